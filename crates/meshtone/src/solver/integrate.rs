//! Integration of one simulation, or of several side by side.

use super::coefficients::{coefficients, first_states};
use super::handout::Handout;
use super::history::{History, Row};
use super::instruction_set::InstructionSet;
use super::outputs::Output;
use super::prepare::{FirstState, Prepared};
use super::reduce::ReducedModel;
use super::shared_forcing::SharedForcing;
use super::size::Size;
use super::step::Group;
use super::stretch::{SizedLoop, TimeLoop};
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
    let (modes, directions, steady) = (size.modes(), size.directions(), size != Size::General);
    let prepared = problems.map(|problem| Prepared::new(problem, directions));
    let start = problems.map(|problem| problem.stages.time.first_simulated_sample as f64);
    let rows: Vec<Row<L>> = (0..prepared[0].rows.len())
        .map(|row| Row::new(std::array::from_fn(|l| &prepared[l].rows[row]), modes, directions, start))
        .collect();
    let mut forcings = problems.map(|problem| Forcing::new(problem.stages, &problem.model.directions));
    let mut forcing = SharedForcing::<L>::new(BLOCK, directions);
    forcing.fill(&mut forcings, 1, steady);
    let first = std::array::from_fn(|l| {
        let (errors, external) = forcing.first(l);
        prepared[l].first_state(problems[l], &errors, external)
    });
    let mut time_loop = time_loop::<L, BLOCK>(size, &problems, &prepared, &first);
    let mut history = History::<L, BLOCK>::new(modes, directions);
    let mut out = Handout::new(&problems, rows.len(), BLOCK, recorders);
    let mut done = 0;
    while done < out.most_steps {
        let steps = BLOCK.min(out.most_steps - done);
        forcing.fill(&mut forcings, steps, steady);
        let recorded = out.is_recorded(done + steps);
        time_loop.advance(instructions, done, steps, &forcing, recorded.then_some(&mut history));
        if recorded {
            for (row, values) in rows.iter().zip(&mut out.values) {
                row.evaluate(instructions, &history, done, &mut values[..steps]);
            }
        }
        out.hand_out(done, steps, std::array::from_fn(|l| time_loop.is_sound(l)));
        done += steps;
    }
    out.results
}

/// The time loop of a size, at the first sample.
fn time_loop<'a, const L: usize, const BLOCK: usize>(
    size: Size,
    problems: &[&Problem; L],
    prepared: &'a [Prepared; L],
    first: &[FirstState; L],
) -> Box<dyn TimeLoop<L, BLOCK> + 'a> {
    let published = problems[0].stages.scenario.convention == Convention::Published;
    macro_rules! time_loop {
        ($size:expr, $published:literal, $steady:literal) => {{
            let sized: SizedLoop<'a, L, { $size.modes() }, { $size.directions() }, $published, $steady> =
                SizedLoop {
                    group: Group {
                        coefficients: coefficients(problems, prepared),
                        tables: prepared.each_ref().map(|prepared| prepared.table.points()),
                    },
                    state: first_states(first),
                };
            Box::new(sized)
        }};
    }
    // Each line is compiled for every instruction set, so what is rare shares the largest size.
    match (size, published) {
        (Size::Flat, false) => time_loop!(Size::Flat, false, true),
        (Size::Tilting, false) => time_loop!(Size::Tilting, false, true),
        (Size::Rolling, false) => time_loop!(Size::Rolling, false, true),
        (Size::General, false) => time_loop!(Size::General, false, false),
        (Size::Flat, true) => time_loop!(Size::Flat, true, true),
        (Size::Tilting, true) => time_loop!(Size::Tilting, true, true),
        (Size::Rolling, true) => time_loop!(Size::Rolling, true, true),
        (Size::General, true) => time_loop!(Size::General, true, false),
    }
}
