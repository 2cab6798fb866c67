//! Cubic spline on points that are not uniform.

/// Cubic spline with natural ends (no curvature there) on rising, not uniform points.
///
/// Source: C. de Boor, "A Practical Guide to Splines", Springer (1978), chapter IV.
///
/// ```
/// use meshtone::interpolation::NaturalSpline;
/// let spline = NaturalSpline::new(vec![0.0, 1.0, 3.0], vec![1.0, 2.0, 4.0]);
/// assert_eq!(spline.at(2.0), 3.0);
/// ```
#[derive(Debug, Clone)]
pub struct NaturalSpline {
    x: Vec<f64>,
    y: Vec<f64>,
    /// Second derivatives.
    curvature: Vec<f64>,
}

impl NaturalSpline {
    /// The spline through the points (x, y).
    ///
    /// # Arguments
    /// * `x` - (at least 2) strictly rising
    /// * `y` - as many
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Self {
        let n = x.len();
        let mut curvature = vec![0.0; n];
        let mut factor = vec![0.0; n];
        for i in 1..n - 1 {
            let (before, after) = (x[i] - x[i - 1], x[i + 1] - x[i]);
            let bend = 6.0 * ((y[i + 1] - y[i]) / after - (y[i] - y[i - 1]) / before);
            let pivot = 2.0 * (before + after) - before * factor[i - 1];
            factor[i] = after / pivot;
            curvature[i] = (bend - before * curvature[i - 1]) / pivot;
        }
        for i in (1..n - 1).rev() {
            curvature[i] -= factor[i] * curvature[i + 1];
        }
        Self { x, y, curvature }
    }

    /// First and last point.
    pub fn range(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }

    /// The spline at `x`; outside the points the end pieces extrapolate.
    pub fn at(&self, x: f64) -> f64 {
        let i = self.x.partition_point(|&knot| knot <= x).clamp(1, self.x.len() - 1) - 1;
        let h = self.x[i + 1] - self.x[i];
        let t = (x - self.x[i]) / h;
        let s = 1.0 - t;
        let bend = (s * s * s - s) * self.curvature[i] + (t * t * t - t) * self.curvature[i + 1];
        s * self.y[i] + t * self.y[i + 1] + bend * h * h / 6.0
    }
}
