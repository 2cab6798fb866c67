//! The forcing of several simulations, side by side.

use super::outputs::EXTERNALS;
use crate::mesh::forcing::{Forcing, ForcingBlock};
use crate::simd::Lanes;

/// Forcing of one block of samples.
pub(super) struct SharedForcing<const L: usize, const R: usize> {
    /// (N) Force of the profile errors in the mesh's directions.
    pub(super) errors: Vec<[Lanes<L>; R]>,
    /// Motor lead, torque deviation and speed deviation; not set while motor and brake are steady.
    pub(super) external: Vec<[Lanes<L>; EXTERNALS]>,
    /// Entries of the mesh's tables, where they are known beforehand.
    pub(super) entries: Vec<[u32; L]>,
    scratch: ForcingBlock,
}

impl<const L: usize, const R: usize> SharedForcing<L, R> {
    /// Room for `samples` samples.
    pub(super) fn new(samples: usize) -> Self {
        Self {
            errors: vec![[Lanes::splat(0.0); R]; samples],
            external: vec![[Lanes::splat(0.0); EXTERNALS]; samples],
            entries: vec![[0; L]; samples],
            scratch: ForcingBlock::default(),
        }
    }

    /// Takes the next `samples` samples of every lane.
    ///
    /// # Arguments
    /// * `forcings` - of each lane
    /// * `samples` - at most as many as there is room for
    /// * `steady` - whether motor and brake of all lanes are steady
    pub(super) fn fill(&mut self, forcings: &mut [Box<dyn Forcing + '_>; L], samples: usize, steady: bool) {
        for (l, forcing) in forcings.iter_mut().enumerate() {
            forcing.next_block(samples, &mut self.scratch);
            for (r, errors) in self.scratch.errors.iter().enumerate() {
                for (shared, error) in self.errors.iter_mut().zip(errors) {
                    shared[r].0[l] = *error;
                }
            }
            for (shared, entry) in self.entries.iter_mut().zip(&self.scratch.entries) {
                shared[l] = *entry;
            }
            if !steady {
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
