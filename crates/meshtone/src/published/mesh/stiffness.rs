//! Stiffness of the whole mesh over the cycle.

use super::pair::PairStiffness;
use crate::operation::{CycleGrid, FINE_PER_COARSE};

/// Mesh stiffness on the coarse grid.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshStiffness {
    /// (N/mm) All pairs in contact, over the cycle from the gear's first tooth's start of contact.
    pub mesh_n_per_mm: Vec<f64>,
    /// (N/mm) The same of a healthy gear, over one pitch.
    pub healthy_mesh_n_per_mm: Vec<f64>,
    /// Number of points, from the start of the cycle, at which the gear's first tooth is in contact.
    pub first_pair_points: usize,
}

impl MeshStiffness {
    /// Sums the pairs in contact: pair j from j times the fine points of a pitch on, pair 0 the faulty one. The published code loses
    /// what overlaps beyond two pairs.
    ///
    /// # Arguments
    /// * `pair` - healthy and faulty pair
    /// * `grid` - division of the cycle
    pub fn new(pair: &PairStiffness, grid: &CycleGrid) -> Self {
        let pitch = grid.fine_points_per_pitch;
        let fine_points = grid.fine_points_in(pair.span_rev).min(2 * pitch);
        let (healthy, first) = (pair.healthy_curve(), pair.faulty_curve());
        let at = |point: usize, has_first: bool| -> f64 {
            let (latest, since) = (point * FINE_PER_COARSE / pitch, point * FINE_PER_COARSE % pitch);
            (since..fine_points)
                .step_by(pitch)
                .enumerate()
                .map(|(age, fine)| {
                    let position_rev = fine as f64 * grid.fine_step_rev;
                    if has_first && age == latest { first.at(position_rev) } else { healthy.at(position_rev) }
                })
                .sum()
        };
        Self {
            mesh_n_per_mm: (0..grid.points_per_gear_revolution).map(|point| at(point, true)).collect(),
            healthy_mesh_n_per_mm: (0..grid.points_per_pitch).map(|point| at(point, false)).collect(),
            first_pair_points: fine_points.div_ceil(FINE_PER_COARSE),
        }
    }

    /// (N/mm) Mean over the cycle.
    pub fn mean_n_per_mm(&self) -> f64 {
        self.mesh_n_per_mm.iter().sum::<f64>() / self.mesh_n_per_mm.len() as f64
    }
}
