//! What a step makes of a force in each mode.

use nalgebra::{DMatrix, DVector};

use super::reduce::ReducedModel;

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
