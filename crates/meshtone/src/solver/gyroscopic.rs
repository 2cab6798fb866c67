//! Gyroscopic moments within the steps.
//!
//! The tilt rates V = Δt φ̇ of what spins, two a node, are at the end of a step `V = V₀ + Γ F + Γ' F'`, with the forces F' of meshes and bearings and the
//! moments `F = −S V`, whose S has `Sᵀ = −S`. So `F = T (V₀ + Γ' F')` with `T = −S (1 + Γ S)⁻¹`: numbers that do not change from step to step, and the
//! deflections of meshes and bearings, on which F acts too, take it into their own constants. The equations of a step are no more than without.
//!
//! It is as stable as without: with `Δq̇ = Δt ā` and ā the mean acceleration of a step, the moments' part in the balance `āᵀ(Δq̈ + G Δq̇ + K Δq) = 0` is
//! `Δt āᵀ G ā = 0`. The rates of a step are those of the trapezium rule, which is short of a mode's own by `½θ/tan ½θ`, θ its turn in a step;
//! each mode is read with its own.

use nalgebra::DMatrix;

use super::modal::ModalMachine;
use super::mode_step::StepOfMode;
use super::outputs::{EXTERNALS, dot};
use super::prepare::Column;

/// Where gyroscopic moments act.
pub(super) struct Gyroscopic<'a> {
    /// With what spins.
    pub(super) model: &'a ModalMachine,
    /// How each mode is stepped.
    pub(super) steps: &'a [StepOfMode],
    /// (s) Δt.
    pub(super) step_s: f64,
    /// (-) Speed of the motor over the nominal one.
    pub(super) speed: f64,
}

/// `Δt² q̈` of each mode.
#[derive(Clone, Copy)]
pub(super) struct Pushes<'a> {
    /// Per moment of what spins, about x and about y of each.
    pub(super) moments: &'a [Vec<f64>],
    /// Per external.
    pub(super) externals: &'a [Vec<f64>; EXTERNALS],
    /// Per force that turns with a shaft.
    pub(super) turning: &'a [[Vec<f64>; 2]],
}

impl Gyroscopic<'_> {
    /// Adds the columns of what spins behind all others, and what its moments change in these.
    ///
    /// # Arguments
    /// * `columns`, `compliance` - of meshes, bearings and friction; the latter also per moment of what spins, in the columns behind
    /// * `restore`, `damp` - change of the modes' accelerations, as of [`Prepared`](super::prepare::Prepared)
    /// * `pushes` - what pushes the modes beside the columns' forces
    pub(super) fn add_to(
        &self,
        columns: &mut Vec<Column>,
        compliance: &mut Vec<Vec<f64>>,
        [restore, damp]: [&[f64]; 2],
        pushes: Pushes,
    ) {
        let tilts: Vec<&Vec<f64>> = self.model.spinning.iter().flat_map(|of| &of.tilts).collect();
        let (count, others) = (tilts.len(), columns.len());
        if count == 0 {
            return;
        }
        let reads: Vec<Vec<f64>> = (tilts.iter())
            .map(|tilt| tilt.iter().zip(self.steps).map(|(tilt, step)| tilt * step.rate_factor()).collect())
            .collect();
        // (-) V at the step's end per force: half of what its acceleration is.
        let per_push = |read: &[f64], push: &[f64]| dot(read, push) / 2.0;
        let yielded =
            DMatrix::from_fn(count, count, |row, column| per_push(&reads[row], &pushes.moments[column]));
        let moments = DMatrix::from_fn(count, count, |row, column| {
            let momentum = self.speed * self.model.spinning[row / 2].momentum / self.step_s;
            let sign = if row % 2 == 0 { 1.0 } else { -1.0 };
            if row / 2 == column / 2 && row != column { sign * momentum } else { 0.0 }
        });
        let answer = (DMatrix::identity(count, count) + yielded * &moments).lu();
        // T = −S (1 + Γ S)⁻¹.
        let moment_of_rate = answer.try_inverse().map_or_else(|| -&moments, |inverse| -(&moments * inverse));
        let combined = |of: &dyn Fn(usize) -> f64, row: usize| -> f64 {
            (0..count).map(|column| moment_of_rate[(row, column)] * of(column)).sum()
        };
        let modes = self.steps.len();
        for row in 0..count {
            let read: Vec<f64> = (0..modes).map(|n| combined(&|column| reads[column][n], row)).collect();
            let of_push = |push: &Vec<f64>| per_push(&read, push);
            let own = Column {
                push: pushes.moments[row].clone(),
                static_deflection: 0.0,
                of_displacement: (0..modes).map(|n| read[n] * restore[n] / 2.0).collect(),
                of_velocity: (0..modes).map(|n| read[n] * (1.0 + damp[n] / 2.0)).collect(),
                of_force: Vec::new(),
                of_external: pushes.externals.each_ref().map(of_push),
                of_turning: pushes.turning.iter().map(|of| of.each_ref().map(of_push)).collect(),
            };
            compliance.push(columns[..others].iter().map(|column| of_push(&column.push)).collect());
            columns.push(own);
        }
        let (others_of, own) = columns.split_at_mut(others);
        let (compliance, of_own) = compliance.split_at_mut(others);
        for (column, compliance) in others_of.iter_mut().zip(compliance) {
            let per_moment = compliance.split_off(others);
            for ((own, of_own), deflected) in own.iter().zip(of_own.iter()).zip(per_moment) {
                let add = |values: &mut [f64], more: &[f64]| {
                    values.iter_mut().zip(more).for_each(|(value, more)| *value += deflected * more);
                };
                add(&mut column.of_displacement, &own.of_displacement);
                add(&mut column.of_velocity, &own.of_velocity);
                add(&mut column.of_external, &own.of_external);
                column.of_turning.iter_mut().zip(&own.of_turning).for_each(|(of, more)| add(of, more));
                add(compliance, of_own);
            }
        }
    }
}
