//! The linear law: `f = Σ k_n (δ_n + e_n)` over the pairs on their path of contact. Pairs push and pull.
//!
//! Stiffness and deviations are known functions of the motor's angle, so a step is linear and solved at once.

use super::table::solve;
use super::{MeshLaw, MeshTable, TabulatedSample, Trial};
use crate::simd::{Instructions, Lanes};

/// Linear meshes side by side.
pub(crate) struct LinearLaw<'a, const L: usize, const R: usize> {
    /// The mesh of each simulation.
    pub(crate) tables: [&'a MeshTable<R>; L],
}

impl<const L: usize, const R: usize> MeshLaw<L, R> for LinearLaw<'_, L, R> {
    type Sample = TabulatedSample<L, R>;

    #[inline(always)]
    fn force<I: Instructions, T: Trial<I, L, R>>(
        &self,
        simd: I,
        trial: &T,
        sample: &TabulatedSample<L, R>,
        entries: &mut [usize; L],
    ) -> [Lanes<L>; R] {
        for l in 0..L {
            // A lane that has ended keeps stepping, without a mesh of its own to step over.
            entries[l] = (sample.entries[l] as usize).min(self.tables[l].points.len() - 1);
        }
        solve(simd, &self.tables, entries, &sample.errors, trial.deflection())
    }
}
