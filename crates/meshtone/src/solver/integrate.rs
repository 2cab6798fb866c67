//! The time loop: one simulation, or several side by side.

use super::cycle_table::{CycleTable, StepFactors};
use super::instruction_set::{InstructionSet, Task};
use super::lanes::Lanes;
use super::outputs::{EXTERNALS, Output, OutputRow, Scales};
use super::reduce::ReducedModel;
use super::step::{Coefficients, Group, Norm, State};
use crate::dynamics::coordinates::THETA_PINION;
use crate::dynamics::{Forcing, ForcingBlock};
use crate::scenario::Convention;
use crate::simulate::Stages;

/// Samples that are forced, solved and handed out at a time.
const BLOCK_SAMPLES: usize = 512;

/// Successive samples of all outputs of one simulation.
pub struct Block<'a> {
    /// Number of the first sample, 0 at the start of the simulation.
    pub first_sample: usize,
    outputs: &'a [Vec<f64>],
}

impl Block<'_> {
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

/// Number of modes and of mesh directions that a step is compiled for. Fixed sizes let the compiler unroll the step and
/// keep it in registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Size {
    /// A healthy pair, a missing or a destroyed tooth: the wheels do not tilt.
    Flat,
    /// The load moves along the face: the wheels tilt.
    Tilting,
    /// The pressure angle changes.
    Rolling,
    /// Everything, as after an arbitrary initial displacement; also at varying speed or load.
    General,
}

impl Size {
    fn of(model: &ReducedModel) -> Self {
        match (model.modes(), model.directions.len()) {
            (0..=5, 0..=1) => Self::Flat,
            (0..=7, 0..=2) => Self::Tilting,
            (0..=7, 3) => Self::Rolling,
            _ => Self::General,
        }
    }
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
    let forcing = Forcing::new(problem.stages, &problem.model.directions);
    let steady = forcing.is_steady();
    let published = problem.stages.scenario.convention == Convention::Published;
    let size = Size::of(problem.model);
    let [result] = by_size::<1>(size, published, steady, instructions, [problem], [forcing], [recorder]);
    result
}

fn by_size<const L: usize>(
    size: Size,
    published: bool,
    steady: bool,
    instructions: InstructionSet,
    problems: [&Problem; L],
    forcings: [Forcing; L],
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    macro_rules! solve {
        ($modes:literal, $directions:literal, $steady:literal) => {
            if published {
                instructions.run(Solve::<L, $modes, $directions, true, $steady> {
                    problems,
                    forcings,
                    recorders,
                })
            } else {
                instructions.run(Solve::<L, $modes, $directions, false, $steady> {
                    problems,
                    forcings,
                    recorders,
                })
            }
        };
    }
    // Each line is compiled for every instruction set, so what is rare shares the largest size.
    match size {
        Size::Flat if steady => solve!(5, 1, true),
        Size::Tilting if steady => solve!(7, 2, true),
        Size::Rolling if steady => solve!(7, 3, true),
        _ => solve!(13, 5, false),
    }
}

/// A time loop of `L` simulations, ready to run.
struct Solve<
    'a,
    'r,
    const L: usize,
    const N: usize,
    const R: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
