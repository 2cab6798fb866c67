//! Everything about a simulation that does not change from step to step, and its first state.

use nalgebra::{DMatrix, DVector};

use super::integrate::Problem;
use super::outputs::{EXTERNALS, OutputRow, Scales};
use super::reduce::ReducedModel;
use super::step_factors::StepFactors;
use crate::machine::coordinates::THETA_PINION;
use crate::mesh::law::{
    ContactConstants, ContactSample, MeshTable, Reduction, TabulatedSample, deflection_at_rest, force_on,
};

/// Everything about one simulation that does not change from step to step.
pub(super) struct Prepared<const R: usize> {
    pub(super) factors: StepFactors,
    pub(super) scales: Scales,
    pub(super) rows: Vec<OutputRow>,
    /// Angle of the pinion in coarse points of the cycle, per modal displacement.
    pub(super) angle: Vec<f64>,
    /// Angle under the constant loads, plus the half point that makes rounding down the nearest.
    pub(super) static_angle: f64,
    /// Deflection under the constant loads.
    pub(super) static_deflection: [f64; R],
    /// Coarse points of the cycle per sample, at the nominal speed.
    pub(super) points_per_sample: f64,
}

/// State of the modes at the first sample.
pub(super) struct FirstState<const R: usize> {
    pub(super) displacement: Vec<f64>,
    pub(super) scaled_velocity: Vec<f64>,
    pub(super) force: [f64; R],
    pub(super) entry: usize,
}

impl<const R: usize> Prepared<R> {
    /// Tabulates a simulation.
    pub(super) fn new(problem: &Problem) -> Self {
        let model = problem.model;
        let half_step_s = problem.time.step_s() / 2.0;
        let factors = StepFactors::new(model, half_step_s);
        let drag: Vec<f64> =
            model.damping.iter().zip(&model.rigid_velocity).map(|(damping, rigid)| damping * rigid).collect();
        let static_displacement: Vec<f64> = (0..model.modes())
            .map(|n| {
                let brake = if model.damps_rotation { drag[n] * model.rotation_rad_per_s } else { 0.0 };
                let mesh = model.mesh.first().map_or(0.0, |line| line[n] * model.static_mesh_force_n);
                let load = model.brake[n] * problem.brake_torque_nm - brake - mesh;
                // What turns freely is in balance already.
                if model.stiffness[n] == 0.0 { 0.0 } else { load / model.stiffness[n] }
            })
            .collect();
        let followed_speed = if model.damps_rotation { vec![0.0; model.modes()] } else { drag };
        let points_per_rad = problem.points_per_revolution / std::f64::consts::TAU;
        let angle: Vec<f64> = model.shapes.iter().map(|shape| shape[THETA_PINION] * points_per_rad).collect();
        let column = |r: usize| model.mesh.get(r).map_or(&[][..], |column| column.as_slice());
        let scales = Scales {
            half_step_s,
            external: [model.motor.clone(), model.brake.clone(), followed_speed],
            static_displacement,
        };
        Self {
            rows: problem.outputs.iter().map(|output| output.row(model, &scales)).collect(),
            static_angle: sum(&angle, &scales.static_displacement) + 0.5,
            static_deflection: std::array::from_fn(|r| sum(column(r), &scales.static_displacement)),
            points_per_sample: problem.points_per_revolution
                / problem.time.samples_per_pinion_revolution as f64,
            angle,
            factors,
            scales,
        }
    }

    /// (rad, m) `share · column`: what a force in mesh direction `r` adds to each mode in a step.
    pub(super) fn push(&self, problem: &Problem, r: usize) -> Vec<f64> {
        problem.model.mesh.get(r).map_or_else(Vec::new, |column| self.share(column.as_slice()))
    }

    /// `h² E` times a modal force.
    pub(super) fn share(&self, force: &[f64]) -> Vec<f64> {
        self.factors.share.iter().zip(force).map(|(share, force)| share * force).collect()
    }

    fn scaled_velocity(&self, model: &ReducedModel) -> Vec<f64> {
        model.initial_velocity.iter().map(|velocity| velocity * self.scales.half_step_s).collect()
    }

    /// The mesh as a table, of a simulation whose law is one of tables.
    pub(super) fn table(&self, problem: &Problem) -> MeshTable<R> {
        problem.mesh.table(&Reduction {
            directions: &problem.model.directions,
            mean_stiffness: &problem.model.mean_mesh_stiffness,
            compliance: &self.factors.compliance,
        })
    }

    /// The displacement that the user gives for the start, relative to the one under the constant loads.
    fn given_displacement(&self, model: &ReducedModel) -> Option<Vec<f64>> {
        let given = model.initial_displacement.as_ref()?;
        let relative = given.iter().zip(&self.scales.static_displacement);
        Some(relative.map(|(given, at_rest)| given - at_rest).collect())
    }

    /// (m) Deflection in the mesh's directions.
    fn deflection(&self, model: &ReducedModel, displacement: &[f64]) -> [f64; R] {
        std::array::from_fn(|r| {
            let column = model.mesh.get(r).map_or(0.0, |column| sum(column.as_slice(), displacement));
            self.static_deflection[r] + column
        })
    }

