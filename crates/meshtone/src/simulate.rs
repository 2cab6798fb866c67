//! The eight stages, in order.

mod measured;

use std::fmt::{self, Debug, Formatter};
use std::num::NonZeroUsize;
use std::time::Duration;

use nalgebra::DMatrix;
use web_time::Instant;

use crate::damage::{Damage, DamagedTooth, Fault, damaged_teeth};
use crate::error::{Error, ScenarioError, ScenarioWarning};
use crate::machine::coordinates::CoordinateVector;
use crate::machine::{ClosedMesh, DecayingMode, Excitation, Structure, System};
use crate::mesh::forcing::{Forcing, ForcingBlock, ForcingSource};
use crate::mesh::published::PublishedForcing;
use crate::mesh::{
    ALL_DIRECTIONS, ContactForcing, ContactMesh, ContactParameters, ContactTable, DirectionVector, FaceSlope,
    Mesh, PairDeviations, PairForcing, PairMesh, PairSequence, Pairs, PublishedMesh, TipShape,
};
use crate::model::Model;
use crate::operation::{CycleGrid, Solver, TimeGrid};
use crate::scenario::{MemoryLimit, Scenario};
use crate::sensor::{Channels, ContactFigures};
use crate::simd::InstructionSet;
use crate::solver::{Block, Diverged, Output, Problem, Recorder, ReducedModel, integrate};
use crate::wheel::quality::{deviations, profile_errors};
use crate::wheel::{Deviations, ProfileErrors, RunOut, Teeth, WheelDeviations, WheelName, teeth};

/// Results of every stage before the time loop.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Stages {
    /// Stage 1: what is simulated. Under the published model the keys that the published code ignores are
    /// at their defaults; faults that were given by their severity have its sizes beside it.
    pub scenario: Scenario,
    /// Division of time.
    pub time: TimeGrid,
    /// Division of the mesh cycle.
    pub cycle: CycleGrid,
    /// Stage 2: healthy teeth and their contact.
    pub teeth: Teeth,
    /// Stage 3: profile errors; none for ideal teeth.
    pub profile_errors: Option<ProfileErrors>,
    /// Stage 3 under `contact`: run-out of the pinion and of the gear.
    pub run_out: [RunOut; 2],
    /// (µm) Stage 3 under `contact`: helix slope deviation of the pinion and of the gear over the face width.
    pub helix_slope_um: [f64; 2],
    /// Stage 4: the damaged teeth; none of a healthy pair.
    pub damaged: Vec<DamagedTooth>,
    /// (-) Stage 4: how severe each of the scenario's faults is, from 0 to 1.
    pub fault_severities: Vec<f64>,
    /// Stage 5: the mesh, pair by pair.
    pub mesh: Mesh,
    /// Stage 6: the equations of motion of the wheels on rigid supports.
    #[doc(hidden)]
    pub system: System,
    /// Stage 6 under `contact`: those of wheels, shafts and supports, in place of [`Self::system`].
    pub structure: Option<Structure>,
    /// Time that each stage took.
    pub timings: Vec<StageTime>,
    /// Stage 1: what is doubtful by the scenario alone.
    pub(crate) warnings_of_scenario: Vec<ScenarioWarning>,
    /// Most memory that the simulation may need, and one that repeats it.
    pub(crate) memory_limit: MemoryLimit,
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
#[non_exhaustive]
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
/// A scenario that is not valid, a fault that does not fit the tooth, a motion that grows without bound.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.solver.sampling_rate_hz = 2e4;
/// let simulation = meshtone::simulate(&scenario)?;
/// let force = &simulation.channels.mesh_force_n;
/// let mean = force.iter().sum::<f64>() / force.len() as f64;
/// assert!((mean / 187.0 - 1.0).abs() < 0.01);
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn simulate(scenario: &Scenario) -> Result<Simulation, Error> {
    stages(scenario)?.simulate()
}

/// Runs stages 1 to 6: everything before the time loop.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// A scenario that is not valid, or a fault that does not fit the tooth.
pub fn stages(scenario: &Scenario) -> Result<Stages, ScenarioError> {
    stages_within(scenario, MemoryLimit::default())
}

