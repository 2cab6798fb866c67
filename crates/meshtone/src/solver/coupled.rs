//! Steps of a machine with several meshes or rolling bearings: one unknown a mesh or two, two a bearing, all coupled through the machine.
//!
//! In the notation of [`super::step`], the deflections with their damping's lead, `D_a` of mesh a, obey `D + G f(D) = D₀` with
//! `G_ab = Σ_n B_na (β_n + ½ τ_a/Δt) Δt²E_n B_nb`, and `f_a` a rising, piecewise linear function of `D_a` alone. The two unknowns of a
//! bearing are its stretch along x and y, and their forces depend on both: what the load of its elements differs from that of the linear
//! spring that the machine has in its place. Their slopes may be negative, but `1 + G K` is as regular as if the machine had no such spring.
//!
//! The second unknown of a mesh is the slope of its deflection along the face, as the deflection T that it adds at the face's end. Force and moment are
//! the derivatives of a convex function of both, so that their slopes are symmetric and never negative, and the solution stays unique.
//!
//! Friction of mesh b pushes across its line of action by `Q_b = Σ μ_n f_n` and turns the wheels by the moment `R_b = Σ μ_n d_n f_n`, where μ_n with
//! its sign and the arm d_n of each pair follow from where it is on its path. Both are functions of the same `D_b`, piecewise linear with
//! the same places, so that they join the equations: `D + G f(D) − G_Q Q(D) − G_R R(D) = D₀`. What a step makes of Q along a line of action is
//! at most μ times a part of what it makes of f, so that the slopes of the sum have the sign of those of `G f`, and the solution stays unique.
//!
//! Newton's method takes the slopes at the last iterate, that is the springs that touch, and solves the linear equations that these make.
//! It ends when the same pairs touch at the new iterate, which is exact, the deflections of meshes with corners have moved by no more than a
//! ten-millionth, and the bearings by no more than [`BEARING_MOVES_M`]. In
//! theory it can go round in a circle; after [`MOST_PLAIN_ITERATIONS`] each iterate goes only as far towards Newton's as makes the residual
//! smaller.

use std::array::from_fn;
use std::ops::Range;

use super::integrate::{Block, Diverged, MotionState, Problem, Recorder, StepCounts, is_bounded};
use super::outputs::{EXTERNALS, OutputWeights, dot};
use super::prepare::{FirstState, Prepared};
use crate::bearing::{BearingLoad, RollingBearing};
use crate::mesh::{ForcingBlock, MeshLaw, SpringSamples, TANGENT_M, TANGENT_PART, TiltedLoad};
use crate::simd::{Dispatch, InstructionSet, Instructions, Lanes, Task};

/// Most meshes that one machine has.
pub(crate) const MOST_MESHES: usize = 16;

/// Most rolling bearings that one machine has.
pub(crate) const MOST_ROLLING_BEARINGS: usize = 12;

/// Most unknowns of a step.
const MOST_UNKNOWNS: usize = 2 * MOST_MESHES + 2 * MOST_ROLLING_BEARINGS;

/// Samples that are forced and handed out at a time.
const BLOCK: usize = 256;

/// (-) Change of the motor's speed from which on gyroscopic moments are those of another speed.
const SAME_SPEED: f64 = 2e-3;

/// Modes that are stepped side by side.
const SIDE_BY_SIDE: usize = 8;

/// Numbers of some modes side by side, in a cache line of their own; 0 behind the last mode.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Lot(Lanes<SIDE_BY_SIDE>);

/// The states of the modes of a lot: predicted displacements, predicted velocities times Δt, and accelerations times Δt².
#[derive(Clone, Copy)]
#[repr(align(64))]
struct LotState([Lanes<SIDE_BY_SIDE>; 3]);

/// What does not change from step to step of the modes of a lot.
#[repr(align(64))]
struct LotConstants {
    restore: Lanes<SIDE_BY_SIDE>,
    damp: Lanes<SIDE_BY_SIDE>,
    external_push: [Lanes<SIDE_BY_SIDE>; EXTERNALS],
}

/// Columns whose deflections are summed in one pass over the modes.
const AT_ONCE: usize = 2;

/// For each of some columns two numbers of a lot: what a predicted displacement deflects, and a predicted velocity.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct LotColumns([[Lanes<SIDE_BY_SIDE>; 2]; AT_ONCE]);

impl LotColumns {
    const ZERO: Self = Self([[Lanes([0.0; SIDE_BY_SIDE]); 2]; AT_ONCE]);

    /// Adds what a lot deflects in the columns.
    ///
    /// # Arguments
    /// * `columns` - of the lot
    /// * `state` - its predicted displacement and velocity
    #[inline(always)]
    fn add<I: Instructions>(&mut self, simd: I, columns: &Self, state: [Lanes<SIDE_BY_SIDE>; 2]) {
        for (sums, columns) in self.0.iter_mut().zip(&columns.0) {
            for n in 0..2 {
                sums[n] = columns[n].mul_add(simd, state[n], sums[n]);
            }
        }
    }
}

/// One of the numbers of a [`LotState`] at the samples of a tile.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct LotTile([Lanes<SIDE_BY_SIDE>; TILE]);

/// A number for each mesh, then two for each bearing, and then one for each mesh whose tilt is an unknown.
type OfUnknowns = [f64; MOST_UNKNOWNS];
/// A number for each pair of unknowns.
type Matrix = [OfUnknowns; MOST_UNKNOWNS];

/// The order of the modes: those that the same outputs see lie side by side, so that of an output with few modes few have to be added.
struct Order(Vec<usize>);

impl Order {
    fn new(prepared: &Prepared) -> Self {
        let sees = |output: &OutputWeights, n: usize| {
            let lists = [&output.displacement, &output.velocity, &output.acceleration];
            lists.into_iter().any(|list| list.get(n).is_some_and(|weight| *weight != 0.0))
        };
        let seen_by =
            |n: &usize| -> Vec<bool> { prepared.outputs.iter().map(|output| sees(output, *n)).collect() };
        let mut order: Vec<usize> = (0..prepared.restore.len()).collect();
        order.sort_by_cached_key(seen_by);
        Self(order)
    }

    /// Numbers of the modes, lot by lot.
    fn lots(&self, values: &[f64]) -> Vec<Lot> {
        let of_lot =
            |modes: &[usize]| Lot(Lanes::from_fn(|lane| modes.get(lane).map_or(0.0, |&mode| values[mode])));
        self.0.chunks(SIDE_BY_SIDE).map(of_lot).collect()
    }

    /// A number of each mode, in the modes' own order.
    ///
    /// # Arguments
    /// * `lots` - the states
    /// * `number` - which number of a [`LotState`]
    fn modes(&self, lots: &[LotState], number: usize) -> Vec<f64> {
        let mut values = vec![0.0; self.0.len()];
        for (place, &mode) in self.0.iter().enumerate() {
            values[mode] = lots[place / SIDE_BY_SIDE].0[number].0[place % SIDE_BY_SIDE];
        }
        values
    }

    /// The same from the first lot that is not 0 to the last; an empty list stands for zeros.
    fn weights(&self, values: &[f64]) -> Weights {
        if values.is_empty() {
            return Weights { first: 0, lots: Vec::new() };
        }
        let mut lots = self.lots(values);
        let counts = |lot: &Lot| lot.0.0 != [0.0; SIDE_BY_SIDE];
        lots.truncate(lots.iter().rposition(counts).map_or(0, |last| last + 1));
        let first = lots.iter().position(counts).unwrap_or(0);
        Weights { first, lots: lots.split_off(first) }
    }
}

/// Weights of modes in an output, without the zeros before the first lot and after the last.
struct Weights {
    /// Number of the first lot.
    first: usize,
    lots: Vec<Lot>,
}