    /// The state at the first simulated sample, under the law of contact: as given, or at rest but for the rigid rotation with the
    /// mesh closed. All that deforms is then as under the constant loads, and the freely turning train has turned until the pairs
    /// carry the load.
    ///
    /// # Arguments
    /// * `problem` - the simulation
    /// * `constants` - of its law
    /// * `sample`, `lane` - its pairs at that sample
    pub(super) fn first_state_in_contact<const L: usize>(
        &self,
        problem: &Problem,
        constants: &ContactConstants,
        sample: &ContactSample<L>,
        lane: usize,
    ) -> FirstState<R> {
        let model = problem.model;
        let z = sample.face_centre.0[lane];
        let displacement = self.given_displacement(model).unwrap_or_else(|| {
            let mut displacement = vec![0.0; model.modes()];
            let closed = deflection_at_rest(sample, lane, constants.static_force_n.max(0.0));
            if let (Some(turned), Some(line)) = (displacement.first_mut(), model.mesh.first()) {
                let tilted = if R > 1 { z * self.static_deflection[1] } else { 0.0 };
                *turned = (closed - self.static_deflection[0] - tilted) / line[0];
            }
            displacement
        });
        let scaled_velocity = self.scaled_velocity(model);
        let deflection = self.deflection(model, &displacement);
        let speed = model.mesh.first().map_or(0.0, |line| sum(line.as_slice(), &scaled_velocity));
        let tilted = if R > 1 { z * deflection[1] } else { 0.0 };
        let lead = constants.damping_time_s / self.scales.half_step_s * speed;
        let whole = force_on(constants, sample, lane, deflection[0] + tilted + lead);
        let mut force = [0.0; R];
        force[0] = whole;
        if R > 1 {
            force[1] = z * (whole - constants.static_force_n);
        }
        FirstState { displacement, scaled_velocity, force, entry: 0 }
    }

    /// The state at the first simulated sample, under a law of tables: as given, or the static equilibrium of the loaded mesh
    /// there.
    ///
    /// # Arguments
    /// * `problem` - the simulation
    /// * `table` - its mesh
    /// * `sample`, `lane` - force of the profile errors at that sample, in the mesh's directions, and entry of the mesh's table
    ///   there, where the motor's angle decides it
    /// * `external` - motor lead, torque deviation and speed deviation there
    pub(super) fn first_state<const L: usize>(
        &self,
        problem: &Problem,
        table: &MeshTable<R>,
        (sample, lane): (&TabulatedSample<L, R>, usize),
        external: &[f64; EXTERNALS],
    ) -> FirstState<R> {
        let model = problem.model;
        let errors = &sample.errors.map(|errors| errors.0[lane]);
        let known_entry = sample.entries[lane] as usize;
        let Some(displacement) = self.given_displacement(model) else {
            return self.equilibrium(problem, table, errors, external, known_entry);
        };
        let angle = self.static_angle + sum(&self.angle, &displacement);
        let rotation = problem.time.first_simulated_sample as f64 * self.points_per_sample;
        let entry = problem.mesh.cycle().map_or(known_entry, |cycle| cycle.entry(rotation + angle));
        let force = table.points[entry].force_on(errors, &self.deflection(model, &displacement));
        FirstState { displacement, scaled_velocity: self.scaled_velocity(model), force, entry }
    }

    /// No acceleration: `ω² q = B w + p` with `w = −(f + S' y)` and p the externals' and the damping's force. A problem of the
    /// size of the mesh's directions, `w = −(1 + S' Γ₀)⁻¹ (f + S' y₀)` with `Γ₀ = Bᵀ ω⁻² B` and y₀ the deflection without
    /// w.
    fn equilibrium(
        &self,
        problem: &Problem,
        table: &MeshTable<R>,
        errors: &[f64; R],
        external: &[f64; EXTERNALS],
        entry: usize,
    ) -> FirstState<R> {
        let model = problem.model;
        let columns = model.mesh.len();
        let stiffness = DVector::from_column_slice(&model.stiffness);
        let flexible: Vec<DVector<f64>> =
            model.mesh.iter().map(|column| column.component_div(&stiffness)).collect();
        let compliance = DMatrix::from_fn(columns, columns, |r, c| model.mesh[r].dot(&flexible[c]));
        let forces = externals(self);
        let alone = DVector::from_fn(model.modes(), |n, _| {
            let driven = forces.iter().zip(external).map(|(force, value)| force[n] * value);
            (driven.sum::<f64>() - model.damping[n] * model.initial_velocity[n]) / model.stiffness[n]
        });
        let deflection_alone =
            DVector::from_fn(columns, |r, _| self.static_deflection[r] + model.mesh[r].dot(&alone));
        let force = table.points[entry].static_force(errors, &deflection_alone, &compliance);
        let mut displacement = alone;
        for (column, force) in flexible.iter().zip(force.iter()) {
            displacement.axpy(*force, column, 1.0);
        }
        FirstState {
            displacement: displacement.as_slice().to_vec(),
            scaled_velocity: self.scaled_velocity(model),
            force: std::array::from_fn(|r| force.get(r).copied().unwrap_or(0.0)),
            entry,
        }
    }
}

/// Modal force of each external, of a simulation.
pub(super) fn externals<const R: usize>(prepared: &Prepared<R>) -> [&[f64]; EXTERNALS] {
    std::array::from_fn(|x| prepared.scales.external[x].as_slice())
}

/// `Σ a_n b_n`.
pub(super) fn sum(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
