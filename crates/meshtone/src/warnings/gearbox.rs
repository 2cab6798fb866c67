//! Warnings about a gearbox's simulation: those of a pair, mesh by mesh.

use std::f64::consts::TAU;

use super::of_signals::{long_step, other_speed, resonance};
use super::step_error::{StepJudgement, step_error_of_gearbox};
use super::{largest_torque, overload, unsettled, words_of};
use crate::error::{ScenarioWarning, WarningKind};
use crate::mesh::Mesh;
use crate::sensor::SignalSource;
use crate::simulate::{GearboxSimulation, GearboxStages};
use crate::wheel::unused_slices;

/// (-) How near a multiple of a mesh frequency may come to a natural frequency without a warning.
const NEAR: f64 = 0.01;
/// Multiples of a mesh frequency that are looked at: the strongest.
const MULTIPLES: u32 = 3;
/// (-) Part of its strain energy that a mode must have in a mesh to be set in motion there: most bending modes have less.
const LEAST_ENERGY: f64 = 1e-3;

impl GearboxStages {
    /// Warnings about stages that can be simulated: those of [`Gearbox::validate`](crate::scenario::Gearbox::validate), a settling too
    /// short for the slowest mode, a load that would break teeth, a mesh frequency that meets a natural frequency.
    pub fn warnings(&self) -> Vec<ScenarioWarning> {
        let (operation, solver) = (&self.gearbox.operation.drive, &self.gearbox.solver.settings);
        let unsettled = unsettled(&self.slowest_mode, &self.time, operation, solver, words_of);
        let of_scenario = self.warnings_of_scenario.iter().cloned();
        of_scenario
            .chain(self.unused_slices())
            .chain(unsettled)
            .chain(self.overloads())
            .chain(self.resonances())
            .collect()
    }

    /// Slices that the faces are not cut into.
    fn unused_slices(&self) -> impl Iterator<Item = ScenarioWarning> {
        self.meshes.iter().enumerate().filter_map(|(number, mesh)| {
            unused_slices(&self.layout.named_gears(&self.gearbox, number), mesh.slices())
        })
    }

    /// Teeth that the load would bend off, mesh by mesh.
    fn overloads(&self) -> impl Iterator<Item = ScenarioWarning> {
        let (key, torque_nm) = largest_torque(&self.gearbox.operation.drive);
        let forces_n = self.forces_of_torque_n(torque_nm).into_iter();
        let meshes = self.gearbox.meshes.iter().zip(&self.meshes).zip(&self.layout.gears);
        forces_n.zip(meshes).filter_map(move |(force_n, ((of_file, mesh), gears))| {
            let teeth = format!("the teeth of mesh {}", of_file.name());
            overload(&teeth, key.clone(), torque_nm, force_n, mesh.mean_stiffness_n_per_m, gears)
        })
    }

    /// Modes that the meshes deform and whose frequency is nearly a multiple of a mesh frequency.
    fn resonances(&self) -> Option<ScenarioWarning> {
        if !self.is_steady() {
            return None;
        }
        let speed_hz = self.gearbox.operation.drive.pinion_speed_hz;
        let mesh_hz: Vec<f64> =
            self.meshes.iter().map(|mesh| mesh.turning.pitches_per_revolution * speed_hz).collect();
        let closed: Vec<_> = self.meshes.iter().map(Mesh::closed).collect();
        // Without the higher modes the frequencies are 0.1 % off.
        let highest_hz = 4.0 * f64::from(MULTIPLES) * mesh_hz.iter().copied().fold(0.0, f64::max);
        let mut found = Vec::new();
        for mode in self.modal_machine().closed_modes(&closed, TAU * highest_hz) {
            let natural_hz = mode.decay.frequency_hz;
            for (mesh, (mesh_hz, energy)) in mesh_hz.iter().zip(&mode.mesh_energies).enumerate() {
                let multiple = (1..=MULTIPLES)
                    .find(|&multiple| (natural_hz / (f64::from(multiple) * mesh_hz) - 1.0).abs() < NEAR);
                if let Some(multiple) = multiple.filter(|_| *energy > LEAST_ENERGY) {
                    let (name, order) = (self.gearbox.meshes[mesh].name(), f64::from(multiple) * mesh_hz);
                    found.push(format!(
                        "{natural_hz:.1} Hz by {order:.1} Hz, {multiple} times that of mesh {name}"
                    ));
                }
            }
        }
        (!found.is_empty()).then(|| {
            let message = format!(
                "mesh frequencies coincide with natural frequencies within 1 %: {}; there the vibration \
                 depends on damping and on small changes of speed",
                found.join(", ")
            );
            ScenarioWarning::new(WarningKind::MeshResonance, "operation.input_speed_hz", message)
        })
    }
}

impl GearboxSimulation {
    /// Warnings that the signals cause: a mesh force beyond all measure, a shaft that does not turn at the speed that it is driven at, a
    /// step too long for a resonance.
    ///
    /// # Arguments
    /// * `judgement` - how the step is judged where a resonance is suspected
    pub fn warnings_of_signals(&self, judgement: StepJudgement) -> Vec<ScenarioWarning> {
        let (stages, channels) = (&self.stages, &self.channels);
        let (_, torque_nm) = largest_torque(&stages.gearbox.operation.drive);
        let static_n = stages.forces_of_torque_n(torque_nm);
        let meshes = stages.gearbox.meshes.iter().zip(static_n).enumerate();
        let forces = meshes.filter_map(|(number, (mesh, static_n))| {
            let force_n = channels.of(SignalSource::MeshForce(number));
            let largest_n = force_n.iter().fold(0.0, |most: f64, force| most.max(force.abs()));
            let name = format!("mesh {}", mesh.name());
            resonance(&name, "operation.input_speed_hz", largest_n, static_n)
        });
        let driven = stages.motion().skip(stages.time.first_kept_sample).take(channels.len());
        let driven_hz = driven.map(|motion| motion.speed_hz).sum::<f64>() / channels.len() as f64;
        let shafts = stages.gearbox.shafts.iter().zip(&stages.layout.ratios).enumerate();
        let speeds = shafts.filter_map(|(number, (shaft, ratio))| {
            let speed_hz = channels.of(SignalSource::ShaftSpeed(number));
            let mean_hz = speed_hz.iter().sum::<f64>() / speed_hz.len() as f64;
            other_speed(&format!("shaft {:?}", shaft.name), driven_hz * ratio.value().abs(), mean_hz.abs())
        });
        let rate_hz = channels.sampling_rate_hz;
        let step = step_error_of_gearbox(self, judgement).and_then(|error| long_step(error, rate_hz));
        forces.chain(speeds).chain(step).collect()
    }
}
