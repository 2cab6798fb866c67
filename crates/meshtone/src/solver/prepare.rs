//! Everything about a simulation that does not change from step to step, and its first state.

use super::gyroscopic::{Gyroscopic, Pushes};
use super::integrate::{MotionState, Problem};
use super::modal::ModalMachine;
use super::mode_step::StepOfMode;
use super::outputs::{EXTERNALS, OutputWeights, dot, external_forces};
use crate::bearing::RollingBearing;
use crate::mesh::{ForcingBlock, MeshLaw, SpringSamples, deflection_at_rest};

/// The constants of one simulation's steps; its columns are those of [`ModalMachine::columns`], each with its unknown, those across the lines in which
/// friction acts, two of each mesh, and then the tilts about x and y of what spins.
pub(super) struct Prepared {
    /// (s) Δt.
    step_s: f64,
    /// How each mode is stepped.
    steps: Vec<StepOfMode>,
    /// (-) Change of `Δt² q̈` per predicted displacement of each mode.
    pub(super) restore: Vec<f64>,
    /// (-) The same per predicted `Δt q̇`.
    pub(super) damp: Vec<f64>,
    /// `Δt² q̈` per unit of each external.
    pub(super) external_push: [Vec<f64>; EXTERNALS],
    /// `Δt² q̈` per unit of each force that turns with a shaft, see [`ModalTurningForce`](super::modal::ModalTurningForce).
    pub(super) turning_push: Vec<[Vec<f64>; 2]>,
    /// Each column.
    pub(super) columns: Vec<Column>,
    /// Of each mesh whose tilt is an unknown, the number of its column.
    pub(super) tilt_of_mesh: Vec<Option<usize>>,
    /// Number of the first column in which friction acts, and of the unknowns, which are the deflections in the columns before; as many as there are columns without friction.
    pub(super) first_across: usize,
    /// Number of the first column in which a gyroscopic moment acts: it is what [`Column`] has of the step's end, plus [`Self::compliance`] times the forces
    /// in the columns before.
    pub(super) first_spinning: usize,
    /// (m/N) G: deflection, with its damping's lead, in each column per force of the step in each.
    pub(super) compliance: Vec<Vec<f64>>,
    /// The outputs.
    pub(super) outputs: Vec<OutputWeights>,
    /// The law of each mesh.
    pub(super) laws: Vec<MeshLaw>,
    /// The rolling bearings.
    pub(super) bearings: Vec<RollingBearing>,
    /// (N) Force of each mesh under the constant loads.
    pub(super) static_force_n: Vec<f64>,
    /// (m √kg) How far each mode may move.
    pub(super) largest_displacement: Vec<f64>,
}

/// One column of a line of action, and what the deflection in it at the end of a step, with its damping's lead, is without the step's
/// own force.
///
/// It is `D = B·(q + ℓ Δt q̇)` with ℓ = τ/Δt, hence a sum over what is predicted for the step's end. That but for the share of the
/// force at the step's start is known a step earlier. So the sum over the modes is made while that force is sought, and when it is
/// found only its product with one number is left: without that a step of a single simulation waits most of its time.
pub(super) struct Column {
    /// `Δt² q̈` of each mode per force.
    pub(super) push: Vec<f64>,
    /// (m) Deflection under the constant loads.
    pub(super) static_deflection: f64,
    /// `B (1 − (β + ℓ/2) e_y)`, per predicted displacement.
    pub(super) of_displacement: Vec<f64>,
    /// `B (ℓ − (β + ℓ/2) e_v)`, per predicted `Δt q̇`.
    pub(super) of_velocity: Vec<f64>,
    /// (m/N) Per force at the step's start in each column.
    pub(super) of_force: Vec<f64>,
    /// Per external at the step's end.
    pub(super) of_external: [f64; EXTERNALS],
    /// Per unit of each force that turns with a shaft, at the step's end.
    pub(super) of_turning: Vec<[f64; 2]>,
}

/// What a step has of the first sample.
pub(super) struct FirstState {
    /// Predicted displacements.
    pub(super) displacement: Vec<f64>,
    /// Predicted `Δt q̇`.
    pub(super) velocity: Vec<f64>,
    /// `Δt² q̈`.
    pub(super) acceleration: Vec<f64>,
    /// (N) Force in each column.
    pub(super) force: Vec<f64>,
}

