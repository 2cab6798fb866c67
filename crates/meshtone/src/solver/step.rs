//! One step of the time integration for a machine with one mesh, for several simulations side by side.
//!
//! Each mode obeys `q̈ + c q̇ + k q = p`, with `p = B w + external` the modal force. The method is Newmark's with γ = ½ and a β of each
//! mode ([`StepOfMode`](super::mode_step::StepOfMode)). With `A = Δt² q̈` it reads
//!
//! ```text
//! q₁ = q₀ + Δt q̇₀ + (½ − β) A₀ + β A₁,   Δt q̇₁ = Δt q̇₀ + ½ (A₀ + A₁),   A₁ = Δt² (p₁ − c q̇₁ − k q₁)
//! ```
//!
//! What is stepped are the predictions that Newmark's method makes of a sample before its force is known, `v = Δt q̇ − ½ A` and
//! `y = q − β A`. In these a step is the same whatever β is: `v₁ = v₀ + A₀`, `y₁ = y₀ + v₁`, `A₁ = push·w₁ − e_v v₁ − e_y y₁`. It is
//! implicit only through the mesh's force `w₁`, which is found by the mesh's law: [`LawLanes`].
//!
//! `q` is taken relative to the rigid rotation at the nominal speed, in which the mesh does not deflect, and to the
//! displacement under the constant loads.
//!
//! Source: N. M. Newmark, "A method of computation for structural dynamics", Journal of the Engineering Mechanics
//! Division 85 (1959).

use super::history::History;
use super::integrate::{Problem, is_bounded};
use super::outputs::EXTERNALS;
use super::prepare::{FirstState, Prepared};
use crate::mesh::{CornerLanes, LastContact, LawLanes, Mesh, PAIRS, PairsSample};
use crate::simd::{Chains, Instructions, Lanes, Task};

/// Number of modes above which a step is compiled for forces that turn with the shafts; up to it, the mesh alone moves the machine. A
/// pair whose load tilts the wheels has as many, wherever they sit on their shafts.
pub(super) const MOST_UNDRIVEN_MODES: usize = 9;

/// Number of modes that the mesh of a pair moves whose wheels do not tilt.
pub(super) const MOVED_IN_PLANE: usize = 7;

/// Number of modes of the same pair with forces that turn with the shafts.
pub(super) const MOST_TURNING_MODES: usize = 11;

/// Number of modes above which a step is compiled for any motion of motor and brake; up to it, both are steady. A pair of helical teeth
/// has as many whose wheels sit midway on their shafts.
pub(super) const MOST_STEADY_MODES: usize = 13;

/// Number of modes of the largest machine that a step is compiled for; larger ones are stepped by [`super::coupled`].
pub(super) const MOST_MODES: usize = 17;

/// Pairs of helical teeth that most wheels have at once, with what their corners reach.
pub(super) const USUAL_PAIRS: usize = 4;

/// Most pairs of helical teeth that a step is compiled for: as many as overlap, with what their corners reach, where the contact ratios of
/// profile and face add up to 4.8.
pub(super) const MOST_PAIRS: usize = 6;

/// Constants of one simulation (`L` = 1) or of several side by side: `N` modes, of which the mesh moves the first `M`, and `R` columns of the mesh's line of action, one at the
/// middle of the face, and one for what is added per m along it. What they mean is said at [`Prepared`].
///
/// Aligned so that eight numbers side by side never straddle two cache lines; likewise [`State`]. Its fields stay in this order, so that
/// the list at the end shifts no numbers.
#[repr(C, align(64))]
pub(super) struct Coefficients<const L: usize, const N: usize, const M: usize, const R: usize> {
    restore: [Lanes<L>; N],
    damp: [Lanes<L>; N],
    push: [[Lanes<L>; M]; R],
    external_push: [[Lanes<L>; N]; EXTERNALS],
    compliance: [[Lanes<L>; R]; R],
    static_deflection: [Lanes<L>; R],
    /// The deflection at a step's end from the state at its start: see [`Column`](super::prepare::Column).
    prediction: Prediction<L, M, R>,
    /// Of each force that turns with a shaft.
    turning: Vec<TurningPush<L, N, R>>,
}

/// What a force that turns with a shaft brings about: per unit along the shaft's direction at the start, and a quarter of a revolution on.
#[repr(align(64))]
struct TurningPush<const L: usize, const N: usize, const R: usize> {
    push: [[Lanes<L>; N]; 2],
    /// Of the deflection at the step's end.
    of_deflection: [[Lanes<L>; 2]; R],
}

