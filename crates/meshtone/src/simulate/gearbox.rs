//! The stages of a gearbox: those of a pair for each mesh, one machine around all of them, one integration.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::num::NonZeroUsize;
use std::sync::Arc;

use super::measured::WantedChannels;
use super::{Clock, MeshOf, StageTime, start_of_settling};
use crate::bearing::{BearingTurning, RollingBearing, RollingParts};
use crate::damage::{DamagedTooth, Fault, damaged_teeth_of_file};
use crate::error::{Error, ScenarioError, ScenarioWarning};
use crate::machine::{
    Axis, DecayingMode, Disc, GearboxMachine, GearboxParts, KnownModes, MeshLine, Modes, PlacedUnbalance,
    SeatedBearing, WheelBody,
};
use crate::mesh::{Contact, Forcing, Mesh, PairDeviations, Turning};
use crate::operation::{CycleGrid, Motion, TimeGrid, TorqueHarmonic};
use crate::random::{Draws, Purpose};
use crate::scenario::{Gearbox, GearboxLayout, GearboxMesh, GearboxSensor, GearboxShaft, MemoryLimit};
use crate::sensor::{Channels, GRAVITY_M_PER_S2, Measurement, NamedSignal, SignalSource};
use crate::simd::InstructionSet;
use crate::solver::{InitialMotion, ModalMachine, Output, Problem, Recorder, StepCounts, integrate};
use crate::threads;
use crate::trace_fields::Trace;
use crate::wheel::quality::deviations;
use crate::wheel::{
    Deviations, ERROR_POINTS, ErrorTable, Gears, ProfileErrors, RunOut, Teeth, WheelName, teeth,
};

/// Two wheels of a gearbox in mesh: what the stages before the mesh make of them.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeshedPair {
    /// Both healthy wheels and their contact.
    pub teeth: Teeth,
    /// Profile errors; none for ideal teeth.
    pub profile_errors: Option<ProfileErrors>,
    /// Run-out of the driving and of the driven wheel.
    pub run_out: [RunOut; 2],
    /// (µm) Helix slope deviation of both over the face width.
    pub helix_slope_um: [f64; 2],
    /// The damaged teeth.
    pub damaged: Vec<DamagedTooth>,
    /// The faults on both wheels with their sizes, each with its number in the gearbox.
    pub faults: Vec<(usize, Fault)>,
    /// (N) Force along the line of action that holds the brake's nominal torque.
    pub static_force_n: f64,
}

/// Results of every stage of a gearbox before the time loop.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct GearboxStages {
    /// What is simulated.
    pub gearbox: Gearbox,
    /// How its parts stand and turn.
    pub layout: GearboxLayout,
    /// Division of time; a pinion revolution is one of the input.
    pub time: TimeGrid,
    /// What the stages before the mesh make of each mesh's wheels.
    pub pairs: Vec<MeshedPair>,
    /// The meshes, in the order of the file.
    pub meshes: Vec<Mesh>,
    /// The rolling bearings: each with its number in the gearbox.
    pub bearings: Vec<(usize, RollingBearing)>,
    /// The sensors, listed or by default.
    pub sensors: Vec<GearboxSensor>,
    /// (-) How severe each fault is, from 0 to 1.
    pub fault_severities: Vec<f64>,
    /// Time that each stage took.
    pub timings: Vec<StageTime>,
    machine: GearboxMachine,
    modes: Arc<Modes>,
    /// The machine in the modes that are stepped.
    modal: ModalMachine,
    /// The mode that is the slowest to decay with the meshes closed.
    pub(crate) slowest_mode: DecayingMode,
    pub(crate) warnings_of_scenario: Vec<ScenarioWarning>,
    /// Most memory that the simulation may need, and one that repeats it.
    pub(crate) memory_limit: MemoryLimit,
}

/// A simulation of a gearbox.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub struct GearboxSimulation {
    /// Results of the stages.
    pub stages: GearboxStages,
    /// The kept signals.
    pub channels: Channels,
    /// Steps, iterations of Newton's method, most of them in a step, and steps in which a search along the line was needed.
    pub step_counts: [u64; 4],
    /// Time that each stage took, the time loop included.
    pub timings: Vec<StageTime>,
}

