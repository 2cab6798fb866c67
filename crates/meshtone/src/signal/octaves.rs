//! A signal over the angle in octaves of mesh orders.

use std::f64::consts::SQRT_2;

use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

use super::check::check_finite;
use super::{SignalError, kurtosis};

/// (mesh orders) Middles of the octaves, names of which are `half`, `1`, `2` and so on.
pub const OCTAVES: [(&str, f64); 7] =
    [("half", 0.5), ("1", 1.0), ("2", 2.0), ("4", 4.0), ("8", 8.0), ("16", 16.0), ("32", 32.0)];

/// Content of a signal in an octave of mesh orders.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
/// * `highest_order` - (shaft orders) beyond which the signal holds nothing
///
/// Returns a band for each of [`OCTAVES`]; none for those that reach beyond the highest order.
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
/// let rms = bands.map(|band| band.map(|band| band.rms));
/// assert!((rms[4].unwrap() - 0.5f64.sqrt()).abs() < 1e-12 && rms[3].unwrap() < 1e-12);
/// assert_eq!(rms[6], None); // 32 mesh orders are beyond
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn octave_bands(
    values: &[f64],
    teeth: usize,
    highest_order: f64,
) -> Result<[Option<OctaveBand>; OCTAVES.len()], SignalError> {
    check_finite(values)?;
    let spectrum = real_spectrum(values);
    let highest = highest_order.min(values.len() as f64 / 2.0);
    let band = |middle: f64| {
        let [from, to] = [middle / SQRT_2, middle * SQRT_2].map(|order| order * teeth as f64);
        let lines = from.ceil() as usize..(to.ceil() as usize).min(spectrum.len());
        let mut filtered = vec![Complex64::new(0.0, 0.0); spectrum.len()];
        filtered[lines.clone()].copy_from_slice(&spectrum[lines]);
        let filtered = from_real_spectrum(filtered, values.len());
        let rms = super::rms(&filtered);
        OctaveBand { middle, rms, kurtosis: if rms > 0.0 { kurtosis(&filtered) } else { None } }
    };
    let is_shown = |middle: f64| middle * SQRT_2 * teeth as f64 <= highest;
    Ok(OCTAVES.map(|(_, middle)| is_shown(middle).then(|| band(middle))))
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
        let bands = octave_bands(&signal, 17, 256.0).unwrap().map(|band| band.unwrap_or_default());
        let squares: f64 = bands.iter().map(|band| band.rms * band.rms).sum();
        assert!((squares - crate::signal::rms(&signal).powi(2)).abs() < 1e-12);
        // 10 lies in the octave below the mesh order, 111 in that of 8.
        assert!((bands[0].rms - 0.5f64.sqrt()).abs() < 1e-12);
        assert!((bands[4].rms - 0.3 * 0.5f64.sqrt()).abs() < 1e-12);
        assert!((bands[1].kurtosis.unwrap() - 1.5).abs() < 1e-9);
    }

    #[test]
    fn only_octaves_that_the_sampling_shows() {
        assert_eq!(octave_bands(&[1.0, -1.0, 0.5, 0.0], 17, 2.0).unwrap(), [None; OCTAVES.len()]);
        let silent = octave_bands(&[0.0; 128], 17, 30.0).unwrap();
        assert_eq!(silent.iter().flatten().count(), 2);
        assert_eq!(silent[0].and_then(|band| band.kurtosis), None);
        assert!(octave_bands(&[f64::NAN; 8], 2, 4.0).is_err());
    }
}
