//! From ratios of power in cells to a path over frequency.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::cells::{Cell, LineKind, SORTS};

/// (dB) Standard deviation of the path's level before anything is known, and (dB an octave) of its slope.
const LEVEL_DB: f64 = 40.0;
const SLOPE_DB: f64 = 6.0;
/// (dB) Deviations from the slope that are tried, and (octaves) how far they reach.
const DEVIATIONS_DB: [f64; 3] = [3.0, 6.0, 12.0];
const REACHES_OCTAVES: [f64; 4] = [0.05, 0.1, 0.2, 0.4];
/// (dB) Least standard deviation of a kind's and of a cell's level over the wheels.
const LEAST_DB: f64 = 0.5;
/// Draws that the common scatter of all cells of a kind counts as, beside a cell's own.
const COMMON_DRAWS: f64 = 8.0;
/// Degrees of freedom of the t distribution of what is left: tones of something else count less.
const FREEDOM: f64 = 4.0;
/// Rounds in which outlying cells are found.
const ROUNDS: usize = 4;

/// A cell's level in a recording, and in simulations of many wheels.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CellLevel {
    /// The cell.
    pub cell: Cell,
    /// (dB) Level of the recording over the mean of the simulations.
    pub ratio_db: f64,
    /// (dB) Level of each simulation over that mean.
    pub scatter_db: Vec<f64>,
}

/// A path over frequency.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// (dB) Magnitude.
    pub magnitude_db: Vec<f64>,
    /// (dB) Its standard deviation.
    pub deviation_db: Vec<f64>,
    /// (-) Mean square of how far the kinds of lines are from the simulations', over what wheels explain: about 1.
    pub kind_misfit: f64,
    /// (-) The same of the cells beside their kinds.
    pub cell_misfit: f64,
}

/// Finds the path that explains the levels: `ratio = path(frequency) + wheels(kind) + rest`.
///
/// Each of the three is normal: the path smooth over the logarithm of the frequency (Matérn's kernel of order 3/2 about a line), the wheels'
/// part of each kind of lines with the covariance of the simulations, the rest with the scatter that is left in these. The kernel's
/// size and reach are those of the largest marginal likelihood.
///
/// Source: C. E. Rasmussen, C. K. I. Williams, *Gaussian Processes for Machine Learning* (2006), sections 2.7, 4.2.1, 5.4.1.
///
/// # Arguments
/// * `frequency_hz` - (Hz) of the path
/// * `levels` - at least one
///
/// # Returns
/// None where the equations cannot be solved.
pub(super) fn smooth(frequency_hz: &[f64], levels: &[CellLevel]) -> Option<Path> {
    let scatter = Scatter::of(levels);
    let of_kinds = Cholesky::new(scatter.covariance.clone())?.inverse();
    let priors = DEVIATIONS_DB
        .into_iter()
        .flat_map(|deviation_db| REACHES_OCTAVES.map(|reach_octaves| (deviation_db, reach_octaves)));
    let mut best: Option<(f64, Prior)> = None;
    for (deviation_db, reach_octaves) in priors {
        let prior = Prior::new(frequency_hz, deviation_db, reach_octaves)?;
        let evidence = Solution::new(&prior, &of_kinds, levels, &scatter, &scatter.weights)?.evidence;
        if best.as_ref().is_none_or(|(most, _)| evidence > *most) {
            best = Some((evidence, prior));
        }
    }
    let (_, prior) = best?;
    let mut weights = scatter.weights.clone();
    for _ in 0..ROUNDS {
        let solution = Solution::new(&prior, &of_kinds, levels, &scatter, &weights)?;
        let rest_db = solution.rest_db(levels, &scatter);
        weights = rest_db
            .zip(&scatter.weights)
            .map(|(rest_db, weight)| weight * (FREEDOM + 1.0) / (FREEDOM + weight * rest_db * rest_db))
            .collect();
    }
    let solution = Solution::new(&prior, &of_kinds, levels, &scatter, &weights)?;
    let points = frequency_hz.len();
    let kinds = solution.mean.rows(points, scatter.kinds.len()).into_owned();
    let squares =
        solution.rest_db(levels, &scatter).zip(&scatter.weights).map(|(rest, weight)| weight * rest * rest);
    let covariance = solution.precision.inverse();
    let of_draws = solution.variance_over_draws(levels, &scatter, &weights);
    let variance = |at: usize| covariance[(at, at)].max(of_draws[at]);
    Some(Path {
        magnitude_db: solution.mean.iter().take(points).copied().collect(),
        deviation_db: (0..points).map(|at| variance(at).sqrt()).collect(),
        kind_misfit: kinds.dot(&(&of_kinds * &kinds)) / scatter.kinds.len() as f64,
        cell_misfit: squares.sum::<f64>() / levels.len() as f64,
    })
}