/// The states of one block of samples.
struct History {
    /// Each number of a state: which lots are kept, and what they are, tile by tile.
    states: [(Range<usize>, Vec<LotTile>); 3],
    /// (N) The forces in all columns, sample by sample.
    force: Vec<f64>,
    external: Vec<[f64; EXTERNALS]>,
}

impl History {
    /// Keeps what some outputs see.
    fn new(outputs: &[OutputOfModes]) -> Self {
        let kept = |number: usize| {
            let seen =
                || outputs.iter().map(|output| &output.modes[number]).filter(|seen| !seen.lots.is_empty());
            let end = seen().map(|seen| seen.first + seen.lots.len()).max().unwrap_or(0);
            let lots = seen().map(|seen| seen.first).min().unwrap_or(0)..end;
            let tiles = vec![LotTile([Lanes::splat(0.0); TILE]); lots.len() * BLOCK / TILE];
            (lots, tiles)
        };
        Self { states: [kept(0), kept(1), kept(2)], force: Vec::new(), external: Vec::new() }
    }

    /// Takes the next state, with displacements and velocities as they are at the step's end, where a step predicts them without its forces.
    #[inline(always)]
    fn push<I: Instructions>(&mut self, simd: I, state: &State, betas: &[Lot]) {
        let (tile, k) = (self.external.len() / TILE, self.external.len() % TILE);
        let at_end = |number: usize, lot: usize| {
            let LotState([displacement, velocity, acceleration]) = &state.lots[lot];
            match number {
                0 => betas[lot].0.mul_add(simd, *acceleration, *displacement),
                1 => Lanes::splat(0.5).mul_add(simd, *acceleration, *velocity),
                _ => *acceleration,
            }
        };
        for (number, (kept, tiles)) in self.states.iter_mut().enumerate() {
            for (tile, lot) in tiles[tile * kept.len()..].iter_mut().zip(kept.clone()) {
                tile.0[k] = at_end(number, lot);
            }
        }
        self.force.extend_from_slice(&state.force);
        self.external.push(state.external);
    }

    fn clear(&mut self) {
        self.force.clear();
        self.external.clear();
    }
}

/// Integrates a simulation of any number of meshes and rolling bearings, up to [`MOST_MESHES`] and [`MOST_ROLLING_BEARINGS`].
///
/// # Arguments
/// * `problem` - the simulation
/// * `from` - the motion that it goes on from; none where it starts at rest
/// * `instructions` - vector instructions
/// * `recorder` - takes the outputs
///
/// # Errors
/// Those of [`super::integrate()`].
pub(super) fn integrate(
    mut problem: Problem,
    from: Option<&MotionState>,
    instructions: InstructionSet,
    recorder: &mut dyn Recorder,
) -> Result<(), Diverged> {
    let mut speed = 1.0;
    let prepared = Prepared::new(&problem, speed);
    let order = Order::new(&prepared);
    let mut constants = Constants::new(prepared, &order);
    let (start, end) = (problem.time.first_simulated_sample, problem.time.samples);
    let mut block = ForcingBlock::default();
    problem.forcing.next_block(1, &mut block);
    let mut springs: Vec<SpringSamples> = problem.forcing.meshes().map(SpringSamples::new).collect();
    let first_external = external(&block, 0);
    springs.iter_mut().zip(&block.meshes).for_each(|(springs, block)| springs.line_up(block));
    let first = match from {
        Some(state) => constants.prepared.resumed_state(state, &block, first_external),
        None => constants.prepared.first_state(&problem.machine, &block, &springs, first_external),
    };
    let mut state = State::new(first, first_external, &constants.prepared, &order);
    let largest = order.lots(&constants.prepared.largest_displacement);
    let mut history = History::new(&constants.outputs);
    let mut outputs: Vec<Vec<f64>> = vec![Vec::with_capacity(BLOCK); constants.outputs.len()];
    let mut sample = start;
    while sample < end && recorder.goes_on() {
        let steps = BLOCK.min(end - sample);
        if recorder.wants_state(sample) {
            let numbers = [0, 1, 2].map(|number| order.modes(&state.lots, number));
            recorder.keep_state(constants.prepared.motion_state(sample, numbers, state.force.clone()));
        }
        problem.forcing.next_block(steps, &mut block);
        springs.iter_mut().zip(&block.meshes).for_each(|(springs, block)| springs.line_up(block));
        outputs.iter_mut().for_each(Vec::clear);
        history.clear();
        let now = mean_speed(&block, problem.machine.rotation_rad_per_s);
        if !problem.machine.spinning.is_empty() && (now / speed - 1.0).abs() > SAME_SPEED {
            speed = now;
            constants = Constants::new(Prepared::new(&problem, speed), &order);
            state.equations = Equations::new(&constants.prepared);
        }
        let first_recorded = problem.first_sample.max(sample);
        instructions.run(Steps {
            constants: &constants,
            state: &mut state,
            springs: &springs,
            block: &block,
            is_steady: problem.is_steady,
            samples: sample..sample + steps,
            first_recorded,
            history: &mut history,
        });
        if first_recorded < sample + steps {
            instructions.run(Outputs {
                constants: &constants,
                history: &mut history,
                first_recorded,
                outputs: &mut outputs,
            });
        }
        let within = |(lot, largest): (&LotState, &Lot)| {
            let lanes = lot.0[..2].iter().flat_map(|lanes| lanes.0.iter().zip(&largest.0.0));
            // Lanes behind the last mode are 0, and so is their bound.
            lanes.into_iter().all(|(mode, largest)| *largest == 0.0 || is_bounded(*mode, *largest))
        };
        if !state.lots.iter().zip(&largest).all(within) {
            return Err(Diverged { sample: sample + steps });
        }
        sample += steps;
        if first_recorded < sample {
            recorder.record(&Block::new(first_recorded, &outputs));
        }
    }
    recorder.count(state.counts);
    Ok(())
}

/// (-) The motor's speed over the nominal one, in the mean of a block.
fn mean_speed(block: &ForcingBlock, nominal_rad_per_s: f64) -> f64 {
    let deviations = &block.external.speed_deviation_rad_per_s;
    1.0 + deviations.iter().sum::<f64>() / (deviations.len().max(1) as f64 * nominal_rad_per_s)
}

/// Motor lead, torque deviation and speed deviation at one sample of a block; 0 while motor and brake are steady.
fn external(block: &ForcingBlock, k: usize) -> [f64; EXTERNALS] {
    block.external.parts().map(|part| part.get(k).copied().unwrap_or(0.0))
}

/// What does not change from step to step.
struct Constants {
    prepared: Prepared,
    lots: Vec<LotConstants>,
    /// `Δt² q̈` of each lot per force in each column.
    pushes: Vec<Lot>,
    /// The columns in which something is deflected, which those of friction are not, and for as many as are summed at once their lots.
    deflected: Vec<usize>,
    columns: Vec<Vec<LotColumns>>,
    turning: Vec<[Vec<Lot>; 2]>,
    /// (-) Of each lot, what of `Δt² q̈` a displacement has at a step's end beside what was predicted.
    betas: Vec<Lot>,
    outputs: Vec<OutputOfModes>,
}

/// An output: the weights of each number of a [`LotState`] at a step's end, and those of the forces that it sees, with their columns.
struct OutputOfModes {
    modes: [Weights; 3],
    forces: Vec<(usize, f64)>,
}

