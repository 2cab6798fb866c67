//! Bearings: their defect orders and lines, and the tools that bring these out of a recording.

use meshtone::bearing::{BearingGeometry, NAMED_BEARINGS};
use meshtone::signal::{
    self as steps, BearingSeparation, BearingSettings, EnvelopeBand, FrequencyBand, GearTrain, Kurtogram,
    SquaredEnvelopeSpectrum, TrainBearing, TrainRecording,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::{Array, Signal, array, samples};
use crate::error::value_error;
use crate::phase::ShaftPhase;
use crate::process::{shaft_number, stated_shaft, train, turning, typed};
use crate::scenario::Scenario;

/// Number of elements, their diameter, the pitch diameter, and the contact angle.
type Geometry = (u32, f64, f64, f64);
/// Name, part, order, place where it was found, amplitude, amplitude over the median, whether a shaft order is as near.
type Line = (String, &'static str, f64, f64, f64, f64, bool);

fn geometry((elements, element_mm, pitch_mm, contact_angle_deg): Geometry) -> PyResult<BearingGeometry> {
    BearingGeometry::new(elements, element_mm, pitch_mm, contact_angle_deg).map_err(value_error)
}

fn numbers(of: BearingGeometry) -> Geometry {
    (of.elements, of.element_mm, of.pitch_mm, of.contact_angle_deg)
}

/// Name, geometry and source of the bearings by name.
#[pyfunction]
pub fn named_bearings() -> Vec<(&'static str, Geometry, &'static str)> {
    NAMED_BEARINGS.iter().map(|named| (named.name, numbers(named.geometry), named.source)).collect()
}

/// FTF, BPFO, BPFI and BSF.
#[pyfunction]
pub fn defect_orders(bearing: Geometry) -> PyResult<(f64, f64, f64, f64)> {
    let of = geometry(bearing)?.defect_orders();
    Ok((of.cage, of.outer_race, of.inner_race, of.element_spin))
}

/// The lines of a bearing's defects in a squared envelope spectrum.
#[pyfunction]
pub fn defect_lines(
    py: Python<'_>,
    step: f64,
    amplitudes: Signal<'_>,
    bearing: Geometry,
    shaft: f64,
) -> PyResult<Vec<Line>> {
    let orders = geometry(bearing)?.defect_orders();
    let spectrum = SquaredEnvelopeSpectrum { step, amplitudes: samples(&amplitudes)?.to_vec() };
    Ok(py.detach(|| steps::defect_lines(&spectrum, &orders, shaft)).iter().map(line).collect())
}

/// Race, order, place where it was found, band, depth, probability, whether it is detected.
type Race = (&'static str, f64, f64, (f64, f64), f64, f64, bool);

fn race_test(of: &steps::RaceTest) -> Race {
    let band_hz = (of.band.from_hz, of.band.to_hz);
    (of.race.name(), of.order, of.found_order, band_hz, of.depth, of.stated_probability(), of.is_detected())
}

fn line(of: &steps::DefectLine) -> Line {
    let part = of.kind.name();
    (of.name(), part, of.order, of.found_order, of.amplitude, of.over_median, of.is_beside_shaft_order)
}

/// Looks for bearings on the shafts of a machine: the kurtogram, the band and its kurtosis, for each bearing its spectrum and lines, the
/// warnings, and the bearings with their shafts: of the machine, where none are given. Without a machine there is one shaft.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "they are those of the method in Python")]
pub fn bearings_of_train<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phase: &ShaftPhase,
    machine: Option<PyRef<'py, Scenario>>,
    sampling_rate_hz: f64,
    shaft: Option<&str>,
    bearings: Option<Vec<(Geometry, Option<String>)>>,
    separation: &str,
    band_hz: Option<(f64, f64)>,
    of_kurtogram: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let signal = samples(&signal)?;
    let train = machine.map_or_else(|| Ok(GearTrain::of_shaft("shaft")), |machine| train(&machine))?;
    let turning = turning(&train, phase, shaft)?;
    let own = stated_shaft(&train, shaft)?;
    let place = |(of, shaft): (Geometry, Option<String>)| -> PyResult<TrainBearing> {
        let shaft = shaft.map_or(Ok(own), |name| shaft_number(&train, &name))?;
        Ok(TrainBearing { geometry: geometry(of)?, shaft })
    };
    let placed = match bearings {
        Some(bearings) => bearings.into_iter().map(place).collect::<PyResult<Vec<_>>>()?,
        None if train.bearings.is_empty() => {
            let problem = "bearings: missing, and the machine has no rolling bearing; name some, as [Bearing.named(\"6205\")]";
            return Err(value_error(problem));
        }
        None => train.distinct_bearings(),
    };
    let separation = match separation {
        "averages" => BearingSeparation::Averages,
        "discrete-random" => BearingSeparation::DiscreteRandom,
        "prewhitening" => BearingSeparation::Prewhitening,
        "none" => BearingSeparation::None,
        other => {
            let allowed = "averages, discrete-random, prewhitening, none";
            return Err(value_error(format!("separation = '{other}': must be one of {allowed}")));
        }
    };
    let band = match frequencies(band_hz) {
        Some(band) => EnvelopeBand::Stated(band),
        None if of_kurtogram => EnvelopeBand::Kurtogram,
        None => EnvelopeBand::Verdict,
    };
    let settings = BearingSettings { separation, band };
    let recording = TrainRecording { signal, sampling_rate_hz, train: &train, turning: &turning };
    let found = py.detach(|| recording.bearings(&placed, &settings)).map_err(value_error)?;
    let defects = &found.defects;
    let levels = found.kurtogram.levels.into_iter().map(|level| array(py, level));
    let of_bearing = |(spectrum, lines): (SquaredEnvelopeSpectrum, Vec<steps::DefectLine>)| {
        (spectrum.step, array(py, spectrum.amplitudes), lines.iter().map(line).collect::<Vec<_>>())
    };
    let of_train = |bearing: &TrainBearing| (numbers(bearing.geometry), &train.shafts[bearing.shaft].name);
    let all = PyDict::new(py);
    all.set_item("placed", placed.iter().map(of_train).collect::<Vec<_>>())?;
    let verdict = |place| {
        let races = defects.races.iter().filter(|of| of.bearings.contains(&place)).map(race_test);
        let unexplained = defects.unexplained.as_ref().filter(|of| of.shaft == placed[place].shaft);
        let unexplained = unexplained.map(|of| {
            let ratios: Vec<_> = of.ratios.iter().map(|(race, _, ratio)| (race.name(), *ratio)).collect();
            (of.order, (of.band.from_hz, of.band.to_hz), ratios, of.to_string())
        });
        let (name, in_words) = (defects.verdict(place).name(), defects.in_words(place));
        (name, in_words, races.collect::<Vec<_>>(), unexplained)
    };
    all.set_item("verdicts", (0..placed.len()).map(verdict).collect::<Vec<_>>())?;
    all.set_item("levels", levels.collect::<Vec<_>>())?;
    all.set_item("band_hz", (found.band.from_hz, found.band.to_hz))?;
    all.set_item("kurtosis", found.kurtosis)?;
    all.set_item("bearings", found.bearings.into_iter().map(of_bearing).collect::<Vec<_>>())?;
    all.set_item("warnings", typed(&found.warnings))?;
    Ok(all)
}

fn frequencies(band_hz: Option<(f64, f64)>) -> Option<FrequencyBand> {
    band_hz.map(|(from_hz, to_hz)| FrequencyBand { from_hz, to_hz })
}

/// Squared envelope of a band.
#[pyfunction]
pub fn squared_envelope<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    sampling_rate_hz: f64,
    band_hz: Option<(f64, f64)>,
) -> PyResult<Array<'py>> {
    let signal = samples(&signal)?;
    let squares = py.detach(|| steps::squared_envelope(signal, sampling_rate_hz, frequencies(band_hz)));
    Ok(array(py, squares.map_err(value_error)?))
}