> {
    problems: [&'a Problem<'a>; L],
    forcings: [Forcing<'a>; L],
    recorders: [&'r mut dyn Recorder; L],
}

impl<const L: usize, const N: usize, const R: usize, const PUBLISHED: bool, const STEADY: bool> Task
    for Solve<'_, '_, L, N, R, PUBLISHED, STEADY>
{
    type Output = [Result<(), Diverged>; L];

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Self::Output {
        solve::<L, FUSED, N, R, PUBLISHED, STEADY>(self.problems, self.forcings, self.recorders)
    }
}

/// Everything about one simulation that does not change from step to step.
struct Prepared<const R: usize> {
    factors: StepFactors,
    scales: Scales,
    table: CycleTable<R>,
    rows: Vec<OutputRow>,
}

impl<const R: usize> Prepared<R> {
    fn new(problem: &Problem) -> Self {
        let (model, stages) = (problem.model, problem.stages);
        let half_step_s = stages.time.step_s() / 2.0;
        let factors = StepFactors::new(model, half_step_s);
        let published = stages.scenario.convention == Convention::Published;
        let drag: Vec<f64> =
            model.damping.iter().zip(&model.rigid_velocity).map(|(damping, rigid)| damping * rigid).collect();
        let torque = stages.scenario.operation.brake_torque_nm;
        let static_displacement = (0..model.modes())
            .map(|n| {
                // Convention: under `published` damping brakes the rigid rotation too, under `corrected` it acts on the
                // velocity relative to the motor's.
                let brake = if published { drag[n] * model.rotation_rad_per_s } else { 0.0 };
                (model.brake[n] * torque - brake) / model.stiffness[n]
            })
            .collect();
        let followed_speed = if published { vec![0.0; model.modes()] } else { drag };
        let scales = Scales {
            half_step_s,
            static_displacement,
            external: [model.motor.clone(), model.brake.clone(), followed_speed],
        };
        Self {
            table: CycleTable::new(model, &stages.system, &factors.compliance),
            rows: problem.outputs.iter().map(|output| output.row(model, &scales)).collect(),
            factors,
            scales,
        }
    }
}

fn lanes<const L: usize, const FUSED: bool>(f: impl FnMut(usize) -> f64) -> Lanes<L, FUSED> {
    Lanes::from_fn(f)
}

fn modal<const L: usize, const FUSED: bool, const N: usize>(
    mut of: impl FnMut(usize) -> Vec<f64>,
) -> [Lanes<L, FUSED>; N] {
    let values: [Vec<f64>; L] = std::array::from_fn(&mut of);
    std::array::from_fn(|n| lanes(|l| values[l].get(n).copied().unwrap_or(0.0)))
}

fn coefficients<const L: usize, const FUSED: bool, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared<R>; L],
) -> Coefficients<L, FUSED, N, R> {
    let model = |l: usize| problems[l].model;
    let share = |l: usize, force: &[f64]| -> Vec<f64> {
        prepared[l].factors.share.iter().zip(force).map(|(share, force)| share * force).collect()
    };
    let column = |l: usize, r: usize| -> Vec<f64> {
        model(l).mesh.get(r).map_or_else(Vec::new, |column| column.as_slice().to_vec())
    };
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let points_per_rad = |l: usize| 1.0 / (std::f64::consts::TAU * problems[l].stages.cycle.coarse_step_rev);
    let angle = |l: usize| -> Vec<f64> {
        model(l).shapes.iter().map(|shape| shape[THETA_PINION] * points_per_rad(l)).collect()
    };
    let rotation = |l: usize| model(l).rotation_rad_per_s;
    let half_step = |l: usize| prepared[l].scales.half_step_s;
    Coefficients {
        keep: modal(|l| prepared[l].factors.keep.clone()),
        restore: modal(|l| prepared[l].factors.restore.clone()),
        push: std::array::from_fn(|r| modal(|l| share(l, &column(l, r)))),
        external_push: std::array::from_fn(|x| modal(|l| share(l, &prepared[l].scales.external[x]))),
        mesh: std::array::from_fn(|r| modal(|l| column(l, r))),
        angle: modal(angle),
        angle_push: std::array::from_fn(|r| lanes(|l| sum(&angle(l), &share(l, &column(l, r))))),
        compliance: std::array::from_fn(|r| {
            std::array::from_fn(|c| {
                lanes(|l| prepared[l].factors.compliance.get((r, c)).copied().unwrap_or(0.0))
            })
        }),
        static_deflection: std::array::from_fn(|r| {
            lanes(|l| sum(&column(l, r), &prepared[l].scales.static_displacement))
        }),
        static_angle: lanes(|l| sum(&angle(l), &prepared[l].scales.static_displacement) + 0.5),
        points_per_sample: lanes(|l| {
            let (time, cycle) = (&problems[l].stages.time, &problems[l].stages.cycle);
            cycle.points_per_pinion_revolution as f64 / time.samples_per_pinion_revolution as f64
        }),
        cycle: lanes(|l| prepared[l].table.cycle as f64),
        per_cycle: lanes(|l| 1.0 / prepared[l].table.cycle as f64),
        pitch: lanes(|l| prepared[l].table.pitch as f64),
        per_pitch: lanes(|l| 1.0 / prepared[l].table.pitch as f64),
        window: lanes(|l| prepared[l].table.window as f64),
        norm: Norm {
            rigid_displacement: modal(|l| {
                model(l).rigid_velocity.iter().map(|rigid| rigid * rotation(l) * 2.0 * half_step(l)).collect()
            }),
            // K̂ r = k_p e_θp + (2/dt) C r + (4/dt²) M r, whatever the mesh stiffness.
            rigid_increment: modal(|l| {
                (0..model(l).modes())
                    .map(|n| {
                        let (h, rigid) = (half_step(l), model(l).rigid_velocity[n]);
                        rotation(l)
                            * (model(l).motor[n] * 2.0 * h + (2.0 * model(l).damping[n] + 2.0 / h) * rigid)
                    })
                    .collect()
            }),
            external: std::array::from_fn(|x| modal(|l| prepared[l].scales.external[x].clone())),
            twice_stiffness: modal(|l| model(l).stiffness.iter().map(|stiffness| 2.0 * stiffness).collect()),
            two_per_h2: lanes(|l| 2.0 / (half_step(l) * half_step(l))),
        },
    }
}