/// Runs every stage of a gearbox before the time loop.
///
/// # Arguments
/// * `gearbox` - what is simulated
///
/// # Errors
/// A gearbox that is not valid, or a fault that does not fit the tooth.
pub fn gearbox_stages(gearbox: &Gearbox) -> Result<GearboxStages, ScenarioError> {
    gearbox_stages_within(gearbox, MemoryLimit::default())
}

/// Does what [`gearbox_stages`] does, with another limit of memory.
///
/// # Arguments
/// * `gearbox` - what is simulated
/// * `limit` - most memory that the simulation, and one that repeats it, may need
///
/// # Errors
/// Those of [`gearbox_stages`].
pub fn gearbox_stages_within(gearbox: &Gearbox, limit: MemoryLimit) -> Result<GearboxStages, ScenarioError> {
    stages_with(gearbox, limit, &KnownModes::default())
}

/// Does what [`gearbox_stages`] does, with modes that are known already.
pub(crate) fn gearbox_stages_with(
    gearbox: &Gearbox,
    known: &KnownModes,
) -> Result<GearboxStages, ScenarioError> {
    stages_with(gearbox, MemoryLimit::default(), known)
}

/// (Hz) Natural frequency above which modes decay faster than those below.
const HIGHEST_OF_SLOW_HZ: f64 = 2e3;

/// Does what [`gearbox_stages_within`] does, with modes that are known already.
///
/// The wheels' teeth are made first, as the machine needs their base radii. It gives the static forces, which the meshes' tables need, and
/// these say which modes are stepped.
fn stages_with(
    gearbox: &Gearbox,
    memory_limit: MemoryLimit,
    known: &KnownModes,
) -> Result<GearboxStages, ScenarioError> {
    let mut clock = Clock::default();
    let warnings_of_scenario = gearbox.validate_within(memory_limit)?;
    let layout = GearboxLayout::new(gearbox)?;
    let (time, is_steady) = (gearbox.time_grid(), gearbox.operation.is_steady());
    clock.lap("scenario");
    let teeth: Vec<Teeth> =
        (0..gearbox.meshes.len()).map(|mesh| teeth_of_mesh(gearbox, &layout, mesh)).collect();
    clock.lap("tooth profiles");
    let sensors = gearbox.all_sensors();
    let MachineAround { machine, mesh_mass_kg, bearings } = machine_of(gearbox, &layout, &teeth, &sensors)?;
    let modes = known.damped_by_springs(&machine.machine);
    let modal_machine =
        |face_reach_m: &[f64]| ModalMachine::new(&machine.machine, &modes, face_reach_m, start(gearbox));
    let modal = modal_machine(&vec![0.0; teeth.len()]);
    clock.lap("equations of motion");
    let pairs: Vec<MeshedPair> = (teeth.into_iter().zip(&modal.lines).enumerate())
        .map(|(mesh, (teeth, line))| meshed_pair(gearbox, &layout, mesh, teeth, line.static_force_n))
        .collect::<Result<_, _>>()?;
    clock.lap("profile errors and faults");
    let meshes: Vec<Mesh> = (pairs.iter().zip(mesh_mass_kg).enumerate())
        .map(|(number, (pair, mesh_mass_kg))| {
            let gears = layout.named_gears(gearbox, number);
            let driving = layout.shaft_of_wheel[layout.wheels_of_mesh[number][0]];
            let turning = Turning {
                pitches_per_revolution: f64::from(gears.pinion_teeth) * layout.ratios[driving].value().abs(),
                first_pitch: layout.phases[number],
            };
            let mesh = MeshOf {
                gears: &gears,
                teeth: &pair.teeth,
                damaged: &pair.damaged,
                machine: &machine.machine,
                modes: &modes,
                number,
                closer_um: pair.helix_slope_um.iter().sum(),
                static_force_n: pair.static_force_n,
                contact: Contact::Unilateral,
                turning,
                sense: layout.ratios[driving].value().signum(),
                damping_ratio: gearbox.meshes[number].damping_ratio,
                mesh_mass_kg,
            };
            let points = points_per_pitch(&time, is_steady, &turning, &gears);
            mesh.with_tables(NonZeroUsize::new(points).unwrap_or(NonZeroUsize::MIN))
        })
        .collect::<Result<_, ScenarioError>>()?;
    clock.lap("mesh stiffness");
    let face_reach_m: Vec<f64> = meshes.iter().map(Mesh::face_reach_m).collect();
    let is_tilted = face_reach_m.iter().any(|reach_m| *reach_m > 0.0);
    let highest_hz = gearbox.solver.highest_mode_hz(time.sampling_rate_hz);
    let modal = if is_tilted { modal_machine(&face_reach_m) } else { modal }.up_to(TAU * highest_hz);
    let closed: Vec<_> = meshes.iter().map(Mesh::closed).collect();
    let slowest_mode = modal.slowest_closed(&closed, TAU * HIGHEST_OF_SLOW_HZ);
    let settle_tolerance = gearbox.solver.settings.settle_tolerance;
    let first_simulated_sample =
        if is_steady { start_of_settling(&time, settle_tolerance, &slowest_mode) } else { 0 };
    clock.lap("settling");
    let severities = pairs
        .iter()
        .flat_map(|pair| pair.faults.iter().map(|(number, fault)| (*number, fault.severity_on(&pair.teeth))));
    // A wheel in two meshes is damaged in both.
    let severities: BTreeMap<usize, f64> = severities.collect();
    Ok(GearboxStages {
        gearbox: gearbox.clone(),
        layout,
        time: TimeGrid { first_simulated_sample, ..time },
        pairs,
        meshes,
        bearings,
        sensors,
        fault_severities: severities.into_values().collect(),
        timings: clock.laps,
        machine,
        modes,
        modal,
        slowest_mode,
        warnings_of_scenario,
        memory_limit,
    })
}

