//! The machine around the meshes, of the maker for its structure.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use crate::bearing::{RollingBearing, RollingParts};
use crate::error::ScenarioError;
use crate::machine::{
    Disc, GearboxMachine, GearboxParts, GearboxShaft, KnownModes, Machine, MeshLine, Modes, PlacedUnbalance,
    RigMachine, RigParts, RimParts, SeatedBearing, SetCoordinates, SetParts, Spinning, Supports, WheelBody,
    WheelInertia, body_stiffness_nm_per_rad,
};
use crate::scenario::{Layout, PlanetarySet, Scenario, SetLayout};
use crate::solver::{InitialMotion, ModalMachine};
use crate::wheel::{Teeth, WheelName};

use super::measured::{speed_name, transmission_error_name};

/// The machine around the meshes, and its modes without these.
#[derive(Debug, Clone, PartialEq)]
pub struct AssembledMachine {
    /// With the places that outputs read.
    pub machine: Machine,
    /// Without the meshes.
    pub modes: Arc<Modes>,
    /// Mass and inertias of each wheel.
    pub wheels: Vec<WheelBody>,
    /// (N m/rad) Torsional stiffness between each shaft and what it is coupled to, of a pair between wheel and coupling.
    pub shaft_stiffness_nm_per_rad: Vec<f64>,
    /// What turns with the nodes of shafts of beams; nothing of a rig. What of it is stepped is the machine's.
    pub spinning: Vec<Spinning>,
    /// (kg) The mass that the wheels' rotation has along each line of action.
    pub mesh_mass_kg: Vec<f64>,
    /// (-) Damping ratio of each mesh.
    pub mesh_damping_ratio: Vec<f64>,
    /// (Hz) Natural frequency up to which modes are stepped; those above deform at rest with their forces.
    pub stepped_up_to_hz: f64,
    /// (Hz) Natural frequency above which modes decay faster than those below.
    pub highest_of_slow_hz: f64,
    /// The coordinates of each planetary set.
    pub sets: Vec<SetCoordinates>,
    /// (m) Radius of the middle of the rim of each set's ring.
    pub rim_radii_m: Vec<f64>,
}

/// (Hz) Natural frequency above which modes of shafts of beams decay faster than those below.
const HIGHEST_OF_SLOW_HZ: f64 = 2e3;

/// The rolling bearings of a machine: each with its number in the scenario.
pub(super) type Bearings = Vec<(usize, RollingBearing)>;

/// Puts the machine together: a rig of one pair on condensed shafts, or shafts of beams in bearings.
///
/// # Arguments
/// * `scenario`, `layout` - what is simulated, and how it stands and turns
/// * `teeth` - of each mesh
/// * `known` - modes of machines of the same masses and springs
///
/// Returns the machine with its rolling bearings.
///
/// # Errors
/// Rolling bearings that do not fit, a sensor at a place that there is not.
pub(super) fn assembled(
    scenario: &Scenario,
    layout: &Layout,
    teeth: &[Teeth],
    known: &KnownModes,
) -> Result<(AssembledMachine, Bearings), ScenarioError> {
    match scenario.rig_parts(&layout.gears[0]) {
        Some(parts) => Ok((rig(scenario, parts, &teeth[0]), Vec::new())),
        None => shafts_of_beams(scenario, layout, teeth, known),
    }
}

