//! The published law: the linear one, at the angle that the pinion itself has, which the step's result decides.
//!
//! Source: the paper's section 4, item 3 (Newton and Raphson's iteration on the angle-dependent stiffness).

use super::table::solve;
use super::{MeshLaw, MeshTable, TabulatedSample, Trial};
use crate::simd::{Instructions, Lanes};

/// Most iterations of a step.
const MOST_ITERATIONS: usize = 11;
/// Energy norm at which the iteration stops.
const TOLERANCE: f64 = 1e-5;

/// How a table's entries follow one another over the cycle: the points while the fault is in contact, then one pitch of the
/// healthy mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PublishedCycle {
    /// Number of points while the fault is in contact.
    pub(crate) window: usize,
    /// Number of points from one tooth to the next.
    pub(crate) pitch: usize,
    /// Number of points in a gear revolution.
    pub(crate) cycle: usize,
}

impl PublishedCycle {
    /// Entry of the point that is `angle` rounded down, counted from the start of the simulation.
    pub(crate) fn entry(&self, angle: f64) -> usize {
        let in_cycle = (angle.floor() as i64).rem_euclid(self.cycle as i64) as usize;
        if in_cycle < self.window { in_cycle } else { self.window + in_cycle % self.pitch }
    }
}

/// Published meshes side by side.
pub(crate) struct PublishedLaw<'a, const L: usize, const R: usize> {
    tables: [&'a MeshTable<R>; L],
    cycle: Lanes<L>,
    per_cycle: Lanes<L>,
    pitch: Lanes<L>,
    per_pitch: Lanes<L>,
    window: Lanes<L>,
}

impl<'a, const L: usize, const R: usize> PublishedLaw<'a, L, R> {
    /// Lines the meshes of `L` simulations up.
    pub(crate) fn new(tables: [&'a MeshTable<R>; L], cycles: [PublishedCycle; L]) -> Self {
        Self {
            tables,
            cycle: Lanes::from_fn(|l| cycles[l].cycle as f64),
            per_cycle: Lanes::from_fn(|l| 1.0 / cycles[l].cycle as f64),
            pitch: Lanes::from_fn(|l| cycles[l].pitch as f64),
            per_pitch: Lanes::from_fn(|l| 1.0 / cycles[l].pitch as f64),
            window: Lanes::from_fn(|l| cycles[l].window as f64),
        }
    }

    /// Entries of the tables at `angle`, in points of the cycle plus a half, counted from the start of the simulation.
    #[inline(always)]
    fn entries<I: Instructions>(&self, simd: I, angle: Lanes<L>) -> [usize; L] {
        let nearest = angle.floor(simd);
        let half = Lanes::splat(0.5);
        // The half keeps a whole number of cycles from being rounded into the cycle before.
        let cycles = nearest.add(simd, half).mul(simd, self.per_cycle).floor(simd);
        let in_cycle = cycles.negative_mul_add(simd, self.cycle, nearest);
        let pitches = in_cycle.add(simd, half).mul(simd, self.per_pitch).floor(simd);
        let in_pitch = pitches.negative_mul_add(simd, self.pitch, in_cycle).add(simd, self.window);
        let mut entries = in_cycle.where_less(simd, in_cycle, self.window, in_pitch).indices(simd);
        for l in 0..L {
            // The angle of a solution that has diverged has no entry.
            entries[l] = entries[l].min(self.tables[l].points.len() - 1);
        }
        entries
    }

    /// The mesh's force that is in equilibrium with a deflection at some entries.
    #[inline(always)]
    fn force_of_deflection<I: Instructions>(
        &self,
        simd: I,
        deflection: &[Lanes<L>; R],
        entries: &[usize; L],
        errors: &[Lanes<L>; R],
    ) -> [Lanes<L>; R] {
        let mut force = [Lanes::splat(0.0); R];
        for r in 0..R {
            force[r] = errors[r].neg(simd);
            for c in 0..R {
                let deviation = Lanes::from_fn(|l| self.tables[l].points[entries[l]].deviation[r][c]);
                force[r] = deviation.negative_mul_add(simd, deflection[c], force[r]);
            }
        }
        force
    }

    /// `r·ΔP` of the change from mesh force `before` to `after`, solved at `entries`: with `Δw` that change,
    /// `Δwᵀ Γ Δw + (Γ Δw)ᵀ S' (Γ Δw)`.
    #[inline(always)]
    fn work_of_change<I: Instructions>(
        &self,
        simd: I,
        compliance: &[[Lanes<L>; R]; R],
        entries: &[usize; L],
        before: &[Lanes<L>; R],
        after: &[Lanes<L>; R],
    ) -> Lanes<L> {
        let mut moved = [Lanes::splat(0.0); R];
        for r in 0..R {
            for s in 0..R {
                moved[r] = compliance[r][s].mul_add(simd, after[s].sub(simd, before[s]), moved[r]);
            }
        }
        let mut work = Lanes::splat(0.0);
        for r in 0..R {
            let mut load = after[r].sub(simd, before[r]);
            for s in 0..R {
                let deviation = Lanes::from_fn(|l| self.tables[l].points[entries[l]].deviation[r][s]);
                load = deviation.mul_add(simd, moved[s], load);
            }
            work = load.mul_add(simd, moved[r], work);
        }
        work
    }
}

impl<const L: usize, const R: usize> MeshLaw<L, R> for PublishedLaw<'_, L, R> {
    type Sample = TabulatedSample<L, R>;

    /// From the point of the state before, until the change's energy norm `|r·ΔP/(ΔF̂·P)|` is small.
    #[inline(always)]
    fn force<I: Instructions, T: Trial<I, L, R>>(
        &self,
        simd: I,
        trial: &T,
        sample: &TabulatedSample<L, R>,
        entries: &mut [usize; L],
    ) -> [Lanes<L>; R] {
        let errors = &sample.errors;
        let held = self.force_of_deflection(simd, &trial.deflection_before(simd), entries, errors);
        let right_hand_side = trial.right_hand_side(simd, &held);
        let deflection = trial.deflection();
        let mut force = solve(simd, &self.tables, entries, errors, deflection);
        let mut at = self.entries(simd, trial.angle(simd, &force));
        let mut running = [true; L];
        for _ in 1..MOST_ITERATIONS {
            let next = solve(simd, &self.tables, &at, errors, deflection);
            let work = self.work_of_change(simd, trial.compliance(), &at, &force, &next);
            let whole = trial.work(simd, &right_hand_side, &next);
            let next_entries = self.entries(simd, trial.angle(simd, &next));
            let mut any = false;
            for l in 0..L {
                if running[l] {
                    for r in 0..R {
                        force[r].0[l] = next[r].0[l];
                    }
                    at[l] = next_entries[l];
                    running[l] = (work.0[l] / whole.0[l]).abs() > TOLERANCE;
                    any |= running[l];
                }
            }
            if !any {
                break;
            }
        }
        *entries = at;
        force
    }
}
