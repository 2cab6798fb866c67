//! How stiffly, where along the face and in which direction the mesh carries its load, over the cycle.

use super::stiffness::MeshStiffness;
use crate::damage::published::{ContactWidth, Displacement, FaultGeometry, Half};
use crate::mesh::load_state::{DirectionMatrix, DirectionVector, LoadState};
use crate::operation::CycleGrid;

/// Stiffness and load state of the mesh at every coarse point of the cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshLoad {
    /// (N/m) Mesh stiffness over a gear revolution.
    pub stiffness_n_per_m: Vec<f64>,
    /// Load state of a healthy mesh.
    pub nominal: LoadState,
    /// Load state at the first points of the cycle, while the fault is in contact.
    pub faulty: Vec<LoadState>,
    /// Number of points from one tooth to the next.
    pub points_per_pitch: usize,
    /// Number of points, from the start of the cycle, at which the mesh is not that of a healthy gear.
    pub disturbed_points: usize,
    /// (m) Half the face width.
    half_width_m: f64,
    contact_width: ContactWidth,
}

impl MeshLoad {
    /// Puts the mesh stiffness and the fault's effect on width and direction together.
    ///
    /// # Arguments
    /// * `mesh` - mesh stiffness
    /// * `fault` - the fault
    /// * `grid` - division of the cycle
    /// * `face_width_mm` - (mm) face width
    /// * `pressure_angle_rad` - (rad) nominal pressure angle
    ///
    /// The published code leaves out the tilt coupling of a through fault and gives its pressure angle in the order
    /// opposite to contact.
    pub fn new(
        mesh: &MeshStiffness,
        fault: Option<&FaultGeometry>,
        grid: &CycleGrid,
        face_width_mm: f64,
        pressure_angle_rad: f64,
    ) -> Self {
        let half_width = face_width_mm * 1e-3 / 2.0;
        let mut nominal = LoadState::spread(-half_width, half_width, pressure_angle_rad);
        let short_of = |missing_mm: f64| {
            LoadState::spread(-half_width, half_width - missing_mm * 1e-3, pressure_angle_rad)
        };
        let nearest = |position_rev: f64| {
            let point = (position_rev / grid.coarse_step_rev).round().max(0.0) as usize;
            point.min(grid.points_per_gear_revolution - 1)
        };
        let mut faulty = Vec::new();
        if let Some(fault) = fault {
            match fault.contact_width {
                ContactWidth::Whole => {}
                ContactWidth::Chip { width_mm, exit_rev } => {
                    let exit = nearest(exit_rev);
                    let left = |i: usize| 1.0 - i as f64 / exit.max(1) as f64;
                    faulty = (0..=exit).map(|i| short_of(width_mm * left(i))).collect();
                }
                ContactWidth::Pit { width_mm, start_rev, end_rev } => {
                    faulty = vec![nominal; nearest(start_rev)];
                    faulty.resize(nearest(end_rev) + 1, short_of(width_mm));
                }
            }
            if let Displacement::Rolling(rolling) = &fault.displacement {
                let start = (rolling.start_rev / grid.coarse_step_rev).ceil() as usize;
                let end = (rolling.end_rev / grid.coarse_step_rev).floor() as usize;
                let points = end + 1 - start;
                // The published curve starts with the half that leaves contact last.
                nominal.mean_z2_m2 = 0.0;
                let angles = rolling.over_range_rad(points, Half::End);
                faulty = vec![nominal; start];
                faulty.extend(angles.iter().map(|&angle| LoadState { pressure_angle_rad: angle, ..nominal }));
            }
        }
        Self {
            stiffness_n_per_m: mesh.mesh_n_per_mm.iter().map(|k| k * 1e3).collect(),
            points_per_pitch: grid.points_per_pitch,
            disturbed_points: if !grid.pitch_is_whole() {
                grid.points_per_gear_revolution
            } else if fault.is_some() {
                mesh.first_pair_n_per_mm.len().max(faulty.len()).min(grid.points_per_gear_revolution)
            } else {
                0
            },
            nominal,
            faulty,
            half_width_m: half_width,
            contact_width: fault.map_or(ContactWidth::Whole, |fault| fault.contact_width),
        }
    }

    /// Load state at coarse point `point`.
    pub fn state(&self, point: usize) -> &LoadState {
        self.faulty.get(point).unwrap_or(&self.nominal)
    }

    /// (rad) Pressure angle at coarse point `point`.
    pub fn pressure_angle_rad(&self, point: usize) -> f64 {
        self.state(point).pressure_angle_rad
    }

    /// Direction in which the profile errors' force acts, in the five constant directions. The contact width is
    /// taken at the position itself, not at the nearest coarse point; the pressure angle is the nominal one.
    ///
    /// # Arguments
    /// * `position_rev` - (rev) pinion revolutions since the damaged tooth entered contact
    pub(crate) fn error_direction(&self, position_rev: f64) -> DirectionVector {
        let nominal = self.nominal.pressure_angle_rad;
        let z_max = self.half_width_m - self.contact_width.missing_mm(position_rev) * 1e-3;
        LoadState::spread(-self.half_width_m, z_max, nominal).mean_direction(nominal)
    }

    /// (N/m) `k · mean(g gᵀ)` at coarse point `point`, in the five constant directions.
    pub(crate) fn stiffness(&self, point: usize) -> DirectionMatrix {
        self.state(point).mean_square(self.nominal.pressure_angle_rad) * self.stiffness_n_per_m[point]
    }

    /// (N/m) Mean of [`Self::stiffness`] over the cycle.
    pub(crate) fn mean_stiffness(&self) -> DirectionMatrix {
        let nominal = self.nominal.pressure_angle_rad;
        let (disturbed, sound) = self.stiffness_n_per_m.split_at(self.faulty.len());
        let mut sum = self.nominal.mean_square(nominal) * sound.iter().sum::<f64>();
        for (state, k) in self.faulty.iter().zip(disturbed) {
            sum += state.mean_square(nominal) * *k;
        }
        sum / self.stiffness_n_per_m.len() as f64
    }
}