/// The rig of one pair. Flanks that may pull stand in supports that are held, and all their modes are damped alike.
fn rig(scenario: &Scenario, parts: RigParts, teeth: &Teeth) -> AssembledMachine {
    let supports = if scenario.model.teeth_part() { Supports::Moving } else { Supports::Held };
    let RigMachine { machine, wheels, shaft_stiffness_nm_per_rad, mesh_mass_kg } =
        RigMachine::new(parts, teeth, supports);
    let modes = match supports {
        Supports::Moving => Modes::damped_by_springs(&machine),
        Supports::Held => Modes::damped_alike(&machine, parts.rig.damping_ratio.of_all_modes()),
    };
    AssembledMachine {
        modes: Arc::new(modes),
        wheels: wheels.to_vec(),
        shaft_stiffness_nm_per_rad: shaft_stiffness_nm_per_rad.to_vec(),
        spinning: Vec::new(),
        mesh_mass_kg: vec![mesh_mass_kg],
        mesh_damping_ratio: scenario.meshes.iter().map(|mesh| mesh.damping_ratio).collect(),
        highest_of_slow_hz: f64::INFINITY,
        sets: Vec::new(),
        rim_radii_m: Vec::new(),
        stepped_up_to_hz: f64::INFINITY,
        machine,
    }
}

/// The machine alone, without places of sensors or modes.
///
/// # Errors
/// Rolling bearings that do not fit.
pub(super) fn bare(scenario: &Scenario, layout: &Layout, teeth: &[Teeth]) -> Result<Machine, ScenarioError> {
    match scenario.rig_parts(&layout.gears[0]) {
        Some(parts) => Ok(RigMachine::new(parts, &teeth[0], Supports::Moving).machine),
        None => Ok(beams(scenario, layout, teeth)?.machine.machine),
    }
}

/// Shafts of beams in bearings, with what is known of them beside the machine.
struct Beams {
    machine: GearboxMachine,
    /// What turns with the nodes.
    spinning: Vec<Spinning>,
    discs: Vec<Disc>,
    mesh_mass_kg: Vec<f64>,
    bearings: Bearings,
    rim_radii_m: Vec<f64>,
}

