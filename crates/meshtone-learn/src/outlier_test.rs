//! A test whether a signal is like any that was simulated.
//!
//! A conformal p-value (Vovk, Gammerman, Shafer, "Algorithmic learning in a random world", 2005): the part of the simulations that
//! are as strange as the recording, or stranger. Two numbers say how strange a signal is: its distance to the nearest simulations of
//! other wheels, of whitened principal components and of what these leave; and how far a single feature is beyond its values in nearly all
//! simulations, which the distance loses among many features. The rarer of the two counts.

use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;

use crate::fold::shuffled;
use crate::matrix::Standardisation;
use crate::quantile::quantiles;

/// Principal components that are whitened.
const COMPONENTS: usize = 40;
/// (standard deviations) Beyond which a feature is no farther away: one that is the same in all simulations must not decide alone.
const FARTHEST: f64 = 20.0;
/// (-) Parts of the simulations below and above which the values of a feature are looked at as beyond it.
const NEARLY_ALL: [f64; 2] = [0.002, 0.998];
/// (-) Least width of a feature's range: one that is the same in all simulations must not decide alone.
const LEAST_WIDTH: f64 = 0.1;
/// Neighbours whose mean distance counts.
const NEIGHBOURS: usize = 8;

/// Simulations as points.
pub struct OutlierTest {
    standard: Standardisation,
    /// Principal components over their deviation, a column each.
    components: DMatrix<f64>,
    /// Standard deviation of what the components leave.
    left: f64,
    points: Vec<Vec<f64>>,
    units: Vec<u64>,
    /// Whether a simulation is to be expected at all.
    counts: Vec<bool>,
    /// Range of each feature in nearly all simulations of either half of the units, which are drawn: a simulation is held against the
    /// half in which its unit is not.
    ranges: [Vec<[f64; 2]>; 2],
    /// Distances of the simulations from those of other units; how far they are beyond the ranges; the rarer of the two.
    by_distance: Ranking,
    by_feature: Ranking,
    by_rarer: Ranking,
}

/// Values of which the part is known that are as large as another, or larger.
#[derive(Default)]
pub struct Ranking {
    falling: Vec<f64>,
}

impl Ranking {
    /// Ranks the values of simulations.
    ///
    /// # Arguments
    /// * `values` - of simulations
    pub fn new(values: impl IntoIterator<Item = f64>) -> Self {
        let mut falling: Vec<f64> = values.into_iter().collect();
        falling.sort_by(|a, b| b.total_cmp(a));
        Self { falling }
    }

    /// (-) The part of the values that are as large as another, or larger, which is one more.
    ///
    /// # Arguments
    /// * `value` - of a recording
    pub fn p_value(&self, value: f64) -> f64 {
        let larger = self.falling.partition_point(|other| *other >= value);
        (larger + 1) as f64 / (self.falling.len() + 1) as f64
    }
}

impl OutlierTest {
    /// The test against some simulations.
    ///
    /// Each simulation is first asked itself, against those of other units, because only the ranks among these answers make a p-value of a distance. The ranges
    /// of single features are likewise of the half of the units in which the asked one is not.
    ///
    /// # Arguments
    /// * `rows` - features of the simulations
    /// * `units` - the pair of wheels of each
    /// * `counts` - whether each is to be expected at all: one that is not is a point, but no other is held against it
    pub fn new(rows: &[Vec<f64>], units: Vec<u64>, counts: Vec<bool>) -> Self {
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
        let range = |half: u64, feature: usize| {
            let inside = rows.iter().zip(&counts).zip(&units);
            let inside = inside.filter(|((_, counts), unit)| **counts && shuffled(**unit) % 2 == half);
            quantiles(inside.map(|((row, _), _)| (row[feature], 1.0)).collect(), NEARLY_ALL)
        };
        let ranges =
            [0, 1].map(|half| (0..width).into_par_iter().map(|feature| range(half, feature)).collect());
        let mut of = Self {
            standard,
            components,
            left,
            points: Vec::new(),
            units,
            counts,
            ranges,
            by_distance: Ranking::default(),
            by_feature: Ranking::default(),
            by_rarer: Ranking::default(),
        };
        of.points = rows.par_iter().map(|row| of.point(row)).collect();
        let places = || (0..rows.len()).into_par_iter();
        let distances: Vec<f64> =
            places().map(|row| of.distance(&of.points[row], Some(of.units[row]))).collect();
        let beyond: Vec<f64> =
            places().map(|row| of.beyond(&rows[row], 1 - (shuffled(of.units[row]) % 2) as usize)).collect();
        let expected = |values: &[f64]| {
            Ranking::new(
                values.iter().zip(&of.counts).filter(|(_, counts)| **counts).map(|(value, _)| *value),
            )
        };
        (of.by_distance, of.by_feature) = (expected(&distances), expected(&beyond));
        let rarer: Vec<f64> = places().map(|row| -of.rarer(distances[row], beyond[row])).collect();
        of.by_rarer = expected(&rarer);
        of
    }

    /// Coordinates of a signal among the simulations.
    ///
    /// # Arguments
    /// * `row` - features of the signal
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
        let nearest =
            self.nearest(point, &|row| self.counts[row] && Some(self.units[row]) != but, NEIGHBOURS);
        nearest.iter().map(|(distance, _)| distance).sum::<f64>() / nearest.len().max(1) as f64
    }

    /// (-) How far the strangest feature is beyond its range in a half of the simulations, over the width of this.
    fn beyond(&self, row: &[f64], half: usize) -> f64 {
        let beyond = |(value, [low, high]): (&f64, &[f64; 2])| {
            (low - value).max(value - high) / (high - low).max(LEAST_WIDTH)
        };
        row.iter().zip(&self.ranges[half]).map(beyond).fold(f64::NEG_INFINITY, f64::max)
    }

    /// (-) The rarer of the two ways to be strange.
    fn rarer(&self, distance: f64, beyond: f64) -> f64 {
        self.by_distance.p_value(distance).min(self.by_feature.p_value(beyond))
    }

    /// The nearest simulations among some: the distance and the number of each, nearest first.
    ///
    /// # Arguments
    /// * `point` - coordinates of a signal
    /// * `among` - whether a simulation counts, by its number
    /// * `count` - how many at most
    pub fn nearest(&self, point: &[f64], among: &dyn Fn(usize) -> bool, count: usize) -> Vec<(f64, usize)> {
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

    /// (-) The part of the simulations that are as strange, or stranger.
    ///
    /// # Arguments
    /// * `row` - features of the recording
    pub fn p_value(&self, row: &[f64]) -> f64 {
        let distance = self.distance(&self.point(row), None);
        let beyond = 0.5 * (self.beyond(row, 0) + self.beyond(row, 1));
        self.by_rarer.p_value(-self.rarer(distance, beyond))
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
        let outside = OutlierTest::new(&rows, units, vec![true; 600]);
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