impl Prepared {
    /// The constants of a simulation.
    ///
    /// Follows the equations of [`super::step`]: the factors of each mode first, then what they make of a force in each column of the
    /// lines of action.
    ///
    /// # Arguments
    /// * `problem` - the simulation
    /// * `speed` - (-) of the motor over the nominal one, for gyroscopic moments
    pub(super) fn new(problem: &Problem, speed: f64) -> Self {
        let model = &problem.machine;
        let step_s = problem.time.step_s();
        let steps = model.steps(&problem.laws, step_s);
        let of_steps = |of: fn(&StepOfMode) -> f64| steps.iter().map(of).collect::<Vec<f64>>();
        let (restore, damp) = (of_steps(StepOfMode::of_displacement), of_steps(StepOfMode::of_velocity));
        let yielding = |(step, force): (&StepOfMode, &f64)| {
            step_s * step_s * step.force_factor * step.yielding() * force
        };
        let pushed = |force: &[f64]| steps.iter().zip(force).map(yielding).collect::<Vec<f64>>();
        let external_push = external_forces(model).map(|force| pushed(&force));
        let turning_push: Vec<[Vec<f64>; 2]> =
            model.turning_forces.iter().map(|force| force.at.each_ref().map(|at| pushed(at))).collect();
        // (-) ℓ of each column; the damping of a bearing is that of its linear spring, in the modes.
        let lead = |mesh: usize| problem.laws[mesh].damping_time_s / step_s;
        let lines: Vec<(&[f64], f64)> =
            model.columns().map(|(column, mesh)| (column, mesh.map_or(0.0, lead))).collect();
        let first_across = lines.len();
        let of_friction =
            model.lines.iter().filter(|_| problem.has_friction()).filter_map(|line| line.across.as_ref());
        let lines: Vec<(&[f64], f64)> =
            lines.into_iter().chain(of_friction.flatten().map(|column| (column.as_slice(), 0.0))).collect();
        let first_spinning = lines.len();
        let pushes: Vec<Vec<f64>> = lines.iter().map(|(line, _)| pushed(line)).collect();
        let spinning_pushes: Vec<Vec<f64>> =
            model.spinning.iter().flat_map(|of| &of.tilts).map(|tilt| pushed(tilt)).collect();
        let column = |((line, lead), push): (&(&[f64], f64), &Vec<f64>)| {
            let of_modes =
                |of: &dyn Fn(usize) -> f64| (0..steps.len()).map(|n| line[n] * of(n)).collect::<Vec<f64>>();
            let ahead = |n: usize| steps[n].beta + lead / 2.0;
            let of_acceleration = of_modes(&ahead);
            let of_displacement = of_modes(&|n| 1.0 + ahead(n) * restore[n]);
            let of_velocity = of_modes(&|n| lead + ahead(n) * damp[n]);
            let all_pushes = pushes.iter().chain(&spinning_pushes);
            let compliance: Vec<f64> = all_pushes.map(|push| dot(&of_acceleration, push)).collect();
            let column = Column {
                push: push.clone(),
                static_deflection: dot(line, &model.static_displacement),
                of_force: pushes
                    .iter()
                    .map(|push| dot(&of_displacement, push) + dot(&of_velocity, push))
                    .collect(),
                of_external: external_push.each_ref().map(|push| dot(&of_acceleration, push)),
                of_turning: turning_push
                    .iter()
                    .map(|of| of.each_ref().map(|push| dot(&of_acceleration, push)))
                    .collect(),
                of_displacement,
                of_velocity,
            };
            (column, compliance)
        };
        let (mut columns, mut compliance): (Vec<Column>, Vec<Vec<f64>>) =
            lines.iter().zip(&pushes).map(column).unzip();
        let residual = model.residual.of_columns();
        for (((column, compliance), residual), (_, lead)) in
            columns.iter_mut().zip(&mut compliance).zip(residual).zip(&lines)
        {
            compliance[..first_spinning]
                .iter_mut()
                .zip(residual.of_force)
                .for_each(|(compliance, residual)| *compliance += residual);
            column.static_deflection += residual.constant;
            let [of_motor, of_brake] = residual.of_drives;
            // Modes at rest follow the motor's speed too, and that is the damping's lead of their deflection.
            let of_external = [of_motor, of_brake, lead * step_s * of_motor];
            column
                .of_external
                .iter_mut()
                .zip(of_external)
                .for_each(|(external, residual)| *external += residual);
        }
        let spinning = Gyroscopic { model, steps: &steps, step_s, speed };
        let pushes = Pushes { moments: &spinning_pushes, externals: &external_push, turning: &turning_push };
        spinning.add_to(&mut columns, &mut compliance, [&restore, &damp], pushes);
        let tilts = model.lines.iter().filter(|line| line.to_end.is_some()).count();
        let mut tilts = first_across - tilts..first_across;
        let tilt_of_mesh =
            model.lines.iter().map(|line| line.to_end.as_ref().and_then(|_| tilts.next())).collect();
        Self {
            step_s,
            columns,
            tilt_of_mesh,
            first_across,
            first_spinning,
            compliance,
            outputs: (problem.outputs.iter())
                .map(|output| {
                    let mut weights = output.weights(model, &steps, step_s);
                    // Without friction nothing acts across the lines.
                    weights.force.truncate(first_spinning);
                    weights
                })
                .collect(),
            restore,
            damp,
            external_push,
            turning_push,
            laws: problem.laws.clone(),
            bearings: problem.bearings.clone(),
            static_force_n: model.lines.iter().map(|line| line.static_force_n).collect(),
            largest_displacement: model.largest_displacements(),
            steps,
        }
    }