impl Constants {
    fn new(prepared: Prepared, order: &Order) -> Self {
        let pushes: Vec<Vec<Lot>> = prepared.columns.iter().map(|column| order.lots(&column.push)).collect();
        let is_deflected =
            |number: &usize| *number < prepared.first_across || *number >= prepared.first_spinning;
        let deflected: Vec<usize> = (0..prepared.columns.len()).filter(is_deflected).collect();
        let at_once = |numbers: &[usize]| {
            let mut lots = vec![LotColumns::ZERO; pushes[0].len()];
            for (place, column) in numbers.iter().map(|number| &prepared.columns[*number]).enumerate() {
                for (n, values) in [&column.of_displacement, &column.of_velocity].into_iter().enumerate() {
                    lots.iter_mut().zip(order.lots(values)).for_each(|(lot, own)| lot.0[place][n] = own.0);
                }
            }
            lots
        };
        let betas = prepared.betas();
        // Displacements and velocities at a step's end have their part of the accelerations already: of an output of these nothing is left.
        let beside = |of: &OutputWeights| -> Vec<f64> {
            let at = |list: &[f64], n: usize| list.get(n).copied().unwrap_or(0.0);
            let of_mode = |(n, acceleration): (usize, &f64)| {
                acceleration - betas[n] * at(&of.displacement, n) - 0.5 * at(&of.velocity, n)
            };
            of.acceleration.iter().enumerate().map(of_mode).collect()
        };
        let output = |of: &OutputWeights| OutputOfModes {
            modes: [&of.displacement, &of.velocity, &beside(of)].map(|list| order.weights(list)),
            forces: of.force.iter().copied().enumerate().filter(|(_, weight)| *weight != 0.0).collect(),
        };
        let (restore, damp) = (order.lots(&prepared.restore), order.lots(&prepared.damp));
        let external_push = prepared.external_push.each_ref().map(|push| order.lots(push));
        let lot = |n: usize| LotConstants {
            restore: restore[n].0,
            damp: damp[n].0,
            external_push: external_push.each_ref().map(|push| push[n].0),
        };
        Self {
            lots: (0..restore.len()).map(lot).collect(),
            pushes: (0..restore.len()).flat_map(|n| pushes.iter().map(move |lots| lots[n])).collect(),
            columns: deflected.chunks(AT_ONCE).map(at_once).collect(),
            deflected,
            turning: prepared
                .turning_push
                .iter()
                .map(|of| of.each_ref().map(|push| order.lots(push)))
                .collect(),
            outputs: prepared.outputs.iter().map(output).collect(),
            betas: order.lots(&betas),
            prepared,
        }
    }
}

/// The state of the modes, and where the next step begins its search.
struct State {
    lots: Vec<LotState>,
    /// (N) Force in each column, relative to the static one.
    force: Vec<f64>,
    external: [f64; EXTERNALS],
    /// (m) D of each unknown.
    deflection: OfUnknowns,
    /// (m) What the forces took from the free deflection of each bearing's unknown, two steps and one step earlier.
    pressed: [[f64; 2]; MOST_UNKNOWNS],
    search: Search,
    /// The equations of the last step, without the free deflections.
    equations: Equations,
    /// (m) Deflection in each column with its damping's lead, without the step's own force.
    free: Vec<f64>,
    counts: StepCounts,
}

impl State {
    fn new(first: FirstState, external: [f64; EXTERNALS], prepared: &Prepared, order: &Order) -> Self {
        let FirstState { displacement, velocity, acceleration, force } = first;
        let numbers = [displacement, velocity, acceleration].map(|values| order.lots(&values));
        Self {
            lots: (0..numbers[0].len()).map(|n| LotState(numbers.each_ref().map(|lots| lots[n].0))).collect(),
            free: vec![0.0; force.len()],
            force,
            external,
            deflection: [0.0; MOST_UNKNOWNS],
            pressed: [[0.0; 2]; MOST_UNKNOWNS],
            search: Search::new(),
            equations: Equations::new(prepared),
            counts: StepCounts::default(),
        }
    }
}

/// The sum of numbers side by side.
#[inline(always)]
fn total(lanes: Lanes<SIDE_BY_SIDE>) -> f64 {
    let [a, b, c, d, e, f, g, h] = lanes.0;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

/// The steps of one block of samples: all that is compiled for each instruction set.
struct Steps<'a> {
    constants: &'a Constants,
    state: &'a mut State,
    /// Of each mesh, at the samples after the state's.
    springs: &'a [SpringSamples],
    block: &'a ForcingBlock,
    is_steady: bool,
    samples: Range<usize>,
    first_recorded: usize,
    history: &'a mut History,
}

impl Task for Steps<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) {
        for (k, sample) in self.samples.clone().enumerate() {
            if sample >= self.first_recorded {
                self.history.push(simd, self.state, &self.constants.betas);
            }
            let external = (!self.is_steady).then(|| external(self.block, k));
            let sample = ContactSample { springs: self.springs, block: self.block, k };
            self.state.step(simd, self.constants, &sample, external);
        }
    }
}

/// What is read off the states of one block.
struct Outputs<'a> {
    constants: &'a Constants,
    history: &'a mut History,
    first_recorded: usize,
    outputs: &'a mut [Vec<f64>],
}

/// Samples whose outputs are summed in registers; a part of [`BLOCK`].
const TILE: usize = 4;

impl Task for Outputs<'_> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(self, simd: I) {
        let History { states, force, external } = self.history;
        let columns = self.constants.prepared.columns.len();
        let outputs = self.constants.outputs.iter().zip(&self.constants.prepared.outputs);
        for (values, (output, others)) in self.outputs.iter_mut().zip(outputs) {
            for (tile, external) in external.chunks(TILE).enumerate() {
                let mut sums = [Lanes::splat(0.0); TILE];
                for (weights, (kept, tiles)) in output.modes.iter().zip(states.iter()) {
                    let first = tile * kept.len() + weights.first.saturating_sub(kept.start);
                    for (weight, lot) in weights.lots.iter().zip(&tiles[first..]) {
                        for k in 0..TILE {
                            sums[k] = weight.0.mul_add(simd, lot.0[k], sums[k]);
                        }
                    }
                }
                for (k, external) in external.iter().enumerate() {
                    let sample = tile * TILE + k;
                    let force = &force[sample * columns..];
                    let forces: f64 =
                        output.forces.iter().map(|(column, weight)| weight * force[*column]).sum();
                    let steady = others.constant + others.per_sample * (self.first_recorded + sample) as f64;
                    values.push(steady + forces + dot(&others.external, external) + total(sums[k]));
                }
            }
        }
    }
}

