//! From a channel to its indicators.

use meshtone::signal::{
    self, AngleZero, AngularSettings, ChainSettings, ForeignTone, GearTrain, SeparationSettings, SignalError,
    SignalWarning, StatedFacts, StatedTurning, SynchronousPart, TrainRecording, TrainRecords, TrainSettings,
    TrainTurning,
};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::array::{Signal, array, samples};
use crate::error::{scenario_error, value_error};
use crate::phase::ShaftPhase;
use crate::scenario::Scenario;

/// Settings of the chain that are not at their defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    teeth: usize,
    sidebands: Option<usize>,
    shaft_orders: Option<Vec<usize>>,
}

impl Settings {
    /// The settings as the library has them; its defaults where Python gives none.
    pub fn chain(given: Option<Self>) -> ChainSettings {
        let separation = given.map(|given| separation(given.teeth, given.sidebands, given.shaft_orders));
        ChainSettings { separation, ..ChainSettings::default() }
    }
}

/// What belongs to the regular part; the library's defaults where Python gives none.
pub fn separation(
    teeth: usize,
    sidebands: Option<usize>,
    shaft_orders: Option<Vec<usize>>,
) -> SeparationSettings {
    let defaults = SeparationSettings::new(teeth);
    SeparationSettings {
        sidebands: sidebands.unwrap_or(defaults.sidebands),
        shaft_orders: shaft_orders.unwrap_or(defaults.shaft_orders),
        ..defaults
    }
}

/// Code, words and numbers of a warning.
pub type TypedWarning = (&'static str, String, Vec<(String, f64)>);

/// Warnings as Python takes them.
pub fn typed(warnings: &[SignalWarning]) -> Vec<TypedWarning> {
    warnings.iter().map(|warning| (warning.code(), warning.to_string(), warning.values())).collect()
}

/// The results of one channel for one wheel, by the names of Python's properties; an indicator that is not defined is NaN.
pub fn record_parts(py: Python<'_>, record: signal::Record) -> PyResult<Bound<'_, PyDict>> {
    let indicators = record.indicators.table("").into_iter();
    let indicators = indicators.map(|indicator| (indicator.name, indicator.value.unwrap_or(f64::NAN)));
    let signals = [
        ("average", record.average.values),
        ("regular", record.parts.regular),
        ("residual", record.parts.residual),
        ("difference", record.parts.difference),
        ("envelope", record.envelope),
        ("order_spectrum", record.order_spectrum),
        ("envelope_spectrum", record.envelope_spectrum),
    ];
    let parts = signals.map(|(name, values)| (name, array(py, values))).into_py_dict(py)?;
    parts.set_item("revolutions", record.average.revolutions)?;
    parts.set_item("nyquist_order", record.average.nyquist_order)?;
    parts.set_item("indicators", indicators.into_py_dict(py)?)?;
    parts.set_item("warnings", typed(&record.warnings))?;
    Ok(parts)
}

/// Takes one channel to its indicators.
#[pyfunction]
#[pyo3(signature = (signal, phase, teeth, settings=None))]
pub fn process_channel<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phase: &ShaftPhase,
    teeth: u32,
    settings: Option<Settings>,
) -> PyResult<Bound<'py, PyDict>> {
    let signal = samples(&signal)?;
    let settings = Settings::chain(settings);
    let record = py.detach(|| signal::process_channel(signal, &phase.0, teeth, &settings));
    record_parts(py, record.map_err(value_error)?)
}

/// The shafts and wheels of a scenario.
pub fn train(scenario: &Scenario) -> PyResult<GearTrain> {
    GearTrain::of_scenario(&scenario.0).map_err(|error| scenario_error(&error))
}

/// Number of a shaft by its name.
pub fn shaft_number(train: &GearTrain, name: &str) -> PyResult<usize> {
    let names: Vec<&str> = train.shafts.iter().map(|shaft| shaft.name.as_str()).collect();
    let known = names.iter().position(|known| *known == name);
    known.ok_or_else(|| value_error(format!("shaft = '{name}': must be one of {}", names.join(", "))))
}

/// Number of the shaft that a phase is stated to be of, the input where none is named.
pub fn stated_shaft(train: &GearTrain, name: Option<&str>) -> PyResult<usize> {
    name.map_or_else(|| Ok(train.input()), |name| shaft_number(train, name))
}

