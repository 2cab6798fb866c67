//! The three parameters, how well they are known, and how well they predict.

use std::sync::atomic::AtomicBool;

use thiserror::Error;

use super::search::{Grid, Objective, Point, Target, enhancement, equal_weights, point, refine};
use super::{Enhancement, EnhancementBounds, Fit, HybridError, Measurements, SimulatedCases};
use crate::threads;

/// Bootstrap samples of the records.
const BOOTSTRAP_SAMPLES: u64 = 200;
/// Part of the bootstrap samples that the intervals hold.
const CONFIDENCE: f64 = 0.95;
/// Relative excess of error that a solution nearer to α = 1 may have.
const VALLEY: f64 = 0.005;
/// Halvings of an interval's end.
const HALVINGS: usize = 9;
/// First steps of local searches, in logarithms.
const STEPS: Point = [0.1; 3];
/// Ratio of the ends of an interval from which on the parameter counts as unknown.
const UNKNOWN: f64 = 4.0;
/// Records per case below which intervals mean little.
const FEW_RECORDS: usize = 5;

/// The result of tuning the three parameters.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Tuning {
    /// The parameters: of all solutions that are as good as the best, to half a per cent of its error, the one with the
    /// fault-to-harmonics ratio nearest to 1.
    pub enhancement: Enhancement,
    /// Intervals that hold them with a confidence of 95 %, by a bootstrap over the cases and their records.
    ///
    /// All values whose error, with everything else adjusted, exceeds the least by no more than the chosen
    /// parameters' error exceeds the least one in 95 % of the bootstrap samples. Drawing the cases, too, lets what the model
    /// cannot follow in some of them widen the intervals.
    pub intervals: EnhancementBounds,
    /// Mean error (Eq. 7) of the original simulation, before anything was tuned.
    pub original_error: f64,
    /// Mean error after the enhancement.
    pub enhanced_error: f64,
    /// The measurements' own scatter: mean error of their medians, the floor.
    pub scatter: f64,
    /// Each case as what is tuned to the others predicts it.
    pub left_out: Vec<LeftOutCase>,
    /// Indicators of the original simulation, before anything was tuned, by case and indicator.
    pub original: Vec<Vec<f64>>,
    /// Indicators after the enhancement, by case and indicator.
    pub enhanced: Vec<Vec<f64>>,
    /// Warnings.
    pub warnings: Vec<TuningWarning>,
}

impl Tuning {
    /// Mean error over the cases that were left out of the fit in turn.
    pub fn mean_leave_one_out_error(&self) -> f64 {
        self.left_out.iter().map(|case| case.error).sum::<f64>() / self.left_out.len() as f64
    }
}

/// A case that is left out of the fit, and what the fit to the others predicts of it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct LeftOutCase {
    /// Error of the prediction (Eq. 7).
    pub error: f64,
    /// By indicator: the prediction, the mean over the combinations that fit the other cases best.
    pub predicted: Vec<f64>,
    /// By indicator: the interval in which a record of the case is expected with a confidence of 95 %.
    ///
    /// It reaches as far from the prediction as 95 % of the other cases' records lie from theirs, each predicted with its case left out:
    /// the jackknife interval of Barber, Candès, Ramdas and Tibshirani, Predictive inference with the jackknife+ (2021).
    pub intervals: Vec<[f64; 2]>,
}

impl LeftOutCase {
    /// # Arguments
    /// * `predicted` - by case and indicator, each case by what is tuned to the others
    pub(super) fn all(measured: &Measurements, predicted: Vec<Vec<f64>>) -> Vec<Self> {
        let distances = |case: usize, j: usize| {
            let centre = predicted[case][j];
            measured.records(case, j).iter().map(move |record| (record - centre).abs())
        };
        let reach = |left_out: usize, j: usize| {
            let others = (0..measured.cases()).filter(|&case| case != left_out);
            let mut all: Vec<f64> = others.flat_map(|case| distances(case, j)).collect();
            all.sort_unstable_by(f64::total_cmp);
            all[((CONFIDENCE * all.len() as f64) as usize).min(all.len() - 1)]
        };
        let intervals = |case: usize| {
            let of_indicator =
                |(j, centre): (usize, &f64)| [centre - reach(case, j), centre + reach(case, j)];
            predicted[case].iter().enumerate().map(of_indicator).collect()
        };
        let intervals: Vec<Vec<[f64; 2]>> = (0..measured.cases()).map(intervals).collect();
        let cases = predicted.into_iter().zip(intervals).enumerate();
        cases
            .map(|(case, (predicted, intervals))| Self {
                error: measured.case_error(case, &predicted),
                predicted,
                intervals,
            })
            .collect()
    }
}

