//! Integration of one simulation, or of several side by side.

use std::array::from_fn;
use std::fmt;

use super::coupled;
use super::history::{BLOCK, History, OutputTerms};
use super::lane_outputs::LaneOutputs;
use super::modal::ModalMachine;
use super::outputs::{EXTERNALS, Output};
use super::prepare::Prepared;
use super::repetition::Repeating;
use super::step::{
    Coefficients, MOST_MODES, MOST_PAIRS, MOST_STEADY_MODES, MOST_TURNING_MODES, MOST_UNDRIVEN_MODES,
    MOVED_IN_PLANE, Size, State, StepBlock, TurningSample, USUAL_PAIRS, law_lanes,
};
use crate::bearing::RollingBearing;
use crate::mesh::{
    CornerLane, CornerLanes, CornerLaw, Forcing, ForcingBlock, Mesh, MeshLaw, PAIRS, PairsSample,
    SpringSamples, line_up,
};
use crate::operation::TimeGrid;
use crate::simd::{Dispatch, InstructionSet, Lanes, OneByOne, Registers};

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
    pub(crate) fn outputs(&self) -> &[Vec<f64>] {
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

/// The motion at one sample, from which it can go on with another step.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionState {
    /// Number of the sample, 0 at the start of the simulation.
    pub sample: usize,
    /// (m √kg) Displacement of each stepped mode.
    pub(super) displacement: Vec<f64>,
    /// (m √kg/s) Velocity of each.
    pub(super) velocity: Vec<f64>,
    /// (N) Force in each column of the lines of action, and then of the bearings.
    pub(super) force: Vec<f64>,
}

/// Takes the outputs of a solution as they are computed.
pub trait Recorder {
    /// Called for successive blocks of samples, in order.
    ///
    /// # Arguments
    /// * `block` - the outputs
    fn record(&mut self, block: &Block);

    /// Whether the motion at a sample is wanted beside the outputs: asked before every block. By default it never is.
    ///
    /// # Arguments
    /// * `sample` - the first one of the block
    fn wants_state(&self, sample: usize) -> bool {
        let _ = sample;
        false
    }

    /// Called with the motion at the samples at which it is wanted. By default that is not kept.
    ///
    /// # Arguments
    /// * `state` - the motion
    fn keep_state(&mut self, state: MotionState) {
        let _ = state;
    }

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

/// Why a simulation is stepped alone, and not side by side with others of a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum SteppedAlone {
    /// The published model has a solver of its own.
    PublishedModel,
    /// The machine has several meshes, whose deflections are solved together.
    SeveralMeshes,
    /// Gyroscopic moments shift its modes.
    GyroscopicMoments,
    /// The machine has rolling bearings, whose stretches are solved together with the mesh.
    RollingBearings,
    /// The face is cut into slices, each of which is a spring.
    SlicedFace,
    /// The deflection of helical teeth has a slope along the face.
    TiltedHelical,
    /// A slope of the flanks along the face turns with a wheel.
    Wobble,
    /// The flanks rub.
    Friction,
    /// More pairs of helical teeth overlap than a step side by side looks at.
    ManyPairs,
    /// The machine has more modes than a step side by side, or such that follow as at rest.
    ManyModes,
}

impl SteppedAlone {
    /// The reason of a machine around some meshes; none where it is stepped side by side with others.
    pub(crate) fn of<'m>(
        machine: &ModalMachine,
        mut meshes: impl Iterator<Item = &'m Mesh> + Clone,
    ) -> Option<Self> {
        if machine.lines.len() != 1 {
            Some(Self::SeveralMeshes)
        } else if !machine.spinning.is_empty() {
            Some(Self::GyroscopicMoments)
        } else if !machine.bearings.is_empty() {
            Some(Self::RollingBearings)
        } else if meshes.clone().any(|mesh| mesh.slices() > 1) {
            Some(Self::SlicedFace)
        } else if meshes.clone().any(|mesh| mesh.has_corners() && mesh.tilts()) {
            Some(Self::TiltedHelical)
        } else if meshes.clone().any(Mesh::wobbles) {
            Some(Self::Wobble)
        } else if meshes.clone().any(Mesh::has_friction) {
            Some(Self::Friction)
        } else if meshes.any(|mesh| mesh.springs() > MOST_PAIRS) {
            Some(Self::ManyPairs)
        } else if machine.modes() > MOST_MODES || !machine.residual.is_empty() {
            Some(Self::ManyModes)
        } else {
            None
        }
    }
}

