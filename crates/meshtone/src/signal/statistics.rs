//! Numbers that sum up a signal.

/// Partial sums that are formed side by side: in a single one every addition would wait for the one before.
const LANES: usize = 8;

/// The values taken in to as many partial results, every eighth to the same one, and those taken together at the end:
/// always in the same order.
#[inline(always)]
fn reduced(signal: &[f64], start: f64, reduce: impl Fn(f64, f64) -> f64 + Copy) -> [f64; LANES] {
    let mut lanes = [start; LANES];
    let (blocks, rest) = signal.as_chunks::<LANES>();
    for block in blocks {
        for (lane, &x) in lanes.iter_mut().zip(block) {
            *lane = reduce(*lane, x);
        }
    }
    for (lane, &x) in lanes.iter_mut().zip(rest) {
        *lane = reduce(*lane, x);
    }
    lanes
}

/// `Σ f(x)`.
#[inline(always)]
fn sum(signal: &[f64], f: impl Fn(f64) -> f64 + Copy) -> f64 {
    reduced(signal, 0.0, |sum, x| sum + f(x)).iter().sum()
}

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
    (sum(signal, |x| x * x) / signal.len() as f64).sqrt()
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
    // NaN is never larger.
    let larger = |peak: f64, x: f64| if x.abs() > peak { x.abs() } else { peak };
    reduced(signal, 0.0, larger).into_iter().fold(0.0, larger)
}

/// Peak to peak, the largest value less the least.
///
/// # Arguments
/// * `signal` - the signal
///
/// 0 for an empty signal.
///
/// ```
/// assert_eq!(meshtone::signal::peak_to_peak(&[1.0, -4.0, 2.0]), 6.0);
/// ```
pub fn peak_to_peak(signal: &[f64]) -> f64 {
    let largest = signal.iter().copied().reduce(f64::max);
    let least = signal.iter().copied().reduce(f64::min);
    largest.zip(least).map_or(0.0, |(largest, least)| largest - least)
}

/// Crest factor, peak over rms: `√2` for a sine.
///
/// # Arguments
/// * `signal` - the signal; its mean is not removed
///
/// None where the signal is 0 or empty.
///
/// ```
/// assert_eq!(meshtone::signal::crest_factor(&[3.0, -1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 2.0]), Some(3.0 / 2f64.sqrt()));
/// assert_eq!(meshtone::signal::crest_factor(&[0.0; 3]), None);
/// ```
pub fn crest_factor(signal: &[f64]) -> Option<f64> {
    let rms = rms(signal);
    (rms > 0.0).then(|| peak(signal) / rms)
}

/// Central moment `µ_k = Σ(x − x̄)ᵏ/n`, of the whole population.
///
/// # Arguments
/// * `signal` - the signal
/// * `order` - k
///
/// NaN for an empty signal.
///
/// ```
/// assert_eq!(meshtone::signal::central_moment(&[1.0, 2.0, 3.0, 6.0], 2), 3.5);
/// ```
pub fn central_moment(signal: &[f64], order: i32) -> f64 {
    let count = signal.len() as f64;
    // Seen from its first value a constant is exactly 0, and so is its mean.
    let first = signal.first().copied().unwrap_or(f64::NAN);
    let mean = sum(signal, |x| x - first) / count;
    let sum = match order {
        2 => powers::<2>(signal, first, mean),
        3 => powers::<3>(signal, first, mean),
        4 => powers::<4>(signal, first, mean),
        6 => powers::<6>(signal, first, mean),
        8 => powers::<8>(signal, first, mean),
        _ => sum(signal, |x| (x - first - mean).powi(order)),
    };
    sum / count
}

/// `Σ(x − first − mean)ᵏ` for a k that is known beforehand, and so a few multiplications.
fn powers<const ORDER: i32>(signal: &[f64], first: f64, mean: f64) -> f64 {
    sum(signal, |x| (x - first - mean).powi(ORDER))
}

/// Standard deviation `√µ₂`, of the whole population.
///
/// # Arguments
/// * `signal` - the signal
///
/// NaN for an empty signal.
///
/// ```
/// assert_eq!(meshtone::signal::standard_deviation(&[1.0, 3.0, 1.0, 3.0]), 1.0);
/// ```
pub fn standard_deviation(signal: &[f64]) -> f64 {
    central_moment(signal, 2).sqrt()
}

/// Standardised moment `µ_k/µ₂^(k/2)`: skewness for k = 3, kurtosis for 4; 1·3·5…(k − 1) for Gaussian noise and
/// even k.
///
/// # Arguments
/// * `signal` - the signal
/// * `order` - k
///
/// None where the signal is constant (to rounding) or empty, and so has no shape. Without a correction for small
/// samples.
///
/// ```
/// use meshtone::signal::standardised_moment;
///
/// assert_eq!(standardised_moment(&[1.0, -1.0, 1.0, -1.0], 6), Some(1.0));
/// assert_eq!(standardised_moment(&[40.0; 8], 6), None);
/// ```
pub fn standardised_moment(signal: &[f64], order: i32) -> Option<f64> {
    let variance = central_moment(signal, 2);
    let deviation = variance.sqrt();
    // What differs by rounding only is no signal.
    let rounding = 4.0 * f64::EPSILON * peak(signal);
    // Without the root where there is none, as in NA4 of a single record.
    let scale = if order % 2 == 0 { variance.powi(order / 2) } else { deviation.powi(order) };
    (deviation > rounding).then(|| central_moment(signal, order) / scale)
}

/// Skewness `µ₃/µ₂^1.5`: 0 for what is as often so far above as below its mean.
///
/// # Arguments
/// * `signal` - the signal
///
/// None as for [`standardised_moment`].
///
/// ```
/// let skewness = meshtone::signal::skewness(&[0.0, 0.0, 0.0, 4.0]).unwrap();
/// assert!((skewness - 2.0 / 3f64.sqrt()).abs() < 1e-15);
/// ```
pub fn skewness(signal: &[f64]) -> Option<f64> {
    standardised_moment(signal, 3)
}

/// Kurtosis `µ₄/µ₂²`, with `µ_k = Σ(x − x̄)ᵏ/n`: 3 for Gaussian noise, 1.5 for a sine.
///
/// # Arguments
/// * `signal` - the signal
///
/// None as for [`standardised_moment`].
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
    standardised_moment(signal, 4)
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
