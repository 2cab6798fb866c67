//! The two-shaft rig as a machine: the only file that names its coordinates.
//!
//! x and y lie in the plane of the wheels, z along the shafts; θ turns about z, φ and ψ tilt a wheel about x and y. Displacements are
//! in m, rotations in rad. Each wheel hangs in its support by the flexibility of its shaft and bearings, in deflection and slope; the
//! supports stand on the base and hold one another.

use std::f64::consts::PI;
use std::ops::IndexMut;

use nalgebra::{DMatrix, DVector};

use super::body::{WheelBody, body_stiffness_nm_per_rad};
use super::parts::{Axis, Drive, LineOfAction, Machine, Place, Spring};
use super::shaft_bending::wheel_flexibility;
use super::{Rig, RigParts, Shaft, TurningForce, Unbalance};
use crate::wheel::{Gears, Teeth, Wheel, WheelName};

/// Names of the coordinates, as in the paper; the last four are those of the supports.
const NAMES: [&str; 17] = [
    "x_g", "y_g", "x_p", "y_p", "theta_g", "theta_p", "theta_b", "z_g", "z_p", "phi_g", "phi_p", "psi_g",
    "psi_p", "x_gs", "y_gs", "x_ps", "y_ps",
];

const X_GEAR: usize = 0;
const Y_GEAR: usize = 1;
const X_PINION: usize = 2;
const Y_PINION: usize = 3;
const THETA_GEAR: usize = 4;
const THETA_PINION: usize = 5;
const THETA_BRAKE: usize = 6;
const Z_GEAR: usize = 7;
const Z_PINION: usize = 8;
const PHI_GEAR: usize = 9;
const PHI_PINION: usize = 10;
const PSI_GEAR: usize = 11;
const PSI_PINION: usize = 12;
const X_GEAR_SUPPORT: usize = 13;
const Y_GEAR_SUPPORT: usize = 14;
const X_PINION_SUPPORT: usize = 15;
const Y_PINION_SUPPORT: usize = 16;

/// Number of coordinates where the supports are held.
const WITHOUT_SUPPORTS: usize = 13;

/// Place: the mean of both supports.
pub const SUPPORTS: &str = "support";
/// Place: the support of the pinion's shaft.
pub const PINION_SUPPORT: &str = "pinion-support";
/// Place: the support of the gear's shaft.
pub const GEAR_SUPPORT: &str = "gear-support";
/// Place: both wheels, the sum of their motions.
pub const WHEELS: &str = "wheels";
/// Place: the pinion, of whose motion its rotation is measured.
pub const PINION: &str = "pinion";
/// Place: the gear, of whose motion its rotation is measured, positive as it turns.
pub const GEAR: &str = "gear";

/// What the shafts' bearings sit in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Supports {
    /// They move across the shafts.
    Moving,
    /// They are held.
    Held,
}

/// The rig of one gear pair as a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct RigMachine {
    /// Its parts.
    pub machine: Machine,
    /// Mass and inertias of the pinion and of the gear.
    pub wheels: [WheelBody; 2],
    /// (N m/rad) Torsional stiffness of the pinion's and of the gear's shaft, each with its wheel's body.
    pub shaft_stiffness_nm_per_rad: [f64; 2],
    /// (kg) Mass that the wheels' rotation has along the line of action, `1/(Rb_g²/J_g + Rb_p²/J_p)`.
    pub mesh_mass_kg: f64,
}

/// A mode in which the supports move much.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SupportMode {
    /// (Hz) Natural frequency, with the meshes closed.
    pub frequency_hz: f64,
    /// (-) Part of the kinetic energy that the supports have.
    pub share: f64,
    /// Whether both supports move in phase; otherwise they move out of phase.
    pub is_alike: bool,
}

/// (-) Part of the kinetic energy from which on the supports move much.
const MUCH: f64 = 1.0 / 6.0;

