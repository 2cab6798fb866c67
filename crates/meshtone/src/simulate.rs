//! The eight stages, in order.

mod curves;
mod equations;
mod gearbox;
mod measured;
mod options;
mod severities;

use std::fmt::{self, Debug, Formatter};
use std::num::NonZeroUsize;
use std::time::Duration;

use web_time::Instant;

pub use equations::Equations;
pub(crate) use gearbox::gearbox_stages_with;
pub use gearbox::{
    GearboxSimulation, GearboxStages, MeshedPair, gearbox_stages, gearbox_stages_within, simulate_gearbox,
    simulate_gearboxes,
};
use measured::WantedChannels;
use options::MachineOptions;

use crate::damage::{DamagedTooth, ToothPart, damaged_teeth};
use crate::error::{Error, ScenarioError, ScenarioWarning};
use crate::machine::{DecayingMode, Machine, Modes, Train};
use crate::mesh::{
    Contact, FaceSlope, Mesh, MeshParameters, PairSequence, PairTable, Pairs, TipShape, Turning,
    place_on_face,
};
use crate::operation::{CycleGrid, Solver, TimeGrid};
use crate::published::{self, Published};
use crate::scenario::{MemoryLimit, Scenario};
use crate::sensor::{Channels, ContactFigures, SignalSource};
use crate::simd::InstructionSet;
use crate::solver::{Diverged, Output, Recorder, StepCounts};
use crate::wheel::quality::{deviations, profile_errors};
use crate::wheel::{
    Deviations, NamedGears, ProfileErrors, RunOut, Teeth, TipRelief, WheelDeviations, WheelName, teeth,
};

/// Results of every stage before the time loop.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Stages {
    /// Stage 1: what is simulated. Keys that the model ignores are at their defaults; faults that were given by their severity
    /// have its sizes beside it.
    pub scenario: Scenario,
    /// Division of time.
    pub time: TimeGrid,
    /// Division of the mesh cycle.
    pub cycle: CycleGrid,
    /// Stage 2: healthy teeth and their contact.
    pub teeth: Teeth,
    /// Stage 3: profile errors; none for ideal teeth.
    pub profile_errors: Option<ProfileErrors>,
    /// Stage 3: run-out of the pinion and of the gear.
    pub run_out: [RunOut; 2],
    /// (µm) Stage 3: helix slope deviation of the pinion and of the gear over the face width.
    pub helix_slope_um: [f64; 2],
    /// Stage 4: the damaged teeth; none of a healthy pair.
    pub damaged: Vec<DamagedTooth>,
    /// (-) Stage 4: how severe each of the scenario's faults is, from 0 to 1.
    pub fault_severities: Vec<f64>,
    /// Stage 5: the meshes; none under the published model, which has one of its own.
    pub meshes: Vec<Mesh>,
    /// Stage 6: the equations of motion, of a type that is public only for the project's own tests and benchmarks.
    #[cfg(feature = "internals")]
    #[doc(hidden)]
    pub equations: Equations,
    #[cfg(not(feature = "internals"))]
    pub(crate) equations: Equations,
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
/// let force = &simulation.channels["mesh_force_n"];
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

/// Does what [`stages`] does, with another limit of memory.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `limit` - most memory that the simulation may need
///
/// # Errors
/// Those of [`stages`].
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
    let clock = Clock::default();
    let mut warnings = scenario.validate_within(limit)?;
    warnings.extend(scenario.ignored_by_model());
    let honoured = scenario.without_ignored_keys();
    let mut stages = match MachineOptions::of(scenario.model) {
        Some(options) => machine_stages(honoured, &options, clock)?,
        None => published_stages(honoured, clock)?,
    };
    stages.warnings_of_scenario = warnings;
    stages.memory_limit = limit;
    let Stages { scenario: Scenario { faults, .. }, teeth, .. } = &mut stages;
    let severities = faults.iter().map(|fault| fault.severity_on(teeth)).collect();
    *faults = faults.iter().map(|fault| fault.with_sizes(teeth)).collect();
    stages.fault_severities = severities;
    stages.time.first_simulated_sample = stages.start_of_settling();
    Ok(stages)
}

