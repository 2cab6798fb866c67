//! The eight stages, in order.

use std::fmt::{self, Debug, Formatter};
use std::time::Duration;

use web_time::Instant;

use crate::dynamics::coordinates::CoordinateVector;
use crate::dynamics::{ErrorForce, Excitation, MeshLoad, Motion, MotionSample, System};
use crate::fault::{FaultGeometry, fault_geometry};
use crate::quality::profile_errors;
use crate::sampling::{CycleGrid, TimeGrid};
use crate::scenario::{Convention, DampingRatio, ProfileErrors, Scenario, ScenarioError, Solver};
use crate::signal::{Channels, channel_outputs};
use crate::solver::{Diverged, InstructionSet, Output, Problem, Recorder, ReducedModel, integrate};
use crate::stiffness::{MeshStiffness, PairStiffness};
use crate::tooth::{Teeth, teeth};

/// Results of every stage before the time loop.
#[derive(Clone, PartialEq)]
pub struct Stages {
    /// Stage 1: what is simulated. Under the published convention the keys that the published code ignores are
    /// at their defaults.
    pub scenario: Scenario,
    /// Division of time.
    pub time: TimeGrid,
    /// Division of the mesh cycle.
    pub cycle: CycleGrid,
    /// Stage 2: healthy teeth and their contact.
    pub teeth: Teeth,
    /// Stage 3: profile errors; none for ideal teeth.
    pub profile_errors: Option<ProfileErrors>,
    /// Stage 4: the faulty pair; none for a healthy gear.
    pub fault: Option<FaultGeometry>,
    /// Stage 5: stiffness of a tooth pair.
    pub pair: PairStiffness,
    /// Stage 5: stiffness of the mesh.
    pub mesh: MeshStiffness,
    /// Stage 6: the equations of motion.
    pub system: System,
    /// Time that each stage took.
    pub timings: Vec<StageTime>,
}

/// Time that a stage took.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StageTime {
    /// The stage's name.
    pub stage: &'static str,
    /// Wall time.
    pub elapsed: Duration,
}

/// A simulation: every stage's results and the signals.
#[derive(Clone, PartialEq)]
pub struct Simulation {
    /// Stages 1 to 6.
    pub stages: Stages,
    /// Stage 8: the kept signals.
    pub channels: Channels,
    /// Time that each stage took, the time loop included.
    pub timings: Vec<StageTime>,
}

/// Simulates a scenario.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// A scenario that is not valid, or a fault that does not fit the tooth.
///
/// ```
/// use meshtone::scenario::Scenario;
///
/// let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
/// scenario.solver.sampling_rate_hz = 2e4;
/// let simulation = meshtone::simulate(&scenario)?;
/// let force = &simulation.channels.mesh_force_n;
/// let mean = force.iter().sum::<f64>() / force.len() as f64;
/// assert!((mean / 187.0 - 1.0).abs() < 0.01);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn simulate(scenario: &Scenario) -> Result<Simulation, ScenarioError> {
    stages(scenario)?.simulate()
}

/// Runs stages 1 to 6: everything before the time loop.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// As [`simulate`].
pub fn stages(scenario: &Scenario) -> Result<Stages, ScenarioError> {
    let mut clock = Clock::default();
    scenario.validate()?;
    let scenario = scenario.as_honoured();
    let (gears, convention) = (&scenario.gears, scenario.convention);
    let time = TimeGrid::new(&scenario);
    let cycle = CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz);
    clock.lap("scenario");

    let teeth = teeth(gears, &scenario.rig, convention);
    clock.lap("tooth profiles");

    let profile_errors = profile_errors(&scenario.quality, &teeth, scenario.seed);
    clock.lap("profile errors");

    let fault = match &scenario.fault {
        Some(fault) => Some(fault_geometry(fault, &teeth, convention, scenario.seed)?),
        None => None,
    };
    clock.lap("fault");

    let pair = PairStiffness::new(gears, &teeth, fault.as_ref())?;
    let mesh = MeshStiffness::new(&pair, &cycle, convention);
    clock.lap("mesh stiffness");

    let angle = teeth.gear.pressure_angle_rad;
    let load = MeshLoad::new(&mesh, fault.as_ref(), &cycle, gears.face_width_mm, angle, convention);
    let system = System::new(&scenario, &teeth, load);
    let mut stages = Stages {
        time,
        cycle,
        teeth,
        profile_errors,
        fault,
        pair,
        mesh,
        system,
        timings: Vec::new(),
        scenario,
    };
    stages.time.first_simulated_sample = stages.start_of_settling();
    clock.lap("equations of motion");
    stages.timings = clock.laps;
    Ok(stages)
}

