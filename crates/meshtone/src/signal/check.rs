//! A check that a channel can be processed.

use super::SignalError;

/// Checks that a channel holds a vibration.
///
/// # Arguments
/// * `signal` - the channel
///
/// # Errors
/// NaN or infinity, with the first position; a constant channel; fewer than two samples.
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
    Ok(())
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

/// Checks that every value is a number.
pub(super) fn check_finite(signal: &[f64]) -> Result<(), SignalError> {
    // All of them first, many at a time: hardly any signal has to be searched.
    if signal.iter().fold(true, |finite, x| finite & x.is_finite()) {
        return Ok(());
    }
    let sample = signal.iter().position(|x| !x.is_finite()).unwrap_or(0);
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