/// Stages 1 to 6 of a machine around one mesh. The models that have one differ in nothing but its options.
fn machine_stages(
    scenario: Scenario,
    options: &MachineOptions,
    mut clock: Clock,
) -> Result<Stages, ScenarioError> {
    let (gears, rig) = (&scenario.gears, &scenario.rig);
    let time = scenario.time_grid();
    let cycle = CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz);
    clock.lap("scenario");
    let teeth = healthy_teeth(&scenario);
    clock.lap("tooth profiles");
    let Deviations { flanks: profile_errors, run_out, helix_slope_um } =
        deviations(&scenario.quality, &teeth, scenario.seed);
    clock.lap("profile errors");
    let damaged = damaged_teeth(&scenario.faults, &teeth, scenario.seed)?;
    clock.lap("fault");
    let train = Train::new(gears, rig, &teeth, options.supports);
    let modes = (options.modes)(&train.machine, rig);
    let mut stages = Stages {
        time,
        cycle,
        teeth,
        profile_errors,
        run_out,
        helix_slope_um,
        damaged,
        fault_severities: Vec::new(),
        meshes: Vec::new(),
        equations: Equations::Machine(Box::new(train), modes),
        timings: Vec::new(),
        warnings_of_scenario: Vec::new(),
        memory_limit: MemoryLimit::default(),
        scenario,
    };
    clock.lap("equations of motion");
    stages.meshes = stages.meshes_at(stages.points_per_pitch())?;
    clock.lap("mesh stiffness");
    stages.timings = clock.laps;
    Ok(stages)
}

/// The same of the published model, which has a mesh and equations of motion of its own.
fn published_stages(scenario: Scenario, mut clock: Clock) -> Result<Stages, ScenarioError> {
    let time = scenario.time_grid();
    clock.lap("scenario");
    let teeth = healthy_teeth(&scenario);
    clock.lap("tooth profiles");
    let profile_errors = profile_errors(&scenario.quality, &teeth, scenario.seed);
    clock.lap("profile errors");
    let published = Published::new(&scenario, &time, &teeth, profile_errors.as_ref())?;
    clock.lap("mesh stiffness");
    Ok(Stages {
        cycle: published.mesh.grid,
        damaged: published.damaged_tooth(&teeth).into_iter().collect(),
        time,
        teeth,
        profile_errors,
        run_out: Default::default(),
        helix_slope_um: [0.0; 2],
        fault_severities: Vec::new(),
        meshes: Vec::new(),
        equations: Equations::Published(Box::new(published)),
        timings: clock.laps,
        warnings_of_scenario: Vec::new(),
        memory_limit: MemoryLimit::default(),
        scenario,
    })
}

/// The healthy teeth of a scenario's wheels.
///
/// # Arguments
/// * `scenario` - with the keys that its model ignores at their defaults
fn healthy_teeth(scenario: &Scenario) -> Teeth {
    let Scenario { gears, rig, model, .. } = scenario;
    let bore_radii_mm = [rig.pinion_shaft.radius_mm, rig.gear_shaft.radius_mm];
    if model.has_meshes() { teeth(gears, bore_radii_mm) } else { published::teeth(gears, bore_radii_mm) }
}

/// The mesh, unless it can carry nothing, or has more pairs at once than a step looks at.
fn checked(mesh: Mesh, gears: &NamedGears) -> Result<Mesh, ScenarioError> {
    if mesh.mean_stiffness_n_per_m.is_nan() || mesh.mean_stiffness_n_per_m <= 0.0 {
        return Err(ScenarioError::not_stiff(gears.foundation()));
    }
    if mesh.contact_ratio <= 0.0 {
        let problem = "the tips' chamfers and the active profile's shortening leave no path of contact";
        let help =
            format!("lower {} or {}", gears.key("tip_chamfer_mm"), gears.key("active_profile_shortening"));
        return Err(ScenarioError::new(gears.whole(), "", problem).with_help(help));
    }
    if mesh.overlap == 0.0 && mesh.contact_ratio > Mesh::MOST_CONTACT_RATIO {
        let keys = [gears.whole(), gears.key("pressure_angle_deg")];
        return Err(ScenarioError::too_many_pairs(mesh.contact_ratio, Mesh::MOST_CONTACT_RATIO, keys));
    }
    let meets = |table: &PairTable| table.kind.pairs_per_cycle > 0 && table.can_touch();
    if mesh.classes.iter().any(meets) { Ok(mesh) } else { Err(ScenarioError::nothing_left()) }
}

