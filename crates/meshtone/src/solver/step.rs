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
use crate::mesh::{LawLanes, PairsSample, Touching};
use crate::simd::{Instructions, Lanes, Task, dot};

/// Number of modes above which a step is compiled for any motion of motor and brake; up to it, both are steady. A pair whose load tilts
/// the wheels has as many, wherever they sit on their shafts.
pub(super) const MOST_STEADY_MODES: usize = 9;

/// Number of modes of the largest machine that a step is compiled for; larger ones are stepped by [`super::coupled`].
pub(super) const MOST_MODES: usize = 17;

/// Constants of one simulation (`L` = 1) or of several side by side: `N` modes, and `R` columns of the mesh's line of action, one at the
/// middle of the face, and one for what is added per m along it. What they mean is said at [`Prepared`].
///
/// Aligned so that eight numbers side by side never straddle two cache lines; likewise [`State`].
#[repr(align(64))]
pub(super) struct Coefficients<const L: usize, const N: usize, const R: usize> {
    restore: [Lanes<L>; N],
    damp: [Lanes<L>; N],
    push: [[Lanes<L>; N]; R],
    external_push: [[Lanes<L>; N]; EXTERNALS],
    compliance: [[Lanes<L>; R]; R],
    static_deflection: [Lanes<L>; R],
    /// The deflection at a step's end from the state at its start: see [`Column`](super::prepare::Column).
    prediction: Prediction<L, N, R>,
}

/// What predicts the deflection at a step's end, with its damping's lead and without the step's own force.
struct Prediction<const L: usize, const N: usize, const R: usize> {
    of_displacement: [[Lanes<L>; N]; R],
    of_velocity: [[Lanes<L>; N]; R],
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
    /// The pairs that touch.
    touching: Touching<L>,
}

impl<const L: usize, const N: usize, const R: usize> Coefficients<L, N, R> {
    /// Whether motor and brake are steady, so that externals are 0 and are not read.
    const STEADY: bool = N <= MOST_STEADY_MODES;

    /// Lines the constants of `L` simulations up. Modes and columns that a simulation has not got are 0.
    pub(super) fn new(prepared: &[Prepared; L]) -> Self {
        let modes = |of: &dyn Fn(&Prepared) -> &[f64]| items(&|l, n| at(of(&prepared[l]), n));
        let column = |r: usize, l: usize| prepared[l].columns.get(r);
        Self {
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
            for n in 0..N {
                let share: f64 = (0..R).map(|s| self.push[s][n].0[l] * force[s].0[l]).sum();
                let next_velocity = velocity[n].0[l] + acceleration[n].0[l] - share;
                let next_displacement = displacement[n].0[l] + next_velocity;
                predicted += self.prediction.of_displacement[r][n].0[l] * next_displacement;
                predicted += self.prediction.of_velocity[r][n].0[l] * next_velocity;
            }
            predicted
        };
        State { predicted: items(&predicted), displacement, velocity, acceleration, force, touching: [0; L] }
    }

    /// Whether the motion of lane `l` is bounded.
    pub(super) fn is_sound(&self, state: &State<L, N, R>, l: usize) -> bool {
        state.displacement.iter().chain(&state.velocity).all(|mode| is_bounded(mode.0[l]))
    }

    /// Makes a step.
    ///
    /// The acceleration without the mesh's new force comes first, and the deflection that it leads to a step later. The deflection of
    /// this step is known but for the last step's force ([`Prediction`]), so that the law can begin. Its force is then added to every
    /// mode.
    ///
    /// # Arguments
    /// * `law` - the mesh
    /// * `state` - moves on by one sample
    /// * `pairs`, `external` - at the step's end
    #[inline(always)]
    fn step<I: Instructions>(
        &self,
        simd: I,
        law: &LawLanes<L>,
        state: &mut State<L, N, R>,
        pairs: &PairsSample<L>,
        external: &[Lanes<L>; EXTERNALS],
    ) {
        let zero = Lanes::splat(0.0);
        let (mut next_displacement, mut next_velocity) = ([zero; N], [zero; N]);
        for n in 0..N {
            state.velocity[n] = state.velocity[n].add(simd, state.acceleration[n]);
            state.displacement[n] = state.displacement[n].add(simd, state.velocity[n]);
            let damped = self.damp[n].mul(simd, state.velocity[n]);
            let mut acceleration = self.restore[n].mul_add(simd, state.displacement[n], damped);
            if !Self::STEADY {
                for x in 0..EXTERNALS {
                    acceleration = self.external_push[x][n].mul_add(simd, external[x], acceleration);
                }
            }
            state.acceleration[n] = acceleration;
            next_velocity[n] = state.velocity[n].add(simd, acceleration);
            next_displacement[n] = state.displacement[n].add(simd, next_velocity[n]);
        }
        let deflection = self.free_deflection(simd, state, external);
        let predicted = self.predict(simd, &next_displacement, &next_velocity);
        let force = law.force(simd, &deflection, &self.compliance, pairs, &mut state.touching);
        for n in 0..N {
            for r in 0..R {
                state.acceleration[n] = self.push[r][n].mul_add(simd, force[r], state.acceleration[n]);
            }
        }
        state.force = force;
        state.predicted = predicted;
    }