/// The modes in which the supports of a rig move much, in rising order; none of a machine without supports that move.
///
/// # Arguments
/// * `machine` - of a rig, or any other
/// * `mesh_stiffness_n_per_m` - (N/m) of each mesh along its line of action
pub fn support_modes(machine: &Machine, mesh_stiffness_n_per_m: &[f64]) -> Vec<SupportMode> {
    if machine.names.get(X_GEAR_SUPPORT).is_none_or(|name| name != NAMES[X_GEAR_SUPPORT]) {
        return Vec::new();
    }
    let (frequencies_hz, shapes) = machine.closed_modes(mesh_stiffness_n_per_m);
    let mode = |(&frequency_hz, shape): (&f64, DVector<f64>)| {
        let gear = [shape[X_GEAR_SUPPORT], shape[Y_GEAR_SUPPORT]];
        let pinion = [shape[X_PINION_SUPPORT], shape[Y_PINION_SUPPORT]];
        let mass = machine.mass[(X_GEAR_SUPPORT, X_GEAR_SUPPORT)];
        let share = mass * gear.iter().chain(&pinion).map(|motion| motion * motion).sum::<f64>();
        let is_alike = gear[0] * pinion[0] + gear[1] * pinion[1] > 0.0;
        SupportMode { frequency_hz, share, is_alike }
    };
    let shapes = shapes.column_iter().map(|shape| shape.into_owned());
    frequencies_hz.iter().zip(shapes).map(mode).filter(|mode| mode.share > MUCH).collect()
}

impl RigMachine {
    /// Assembles the rig of one gear pair.
    ///
    /// Springs and supports are first written in vertical and horizontal coordinates, as a rig's numbers are given, and then turned to
    /// the line of action, in which the mesh acts on one coordinate of each wheel.
    ///
    /// # Arguments
    /// * `parts` - wheels, shafts, bearings, supports, brake
    /// * `teeth` - both wheels
    /// * `supports` - whether the supports move
    pub fn new(parts: RigParts, teeth: &Teeth, supports: Supports) -> Self {
        let RigParts { gears, rig, inertias, overruns, .. } = parts;
        let pinion = WheelBody::new(&teeth.pinion, gears.material_of(WheelName::Pinion), inertias[0]);
        let gear = WheelBody::new(&teeth.gear, gears.material_of(WheelName::Gear), inertias[1]);
        let coordinates = match supports {
            Supports::Moving => NAMES.len(),
            Supports::Held => WITHOUT_SUPPORTS,
        };
        let torsion = WheelName::BOTH.map(|side| {
            let of_shaft = torsional_stiffness(rig.shaft(side), gears);
            let with_body = |body: f64| 1.0 / (1.0 / of_shaft + 1.0 / body);
            body_stiffness_nm_per_rad(teeth.wheel(side), side, gears).map_or(of_shaft, with_body)
        });
        let angle_rad = teeth.gear.working_pressure_angle_rad;
        // The other flanks push downwards where these push upwards.
        let angle_rad = if overruns { PI - angle_rad } else { angle_rad };
        let turn = turn(angle_rad, coordinates);
        let ratio = f64::from(gears.gear_teeth) / f64::from(gears.pinion_teeth);
        let mut rigid_rotation = DVector::zeros(coordinates);
        rigid_rotation[THETA_GEAR] = -1.0 / ratio;
        rigid_rotation[THETA_PINION] = 1.0;
        rigid_rotation[THETA_BRAKE] = -1.0 / ratio;
        let of_rotation =
            |wheel: &Wheel, body: &WheelBody| (wheel.base_radius_mm * 1e-3).powi(2) / body.polar_kgm2;
        Self {
            mesh_mass_kg: 1.0 / (of_rotation(&teeth.pinion, &pinion) + of_rotation(&teeth.gear, &gear)),
            wheels: [pinion, gear],
            shaft_stiffness_nm_per_rad: torsion,
            machine: Machine {
                names: NAMES[..coordinates].iter().map(|&name| name.into()).collect(),
                mass: DMatrix::from_diagonal(&DVector::from_vec(masses(&pinion, &gear, parts, coordinates))),
                springs: springs(gears, rig, torsion, supports, coordinates)
                    .iter()
                    .map(|spring| spring.turned(&turn))
                    .collect(),
                lines: vec![line_of_action((gears, teeth), angle_rad, coordinates)],
                bearings: Vec::new(),
                turning_forces: unbalances(parts.unbalances, &turn, &rigid_rotation),
                spinning: Vec::new(),
                drives: vec![
                    Drive::Motor {
                        coordinate: THETA_PINION,
                        stiffness_nm_per_rad: torsion[0],
                        speed_ratio: 1.0,
                    },
                    Drive::Brake { coordinate: THETA_BRAKE, torque_share: 1.0 },
                ],
                places: places(supports),
                turn,
                rigid_rotation,
            },
        }
    }
}

