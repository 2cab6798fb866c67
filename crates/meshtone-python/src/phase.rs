//! The angle of a shaft.

use meshtone::signal::{self, AngleZero, MeshTone, PulseEdge, Tachometer, TrainTurning};
use pyo3::prelude::*;

use crate::array::{Array, Signal, array, samples};
use crate::error::value_error;
use crate::process::{TypedWarning, train, typed};
use crate::scenario::Scenario;

/// Angle of a shaft at each sample.
#[pyclass(frozen, module = "meshtone._core")]
#[derive(Clone)]
pub struct ShaftPhase(pub signal::ShaftPhase);

#[pymethods]
impl ShaftPhase {
    #[new]
    #[pyo3(signature = (revolutions, first_sample=0, zero="angle 0"))]
    fn new(revolutions: Signal<'_>, first_sample: usize, zero: &str) -> PyResult<Self> {
        let revolutions = samples(&revolutions)?.to_vec();
        let known = AngleZero::NAMES.into_iter().find(|(name, _)| *name == zero);
        let (_, zero) = known.ok_or_else(|| value_error(format!("zero '{zero}': is no angle's origin")))?;
        let phase = signal::ShaftPhase::new(first_sample, revolutions).map_err(value_error)?;
        Ok(Self(phase.with_zero(zero)))
    }

    /// Returns the phase of the input in a simulation: of the pinion, or of the shaft at the motor.
    #[staticmethod]
    fn of_simulated(scenario: &Scenario, start_s: f64, samples: usize) -> PyResult<Self> {
        let train = train(scenario)?;
        let turning = TrainTurning::of_simulated(&scenario.0, start_s, samples);
        let known = turning.and_then(|turning| turning.known_phase(&train));
        known.map(|(_, phase, _)| Self(phase)).map_err(value_error)
    }

    /// Of a constant speed.
    #[staticmethod]
    fn constant(speed_hz: f64, sampling_rate_hz: f64, samples: usize) -> PyResult<Self> {
        signal::ShaftPhase::constant(speed_hz, sampling_rate_hz, samples).map(Self).map_err(value_error)
    }

    /// From the times of pulses.
    #[staticmethod]
    fn from_pulses(
        time_s: Signal<'_>,
        pulses_per_revolution: u32,
        sampling_rate_hz: f64,
        samples: usize,
        stated_speed_hz: Option<f64>,
    ) -> PyResult<Self> {
        let time_s = crate::array::samples(&time_s)?;
        signal::ShaftPhase::from_pulses(
            time_s,
            pulses_per_revolution,
            stated_speed_hz,
            sampling_rate_hz,
            samples,
        )
        .map(Self)
        .map_err(value_error)
    }

    /// From a speed that is known at some times.
    #[staticmethod]
    fn from_speed_profile(
        time_s: Signal<'_>,
        speed_hz: Signal<'_>,
        sampling_rate_hz: f64,
        samples: usize,
    ) -> PyResult<Self> {
        let (time_s, speed_hz) = (crate::array::samples(&time_s)?, crate::array::samples(&speed_hz)?);
        signal::ShaftPhase::from_speed_profile(time_s, speed_hz, sampling_rate_hz, samples)
            .map(Self)
            .map_err(value_error)
    }

    /// From the speed at every sample.
    #[staticmethod]
    fn from_speed_samples(speed_hz: Signal<'_>, sampling_rate_hz: f64) -> PyResult<Self> {
        signal::ShaftPhase::from_speed_samples(samples(&speed_hz)?, sampling_rate_hz)
            .map(Self)
            .map_err(value_error)
    }

    /// From the vibration itself.
    #[staticmethod]
    fn from_mesh_tone(
        py: Python<'_>,
        signal: Signal<'_>,
        sampling_rate_hz: f64,
        teeth: u32,
        shaft_hz: f64,
        harmonic: u32,
        half_band_hz: Option<f64>,
    ) -> PyResult<Self> {
        let tone = MeshTone { harmonic, half_band_hz, ..MeshTone::new(teeth, shaft_hz) };
        let signal = samples(&signal)?;
        py.detach(|| signal::ShaftPhase::from_mesh_tone(signal, sampling_rate_hz, &tone))
            .map(Self)
            .map_err(value_error)
    }

    /// Of the shaft of the wheel that this one's wheel meshes with.
    fn of_mate(&self, teeth: u32, mate_teeth: u32) -> PyResult<Self> {
        self.0.of_mate(teeth, mate_teeth).map(Self).map_err(value_error)
    }

    /// Of a part of the recording.
    fn part(&self, start: usize, stop: usize) -> PyResult<Self> {
        self.0.part(start..stop).map(Self).map_err(value_error)
    }

    /// Meaning of angle 0.
    #[getter]
    fn zero(&self) -> &'static str {
        self.0.zero.name()
    }

    /// Number of the recording's sample that the first angle belongs to.
    #[getter]
    fn first_sample(&self) -> usize {
        self.0.first_sample
    }

    /// (rev) Angle at each sample.
    #[getter]
    fn revolutions<'py>(&self, py: Python<'py>) -> Array<'py> {
        array(py, self.0.revolutions.clone())
    }

    /// Warnings.
    #[getter]
    fn warnings(&self) -> Vec<TypedWarning> {
        typed(&self.0.warnings)
    }

    /// (Hz)
    fn mean_speed_hz(&self, sampling_rate_hz: f64) -> f64 {
        self.0.mean_speed_hz(sampling_rate_hz)
    }
}

/// Times of a tachometer's pulses.
#[pyfunction]
pub fn tachometer_pulses<'py>(
    py: Python<'py>,
    waveform: Signal<'py>,
    sampling_rate_hz: f64,
    threshold: Option<f64>,
    hysteresis: Option<f64>,
    edge: &str,
) -> PyResult<Array<'py>> {
    let edge = match edge {
        "rising" => PulseEdge::Rising,
        "falling" => PulseEdge::Falling,
        _ => return Err(value_error(format!("edge = '{edge}': must be 'rising' or 'falling'"))),
    };
    let tachometer = Tachometer { threshold, hysteresis, edge };
    let pulses =
        signal::tachometer_pulses(samples(&waveform)?, sampling_rate_hz, &tachometer).map_err(value_error)?;
    Ok(array(py, pulses))
}

/// Pulses with the missing ones put in and the doubled ones taken out, and what was found.
#[pyfunction]
pub fn repair_pulses<'py>(py: Python<'py>, time_s: Signal<'py>) -> PyResult<(Array<'py>, Vec<String>)> {
    let train = signal::repair_pulses(samples(&time_s)?).map_err(value_error)?;
    let warnings = train.warnings.iter().map(ToString::to_string).collect();
    Ok((array(py, train.time_s), warnings))
}