/// Simulates a gearbox.
///
/// # Arguments
/// * `gearbox` - what is simulated
///
/// # Errors
/// Those of [`gearbox_stages`], and a motion that grows without bound.
///
/// ```
/// use meshtone::scenario::{Gearbox, gearbox_template};
///
/// let mut gearbox = Gearbox::from_toml(&gearbox_template(None))?;
/// gearbox.solver.settings.duration_s = Some(0.1);
/// let simulation = meshtone::simulate_gearbox(&gearbox)?;
/// let force = simulation.channels.signal("force_n.z3-z4").unwrap();
/// let mean = force.iter().sum::<f64>() / force.len() as f64;
/// assert!((mean / simulation.stages.pairs[1].static_force_n - 1.0).abs() < 0.05);
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn simulate_gearbox(gearbox: &Gearbox) -> Result<GearboxSimulation, Error> {
    gearbox_stages(gearbox)?.simulate()
}

/// Simulates gearboxes, in the threads of the current rayon pool.
///
/// # Arguments
/// * `gearboxes` - what is simulated
/// * `keep` - what is kept of a simulation
///
/// # Returns
/// For each in its place what is kept, or the error of [`simulate_gearbox`]; results do not depend on the number of threads.
pub fn simulate_gearboxes<T: Send>(
    gearboxes: &[Gearbox],
    keep: impl Fn(GearboxSimulation) -> T + Sync,
) -> Vec<Result<T, Error>> {
    let known = KnownModes::default();
    threads::map(gearboxes, |gearbox| gearbox_stages_with(gearbox, &known)?.simulate().map(&keep))
}

/// The healthy teeth of a mesh's wheels.
pub(super) fn teeth_of_mesh(gearbox: &Gearbox, layout: &GearboxLayout, mesh: usize) -> Teeth {
    let bores_mm = layout.wheels_of_mesh[mesh]
        .map(|wheel| gearbox.shafts[layout.shaft_of_wheel[wheel]].radius_at_mm(gearbox.wheels[wheel].at));
    teeth(&layout.gears[mesh], bores_mm)
}

/// The wheels of a mesh: deviations of each, drawn with a seed of its own, and damage.
fn meshed_pair(
    gearbox: &Gearbox,
    layout: &GearboxLayout,
    mesh: usize,
    teeth: Teeth,
    static_force_n: f64,
) -> Result<MeshedPair, ScenarioError> {
    let numbers = layout.wheels_of_mesh[mesh];
    let [of_pinion, of_gear] = WheelName::BOTH.map(|side| {
        let seed = gearbox.wheels_seed.unwrap_or(gearbox.seed);
        let seed = Draws::new(seed, Purpose::GearboxWheel, numbers[side as usize] as u64).bits();
        deviations(&layout.quality_of_mesh(gearbox, mesh, side), &teeth, seed)
    });
    let profile_errors = joined(of_pinion.flanks.clone(), of_gear.flanks.clone(), &teeth);
    let Deviations { run_out: [pinion_run_out, _], helix_slope_um: [pinion_um, _], .. } = of_pinion;
    let Deviations { run_out: [_, gear_run_out], helix_slope_um: [_, gear_um], .. } = of_gear;
    let (numbers, faults): (Vec<usize>, Vec<Fault>) =
        layout.faults_of_mesh(gearbox, mesh).into_iter().unzip();
    let damaged = damaged_teeth_of_file(&faults, &numbers, gearbox.faults.len(), &teeth, gearbox.seed)?;
    let faults = faults.iter().map(|fault| fault.with_sizes(&teeth));
    Ok(MeshedPair {
        profile_errors,
        run_out: [pinion_run_out, gear_run_out],
        helix_slope_um: [pinion_um, gear_um],
        damaged,
        faults: numbers.into_iter().zip(faults).collect(),
        static_force_n,
        teeth,
    })
}

