//! The simulations of an experiment.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::difference::KeepDifference;
use super::{Experiment, ExperimentControl, HybridError};
use crate::batch::{Control, simulate_many};
use crate::error::Error;
use crate::scenario::Scenario;

/// Difference signals by case.
pub(super) type Differences = Vec<Vec<f64>>;

pub(super) struct Simulations<'a> {
    experiment: &'a Experiment,
    control: &'a ExperimentControl<'a>,
    finished: AtomicUsize,
    all: usize,
}

impl<'a> Simulations<'a> {
    pub(super) fn new(experiment: &'a Experiment, control: &'a ExperimentControl<'a>) -> Self {
        let candidates = if experiment.keys.is_empty() { 0 } else { experiment.candidates };
        let all = experiment.cases.len() * (1 + candidates);
        Self { experiment, control, finished: AtomicUsize::new(0), all }
    }

    /// Difference signals of some combinations, all cases of each.
    pub(super) fn run(
        &self,
        combinations: Vec<Vec<Scenario>>,
    ) -> Result<Vec<Result<Differences, HybridError>>, HybridError> {
        let cases = self.experiment.cases.len();
        let count = combinations.len() * cases;
        let before = self.finished.load(Ordering::Relaxed);
        let progress = |finished: usize| (self.control.progress)(before + finished, self.all);
        let control =
            Control { progress: &progress, cancelled: self.control.cancelled, ..Control::default() };
        let mut results: Vec<Result<Vec<f64>, HybridError>> = Vec::with_capacity(count);
        let keep = KeepDifference(&self.experiment.chain);
        let take = |_: usize, kept: Result<Result<Vec<f64>, HybridError>, Error>| {
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
                all.into_iter().collect()
            })
            .collect())
    }

    /// A combination that is no scenario needs no simulations.
    pub(super) fn skip_one(&self) {
        let cases = self.experiment.cases.len();
        let finished = self.finished.fetch_add(cases, Ordering::Relaxed) + cases;
        (self.control.progress)(finished, self.all);
    }
}
