//! The steps of the chain, one by one.

use meshtone::signal::{
    self as steps, AngularSettings, AngularSignal, Edge, Interpolation, OrderMapSettings,
};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::array::{Array, Signal, array, matrix, samples};
use crate::error::value_error;
use crate::phase::ShaftPhase;
use crate::process::separation;

/// Another sampling rate.
#[pyfunction]
pub fn resample<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    from_hz: f64,
    to_hz: f64,
    edge: &str,
) -> PyResult<Array<'py>> {
    let edge = match edge {
        "zero" => Edge::Zero,
        "reflect" => Edge::Reflect,
        "periodic" => Edge::Periodic,
        _ => return Err(value_error(format!("edge = '{edge}': must be 'zero', 'reflect' or 'periodic'"))),
    };
    let signal = samples(&signal)?;
    let resampled = py.detach(|| steps::resample_to(signal, from_hz, to_hz, edge));
    Ok(array(py, resampled.map_err(value_error)?))
}

/// A signal over whole revolutions: values, points in a revolution, angle of the first, Nyquist order.
#[pyfunction]
pub fn angular_resample<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phase: &ShaftPhase,
    points_per_revolution: Option<usize>,
    interpolation: &str,
) -> PyResult<(Array<'py>, usize, f64, f64)> {
    let interpolation = match interpolation {
        "band-limited" => Interpolation::BandLimited,
        "pchip" => Interpolation::Pchip,
        _ => {
            return Err(value_error(format!(
                "interpolation = '{interpolation}': must be 'band-limited' or 'pchip'"
            )));
        }
    };
    let settings = AngularSettings { points_per_revolution, interpolation, ..AngularSettings::default() };
    let signal = samples(&signal)?;
    let angular = py.detach(|| steps::angular_resample(signal, &phase.0, &settings)).map_err(value_error)?;
    Ok((array(py, angular.values), angular.points_per_revolution, angular.start_rev, angular.nyquist_order))
}

/// Order spectra of parts of a recording: length of the parts in revolutions, times and speeds of the parts, amplitudes.
#[pyfunction]
pub fn order_map<'py>(
    py: Python<'py>,
    signal: Signal<'py>,
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
    revolutions: Option<usize>,
    highest_order: Option<f64>,
) -> PyResult<(usize, Array<'py>, Array<'py>, Bound<'py, PyArray2<f64>>)> {
    let settings = OrderMapSettings { revolutions, highest_order };
    let signal = samples(&signal)?;
    let map = py.detach(|| steps::order_map(signal, &phase.0, sampling_rate_hz, &settings));
    let map = map.map_err(value_error)?;
    let shape = [map.amplitudes.len(), map.amplitudes.first().map_or(0, Vec::len)];
    let amplitudes = matrix(py, map.amplitudes.concat(), shape)?;
    Ok((map.revolutions, array(py, map.times_s), array(py, map.speeds_hz), amplitudes))
}

/// Average over the revolutions of a signal at equal angles.
#[pyfunction]
pub fn synchronous_average<'py>(
    py: Python<'py>,
    values: Signal<'py>,
    points_per_revolution: usize,
) -> PyResult<Array<'py>> {
    let angular = AngularSignal {
        points_per_revolution,
        start_rev: 0.0,
        nyquist_order: points_per_revolution as f64 / 2.0,
        values: samples(&values)?.to_vec(),
    };
    Ok(array(py, steps::synchronous_average(&angular).map_err(value_error)?.values))
}

/// Regular part, residual and difference of an average.
#[pyfunction]
pub fn separate<'py>(
    py: Python<'py>,
    average: Signal<'py>,
    teeth: usize,
    sidebands: Option<usize>,
    shaft_orders: Option<Vec<usize>>,
) -> PyResult<(Array<'py>, Array<'py>, Array<'py>)> {
    let settings = separation(teeth, sidebands, shaft_orders);
    let parts = steps::separate(samples(&average)?, &settings).map_err(value_error)?;
    Ok((array(py, parts.regular), array(py, parts.residual), array(py, parts.difference)))
}

