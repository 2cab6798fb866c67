//! Integration of one simulation, or of several side by side.

use super::coefficients::{coefficients, state};
use super::handout::Handout;
use super::history::{History, Row};
use super::outputs::Output;
use super::prepare::Prepared;
use super::reduce::ReducedModel;
use super::shared_forcing::SharedForcing;
use super::size::Size;
use super::step::{Coefficients, State};
use super::stretch::Stretch;
use crate::mesh::Mesh;
use crate::mesh::forcing::{Forcing, ForcingSource};
use crate::mesh::law::{
    ContactConstants, ContactLaw, ContactSample, LinearLaw, MeshLaw, MeshTable, PublishedLaw, TabulatedSample,
};
use crate::operation::TimeGrid;
use crate::simd::InstructionSet;

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

    /// Whether the samples that follow are still wanted: asked after every block. Where they are not, the solution ends there,
    /// without an error. By default they always are.
    fn goes_on(&self) -> bool {
        true
    }
}

/// One simulation to integrate.
pub(crate) struct Problem<'a> {
    /// Division of time.
    pub(crate) time: &'a TimeGrid,
    /// The modes.
    pub(crate) model: &'a ReducedModel,
    /// The mesh, with its law.
    pub(crate) mesh: &'a Mesh,
    /// Points of the mesh's cycle in a revolution of the pinion.
    pub(crate) points_per_revolution: f64,
    /// What forces them.
    pub(crate) source: &'a dyn ForcingSource,
    /// (N m) Nominal torque of the brake.
    pub(crate) brake_torque_nm: f64,
    /// Whether motor and brake are steady.
    pub(crate) steady: bool,
    /// What is read off the solution.
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
    let size = Size::of(problem);
    let [result] = by_size::<1, SINGLE_BLOCK>(size, instructions, [problem], [recorder]);
    result
}

/// Integrates simulations side by side; what comes out of each is the same as alone, bit by bit.
///
/// # Arguments
/// * `size` - at least each problem's own
/// * `problems` - of one mesh law, with as many outputs each
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
    macro_rules! solve {
        ($law:ident, $modes:literal, $directions:literal, $steady:literal) => {
            $law::<L, $modes, $directions, BLOCK, $steady>(problems, instructions, recorders)
        };
    }
    // Each line is compiled for every instruction set, so what is rare shares the largest size.
    match size {
        Size::Flat => solve!(solve_linear, 5, 1, true),
        Size::Tilting => solve!(solve_linear, 8, 2, true),
        Size::Rolling => solve!(solve_linear, 8, 3, true),
        Size::General => solve!(solve_linear, 13, 5, false),
        Size::Published => solve!(solve_published, 8, 3, true),
        Size::PublishedGeneral => solve!(solve_published, 13, 5, false),
        Size::ContactFlat => solve!(solve_contact, 8, 1, true),
        Size::ContactTilting => solve!(solve_contact, 12, 2, true),
        Size::ContactGeneral => solve!(solve_contact, 17, 2, false),
    }
}