impl State {
    /// Moves on by one sample: first without the new forces of the meshes and bearings, then by these.
    #[inline(always)]
    fn step<I: Instructions>(
        &mut self,
        simd: I,
        constants: &Constants,
        sample: &ContactSample,
        external: Option<[f64; EXTERNALS]>,
    ) {
        let mut sums = LotColumns::ZERO;
        for ((LotState([displacement, velocity, acceleration]), constants), columns) in
            self.lots.iter_mut().zip(&constants.lots).zip(&constants.columns[0])
        {
            *velocity = velocity.add(simd, *acceleration);
            *displacement = displacement.add(simd, *velocity);
            *acceleration =
                constants.restore.mul_add(simd, *displacement, constants.damp.mul(simd, *velocity));
            for (push, external) in constants.external_push.iter().zip(external.into_iter().flatten()) {
                *acceleration = push.mul_add(simd, Lanes::splat(external), *acceleration);
            }
            sums.add(simd, columns, [*displacement, *velocity]);
        }
        for ([cos, sin], values) in constants.turning.iter().zip(&sample.block.external.turning) {
            let [of_cos, of_sin] = values.each_ref().map(|values| Lanes::splat(values[sample.k]));
            for ((LotState([.., acceleration]), cos), sin) in self.lots.iter_mut().zip(cos).zip(sin) {
                *acceleration = cos.0.mul_add(simd, of_cos, sin.0.mul_add(simd, of_sin, *acceleration));
            }
        }
        self.external = external.unwrap_or_default();
        let prepared = &constants.prepared;
        for (part, numbers) in constants.deflected.chunks(AT_ONCE).enumerate() {
            if part > 0 {
                sums = LotColumns::ZERO;
                for (LotState([displacement, velocity, _]), columns) in
                    self.lots.iter().zip(&constants.columns[part])
                {
                    sums.add(simd, columns, [*displacement, *velocity]);
                }
            }
            for (&number, [of_displacement, of_velocity]) in numbers.iter().zip(sums.0) {
                let (free, column) = (&mut self.free[number], &prepared.columns[number]);
                let sum = of_displacement.add(simd, of_velocity);
                let turned = column.of_turning.iter().zip(&sample.block.external.turning);
                let turned: f64 =
                    turned.map(|(of, [cos, sin])| of[0] * cos[sample.k] + of[1] * sin[sample.k]).sum();
                *free =
                    column.static_deflection + dot(&column.of_external, &self.external) + turned + total(sum);
            }
        }
        constants.contact_forces(simd, sample, self);
        let pushes = constants.pushes.chunks_exact(self.force.len());
        for (LotState([.., acceleration]), pushes) in self.lots.iter_mut().zip(pushes) {
            for (push, force) in pushes.iter().zip(&self.force) {
                *acceleration = push.0.mul_add(simd, Lanes::splat(*force), *acceleration);
            }
        }
    }
}

impl Constants {
    /// Sets (N) the forces of the meshes and bearings on the modes at the end of a step, in each column, relative to the static ones.
    ///
    /// # Arguments
    /// * `sample` - what touches at the step's end
    /// * `state` - has the free deflections, and the deflection of each mesh at the step's start; those of all unknowns are set to those at its end
    #[inline(always)]
    fn contact_forces<I: Instructions>(&self, simd: I, sample: &ContactSample, state: &mut State) {
        let prepared = &self.prepared;
        let equations = &state.equations;
        let mut free = equations.of_static;
        free.iter_mut().zip(&state.free).take(equations.count).for_each(|(free, column)| *free += column);
        let law = ContactLaw { laws: &prepared.laws, bearings: &prepared.bearings, sample };
        for unknown in equations.of_bearings() {
            // The search begins at D₀ − G f with G f, a small part of D, as of the last two steps.
            let [before, last] = state.pressed[unknown];
            state.deflection[unknown] = free[unknown] - (2.0 * last - before);
        }
        let Found { loads, iterations, searched } =
            equations.solve(simd, &law, &free, &mut state.deflection, &mut state.search);
        for unknown in equations.of_bearings() {
            let [_, last] = state.pressed[unknown];
            state.pressed[unknown] = [last, free[unknown] - state.deflection[unknown]];
        }
        let Loads { forces, friction, .. } = &state.search.loads[loads];
        state.counts.steps += 1;
        state.counts.iterations += iterations;
        state.counts.most_iterations = state.counts.most_iterations.max(iterations);
        state.counts.searched += searched;
        // The static forces of the bearings are those of their linear springs, and those of the meshes act midway along their faces.
        let static_forces_n = prepared.static_force_n.iter().copied().chain(std::iter::repeat(0.0));
        for ((state, force), static_force_n) in
            state.force.iter_mut().zip(forces).zip(static_forces_n).take(equations.count)
        {
            *state = static_force_n - force;
        }
        let (forces, moments) = state.force.split_at_mut(prepared.first_spinning);
        for (across, friction) in forces[prepared.first_across..].chunks_exact_mut(2).zip(friction) {
            across.iter_mut().zip(friction).for_each(|(force, [friction, ..])| *force = *friction);
        }
        for (number, moment) in (prepared.first_spinning..).zip(moments) {
            *moment = state.free[number] + dot(&prepared.compliance[number], forces);
        }
    }
}

impl Prepared {
    /// Deflection of each unknown per friction of each mesh, and per its moment; none where no flanks rub. Friction acts midway along the face.
    fn across(&self) -> Option<Box<[[OfUnknowns; 2]; MOST_MESHES]>> {
        let of_friction = |unknown: usize, mesh: usize, number: usize| {
            let row = &self.compliance[unknown];
            row.get(self.first_across + 2 * mesh + number).copied().unwrap_or(0.0)
        };
        let of_unknowns = |mesh: usize, number: usize| {
            from_fn(
                |unknown| {
                    if unknown < self.first_across { of_friction(unknown, mesh, number) } else { 0.0 }
                },
            )
        };
        let rubs = self.first_across < self.first_spinning;
        rubs.then(|| Box::new(from_fn(|mesh| [of_unknowns(mesh, 0), of_unknowns(mesh, 1)])))
    }
}

/// Forces and slopes of all unknowns at their deflections.
trait Law {
    /// (N, N/m) Of a mesh at (m) a deflection: rising and piecewise linear.
    fn of_mesh(&self, mesh: usize, deflection_m: f64) -> [f64; 2];

    /// Whether the force of a mesh is smooth, so that between iterates that are near to one another its tangent is the force.
    fn is_smooth(&self, mesh: usize) -> bool;

    /// Of a mesh whose flanks rub, also its friction and the moment of that, as [`MeshLaw::force_and_friction`].
    fn of_rubbing_mesh(&self, mesh: usize, deflection_m: f64) -> ([f64; 2], [[f64; 2]; 2]);

    /// Of a mesh whose tilt is an unknown, at (m) the deflection midway and what the tilt adds at the face's end.
    fn of_tilted(&self, mesh: usize, deflection_m: [f64; 2]) -> TiltedLoad;

    /// Of a bearing at (m) a stretch.
    fn of_bearing(&self, bearing: usize, stretch_m: [f64; 2]) -> BearingLoad;
}

/// What acts at one sample.
struct ContactSample<'a> {
    /// Of each mesh.
    springs: &'a [SpringSamples],
    /// With the elements of each bearing, and what turns with the shafts.
    block: &'a ForcingBlock,
    /// Number of the sample in the block.
    k: usize,
}

/// The meshes and bearings at one sample.
struct ContactLaw<'a> {
    laws: &'a [MeshLaw],
    bearings: &'a [RollingBearing],
    sample: &'a ContactSample<'a>,
}

impl Law for ContactLaw<'_> {
    #[inline(always)]
    fn of_mesh(&self, mesh: usize, deflection_m: f64) -> [f64; 2] {
        self.laws[mesh].force_and_slope(self.sample.springs[mesh].at(self.sample.k), deflection_m)
    }

    #[inline(always)]
    fn is_smooth(&self, mesh: usize) -> bool {
        self.sample.springs[mesh].is_smooth()
    }

    #[inline(always)]
    fn of_rubbing_mesh(&self, mesh: usize, deflection_m: f64) -> ([f64; 2], [[f64; 2]; 2]) {
        self.laws[mesh].force_and_friction(self.sample.springs[mesh].at(self.sample.k), deflection_m)
    }

    #[inline(always)]
    fn of_tilted(&self, mesh: usize, deflection_m: [f64; 2]) -> TiltedLoad {
        self.laws[mesh].tilted(self.sample.springs[mesh].at(self.sample.k), deflection_m)
    }

    #[inline(always)]
    fn of_bearing(&self, bearing: usize, stretch_m: [f64; 2]) -> BearingLoad {
        self.bearings[bearing]
            .beside_spring(stretch_m, &self.sample.block.bearings[bearing].places(self.sample.k))
    }
}