/// Shafts of beams in bearings: wheels become discs, meshes lines of action, and all unbalances are placed on their shafts.
///
/// Rolling bearings have the stiffness of linear ones first, which gives their static loads, and these the linear springs in their
/// places.
fn beams(scenario: &Scenario, layout: &Layout, teeth: &[Teeth]) -> Result<Beams, ScenarioError> {
    let shafts: Vec<_> = scenario.shafts().iter().zip(layout.positions_m.iter().copied()).collect();
    let (own_wheels, own_meshes) = (scenario.own_wheels(), scenario.own_meshes());
    let discs: Vec<Disc> = (scenario.wheels.iter().take(own_wheels).enumerate())
        .map(|(number, wheel)| {
            // Every wheel is in a mesh, as the layout has checked.
            let (mesh, side) = layout.mesh_of(number).unwrap_or((0, WheelName::Pinion));
            let mut tooth = *teeth[mesh].wheel(side);
            tooth.face_width_mm = wheel.face_width_mm;
            let gears = &layout.gears[mesh];
            Disc {
                shaft: layout.shaft_of_wheel[number],
                at: wheel.at,
                body: WheelBody::new(&tooth, gears.material_of(side), &wheel.inertia),
                body_stiffness_nm_per_rad: body_stiffness_nm_per_rad(&tooth, side, gears),
            }
        })
        .collect();
    let overruns = scenario.operation.overruns();
    let has_forces_across = scenario.meshes.iter().any(|mesh| mesh.friction > 0.0 || mesh.random_force > 0.0);
    let of_meshes = teeth.iter().zip(&layout.wheels_of_mesh).zip(&layout.gears).take(own_meshes);
    let lines: Vec<MeshLine> = of_meshes
        .enumerate()
        .map(|(mesh, ((teeth, &wheels), gears))| {
            let line = MeshLine {
                wheels,
                offsets_m: layout.offsets_of_face_m(scenario, mesh),
                base_radii_m: WheelName::BOTH.map(|side| teeth.wheel(side).base_radius_mm * 1e-3),
                working_pressure_angle_rad: teeth.gear.working_pressure_angle_rad,
                thrust: gears.thrust(),
                has_forces_across,
            };
            if overruns { line.exchanged() } else { line }
        })
        .collect();
    let mass_kg = lines.iter().map(|line| {
        let both = line.wheels.iter().zip(line.base_radii_m);
        1.0 / both.map(|(&disc, radius_m)| radius_m * radius_m / discs[disc].body.polar_kgm2).sum::<f64>()
    });
    let mut sets: Vec<SetParts> = (scenario.planetary().iter().zip(&layout.sets))
        .map(|(set, of_set)| SetParts {
            has_forces_across,
            ..set_parts(scenario, layout, teeth, set, of_set)
        })
        .collect();
    let mut linear: Vec<SeatedBearing> = (layout.shaft_of_bearing.iter().zip(scenario.bearings()))
        .filter(|(shaft, _)| **shaft < shafts.len())
        .map(|(&shaft, bearing)| SeatedBearing::linear(shaft, bearing))
        .collect();
    let mut rolling: Vec<(usize, RollingParts)> = scenario.rolling_bearings()?;
    // Those of planets come last in the machine.
    rolling.sort_by_key(|(number, _)| (layout.shaft_of_bearing[*number] + 1).saturating_sub(shafts.len()));
    let ratios: Vec<f64> = layout.ratios.iter().take(shafts.len()).map(|ratio| ratio.value()).collect();
    let of_wheels = (scenario.wheels.iter().zip(&layout.shaft_of_wheel))
        .map(|(wheel, &shaft)| PlacedUnbalance { shaft, at: wheel.at, unbalance: &wheel.unbalance });
    let of_shafts = (scenario.shafts().iter().enumerate()).map(|(shaft, of)| PlacedUnbalance {
        shaft,
        at: 0.5,
        unbalance: &of.unbalance,
    });
    let unbalances: Vec<_> = of_wheels.chain(of_shafts).filter(|of| of.unbalance.g_mm > 0.0).collect();
    let without = GearboxParts {
        shafts: &shafts,
        speed_ratios: &ratios,
        discs: &discs,
        meshes: &lines,
        bearings: &[],
        housing: scenario.housing(),
        material: scenario.material,
        unbalances: &unbalances,
        brake_inertia_kgm2: scenario.operation.brake_inertia_kgm2,
        sets: &[],
    };
    let parts = GearboxParts { bearings: &linear, sets: &sets, ..without };
    let mut machine = GearboxMachine::new(&parts);
    let mut bearings = Vec::new();
    if !rolling.is_empty() {
        let torque_nm = scenario.operation.brake_torque_nm;
        let loads_n = machine.static_bearing_loads_n(&parts, torque_nm);
        for ((number, rolling), load_n) in rolling.into_iter().zip(loads_n) {
            let mut bearing = RollingBearing::new(rolling, load_n);
            match layout.planet_on_axis(layout.shaft_of_bearing[number]) {
                Some([set, planet]) => {
                    let set = &mut sets[set];
                    let springs = set.rolling_n_per_m.iter_mut().filter(|(of, _)| *of == planet);
                    springs.for_each(|(_, spring)| *spring = bearing.spring_n_per_m);
                    bearing.off_m = set.pin_errors_m[planet];
                }
                None => {
                    let seat = layout.shaft_of_bearing[..number].iter().filter(|of| **of < shafts.len());
                    linear[seat.count()].radial_n_per_m = bearing.spring_n_per_m;
                }
            }
            bearings.push((number, bearing));
        }
        machine = GearboxMachine::new(&GearboxParts { bearings: &linear, sets: &sets, ..without });
    }
    let parts = GearboxParts { bearings: &linear, sets: &sets, ..without };
    let mesh_mass_kg = mass_kg.chain(sets.iter().flat_map(SetParts::mesh_masses_kg)).collect();
    let spinning = machine.spinning(&parts);
    let rim_radii_m = sets.iter().map(|set| set.rim.radius_m).collect();
    Ok(Beams { machine, discs, spinning, mesh_mass_kg, bearings, rim_radii_m })
}

