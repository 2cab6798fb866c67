//! Amplitudes of the orders of a shaft.

use super::SignalError;
use super::check::{check_count, check_finite};
use meshtone_fourier::real_spectrum;

/// Values without their mean, behind a window of as many.
pub(super) fn windowed(values: &[f64], window: &[f64]) -> Vec<f64> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter().zip(window).map(|(value, window)| window * (value - mean)).collect()
}

/// Single-sided amplitude spectrum of one revolution: the amplitude of every order.
///
/// With `X_k = Σ x_n e^(−2πikn/N)` the value of order k = 0 … ⌊N/2⌋ is `2|X_k|/N`, except for the mean,
/// `|X_0|/N`, and, for even N, the Nyquist order, `|X_{N/2}|/N`, which have no mirror image. So a cosine of amplitude A
/// shows as A; no window is used, since an average is periodic.
///
/// # Arguments
/// * `average` - one revolution at equal angles
///
/// Returns the amplitude at index = order, in the unit of the signal.
///
/// # Errors
/// NaN; an empty signal.
///
/// ```
/// let amplitude = meshtone::signal::order_spectrum(&[3.0, 0.0, -1.0, 0.0])?;
/// assert_eq!(amplitude, [0.5, 2.0, 0.5]); // 1/2 + 2 cos + 1/2 cos 2
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn order_spectrum(average: &[f64]) -> Result<Vec<f64>, SignalError> {
    check_count("values of an average", average.len(), 1)?;
    check_finite(average)?;
    let len = average.len();
    let amplitude = |(order, line): (usize, &meshtone_fourier::Complex64)| {
        let images = if order == 0 || 2 * order == len { 1.0 } else { 2.0 };
        images * line.norm() / len as f64
    };
    Ok(real_spectrum(average).iter().enumerate().map(amplitude).collect())
}
