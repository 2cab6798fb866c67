//! Moments of the envelope of a mixture in noise, without drawing the noise.

use meshtone_fourier::Complex64;

use super::modify::window_start;
use super::moments::Window;
use super::rice::Rice;
use super::{HybridError, Moments};
use crate::signal::analytic_signal;

/// The analytic signals of a case and of the healthy state, over every window around a centre.
///
/// The analytic signal of `h + α (d − h)` is the same mixture of theirs, and that of white Gaussian noise has independent
/// Gaussian parts of one variance at every place. So the envelope in noise has the distribution of Rice at every place, and its
/// expected moments are means of that distribution's over the window.
#[derive(Debug, Clone)]
pub(super) struct WindowEnvelopes {
    /// By place of the cycle: the square of the mixture's modulus is `[0] + α [1] + α² [2]`.
    squares: Vec<[f64; 3]>,
}

impl WindowEnvelopes {
    /// # Arguments
    /// * `difference` - d, one cycle
    /// * `healthy` - h, one cycle
    /// * `centre_rev` - (rev) centre of all windows
    pub(super) fn new(difference: &[f64], healthy: &[f64], centre_rev: f64) -> Result<Self, HybridError> {
        let (d, h) = (analytic_signal(difference)?, analytic_signal(healthy)?);
        let start = window_start(centre_rev, d.len()) as i64;
        let squares = (0..d.len() as i64).map(|k| {
            let at = (start + k).rem_euclid(d.len() as i64) as usize;
            let response: Complex64 = d[at] - h[at];
            [h[at].norm_sqr(), 2.0 * (h[at].conj() * response).re, response.norm_sqr()]
        });
        Ok(Self { squares: squares.collect() })
    }

    /// Moments of the envelope after a change of duration, in noise.
    ///
    /// # Arguments
    /// * `width_ratio` - (-) as of [`super::change_duration`]
    /// * `fault_to_harmonics_ratio` - (-) α
    /// * `variance` - of the noise
    pub(super) fn moments(&self, width_ratio: f64, fault_to_harmonics_ratio: f64, variance: f64) -> Moments {
        let window = Window::new(self.squares.len(), width_ratio);
        let rice = Rice::new(variance);
        let alpha = fault_to_harmonics_ratio;
        let mut raw = [0.0; 4];
        let mut add = |part: f64, square: f64| {
            let [first, third] = rice.moments(square.sqrt());
            raw[0] += part * first;
            raw[1] += part * (square + 2.0 * variance);
            raw[2] += part * third;
            raw[3] += part * (square * square + 8.0 * variance * (square + variance));
        };
        for (part, [healthy, mixed, response]) in window.values(&self.squares) {
            // Rounding must not make a square negative.
            add(part, (healthy + alpha * (mixed + alpha * response)).max(0.0));
        }
        add(window.padding(), 0.0);
        Moments::from_raw(raw.map(|sum| sum / window.count))
    }

    /// Mean square of the healthy envelope after a change of duration, without noise.
    ///
    /// # Arguments
    /// * `width_ratio` - (-) as of [`super::change_duration`]
    pub(super) fn healthy_square(&self, width_ratio: f64) -> f64 {
        let window = Window::new(self.squares.len(), width_ratio);
        window.values(&self.squares).map(|(part, squares)| part * squares[0]).sum::<f64>() / window.count
    }
}
