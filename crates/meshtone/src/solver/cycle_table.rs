//! The mesh over the cycle, as a step needs it.

use nalgebra::{DMatrix, DVector};

use super::reduce::ReducedModel;
use crate::dynamics::System;

/// What a step needs at one coarse point of the cycle; with `y` the deflection in the mesh's directions and `f` the
/// profile errors' force, the mesh's force on the modes is `B w`, `w = −(f + S' y)`.
///
/// First [`DEVIATION`], then [`RELIEF`].
pub(super) type CyclePoint<const R: usize> = [[[f64; R]; R]; 2];

/// (N/m) `S' = S − S_mean`.
pub(super) const DEVIATION: usize = 0;
/// (-) `(1 + S' Γ)⁻¹`, Γ the step's own compliance: `w = −(1 + S' Γ)⁻¹ (f + S' ŷ)` with ŷ the deflection at `w = 0`. This is
/// Woodbury's identity for `K̂⁻¹`.
pub(super) const RELIEF: usize = 1;

/// The points while the fault is in contact, then one pitch of the healthy mesh.
pub(super) struct CycleTable {
    /// The numbers of every [`CyclePoint`].
    values: Vec<f64>,
    /// Number of directions that there is room for.
    directions: usize,
    /// Number of points while the fault is in contact.
    pub(super) window: usize,
    /// Number of points from one tooth to the next.
    pub(super) pitch: usize,
    /// Number of points in a gear revolution.
    pub(super) cycle: usize,
}

impl CycleTable {
    /// Tabulates the mesh.
    ///
    /// # Arguments
    /// * `model` - for the mesh's directions
    /// * `system` - for stiffness and load state
    /// * `compliance` - Γ: (m/N) deflection in each direction, at the end of a step, per force in each
    /// * `directions` - at least the model's; those that it has not got carry nothing
    pub(super) fn new(
        model: &ReducedModel,
        system: &System,
        compliance: &DMatrix<f64>,
        directions: usize,
    ) -> Self {
        let load = &system.mesh;
        let cycle = load.stiffness_n_per_m.len();
        let pitch = load.points_per_pitch;
        let window = load.disturbed_points;
        // After the window, the pitch that starts at a tooth: any whole pitch beyond it.
        let first_whole = window.div_ceil(pitch) * pitch;
        let (window, healthy) = if first_whole + pitch <= cycle { (window, first_whole) } else { (cycle, 0) };
        let tabulated = (0..window).chain(healthy..healthy + pitch);
        let numbers = 2 * directions * directions;
        let mut values = vec![0.0; numbers * (window + pitch)];
        for (entry, n) in values.chunks_exact_mut(numbers).zip(tabulated) {
            tabulate(model, system, compliance, n, directions, entry);
        }
        Self { values, directions, window, pitch, cycle }
    }

    /// The entries, with the `R` directions that there is room for.
    pub(super) fn points<const R: usize>(&self) -> &[CyclePoint<R>] {
        self.values.as_chunks().0.as_chunks().0.as_chunks().0
    }

    /// The deviation at an entry, row by row.
    pub(super) fn deviation(&self, entry: usize) -> &[f64] {
        let size = self.directions * self.directions;
        &self.values[2 * entry * size..][..size]
    }

    /// Entry of the point that is `angle` rounded down, counted from the start of the simulation.
    pub(super) fn entry(&self, angle: f64) -> usize {
        let in_cycle = (angle.floor() as i64).rem_euclid(self.cycle as i64) as usize;
        if in_cycle < self.window { in_cycle } else { self.window + in_cycle % self.pitch }
    }
}

/// Sets the numbers of a [`CyclePoint`] of `directions` directions.
fn tabulate(
    model: &ReducedModel,
    system: &System,
    compliance: &DMatrix<f64>,
    point: usize,
    directions: usize,
    entry: &mut [f64],
) {
    let (deviation, relief) = entry.split_at_mut(directions * directions);
    let at = |r: usize, c: usize| r * directions + c;
    for r in 0..directions {
        relief[at(r, r)] = 1.0;
    }
    let load = &system.mesh;
    let columns = model.directions.len();
    let k = load.stiffness_n_per_m[point];
    let square = load.state(point).mean_square(load.nominal.pressure_angle_rad);
    for r in 0..columns {
        for c in 0..columns {
            deviation[at(r, c)] =
                k * square[(model.directions[r], model.directions[c])] - model.mean_mesh_stiffness[(r, c)];
        }
    }
    if columns == 1 {
        relief[0] = 1.0 / (1.0 + deviation[0] * compliance[(0, 0)]);
        return;
    }
    let matrix = DMatrix::identity(columns, columns)
        + DMatrix::from_fn(columns, columns, |r, c| deviation[at(r, c)]) * compliance;
    // K̂ is positive definite, so the matrix has an inverse.
    if let Some(inverse) = matrix.try_inverse() {
        for r in 0..columns {
            for c in 0..columns {
                relief[at(r, c)] = inverse[(r, c)];
            }
        }
    }
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
