//! The equations of motion: of a machine around meshes, or of the published model. Only this file tells them apart.

use std::f64::consts::TAU;
use std::ops::Range;

use super::Stages;
use crate::error::Error;
use crate::machine::{ClosedMesh, DecayingMode, Modes, SupportMode, Train, WheelBody};
use crate::mesh::{Forcing, Mesh, MeshCurve, PairDeviations};
use crate::published::{self, Published};
use crate::simd::InstructionSet;
use crate::solver::{InitialMotion, ModalMachine, Output, Problem, Recorder, SteppedAlone, integrate};
use crate::trace_fields::Trace;
use crate::wheel::WheelName;

/// The equations of motion.
#[doc(hidden)]
#[derive(Clone, PartialEq)]
pub enum Equations {
    /// A machine around meshes, and its modes without these.
    Machine(Box<Train>, Modes),
    /// Those of the published model, with its mesh.
    Published(Box<Published>),
}

impl Stages {
    /// The machine around the meshes and its modes; none under the published model.
    pub(super) fn train(&self) -> Option<(&Train, &Modes)> {
        match &self.equations {
            Equations::Machine(train, modes) => Some((train, modes)),
            Equations::Published(_) => None,
        }
    }

    /// Number of the coordinates in which the equations of motion are written.
    pub(crate) fn coordinates(&self) -> usize {
        match &self.equations {
            Equations::Machine(train, _) => train.machine.coordinates(),
            Equations::Published(published) => published.machine.mass.len(),
        }
    }

    /// Mass and inertias of the pinion and of the gear.
    pub(crate) fn wheel_bodies(&self) -> [WheelBody; 2] {
        match &self.equations {
            Equations::Machine(train, _) => train.wheels,
            Equations::Published(published) => [published.machine.pinion, published.machine.gear],
        }
    }

    /// (N m/rad) Torsional stiffness of the pinion's and of the gear's shaft.
    pub(crate) fn shaft_stiffness_nm_per_rad(&self) -> [f64; 2] {
        match &self.equations {
            Equations::Machine(train, _) => train.shaft_stiffness_nm_per_rad,
            Equations::Published(published) => published.machine.shaft_stiffness_nm_per_rad,
        }
    }

