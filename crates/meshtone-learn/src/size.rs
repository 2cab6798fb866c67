//! The size of a damage, given its kind: approximate Bayesian computation on a summary that was learnt.
//!
//! The summary of a signal is what a ridge regression predicts of the size (Fearnhead and Prangle 2012). Of every simulation it is
//! the prediction by those of other wheels, so that it errs as much as that of the recording. The sizes of the simulations whose
//! summaries are nearest are brought to the recording's summary by a local linear regression (Beaumont et al. 2002).
//!
//! Sources: M. A. Beaumont, W. Zhang, D. J. Balding, Genetics 162 (2002) 2025–2035; P. Fearnhead, D. Prangle, J. R. Stat. Soc. B 74
//! (2012) 419–474.

use nalgebra::DMatrix;

use crate::LearnError;
use crate::matrix::{Ridge, dual_ridge};
use crate::quantile::mean;

/// Penalties that are tried, as parts of the number of rows; the one that predicts the other wheels best is taken.
const PENALTIES: [f64; 5] = [0.03, 0.1, 0.3, 1.0, 3.0];
/// (-) Part of the simulations of a kind that count as near.
const NEAR: f64 = 0.35;
/// The fewest of them.
const FEWEST: usize = 40;
/// Fewest simulations of a class that can be learnt from.
const FEWEST_TO_LEARN: usize = 8;

/// Model of one number of a damage.
pub struct SizeModel {
    /// The number of each simulation.
    values: Vec<f64>,
    /// Prediction for each record by those of other wheels.
    predicted: Vec<f64>,
    /// Coefficients of the regression on the features.
    coefficients: Vec<f64>,
    /// The least and the largest value that was simulated.
    range: [f64; 2],
}

impl SizeModel {
    /// Models of several numbers of the damages of one class.
    ///
    /// # Arguments
    /// * `features` - of the simulations with the damage, a column each
    /// * `numbers` - for each number its value of each simulation
    /// * `folds` - which part each simulation is in
    ///
    /// # Errors
    /// Too few simulations; features that are not finite.
    pub fn fit(
        features: &DMatrix<f64>,
        numbers: &[Vec<f64>],
        folds: &[usize],
    ) -> Result<Vec<Self>, LearnError> {
        let count = folds.len();
        if count < FEWEST_TO_LEARN {
            return Err(LearnError::TooFewRows);
        }
        let targets = DMatrix::from_fn(numbers.len(), count, |target, row| {
            numbers[target][row] - mean(&numbers[target])
        });
        let fit = |penalty: f64| dual_ridge(features, &targets, folds, penalty * count as f64);
        let fits: Vec<Ridge> = PENALTIES.into_iter().map(fit).collect::<Result<_, _>>()?;
        let model = |(target, values): (usize, &Vec<f64>)| {
            let error = |fit: &Ridge| (fit.out_of_fold.row(target) - targets.row(target)).norm_squared();
            let best = fits.iter().min_by(|a, b| error(a).total_cmp(&error(b)))?;
            Some(Self {
                values: values.clone(),
                predicted: best.out_of_fold.row(target).iter().copied().collect(),
                coefficients: best.coefficients.column(target).iter().copied().collect(),
                range: ends(values.iter().copied()),
            })
        };
        Ok(numbers.iter().enumerate().filter_map(model).collect())
    }

    /// Posterior of the number: values with their weights.
    ///
    /// # Arguments
    /// * `features` - of the recording
    pub fn posterior(&self, features: &[f64]) -> Vec<(f64, f64)> {
        self.near(self.coefficients.iter().zip(features).map(|(a, b)| a * b).sum(), None)
    }

    /// The posterior of a simulation by those of other wheels.
    #[cfg(test)]
    pub fn posterior_of(&self, row: usize) -> Vec<(f64, f64)> {
        self.near(self.predicted[row], Some(row))
    }

    /// The values of those whose summaries are near one, brought to it.
    fn near(&self, at: f64, but: Option<usize>) -> Vec<(f64, f64)> {
        // Beyond all that was simulated the nearest are all on one side: the recording counts as the outermost.
        let mut distances: Vec<(f64, usize)> = (0..self.values.len())
            .filter(|&row| Some(row) != but)
            .map(|row| ((self.predicted[row] - at).abs(), row))
            .collect();
        distances.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = ((NEAR * self.values.len() as f64) as usize).max(FEWEST).min(distances.len());
        let width = distances[count - 1].0.max(f64::MIN_POSITIVE) * (1.0 + 1e-9);
        // The weights are those of Epanechnikov's kernel.
        let weighted = |&(distance, row): &(f64, usize)| {
            (self.predicted[row], self.values[row], 1.0 - (distance / width).powi(2))
        };
        let near: Vec<(f64, f64, f64)> = distances[..count].iter().map(weighted).collect();
        let total: f64 = near.iter().map(|(_, _, weight)| weight).sum();
        let mean =
            |of: fn(&(f64, f64, f64)) -> f64| near.iter().map(|row| of(row) * row.2).sum::<f64>() / total;
        let (summary, value) = (mean(|row| row.0), mean(|row| row.1));
        let across: f64 = near.iter().map(|row| row.2 * (row.0 - summary).powi(2)).sum();
        let along: f64 = near.iter().map(|row| row.2 * (row.0 - summary) * (row.1 - value)).sum();
        let slope = if across > 0.0 { (along / across).clamp(0.0, 2.0) } else { 0.0 };
        let [lowest, highest] = ends(near.iter().map(|row| row.0));
        let bounded = at.clamp(lowest, highest);
        let [least, largest] = self.range;
        let brought =
            |row: &(f64, f64, f64)| ((row.1 + slope * (bounded - row.0)).clamp(least, largest), row.2);
        near.iter().map(brought).collect()
    }
}

/// The least and the largest of some values.
fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};

    // A number seen with noise: the intervals of each by the others hold it as often as they say.
    #[test]
    fn intervals_hold_as_often_as_they_say() {
        const COUNT: usize = 400;
        let mut draws = Draws::new(5, Purpose::DiagnosisNoise, 0);
        let values: Vec<f64> = (0..COUNT).map(|_| draws.uniform(0.5, 0.5)).collect();
        let seen: Vec<[f64; 2]> =
            values.iter().map(|value| draws.normals().map(|noise| value + 0.2 * noise)).collect();
        let features =
            DMatrix::from_fn(3, COUNT, |feature, row| if feature < 2 { seen[row][feature] } else { 1.0 });
        let folds: Vec<usize> = (0..COUNT).map(|row| row % crate::fold::FOLDS).collect();
        let models = SizeModel::fit(&features, std::slice::from_ref(&values), &folds).unwrap();
        let within = |row: usize, part: fn(&crate::quantile::Interval) -> [f64; 2]| {
            let [low, high] = part(&crate::quantile::interval(&models[0].posterior_of(row)));
            low <= values[row] && values[row] <= high
        };
        let half = (0..COUNT).filter(|&row| within(row, |of| of.within_50)).count() as f64 / COUNT as f64;
        let most = (0..COUNT).filter(|&row| within(row, |of| of.within_90)).count() as f64 / COUNT as f64;
        assert!((half - 0.5).abs() < 0.06 && (most - 0.9).abs() < 0.04, "{half} {most}");
    }
}
