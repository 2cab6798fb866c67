//! The eight stages, in order: layout, teeth, machine, static forces, wheels, meshes, modes and settling; then the time loop.

mod curves;
mod equations;
mod laws;
mod machine;
mod measured;
mod meshes;
mod on_ring;
pub(crate) mod random_force;
mod severities;
mod wheels;

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::{self, Debug, Formatter};
use std::num::NonZeroUsize;
use std::time::Duration;

use web_time::Instant;

pub use equations::Equations;
pub use machine::AssembledMachine;
use measured::WantedChannels;
use random_force::RandomForces;
pub use wheels::MeshedPair;
use wheels::{KnownDeviations, healthy_teeth, sound_pair};

use crate::bearing::RollingBearing;
use crate::damage::{DamagedTooth, ToothPart};
use crate::error::{Error, ScenarioError, ScenarioWarning};
use crate::machine::{DecayingMode, Drive, KnownModes};
use crate::mesh::{Contact, FacesAtRest, Mesh, Pairs};
use crate::operation::{Motion, TimeGrid, TorqueHarmonic};
use crate::published::Published;
use crate::scenario::{Layout, MemoryLimit, Ripple, Scenario};
use crate::sensor::{Channels, ContactFigures, Sensor, SignalSource};
use crate::simd::InstructionSet;
use crate::solver::{Diverged, ModalMachine, MotionState, Output, Recorder, StepCounts};
use crate::wheel::{KnownProfiles, Teeth, TipRelief, WheelDeviations, WheelName};

/// Results of every stage before the time loop, of any form of scenario: a pair is a train with one mesh.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct Stages {
    /// What is simulated. Keys that the model ignores are at their defaults; faults that were given by their severity have its sizes beside it.
    pub scenario: Scenario,
    /// How shafts, wheels and meshes stand and turn.
    pub layout: Layout,
    /// Division of time; a pinion revolution is one of the motor.
    pub time: TimeGrid,
    /// What the stages before the mesh make of each mesh's wheels.
    pub pairs: Vec<MeshedPair>,
    /// The meshes, in the order of the scenario; none under the published model, which has one of its own.
    pub meshes: Vec<Mesh>,
    /// The wheels as they push one another where the brake drives; none where the motor does.
    pub(crate) overrun: Option<Overrun>,
    /// The rolling bearings: each with its number in the scenario.
    pub bearings: Vec<(usize, RollingBearing)>,
    /// The sensors, each with its name: those listed, or among shafts of beams without any those on the bearings' seats.
    pub sensors: Vec<Sensor>,
    /// (-) How severe each of the scenario's faults is, from 0 to 1.
    pub fault_severities: Vec<f64>,
    /// The equations of motion, of a type that is public only for the project's own tests and benchmarks.
    #[cfg(feature = "internals")]
    #[doc(hidden)]
    pub equations: Equations,
    #[cfg(not(feature = "internals"))]
    pub(crate) equations: Equations,
    /// The mode that is the slowest to decay with the meshes closed.
    pub(crate) slowest_mode: DecayingMode,
    /// Time that each stage took.
    pub timings: Vec<StageTime>,
    /// What is doubtful by the scenario alone.
    pub(crate) warnings_of_scenario: Vec<ScenarioWarning>,
    /// Most memory that the simulation may need, and one that repeats it.
    pub(crate) memory_limit: MemoryLimit,
    /// The random forces of the run, once the meshes' forces are known; none where there are none.
    pub(crate) random_forces: Option<RandomForces>,
}

/// How the wheels push one another where the brake drives: the second one of each mesh comes first.
#[derive(Clone, PartialEq)]
pub(crate) struct Overrun {
    layout: Layout,
    pairs: Vec<MeshedPair>,
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
    /// Results of the stages.
    pub stages: Stages,
    /// The kept signals.
    pub channels: Channels,
    /// Steps, iterations of Newton's method, most of them in a step, and steps in which a search along the line was needed, of a machine that
    /// [`Stages::simulate`] steps alone ([`SteppedAlone`](crate::batch::SteppedAlone)); 0 of all others.
    pub step_counts: [u64; 4],
    /// Time that each stage took, the time loop included.
    pub timings: Vec<StageTime>,
    /// The motion at the first block of each tenth of the kept time; none of signals that were read.
    pub(crate) states: Vec<MotionState>,
}