/// The pinion's errors of one draw and the gear's of another; ideal where one has none.
fn joined(
    pinion: Option<ProfileErrors>,
    gear: Option<ProfileErrors>,
    teeth: &Teeth,
) -> Option<ProfileErrors> {
    let is_given = pinion.is_some() || gear.is_some();
    let table = |errors: Option<ProfileErrors>, wheel: WheelName| match errors {
        Some(errors) => wheel.choose(errors.pinion_profile_errors_mm, errors.gear_profile_errors_mm),
        None => ErrorTable::filled(ERROR_POINTS, teeth.wheel(wheel).teeth as usize, 0.0),
    };
    is_given.then(|| ProfileErrors {
        pinion_profile_errors_mm: table(pinion, WheelName::Pinion),
        gear_profile_errors_mm: table(gear, WheelName::Gear),
    })
}

/// The machine around the meshes.
struct MachineAround {
    /// With the places that outputs read.
    machine: GearboxMachine,
    /// (kg) The mass that the wheels' rotation has along each line of action.
    mesh_mass_kg: Vec<f64>,
    /// The rolling bearings: each with its number in the gearbox.
    bearings: Vec<(usize, RollingBearing)>,
}

/// Puts the machine together. Rolling bearings have the stiffness of linear ones first, which gives their static loads, and these the
/// linear springs in their places.
fn machine_of(
    gearbox: &Gearbox,
    layout: &GearboxLayout,
    teeth: &[Teeth],
    sensors: &[GearboxSensor],
) -> Result<MachineAround, ScenarioError> {
    let shafts: Vec<_> = gearbox.shafts.iter().zip(layout.positions_m.iter().copied()).collect();
    let discs: Vec<Disc> = (gearbox.wheels.iter().enumerate())
        .map(|(number, wheel)| {
            // Every wheel is in a mesh, as the layout has checked.
            let (mesh, side) = layout.mesh_of(number).unwrap_or((0, WheelName::Pinion));
            let mut tooth = *teeth[mesh].wheel(side);
            tooth.face_width_mm = wheel.face_width_mm;
            let body = WheelBody::new(&tooth, layout.gears[mesh].material, &wheel.inertia);
            Disc { shaft: layout.shaft_of_wheel[number], at: wheel.at, body }
        })
        .collect();
    let lines: Vec<MeshLine> = (teeth.iter().zip(&layout.wheels_of_mesh).zip(&layout.gears))
        .map(|((teeth, &wheels), gears)| MeshLine {
            wheels,
            base_radii_m: WheelName::BOTH.map(|side| teeth.wheel(side).base_radius_mm * 1e-3),
            working_pressure_angle_rad: teeth.gear.working_pressure_angle_rad,
            thrust: gears.thrust(),
        })
        .collect();
    let mass_kg = lines.iter().map(|line| {
        let both = line.wheels.iter().zip(line.base_radii_m);
        1.0 / both.map(|(&disc, radius_m)| radius_m * radius_m / discs[disc].body.polar_kgm2).sum::<f64>()
    });
    let linear: Vec<SeatedBearing> = (layout.shaft_of_bearing.iter().zip(&gearbox.bearings))
        .map(|(&shaft, bearing)| SeatedBearing::linear(shaft, bearing))
        .collect();
    let rolling: Vec<(usize, RollingParts)> = gearbox.rolling_bearings()?;
    let ratios: Vec<f64> = layout.ratios.iter().map(|ratio| ratio.value()).collect();
    let of_wheels = (gearbox.wheels.iter().zip(&layout.shaft_of_wheel))
        .map(|(wheel, &shaft)| PlacedUnbalance { shaft, at: wheel.at, unbalance: &wheel.unbalance });
    let of_shafts = (gearbox.shafts.iter().enumerate()).map(|(shaft, of)| PlacedUnbalance {
        shaft,
        at: 0.5,
        unbalance: &of.unbalance,
    });
    let unbalances: Vec<_> = of_wheels.chain(of_shafts).filter(|of| of.unbalance.g_mm > 0.0).collect();
    let mut parts = GearboxParts {
        shafts: &shafts,
        speed_ratios: &ratios,
        discs: &discs,
        meshes: &lines,
        bearings: &linear,
        housing: gearbox.housing.as_ref(),
        material: gearbox.material,
        unbalances: &unbalances,
        brake_inertia_kgm2: gearbox.operation.brake_inertia_kgm2,
    };
    let mut machine = GearboxMachine::new(&parts);
    let (mut seated, mut bearings) = (linear.clone(), Vec::new());
    if !rolling.is_empty() {
        let loads_n = machine.static_bearing_loads_n(&parts, gearbox.operation.drive.brake_torque_nm);
        for ((number, rolling), load_n) in rolling.into_iter().zip(loads_n) {
            let bearing = RollingBearing::new(rolling, load_n);
            seated[number].radial_n_per_m = bearing.spring_n_per_m;
            bearings.push((number, bearing));
        }
        parts.bearings = &seated;
        machine = GearboxMachine::new(&parts);
    }
    for (sensor, place) in sensors.iter().zip(gearbox.places(layout)?) {
        machine.add_place(sensor.name(), place);
    }
    for (number, shaft) in gearbox.shafts.iter().enumerate() {
        machine.add_rotation(speed_name(&shaft.name), number);
    }
    for (number, mesh) in gearbox.meshes.iter().enumerate() {
        machine.add_transmission_error(transmission_error_name(&mesh.name()), number);
    }
    Ok(MachineAround { machine, mesh_mass_kg: mass_kg.collect(), bearings })
}

