//! A test whether a signal is like any that was simulated.
//!
//! A conformal p-value (Vovk, Gammerman, Shafer, "Algorithmic learning in a random world", 2005): the part of the simulations that
//! are as far from those of other wheels as the recording is from all, or farther. The distance is that to the nearest of them, of
//! whitened principal components and of what these leave.

use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;

use crate::matrix::Standardisation;

/// Principal components that are whitened.
const COMPONENTS: usize = 40;
/// (standard deviations) Beyond which a feature is no farther away: one that is the same in all simulations must not decide alone.
const FARTHEST: f64 = 20.0;
/// Neighbours whose mean distance counts.
const NEIGHBOURS: usize = 8;

/// Simulations as points.
pub(crate) struct OutlierTest {
    standard: Standardisation,
    /// Principal components over their deviation, a column each.
    components: DMatrix<f64>,
    /// Standard deviation of what the components leave.
    left: f64,
    points: Vec<Vec<f64>>,
    units: Vec<u64>,
    weights: Vec<f64>,
    /// Distance of each simulation from those of other units.
    scores: Vec<f64>,
}

impl OutlierTest {
    /// # Arguments
    /// * `rows` - features of the simulations
    /// * `units` - the pair of wheels of each
    /// * `weights` - how often each is to be expected
    pub fn new(rows: &[Vec<f64>], units: Vec<u64>, weights: &[f64]) -> Self {
        let standard = Standardisation::of(rows);
        let width = rows.first().map_or(0, Vec::len);
        let matrix: Vec<Vec<f64>> = rows.iter().map(|row| standard.apply(row)).collect();
        let data = DMatrix::from_fn(width, rows.len(), |feature, row| matrix[row][feature]);
        let covariance = &data * data.transpose() / rows.len().max(1) as f64;
        let eigen = SymmetricEigen::new(covariance);
        let mut order: Vec<usize> = (0..width).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        order.truncate(COMPONENTS);
        let deviation = |at: usize| eigen.eigenvalues[at].max(1e-9).sqrt();
        let components = DMatrix::from_fn(width, order.len(), |feature, place| {
            eigen.eigenvectors[(feature, order[place])] / deviation(order[place])
        });
        let left = order.iter().map(|&at| eigen.eigenvalues[at]).sum::<f64>();
        let left = (eigen.eigenvalues.sum() - left).max(1e-9).sqrt();
        let mut of = Self {
            standard,
            components,
            left,
            points: Vec::new(),
            units,
            weights: weights.to_vec(),
            scores: Vec::new(),
        };
        of.points = rows.par_iter().map(|row| of.point(row)).collect();
        of.scores = (0..rows.len())
            .into_par_iter()
            .map(|row| of.distance(&of.points[row], Some(of.units[row])))
            .collect();
        of
    }

    /// Coordinates of a signal among the simulations.
    pub fn point(&self, row: &[f64]) -> Vec<f64> {
        let standard = self.standard.within(row, FARTHEST);
        let components = || self.components.column_iter();
        let places = components().map(|of| of.iter().zip(&standard).map(|(a, b)| a * b).sum());
        let mut point: Vec<f64> = places.collect();
        // The components' part of the squares, in the units of the features.
        let inside = components().zip(&point).map(|(component, place)| {
            (place / component.norm_squared().max(1e-30)).powi(2) * component.norm_squared()
        });
        let inside: f64 = inside.sum();
        let all: f64 = standard.iter().map(|value| value * value).sum();
        point.push(2.0 * (all - inside).max(0.0).sqrt() / self.left);
        point
    }

    fn distance(&self, point: &[f64], but: Option<u64>) -> f64 {
        let nearest = self.nearest(point, |row| Some(self.units[row]) != but, NEIGHBOURS);
        nearest.iter().map(|(distance, _)| distance).sum::<f64>() / nearest.len().max(1) as f64
    }

    /// The nearest simulations among some, with their distances, nearest first.
    pub fn nearest(&self, point: &[f64], among: impl Fn(usize) -> bool, count: usize) -> Vec<(f64, usize)> {
        let mut nearest: Vec<(f64, usize)> = Vec::with_capacity(count + 1);
        for (row, other) in self.points.iter().enumerate().filter(|(row, _)| among(*row)) {
            let square: f64 = other.iter().zip(point).map(|(a, b)| (a - b) * (a - b)).sum();
            if nearest.len() < count || nearest.last().is_some_and(|(farthest, _)| square < *farthest) {
                let place = nearest.partition_point(|(known, _)| *known <= square);
                nearest.insert(place, (square, row));
                nearest.truncate(count);
            }
        }
        nearest.into_iter().map(|(square, row)| (square.sqrt(), row)).collect()
    }

    /// (-) The part of the simulations that are as far from the others, or farther.
    ///
    /// # Arguments
    /// * `row` - features of the recording
    pub fn p_value(&self, row: &[f64]) -> f64 {
        let distance = self.distance(&self.point(row), None);
        let total: f64 = self.weights.iter().sum();
        let farther = self.scores.iter().zip(&self.weights).filter(|(score, _)| **score >= distance);
        let mean = total / self.weights.len().max(1) as f64;
        (farther.map(|(_, weight)| weight).sum::<f64>() + mean) / (total + mean)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};

    // Points on a line within noise in ten dimensions: new ones of the kind are as often below a p-value as it says, one beside the line
    // is not among them.
    #[test]
    fn p_values_are_uniform_and_small_beside_what_was_simulated() {
        let mut draws = Draws::new(2, Purpose::DiagnosisNoise, 0);
        let mut row = || -> Vec<f64> {
            let along = draws.normal();
            (0..10).map(|feature| along * f64::from(feature) + 0.2 * draws.normal()).collect()
        };
        let rows: Vec<Vec<f64>> = (0..600).map(|_| row()).collect();
        let units: Vec<u64> = (0..600).map(|number| number / 4).collect();
        let outside = OutlierTest::new(&rows, units, &[1.0; 600]);
        let mut values: Vec<f64> = (0..400).map(|_| outside.p_value(&row())).collect();
        values.sort_by(f64::total_cmp);
        // Kolmogorov and Smirnov: 1.63 / √400 is passed by one in a hundred.
        let apart = |(at, value): (usize, &f64)| ((at as f64 + 0.5) / 400.0 - value).abs();
        let farthest = values.iter().enumerate().map(apart).fold(0.0, f64::max);
        assert!(farthest < 0.0815, "{farthest}");
        let mut strange = row();
        strange[9] -= 3.0;
        assert!(outside.p_value(&strange) < 0.01);
    }
}
