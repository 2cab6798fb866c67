//! A check that a channel can be processed.

use std::ops::RangeInclusive;

use super::{SignalError, peak};

/// Size up to which all powers of a sample that indicators take are numbers; no unit makes more of a vibration.
const LARGEST: f64 = 1e35;
/// Size of the largest sample from which they are.
const LEAST_PEAK: f64 = 1e-35;

/// (S/s) Sampling rates that a recording may have.
pub const SAMPLING_RATES_HZ: RangeInclusive<f64> = 1e-6..=1e12;

/// Checks that a channel holds a vibration.
///
/// # Arguments
/// * `signal` - the channel
///
/// # Errors
/// NaN or infinity, with the first position; a constant channel; fewer than two samples; a largest sample below 1e-35 or above 1e35.
///
/// ```
/// use meshtone::signal::{SignalError, check_channel};
///
/// assert!(check_channel(&[0.0, 1.0]).is_ok());
/// assert_eq!(check_channel(&[2.0; 9]), Err(SignalError::Constant { value: 2.0, samples: 9 }));
/// ```
pub fn check_channel(signal: &[f64]) -> Result<(), SignalError> {
    check_count("samples", signal.len(), 2)?;
    check_finite(signal)?;
    if signal.iter().all(|&x| x == signal[0]) {
        return Err(SignalError::Constant { value: signal[0], samples: signal.len() });
    }
    match peak(signal) {
        peak if peak >= LEAST_PEAK => Ok(()),
        peak => Err(SignalError::parameter("the largest sample", peak, "at least 1e-35: use another unit")),
    }
}

/// Checks that a sampling rate is one of a recording.
pub(super) fn check_rate(rate_hz: f64) -> Result<(), SignalError> {
    match SAMPLING_RATES_HZ.contains(&rate_hz) {
        true => Ok(()),
        false => Err(SignalError::parameter("sampling_rate_hz", rate_hz, "from 1e-6 to 1e12 S/s")),
    }
}

/// Checks that there are enough of something.
pub(super) fn check_count(what: &'static str, given: usize, needed: usize) -> Result<(), SignalError> {
    if given < needed { Err(SignalError::TooFew { what, given, needed }) } else { Ok(()) }
}

/// Checks that something is as long as it must be.
pub(super) fn check_length(what: &'static str, given: usize, expected: usize) -> Result<(), SignalError> {
    if given == expected { Ok(()) } else { Err(SignalError::LengthMismatch { what, given, expected }) }
}

/// Checks that there are teeth, and that the mesh order is not beyond the Nyquist order.
pub(super) fn check_mesh_order(teeth: usize, nyquist_order: f64) -> Result<(), SignalError> {
    let mesh_order = teeth as f64;
    if teeth == 0 {
        return Err(SignalError::parameter("teeth", 0.0, "at least 1"));
    }
    if mesh_order > nyquist_order {
        return Err(SignalError::MeshOrderBeyondNyquist { mesh_order, nyquist_order });
    }
    Ok(())
}

/// Checks that every value is a number, and none beyond all units.
pub(super) fn check_finite(signal: &[f64]) -> Result<(), SignalError> {
    // All of them first, many at a time: hardly any signal has to be searched.
    if signal.iter().fold(true, |small, x| small & (x.abs() <= LARGEST)) {
        return Ok(());
    }
    let Some(sample) = signal.iter().position(|x| !x.is_finite()) else {
        return Err(SignalError::parameter(
            "the largest sample",
            peak(signal),
            "at most 1e35: use another unit",
        ));
    };
    let count = signal.iter().filter(|x| !x.is_finite()).count();
    Err(SignalError::NotFinite { sample, value: signal[sample], count, samples: signal.len() })
}

/// Checks that a number is finite and more than 0.
pub(super) fn check_positive(name: &'static str, value: f64) -> Result<(), SignalError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(SignalError::parameter(name, value, "a number more than 0"))
    }
}
