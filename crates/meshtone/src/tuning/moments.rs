//! Moments of a mixture, without forming it.

use super::HybridError;
use super::modify::{check_cycle, window_start};
use crate::interpolation::UniformLinear;

/// Highest power.
const POWERS: usize = 5;

/// Sums of products of powers of a signal and of the healthy one, over every window around a centre.
///
/// `E[(α d + (1 − α) h)^k]` is a polynomial in α whose coefficients are the joint moments `E[dⁱ hʲ]`, i + j = k; over
/// a window they are differences of running sums. So a search over α, the noise level and the width needs no
/// signal at all.
#[derive(Debug, Clone)]
pub struct WindowMoments {
    /// Running sums of dⁱ hʲ by `[i][j]`, i + j ≤ 4; the first is 0.
    sums: [[Vec<f64>; POWERS]; POWERS],
    points: usize,
}

/// Part of a cycle that becomes the cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    from: f64,
    to: f64,
    /// Length of what it becomes, in values of the cycle: the zeros of the padding count.
    pub(super) count: f64,
}

impl Window {
    /// # Arguments
    /// * `points` - of the cycle
    /// * `width_ratio` - (-) as of [`super::change_duration`]
    pub(super) fn new(points: usize, width_ratio: f64) -> Self {
        let points = points as f64;
        let half = 0.5 * width_ratio.min(1.0) * points;
        Self { from: 0.5 * points - half, to: 0.5 * points + half, count: width_ratio * points }
    }

    /// The values of the cycle that lie in it, with the part that each counts by.
    pub(super) fn values<T>(self, cycle: &[T]) -> impl Iterator<Item = (f64, &T)> {
        let (first, end) = (self.from as usize, (self.to.ceil() as usize).min(cycle.len()));
        let part = move |place: f64| self.to.min(place + 1.0) - self.from.max(place);
        cycle[first..end].iter().enumerate().map(move |(n, value)| (part((first + n) as f64), value))
    }

    /// Number of zeros of the padding that it holds.
    pub(super) fn padding(self) -> f64 {
        self.count - (self.to - self.from)
    }
}

/// Joint moments `E[dⁱ hʲ]` over one window, by `[i][j]`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct JointMoments(pub [[f64; POWERS]; POWERS]);

/// Mean and central moments of a signal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: f64,
    /// Second central moment.
    pub second: f64,
    /// Third central moment.
    pub third: f64,
    /// Fourth central moment.
    pub fourth: f64,
}

impl WindowMoments {
    /// Sums up a cycle.
    ///
    /// # Arguments
    /// * `difference` - d, one cycle
    /// * `healthy` - h, one cycle
    /// * `centre_rev` - (rev) centre of all windows
    ///
    /// # Errors
    /// NaN, fewer than 4 values, different lengths.
    pub fn new(difference: &[f64], healthy: &[f64], centre_rev: f64) -> Result<Self, HybridError> {
        check_cycle("difference", difference)?;
        check_cycle("healthy", healthy)?;
        let points = difference.len();
        if healthy.len() != points {
            return Err(HybridError::LengthMismatch { signal: points, healthy: healthy.len() });
        }
        let start = window_start(centre_rev, points) as i64;
        let at = |k: usize| (start + k as i64).rem_euclid(points as i64) as usize;
        let sums = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                if i + j >= POWERS {
                    return Vec::new();
                }
                let mut sum = 0.0;
                let mut running = Vec::with_capacity(points + 1);
                running.push(0.0);
                for k in 0..points {
                    let n = at(k);
                    sum += difference[n].powi(i as i32) * healthy[n].powi(j as i32);
                    running.push(sum);
                }
                running
            })
        });
        Ok(Self { sums, points })
    }

    /// Joint moments after a change of duration.
    ///
    /// # Arguments
    /// * `width_ratio` - (-) as of [`super::change_duration`]; above 1 the zeros of the padding count
    pub fn at_duration(&self, width_ratio: f64) -> JointMoments {
        let Window { from, to, count } = Window::new(self.points, width_ratio);
        let mut moments = JointMoments::default();
        for i in 0..POWERS {
            for j in 0..POWERS - i {
                let sums = UniformLinear::uniform(0.0, 1.0, &self.sums[i][j]);
                moments.0[i][j] = (sums.at(to) - sums.at(from)) / count;
            }
        }
        moments.0[0][0] = 1.0;
        moments
    }
}

impl JointMoments {
    /// Moments of `α d + (1 − α) h`.
    ///
    /// # Arguments
    /// * `fault_to_harmonics_ratio` - (-) α
    pub fn mixed(&self, fault_to_harmonics_ratio: f64) -> Moments {
        let (a, b) = (fault_to_harmonics_ratio, 1.0 - fault_to_harmonics_ratio);
        let m = &self.0;
        let first = a * m[1][0] + b * m[0][1];
        let second = a * a * m[2][0] + 2.0 * a * b * m[1][1] + b * b * m[0][2];
        let third =
            a.powi(3) * m[3][0] + 3.0 * a * a * b * m[2][1] + 3.0 * a * b * b * m[1][2] + b.powi(3) * m[0][3];
        let fourth = a.powi(4) * m[4][0]
            + 4.0 * a.powi(3) * b * m[3][1]
            + 6.0 * a * a * b * b * m[2][2]
            + 4.0 * a * b.powi(3) * m[1][3]
            + b.powi(4) * m[0][4];
        Moments::from_raw([first, second, third, fourth])
    }

    /// Mean square of the healthy signal.
    pub fn healthy_square(&self) -> f64 {
        self.0[0][2]
    }
}

impl Moments {
    /// From the means of the first four powers.
    pub(super) fn from_raw([first, second, third, fourth]: [f64; 4]) -> Self {
        Self {
            mean: first,
            second: second - first * first,
            third: third - 3.0 * first * second + 2.0 * first.powi(3),
            fourth: fourth - 4.0 * first * third + 6.0 * first * first * second - 3.0 * first.powi(4),
        }
    }

    /// With Gaussian noise added.
    ///
    /// # Arguments
    /// * `variance` - of the noise
    pub fn with_noise(self, variance: f64) -> Self {
        Self {
            mean: self.mean,
            second: self.second + variance,
            third: self.third,
            fourth: self.fourth + 6.0 * self.second * variance + 3.0 * variance * variance,
        }
    }

    /// Rms.
    pub fn rms(self) -> f64 {
        (self.mean * self.mean + self.second).sqrt()
    }

    /// Skewness `µ₃/µ₂^1.5`.
    pub fn skewness(self) -> f64 {
        self.third / self.second.powf(1.5)
    }

    /// Kurtosis `µ₄/µ₂²`.
    pub fn kurtosis(self) -> f64 {
        self.fourth / (self.second * self.second)
    }
}