/// Why a tuning is doubtful.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum TuningWarning {
    /// The measurements hardly limit a parameter.
    #[error(
        "the measurements do not determine {parameter}: all values from {:.3} to {:.3} fit equally well",
        interval[0], interval[1]
    )]
    Unknown {
        /// Its name.
        parameter: &'static str,
        /// Its interval.
        interval: [f64; 2],
    },
    /// A parameter lies at the end of the range in which it was searched.
    #[error(
        "{parameter} = {value:.3} lies at the end of the range in which it was searched; widen the range"
    )]
    AtBound {
        /// Its name.
        parameter: &'static str,
        /// Its value.
        value: f64,
    },
    /// A case has few records.
    #[error("case {case} has only {records} records, too few for meaningful intervals (use 5 or more)")]
    FewRecords {
        /// Number of the case, the healthy one is 0.
        case: usize,
        /// Its records.
        records: usize,
    },
    /// The faults of a case are on other shafts than that over whose revolutions the signals are averaged.
    #[error(
        "case {case} is damaged on {damaged} alone, but its signals are averaged over revolutions of {averaged}, in which \
         that damage fades"
    )]
    OtherWheel {
        /// Number of the case.
        case: usize,
        /// The damaged wheels, in words.
        damaged: String,
        /// The wheel that is averaged over, in words.
        averaged: String,
    },
    /// The enhancement is no better than the simulation was.
    #[error("the enhancement does not bring the signals closer to the measured ones")]
    NoBetter,
    /// No combination of the keys' values that was tried is better than the scenario as it is, which was kept.
    #[error(
        "no values of the keys that were tried are better than the scenario's own, which are kept; try more candidates"
    )]
    KeysDoNotHelp,
    /// With the keys the cases that are left out are predicted worse than without.
    #[error(
        "left out, the cases are predicted worse with the keys ({together:.3}) than by the three parameters \
         alone ({alone:.3}): the keys may be fitted to the cases instead of the rig"
    )]
    KeysPredictWorse {
        /// Leave-one-out error of the three parameters alone.
        alone: f64,
        /// With the keys.
        together: f64,
    },
    /// Cases that are left out are predicted worse than they were before anything was tuned.
    #[error(
        "left out, the cases are predicted worse ({left_out:.3}) than by the simulation before it was tuned ({original:.3}): \
         do not rely on it for damage that was not measured; measure more cases, or tune fewer numbers"
    )]
    PredictsWorse {
        /// Mean error of the simulation as it was.
        original: f64,
        /// Mean leave-one-out error.
        left_out: f64,
    },
    /// No more numbers were measured than are tuned.
    #[error(
        "{tuned} numbers are tuned to {measured} measured ones (cases times indicators), which they can fit \
         whatever the measurements are: measure more cases, name more indicators, or hold numbers"
    )]
    FewNumbers {
        /// Cases times indicators.
        measured: usize,
        /// Parameters and keys that are not held.
        tuned: usize,
    },
    /// Combinations of the keys' values that could not be simulated.
    #[error("{failed} combinations of the keys' values could not be simulated; the first: {first}")]
    Failed {
        /// The number.
        failed: usize,
        /// Reason of the first.
        first: String,
    },
}

/// Tunes the three parameters.
///
/// # Arguments
/// * `simulated` - difference signals of all cases
/// * `measured` - of the same cases
/// * `bounds` - where the parameters are searched
/// * `seed` - of the bootstrap
/// * `cancelled` - set it to stop
///
/// # Errors
/// Those of [`fit`](super::fit).
///
/// Source: section 5 of arXiv:2410.05073, Eq. 7.
pub fn tune(
    simulated: &SimulatedCases,
    measured: &Measurements,
    bounds: &EnhancementBounds,
    seed: u64,
    cancelled: &AtomicBool,
) -> Result<Tuning, HybridError> {
    let target = Target { measured, bounds, cancelled };
    let grid = Grid::new(simulated, target)?;
    let best = grid.fit(None)?;
    let original = simulated.predict(measured.indicators(), &Enhancement::default())?;
    let common = TuningInputs { target, seed, original: &original };
    let mut tuning = tune_among(&[(simulated, best)], &common)?;
    let predicted = threads::try_map(0..measured.cases(), |case| {
        common.prediction(&[(simulated, grid.fit(Some(case))?)], case)
    })?;
    tuning.left_out = LeftOutCase::all(measured, predicted);
    Ok(tuning)
}

