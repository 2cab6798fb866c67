//! The three modifications of a difference signal, each on one cycle.

use super::HybridError;
use crate::random::{Draws, Purpose};
use crate::signal::{Edge, interpolate_band_limited, rms};

/// Changes the duration of a fault's response.
///
/// A ratio below 1 takes the central part of the cycle and stretches it to the cycle's length: the response lasts longer, by
/// the reciprocal of the ratio. A ratio above 1 pads the cycle with zeros on both sides and shrinks it: the response
/// becomes shorter. The number of values stays.
///
/// # Arguments
/// * `signal` - one cycle at equal angles
/// * `width_ratio` - (-) the fraction of the cycle that is stretched to the cycle, above 0
/// * `centre_rev` - (rev) where the fault's response is; it comes to lie in the middle
///
/// # Errors
/// NaN, fewer than 4 values, a ratio that is not above 0 and finite, a centre that is not finite.
///
/// Source: section 5 of arXiv:2410.05073, "signal duration modification". Between the values the signal is
/// read by [`interpolate_band_limited`]; the paper does not say how it interpolates.
///
/// ```
/// use meshtone::tuning::change_duration;
///
/// // A response of 10 values around the place 0.25 of 400.
/// let signal: Vec<f64> = (0..400).map(|i| f64::from((95..105).contains(&i))).collect();
/// let stretched = change_duration(&signal, 0.2, 0.25)?;
/// let long = stretched.iter().filter(|&&x| x > 0.5).count();
/// assert!((48..=52).contains(&long));
/// assert!(stretched[200] > 0.5); // in the middle
/// # Ok::<(), meshtone::tuning::HybridError>(())
/// ```
pub fn change_duration(signal: &[f64], width_ratio: f64, centre_rev: f64) -> Result<Vec<f64>, HybridError> {
    check_cycle("signal", signal)?;
    check_width_ratio(width_ratio)?;
    check_number("centre_rev", centre_rev, true, "a finite number")?;
    let points = signal.len() as f64;
    // Of the middle of each new value, from the centre on, in old values.
    let offset = |i: usize| ((i as f64 + 0.5) / points - 0.5) * width_ratio * points;
    let inside = |i: usize| offset(i).abs() <= 0.5 * points;
    // Between two values, so that a ratio of 1 takes the values as they are.
    let centre = window_start(centre_rev, signal.len()) + 0.5 * points - 0.5;
    let places: Vec<f64> =
        (0..signal.len()).filter(|&i| inside(i)).map(|i| (centre + offset(i)).rem_euclid(points)).collect();
    let mut values = interpolate_band_limited(signal, &places, Edge::Periodic)?.into_iter();
    let value = |i| if inside(i) { values.next().unwrap_or_default() } else { 0.0 };
    Ok((0..signal.len()).map(value).collect())
}

/// Number of the value at which the cycle is cut, so that the centre comes to lie in its middle.
pub(super) fn window_start(centre_rev: f64, points: usize) -> f64 {
    let points = points as f64;
    (centre_rev * points - 0.5 * points).round()
}

/// Changes the ratio of the fault's response to what a healthy pair shows: `α x + (1 − α) healthy`.
///
/// # Arguments
/// * `signal` - one cycle
/// * `healthy` - one cycle of the healthy pair, changed in duration like the signal
/// * `fault_to_harmonics_ratio` - (-) α; 1 changes nothing
///
/// # Errors
/// NaN, fewer than 4 values, cycles of different lengths, a ratio that is not a finite number.
///
/// Source: section 5 of arXiv:2410.05073, "fault-to-harmonics ratio".
///
/// ```
/// use meshtone::tuning::change_fault_to_harmonics_ratio;
///
/// let mixed = change_fault_to_harmonics_ratio(&[1.0, 3.0, 1.0, 1.0], &[1.0; 4], 2.0)?;
/// assert_eq!(mixed, [1.0, 5.0, 1.0, 1.0]);
/// # Ok::<(), meshtone::tuning::HybridError>(())
/// ```
pub fn change_fault_to_harmonics_ratio(
    signal: &[f64],
    healthy: &[f64],
    fault_to_harmonics_ratio: f64,
) -> Result<Vec<f64>, HybridError> {
    check_cycle("signal", signal)?;
    check_cycle("healthy", healthy)?;
    if signal.len() != healthy.len() {
        return Err(HybridError::LengthMismatch { signal: signal.len(), healthy: healthy.len() });
    }
    check_ratio(fault_to_harmonics_ratio)?;
    let alpha = fault_to_harmonics_ratio;
    Ok(signal.iter().zip(healthy).map(|(x, h)| alpha * x + (1.0 - alpha) * h).collect())
}