/// Simulates a scenario, of one pair or of a gearbox.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// A scenario that is not valid, a fault that does not fit the tooth, a motion that grows without bound.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario, gearbox_template};
///
/// let mean = |force: &[f64]| force.iter().sum::<f64>() / force.len() as f64;
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.solver.sampling_rate_hz = 2e4;
/// let simulation = meshtone::simulate(&scenario)?;
/// assert!((mean(&simulation.channels["mesh_force_n"]) / 187.0 - 1.0).abs() < 0.01);
///
/// let mut gearbox = Scenario::from_toml(&gearbox_template(None))?;
/// gearbox.solver.duration_s = Some(0.1);
/// let simulation = meshtone::simulate(&gearbox)?;
/// let static_force_n = simulation.stages.pairs[1].static_force_n;
/// assert!((mean(&simulation.channels["force_n.z3-z4"]) / static_force_n - 1.0).abs() < 0.05);
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn simulate(scenario: impl Into<Scenario>) -> Result<Simulation, Error> {
    stages(scenario)?.simulate()
}

/// Runs every stage before the time loop.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// A scenario that is not valid, or a fault that does not fit the tooth.
pub fn stages(scenario: impl Into<Scenario>) -> Result<Stages, ScenarioError> {
    stages_within(scenario, MemoryLimit::default())
}

/// Does what [`stages`] does, with another limit of memory.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `limit` - most memory that the simulation, and one that repeats it, may need
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
pub fn stages_within(scenario: impl Into<Scenario>, limit: MemoryLimit) -> Result<Stages, ScenarioError> {
    stages_with(scenario.into(), limit, &KnownStages::default())
}

/// What stages made of the same for earlier simulations.
#[derive(Debug, Default)]
pub(crate) struct KnownStages {
    profiles: KnownProfiles,
    deviations: KnownDeviations,
    modes: KnownModes,
}

/// Does what [`stages_within`] does, with results of stages that are known already.
///
/// Layout and teeth come first, as both models need them, and settling last, as it is of both; what lies between is either a machine
/// around meshes or the published model. Faults get their severities only here, since the teeth of all meshes must be known for that.
pub(crate) fn stages_with(
    scenario: Scenario,
    memory_limit: MemoryLimit,
    known: &KnownStages,
) -> Result<Stages, ScenarioError> {
    let mut clock = Clock::default();
    let scenario = scenario.with_members();
    let mut warnings_of_scenario = scenario.validate_within(memory_limit)?;
    warnings_of_scenario.extend(scenario.ignored_by_model());
    let scenario = scenario.without_ignored_keys();
    let layout = scenario.layout()?;
    let mut time = scenario.time_grid();
    clock.lap("scenario");
    let teeth = healthy_teeth(scenario.model, &layout, &known.profiles);
    clock.lap("tooth profiles");
    let parts = if scenario.model.has_meshes() {
        machine_parts(&scenario, &layout, &time, teeth, known, &mut clock)?
    } else {
        published_parts(&scenario, &layout, &time, teeth, known, &mut clock)?
    };
    let Parts { pairs, overrun, meshes, bearings, equations, slowest_mode } = parts;
    let settle_tolerance = scenario.solver.settle_tolerance;
    // Only a motion that starts in equilibrium, and not one that is drawn anew for every sample: before the kept signal all else is steady.
    let is_drawn = scenario.operation.is_drawn_for_every_sample();
    if scenario.model.has_meshes() && scenario.solver.initial_velocity.is_none() && !is_drawn {
        time.first_simulated_sample = start_of_settling(&time, settle_tolerance, &slowest_mode);
    }
    let severities = pairs
        .iter()
        .flat_map(|pair| pair.faults.iter().map(|(number, fault)| (*number, fault.severity_on(&pair.teeth))));
    // A wheel in two meshes is damaged in both.
    let severities: BTreeMap<usize, f64> = severities.collect();
    Ok(Stages {
        sensors: scenario.all_sensors(),
        scenario: with_sizes(scenario, &pairs),
        layout,
        time,
        pairs,
        overrun,
        meshes,
        bearings,
        fault_severities: severities.into_values().collect(),
        equations,
        slowest_mode,
        timings: clock.laps,
        warnings_of_scenario,
        memory_limit,
        random_forces: None,
    })
}

/// The scenario with the sizes of the faults that were given by their severity beside it.
fn with_sizes(mut scenario: Scenario, pairs: &[MeshedPair]) -> Scenario {
    for (number, sized) in pairs.iter().flat_map(|pair| &pair.faults) {
        if let Some(fault) = scenario.faults.get_mut(*number) {
            fault.damage.clone_from(&sized.damage);
        }
    }
    scenario
}

