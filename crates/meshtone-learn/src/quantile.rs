//! Weighted quantiles.

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Median: the value is as likely larger as smaller.
    pub median: f64,
    /// It is within with a probability of 0.5.
    pub within_50: [f64; 2],
    /// It is within with a probability of 0.9.
    pub within_90: [f64; 2],
}

/// The median and the intervals of a weighted sample.
///
/// # Arguments
/// * `sample` - values and their weights, none of them negative; not empty
pub fn interval(sample: &[(f64, f64)]) -> Interval {
    let [lowest, low, median, high, highest] = quantiles(sample.to_vec(), [0.05, 0.25, 0.5, 0.75, 0.95]);
    Interval { median, within_50: [low, high], within_90: [lowest, highest] }
}

/// The mean of some values.
///
/// # Arguments
/// * `values` - not empty
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The middle one of some values, of an even number the mean of the middle two.
///
/// # Arguments
/// * `values` - in any order; of none NaN
pub fn median(values: &[f64]) -> f64 {
    quantiles(values.iter().map(|value| (*value, 1.0)).collect(), [0.5])[0]
}

/// The values below which parts of the weight of a sample lie, between its values along straight lines.
///
/// # Arguments
/// * `sample` - values and their weights, none of them negative
/// * `parts` - (-) of the weight, from 0 to 1
pub fn quantiles<const N: usize>(mut sample: Vec<(f64, f64)>, parts: [f64; N]) -> [f64; N] {
    sample.sort_by(|a, b| a.0.total_cmp(&b.0));
    parts.map(|part| quantile(&sample, part))
}

fn quantile(sorted: &[(f64, f64)], part: f64) -> f64 {
    let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
    let mut below = 0.0;
    let mut last: Option<(f64, f64)> = None;
    for &(value, weight) in sorted.iter().filter(|(_, weight)| *weight > 0.0) {
        let middle = (below + 0.5 * weight) / total.max(f64::MIN_POSITIVE);
        if middle >= part {
            return match last {
                Some((before, at)) if middle > at => before + (value - before) * (part - at) / (middle - at),
                _ => value,
            };
        }
        below += weight;
        last = Some((value, middle));
    }
    last.map_or(f64::NAN, |(value, _)| value)
}

#[cfg(test)]
mod tests {
    use super::*;

    // Of the numbers 1 to 100 by their plotting positions (i − ½)/100 (Hazen).
    #[test]
    fn quantiles_of_equal_weights() {
        let sample: Vec<(f64, f64)> = (1..=100).rev().map(|value| (f64::from(value), 1.0)).collect();
        let interval = interval(&sample);
        assert!((interval.median - 50.5).abs() < 1e-9);
        assert!((interval.within_90[0] - 5.5).abs() < 1e-9 && (interval.within_90[1] - 95.5).abs() < 1e-9);
    }

    #[test]
    fn a_value_without_weight_counts_nothing() {
        let interval = interval(&[(1.0, 1.0), (2.0, 1.0), (3.0, 1.0), (1000.0, 0.0)]);
        assert_eq!(interval.median, 2.0);
        assert!(interval.within_90[1] <= 3.0);
    }
}
