//! One group: simulations that are stepped side by side in one thread.

use super::keep::Keep;
use crate::error::Error;
use crate::scenario::Scenario;
use crate::simd::InstructionSet;
use crate::simulate::{Stages, stages};
use crate::solver::{LANES, Output, Problem, Recorder, integrate_side_by_side};

/// A scenario and its number.
pub(super) type Numbered<S> = (usize, S);

/// Result of a scenario and its number.
pub(super) type NumberedResult<T> = (usize, Result<T, Error>);

/// A simulation that is ready for the time loop.
struct Ready<R> {
    index: usize,
    stages: Stages,
    outputs: Vec<Output>,
    recorder: R,
}

/// Simulates at most [`LANES`] scenarios that go together.
pub(super) fn simulate_group<K: Keep>(
    scenarios: Vec<Numbered<Scenario>>,
    keep: &K,
    instructions: InstructionSet,
) -> Vec<NumberedResult<K::Kept>> {
    let mut results = Vec::with_capacity(scenarios.len());
    let mut ready = Vec::with_capacity(scenarios.len());
    for (index, scenario) in scenarios {
        let outputs = keep.outputs(&scenario.without_ignored_keys());
        match stages(scenario).and_then(|stages| Ok((stages, outputs?))) {
            Ok((stages, outputs)) => {
                let recorder = keep.recorder(&stages);
                ready.push(Ready { index, stages, outputs, recorder });
            }
            Err(error) => results.push((index, Err(error.into()))),
        }
    }
    let divergences = integrate_ready(&mut ready, instructions);
    for (ready, divergence) in ready.into_iter().zip(divergences) {
        let kept = divergence.map(|()| keep.keep(ready.index, ready.stages, ready.recorder));
        results.push((ready.index, kept));
    }
    results
}

/// Fewest simulations that are faster side by side than one after the other.
const FEWEST_LANES: usize = 2;

/// Integrates the simulations of a group: side by side, or where they are too few or solved otherwise, one after the other.
fn integrate_ready<R: Recorder>(
    ready: &mut [Ready<R>],
    instructions: InstructionSet,
) -> Vec<Result<(), Error>> {
    let (mut simulations, mut recorders) = (Vec::with_capacity(LANES), Vec::<&mut dyn Recorder>::new());
    for Ready { stages, outputs, recorder, .. } in ready {
        simulations.push((&*stages, outputs.as_slice()));
        recorders.push(recorder);
    }
    if simulations.len() >= FEWEST_LANES {
        // A lane that is left over repeats the last simulation.
        let last = simulations.len() - 1;
        let lanes = (0..LANES).filter_map(|lane| {
            let (stages, outputs) = simulations[lane.min(last)];
            stages.lane(outputs)
        });
        if let Ok(problems) = <[Problem; LANES]>::try_from(lanes.collect::<Vec<_>>()) {
            let results = integrate_side_by_side(problems, instructions, recorders);
            let each = results.into_iter().zip(simulations);
            return each
                .map(|(result, (stages, _))| result.map_err(|error| stages.divergence(error)))
                .collect();
        }
    }
    let each = simulations.into_iter().zip(recorders);
    let alone = |((stages, outputs), recorder): ((&Stages, &[Output]), &mut dyn Recorder)| {
        stages.integrate_with(instructions, outputs, stages.time.first_kept_sample, recorder)
    };
    each.map(alone).collect()
}