/// Forces and slopes of the unknowns.
#[derive(Clone, Copy)]
struct Loads {
    /// (N)
    forces: OfUnknowns,
    /// (N/m) Each by its own deflection.
    slopes: OfUnknowns,
    /// (N/m) Of the unknown of a bearing, or of a mesh with two, by the other one of the same.
    cross_slopes: OfUnknowns,
    /// Of each mesh, friction across its line of action and its moment, each with its slopes by deflection and tilt; 0 without friction.
    friction: [[[f64; 3]; 2]; MOST_MESHES],
}

impl Loads {
    const NONE: Self = Self {
        forces: [0.0; MOST_UNKNOWNS],
        slopes: [0.0; MOST_UNKNOWNS],
        cross_slopes: [0.0; MOST_UNKNOWNS],
        friction: [[[0.0; 3]; 2]; MOST_MESHES],
    };
}

/// Most of Newton's iterations without a search along the line. Of 2 000 random problems of up to eight meshes none needed more than 8.
const MOST_PLAIN_ITERATIONS: usize = 12;
/// Most iterations of all: beyond, rounding decides between two sets of pairs that are as good.
const MOST_ITERATIONS: usize = 50;
/// (m) Move of a bearing in an iteration up to which its load is read off the tangent, and not computed anew. Of elements that are pressed
/// together by 1 µm the tangent is wrong by 3e-4 N, at their first touch by 1e-2 N.
const BEARING_MOVES_M: f64 = 1e-8;

/// Whether an unknown of a bearing moves more than its tangent allows.
#[inline(always)]
fn moves(from: &OfUnknowns, to: &OfUnknowns, unknown: usize) -> bool {
    let move_m = (to[unknown] - from[unknown]).abs();
    move_m > BEARING_MOVES_M || move_m.is_nan()
}

/// Whether an unknown of a smooth mesh moves more than its tangent allows.
#[inline(always)]
fn moves_beyond_tangent(from: &OfUnknowns, to: &OfUnknowns, mesh: usize, unknown: usize) -> bool {
    let move_m = (to[unknown] - from[unknown]).abs();
    move_m > TANGENT_PART * to[mesh].abs() + TANGENT_M || move_m.is_nan()
}

/// The equations of a step, `D + G f(D) = D₀`.
struct Equations {
    /// Number of unknowns.
    count: usize,
    /// Number of meshes, whose unknowns come first.
    meshes: usize,
    /// Of each mesh, the number of its second unknown.
    tilts: [Option<usize>; MOST_MESHES],
    /// Number of the first of these; as many as there are unknowns without one.
    first_tilt: usize,
    /// Both unknowns of each bearing, and of each mesh with two.
    twins: Vec<[usize; 2]>,
    /// (m/N) G, by columns: of each unknown's force, the deflection of each.
    compliance: Matrix,
    /// (m) What the static forces, which the forces on the modes are relative to, add to D₀.
    of_static: OfUnknowns,
    /// (m/N, 1/N) G_Q and G_R: of each mesh, the deflection of each unknown per friction and per its moment; none where no flanks rub.
    across: Option<Box<[[OfUnknowns; 2]; MOST_MESHES]>>,
}

impl Equations {
    /// The equations of a step without the free deflections.
    fn new(prepared: &Prepared) -> Self {
        let (count, meshes) = (prepared.first_across, prepared.laws.len());
        let tilts = prepared.tilt_of_mesh.iter().enumerate();
        let tilts: Vec<[usize; 2]> = tilts.filter_map(|(mesh, tilt)| Some([mesh, (*tilt)?])).collect();
        let first_tilt = count - tilts.len();
        let mut this = Self {
            count,
            meshes,
            tilts: from_fn(|mesh| prepared.tilt_of_mesh.get(mesh).copied().flatten()),
            first_tilt,
            twins: (meshes..first_tilt).step_by(2).map(|a| [a, a + 1]).chain(tilts).collect(),
            compliance: [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS],
            of_static: [0.0; MOST_UNKNOWNS],
            across: prepared.across(),
        };
        for (a, row) in prepared.compliance[..count].iter().enumerate() {
            row[..count].iter().enumerate().for_each(|(b, g)| this.compliance[b][a] = *g);
            this.of_static[a] =
                row.iter().zip(&prepared.static_force_n).map(|(g, force_n)| g * force_n).sum();
        }
        this
    }

    /// The unknowns of the bearings.
    #[inline(always)]
    fn of_bearings(&self) -> Range<usize> {
        self.meshes..self.first_tilt
    }

    /// Whether a smooth mesh moves more than its tangent allows.
    #[inline(always)]
    fn leaves_tangent(&self, from: &OfUnknowns, to: &OfUnknowns, mesh: usize) -> bool {
        let tilts = self.tilts[mesh].is_some_and(|tilt| moves_beyond_tangent(from, to, mesh, tilt));
        tilts || moves_beyond_tangent(from, to, mesh, mesh)
    }

    /// Solves the equations.
    ///
    /// # Arguments
    /// * `law` - of the meshes and bearings
    /// * `free` - (m) D₀
    /// * `deflection` - (m) where to begin; set to the solution
    #[inline(always)]
    fn solve<I: Instructions>(
        &self,
        simd: I,
        law: &impl Law,
        free: &OfUnknowns,
        deflection: &mut OfUnknowns,
        search: &mut Search,
    ) -> Found {
        let Search { loads, next } = search;
        self.set_loads(law, deflection, &mut loads[0]);
        for iteration in 0..MOST_ITERATIONS {
            // The loads of two iterates take turns.
            let [even, odd] = loads;
            let (now, new) = if iteration % 2 == 0 { (even, odd) } else { (odd, even) };
            self.newton(simd, free, deflection, now, next);
            self.set_next_loads(law, [deflection, next], now, new);
            let same = self.is_same(law, [now, new], deflection, next);
            if !same && iteration >= MOST_PLAIN_ITERATIONS {
                *next = self.towards(law, free, deflection, next);
                self.set_loads(law, next, new);
            }
            deflection[..self.count].copy_from_slice(&next[..self.count]);
            if same {
                let searched = u64::from(iteration > MOST_PLAIN_ITERATIONS);
                return Found { loads: 1 - iteration % 2, iterations: iteration as u64 + 1, searched };
            }
        }
        Found { loads: MOST_ITERATIONS % 2, iterations: MOST_ITERATIONS as u64, searched: 1 }
    }

    /// Whether the same pairs touch before and after an iteration, and neither a smooth mesh nor a bearing has moved.
    #[inline(always)]
    fn is_same(
        &self,
        law: &impl Law,
        [loads, next]: [&Loads; 2],
        deflection: &OfUnknowns,
        next_deflection: &OfUnknowns,
    ) -> bool {
        let has_moved = |a: usize| moves(deflection, next_deflection, a);
        let is_other = |a: usize| match law.is_smooth(a) {
            true => self.leaves_tangent(deflection, next_deflection, a),
            false => loads.slopes[a] != next.slopes[a],
        };
        !(0..self.meshes).any(is_other) && !self.of_bearings().any(has_moved)
    }