impl fmt::Display for SteppedAlone {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PublishedModel => formatter.write_str("the published model has a solver of its own"),
            Self::SeveralMeshes => formatter.write_str("it has several meshes"),
            Self::GyroscopicMoments => formatter.write_str("gyroscopic moments shift its modes"),
            Self::RollingBearings => formatter.write_str("it has rolling bearings"),
            Self::SlicedFace => formatter.write_str("its face is cut into slices"),
            Self::TiltedHelical => formatter.write_str("its helical teeth bear unevenly along the face"),
            Self::Wobble => formatter.write_str("a helix slope turns with its wheel"),
            Self::Friction => formatter.write_str("its flanks rub"),
            Self::ManyPairs => write!(formatter, "more than {MOST_PAIRS} pairs of its teeth overlap"),
            Self::ManyModes => {
                write!(formatter, "it has more than {MOST_MODES} modes, or such that follow as at rest")
            }
        }
    }
}

impl Problem<'_> {
    /// Whether its teeth have corners of their own, so that the law is smooth: such go side by side with one another only.
    pub(super) fn has_corners(&self) -> bool {
        self.forcing.meshes().any(Mesh::has_corners)
    }

    /// Whether flanks rub.
    pub(super) fn has_friction(&self) -> bool {
        self.forcing.meshes().any(Mesh::has_friction)
    }

    /// Why the steps that are compiled for simulations side by side do not hold it; none where they do.
    pub(crate) fn stepped_alone(&self) -> Option<SteppedAlone> {
        SteppedAlone::of(&self.machine, self.forcing.meshes())
    }
}

/// Whether a mode moves as a machine can.
///
/// # Arguments
/// * `displacement` - (m √kg) its displacement, or its velocity times the time step
/// * `largest` - (m √kg) as of [`ModalMachine::largest_displacements`]
pub(super) fn is_bounded(displacement: f64, largest: f64) -> bool {
    displacement.abs() < largest
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
    if problem.stepped_alone().is_some() {
        return coupled::integrate(problem, None, instructions, recorder);
    }
    let [result] = of_size([problem], [None], OneByOne(instructions), vec![recorder]);
    result
}

/// Goes on with a simulation from a motion that was kept, of the same machine at any step.
///
/// # Arguments
/// * `problem` - its first simulated sample is that of the motion
/// * `state` - the motion
/// * `instructions` - vector instructions
/// * `recorder` - takes the outputs
///
/// # Errors
/// As [`integrate`].
pub(crate) fn resume(
    problem: Problem,
    state: &MotionState,
    instructions: InstructionSet,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    if problem.stepped_alone().is_some() {
        return coupled::integrate(problem, Some(state), instructions, recorder);
    }
    let [result] = of_size([problem], [Some(state)], OneByOne(instructions), vec![recorder]);
    result
}

/// Integrates simulations of one mesh each side by side; what comes out of each is the same as alone, bit by bit.
///
/// # Arguments
/// * `problems` - as many lanes
/// * `registers` - what the processor has
/// * `recorders` - take the outputs of the first lanes; the others repeat a simulation
///
/// # Errors
/// As [`integrate`], of each on its own.
pub(crate) fn integrate_side_by_side(
    problems: [Problem; LANES],
    registers: Registers,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; LANES] {
    let mut repeating: Vec<Repeating> =
        problems.iter().zip(recorders).map(|(problem, recorder)| Repeating::new(problem, recorder)).collect();
    let recorders = repeating.iter_mut().map(|recorder| recorder as &mut dyn Recorder).collect();
    of_size(problems, [None; LANES], registers, recorders)
}

fn of_size<const L: usize>(
    problems: [Problem; L],
    from: [Option<&MotionState>; L],
    instructions: impl Dispatch,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; L] {
    match Size::of(&problems) {
        Size::Flat => run::<L, 8, 8, 1, PAIRS, 0>(problems, from, instructions, recorders),
        Size::Tilting => {
            const N: usize = MOST_UNDRIVEN_MODES;
            run::<L, N, N, 2, PAIRS, 0>(problems, from, instructions, recorders)
        }
        Size::Turning => {
            run::<L, MOST_TURNING_MODES, MOVED_IN_PLANE, 1, PAIRS, 0>(problems, from, instructions, recorders)
        }
        Size::Steady => {
            const N: usize = MOST_STEADY_MODES;
            run::<L, N, N, 2, PAIRS, 0>(problems, from, instructions, recorders)
        }
        Size::General => {
            const N: usize = MOST_MODES;
            run::<L, N, N, 2, MOST_PAIRS, 0>(problems, from, instructions, recorders)
        }
        Size::Helical => {
            const N: usize = MOST_STEADY_MODES;
            run::<L, N, N, 1, USUAL_PAIRS, USUAL_PAIRS>(problems, from, instructions, recorders)
        }
        Size::GeneralHelical => {
            const N: usize = MOST_MODES;
            run::<L, N, N, 1, MOST_PAIRS, MOST_PAIRS>(problems, from, instructions, recorders)
        }
    }
}

