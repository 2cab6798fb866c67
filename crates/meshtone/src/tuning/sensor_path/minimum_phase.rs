//! The phase that belongs to a magnitude.

use meshtone_fourier::{Complex64, convenient_length, from_real_spectrum, real_spectrum};

use crate::interpolation::straight_between;

/// (-) How far the magnitude is continued beyond its last frequency, where it stays: the phase below then knows of no end.
const CONTINUED: f64 = 4.0;
/// Most lines of the spectrum by which the phase is found.
const MOST_LINES: usize = 1 << 18;

/// (°) Phase of least delay of a system of this magnitude: the Hilbert transform of its logarithm, by the cepstrum.
///
/// Source: A. V. Oppenheim, R. W. Schafer, *Discrete-Time Signal Processing*, 3rd edition (2010), section 13.5.
///
/// # Arguments
/// * `frequency_hz` - (Hz) rising, the last not 0
/// * `magnitude_db` - (dB) at those; straight between them, the same outside
pub(super) fn minimum_phase_deg(frequency_hz: &[f64], magnitude_db: &[f64]) -> Vec<f64> {
    let last_hz = frequency_hz.last().copied().unwrap_or(1.0);
    let steps = frequency_hz.windows(2).map(|pair| pair[1] - pair[0]);
    let step_hz = steps.fold(f64::INFINITY, f64::min) / 2.0;
    let lines = ((CONTINUED * last_hz / step_hz) as usize).clamp(16, MOST_LINES);
    let length = convenient_length(2 * lines);
    let step_hz = CONTINUED * last_hz / (length / 2) as f64;
    let logarithm = |line: usize| {
        let db = straight_between(frequency_hz, magnitude_db, line as f64 * step_hz);
        Complex64::new(db * std::f64::consts::LN_10 / 20.0, 0.0)
    };
    let mut cepstrum = from_real_spectrum((0..=length / 2).map(logarithm).collect(), length);
    // What comes before time 0 is folded to after it: the even part of a causal cepstrum becomes all of it.
    cepstrum[1..length / 2].iter_mut().for_each(|value| *value *= 2.0);
    cepstrum[length / 2 + 1..].fill(0.0);
    let phase_deg: Vec<f64> =
        real_spectrum(&cepstrum).into_iter().map(|value| value.im.to_degrees()).collect();
    let line_hz: Vec<f64> = (0..phase_deg.len()).map(|line| line as f64 * step_hz).collect();
    frequency_hz.iter().map(|&hz| straight_between(&line_hz, &phase_deg, hz)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `H = 1 + Σ …` of a damped resonance, whose phase is known: all its poles and zeros are on the stable side.
    #[test]
    fn the_phase_of_a_resonance_is_the_closed_form() {
        let (resonance_hz, damping_ratio) = (2000.0, 0.05);
        let response = |hz: f64| {
            let ratio = hz / resonance_hz;
            let resonance = Complex64::new(1.0 - ratio * ratio, 2.0 * damping_ratio * ratio);
            Complex64::ONE + 0.5 * ratio * ratio / resonance
        };
        let frequency_hz: Vec<f64> = (0..2000).map(|line| 10.0 * f64::from(line)).collect();
        let magnitude_db: Vec<f64> =
            frequency_hz.iter().map(|&hz| 20.0 * response(hz).norm().log10()).collect();
        let phase_deg = minimum_phase_deg(&frequency_hz, &magnitude_db);
        for (&hz, phase_deg) in frequency_hz.iter().zip(&phase_deg).filter(|(hz, _)| **hz < 10_000.0) {
            let expected_deg = response(hz).arg().to_degrees();
            assert!((phase_deg - expected_deg).abs() < 1.0, "{hz} Hz: {phase_deg} of {expected_deg}");
        }
    }
}
