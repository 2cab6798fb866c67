//! The equations of motion: of a machine around meshes, or of the published model. Only this file tells them apart.

use std::f64::consts::TAU;
use std::ops::Range;

use super::{AssembledMachine, MeshedPair, Stages};
use crate::bearing::{BearingTurning, RollingBearing};
use crate::error::Error;
use crate::machine::{ClosedMesh, SupportMode, WheelBody, support_modes};
use crate::mesh::{Forcing, Mesh, MeshCurve, PairDeviations};
use crate::operation::{Motion, TimeGrid};
use crate::published::{self, Published};
use crate::scenario::Rig;
use crate::simd::InstructionSet;
use crate::solver::{ModalMachine, MotionState, Output, Problem, Recorder, SteppedAlone, integrate, resume};
use crate::trace_fields::Trace;

/// The equations of motion.
#[doc(hidden)]
#[derive(Clone, PartialEq)]
pub enum Equations {
    /// A machine around meshes, and the same in the modes that are stepped.
    Machine(Box<AssembledMachine>, Box<ModalMachine>),
    /// Those of the published model, with its mesh.
    Published(Box<Published>),
}

impl Stages {
    /// The machine around the meshes, and the same in the modes that are stepped; none under the published model.
    pub(crate) fn machine(&self) -> Option<(&AssembledMachine, &ModalMachine)> {
        match &self.equations {
            Equations::Machine(machine, modal) => Some((machine, modal)),
            Equations::Published(_) => None,
        }
    }

    /// The machine around the meshes, and its modes without them; none under the published model.
    #[cfg(feature = "internals")]
    #[doc(hidden)]
    pub fn machine_and_modes(&self) -> Option<(&crate::machine::Machine, &crate::machine::Modes)> {
        self.machine().map(|(machine, _)| (&machine.machine, &*machine.modes))
    }

    /// Number of the coordinates in which the equations of motion are written.
    pub(crate) fn coordinates(&self) -> usize {
        match &self.equations {
            Equations::Machine(machine, _) => machine.machine.coordinates(),
            Equations::Published(published) => published.machine.mass.len(),
        }
    }

    /// Mass and inertias of each wheel.
    pub(crate) fn wheel_bodies(&self) -> Vec<WheelBody> {
        match &self.equations {
            Equations::Machine(machine, _) => machine.wheels.clone(),
            Equations::Published(published) => vec![published.machine.pinion, published.machine.gear],
        }
    }

    /// (N m/rad) Torsional stiffness between each shaft and what it is coupled to.
    pub(crate) fn shaft_stiffness_nm_per_rad(&self) -> Vec<f64> {
        match &self.equations {
            Equations::Machine(machine, _) => machine.shaft_stiffness_nm_per_rad.clone(),
            Equations::Published(published) => published.machine.shaft_stiffness_nm_per_rad.to_vec(),
        }
    }

