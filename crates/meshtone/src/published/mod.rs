//! The published model: what the published code simulates, its known errors included, so that results can be compared number by number.
//!
//! It is a guest: all that only it needs is here, from its teeth to its own solver, and nothing here is needed by the other models. Its
//! differences from the theory of its own paper are listed in the chapter "Published, linear and contact" of the documentation.

pub mod compliance;
mod cycle;
pub mod damage;
pub mod machine;
pub mod mesh;
mod motion;
mod newmark;
mod teeth;
mod trace;

pub(crate) use newmark::integrate;
#[cfg(feature = "internals")]
pub use teeth::relieved_teeth;
pub use teeth::teeth;

use std::f64::consts::TAU;
use std::ops::Range;

use machine::coordinates::{CoordinateVector, THETA_BRAKE, THETA_PINION};
use machine::{Forcing, Machine};
use mesh::{ErrorForce, PairCurve, PublishedMesh};

use crate::damage::DamagedTooth;
use crate::error::{self, ScenarioError};
use crate::machine::DecayingMode;
use crate::mesh::MeshCurve;
use crate::mesh::curve::in_cycle;
use crate::operation::TimeGrid;
use crate::scenario::Scenario;
use crate::wheel::{ProfileErrors, Teeth};

/// A simulation by the published model, before its time loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Published {
    /// The mesh over its cycle.
    pub mesh: PublishedMesh,
    /// The equations of motion.
    pub machine: Machine,
    scenario: Scenario,
    time: TimeGrid,
    profile_errors: Option<ProfileErrors>,
}

impl Published {
    /// What the published model has of its own before the time loop: fault, mesh and machine.
    ///
    /// # Arguments
    /// * `scenario` - valid, with what the model ignores at its default
    /// * `time` - division of time
    /// * `teeth` - by [`teeth`]
    /// * `profile_errors` - of both wheels
    ///
    /// # Errors
    /// A fault that does not fit the tooth, foundation coefficients with which the healthy pair would not be stiff.
    pub(crate) fn new(
        scenario: &Scenario,
        time: &TimeGrid,
        teeth: &Teeth,
        profile_errors: Option<&ProfileErrors>,
    ) -> Result<Self, ScenarioError> {
        let damage = scenario.faults.first().and_then(|fault| fault.sized(teeth));
        let fault = damage.map(|damage| damage::geometry(&damage, teeth, scenario.seed)).transpose()?;
        let gears = scenario.gears();
        let mesh = PublishedMesh::new(&gears, teeth, fault, cycle::grid(scenario, &gears))?;
        let parts = scenario.expect_pair()?.rig_parts(&gears).ok_or_else(error::nothing_left)?;
        let machine = Machine::new(parts, teeth, &mesh.load);
        let (scenario, profile_errors) = (scenario.clone(), profile_errors.cloned());
        Ok(Self { mesh, machine, scenario, time: *time, profile_errors })
    }

    /// What is left of the gear's first tooth, where it is damaged.
    pub(crate) fn damaged_tooth(&self, teeth: &Teeth) -> Option<DamagedTooth> {
        self.mesh.fault.as_ref().map(|fault| fault.damaged_tooth(teeth))
    }

    /// The stiffness of the mesh: over one gear revolution, or over some pitches, counted from the start of the simulation.
    pub(crate) fn mesh_curve(&self, pitches: Option<Range<i64>>) -> MeshCurve {
        let (mesh, points_per_pitch) = (&self.mesh.stiffness, self.mesh.grid.points_per_pitch);
        let cycle = &mesh.mesh_n_per_mm;
        let shown = pitches.map_or(0..cycle.len(), |pitches| {
            let points = points_per_pitch as i64;
            in_cycle(pitches.start * points..pitches.end * points, cycle.len())
        });
        MeshCurve {
            points_per_pitch,
            stiffness_n_per_mm: cycle.iter().cycle().skip(shown.start).take(shown.len()).copied().collect(),
            healthy_stiffness_n_per_mm: mesh.healthy_mesh_n_per_mm.clone(),
            mean_stiffness_n_per_mm: mesh.mean_n_per_mm(),
            face_load_factor: None,
        }
    }