fn start(gearbox: &Gearbox) -> InitialMotion<'static> {
    let drive = &gearbox.operation.drive;
    let first_hz = drive.speed_profile_hz.as_ref().map_or(drive.pinion_speed_hz, |profile| profile.value[0]);
    InitialMotion {
        nominal_rad_per_s: TAU * drive.pinion_speed_hz,
        brake_torque_nm: drive.brake_torque_nm,
        motor_rad_per_s: TAU * first_hz,
        velocity: None,
    }
}

/// Name of the speed of a shaft.
fn speed_name(shaft: &str) -> String {
    format!("speed_hz.{shaft}")
}

/// Name of the transmission error of a mesh.
fn transmission_error_name(mesh: &str) -> String {
    format!("transmission_error_um.{mesh}")
}

/// Points from one pair to the next: where a whole number of samples passes between them every sample is one, else the coarse points of
/// the cycle, between which the tables are read.
fn points_per_pitch(time: &TimeGrid, is_steady: bool, turning: &Turning, gears: &Gears) -> usize {
    let samples = time.samples_per_pinion_revolution as f64 / turning.pitches_per_revolution;
    let is_whole = (samples.round() / samples - 1.0).abs() < 1e-12;
    if is_whole && turning.first_pitch == 0.0 && is_steady {
        return samples.round() as usize;
    }
    CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz).points_per_pitch
}

impl Gearbox {
    /// The signals that a simulation has, without their samples, in the order of files: sensors first.
    pub fn signals(&self) -> Vec<NamedSignal> {
        self.signals_and_outputs().into_iter().map(|(signal, _)| signal).collect()
    }

    /// What each of [`Self::signals`] is of the solution.
    pub(crate) fn outputs(&self) -> Vec<Output> {
        self.signals_and_outputs().into_iter().map(|(_, output)| output).collect()
    }