/// Amplitude of the analytic signal.
#[pyfunction]
pub fn envelope<'py>(py: Python<'py>, signal: Signal<'py>) -> PyResult<Array<'py>> {
    Ok(array(py, steps::envelope(samples(&signal)?).map_err(value_error)?))
}

/// Spectrum of the envelope.
#[pyfunction]
pub fn envelope_spectrum<'py>(py: Python<'py>, signal: Signal<'py>) -> PyResult<Array<'py>> {
    Ok(array(py, steps::envelope_spectrum(samples(&signal)?).map_err(value_error)?))
}

/// Amplitude at each order.
#[pyfunction]
pub fn order_spectrum<'py>(py: Python<'py>, average: Signal<'py>) -> PyResult<Array<'py>> {
    Ok(array(py, steps::order_spectrum(samples(&average)?).map_err(value_error)?))
}

/// Peak-to-peak over the mesh harmonics.
#[pyfunction]
pub fn fm0(average: Signal<'_>, teeth: usize) -> PyResult<f64> {
    let average = samples(&average)?;
    let spectrum = steps::order_spectrum(average).map_err(value_error)?;
    Ok(defined(steps::fm0(average, &spectrum, teeth).map_err(value_error)?))
}

/// Standardised fourth moment.
#[pyfunction]
pub fn fm4(difference: Signal<'_>) -> PyResult<f64> {
    Ok(defined(steps::fm4(samples(&difference)?)))
}

/// Standardised sixth moment.
#[pyfunction]
pub fn m6a(difference: Signal<'_>) -> PyResult<f64> {
    Ok(defined(steps::m6a(samples(&difference)?)))
}

/// Standardised eighth moment.
#[pyfunction]
pub fn m8a(difference: Signal<'_>) -> PyResult<f64> {
    Ok(defined(steps::m8a(samples(&difference)?)))
}

/// NA4 of each record of a series.
#[pyfunction]
pub fn na4<'py>(py: Python<'py>, residuals: Vec<Signal<'py>>) -> PyResult<Array<'py>> {
    let residuals = residuals.iter().map(samples).collect::<PyResult<Vec<_>>>()?;
    let values = steps::na4(&residuals).map_err(value_error)?;
    Ok(array(py, values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect()))
}

/// Standard deviation of the difference over that of the regular part.
#[pyfunction]
pub fn energy_ratio(difference: Signal<'_>, regular: Signal<'_>) -> PyResult<f64> {
    Ok(defined(steps::energy_ratio(samples(&difference)?, samples(&regular)?)))
}

/// First sidebands of the mesh order over the average's standard deviation.
#[pyfunction]
pub fn sideband_level_factor(average: Signal<'_>, teeth: usize) -> PyResult<f64> {
    let average = samples(&average)?;
    let spectrum = steps::order_spectrum(average).map_err(value_error)?;
    Ok(defined(steps::sideband_level_factor(average, &spectrum, teeth).map_err(value_error)?))
}

/// Rms and the like of a signal, by name.
#[pyfunction]
pub fn statistics<'py>(py: Python<'py>, signal: Signal<'py>) -> PyResult<Bound<'py, PyDict>> {
    let signal = samples(&signal)?;
    steps::check_channel(signal).map_err(value_error)?;
    let all = [
        ("rms", Some(steps::rms(signal))),
        ("peak_to_peak", Some(steps::peak_to_peak(signal))),
        ("crest_factor", steps::crest_factor(signal)),
        ("skewness", steps::skewness(signal)),
        ("kurtosis", steps::kurtosis(signal)),
    ];
    all.map(|(name, value)| (name, defined(value))).into_py_dict(py)
}

/// NaN where there is no value.
fn defined(value: Option<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}
