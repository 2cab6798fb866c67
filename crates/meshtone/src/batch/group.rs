//! One group: simulations that are stepped side by side in one thread.

use super::keep::Keep;
use crate::error::Error;
use crate::scenario::Scenario;
use crate::simd::InstructionSet;
use crate::simulate::{Stages, stages};
use crate::solver::{
    Block, LANES, Output, Problem, Recorder, ReducedModel, Size, integrate, integrate_side_by_side,
};

/// A scenario and its number.
pub(super) type Numbered = (usize, Scenario);

/// Result of a scenario and its number.
pub(super) type NumberedResult<T> = (usize, Result<T, Error>);

/// A simulation that is ready for the time loop.
struct Ready<R> {
    index: usize,
    stages: Stages,
    model: ReducedModel,
    outputs: Vec<Output>,
    recorder: R,
}

/// Takes the outputs of a lane that no simulation is left for.
struct Nobody;

impl Recorder for Nobody {
    fn record(&mut self, _: &Block) {}
}

/// Simulates at most [`LANES`] scenarios of one mesh law.
pub(super) fn simulate_group<K: Keep>(
    scenarios: Vec<Numbered>,
    keep: &K,
    instructions: InstructionSet,
) -> Vec<NumberedResult<K::Kept>> {
    let mut results = Vec::with_capacity(scenarios.len());
    let mut ready = Vec::with_capacity(scenarios.len());
    for (index, scenario) in scenarios {
        match stages(&scenario)
            .and_then(|stages| keep.outputs(&stages.scenario).map(|outputs| (stages, outputs)))
        {
            Ok((stages, outputs)) => {
                let model = stages.reduced_model();
                let recorder = keep.recorder(&stages);
                ready.push(Ready { index, stages, model, outputs, recorder });
            }
            Err(error) => results.push((index, Err(error.into()))),
        }
    }
    give_as_many_outputs(&mut ready);
    let divergences = integrate_ready(&mut ready, instructions);
    for (ready, divergence) in ready.into_iter().zip(divergences) {
        let kept = divergence.map(|()| keep.keep(ready.index, ready.stages, ready.recorder));
        results.push((ready.index, kept));
    }
    results
}

/// Fewest simulations that are faster side by side than one after the other.
const FEWEST_LANES: usize = 2;

/// Gives every simulation as many outputs as that with most has, for scenarios may list more sensors or fewer: what is added is 0,
/// and nobody reads it.
fn give_as_many_outputs<R>(ready: &mut [Ready<R>]) {
    let most = ready.iter().map(|ready| ready.outputs.len()).max().unwrap_or(0);
    ready.iter_mut().for_each(|ready| ready.outputs.resize(most, Output::Acceleration(Vec::new())));
}

fn integrate_ready<R: Recorder>(
    ready: &mut [Ready<R>],
    instructions: InstructionSet,
) -> Vec<Result<(), Error>> {
    if ready.len() < FEWEST_LANES {
        let single = |ready: &mut Ready<R>| {
            let problem = ready.stages.problem(&ready.model, &ready.outputs);
            integrate(&problem, instructions, &mut ready.recorder)
                .map_err(|diverged| ready.stages.divergence(diverged))
        };
        return ready.iter_mut().map(single).collect();
    }
    let mut problems = Vec::with_capacity(LANES);
    let mut recorders: Vec<&mut dyn Recorder> = Vec::with_capacity(LANES);
    let mut nobody: [Nobody; LANES] = std::array::from_fn(|_| Nobody);
    let mut stages = Vec::with_capacity(ready.len());
    for ready in ready.iter_mut() {
        problems.push(ready.stages.problem(&ready.model, &ready.outputs));
        recorders.push(&mut ready.recorder);
        stages.push(&ready.stages);
    }
    let size = problems.iter().map(Size::of).max().unwrap_or(Size::Flat);
    recorders.extend(nobody.iter_mut().map(|nobody| nobody as &mut dyn Recorder));
    let mut recorders = recorders.into_iter();
    // A lane that is left over repeats the last simulation, for nobody.
    let lanes: [&Problem; LANES] = std::array::from_fn(|l| &problems[l.min(problems.len() - 1)]);
    // There are more recorders than lanes.
    let taken: Option<[&mut dyn Recorder; LANES]> =
        recorders.by_ref().take(LANES).collect::<Vec<_>>().try_into().ok();
    let Some(taken) = taken else { return Vec::new() };
    let results = integrate_side_by_side(size, lanes, instructions, taken);
    let each = results.into_iter().zip(stages);
    each.map(|(result, stages)| result.map_err(|diverged| stages.divergence(diverged))).collect()
}
