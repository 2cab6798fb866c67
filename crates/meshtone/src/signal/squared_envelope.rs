//! The squared envelope of a band, and its spectrum over frequency or over the orders of a shaft.

use meshtone_fourier::{Complex64, hann_window, inverse_complex, real_spectrum};

use super::check::{check_channel, check_rate};
use super::spectrum::windowed;
use super::{AngularSettings, ShaftPhase, SignalError, angular_resample};

/// A band of frequencies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrequencyBand {
    /// (Hz) Where it begins.
    pub from_hz: f64,
    /// (Hz) Where it ends.
    pub to_hz: f64,
}

/// Spectrum of a squared envelope.
#[derive(Debug, Clone, PartialEq)]
pub struct SquaredEnvelopeSpectrum {
    /// (Hz, or orders of the shaft) Distance of two lines; the first is at 0.
    pub step: f64,
    /// (unit of the signal, squared) Amplitudes: of a cosine its own, at least 0.85 of it between two lines. The mean is removed.
    pub amplitudes: Vec<f64>,
}

/// Squared envelope of a signal in a band: the square of the modulus of its analytic signal.
///
/// The lines of the spectrum outside of the band are 0, those in it have no negative frequencies.
///
/// # Arguments
/// * `signal` - (any unit) the signal
/// * `sampling_rate_hz` - (S/s) its sampling rate
/// * `band` - the band; none for all frequencies but 0
///
/// Returns a value for each sample, in the unit of the signal, squared.
///
/// # Errors
/// NaN; a constant signal; a band that is empty or reaches beyond half the sampling rate.
///
/// Source: R. B. Randall, J. Antoni, "Rolling element bearing diagnostics – a tutorial", Mech. Syst. Signal Process. 25 (2011) 485–520.
///
/// ```
/// use std::f64::consts::TAU;
/// use meshtone::signal::{FrequencyBand, squared_envelope};
///
/// let signal: Vec<f64> = (0..1000).map(|i| (TAU * 0.2 * f64::from(i)).cos() + 9.0 * (TAU * 0.01 * f64::from(i)).cos()).collect();
/// let squares = squared_envelope(&signal, 1000.0, Some(FrequencyBand { from_hz: 100.0, to_hz: 300.0 }))?;
/// assert!(squares.iter().all(|square| (square - 1.0).abs() < 1e-9));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn squared_envelope(
    signal: &[f64],
    sampling_rate_hz: f64,
    band: Option<FrequencyBand>,
) -> Result<Vec<f64>, SignalError> {
    check_channel(signal)?;
    check_rate(sampling_rate_hz)?;
    let len = signal.len();
    let band = band.unwrap_or(FrequencyBand { from_hz: 0.0, to_hz: 0.5 * sampling_rate_hz });
    // What is not a number is refused too.
    if !(band.from_hz >= 0.0 && band.from_hz < band.to_hz) {
        return Err(SignalError::parameter("from_hz of the band", band.from_hz, "from 0 to below its end"));
    }
    if band.to_hz > 0.5 * sampling_rate_hz {
        return Err(SignalError::parameter(
            "to_hz of the band",
            band.to_hz,
            "at most half the sampling rate",
        ));
    }
    let line = |hz: f64| hz * len as f64 / sampling_rate_hz;
    let mut spectrum = real_spectrum(signal);
    for (k, value) in spectrum.iter_mut().enumerate() {
        let is_inside = k > 0 && (line(band.from_hz)..=line(band.to_hz)).contains(&(k as f64));
        let images = if 2 * k == len { 1.0 } else { 2.0 };
        *value *= if is_inside { images / len as f64 } else { 0.0 };
    }
    spectrum.resize(len, Complex64::default());
    Ok(inverse_complex(spectrum).iter().map(Complex64::norm_sqr).collect())
}

/// Spectrum of the squared envelope over frequency.
///
/// # Arguments
/// As of [`squared_envelope`].
///
/// # Errors
/// Those of [`squared_envelope`].
///
/// ```
/// use std::f64::consts::TAU;
/// use meshtone::signal::squared_envelope_spectrum;
///
/// // (1 + cos)² = 3/2 + 2 cos + 1/2 cos of twice the frequency
/// let signal: Vec<f64> =
///     (0..1000).map(|i| (1.0 + (TAU * 0.03 * f64::from(i)).cos()) * (TAU * 0.2 * f64::from(i)).cos()).collect();
/// let spectrum = squared_envelope_spectrum(&signal, 1000.0, None)?;
/// assert!((spectrum.amplitudes[30] - 2.0).abs() < 1e-9 && (spectrum.amplitudes[60] - 0.5).abs() < 1e-9);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn squared_envelope_spectrum(
    signal: &[f64],
    sampling_rate_hz: f64,
    band: Option<FrequencyBand>,
) -> Result<SquaredEnvelopeSpectrum, SignalError> {
    let squares = squared_envelope(signal, sampling_rate_hz, band)?;
    Ok(SquaredEnvelopeSpectrum {
        step: sampling_rate_hz / squares.len() as f64,
        amplitudes: amplitudes(&squares),
    })
}

/// Spectrum of the squared envelope over the orders of a shaft: the band is one of frequency, since resonances stay where they are, and only the
/// squared envelope is resampled at equal angles.
///
/// # Arguments
/// * `signal`, `sampling_rate_hz`, `band` - as of [`squared_envelope`]
/// * `phase` - of the shaft
///
/// # Errors
/// Those of [`squared_envelope`] and of [`angular_resample`].
pub fn squared_envelope_order_spectrum(
    signal: &[f64],
    sampling_rate_hz: f64,
    band: Option<FrequencyBand>,
    phase: &ShaftPhase,
) -> Result<SquaredEnvelopeSpectrum, SignalError> {
    let squares = squared_envelope(signal, sampling_rate_hz, band)?;
    let angular = angular_resample(&squares, phase, &AngularSettings::default())?;
    Ok(SquaredEnvelopeSpectrum {
        step: 1.0 / angular.revolutions() as f64,
        amplitudes: amplitudes(&angular.values),
    })
}

/// Single-sided amplitudes with a Hann window, without the mean.
fn amplitudes(values: &[f64]) -> Vec<f64> {
    let len = values.len();
    // A Hann window halves the amplitude, and each line has a mirror image.
    let spectrum = real_spectrum(&windowed(values, &hann_window(len)));
    spectrum.iter().map(|line| 4.0 * line.norm() / len as f64).collect()
}
