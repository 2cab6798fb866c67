//! Mass, damping and stiffness in the 13 coordinates.

mod body;
pub mod coordinates;
mod modes;

use std::f64::consts::{PI, TAU};

use body::wheel_body;
use coordinates::*;
pub use modes::Modes;

use super::mesh::{LoadState, MeshLoad};
use crate::machine::{DecayingMode, Rig, RigParts, Shaft, WheelBody, connected_groups, turn_planes};
use crate::wheel::{Gears, Teeth};

/// What forces the equations of motion at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forcing {
    /// (rad) Angle of the motor.
    pub motor_angle_rad: f64,
    /// (N m) Torque of the brake.
    pub brake_torque_nm: f64,
    /// (N) Force of the flanks' deviations, stiffness × deviation, summed over the pairs in contact.
    pub error_force_n: f64,
    /// (m) Where along the face that force acts, from its middle.
    pub error_mean_z_m: f64,
}

/// The equations of motion `M ü + C u̇ + K(θ_p) u = F` without the force.
///
/// At axial position z and pressure angle α the line of action is `g = g0 + z g1`,
/// `g0 = [sin α, cos α, −sin α, −cos α, Rb_g, Rb_p, 0, 0, 0, 0, 0, 0, 0]`, `g1 = [0×9, −cos α, cos α, sin α, −sin α]`.
///
/// The bearings are as stiff in every direction, so the plane of the wheels and the plane of their tilts can be turned until one axis
/// lies along the nominal line of action. In these *turned* coordinates most entries are exactly zero, and what the mesh does not reach
/// stays out of the solution. Fields are in turned coordinates, in which mass and constant stiffness are what they are in the others;
/// methods return what they say in the 13 coordinates themselves unless their names say otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Mass and inertias of the pinion.
    pub pinion: WheelBody,
    /// Mass and inertias of the gear.
    pub gear: WheelBody,
    /// (kg, kg m²) Diagonal of the mass matrix.
    pub mass: CoordinateVector,
    /// (N m/rad) Torsional stiffness of the pinion's and of the gear's shaft.
    pub shaft_stiffness_nm_per_rad: [f64; 2],
    /// Stiffness without the mesh.
    pub constant_stiffness: CoordinateMatrix,
    /// Mean stiffness over the cycle.
    pub(super) mean_stiffness: CoordinateMatrix,
    /// Damping, `C = M Σ_n 2 ζ_n ω_n φ_n φ_nᵀ M`.
    pub(super) damping: CoordinateMatrix,
    /// Modes of the mean stiffness.
    pub modes: Modes,
    /// (-) Damping ratio of each mode.
    pub damping_ratio: [f64; COORDINATES],
    /// Columns: the turned coordinates' unit vectors in the 13 coordinates.
    turn: CoordinateMatrix,
    /// (m) Base radii of pinion and gear.
    base_radius_m: [f64; 2],
    pub(super) nominal_angle_rad: f64,
    /// (-) Revolutions of the pinion per revolution of the gear, `z_g/z_p`.
    ratio: f64,
}

impl Machine {
    /// Assembles the equations of motion.
    ///
    /// # Arguments
    /// * `parts` - wheels, bearings, shafts, brake
    /// * `teeth` - both wheels
    /// * `load` - the mesh over the cycle
    pub(super) fn new(parts: RigParts, teeth: &Teeth, load: &MeshLoad) -> Self {
        let RigParts { gears, rig, inertias, brake_inertia_kgm2, .. } = parts;
        let pinion = wheel_body(&teeth.pinion, gears.material, inertias[0]);
        let gear = wheel_body(&teeth.gear, gears.material, inertias[1]);
        let mass = masses(&pinion, &gear, brake_inertia_kgm2);
        let shaft_stiffness_nm_per_rad =
            [torsional_stiffness(&rig.pinion_shaft, gears), torsional_stiffness(&rig.gear_shaft, gears)];
        let constant_stiffness = constant_stiffness(rig, shaft_stiffness_nm_per_rad);
        let mut machine = Self {
            pinion,
            gear,
            mass,
            shaft_stiffness_nm_per_rad,
            constant_stiffness,
            mean_stiffness: constant_stiffness,
            damping: CoordinateMatrix::zeros(),
            modes: Modes::new(&mass, &constant_stiffness),
            damping_ratio: rig.damping_ratio.per_mode(),
            turn: turn(teeth.gear.pressure_angle_rad),
            base_radius_m: [&teeth.pinion, &teeth.gear].map(|wheel| wheel.base_radius_mm * 1e-3),
            nominal_angle_rad: teeth.gear.pressure_angle_rad,
            ratio: f64::from(gears.gear_teeth) / f64::from(gears.pinion_teeth),
        };
        machine.mean_stiffness += machine.mean_of_mesh(load);
        machine.modes = Modes::new(&mass, &machine.mean_stiffness);
        let mass_shapes = CoordinateMatrix::from_diagonal(&mass) * machine.modes.shapes;
        let modal = CoordinateVector::from_fn(|n, _| machine.modal_damping(n));
        machine.damping = mass_shapes * CoordinateMatrix::from_diagonal(&modal) * mass_shapes.transpose();
        machine
    }