/// Steps `L` simulations from their first sample to their last.
///
/// Time is divided into blocks of samples. For each block the forcing is tabulated first, then all steps are made, and then the outputs
/// are computed from the states of the block, so that each of the three loops is short and its numbers stay in the cache. A simulation
/// goes on from a motion that was kept where there is one.
fn run<const L: usize, const N: usize, const M: usize, const R: usize, const P: usize, const C: usize>(
    mut problems: [Problem; L],
    from: [Option<&MotionState>; L],
    instructions: impl Dispatch,
    recorders: Vec<&mut dyn Recorder>,
) -> [Result<(), Diverged>; L] {
    let prepared: [Prepared; L] = problems.each_ref().map(|problem| Prepared::new(problem, 1.0));
    let coefficients = Coefficients::<L, N, M, R>::new(&prepared);
    let law = law_lanes(&prepared, &problems);
    let start = Lanes::from_fn(|l| problems[l].time.first_simulated_sample as f64);
    let outputs = prepared.iter().map(|of| of.outputs.len()).max().unwrap_or(0);
    let terms: Vec<OutputTerms<L>> = (0..outputs)
        .map(|output| OutputTerms::new::<N, R>(prepared.each_ref().map(|of| of.outputs.get(output)), start))
        .collect();
    let mut out = LaneOutputs::new(problems.each_ref(), outputs, BLOCK, recorders);
    let mut forcing = LaneForcing::<L, P, C>::new(problems.each_ref());
    forcing.fill(&mut problems, 1);
    let first = from_fn(|l| {
        let external = forcing.external[0].map(|external| external.0[l]);
        let mut springs: Vec<SpringSamples> = problems[l].forcing.meshes().map(SpringSamples::new).collect();
        springs.iter_mut().zip(&forcing.blocks[l].meshes).for_each(|(springs, block)| springs.line_up(block));
        match from[l] {
            Some(state) => prepared[l].resumed_state(state, &forcing.blocks[l], external),
            None => prepared[l].first_state(&problems[l].machine, &forcing.blocks[l], &springs, external),
        }
    });
    let mut state: State<L, N, R> = coefficients.first_state(&first);
    let mut history = History::<L, N, R>::new();
    let mut done = 0;
    while done < out.most_steps {
        let steps = BLOCK.min(out.most_steps - done);
        out.keep_states(done, |l, sample| {
            let of = |of: &[Lanes<L>]| of.iter().map(|lanes| lanes.0[l]).collect::<Vec<f64>>();
            let numbers =
                [&state.displacement, &state.velocity, &state.acceleration].map(|of_modes| of(of_modes));
            prepared[l].motion_state(sample, numbers, of(&state.force))
        });
        forcing.fill(&mut problems, steps);
        let recorded = out.is_recorded(done + steps);
        instructions.run(StepBlock {
            coefficients: &coefficients,
            law: &law,
            state: &mut state,
            pairs: &forcing.pairs[..steps],
            corners: &forcing.corners,
            external: forcing.is_driven.then_some(&forcing.external[..steps]),
            turning: &forcing.turning,
            history: recorded.then_some(&mut history),
        });
        if recorded {
            for (terms, values) in terms.iter().zip(&mut out.values) {
                terms.evaluate(instructions, &history, done, &mut values[..steps]);
            }
        }
        out.record(done, steps, |l| coefficients.is_sound(&state, &prepared[l].largest_displacement, l));
        if !out.goes_on() {
            break;
        }
        done += steps;
    }
    out.results
}

/// What a force brings about that a simulation has not got.
const NO_FORCE: &[f64] = &[0.0; BLOCK];