/// What predicts the deflection at a step's end, with its damping's lead and without the step's own force.
struct Prediction<const L: usize, const M: usize, const R: usize> {
    of_displacement: [[Lanes<L>; M]; R],
    of_velocity: [[Lanes<L>; M]; R],
    of_force: [[Lanes<L>; R]; R],
    of_external: [[Lanes<L>; EXTERNALS]; R],
}

/// What a step has of a sample.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct State<const L: usize, const N: usize, const R: usize> {
    /// Displacements as they were predicted, `q − β Δt² q̈`.
    pub(super) displacement: [Lanes<L>; N],
    /// Velocities as they were predicted, times Δt: `Δt q̇ − ½ Δt² q̈`.
    pub(super) velocity: [Lanes<L>; N],
    /// `Δt² q̈`.
    pub(super) acceleration: [Lanes<L>; N],
    /// (N) Mesh force on the modes, `w`.
    pub(super) force: [Lanes<L>; R],
    /// (m) The next deflection that [`Prediction`] makes of the state, but for the share of the state's own force.
    predicted: [Lanes<L>; R],
    /// Where the next step begins its search.
    last: LastContact<L>,
}

impl<const L: usize, const N: usize, const M: usize, const R: usize> Coefficients<L, N, M, R> {
    /// Whether a force may turn with a shaft.
    const TURNS: bool = N > MOST_UNDRIVEN_MODES;
    /// Whether motor or brake may vary; otherwise externals are 0 and are not read.
    const VARIES: bool = N > MOST_STEADY_MODES;

    /// Lines the constants of `L` simulations up. Modes and columns that a simulation has not got are 0.
    pub(super) fn new(prepared: &[Prepared; L]) -> Self {
        let modes = |of: &dyn Fn(&Prepared) -> &[f64]| items(&|l, n| at(of(&prepared[l]), n));
        let column = |r: usize, l: usize| prepared[l].columns.get(r);
        let turning = |t: usize| TurningPush {
            push: rows(&|l, x, n| prepared[l].turning_push.get(t).map_or(0.0, |push| at(&push[x], n))),
            of_deflection: rows(&|l, r, x| {
                column(r, l).and_then(|column| column.of_turning.get(t)).map_or(0.0, |of| of[x])
            }),
        };
        let turning_forces = prepared.iter().map(|of| of.turning_push.len()).max().unwrap_or(0);
        Self {
            turning: (0..turning_forces).map(turning).collect(),
            restore: modes(&|prepared| &prepared.restore),
            damp: modes(&|prepared| &prepared.damp),
            push: rows(&|l, r, n| column(r, l).map_or(0.0, |column| at(&column.push, n))),
            external_push: rows(&|l, x, n| at(&prepared[l].external_push[x], n)),
            compliance: rows(&|l, r, c| prepared[l].compliance.get(r).map_or(0.0, |row| at(row, c))),
            static_deflection: items(&|l, r| column(r, l).map_or(0.0, |column| column.static_deflection)),
            prediction: Prediction {
                of_displacement: rows(&|l, r, n| {
                    column(r, l).map_or(0.0, |column| at(&column.of_displacement, n))
                }),
                of_velocity: rows(&|l, r, n| column(r, l).map_or(0.0, |column| at(&column.of_velocity, n))),
                of_force: rows(&|l, r, s| column(r, l).map_or(0.0, |column| at(&column.of_force, s))),
                of_external: rows(&|l, r, x| column(r, l).map_or(0.0, |column| column.of_external[x])),
            },
        }
    }

    /// Lines the first states of `L` simulations up.
    ///
    /// # Arguments
    /// * `first` - of each
    pub(super) fn first_state(&self, first: &[FirstState; L]) -> State<L, N, R> {
        let displacement = items(&|l, n| at(&first[l].displacement, n));
        let velocity = items(&|l, n| at(&first[l].velocity, n));
        let acceleration = items(&|l, n| at(&first[l].acceleration, n));
        let force = items(&|l, r| at(&first[l].force, r));
        let predicted = |l: usize, r: usize| {
            let mut predicted = self.static_deflection[r].0[l];
            for n in 0..M {
                let share: f64 = (0..R).map(|s| self.push[s][n].0[l] * force[s].0[l]).sum();
                let next_velocity = velocity[n].0[l] + acceleration[n].0[l] - share;
                let next_displacement = displacement[n].0[l] + next_velocity;
                predicted += self.prediction.of_displacement[r][n].0[l] * next_displacement;
                predicted += self.prediction.of_velocity[r][n].0[l] * next_velocity;
            }
            predicted
        };
        State {
            predicted: items(&predicted),
            displacement,
            velocity,
            acceleration,
            force,
            last: LastContact::none(),
        }
    }

