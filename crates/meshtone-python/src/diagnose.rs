//! Diagnosis of a gear.

use std::path::{Path, PathBuf};

use meshtone::batch::Control;
use meshtone::scenario;
use meshtone::signal::{
    AngleZero, AngularSettings, ChainSettings, SignalError, SimulatedShafts, StatedFacts, StatedTurning,
    angular_resample, find_mismatch,
};
use meshtone::wheel::WheelName;
use meshtone_diagnose::{
    Answer, Learned, Observation as Observed, Prior, Question, ReferenceStore, SignalKind, StoreError,
    other_teeth, refine,
};
use meshtone_io::experiment::read_tuned;
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

use crate::array::{Array, Signal, array, samples};
use crate::error::{file_error, read_error, scenario_error, value_error};
use crate::interrupt::interruptible;
use crate::phase::ShaftPhase;
use crate::scenario::Scenario;

/// Features of a recording.
#[pyclass(frozen, module = "meshtone._core")]
pub struct Observation(Observed);

#[pymethods]
impl Observation {
    /// Of a simulated signal, in g.
    #[staticmethod]
    fn of_simulated(py: Python<'_>, scenario: &Scenario, signal: Signal<'_>, start_s: f64) -> PyResult<Self> {
        let signal = samples(&signal)?;
        let observe = || {
            let shafts = SimulatedShafts::new(&scenario.0, start_s, signal.len());
            let over = |shaft| shafts.angular(signal, shaft, &ChainSettings::default());
            let (pinion, gear) = (over(WheelName::Pinion)?, over(WheelName::Gear)?);
            let teeth = WheelName::BOTH.map(|shaft| shafts.teeth(shaft));
            let observed =
                Observed::of_recording(&pinion, &gear, teeth, shafts.mean_speed_hz(WheelName::Pinion));
            observed.map(|observed| observed.with_zero(vec![AngleZero::Simulated; 2]))
        };
        py.detach(observe).map(Self).map_err(value_error)
    }

    /// Of a measured signal, in g, with the phase of the pinion's shaft.
    #[staticmethod]
    fn of_measured(
        py: Python<'_>,
        signal: Signal<'_>,
        sampling_rate_hz: f64,
        phase: &ShaftPhase,
        scenario: &Scenario,
    ) -> PyResult<Self> {
        let signal = samples(&signal)?;
        py.detach(|| measured(signal, sampling_rate_hz, phase, &scenario.0)).map(Self).map_err(value_error)
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

fn measured(
    signal: &[f64],
    sampling_rate_hz: f64,
    phase: &ShaftPhase,
    scenario: &scenario::Scenario,
) -> Result<Observed, SignalError> {
    let teeth = [scenario.gears.pinion_teeth, scenario.gears.gear_teeth];
    let settings = AngularSettings::default();
    let pinion = angular_resample(signal, &phase.0, &settings)?;
    let of_gear = phase.0.of_mate(teeth[0], teeth[1])?;
    let gear = angular_resample(signal, &of_gear, &settings)?;
    let stated = StatedFacts { teeth: teeth[0], mate_teeth: Some(teeth[1]), turning: StatedTurning::Other };
    let observed = Observed::of_recording(&pinion, &gear, teeth, phase.0.mean_speed_hz(sampling_rate_hz))?
        .with_zero(vec![phase.0.zero, of_gear.zero]);
    let is_doubtful = phase.0.zero == AngleZero::Chance && !phase.0.warnings.is_empty();
    let against = match find_mismatch(&pinion, &stated) {
        // Another tone than the mesh's may have been followed.
        None if is_doubtful => {
            other_teeth(signal, sampling_rate_hz, teeth, scenario.operation.pinion_speed_hz)?
        }
        against => against,
    };
    Ok(match against {
        Some(against) => observed.with_mismatch(against),
        None => observed,
    })
}

/// The text of the answer's JSON, the difference signal, and the predictive band's ends.
type Diagnosed<'py> = (String, Array<'py>, [Array<'py>; 2]);

/// Says what may be wrong.
#[pyfunction]
pub fn diagnose<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    now: Vec<PyRef<'py, Observation>>,
    healthy: Vec<PyRef<'py, Observation>>,
    tuned: Option<PathBuf>,
    reference: Option<PathBuf>,
    records: u64,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Diagnosed<'py>> {
    let rig = with_tuned(&scenario.0, tuned.as_deref())?;
    let folder = reference.or_else(ReferenceStore::default_folder);
    let folder = folder.ok_or_else(|| {
        value_error("reference: the environment names no home directory; name a folder for the simulations")
    })?;
    let [now, healthy] =
        [now, healthy].map(|all| all.iter().map(|one| one.0.clone()).collect::<Vec<Observed>>());
    let prior = Prior::new(&rig);
    let store = ReferenceStore::new(folder);
    let answer = interruptible(py, progress, records, |cancelled, report| {
        let progress = |count| report((count as u64).min(records), records);
        let control = Control { progress: &progress, cancelled, ..Control::default() };
        answer(&store, &prior, records, &Question { now: &now, healthy: &healthy }, &control)
    })??;
    let mut json = answer.to_json();
    json["reference"] = serde_json::json!({
        "asked": records,
        "simulated": answer.simulated_records,
        "records": answer.reference_records,
        "refined_records": answer.refined_records,
        "folder": store.folder_of(&prior).display().to_string(),
    });
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
    question.check(prior).map_err(value_error)?;
    let reference = store.get(prior, records, control);
    let reference = reference.map_err(|error| match &error {
        StoreError::Folder { path, source } => file_error(path, Some(source), &error),
        StoreError::File(_) => PyOSError::new_err(error.to_string()),
        StoreError::Cancelled => PyRuntimeError::new_err(error.to_string()),
    })?;
    let learned = Learned::new(&reference, question).map_err(value_error)?;
    // The caller's count of simulations is complete.
    let control = Control { progress: &|_| {}, ..*control };
    let refined = refine(&learned, question, &control).map_err(value_error)?;
    meshtone_diagnose::diagnose(&learned, question, refined.as_ref()).map_err(value_error)
}

fn with_tuned(scenario: &scenario::Scenario, path: Option<&Path>) -> PyResult<scenario::Scenario> {
    let Some(path) = path else { return Ok(scenario.clone()) };
    let tuned = read_tuned(path).map_err(|error| read_error(path, &error))?;
    match tuned.warning_for(scenario) {
        Some(problem) => Err(value_error(format!("{}: {problem}", path.display()))),
        None => tuned.apply(scenario).map_err(|error| scenario_error(&error)),
    }
}