/// As [`stages`], with another limit of memory.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `limit` - most memory that the simulation may need
///
/// # Errors
/// As [`stages`].
///
/// ```
/// use meshtone::scenario::{GearPair, MemoryLimit, Scenario};
///
/// let scenario = Scenario::new(GearPair::example());
/// let needed = scenario.memory_estimate_bytes();
/// assert!(meshtone::stages_within(&scenario, MemoryLimit::Given { bytes: needed }).is_ok());
/// assert!(meshtone::stages_within(&scenario, MemoryLimit::Given { bytes: needed - 1 }).is_err());
/// ```
pub fn stages_within(scenario: &Scenario, limit: MemoryLimit) -> Result<Stages, ScenarioError> {
    let mut clock = Clock::default();
    let mut warnings_of_scenario = scenario.validate_within(limit)?;
    warnings_of_scenario.extend(scenario.ignored_by_model());
    let mut scenario = scenario.as_honoured();
    let (gears, rig, model) = (&scenario.gears, &scenario.rig, scenario.model);
    let time = scenario.time_grid();
    let mut cycle = CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz);
    clock.lap("scenario");

    let teeth = teeth(gears, [rig.pinion_shaft.radius_mm, rig.gear_shaft.radius_mm], model);
    clock.lap("tooth profiles");

    let Deviations { flanks: profile_errors, run_out, helix_slope_um } = match model {
        Model::Published | Model::Linear => Deviations {
            flanks: profile_errors(&scenario.quality, &teeth, scenario.seed),
            ..Deviations::default()
        },
        Model::Contact => deviations(&scenario.quality, &teeth, scenario.seed),
    };
    clock.lap("profile errors");

    let mut structure = None;
    let (damaged, mesh) = match model {
        Model::Published => {
            cycle = cycle.as_published(gears.pinion_teeth, gears.gear_teeth);
            let damage = scenario.faults.first().and_then(|fault| fault.sized(&teeth));
            let fault = damage.map(|damage| damage.published_geometry(&teeth, scenario.seed)).transpose()?;
            let damaged = fault.iter().map(|fault| fault.damaged_tooth(&teeth)).collect();
            clock.lap("fault");
            let mesh = PublishedMesh::new(gears, &teeth, fault, cycle)?;
            (damaged, Mesh::Published(Box::new(mesh)))
        }
        Model::Linear => {
            let damaged = damaged_teeth(&scenario.faults, &teeth, scenario.seed)?;
            clock.lap("fault");
            let points_per_pitch = points_per_pitch(&scenario, &time, &cycle);
            let sequence = PairSequence::new(gears.pinion_teeth, gears.gear_teeth, &damaged)?;
            let mesh = pair_mesh(&scenario, &teeth, &damaged, sequence, points_per_pitch);
            if mesh.classes[0].stiffness_n_per_m.contains(&0.0) {
                return Err(ScenarioError::not_stiff());
            }
            if mesh.mean_whole_stiffness_n_per_m() == 0.0 {
                return Err(ScenarioError::nothing_left());
            }
            (damaged, Mesh::Pairs(Box::new(mesh)))
        }
        Model::Contact => {
            let damaged = damaged_teeth(&scenario.faults, &teeth, scenario.seed)?;
            clock.lap("fault");
            let built = Structure::new(gears, rig, &teeth);
            let points_per_pitch = points_per_pitch(&scenario, &time, &cycle);
            let sequence = PairSequence::new(gears.pinion_teeth, gears.gear_teeth, &damaged)?;
            let pairs = pairs(&scenario, &teeth, &damaged);
            let parameters = contact_parameters(&scenario, &teeth, &built, helix_slope_um);
            if parameters.face.is_some() && parameters.static_force_n <= 0.0 {
                return Err(ScenarioError::no_load_along_the_face());
            }
            let mesh = ContactMesh::new(&pairs, tip_shape(&scenario), sequence, points_per_pitch, parameters);
            if mesh.mean_stiffness_n_per_m.is_nan() || mesh.mean_stiffness_n_per_m <= 0.0 {
                return Err(ScenarioError::not_stiff());
            }
            if mesh.contact_ratio > ContactMesh::MOST_CONTACT_RATIO {
                return Err(ScenarioError::too_many_pairs(
                    mesh.contact_ratio,
                    ContactMesh::MOST_CONTACT_RATIO,
                ));
            }
            let meets = |table: &ContactTable| table.kind.pairs_per_cycle > 0 && table.can_touch();
            if !mesh.classes.iter().any(meets) {
                return Err(ScenarioError::nothing_left());
            }
            structure = Some(built);
            (damaged, Mesh::Contact(Box::new(mesh)))
        }
    };
    clock.lap("mesh stiffness");

    let system = System::new(gears, rig, &teeth, &mesh, model);
    let fault_severities = scenario.faults.iter().map(|fault| fault.severity_on(&teeth)).collect();
    scenario.faults = scenario.faults.iter().map(|fault| fault.with_sizes(&teeth)).collect();
    let mut stages = Stages {
        time,
        cycle,
        teeth,
        profile_errors,
        run_out,
        helix_slope_um,
        damaged,
        fault_severities,
        mesh,
        system,
        structure,
        timings: Vec::new(),
        warnings_of_scenario,
        memory_limit: limit,
        scenario,
    };
    stages.time.first_simulated_sample = stages.start_of_settling();
    clock.lap("equations of motion");
    stages.timings = clock.laps;
    Ok(stages)
}

