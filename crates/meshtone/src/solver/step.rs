//! One step of Newmark's method (γ = ½, β = ¼), for several simulations side by side.
//!
//! Each mode obeys `q̈ + 2ζω q̇ + ω² q = p`, with `p = B w + external` the modal force. Over a step of `2h`, with
//! `E = 1/(1 + 2ζω h + ω² h²)` and `s = h q̇`, the method reads
//! `S = 2E s₀ − 2h²ω²E q₀ + h²E (p₀ + p₁)`, `q₁ = q₀ + S`, `s₁ = S − s₀`. It is implicit only through the mesh's
//! force `w₁`, which has as many components as the mesh has directions: [`Group::solve`].
//!
//! `q` is taken relative to the rigid rotation at the nominal speed, in which the mesh does not deflect, and to the
//! displacement under the constant loads.
//!
//! Source: N. M. Newmark, "A method of computation for structural dynamics", Journal of the Engineering Mechanics
//! Division 85 (1959); the iteration on the angle-dependent stiffness is the paper's (section 4, item 3).

use super::cycle_table::{CyclePoint, DEVIATION, RELIEF};
use super::instruction_set::Instructions;
use super::lanes::{Lanes, dot};
use super::outputs::EXTERNALS;

/// Most iterations of a step.
const MOST_ITERATIONS: usize = 11;
/// Energy norm at which the published iteration stops.
const PUBLISHED_TOLERANCE: f64 = 1e-5;

/// Constants of one simulation (`L` = 1) or of several side by side.
///
/// Aligned so that eight numbers side by side never straddle two cache lines; likewise [`State`].
#[repr(align(64))]
pub(super) struct Coefficients<const L: usize, const N: usize, const R: usize> {
    /// (-) `2E`.
    pub(super) keep: [Lanes<L>; N],
    /// (-) `2 h² ω² E`.
    pub(super) restore: [Lanes<L>; N],
    /// (s²…) `h² E B`.
    pub(super) push: [[Lanes<L>; N]; R],
    /// `h² E` times the modal force of each external.
    pub(super) external_push: [[Lanes<L>; N]; EXTERNALS],
    /// `B`.
    pub(super) mesh: [[Lanes<L>; N]; R],
    /// Angle of the pinion in coarse points of the cycle, per modal displacement.
    pub(super) angle: [Lanes<L>; N],
    /// Angle per mesh force of the step.
    pub(super) angle_push: [Lanes<L>; R],
    /// Γ: deflection in each direction per mesh force of the step.
    pub(super) compliance: [[Lanes<L>; R]; R],
    /// Deflection under the constant loads.
    pub(super) static_deflection: [Lanes<L>; R],
    /// Angle under the constant loads, plus the half point that makes rounding down the nearest.
    pub(super) static_angle: Lanes<L>,
    /// Number of the sample at which the integration starts.
    pub(super) start: Lanes<L>,
    /// Coarse points of the cycle per sample, at the nominal speed.
    pub(super) points_per_sample: Lanes<L>,
    pub(super) cycle: Lanes<L>,
    pub(super) per_cycle: Lanes<L>,
    pub(super) pitch: Lanes<L>,
    pub(super) per_pitch: Lanes<L>,
    pub(super) window: Lanes<L>,
    /// Published energy norm: parts of the rigid rotation and of the modes.
    pub(super) norm: Norm<L, N>,
}

/// What the published energy norm needs.
pub(super) struct Norm<const L: usize, const N: usize> {
    /// The rigid rotation's modal displacement in a step.
    pub(super) rigid_displacement: [Lanes<L>; N],
    /// Its part of the right-hand side.
    pub(super) rigid_increment: [Lanes<L>; N],
    /// Modal force of each external.
    pub(super) external: [[Lanes<L>; N]; EXTERNALS],
    /// (1/s²) `2ω²`.
    pub(super) twice_stiffness: [Lanes<L>; N],
    /// (1/s²) `2/h²`.
    pub(super) two_per_h2: Lanes<L>,
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
    /// Angle of the pinion relative to the rigid rotation, in coarse points, plus a half.
    pub(super) angle: Lanes<L>,
    /// The angles one and two samples before, from which the next is guessed.
    pub(super) angles_before: [Lanes<L>; 2],
    /// Entry of the cycle table that the state belongs to.
    pub(super) entry: [usize; L],
}