/// The inputs of tuning besides simulations.
#[derive(Clone, Copy)]
pub(super) struct TuningInputs<'a> {
    pub(super) target: Target<'a>,
    /// Of the bootstrap.
    pub(super) seed: u64,
    /// Indicators of the original simulation.
    pub(super) original: &'a [Vec<f64>],
}

impl TuningInputs<'_> {
    /// Indicators of a case, predicted by what is tuned to the others: the mean over several simulations that fit those.
    ///
    /// # Arguments
    /// * `good` - simulations with their fits to the others
    pub(super) fn prediction(
        &self,
        good: &[(&SimulatedCases, Fit)],
        case: usize,
    ) -> Result<Vec<f64>, HybridError> {
        let measured = self.target.measured;
        let weights = equal_weights(measured.cases(), Some(case));
        let mut mean = vec![0.0; measured.indicators().len()];
        for &(simulated, best) in good {
            let objective = Objective { simulated, target: self.target, weights: &weights };
            let chosen = nearest_to_unit_ratio(&objective, best)?;
            let predicted = simulated.predict(measured.indicators(), &chosen.enhancement)?;
            mean.iter_mut().zip(&predicted[case]).for_each(|(sum, value)| *sum += value / good.len() as f64);
        }
        Ok(mean)
    }
}

/// Tunes where several simulations are as good as another: the first is the best, the others count for the intervals.
/// What is left out is not predicted.
pub(super) fn tune_among(
    candidates: &[(&SimulatedCases, Fit)],
    common: &TuningInputs,
) -> Result<Tuning, HybridError> {
    let TuningInputs { target, seed, original } = *common;
    let Target { measured, bounds, .. } = target;
    let weights = equal_weights(measured.cases(), None);
    let (simulated, best) = candidates.first().copied().ok_or(HybridError::NoFit)?;
    let objective = Objective { simulated, target, weights: &weights };
    let chosen = nearest_to_unit_ratio(&objective, best)?;
    let intervals = intervals(candidates, &objective, &chosen, seed)?;
    let original_error = measured.mean_error(original);
    Ok(Tuning {
        enhancement: chosen.enhancement,
        intervals,
        original_error,
        enhanced_error: chosen.error,
        scatter: measured.scatter(),
        left_out: Vec::new(),
        original: original.to_vec(),
        enhanced: simulated.predict(measured.indicators(), &chosen.enhancement)?,
        warnings: warnings(measured, bounds, &chosen, &intervals, original_error),
    })
}

/// Along the valley in which α and the noise level rise together, the solution nearest to α = 1.
fn nearest_to_unit_ratio(objective: &Objective, best: Fit) -> Result<Fit, HybridError> {
    let ranges = objective.target.bounds.logarithms();
    let limit = best.error * (1.0 + VALLEY);
    let from = point(&best.enhancement);
    let goal = 0.0_f64.clamp(ranges[1][0], ranges[1][1]);
    let mut chosen = best;
    // Part of the way to α = 1: from what fits to what does not.
    let (mut good, mut bad) = (0.0, 1.0);
    let mut part = 1.0;
    for _ in 0..HALVINGS {
        let ratio = from[1] + part * (goal - from[1]);
        let mut held = ranges;
        held[1] = [ratio; 2];
        let mut start = point(&chosen.enhancement);
        // The noise goes along with the ratio.
        start[2] += ratio - start[1];
        let (error, found) = refine(objective, held, start, STEPS)?;
        if error <= limit {
            chosen = Fit { enhancement: enhancement(found), error };
            good = part;
        } else {
            bad = part;
        }
        if good == bad {
            break;
        }
        part = 0.5 * (good + bad);
    }
    Ok(chosen)
}

