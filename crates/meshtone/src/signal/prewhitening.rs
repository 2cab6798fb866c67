//! Cepstral prewhitening.

use meshtone_fourier::{from_real_spectrum, real_spectrum};

use super::SignalError;
use super::check::check_channel;

/// (-) Lines of the spectrum below this part of the largest are rounding and are left out.
const ROUNDING: f64 = 1e-13;

/// Cepstral prewhitening: the signal with all lines of its spectrum at the same amplitude and with their own phases.
///
/// That is the signal whose real cepstrum is 0 but for its first value: tones and resonances of the path disappear, and impulses stand out of the
/// noise. The speed is not needed.
///
/// # Arguments
/// * `signal` - (any unit) the signal
///
/// Returns (-) as many values, with an rms of 1.
///
/// # Errors
/// NaN; a constant signal.
///
/// Source: P. Borghesani, P. Pennacchi, R. B. Randall, N. Sawalhi, R. Ricci, "Application of cepstrum pre-whitening for the diagnosis of bearing
/// faults under variable speed conditions", Mech. Syst. Signal Process. 36 (2013) 370–384.
///
/// ```
/// let signal: Vec<f64> = (0..64).map(|i| if i == 9 { 1.0 } else { 0.3 * (0.7 * f64::from(i)).cos() }).collect();
/// let white = meshtone::signal::cepstral_prewhitening(&signal)?;
/// let spectrum = meshtone::signal::order_spectrum(&white)?;
/// assert!(spectrum[1..32].iter().all(|line| (line - spectrum[1]).abs() < 1e-12));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn cepstral_prewhitening(signal: &[f64]) -> Result<Vec<f64>, SignalError> {
    check_channel(signal)?;
    let mut spectrum = real_spectrum(signal);
    let least = ROUNDING * spectrum.iter().map(|line| line.norm()).fold(0.0, f64::max);
    for line in &mut spectrum {
        let size = line.norm();
        *line = if size > least { *line / size } else { Default::default() };
    }
    let mut white = from_real_spectrum(spectrum, signal.len());
    let rms = super::rms(&white);
    white.iter_mut().for_each(|value| *value /= rms);
    Ok(white)
}