/// First sample that must be simulated, so that a mode's transient has decayed to the settling tolerance where the kept signal starts.
fn start_of_settling(time: &TimeGrid, settle_tolerance: f64, slowest: &DecayingMode) -> usize {
    // Where nothing decays, or nothing is tolerated, all of the settling is simulated: as a float, that takes forever.
    let decay_s = -settle_tolerance.ln() / slowest.decay_per_s.clamp(0.0, f64::MAX);
    let settling = (decay_s * time.sampling_rate_hz).ceil();
    time.first_kept_sample.saturating_sub(settling as usize)
}

/// What a mesh is made of.
struct MeshOf<'a> {
    gears: &'a NamedGears<'a>,
    teeth: &'a Teeth,
    damaged: &'a [DamagedTooth],
    machine: &'a Machine,
    /// Without the meshes.
    modes: &'a Modes,
    /// Of the mesh in the machine.
    number: usize,
    /// (µm) By how much more the flanks close at one end of the face than at the other.
    closer_um: f64,
    static_force_n: f64,
    contact: Contact,
    turning: Turning,
    /// 1 where the driving wheel turns about positive z, −1 where it turns the other way.
    sense: f64,
    damping_ratio: f64,
    /// (kg) That the wheels' rotation has along the line of action.
    mesh_mass_kg: f64,
}

impl MeshOf<'_> {
    /// The mesh with its tables.
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one, misaligned shafts without a load, and a mesh that cannot carry any.
    fn with_tables(&self, points_per_pitch: NonZeroUsize) -> Result<Mesh, ScenarioError> {
        let &Self { gears, teeth, damaged, closer_um, static_force_n, .. } = self;
        let sequence = PairSequence::new(gears.pinion_teeth, gears.gear_teeth, damaged)?;
        if closer_um != 0.0 && static_force_n <= 0.0 {
            return Err(ScenarioError::no_load_along_the_face(gears.load()));
        }
        let width_m = gears.face_width_mm * 1e-3;
        let face = || FaceSlope {
            slope: closer_um * 1e-6 / width_m,
            width_m,
            tilt_rad_per_m: self.modes.tilt_rad_per_nm(self.machine, self.number) * static_force_n,
        };
        let slices = if self.gap_varies_along_face() { gears.slices as usize } else { 1 };
        let parameters = MeshParameters {
            contact: self.contact,
            turning: self.turning,
            damping_ratio: self.damping_ratio,
            mesh_mass_kg: self.mesh_mass_kg,
            // Across the teeth, as it is measured; in the transverse section it is larger.
            backlash_m: gears.normal_backlash_mm() * 1e-3 / gears.base_helix_angle_rad().cos(),
            static_force_n,
            face: (closer_um != 0.0).then(face),
            overlap: self.sense * gears.hand.sign() * gears.overlap_ratio(),
            face_width_m: width_m,
            gaps_m: (0..slices)
                .map(|slice| [slice, slice + 1].map(|edge| place_on_face(edge as f64, slices)))
                .map(|ends| gears.mean_gap_mm(ends) * 1e-3)
                .collect(),
        };
        let shape = TipShape {
            chamfer_mm: gears.chamfer_mm(),
            active_profile_shortening: match self.contact {
                Contact::Unilateral => gears.active_profile_shortening,
                Contact::Bilateral => 0.0,
            },
            relief: gears.flank_relief,
        };
        let tabulated =
            |faces: &[Pairs]| checked(Mesh::new(faces, shape, sequence, points_per_pitch, parameters), gears);
        if slices == 1 {
            return tabulated(&[Pairs::new(teeth, damaged, gears.material, &gears.foundation)]);
        }
        let width_mm = gears.face_width_mm;
        let of_slice = teeth.with_face_width(width_mm / slices as f64);
        let damaged: Vec<Vec<DamagedTooth>> = (0..slices)
            .map(|slice| [slice, slice + 1].map(|edge| width_mm * place_on_face(edge as f64, slices)))
            .map(|ends_mm| damaged.iter().map(|tooth| tooth.slice(ends_mm, width_mm)).collect())
            .collect();
        let sound = Pairs::new(&of_slice, &[], gears.material, &gears.foundation);
        tabulated(&damaged.iter().map(|damaged| sound.with_damaged(damaged)).collect::<Vec<_>>())
    }

    /// Whether the gap between two flanks differs along the face, so that its slices touch one after the other. A slope of spur wheels'
    /// flanks and what is lost of their faces need no slices: see [`FaceSlope`] and [`Pairs`].
    fn gap_varies_along_face(&self) -> bool {
        let gears = self.gears;
        let is_crowned = gears.lead_crowning_um > 0.0 || gears.end_relief.amount_um > 0.0;
        let varies_along_contact_lines = || {
            self.closer_um != 0.0
                || gears.flank_relief.amount_um > 0.0
                || self.damaged.iter().any(DamagedTooth::varies_over_face)
        };
        is_crowned || gears.is_helical() && varies_along_contact_lines()
    }
}

