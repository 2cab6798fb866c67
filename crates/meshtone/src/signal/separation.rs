//! The parts of an average.

use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum};

use super::SignalError;
use super::check::{check_finite, check_mesh_order};

/// The orders that belong to the regular part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SeparationSettings {
    /// Teeth of the wheel on the shaft: the mesh order.
    pub teeth: usize,
    /// Teeth of other wheels on the same shaft, whose mesh orders belong to the regular part as well. Default none.
    pub other_teeth: Vec<usize>,
    /// Sidebands on each side of every mesh harmonic that belong to the regular part. Default 2.
    pub sidebands: usize,
    /// Orders of the shaft that belong to it. Default 1 to 7.
    pub shaft_orders: Vec<usize>,
    /// Treatment of the mean.
    pub mean: MeanPart,
}

/// Part to which order 0, the mean, belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MeanPart {
    /// To the residual and the difference, as in the published code. No indicator but the rms sees it.
    #[default]
    Kept,
    /// To the regular part.
    Removed,
}

impl SeparationSettings {
    /// Two sidebands and the shaft orders 1 to 7, as the paper's experiments have it; the mean is kept.
    ///
    /// # Arguments
    /// * `teeth` - of the wheel on the shaft
    pub fn new(teeth: usize) -> Self {
        Self {
            teeth,
            other_teeth: Vec::new(),
            sidebands: 2,
            shaft_orders: (1..=7).collect(),
            mean: MeanPart::Kept,
        }
    }

    /// Teeth of all wheels on the shaft.
    fn all_teeth(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.teeth).chain(self.other_teeth.iter().copied())
    }
}

/// An average, taken apart.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Separation {
    /// Shaft orders and mesh harmonics with their sidebands: what a sound wheel shows.
    pub regular: Vec<f64>,
    /// The average without the mesh harmonics and the shaft orders; the sidebands stay.
    pub residual: Vec<f64>,
    /// The average without the regular part: what is left for faults.
    pub difference: Vec<f64>,
}

/// Takes an average apart in the order domain.
///
/// With z teeth, n sidebands and the Nyquist order `N/2` of N values:
/// * the mesh orders are `z, 2z, …` up to the Nyquist order, and those of other wheels on the shaft;
/// * *regular* are the shaft orders and, of every mesh order m, `m − n … m + n`;
/// * *residual* = average − mesh orders − shaft orders;
/// * *difference* = average − regular.
///
/// The lines of an order are taken or left as they are, without a window: the average is periodic. A mesh harmonic beyond the
/// Nyquist order takes nothing with it, nor do its sidebands below, as in the published code.
///
/// # Arguments
/// * `average` - one revolution at equal angles
/// * `settings` - what is regular
///
/// # Errors
/// NaN; no teeth; a mesh order beyond the Nyquist order; so many sidebands that those of neighbouring mesh orders meet.
///
/// Sources: P. D. McFadden, "Detecting fatigue cracks in gears by amplitude and phase demodulation of the meshing
/// vibration", J. Vib. Acoust. 108 (1986) 165–170; J. J. Zakrajsek, D. P. Townsend, H. J. Decker, NASA TM-105950 (1993).
///
/// ```
/// use meshtone::signal::{SeparationSettings, separate};
///
/// let wave = |order: f64, i: usize| (std::f64::consts::TAU * order * i as f64 / 256.0).cos();
/// let average: Vec<f64> = (0..256).map(|i| wave(1.0, i) + wave(20.0, i) + wave(21.0, i) + wave(28.0, i)).collect();
/// let parts = separate(&average, &SeparationSettings::new(20))?;
/// for i in 0..256 {
///     assert!((parts.difference[i] - wave(28.0, i)).abs() < 1e-12);
///     assert!((parts.residual[i] - wave(28.0, i) - wave(21.0, i)).abs() < 1e-12);
/// }
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn separate(average: &[f64], settings: &SeparationSettings) -> Result<Separation, SignalError> {
    check_finite(average)?;
    check_settings(average.len(), settings)?;
    let spectrum = real_spectrum(average);
    let last = average.len() / 2;
    let mesh_orders = settings.all_teeth().flat_map(|teeth| (teeth..=last).step_by(teeth));
    let mut low = vec![false; last + 1];
    for &order in settings.shaft_orders.iter().filter(|&&order| order <= last) {
        low[order] = true;
    }
    low[0] = settings.mean == MeanPart::Removed;
    let mut meshing = low.clone();
    let mut regular = low;
    for order in mesh_orders {
        meshing[order] = true;
        regular[order - settings.sidebands..=(order + settings.sidebands).min(last)].fill(true);
    }
    let part = |belongs: &dyn Fn(usize) -> bool| {
        let chosen = |(order, &line)| if belongs(order) { line } else { Complex64::default() };
        from_real_spectrum(spectrum.iter().enumerate().map(chosen).collect(), average.len())
    };
    Ok(Separation {
        regular: part(&|order| regular[order]),
        residual: part(&|order| !meshing[order]),
        difference: part(&|order| !regular[order]),
    })
}

fn check_settings(points: usize, settings: &SeparationSettings) -> Result<(), SignalError> {
    check_mesh_order(settings.teeth, points as f64 / 2.0)?;
    for teeth in settings.all_teeth() {
        // All orders would be regular.
        if settings.sidebands.saturating_mul(2).saturating_add(1) >= teeth {
            let allowed = "less than half the teeth minus one";
            return Err(SignalError::parameter("sidebands", settings.sidebands as f64, allowed));
        }
    }
    Ok(())
}
