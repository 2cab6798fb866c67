//! Shape-preserving cubic interpolation.

use super::locate;

/// Piecewise cubic Hermite interpolation that keeps the data's monotonicity.
///
/// Slopes by Fritsch and Butland (harmonic mean of the neighbouring secants), one-sided at the
/// ends; the same as MATLAB's `pchip` and SciPy's `PchipInterpolator`. Source: F. N. Fritsch,
/// J. Butland, "A method for constructing local monotone piecewise cubic interpolants", SIAM J. Sci.
/// Stat. Comput. 5 (1984).
///
/// ```
/// use meshtone::interpolation::Pchip;
/// let curve = Pchip::uniform(0.0, 1.0, &[0.0, 1.0, 1.0, 2.0]);
/// assert_eq!(curve.at(1.5), 1.0);
/// ```
#[derive(Debug, Clone)]
pub struct Pchip<'a> {
    start: f64,
    step: f64,
    values: &'a [f64],
    /// Slopes times the step.
    slopes: Vec<f64>,
}

impl<'a> Pchip<'a> {
    /// The curve through `values` at `start`, `start + step`, ….
    ///
    /// # Arguments
    /// * `start`, `step` - the grid
    /// * `values` - (at least 2) the points
    pub fn uniform(start: f64, step: f64, values: &'a [f64]) -> Self {
        let n = values.len();
        let secant = |i: usize| values[i + 1] - values[i];
        let slopes = (0..n)
            .map(|i| match i {
                _ if n == 2 => secant(0),
                0 => end_slope(secant(0), secant(1)),
                _ if i == n - 1 => end_slope(secant(n - 2), secant(n - 3)),
                _ => inner_slope(secant(i - 1), secant(i)),
            })
            .collect();
        Self { start, step, values, slopes }
    }

    /// The curve at `x`; outside the points the end pieces extrapolate.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        let (i, t) = locate(x, self.start, self.step, self.values.len());
        let (y0, y1, d0, d1) = (self.values[i], self.values[i + 1], self.slopes[i], self.slopes[i + 1]);
        let secant = y1 - y0;
        let quadratic = 3.0 * secant - 2.0 * d0 - d1;
        let cubic = d0 + d1 - 2.0 * secant;
        y0 + t * (d0 + t * (quadratic + t * cubic))
    }
}

fn inner_slope(before: f64, after: f64) -> f64 {
    if before * after <= 0.0 { 0.0 } else { 2.0 * before * after / (before + after) }
}

fn end_slope(near: f64, next: f64) -> f64 {
    let slope = (3.0 * near - next) / 2.0;
    if slope * near <= 0.0 {
        0.0
    } else if near * next <= 0.0 && slope.abs() > 3.0 * near.abs() {
        3.0 * near
    } else {
        slope
    }
}
