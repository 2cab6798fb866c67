//! The right-hand side in blocks of samples, as fast as the solution.

use super::contact_forcing::PairsBlock;

/// Forcing of successive samples.
#[derive(Debug, Clone, Default)]
pub(crate) struct ForcingBlock {
    /// (N) Force of the flanks' deviations in each of the mesh's directions that the solution uses.
    pub(crate) errors: Vec<Vec<f64>>,
    /// Entries of the mesh's table, where they are known beforehand.
    pub(crate) entries: Vec<u32>,
    /// The pairs, under `contact`.
    pub(crate) pairs: PairsBlock,
    /// (rad) Angle of the motor less that of the rigid rotation at the nominal speed.
    pub(crate) motor_lead_rad: Vec<f64>,
    /// (N m) Torque of the brake less its nominal value.
    pub(crate) torque_deviation_nm: Vec<f64>,
    /// (rad/s) Speed of the motor less the nominal one.
    pub(crate) speed_deviation_rad_per_s: Vec<f64>,
}

impl ForcingBlock {
    /// Forgets the samples before and makes room for `samples` of `directions` directions, without errors.
    pub(crate) fn clear(&mut self, directions: usize, samples: usize) {
        self.errors.resize_with(directions, Vec::new);
        for errors in &mut self.errors {
            errors.clear();
            errors.resize(samples, 0.0);
        }
        self.entries.clear();
        self.motor_lead_rad.clear();
        self.torque_deviation_nm.clear();
        self.speed_deviation_rad_per_s.clear();
    }
}

/// Produces the forcing of one simulation, block by block.
pub(crate) trait Forcing {
    /// The next `samples` samples.
    fn next_block(&mut self, samples: usize, block: &mut ForcingBlock);
}

/// What forces one simulation.
pub(crate) trait ForcingSource: Sync {
    /// Forcing from the first simulated sample on.
    ///
    /// # Arguments
    /// * `directions` - which of the mesh's constant directions the solution uses
    fn forcing(&self, directions: &[usize]) -> Box<dyn Forcing + '_>;
}