/// Forcing of one block of samples of `L` simulations, side by side.
struct LaneForcing<const L: usize, const P: usize, const C: usize> {
    /// The pairs of the one mesh.
    pairs: Vec<PairsSample<L, P, C>>,
    /// The laws of the corners of the mesh in each lane: of each class, at the start of the path and at its end.
    laws: [Vec<CornerLaw>; L],
    /// The laws of the pairs' corners, each up to a sample: until a pair of another class comes to a place.
    corners: Vec<(usize, CornerLanes<L, C>)>,
    /// Whether any motor or brake is not steady.
    is_driven: bool,
    /// Motor lead, torque deviation and speed deviation; 0 while motor and brake are steady.
    external: Vec<[Lanes<L>; EXTERNALS]>,
    /// Each force that turns with a shaft; 0 where a simulation has fewer than others.
    turning: Vec<Vec<TurningSample<L>>>,
    blocks: [ForcingBlock; L],
}

impl<const L: usize, const P: usize, const C: usize> LaneForcing<L, P, C> {
    fn new(problems: [&Problem; L]) -> Self {
        let turning_forces = problems.map(|problem| problem.machine.turning_forces.len());
        Self {
            pairs: vec![PairsSample::NONE; BLOCK],
            laws: problems.map(|problem| problem.forcing.meshes().flat_map(Mesh::corner_laws).collect()),
            corners: Vec::new(),
            is_driven: problems.iter().any(|problem| !problem.is_steady),
            external: vec![[Lanes::splat(0.0); EXTERNALS]; BLOCK],
            turning: vec![
                vec![TurningSample([Lanes::splat(0.0); 2]); BLOCK];
                turning_forces.into_iter().max().unwrap_or(0)
            ],
            blocks: from_fn(|_| ForcingBlock::default()),
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
        self.line_corners_up(samples);
        for (force, turning) in self.turning.iter_mut().enumerate() {
            for side in 0..2 {
                let parts = self.blocks.each_ref().map(|block| {
                    block.external.turning.get(force).map_or(NO_FORCE, |of| of[side].as_slice())
                });
                line_up(&mut turning[..samples], parts, |sample| &mut sample.0[side]);
            }
        }
    }
}

impl<const L: usize, const P: usize, const C: usize> LaneForcing<L, P, C> {
    /// Lines the laws of the corners up, anew from each sample on at which a pair of another class comes to a place.
    fn line_corners_up(&mut self, samples: usize) {
        self.corners.clear();
        let blocks = self.blocks.each_ref().map(|block| &block.meshes[0]);
        let class = |l: usize, place: usize, sample: usize| {
            if place < blocks[l].classes.len() { blocks[l].class_at(place, sample) } else { 0 }
        };
        let spans = blocks.iter().flat_map(|block| block.classes.iter().take(C));
        let mut starts: Vec<usize> = spans.flatten().map(|(from, _)| *from).chain([0]).collect();
        starts.sort_unstable();
        starts.dedup();
        let differs = |at: &usize| {
            let places = (0..L).flat_map(|l| (0..C).map(move |place| (l, place)));
            *at == 0 || places.into_iter().any(|(l, place)| class(l, place, *at) != class(l, place, at - 1))
        };
        let starts: Vec<usize> = starts.into_iter().filter(differs).collect();
        for (n, start) in starts.iter().enumerate() {
            let law = |l: usize, place: usize, end: usize| {
                self.laws[l].get(2 * class(l, place, *start) + end).copied().unwrap_or(CornerLaw::NONE)
            };
            let lanes = from_fn(|place| from_fn(|end| CornerLane::new(from_fn(|l| law(l, place, end)))));
            self.corners.push((starts.get(n + 1).copied().unwrap_or(samples), lanes));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Unbalance;
    use crate::scenario::{Fault, GearPair, MissingTooth, Scenario};
    use crate::sensor::ChannelKind;
    use crate::simulate::stages;

    /// All outputs.
    #[derive(Default)]
    struct All(Vec<Vec<f64>>);

    impl Recorder for All {
        fn record(&mut self, block: &Block) {
            self.0.resize_with(block.outputs().len(), Vec::new);
            self.0.iter_mut().zip(block.outputs()).for_each(|(all, block)| all.extend_from_slice(block));
        }
    }

    /// Checks that the steps for simulations side by side and the steps for any machine make the same of a scenario.
    fn check_both_steppers(scenario: &Scenario, expected: Size, name: &str) {
        let stages = stages(scenario).unwrap();
        let outputs = ChannelKind::ALL.map(ChannelKind::output);
        let problem = || stages.lane(&outputs).unwrap();
        assert_eq!(Size::of(&[problem()]), expected, "{name}");
        let instructions = InstructionSet::in_use();
        let [mut side_by_side, mut alone] = [All::default(), All::default()];
        let [result] = of_size([problem()], [None], OneByOne(instructions), vec![&mut side_by_side]);
        result.unwrap();
        coupled::integrate(problem(), None, instructions, &mut alone).unwrap();
        assert_eq!((side_by_side.0.len(), alone.0.len()), (outputs.len(), outputs.len()), "{name}");
        for (number, (side_by_side, alone)) in side_by_side.0.iter().zip(&alone.0).enumerate() {
            let largest =
                |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most, x: f64| x.abs().max(most));
            let most = largest(&mut alone.iter().copied());
            let difference = largest(&mut side_by_side.iter().zip(alone).map(|(a, b)| a - b));
            assert_eq!(side_by_side.len(), alone.len(), "{name}, output {number}");
            assert!(side_by_side.iter().all(|value| value.is_finite()), "{name}, output {number}");
            // Spur wheels do not move along their shafts.
            assert!(most > 0.0 || number == 2, "{name}, output {number}");
            assert!(difference <= 1e-12 * most, "{name}, output {number}: {difference:e} of {most}");
        }
    }

    fn pair(helix_angle_deg: f64, face_width_mm: f64) -> Scenario {
        let mut scenario = Scenario::new(GearPair { face_width_mm, ..GearPair::example() });
        scenario.meshes[0].helix_angle_deg = helix_angle_deg;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
        scenario.solver.sampling_rate_hz = 5e4;
        // Four revolutions of the pinion are long enough for any difference to grow, and soon stepped without optimisation.
        scenario.solver.duration_s = Some(0.1);
        scenario
    }

    fn unbalanced(mut scenario: Scenario) -> Scenario {
        scenario.wheels[0].unbalance = Unbalance { g_mm: 20.0, angle_deg: 30.0 };
        scenario.wheels[1].unbalance = Unbalance { g_mm: 50.0, angle_deg: -100.0 };
        scenario
    }

    #[test]
    fn unbalance_moves_both_steppers_alike() {
        let one = {
            let mut scenario = pair(0.0, 15.0);
            scenario.wheels[1].unbalance.g_mm = 1e-9;
            scenario
        };
        check_both_steppers(&one, Size::Turning, "a trace of unbalance");
        check_both_steppers(&unbalanced(pair(0.0, 15.0)), Size::Turning, "two wheels");
        let mut tilting = unbalanced(pair(0.0, 15.0));
        tilting.meshes[0].misalignment_um = 6.0;
        check_both_steppers(&tilting, Size::Steady, "tilting wheels");
        let mut varying = unbalanced(pair(0.0, 15.0));
        varying.operation.speed_fluctuation_hz = 0.3;
        check_both_steppers(&varying, Size::General, "a speed that varies");
    }

    /// By the whole face, by an end of it and by the other, with teeth that part; at constant and at varying speed.
    #[test]
    fn tilting_wheels_move_both_steppers_alike() {
        for misalignment_um in [2.0, -12.0, 40.0] {
            let mut tilting = pair(0.0, 15.0);
            tilting.meshes[0].misalignment_um = misalignment_um;
            tilting.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
            check_both_steppers(&tilting, Size::Tilting, "tilting wheels");
            tilting.operation.speed_fluctuation_hz = 0.3;
            check_both_steppers(&tilting, Size::General, "tilting wheels at a speed that varies");
        }
    }

    #[test]
    fn helical_teeth_move_both_steppers_alike() {
        check_both_steppers(&pair(5.0, 15.0), Size::Helical, "two pairs at once");
        check_both_steppers(&pair(20.0, 30.0), Size::Helical, "three pairs at once");
        let mut fine = pair(25.0, 30.0);
        fine.meshes[0].module_mm /= 2.0;
        fine.wheels.iter_mut().for_each(|wheel| wheel.teeth *= 2);
        check_both_steppers(&fine, Size::GeneralHelical, "more pairs at once");
        check_both_steppers(&unbalanced(pair(20.0, 15.0)), Size::GeneralHelical, "unbalanced wheels");
        let mut missing = pair(20.0, 15.0);
        missing.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
        check_both_steppers(&missing, Size::Helical, "a missing tooth");
        let mut varying = pair(20.0, 15.0);
        varying.operation.speed_fluctuation_hz = 0.3;
        check_both_steppers(&varying, Size::GeneralHelical, "a speed that varies");
    }
}
