//! Numbers that sum up a signal.

/// Root mean square, `√(Σx²/n)`.
///
/// # Arguments
/// * `signal` - the signal; its mean is not removed
///
/// NaN for an empty signal.
///
/// ```
/// assert_eq!(meshtone::signal::rms(&[3.0, -3.0, 3.0, -3.0]), 3.0);
/// ```
pub fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|x| x * x).sum::<f64>() / signal.len() as f64).sqrt()
}

/// Peak, the largest `|x|`.
///
/// # Arguments
/// * `signal` - the signal; its mean is not removed
///
/// 0 for an empty signal.
///
/// ```
/// assert_eq!(meshtone::signal::peak(&[1.0, -4.0, 2.0]), 4.0);
/// ```
pub fn peak(signal: &[f64]) -> f64 {
    signal.iter().fold(0.0, |peak, x| peak.max(x.abs()))
}

/// Kurtosis `µ₄/µ₂²`, with `µ_k = Σ(x − x̄)ᵏ/n`: 3 for Gaussian noise, 1.5 for a sine.
///
/// # Arguments
/// * `signal` - the signal
///
/// None where the signal is constant (to rounding) or empty, and so has no shape.
///
/// This is the kurtosis itself, not its excess over 3, of the whole population, without the correction for
/// small samples.
///
/// ```
/// use meshtone::signal::kurtosis;
///
/// assert_eq!(kurtosis(&[1.0, -1.0, 1.0, -1.0]), Some(1.0));
/// assert_eq!(kurtosis(&[40.0; 8]), None);
/// ```
pub fn kurtosis(signal: &[f64]) -> Option<f64> {
    let count = signal.len() as f64;
    // Seen from its first value a constant is exactly 0, and so is its mean.
    let first = *signal.first()?;
    let mean = signal.iter().map(|x| x - first).sum::<f64>() / count;
    let (mut second, mut fourth) = (0.0, 0.0);
    for x in signal {
        let square = (x - first - mean) * (x - first - mean);
        second += square;
        fourth += square * square;
    }
    let (second, fourth) = (second / count, fourth / count);
    // What differs by rounding only is no signal.
    let rounding = 4.0 * f64::EPSILON * peak(signal);
    (second > rounding * rounding).then(|| fourth / (second * second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn sine(amplitude: f64, offset: f64) -> Vec<f64> {
        (0..1000).map(|i| offset + amplitude * (TAU * 7.0 * f64::from(i) / 1000.0).sin()).collect()
    }

    // ∫sin² = 1/2 and ∫sin⁴ = 3/8 over whole periods; equidistant points give both exactly.
    #[test]
    fn of_a_sine() {
        assert!((rms(&sine(2.0, 0.0)) - 2f64.sqrt()).abs() < 1e-13);
        assert!((rms(&sine(2.0, 3.0)) - 11f64.sqrt()).abs() < 1e-13);
        assert!((kurtosis(&sine(2.0, 3.0)).unwrap() - 1.5).abs() < 1e-12);
    }

    // A pulse of height h in n samples: µ₂ = h² p(1 − p), µ₄/µ₂² = 1/(p(1 − p)) − 3 with p = 1/n.
    #[test]
    fn of_a_pulse() {
        let mut pulse = vec![0.0; 100];
        pulse[41] = -5.0;
        assert_eq!(peak(&pulse), 5.0);
        assert_eq!(rms(&pulse), 0.5);
        assert!((kurtosis(&pulse).unwrap() - (1.0 / (0.01 * 0.99) - 3.0)).abs() < 1e-10);
    }

    // Uniform on n equidistant points: 3(3n² − 7)/(5(n² − 1)).
    #[test]
    fn of_a_ramp() {
        let ramp: Vec<f64> = (0..101).map(f64::from).collect();
        let n2 = 101.0 * 101.0;
        assert!((kurtosis(&ramp).unwrap() - 3.0 * (3.0 * n2 - 7.0) / (5.0 * (n2 - 1.0))).abs() < 1e-12);
    }

    #[test]
    fn of_a_constant_or_nothing() {
        assert_eq!(kurtosis(&[0.0; 5]), None);
        // The sum of these is not exactly 100.1.
        assert_eq!(kurtosis(&[0.1; 1001]), None);
        assert_eq!(kurtosis(&[]), None);
        assert!(rms(&[]).is_nan());
        assert_eq!(peak(&[]), 0.0);
    }
}
