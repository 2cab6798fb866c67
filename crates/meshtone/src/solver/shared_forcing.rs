//! The forcing of several simulations, side by side.

use super::outputs::EXTERNALS;
use crate::mesh::forcing::{Forcing, ForcingBlock};
use crate::simd::Lanes;

/// Forcing of one block of samples, as a mesh law takes it.
pub(super) struct SharedForcing<S, const L: usize> {
    /// What the law takes.
    pub(super) samples: Vec<S>,
    /// Motor lead, torque deviation and speed deviation; not set while motor and brake are steady.
    pub(super) external: Vec<[Lanes<L>; EXTERNALS]>,
    /// Lines the blocks of all lanes up.
    line_up: fn(&mut [S], &[ForcingBlock; L]),
    blocks: [ForcingBlock; L],
}

impl<S: Copy, const L: usize> SharedForcing<S, L> {
    /// Room for some samples.
    ///
    /// # Arguments
    /// * `samples` - how many
    /// * `nothing` - a sample without force
    /// * `line_up` - sets the samples from a block of each lane
    pub(super) fn new(samples: usize, nothing: S, line_up: fn(&mut [S], &[ForcingBlock; L])) -> Self {
        Self {
            samples: vec![nothing; samples],
            external: vec![[Lanes::splat(0.0); EXTERNALS]; samples],
            line_up,
            blocks: std::array::from_fn(|_| ForcingBlock::default()),
        }
    }

    /// Takes the next `samples` samples of every lane.
    ///
    /// # Arguments
    /// * `forcings` - of each lane
    /// * `samples` - at most as many as there is room for
    /// * `steady` - whether motor and brake of all lanes are steady
    pub(super) fn fill(&mut self, forcings: &mut [Box<dyn Forcing + '_>; L], samples: usize, steady: bool) {
        for (l, (forcing, block)) in forcings.iter_mut().zip(&mut self.blocks).enumerate() {
            forcing.next_block(samples, block);
            if !steady {
                let parts =
                    [&block.motor_lead_rad, &block.torque_deviation_nm, &block.speed_deviation_rad_per_s];
                for (x, part) in parts.into_iter().enumerate() {
                    for (shared, value) in self.external.iter_mut().zip(part) {
                        shared[x].0[l] = *value;
                    }
                }
            }
        }
        (self.line_up)(&mut self.samples, &self.blocks);
    }
}