    /// Sets the loads at the next iterate: of a smooth mesh or a bearing that has hardly moved those of its tangent.
    #[inline(always)]
    fn set_next_loads(&self, law: &impl Law, [from, to]: [&OfUnknowns; 2], loads: &Loads, next: &mut Loads) {
        for a in 0..self.meshes {
            let is_on_tangent = law.is_smooth(a) && !self.leaves_tangent(from, to, a);
            if let Some(tilt) = self.tilts[a] {
                if is_on_tangent {
                    self.set_tangent(loads, [from, to], [a, tilt], next);
                    let [move_m, tilt_m] = [a, tilt].map(|b| to[b] - from[b]);
                    next.friction[a] = loads.friction[a].map(|[force, slope, of_tilt]| {
                        [force + slope * move_m + of_tilt * tilt_m, slope, of_tilt]
                    });
                } else {
                    self.set_tilted_loads(law, [a, tilt], to, next);
                }
                continue;
            }
            if is_on_tangent {
                let further = |[force, slope]: [f64; 2]| [force + slope * (to[a] - from[a]), slope];
                [next.forces[a], next.slopes[a]] = further([loads.forces[a], loads.slopes[a]]);
                next.friction[a] = loads.friction[a].map(|[force, slope, _]| {
                    let [force, slope] = further([force, slope]);
                    [force, slope, 0.0]
                });
            } else {
                self.set_even_loads(law, a, to, next);
            }
        }
        for (bearing, a) in self.of_bearings().step_by(2).enumerate() {
            if moves(from, to, a) || moves(from, to, a + 1) {
                self.set_bearing_loads(law, bearing, to, next);
            } else {
                self.set_tangent(loads, [from, to], [a, a + 1], next);
            }
        }
    }

    /// Sets forces and slopes of two unknowns to those of their tangent.
    #[inline(always)]
    fn set_tangent(&self, loads: &Loads, [from, to]: [&OfUnknowns; 2], [a, b]: [usize; 2], next: &mut Loads) {
        for (a, other) in [(a, b), (b, a)] {
            let [own_m, other_m] = [a, other].map(|b| to[b] - from[b]);
            next.forces[a] = loads.forces[a] + loads.slopes[a] * own_m + loads.cross_slopes[a] * other_m;
            (next.slopes[a], next.cross_slopes[a]) = (loads.slopes[a], loads.cross_slopes[a]);
        }
    }

    /// Sets forces and slopes to those at a deflection of each unknown.
    #[inline(always)]
    fn set_loads(&self, law: &impl Law, deflection: &OfUnknowns, loads: &mut Loads) {
        self.set_mesh_loads(law, deflection, loads);
        for bearing in 0..self.of_bearings().len() / 2 {
            self.set_bearing_loads(law, bearing, deflection, loads);
        }
    }

    #[inline(always)]
    fn set_mesh_loads(&self, law: &impl Law, deflection: &OfUnknowns, loads: &mut Loads) {
        for a in 0..self.meshes {
            if let Some(tilt) = self.tilts[a] {
                self.set_tilted_loads(law, [a, tilt], deflection, loads);
                continue;
            }
            self.set_even_loads(law, a, deflection, loads);
        }
    }

    /// Sets force, slope and friction of a mesh with one unknown.
    #[inline(always)]
    fn set_even_loads(&self, law: &impl Law, mesh: usize, deflection: &OfUnknowns, loads: &mut Loads) {
        if self.across.is_none() {
            [loads.forces[mesh], loads.slopes[mesh]] = law.of_mesh(mesh, deflection[mesh]);
            return;
        }
        let (load, friction) = law.of_rubbing_mesh(mesh, deflection[mesh]);
        [loads.forces[mesh], loads.slopes[mesh]] = load;
        loads.friction[mesh] = friction.map(|[force, slope]| [force, slope, 0.0]);
    }

    /// Sets forces, slopes and friction of a mesh with two unknowns.
    #[inline(always)]
    fn set_tilted_loads(
        &self,
        law: &impl Law,
        [mesh, tilt]: [usize; 2],
        deflection: &OfUnknowns,
        loads: &mut Loads,
    ) {
        let load = law.of_tilted(mesh, [deflection[mesh], deflection[tilt]]);
        [loads.forces[mesh], loads.forces[tilt]] = load.forces;
        let cross;
        [loads.slopes[mesh], cross, loads.slopes[tilt]] = load.slopes;
        [loads.cross_slopes[mesh], loads.cross_slopes[tilt]] = [cross; 2];
        loads.friction[mesh] = load.friction;
    }

    #[inline(always)]
    fn set_bearing_loads(&self, law: &impl Law, bearing: usize, deflection: &OfUnknowns, loads: &mut Loads) {
        let a = self.meshes + 2 * bearing;
        let BearingLoad { force_n, slope_n_per_m: [xx, xy, yy] } =
            law.of_bearing(bearing, [deflection[a], deflection[a + 1]]);
        loads.forces[a..a + 2].copy_from_slice(&force_n);
        loads.slopes[a..a + 2].copy_from_slice(&[xx, yy]);
        loads.cross_slopes[a..a + 2].fill(xy);
    }

    /// Sets `next` to the solution if the slopes at `deflection` K went on, `(1 + G K) D = D₀ − G (f − K D)`.
    #[inline(always)]
    fn newton<I: Instructions>(
        &self,
        simd: I,
        free: &OfUnknowns,
        deflection: &OfUnknowns,
        loads: &Loads,
        next: &mut OfUnknowns,
    ) {
        // Columns of a known length are compiled to fewer instructions. G is 0 beyond the machine's unknowns.
        match self.count {
            0..=2 => next[..2].copy_from_slice(&self.newton_of::<_, 2>(simd, 2, free, deflection, loads)),
            3..=4 => next[..4].copy_from_slice(&self.newton_of::<_, 4>(simd, 4, free, deflection, loads)),
            5..=8 => next[..8].copy_from_slice(&self.newton_of::<_, 8>(simd, 8, free, deflection, loads)),
            count @ 9..=16 => {
                next[..16].copy_from_slice(&self.newton_of::<_, 16>(simd, count, free, deflection, loads));
            }
            count => *next = self.newton_of(simd, count, free, deflection, loads),
        }
    }

    /// [`Self::newton`] of `count` of at most `N` unknowns, column by column of the matrix, so that the rows of each lie side by side.
    #[inline(always)]
    fn newton_of<I: Instructions, const N: usize>(
        &self,
        simd: I,
        count: usize,
        free: &OfUnknowns,
        deflection: &OfUnknowns,
        loads: &Loads,
    ) -> [f64; N] {
        let mut columns = [Lanes([0.0; N]); N];
        let mut right = Lanes::from_fn(|a| free[a]);
        for b in 0..count {
            let slope = loads.slopes[b];
            add(simd, &mut columns[b], slope, &self.compliance[b]);
            add(simd, &mut right, slope * deflection[b] - loads.forces[b], &self.compliance[b]);
        }
        for &[first, second] in &self.twins {
            let cross = loads.cross_slopes[first];
            for (b, other) in [(first, second), (second, first)] {
                add(simd, &mut columns[b], cross, &self.compliance[other]);
                add(simd, &mut right, cross * deflection[b], &self.compliance[other]);
            }
        }
        if let Some(across) = &self.across {
            for b in 0..self.meshes {
                for (of_unknown, [force, slope, of_tilt]) in across[b].iter().zip(loads.friction[b]) {
                    let mut constant = force - slope * deflection[b];
                    add(simd, &mut columns[b], -slope, of_unknown);
                    if let Some(tilt) = self.tilts[b] {
                        constant -= of_tilt * deflection[tilt];
                        add(simd, &mut columns[tilt], -of_tilt, of_unknown);
                    }
                    add(simd, &mut right, constant, of_unknown);
                }
            }
        }
        eliminate(simd, count, &mut columns, &mut right);
        right.0
    }

