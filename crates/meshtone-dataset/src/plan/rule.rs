//! Rules that say how keys vary.

use meshtone::scenario::key_of_both_wheels;

use crate::expression::Expression;
use crate::sampling::{normal_distribution, normal_quantile};

/// The group that a value is drawn for: a unit, a mounting or a record. The one that comprises most records comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Once for all records of a unit.
    Unit,
    /// Once for all records of a mounting. A unit that is taken apart and put together again has a new mounting.
    Mounting,
    /// For each record.
    Record,
}

meshtone_toml::named!(Level { Unit = "unit", Mounting = "mounting", Record = "record" });

/// A rule by which one key, or several together, vary.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Dotted keys of the scenario file, or of the plan alone: [`crate::draw::is_of_plan`].
    pub keys: Vec<String>,
    /// What a value is drawn for.
    pub level: Level,
    /// What is drawn.
    pub distribution: Distribution,
    /// The drawn number is multiplied by this.
    pub times: Option<Expression>,
    /// This is added after the multiplication.
    pub plus: Option<Expression>,
}

/// Returns whether two keys set the same number, or one of them sets it for one wheel of a pair and the other for both wheels.
pub(crate) fn overlap(key: &str, other: &str) -> bool {
    let is_part = |key: &str, of: &str| key_of_both_wheels(key).as_deref() == Some(of);
    key == other || is_part(key, other) || is_part(other, key)
}

impl Rule {
    /// Returns whether the rule varies a key, or a part of its number.
    pub(crate) fn varies(&self, key: &str) -> bool {
        self.keys.iter().any(|own| overlap(own, key))
    }
}

/// The distribution that a value is drawn from. Rows hold one number for each of the rule's keys.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// One value.
    Fixed(f64),
    /// The values in turn; of several such rules, every combination in turn.
    Grid(Vec<Vec<f64>>),
    /// One of the values.
    Choice {
        /// The values.
        rows: Vec<Vec<f64>>,
        /// Their weights, all the same by default; none of them negative.
        weights: Vec<f64>,
    },
    /// Uniform between two numbers.
    Uniform([f64; 2]),
    /// Its logarithm is uniform between those of two numbers.
    LogUniform([f64; 2]),
    /// Normal, truncated to the range between two numbers.
    Normal {
        /// Mean, before it was truncated.
        mean: f64,
        /// Standard deviation, before it was truncated.
        standard_deviation: f64,
        /// The least and the largest value.
        within: [f64; 2],
    },
}