/// Simulations that are ready for the time loop, under laws that take samples `S`.
struct Run<'a, 'r, S, const L: usize, const N: usize, const R: usize> {
    coefficients: Coefficients<L, N, R>,
    rows: Vec<Row<L>>,
    forcings: [Box<dyn Forcing + 'a>; L],
    forcing: SharedForcing<S, L>,
    out: Handout<'r, L>,
}

impl<'a, 'r, S: Copy, const L: usize, const N: usize, const R: usize> Run<'a, 'r, S, L, N, R> {
    /// Lines `L` simulations up, with the forcing of their first sample.
    ///
    /// # Arguments
    /// * `problems`, `prepared` - the simulations
    /// * `forcing` - room for the samples of a block
    /// * `recorders` - take the outputs of each
    fn new<const BLOCK: usize, const STEADY: bool>(
        problems: &[&'a Problem<'a>; L],
        prepared: &[Prepared<R>; L],
        mut forcing: SharedForcing<S, L>,
        recorders: [&'r mut dyn Recorder; L],
    ) -> Self {
        let coefficients = coefficients::<L, N, R>(problems, prepared);
        let rows: Vec<Row<L>> = (0..prepared[0].rows.len())
            .map(|row| Row::new::<N, R>(std::array::from_fn(|l| &prepared[l].rows[row]), coefficients.start))
            .collect();
        let mut forcings: [Box<dyn Forcing + 'a>; L] =
            std::array::from_fn(|l| problems[l].source.forcing(&problems[l].model.directions));
        forcing.fill(&mut forcings, 1, STEADY);
        let out = Handout::new(problems, rows.len(), BLOCK, recorders);
        Self { coefficients, rows, forcings, forcing, out }
    }

    fn finish<M: MeshLaw<L, R, Sample = S>, const BLOCK: usize, const STEADY: bool>(
        mut self,
        law: &M,
        mut state: State<L, N, R>,
        instructions: InstructionSet,
    ) -> [Result<(), Diverged>; L] {
        let mut history = History::<L, N, R, BLOCK>::new();
        let mut done = 0;
        while done < self.out.most_steps {
            let steps = BLOCK.min(self.out.most_steps - done);
            self.forcing.fill(&mut self.forcings, steps, STEADY);
            let recorded = self.out.is_recorded(done + steps);
            instructions.run(Stretch::<M, L, N, R, BLOCK, STEADY> {
                coefficients: &self.coefficients,
                law,
                state: &mut state,
                steps_before: done,
                forcing: &self.forcing,
                steps,
                history: recorded.then_some(&mut history),
            });
            if recorded {
                for (row, values) in self.rows.iter().zip(&mut self.out.values) {
                    row.evaluate(instructions, &history, done, &mut values[..steps]);
                }
            }
            let coefficients = &self.coefficients;
            self.out.hand_out(done, steps, |l| coefficients.is_sound(&state, l));
            if !self.out.goes_on() {
                break;
            }
            done += steps;
        }
        self.out.results
    }
}

/// Simulations under a law of tables, linear or published, lined up: the meshes' tables, the run and its first state.
#[allow(clippy::type_complexity, reason = "taken apart where it is made")]
fn with_tables<
    'a,
    'r,
    const L: usize,
    const N: usize,
    const R: usize,
    const BLOCK: usize,
    const STEADY: bool,
>(
    problems: &[&'a Problem<'a>; L],
    recorders: [&'r mut dyn Recorder; L],
) -> ([MeshTable<R>; L], Run<'a, 'r, TabulatedSample<L, R>, L, N, R>, State<L, N, R>) {
    let prepared: [Prepared<R>; L] = std::array::from_fn(|l| Prepared::new(problems[l]));
    let forcing = SharedForcing::new(BLOCK, TabulatedSample::NOTHING, |samples, blocks| {
        for (lane, block) in blocks.iter().enumerate() {
            TabulatedSample::fill(samples, lane, block);
        }
    });
    let run = Run::<_, L, N, R>::new::<BLOCK, STEADY>(problems, &prepared, forcing, recorders);
    let meshes: [MeshTable<R>; L] = std::array::from_fn(|l| prepared[l].table(problems[l]));
    let (sample, external) = (&run.forcing.samples[0], run.forcing.external[0]);
    let first = std::array::from_fn(|l| {
        prepared[l].first_state(problems[l], &meshes[l], (sample, l), &external.map(|external| external.0[l]))
    });
    let state = state(&run.coefficients, &first, external);
    (meshes, run, state)
}

/// Under the linear law.
fn solve_linear<const L: usize, const N: usize, const R: usize, const BLOCK: usize, const STEADY: bool>(
    problems: [&Problem; L],
    instructions: InstructionSet,
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let (meshes, run, state) = with_tables::<L, N, R, BLOCK, STEADY>(&problems, recorders);
    run.finish::<_, BLOCK, STEADY>(&LinearLaw { tables: meshes.each_ref() }, state, instructions)
}

/// Under the published law.
fn solve_published<const L: usize, const N: usize, const R: usize, const BLOCK: usize, const STEADY: bool>(
    problems: [&Problem; L],
    instructions: InstructionSet,
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let Some(cycles) = problems.iter().map(|problem| problem.mesh.cycle()).collect::<Option<Vec<_>>>() else {
        return solve_linear::<L, N, R, BLOCK, STEADY>(problems, instructions, recorders);
    };
    let (meshes, run, state) = with_tables::<L, N, R, BLOCK, STEADY>(&problems, recorders);
    let law = PublishedLaw::new(meshes.each_ref(), std::array::from_fn(|l| cycles[l]));
    run.finish::<_, BLOCK, STEADY>(&law, state, instructions)
}

/// Under the law of contact.
fn solve_contact<const L: usize, const N: usize, const R: usize, const BLOCK: usize, const STEADY: bool>(
    problems: [&Problem; L],
    instructions: InstructionSet,
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let prepared: [Prepared<R>; L] = std::array::from_fn(|l| Prepared::new(problems[l]));
    let forcing = SharedForcing::new(BLOCK, ContactSample::NOTHING, ContactSample::fill);
    let run = Run::<_, L, N, R>::new::<BLOCK, STEADY>(&problems, &prepared, forcing, recorders);
    let constants: [ContactConstants; L] = std::array::from_fn(|l| problems[l].contact_constants());
    let law = ContactLaw::new(constants, std::array::from_fn(|l| prepared[l].scales.half_step_s));
    let sample = &run.forcing.samples[0];
    let first =
        std::array::from_fn(|l| prepared[l].first_state_in_contact(problems[l], &constants[l], sample, l));
    let state = state(&run.coefficients, &first, run.forcing.external[0]);
    run.finish::<_, BLOCK, STEADY>(&law, state, instructions)
}

impl Problem<'_> {
    /// What the law of contact needs; without damping under another law.
    pub(super) fn contact_constants(&self) -> ContactConstants {
        let static_force_n = self.model.static_mesh_force_n;
        self.mesh.contact().map_or_else(ContactConstants::default, |mesh| mesh.constants(static_force_n))
    }
}