/// Distance of the lines in Hz, or in orders of the shaft where its phase is given, and their amplitudes.
#[pyfunction]
pub fn squared_envelope_spectrum<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    sampling_rate_hz: f64,
    band_hz: Option<(f64, f64)>,
    phase: Option<&ShaftPhase>,
) -> PyResult<(f64, Array<'py>)> {
    let (signal, band) = (samples(&signal)?, frequencies(band_hz));
    let phase = phase.map(|phase| &phase.0);
    let spectrum = py.detach(|| match phase {
        None => steps::squared_envelope_spectrum(signal, sampling_rate_hz, band),
        Some(phase) => steps::squared_envelope_order_spectrum(signal, sampling_rate_hz, band, phase),
    });
    let spectrum = spectrum.map_err(value_error)?;
    Ok((spectrum.step, array(py, spectrum.amplitudes)))
}

/// Kurtosis in the bands of each level.
#[pyfunction]
pub fn kurtogram<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    sampling_rate_hz: f64,
    most_levels: u32,
) -> PyResult<Vec<Array<'py>>> {
    let signal = samples(&signal)?;
    let of = py.detach(|| steps::kurtogram(signal, sampling_rate_hz, most_levels)).map_err(value_error)?;
    Ok(of.levels.into_iter().map(|level| array(py, level)).collect())
}

