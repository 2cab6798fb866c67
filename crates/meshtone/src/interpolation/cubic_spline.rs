//! Twice continuously differentiable cubic interpolation.

use super::locate;

/// Cubic spline with not-a-knot ends, as MATLAB's `spline` and SciPy's `CubicSpline`.
///
/// Source: C. de Boor, "A Practical Guide to Splines", Springer (1978), chapter IV.
///
/// ```
/// use meshtone::interpolation::NotAKnotSpline;
/// let cubes: Vec<f64> = (0..6).map(|i| f64::from(i).powi(3)).collect();
/// let spline = NotAKnotSpline::uniform(0.0, 1.0, &cubes);
/// assert!((spline.at(2.5) - 15.625).abs() < 1e-12);
/// ```
#[derive(Debug, Clone)]
pub struct NotAKnotSpline<'a> {
    start: f64,
    step: f64,
    values: &'a [f64],
    /// Second derivatives times step²/6.
    bends: Vec<f64>,
}

impl<'a> NotAKnotSpline<'a> {
    /// The spline through `values` at `start`, `start + step`, ….
    ///
    /// # Arguments
    /// * `start`, `step` - the grid
    /// * `values` - (at least 2) the points; three give the parabola, two the line
    pub fn uniform(start: f64, step: f64, values: &'a [f64]) -> Self {
        Self { start, step, values, bends: bends(values) }
    }

    /// The spline at `x`; outside the points the end pieces extrapolate.
    pub fn at(&self, x: f64) -> f64 {
        let (i, t) = locate(x, self.start, self.step, self.values.len());
        let s = 1.0 - t;
        s * self.values[i]
            + t * self.values[i + 1]
            + self.bends[i] * (s * s * s - s)
            + self.bends[i + 1] * (t * t * t - t)
    }
}

/// With `m_i` the second derivative times h²/6: `m_{i−1} + 4 m_i + m_{i+1} = y_{i−1} − 2 y_i + y_{i+1}`
/// inside, and equal third derivatives across the second and the last but one point,
/// `m_0 = 2 m_1 − m_2`, which leaves `6 m_1 = y_0 − 2 y_1 + y_2` in the first row and its mirror image
/// in the last.
fn bends(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n < 3 {
        return vec![0.0; n];
    }
    let curvature = |i: usize| values[i - 1] - 2.0 * values[i] + values[i + 1];
    if n == 3 {
        return vec![curvature(1) / 6.0; 3];
    }
    let mut m = vec![0.0; n];
    let mut factor = vec![0.0; n];
    m[1] = curvature(1) / 6.0;
    for i in 2..n - 2 {
        let pivot = 4.0 - factor[i - 1];
        factor[i] = 1.0 / pivot;
        m[i] = (curvature(i) - m[i - 1]) / pivot;
    }
    m[n - 2] = curvature(n - 2) / 6.0;
    for i in (2..n - 2).rev() {
        m[i] -= factor[i] * m[i + 1];
    }
    m[0] = 2.0 * m[1] - m[2];
    m[n - 1] = 2.0 * m[n - 2] - m[n - 3];
    m
}