/// States of one block of samples, variable by variable, so that outputs are computed for many samples at once.
struct History<const L: usize, const FUSED: bool, const N: usize, const R: usize> {
    displacement: Column<L, FUSED, N>,
    scaled_velocity: Column<L, FUSED, N>,
    force: Column<L, FUSED, R>,
    external: Column<L, FUSED, EXTERNALS>,
}

/// `V` variables over a block of samples.
type Column<const L: usize, const FUSED: bool, const V: usize> = Box<[[Lanes<L, FUSED>; BLOCK_SAMPLES]; V]>;

/// An output as a combination of a [`History`]'s variables; those whose weight is zero everywhere are left out.
struct Row<const L: usize, const FUSED: bool> {
    weights: Vec<(usize, Lanes<L, FUSED>)>,
    constant: Lanes<L, FUSED>,
    per_sample: Lanes<L, FUSED>,
}

impl<const L: usize, const FUSED: bool, const N: usize, const R: usize> History<L, FUSED, N, R> {
    fn new() -> Self {
        Self {
            displacement: Box::new([[Lanes::splat(0.0); BLOCK_SAMPLES]; N]),
            scaled_velocity: Box::new([[Lanes::splat(0.0); BLOCK_SAMPLES]; N]),
            force: Box::new([[Lanes::splat(0.0); BLOCK_SAMPLES]; R]),
            external: Box::new([[Lanes::splat(0.0); BLOCK_SAMPLES]; EXTERNALS]),
        }
    }

    /// Stores the state of sample `k` of the block.
    #[inline(always)]
    fn store<const STEADY: bool>(&mut self, k: usize, state: &State<L, FUSED, N, R>) {
        // Never larger; lets the compiler see that.
        let k = k % BLOCK_SAMPLES;
        for n in 0..N {
            self.displacement[n][k] = state.displacement[n];
            self.scaled_velocity[n][k] = state.scaled_velocity[n];
        }
        for r in 0..R {
            self.force[r][k] = state.force[r];
        }
        if !STEADY {
            for x in 0..EXTERNALS {
                self.external[x][k] = state.external[x];
            }
        }
    }

    /// Variable `index`: displacements first, then scaled velocities, forces and externals.
    fn variable(&self, index: usize) -> &[Lanes<L, FUSED>] {
        let all = self.displacement.iter().chain(self.scaled_velocity.iter());
        all.chain(self.force.iter()).chain(self.external.iter()).nth(index).map_or(&[], |column| column)
    }
}

impl<const L: usize, const FUSED: bool> Row<L, FUSED> {
    fn new<const N: usize, const R: usize>(rows: [&OutputRow; L]) -> Self {
        let value = |values: &[f64], index: usize| values.get(index).copied().unwrap_or(0.0);
        let displacement = (0..N).map(|n| (n, lanes(|l| value(&rows[l].displacement, n))));
        let velocity = (0..N).map(|n| (N + n, lanes(|l| value(&rows[l].scaled_velocity, n))));
        let force = (0..R).map(|r| (2 * N + r, lanes(|l| value(&rows[l].force, r))));
        let external = (0..EXTERNALS).map(|x| (2 * N + R + x, lanes(|l| rows[l].external[x])));
        let all = displacement.chain(velocity).chain(force).chain(external);
        Self {
            weights: all.filter(|(_, weight): &(usize, Lanes<L, FUSED>)| weight.0 != [0.0; L]).collect(),
            constant: lanes(|l| rows[l].constant),
            per_sample: lanes(|l| rows[l].per_sample),
        }
    }

    /// The output at the samples from `first` on.
    #[inline(always)]
    fn evaluate<const N: usize, const R: usize>(
        &self,
        history: &History<L, FUSED, N, R>,
        first: usize,
        output: &mut [Lanes<L, FUSED>],
    ) {
        for (k, value) in output.iter_mut().enumerate() {
            *value = self.per_sample.mul_add(Lanes::splat((first + k) as f64), self.constant);
        }
        for &(variable, weight) in &self.weights {
            for (value, state) in output.iter_mut().zip(history.variable(variable)) {
                *value = weight.mul_add(*state, *value);
            }
        }
    }
}

/// Forcing of one block, side by side.
struct SharedBlock<const L: usize, const FUSED: bool, const R: usize> {
    errors: Vec<[Lanes<L, FUSED>; R]>,
    external: Vec<[Lanes<L, FUSED>; EXTERNALS]>,
    scratch: ForcingBlock,
}

impl<const L: usize, const FUSED: bool, const R: usize> SharedBlock<L, FUSED, R> {
    fn new() -> Self {
        Self {
            errors: vec![[Lanes::splat(0.0); R]; BLOCK_SAMPLES],
            external: vec![[Lanes::splat(0.0); EXTERNALS]; BLOCK_SAMPLES],
            scratch: ForcingBlock::default(),
        }
    }

