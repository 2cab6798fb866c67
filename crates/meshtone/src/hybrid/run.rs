//! Runs an experiment.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use super::candidates::{place, rounds, value};
use super::difference::KeepDifference;
use super::tune::tune_among;
use super::{Experiment, Fit, HybridError, SimulatedCases, Tuning, TuningWarning, fit, tune};
use crate::batch::{Control, simulate_many};
use crate::scenario::{Scenario, ScenarioError};

/// The best candidates whose parameters the intervals hold, where their error allows it.
const MOST_FOR_INTERVALS: usize = 12;

/// What an experiment gave.
#[derive(Debug, Clone)]
pub struct ExperimentResult {
    /// Difference signals of the scenario as it is.
    pub original: SimulatedCases,
    /// The three parameters tuned alone.
    pub enhancement_alone: Tuning,
    /// With the keys tuned as well; none where no keys are, or where no combination that was tried is better than the scenario
    /// as it is.
    pub with_keys: Option<TunedKeys>,
}

/// Keys and enhancement tuned together.
#[derive(Debug, Clone)]
pub struct TunedKeys {
    /// The keys' values, in the experiment's order.
    pub values: Vec<f64>,
    /// Difference signals with these values.
    pub simulated: SimulatedCases,
    /// The three parameters; its leave-one-out errors choose the keys' values anew for each case, too.
    pub tuning: Tuning,
    /// Combinations that were simulated.
    pub candidates: usize,
    /// Combinations that no simulation could be made of.
    pub failed: usize,
    /// The reason of the first of them.
    pub first_failure: Option<String>,
}

impl ExperimentResult {
    /// The best that was found.
    pub fn tuning(&self) -> &Tuning {
        self.with_keys.as_ref().map_or(&self.enhancement_alone, |keys| &keys.tuning)
    }

    /// Difference signals that the best enhancement is applied to.
    pub fn simulated(&self) -> &SimulatedCases {
        self.with_keys.as_ref().map_or(&self.original, |keys| &keys.simulated)
    }
}

/// Progress and cancellation of an experiment.
pub struct ExperimentControl<'a> {
    /// Called with the simulations that are finished and all there are, from any thread.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    /// Set to stop; the experiment then ends with [`HybridError::Cancelled`].
    pub cancelled: &'a AtomicBool,
}

/// A combination of values that was simulated.
struct Candidate {
    places: Vec<f64>,
    simulated: SimulatedCases,
    fit: Fit,
}

/// Simulates an experiment's cases and tunes them to what was measured.
///
/// # Arguments
/// * `experiment` - what is tuned
/// * `control` - progress and cancellation
///
/// # Errors
/// As of [`Experiment::check`]; a case that cannot be simulated as it is; cancelled.
pub fn run_experiment(
    experiment: &Experiment,
    control: &ExperimentControl,
) -> Result<ExperimentResult, HybridError> {
    experiment.check()?;
    let search = Search {
        experiment,
        control,
        finished: AtomicUsize::new(0),
        all: experiment.cases.len()
            * (1 + if experiment.keys.is_empty() { 0 } else { experiment.candidates }),
    };
    let unchanged: Vec<Scenario> = experiment.cases.iter().map(|case| experiment.scenario(case)).collect();
    let original = search.simulate(vec![unchanged])?.swap_remove(0)?;
    let Experiment { measured, bounds, seed, .. } = experiment;
    let enhancement_alone = tune(&original, measured, bounds, *seed)?;
    let mut enhancement_alone = enhancement_alone;
    let mut with_keys = if experiment.keys.is_empty() { None } else { Some(search.with_keys()?) };
    if let Some(keys) = &mut with_keys {
        let (alone, together) = (&enhancement_alone, &mut keys.tuning);
        let [before, after] = [alone.mean_leave_one_out_error(), together.mean_leave_one_out_error()];
        if together.enhanced_error >= alone.enhanced_error {
            enhancement_alone.warnings.push(TuningWarning::KeysDoNotHelp);
            with_keys = None;
        } else if after > before {
            together.warnings.push(TuningWarning::KeysPredictWorse { alone: before, together: after });
        }
    }
    Ok(ExperimentResult { original, enhancement_alone, with_keys })
}

struct Search<'a> {
    experiment: &'a Experiment,
    control: &'a ExperimentControl<'a>,
    finished: AtomicUsize,
    all: usize,
}