    /// The modal displacement under the forces that turn with the shafts, as they stand at the first simulated sample, at rest.
    fn turned_at_rest(&self, model: &ModalMachine, block: &ForcingBlock) -> Vec<f64> {
        let forces = || model.turning_forces.iter().zip(&block.external.turning);
        let of_mode = |(n, stiffness): (usize, &f64)| {
            let force: f64 =
                forces().map(|(of, [cos, sin])| of.at[0][n] * cos[0] + of.at[1][n] * sin[0]).sum();
            if *stiffness > 0.0 { force / stiffness } else { 0.0 }
        };
        model.stiffness.iter().enumerate().map(of_mode).collect()
    }

    /// The state at the first simulated sample: with the given velocity, and the meshes closed at rest. All that deforms is then as
    /// under the constant loads and the torque with which a profile begins, and the shafts that turn freely have turned until the pairs carry the load.
    ///
    /// # Arguments
    /// * `model` - the machine
    /// * `block`, `springs` - whose first sample it is
    /// * `external` - the externals at that sample
    pub(super) fn first_state(
        &self,
        model: &ModalMachine,
        block: &ForcingBlock,
        springs: &[SpringSamples],
        external: [f64; EXTERNALS],
    ) -> FirstState {
        let (beside_n, beside) = model.balanced(external[1]);
        let turned: Vec<f64> = self
            .turned_at_rest(model, block)
            .iter()
            .zip(beside)
            .map(|(turned, beside)| turned + beside)
            .collect();
        let lines: Vec<&[f64]> = model.columns().map(|(column, _)| column).collect();
        let has_friction = self.first_across < self.first_spinning;
        let missing: Vec<f64> = (self.laws.iter().enumerate())
            .map(|(mesh, law)| {
                let force_n = (self.static_force_n[mesh] + beside_n[mesh]).max(0.0);
                let at_rest = |column: usize| self.columns[column].static_deflection;
                let closed = match self.tilt_of_mesh[mesh] {
                    None => deflection_at_rest(law.contact, springs[mesh].at(0), force_n),
                    Some(tilt) => {
                        let tilt_m = at_rest(tilt) + dot(lines[tilt], &turned);
                        law.tilted_at_rest(springs[mesh].at(0), tilt_m, force_n)
                    }
                };
                closed - at_rest(mesh) - dot(lines[mesh], &turned)
            })
            .collect();
        // All has turned by the motor's lead, as in a run-up that is not simulated from its start.
        let displacement: Vec<f64> =
            (model.turned_by(&missing).iter().zip(&turned).zip(&model.rigid_velocity))
                .map(|((closing, turned), rigid)| closing + turned + rigid * external[0])
                .collect();
        let (mut force, mut of_friction) = (Vec::with_capacity(self.columns.len()), Vec::new());
        let mut moments = Vec::new();
        for (mesh, law) in self.laws.iter().enumerate() {
            let deflection = |column: usize| {
                let at_rest = self.columns[column].static_deflection + dot(lines[column], &displacement);
                at_rest + law.damping_time_s * dot(lines[column], &model.initial_velocity)
            };
            let springs = springs[mesh].at(0);
            let carried = if let Some(tilt) = self.tilt_of_mesh[mesh] {
                let load = law.tilted(springs, [deflection(mesh), deflection(tilt)]);
                moments.push(-load.forces[1]);
                of_friction.extend(load.friction.iter().map(|friction| friction[0]).filter(|_| has_friction));
                load.forces[0]
            } else if has_friction {
                let (load, friction) = law.force_and_friction(springs, deflection(mesh));
                of_friction.extend(friction.map(|friction| friction[0]));
                load[0]
            } else {
                law.force_and_slope(springs, deflection(mesh))[0]
            };
            force.push(self.static_force_n[mesh] - carried);
        }
        for ((bearing, places), first) in
            self.bearings.iter().zip(&block.bearings).zip((force.len()..).step_by(2))
        {
            let stretch_m = [first, first + 1]
                .map(|column| self.columns[column].static_deflection + dot(lines[column], &displacement));
            force.extend(bearing.beside_spring(stretch_m, &places.places(0)).force_n.map(|beside| -beside));
        }
        force.extend(moments);
        force.extend(of_friction);
        for of in &model.spinning {
            let [about_x, about_y] = of.tilts.each_ref().map(|tilt| dot(tilt, &model.initial_velocity));
            force.extend([-of.momentum * about_y, of.momentum * about_x]);
        }
        self.state_of([&displacement, &model.initial_velocity], force, block, external)
    }

