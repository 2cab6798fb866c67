//! One group: simulations that are stepped side by side in one thread.

use super::keep::Keep;
use crate::error::Error;
use crate::scenario::{MemoryLimit, Scenario};
use crate::simd::InstructionSet;
use crate::simulate::random_force::WithMeshForces;
use crate::simulate::{KnownStages, Stages, stages_with};
use crate::solver::{LANES, Output, Problem, Recorder, integrate_side_by_side};

/// A scenario and its number.
pub(super) type Numbered = (usize, Scenario);

/// Result of a scenario and its number.
pub(super) type NumberedResult<T> = (usize, Result<T, Error>);

/// A simulation that is ready for the time loop.
struct Ready<R> {
    index: usize,
    stages: Stages,
    /// Those that are asked for, and behind them those of the random forces.
    outputs: Vec<Output>,
    recorder: WithMeshForces<R>,
}

/// Simulates at most [`LANES`] scenarios that go together.
pub(super) fn simulate_group<K: Keep>(
    scenarios: Vec<Numbered>,
    keep: &K,
    known: &KnownStages,
    instructions: InstructionSet,
) -> Vec<NumberedResult<K::Kept>> {
    let mut results = Vec::with_capacity(scenarios.len());
    let mut ready = Vec::with_capacity(scenarios.len());
    for (index, scenario) in scenarios {
        let prepared = stages_with(scenario, MemoryLimit::default(), known).and_then(|stages| {
            let outputs = keep.outputs(&stages.scenario)?;
            Ok((stages, outputs))
        });
        match prepared {
            Ok((stages, outputs)) => {
                let forces = stages.outputs_of_random_forces();
                let recorder = WithMeshForces::new(keep.recorder(&stages), outputs.len(), forces.len());
                ready.push(Ready { index, stages, outputs: [outputs, forces].concat(), recorder });
            }
            Err(error) => results.push((index, Err(error.into()))),
        }
    }
    let divergences = integrate_ready(&mut ready, instructions);
    for (ready, divergence) in ready.into_iter().zip(divergences) {
        let Ready { index, stages, recorder: WithMeshForces { inner, mesh_force_n, .. }, .. } = ready;
        let forces: Vec<&[f64]> = mesh_force_n.iter().map(Vec::as_slice).collect();
        let sound = divergence.and_then(|()| keep.check(&stages, &inner));
        let kept = sound.map(|()| keep.keep(index, stages.with_random_forces(&forces), inner));
        results.push((index, kept));
    }
    results
}

/// Fewest simulations that are faster side by side than one after the other.
const FEWEST_LANES: usize = 2;

/// A simulation of a group: its place in it, its stages, its outputs, and who takes them.
type Placed<'a> = (usize, &'a Stages, &'a [Output], &'a mut dyn Recorder);

/// Integrates the simulations of a group: side by side those that can be, and the others one after the other, as all where they are too
/// few or the processor has no vector registers.
fn integrate_ready<R: Recorder>(
    ready: &mut [Ready<R>],
    instructions: InstructionSet,
) -> Vec<Result<(), Error>> {
    let count = ready.len();
    let (mut together, mut problems, mut alone) = (Vec::<Placed>::new(), Vec::new(), Vec::<Placed>::new());
    for (place, Ready { stages, outputs, recorder, .. }) in ready.iter_mut().enumerate() {
        let (stages, outputs) = (&*stages, outputs.as_slice());
        let lane = (count >= FEWEST_LANES).then(|| stages.lane(outputs).ok()).flatten();
        let side = if lane.is_some() { &mut together } else { &mut alone };
        side.push((place, stages, outputs, recorder));
        problems.extend(lane);
    }
    let mut results = Vec::with_capacity(count);
    // A lane that is left over repeats the last simulation.
    if let Some((_, stages, outputs, _)) = together.last().filter(|_| together.len() >= FEWEST_LANES) {
        let (stages, outputs) = (*stages, *outputs);
        problems.extend((problems.len()..LANES).filter_map(|_| stages.lane(outputs).ok()));
    }
    match (instructions.registers(), <[Problem; LANES]>::try_from(problems)) {
        (Some(registers), Ok(problems)) => {
            let (placed, recorders): (Vec<_>, Vec<_>) = (together.into_iter())
                .map(|(place, stages, _, recorder)| ((place, stages), recorder))
                .unzip();
            let each = integrate_side_by_side(problems, registers, recorders).into_iter().zip(placed);
            results.extend(
                each.map(|(result, (place, stages))| {
                    (place, result.map_err(|error| stages.divergence(error)))
                }),
            );
        }
        _ => alone.extend(together),
    }
    results.extend(alone.into_iter().map(|(place, stages, outputs, recorder)| {
        let first_sample = stages.time.first_kept_sample;
        (place, stages.integrate_with(instructions, outputs, first_sample, recorder))
    }));
    results.sort_by_key(|(place, _)| *place);
    results.into_iter().map(|(_, result)| result).collect()
}