    /// Whether the motion of lane `l` is bounded.
    ///
    /// # Arguments
    /// * `state` - of all lanes
    /// * `largest` - (m √kg) how far each of the lane's modes may move
    /// * `l` - number of the lane
    pub(super) fn is_sound(&self, state: &State<L, N, R>, largest: &[f64], l: usize) -> bool {
        let of_modes = state.displacement.iter().zip(&state.velocity).zip(largest);
        of_modes
            .flat_map(|((displacement, velocity), largest)| {
                [displacement, velocity].map(|mode| (mode, largest))
            })
            .all(|(mode, largest)| is_bounded(mode.0[l], *largest))
    }

    /// Makes a step of a mesh of which `P` pairs are looked at together.
    ///
    /// The acceleration without the mesh's new force comes first, and the deflection that it leads to a step later. The deflection of
    /// this step is known but for the last step's force ([`Prediction`]), so that the law can begin. Its force is then added to every
    /// mode.
    ///
    /// # Arguments
    /// * `law`, `corners` - the mesh
    /// * `state` - moves on by one sample
    /// * `pairs`, `driven` - at the step's end
    #[inline(always)]
    fn step<I: Instructions, const P: usize, const C: usize>(
        &self,
        simd: I,
        (law, corners): (&LawLanes<L>, &CornerLanes<L, C>),
        state: &mut State<L, N, R>,
        pairs: &PairsSample<L, P, C>,
        driven: DrivenSample<L>,
    ) {
        let mut ahead = Ahead::new();
        for n in 0..N {
            state.velocity[n] = state.velocity[n].add(simd, state.acceleration[n]);
            state.displacement[n] = state.displacement[n].add(simd, state.velocity[n]);
            let damped = self.damp[n].mul(simd, state.velocity[n]);
            state.acceleration[n] = self.restore[n].mul_add(simd, state.displacement[n], damped);
            if !Self::TURNS && n < M {
                ahead.look(simd, n, state, &self.prediction);
            }
        }
        if Self::TURNS {
            self.drive(simd, &mut state.acceleration, driven);
            for n in 0..M {
                ahead.look(simd, n, state, &self.prediction);
            }
        }
        let deflection = self.free_deflection(simd, state, driven);
        state.predicted = ahead.predict(simd, &self.static_deflection, &self.prediction);
        let force = law.force(simd, &deflection, &self.compliance, pairs, corners, &mut state.last);
        for n in 0..M {
            for r in 0..R {
                state.acceleration[n] = self.push[r][n].mul_add(simd, force[r], state.acceleration[n]);
            }
        }
        state.force = force;
    }

    /// Adds what motor, brake and the forces that turn with the shafts bring about.
    #[inline(always)]
    fn drive<I: Instructions>(&self, simd: I, acceleration: &mut [Lanes<L>; N], driven: DrivenSample<L>) {
        if Self::VARIES
            && let Some(external) = driven.external
        {
            for n in 0..N {
                for x in 0..EXTERNALS {
                    acceleration[n] = self.external_push[x][n].mul_add(simd, external[x], acceleration[n]);
                }
            }
        }
        for (of, samples) in self.turning.iter().zip(driven.turning) {
            let TurningSample([of_cos, of_sin]) = samples[driven.sample];
            for n in 0..N {
                let pushed = of.push[1][n].mul_add(simd, of_sin, acceleration[n]);
                acceleration[n] = of.push[0][n].mul_add(simd, of_cos, pushed);
            }
        }
    }

    /// The deflection at a step's end, with its damping's lead, without the step's own force.
    #[inline(always)]
    fn free_deflection<I: Instructions>(
        &self,
        simd: I,
        state: &State<L, N, R>,
        driven: DrivenSample<L>,
    ) -> [Lanes<L>; R] {
        let mut deflection = state.predicted;
        for r in 0..R {
            if Self::VARIES
                && let Some(external) = driven.external
            {
                for x in 0..EXTERNALS {
                    deflection[r] =
                        self.prediction.of_external[r][x].mul_add(simd, external[x], deflection[r]);
                }
            }
            if Self::TURNS {
                for (of, samples) in self.turning.iter().zip(driven.turning) {
                    for (of, value) in of.of_deflection[r].iter().zip(samples[driven.sample].0) {
                        deflection[r] = of.mul_add(simd, value, deflection[r]);
                    }
                }
            }
            for s in 0..R {
                deflection[r] = self.prediction.of_force[r][s].mul_add(simd, state.force[s], deflection[r]);
            }
        }
        deflection
    }
}

