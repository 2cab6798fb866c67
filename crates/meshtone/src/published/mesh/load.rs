//! How stiffly, where along the face and in which direction the mesh carries its load, over the cycle.

use super::stiffness::MeshStiffness;
use crate::operation::CycleGrid;
use crate::published::cycle::remainder;
use crate::published::damage::{ContactWidth, Displacement, FaultGeometry, Half, RollingAngle};
use crate::wheel::Teeth;

/// Where and in which direction the mesh carries its load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadState {
    /// (m) Mean of z over the contact width.
    pub mean_z_m: f64,
    /// (m²) Mean of z² over the contact width.
    pub mean_z2_m2: f64,
    /// (rad) Pressure angle, at which the line of action lies.
    pub pressure_angle_rad: f64,
}

impl LoadState {
    /// Load spread evenly from `z_min_m` to `z_max_m`.
    fn spread(z_min_m: f64, z_max_m: f64, pressure_angle_rad: f64) -> Self {
        Self {
            mean_z_m: (z_min_m + z_max_m) / 2.0,
            mean_z2_m2: (z_min_m * z_min_m + z_min_m * z_max_m + z_max_m * z_max_m) / 3.0,
            pressure_angle_rad,
        }
    }
}

/// Stiffness and load state of the mesh at every coarse point of the cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshLoad {
    /// (N/m) Mesh stiffness over the cycle.
    pub stiffness_n_per_m: Vec<f64>,
    /// Load state of a healthy mesh.
    pub nominal: LoadState,
    /// Load state at the first points of the cycle, up to the last at which the fault changes it.
    pub faulty: Vec<LoadState>,
}

impl MeshLoad {
    /// Puts the mesh stiffness and the fault's effect on width and direction together.
    ///
    /// # Arguments
    /// * `mesh` - mesh stiffness
    /// * `fault` - the fault
    /// * `grid` - division of the cycle
    /// * `teeth` - both wheels
    ///
    /// The published code leaves out the tilt coupling of a through fault and gives its pressure angle in the order opposite to
    /// contact.
    pub fn new(mesh: &MeshStiffness, fault: Option<&FaultGeometry>, grid: &CycleGrid, teeth: &Teeth) -> Self {
        let half_width_m = teeth.gear.face_width_mm * 1e-3 / 2.0;
        let short_of = |missing_mm: f64| {
            LoadState::spread(-half_width_m, half_width_m - missing_mm * 1e-3, teeth.gear.pressure_angle_rad)
        };
        let mut nominal = short_of(0.0);
        let nearest = |position_rev: f64| {
            let point = (position_rev / grid.coarse_step_rev).round().max(0.0) as usize;
            point.min(grid.points_per_gear_revolution - 1)
        };
        let contact_width = fault.map_or(ContactWidth::Whole, |fault| fault.contact_width);
        let mut faulty = match contact_width {
            ContactWidth::Whole => Vec::new(),
            ContactWidth::Chip { width_mm, exit_rev } => {
                let exit = nearest(exit_rev);
                let left = |i: usize| 1.0 - i as f64 / exit.max(1) as f64;
                (0..=exit).map(|i| short_of(width_mm * left(i))).collect()
            }
            ContactWidth::Pit { width_mm, start_rev, end_rev } => {
                let (start, end) = (nearest(start_rev), nearest(end_rev));
                (0..=end).map(|i| if i < start { nominal } else { short_of(width_mm) }).collect()
            }
        };
        if let Some(Displacement::Rolling(rolling)) = fault.map(|fault| &fault.displacement) {
            nominal.mean_z2_m2 = 0.0;
            let turned = |pressure_angle_rad| LoadState { pressure_angle_rad, ..nominal };
            let gear_revolution_rev = f64::from(teeth.gear.teeth) / f64::from(teeth.pinion.teeth);
            let (start, angles_rad) = angles_over_cycle(rolling, grid, gear_revolution_rev);
            faulty = vec![nominal; start];
            faulty.extend(angles_rad.into_iter().map(turned));
        }
        let stiffness_n_per_m = mesh.mesh_n_per_mm.iter().map(|k| k * 1e3).collect();
        Self { stiffness_n_per_m, nominal, faulty }
    }

    /// Load state at coarse point `point`.
    pub fn state(&self, point: usize) -> &LoadState {
        self.faulty.get(point).unwrap_or(&self.nominal)
    }
}

/// First coarse point of a through fault's pressure angle, and (rad) the angle from it on.
///
/// It is set from the first point whose remainder of a gear revolution is not before the fault to the last whose remainder is not
/// behind it. Where the cycle comes out longer than a gear revolution its last points have remainders near 0, so that the angle of
/// nearly the whole cycle changes.
fn angles_over_cycle(
    rolling: &RollingAngle,
    grid: &CycleGrid,
    gear_revolution_rev: f64,
) -> (usize, Vec<f64>) {
    let position_rev = |point: usize| remainder(point as f64 * grid.coarse_step_rev, gear_revolution_rev);
    let mut points = 0..grid.points_per_gear_revolution;
    let start = points.clone().find(|&point| position_rev(point) >= rolling.start_rev);
    let end = points.rfind(|&point| position_rev(point) <= rolling.end_rev);
    match (start, end) {
        (Some(start), Some(end)) if start <= end => {
            (start, rolling.over_range_rad(end + 1 - start, Half::End))
        }
        _ => (0, Vec::new()),
    }
}