/// How a train turns by the phase of one shaft, of the input where none is named.
pub fn turning(train: &GearTrain, phase: &ShaftPhase, shaft: Option<&str>) -> PyResult<TrainTurning> {
    let shaft = stated_shaft(train, shaft)?;
    Ok(TrainTurning::Shaft { shaft, phase: phase.0.clone(), stated: StatedTurning::Other })
}

/// The shaft that the phase of a rig's recording is of, and what is stated about it: a phase from a mesh tone, whose zero is chance, has the
/// scenario's speed beside it.
pub fn stated_of_rig(
    rig: &meshtone::scenario::Scenario,
    train: &GearTrain,
    phase: &ShaftPhase,
    shaft: Option<&str>,
) -> PyResult<(usize, StatedTurning)> {
    let shaft = stated_shaft(train, shaft)?;
    let ratio = train.speed_ratio(shaft, train.input()).value();
    let stated = match phase.0.zero {
        AngleZero::Chance => StatedTurning::MeshTone { nominal_hz: rig.operation.pinion_speed_hz * ratio },
        _ => StatedTurning::Other,
    };
    Ok((shaft, stated))
}

/// Takes one channel to the indicators of every wheel of a machine: name, shaft, teeth, speed and record of each wheel; the foreign lines; the
/// warnings.
#[pyfunction]
#[pyo3(signature = (signal, phase, machine, sampling_rate_hz, shaft=None, sidebands=None, shaft_orders=None))]
#[expect(clippy::too_many_arguments, reason = "they are those of the function in Python")]
pub fn process_train<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phase: &ShaftPhase,
    machine: PyRef<'py, Scenario>,
    sampling_rate_hz: f64,
    shaft: Option<&str>,
    sidebands: Option<usize>,
    shaft_orders: Option<Vec<usize>>,
) -> PyResult<Bound<'py, PyDict>> {
    let signal = samples(&signal)?;
    let train = train(&machine)?;
    let turning = turning(&train, phase, shaft)?;
    let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
    train_parts(py, &recording, separation(1, sidebands, shaft_orders))
}

/// The results of one channel for all wheels, by the names of Python's properties.
pub fn train_parts<'py>(
    py: Python<'py>,
    recording: &TrainRecording<'_>,
    separation: SeparationSettings,
) -> PyResult<Bound<'py, PyDict>> {
    let settings = TrainSettings { separation, ..TrainSettings::default() };
    let processed = py.detach(|| recording.process(&settings));
    let train = recording.train;
    let TrainRecords { wheels, foreign, warnings, .. } = processed.map_err(value_error)?;
    let wheels = wheels.into_iter().map(|of| {
        let wheel = &train.wheels[of.wheel];
        let record = of.records.into_iter().next().ok_or_else(|| value_error("there is no record"))?;
        let parts = record_parts(py, record)?;
        Ok((&*wheel.name, &*train.shafts[wheel.shaft].name, wheel.teeth, of.mean_speed_hz, parts))
    });
    let line = |tone: &ForeignTone| (tone.frequency_hz, tone.order, tone.amplitude, tone.part);
    let all = PyDict::new(py);
    all.set_item("wheels", wheels.collect::<PyResult<Vec<_>>>()?)?;
    all.set_item("own_orders_part", foreign.as_ref().map(|found| found.own_part))?;
    all.set_item("foreign_lines_need_s", foreign.as_ref().and_then(|found| found.needed_s))?;
    all.set_item("foreign", foreign.map(|found| found.tones.iter().map(line).collect::<Vec<_>>()))?;
    all.set_item("warnings", typed(&warnings))?;
    Ok(all)
}