impl Stages {
    /// Whether motor speed and brake torque are constant.
    pub fn is_steady(&self) -> bool {
        let motion = Motion::new(&self.scenario, &self.time);
        motion.is_steady() && motion.has_constant_torque()
    }

    /// First sample that must be simulated, so that the slowest mode's transient has decayed to the settling tolerance where
    /// the kept signal starts.
    ///
    /// Only for a steady motion that starts in equilibrium: what is left out is then a motion like the one that follows.
    fn start_of_settling(&self) -> usize {
        let Solver { settle_tolerance, initial_displacement, initial_velocity, .. } = &self.scenario.solver;
        let starts_in_equilibrium = initial_displacement.is_none() && initial_velocity.is_none();
        let published = self.scenario.convention == Convention::Published;
        if published || !starts_in_equilibrium || *settle_tolerance == 0.0 || !self.is_steady() {
            return 0;
        }
        let decay_s = -settle_tolerance.ln() / self.reduced_model().slowest_decay_per_s();
        let settling = (decay_s * self.time.sampling_rate_hz).ceil();
        // As a float: a decay that takes forever saturates.
        self.time.first_kept_sample.saturating_sub(settling as usize)
    }

    /// Stages 7 and 8: the rest of the simulation, for those who have looked at the first six.
    ///
    /// # Errors
    /// As [`Self::integrate`].
    ///
    /// ```
    /// use meshtone::scenario::Scenario;
    ///
    /// let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
    /// scenario.solver.sampling_rate_hz = 2e4;
    /// let stages = meshtone::stages(&scenario)?;
    /// let samples = stages.time.kept_samples();
    /// assert_eq!(stages.simulate()?.channels.len(), samples);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn simulate(self) -> Result<Simulation, ScenarioError> {
        let mut clock = Clock::default();
        let model = self.reduced_model();
        let mut channels = Channels::new(&self.time);
        self.integrate(&model, &channel_outputs(), self.time.first_kept_sample, &mut channels)?;
        clock.lap("time integration");
        let timings = self.timings.iter().copied().chain(clock.laps).collect();
        Ok(Simulation { stages: self, channels, timings })
    }

    /// (rev) Simulated revolutions of the pinion at the nominal speed, settling included.
    pub fn pinion_revolutions(&self) -> f64 {
        self.time.samples as f64 / self.time.samples_per_pinion_revolution as f64
    }

    /// Stage 6, the right-hand side: motor, brake and the profile errors' force, sample by sample from the start.
    pub fn excitation(&self) -> impl Iterator<Item = Excitation> {
        let errors = self.error_force();
        Motion::new(&self.scenario, &self.time).map(move |motion| self.excite(&motion, &errors))
    }

    pub(crate) fn error_force(&self) -> ErrorForce<'_> {
        ErrorForce::new(
            &self.scenario,
            &self.pair,
            self.profile_errors.as_ref(),
            self.fault.as_ref(),
            &self.system.mesh,
            self.cycle,
        )
    }

    pub(crate) fn excite(&self, motion: &MotionSample, errors: &ErrorForce) -> Excitation {
        let (position_rev, coarse_point) = self.position(motion.revolutions);
        Excitation {
            motor_angle_rad: std::f64::consts::TAU * motion.revolutions,
            motor_speed_rad_per_s: std::f64::consts::TAU * motion.speed_hz,
            brake_torque_nm: motion.torque_nm,
            error_force_n: errors.at(motion.revolutions, position_rev, coarse_point),
            position_rev,
            coarse_point,
        }
    }

    /// Motor revolutions since the gear's first tooth last entered contact, and the coarse point nearest to them.
    pub(crate) fn position(&self, revolutions: f64) -> (f64, usize) {
        let nearest = (revolutions / self.cycle.coarse_step_rev).round() as i64;
        let coarse_point = nearest.rem_euclid(self.cycle.points_per_gear_revolution as i64) as usize;
        (revolutions.rem_euclid(self.system.ratio), coarse_point)
    }

    /// The equations of motion in the modes that take part in the motion.
    pub fn reduced_model(&self) -> ReducedModel {
        let solver = &self.scenario.solver;
        let displacement = match (solver.initial_displacement, self.scenario.convention) {
            (Some(given), _) => Some(given.into()),
            (None, Convention::Published) => Some(CoordinateVector::zeros()),
            (None, Convention::Corrected) => None,
        };
        let speed = self.initial_motor_speed_rad_per_s();
        let velocity = match solver.initial_velocity {
            Some(given) => given.into(),
            None => self.system.rigid_rotation() * speed,
        };
        let nominal_speed = std::f64::consts::TAU * self.scenario.operation.pinion_speed_hz;
        ReducedModel::new(&self.system, nominal_speed, displacement.as_ref(), &velocity)
    }

    fn initial_motor_speed_rad_per_s(&self) -> f64 {
        let operation = &self.scenario.operation;
        let speed_hz =
            operation.speed_profile_hz.as_ref().map_or(operation.pinion_speed_hz, |profile| profile.value[0]);
        std::f64::consts::TAU * speed_hz
    }

    /// Stage 7: solves the equations of motion and hands the outputs of every sample to `recorder`.
    ///
    /// # Arguments
    /// * `model` - from [`Self::reduced_model`]
    /// * `outputs` - what is read off the solution
    /// * `first_sample` - first sample that is recorded; those before are computed all the same
    /// * `recorder` - takes the outputs, in the same order
    ///
    /// # Errors
    /// A motion that grows without bound, as with too little damping the varying mesh stiffness can make it.
    pub fn integrate(
        &self,
        model: &ReducedModel,
        outputs: &[Output],
        first_sample: usize,
        recorder: &mut dyn Recorder,
    ) -> Result<(), ScenarioError> {
        let problem = Problem { stages: self, model, outputs, first_sample };
        let result = integrate(&problem, InstructionSet::fastest(), recorder);
        result.map_err(|diverged| self.divergence(diverged))
    }

    /// The error that a solution without bound is.
    pub(crate) fn divergence(&self, diverged: Diverged) -> ScenarioError {
        let time_s = diverged.sample as f64 * self.time.step_s();
        let value = match &self.scenario.rig.damping_ratio {
            DampingRatio::Uniform(ratio) => format!("{ratio:?}"),
            ratios => format!("{:?}", ratios.per_mode()),
        };
        let problem = format!(
            "the motion grows without bound within {time_s:.4} s; damping must take what the varying mesh stiffness puts \
             into a mode, and a missing tooth must leave another in contact"
        );
        ScenarioError::new("rig.damping_ratio", value, problem).with_help(
            "raise the damping ratios (the default is 0.05), use more teeth, or change operation.pinion_speed_hz",
        )
    }
}

/// What is simulated; the fields' thousands of numbers are left out.
impl Debug for Stages {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        let Self { scenario, time, .. } = self;
        formatter
            .debug_struct("Stages")
            .field("scenario", scenario)
            .field("time", time)
            .finish_non_exhaustive()
    }
}

/// What is simulated; the signals' thousands of numbers are left out.
impl Debug for Simulation {
    fn fmt(&self, formatter: &mut Formatter) -> fmt::Result {
        formatter.debug_struct("Simulation").field("stages", &self.stages).finish_non_exhaustive()
    }
}

/// Takes the time of stages.
struct Clock {
    last: Instant,
    laps: Vec<StageTime>,
}

impl Default for Clock {
    fn default() -> Self {
        Self { last: Instant::now(), laps: Vec::new() }
    }
}

impl Clock {
    fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        self.laps.push(StageTime { stage, elapsed: now - self.last });
        self.last = now;
    }
}