    fn signals_and_outputs(&self) -> Vec<(NamedSignal, Output)> {
        let sensor = |(number, sensor): (usize, GearboxSensor)| {
            let (place, axis) = (sensor.name().into(), sensor.axis());
            let output = Output::Acceleration { place, axis, factor: 1.0 / GRAVITY_M_PER_S2 };
            (NamedSignal::new(sensor.channel(), SignalSource::Sensor(number)), output)
        };
        let mesh = |(mesh, of): (usize, &GearboxMesh)| {
            let (name, axis) = (transmission_error_name(&of.name()), Axis::Rotation);
            let error = Output::Displacement { place: name.clone().into(), axis, factor: 1e6 };
            let force = NamedSignal::new(format!("force_n.{}", of.name()), SignalSource::MeshForce(mesh));
            [
                (force, Output::MeshForce { mesh }),
                (NamedSignal::new(name, SignalSource::TransmissionError(mesh)), error),
            ]
        };
        let shaft = |(shaft, of): (usize, &GearboxShaft)| {
            let (name, axis) = (speed_name(&of.name), Axis::Rotation);
            let output = Output::Velocity { place: name.clone().into(), axis, factor: 1.0 / TAU };
            (NamedSignal::new(name, SignalSource::ShaftSpeed(shaft)), output)
        };
        let sensors = self.all_sensors().into_iter().enumerate().map(sensor);
        let meshes = self.meshes.iter().enumerate().flat_map(mesh);
        sensors.chain(meshes).chain(self.shafts.iter().enumerate().map(shaft)).collect()
    }
}

impl GearboxStages {
    /// (Hz) Natural frequencies of the machine with its meshes closed at their mean stiffness, rising; 0 of the whole train's free rotation,
    /// where nothing holds it.
    pub fn natural_frequencies_hz(&self) -> Vec<f64> {
        self.natural_frequencies_with_hz(&self.mean_stiffness_n_per_m())
    }

    /// (Hz) The same with other mesh stiffnesses.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh
    pub fn natural_frequencies_with_hz(&self, mesh_stiffness_n_per_m: &[f64]) -> Vec<f64> {
        self.machine.machine.closed_modes(mesh_stiffness_n_per_m).0
    }

    /// (N/m) Mean stiffness of each mesh.
    pub fn mean_stiffness_n_per_m(&self) -> Vec<f64> {
        self.meshes.iter().map(|mesh| mesh.mean_stiffness_n_per_m).collect()
    }

    /// Whether motor and brake are steady.
    pub fn is_steady(&self) -> bool {
        self.gearbox.operation.is_steady()
    }

    /// Samples after which all teeth and shafts stand again as at the start, where motor and brake are steady and no rolling bearing slips.
    fn cycle_samples(&self) -> Option<usize> {
        let revolutions = usize::try_from(self.layout.cycle_revolutions()).ok()?;
        let samples = revolutions.checked_mul(self.time.samples_per_pinion_revolution)?;
        (self.is_steady() && self.bearings.is_empty()).then_some(samples)
    }

    /// The machine around the meshes, and its modes without them.
    #[cfg(feature = "internals")]
    #[doc(hidden)]
    pub fn machine_and_modes(&self) -> (&crate::machine::Machine, &Modes) {
        (&self.machine.machine, &self.modes)
    }

    /// Traces the machine and its modes.
    pub(crate) fn trace_machine(&self, trace: &mut Trace) {
        let machine = &self.machine.machine;
        let size = machine.coordinates();
        trace.vector("open_frequencies_hz", self.modes.angular_frequencies.iter().map(|omega| omega / TAU));
        trace.vector("damping_ratio", self.modes.damping_ratio.iter().copied());
        trace.scalar("stepped_modes", self.modal_machine().modes() as f64);
        let mean = machine.closed_stiffness(&self.mean_stiffness_n_per_m());
        for (name, matrix) in [
            ("mass_matrix", &machine.mass),
            ("stiffness_matrix_open", &machine.stiffness()),
            ("stiffness_matrix_mean", &mean),
        ] {
            trace.matrix(name, size, size, |r, c| matrix[(r, c)]);
        }
    }

    /// The machine in the modes that are stepped.
    pub(crate) fn modal_machine(&self) -> &ModalMachine {
        &self.modal
    }

