//! Integration of one simulation, or of several side by side.

use super::coefficients::{coefficients, first_states};
use super::handout::Handout;
use super::history::{History, Row};
use super::instruction_set::InstructionSet;
use super::outputs::Output;
use super::prepare::Prepared;
use super::reduce::ReducedModel;
use super::shared_forcing::SharedForcing;
use super::size::Size;
use super::step::{Group, State};
use super::stretch::Stretch;
use crate::dynamics::Forcing;
use crate::scenario::Convention;
use crate::simulate::Stages;

/// Samples of one simulation that are forced, solved and handed out at a time.
const SINGLE_BLOCK: usize = 512;
/// Samples of simulations side by side: their states stay in the second-level cache.
const LANES_BLOCK: usize = 128;

/// Simulations that are solved side by side.
pub(crate) const LANES: usize = 8;

/// Successive samples of all outputs of one simulation.
pub struct Block<'a> {
    /// Number of the first sample, 0 at the start of the simulation.
    pub first_sample: usize,
    outputs: &'a [Vec<f64>],
}

impl<'a> Block<'a> {
    pub(super) fn new(first_sample: usize, outputs: &'a [Vec<f64>]) -> Self {
        Self { first_sample, outputs }
    }

    /// The samples of output `index`, in the order in which the outputs were asked for.
    pub fn output(&self, index: usize) -> &[f64] {
        &self.outputs[index]
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.outputs.first().map_or(0, Vec::len)
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Takes the outputs of a solution as they are computed.
pub trait Recorder {
    /// Called for successive blocks of samples, in order.
    ///
    /// # Arguments
    /// * `block` - the outputs
    fn record(&mut self, block: &Block);
}

/// One simulation to integrate.
pub(crate) struct Problem<'a> {
    pub(crate) stages: &'a Stages,
    pub(crate) model: &'a ReducedModel,
    pub(crate) outputs: &'a [Output],
    /// Samples before it are computed, but not recorded.
    pub(crate) first_sample: usize,
}

/// A solution that has grown without bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Diverged {
    /// Number of the sample, from the start of the simulation, by which that had happened.
    pub(crate) sample: usize,
}

/// Integrates one simulation.
///
/// # Errors
/// A solution that grows without bound; nothing is recorded of the block in which that happens, nor after it.
pub(crate) fn integrate(
    problem: &Problem,
    instructions: InstructionSet,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    let size = Size::of(problem.stages, problem.model);
    let [result] = by_size::<1, SINGLE_BLOCK>(size, instructions, [problem], [recorder]);
    result
}

/// Integrates simulations side by side; what comes out of each is the same as alone, bit by bit.
///
/// # Arguments
/// * `size` - at least each problem's own
/// * `problems` - of one convention, with as many outputs each
/// * `recorders` - take the outputs of each
///
/// # Errors
/// As [`integrate`], of each on its own.
pub(crate) fn integrate_side_by_side(
    size: Size,
    problems: [&Problem; LANES],
    instructions: InstructionSet,
    recorders: [&mut dyn Recorder; LANES],
) -> [Result<(), Diverged>; LANES] {
    by_size::<LANES, LANES_BLOCK>(size, instructions, problems, recorders)
}

fn by_size<const L: usize, const BLOCK: usize>(
    size: Size,
    instructions: InstructionSet,
    problems: [&Problem; L],
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let published = problems[0].stages.scenario.convention == Convention::Published;
    macro_rules! solve {
        ($modes:literal, $directions:literal, $steady:literal) => {
            if published {
                solve::<L, $modes, $directions, BLOCK, true, $steady>(problems, instructions, recorders)
            } else {
                solve::<L, $modes, $directions, BLOCK, false, $steady>(problems, instructions, recorders)
            }
        };
    }
    // Each line is compiled for every instruction set, so what is rare shares the largest size.
    match size {
        Size::Flat => solve!(5, 1, true),
        Size::Tilting => solve!(8, 2, true),
        Size::Rolling => solve!(8, 3, true),
        Size::General => solve!(13, 5, false),
    }
}

fn solve<
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
>(
    problems: [&Problem; L],
    instructions: InstructionSet,
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let prepared: [Prepared<R>; L] = std::array::from_fn(|l| Prepared::new(problems[l]));
    let coefficients = coefficients::<L, N, R>(&problems, &prepared);
    let group = Group { coefficients: &coefficients, tables: std::array::from_fn(|l| &prepared[l].table) };
    let rows: Vec<Row<L>> = (0..prepared[0].rows.len())
        .map(|row| Row::new::<N, R>(std::array::from_fn(|l| &prepared[l].rows[row]), coefficients.start))
        .collect();
    let mut forcings: [Forcing; L] =
        std::array::from_fn(|l| Forcing::new(problems[l].stages, &problems[l].model.directions));
    let mut forcing = SharedForcing::new(BLOCK);
    forcing.fill(&mut forcings, 1, STEADY);
    let mut state: State<L, N, R> = first_states(&problems, &prepared, &forcing);
    let mut history = History::<L, N, R, BLOCK>::new();
    let mut out = Handout::new(&problems, rows.len(), BLOCK, recorders);
    let mut done = 0;
    while done < out.most_steps {
        let steps = BLOCK.min(out.most_steps - done);
        forcing.fill(&mut forcings, steps, STEADY);
        let recorded = out.is_recorded(done + steps);
        instructions.run(Stretch::<L, N, R, BLOCK, PUBLISHED, STEADY> {
            group: &group,
            state: &mut state,
            steps_before: done,
            forcing: &forcing,
            steps,
            history: recorded.then_some(&mut history),
        });
        if recorded {
            for (row, values) in rows.iter().zip(&mut out.values) {
                row.evaluate(instructions, &history, done, &mut values[..steps]);
            }
        }
        out.hand_out(done, steps, |l| state.is_sound(l));
        done += steps;
    }
    out.results
}