impl Simulation {
    /// How the teeth touched; none where the flanks may pull.
    pub fn contact_figures(&self) -> Option<ContactFigures> {
        let force_n = self.channels.of(SignalSource::MeshForce(0));
        self.stages.teeth_part().then(|| ContactFigures::of_force(force_n))
    }
}

impl Stages {
    /// Whether flanks that are pulled part, as real ones do.
    pub(crate) fn teeth_part(&self) -> bool {
        self.meshes.iter().any(|mesh| mesh.contact == Contact::Unilateral)
    }

    /// The tooth pairs, at any position of their path; not under the published model, whose flanks are not conjugate.
    pub fn pairs(&self) -> Pairs<'_> {
        Pairs::new(&self.teeth, &self.damaged, self.scenario.gears.material, &self.scenario.gears.foundation)
    }

    /// The meshes, with another number of points from one pair to the next than the time loop has; none under the published model.
    ///
    /// # Arguments
    /// * `points_per_pitch` - how many
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one, misaligned shafts without a load.
    pub fn meshes_at(&self, points_per_pitch: NonZeroUsize) -> Result<Vec<Mesh>, ScenarioError> {
        let (Some((train, modes)), Some(options)) = (self.train(), MachineOptions::of(self.scenario.model))
        else {
            return Ok(Vec::new());
        };
        let Scenario { gears, rig, .. } = &self.scenario;
        let closer_um = if options.feels_misalignment {
            rig.misalignment_um + self.helix_slope_um.iter().sum::<f64>()
        } else {
            0.0
        };
        let mesh = MeshOf {
            gears: &NamedGears::of_pair(gears),
            teeth: &self.teeth,
            damaged: &self.damaged,
            machine: &train.machine,
            modes,
            number: 0,
            closer_um,
            static_force_n: self.static_force_n(),
            contact: options.contact,
            turning: Turning { pitches_per_revolution: f64::from(gears.pinion_teeth), first_pitch: 0.0 },
            sense: 1.0,
            damping_ratio: rig.mesh_damping_ratio,
            mesh_mass_kg: train.mesh_mass_kg,
        };
        Ok(vec![mesh.with_tables(points_per_pitch)?])
    }

    /// The deviations of the pinion and of the gear beside their profile errors: run-out and helix slope. With the profile errors, of
    /// which the pitches are a part, these are all their deviations: given to a scenario, they make the same signals.
    pub fn wheel_deviations(&self) -> [WheelDeviations; 2] {
        let of_wheel = |wheel: usize| WheelDeviations {
            cumulative_pitch_um: None,
            run_out_um: Some(self.run_out[wheel].run_out_um),
            run_out_phase_rad: Some(self.run_out[wheel].phase_rad),
            helix_slope_um: Some(self.helix_slope_um[wheel]),
        };
        let none = [WheelDeviations::default(), WheelDeviations::default()];
        if self.scenario.model.has_meshes() { [of_wheel(0), of_wheel(1)] } else { none }
    }

    /// (mm) How far the tips' chamfers and their relief reach inwards from the tip; 0 where there is none.
    pub fn tip_lengths_mm(&self) -> [f64; 2] {
        let gears = &self.scenario.gears;
        if !self.scenario.model.has_meshes() {
            return [0.0, TipRelief::PUBLISHED.length_mm];
        }
        gears.tip_lengths_mm()
    }

    /// (N) Force along the line of action that balances the brake's nominal torque.
    pub fn static_force_n(&self) -> f64 {
        self.force_of_torque_n(self.scenario.operation.brake_torque_nm)
    }

    /// (N) Force along the line of action that balances a torque on the gear.
    pub(crate) fn force_of_torque_n(&self, torque_nm: f64) -> f64 {
        torque_nm / (self.teeth.gear.base_radius_mm * 1e-3)
    }

    /// Points from one pair to the next: while motor and brake are steady every sample is one, else the coarse points of the cycle.
    fn points_per_pitch(&self) -> NonZeroUsize {
        let Self { time, teeth, cycle, .. } = self;
        let samples = time.samples_per_pinion_revolution / teeth.pinion.teeth as usize;
        let points = if self.is_steady() { samples } else { cycle.points_per_pitch };
        NonZeroUsize::new(points).unwrap_or(NonZeroUsize::MIN)
    }

    /// Whether motor speed and brake torque are constant.
    pub fn is_steady(&self) -> bool {
        self.scenario.operation.is_steady()
    }

    /// First sample that must be simulated, so that the slowest mode's transient has decayed to the settling tolerance where
    /// the kept signal starts.
    ///
    /// Only for a steady motion that starts in equilibrium: what is left out is then a motion like the one that follows.
    fn start_of_settling(&self) -> usize {
        let Solver { settle_tolerance, initial_velocity, .. } = &self.scenario.solver;
        let starts_in_equilibrium = self.scenario.model.has_meshes() && initial_velocity.is_none();
        if !starts_in_equilibrium || !self.is_steady() {
            return 0;
        }
        start_of_settling(&self.time, *settle_tolerance, &self.slowest_mode())
    }

    /// Stages 7 and 8: the rest of the simulation, for those who have looked at the first six.
    ///
    /// # Errors
    /// Those of [`Self::integrate`].
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
        let channels = self.integrated_while(&|| true)?;
        Ok(self.simulated(channels, clock))
    }

    /// Does what [`Self::simulate`] does, for those who may change their mind meanwhile.
    ///
    /// # Arguments
    /// * `is_wanted` - asked after every block of samples whether the simulation still is
    ///
    /// # Returns
    /// None where it is no longer wanted.
    ///
    /// # Errors
    /// Those of [`Self::integrate`].
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
        let channels = self.integrated_while(is_wanted)?;
        Ok(is_wanted().then(|| self.simulated(channels, clock)))
    }

    /// Stage 7, with what the channels take of it.
    fn integrated_while(&self, is_wanted: &dyn Fn() -> bool) -> Result<Channels, Error> {
        let counts = StepCounts::default();
        let mut wanted = WantedChannels { channels: self.channels(), counts, is_wanted };
        self.integrate(&self.scenario.outputs(), self.time.first_kept_sample, &mut wanted)?;
        Ok(wanted.channels)
    }

    /// Stage 8, and everything together.
    fn simulated(self, mut channels: Channels, mut clock: Clock) -> Simulation {
        clock.lap("time integration");
        if !self.scenario.sensors.is_empty() {
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

    /// Stage 7: solves the equations of motion and hands the outputs of every sample to `recorder`.
    ///
    /// # Arguments
    /// * `outputs` - what is read off the solution
    /// * `first_sample` - first sample that is recorded; those before are computed all the same
    /// * `recorder` - takes the outputs, in the same order
    ///
    /// # Errors
    /// A motion that grows without bound, as with too little damping the varying mesh stiffness can make it.
    pub fn integrate(
        &self,
        outputs: &[Output],
        first_sample: usize,
        recorder: &mut dyn Recorder,
    ) -> Result<(), Error> {
        self.integrate_with(InstructionSet::fastest(), outputs, first_sample, recorder)
    }

    /// The error that a solution without bound is.
    pub(crate) fn divergence(&self, diverged: Diverged) -> Error {
        let time_s = diverged.sample as f64 * self.time.step_s();
        if let Some(error) = WheelName::BOTH.into_iter().find_map(|wheel| self.gap(wheel, time_s)) {
            return error.into();
        }
        let (key, damping_ratios) = self.damping();
        let help = "raise the damping ratios of [rig], use more teeth, or change operation.pinion_speed_hz";
        Error::Diverged { time_s, key, help, damping_ratios }
    }

    /// The same where more neighbours are missing on a wheel than pairs are in contact at once: nothing bears while they pass.
    fn gap(&self, wheel: WheelName, time_s: f64) -> Option<ScenarioError> {
        let missing = most_neighbours(&self.damaged, wheel, self.teeth.wheel(wheel).teeth as usize);
        let ratio = self.scenario.gears.total_contact_ratio();
        if missing as f64 <= ratio {
            return None;
        }
        let faults = self.scenario.faults.iter().enumerate();
        let of_wheel =
            faults.filter(|(_, fault)| fault.wheel == wheel && fault.damage.part() == ToothPart::Whole);
        let named: Vec<String> = of_wheel.map(|(n, _)| format!("fault[{n}]")).collect();
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