    /// Goes from `from` towards `to`, Newton's iterate, as far as makes the residual smaller: up to the next pair that touches or leaves the
    /// residual falls in proportion.
    fn towards(&self, law: &impl Law, free: &OfUnknowns, from: &OfUnknowns, to: &OfUnknowns) -> OfUnknowns {
        let residual = |deflection: &OfUnknowns| {
            let mut loads = Loads::NONE;
            self.set_loads(law, deflection, &mut loads);
            let forces = loads.forces;
            let of_unknown = |a: usize| {
                let pressed = (0..self.count).map(|b| self.compliance[b][a] * forces[b]);
                let rubbed = self.across.iter().flat_map(|across| across.iter().zip(&loads.friction));
                let rubbed = rubbed.flat_map(|(of_mesh, friction)| of_mesh.iter().zip(friction));
                let rubbed: f64 = rubbed.map(|(of_unknown, [force, ..])| of_unknown[a] * force).sum();
                (deflection[a] + pressed.sum::<f64>() - rubbed - free[a]).powi(2)
            };
            (0..self.count).map(of_unknown).sum::<f64>()
        };
        let before = residual(from);
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let between = from_fn(|a| from[a] + part * (to[a] - from[a]));
            if residual(&between) < before {
                return between;
            }
            part /= 2.0;
        }
        *from
    }
}

/// What the search for a step's solution works with.
struct Search {
    /// At the last two iterates.
    loads: [Loads; 2],
    next: OfUnknowns,
}

impl Search {
    fn new() -> Self {
        Self { loads: [Loads::NONE; 2], next: [0.0; MOST_UNKNOWNS] }
    }
}

/// What a search came to.
struct Found {
    /// Which of the loads of the [`Search`] are those of the solution.
    loads: usize,
    iterations: u64,
    /// 1 where some iterations were searches along the line.
    searched: u64,
}

/// Halvings of the way until only rounding is left of it.
const HALVINGS: usize = 60;

/// Adds so many times the first numbers of a column.
#[inline(always)]
fn add<I: Instructions, const N: usize>(simd: I, sums: &mut Lanes<N>, times: f64, column: &OfUnknowns) {
    *sums = Lanes::splat(times).mul_add(simd, Lanes::from_fn(|a| column[a]), *sums);
}