/// What a planetary set is made of, with no forces across its lines of action.
fn set_parts(
    scenario: &Scenario,
    layout: &Layout,
    teeth: &[Teeth],
    set: &PlanetarySet,
    of_set: &SetLayout,
) -> SetParts {
    let planets = of_set.planets();
    let first_meshes = [of_set.first_mesh, of_set.first_mesh + planets];
    let [at_sun, at_ring] = first_meshes.map(|mesh| &teeth[mesh]);
    let (sun_side, planet_side) = match of_set.sun_drives {
        true => (WheelName::Pinion, WheelName::Gear),
        false => (WheelName::Gear, WheelName::Pinion),
    };
    let (sun, planet) = (at_sun.wheel(sun_side), at_sun.wheel(planet_side));
    let ring = &at_ring.gear;
    let material = scenario.material;
    let rim_m = set.rim_thickness_mm() * 1e-3;
    let (root_m, width_m) = (ring.root_radius_mm * 1e-3, set.face_width_mm * 1e-3);
    let [density, elasticity_pa] = [material.density_kg_per_m3(), material.youngs_modulus_mpa() * 1e6];
    let arm_m = of_set.centre_distance_mm * 1e-3;
    // A ring from r to R.
    let annulus = |inner_m: f64, outer_m: f64, given: &WheelInertia| {
        let solid_kg = density * PI * (outer_m.powi(2) - inner_m.powi(2)) * width_m;
        WheelBody::of_annulus(solid_kg, [inner_m, outer_m], given)
    };
    let ring_m = [ring.tip_radius_mm * 1e-3, root_m + rim_m];
    let carrier_m = arm_m + planet.pitch_radius_mm * 1e-3;
    let sun_body = WheelBody::new(sun, material, &set.sun_inertia);
    let coupling = set.coupling_stiffness_nm_per_rad;
    // The body of the sun yields between its bore and its teeth; planets turn freely on their pins.
    let sun_yields = body_stiffness_nm_per_rad(sun, sun_side, &layout.gears[first_meshes[0]]);
    let to_sun = sun_yields.map_or(coupling, |body| 1.0 / (1.0 / coupling + 1.0 / body));
    let ring_base_m = ring.base_radius_mm * 1e-3;
    let [support, around] = [set.rim.support_n_per_m, set.rim.rotation_support_n_per_m];
    let to_ring = match set.shafts()[2] {
        Some(_) => coupling,
        None => around * ring_base_m * ring_base_m,
    };
    SetParts {
        name: set.name.clone(),
        angles_rad: of_set.angles_rad.clone(),
        centre_distance_m: arm_m,
        ratios: of_set.ratios.map(|ratio| ratio.value()),
        planet_ratio: layout.ratios[layout.shaft_of_wheel[of_set.first_wheel + 1]].value(),
        shafts: set
            .shafts()
            .map(|name| Some((scenario.shaft_number(name?)?, scenario.is_at_end(set, name?)))),
        bodies: [
            sun_body,
            WheelBody::new(planet, material, &set.planet_inertia),
            annulus(ring_m[0], ring_m[1], &set.ring_inertia),
            annulus(0.0, carrier_m, &set.carrier_inertia),
        ],
        supports_n_per_m: [set.sun_support_n_per_m, set.carrier_support_n_per_m, support],
        couplings_nm_per_rad: [to_sun, coupling, to_ring],
        pin_n_per_m: set.pin.stiffness_n_per_m,
        rolling_n_per_m: (0..planets)
            .filter(|planet| {
                let axis = layout.shaft_of_wheel[of_set.first_wheel + 1 + planet];
                layout.shaft_of_bearing.contains(&axis)
            })
            .map(|planet| (planet, [[set.pin.stiffness_n_per_m, 0.0], [0.0, set.pin.stiffness_n_per_m]]))
            .collect(),
        pin_errors_m: set.pin_errors_m(),
        rim: RimParts {
            radius_m: root_m + rim_m / 2.0,
            thickness_m: rim_m,
            width_m,
            elasticity_pa,
            density_kg_per_m3: density,
            support_n_per_m: [support, around],
            waves: set.rim.waves as usize,
        },
        damping_ratio: set.support_damping_ratio,
        sun_drives: of_set.sun_drives,
        base_radii_m: [
            sun.base_radius_mm,
            planet.base_radius_mm,
            at_ring.pinion.base_radius_mm,
            ring.base_radius_mm,
        ]
        .map(|mm| mm * 1e-3),
        working_pressure_angles_rad: [at_sun, at_ring].map(|teeth| teeth.gear.working_pressure_angle_rad),
        has_forces_across: false,
    }
}

