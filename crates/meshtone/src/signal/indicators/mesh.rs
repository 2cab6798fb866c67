//! The amplitudes of the mesh harmonics and of their sidebands.

use super::IndicatorValue;

/// Mesh harmonics that are measured: the first so many.
pub const MESH_HARMONICS: usize = 8;
/// Sidebands that are measured on each side of a mesh harmonic.
pub const MESH_SIDEBANDS: usize = 2;

/// Amplitudes of a mesh harmonic and of its sidebands, all in the signal's unit; none beyond the highest order that the signal shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct MeshHarmonic {
    /// Of the harmonic h of z teeth: `A(hz)`.
    pub amplitude: Option<f64>,
    /// Of the sidebands below it, the nearest first: `A(hz − 1)`, `A(hz − 2)`.
    pub lower_sidebands: [Option<f64>; MESH_SIDEBANDS],
    /// Of the sidebands above it, the nearest first: `A(hz + 1)`, `A(hz + 2)`.
    pub upper_sidebands: [Option<f64>; MESH_SIDEBANDS],
}

/// Amplitudes of the mesh harmonics and of their sidebands.
///
/// Wear and load change the harmonics. Damage on one tooth and eccentricity modulate the mesh once in a revolution of the wheel, which gives
/// sidebands at distances of the wheel's shaft order. Each wheel of a mesh has sidebands of its own, in the average over its own revolutions.
///
/// # Arguments
/// * `spectrum` - [`crate::signal::order_spectrum`] of an average
/// * `teeth` - of the wheel on the shaft
/// * `highest_order` - (shaft orders) beyond which the signal holds nothing
///
/// Source: P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing vibration", J. Vib. Acoust.
/// 108 (1986) 165–170.
///
/// ```
/// use meshtone::signal::{mesh_harmonics, order_spectrum};
///
/// let wave = |order: f64, i: usize| (std::f64::consts::TAU * order * i as f64 / 256.0).cos();
/// let average: Vec<f64> = (0..256).map(|i| 2.0 * wave(40.0, i) + 0.5 * wave(41.0, i)).collect();
/// let second = mesh_harmonics(&order_spectrum(&average)?, 20, 128.0)[1];
/// assert!((second.amplitude.unwrap() - 2.0).abs() < 1e-12);
/// assert!((second.upper_sidebands[0].unwrap() - 0.5).abs() < 1e-12);
/// assert!(second.lower_sidebands[0].unwrap() < 1e-12);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn mesh_harmonics(spectrum: &[f64], teeth: usize, highest_order: f64) -> [MeshHarmonic; MESH_HARMONICS] {
    let amplitude = |order: Option<usize>| {
        let order = order.filter(|order| *order as f64 <= highest_order)?;
        spectrum.get(order).copied()
    };
    std::array::from_fn(|harmonic| {
        let order = teeth.saturating_mul(harmonic + 1);
        MeshHarmonic {
            amplitude: amplitude(Some(order)),
            lower_sidebands: std::array::from_fn(|side| amplitude(order.checked_sub(side + 1))),
            upper_sidebands: std::array::from_fn(|side| amplitude(order.checked_add(side + 1))),
        }
    })
}

impl MeshHarmonic {
    /// The amplitudes as a table.
    ///
    /// # Arguments
    /// * `number` - of the harmonic, from 1
    /// * `unit` - of the signal
    pub(super) fn table(&self, number: usize, unit: &str) -> Vec<IndicatorValue> {
        let value =
            |name: String, value| IndicatorValue::new(format!("mesh_harmonic_{number}{name}"), unit, value);
        let mut all = vec![value(String::new(), self.amplitude)];
        for (sign, sidebands) in [("minus", self.lower_sidebands), ("plus", self.upper_sidebands)] {
            let named = sidebands.iter().enumerate();
            all.extend(
                named.map(|(side, &amplitude)| value(format!("_sideband_{sign}_{}", side + 1), amplitude)),
            );
        }
        all
    }
}
