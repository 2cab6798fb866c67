//! Integration of one simulation, or of several side by side.

use super::coupled;
use super::history::{BLOCK, History, OutputTerms};
use super::lane_outputs::LaneOutputs;
use super::modal::ModalMachine;
use super::outputs::{EXTERNALS, Output};
use super::prepare::Prepared;
use super::repetition::Repeating;
use super::step::{Coefficients, MOST_MODES, MOST_STEADY_MODES, Size, State, StepBlock, law_lanes};
use crate::bearing::RollingBearing;
use crate::mesh::{Forcing, ForcingBlock, MeshLaw, PAIRS, PairsSample};
use crate::operation::TimeGrid;
use crate::simd::{InstructionSet, Lanes};

/// Simulations that are solved side by side.
pub const LANES: usize = 8;

/// Successive samples of all outputs of one simulation.
pub struct Block<'a> {
    /// Number of the first sample, 0 at the start of the simulation.
    pub first_sample: usize,
    outputs: &'a [Vec<f64>],
}

impl<'a> Block<'a> {
    pub(crate) fn new(first_sample: usize, outputs: &'a [Vec<f64>]) -> Self {
        Self { first_sample, outputs }
    }

    /// The samples of all outputs.
    pub(super) fn outputs(&self) -> &[Vec<f64>] {
        self.outputs
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

    /// Called once at the end of a machine of several meshes, with what its steps took. By default that is not kept.
    ///
    /// # Arguments
    /// * `counts` - of all steps
    fn count(&mut self, counts: StepCounts) {
        let _ = counts;
    }

    /// Whether the samples that follow are still wanted: asked after every block. Where they are not, the solution ends there,
    /// without an error. By default they always are.
    fn goes_on(&self) -> bool {
        true
    }
}

/// What the steps of a machine of several meshes took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StepCounts {
    /// Steps.
    pub steps: u64,
    /// Iterations of Newton's method, the last check of each step included.
    pub iterations: u64,
    /// Most iterations of a step.
    pub most_iterations: u64,
    /// Steps in which a search along the line was needed.
    pub searched: u64,
}

/// One simulation to integrate.
pub struct Problem<'a> {
    /// Division of time.
    pub time: &'a TimeGrid,
    /// The machine.
    pub machine: ModalMachine,
    /// The law of each mesh.
    pub laws: Vec<MeshLaw>,
    /// The rolling bearings, in the order of the machine's.
    pub bearings: Vec<RollingBearing>,
    /// Motor, brake, the pairs of the meshes and the elements of the bearings, from the first simulated sample on.
    pub forcing: Forcing<'a>,
    /// Whether motor and brake are steady.
    pub is_steady: bool,
    /// Samples after which the same teeth meet again, where motor and brake are steady.
    pub hunting_period_samples: Option<usize>,
    /// What is read off the solution.
    pub outputs: &'a [Output],
    /// Samples before it are computed, but not recorded.
    pub first_sample: usize,
}

impl Problem<'_> {
    /// Whether the steps that are compiled for simulations side by side hold it: one mesh of as many springs as spur wheels have pairs, no
    /// rolling bearings or unbalance, and no more modes than the largest has, all of which are stepped.
    pub(crate) fn fits_a_lane(&self) -> bool {
        let machine = &self.machine;
        machine.lines.len() == 1
            && machine.bearings.is_empty()
            && machine.turning_forces.is_empty()
            && self.forcing.springs().eq([PAIRS])
            && machine.modes() <= MOST_MODES
            && machine.residual.is_empty()
    }
}

/// (m √kg) Displacement of a mode, with a modal mass of 1 kg, that no machine has: a motion that reaches it grows without bound.
const LARGEST_DISPLACEMENT: f64 = 1e12;

/// Whether a mode moves as a machine can.
///
/// # Arguments
/// * `displacement` - (m √kg) its displacement, or its velocity times half of the time step
pub(super) fn is_bounded(displacement: f64) -> bool {
    displacement.abs() < LARGEST_DISPLACEMENT
}

/// A solution that has grown without bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Diverged {
    /// Number of the sample, from the start of the simulation, by which that had happened.
    pub sample: usize,
}

/// Integrates one simulation.
///
/// # Errors
/// A solution that grows without bound; nothing is recorded of the block in which that happens, nor after it.
pub fn integrate(
    problem: Problem,
    instructions: InstructionSet,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    let recorder = &mut Repeating::new(&problem, recorder);
    if !problem.fits_a_lane() {
        return coupled::integrate(problem, instructions, recorder);
    }
    let size = Size::of(&problem);
    let [result] = of_size(size, [problem], instructions, vec![recorder]);
    result
}