/// The machine of [`beams`] with its modes. Places that outputs read are added to the finished machine, as they need its nodes.
fn shafts_of_beams(
    scenario: &Scenario,
    layout: &Layout,
    teeth: &[Teeth],
    known: &KnownModes,
) -> Result<(AssembledMachine, Bearings), ScenarioError> {
    let Beams { mut machine, discs, spinning, mesh_mass_kg, bearings, rim_radii_m } =
        beams(scenario, layout, teeth)?;
    let sensors = scenario.all_sensors();
    for (sensor, place) in sensors.iter().zip(scenario.places(layout)?) {
        if let Some(place) = place {
            machine.add_place(sensor.name(), place);
        }
    }
    for (number, shaft) in scenario.shafts().iter().enumerate() {
        machine.add_rotation(speed_name(&shaft.name), number);
    }
    for (number, mesh) in scenario.meshes.iter().enumerate() {
        machine.add_transmission_error(transmission_error_name(&mesh.name()), number);
    }
    let stepped_up_to_hz = scenario.solver.highest_mode_hz(scenario.time_grid().sampling_rate_hz);
    let of = &machine.machine;
    let modes = known.get(Modes::made_of(of), |_| Modes::damped_by_springs(of));
    let (_, fastest_hz) = scenario.fastest_speed(layout);
    machine.machine.spinning = modes.stepped_spinning(&spinning, TAU * fastest_hz, TAU * stepped_up_to_hz);
    let assembled = AssembledMachine {
        wheels: discs.iter().map(|disc| disc.body).collect(),
        shaft_stiffness_nm_per_rad: scenario.shafts().iter().map(GearboxShaft::coupling_nm_per_rad).collect(),
        mesh_damping_ratio: scenario.meshes.iter().map(|mesh| mesh.damping_ratio).collect(),
        spinning,
        mesh_mass_kg,
        highest_of_slow_hz: HIGHEST_OF_SLOW_HZ,
        sets: machine.sets,
        rim_radii_m,
        stepped_up_to_hz,
        modes,
        machine: machine.machine,
    };
    Ok((assembled, bearings))
}

impl AssembledMachine {
    /// The machine in the modes that take part in the motion.
    ///
    /// # Arguments
    /// * `scenario` - nominal speed and load, and the motion at the start
    /// * `half_faces_m` - (m) as of [`ModalMachine::new`]
    pub(super) fn modal(&self, scenario: &Scenario, half_faces_m: &[f64]) -> ModalMachine {
        let operation = &scenario.operation;
        let first_hz = operation.speed_profile_hz.as_ref().map(|profile| profile.value[0]);
        let start = InitialMotion {
            nominal_rad_per_s: TAU * operation.pinion_speed_hz,
            brake_torque_nm: operation.brake_torque_nm,
            motor_rad_per_s: TAU * first_hz.unwrap_or(operation.pinion_speed_hz),
            velocity: scenario.solver.initial_velocity.as_ref().map(|given| given.as_slice()),
        };
        ModalMachine::new(&self.machine, &self.modes, half_faces_m, start)
    }
}
