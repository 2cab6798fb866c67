//! Ridge regression, each part of the rows predicted by the others.

use meshtone::random::{Draws, Purpose};
use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use crate::LearnError;
use crate::fold::FOLDS;

/// The deviation of a feature that is the same in all simulations: logarithms and shapes differ by more where they differ.
const LEAST_DEVIATION: f64 = 1e-3;

/// Each feature less its mean, over its standard deviation, and within bounds.
#[derive(Debug, Clone)]
pub struct Standardisation {
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl Standardisation {
    /// Standard deviations beyond which a feature is no farther away.
    const MOST: f64 = 5.0;

    /// The mean and the standard deviation of each feature.
    ///
    /// # Arguments
    /// * `rows` - features of the simulations
    pub fn of(rows: &[Vec<f64>]) -> Self {
        let (count, width) = (rows.len().max(1) as f64, rows.first().map_or(0, Vec::len));
        let of_feature = |at: usize| {
            let mean: f64 = rows.iter().map(|row| row[at] / count).sum();
            let variance: f64 = rows.iter().map(|row| (row[at] - mean).powi(2) / count).sum();
            (mean, variance.sqrt().max(LEAST_DEVIATION))
        };
        let (mean, deviation) = (0..width).map(of_feature).unzip();
        Self { mean, deviation }
    }

    /// Standardises a row, within five standard deviations.
    ///
    /// # Arguments
    /// * `row` - features of a signal
    pub fn apply(&self, row: &[f64]) -> Vec<f64> {
        self.within(row, Self::MOST)
    }

    /// Standardises a row within other bounds.
    ///
    /// # Arguments
    /// * `row` - features of a signal
    /// * `most` - (standard deviations) beyond which a feature is no farther away
    pub fn within(&self, row: &[f64], most: f64) -> Vec<f64> {
        let of = |((value, mean), deviation): ((&f64, &f64), &f64)| {
            ((value - mean) / deviation).clamp(-most, most)
        };
        row.iter().zip(&self.mean).zip(&self.deviation).map(of).collect()
    }
}

/// Random Fourier features of a Gaussian kernel beside the standardised features themselves.
///
/// Source: A. Rahimi, B. Recht, "Random features for large-scale kernel machines", NIPS 20 (2007).
#[derive(Debug, Clone)]
pub struct RandomFeatures {
    standard: Standardisation,
    /// A direction for each feature, in its column.
    directions: DMatrix<f64>,
    phases: DVector<f64>,
}

impl RandomFeatures {
    /// Width of the kernel, in root mean square distances from the mean.
    const WIDTH: f64 = 2.0;
    /// (-) What a linear feature counts beside them.
    const LINEAR: f64 = 0.5;

    /// Draws the directions.
    ///
    /// # Arguments
    /// * `rows` - features of the simulations
    /// * `count` - number of random ones
    /// * `seed` - of the draws
    pub fn new(rows: &[Vec<f64>], count: usize, seed: u64) -> Self {
        let width = rows.first().map_or(0, Vec::len);
        let mut directions = DMatrix::zeros(width, count);
        let mut phases = DVector::zeros(count);
        let scale = 1.0 / (Self::WIDTH * (width.max(1) as f64).sqrt());
        for index in 0..count {
            let mut draws = Draws::new(seed, Purpose::DiagnosisFeature, index as u64);
            phases[index] = draws.uniform(0.0, std::f64::consts::PI);
            directions.column_mut(index).iter_mut().for_each(|value| *value = scale * draws.normal());
        }
        Self { standard: Standardisation::of(rows), directions, phases }
    }

