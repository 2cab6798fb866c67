//! One step of Newmark's method (γ = ½, β = ¼), for several simulations side by side.
//!
//! Each mode obeys `q̈ + 2ζω q̇ + ω² q = p`, with `p = B w + external` the modal force. Over a step of `2h`, with
//! `E = 1/(1 + 2ζω h + ω² h²)` and `s = h q̇`, the method reads
//! `S = 2E s₀ − 2h²ω²E q₀ + h²E (p₀ + p₁)`, `q₁ = q₀ + S`, `s₁ = S − s₀`. It is implicit only through the mesh's
//! force `w₁`, which has as many components as the mesh has directions and is found by its law: [`MeshLaw`].
//!
//! `q` is taken relative to the rigid rotation at the nominal speed, in which the mesh does not deflect, and to the
//! displacement under the constant loads.
//!
//! Source: N. M. Newmark, "A method of computation for structural dynamics", Journal of the Engineering Mechanics
//! Division 85 (1959).

use super::outputs::EXTERNALS;
use crate::mesh::law::{MeshLaw, Trial};
use crate::simd::{Instructions, Lanes, dot};

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
    /// Published energy norm: parts of the rigid rotation and of the modes.
    pub(super) norm: Norm<L, N>,
    /// The deflection at a step's end from the state at its start, under a law whose force depends on the deflection's speed.
    pub(super) ahead: Ahead<L, N, R>,
}

/// What the deflection at the end of a step, with its damping's lead ℓ = 1 + τ/h, is without the step's own force.
///
/// With the step's change S it is `D = B·(q₀ + ℓ S − (ℓ − 1) s₀)`, hence a sum over the modes of the state before. That state but
/// for its own force's share is known a step earlier. So the sum over the modes is made while that force is sought, and when it is
/// found only its product with one number is left: without that a step of a single simulation waits most of its time.
pub(super) struct Ahead<const L: usize, const N: usize, const R: usize> {
    /// `B (1 − 2ℓh²ω²E)`.
    pub(super) displacement: [[Lanes<L>; N]; R],
    /// `B (2ℓE − ℓ + 1)`.
    pub(super) scaled_velocity: [[Lanes<L>; N]; R],
    /// (m/N) Per force at the step's start: its share in the state there, and `ℓ Γ`.
    pub(super) force: [[Lanes<L>; R]; R],
    /// Per sum of an external at both ends of the step.
    pub(super) external: [[Lanes<L>; EXTERNALS]; R],
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
    /// (m) What [`Ahead`] makes of the state without its own force's share, where the law needs it.
    pub(super) ahead: [Lanes<L>; R],
    /// Entry of the mesh's table that the state belongs to.
    pub(super) entry: [usize; L],
}

/// Points of the cycle, counted from the start of the simulation: about 10⁷ revolutions.
const MOST_POINTS: f64 = (1u64 << 40) as f64;

/// What forces a step at its end.
pub(super) struct StepForcing<'a, S, const L: usize> {
    /// What the law takes.
    pub(super) sample: &'a S,
    /// Motor lead, torque deviation and speed deviation; not read while motor and brake are steady.
    pub(super) external: &'a [Lanes<L>; EXTERNALS],
}

impl<const L: usize, const N: usize, const R: usize> Coefficients<L, N, R> {
    /// Whether lane `l` is still a motion: every mode a number, and an angle of which the point of the cycle can be told.
    pub(super) fn is_sound(&self, state: &State<L, N, R>, l: usize) -> bool {
        let angle: f64 = (0..N).map(|n| self.angle[n].0[l] * state.displacement[n].0[l]).sum();
        let modes = state.displacement.iter().chain(&state.scaled_velocity);
        angle.abs() < MOST_POINTS && modes.map(|mode| mode.0[l]).all(f64::is_finite)
    }

    #[inline(always)]
    fn deflection<I: Instructions>(&self, simd: I, displacement: &[Lanes<L>; N]) -> [Lanes<L>; R] {
        let mut deflection = self.static_deflection;
        for r in 0..R {
            deflection[r] = dot(simd, deflection[r], &self.mesh[r], displacement);
        }
        deflection
    }