    /// (-) β of each mode.
    pub(super) fn betas(&self) -> Vec<f64> {
        self.steps.iter().map(|step| step.beta).collect()
    }

    /// The state of a motion that was kept, perhaps at another step.
    ///
    /// # Arguments
    /// * `state` - the motion at the first sample
    /// * `block`, `external` - as of [`Self::first_state`]
    pub(super) fn resumed_state(
        &self,
        state: &MotionState,
        block: &ForcingBlock,
        external: [f64; EXTERNALS],
    ) -> FirstState {
        let rates = state.velocity.iter().zip(&self.steps);
        let velocity: Vec<f64> = rates.map(|(rate, step)| rate / step.rate_factor()).collect();
        self.state_of([&state.displacement, &velocity], state.force.clone(), block, external)
    }

    /// The motion of a state, with the modes' own rates: those of another step's trapezium rule are others.
    ///
    /// # Arguments
    /// * `sample` - at which it is
    /// * `numbers` - predicted displacements, predicted `Δt q̇` and `Δt² q̈` of the modes
    /// * `force` - (N) in each column, and in columns that the machine has not got
    pub(super) fn motion_state(
        &self,
        sample: usize,
        [displacement, velocity, acceleration]: [Vec<f64>; 3],
        mut force: Vec<f64>,
    ) -> MotionState {
        force.truncate(self.columns.len());
        MotionState {
            sample,
            displacement: (self.steps.iter().enumerate())
                .map(|(n, step)| displacement[n] + step.beta * acceleration[n])
                .collect(),
            velocity: (0..self.steps.len())
                .map(|n| (velocity[n] + acceleration[n] / 2.0) / self.step_s * self.steps[n].rate_factor())
                .collect(),
            force,
        }
    }

    /// What a step has of a motion and its forces.
    fn state_of(
        &self,
        [displacement, velocity]: [&[f64]; 2],
        force: Vec<f64>,
        block: &ForcingBlock,
        external: [f64; EXTERNALS],
    ) -> FirstState {
        let acceleration: Vec<f64> = (self.steps.iter().enumerate())
            .map(|(n, step)| {
                let meshes: f64 =
                    self.columns.iter().zip(&force).map(|(column, force)| column.push[n] * force).sum();
                let driven: f64 =
                    self.external_push.iter().zip(external).map(|(push, external)| push[n] * external).sum();
                let turned: f64 = (self.turning_push.iter().zip(&block.external.turning))
                    .map(|(push, [cos, sin])| push[0][n] * cos[0] + push[1][n] * sin[0])
                    .sum();
                let scaled_force = (meshes + driven + turned) / step.yielding();
                step.acceleration(displacement[n], velocity[n] * self.step_s, scaled_force)
            })
            .collect();
        FirstState {
            displacement: (0..displacement.len())
                .map(|n| displacement[n] - self.steps[n].beta * acceleration[n])
                .collect(),
            velocity: (0..displacement.len())
                .map(|n| velocity[n] * self.step_s - acceleration[n] / 2.0)
                .collect(),
            acceleration,
            force,
        }
    }
}
