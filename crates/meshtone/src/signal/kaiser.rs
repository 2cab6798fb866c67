//! Kaiser's window and the low-pass filters made with it.

use std::f64::consts::PI;

/// Kaiser's window at `position`, `I₀(β √(1 − position²))/I₀(β)`.
///
/// Source: J. F. Kaiser, R. W. Schafer, "On the use of the I₀-sinh window for spectrum analysis", IEEE Trans. Acoust.
/// Speech Signal Process. 28 (1980) 105–107.
///
/// # Arguments
/// * `position` - (-) from the middle, ±1 at the ends; 0 is returned outside
/// * `beta` - (-) shape: 0 is the rectangle
///
/// ```
/// assert_eq!(meshtone::signal::kaiser(0.0, 5.0), 1.0);
/// assert_eq!(meshtone::signal::kaiser(1.5, 5.0), 0.0);
/// ```
pub fn kaiser(position: f64, beta: f64) -> f64 {
    let inside = 1.0 - position * position;
    if inside < 0.0 { 0.0 } else { bessel_i0(beta * inside.sqrt()) / bessel_i0(beta) }
}

/// The ideal low-pass filter under Kaiser's window: `sin πt/(πt)` times the window, 1 in the middle.
///
/// # Arguments
/// * `t` - (zero crossings) from the middle
/// * `zero_crossings` - on each side, the last one at the window's end
/// * `beta` - (-) the window's shape
pub(super) fn windowed_sinc(t: f64, zero_crossings: f64, beta: f64) -> f64 {
    let sinc = if t == 0.0 { 1.0 } else { (PI * t).sin() / (PI * t) };
    sinc * kaiser(t / zero_crossings, beta)
}

/// Modified Bessel function `I₀(x) = Σ ((x/2)^k/k!)²`.
fn bessel_i0(x: f64) -> f64 {
    let quarter = 0.25 * x * x;
    let (mut sum, mut term, mut k) = (1.0, 1.0, 1.0);
    while term > f64::EPSILON * 0.01 * sum {
        term *= quarter / (k * k);
        sum += term;
        k += 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    // M. Abramowitz, I. A. Stegun, table 9.8: e^(−x) I₀(x).
    #[test]
    fn bessel_function_of_the_tables() {
        for (x, tabulated) in [(1.0, 0.465_759_607_6), (5.0, 0.183_540_812_6), (10.0, 0.127_833_337_2)] {
            let scaled: f64 = bessel_i0(x) * f64::exp(-x);
            assert!((scaled - tabulated).abs() < 1e-10, "{x}: {scaled}");
        }
    }
}