/// Integrates simulations of one mesh each side by side; what comes out of each is the same as alone, bit by bit.
///
/// # Arguments
/// * `problems` - as many lanes
/// * `recorders` - take the outputs of the first lanes; the others repeat a simulation
///
/// # Errors
/// As [`integrate`], of each on its own.
pub fn integrate_side_by_side(
    problems: [Problem; LANES],
    instructions: InstructionSet,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; LANES] {
    let size = problems.each_ref().map(Size::of).into_iter().max().unwrap_or(Size::General);
    let mut repeating: Vec<Repeating> =
        problems.iter().zip(recorders).map(|(problem, recorder)| Repeating::new(problem, recorder)).collect();
    let recorders = repeating.iter_mut().map(|recorder| recorder as &mut dyn Recorder).collect();
    of_size(size, problems, instructions, recorders)
}

fn of_size<const L: usize>(
    size: Size,
    problems: [Problem; L],
    instructions: InstructionSet,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; L] {
    match size {
        Size::Flat => run::<L, 8, 1>(problems, instructions, recorders),
        Size::Tilting => run::<L, MOST_STEADY_MODES, 2>(problems, instructions, recorders),
        Size::General => run::<L, MOST_MODES, 2>(problems, instructions, recorders),
    }
}

/// Steps `L` simulations from their first sample to their last.
///
/// Time is divided into blocks of samples. For each block the forcing is tabulated first, then all steps are made, and then the outputs
/// are computed from the states of the block, so that each of the three loops is short and its numbers stay in the cache.
fn run<const L: usize, const N: usize, const R: usize>(
    mut problems: [Problem; L],
    instructions: InstructionSet,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; L] {
    let prepared: [Prepared; L] = problems.each_ref().map(Prepared::new);
    let coefficients = Coefficients::<L, N, R>::new(&prepared);
    let law = law_lanes(&prepared);
    let start = Lanes::from_fn(|l| problems[l].time.first_simulated_sample as f64);
    let outputs = prepared.iter().map(|of| of.outputs.len()).max().unwrap_or(0);
    let terms: Vec<OutputTerms<L>> = (0..outputs)
        .map(|output| OutputTerms::new::<N, R>(prepared.each_ref().map(|of| of.outputs.get(output)), start))
        .collect();
    let mut out = LaneOutputs::new(problems.each_ref(), outputs, BLOCK, recorders);
    let mut forcing = LaneForcing::new();
    forcing.fill(&mut problems, 1);
    let first = std::array::from_fn(|l| {
        let external = forcing.external[0].map(|external| external.0[l]);
        prepared[l].first_state(&problems[l].machine, &forcing.blocks[l], external)
    });
    let mut state: State<L, N, R> = coefficients.first_state(&first);
    let mut history = History::<L, N, R>::new();
    let mut done = 0;
    while done < out.most_steps {
        let steps = BLOCK.min(out.most_steps - done);
        forcing.fill(&mut problems, steps);
        let recorded = out.is_recorded(done + steps);
        instructions.run(StepBlock {
            coefficients: &coefficients,
            law: &law,
            state: &mut state,
            pairs: &forcing.pairs[..steps],
            external: &forcing.external[..steps],
            history: recorded.then_some(&mut history),
        });
        if recorded {
            for (terms, values) in terms.iter().zip(&mut out.values) {
                terms.evaluate(instructions, &history, done, &mut values[..steps]);
            }
        }
        out.record(done, steps, |l| coefficients.is_sound(&state, l));
        if !out.goes_on() {
            break;
        }
        done += steps;
    }
    out.results
}

/// Forcing of one block of samples of `L` simulations, side by side.
struct LaneForcing<const L: usize> {
    /// The pairs of the one mesh.
    pairs: Vec<PairsSample<L>>,
    /// Motor lead, torque deviation and speed deviation; 0 while motor and brake are steady.
    external: Vec<[Lanes<L>; EXTERNALS]>,
    blocks: [ForcingBlock; L],
}

impl<const L: usize> LaneForcing<L> {
    fn new() -> Self {
        Self {
            pairs: vec![PairsSample::NONE; BLOCK],
            external: vec![[Lanes::splat(0.0); EXTERNALS]; BLOCK],
            blocks: std::array::from_fn(|_| ForcingBlock::default()),
        }
    }

    /// Takes the next `samples` samples of every lane.
    fn fill(&mut self, problems: &mut [Problem; L], samples: usize) {
        for (l, (problem, block)) in problems.iter_mut().zip(&mut self.blocks).enumerate() {
            problem.forcing.next_block(samples, block);
            for (x, part) in block.external.parts().into_iter().enumerate() {
                for (external, value) in self.external.iter_mut().zip(part) {
                    external[x].0[l] = *value;
                }
            }
        }
        PairsSample::line_up(
            &mut self.pairs[..samples],
            &self.blocks.each_ref().map(|block| &block.meshes[0]),
        );
    }
}