/// The forces of the wheels' unbalances.
///
/// # Arguments
/// * `turn` - unit vectors of the turned coordinates
/// * `rigid_rotation` - of all coordinates per unit rotation of the motor
fn unbalances(
    [pinion, gear]: [&Unbalance; 2],
    turn: &DMatrix<f64>,
    rigid_rotation: &DVector<f64>,
) -> Vec<TurningForce> {
    let wheels = [(pinion, THETA_PINION, [X_PINION, Y_PINION]), (gear, THETA_GEAR, [X_GEAR, Y_GEAR])];
    let unbalanced = wheels.into_iter().filter(|(unbalance, ..)| unbalance.g_mm > 0.0);
    let force = |(unbalance, rotation, plane): (&Unbalance, usize, [usize; 2])| {
        let motion = plane.map(|coordinate| turn.row(coordinate).transpose());
        TurningForce::of_unbalance(unbalance, rigid_rotation[rotation], motion)
    };
    unbalanced.map(force).collect()
}

/// (kg, kg m²) Mass or moment of inertia of each coordinate.
fn masses(pinion: &WheelBody, gear: &WheelBody, parts: RigParts, coordinates: usize) -> Vec<f64> {
    let mut mass = vec![parts.rig.support.mass_kg; coordinates];
    for (wheel, of_wheel) in [
        (gear, [X_GEAR, Y_GEAR, Z_GEAR, THETA_GEAR, PHI_GEAR, PSI_GEAR]),
        (pinion, [X_PINION, Y_PINION, Z_PINION, THETA_PINION, PHI_PINION, PSI_PINION]),
    ] {
        let WheelBody { mass_kg, polar_kgm2, transverse_kgm2 } = *wheel;
        let values = [mass_kg, mass_kg, mass_kg, polar_kgm2, transverse_kgm2, transverse_kgm2];
        for (coordinate, value) in of_wheel.into_iter().zip(values) {
            mass[coordinate] = value;
        }
    }
    mass[THETA_BRAKE] = parts.brake_inertia_kgm2;
    mass
}

/// The unit vectors of the turned coordinates: x and y of wheels and supports become the directions along and across the line of
/// action, and the tilts the one that moves the flank along the line of action and the other. The bearings are as stiff in every
/// direction, so that the machine looks the same in them.
fn turn(pressure_angle_rad: f64, coordinates: usize) -> DMatrix<f64> {
    let mut turn = DMatrix::identity(coordinates, coordinates);
    let planes = [
        (X_GEAR, Y_GEAR),
        (X_PINION, Y_PINION),
        (X_GEAR_SUPPORT, Y_GEAR_SUPPORT),
        (X_PINION_SUPPORT, Y_PINION_SUPPORT),
    ];
    let planes = planes.into_iter().filter(|(x, _)| *x < coordinates);
    turn_planes(&mut turn, pressure_angle_rad, planes, [(PHI_GEAR, PSI_GEAR), (PHI_PINION, PSI_PINION)]);
    turn
}

/// Turns planes of translations and of tilts along and across the line of action.
///
/// # Arguments
/// * `turn` - the identity; set to the turned unit vectors, in columns
/// * `pressure_angle_rad` - (rad) direction of the line of action
/// * `planes` - numbers of x and y of each body
/// * `tilts` - numbers of φ and ψ of each wheel
pub(crate) fn turn_planes(
    turn: &mut impl IndexMut<(usize, usize), Output = f64>,
    pressure_angle_rad: f64,
    planes: impl IntoIterator<Item = (usize, usize)>,
    tilts: impl IntoIterator<Item = (usize, usize)>,
) {
    let (sin, cos) = pressure_angle_rad.sin_cos();
    for (x, y) in planes {
        turn[(x, x)] = sin;
        turn[(y, x)] = cos;
        turn[(x, y)] = cos;
        turn[(y, y)] = -sin;
    }
    for (phi, psi) in tilts {
        turn[(phi, phi)] = -cos;
        turn[(psi, phi)] = sin;
        turn[(phi, psi)] = sin;
        turn[(psi, psi)] = cos;
    }
}

