//! Everything about a simulation that does not change from step to step, and its first state.

use nalgebra::{DMatrix, DVector};

use super::cycle_table::{CycleTable, StepFactors};
use super::integrate::Problem;
use super::outputs::{EXTERNALS, OutputRow, Scales};
use super::reduce::ReducedModel;
use crate::dynamics::coordinates::THETA_PINION;
use crate::scenario::Convention;

/// Everything about one simulation that does not change from step to step.
pub(super) struct Prepared {
    pub(super) factors: StepFactors,
    pub(super) scales: Scales,
    pub(super) table: CycleTable,
    pub(super) rows: Vec<OutputRow>,
    /// Angle of the pinion in coarse points of the cycle, per modal displacement.
    pub(super) angle: Vec<f64>,
    /// Angle under the constant loads, plus the half point that makes rounding down the nearest.
    pub(super) static_angle: f64,
    /// Deflection under the constant loads, in each direction.
    pub(super) static_deflection: Vec<f64>,
    /// Coarse points of the cycle per sample, at the nominal speed.
    pub(super) points_per_sample: f64,
}

/// State of the modes at the first sample.
pub(super) struct FirstState {
    pub(super) displacement: Vec<f64>,
    pub(super) scaled_velocity: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) external: [f64; EXTERNALS],
    pub(super) angle: f64,
    pub(super) entry: usize,
}

/// Most times that the point of the cycle is sought to which its own static equilibrium leads.
const MOST_ITERATIONS: usize = 11;

impl Prepared {
    /// Tabulates a simulation.
    ///
    /// # Arguments
    /// * `problem` - the simulation
    /// * `directions` - at least the mesh directions that it has; those that it has not got stay at rest
    pub(super) fn new(problem: &Problem, directions: usize) -> Self {
        let (model, stages) = (problem.model, problem.stages);
        let half_step_s = stages.time.step_s() / 2.0;
        let factors = StepFactors::new(model, half_step_s);
        let published = stages.scenario.convention == Convention::Published;
        let drag: Vec<f64> =
            model.damping.iter().zip(&model.rigid_velocity).map(|(damping, rigid)| damping * rigid).collect();
        let torque = stages.scenario.operation.brake_torque_nm;
        let static_displacement: Vec<f64> = (0..model.modes())
            .map(|n| {
                // Convention: under `published` damping brakes the rigid rotation too, under `corrected` it acts on the
                // velocity relative to the motor's.
                let brake = if published { drag[n] * model.rotation_rad_per_s } else { 0.0 };
                (model.brake[n] * torque - brake) / model.stiffness[n]
            })
            .collect();
        let followed_speed = if published { vec![0.0; model.modes()] } else { drag };
        let points_per_rad = 1.0 / (std::f64::consts::TAU * stages.cycle.coarse_step_rev);
        let angle: Vec<f64> = model.shapes.iter().map(|shape| shape[THETA_PINION] * points_per_rad).collect();
        let scales = Scales {
            half_step_s,
            external: [model.motor.clone(), model.brake.clone(), followed_speed],
            static_displacement,
        };
        Self {
            table: CycleTable::new(model, &stages.system, &factors.compliance, directions),
            rows: problem.outputs.iter().map(|output| output.row(model, &scales)).collect(),
            static_angle: sum(&angle, &scales.static_displacement) + 0.5,
            static_deflection: (0..directions)
                .map(|r| sum(column(model, r), &scales.static_displacement))
                .collect(),
            points_per_sample: stages.cycle.points_per_pinion_revolution as f64
                / stages.time.samples_per_pinion_revolution as f64,
            angle,
            factors,
            scales,
        }
    }

    fn scaled_velocity(&self, model: &ReducedModel) -> Vec<f64> {
        model.initial_velocity.iter().map(|velocity| velocity * self.scales.half_step_s).collect()
    }

