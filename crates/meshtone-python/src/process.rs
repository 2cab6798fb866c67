//! From a channel to its indicators.

use meshtone::signal::{
    self, Alternative, AngularSettings, ChainSettings, SeparationSettings, StatedFacts, StatedTurning,
};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Signal, array, samples};
use crate::error::value_error;
use crate::phase::ShaftPhase;

/// Settings of the chain that are not at their defaults.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Settings {
    teeth: usize,
    sidebands: Option<usize>,
    shaft_orders: Option<Vec<usize>>,
}

impl Settings {
    /// The settings as the library has them.
    pub fn chain(&self) -> PyResult<ChainSettings> {
        let mut separation = SeparationSettings::new(self.teeth);
        if let Some(sidebands) = self.sidebands {
            separation.sidebands = sidebands;
        }
        if let Some(orders) = &self.shaft_orders {
            separation.shaft_orders.clone_from(orders);
        }
        Ok(ChainSettings { separation: Some(separation), ..ChainSettings::default() })
    }
}

/// Results of one channel for one wheel.
#[pyclass(frozen, module = "meshtone._core")]
pub struct Record(pub signal::Record);

#[pymethods]
impl Record {
    /// Average over a revolution.
    #[getter]
    fn average<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.average.values.clone())
    }

    /// Revolutions that were averaged.
    #[getter]
    fn revolutions(&self) -> usize {
        self.0.average.revolutions
    }

    /// Highest order that the sampling rate shows.
    #[getter]
    fn nyquist_order(&self) -> f64 {
        self.0.average.nyquist_order
    }

    /// Mesh harmonics and their sidebands.
    #[getter]
    fn regular<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.parts.regular.clone())
    }

    /// The average without the mesh harmonics.
    #[getter]
    fn residual<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.parts.residual.clone())
    }

    /// The average without the mesh harmonics and their sidebands.
    #[getter]
    fn difference<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.parts.difference.clone())
    }

    /// Envelope of the difference.
    #[getter]
    fn envelope<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.envelope.clone())
    }

    /// Amplitude at each order of the shaft.
    #[getter]
    fn order_spectrum<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.order_spectrum.clone())
    }

    /// Of the envelope.
    #[getter]
    fn envelope_spectrum<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(py, self.0.envelope_spectrum.clone())
    }

    /// Indicators by name; NaN where one is not defined.
    #[getter]
    fn indicators<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for indicator in self.0.indicators.table("") {
            all.set_item(indicator.name, indicator.value.unwrap_or(f64::NAN))?;
        }
        Ok(all)
    }

    /// Warnings.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings.iter().map(ToString::to_string).collect()
    }
}

/// Takes one channel to its indicators.
#[pyfunction]
#[pyo3(signature = (signal, phase, teeth, settings=None))]
pub fn process_channel(
    py: Python<'_>,
    signal: Signal<'_>,
    phase: &ShaftPhase,
    teeth: u32,
    settings: Option<Settings>,
) -> PyResult<Record> {
    let signal = samples(&signal)?;
    let settings = settings.map_or_else(|| Ok(ChainSettings::default()), |settings| settings.chain())?;
    py.detach(|| signal::process_channel(signal, &phase.0, teeth, &settings)).map(Record).map_err(value_error)
}

/// Takes the recordings of a series to their indicators; NA4 knows the earlier ones.
#[pyfunction]
#[pyo3(signature = (signals, phases, teeth, settings=None))]
pub fn process_series(
    py: Python<'_>,
    signals: Vec<Signal<'_>>,
    phases: Vec<PyRef<'_, ShaftPhase>>,
    teeth: u32,
    settings: Option<Settings>,
) -> PyResult<Vec<Record>> {
    if signals.len() != phases.len() {
        return Err(value_error(format!(
            "{} signals, but {} phases: give one of each",
            signals.len(),
            phases.len()
        )));
    }
    let settings = settings.map_or_else(|| Ok(ChainSettings::default()), |settings| settings.chain())?;
    let recordings = signals
        .iter()
        .zip(&phases)
        .map(|(signal, phase)| Ok(signal::Recording { signal: samples(signal)?, phase: &phase.0 }))
        .collect::<PyResult<Vec<_>>>()?;
    let records = py.detach(|| signal::process_series(&recordings, teeth, &settings)).map_err(value_error)?;
    Ok(records.into_iter().map(Record).collect())
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
    let turning = match (pulses_per_revolution, speed_hz) {
        (Some(per_revolution), _) => StatedTurning::Pulses { per_revolution },
        (None, Some(speed_hz)) => StatedTurning::ConstantSpeed { speed_hz },
        (None, None) => StatedTurning::Other,
    };
    let stated = StatedFacts { teeth, mate_teeth, turning };
    let found = py.detach(|| {
        signal::angular_resample(signal, &phase.0, &AngularSettings::default())
            .map(|angular| signal::find_mismatch(&angular, &stated))
    });
    Ok(found.map_err(value_error)?.map(|mismatch| {
        let (cause, value) = match mismatch.alternative {
            Alternative::Teeth { teeth } => ("teeth", f64::from(teeth)),
            Alternative::MateTeeth { teeth, .. } => ("mate_teeth", f64::from(teeth)),
            Alternative::OtherShaft { mate_teeth } => ("other_shaft", f64::from(mate_teeth)),
            Alternative::PulsesPerRevolution { pulses, .. } => ("pulses_per_revolution", f64::from(pulses)),
            Alternative::ShaftSpeed { speed_hz, .. } => ("speed_hz", speed_hz),
            Alternative::VaryingSpeed { variation, .. } => ("varying_speed", variation),
            _ => ("other", f64::NAN),
        };
        (cause, value, mismatch.to_string(), mismatch.energy_ratio)
    }))
}