    /// The features of some rows, a column each: random ones, linear ones, and 1.
    ///
    /// # Arguments
    /// * `rows` - features of signals
    pub fn of(&self, rows: &[Vec<f64>]) -> DMatrix<f64> {
        let (width, count) = self.directions.shape();
        let rows: Vec<Vec<f64>> = rows.iter().map(|row| self.standard.apply(row)).collect();
        let linear = DMatrix::from_fn(width, rows.len(), |feature, row| rows[row][feature]);
        let projected = self.directions.transpose() * &linear;
        let amplitude = (2.0 * width as f64 / count.max(1) as f64).sqrt();
        DMatrix::from_fn(count + width + 1, rows.len(), |feature, row| {
            if feature < count {
                amplitude * (projected[(feature, row)] + self.phases[feature]).cos()
            } else if feature < count + width {
                Self::LINEAR * linear[(feature - count, row)]
            } else {
                1.0
            }
        })
    }
}

/// Products of the features with each other, and with the targets.
type NormalEquations = (DMatrix<f64>, DMatrix<f64>);

/// A ridge regression of several targets.
pub struct Ridge {
    /// Coefficients: a row for each feature, a column for each target.
    pub coefficients: DMatrix<f64>,
    /// Predictions of every row by the regression on the other parts: a row for each target.
    pub out_of_fold: DMatrix<f64>,
}

/// Fits targets to features by weighted least squares with a penalty.
///
/// The normal equations are set up for each fold once. Their sum over all folds gives the coefficients, and the sums without one fold
/// predict the rows of that fold, which so had no part in their own prediction.
///
/// # Arguments
/// * `features` - a column for each row of data
/// * `targets` - likewise
/// * `weights` - of the rows
/// * `folds` - which part each row is in, below [`FOLDS`]
/// * `penalty` - of a coefficient's square
///
/// # Errors
/// Normal equations that cannot be solved: features that are not finite.
pub fn ridge(
    features: &DMatrix<f64>,
    targets: &DMatrix<f64>,
    weights: &[f64],
    folds: &[usize],
    penalty: f64,
) -> Result<Ridge, LearnError> {
    let width = features.nrows();
    let normal: Vec<NormalEquations> = (0..FOLDS)
        .into_par_iter()
        .map(|fold| {
            let rows: Vec<usize> = (0..folds.len()).filter(|&row| folds[row] == fold).collect();
            let root = |row: usize| weights[row].sqrt();
            let of = |from: &DMatrix<f64>| {
                DMatrix::from_fn(from.nrows(), rows.len(), |i, j| from[(i, rows[j])] * root(rows[j]))
            };
            let (f, t) = (of(features), of(targets));
            let transposed = f.transpose();
            (&f * &transposed, &f * t.transpose())
        })
        .collect();
    // All parts but one; of as many as there are parts, all.
    let solve = |but: usize| -> Result<DMatrix<f64>, LearnError> {
        let kept = normal.iter().enumerate().filter(|(fold, _)| *fold != but).map(|(_, pair)| pair.clone());
        let sum = kept.reduce(|(gram, right), (more, more_right)| (gram + more, right + more_right));
        let (mut gram, right) = sum.ok_or(LearnError::TooFewRows)?;
        (0..width).for_each(|feature| gram[(feature, feature)] += penalty);
        Ok(Cholesky::new(gram).ok_or(LearnError::NotSolved)?.solve(&right))
    };
    let solved: Vec<DMatrix<f64>> = (0..=FOLDS).into_par_iter().map(solve).collect::<Result<_, _>>()?;
    let mut out_of_fold = DMatrix::zeros(targets.nrows(), targets.ncols());
    for (fold, coefficients) in solved.iter().take(FOLDS).enumerate() {
        let rows: Vec<usize> = (0..folds.len()).filter(|&row| folds[row] == fold).collect();
        let predicted = coefficients.transpose() * features.select_columns(&rows);
        for (place, &row) in rows.iter().enumerate() {
            out_of_fold.set_column(row, &predicted.column(place));
        }
    }
    let coefficients = solved.into_iter().next_back().ok_or(LearnError::TooFewRows)?;
    Ok(Ridge { coefficients, out_of_fold })
}

/// Does what [`ridge`] does without weights, for fewer rows than features: by the products of rows.
///
/// # Errors
/// Those of [`ridge`].
pub fn dual_ridge(
    features: &DMatrix<f64>,
    targets: &DMatrix<f64>,
    folds: &[usize],
    penalty: f64,
) -> Result<Ridge, LearnError> {
    let products = features.transpose() * features;
    let solve = |rows: &[usize]| -> Result<DMatrix<f64>, LearnError> {
        let mut kernel = DMatrix::from_fn(rows.len(), rows.len(), |i, j| products[(rows[i], rows[j])]);
        (0..rows.len()).for_each(|row| kernel[(row, row)] += penalty);
        let right = DMatrix::from_fn(rows.len(), targets.nrows(), |i, target| targets[(target, rows[i])]);
        Ok(Cholesky::new(kernel).ok_or(LearnError::NotSolved)?.solve(&right))
    };
    let mut out_of_fold = DMatrix::zeros(targets.nrows(), targets.ncols());
    for fold in 0..FOLDS {
        let (inside, others): (Vec<usize>, Vec<usize>) =
            (0..folds.len()).partition(|&row| folds[row] == fold);
        let duals = solve(&others)?;
        for &row in &inside {
            for target in 0..targets.nrows() {
                let products =
                    others.iter().enumerate().map(|(i, &other)| products[(row, other)] * duals[(i, target)]);
                out_of_fold[(target, row)] = products.sum();
            }
        }
    }
    let all: Vec<usize> = (0..folds.len()).collect();
    Ok(Ridge { coefficients: features * solve(&all)?, out_of_fold })
}