/// What a model makes of the teeth.
struct Parts {
    pairs: Vec<MeshedPair>,
    overrun: Option<Overrun>,
    meshes: Vec<Mesh>,
    bearings: Vec<(usize, RollingBearing)>,
    equations: Equations,
    slowest_mode: DecayingMode,
}

/// The stages of a machine around meshes, in the order in which each needs what the ones before it gave.
///
/// The machine needs the base radii of the teeth, and gives the static forces that press these together; the meshes' tables need these
/// forces, the deviations and the damage of the wheels. The meshes then say which has its tilt as an unknown: there the machine
/// is taken to its modes a second time, with that tilt.
fn machine_parts(
    scenario: &Scenario,
    layout: &Layout,
    time: &TimeGrid,
    teeth: Vec<Teeth>,
    known: &KnownStages,
    clock: &mut Clock,
) -> Result<Parts, ScenarioError> {
    let (machine, bearings) = machine::assembled(scenario, layout, &teeth, &known.modes)?;
    let modal = machine.modal(scenario, &vec![0.0; teeth.len()]);
    let driven_mm: Vec<f64> = teeth.iter().map(|teeth| teeth.gear.base_radius_mm).collect();
    let forces_n = static_forces_n(Some(&modal), &driven_mm, scenario.operation.brake_torque_nm);
    clock.lap("equations of motion");
    let pairs: Vec<MeshedPair> = (teeth.into_iter().zip(forces_n).enumerate())
        .map(|(mesh, (teeth, force_n))| {
            sound_pair(scenario, layout, time, mesh, teeth, &known.deviations, force_n)
                .damaged(scenario, layout, mesh)
        })
        .collect::<Result<_, _>>()?;
    let overrun = scenario.operation.overruns().then(|| {
        let layout = layout.overrun(scenario);
        let teeth = healthy_teeth(scenario.model, &layout, &known.profiles);
        let pairs = pairs.iter().zip(teeth).map(|(pair, teeth)| pair.exchanged(teeth)).collect();
        Overrun { layout, pairs }
    });
    clock.lap("profile errors and faults");
    let (layout, pushing) =
        overrun.as_ref().map_or((layout, &pairs), |Overrun { layout, pairs }| (layout, pairs));
    let meshes = meshes::meshes(scenario, layout, time, (pushing, &machine), None)?;
    clock.lap("mesh stiffness");
    let half_face_m = |mesh: &Mesh| mesh.two_unknowns().map_or(0.0, |[width_m, _]| width_m / 2.0);
    let half_faces_m: Vec<f64> = meshes.iter().map(half_face_m).collect();
    let is_tilted = half_faces_m.iter().any(|half_m| *half_m > 0.0);
    let modal = if is_tilted { machine.modal(scenario, &half_faces_m) } else { modal };
    let closed: Vec<_> = meshes.iter().map(Mesh::closed).collect();
    let modal = modal.up_to(TAU * machine.stepped_up_to_hz);
    let slowest_mode = modal.slowest_closed(&closed, TAU * machine.highest_of_slow_hz);
    clock.lap("settling");
    let equations = Equations::Machine(Box::new(machine), Box::new(modal));
    Ok(Parts { pairs, overrun, meshes, bearings, equations, slowest_mode })
}

/// The same of the published model, which has a mesh and equations of motion of its own.
fn published_parts(
    scenario: &Scenario,
    layout: &Layout,
    time: &TimeGrid,
    teeth: Vec<Teeth>,
    known: &KnownStages,
    clock: &mut Clock,
) -> Result<Parts, ScenarioError> {
    let forces_n = static_forces_n(None, &[teeth[0].gear.base_radius_mm], scenario.operation.brake_torque_nm);
    let sound = |(mesh, (teeth, force_n))| {
        sound_pair(scenario, layout, time, mesh, teeth, &known.deviations, force_n)
    };
    let mut pairs: Vec<MeshedPair> = teeth.into_iter().zip(forces_n).enumerate().map(sound).collect();
    clock.lap("profile errors");
    let MeshedPair { teeth, profile_errors, cycle, damaged, .. } = &mut pairs[0];
    let published = Published::new(scenario, time, teeth, profile_errors.as_ref())?;
    (*cycle, *damaged) = (published.mesh.grid, published.damaged_tooth(teeth).into_iter().collect());
    clock.lap("mesh stiffness");
    let slowest_mode = published.slowest_mode();
    let equations = Equations::Published(Box::new(published));
    Ok(Parts { pairs, overrun: None, meshes: Vec::new(), bearings: Vec::new(), equations, slowest_mode })
}

