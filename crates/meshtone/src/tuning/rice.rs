//! The modulus of a complex number in complex Gaussian noise: the distribution of Rice.

use std::sync::LazyLock;

/// Largest modulus over the noise's deviation that the table reaches; beyond it the series of large moduli is exact enough.
const LARGEST: f64 = 16.0;
/// Steps of the table for each unit: straight lines between them err by 3 in a million at most.
const STEPS: f64 = 256.0;

/// First and third moment of the modulus at equal steps of the noise-free one, all over the noise's deviation.
static TABLE: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
    (0..=(LARGEST * STEPS) as usize + 1).map(|step| by_bessel_functions(step as f64 / STEPS)).collect()
});

/// Expected modulus of `a + n` and its expected cube, where n has independent Gaussian parts of one variance.
#[derive(Clone, Copy)]
pub(super) struct Rice {
    table: &'static [[f64; 2]],
    deviation: f64,
    /// Steps of the table for each unit of the modulus.
    scale: f64,
}

impl Rice {
    /// # Arguments
    /// * `variance` - of the noise's real part, and of its imaginary part
    pub(super) fn new(variance: f64) -> Self {
        let deviation = variance.sqrt();
        Self { table: &TABLE, deviation, scale: STEPS / deviation }
    }

    /// First and third moment.
    ///
    /// # Arguments
    /// * `modulus` - of a, 0 or more
    pub(super) fn moments(&self, modulus: f64) -> [f64; 2] {
        let s = self.deviation;
        if modulus >= LARGEST * s {
            // |a|ᵖ (1 + p²/2 q + p²(p − 2)²/8 q² + p²(p − 2)²(p − 4)²/48 q³ …) with q = (s/|a|)².
            let q = if modulus > 0.0 { (s / modulus).powi(2) } else { 0.0 };
            let first = modulus * (1.0 + q * (0.5 + q * (0.125 + q * 0.1875)));
            let third = modulus.powi(3) * (1.0 + q * (4.5 + q * (1.125 + q * 0.1875)));
            return [first, third];
        }
        let place = modulus * self.scale;
        let below = place as usize;
        let part = place - below as f64;
        let [low, high] = [self.table[below], self.table[below + 1]];
        [s * (low[0] + part * (high[0] - low[0])), s.powi(3) * (low[1] + part * (high[1] - low[1]))]
    }
}

/// First and third moment at deviation 1: `√(π/2) L½(−u)` and `3 √(π/2) L³⁄₂(−u)`, u half of the square of the noise-free
/// modulus.
fn by_bessel_functions(modulus: f64) -> [f64; 2] {
    let u = 0.5 * modulus * modulus;
    let [zeroth, first] = scaled_bessel(0.5 * u);
    let half = (1.0 + u) * zeroth + u * first;
    // From the recurrence of Laguerre's functions, L−½(−u) being e^(−u/2) I₀(u/2).
    let three_halves = ((2.0 + u) * half - 0.5 * zeroth) / 1.5;
    let root = std::f64::consts::FRAC_PI_2.sqrt();
    [root * half, 3.0 * root * three_halves]
}

/// `e⁻ˣ I₀(x)` and `e⁻ˣ I₁(x)`: means of `e^(x cos t − x)` and of `cos t` times it over a period, to which sums at equal
/// distances converge faster than any power.
fn scaled_bessel(x: f64) -> [f64; 2] {
    const PLACES: usize = 128;
    let mut sums = [0.0; 2];
    for k in 0..PLACES {
        let cosine = (std::f64::consts::TAU * k as f64 / PLACES as f64).cos();
        let value = (x * (cosine - 1.0)).exp();
        sums[0] += value;
        sums[1] += value * cosine;
    }
    sums.map(|sum| sum / PLACES as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_modulus_it_is_rayleigh_s_distribution() {
        let [first, third] = Rice::new(4.0).moments(0.0);
        let root = std::f64::consts::FRAC_PI_2.sqrt();
        assert!((first / (2.0 * root) - 1.0).abs() < 1e-14);
        assert!((third / (8.0 * 3.0 * root) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn without_noise_nothing_changes() {
        assert_eq!(Rice::new(0.0).moments(3.0), [3.0, 27.0]);
        assert_eq!(Rice::new(0.0).moments(0.0), [0.0, 0.0]);
    }

    /// Against the integral over the plane of the noise.
    #[test]
    fn moments_are_those_of_the_distribution() {
        for modulus in [0.013, 0.5, 1.7, 6.0031, 15.99, 16.01, 40.0] {
            let [mut first, mut third, mut weight] = [0.0; 3];
            for i in -80..=80 {
                for j in -80..=80 {
                    let (x, y) = (f64::from(i) * 0.1, f64::from(j) * 0.1);
                    let density = (-0.5 * (x * x + y * y)).exp();
                    let sum = (modulus + x).hypot(y);
                    weight += density;
                    first += density * sum;
                    third += density * sum.powi(3);
                }
            }
            let [by_rice, cube_by_rice] = Rice::new(1.0).moments(modulus);
            // Half of the tolerance is the sum's, whose integrand has a kink at 0.
            assert!((by_rice * weight / first - 1.0).abs() < 1e-4, "{modulus}");
            assert!((cube_by_rice * weight / third - 1.0).abs() < 1e-5, "{modulus}");
        }
    }
}
