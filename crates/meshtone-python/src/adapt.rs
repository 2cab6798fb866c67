//! A data set for a machine of which healthy recordings are known.

use std::path::PathBuf;

use meshtone::signal::GearTrain;
use meshtone::tuning::{ExperimentControl, PathSettings, estimate_path};
use meshtone_dataset::DatasetError;
use meshtone_dataset::adapt::{self, AdaptSettings, KnownMachine, tooth_classes};
use meshtone_dataset::generate::GenerateControl;
use meshtone_dataset::store::Destination;
use pyo3::prelude::*;

use crate::dataset::dataset_error;
use crate::error::scenario_error;
use crate::interrupt::interruptible;
use crate::scenario::Scenario;
use crate::sensor_path::{Recorded, path_error, sensor_recordings};

/// A data set for a machine, and the classifier that was learnt from it.
#[pyclass(frozen)]
pub struct Adaptation {
    adaptation: adapt::Adaptation,
}

/// Makes a data set for a machine, in a directory.
#[pyfunction]
pub fn adapt_dataset<'py>(
    py: Python<'py>,
    machine: PyRef<'py, Scenario>,
    recordings: Vec<Recorded<'py>>,
    to: PathBuf,
    classes: Option<Vec<String>>,
    numbers: (u64, usize, u64),
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Adaptation> {
    let ((units, draws, seed), machine) = (numbers, machine.0.clone());
    let train = GearTrain::of_scenario(&machine).map_err(|error| scenario_error(&error))?;
    let healthy = sensor_recordings(&machine, &train, &recordings)?;
    let settings = AdaptSettings { classes: classes.unwrap_or_else(|| tooth_classes(&machine)), units, seed };
    settings.check(&machine).map_err(dataset_error)?;
    let to = Destination::directory(to);
    let made = interruptible(py, progress, 0, |cancelled, progress| {
        let control = ExperimentControl { progress: &|_, _| {}, cancelled };
        let estimate = estimate_path(&machine, &healthy, &PathSettings { draws, seed }, &control);
        let estimate = estimate.map_err(path_error)?;
        let known = KnownMachine { scenario: &machine, recordings: &healthy, estimate: &estimate };
        let made: Result<_, DatasetError> =
            adapt::adapt(&known, &settings, &to, &GenerateControl { progress, cancelled });
        made.map_err(dataset_error)
    })?;
    Ok(Adaptation { adaptation: made? })
}

#[pymethods]
impl Adaptation {
    /// What was found, as JSON.
    fn json(&self) -> String {
        self.adaptation.to_json().to_string()
    }

    /// Probabilities of the classes for each window of a recording, and what is doubtful about it.
    fn probabilities<'py>(
        &self,
        py: Python<'py>,
        recording: Recorded<'py>,
    ) -> PyResult<(Vec<Vec<f64>>, Option<String>)> {
        let adapt::Adaptation { scenario, train, .. } = &self.adaptation;
        let recording = &sensor_recordings(scenario, train, &[recording])?[0];
        let judged = py.detach(|| self.adaptation.judge(recording)).map_err(dataset_error)?;
        let doubt = judged.doubt();
        Ok((judged.probabilities, doubt))
    }
}