impl Search<'_> {
    /// Difference signals of some combinations, all cases of each.
    fn simulate(
        &self,
        combinations: Vec<Vec<Scenario>>,
    ) -> Result<Vec<Result<SimulatedCases, HybridError>>, HybridError> {
        let cases = self.experiment.cases.len();
        let count = combinations.len() * cases;
        let before = self.finished.load(Ordering::Relaxed);
        let progress = |finished: usize| (self.control.progress)(before + finished, self.all);
        let control =
            Control { progress: &progress, cancelled: self.control.cancelled, ..Control::default() };
        let mut results: Vec<Result<Vec<f64>, HybridError>> = Vec::with_capacity(count);
        let keep = KeepDifference(&self.experiment.chain);
        let take = |_: usize, kept: Result<Result<Vec<f64>, HybridError>, ScenarioError>| {
            results.push(kept.map_err(HybridError::from).and_then(|difference| difference));
        };
        simulate_many(combinations.into_iter().flatten(), &keep, &control, take);
        if results.len() < count {
            return Err(HybridError::Cancelled);
        }
        self.finished.fetch_add(count, Ordering::Relaxed);
        let mut results = results.into_iter();
        Ok((0..count / cases)
            .map(|_| {
                // All of the combination's results are taken, whatever the first error.
                let all: Vec<_> = results.by_ref().take(cases).collect();
                SimulatedCases::new(all.into_iter().collect::<Result<_, _>>()?)
            })
            .collect())
    }

    fn with_keys(&self) -> Result<TunedKeys, HybridError> {
        let Experiment { cases, keys, measured, bounds, candidates, seed, .. } = self.experiment;
        let mut tried: Vec<Candidate> = Vec::new();
        let (mut index, mut failed, mut first_failure) = (0, 0, None);
        let mut fail = |error: HybridError| {
            failed += 1;
            first_failure.get_or_insert_with(|| error.to_string());
        };
        for (round, count) in rounds(*candidates).into_iter().enumerate() {
            let best: Vec<&Vec<f64>> = tried.iter().map(|candidate| &candidate.places).collect();
            let (mut places, mut scenarios) = (Vec::new(), Vec::new());
            for _ in 0..count {
                let at = place(keys, *seed, index, round, &best);
                index += 1;
                let values: Vec<f64> = keys.iter().zip(&at).map(|(key, &at)| value(key, at)).collect();
                let all = cases.iter().map(|case| self.experiment.scenario_with(case, &values));
                match all.collect::<Result<Vec<_>, _>>() {
                    Ok(all) => {
                        places.push(at);
                        scenarios.push(all);
                    }
                    Err(error) => fail(error),
                }
            }
            let simulated = self.simulate(scenarios)?;
            let fits: Vec<Result<Candidate, HybridError>> = places
                .into_par_iter()
                .zip(simulated)
                .map(|(places, simulated)| {
                    let simulated = simulated?;
                    let fit = fit(&simulated, measured, bounds, None)?;
                    Ok(Candidate { places, simulated, fit })
                })
                .collect();
            for result in fits {
                match result {
                    Ok(candidate) => tried.push(candidate),
                    Err(error) => fail(error),
                }
            }
            // A stable sort: of equals the one that was drawn first.
            tried.sort_by(|a, b| a.fit.error.total_cmp(&b.fit.error));
        }
        let leave_one_out_error = self.leave_one_out(&tried)?;
        let good: Vec<(&SimulatedCases, Fit)> = tried
            .iter()
            .take(MOST_FOR_INTERVALS)
            .map(|candidate| (&candidate.simulated, candidate.fit))
            .collect();
        if good.is_empty() {
            let first_failure = first_failure.unwrap_or_default();
            return Err(HybridError::NoCandidate { first_failure });
        }
        let mut tuning = tune_among(&good, measured, bounds, *seed)?;
        tuning.leave_one_out_error = leave_one_out_error;
        if let Some(first) = &first_failure {
            tuning.warnings.push(TuningWarning::Failed { failed, first: first.clone() });
        }
        let best = &tried[0];
        Ok(TunedKeys {
            values: keys.iter().zip(&best.places).map(|(key, &at)| value(key, at)).collect(),
            simulated: best.simulated.clone(),
            tuning,
            candidates: tried.len(),
            failed,
            first_failure,
        })
    }

    /// Error of each case, predicted by the candidate and the enhancement that fit the others best.
    fn leave_one_out(&self, tried: &[Candidate]) -> Result<Vec<f64>, HybridError> {
        let Experiment { cases, measured, bounds, .. } = self.experiment;
        (0..cases.len())
            .into_par_iter()
            .map(|case| {
                let mut best: Option<(Fit, &Candidate)> = None;
                for candidate in tried {
                    let others = fit(&candidate.simulated, measured, bounds, Some(case))?;
                    if best.is_none_or(|(least, _)| others.error < least.error) {
                        best = Some((others, candidate));
                    }
                }
                let (others, candidate) = best.ok_or(HybridError::NoFit)?;
                let predicted = candidate.simulated.predict(measured.indicators(), &others.enhancement)?;
                Ok(measured.case_error(case, &predicted[case]))
            })
            .collect()
    }
}