    /// Mean over the cycle of the mesh's part of the stiffness, in turned coordinates.
    fn mean_of_mesh(&self, load: &MeshLoad) -> CoordinateMatrix {
        let (disturbed, sound) = load.stiffness_n_per_m.split_at(load.faulty.len());
        let mut sum = self.turned_mesh_stiffness(sound.iter().sum(), &load.nominal);
        for (state, k) in load.faulty.iter().zip(disturbed) {
            sum += self.turned_mesh_stiffness(*k, state);
        }
        sum / load.stiffness_n_per_m.len() as f64
    }

    /// The line of action in the middle of the face, and what is added to it per m along the face, in turned coordinates.
    ///
    /// # Arguments
    /// * `pressure_angle_rad` - (rad) at which it lies
    pub(super) fn turned_line(&self, pressure_angle_rad: f64) -> [CoordinateVector; 2] {
        let (sin, cos) = (pressure_angle_rad - self.nominal_angle_rad).sin_cos();
        let (mut line, mut tilt) = (CoordinateVector::zeros(), CoordinateVector::zeros());
        for (vector, gear, pinion, entry) in
            [(&mut line, X_GEAR, X_PINION, cos), (&mut tilt, PHI_GEAR, PHI_PINION, cos)]
        {
            (vector[gear], vector[pinion]) = (entry, -entry);
        }
        (line[Y_GEAR], line[Y_PINION]) = (sin, -sin);
        (tilt[PSI_GEAR], tilt[PSI_PINION]) = (sin, -sin);
        [line[THETA_PINION], line[THETA_GEAR]] = self.base_radius_m;
        [line, tilt]
    }

    /// `k · mean_z(g gᵀ)` in turned coordinates.
    fn turned_mesh_stiffness(&self, stiffness_n_per_m: f64, load: &LoadState) -> CoordinateMatrix {
        let [line, tilt] = self.turned_line(load.pressure_angle_rad);
        let cross = line * tilt.transpose();
        let square = line * line.transpose()
            + (cross + cross.transpose()) * load.mean_z_m
            + tilt * tilt.transpose() * load.mean_z2_m2;
        square * stiffness_n_per_m
    }

    /// Groups of turned coordinates that move one another.
    pub(super) fn coupled_coordinates(&self) -> Vec<Vec<usize>> {
        connected_groups(COORDINATES, |row, column| self.mean_stiffness[(row, column)] != 0.0)
    }

    /// A vector of the 13 coordinates in the turned ones.
    pub(super) fn turned(&self, vector: &CoordinateVector) -> CoordinateVector {
        self.turn.transpose() * vector
    }

    /// (Hz) Natural frequencies of the mean system, rising.
    pub fn natural_frequencies_hz(&self) -> CoordinateVector {
        self.modes.angular_frequencies / TAU
    }

    /// Mode shapes of the mean system, a column each, of unit modal mass.
    pub fn mode_shapes(&self) -> CoordinateMatrix {
        self.turn * self.modes.shapes
    }

    /// (N/m, N/rad, N m/rad) Stiffness matrix at a point of the cycle.
    ///
    /// # Arguments
    /// * `load` - the mesh over the cycle
    /// * `point` - coarse point
    pub fn stiffness_matrix_at(&self, load: &MeshLoad, point: usize) -> CoordinateMatrix {
        let mesh = self.turned_mesh_stiffness(load.stiffness_n_per_m[point], load.state(point));
        self.turned_back(&(self.constant_stiffness + mesh))
    }

    /// Mean stiffness matrix over the cycle.
    pub fn mean_stiffness_matrix(&self) -> CoordinateMatrix {
        self.turned_back(&self.mean_stiffness)
    }

    /// Damping matrix.
    pub fn damping_matrix(&self) -> CoordinateMatrix {
        self.turned_back(&self.damping)
    }

    /// (1/s) `2 ζ ω` of mode `n`.
    fn modal_damping(&self, n: usize) -> f64 {
        2.0 * self.damping_ratio[n] * self.modes.angular_frequencies[n]
    }