    /// (Hz) Natural frequencies, rising: of the mean meshes, closed.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        match &self.equations {
            Equations::Machine(train, _) => train.machine.closed_modes(&self.mean_stiffness_n_per_m()).0,
            Equations::Published(published) => published.natural_frequencies_hz(),
        }
    }

    /// Mode shapes in the order of [`Self::natural_frequencies_hz`], of unit modal mass: for each mode a number for each coordinate.
    pub fn mode_shapes(&self) -> Vec<Vec<f64>> {
        match &self.equations {
            Equations::Machine(train, _) => {
                let (_, shapes) = train.machine.closed_modes(&self.mean_stiffness_n_per_m());
                shapes.column_iter().map(|shape| shape.iter().copied().collect()).collect()
            }
            Equations::Published(published) => published.mode_shapes(),
        }
    }

    /// The modes in which the supports move much, in rising order, of the mean meshes, closed; none where the supports are held.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let modes = meshtone::stages(&Scenario::new(GearPair::example()))?.support_modes();
    /// let highest = modes[modes.len() - 1];
    /// assert!(!highest.is_alike && (highest.frequency_hz - 3000.0).abs() < 150.0);
    /// # Ok::<(), meshtone::Error>(())
    /// ```
    pub fn support_modes(&self) -> Vec<SupportMode> {
        self.train().map_or_else(Vec::new, |(train, _)| train.support_modes(&self.mean_stiffness_n_per_m()))
    }

    /// (N/m) Mean stiffness of each mesh.
    pub(crate) fn mean_stiffness_n_per_m(&self) -> Vec<f64> {
        match &self.equations {
            Equations::Machine(..) => self.meshes.iter().map(|mesh| mesh.mean_stiffness_n_per_m).collect(),
            Equations::Published(published) => vec![published.mean_stiffness_n_per_m()],
        }
    }

    pub(super) fn curves_of(&self, meshes: &[Mesh], pitches: Option<Range<i64>>) -> Vec<MeshCurve> {
        match &self.equations {
            Equations::Machine(..) => meshes.iter().map(|mesh| mesh.curve(pitches.clone())).collect(),
            Equations::Published(published) => vec![published.mesh_curve(pitches)],
        }
    }

    /// (N/mm) Stiffness of the meshes where each damaged tooth passes: over a turn of the wheel that has more teeth.
    pub(crate) fn stiffness_over_a_turn_n_per_mm(&self) -> Vec<f64> {
        match &self.equations {
            Equations::Machine(..) => {
                // Every tooth of both has met another by then.
                let pitches = WheelName::BOTH.map(|wheel| self.teeth.wheel(wheel).teeth as usize);
                let over = 0..pitches[0].max(pitches[1]);
                self.meshes.iter().flat_map(|mesh| mesh.stiffness_n_per_mm(over.clone())).collect()
            }
            Equations::Published(published) => published.mesh_curve(None).stiffness_n_per_mm,
        }
    }

    /// (N/mm) Stiffness of a sound pair of teeth, and of the first damaged tooth with a sound mate, where there is one.
    ///
    /// # Arguments
    /// * `positions_rev` - (rev) pinion revolutions since the pair entered contact
    pub(crate) fn pair_stiffness_n_per_mm(&self, positions_rev: &[f64]) -> [Option<Vec<f64>>; 2] {
        match &self.equations {
            Equations::Machine(..) => self.mesh_pair_stiffness_n_per_mm(positions_rev),
            Equations::Published(published) => published.pair_stiffness_n_per_mm(positions_rev),
        }
    }

    /// Traces the matrices of the machine without the meshes, and with the mean ones closed.
    pub(crate) fn trace_matrices(&self, trace: &mut Trace) {
        let Some((train, modes)) = self.train() else { return };
        let machine = &train.machine;
        let size = machine.coordinates();
        trace.vector("mass_diagonal", machine.mass.diagonal().iter().copied());
        let mean = machine.closed_stiffness(&self.mean_stiffness_n_per_m());
        for (name, matrix) in [
            ("damping_matrix", modes.damping_matrix(machine)),
            ("stiffness_matrix_open", machine.turn_back(&machine.stiffness())),
            ("stiffness_matrix_mean", machine.turn_back(&mean)),
        ] {
            trace.matrix(name, size, size, |r, c| matrix[(r, c)]);
        }
    }

    /// Traces what only the published model has: its matrices, the fault and the forces.
    pub(crate) fn trace_of_published(&self, trace: &mut Trace) {
        if let Equations::Published(published) = &self.equations {
            published.trace(trace);
        }
    }

    /// The slowest mode in motion, with the mean meshes closed.
    pub(crate) fn slowest_mode(&self) -> DecayingMode {
        match &self.equations {
            Equations::Machine(train, modes) => {
                self.modal_machine(train, modes).slowest_closed(&self.closed_meshes(), f64::INFINITY)
            }
            Equations::Published(published) => published.slowest_mode(),
        }
    }

    /// The meshes as if they were closed always.
    pub(crate) fn closed_meshes(&self) -> Vec<ClosedMesh> {
        self.meshes.iter().map(Mesh::closed).collect()
    }

    /// As [`Self::integrate`], with given vector instructions.
    pub(crate) fn integrate_with(
        &self,
        instructions: InstructionSet,
        outputs: &[Output],
        first_sample: usize,
        recorder: &mut dyn Recorder,
    ) -> Result<(), Error> {
        let result = match &self.equations {
            Equations::Machine(train, modes) => {
                integrate(self.problem(train, modes, outputs, first_sample), instructions, recorder)
            }
            Equations::Published(published) => {
                published::integrate(published, outputs, first_sample, recorder)
            }
        };
        result.map_err(|diverged| self.divergence(diverged))
    }

    /// The simulation as it is solved side by side with others.
    ///
    /// # Arguments
    /// * `outputs` - what is read off the solution, of the kept samples
    ///
    /// # Errors
    /// It is solved alone, with the reason.
    pub(crate) fn lane<'a>(&'a self, outputs: &'a [Output]) -> Result<Problem<'a>, SteppedAlone> {
        let (train, modes) = self.train().ok_or(SteppedAlone::PublishedModel)?;
        let problem = self.problem(train, modes, outputs, self.time.first_kept_sample);
        problem.stepped_alone().map_or(Ok(problem), Err)
    }

    /// Why a batch steps the simulation alone, which takes several times as long; none where it steps it side by side with others.
    pub fn stepped_alone(&self) -> Option<SteppedAlone> {
        match self.train() {
            Some((train, modes)) => SteppedAlone::of(&self.modal_machine(train, modes), self.meshes.iter()),
            None => Some(SteppedAlone::PublishedModel),
        }
    }

    /// The simulation as the solver sees it.
    fn problem<'a>(
        &'a self,
        train: &Train,
        modes: &Modes,
        outputs: &'a [Output],
        first_sample: usize,
    ) -> Problem<'a> {
        let operation = &self.scenario.operation;
        let deviations = || PairDeviations {
            teeth: &self.teeth,
            errors: self.profile_errors.as_ref(),
            eccentricity_m: self.scenario.rig.eccentricity_mm * 1e-3,
            run_out: self.run_out,
        };
        Problem {
            time: &self.time,
            machine: self.modal_machine(train, modes),
            bearings: Vec::new(),
            laws: self.meshes.iter().map(Mesh::law).collect(),
            forcing: Forcing::new(
                self.scenario.motion(&self.time),
                &self.time,
                [operation.pinion_speed_hz, operation.brake_torque_nm],
                self.time.first_simulated_sample,
                self.meshes.iter().map(|mesh| (mesh, deviations())),
            )
            .with_turning_forces(&train.machine.turning_forces),
            is_steady: self.is_steady(),
            hunting_period_samples: self
                .is_steady()
                .then(|| self.time.hunting_period_samples(&self.scenario.gears)),
            outputs,
            first_sample,
        }
    }

    /// The machine in the modes that take part in the motion.
    pub(crate) fn modal_machine(&self, train: &Train, modes: &Modes) -> ModalMachine {
        let operation = &self.scenario.operation;
        let first_speed = operation.speed_profile_hz.as_ref().map(|profile| profile.value[0]);
        let face_reach_m: Vec<f64> = self.meshes.iter().map(Mesh::face_reach_m).collect();
        let start = InitialMotion {
            nominal_rad_per_s: TAU * operation.pinion_speed_hz,
            brake_torque_nm: operation.brake_torque_nm,
            motor_rad_per_s: TAU * first_speed.unwrap_or(operation.pinion_speed_hz),
            velocity: self.scenario.solver.initial_velocity.as_ref().map(|given| given.as_slice()),
        };
        ModalMachine::new(&train.machine, modes, &face_reach_m, start)
    }

    /// The key of the damping that a growing motion lacks, and the damping ratios.
    pub(super) fn damping(&self) -> (&'static str, Vec<f64>) {
        match self.train() {
            // The shafts' as well.
            Some((_, modes)) if self.teeth_part() => {
                ("rig.support.damping_ratio", modes.damping_ratio.clone())
            }
            _ => ("rig.damping_ratio", self.scenario.rig.damping_ratio.per_mode().to_vec()),
        }
    }
}