/// What is predicted for the next step, without the share of this step's force, of the modes that the mesh moves.
struct Ahead<const L: usize, const M: usize, const R: usize> {
    displacement: [Lanes<L>; M],
    velocity: [Lanes<L>; M],
    /// Of a single column: what displacements and velocities add to the deflection.
    sums: [Chains<L>; 2],
}

impl<const L: usize, const M: usize, const R: usize> Ahead<L, M, R> {
    #[inline(always)]
    fn new() -> Self {
        let none = [Lanes::splat(0.0); M];
        Self { displacement: none, velocity: none, sums: [Chains::NONE; 2] }
    }

    /// Looks at mode `n`, whose acceleration is known but for the step's force.
    #[inline(always)]
    fn look<I: Instructions, const N: usize>(
        &mut self,
        simd: I,
        n: usize,
        state: &State<L, N, R>,
        prediction: &Prediction<L, M, R>,
    ) {
        self.velocity[n] = state.velocity[n].add(simd, state.acceleration[n]);
        self.displacement[n] = state.displacement[n].add(simd, self.velocity[n]);
        if R == 1 {
            self.sum(simd, n, 0, prediction);
        }
    }

    #[inline(always)]
    fn sum<I: Instructions>(&mut self, simd: I, n: usize, r: usize, prediction: &Prediction<L, M, R>) {
        self.sums[0].add(simd, n, prediction.of_displacement[r][n], self.displacement[n]);
        self.sums[1].add(simd, n, prediction.of_velocity[r][n], self.velocity[n]);
    }

    /// The deflection in each column. The sums of several columns are made one after the other, as they do not fit in the registers together.
    #[inline(always)]
    fn predict<I: Instructions>(
        &mut self,
        simd: I,
        static_deflection: &[Lanes<L>; R],
        prediction: &Prediction<L, M, R>,
    ) -> [Lanes<L>; R] {
        let mut predicted = *static_deflection;
        for r in 0..R {
            if R > 1 {
                self.sums = [Chains::NONE; 2];
                for n in 0..M {
                    self.sum(simd, n, r, prediction);
                }
            }
            for sum in &self.sums {
                predicted[r] = sum.total(simd, predicted[r]);
            }
        }
        predicted
    }
}

/// What drives the machine at a sample beside its mesh.
#[derive(Clone, Copy)]
struct DrivenSample<'a, const L: usize> {
    /// Motor and brake; none while they are steady.
    external: Option<&'a [Lanes<L>; EXTERNALS]>,
    /// As of [`StepBlock`].
    turning: &'a [Vec<TurningSample<L>>],
    /// Number of the sample in the block.
    sample: usize,
}

/// A force that turns with a shaft: how much of it points along the shaft's direction at the start, and a quarter of a revolution on.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct TurningSample<const L: usize>(pub(super) [Lanes<L>; 2]);

/// The steps of one block of samples: all that is compiled for each instruction set.
pub(super) struct StepBlock<
    'a,
    const L: usize,
    const N: usize,
    const M: usize,
    const R: usize,
    const P: usize,
    const C: usize,
> {
    pub(super) coefficients: &'a Coefficients<L, N, M, R>,
    pub(super) law: &'a LawLanes<L>,
    pub(super) state: &'a mut State<L, N, R>,
    /// Pairs at the samples after the state's.
    pub(super) pairs: &'a [PairsSample<L, P, C>],
    /// The laws of their corners: each up to a sample, the last one to the end of the block.
    pub(super) corners: &'a [(usize, CornerLanes<L, C>)],
    /// Externals at the same; none while all motors and brakes are steady.
    pub(super) external: Option<&'a [[Lanes<L>; EXTERNALS]]>,
    /// Each force that turns with a shaft, at the same.
    pub(super) turning: &'a [Vec<TurningSample<L>>],
    /// Takes the states before each step.
    pub(super) history: Option<&'a mut History<L, N, R>>,
}

impl<const L: usize, const N: usize, const M: usize, const R: usize, const P: usize, const C: usize> Task
    for StepBlock<'_, L, N, M, R, P, C>
{
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(mut self, simd: I) {
        // A copy, which the compiler can keep in registers.
        let mut state = *self.state;
        let mut k = 0;
        for (until, corners) in self.corners {
            for pairs in &self.pairs[k..*until] {
                if let Some(history) = &mut self.history {
                    history.store(k, &state);
                }
                let external = self.external.and_then(|external| external.get(k));
                let driven = DrivenSample { external, turning: self.turning, sample: k };
                self.coefficients.step(simd, (self.law, corners), &mut state, pairs, driven);
                k += 1;
            }
        }
        *self.state = state;
    }
}