    /// (Hz) Natural frequencies of the machine with its meshes closed at their mean stiffness, rising; 0 of the whole train's free rotation,
    /// where nothing holds it.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        match &self.equations {
            Equations::Machine(..) => self.natural_frequencies_with_hz(&self.mean_stiffness_n_per_m()),
            Equations::Published(published) => published.natural_frequencies_hz(),
        }
    }

    /// (Hz) The same with other mesh stiffnesses; none under the published model.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh
    pub fn natural_frequencies_with_hz(&self, mesh_stiffness_n_per_m: &[f64]) -> Vec<f64> {
        let of = |(machine, _): (&AssembledMachine, &ModalMachine)| {
            machine.machine.closed_modes(mesh_stiffness_n_per_m).0
        };
        self.machine().map_or_else(Vec::new, of)
    }

    /// Mode shapes in the order of [`Self::natural_frequencies_hz`], of unit modal mass: for each mode a number for each coordinate.
    pub fn mode_shapes(&self) -> Vec<Vec<f64>> {
        match &self.equations {
            Equations::Machine(machine, _) => {
                let (_, shapes) = machine.machine.closed_modes(&self.mean_stiffness_n_per_m());
                shapes.column_iter().map(|shape| shape.iter().copied().collect()).collect()
            }
            Equations::Published(published) => published.mode_shapes(),
        }
    }

    /// The modes in which the supports of a rig move much, in rising order, of the mean meshes, closed; none where the supports are held.
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
        self.machine().map_or_else(Vec::new, |(machine, _)| {
            support_modes(&machine.machine, &self.mean_stiffness_n_per_m())
        })
    }

    /// (N/m) Mean stiffness of each mesh.
    pub fn mean_stiffness_n_per_m(&self) -> Vec<f64> {
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
                let pitches = |pair: &MeshedPair| pair.teeth.pinion.teeth.max(pair.teeth.gear.teeth) as usize;
                let each = self.meshes.iter().zip(&self.pairs);
                each.flat_map(|(mesh, pair)| mesh.stiffness_n_per_mm(0..pitches(pair))).collect()
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
        let Some((AssembledMachine { machine, modes, .. }, _)) = self.machine() else { return };
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

    /// Traces a machine of beams and its modes.
    pub(crate) fn trace_modes(&self, trace: &mut Trace) {
        let Some((AssembledMachine { machine, modes, .. }, modal)) = self.machine() else { return };
        let size = machine.coordinates();
        trace.vector("open_frequencies_hz", modes.angular_frequencies.iter().map(|omega| omega / TAU));
        trace.vector("damping_ratio", modes.damping_ratio.iter().copied());
        trace.scalar("stepped_modes", modal.modes() as f64);
        let mean = machine.closed_stiffness(&self.mean_stiffness_n_per_m());
        for (name, matrix) in [
            ("mass_matrix", &machine.mass),
            ("stiffness_matrix_open", &machine.stiffness()),
            ("stiffness_matrix_mean", &mean),
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
            Equations::Machine(machine, modal) => self.with_rings(
                (machine, &self.time),
                (outputs, first_sample),
                recorder,
                |outputs, recorder| {
                    let problem = self.problem(machine, modal, &self.time, outputs, first_sample);
                    integrate(problem, instructions, recorder)
                },
            ),
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
        let (machine, modal) = self.machine().ok_or(SteppedAlone::PublishedModel)?;
        let problem = self.problem(machine, modal, &self.time, outputs, self.time.first_kept_sample);
        problem.stepped_alone().map_or(Ok(problem), Err)
    }

    /// Why a batch steps the simulation alone, which takes several times as long; none where it steps it side by side with others.
    pub fn stepped_alone(&self) -> Option<SteppedAlone> {
        match self.machine() {
            Some((_, modal)) => SteppedAlone::of(modal, self.meshes.iter()),
            None => Some(SteppedAlone::PublishedModel),
        }
    }

    /// Simulates a part again, with half of the step, from a motion that was kept.
    ///
    /// # Arguments
    /// * `state` - the motion at the part's first sample
    /// * `samples` - of the part, at the simulation's own step
    /// * `outputs`, `recorder` - as of [`Self::integrate`]
    ///
    /// # Errors
    /// Those of [`Self::integrate`].
    pub(crate) fn integrate_part_finer(
        &self,
        state: &MotionState,
        samples: usize,
        outputs: &[Output],
        recorder: &mut dyn Recorder,
    ) -> Result<(), Error> {
        let Some((machine, modal)) = self.machine() else { return Ok(()) };
        let time = TimeGrid {
            sampling_rate_hz: 2.0 * self.time.sampling_rate_hz,
            samples: 2 * (state.sample + samples),
            first_simulated_sample: 2 * state.sample,
            first_kept_sample: 2 * self.time.first_kept_sample,
            samples_per_pinion_revolution: 2 * self.time.samples_per_pinion_revolution,
        };
        let first_sample = time.first_simulated_sample;
        let finer =
            self.with_rings((machine, &time), (outputs, first_sample), recorder, |outputs, recorder| {
                let mut problem = self.problem(machine, modal, &time, outputs, first_sample);
                problem.hunting_period_samples = None;
                resume(problem, state, InstructionSet::in_use(), recorder)
            });
        finer.map_err(|diverged| self.divergence(diverged))
    }

    /// Motion of motor and brake from a sample of a division of time on.
    pub(super) fn motion_from(&self, sample: usize, time: &TimeGrid) -> Motion<'_> {
        let motion = self.motion_in(time);
        if self.is_steady() || sample == 0 {
            return motion;
        }
        let before = self
            .motion()
            .nth(sample * self.time.samples_per_pinion_revolution / time.samples_per_pinion_revolution);
        motion.resumed_at(sample, before.map_or(0.0, |before| before.revolutions))
    }

    /// The simulation as the solver sees it, in its own division of time or a finer one.
    fn problem<'a>(
        &'a self,
        machine: &AssembledMachine,
        modal: &ModalMachine,
        time: &'a TimeGrid,
        outputs: &'a [Output],
        first_sample: usize,
    ) -> Problem<'a> {
        let operation = &self.scenario.operation;
        let deviations = |pair: &'a MeshedPair| PairDeviations {
            teeth: &pair.teeth,
            errors: pair.profile_errors.as_ref(),
            eccentricity_m: pair.eccentricity_mm.map(|of_wheel_mm| of_wheel_mm * 1e-3),
            run_out: pair.run_out,
        };
        let turning = |(number, bearing): &'a (usize, RollingBearing)| {
            let shaft = self.layout.shaft_of_bearing[*number];
            let ratio = self.layout.ratios[shaft].value();
            // A planet turns with the outer ring about its pin.
            let rings = if shaft < self.layout.own_shafts() { [ratio, 0.0] } else { [0.0, ratio] };
            BearingTurning::new(bearing, rings, self.scenario.seed, *number, time.step_s())
        };
        Problem {
            time,
            machine: modal.clone(),
            laws: self.meshes.iter().map(Mesh::law).collect(),
            bearings: self.bearings.iter().map(|(_, bearing)| bearing.clone()).collect(),
            forcing: Forcing::new(
                self.motion_from(time.first_simulated_sample, time),
                time,
                [operation.pinion_speed_hz, operation.brake_torque_nm],
                time.first_simulated_sample,
                self.meshes.iter().zip(self.pushing().1.iter().map(deviations)),
            )
            .with_bearings(self.bearings.iter().map(turning).collect())
            .with_turning_forces(&machine.machine.turning_forces),
            is_steady: operation.is_constant(),
            hunting_period_samples: self.cycle_samples(),
            outputs,
            first_sample,
        }
    }

    /// The key of the damping that a growing motion lacks, and the damping ratios.
    pub(super) fn damping(&self) -> (&'static str, Vec<f64>) {
        match (self.machine(), self.scenario.rig()) {
            (Some((machine, _)), None) => ("bearing.damping_ratio", machine.modes.damping_ratio.clone()),
            // The shafts' as well.
            (Some((machine, _)), Some(_)) if self.teeth_part() => {
                ("rig.support.damping_ratio", machine.modes.damping_ratio.clone())
            }
            (_, rig) => {
                let of_modes = |rig: &Rig| rig.damping_ratio.per_mode().to_vec();
                ("rig.damping_ratio", rig.map_or_else(Vec::new, of_modes))
            }
        }
    }
}