/// The line of action in turned coordinates. At the axial position z it is `g = g0 + z g1` with
/// `g0 = [sin α, cos α, −sin α, −cos α, Rb_g, Rb_p, 0, t, −t, 0, 0, −t r_g, −t r_p, 0 …]` and
/// `g1 = [0×9, −cos α, cos α, sin α, −sin α, 0 …]`, α the working pressure angle in the transverse section, t the thrust of helical wheels and
/// r the radii of the working pitch circles, at which it tilts them.
fn line_of_action((gears, teeth): (&Gears, &Teeth), angle_rad: f64, coordinates: usize) -> LineOfAction {
    let (mut at_middle, mut per_m) = (DVector::zeros(coordinates), DVector::zeros(coordinates));
    at_middle[X_GEAR] = 1.0;
    at_middle[X_PINION] = -1.0;
    let (sin, cos) = angle_rad.sin_cos();
    // Of the other flanks, beyond a right angle, what turns and what pushes along the shafts has the other sign.
    let sense = cos.signum();
    let thrust = sense * gears.thrust();
    for (wheel, theta, z, phi, psi, side) in [
        (&teeth.gear, THETA_GEAR, Z_GEAR, PHI_GEAR, PSI_GEAR, 1.0),
        (&teeth.pinion, THETA_PINION, Z_PINION, PHI_PINION, PSI_PINION, -1.0),
    ] {
        at_middle[theta] = sense * wheel.base_radius_mm * 1e-3;
        at_middle[z] = side * thrust;
        // A moment about y, whose tilt ψ is turned with the line of action.
        let about_y = -thrust * wheel.working_pitch_radius_mm * 1e-3;
        at_middle[phi] = about_y * sin;
        at_middle[psi] = about_y * cos;
        per_m[phi] = side;
    }
    LineOfAction { at_middle, per_m, across: None }
}

/// Where a sensor can sit; the sensor that every simulation has is on the pinion's support. Where the supports are held, every sensor
/// shows the sum of both wheels' motions.
fn places(supports: Supports) -> Vec<Place> {
    let both = |pair: [usize; 2], weight: f64| pair.map(|coordinate| (coordinate, weight)).to_vec();
    let of_wheels = || {
        vec![
            (Axis::X, both([X_GEAR, X_PINION], 1.0)),
            (Axis::Y, both([Y_GEAR, Y_PINION], 1.0)),
            (Axis::Z, both([Z_GEAR, Z_PINION], 1.0)),
        ]
    };
    // No support moves along the shafts: an axial sensor shows both wheels.
    let of_supports = |x: Vec<(usize, f64)>, y: Vec<(usize, f64)>| {
        vec![(Axis::X, x), (Axis::Y, y), (Axis::Z, both([Z_GEAR, Z_PINION], 1.0))]
    };
    let [both_supports, pinion_support, gear_support] = match supports {
        Supports::Held => [of_wheels(), of_wheels(), of_wheels()],
        Supports::Moving => [
            of_supports(
                both([X_GEAR_SUPPORT, X_PINION_SUPPORT], 0.5),
                both([Y_GEAR_SUPPORT, Y_PINION_SUPPORT], 0.5),
            ),
            of_supports(vec![(X_PINION_SUPPORT, 1.0)], vec![(Y_PINION_SUPPORT, 1.0)]),
            of_supports(vec![(X_GEAR_SUPPORT, 1.0)], vec![(Y_GEAR_SUPPORT, 1.0)]),
        ],
    };
    vec![
        Place { name: SUPPORTS.into(), motion: both_supports },
        Place { name: PINION_SUPPORT.into(), motion: pinion_support },
        Place { name: GEAR_SUPPORT.into(), motion: gear_support },
        Place { name: WHEELS.into(), motion: of_wheels() },
        Place { name: PINION.into(), motion: vec![(Axis::Rotation, vec![(THETA_PINION, 1.0)])] },
        // The gear turns backwards.
        Place { name: GEAR.into(), motion: vec![(Axis::Rotation, vec![(THETA_GEAR, -1.0)])] },
    ]
}

