//! What sensors on the rig would show.

use std::f64::consts::TAU;

use crate::machine::coordinates::*;
use crate::operation::TimeGrid;
use crate::solver::{Block, Output, Recorder};

/// (m/s²) One g, as the published model has it.
pub const GRAVITY_M_PER_S2: f64 = 9.81;

/// The kept signals, all at the same rate and equally long.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Channels {
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first kept sample since the start of the simulation.
    pub start_s: f64,
    /// (g) Horizontal acceleration, `(ẍ_g + ẍ_p)/9.81`.
    pub horizontal_g: Vec<f64>,
    /// (g) Vertical acceleration, `(ÿ_g + ÿ_p)/9.81`.
    pub vertical_g: Vec<f64>,
    /// (g) Axial acceleration, `(z̈_g + z̈_p)/9.81`.
    pub axial_g: Vec<f64>,
    /// (Hz) Speed of the pinion's shaft, `θ̇_p/2π`.
    pub pinion_speed_hz: Vec<f64>,
    /// (Hz) Speed of the gear's shaft, `−θ̇_g/2π`.
    pub gear_speed_hz: Vec<f64>,
    /// (N) Mesh force along the line of action; negative: the linear mesh pulls where real teeth would part.
    pub mesh_force_n: Vec<f64>,
}

impl Channels {
    /// Empty channels, with room for the kept samples.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn new(time: &TimeGrid) -> Self {
        let empty = || Vec::with_capacity(time.kept_samples());
        Self {
            sampling_rate_hz: time.sampling_rate_hz,
            start_s: time.first_kept_sample as f64 * time.step_s(),
            horizontal_g: empty(),
            vertical_g: empty(),
            axial_g: empty(),
            pinion_speed_hz: empty(),
            gear_speed_hz: empty(),
            mesh_force_n: empty(),
        }
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.vertical_g.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.vertical_g.is_empty()
    }

    /// (s) Time of sample `index` since the start of the simulation.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / self.sampling_rate_hz
    }

    /// (-) Part of the kept time in which the mesh force is negative.
    pub fn tension_fraction(&self) -> f64 {
        let pulling = self.mesh_force_n.iter().filter(|&&force| force < 0.0).count();
        pulling as f64 / self.mesh_force_n.len().max(1) as f64
    }
}

/// What [`Channels`] reads off the solution, in the order of its fields.
pub fn channel_outputs() -> [Output; 6] {
    let weighted = |terms: &[(usize, f64)]| {
        let mut weights = [0.0; COORDINATES];
        for &(coordinate, weight) in terms {
            weights[coordinate] = weight;
        }
        weights
    };
    let per_g = 1.0 / GRAVITY_M_PER_S2;
    [
        Output::Acceleration(weighted(&[(X_GEAR, per_g), (X_PINION, per_g)])),
        Output::Acceleration(weighted(&[(Y_GEAR, per_g), (Y_PINION, per_g)])),
        Output::Acceleration(weighted(&[(Z_GEAR, per_g), (Z_PINION, per_g)])),
        Output::Velocity(weighted(&[(THETA_PINION, 1.0 / TAU)])),
        Output::Velocity(weighted(&[(THETA_GEAR, -1.0 / TAU)])),
        Output::MeshForce,
    ]
}

impl Recorder for Channels {
    fn record(&mut self, block: &Block) {
        self.horizontal_g.extend_from_slice(block.output(0));
        self.vertical_g.extend_from_slice(block.output(1));
        self.axial_g.extend_from_slice(block.output(2));
        self.pinion_speed_hz.extend_from_slice(block.output(3));
        self.gear_speed_hz.extend_from_slice(block.output(4));
        self.mesh_force_n.extend_from_slice(block.output(5));
    }
}
