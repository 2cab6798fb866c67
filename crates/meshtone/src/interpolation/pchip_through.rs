//! Shape-preserving cubic interpolation of points that are not uniform.

/// [`Pchip`](super::Pchip) through rising points that are not uniform, as MATLAB's `pchip` and SciPy's
/// `PchipInterpolator`.
///
/// Slopes by Fritsch and Butland: the weighted harmonic mean `(w₁ + w₂)/(w₁/s₁ + w₂/s₂)` of the neighbouring secants s,
/// `w₁ = 2h₂ + h₁`, `w₂ = h₂ + 2h₁`; one-sided with three points at the ends.
///
/// ```
/// use meshtone::interpolation::PchipThrough;
/// let curve = PchipThrough::new(vec![0.0, 1.0, 3.0], vec![0.0, 1.0, 1.0]);
/// assert_eq!(curve.at_rising([2.0]), [1.0]);
/// ```
#[derive(Debug, Clone)]
pub struct PchipThrough {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
}

impl PchipThrough {
    /// The curve through the points (x, y).
    ///
    /// # Arguments
    /// * `x` - (at least 2) strictly rising
    /// * `y` - as many
    pub fn new(x: Vec<f64>, y: Vec<f64>) -> Self {
        let n = x.len();
        let step = |i: usize| x[i + 1] - x[i];
        let secant = |i: usize| (y[i + 1] - y[i]) / step(i);
        let slopes = (0..n)
            .map(|i| match i {
                _ if n == 2 => secant(0),
                0 => end_slope((step(0), secant(0)), (step(1), secant(1))),
                _ if i == n - 1 => end_slope((step(n - 2), secant(n - 2)), (step(n - 3), secant(n - 3))),
                _ => inner_slope((step(i - 1), secant(i - 1)), (step(i), secant(i))),
            })
            .collect();
        Self { x, y, slopes }
    }

    /// The curve at rising places, each found from the one before; outside the points the end pieces extrapolate.
    ///
    /// # Arguments
    /// * `places` - never falling
    pub fn at_rising(&self, places: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let (mut number, mut piece) = (0, self.piece(0));
        let value = |x: f64| {
            while number + 2 < self.x.len() && self.x[number + 1] <= x {
                number += 1;
                piece = self.piece(number);
            }
            piece.at(x)
        };
        places.into_iter().map(value).collect()
    }

    fn piece(&self, i: usize) -> Piece {
        let step = self.x[i + 1] - self.x[i];
        let (d0, d1) = (self.slopes[i] * step, self.slopes[i + 1] * step);
        let rise = self.y[i + 1] - self.y[i];
        let factors = [self.y[i], d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise];
        Piece { start: self.x[i], step, factors }
    }
}

/// The curve between two of its points.
struct Piece {
    start: f64,
    step: f64,
    /// Of the powers of the part of the way from the one to the other.
    factors: [f64; 4],
}

impl Piece {
    fn at(&self, x: f64) -> f64 {
        let t = (x - self.start) / self.step;
        let [constant, linear, quadratic, cubic] = self.factors;
        constant + t * (linear + t * (quadratic + t * cubic))
    }
}

fn inner_slope((h0, before): (f64, f64), (h1, after): (f64, f64)) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
    (w0 + w1) / (w0 / before + w1 / after)
}

fn end_slope((h0, near): (f64, f64), (h1, next): (f64, f64)) -> f64 {
    let slope = ((2.0 * h0 + h1) * near - h0 * next) / (h0 + h1);
    if slope * near <= 0.0 {
        0.0
    } else if near * next <= 0.0 && slope.abs() > 3.0 * near.abs() {
        3.0 * near
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolation::Pchip;

    #[test]
    fn on_uniform_points_the_same_curve() {
        let y = [0.0, 1.0, 0.5, 2.0, 4.0, 4.0, 5.5];
        let through = PchipThrough::new((0..7).map(f64::from).collect(), y.to_vec());
        let uniform = Pchip::uniform(0.0, 1.0, &y);
        let places: Vec<f64> = (-4..70).map(|i| f64::from(i) / 10.0).collect();
        for (x, rising) in places.iter().zip(through.at_rising(places.iter().copied())) {
            assert!((rising - uniform.at(*x)).abs() < 1e-13, "{x}");
        }
    }
}
