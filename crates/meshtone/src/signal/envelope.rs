//! Envelope by the analytic signal.

use meshtone_fourier::{Complex64, inverse_complex, real_spectrum};

use super::SignalError;
use super::check::{check_count, check_finite};
use super::order_spectrum;

/// Analytic signal: the signal and, as its imaginary part, its Hilbert transform.
///
/// The spectrum with the positive frequencies doubled, the negative ones 0, and the mean and the Nyquist frequency as they
/// are: MATLAB's and SciPy's `hilbert`. The signal is taken to be periodic, as an average over revolutions is.
///
/// # Arguments
/// * `signal` - whole periods
///
/// # Errors
/// NaN; an empty signal.
///
/// Source: S. L. Marple, "Computing the discrete-time analytic signal via FFT", IEEE Trans. Signal Process. 47 (1999)
/// 2600–2603.
///
/// ```
/// let wave: Vec<f64> = (0..8).map(|i| (std::f64::consts::TAU * i as f64 / 8.0).cos()).collect();
/// let analytic = meshtone::signal::analytic_signal(&wave)?;
/// assert!((analytic[2].im - 1.0).abs() < 1e-15); // sin
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn analytic_signal(signal: &[f64]) -> Result<Vec<Complex64>, SignalError> {
    check_count("samples", signal.len(), 1)?;
    check_finite(signal)?;
    let len = signal.len();
    let mut spectrum = real_spectrum(signal);
    for (k, line) in spectrum.iter_mut().enumerate() {
        let images = if k == 0 || 2 * k == len { 1.0 } else { 2.0 };
        *line *= images / len as f64;
    }
    spectrum.resize(len, Complex64::default());
    Ok(inverse_complex(spectrum))
}

/// Envelope: the modulus of the analytic signal.
///
/// # Arguments
/// * `signal` - whole periods
///
/// # Errors
/// Those of [`analytic_signal`].
///
/// ```
/// use std::f64::consts::TAU;
///
/// let modulated = |t: f64| (1.0 + 0.5 * (TAU * t).cos()) * (TAU * 20.0 * t).cos();
/// let signal: Vec<f64> = (0..128).map(|i| modulated(i as f64 / 128.0)).collect();
/// let envelope = meshtone::signal::envelope(&signal)?;
/// assert!((envelope[0] - 1.5).abs() < 1e-14);
/// assert!((envelope[64] - 0.5).abs() < 1e-14);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn envelope(signal: &[f64]) -> Result<Vec<f64>, SignalError> {
    Ok(analytic_signal(signal)?.iter().map(|z| z.norm()).collect())
}

/// Envelope spectrum: [`order_spectrum`] of the envelope, its mean included as order 0.
///
/// # Arguments
/// * `signal` - whole periods; of a difference signal over one revolution the index is the shaft order
///
/// # Errors
/// Those of [`analytic_signal`].
///
/// ```
/// use std::f64::consts::TAU;
///
/// let modulated = |t: f64| (1.0 + 0.5 * (TAU * 3.0 * t).cos()) * (TAU * 20.0 * t).cos();
/// let signal: Vec<f64> = (0..128).map(|i| modulated(i as f64 / 128.0)).collect();
/// let spectrum = meshtone::signal::envelope_spectrum(&signal)?;
/// assert!((spectrum[0] - 1.0).abs() < 1e-14 && (spectrum[3] - 0.5).abs() < 1e-14);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn envelope_spectrum(signal: &[f64]) -> Result<Vec<f64>, SignalError> {
    order_spectrum(&envelope(signal)?)
}