/// Adds white Gaussian noise.
///
/// # Arguments
/// * `signal` - one cycle
/// * `noise_level` - (-) standard deviation of the noise over `healthy_rms`, 0 or more
/// * `healthy_rms` - rms of the healthy pair's cycle, changed in duration like the signal; in the signal's unit
/// * `seed` - of all draws
/// * `draw` - number of the draw: the same seed and number give the same noise
///
/// # Errors
/// NaN, fewer than 4 values, a level or an rms below 0.
///
/// Source: section 5 of arXiv:2410.05073, "signal-to-noise ratio".
///
/// ```
/// use meshtone::tuning::add_noise;
///
/// let noise = add_noise(&[0.0; 1000], 0.5, 2.0, 1, 0)?;
/// assert!((meshtone::signal::rms(&noise) - 1.0).abs() < 0.1);
/// assert_eq!(noise, add_noise(&[0.0; 1000], 0.5, 2.0, 1, 0)?);
/// assert_ne!(noise, add_noise(&[0.0; 1000], 0.5, 2.0, 1, 1)?);
/// # Ok::<(), meshtone::tuning::HybridError>(())
/// ```
pub fn add_noise(
    signal: &[f64],
    noise_level: f64,
    healthy_rms: f64,
    seed: u64,
    draw: u64,
) -> Result<Vec<f64>, HybridError> {
    check_cycle("signal", signal)?;
    check_not_negative("noise_level", noise_level)?;
    check_not_negative("healthy_rms", healthy_rms)?;
    let deviation = noise_level * healthy_rms;
    let mut draws = Draws::new(seed, Purpose::EnhancementNoise, draw);
    Ok(signal.iter().map(|x| x + deviation * draws.normal()).collect())
}

/// The three modifications of section 5 of arXiv:2410.05073.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enhancement {
    /// (-) Duration: [`change_duration`]. 1 changes nothing.
    pub width_ratio: f64,
    /// (-) Fault-to-harmonics ratio: [`change_fault_to_harmonics_ratio`]. 1 changes nothing.
    pub fault_to_harmonics_ratio: f64,
    /// (-) Noise: [`add_noise`]. 0 changes nothing.
    pub noise_level: f64,
}

impl Default for Enhancement {
    /// Changes nothing but the place of the fault's response.
    fn default() -> Self {
        Self { width_ratio: 1.0, fault_to_harmonics_ratio: 1.0, noise_level: 0.0 }
    }
}

impl Enhancement {
    /// Refuses parameters that no signal can be modified by.
    pub(super) fn check(&self) -> Result<(), HybridError> {
        check_width_ratio(self.width_ratio)?;
        check_ratio(self.fault_to_harmonics_ratio)?;
        check_not_negative("noise_level", self.noise_level)
    }

    /// Modifies a difference signal: duration, then fault-to-harmonics ratio.
    ///
    /// # Arguments
    /// * `difference` - one cycle
    /// * `healthy` - one cycle of the healthy pair
    /// * `centre_rev` - (rev) where the fault's response is, in both
    ///
    /// # Errors
    /// Those of the modifications.
    pub fn without_noise(
        &self,
        difference: &[f64],
        healthy: &[f64],
        centre_rev: f64,
    ) -> Result<Enhanced, HybridError> {
        let healthy = change_duration(healthy, self.width_ratio, centre_rev)?;
        let signal = change_duration(difference, self.width_ratio, centre_rev)?;
        let signal = change_fault_to_harmonics_ratio(&signal, &healthy, self.fault_to_harmonics_ratio)?;
        Ok(Enhanced { signal, healthy_rms: rms(&healthy), noise_level: self.noise_level })
    }
}

/// A modified difference signal, before noise is drawn.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Enhanced {
    /// One cycle.
    pub signal: Vec<f64>,
    /// Rms of the healthy pair's cycle, changed in duration like the signal.
    pub healthy_rms: f64,
    /// (-) As in [`Enhancement`].
    pub noise_level: f64,
}

impl Enhanced {
    /// The signal with noise.
    ///
    /// # Arguments
    /// * `seed`, `draw` - as of [`add_noise`]
    ///
    /// # Errors
    /// Those of [`add_noise`].
    pub fn with_noise(&self, seed: u64, draw: u64) -> Result<Vec<f64>, HybridError> {
        add_noise(&self.signal, self.noise_level, self.healthy_rms, seed, draw)
    }
}

/// Checks the values that interpolation needs: at least 4, all of them numbers.
pub(super) fn check_cycle(what: &'static str, values: &[f64]) -> Result<(), HybridError> {
    if values.len() < 4 {
        return Err(HybridError::TooShort { what, values: values.len() });
    }
    match values.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(HybridError::NotANumber { what, index }),
        None => Ok(()),
    }
}

/// Checks that a parameter is finite, and that what else it must be holds.
fn check_number(name: &str, value: f64, holds: bool, allowed: &str) -> Result<(), HybridError> {
    if holds && value.is_finite() { Ok(()) } else { Err(HybridError::parameter(name, value, allowed)) }
}

fn check_width_ratio(value: f64) -> Result<(), HybridError> {
    check_number("width_ratio", value, value > 0.0, "above 0")
}

fn check_ratio(value: f64) -> Result<(), HybridError> {
    check_number("fault_to_harmonics_ratio", value, true, "a finite number")
}

fn check_not_negative(name: &str, value: f64) -> Result<(), HybridError> {
    check_number(name, value, value >= 0.0, "0 or more")
}