/// Takes the recordings of a series to their indicators; NA4 knows the earlier ones.
#[pyfunction]
#[pyo3(signature = (signals, phases, teeth, settings=None))]
pub fn process_series<'py>(
    py: Python<'py>,
    signals: Vec<Signal<'py>>,
    phases: Vec<PyRef<'py, ShaftPhase>>,
    teeth: u32,
    settings: Option<Settings>,
) -> PyResult<Vec<Bound<'py, PyDict>>> {
    if signals.len() != phases.len() {
        return Err(value_error(format!(
            "{} signals, but {} phases: give one of each",
            signals.len(),
            phases.len()
        )));
    }
    let settings = Settings::chain(settings);
    let recordings = signals
        .iter()
        .zip(&phases)
        .map(|(signal, phase)| Ok(signal::Recording { signal: samples(signal)?, phase: &phase.0 }))
        .collect::<PyResult<Vec<_>>>()?;
    let records = py.detach(|| signal::process_series(&recordings, teeth, &settings)).map_err(value_error)?;
    records.into_iter().map(|record| record_parts(py, record)).collect()
}

/// Cause, better value, words, and how much more energy the average would hold.
type Mismatch = (&'static str, f64, String, Option<f64>);

/// Finds a sign that a recording does not fit what is stated.
#[pyfunction]
#[pyo3(signature = (signal, phase, teeth, mate_teeth=None, pulses_per_revolution=None, speed_hz=None))]
pub fn find_mismatch(
    py: Python<'_>,
    signal: Signal<'_>,
    phase: &ShaftPhase,
    teeth: u32,
    mate_teeth: Option<u32>,
    pulses_per_revolution: Option<u32>,
    speed_hz: Option<f64>,
) -> PyResult<Option<Mismatch>> {
    let signal = samples(&signal)?;
    let stated = stated_facts(phase, teeth, mate_teeth, pulses_per_revolution, speed_hz);
    let found = py.detach(|| {
        signal::angular_resample(signal, &phase.0, &AngularSettings::default())
            .map(|angular| signal::find_mismatch(&angular, &stated))
    });
    Ok(found.map_err(value_error)?.map(|mismatch| {
        let alternative = mismatch.alternative;
        (alternative.code(), alternative.value(), mismatch.to_string(), mismatch.energy_ratio)
    }))
}

/// Finds all that is doubtful about a recording and what is stated about it.
#[pyfunction]
#[pyo3(signature = (signal, phase, sampling_rate_hz, teeth, mate_teeth=None, pulses_per_revolution=None, speed_hz=None))]
#[expect(clippy::too_many_arguments, reason = "they are those of the function in Python")]
pub fn check_recording(
    py: Python<'_>,
    signal: Signal<'_>,
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
    teeth: u32,
    mate_teeth: Option<u32>,
    pulses_per_revolution: Option<u32>,
    speed_hz: Option<f64>,
) -> PyResult<Vec<TypedWarning>> {
    let signal = samples(&signal)?;
    let stated = stated_facts(phase, teeth, mate_teeth, pulses_per_revolution, speed_hz);
    let found: Result<_, SignalError> = py.detach(|| {
        let angular = signal::angular_resample(signal, &phase.0, &AngularSettings::default())?;
        let mut found = phase.0.warnings.clone();
        found.extend(signal::sensor_faults(signal).into_iter().map(SignalWarning::SensorFault));
        found.extend(signal::check_recording(&angular, &stated, &phase.0, sampling_rate_hz));
        let part = signal::synchronous_average(&angular)
            .ok()
            .and_then(|average| signal::synchronous_part(&angular.values, &average.values));
        let part = part.filter(SynchronousPart::is_noise);
        found.extend(part.map(|part| SignalWarning::NothingSynchronous { part, teeth, other: None }));
        Ok(found)
    });
    Ok(typed(&found.map_err(value_error)?))
}

/// What is stated; a phase that was found in the mesh tone says so itself.
fn stated_facts(
    phase: &ShaftPhase,
    teeth: u32,
    mate_teeth: Option<u32>,
    pulses_per_revolution: Option<u32>,
    speed_hz: Option<f64>,
) -> StatedFacts {
    let turning = match (pulses_per_revolution, speed_hz) {
        (Some(per_revolution), _) => StatedTurning::Pulses { per_revolution },
        (None, Some(nominal_hz)) if phase.0.zero == AngleZero::Chance => {
            StatedTurning::MeshTone { nominal_hz }
        }
        (None, Some(speed_hz)) => StatedTurning::ConstantSpeed { speed_hz },
        (None, None) => StatedTurning::Other,
    };
    StatedFacts { teeth, mate_teeth, turning }
}
