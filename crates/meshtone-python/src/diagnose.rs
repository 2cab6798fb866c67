//! Diagnosis of a gear.

use std::path::PathBuf;

use meshtone::batch::Control;
use meshtone::signal::{GearTrain, TrainRecording, TrainTurning};
use meshtone_diagnose::{
    Answer, DiagnoseError, Learned, Observation as Observed, Prior, Question, ReferenceStore, SignalKind,
    StoreError, refine,
};
use meshtone_io::experiment::read_tuned;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::array::{Array, Signal, array, samples};
use crate::error::{os_error, read_error, scenario_error, value_error};
use crate::interrupt::interruptible;
use crate::phase::ShaftPhase;
use crate::process::stated_of_rig;
use crate::scenario::Scenario;

/// Features of a recording.
#[pyclass(frozen, module = "meshtone._core")]
pub struct Observation(Observed);

#[pymethods]
impl Observation {
    /// Of a simulated signal, in g.
    #[staticmethod]
    fn of_simulated(
        py: Python<'_>,
        machine: PyRef<'_, Scenario>,
        signal: Signal<'_>,
        start_s: f64,
    ) -> PyResult<Self> {
        let signal = samples(&signal)?;
        let form = machine.0.clone();
        let train = GearTrain::of_scenario(&form).map_err(|error| scenario_error(&error))?;
        let observe = || {
            let turning = TrainTurning::of_simulated(&form, start_s, signal.len())?;
            let sampling_rate_hz = form.time_grid().sampling_rate_hz;
            let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
            Observed::of_recording(&recording)
        };
        py.detach(observe).map(Self).map_err(value_error)
    }

    /// Observes a measured signal, in g, by the phase of a shaft (the pinion's or the input where none is named).
    #[staticmethod]
    fn of_measured(
        py: Python<'_>,
        signal: Signal<'_>,
        sampling_rate_hz: f64,
        phase: &ShaftPhase,
        shaft: Option<&str>,
        machine: PyRef<'_, Scenario>,
    ) -> PyResult<Self> {
        let signal = samples(&signal)?;
        let form = machine.0.clone();
        let train = GearTrain::of_scenario(&form).map_err(|error| scenario_error(&error))?;
        let (shaft, stated) = stated_of_rig(&form, &train, phase, shaft)?;
        let turning = TrainTurning::Shaft { shaft, phase: phase.0.clone(), stated };
        let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
        py.detach(|| Observed::of_recording(&recording)).map(Self).map_err(value_error)
    }

    /// Of one revolution of the gear, in g.
    #[staticmethod]
    fn of_revolution(py: Python<'_>, values: Signal<'_>, gear_teeth: u32, signal: &str) -> PyResult<Self> {
        let kind = SignalKind::NAMES.into_iter().find(|(name, _)| *name == signal);
        let (_, kind) = kind.ok_or_else(|| {
            value_error(format!("signal '{signal}': must be 'recording', 'average' or 'difference'"))
        })?;
        let values = samples(&values)?;
        py.detach(|| Observed::of_revolution(values, gear_teeth, kind, None)).map(Self).map_err(value_error)
    }
}

/// The text of the answer's JSON, the difference signal, and the predictive band's ends.
type Diagnosed<'py> = (String, Array<'py>, [Array<'py>; 2]);

/// The rig with the numbers of a `tuned.toml`.
#[pyfunction]
pub fn tuned_rig(scenario: &Scenario, path: PathBuf) -> PyResult<Scenario> {
    let tuned = read_tuned(&path).map_err(|error| read_error(&path, &error))?;
    match tuned.warning_for(&scenario.0) {
        Some(problem) => Err(value_error(format!("{}: {problem}", path.display()))),
        None => tuned.apply(&scenario.0).map(Scenario).map_err(|error| scenario_error(&error)),
    }
}

/// Checks a question, and lists the codes and messages of what is doubtful about it before anything is simulated.
#[pyfunction]
pub fn check_diagnosis(
    py: Python<'_>,
    machine: PyRef<'_, Scenario>,
    now: Vec<PyRef<'_, Observation>>,
    healthy: Vec<PyRef<'_, Observation>>,
) -> PyResult<Vec<(&'static str, String)>> {
    let [now, healthy] = [now, healthy].map(observed);
    let question = Question { now: &now, healthy: &healthy };
    let prior = question.prior(&machine.0).map_err(|error| scenario_error(&error))?;
    let check = || {
        question.check(&prior)?;
        Ok(question.warnings(&prior))
    };
    let warnings = py.detach(check).map_err(|error: DiagnoseError| value_error(error))?;
    Ok(warnings.into_iter().map(|warning| (warning.code, warning.message)).collect())
}

fn observed(all: Vec<PyRef<'_, Observation>>) -> Vec<Observed> {
    all.iter().map(|one| one.0.clone()).collect()
}

/// Says what may be wrong.
#[pyfunction]
pub fn diagnose<'py>(
    py: Python<'py>,
    machine: PyRef<'py, Scenario>,
    now: Vec<PyRef<'py, Observation>>,
    healthy: Vec<PyRef<'py, Observation>>,
    reference: Option<PathBuf>,
    records: u64,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Diagnosed<'py>> {
    let folder = reference.or_else(ReferenceStore::default_folder);
    let folder = folder.ok_or_else(|| {
        value_error("reference: the environment names no home directory; name a folder for the simulations")
    })?;
    let [now, healthy] = [now, healthy].map(observed);
    let question = Question { now: &now, healthy: &healthy };
    let prior = question.prior(&machine.0).map_err(|error| scenario_error(&error))?;
    let store = ReferenceStore::new(folder);
    let answer = interruptible(py, progress, records, |cancelled, report| {
        let progress = |count| report((count as u64).min(records), records);
        let control = Control { progress: &progress, cancelled, ..Control::default() };
        answer(&store, &prior, records, &question, &control)
    })??;
    let mut json = answer.to_json();
    json["reference"] = answer.reference_json(records, &store.folder_of(&prior));
    let band = answer.band_g.map(|end| array(py, end));
    Ok((json.to_string(), array(py, answer.difference_g), band))
}

fn answer(
    store: &ReferenceStore,
    prior: &Prior,
    records: u64,
    question: &Question,
    control: &Control,
) -> PyResult<Answer> {
    let reference = store.get(prior, records, control);
    let reference = reference.map_err(|error| match error {
        StoreError::File(error) => os_error("write", error.path.display().to_string(), &error.source),
        StoreError::Cancelled => PyRuntimeError::new_err(error.to_string()),
    })?;
    let learned = Learned::new(&reference, question).map_err(value_error)?;
    // The caller's count of simulations is complete.
    let control = Control { progress: &|_| {}, ..*control };
    let refined = refine(&learned, question, &control).map_err(value_error)?;
    meshtone_diagnose::diagnose(&learned, question, refined.as_ref()).map_err(value_error)
}