/// (N) The forces along the lines of action that hold a torque of the brake: of one mesh by the driven wheel's base radius, of several by
/// the balance of the shafts that turn freely.
///
/// # Arguments
/// * `modal` - the machine in its modes
/// * `driven_mm` - (mm) base radius of each mesh's driven wheel
/// * `torque_nm` - (N m) the torque
fn static_forces_n(modal: Option<&ModalMachine>, driven_mm: &[f64], torque_nm: f64) -> Vec<f64> {
    match (driven_mm, modal) {
        ([_, _, ..], Some(modal)) => modal.balancing_forces_n(torque_nm),
        _ => driven_mm.iter().map(|radius_mm| torque_nm.abs() / (radius_mm * 1e-3)).collect(),
    }
}

/// First sample that must be simulated, so that a mode's transient has decayed to the settling tolerance where the kept signal starts.
fn start_of_settling(time: &TimeGrid, settle_tolerance: f64, slowest: &DecayingMode) -> usize {
    // Where nothing decays, or nothing is tolerated, all of the settling is simulated: as a float, that takes forever.
    let decay_s = -settle_tolerance.ln() / slowest.decay_per_s.clamp(0.0, f64::MAX);
    let settling = (decay_s * time.sampling_rate_hz).ceil();
    time.first_kept_sample.saturating_sub(settling as usize)
}

impl Simulation {
    /// (-) Part of the mean power of a mesh's driving wheel that the friction of the flanks leaves; none of frictionless flanks, and where no power
    /// passes.
    ///
    /// # Arguments
    /// * `mesh` - its number
    pub fn efficiency(&self, mesh: usize) -> Option<f64> {
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len().max(1) as f64;
        let loss_w = self.channels.of(SignalSource::FrictionLoss(mesh));
        let driving_rad_per_s = TAU
            * self.stages.scenario.operation.pinion_speed_hz
            * self.stages.layout.driving_ratio(mesh).abs();
        let base_radius_m = self.stages.pairs.get(mesh)?.teeth.pinion.base_radius_mm * 1e-3;
        let power_w =
            mean(self.channels.of(SignalSource::MeshForce(mesh))) * base_radius_m * driving_rad_per_s;
        (!loss_w.is_empty() && power_w > 0.0).then(|| 1.0 - mean(loss_w) / power_w)
    }

    /// How the teeth of the first mesh touched; none where the flanks may pull.
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

    /// How the meshes would bear along their faces at rest on other shafts; none where they always bear evenly.
    ///
    /// # Arguments
    /// * `changed` - a scenario that differs from this one in its shafts, or in where wheels sit on them
    pub(crate) fn faces_at_rest_of(&self, changed: &Scenario) -> Option<FacesAtRest> {
        let layout = changed.layout().ok()?;
        let teeth: Vec<Teeth> = self.pairs.iter().map(|pair| pair.teeth.clone()).collect();
        let machine = machine::bare(changed, &layout, &teeth).ok()?;
        meshes::faces_at_rest(changed, &layout, &machine, &self.pairs, &self.meshes)
    }