    fn fill<const STEADY: bool>(&mut self, forcings: &mut [Forcing; L], samples: usize) {
        for (l, forcing) in forcings.iter_mut().enumerate() {
            forcing.next_block(samples, &mut self.scratch);
            for (r, errors) in self.scratch.errors.iter().enumerate() {
                for (shared, error) in self.errors.iter_mut().zip(errors) {
                    shared[r].0[l] = *error;
                }
            }
            if !STEADY {
                let parts = [
                    &self.scratch.motor_lead_rad,
                    &self.scratch.torque_deviation_nm,
                    &self.scratch.speed_deviation_rad_per_s,
                ];
                for (x, part) in parts.into_iter().enumerate() {
                    for (shared, value) in self.external.iter_mut().zip(part) {
                        shared[x].0[l] = *value;
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn solve<
    const L: usize,
    const FUSED: bool,
    const N: usize,
    const R: usize,
    const PUBLISHED: bool,
    const STEADY: bool,
>(
    problems: [&Problem; L],
    mut forcings: [Forcing; L],
    recorders: [&mut dyn Recorder; L],
) -> [Result<(), Diverged>; L] {
    let mut results = [Ok(()); L];
    let prepared: [Prepared<R>; L] = std::array::from_fn(|l| Prepared::new(problems[l]));
    let coefficients = coefficients::<L, FUSED, N, R>(&problems, &prepared);
    let group = Group { coefficients: &coefficients, tables: std::array::from_fn(|l| &prepared[l].table) };
    let rows: Vec<Row<L, FUSED>> = (0..prepared[0].rows.len())
        .map(|row| Row::new::<N, R>(std::array::from_fn(|l| &prepared[l].rows[row])))
        .collect();
    let samples: [usize; L] = std::array::from_fn(|l| problems[l].stages.time.samples);
    let last = samples.iter().copied().max().unwrap_or(0);
    let first_recorded = problems.iter().map(|problem| problem.first_sample).min().unwrap_or(0);

    let mut block = SharedBlock::<L, FUSED, R>::new();
    block.fill::<STEADY>(&mut forcings, 1);
    let mut state = initial_state::<L, FUSED, N, R>(&problems, &prepared, &group, &block);
    let block_samples = BLOCK_SAMPLES / L;
    let mut history = History::<L, FUSED, N, R>::new();
    let mut values = vec![vec![Lanes::<L, FUSED>::splat(0.0); block_samples]; rows.len()];
    let mut outputs = vec![Vec::with_capacity(block_samples); rows.len()];

    let mut start = 0;
    while start < last {
        let length = block_samples.min(last - start);
        block.fill::<STEADY>(&mut forcings, length);
        let recorded = start + length > first_recorded;
        for k in 0..length {
            if recorded {
                history.store::<STEADY>(k, &state);
            }
            group.step::<PUBLISHED, STEADY>(&mut state, start + k + 1, &block.errors[k], &block.external[k]);
        }
        if recorded {
            for (row, values) in rows.iter().zip(&mut values) {
                row.evaluate(&history, start, &mut values[..length]);
            }
        }
        for l in 0..L {
            if start < samples[l] && !state.is_sound(l) {
                results[l] = results[l].and(Err(Diverged { sample: start + length }));
            }
            if results[l].is_err() {
                continue;
            }
            let from = problems[l].first_sample.saturating_sub(start).min(length);
            let until = samples[l].saturating_sub(start).min(length);
            if from >= until {
                continue;
            }
            for (output, values) in outputs.iter_mut().zip(&values) {
                output.clear();
                output.extend(values[from..until].iter().map(|value| value.0[l]));
            }
            recorders[l].record(&Block { first_sample: start + from, outputs: &outputs });
        }
        start += length;
    }
    results
}

fn initial_state<const L: usize, const FUSED: bool, const N: usize, const R: usize>(
    problems: &[&Problem; L],
    prepared: &[Prepared<R>; L],
    group: &Group<L, FUSED, N, R>,
    block: &SharedBlock<L, FUSED, R>,
) -> State<L, FUSED, N, R> {
    let displacement: [Lanes<L, FUSED>; N] = modal(|l| {
        let given = problems[l].model.initial_displacement.iter();
        given.zip(&prepared[l].scales.static_displacement).map(|(given, at_rest)| given - at_rest).collect()
    });
    let scaled_velocity = modal(|l| {
        let half_step = prepared[l].scales.half_step_s;
        problems[l].model.initial_velocity.iter().map(|velocity| velocity * half_step).collect()
    });
    let mut angle = group.coefficients.static_angle;
    for n in 0..N {
        angle = group.coefficients.angle[n].mul_add(displacement[n], angle);
    }
    let entry = group.entries(angle);
    let force = group.force_of_state(&displacement, &entry, &block.errors[0]);
    State { displacement, scaled_velocity, force, external: block.external[0], angle, entry }
}