/// (N m/rad) Torsional stiffness of a round shaft, `π r⁴ G/(2 l)`.
pub fn torsional_stiffness(shaft: &Shaft, gears: &Gears) -> f64 {
    let (radius, length) = (shaft.radius_mm * 1e-3, shaft.length_mm * 1e-3);
    PI * radius.powi(4) * gears.material.shear_modulus_mpa() * 1e6 / (2.0 * length)
}

/// All springs: shafts and bearings, the shafts' torsion, and the supports where they move.
///
/// # Arguments
/// * `torsion` - (N m/rad) stiffness of the pinion's and of the gear's shaft with the wheel's body
fn springs(
    gears: &Gears,
    rig: &Rig,
    torsion: [f64; 2],
    supports: Supports,
    coordinates: usize,
) -> Vec<Spring> {
    let spring = |damping_ratio| Spring::new(coordinates, damping_ratio);
    let mut gear_torsion = spring(rig.gear_shaft.damping_ratio);
    gear_torsion.resist(&[(THETA_GEAR, 1.0), (THETA_BRAKE, -1.0)], torsion[1]);
    let mut pinion_torsion = spring(rig.pinion_shaft.damping_ratio);
    pinion_torsion.resist(&[(THETA_PINION, 1.0)], torsion[0]);
    let mut springs = vec![
        bent_shaft(WheelName::Gear, rig, gears, coordinates),
        bent_shaft(WheelName::Pinion, rig, gears, coordinates),
        gear_torsion,
        pinion_torsion,
    ];
    if supports == Supports::Moving {
        springs.push(support_springs(rig));
    }
    springs
}

/// The shaft and bearings of a wheel: deflection relative to its support (to the base, where the support is held), slope, and the
/// axial stiffness.
///
/// Along the shaft x grows by ψ and y falls by φ.
fn bent_shaft(wheel: WheelName, rig: &Rig, gears: &Gears, coordinates: usize) -> Spring {
    let shaft = rig.shaft(wheel);
    let bearing = shaft.bearing_stiffness_n_per_m.unwrap_or(rig.bearing_stiffness_n_per_m);
    let flexibility = wheel_flexibility(shaft, bearing, gears.material);
    let [x, y, z, phi, psi, x_support, y_support] = match wheel {
        WheelName::Gear => [X_GEAR, Y_GEAR, Z_GEAR, PHI_GEAR, PSI_GEAR, X_GEAR_SUPPORT, Y_GEAR_SUPPORT],
        WheelName::Pinion => {
            [X_PINION, Y_PINION, Z_PINION, PHI_PINION, PSI_PINION, X_PINION_SUPPORT, Y_PINION_SUPPORT]
        }
    };
    let mut spring = Spring::new(coordinates, shaft.damping_ratio);
    // The inverse of a 2 × 2 flexibility.
    let determinant = flexibility.determinant();
    let (direct, cross, slope) = (
        flexibility[(1, 1)] / determinant,
        -flexibility[(0, 1)] / determinant,
        flexibility[(0, 0)] / determinant,
    );
    for (deflection, support, tilt, sign) in [(x, x_support, psi, 1.0), (y, y_support, phi, -1.0)] {
        let mut stretch = vec![(deflection, 1.0)];
        stretch.extend((support < coordinates).then_some((support, -1.0)));
        let tilt = [(tilt, 1.0)];
        spring.resist(&stretch, direct);
        spring.resist(&tilt, slope);
        spring.couple(&stretch, &tilt, cross * sign);
        spring.couple(&tilt, &stretch, cross * sign);
    }
    spring.resist(&[(z, 1.0)], bearing);
    spring
}

