//! The forcing of several simulations, side by side.

use super::lanes::Lanes;
use super::outputs::EXTERNALS;
use crate::dynamics::{Forcing, ForcingBlock};

/// Forcing of one block of samples.
pub(super) struct SharedForcing<const L: usize> {
    /// (N) Force of the profile errors in the mesh's directions, sample by sample.
    errors: Vec<Lanes<L>>,
    /// Number of the mesh's directions.
    directions: usize,
    /// Motor lead, torque deviation and speed deviation; not set while motor and brake are steady.
    pub(super) external: Vec<[Lanes<L>; EXTERNALS]>,
    scratch: ForcingBlock,
}

impl<const L: usize> SharedForcing<L> {
    /// Room for `samples` samples.
    ///
    /// # Arguments
    /// * `samples` - number of samples
    /// * `directions` - number of the mesh's directions
    pub(super) fn new(samples: usize, directions: usize) -> Self {
        Self {
            errors: vec![Lanes::splat(0.0); samples * directions],
            directions,
            external: vec![[Lanes::splat(0.0); EXTERNALS]; samples],
            scratch: ForcingBlock::default(),
        }
    }

    /// Force of the profile errors at every sample, in the `R` directions that there are.
    pub(super) fn errors<const R: usize>(&self) -> &[[Lanes<L>; R]] {
        self.errors.as_chunks().0
    }

    /// Force of the profile errors at the first sample, in each direction, and the externals there.
    ///
    /// # Arguments
    /// * `lane` - which simulation
    pub(super) fn first(&self, lane: usize) -> (Vec<f64>, [f64; EXTERNALS]) {
        let errors = self.errors[..self.directions].iter().map(|error| error.0[lane]);
        (errors.collect(), self.external[0].map(|external| external.0[lane]))
    }

    /// Takes the next `samples` samples of every lane.
    ///
    /// # Arguments
    /// * `forcings` - of each lane
    /// * `samples` - at most as many as there is room for
    /// * `steady` - whether motor and brake of all lanes are steady
    pub(super) fn fill(&mut self, forcings: &mut [Forcing; L], samples: usize, steady: bool) {
        for (l, forcing) in forcings.iter_mut().enumerate() {
            forcing.next_block(samples, &mut self.scratch);
            for (r, errors) in self.scratch.errors.iter().enumerate() {
                for (shared, error) in self.errors.chunks_exact_mut(self.directions).zip(errors) {
                    shared[r].0[l] = *error;
                }
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
