//! The mesh over the cycle, as a step needs it.

use nalgebra::{DMatrix, DVector};

use super::reduce::ReducedModel;
use crate::dynamics::System;

/// What a step needs at one coarse point of the cycle; with `y` the deflection in the mesh's directions and `f` the
/// profile errors' force, the mesh's force on the modes is `B w`, `w = −(f + S' y)`.
#[derive(Clone, Copy)]
pub(super) struct CyclePoint<const R: usize> {
    /// (N/m) `S' = S − S_mean`.
    pub(super) deviation: [[f64; R]; R],
    /// (-) `(1 + S' Γ)⁻¹`, Γ the step's own compliance: `w = −(1 + S' Γ)⁻¹ (f + S' ŷ)` with ŷ the deflection at
    /// `w = 0`. This is Woodbury's identity for `K̂⁻¹`.
    pub(super) relief: [[f64; R]; R],
}

/// The points while the fault is in contact, then one pitch of the healthy mesh.
pub(super) struct CycleTable<const R: usize> {
    pub(super) points: Vec<CyclePoint<R>>,
    /// Number of points while the fault is in contact.
    pub(super) window: usize,
    /// Number of points from one tooth to the next.
    pub(super) pitch: usize,
    /// Number of points in a gear revolution.
    pub(super) cycle: usize,
}

impl<const R: usize> CycleTable<R> {
    /// Tabulates the mesh.
    ///
    /// # Arguments
    /// * `model` - for the mesh's directions
    /// * `system` - for stiffness and load state
    /// * `compliance` - Γ: (m/N) deflection in each direction, at the end of a step, per force in each
    pub(super) fn new(model: &ReducedModel, system: &System, compliance: &DMatrix<f64>) -> Self {
        let load = &system.mesh;
        let cycle = load.stiffness_n_per_m.len();
        let pitch = load.points_per_pitch;
        let window = load.disturbed_points;
        // After the window, the pitch that starts at a tooth: any whole pitch beyond it.
        let first_whole = window.div_ceil(pitch) * pitch;
        let (window, healthy) = if first_whole + pitch <= cycle { (window, first_whole) } else { (cycle, 0) };
        let tabulated = (0..window).chain(healthy..healthy + pitch);
        Self {
            points: tabulated.map(|n| point(model, system, compliance, n)).collect(),
            window,
            pitch,
            cycle,
        }
    }
}

impl<const R: usize> CycleTable<R> {
    /// Entry of the point that is `angle` rounded down, counted from the start of the simulation.
    pub(super) fn entry(&self, angle: f64) -> usize {
        let in_cycle = (angle.floor() as i64).rem_euclid(self.cycle as i64) as usize;
        if in_cycle < self.window { in_cycle } else { self.window + in_cycle % self.pitch }
    }
}

fn point<const R: usize>(
    model: &ReducedModel,
    system: &System,
    compliance: &DMatrix<f64>,
    point: usize,
) -> CyclePoint<R> {
    let load = &system.mesh;
    let columns = model.directions.len();
    let mut entry = CyclePoint { deviation: [[0.0; R]; R], relief: [[0.0; R]; R] };
    for r in 0..R {
        entry.relief[r][r] = 1.0;
    }
    let k = load.stiffness_n_per_m[point];
    let square = load.state(point).mean_square(load.nominal.pressure_angle_rad);
    for r in 0..columns {
        for c in 0..columns {
            entry.deviation[r][c] =
                k * square[(model.directions[r], model.directions[c])] - model.mean_mesh_stiffness[(r, c)];
        }
    }
    if columns == 1 {
        entry.relief[0][0] = 1.0 / (1.0 + entry.deviation[0][0] * compliance[(0, 0)]);
        return entry;
    }
    let deviation = DMatrix::from_fn(columns, columns, |r, c| entry.deviation[r][c]);
    let matrix = DMatrix::identity(columns, columns) + deviation * compliance;
    // K̂ is positive definite, so the matrix has an inverse.
    if let Some(relief) = matrix.try_inverse() {
        for r in 0..columns {
            for c in 0..columns {
                entry.relief[r][c] = relief[(r, c)];
            }
        }
    }
    entry
}

/// Γ and the factors of the step in each mode: see [`super::step`].
pub(super) struct StepFactors {
    /// (-) `2E`.
    pub(super) keep: Vec<f64>,
    /// (-) `2 h² ω² E`.
    pub(super) restore: Vec<f64>,
    /// (s²) `h² E`: a force's share in a step's displacement.
    pub(super) share: Vec<f64>,
    /// (m/N) Γ.
    pub(super) compliance: DMatrix<f64>,
}

impl StepFactors {
    /// Factors for steps of `2 half_step_s`.
    pub(super) fn new(model: &ReducedModel, half_step_s: f64) -> Self {
        let (h, modes) = (half_step_s, model.modes());
        let e: Vec<f64> =
            (0..modes).map(|n| 1.0 / (1.0 + h * model.damping[n] + h * h * model.stiffness[n])).collect();
        let share: Vec<f64> = e.iter().map(|e| h * h * e).collect();
        let weights = DVector::from_column_slice(&share);
        let columns = model.directions.len();
        Self {
            keep: e.iter().map(|e| 2.0 * e).collect(),
            restore: (0..modes).map(|n| 2.0 * h * h * model.stiffness[n] * e[n]).collect(),
            share,
            compliance: DMatrix::from_fn(columns, columns, |r, c| {
                model.mesh[r].component_mul(&weights).dot(&model.mesh[c])
            }),
        }
    }
}