    /// What [`Ahead`] makes of a state without its own force's share.
    #[inline(always)]
    fn look_ahead<I: Instructions>(
        &self,
        simd: I,
        displacement: &[Lanes<L>; N],
        scaled_velocity: &[Lanes<L>; N],
    ) -> [Lanes<L>; R] {
        let mut ahead = self.static_deflection;
        for r in 0..R {
            ahead[r] = dot(simd, ahead[r], &self.ahead.displacement[r], displacement);
            ahead[r] = dot(simd, ahead[r], &self.ahead.scaled_velocity[r], scaled_velocity);
        }
        ahead
    }

    /// The deflection at a step's end, with its damping's lead, without the step's own force.
    #[inline(always)]
    fn led_deflection<I: Instructions, const STEADY: bool>(
        &self,
        simd: I,
        state: &State<L, N, R>,
        external: &[Lanes<L>; EXTERNALS],
    ) -> [Lanes<L>; R] {
        let mut deflection = state.ahead;
        for r in 0..R {
            if !STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, external[x]);
                    deflection[r] = self.ahead.external[r][x].mul_add(simd, both, deflection[r]);
                }
            }
            for s in 0..R {
                deflection[r] = self.ahead.force[r][s].mul_add(simd, state.force[s], deflection[r]);
            }
        }
        deflection
    }

    /// (m) What [`Ahead`] makes of lane `l` of a state at the start.
    pub(super) fn ahead_at_start(
        &self,
        r: usize,
        l: usize,
        [displacement, scaled_velocity]: [&[Lanes<L>; N]; 2],
        force: &[Lanes<L>; R],
    ) -> f64 {
        let Ahead { displacement: of_displacement, scaled_velocity: of_velocity, .. } = &self.ahead;
        let mut ahead = self.static_deflection[r].0[l];
        for n in 0..N {
            let share: f64 = (0..R).map(|s| self.push[s][n].0[l] * force[s].0[l]).sum();
            ahead += of_displacement[r][n].0[l] * (displacement[n].0[l] - share);
            ahead += of_velocity[r][n].0[l] * (scaled_velocity[n].0[l] - share);
        }
        ahead
    }

    /// Makes a step.
    ///
    /// # Arguments
    /// * `law` - the mesh
    /// * `state` - moves on by one sample
    /// * `step` - number of the step, 1 from the first sample to the next
    /// * `forcing` - after it
    #[inline(always)]
    pub(super) fn step<I: Instructions, M: MeshLaw<L, R>, const STEADY: bool>(
        &self,
        simd: I,
        law: &M,
        state: &mut State<L, N, R>,
        step: usize,
        forcing: &StepForcing<M::Sample, L>,
    ) {
        let mut change = [Lanes::splat(0.0); N];
        let mut displacement = [Lanes::splat(0.0); N];
        for n in 0..N {
            change[n] = self.keep[n].mul(simd, state.scaled_velocity[n]);
            change[n] = self.restore[n].negative_mul_add(simd, state.displacement[n], change[n]);
            for r in 0..R {
                change[n] = self.push[r][n].mul_add(simd, state.force[r], change[n]);
            }
            if !STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, forcing.external[x]);
                    change[n] = self.external_push[x][n].mul_add(simd, both, change[n]);
                }
            }
            displacement[n] = state.displacement[n].add(simd, change[n]);
        }
        let mut ahead = state.ahead;
        let deflection = if M::LEADS {
            let mut scaled_velocity = [Lanes::splat(0.0); N];
            for n in 0..N {
                scaled_velocity[n] = change[n].sub(simd, state.scaled_velocity[n]);
            }
            ahead = self.look_ahead(simd, &displacement, &scaled_velocity);
            self.led_deflection::<I, STEADY>(simd, state, forcing.external)
        } else {
            self.deflection(simd, &displacement)
        };
        let rotation = self.start.add(simd, Lanes::splat(step as f64)).mul(simd, self.points_per_sample);
        let mut entry = state.entry;
        let trial = ModalTrial::<L, N, R, STEADY> {
            coefficients: self,
            state,
            external: forcing.external,
            deflection,
            angle: rotation.add(simd, dot(simd, self.static_angle, &self.angle, &displacement)),
            change: &change,
        };
        let force = law.force(simd, &trial, forcing.sample, &mut entry);

        for n in 0..N {
            for r in 0..R {
                change[n] = self.push[r][n].mul_add(simd, force[r], change[n]);
            }
            state.displacement[n] = state.displacement[n].add(simd, change[n]);
            state.scaled_velocity[n] = change[n].sub(simd, state.scaled_velocity[n]);
        }
        state.force = force;
        state.ahead = ahead;
        state.entry = entry;
        if !STEADY {
            state.external = *forcing.external;
        }
    }
}

