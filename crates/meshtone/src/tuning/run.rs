//! Runs an experiment.

use std::sync::atomic::AtomicBool;

use super::key_search::KeySearch;
use super::search::Target;
use super::simulations::Simulations;
use super::tune::TuningInputs;
use super::{Case, Enhancement, Experiment, HybridError, SimulatedCases, Tuning, TuningWarning, tune};
use crate::scenario::Scenario;
use crate::signal::{GearTrain, SeparationSettings};

/// Result of an experiment.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ExperimentResult {
    /// The original simulation: difference signals of the scenario as it is, before anything was tuned.
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
    /// The three parameters.
    ///
    /// For each case that is left out, the keys' values are searched anew, near those that fit the other cases; the prediction is the mean over
    /// the best of them.
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
    /// Called with the simulations that are finished, which never fall, and all there are, from any thread.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    /// Set to stop, at any time; the experiment then ends with [`HybridError::Cancelled`].
    pub cancelled: &'a AtomicBool,
}

/// Simulates an experiment's cases and tunes them to what was measured.
///
/// # Arguments
/// * `experiment` - what is tuned
/// * `control` - progress and cancellation
///
/// # Errors
/// Those of [`Experiment::check`]; a case that cannot be simulated as it is; no combination of the keys' values that can be
/// simulated; cancelled.
pub fn run_experiment(
    experiment: &Experiment,
    control: &ExperimentControl,
) -> Result<ExperimentResult, HybridError> {
    experiment.check()?;
    let simulations = Simulations::new(experiment, control);
    let unchanged: Vec<Scenario> = experiment.cases.iter().map(|case| experiment.scenario(case)).collect();
    let original = SimulatedCases::new(simulations.run(vec![unchanged])?.swap_remove(0)?)?;
    let Experiment { measured, bounds, seed, .. } = experiment;
    let cancelled = control.cancelled;
    let mut enhancement_alone = tune(&original, measured, bounds, *seed, cancelled)?;
    let mut with_keys = None;
    if !experiment.keys.is_empty() {
        let predicted = original.predict(measured.indicators(), &Enhancement::default())?;
        let target = Target { measured, bounds, cancelled };
        let common = TuningInputs { target, seed: *seed, original: &predicted };
        let keys = KeySearch::new(experiment, &simulations, common, &original)?.run()?;
        with_keys = kept(keys, &mut enhancement_alone);
    }
    let keys = if with_keys.is_some() { experiment.keys.len() } else { 0 };
    let reported = with_keys.as_mut().map_or(&mut enhancement_alone, |keys| &mut keys.tuning);
    reported.warnings.extend(damaged_on_other_shafts(experiment));
    reported.warnings.extend(few_numbers(experiment, keys));
    reported.warnings.extend(predicts_worse(reported));
    Ok(ExperimentResult { original, enhancement_alone, with_keys })
}

/// Cases whose damage meets another place of the averaged wheel in each of its revolutions.
fn damaged_on_other_shafts(experiment: &Experiment) -> Vec<TuningWarning> {
    let (base, averaged) = (&experiment.base, &experiment.chain.wheel);
    let Ok(train) = GearTrain::of_scenario(base) else { return Vec::new() };
    let wheel_of = |name: &str| train.wheels.iter().position(|wheel| wheel.name == name);
    let Some(number) = wheel_of(averaged) else { return Vec::new() };
    let taken_away = train.separation(number, &SeparationSettings::new(1)).other_orders;
    let fades = |damaged: &str| {
        let Some(damaged) = wheel_of(damaged) else { return false };
        let turns = train.speed_ratio(train.wheels[damaged].shaft, train.wheels[number].shaft);
        // Where the other shaft turns a whole number of times meanwhile, its damage is averaged as well, unless its orders are taken away.
        turns.denominator != 1 || taken_away.iter().any(|order| turns.numerator % *order as i64 == 0)
    };
    let faulty = experiment.cases.iter().enumerate().skip(1);
    let fading = faulty.filter(|(_, case)| case.faults.iter().all(|fault| fades(&fault.wheel)));
    let warning = |(case, of): (usize, &Case)| {
        let mut damaged: Vec<String> =
            of.faults.iter().map(|fault| base.wheel_in_words(&fault.wheel)).collect();
        damaged.dedup();
        TuningWarning::OtherWheel {
            case,
            damaged: damaged.join(" and "),
            averaged: base.wheel_in_words(averaged),
        }
    };
    fading.map(warning).collect()
}

/// Warns where there are no more measurements than tuned numbers.
///
/// # Arguments
/// * `keys` - that were tuned as well
fn few_numbers(experiment: &Experiment, keys: usize) -> Option<TuningWarning> {
    let measured = experiment.measured.cases() * experiment.measured.indicators().len();
    let free = experiment.bounds.all().into_iter().filter(|(_, [least, largest])| least < largest);
    let tuned = free.count() + keys;
    (measured <= tuned).then_some(TuningWarning::FewNumbers { measured, tuned })
}

/// Warns where other cases were better predicted before anything was tuned.
fn predicts_worse(tuning: &Tuning) -> Option<TuningWarning> {
    let (original, left_out) = (tuning.original_error, tuning.mean_leave_one_out_error());
    (left_out > original).then_some(TuningWarning::PredictsWorse { original, left_out })
}

/// The tuned keys, where they are better than the scenario as it is; a doubt is added to whichever of both is reported.
fn kept(mut keys: TunedKeys, alone: &mut Tuning) -> Option<TunedKeys> {
    let help = keys.tuning.enhanced_error < alone.enhanced_error;
    let reported = if help { &mut keys.tuning } else { &mut *alone };
    if let Some(first) = &keys.first_failure {
        reported.warnings.push(TuningWarning::Failed { failed: keys.failed, first: first.clone() });
    }
    if !help {
        alone.warnings.push(TuningWarning::KeysDoNotHelp);
        return None;
    }
    let [before, after] = [&*alone, &keys.tuning].map(Tuning::mean_leave_one_out_error);
    if after > before {
        keys.tuning.warnings.push(TuningWarning::KeysPredictWorse { alone: before, together: after });
    }
    Some(keys)
}