/// The laws of the meshes of `L` simulations.
///
/// # Arguments
/// * `prepared` - their constants
/// * `problems` - the simulations
pub(super) fn law_lanes<const L: usize>(prepared: &[Prepared; L], problems: &[Problem; L]) -> LawLanes<L> {
    LawLanes::new(
        prepared.each_ref().map(|of| of.laws[0]),
        prepared.each_ref().map(|of| of.static_force_n[0]),
        problems.each_ref().map(|of| of.forcing.meshes().find_map(|mesh| mesh.closer_at_end_m)),
    )
}

/// How large a machine a step is compiled for. Fixed sizes let the compiler unroll the step and keep it in registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    /// The load acts midway along the face: 8 modes.
    Flat,
    /// The load moves along the face and tilts the wheels: [`MOST_UNDRIVEN_MODES`]. Two of these modes are the tilts, and leaving out
    /// either one changes the acceleration by up to 3 % (10 and 100 N m, 5 and 20 µm of misalignment).
    Tilting,
    /// A load midway along the face, and forces that turn with the shafts: as many modes as a pair has then whose wheels sit midway on their
    /// shafts, [`MOVED_IN_PLANE`] along the line of action and four across it.
    Turning,
    /// A load that moves along the face, with forces that turn with the shafts: [`MOST_STEADY_MODES`].
    Steady,
    /// Any motion of motor and brake, any initial velocity, and flanks of helical teeth that may pull: [`MOST_MODES`] and [`MOST_PAIRS`].
    General,
    /// Helical teeth, steady: [`MOST_STEADY_MODES`] and [`USUAL_PAIRS`].
    Helical,
    /// Helical teeth in any motion, and any that overlap: [`MOST_MODES`] and [`MOST_PAIRS`].
    GeneralHelical,
}

impl Size {
    /// The smallest size that holds simulations of one mesh.
    pub(super) fn of(problems: &[Problem]) -> Self {
        let most = |of: fn(&Problem) -> usize| problems.iter().map(of).max().unwrap_or(0);
        let modes = most(|problem| problem.machine.modes());
        let moved = most(|problem| problem.machine.modes_moved_by_meshes());
        let columns = most(|problem| 1 + usize::from(problem.machine.lines[0].to_end.is_some()));
        let is_steady = problems.iter().all(|problem| problem.is_steady);
        let springs = most(|problem| problem.forcing.meshes().map(Mesh::springs).max().unwrap_or(0));
        let turning_forces = most(|problem| problem.machine.turning_forces.len());
        let is_small = is_steady && modes <= MOST_STEADY_MODES;
        if problems.iter().any(Problem::has_corners) {
            return if is_small && springs <= USUAL_PAIRS { Self::Helical } else { Self::GeneralHelical };
        }
        if !is_small || springs > PAIRS {
            return Self::General;
        }
        match (turning_forces, modes, columns) {
            (0, 0..=8, 1) => Self::Flat,
            (0, 0..=MOST_UNDRIVEN_MODES, _) => Self::Tilting,
            (_, 0..=MOST_TURNING_MODES, 1) if moved <= MOVED_IN_PLANE => Self::Turning,
            _ => Self::Steady,
        }
    }
}

/// The number at an index, 0 beyond the last.
fn at(values: &[f64], index: usize) -> f64 {
    values.get(index).copied().unwrap_or(0.0)
}

/// Values of each lane, one of each of `N` items. The values are asked for through a reference to a closure: so the function is
/// compiled once for each size, not once for each of its coefficients.
fn items<const L: usize, const N: usize>(of: &dyn Fn(usize, usize) -> f64) -> [Lanes<L>; N] {
    let mut items = [Lanes::splat(0.0); N];
    for (n, item) in items.iter_mut().enumerate() {
        *item = Lanes::from_fn(|l| of(l, n));
    }
    items
}

/// Values of each lane, one of each of `N` items in each of `I` rows.
fn rows<const L: usize, const N: usize, const I: usize>(
    of: &dyn Fn(usize, usize, usize) -> f64,
) -> [[Lanes<L>; N]; I] {
    let mut rows = [[Lanes::splat(0.0); N]; I];
    for (i, row) in rows.iter_mut().enumerate() {
        *row = items(&|l, n| of(l, i, n));
    }
    rows
}