impl<const L: usize, const N: usize, const R: usize> State<L, N, R> {
    /// Whether lane `l` is still a motion: every mode a number, and an angle of which the point of the cycle can be told.
    pub(super) fn is_sound(&self, l: usize) -> bool {
        let modes = self.displacement.iter().chain(&self.scaled_velocity);
        self.angle.0[l].abs() < MOST_POINTS && modes.map(|mode| mode.0[l]).all(f64::is_finite)
    }
}

/// What a step leads to before the new mesh force is known.
struct Trial<const L: usize, const N: usize, const R: usize> {
    /// Change of the displacements.
    change: [Lanes<L>; N],
    /// Deflection in the mesh's directions after it.
    deflection: [Lanes<L>; R],
    /// Angle of the wheel that leads the cycle after it, in points, without the steady rotation.
    angle: Lanes<L>,
    /// Steady rotation at the step's end, in points.
    rotation: Lanes<L>,
}

/// Coarse points of the cycle, counted from the start of the simulation: about 10⁷ revolutions.
const MOST_POINTS: f64 = (1u64 << 40) as f64;

/// Simulations that are stepped side by side.
pub(super) struct Group<'a, const L: usize, const N: usize, const R: usize> {
    pub(super) coefficients: Coefficients<L, N, R>,
    /// The mesh over the cycle, of each lane.
    pub(super) tables: [&'a [CyclePoint<R>]; L],
}