/// Ends of the band with the largest kurtosis, and that.
#[pyfunction]
pub fn best_band(
    levels: Vec<Vec<f64>>,
    sampling_rate_hz: f64,
    least_width_hz: f64,
) -> Option<(f64, f64, f64)> {
    let best = Kurtogram { sampling_rate_hz, levels }.best(least_width_hz)?;
    Some((best.band.from_hz, best.band.to_hz, best.kurtosis))
}

/// Spectral kurtosis.
#[pyfunction]
pub fn spectral_kurtosis<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    block_samples: usize,
) -> PyResult<Array<'py>> {
    let signal = samples(&signal)?;
    let kurtosis = py.detach(|| steps::spectral_kurtosis(signal, block_samples)).map_err(value_error)?;
    Ok(array(py, kurtosis))
}

/// The signal with all lines of its spectrum at the same amplitude.
#[pyfunction]
pub fn cepstral_prewhitening<'py>(py: Python<'py>, signal: Signal<'py>) -> PyResult<Array<'py>> {
    let signal = samples(&signal)?;
    Ok(array(py, py.detach(|| steps::cepstral_prewhitening(signal)).map_err(value_error)?))
}

/// Tones and the rest.
#[pyfunction]
pub fn discrete_random_separation<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    block_samples: usize,
    delay_samples: usize,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let signal = samples(&signal)?;
    let parts = py.detach(|| steps::discrete_random_separation(signal, block_samples, delay_samples));
    let parts = parts.map_err(value_error)?;
    Ok((array(py, parts.discrete), array(py, parts.random)))
}

/// First sample and values of the recording without the averages of all shafts.
#[pyfunction]
pub fn synchronous_residual<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phases: Vec<PyRef<'py, ShaftPhase>>,
) -> PyResult<(usize, Array<'py>)> {
    let signal = samples(&signal)?;
    let phases: Vec<steps::ShaftPhase> = phases.iter().map(|phase| phase.0.clone()).collect();
    let residual = py.detach(|| steps::synchronous_residual(signal, &phases)).map_err(value_error)?;
    Ok((residual.first_sample, array(py, residual.values)))
}

/// Rms of the velocity from 10 to 1000 Hz.
#[pyfunction]
pub fn velocity_rms(
    py: Python<'_>,
    acceleration_m_per_s2: Signal<'_>,
    sampling_rate_hz: f64,
) -> PyResult<f64> {
    let signal = samples(&acceleration_m_per_s2)?;
    py.detach(|| steps::velocity_rms(signal, sampling_rate_hz)).map_err(value_error)
}