/// How the levels scatter over the wheels.
struct Scatter {
    /// The kinds of lines that there are.
    kinds: Vec<LineKind>,
    /// Of each cell, the place of its kind.
    kind_of: Vec<usize>,
    /// (dB²) Covariance of the levels of the kinds.
    covariance: DMatrix<f64>,
    /// (1/dB²) Weights of the cells: one over the variance of what is left beside their kinds.
    weights: Vec<f64>,
}

impl Scatter {
    fn of(levels: &[CellLevel]) -> Self {
        let mut kinds: Vec<LineKind> = levels.iter().map(|level| level.cell.kind).collect();
        kinds.sort();
        kinds.dedup();
        let kind_of: Vec<usize> =
            levels.iter().map(|level| kinds.partition_point(|kind| *kind < level.cell.kind)).collect();
        let draws = levels.first().map_or(0, |level| level.scatter_db.len());
        let mut of_kind = DMatrix::zeros(kinds.len(), draws);
        let mut counts = vec![0.0; kinds.len()];
        for (level, &kind) in levels.iter().zip(&kind_of) {
            counts[kind] += 1.0;
            level.scatter_db.iter().enumerate().for_each(|(draw, db)| of_kind[(kind, draw)] += db);
        }
        for (mut row, count) in of_kind.row_iter_mut().zip(&counts) {
            row /= *count;
        }
        let rest: Vec<Vec<f64>> = levels
            .iter()
            .zip(&kind_of)
            .map(|(level, &kind)| {
                level.scatter_db.iter().enumerate().map(|(draw, db)| db - of_kind[(kind, draw)]).collect()
            })
            .collect();
        let weights = weights(levels, &rest, draws as f64);
        let covariance = covariance(&kinds, &of_kind);
        Self { kinds, kind_of, covariance, weights }
    }
}

/// (dB²) Covariance of the levels of the kinds over the wheels: the variance of each, and between kinds the mean correlation over those of
/// the same sorts, since some tens of draws do not show that of each pair.
fn covariance(kinds: &[LineKind], of_kind: &DMatrix<f64>) -> DMatrix<f64> {
    let draws = of_kind.ncols() as f64;
    // One recording is compared with the mean of the draws.
    let sample = of_kind * of_kind.transpose() * ((1.0 + 1.0 / draws) / (draws - 1.0));
    let deviation: Vec<f64> = sample.diagonal().iter().map(|variance| variance.sqrt()).collect();
    let pairs = || (0..kinds.len()).flat_map(|row| (0..kinds.len()).map(move |column| (row, column)));
    let mut sums = [[[0.0; 2]; SORTS]; SORTS];
    for (row, column) in pairs().filter(|(row, column)| row != column) {
        let [sum, count] = &mut sums[kinds[row].sort()][kinds[column].sort()];
        *sum += sample[(row, column)] / (deviation[row] * deviation[column]);
        *count += 1.0;
    }
    let mut covariance = DMatrix::zeros(kinds.len(), kinds.len());
    for (row, column) in pairs() {
        let [sum, count] = sums[kinds[row].sort()][kinds[column].sort()];
        covariance[(row, column)] = match row == column {
            true => sample[(row, row)] + LEAST_DB * LEAST_DB,
            false => sum / count * deviation[row] * deviation[column],
        };
    }
    covariance
}

/// (1/dB²) Weights of cells by what is left of the scatter beside their kinds: that of each cell, and of all alike, and how far neighbours
/// deviate together.
fn weights(levels: &[CellLevel], rest: &[Vec<f64>], draws: f64) -> Vec<f64> {
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    let mut common = [[1e-12; 2]; SORTS];
    let mut together = [0.0; SORTS];
    let mut order: Vec<usize> = (0..levels.len()).collect();
    order.sort_by_key(|&at| (levels[at].cell.kind, levels[at].cell.frequency));
    for pair in order.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let sort = levels[a].cell.kind.sort();
        if levels[a].cell.kind == levels[b].cell.kind
            && levels[a].cell.frequency + 1 == levels[b].cell.frequency
        {
            together[sort] += rest[a].iter().zip(&rest[b]).map(|(a, b)| a * b).sum::<f64>();
            common[sort][1] += 0.5 * (square(&rest[a]) + square(&rest[b]));
        }
    }
    let mut variance = [[0.0; 2]; SORTS];
    for (level, rest) in levels.iter().zip(rest) {
        let [sum, count] = &mut variance[level.cell.kind.sort()];
        *sum += square(rest);
        *count += draws - 1.0;
    }
    let weight = |(level, rest): (&CellLevel, &Vec<f64>)| {
        let sort = level.cell.kind.sort();
        let [sum, count] = variance[sort];
        let own = (square(rest) + COMMON_DRAWS * sum / count) / (draws - 1.0 + COMMON_DRAWS);
        let correlation = (together[sort] / common[sort][1]).clamp(0.0, 0.8);
        let cells_in_one = (1.0 + correlation) / (1.0 - correlation);
        1.0 / (cells_in_one * (1.0 + 1.0 / draws) * own + LEAST_DB * LEAST_DB)
    };
    levels.iter().zip(rest).map(weight).collect()
}

