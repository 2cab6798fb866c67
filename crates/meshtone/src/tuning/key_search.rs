//! The search for numbers of the scenario.

use std::sync::Arc;

use super::candidates::{place, rounds, value};
use super::search::Grid;
use super::simulations::{Differences, Simulations};
use super::tune::{TuningInputs, tune_among};
use super::{Experiment, Fit, HybridError, SimulatedCases, TunedKeys};
use crate::scenario::Scenario;
use crate::threads;

/// The best candidates whose parameters the intervals hold, where their error allows it; no others are kept.
const KEPT: usize = 12;
/// Simulations that are made, and whose signals are held, at the same time.
const SIMULATED_TOGETHER: usize = 448;

/// A combination of values that was simulated.
struct Candidate {
    places: Vec<f64>,
    fit: Fit,
    differences: Arc<Differences>,
}

/// The best fit to all cases but one, and the signals that it is of.
type LeftOutFit = (Fit, Arc<Differences>);

/// The fits to a combination's simulations.
struct Fits {
    differences: Arc<Differences>,
    all: Fit,
    /// Each case left out in turn; empty beyond the first round.
    left_out: Vec<Fit>,
}

pub(super) struct KeySearch<'a> {
    experiment: &'a Experiment,
    simulations: &'a Simulations<'a>,
    common: TuningInputs<'a>,
    /// The best so far first.
    best: Vec<Candidate>,
    folds: Vec<LeftOutFit>,
    candidates: usize,
    failed: usize,
    first_failure: Option<String>,
}

impl<'a> KeySearch<'a> {
    /// # Arguments
    /// * `original` - the scenario as it is: what a case that is left out is predicted by, unless a combination fits the others
    ///   better
    pub(super) fn new(
        experiment: &'a Experiment,
        simulations: &'a Simulations<'a>,
        common: TuningInputs<'a>,
        original: &SimulatedCases,
    ) -> Result<Self, HybridError> {
        let differences = Arc::new(original.differences().to_vec());
        let fold = |fit| (fit, differences.clone());
        let grid = Grid::new(original, common.target)?;
        let folds = left_out(&grid, experiment.cases.len())?.into_iter().map(fold).collect();
        Ok(Self {
            experiment,
            simulations,
            common,
            best: Vec::new(),
            folds,
            candidates: 0,
            failed: 0,
            first_failure: None,
        })
    }

    pub(super) fn run(mut self) -> Result<TunedKeys, HybridError> {
        let together = (SIMULATED_TOGETHER / self.experiment.cases.len()).max(1);
        let mut index = 0;
        for (round, count) in rounds(self.experiment.candidates).into_iter().enumerate() {
            // The best of the earlier rounds, not of this one.
            let parents: Vec<Vec<f64>> = self.best.iter().map(|candidate| candidate.places.clone()).collect();
            let end = index + count;
            while index < end {
                let next = (index + together).min(end);
                self.try_combinations(index..next, round, &parents)?;
                index = next;
            }
        }
        let leave_one_out_error = self.leave_one_out_error()?;
        let simulated: Vec<SimulatedCases> = self
            .best
            .iter()
            .map(|candidate| SimulatedCases::new(candidate.differences.to_vec()))
            .collect::<Result<_, _>>()?;
        let fits = self.best.iter().map(|candidate| candidate.fit);
        let good: Vec<(&SimulatedCases, Fit)> = simulated.iter().zip(fits).collect();
        let Some(best) = self.best.first() else {
            let first_failure = self.first_failure.unwrap_or_default();
            return Err(HybridError::NoCandidate { first_failure });
        };
        let mut tuning = tune_among(&good, &self.common)?;
        tuning.leave_one_out_error = leave_one_out_error;
        Ok(TunedKeys {
            values: self.values(&best.places),
            simulated: simulated[0].clone(),
            tuning,
            candidates: self.candidates,
            failed: self.failed,
            first_failure: self.first_failure,
        })
    }

    fn values(&self, places: &[f64]) -> Vec<f64> {
        self.experiment.keys.iter().zip(places).map(|(key, &at)| value(key, at)).collect()
    }

    /// Simulates some combinations and keeps the best.
    fn try_combinations(
        &mut self,
        numbers: std::ops::Range<usize>,
        round: usize,
        parents: &[Vec<f64>],
    ) -> Result<(), HybridError> {
        let Experiment { cases, keys, seed, .. } = self.experiment;
        let (mut places, mut scenarios) = (Vec::new(), Vec::new());
        for number in numbers {
            let at = place(keys, *seed, number, round, parents);
            let values = self.values(&at);
            let all = cases.iter().map(|case| self.experiment.scenario_with(case, &values));
            match all.collect::<Result<Vec<Scenario>, _>>() {
                Ok(all) => {
                    places.push(at);
                    scenarios.push(all);
                }
                Err(error) => {
                    self.simulations.skip_one();
                    self.fail(&error);
                }
            }
        }
        let simulated = self.simulations.run(scenarios)?;
        let common = self.common;
        let fits = threads::map(simulated, |simulated| fits(&common, simulated?, round == 0));
        for (places, fits) in places.into_iter().zip(fits) {
            match fits {
                Ok(fits) => self.keep(places, fits),
                Err(HybridError::Cancelled) => return Err(HybridError::Cancelled),
                Err(error) => self.fail(&error),
            }
        }
        Ok(())
    }

    fn fail(&mut self, error: &HybridError) {
        self.failed += 1;
        self.first_failure.get_or_insert_with(|| error.to_string());
    }

    fn keep(&mut self, places: Vec<f64>, fits: Fits) {
        let Fits { differences, all: fit, left_out } = fits;
        self.candidates += 1;
        for (fold, fit) in self.folds.iter_mut().zip(left_out) {
            if fit.error < fold.0.error {
                *fold = (fit, differences.clone());
            }
        }
        // Of equals the one that was drawn first.
        let rank = self.best.partition_point(|other| other.fit.error <= fit.error);
        if rank < KEPT {
            self.best.insert(rank, Candidate { places, fit, differences });
            self.best.truncate(KEPT);
        }
    }

    /// Error of each case, predicted by what fits the others best.
    fn leave_one_out_error(&self) -> Result<Vec<f64>, HybridError> {
        threads::try_map(self.folds.iter().enumerate(), |(case, (fit, differences))| {
            self.common.left_out_error(&SimulatedCases::new(differences.to_vec())?, *fit, case)
        })
    }
}

/// Fits with each case left out in turn.
fn left_out(grid: &Grid, cases: usize) -> Result<Vec<Fit>, HybridError> {
    (0..cases).map(|case| grid.fit(Some(case))).collect()
}

fn fits(common: &TuningInputs, differences: Differences, leave_out: bool) -> Result<Fits, HybridError> {
    let simulated = SimulatedCases::new(differences)?;
    let grid = Grid::new(&simulated, common.target)?;
    let all = grid.fit(None)?;
    let cases = if leave_out { common.target.measured.cases() } else { 0 };
    let left_out = left_out(&grid, cases)?;
    Ok(Fits { all, left_out, differences: Arc::new(simulated.into_differences()) })
}