    /// The state at the first simulated sample: as given, or the static equilibrium of the loaded mesh there.
    ///
    /// # Arguments
    /// * `problem` - the simulation
    /// * `errors` - force of the profile errors at that sample, in the mesh's directions
    /// * `external` - motor lead, torque deviation and speed deviation there
    pub(super) fn first_state(
        &self,
        problem: &Problem,
        errors: &[f64],
        external: [f64; EXTERNALS],
    ) -> FirstState {
        let model = problem.model;
        let rotation = problem.stages.time.first_simulated_sample as f64 * self.points_per_sample;
        let Some(given) = &model.initial_displacement else {
            return self.equilibrium(problem, errors, external, rotation);
        };
        let displacement: Vec<f64> = given
            .iter()
            .zip(&self.scales.static_displacement)
            .map(|(given, at_rest)| given - at_rest)
            .collect();
        let angle = self.static_angle + sum(&self.angle, &displacement);
        let entry = self.table.entry(rotation + angle);
        let directions = errors.len();
        let deflection: Vec<f64> = (0..directions)
            .map(|c| self.static_deflection[c] + sum(column(model, c), &displacement))
            .collect();
        let rows = self.table.deviation(entry).chunks_exact(directions);
        let force = errors.iter().zip(rows).map(|(error, row)| -(error + sum(row, &deflection))).collect();
        let scaled_velocity = self.scaled_velocity(model);
        FirstState { displacement, scaled_velocity, force, external, angle, entry }
    }

    /// No acceleration: `ω² q = B w + p` with `w = −(f + S' y)` and p the externals' and the damping's force. A problem of the
    /// size of the mesh's directions, `w = −(1 + S' Γ₀)⁻¹ (f + S' y₀)` with `Γ₀ = Bᵀ ω⁻² B` and y₀ the deflection without
    /// w.
    fn equilibrium(
        &self,
        problem: &Problem,
        errors: &[f64],
        external: [f64; EXTERNALS],
        rotation: f64,
    ) -> FirstState {
        let model = problem.model;
        let columns = model.mesh.len();
        let stiffness = DVector::from_column_slice(&model.stiffness);
        let flexible: Vec<DVector<f64>> =
            model.mesh.iter().map(|column| column.component_div(&stiffness)).collect();
        let compliance = DMatrix::from_fn(columns, columns, |r, c| model.mesh[r].dot(&flexible[c]));
        let forces = &self.scales.external;
        let alone = DVector::from_fn(model.modes(), |n, _| {
            let driven = forces.iter().zip(external).map(|(force, value)| force[n] * value);
            (driven.sum::<f64>() - model.damping[n] * model.initial_velocity[n]) / model.stiffness[n]
        });
        let deflection_alone =
            DVector::from_fn(columns, |r, _| self.static_deflection[r] + model.mesh[r].dot(&alone));
        let solve = |entry: usize| {
            let table = self.table.deviation(entry);
            let deviation = DMatrix::from_fn(columns, columns, |r, c| table[r * errors.len() + c]);
            let load = DVector::from_fn(columns, |r, _| errors[r]) + &deviation * &deflection_alone;
            // The static stiffness is positive definite, so the matrix has an inverse.
            let relief = (DMatrix::identity(columns, columns) + &deviation * &compliance).try_inverse();
            let force = relief.map_or_else(|| DVector::zeros(columns), |relief| -(relief * load));
            let mut displacement = alone.clone();
            for (column, force) in flexible.iter().zip(force.iter()) {
                displacement.axpy(*force, column, 1.0);
            }
            let angle = self.static_angle + sum(&self.angle, displacement.as_slice());
            (force, displacement, angle)
        };
        let mut entry = self.table.entry(rotation + self.static_angle);
        let mut solution = solve(entry);
        for _ in 0..MOST_ITERATIONS {
            let next = self.table.entry(rotation + solution.2);
            if next == entry {
                break;
            }
            entry = next;
            solution = solve(entry);
        }
        let (force, displacement, angle) = solution;
        FirstState {
            displacement: displacement.as_slice().to_vec(),
            scaled_velocity: self.scaled_velocity(model),
            force: force.as_slice().to_vec(),
            external,
            angle,
            entry,
        }
    }
}

/// Mesh direction `r` in the modes; empty where the simulation has not got it.
pub(super) fn column(model: &ReducedModel, r: usize) -> &[f64] {
    model.mesh.get(r).map_or(&[], |column| column.as_slice())
}

/// `Σ a_n b_n`.
pub(super) fn sum(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