/// Points from one pair to the next: while motor and brake are steady every sample is one, else the coarse points of the cycle.
fn points_per_pitch(scenario: &Scenario, time: &TimeGrid, cycle: &CycleGrid) -> NonZeroUsize {
    let motion = scenario.motion(time);
    let points = if motion.is_steady() && motion.has_constant_torque() {
        time.samples_per_pinion_revolution / scenario.gears.pinion_teeth as usize
    } else {
        cycle.points_per_pitch
    };
    NonZeroUsize::new(points).unwrap_or(NonZeroUsize::MIN)
}

/// The tooth pairs of a scenario.
fn pairs<'a>(scenario: &Scenario, teeth: &'a Teeth, damaged: &'a [DamagedTooth]) -> Pairs<'a> {
    Pairs::new(teeth, damaged, scenario.gears.material, &scenario.gears.foundation)
}

/// The mesh as a sequence of tooth pairs.
fn pair_mesh(
    scenario: &Scenario,
    teeth: &Teeth,
    damaged: &[DamagedTooth],
    sequence: PairSequence,
    points_per_pitch: NonZeroUsize,
) -> PairMesh {
    let pairs = pairs(scenario, teeth, damaged);
    PairMesh::new(&pairs, sequence, teeth.path.contact_ratio, points_per_pitch)
}

/// What shapes the tips and flanks of all teeth under `contact`.
fn tip_shape(scenario: &Scenario) -> TipShape {
    TipShape { chamfer_mm: scenario.gears.chamfer_mm(), relief: scenario.gears.flank_relief }
}

/// What the mesh under `contact` needs beside the pairs.
fn contact_parameters(
    scenario: &Scenario,
    teeth: &Teeth,
    structure: &Structure,
    helix_slope_um: [f64; 2],
) -> ContactParameters {
    let closer_um = scenario.rig.misalignment_um + helix_slope_um[0] + helix_slope_um[1];
    let (width_m, static_force_n) = (teeth.gear.face_width_mm * 1e-3, static_force_n(scenario, teeth));
    let face = FaceSlope {
        slope: closer_um * 1e-6 / width_m,
        width_m,
        tilt_rad_per_m: structure.tilt_rad_per_nm() * static_force_n,
    };
    ContactParameters {
        damping_ratio: scenario.rig.mesh_damping_ratio,
        mesh_mass_kg: structure.mesh_mass_kg,
        backlash_m: scenario.gears.normal_backlash_mm() * 1e-3,
        static_force_n,
        face: (closer_um != 0.0).then_some(face),
    }
}

