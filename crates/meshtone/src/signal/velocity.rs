//! Vibration velocity, as standards about machines as a whole have it.

use std::f64::consts::TAU;

use meshtone_fourier::{hann_window, real_spectrum};

use super::check::{check_channel, check_rate};
use super::spectrum::windowed;
use super::{FrequencyBand, SignalError};

/// The frequencies of [`velocity_rms`].
pub const VELOCITY_BAND: FrequencyBand = FrequencyBand { from_hz: 10.0, to_hz: 1000.0 };
/// (s) Length of a block: 40 periods of the lowest frequency.
const BLOCK_S: f64 = 4.0;
/// (s) The shortest signal: ten periods of the lowest frequency.
const SHORTEST_S: f64 = 1.0;

/// Rms of the vibration velocity from 10 to 1000 Hz, from an acceleration.
///
/// The power spectrum of the acceleration, the mean of blocks of 4 s or of the whole of a shorter signal with a Hann window, overlapping by half
/// and each without its mean, is divided by \\((2\pi f)^2\\) and summed over the lines in the band.
///
/// # Arguments
/// * `acceleration_m_per_s2` - (m/s²) the acceleration
/// * `sampling_rate_hz` - (S/s) its sampling rate, more than 2000
///
/// Returns mm/s. What is much or little for a machine, the standard's parts say; a simulated seat of a bearing is no such machine.
///
/// # Errors
/// NaN; a constant signal; a lower sampling rate; less than 1 s.
///
/// Source: ISO 20816-1:2016, which defines the quantity; the frequencies are those of most of its parts.
///
/// ```
/// // 1 m/s² at 100 Hz, and what lies outside of the band.
/// let tau = std::f64::consts::TAU;
/// let at = |hz: f64, i: usize| (tau * hz * i as f64 / 10_000.0).cos();
/// let signal: Vec<f64> = (0..20_000).map(|i| 3.0 + at(100.0, i) + 5.0 * at(2000.0, i) + 0.1 * at(2.0, i)).collect();
/// let rms = meshtone::signal::velocity_rms(&signal, 10_000.0)?;
/// assert!((rms - 1000.0 / (tau * 100.0) / 2f64.sqrt()).abs() < 1e-3);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn velocity_rms(acceleration_m_per_s2: &[f64], sampling_rate_hz: f64) -> Result<f64, SignalError> {
    check_channel(acceleration_m_per_s2)?;
    check_rate(sampling_rate_hz)?;
    let FrequencyBand { from_hz, to_hz } = VELOCITY_BAND;
    if sampling_rate_hz <= 2.0 * to_hz {
        return Err(SignalError::parameter("sampling_rate_hz", sampling_rate_hz, "more than 2000"));
    }
    let duration_s = acceleration_m_per_s2.len() as f64 / sampling_rate_hz;
    if duration_s < SHORTEST_S {
        return Err(SignalError::parameter("duration, in s,", duration_s, "at least 1"));
    }
    let length = acceleration_m_per_s2.len().min((BLOCK_S * sampling_rate_hz).round() as usize);
    let window = hann_window(length);
    let (mut square, mut blocks) = (0.0, 0.0);
    for block in acceleration_m_per_s2.windows(length).step_by(length / 2) {
        for (line, value) in real_spectrum(&windowed(block, &window)).iter().enumerate() {
            let frequency_hz = line as f64 * sampling_rate_hz / length as f64;
            if (from_hz..=to_hz).contains(&frequency_hz) {
                square += value.norm_sqr() / (TAU * frequency_hz).powi(2);
            }
        }
        blocks += 1.0;
    }
    // Each line has a mirror image; the window has a mean square of 3/8.
    Ok(1e3 * (2.0 * square / (0.375 * blocks)).sqrt() / length as f64)
}
