//! One step of Newmark's method (γ = ½, β = ¼) for a machine with one mesh, for several simulations side by side.
//!
//! Each mode obeys `q̈ + 2ζω q̇ + ω² q = p`, with `p = B w + external` the modal force. Over a step of `2h`, with
//! `E = 1/(1 + 2ζω h + ω² h²)` and `s = h q̇`, the method reads
//! `S = 2E s₀ − 2h²ω²E q₀ + h²E (p₀ + p₁)`, `q₁ = q₀ + S`, `s₁ = S − s₀`. It is implicit only through the mesh's
//! force `w₁`, which is found by the mesh's law: [`LawLanes`].
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

/// Number of modes above which a step is compiled for any motion of motor and brake; below, both are steady.
pub(super) const MOST_STEADY_MODES: usize = 12;

/// Constants of one simulation (`L` = 1) or of several side by side: `N` modes, and `R` columns of the mesh's line of action, one at the
/// middle of the face, and one for what is added per m along it.
///
/// Aligned so that eight numbers side by side never straddle two cache lines; likewise [`State`].
#[repr(align(64))]
pub(super) struct Coefficients<const L: usize, const N: usize, const R: usize> {
    /// (-) `2E`.
    keep: [Lanes<L>; N],
    /// (-) `2 h² ω² E`.
    restore: [Lanes<L>; N],
    /// `h² E B`.
    push: [[Lanes<L>; N]; R],
    /// `h² E` times the modal force of each external.
    external_push: [[Lanes<L>; N]; EXTERNALS],
    /// (m/N) Γ: deflection in each column per force of the step in each.
    compliance: [[Lanes<L>; R]; R],
    /// Deflection under the constant loads.
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

/// State of the modes.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct State<const L: usize, const N: usize, const R: usize> {
    pub(super) displacement: [Lanes<L>; N],
    /// `s = h q̇`.
    pub(super) scaled_velocity: [Lanes<L>; N],
    /// (N) Mesh force on the modes, `w`.
    pub(super) force: [Lanes<L>; R],
    pub(super) external: [Lanes<L>; EXTERNALS],
    /// (m) The deflection that [`Prediction`] makes of the state, but for the share of the state's own force.
    predicted: [Lanes<L>; R],
    /// The pairs that touch.
    touching: Touching<L>,
}

impl<const L: usize, const N: usize, const R: usize> State<L, N, R> {
    /// Whether motor and brake are steady, so that externals are 0 and are not read.
    pub(super) const STEADY: bool = N <= MOST_STEADY_MODES;
}

impl<const L: usize, const N: usize, const R: usize> Coefficients<L, N, R> {
    /// Lines the constants of `L` simulations up. Modes and columns that a simulation has not got are 0.
    pub(super) fn new(prepared: &[Prepared; L]) -> Self {
        let modes = |of: &dyn Fn(&Prepared) -> &[f64]| items(&|l, n| at(of(&prepared[l]), n));
        let column = |r: usize, l: usize| prepared[l].columns.get(r);
        Self {
            keep: modes(&|prepared| &prepared.keep),
            restore: modes(&|prepared| &prepared.restore),
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
    /// * `external` - externals at the first sample
    pub(super) fn first_state(
        &self,
        first: &[FirstState; L],
        external: [Lanes<L>; EXTERNALS],
    ) -> State<L, N, R> {
        let displacement = items(&|l, n| at(&first[l].displacement, n));
        let scaled_velocity = items(&|l, n| at(&first[l].scaled_velocity, n));
        let force = items(&|l, r| at(&first[l].force, r));
        let predicted = |l: usize, r: usize| {
            let mut predicted = self.static_deflection[r].0[l];
            for n in 0..N {
                let share: f64 = (0..R).map(|s| self.push[s][n].0[l] * force[s].0[l]).sum();
                predicted += self.prediction.of_displacement[r][n].0[l] * (displacement[n].0[l] - share);
                predicted += self.prediction.of_velocity[r][n].0[l] * (scaled_velocity[n].0[l] - share);
            }
            predicted
        };
        State {
            predicted: items(&predicted),
            displacement,
            scaled_velocity,
            force,
            external,
            touching: [0; L],
        }
    }

    /// Whether the motion of lane `l` is bounded.
    pub(super) fn is_sound(&self, state: &State<L, N, R>, l: usize) -> bool {
        state.displacement.iter().chain(&state.scaled_velocity).all(|mode| is_bounded(mode.0[l]))
    }

    /// Makes a step.
    ///
    /// The step without the mesh's new force comes first; the deflection that it leads to is known but for the last step's force
    /// ([`Prediction`]), so that the law can begin. Its force is then added to every mode.
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
        let (mut change, mut displacement, mut scaled_velocity) = ([zero; N], [zero; N], [zero; N]);
        for n in 0..N {
            change[n] = self.keep[n].mul(simd, state.scaled_velocity[n]);
            change[n] = self.restore[n].negative_mul_add(simd, state.displacement[n], change[n]);
            for r in 0..R {
                change[n] = self.push[r][n].mul_add(simd, state.force[r], change[n]);
            }
            if !State::<L, N, R>::STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, external[x]);
                    change[n] = self.external_push[x][n].mul_add(simd, both, change[n]);
                }
            }
            displacement[n] = state.displacement[n].add(simd, change[n]);
        }
        for n in 0..N {
            scaled_velocity[n] = change[n].sub(simd, state.scaled_velocity[n]);
        }
        let predicted = self.predict(simd, &displacement, &scaled_velocity);
        let deflection = self.free_deflection(simd, state, external);
        let force = law.force(simd, &deflection, &self.compliance, pairs, &mut state.touching);
        for n in 0..N {
            for r in 0..R {
                change[n] = self.push[r][n].mul_add(simd, force[r], change[n]);
            }
            state.displacement[n] = state.displacement[n].add(simd, change[n]);
            state.scaled_velocity[n] = change[n].sub(simd, state.scaled_velocity[n]);
        }
        state.force = force;
        state.predicted = predicted;
        if !State::<L, N, R>::STEADY {
            state.external = *external;
        }
    }

    /// What [`Prediction`] makes of a state without its own force's share.
    #[inline(always)]
    fn predict<I: Instructions>(
        &self,
        simd: I,
        displacement: &[Lanes<L>; N],
        scaled_velocity: &[Lanes<L>; N],
    ) -> [Lanes<L>; R] {
        let mut predicted = self.static_deflection;
        for r in 0..R {
            predicted[r] = dot(simd, predicted[r], &self.prediction.of_displacement[r], displacement);
            predicted[r] = dot(simd, predicted[r], &self.prediction.of_velocity[r], scaled_velocity);
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
            if !State::<L, N, R>::STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, external[x]);
                    deflection[r] = self.prediction.of_external[r][x].mul_add(simd, both, deflection[r]);
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
        prepared.each_ref().map(|of| of.half_step_s),
    )
}

/// How large a machine a step is compiled for, the smaller sizes first. Fixed sizes let the compiler unroll the step and keep it in
/// registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Size {
    /// The load acts midway along the face: 8 modes.
    Flat,
    /// The load moves along the face and tilts the wheels: 12 modes.
    Tilting,
    /// Any motion of motor and brake, or any initial velocity: 17 modes.
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
