//! Numbers that sum up a signal.

use crate::simd::{Dispatch, InstructionSet, Instructions, Lanes, Task};

/// Partial results that are formed side by side, every eighth value going to the same one: in a single one every addition
/// would wait for the one before. They are taken together at the end, always in the same order, and nothing is fused: the
/// same bits whatever vector instructions there are.
const LANES: usize = 8;

/// Sums of one pass over a signal.
struct Sums {
    /// `Σx²`.
    squares: f64,
    /// `Σ(x − x₀)`, x₀ the first value: seen from there a constant is exactly 0, and so is its mean.
    from_first: f64,
    /// The largest `|x|`.
    peak: f64,
}

impl Sums {
    fn of(signal: &[f64]) -> Self {
        InstructionSet::in_use().run(SumsOf(signal))
    }

    /// The mean, from the first value.
    fn mean_from_first(&self, signal: &[f64]) -> f64 {
        self.from_first / signal.len() as f64
    }
}

/// A pass for [`Sums`].
struct SumsOf<'a>(&'a [f64]);

impl Task for SumsOf<'_> {
    type Output = Sums;

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) -> Sums {
        let zero = Lanes::<LANES>::splat(0.0);
        let first = self.0.first().copied().unwrap_or(f64::NAN);
        let (mut squares, mut from_first, mut peak) = (zero, zero, zero);
        let (blocks, rest) = self.0.as_chunks::<LANES>();
        for &block in blocks {
            let x = Lanes(block);
            squares = squares.add(simd, x.mul(simd, x));
            from_first = from_first.add(simd, x.sub(simd, Lanes::splat(first)));
            let size = x.neg(simd).where_less(simd, x, zero, x);
            // NaN is never larger.
            peak = size.where_less(simd, peak, size, peak);
        }
        for (lane, &x) in rest.iter().enumerate() {
            squares.0[lane] += x * x;
            from_first.0[lane] += x - first;
            peak.0[lane] = larger(peak.0[lane], x.abs());
        }
        Sums {
            squares: total(squares.0),
            from_first: total(from_first.0),
            peak: peak.0.into_iter().fold(0.0, larger),
        }
    }
}

/// A pass for `Σ(x − x̄)²` and `Σ(x − x̄)ᵏ`, k being `ORDER`.
struct Powers<'a, const ORDER: i32> {
    signal: &'a [f64],
    /// The first value, and the mean as seen from there.
    first: f64,
    mean: f64,
}

impl<const ORDER: i32> Task for Powers<'_, ORDER> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) -> [f64; 2] {
        let Self { signal, first, mean } = self;
        let [mut squares, mut powers] = [Lanes::<LANES>::splat(0.0); 2];
        let (blocks, rest) = signal.as_chunks::<LANES>();
        for &block in blocks {
            let off = Lanes(block).sub(simd, Lanes::splat(first)).sub(simd, Lanes::splat(mean));
            let square = off.mul(simd, off);
            squares = squares.add(simd, square);
            let power = match ORDER {
                2 => square,
                3 => square.mul(simd, off),
                _ => {
                    let fourth = square.mul(simd, square);
                    match ORDER {
                        6 => fourth.mul(simd, square),
                        8 => fourth.mul(simd, fourth),
                        _ => fourth,
                    }
                }
            };
            powers = powers.add(simd, power);
        }
        for (lane, &x) in rest.iter().enumerate() {
            let off = x - first - mean;
            squares.0[lane] += off * off;
            powers.0[lane] += off.powi(ORDER);
        }
        [total(squares.0), total(powers.0)]
    }
}

/// `Σ(x − x̄)²` and `Σ(x − x̄)ᵏ`.
fn central_sums(signal: &[f64], mean: f64, order: i32) -> [f64; 2] {
    let first = signal.first().copied().unwrap_or(f64::NAN);
    let instructions = InstructionSet::in_use();
    match order {
        2 => instructions.run(Powers::<2> { signal, first, mean }),
        3 => instructions.run(Powers::<3> { signal, first, mean }),
        4 => instructions.run(Powers::<4> { signal, first, mean }),
        6 => instructions.run(Powers::<6> { signal, first, mean }),
        8 => instructions.run(Powers::<8> { signal, first, mean }),
        _ => {
            let [squares, _] = instructions.run(Powers::<2> { signal, first, mean });
            [squares, signal.iter().map(|x| (x - first - mean).powi(order)).sum()]
        }
    }
}

fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

fn total(lanes: [f64; LANES]) -> f64 {
    lanes.iter().sum()
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
    (Sums::of(signal).squares / signal.len() as f64).sqrt()
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
    Sums::of(signal).peak
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
    let sums = Sums::of(signal);
    let rms = (sums.squares / signal.len() as f64).sqrt();
    (rms > 0.0).then(|| sums.peak / rms)
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
    let [_, powers] = central_sums(signal, Sums::of(signal).mean_from_first(signal), order);
    powers / signal.len() as f64
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
/// None where the signal is constant (to rounding) or empty, and so has no shape, or where the moments are no numbers, which they are of
/// what [`check_channel`](super::check_channel) accepts. Without a correction for small
/// samples.
///
/// ```
/// use meshtone::signal::standardised_moment;
///
/// assert_eq!(standardised_moment(&[1.0, -1.0, 1.0, -1.0], 6), Some(1.0));
/// assert_eq!(standardised_moment(&[40.0; 8], 6), None);
/// ```
pub fn standardised_moment(signal: &[f64], order: i32) -> Option<f64> {
    let sums = Sums::of(signal);
    let [variance, moment] =
        central_sums(signal, sums.mean_from_first(signal), order).map(|sum| sum / signal.len() as f64);
    let deviation = variance.sqrt();
    // What differs by rounding only is no signal.
    let rounding = 4.0 * f64::EPSILON * sums.peak;
    // Without the root where there is none, as in NA4 of a single record.
    let scale = if order % 2 == 0 { variance.powi(order / 2) } else { deviation.powi(order) };
    (deviation > rounding && scale.is_normal()).then(|| moment / scale)
}

/// The straight line through values at equal distances, by least squares.
pub(crate) struct StraightLine {
    /// Mean of the values.
    pub mean: f64,
    /// Rise from one value to the next.
    pub slope: f64,
    /// Sum of the squares by which the values are off it.
    pub off: f64,
}

impl StraightLine {
    pub(crate) fn through(values: &[f64]) -> Self {
        let middle = 0.5 * (values.len() as f64 - 1.0);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let along = || values.iter().enumerate().map(|(i, value)| (i as f64 - middle, value - mean));
        let square: f64 = along().map(|(i, _)| i.powi(2)).sum();
        let slope = along().map(|(i, value)| i * value).sum::<f64>() / square;
        Self { mean, slope, off: along().map(|(i, value)| (value - slope * i).powi(2)).sum() }
    }
}

/// The middle one of the values in rising order, of an even count the upper one of the two; 0 of none.
pub(crate) fn upper_median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(middle, f64::total_cmp).1 }
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