impl Distribution {
    /// The name of the distribution in a plan.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Fixed(_) => "fixed",
            Self::Grid(_) => "grid",
            Self::Choice { .. } => "choice",
            Self::Uniform(_) => "uniform",
            Self::LogUniform(_) => "log_uniform",
            Self::Normal { .. } => "normal",
        }
    }

    /// The rows of values that are listed; none of a range.
    pub(crate) fn rows(&self) -> Vec<&[f64]> {
        match self {
            Self::Fixed(value) => vec![std::slice::from_ref(value)],
            Self::Grid(rows) | Self::Choice { rows, .. } => rows.iter().map(Vec::as_slice).collect(),
            Self::Uniform(_) | Self::LogUniform(_) | Self::Normal { .. } => Vec::new(),
        }
    }

    /// The least and the largest value for the first key.
    pub(crate) fn range(&self) -> [f64; 2] {
        match self {
            Self::Uniform(range) | Self::LogUniform(range) | Self::Normal { within: range, .. } => *range,
            Self::Fixed(_) | Self::Grid(_) | Self::Choice { .. } => self
                .rows()
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], row| [a.min(row[0]), b.max(row[0])]),
        }
    }

    /// Returns whether a coordinate of the design decides the value.
    pub fn is_drawn(&self) -> bool {
        !matches!(self, Self::Fixed(_) | Self::Grid(_))
    }

    /// The values at a coordinate, one for each key.
    ///
    /// # Arguments
    /// * `uniform` - coordinate of the design, from 0 to less than 1
    /// * `place` - which of a grid's values
    ///
    /// ```
    /// use meshtone_dataset::plan::Distribution;
    ///
    /// assert_eq!(Distribution::Uniform([10.0, 60.0]).at(0.5, 0), [35.0]);
    /// assert_eq!(Distribution::Grid(vec![vec![1.0], vec![2.0]]).at(0.0, 1), [2.0]);
    /// let normal = Distribution::Normal { mean: 5.0, standard_deviation: 1.0, within: [4.0, 6.0] };
    /// assert!((normal.at(0.5, 0)[0] - 5.0).abs() < 1e-12);
    /// assert!((normal.at(0.0, 0)[0] - 4.0).abs() < 1e-12);
    /// ```
    pub fn at(&self, uniform: f64, place: usize) -> Vec<f64> {
        match self {
            Self::Fixed(value) => vec![*value],
            Self::Grid(rows) => rows[place % rows.len()].clone(),
            Self::Choice { rows, weights } => {
                let mut left = uniform * weights.iter().sum::<f64>();
                let chosen = weights.iter().position(|weight| {
                    left -= weight;
                    left < 0.0
                });
                // Rounding may leave a remainder after the last value.
                let last = weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0);
                rows[chosen.unwrap_or(last)].clone()
            }
            Self::Uniform([least, largest]) => vec![least + uniform * (largest - least)],
            Self::LogUniform([least, largest]) => {
                let (from, to) = (libm::log(*least), libm::log(*largest));
                vec![libm::exp(from + uniform * (to - from)).clamp(*least, *largest)]
            }
            Self::Normal { mean, standard_deviation, within: [least, largest] } => {
                // Computed from the nearer tail, where the distribution is accurate.
                let sign = if least > mean { -1.0 } else { 1.0 };
                let part = |value: f64| normal_distribution(sign * (value - mean) / standard_deviation);
                let (from, to) = (part(*least), part(*largest));
                let value = mean + sign * standard_deviation * normal_quantile(from + uniform * (to - from));
                vec![value.clamp(*least, *largest)]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(distribution: &Distribution, count: u32) -> Vec<f64> {
        (0..count).map(|i| distribution.at((f64::from(i) + 0.5) / f64::from(count), 0)[0]).collect()
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    // Closed forms of the means.
    #[test]
    fn means() {
        let log = values(&Distribution::LogUniform([1.0, 50.0]), 10_000);
        assert!((mean(&log) - 49.0 / 50f64.ln()).abs() < 1e-3);
        let (least, largest) = (6.0, 9.0);
        let normal = Distribution::Normal { mean: 5.0, standard_deviation: 2.0, within: [least, largest] };
        let density = |x: f64| (-0.5 * x * x).exp() / std::f64::consts::TAU.sqrt();
        let (a, b) = (0.5, 2.0);
        let part = normal_distribution(b) - normal_distribution(a);
        let expected = 5.0 + 2.0 * (density(a) - density(b)) / part;
        assert!((mean(&values(&normal, 10_000)) - expected).abs() < 1e-3);
    }

    #[test]
    fn a_far_tail_keeps_its_digits() {
        let normal = Distribution::Normal { mean: 0.0, standard_deviation: 1.0, within: [12.0, 13.0] };
        let drawn = values(&normal, 100);
        assert!(
            drawn.windows(2).all(|pair| pair[0] < pair[1]) && drawn.iter().all(|x| (12.0..=13.0).contains(x))
        );
        assert!((mean(&drawn) - 12.08).abs() < 0.02);
    }

    #[test]
    fn weights() {
        let rows = [5.0, 6.0, 7.0, 8.0].map(|x| vec![x]).to_vec();
        let choice = Distribution::Choice { rows, weights: vec![1.0, 0.0, 3.0, 0.0] };
        let drawn = values(&choice, 400);
        let count = |value: f64| drawn.iter().filter(|&&x| x == value).count();
        assert_eq!([5.0, 6.0, 7.0, 8.0].map(count), [100, 0, 300, 0]);
    }
}
