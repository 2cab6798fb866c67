//! Probabilities of the classes of a data set for records beside healthy ones.

use meshtone_learn::{ExtraTrees, OutlierTest, median};

use super::rows::Rows;
use crate::error::DatasetError;

/// Label of records without damage.
pub(super) const HEALTHY: &str = "healthy";
/// (-) Part of the weight that healthy records have; the classes of damage share the rest evenly.
const HEALTHY_WEIGHT: f64 = 0.5;

/// A classifier of the records of a data set.
pub(super) struct Detector {
    /// Its classes, the healthy one first.
    pub labels: Vec<String>,
    /// Whether records are compared with healthy ones.
    is_beside: bool,
    /// Numbers of the features that all records have, and their medians.
    features: Vec<(usize, f64)>,
    trees: ExtraTrees,
    /// Whether differences from healthy records are like those of simulations; what records are themselves is the machine's own.
    outside: Option<OutlierTest>,
}

impl Detector {
    /// Learns from the records of a data set.
    ///
    /// The trees learn the classes of these records alone. Whether a record is like any simulation is asked of those of the other machines, too, since a real
    /// machine differs from the scenario as they do.
    ///
    /// # Arguments
    /// * `rows` - the records, with their labels
    /// * `others` - records of machines that differ from it
    /// * `is_beside` - whether they are compared with healthy ones of their unit, or taken as they are
    ///
    /// # Errors
    /// A single class; records from which nothing can be learnt.
    pub fn learn(rows: &Rows, others: &Rows, is_beside: bool) -> Result<Self, DatasetError> {
        let refused = |why: String| {
            let problem = format!("nothing can be learnt from the records: {why}");
            DatasetError::refused(problem, "simulate more units")
        };
        let values = features(rows, is_beside, &|row| rows.is_healthy(row));
        // A record without another healthy one of its unit, as where simulations failed, has no differences.
        let rows = rows.filter(|row| values[row].iter().any(|value| value.is_finite()));
        let values = features(&rows, is_beside, &|row| rows.is_healthy(row));
        let mut labels: Vec<String> = rows.labels.iter().flatten().cloned().collect();
        labels.sort_unstable_by_key(|label| (label != HEALTHY, label.clone()));
        labels.dedup();
        let place = |label: &Option<String>| labels.iter().position(|known| Some(known) == label.as_ref());
        let classes: Vec<usize> = rows.labels.iter().filter_map(place).collect();
        let damaged = labels.len() as f64 - 1.0;
        let weight = |class: usize| {
            let part = if class == 0 { HEALTHY_WEIGHT } else { (1.0 - HEALTHY_WEIGHT) / damaged };
            part / classes.iter().filter(|of| **of == class).count() as f64
        };
        let weights: Vec<f64> = (0..labels.len()).map(weight).collect();
        let width = values.first().map_or(0, Vec::len);
        let column = |feature: usize| values.iter().map(|row| row[feature]).collect::<Vec<f64>>();
        let features = (0..width).filter_map(|feature| {
            let column = column(feature);
            column.iter().all(|value| value.is_finite()).then(|| (feature, median(&column)))
        });
        let features: Vec<(usize, f64)> = features.collect();
        if features.is_empty() {
            return Err(refused("no indicator has a value in all of them".to_owned()));
        }
        let values: Vec<Vec<f64>> = values.iter().map(|row| known(row, &features)).collect();
        let trees = ExtraTrees::learn(&values, &classes, &weights, 1);
        let trees = trees.map_err(|error| refused(error.to_string()))?;
        let mut detector = Self { labels, is_beside, features, trees, outside: None };
        if is_beside {
            let all = rows.with(others);
            let known = detector.features(&all, &|row| all.is_healthy(row));
            let expected = vec![true; known.len()];
            detector.outside = Some(OutlierTest::new(&known, all.units, expected));
        }
        Ok(detector)
    }

    /// The features of some records, each beside the healthy ones of its unit.
    ///
    /// # Arguments
    /// * `rows` - the records
    /// * `healthy` - whether a record is known to be healthy
    pub fn features(&self, rows: &Rows, healthy: &dyn Fn(usize) -> bool) -> Vec<Vec<f64>> {
        features(rows, self.is_beside, healthy).iter().map(|row| known(row, &self.features)).collect()
    }

    /// (-) The probabilities of the classes for records with these features.
    pub fn probabilities(&self, features: &[Vec<f64>]) -> Vec<Vec<f64>> {
        features.iter().map(|row| self.trees.probabilities(row)).collect()
    }

    /// (-) The part of the simulations that are as strange as records with these features, or stranger; 1 where records are taken as they are.
    pub fn p_values(&self, features: &[Vec<f64>]) -> Vec<f64> {
        let p_value = |row: &Vec<f64>| self.outside.as_ref().map_or(1.0, |test| test.p_value(row));
        features.iter().map(p_value).collect()
    }
}

/// The features of all records.
fn features(rows: &Rows, is_beside: bool, healthy: &dyn Fn(usize) -> bool) -> Vec<Vec<f64>> {
    if is_beside { rows.beside_healthy(healthy) } else { rows.values.clone() }
}

/// The features of a row that a detector uses; the median for what the row has no value of.
fn known(row: &[f64], features: &[(usize, f64)]) -> Vec<f64> {
    let value =
        |&(feature, median): &(usize, f64)| if row[feature].is_finite() { row[feature] } else { median };
    features.iter().map(value).collect()
}

/// (-) The score that at most one in twenty healthy records exceeds: of fewer than nineteen the largest, which the next one exceeds with a
/// probability of one over their number and one.
///
/// # Arguments
/// * `healthy` - scores of healthy records; of none the threshold is 1
pub(super) fn threshold(healthy: &[f64]) -> f64 {
    let mut scores = healthy.to_vec();
    scores.sort_by(f64::total_cmp);
    let rank = (0.95 * (scores.len() + 1) as f64).ceil() as usize;
    scores.get(rank.clamp(1, scores.len().max(1)) - 1).copied().unwrap_or(1.0)
}