/// (N) Force along the line of action that balances the brake's nominal torque.
fn static_force_n(scenario: &Scenario, teeth: &Teeth) -> f64 {
    force_of_torque_n(scenario.operation.brake_torque_nm, teeth)
}

/// (N) Force along the line of action that balances a torque on the gear.
fn force_of_torque_n(torque_nm: f64, teeth: &Teeth) -> f64 {
    torque_nm / (teeth.gear.base_radius_mm * 1e-3)
}

impl Simulation {
    /// How the teeth touched; none under the models whose mesh is closed always.
    pub fn contact_figures(&self) -> Option<ContactFigures> {
        self.stages.mesh.contact().map(|_| ContactFigures::of(&self.channels))
    }
}

impl Stages {
    /// (Hz) Natural frequencies, rising: of the mean mesh, closed.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        match &self.structure {
            None => self.system.natural_frequencies_hz().to_vec(),
            Some(structure) => structure.closed_modes(self.mesh.mean_stiffness_n_per_mm() * 1e3).0,
        }
    }

    /// Mode shapes in the order of [`Self::natural_frequencies_hz`], a column each, of unit modal mass: in the wheels' and the
    /// brake's 13 coordinates, and under `contact` in those of the supports.
    pub fn mode_shapes(&self) -> DMatrix<f64> {
        match &self.structure {
            None => {
                let shapes = self.system.mode_shapes();
                DMatrix::from_fn(shapes.nrows(), shapes.ncols(), |row, column| shapes[(row, column)])
            }
            Some(structure) => structure.closed_modes(self.mesh.mean_stiffness_n_per_mm() * 1e3).1,
        }
    }

    /// The tooth pairs, at any position of their path; not under `published`, whose flanks are not conjugate.
    pub fn pairs(&self) -> Pairs<'_> {
        pairs(&self.scenario, &self.teeth, &self.damaged)
    }

    /// The mesh as a sequence of tooth pairs, with another number of points from one pair to the next than the time loop has.
    ///
    /// # Arguments
    /// * `points_per_pitch` - how many
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one.
    pub fn pair_mesh(&self, points_per_pitch: NonZeroUsize) -> Result<PairMesh, ScenarioError> {
        let [pinion, gear] = [self.teeth.pinion.teeth, self.teeth.gear.teeth];
        let sequence = PairSequence::new(pinion, gear, &self.damaged)?;
        Ok(pair_mesh(&self.scenario, &self.teeth, &self.damaged, sequence, points_per_pitch))
    }

    /// The mesh under `contact`, with another number of points from one pair to the next than the time loop has; none under the
    /// other models.
    ///
    /// # Arguments
    /// * `points_per_pitch` - how many
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one.
    pub fn contact_mesh(&self, points_per_pitch: NonZeroUsize) -> Result<Option<ContactMesh>, ScenarioError> {
        let Some(structure) = &self.structure else { return Ok(None) };
        let [pinion, gear] = [self.teeth.pinion.teeth, self.teeth.gear.teeth];
        let sequence = PairSequence::new(pinion, gear, &self.damaged)?;
        let parameters = contact_parameters(&self.scenario, &self.teeth, structure, self.helix_slope_um);
        let shape = tip_shape(&self.scenario);
        Ok(Some(ContactMesh::new(&self.pairs(), shape, sequence, points_per_pitch, parameters)))
    }

    /// What the pinion and the gear have beside their profile errors: under `contact` run-out and helix slope, none under the other
    /// models. With the profile errors, of which the pitches are a part, these are all their deviations: given to a scenario, they
    /// make the same signals.
    pub fn wheel_deviations(&self) -> [WheelDeviations; 2] {
        let of_wheel = |wheel: usize| match self.scenario.model {
            Model::Contact => WheelDeviations {
                cumulative_pitch_um: None,
                run_out_um: Some(self.run_out[wheel].run_out_um),
                run_out_phase_rad: Some(self.run_out[wheel].phase_rad),
                helix_slope_um: Some(self.helix_slope_um[wheel]),
            },
            Model::Linear | Model::Published => WheelDeviations::default(),
        };
        [of_wheel(0), of_wheel(1)]
    }

    /// (N) Force along the line of action that balances the brake's nominal torque.
    pub fn static_force_n(&self) -> f64 {
        static_force_n(&self.scenario, &self.teeth)
    }

    /// (N) Force along the line of action that balances a torque on the gear.
    pub(crate) fn force_of_torque_n(&self, torque_nm: f64) -> f64 {
        force_of_torque_n(torque_nm, &self.teeth)
    }

    /// Whether motor speed and brake torque are constant.
    pub fn is_steady(&self) -> bool {
        let motion = self.scenario.motion(&self.time);
        motion.is_steady() && motion.has_constant_torque()
    }

    /// (1/s) Rate at which the slowest mode in motion decays; under `contact` with the mean mesh, closed.
    pub(crate) fn slowest_decay_per_s(&self) -> f64 {
        let of_system = || self.reduced_model().slowest_decay_per_s();
        self.slowest_closed_mode().map_or_else(of_system, |mode| mode.decay_per_s)
    }

    /// The slowest mode in motion under `contact`, with the mean mesh closed.
    pub(crate) fn slowest_closed_mode(&self) -> Option<DecayingMode> {
        let (structure, mesh) = (self.structure.as_ref()?, self.mesh.contact()?);
        Some(structure.slowest_mode(&ClosedMesh {
            stiffness_n_per_m: mesh.mean_stiffness_n_per_m,
            damping_time_s: mesh.damping_time_s,
        }))
    }

    /// First sample that must be simulated, so that the slowest mode's transient has decayed to the settling tolerance where
    /// the kept signal starts.
    ///
    /// Only for a steady motion that starts in equilibrium: what is left out is then a motion like the one that follows.
    fn start_of_settling(&self) -> usize {
        let Solver { settle_tolerance, initial_displacement, initial_velocity, .. } = &self.scenario.solver;
        let starts_in_equilibrium = initial_displacement.is_none() && initial_velocity.is_none();
        let published = self.scenario.model == Model::Published;
        if published || !starts_in_equilibrium || *settle_tolerance == 0.0 || !self.is_steady() {
            return 0;
        }
        let decay_s = -settle_tolerance.ln() / self.slowest_decay_per_s();
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
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let mut scenario = Scenario::new(GearPair::example());
    /// scenario.solver.sampling_rate_hz = 2e4;
    /// let stages = meshtone::stages(&scenario)?;
    /// let samples = stages.time.kept_samples();
    /// assert_eq!(stages.simulate()?.channels.len(), samples);
    /// # Ok::<(), meshtone::Error>(())
    /// ```
    pub fn simulate(self) -> Result<Simulation, Error> {
        let clock = Clock::default();
        let mut channels = self.channels();
        self.integrate_into(&mut channels)?;
        Ok(self.simulated(channels, clock))
    }

    /// As [`Self::simulate`], for those who may change their mind meanwhile.
    ///
    /// # Arguments
    /// * `is_wanted` - asked after every block of samples whether the simulation still is
    ///
    /// # Returns
    /// None where it is no longer wanted.
    ///
    /// # Errors
    /// As [`Self::integrate`].
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair { gear_teeth: 34, ..GearPair::example() });
    /// let stages = meshtone::stages(&scenario)?;
    /// assert_eq!(stages.clone().simulate_while(&|| true)?.map(|wanted| wanted.channels), Some(stages.clone().simulate()?.channels));
    /// assert!(stages.simulate_while(&|| false)?.is_none());
    /// # Ok::<(), meshtone::Error>(())
    /// ```
    pub fn simulate_while(self, is_wanted: &dyn Fn() -> bool) -> Result<Option<Simulation>, Error> {
        let clock = Clock::default();
        let mut wanted = WantedChannels { channels: self.channels(), is_wanted };
        self.integrate_into(&mut wanted)?;
        let channels = wanted.channels;
        Ok(is_wanted().then(|| self.simulated(channels, clock)))
    }

    /// Stage 7, with what the channels take of it.
    fn integrate_into(&self, recorder: &mut dyn Recorder) -> Result<(), Error> {
        let model = self.reduced_model();
        self.integrate(&model, &self.channel_outputs(), self.time.first_kept_sample, recorder)
    }

    /// Stage 8, and everything together.
    fn simulated(self, mut channels: Channels, mut clock: Clock) -> Simulation {
        clock.lap("time integration");
        if !channels.sensors.is_empty() {
            channels = self.measured(channels);
            clock.lap("sensors");
        }
        let timings = self.timings.iter().copied().chain(clock.laps).collect();
        Simulation { stages: self, channels, timings }
    }

    /// (rev) Simulated revolutions of the pinion at the nominal speed, settling included.
    pub fn pinion_revolutions(&self) -> f64 {
        self.time.samples as f64 / self.time.samples_per_pinion_revolution as f64
    }

    /// Stage 6, the right-hand side: motor, brake and the deviations' force, sample by sample from the start.
    pub fn excitation(&self) -> impl Iterator<Item = Excitation> {
        let mut forcing = self.forcing_from(0, &ALL_DIRECTIONS);
        let mut block = ForcingBlock::default();
        self.scenario.motion(&self.time).map(move |motion| {
            forcing.next_block(1, &mut block);
            Excitation {
                motor_angle_rad: std::f64::consts::TAU * motion.revolutions,
                motor_speed_rad_per_s: std::f64::consts::TAU * motion.speed_hz,
                brake_torque_nm: motion.torque_nm,
                deviation_force_n: DirectionVector::from_fn(|direction, _| block.errors[direction][0]),
            }
        })
    }

    fn forcing_from(&self, first_sample: usize, directions: &[usize]) -> Box<dyn Forcing + '_> {
        let operation = &self.scenario.operation;
        let motion = self.scenario.motion(&self.time);
        let nominal = [operation.pinion_speed_hz, operation.brake_torque_nm];
        let errors = self.profile_errors.as_ref();
        let deviations = PairDeviations {
            teeth: &self.teeth,
            errors,
            eccentricity_m: self.scenario.rig.eccentricity_mm * 1e-3,
            run_out: self.run_out,
        };
        let time = &self.time;
        match &self.mesh {
            Mesh::Published(mesh) => {
                Box::new(PublishedForcing::new(mesh, errors, motion, time, nominal, directions))
            }
            Mesh::Contact(mesh) => {
                let count = directions.len();
                Box::new(ContactForcing::new(mesh, &deviations, motion, time, nominal, count, first_sample))
            }
            Mesh::Pairs(mesh) => {
                Box::new(PairForcing::new(mesh, &deviations, motion, time, nominal, directions, first_sample))
            }
        }
    }

    /// The simulation as the solver sees it.
    pub(crate) fn problem<'a>(&'a self, model: &'a ReducedModel, outputs: &'a [Output]) -> Problem<'a> {
        Problem {
            time: &self.time,
            model,
            mesh: &self.mesh,
            points_per_revolution: match &self.mesh {
                Mesh::Published(_) => self.cycle.points_per_pinion_revolution as f64,
                Mesh::Pairs(_) | Mesh::Contact(_) => {
                    (self.mesh.points_per_pitch() * self.teeth.pinion.teeth as usize) as f64
                }
            },
            source: self,
            brake_torque_nm: self.scenario.operation.brake_torque_nm,
            steady: self.is_steady(),
            outputs,
            first_sample: self.time.first_kept_sample,
        }
    }

    /// The equations of motion in the modes that take part in the motion.
    #[doc(hidden)]
    pub fn reduced_model(&self) -> ReducedModel {
        let solver = &self.scenario.solver;
        let operation = &self.scenario.operation;
        let nominal_speed = std::f64::consts::TAU * operation.pinion_speed_hz;
        let displacement = match (solver.initial_displacement, self.scenario.model) {
            (Some(given), _) => Some(given.into()),
            (None, Model::Published) => Some(CoordinateVector::zeros()),
            (None, Model::Linear | Model::Contact) => None,
        };
        let speed = self.initial_motor_speed_rad_per_s();
        let velocity = match solver.initial_velocity {
            Some(given) => given.into(),
            None => self.system.rigid_rotation() * speed,
        };
        let displacement = displacement.as_ref();
        match (&self.structure, &self.mesh) {
            (Some(structure), Mesh::Contact(mesh)) => {
                let torque = operation.brake_torque_nm;
                let tilts = mesh.tilts();
                ReducedModel::of_structure(structure, tilts, nominal_speed, torque, displacement, &velocity)
            }
            _ => ReducedModel::new(&self.system, nominal_speed, displacement, &velocity),
        }
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
    #[doc(hidden)]
    pub fn integrate(
        &self,
        model: &ReducedModel,
        outputs: &[Output],
        first_sample: usize,
        recorder: &mut dyn Recorder,
    ) -> Result<(), Error> {
        let problem = Problem { first_sample, ..self.problem(model, outputs) };
        let result = integrate(&problem, InstructionSet::fastest(), recorder);
        result.map_err(|diverged| self.divergence(diverged))
    }

    /// The error that a solution without bound is.
    pub(crate) fn divergence(&self, diverged: Diverged) -> Error {
        let time_s = diverged.sample as f64 * self.time.step_s();
        if let Some(error) = WheelName::BOTH.into_iter().find_map(|wheel| self.gap(wheel, time_s)) {
            return error.into();
        }
        let (key, damping_ratios) = match &self.structure {
            None => ("rig.damping_ratio", self.scenario.rig.damping_ratio.per_mode().to_vec()),
            // The shafts' as well.
            Some(structure) => ("rig.support.damping_ratio", structure.damping_ratio.clone()),
        };
        Error::Diverged { time_s, key, damping_ratios }
    }

    /// The same where more neighbours are missing on a wheel than pairs are in contact at once: nothing bears while they pass.
    fn gap(&self, wheel: WheelName, time_s: f64) -> Option<ScenarioError> {
        let missing = most_neighbours(&self.damaged, wheel, self.teeth.wheel(wheel).teeth as usize);
        let ratio = self.teeth.path.contact_ratio;
        if missing as f64 <= ratio {
            return None;
        }
        let faults = &self.scenario.faults;
        let takes_teeth = |(_, fault): &(usize, &Fault)| {
            fault.wheel == wheel && matches!(fault.damage, Damage::MissingTooth(_))
        };
        let named: Vec<String> =
            faults.iter().enumerate().filter(takes_teeth).map(|(n, _)| format!("fault[{n}]")).collect();
        let (named, wheel) = (named.join(", "), wheel.name());
        let problem = format!(
            "{missing} neighbouring teeth of the {wheel} are missing ({named}), more than the {ratio:.2} pairs in contact at once: \
             nothing bears while they pass, and the motion grows without bound within {time_s:.4} s"
        );
        let help = "remove some of these faults, or some numbers from their fault.tooth";
        Some(ScenarioError::new("fault", "", problem).with_help(help))
    }
}

/// The largest number of teeth of a wheel that are missing side by side.
fn most_neighbours(damaged: &[DamagedTooth], wheel: WheelName, teeth: usize) -> usize {
    let of_wheel = damaged.iter().filter(|tooth| tooth.wheel == wheel && tooth.is_missing());
    let missing: Vec<usize> = of_wheel.flat_map(|tooth| tooth.teeth.iter().copied()).collect();
    let run = |&first: &usize| (0..teeth).take_while(|n| missing.contains(&((first + n) % teeth))).count();
    missing.iter().map(run).max().unwrap_or(0)
}

impl ForcingSource for Stages {
    fn forcing(&self, directions: &[usize]) -> Box<dyn Forcing + '_> {
        self.forcing_from(self.time.first_simulated_sample, directions)
    }
}

/// Channels that somebody waits for, as long as they do.
struct WantedChannels<'a> {
    channels: Channels,
    is_wanted: &'a dyn Fn() -> bool,
}

impl Recorder for WantedChannels<'_> {
    fn record(&mut self, block: &Block) {
        self.channels.record(block);
    }

    fn goes_on(&self) -> bool {
        (self.is_wanted)()
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