/// Intervals of the parameters of the enhancement, from a bootstrap of the measured records.
///
/// Of each resampled set it is found by how much the chosen parameters miss its own best fit. The excess that is exceeded in few of them
/// limits the error, and an interval holds all values of a parameter with which the error, the others adjusted, stays below that limit.
/// Every candidate that is below it is a start of its own, since the fits may have several minima.
fn intervals(
    candidates: &[(&SimulatedCases, Fit)],
    objective: &Objective,
    chosen: &Fit,
    seed: u64,
) -> Result<EnhancementBounds, HybridError> {
    let ranges = objective.target.bounds.logarithms();
    let centre = point(&chosen.enhancement);
    let mut excesses = threads::try_map(0..BOOTSTRAP_SAMPLES, |sample| -> Result<f64, HybridError> {
        let (measured, weights) = objective.target.measured.resampled(seed, sample);
        let target = Target { measured: &measured, ..objective.target };
        let again = |simulated| Objective { simulated, target, weights: &weights };
        let here = again(objective.simulated).at(centre)?;
        let mut least = here;
        for (simulated, fit) in candidates {
            let start = point(&fit.enhancement);
            least = least.min(refine(&again(simulated), ranges, start, STEPS)?.0);
        }
        least = least.min(refine(&again(objective.simulated), ranges, centre, STEPS)?.0);
        Ok(here - least)
    })?;
    excesses.sort_unstable_by(f64::total_cmp);
    let least = candidates.first().map_or(chosen.error, |(_, best)| best.error);
    let limit = chosen.error.max(least + excesses[(CONFIDENCE * BOOTSTRAP_SAMPLES as f64) as usize]);
    let starts = candidates
        .iter()
        .filter(|(_, fit)| fit.error <= limit)
        .map(|(simulated, fit)| (*simulated, point(&fit.enhancement)))
        .chain([(objective.simulated, centre)]);
    let ends = threads::try_map(starts, |(simulated, centre)| -> Result<[[f64; 2]; 3], HybridError> {
        let objective = Objective { simulated, ..*objective };
        let mut ends = [[0.0; 2]; 3];
        for (d, of_parameter) in ends.iter_mut().enumerate() {
            for (side, end) in of_parameter.iter_mut().enumerate() {
                *end = end_of_profile(&objective, ranges, centre, d, side, limit)?.exp();
            }
        }
        Ok(ends)
    })?;
    let widest = |d: usize| {
        let least = ends.iter().map(|ends| ends[d][0]).fold(f64::INFINITY, f64::min);
        [least, ends.iter().map(|ends| ends[d][1]).fold(0.0, f64::max)]
    };
    Ok(EnhancementBounds {
        width_ratio: widest(0),
        fault_to_harmonics_ratio: widest(1),
        noise_level: widest(2),
    })
}

/// Value of a parameter at which the error, the others adjusted, exceeds a limit.
///
/// It goes outwards from the fit in growing steps until the error is above the limit, and halves the last step. Each adjustment starts from
/// the last one that was good and from the fit itself, and the better of both counts: the search finds local minima only.
fn end_of_profile(
    objective: &Objective,
    ranges: [[f64; 2]; 3],
    centre: Point,
    parameter: usize,
    side: usize,
    limit: f64,
) -> Result<f64, HybridError> {
    let mut last = centre;
    let mut fits = |value: f64| -> Result<bool, HybridError> {
        let mut held = ranges;
        held[parameter] = [value; 2];
        let mut start = last;
        if parameter != 0 {
            // α and the noise level go together.
            start[3 - parameter] += value - start[parameter];
        }
        let mut found = refine(objective, held, start, STEPS)?;
        let again = refine(objective, held, centre, STEPS)?;
        if again.0 < found.0 {
            found = again;
        }
        if found.0 <= limit {
            last = found.1;
        }
        Ok(found.0 <= limit)
    };
    let outermost = ranges[parameter][side];
    // Outwards in growing steps, so that no far region that fits again by chance is taken.
    let (mut good, mut step) = (centre[parameter], 0.02);
    let direction = if side == 0 { -1.0 } else { 1.0 };
    let mut bad = loop {
        let next = good + direction * step;
        let beyond = direction * (next - outermost) >= 0.0;
        let next = if beyond { outermost } else { next };
        if !fits(next)? {
            break next;
        }
        good = next;
        if beyond {
            return Ok(outermost);
        }
        step *= 1.6;
    };
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + bad);
        if fits(middle)? {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok(good)
}

fn warnings(
    measured: &Measurements,
    bounds: &EnhancementBounds,
    chosen: &Fit,
    intervals: &EnhancementBounds,
    original_error: f64,
) -> Vec<TuningWarning> {
    let mut warnings = Vec::new();
    let values = point(&chosen.enhancement).map(f64::exp);
    let searched = bounds.all().into_iter().zip(values);
    for (((parameter, range), value), (_, interval)) in searched.zip(intervals.all()) {
        if range[0] < range[1] && range.iter().any(|end| (value / end - 1.0).abs() < 1e-3) {
            warnings.push(TuningWarning::AtBound { parameter, value });
        }
        if interval[1] >= UNKNOWN * interval[0] {
            warnings.push(TuningWarning::Unknown { parameter, interval });
        }
    }
    for case in 0..measured.cases() {
        let records = (0..measured.indicators().len()).map(|j| measured.records(case, j).len()).min();
        if let Some(records) = records.filter(|&records| records < FEW_RECORDS) {
            warnings.push(TuningWarning::FewRecords { case, records });
        }
    }
    if chosen.error >= original_error {
        warnings.push(TuningWarning::NoBetter);
    }
    warnings
}