    /// What [`Prediction`] makes of predictions without the share of the last force.
    #[inline(always)]
    fn predict<I: Instructions>(
        &self,
        simd: I,
        displacement: &[Lanes<L>; N],
        velocity: &[Lanes<L>; N],
    ) -> [Lanes<L>; R] {
        let mut predicted = self.static_deflection;
        for r in 0..R {
            predicted[r] = dot(simd, predicted[r], &self.prediction.of_displacement[r], displacement);
            predicted[r] = dot(simd, predicted[r], &self.prediction.of_velocity[r], velocity);
        }
        predicted
    }

    /// The deflection at a step's end, with its damping's lead, without the step's own force.
    #[inline(always)]
    fn free_deflection<I: Instructions>(
        &self,
        simd: I,
        state: &State<L, N, R>,
        external: &[Lanes<L>; EXTERNALS],
    ) -> [Lanes<L>; R] {
        let mut deflection = state.predicted;
        for r in 0..R {
            if !Self::STEADY {
                for x in 0..EXTERNALS {
                    deflection[r] =
                        self.prediction.of_external[r][x].mul_add(simd, external[x], deflection[r]);
                }
            }
            for s in 0..R {
                deflection[r] = self.prediction.of_force[r][s].mul_add(simd, state.force[s], deflection[r]);
            }
        }
        deflection
    }
}

/// The steps of one block of samples: all that is compiled for each instruction set.
pub(super) struct StepBlock<'a, const L: usize, const N: usize, const R: usize> {
    pub(super) coefficients: &'a Coefficients<L, N, R>,
    pub(super) law: &'a LawLanes<L>,
    pub(super) state: &'a mut State<L, N, R>,
    /// Pairs at the samples after the state's.
    pub(super) pairs: &'a [PairsSample<L>],
    /// Externals at the same.
    pub(super) external: &'a [[Lanes<L>; EXTERNALS]],
    /// Takes the states before each step.
    pub(super) history: Option<&'a mut History<L, N, R>>,
}

impl<const L: usize, const N: usize, const R: usize> Task for StepBlock<'_, L, N, R> {
    type Output = ();

    #[inline(always)]
    fn run<I: Instructions>(mut self, simd: I) {
        // A copy, which the compiler can keep in registers.
        let mut state = *self.state;
        for (k, (pairs, external)) in self.pairs.iter().zip(self.external).enumerate() {
            if let Some(history) = &mut self.history {
                history.store(k, &state);
            }
            self.coefficients.step(simd, self.law, &mut state, pairs, external);
        }
        *self.state = state;
    }
}

/// The laws of the meshes of `L` simulations.
pub(super) fn law_lanes<const L: usize>(prepared: &[Prepared; L]) -> LawLanes<L> {
    LawLanes::new(
        prepared.each_ref().map(|of| of.laws[0]),
        prepared.each_ref().map(|of| of.static_force_n[0]),
    )
}

/// How large a machine a step is compiled for, the smaller sizes first. Fixed sizes let the compiler unroll the step and keep it in
/// registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Size {
    /// The load acts midway along the face: 8 modes.
    Flat,
    /// The load moves along the face and tilts the wheels: [`MOST_STEADY_MODES`]. Two of these modes are the tilts, and leaving out
    /// either one changes the acceleration by up to 3 % (10 and 100 N m, 5 and 20 µm of misalignment).
    Tilting,
    /// Any motion of motor and brake, or any initial velocity: [`MOST_MODES`].
    General,
}

impl Size {
    /// The smallest size that holds a simulation of one mesh.
    pub(super) fn of(problem: &Problem) -> Self {
        let columns = problem.machine.lines[0].columns.len();
        match (problem.is_steady, problem.machine.modes(), columns) {
            (true, 0..=8, 1) => Self::Flat,
            (true, 0..=MOST_STEADY_MODES, _) => Self::Tilting,
            _ => Self::General,
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