/// A step before the new mesh force is known.
struct ModalTrial<'a, const L: usize, const N: usize, const R: usize, const STEADY: bool> {
    coefficients: &'a Coefficients<L, N, R>,
    /// The state at its start.
    state: &'a State<L, N, R>,
    /// Externals at its end.
    external: &'a [Lanes<L>; EXTERNALS],
    /// Change of the displacements.
    change: &'a [Lanes<L>; N],
    /// Deflection in the mesh's directions after it.
    deflection: [Lanes<L>; R],
    /// Angle of the pinion after it, in points of the cycle.
    angle: Lanes<L>,
}

impl<I: Instructions, const L: usize, const N: usize, const R: usize, const STEADY: bool> Trial<I, L, R>
    for ModalTrial<'_, L, N, R, STEADY>
{
    type RightHandSide = [Lanes<L>; N];

    #[inline(always)]
    fn deflection(&self) -> &[Lanes<L>; R] {
        &self.deflection
    }

    #[inline(always)]
    fn deflection_before(&self, simd: I) -> [Lanes<L>; R] {
        self.coefficients.deflection(simd, &self.state.displacement)
    }

    #[inline(always)]
    fn compliance(&self) -> &[[Lanes<L>; R]; R] {
        &self.coefficients.compliance
    }

    #[inline(always)]
    fn angle(&self, simd: I, force: &[Lanes<L>; R]) -> Lanes<L> {
        let mut angle = self.angle;
        for r in 0..R {
            angle = self.coefficients.angle_push[r].mul_add(simd, force[r], angle);
        }
        angle
    }

    /// The published right-hand side `ΔF + (M/(β dt) + (γ/β) C) u̇ + M/(2β) ü`, in the modes.
    #[inline(always)]
    fn right_hand_side(&self, simd: I, held: &[Lanes<L>; R]) -> [Lanes<L>; N] {
        let (c, state) = (self.coefficients, self.state);
        let mut result = c.norm.rigid_increment;
        for n in 0..N {
            result[n] = c.norm.two_per_h2.mul_add(simd, state.scaled_velocity[n], result[n]);
            result[n] = c.norm.twice_stiffness[n].negative_mul_add(simd, state.displacement[n], result[n]);
            for r in 0..R {
                result[n] = c.mesh[r][n].mul_add(simd, held[r].add(simd, state.force[r]), result[n]);
            }
            if !STEADY {
                for x in 0..EXTERNALS {
                    let both = state.external[x].add(simd, self.external[x]);
                    result[n] = c.norm.external[x][n].mul_add(simd, both, result[n]);
                }
            }
        }
        result
    }

    #[inline(always)]
    fn work(&self, simd: I, right_hand_side: &[Lanes<L>; N], force: &[Lanes<L>; R]) -> Lanes<L> {
        let c = self.coefficients;
        let mut whole = Lanes::splat(0.0);
        for n in 0..N {
            let mut displacement = self.change[n].add(simd, c.norm.rigid_displacement[n]);
            for r in 0..R {
                displacement = c.push[r][n].mul_add(simd, force[r], displacement);
            }
            whole = right_hand_side[n].mul_add(simd, displacement, whole);
        }
        whole
    }
}