/// What may be of the path: its precision, the inverse of its covariance.
struct Prior {
    precision: DMatrix<f64>,
    /// Logarithm of the determinant of the precision.
    determinant_ln: f64,
}

impl Prior {
    fn new(frequency_hz: &[f64], deviation_db: f64, reach_octaves: f64) -> Option<Self> {
        let middle = frequency_hz[frequency_hz.len() / 2];
        let octaves: Vec<f64> = frequency_hz.iter().map(|hz| libm::log2(hz / middle)).collect();
        let covariance = |a: usize, b: usize| {
            let apart = 3f64.sqrt() * (octaves[a] - octaves[b]).abs() / reach_octaves;
            let own = if a == b { 1e-6 } else { 0.0 };
            LEVEL_DB * LEVEL_DB
                + SLOPE_DB * SLOPE_DB * octaves[a] * octaves[b]
                + deviation_db * deviation_db * ((1.0 + apart) * (-apart).exp() + own)
        };
        let factor = Cholesky::new(DMatrix::from_fn(octaves.len(), octaves.len(), covariance))?;
        Some(Self { determinant_ln: -determinant_ln(&factor), precision: factor.inverse() })
    }
}

fn determinant_ln(factor: &Cholesky<f64, Dyn>) -> f64 {
    2.0 * factor.l_dirty().diagonal().iter().map(|value| value.ln()).sum::<f64>()
}

/// The path at all frequencies, and behind it the wheels' part of each kind of lines.
struct Solution {
    mean: DVector<f64>,
    precision: Cholesky<f64, Dyn>,
    /// Logarithm of the marginal likelihood, but for what the prior of the path does not change.
    evidence: f64,
}

impl Solution {
    fn new(
        prior: &Prior,
        of_kinds: &DMatrix<f64>,
        levels: &[CellLevel],
        scatter: &Scatter,
        weights: &[f64],
    ) -> Option<Self> {
        let points = prior.precision.nrows();
        let all = points + of_kinds.nrows();
        let mut precision = DMatrix::zeros(all, all);
        precision.view_mut((0, 0), (points, points)).copy_from(&prior.precision);
        precision.view_mut((points, points), of_kinds.shape()).copy_from(of_kinds);
        for ((level, kind), weight) in levels.iter().zip(&scatter.kind_of).zip(weights) {
            let (point, kind) = (level.cell.frequency, points + kind);
            for (row, column) in [(point, point), (point, kind), (kind, point), (kind, kind)] {
                precision[(row, column)] += weight;
            }
        }
        let right = right_side(levels, scatter, weights, all, |level| level.ratio_db);
        let precision = Cholesky::new(precision)?;
        let mean = precision.solve(&right);
        let evidence = 0.5 * (right.dot(&mean) - determinant_ln(&precision) + prior.determinant_ln);
        Some(Self { mean, precision, evidence })
    }

    /// (dB²) Mean square of the path that each simulation would show in place of the recordings, where there is none.
    ///
    /// The prior of the wheels' part is drawn with a broad brush; this is how far wheels lead the estimate astray.
    fn variance_over_draws(&self, levels: &[CellLevel], scatter: &Scatter, weights: &[f64]) -> Vec<f64> {
        let points = self.mean.len() - scatter.kinds.len();
        let draws = levels.first().map_or(0, |level| level.scatter_db.len());
        // Over the mean of the others.
        let over_others = draws as f64 / (draws as f64 - 1.0);
        let mut variance = vec![0.0; points];
        for draw in 0..draws {
            let level = |level: &CellLevel| over_others * level.scatter_db[draw];
            let path = self.precision.solve(&right_side(levels, scatter, weights, self.mean.len(), level));
            let squares = variance.iter_mut().zip(&path);
            squares.for_each(|(sum, db)| *sum += db * db / draws as f64);
        }
        variance
    }

    /// (dB) What neither the path nor the kinds of lines explain of each level.
    fn rest_db(&self, levels: &[CellLevel], scatter: &Scatter) -> impl Iterator<Item = f64> {
        let points = self.mean.len() - scatter.kinds.len();
        levels.iter().zip(&scatter.kind_of).map(move |(level, kind)| {
            level.ratio_db - self.mean[level.cell.frequency] - self.mean[points + kind]
        })
    }
}

/// Right side of the equations: the levels by their weights, for the path and for the kinds of lines.
fn right_side(
    levels: &[CellLevel],
    scatter: &Scatter,
    weights: &[f64],
    all: usize,
    level_db: impl Fn(&CellLevel) -> f64,
) -> DVector<f64> {
    let points = all - scatter.kinds.len();
    let mut right = DVector::zeros(all);
    for ((level, kind), weight) in levels.iter().zip(&scatter.kind_of).zip(weights) {
        right[level.cell.frequency] += weight * level_db(level);
        right[points + kind] += weight * level_db(level);
    }
    right
}