    /// The tooth pairs of the first mesh, at any position of their path; not under the published model, whose flanks are not conjugate.
    pub fn tooth_pairs(&self) -> Pairs<'_> {
        let (gears, MeshedPair { teeth, damaged, .. }) = (&self.layout.gears[0], &self.pushing().1[0]);
        Pairs::new(teeth, damaged, gears)
    }

    /// The meshes, with another number of points from one pair to the next than the time loop has; none under the published model.
    ///
    /// # Arguments
    /// * `points_per_pitch` - how many
    ///
    /// # Errors
    /// Damaged teeth that were put beyond a wheel's last one, misaligned shafts without a load.
    pub fn meshes_at(&self, points_per_pitch: NonZeroUsize) -> Result<Vec<Mesh>, ScenarioError> {
        let Some((machine, _)) = self.machine() else { return Ok(Vec::new()) };
        let (layout, pairs) = self.pushing();
        meshes::meshes(&self.scenario, layout, &self.time, (pairs, machine), Some(points_per_pitch))
    }

    /// The wheels with the one that pushes its mate first: where the brake drives, the second of each mesh.
    fn pushing(&self) -> (&Layout, &[MeshedPair]) {
        self.overrun.as_ref().map_or((&self.layout, &self.pairs), |overrun| (&overrun.layout, &overrun.pairs))
    }

    /// The deviations of the wheels of each mesh beside their profile errors: run-out and helix slope. With the profile errors, of
    /// which the pitches are a part, these are all their deviations: given to a scenario, they make the same signals.
    pub fn wheel_deviations(&self) -> Vec<[WheelDeviations; 2]> {
        let of_wheel = |pair: &MeshedPair, wheel: usize| WheelDeviations {
            cumulative_pitch_um: None,
            run_out_um: Some(pair.run_out[wheel].run_out_um),
            run_out_phase_rad: Some(pair.run_out[wheel].phase_rad),
            helix_slope_um: Some(pair.helix_slope_um[wheel]),
        };
        if !self.scenario.model.has_meshes() {
            return vec![Default::default()];
        }
        self.pairs.iter().map(|pair| [of_wheel(pair, 0), of_wheel(pair, 1)]).collect()
    }

    /// (mm) How far the chamfers of a wheel's tips and their relief reach inwards from the tip, in the first mesh; 0 where there is none.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn tip_lengths_mm(&self, wheel: WheelName) -> [f64; 2] {
        if !self.scenario.model.has_meshes() {
            return [0.0, TipRelief::PUBLISHED.length_mm];
        }
        self.layout.gears[0].tip_lengths_mm(wheel)
    }

    /// (N) Force along the line of action of the first mesh that balances the brake's nominal torque.
    pub fn static_force_n(&self) -> f64 {
        self.pairs[0].static_force_n
    }

    /// (N) The forces of the meshes that hold a torque of the brake.
    ///
    /// # Arguments
    /// * `torque_nm` - (N m) the torque
    pub(crate) fn forces_of_torque_n(&self, torque_nm: f64) -> Vec<f64> {
        let driven_mm: Vec<f64> = self.pairs.iter().map(|pair| pair.teeth.gear.base_radius_mm).collect();
        static_forces_n(self.machine().map(|(_, modal)| modal), &driven_mm, torque_nm)
    }

    /// Whether motor and brake are steady.
    pub fn is_steady(&self) -> bool {
        self.scenario.operation.is_steady()
    }

    /// Samples after which all teeth and shafts stand again as at the start, where motor and brake are steady and no rolling bearing slips.
    pub(crate) fn cycle_samples(&self) -> Option<usize> {
        let revolutions = usize::try_from(self.layout.cycle_revolutions()).ok()?;
        let samples = revolutions.checked_mul(self.time.samples_per_pinion_revolution)?;
        (self.is_steady() && self.bearings.is_empty()).then_some(samples)
    }

    /// Motion of motor and brake, sample by sample from the start of the simulation.
    pub fn motion(&self) -> Motion<'_> {
        self.motion_in(&self.time)
    }

    /// The same in another division of time.
    fn motion_in(&self, time: &TimeGrid) -> Motion<'_> {
        let brake = self.machine().map_or(1.0, |(AssembledMachine { machine, .. }, _)| {
            let of_brake = machine.drives.iter().find_map(|drive| match drive {
                Drive::Brake { coordinate, .. } => Some(machine.rigid_rotation[*coordinate].abs()),
                Drive::Motor { .. } => None,
            });
            of_brake.unwrap_or(1.0)
        });
        let ratio = |ripple: &Ripple| {
            let shaft = self.layout.shaft_names.iter().position(|name| Some(name) == ripple.shaft.as_ref());
            shaft.map_or(brake, |shaft| self.layout.ratios[shaft].value().abs())
        };
        let harmonic = |ripple: &Ripple| TorqueHarmonic {
            order: ripple.order * ratio(ripple),
            amplitude: ripple.amplitude,
            phase_rad: ripple.phase_deg.to_radians(),
        };
        let ripple = self.scenario.operation.torque_ripple.iter().map(harmonic).collect();
        Motion::new(&self.scenario.operation, self.scenario.seed, time).with_ripple(ripple)
    }

    /// The simulation that signals are of, such as those read from its file.
    ///
    /// # Arguments
    /// * `channels` - those of [`Scenario::signals`] with their samples
    pub fn with_channels(self, channels: Channels) -> Simulation {
        Simulation {
            channels,
            step_counts: [0; 4],
            timings: self.timings.clone(),
            states: Vec::new(),
            stages: self,
        }
    }

    /// The time loop and the sensors: the rest of the simulation, for those who have looked at the stages before.
    ///
    /// # Errors
    /// Those of [`Self::integrate`]; a result that no machine can have.
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
        let wanted = self.integrated_while(&|| true)?;
        self.simulated(wanted, clock).lawful()
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
    /// Those of [`Self::simulate`].
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
        let wanted = self.integrated_while(is_wanted)?;
        if is_wanted() { self.simulated(wanted, clock).lawful().map(Some) } else { Ok(None) }
    }

    /// The time loop, with what the channels take of it.
    fn integrated_while<'w>(&self, is_wanted: &'w dyn Fn() -> bool) -> Result<WantedChannels<'w>, Error> {
        let mut wanted = WantedChannels::new(self, is_wanted);
        self.integrate(&self.scenario.outputs(), self.time.first_kept_sample, &mut wanted)?;
        Ok(wanted)
    }

    /// What the sensors show, and everything together.
    fn simulated(self, wanted: WantedChannels, mut clock: Clock) -> Simulation {
        clock.lap("time integration");
        let WantedChannels { channels, counts, states, .. } = wanted;
        let stages = self.with_random_forces_of(&channels);
        let channels = stages.measured(channels);
        if !stages.sensors.is_empty() {
            clock.lap("sensors");
        }
        let timings = stages.timings.iter().copied().chain(clock.laps).collect();
        let StepCounts { steps, iterations, most_iterations, searched } = counts;
        let step_counts = [steps, iterations, most_iterations, searched];
        Simulation { stages, channels, step_counts, timings, states }
    }

    /// (rev) Simulated revolutions of the motor at the nominal speed, settling included.
    pub fn pinion_revolutions(&self) -> f64 {
        self.time.samples as f64 / self.time.samples_per_pinion_revolution as f64
    }

    /// Solves the equations of motion and hands the outputs of every sample to `recorder`.
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
        self.integrate_with(InstructionSet::in_use(), outputs, first_sample, recorder)
    }

    /// The error that a solution without bound is.
    pub(crate) fn divergence(&self, diverged: Diverged) -> Error {
        let time_s = diverged.sample as f64 * self.time.step_s();
        if let Some(error) = self.gap(time_s) {
            return error.into();
        }
        if let Some(help) = self.help_of_load() {
            let problem = format!("the motion grows without bound within {time_s:.4} s");
            return Error::Impossible { problem, help };
        }
        let (key, damping_ratios) = self.damping();
        let help = self.scenario.words().against_growth;
        Error::Diverged { time_s, key, help, damping_ratios }
    }

    /// The same where more neighbours are missing on a wheel than pairs are in contact at once: nothing bears while they pass.
    fn gap(&self, time_s: f64) -> Option<ScenarioError> {
        let meshes = (self.pairs.iter().zip(&self.layout.gears)).zip(&self.layout.wheels_of_mesh);
        meshes.flat_map(|(mesh, wheels)| WheelName::BOTH.map(|side| (mesh, wheels, side))).find_map(
            |((pair, gears), wheels, side)| {
                let ratio = gears.total_contact_ratio();
                let missing = most_neighbours(&pair.damaged, side, pair.teeth.wheel(side).teeth as usize);
                (missing as f64 > ratio)
                    .then(|| self.without_bearing(wheels[side as usize], missing, ratio, time_s))
            },
        )
    }

    /// The error of teeth that are missing side by side.
    fn without_bearing(&self, wheel: usize, missing: usize, ratio: f64, time_s: f64) -> ScenarioError {
        let wheel = &self.scenario.wheels[wheel].name;
        let article = if self.scenario.rig().is_some() { "the " } else { "" };
        let faults = self.scenario.faults.iter().enumerate();
        let of_wheel =
            faults.filter(|(_, fault)| fault.wheel == *wheel && fault.damage.part() == ToothPart::Whole);
        let named: Vec<String> = of_wheel.map(|(n, _)| format!("fault[{n}]")).collect();
        let named = named.join(", ");
        let problem = format!(
            "{missing} neighbouring teeth of {article}{wheel} are missing ({named}), more than the {ratio:.2} pairs in contact at once: \
             nothing bears while they pass, and the motion grows without bound within {time_s:.4} s"
        );
        let help = "remove some of these faults, or some numbers from their fault.tooth";
        ScenarioError::new("fault", "", problem).with_help(help)
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
