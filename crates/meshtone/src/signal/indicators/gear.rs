//! The gear metrics, by their usual names.

use crate::signal::check::check_mesh_order;
use crate::signal::{SignalError, peak_to_peak, standard_deviation, standardised_moment};

/// FM0: peak to peak of the average over the sum of the mesh harmonics' amplitudes, `(max x − min x)/Σ_h A(hz)`, h from 1
/// up to the Nyquist order.
///
/// It rises with a single tooth's fault (more peak) and with wear of all teeth (less mesh).
///
/// # Arguments
/// * `average` - one revolution at equal angles
/// * `spectrum` - its [`crate::signal::order_spectrum`]
/// * `teeth` - of the wheel on the shaft
///
/// None where there is no mesh.
///
/// # Errors
/// No teeth; a mesh order beyond the Nyquist order.
///
/// Source: R. M. Stewart, "Some useful data analysis techniques for gearbox diagnostics", ISVR report MHM/R/10/77,
/// University of Southampton (1977).
///
/// ```
/// use meshtone::signal::{fm0, order_spectrum};
///
/// let average: Vec<f64> = (0..40).map(|i| (std::f64::consts::TAU * i as f64 / 4.0).cos()).collect();
/// let ratio = fm0(&average, &order_spectrum(&average)?, 10)?;
/// assert!((ratio.unwrap() - 2.0).abs() < 1e-13);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn fm0(average: &[f64], spectrum: &[f64], teeth: usize) -> Result<Option<f64>, SignalError> {
    check_mesh_order(teeth, spectrum.len().saturating_sub(1) as f64)?;
    let mesh: f64 = spectrum.iter().skip(teeth).step_by(teeth).sum();
    Ok(ratio(peak_to_peak(average), mesh))
}

/// FM4: kurtosis of the difference, `µ₄/µ₂²`; 3 where it is noise, more where a fault stands out.
///
/// # Arguments
/// * `difference` - from [`crate::signal::separate`]
///
/// None where the difference is 0.
///
/// Source: as [`fm0`].
///
/// ```
/// assert_eq!(meshtone::signal::fm4(&[1.0, -1.0, 1.0, -1.0]), Some(1.0));
/// ```
pub fn fm4(difference: &[f64]) -> Option<f64> {
    standardised_moment(difference, 4)
}

/// M6A: `µ₆/µ₂³` of the difference; 15 for Gaussian noise. More sensitive to peaks than FM4.
///
/// # Arguments
/// * `difference` - from [`crate::signal::separate`]
///
/// None where the difference is 0.
///
/// Source: H. R. Martin, "Statistical moment analysis as a means of surface damage detection", Proc. 7th International Modal
/// Analysis Conference (1989) 1016–1021.
///
/// ```
/// assert_eq!(meshtone::signal::m6a(&[1.0, -1.0, 1.0, -1.0]), Some(1.0));
/// ```
pub fn m6a(difference: &[f64]) -> Option<f64> {
    standardised_moment(difference, 6)
}

/// M8A: `µ₈/µ₂⁴` of the difference; 105 for Gaussian noise.
///
/// # Arguments
/// * `difference` - from [`crate::signal::separate`]
///
/// None where the difference is 0.
///
/// Source: as [`m6a`].
///
/// ```
/// assert_eq!(meshtone::signal::m8a(&[1.0, -1.0, 1.0, -1.0]), Some(1.0));
/// ```
pub fn m8a(difference: &[f64]) -> Option<f64> {
    standardised_moment(difference, 8)
}

/// Energy ratio: standard deviation of the difference over that of the regular part.
///
/// # Arguments
/// * `difference`, `regular` - from [`crate::signal::separate`]
///
/// None where the regular part is 0.
///
/// Source: N. S. Swansson, "Application of vibration signal analysis techniques to signal monitoring", Conference on Friction
/// and Wear in Engineering, Institution of Engineers, Australia (1980) 262–267.
///
/// ```
/// assert_eq!(meshtone::signal::energy_ratio(&[1.0, -1.0], &[4.0, -4.0]), Some(0.25));
/// ```
pub fn energy_ratio(difference: &[f64], regular: &[f64]) -> Option<f64> {
    ratio(standard_deviation(difference), standard_deviation(regular))
}

/// Sideband level factor: the two first-order sidebands of the fundamental mesh order over the average's standard deviation,
/// `(A(z − 1) + A(z + 1))/σ`.
///
/// # Arguments
/// * `average` - one revolution at equal angles
/// * `spectrum` - its [`crate::signal::order_spectrum`]
/// * `teeth` - of the wheel on the shaft
///
/// A sideband beyond the Nyquist order counts as 0. None where the average is constant.
///
/// # Errors
/// Those of [`fm0`].
///
/// Source: P. Večeř, M. Kreidl, R. Šmíd, "Condition indicators for gearbox condition monitoring systems", Acta Polytechnica
/// 45(6) (2005) 35–43.
///
/// ```
/// use meshtone::signal::{order_spectrum, sideband_level_factor};
///
/// let wave = |i: usize| (std::f64::consts::TAU * 9.0 * i as f64 / 40.0).cos();
/// let average: Vec<f64> = (0..40).map(wave).collect();
/// let factor = sideband_level_factor(&average, &order_spectrum(&average)?, 10)?;
/// assert!((factor.unwrap() - 2f64.sqrt()).abs() < 1e-13);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn sideband_level_factor(
    average: &[f64],
    spectrum: &[f64],
    teeth: usize,
) -> Result<Option<f64>, SignalError> {
    check_mesh_order(teeth, spectrum.len().saturating_sub(1) as f64)?;
    let amplitude = |order: usize| spectrum.get(order).copied().unwrap_or(0.0);
    Ok(ratio(amplitude(teeth - 1) + amplitude(teeth + 1), standard_deviation(average)))
}

fn ratio(numerator: f64, denominator: f64) -> Option<f64> {
    (denominator > 0.0).then(|| numerator / denominator)
}