/// Solves `(1 + G K) x = right` by Gauss and Jordan's elimination without a search for pivots. Those of meshes are at least 1, since G is positive and no
/// slope of a mesh is negative. Those of bearings are near 1, since the compliance G within a step is small beside that of the bearing's linear spring.
///
/// Each pivot's column is eliminated from all rows at once, and not from those below it alone: rows side by side cost no more. The pivot's own row is left
/// with `a − (a/p)(p − 1) = a/p`, as it must be, because the columns are those of G K, without the 1.
///
/// # Arguments
/// * `count` - number of equations
/// * `columns` - of G K; are overwritten
/// * `right` - the right-hand side; set to the solution
#[inline(always)]
fn eliminate<I: Instructions, const N: usize>(
    simd: I,
    count: usize,
    columns: &mut [Lanes<N>; N],
    right: &mut Lanes<N>,
) {
    for pivot in 0..count {
        let eliminated = columns[pivot];
        let over_pivot = 1.0 / (1.0 + eliminated.0[pivot]);
        let factor = |column: &Lanes<N>| Lanes::splat(column.0[pivot] * over_pivot);
        for column in &mut columns[pivot + 1..count] {
            *column = eliminated.negative_mul_add(simd, factor(column), *column);
        }
        *right = eliminated.negative_mul_add(simd, factor(right), *right);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Draws, Purpose};
    use crate::simd::Plain;

    /// A law that is a function.
    struct Function<F>(F);

    impl<F: Fn(usize, f64) -> [f64; 2]> Law for Function<F> {
        fn of_mesh(&self, mesh: usize, deflection_m: f64) -> [f64; 2] {
            self.0(mesh, deflection_m)
        }

        fn is_smooth(&self, _: usize) -> bool {
            false
        }

        fn of_rubbing_mesh(&self, mesh: usize, deflection_m: f64) -> ([f64; 2], [[f64; 2]; 2]) {
            (self.of_mesh(mesh, deflection_m), [[0.0; 2]; 2])
        }

        fn of_tilted(&self, _: usize, _: [f64; 2]) -> TiltedLoad {
            TiltedLoad::default()
        }

        fn of_bearing(&self, _: usize, _: [f64; 2]) -> BearingLoad {
            BearingLoad { force_n: [0.0; 2], slope_n_per_m: [0.0; 3] }
        }
    }

    impl Equations {
        /// Of so many unknowns, and meshes among them.
        fn without_tilts([count, meshes]: [usize; 2], compliance: Matrix) -> Self {
            let of_static = [0.0; MOST_UNKNOWNS];
            Self {
                count,
                meshes,
                tilts: [None; MOST_MESHES],
                first_tilt: count,
                twins: (meshes..count).step_by(2).map(|a| [a, a + 1]).collect(),
                compliance,
                of_static,
                across: None,
            }
        }
    }

    /// Meshes of springs along their faces, each at a place of its own.
    struct Faces([[[f64; 3]; 12]; MOST_MESHES]);

    impl Law for Faces {
        fn of_mesh(&self, mesh: usize, deflection_m: f64) -> [f64; 2] {
            let load = self.of_tilted(mesh, [deflection_m, 0.0]);
            [load.forces[0], load.slopes[0]]
        }

        fn is_smooth(&self, _: usize) -> bool {
            true
        }

        fn of_rubbing_mesh(&self, mesh: usize, deflection_m: f64) -> ([f64; 2], [[f64; 2]; 2]) {
            (self.of_mesh(mesh, deflection_m), [[0.0; 2]; 2])
        }

        fn of_tilted(&self, mesh: usize, [deflection, tilt]: [f64; 2]) -> TiltedLoad {
            let mut load = TiltedLoad::default();
            for [k, offset, place] in self.0[mesh] {
                let penetration = deflection + offset + place * tilt;
                if penetration > 0.0 {
                    let forces = [k * penetration, k * penetration * place];
                    load.forces.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
                    let slopes = [k, k * place, k * place * place];
                    load.slopes.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += slope);
                }
            }
            load
        }

        fn of_bearing(&self, _: usize, _: [f64; 2]) -> BearingLoad {
            BearingLoad { force_n: [0.0; 2], slope_n_per_m: [0.0; 3] }
        }
    }

    /// One to four meshes, of which some tilt, all coupled with one another, some far more strongly than those of a machine: 2 000 drawn problems.
    #[test]
    fn drawn_equations_of_faces_that_tilt_are_solved() {
        let mut draws = Draws::new(5, Purpose::Candidate, 0);
        let mut most = [0; 2];
        for problem in 0..2_000 {
            let meshes = 1 + problem % 4;
            let strength = 10f64.powf(draws.uniform(0.0, 2.0));
            let mut law = Faces([[[0.0; 3]; 12]; MOST_MESHES]);
            law.0.iter_mut().flatten().for_each(|spring| {
                *spring = [draws.uniform(0.3, 0.3), draws.uniform(0.0, 1.0), draws.uniform(0.0, 1.0)];
            });
            let a: Matrix = from_fn(|_| from_fn(|_| draws.uniform(0.0, 1.0)));
            let mut count = meshes;
            let mut equations = Equations::without_tilts([0, meshes], [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS]);
            for mesh in 0..meshes {
                if mesh == 0 || draws.uniform(0.0, 1.0) > 0.0 {
                    equations.tilts[mesh] = Some(count);
                    equations.twins.push([mesh, count]);
                    count += 1;
                }
            }
            (equations.count, equations.first_tilt) = (count, meshes);
            let free: OfUnknowns = from_fn(|_| draws.uniform(0.0, 3.0));
            equations.compliance = products(&a, strength, count);
            for start in [-10.0, 0.0, 10.0] {
                let mut deflection = [start; MOST_UNKNOWNS];
                let found = equations.solve(Plain, &law, &free, &mut deflection, &mut Search::new());
                most = [most[0].max(found.iterations), most[1] + found.searched];
                let mut loads = Loads::NONE;
                equations.set_loads(&law, &deflection, &mut loads);
                for row in 0..count {
                    let pressed: f64 =
                        (0..count).map(|b| equations.compliance[b][row] * loads.forces[b]).sum();
                    let residual = deflection[row] + pressed - free[row];
                    assert!(residual.abs() < 1e-6 * (1.0 + strength), "{problem}: {residual}");
                }
            }
        }
        println!("most iterations {}, searched along the line in {}", most[0], most[1]);
    }

    /// Number of columns of A, by which the coupling of drawn equations grows.
    const COUPLINGS: usize = 8;

    /// `s A Aᵀ` of the first unknowns, and 0 of the others.
    fn products(a: &Matrix, strength: f64, count: usize) -> [[f64; MOST_UNKNOWNS]; MOST_UNKNOWNS] {
        let product =
            |row: usize, column: usize| (0..COUPLINGS).map(|k| a[row][k] * a[column][k]).sum::<f64>();
        let of = |row: usize, column: usize| {
            if row.max(column) < count { strength * product(row, column) } else { 0.0 }
        };
        from_fn(|row| from_fn(|column| of(row, column)))
    }

    /// Springs that push from given deflections on, and coast flanks: 2 000 drawn problems of one to eight meshes, also of such as are
    /// coupled far more strongly than those of a machine. The solution obeys the equations, from wherever the search begins.
    #[test]
    fn drawn_equations_are_solved_exactly() {
        let mut draws = Draws::new(3, Purpose::Candidate, 0);
        for problem in 0..2_000 {
            let count = 1 + problem % MOST_MESHES;
            let strength = 10f64.powf(draws.uniform(0.0, 2.0));
            let mut springs = [[[0.0; 2]; 4]; MOST_MESHES];
            springs.iter_mut().flatten().for_each(|spring| {
                *spring = [draws.uniform(1.0, 1.0), draws.uniform(0.0, 1.0)];
            });
            let law = |mesh: usize, deflection: f64| {
                let touching = springs[mesh].iter().filter(|[_, offset]| deflection + offset > 0.0);
                touching.fold([0.0; 2], |[force, slope], [k, offset]| {
                    [force + k * (deflection + offset), slope + k]
                })
            };
            // S = A Aᵀ.
            let a: Matrix = from_fn(|_| from_fn(|_| draws.uniform(0.0, 1.0)));
            let mut equations =
                Equations::without_tilts([count, count], [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS]);
            let free: OfUnknowns = from_fn(|_| draws.uniform(0.0, 3.0));
            equations.compliance = products(&a, strength, count);
            for start in [-10.0, 0.0, 10.0] {
                let mut deflection = [start; MOST_UNKNOWNS];
                equations.solve(Plain, &Function(law), &free, &mut deflection, &mut Search::new());
                for row in 0..count {
                    let pressed: f64 = (0..count)
                        .map(|column| equations.compliance[column][row] * law(column, deflection[column])[0])
                        .sum();
                    let residual = deflection[row] + pressed - free[row];
                    assert!(residual.abs() < 1e-9 * (1.0 + strength), "{problem}: {residual}");
                }
            }
        }
    }

    /// A mesh of one spring and a bearing whose force is that of one central spring `K r^1.5`, beside a linear spring that the compliance
    /// contains.
    struct MeshAndBearing;

    const SPRING_N_PER_M: f64 = 5e7;

    impl Law for MeshAndBearing {
        fn of_mesh(&self, _: usize, deflection_m: f64) -> [f64; 2] {
            if deflection_m > 0.0 { [3e8 * deflection_m, 3e8] } else { [0.0; 2] }
        }

        fn is_smooth(&self, _: usize) -> bool {
            false
        }

        fn of_rubbing_mesh(&self, mesh: usize, deflection_m: f64) -> ([f64; 2], [[f64; 2]; 2]) {
            (self.of_mesh(mesh, deflection_m), [[0.0; 2]; 2])
        }

        fn of_tilted(&self, _: usize, _: [f64; 2]) -> TiltedLoad {
            TiltedLoad::default()
        }

        fn of_bearing(&self, _: usize, [x_m, y_m]: [f64; 2]) -> BearingLoad {
            const HERTZ: f64 = 1e10;
            let r_m = x_m.hypot(y_m).max(1e-12);
            let over_r = HERTZ * r_m.sqrt();
            let further = 0.5 * over_r / (r_m * r_m);
            BearingLoad {
                force_n: [x_m, y_m].map(|of_m| (over_r - SPRING_N_PER_M) * of_m),
                slope_n_per_m: [
                    over_r + further * x_m * x_m - SPRING_N_PER_M,
                    further * x_m * y_m,
                    over_r + further * y_m * y_m - SPRING_N_PER_M,
                ],
            }
        }
    }

    /// The bearing's equations hold to what its tangent leaves, from any start, although the slopes beside the spring are negative near 0.
    #[test]
    fn bearings_are_solved_beside_their_linear_springs() {
        // G = (G₀⁻¹ + K₀)⁻¹ of a machine without the spring, G₀.
        let mut compliance = [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS];
        let of_bearing = |without: f64| without / (1.0 + without * SPRING_N_PER_M);
        compliance[0][0] = 2e-10;
        (compliance[1][1], compliance[2][2]) = (of_bearing(3e-9), of_bearing(1e-9));
        (compliance[0][1], compliance[1][0]) = (1e-11, 1e-11);
        let equations = Equations::without_tilts([3, 1], compliance);
        for free_m in [[1e-6, 5e-6, -3e-6], [-1e-6, 2e-7, 1e-7], [0.0, 1e-9, 0.0], [2e-6, -4e-5, 6e-5]] {
            let mut free = [0.0; MOST_UNKNOWNS];
            free[..3].copy_from_slice(&free_m);
            for start_m in [0.0, 1e-6, -2e-5] {
                let mut deflection = [start_m; MOST_UNKNOWNS];
                equations.solve(Plain, &MeshAndBearing, &free, &mut deflection, &mut Search::new());
                let mut loads = Loads::NONE;
                equations.set_loads(&MeshAndBearing, &deflection, &mut loads);
                for row in 0..3 {
                    let pressed: f64 = (0..3).map(|b| compliance[row][b] * loads.forces[b]).sum();
                    let residual_m = deflection[row] + pressed - free[row];
                    assert!(residual_m.abs() < 5e-12, "{free_m:?} {start_m}: {residual_m}");
                }
            }
        }
    }

    /// The search along the line alone comes to the same solution.
    #[test]
    fn search_along_the_line_ends_at_the_solution() {
        let law =
            |_: usize, deflection: f64| if deflection > 0.0 { [3.0 * deflection, 3.0] } else { [0.0, 0.0] };
        let mut compliance = [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS];
        compliance[0][..2].copy_from_slice(&[2.0, 0.9]);
        compliance[1][..2].copy_from_slice(&[0.9, 1.0]);
        let mut free = [0.0; MOST_UNKNOWNS];
        free[..2].copy_from_slice(&[1.0, -0.2]);
        let equations = Equations::without_tilts([2, 2], compliance);
        let law = Function(law);
        let mut exact = [0.0; MOST_UNKNOWNS];
        equations.solve(Plain, &law, &free, &mut exact, &mut Search::new());
        let mut searched = [-4.0; MOST_UNKNOWNS];
        for _ in 0..20 {
            let Search { loads: [mut loads, _], next: mut newton } = Search::new();
            equations.set_loads(&law, &searched, &mut loads);
            equations.newton(Plain, &free, &searched, &loads, &mut newton);
            searched = equations.towards(&law, &free, &searched, &newton);
        }
        assert!(
            (searched[0] - exact[0]).abs() < 1e-12 && (searched[1] - exact[1]).abs() < 1e-12,
            "{searched:?}"
        );
    }
}