    /// The mode that decays most slowly of those that some turned coordinates take part in.
    ///
    /// # Arguments
    /// * `moving` - the coordinates
    pub(super) fn slowest_mode(&self, moving: &[usize]) -> DecayingMode {
        let moves = |n: &usize| moving.iter().any(|&coordinate| self.modes.shapes[(coordinate, *n)] != 0.0);
        let modes = (0..COORDINATES).filter(moves).map(|n| DecayingMode {
            frequency_hz: self.modes.angular_frequencies[n] / TAU,
            decay_per_s: self.modal_damping(n) / 2.0,
        });
        let none = DecayingMode { frequency_hz: 0.0, decay_per_s: f64::INFINITY };
        modes.fold(none, |slowest, mode| if mode.decay_per_s < slowest.decay_per_s { mode } else { slowest })
    }

    /// Rigid rotation of the train per unit rotation of the motor: gear and brake turn backwards by `z_p/z_g`.
    pub fn rigid_rotation(&self) -> CoordinateVector {
        let mut rotation = CoordinateVector::zeros();
        rotation[THETA_GEAR] = -1.0 / self.ratio;
        rotation[THETA_PINION] = 1.0;
        rotation[THETA_BRAKE] = -1.0 / self.ratio;
        rotation
    }

    /// (N, N m) Force of motor, brake and the flanks' deviations, which act along the nominal line of action.
    pub fn force(&self, forcing: &Forcing) -> CoordinateVector {
        let [line, tilt] = self.turned_line(self.nominal_angle_rad);
        let mut force = self.turn * (line + tilt * forcing.error_mean_z_m) * -forcing.error_force_n;
        force[THETA_PINION] += self.shaft_stiffness_nm_per_rad[0] * forcing.motor_angle_rad;
        force[THETA_BRAKE] += forcing.brake_torque_nm;
        force
    }

    fn turned_back(&self, turned: &CoordinateMatrix) -> CoordinateMatrix {
        self.turn * turned * self.turn.transpose()
    }
}

/// The turned coordinates: (x, y) along and across the nominal line of action, (φ, ψ) the tilt that moves the flank along it and the
/// other.
fn turn(pressure_angle_rad: f64) -> CoordinateMatrix {
    let mut turn = CoordinateMatrix::identity();
    let tilts = [(PHI_GEAR, PSI_GEAR), (PHI_PINION, PSI_PINION)];
    turn_planes(&mut turn, pressure_angle_rad, [(X_GEAR, Y_GEAR), (X_PINION, Y_PINION)], tilts);
    turn
}

/// (kg, kg m²) Diagonal of the mass matrix.
fn masses(pinion: &WheelBody, gear: &WheelBody, brake_kgm2: f64) -> CoordinateVector {
    let mut mass = CoordinateVector::zeros();
    for (wheel, [x, y, z, theta, phi, psi]) in [
        (gear, [X_GEAR, Y_GEAR, Z_GEAR, THETA_GEAR, PHI_GEAR, PSI_GEAR]),
        (pinion, [X_PINION, Y_PINION, Z_PINION, THETA_PINION, PHI_PINION, PSI_PINION]),
    ] {
        [x, y, z].into_iter().for_each(|coordinate| mass[coordinate] = wheel.mass_kg);
        mass[theta] = wheel.polar_kgm2;
        [phi, psi].into_iter().for_each(|coordinate| mass[coordinate] = wheel.transverse_kgm2);
    }
    mass[THETA_BRAKE] = brake_kgm2;
    mass
}

/// (N m/rad) `π r⁴ G/(2 l)`.
fn torsional_stiffness(shaft: &Shaft, gears: &Gears) -> f64 {
    let (radius, length) = (shaft.radius_mm * 1e-3, shaft.length_mm * 1e-3);
    PI * radius.powi(4) * gears.material.shear_modulus_mpa() * 1e6 / (2.0 * length)
}

/// Bearings, tilting stiffness and shafts.
fn constant_stiffness(rig: &Rig, [pinion_shaft, gear_shaft]: [f64; 2]) -> CoordinateMatrix {
    let mut stiffness = CoordinateMatrix::zeros();
    for coordinate in [X_GEAR, Y_GEAR, Z_GEAR, X_PINION, Y_PINION, Z_PINION] {
        stiffness[(coordinate, coordinate)] = rig.bearing_stiffness_n_per_m;
    }
    for coordinate in [PHI_GEAR, PSI_GEAR, PHI_PINION, PSI_PINION] {
        stiffness[(coordinate, coordinate)] = rig.wheel_rotational_stiffness_nm_per_rad;
    }
    stiffness[(THETA_GEAR, THETA_GEAR)] = gear_shaft;
    stiffness[(THETA_BRAKE, THETA_BRAKE)] = gear_shaft;
    stiffness[(THETA_GEAR, THETA_BRAKE)] = -gear_shaft;
    stiffness[(THETA_BRAKE, THETA_GEAR)] = -gear_shaft;
    stiffness[(THETA_PINION, THETA_PINION)] = pinion_shaft;
    stiffness
}