impl<const L: usize, const N: usize, const R: usize> Group<'_, L, N, R> {
    /// Entries of the cycle tables at `angle`, in coarse points plus a half.
    #[inline(always)]
    pub(super) fn entries<I: Instructions>(&self, simd: I, angle: Lanes<L>) -> [usize; L] {
        self.entries_of(simd, angle.floor(simd))
    }

    /// Entries of the cycle tables at the point `nearest`, counted from the start of the simulation.
    #[inline(always)]
    fn entries_of<I: Instructions>(&self, simd: I, nearest: Lanes<L>) -> [usize; L] {
        let c = &self.coefficients;
        let half = Lanes::splat(0.5);
        // The half keeps a whole number of cycles from being rounded into the cycle before.
        let cycles = nearest.add(simd, half).mul(simd, c.per_cycle).floor(simd);
        let in_cycle = cycles.negative_mul_add(simd, c.cycle, nearest);
        let pitches = in_cycle.add(simd, half).mul(simd, c.per_pitch).floor(simd);
        let in_pitch = pitches.negative_mul_add(simd, c.pitch, in_cycle).add(simd, c.window);
        let mut entries = in_cycle.where_less(simd, in_cycle, c.window, in_pitch).indices(simd);
        for l in 0..L {
            // The angle of a solution that has diverged has no entry.
            entries[l] = entries[l].min(self.tables[l].len() - 1);
        }
        entries
    }

    /// `w = −(1 + S' Γ)⁻¹ (f + S' ŷ)`: the mesh force at the end of a step whose deflection is ŷ without it.
    #[inline(always)]
    pub(super) fn solve<I: Instructions>(
        &self,
        simd: I,
        entries: &[usize; L],
        errors: &[Lanes<L>; R],
        deflection: &[Lanes<L>; R],
    ) -> [Lanes<L>; R] {
        let mut load = *errors;
        for r in 0..R {
            for c in 0..R {
                let deviation = Lanes::from_fn(|l| self.tables[l][entries[l]][DEVIATION][r][c]);
                load[r] = deviation.mul_add(simd, deflection[c], load[r]);
            }
        }
        let mut force = [Lanes::splat(0.0); R];
        for r in 0..R {
            for c in 0..R {
                let relief = Lanes::from_fn(|l| self.tables[l][entries[l]][RELIEF][r][c]);
                force[r] = relief.negative_mul_add(simd, load[c], force[r]);
            }
        }
        force
    }

    /// The mesh force that is in equilibrium with a state's displacement at its entry.
    #[inline(always)]
    fn force_of_state<I: Instructions>(
        &self,
        simd: I,
        displacement: &[Lanes<L>; N],
        entries: &[usize; L],
        errors: &[Lanes<L>; R],
    ) -> [Lanes<L>; R] {
        let mut force = [Lanes::splat(0.0); R];
        let deflection = self.deflection(simd, displacement);
        for r in 0..R {
            force[r] = errors[r].neg(simd);
            for c in 0..R {
                let deviation = Lanes::from_fn(|l| self.tables[l][entries[l]][DEVIATION][r][c]);
                force[r] = deviation.negative_mul_add(simd, deflection[c], force[r]);
            }
        }
        force
    }

    #[inline(always)]
    fn deflection<I: Instructions>(&self, simd: I, displacement: &[Lanes<L>; N]) -> [Lanes<L>; R] {
        let mut deflection = self.coefficients.static_deflection;
        for r in 0..R {
            deflection[r] = dot(simd, deflection[r], &self.coefficients.mesh[r], displacement);
        }
        deflection
    }

    #[inline(always)]
    fn angle_with<I: Instructions>(&self, simd: I, base: Lanes<L>, force: &[Lanes<L>; R]) -> Lanes<L> {
        let mut angle = base;
        for r in 0..R {
            angle = self.coefficients.angle_push[r].mul_add(simd, force[r], angle);
        }
        angle
    }

    /// Makes a step.
    ///
    /// # Arguments
    /// * `state` - moves on by one sample
    /// * `step` - number of the step, 1 from the first sample to the next
    /// * `errors` - force of the profile errors after it, in the mesh's directions
    /// * `external` - motor lead, torque deviation and speed deviation after it; not read when `STEADY`
    #[inline(always)]
    pub(super) fn step<I: Instructions, const PUBLISHED: bool, const STEADY: bool>(
        &self,
        simd: I,
        state: &mut State<L, N, R>,
        step: usize,
        errors: &[Lanes<L>; R],
        external: &[Lanes<L>; EXTERNALS],
    ) {
        let c = &self.coefficients;
        let mut change = [Lanes::splat(0.0); N];
        let mut displacement = [Lanes::splat(0.0); N];
        for n in 0..N {
            change[n] = c.keep[n].mul(simd, state.scaled_velocity[n]);
            change[n] = c.restore[n].negative_mul_add(simd, state.displacement[n], change[n]);
            for r in 0..R {
                change[n] = c.push[r][n].mul_add(simd, state.force[r], change[n]);
            }
            if !STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, external[x]);
                    change[n] = c.external_push[x][n].mul_add(simd, both, change[n]);
                }
            }
            displacement[n] = state.displacement[n].add(simd, change[n]);
        }
        let trial = Trial {
            change,
            deflection: self.deflection(simd, &displacement),
            angle: dot(simd, c.static_angle, &c.angle, &displacement),
            rotation: c.start.add(simd, Lanes::splat(step as f64)).mul(simd, c.points_per_sample),
        };
        let force = if PUBLISHED {
            self.published_force::<I, STEADY>(simd, state, &trial, errors, external)
        } else {
            self.corrected_force(simd, state, &trial, errors)
        };

        for n in 0..N {
            for r in 0..R {
                change[n] = c.push[r][n].mul_add(simd, force[r], change[n]);
            }
            state.displacement[n] = state.displacement[n].add(simd, change[n]);
            state.scaled_velocity[n] = change[n].sub(simd, state.scaled_velocity[n]);
        }
        state.force = force;
        state.angles_before = [state.angle, state.angles_before[0]];
        state.angle = self.angle_with(simd, trial.angle, &force);
        if !STEADY {
            state.external = *external;
        }
    }

    /// Solves for a point of the cycle, until the solution leads to that point.
    ///
    /// The first point is guessed from the angles before the last: the table can then be read while the last step's result
    /// is still being computed, and the guess fails only where the angle crosses from one point to the next.
    #[inline(always)]
    fn corrected_force<I: Instructions>(
        &self,
        simd: I,
        state: &mut State<L, N, R>,
        trial: &Trial<L, N, R>,
        errors: &[Lanes<L>; R],
    ) -> [Lanes<L>; R] {
        let &Trial { ref deflection, angle, rotation, .. } = trial;
        let [before, two_before] = state.angles_before;
        let guess = before.sub(simd, two_before).mul_add(simd, Lanes::splat(2.0), before);
        let mut point = rotation.add(simd, guess).floor(simd);
        let mut entries = self.entries_of(simd, point);
        let mut force = self.solve(simd, &entries, errors, deflection);
        for _ in 0..MOST_ITERATIONS {
            let next = rotation.add(simd, self.angle_with(simd, angle, &force)).floor(simd);
            if next.equals(simd, point) {
                break;
            }
            // A lane whose point does not change solves the same problem again, with the same result.
            point = next;
            entries = self.entries_of(simd, point);
            force = self.solve(simd, &entries, errors, deflection);
        }
        state.entry = entries;
        force
    }

    /// The published iteration: from the point of the state before, until the change's energy norm is small.
    #[inline(always)]
    fn published_force<I: Instructions, const STEADY: bool>(
        &self,
        simd: I,
        state: &mut State<L, N, R>,
        trial: &Trial<L, N, R>,
        errors: &[Lanes<L>; R],
        external: &[Lanes<L>; EXTERNALS],
    ) -> [Lanes<L>; R] {
        let Trial { change, deflection, .. } = trial;
        let angle = trial.rotation.add(simd, trial.angle);
        let right_hand_side = self.right_hand_side::<I, STEADY>(simd, state, errors, external);
        let mut force = self.solve(simd, &state.entry, errors, deflection);
        let mut entries = self.entries(simd, self.angle_with(simd, angle, &force));
        let mut running = [true; L];
        for _ in 1..MOST_ITERATIONS {
            let next = self.solve(simd, &entries, errors, deflection);
            let error = self.energy_norm(simd, &entries, change, &right_hand_side, &force, &next);
            let next_entries = self.entries(simd, self.angle_with(simd, angle, &next));
            let mut any = false;
            for l in 0..L {
                if running[l] {
                    for r in 0..R {
                        force[r].0[l] = next[r].0[l];
                    }
                    entries[l] = next_entries[l];
                    running[l] = error.0[l] > PUBLISHED_TOLERANCE;
                    any |= running[l];
                }
            }
            if !any {
                break;
            }
        }
        state.entry = entries;
        force
    }

    /// The published right-hand side `ΔF + (M/(β dt) + (γ/β) C) u̇ + M/(2β) ü`, in the modes.
    #[inline(always)]
    fn right_hand_side<I: Instructions, const STEADY: bool>(
        &self,
        simd: I,
        state: &State<L, N, R>,
        errors: &[Lanes<L>; R],
        external: &[Lanes<L>; EXTERNALS],
    ) -> [Lanes<L>; N] {
        let c = &self.coefficients;
        let held = self.force_of_state(simd, &state.displacement, &state.entry, errors);
        let mut result = c.norm.rigid_increment;
        for n in 0..N {
            result[n] = c.norm.two_per_h2.mul_add(simd, state.scaled_velocity[n], result[n]);
            result[n] = c.norm.twice_stiffness[n].negative_mul_add(simd, state.displacement[n], result[n]);
            for r in 0..R {
                result[n] = c.mesh[r][n].mul_add(simd, held[r].add(simd, state.force[r]), result[n]);
            }
            if !STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, external[x]);
                    result[n] = c.norm.external[x][n].mul_add(simd, both, result[n]);
                }
            }
        }
        result
    }

    /// `|r·ΔP/(ΔF̂·P)|` of the change from mesh force `before` to `after`, solved at `entries`: with `Δw` that change,
    /// `r·ΔP = Δwᵀ Γ Δw + (Γ Δw)ᵀ S' (Γ Δw)`.
    #[inline(always)]
    fn energy_norm<I: Instructions>(
        &self,
        simd: I,
        entries: &[usize; L],
        change: &[Lanes<L>; N],
        right_hand_side: &[Lanes<L>; N],
        before: &[Lanes<L>; R],
        after: &[Lanes<L>; R],
    ) -> Lanes<L> {
        let c = &self.coefficients;
        let mut moved = [Lanes::splat(0.0); R];
        for r in 0..R {
            for s in 0..R {
                moved[r] = c.compliance[r][s].mul_add(simd, after[s].sub(simd, before[s]), moved[r]);
            }
        }
        let mut work = Lanes::splat(0.0);
        for r in 0..R {
            let mut load = after[r].sub(simd, before[r]);
            for s in 0..R {
                let deviation = Lanes::from_fn(|l| self.tables[l][entries[l]][DEVIATION][r][s]);
                load = deviation.mul_add(simd, moved[s], load);
            }
            work = load.mul_add(simd, moved[r], work);
        }
        let mut whole = Lanes::splat(0.0);
        for n in 0..N {
            let mut displacement = change[n].add(simd, c.norm.rigid_displacement[n]);
            for r in 0..R {
                displacement = c.push[r][n].mul_add(simd, after[r], displacement);
            }
            whole = right_hand_side[n].mul_add(simd, displacement, whole);
        }
        Lanes::from_fn(|l| (work.0[l] / whole.0[l]).abs())
    }
}