    /// (N/m) Mean stiffness of the mesh.
    pub(crate) fn mean_stiffness_n_per_m(&self) -> f64 {
        self.mesh.stiffness.mean_n_per_mm() * 1e3
    }

    /// (N/mm) Stiffness of a healthy pair, and of the faulty one, where there is one.
    ///
    /// # Arguments
    /// * `positions_rev` - (rev) pinion revolutions since the pair entered contact
    pub(crate) fn pair_stiffness_n_per_mm(&self, positions_rev: &[f64]) -> [Option<Vec<f64>>; 2] {
        let pair = &self.mesh.pair;
        let at_all = |curve: PairCurve| positions_rev.iter().map(|&position| curve.at(position)).collect();
        let faulty = self.mesh.fault.is_some().then(|| pair.faulty_curve());
        [Some(at_all(pair.healthy_curve())), faulty.map(at_all)]
    }

    /// (Hz) Natural frequencies, rising: of the mean mesh.
    pub(crate) fn natural_frequencies_hz(&self) -> Vec<f64> {
        self.machine.natural_frequencies_hz().as_slice().to_vec()
    }

    /// Mode shapes in the same order, of unit modal mass.
    pub(crate) fn mode_shapes(&self) -> Vec<Vec<f64>> {
        self.machine.mode_shapes().column_iter().map(|shape| shape.iter().copied().collect()).collect()
    }

    /// The mode in motion that decays most slowly.
    pub(crate) fn slowest_mode(&self) -> DecayingMode {
        self.machine.slowest_mode(&self.moving_coordinates())
    }

    /// Whether the wheels have the same mass and start from rest, so that all that happens to one happens to the other.
    fn wheels_move_in_opposition(&self) -> bool {
        let solver = &self.scenario.solver;
        self.machine.pinion.mass_kg == self.machine.gear.mass_kg
            && solver.initial_displacement.is_none()
            && solver.initial_velocity.is_none()
    }

    /// (m, rad) Displacement at the start in the 13 coordinates.
    fn initial_displacement(&self) -> CoordinateVector {
        self.scenario.solver.initial_displacement.map_or_else(CoordinateVector::zeros, Into::into)
    }

    /// (m/s, rad/s) Velocity at the start relative to the rigid rotation at the nominal speed.
    fn initial_relative_velocity(&self) -> CoordinateVector {
        let rigid = self.machine.rigid_rotation() * self.nominal_speed_rad_per_s();
        self.scenario
            .solver
            .initial_velocity
            .map_or_else(CoordinateVector::zeros, |given| CoordinateVector::from(given) - rigid)
    }

    fn nominal_speed_rad_per_s(&self) -> f64 {
        TAU * self.scenario.operation.pinion_speed_hz
    }

    /// The turned coordinates that motor, brake or the motion at the start set in motion, or that are coupled to one of these.
    fn moving_coordinates(&self) -> Vec<usize> {
        let start = [self.initial_displacement(), self.initial_relative_velocity()]
            .map(|motion| self.machine.turned(&motion));
        let is_driven = |&n: &usize| {
            [THETA_PINION, THETA_BRAKE].contains(&n) || start.iter().any(|motion| motion[n] != 0.0)
        };
        let groups = self.machine.coupled_coordinates();
        groups.into_iter().filter(|group| group.iter().any(is_driven)).flatten().collect()
    }

    /// What forces the equations of motion, sample by sample from the start and without end.
    pub fn forcing(&self) -> impl Iterator<Item = Forcing> {
        let errors = ErrorForce::new(&self.mesh, self.profile_errors.as_ref());
        motion::motion(&self.scenario, &self.time).map(move |motion| Forcing {
            motor_angle_rad: TAU * motion.revolutions,
            brake_torque_nm: motion.torque_nm,
            error_force_n: errors.at(motion.revolutions),
            error_mean_z_m: -self.mesh.missing_width_mm(motion.revolutions) * 1e-3 / 2.0,
        })
    }

    /// (N, N m; N) Force in the 13 coordinates and the deviations' force in it, sample by sample.
    pub(crate) fn forces(&self) -> impl Iterator<Item = (CoordinateVector, f64)> {
        self.forcing().map(|forcing| (self.machine.force(&forcing), forcing.error_force_n))
    }
}
