//! Stiffness of the whole mesh over a revolution of the gear.

use super::pair::PairStiffness;
use crate::operation::{CycleGrid, FINE_PER_COARSE};

/// Mesh stiffness on the coarse grid of the cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshStiffness {
    /// (N/mm) Healthy pair, from its start of contact.
    pub healthy_pair_n_per_mm: Vec<f64>,
    /// (N/mm) Pair of the gear's first tooth, from its start of contact; the healthy one without a fault.
    pub first_pair_n_per_mm: Vec<f64>,
    /// (N/mm) All pairs in contact, over one gear revolution from the first tooth's start of contact.
    pub mesh_n_per_mm: Vec<f64>,
    /// (N/mm) The same of a healthy gear, over one pitch.
    pub healthy_mesh_n_per_mm: Vec<f64>,
}

impl MeshStiffness {
    /// Sums the pairs in contact: pair j from j/z_p on, pair 0 the faulty one.
    ///
    /// # Arguments
    /// * `pair` - healthy and faulty pair
    /// * `grid` - division of the cycle
    ///
    /// The published code loses what overlaps beyond two pairs.
    pub fn new(pair: &PairStiffness, grid: &CycleGrid) -> Self {
        let points = grid.coarse_points_in(pair.span_rev).min(2 * grid.points_per_pitch);
        let sample = |curve: super::PairCurve| -> Vec<f64> {
            (0..points).map(|i| curve.at(i as f64 * grid.coarse_step_rev)).collect()
        };
        let healthy_pair = sample(pair.healthy_curve());
        let first_pair =
            if pair.faulty_n_per_mm.is_some() { sample(pair.faulty_curve()) } else { healthy_pair.clone() };
        let pitch = grid.points_per_pitch;
        let mut healthy_mesh = vec![0.0; pitch];
        for (i, k) in healthy_pair.iter().enumerate() {
            healthy_mesh[i % pitch] += k;
        }
        let length = grid.points_per_gear_revolution;
        if !grid.pitch_is_whole() {
            return Self {
                mesh_n_per_mm: mesh_of_longer_pitches(pair, grid),
                healthy_pair_n_per_mm: healthy_pair,
                first_pair_n_per_mm: first_pair,
                healthy_mesh_n_per_mm: healthy_mesh,
            };
        }
        let mut mesh: Vec<f64> = healthy_mesh.iter().copied().cycle().take(length).collect();
        if pair.faulty_n_per_mm.is_some() {
            // Summed anew where the first pair is in contact, so that nothing is left of its healthy part.
            for (i, first) in first_pair.iter().enumerate() {
                let others = (1..).map(|j| i + j * pitch).take_while(|&at| at < points);
                let before = (1..).map_while(|j| i.checked_sub(j * pitch));
                let neighbours: f64 = others.chain(before).map(|at| healthy_pair[at]).sum();
                mesh[i % length] = first + neighbours;
            }
        }
        Self {
            healthy_pair_n_per_mm: healthy_pair,
            first_pair_n_per_mm: first_pair,
            mesh_n_per_mm: mesh,
            healthy_mesh_n_per_mm: healthy_mesh,
        }
    }

    /// (N/mm) Mean over the cycle.
    pub fn mean_n_per_mm(&self) -> f64 {
        self.mesh_n_per_mm.iter().sum::<f64>() / self.mesh_n_per_mm.len() as f64
    }
}

/// The sum where a pitch is not a whole number of coarse points: each coarse point has its own place in the pitch.
fn mesh_of_longer_pitches(pair: &PairStiffness, grid: &CycleGrid) -> Vec<f64> {
    let pitch = grid.fine_points_per_pitch;
    let fine_points = grid.fine_points_in(pair.span_rev).min(2 * pitch);
    let (healthy, first) = (pair.healthy_curve(), pair.faulty_curve());
    (0..grid.points_per_gear_revolution)
        .map(|point| {
            let fine = point * FINE_PER_COARSE;
            let (latest, since) = (fine / pitch, fine % pitch);
            let in_contact = (since..fine_points).step_by(pitch).enumerate();
            in_contact
                .map(|(age, at)| {
                    let position = at as f64 * grid.fine_step_rev;
                    if age == latest { first.at(position) } else { healthy.at(position) }
                })
                .sum()
        })
        .collect()
}