/// The supports on their base, and what holds them together.
fn support_springs(rig: &Rig) -> Spring {
    let [base, between] = rig.support.stiffnesses_n_per_m();
    let mut spring = Spring::new(NAMES.len(), rig.support.damping_ratio);
    for [gear, pinion] in [[X_GEAR_SUPPORT, X_PINION_SUPPORT], [Y_GEAR_SUPPORT, Y_PINION_SUPPORT]] {
        spring.resist(&[(gear, 1.0)], base);
        spring.resist(&[(pinion, 1.0)], base);
        spring.resist(&[(gear, 1.0), (pinion, -1.0)], between);
    }
    spring
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Modes;
    use crate::scenario::{GearPair, Scenario};
    use crate::wheel::teeth;

    fn machine(rig: &Rig) -> Machine {
        let scenario = Scenario::new(GearPair::example());
        let gears = scenario.gears();
        let parts = RigParts { rig, ..scenario.rig_parts(&gears).unwrap() };
        RigMachine::new(parts, &teeth(&gears, [10.0; 2]), Supports::Moving).machine
    }

    /// Stiffness in the coordinates themselves, with the brake's rotation held.
    fn held(machine: &Machine) -> DMatrix<f64> {
        let mut stiffness = machine.turn_back(&machine.stiffness());
        stiffness[(THETA_BRAKE, THETA_BRAKE)] += 1.0;
        stiffness
    }

    #[test]
    fn turns_freely_without_the_mesh() {
        let modes = Modes::damped_by_springs(&machine(&Rig::default()));
        let free = modes.angular_frequencies.iter().filter(|omega| **omega == 0.0).count();
        assert_eq!(free, 1);
        let shape = modes.shapes.column(0);
        assert!((shape[THETA_GEAR] / shape[THETA_BRAKE] - 1.0).abs() < 1e-6);
        assert!(modes.angular_frequencies[1] > 1.0);
        // Damping only where parts deform.
        assert_eq!(modes.damping_ratio[0], 0.0);
        assert!(modes.damping_ratio[1..].iter().all(|ratio| (ratio - 0.025).abs() < 1e-9));
    }

    #[test]
    fn a_force_deflects_shaft_and_supports_in_series() {
        let rig = Rig::default();
        let machine = machine(&rig);
        let flexible =
            wheel_flexibility(&rig.gear_shaft, rig.bearing_stiffness_n_per_m, Default::default())[(0, 0)];
        let [base, between] = rig.support.stiffnesses_n_per_m();
        // One support pushed: base and, through the other, coupling in series with its base.
        let support = 1.0 / (base + 1.0 / (1.0 / between + 1.0 / base));
        let mut force = DVector::zeros(NAMES.len());
        force[Y_GEAR] = 1.0;
        let deflection = held(&machine).lu().solve(&force).unwrap();
        assert!((deflection[Y_GEAR] / (flexible + support) - 1.0).abs() < 1e-6);
        assert!(deflection[X_GEAR].abs() < 1e-9 * deflection[Y_GEAR]);
    }

    /// A wheel nearer to the bearing at negative z tilts so that x and y grow along the shaft: ψ positive, φ negative.
    #[test]
    fn a_force_on_a_wheel_off_the_middle_tilts_it() {
        let shaft = Shaft { wheel_at: 0.3, ..Shaft::new(600.0, 10.0) };
        let solved = held(&machine(&Rig { gear_shaft: shaft, ..Rig::default() })).lu();
        for (pushed, tilted, sign) in [(X_GEAR, PSI_GEAR, 1.0), (Y_GEAR, PHI_GEAR, -1.0)] {
            let mut force = DVector::zeros(NAMES.len());
            force[pushed] = 1.0;
            let deflection = solved.solve(&force).unwrap();
            assert!(deflection[pushed] > 0.0 && sign * deflection[tilted] > 0.0);
        }
    }

    #[test]
    fn shapes_are_mass_normalised_and_the_line_of_action_turns_back() {
        let machine = machine(&Rig {
            pinion_shaft: Shaft { wheel_at: 0.3, ..Shaft::new(200.0, 10.0) },
            ..Rig::default()
        });
        let mass = &machine.mass;
        let shapes = Modes::damped_by_springs(&machine).shapes;
        let unit = shapes.transpose() * mass * &shapes;
        assert!((unit - DMatrix::identity(17, 17)).amax() < 1e-9);
        let (sin, cos) = 20f64.to_radians().sin_cos();
        let line = &machine.turn * &machine.lines[0].at_middle;
        let expected =
            [(X_GEAR, sin), (Y_GEAR, cos), (X_PINION, -sin), (Y_PINION, -cos), (X_GEAR_SUPPORT, 0.0)];
        assert!(expected.iter().all(|&(n, value)| (line[n] - value).abs() < 1e-12));
        let tilt = &machine.turn * &machine.lines[0].per_m;
        let expected = [(PHI_GEAR, -cos), (PHI_PINION, cos), (PSI_GEAR, sin), (PSI_PINION, -sin)];
        assert!(expected.iter().all(|&(n, value)| (tilt[n] - value).abs() < 1e-12));
    }
}