    /// Motion of motor and brake, sample by sample from the start of the simulation.
    pub fn motion(&self) -> Motion<'_> {
        let brake = self.machine.machine.rigid_rotation[self.machine.machine.coordinates() - 1].abs();
        let harmonic = |ripple: &crate::scenario::Ripple| TorqueHarmonic {
            order: ripple.order * brake,
            amplitude: ripple.amplitude,
            phase_rad: ripple.phase_deg.to_radians(),
        };
        let operation = &self.gearbox.operation;
        Motion::new(&operation.drive, self.gearbox.seed, &self.time)
            .with_ripple(operation.torque_ripple.iter().map(harmonic).collect())
    }

    /// (N) The forces of the meshes that hold a torque of the brake.
    ///
    /// # Arguments
    /// * `torque_nm` - (N m) the torque
    pub(crate) fn forces_of_torque_n(&self, torque_nm: f64) -> Vec<f64> {
        self.modal.balancing_forces_n(torque_nm)
    }

    /// The simulation that signals are of, such as those read from its file.
    ///
    /// # Arguments
    /// * `channels` - those of [`Gearbox::signals`] with their samples
    pub fn with_channels(self, channels: Channels) -> GearboxSimulation {
        GearboxSimulation { channels, step_counts: [0; 4], timings: self.timings.clone(), stages: self }
    }

    /// Solves the equations of motion, and makes the signals of the sensors.
    ///
    /// # Errors
    /// A motion that grows without bound.
    pub fn simulate(self) -> Result<GearboxSimulation, Error> {
        let mut clock = Clock::default();
        let channels = Channels::with_room(&self.time, self.gearbox.signals());
        let mut wanted = WantedChannels { channels, counts: StepCounts::default(), is_wanted: &|| true };
        self.integrate(&self.gearbox.outputs(), &mut wanted)?;
        clock.lap("time integration");
        let WantedChannels { mut channels, counts, .. } = wanted;
        let conditions = Measurement {
            sampling_rate_hz: self.time.sampling_rate_hz,
            is_periodic: (self.cycle_samples())
                .is_some_and(|cycle| self.time.kept_samples().is_multiple_of(cycle)),
            seed: self.gearbox.seed,
            index: 0,
        };
        channels.measure(self.sensors.iter().map(|of| &of.sensor), &conditions);
        clock.lap("sensors");
        let timings = self.timings.iter().copied().chain(clock.laps).collect();
        let StepCounts { steps, iterations, most_iterations, searched } = counts;
        let step_counts = [steps, iterations, most_iterations, searched];
        Ok(GearboxSimulation { channels, step_counts, timings, stages: self })
    }

    /// Solves the equations of motion and hands the kept samples on.
    ///
    /// # Arguments
    /// * `outputs` - what is read off the solution
    /// * `recorder` - takes it
    ///
    /// # Errors
    /// A motion that grows without bound.
    pub(crate) fn integrate(&self, outputs: &[Output], recorder: &mut dyn Recorder) -> Result<(), Error> {
        integrate(self.problem(outputs), InstructionSet::fastest(), recorder).map_err(|diverged| {
            Error::Diverged {
                time_s: diverged.sample as f64 * self.time.step_s(),
                key: "bearing.damping_ratio",
                help: "raise bearing.damping_ratio or mesh.damping_ratio, use more teeth, or change operation.input_speed_hz",
                damping_ratios: self.modes.damping_ratio.clone(),
            }
        })
    }

    /// The simulation as the solver sees it.
    fn problem<'a>(&'a self, outputs: &'a [Output]) -> Problem<'a> {
        let drive = &self.gearbox.operation.drive;
        let deviations = |pair: &'a MeshedPair| PairDeviations {
            teeth: &pair.teeth,
            errors: pair.profile_errors.as_ref(),
            eccentricity_m: 0.0,
            run_out: pair.run_out,
        };
        let turning = |(number, bearing): &(usize, RollingBearing)| {
            let shaft = self.layout.shaft_of_bearing[*number];
            BearingTurning::new(bearing, self.layout.ratios[shaft].value(), self.gearbox.seed, *number)
        };
        Problem {
            time: &self.time,
            machine: self.modal.clone(),
            laws: self.meshes.iter().map(Mesh::law).collect(),
            bearings: self.bearings.iter().map(|(_, bearing)| bearing.clone()).collect(),
            forcing: Forcing::new(
                self.motion(),
                &self.time,
                [drive.pinion_speed_hz, drive.brake_torque_nm],
                self.time.first_simulated_sample,
                self.meshes.iter().zip(self.pairs.iter().map(deviations)),
            )
            .with_bearings(self.bearings.iter().map(turning).collect())
            .with_turning_forces(&self.machine.machine.turning_forces),
            is_steady: self.is_steady(),
            hunting_period_samples: self.cycle_samples(),
            outputs,
            first_sample: self.time.first_kept_sample,
        }
    }
}
