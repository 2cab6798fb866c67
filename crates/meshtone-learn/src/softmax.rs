//! Probabilities from scores: multinomial logistic regression.

use argmin::core::{CostFunction, Error, Executor, Gradient, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::LearnError;

/// Penalty of the squares of the slopes.
const PENALTY: f64 = 1.0;
/// Factor of the scores: those of a regression on 0 and 1 differ by less than 1.
const SCALE: f64 = 5.0;
const MOST_ITERATIONS: u64 = 200;
const MEMORY: usize = 10;
/// The slope of the mean cost at which the search ends.
const TOLERANCE: f64 = 1e-6;
/// Rows whose gradients are computed together.
const CHUNK: usize = 512;

/// Probabilities of classes from their scores.
#[derive(Debug, Clone)]
pub struct Softmax {
    /// A row for each class: a slope for each score, and the intercept.
    parameters: Vec<f64>,
    classes: usize,
}

impl Softmax {
    /// Fits probabilities to scores.
    ///
    /// # Arguments
    /// * `scores` - a column for each row of data, a score for each class
    /// * `classes` - the true class of each
    /// * `weights` - of each
    ///
    /// # Errors
    /// A search that found nothing.
    pub fn fit(scores: &DMatrix<f64>, classes: &[usize], weights: &[f64]) -> Result<Self, LearnError> {
        let count = scores.nrows();
        let problem = Problem { scores, classes, weights };
        let start: Vec<f64> = (0..count * (count + 1))
            .map(|at| if at % (count + 1) == at / (count + 1) { 1.0 } else { 0.0 })
            .collect();
        let solver = LBFGS::new(MoreThuenteLineSearch::new(), MEMORY)
            .with_tolerance_grad(TOLERANCE)
            .and_then(|solver| solver.with_tolerance_cost(TOLERANCE * TOLERANCE))
            .map_err(|_| LearnError::NotSolved)?;
        let found = Executor::new(problem, solver)
            .configure(|state| state.param(start).max_iters(MOST_ITERATIONS))
            .run()
            .map_err(|_| LearnError::NotSolved)?;
        let parameters = found.state.get_best_param().cloned().ok_or(LearnError::NotSolved)?;
        Ok(Self { parameters, classes: count })
    }

    /// (-) The probabilities of all classes.
    ///
    /// # Arguments
    /// * `scores` - of a signal, one for each class
    pub fn probabilities(&self, scores: &[f64]) -> Vec<f64> {
        probabilities(&self.parameters, self.classes, scores)
    }
}

fn probabilities(parameters: &[f64], classes: usize, scores: &[f64]) -> Vec<f64> {
    let of_class = |row: &[f64]| {
        let sum: f64 = row.iter().zip(scores).map(|(slope, score)| SCALE * slope * score).sum();
        sum + row[classes]
    };
    let logits: Vec<f64> = parameters.chunks_exact(classes + 1).map(of_class).collect();
    let most = logits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let parts: Vec<f64> = logits.iter().map(|logit| (logit - most).exp()).collect();
    let sum: f64 = parts.iter().sum();
    parts.into_iter().map(|part| part / sum).collect()
}

struct Problem<'a> {
    scores: &'a DMatrix<f64>,
    classes: &'a [usize],
    weights: &'a [f64],
}

impl Problem<'_> {
    /// Cost and gradient; in a fixed order, whatever the number of threads.
    fn both(&self, parameters: &[f64]) -> (f64, Vec<f64>) {
        let classes = self.scores.nrows();
        let rows: Vec<usize> = (0..self.classes.len()).collect();
        let parts: Vec<(f64, Vec<f64>)> = rows
            .par_chunks(CHUNK)
            .map(|rows| {
                let (mut cost, mut gradient) = (0.0, vec![0.0; parameters.len()]);
                for &row in rows {
                    let column = self.scores.column(row);
                    let scores = column.as_slice();
                    let of_classes = probabilities(parameters, classes, scores);
                    let (class, weight) = (self.classes[row], self.weights[row]);
                    cost -= weight * of_classes[class].max(f64::MIN_POSITIVE).ln();
                    for (other, part) in gradient.chunks_exact_mut(classes + 1).enumerate() {
                        let beyond = weight * (of_classes[other] - f64::from(u8::from(other == class)));
                        part.iter_mut().zip(scores).for_each(|(sum, score)| *sum += beyond * SCALE * score);
                        part[classes] += beyond;
                    }
                }
                (cost, gradient)
            })
            .collect();
        let mut cost = 0.0;
        let mut gradient = vec![0.0; parameters.len()];
        for (of_part, slopes) in parts {
            cost += of_part;
            gradient.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += slope);
        }
        for (at, (sum, value)) in gradient.iter_mut().zip(parameters).enumerate() {
            if at % (classes + 1) != classes {
                cost += 0.5 * PENALTY * value * value;
                *sum += PENALTY * value;
            }
        }
        // The mean: so its tolerances mean the same for any number of rows.
        let total: f64 = self.weights.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        gradient.iter_mut().for_each(|slope| *slope /= total);
        (cost / total, gradient)
    }
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, parameters: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.both(parameters).0)
    }
}

impl Gradient for Problem<'_> {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, parameters: &Vec<f64>) -> Result<Vec<f64>, Error> {
        Ok(self.both(parameters).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::random::{Draws, Purpose};

    // Three classes, drawn with the probabilities that a known softmax of two scores and nothing gives.
    #[test]
    fn known_probabilities_are_found() {
        const COUNT: usize = 4000;
        let known = |scores: [f64; 3]| {
            let powers = scores.map(|score| (3.0 * score).exp());
            powers.map(|power| power / powers.iter().sum::<f64>())
        };
        let mut draws = Draws::new(7, Purpose::DiagnosisNoise, 0);
        let mut scores = DMatrix::zeros(3, COUNT);
        let mut classes = Vec::new();
        for row in 0..COUNT {
            let drawn = [draws.uniform(0.0, 1.0), draws.uniform(0.0, 1.0), 0.0];
            let [first, second, _] = known(drawn);
            let at = draws.uniform(0.5, 0.5);
            classes.push(if at < first {
                0
            } else if at < first + second {
                1
            } else {
                2
            });
            scores.column_mut(row).copy_from_slice(&drawn);
        }
        let fitted = Softmax::fit(&scores, &classes, &[1.0; COUNT]).unwrap();
        for scores in [[0.5, -0.5, 0.0], [-0.8, 0.2, 0.0], [0.0, 0.0, 0.0]] {
            let found = fitted.probabilities(&scores);
            for (found, known) in found.iter().zip(known(scores)) {
                assert!((found - known).abs() < 0.04, "{scores:?}: {found} of {known}");
            }
        }
    }
}
