//! A signal over the angle in octaves of mesh orders.

use std::f64::consts::SQRT_2;

use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

use super::check::check_finite;
use super::{SignalError, kurtosis};

/// (mesh orders) Middles of the octaves, names of which are `half`, `1`, `2` and so on.
pub const OCTAVES: [(&str, f64); 7] =
    [("half", 0.5), ("1", 1.0), ("2", 2.0), ("4", 4.0), ("8", 8.0), ("16", 16.0), ("32", 32.0)];

/// Content of a signal in an octave of mesh orders.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct OctaveBand {
    /// (mesh orders) Its middle: it reaches from `1/√2` to `√2` of it.
    pub middle: f64,
    /// (the signal's unit) Root mean square.
    pub rms: f64,
    /// (-) `µ₄/µ₂²`; none where there is nothing.
    pub kurtosis: Option<f64>,
}

/// A signal over one revolution in octaves of mesh orders.
///
/// Damage on one tooth rings the machine's modes, far above the mesh frequency: in one octave it may stand far above what is there
/// of a healthy gear, and drown in the rms of all.
///
/// # Arguments
/// * `values` - over one revolution, at equal angles: an average, or its difference signal
/// * `teeth` - of the wheel that turns
/// * `nyquist_order` - (shaft orders) beyond which the signal holds nothing; octaves that reach beyond are left out
///
/// Returns those of [`OCTAVES`] that the signal can show.
///
/// # Errors
/// NaN or infinity.
///
/// Source: octaves as of IEC 61260-1:2014, section 5, with the mesh frequency in place of 1 kHz.
///
/// ```
/// use std::f64::consts::TAU;
///
/// let ringing: Vec<f64> = (0..1024).map(|i| (TAU * 8.0 * 20.0 * f64::from(i) / 1024.0).sin()).collect();
/// let bands = meshtone::signal::octave_bands(&ringing, 20, 512.0)?;
/// assert_eq!(bands.iter().map(|band| band.middle).collect::<Vec<_>>(), [0.5, 1.0, 2.0, 4.0, 8.0, 16.0]);
/// assert!((bands[4].rms - 0.5f64.sqrt()).abs() < 1e-12 && bands[3].rms < 1e-12);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn octave_bands(values: &[f64], teeth: u32, nyquist_order: f64) -> Result<Vec<OctaveBand>, SignalError> {
    check_finite(values)?;
    let spectrum = real_spectrum(values);
    let highest = nyquist_order.min(values.len() as f64 / 2.0);
    let band = |middle: f64| {
        let [from, to] = [middle / SQRT_2, middle * SQRT_2].map(|order| order * f64::from(teeth));
        let lines = from.ceil() as usize..(to.ceil() as usize).min(spectrum.len());
        let mut filtered = vec![Complex64::new(0.0, 0.0); spectrum.len()];
        filtered[lines.clone()].copy_from_slice(&spectrum[lines]);
        let filtered = from_real_spectrum(filtered, values.len());
        let rms = super::rms(&filtered);
        OctaveBand { middle, rms, kurtosis: if rms > 0.0 { kurtosis(&filtered) } else { None } }
    };
    let shown = OCTAVES.iter().filter(|(_, middle)| middle * SQRT_2 * f64::from(teeth) <= highest);
    Ok(shown.map(|(_, middle)| band(*middle)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    // Parseval: the octaves of a signal that lies within them hold all of it.
    #[test]
    fn octaves_add_up() {
        let tones = [(10.0, 1.0), (17.0, 0.5), (40.0, 2.0), (111.0, 0.3)];
        let signal: Vec<f64> = (0..512)
            .map(|i| {
                tones.iter().map(|(order, size)| size * (TAU * order * f64::from(i) / 512.0).cos()).sum()
            })
            .collect();
        let bands = octave_bands(&signal, 17, 256.0).unwrap();
        let squares: f64 = bands.iter().map(|band| band.rms * band.rms).sum();
        assert!((squares - crate::signal::rms(&signal).powi(2)).abs() < 1e-12);
        // 10 lies in the octave below the mesh order, 111 in that of 8.
        assert!((bands[0].rms - 0.5f64.sqrt()).abs() < 1e-12);
        assert!((bands[4].rms - 0.3 * 0.5f64.sqrt()).abs() < 1e-12);
        assert!((bands[1].kurtosis.unwrap() - 1.5).abs() < 1e-9);
    }

    #[test]
    fn only_octaves_that_the_sampling_shows() {
        assert_eq!(octave_bands(&[1.0, -1.0, 0.5, 0.0], 17, 2.0).unwrap(), []);
        let silent = octave_bands(&[0.0; 128], 17, 30.0).unwrap();
        assert_eq!((silent.len(), silent[0].kurtosis), (2, None));
        assert!(octave_bands(&[f64::NAN; 8], 2, 4.0).is_err());
    }
}
