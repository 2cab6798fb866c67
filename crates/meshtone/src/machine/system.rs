//! Mass, damping and stiffness.

use std::f64::consts::PI;

use super::body::WheelBody;
use super::coordinates::*;
use super::mesh_directions::MeshDirections;
use super::modes::Modes;
use super::{Rig, Shaft};
use crate::mesh::{DIRECTIONS, DirectionMatrix, DirectionVector, Mesh, MeshSpan, ROTATION};
use crate::model::Model;
use crate::wheel::{Gears, Teeth};

/// What forces the equations of motion at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Excitation {
    /// (rad) Angle of the motor.
    pub motor_angle_rad: f64,
    /// (rad/s) Angular speed of the motor.
    pub motor_speed_rad_per_s: f64,
    /// (N m) Torque of the brake.
    pub brake_torque_nm: f64,
    /// (N) Force of the flanks' deviations, in the mesh's constant directions.
    pub(crate) deviation_force_n: DirectionVector,
}

impl Excitation {
    /// (N) Force of the flanks' deviations, stiffness × deviation, summed over the pairs in contact.
    pub fn error_force_n(&self) -> f64 {
        self.deviation_force_n[ROTATION]
    }

    /// (N) Force of the flanks' deviations, in the mesh's constant directions, [`MeshDirections::turned`].
    pub fn deviation_force_n(&self) -> [f64; DIRECTIONS] {
        self.deviation_force_n.into()
    }
}

/// Stage 6's result: the coefficients of the equations of motion.
///
/// Kept in turned coordinates (see [`MeshDirections`]); the methods that return matrices turn them back.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// Mass and inertias of the pinion.
    pub pinion: WheelBody,
    /// Mass and inertias of the gear.
    pub gear: WheelBody,
    /// (kg, kg m²) Diagonal of the mass matrix; the same in turned coordinates.
    pub mass_diagonal: [f64; COORDINATES],
    /// (N m/rad) Torsional stiffness of the pinion's and of the gear's shaft.
    pub shaft_stiffness_nm_per_rad: [f64; 2],
    /// (-) Damping ratio of each mode.
    pub damping_ratio: [f64; COORDINATES],
    /// Constant part of the stiffness, without the mesh; the same in turned coordinates.
    pub constant_stiffness: CoordinateMatrix,
    /// Directions of the mesh.
    pub directions: MeshDirections,
    /// What the mesh can do.
    pub(crate) mesh: MeshSpan,
    /// Whether damping acts on the wheels' rigid rotation too, as in the published code, and not only on the motion relative
    /// to it.
    pub(crate) damps_rotation: bool,
    /// Modes of the mean stiffness, in turned coordinates.
    pub modes: Modes,
    /// (-) Revolutions of the pinion per revolution of the gear, `z_g/z_p`.
    pub ratio: f64,
}

impl System {
    /// Assembles the equations of motion.
    ///
    /// # Arguments
    /// * `gears` - for the material
    /// * `rig` - bearings, shafts, brake
    /// * `teeth` - both wheels
    /// * `mesh` - the mesh over the cycle
    /// * `model` - inertias and damping
    pub fn new(gears: &Gears, rig: &Rig, teeth: &Teeth, mesh: &Mesh, model: Model) -> Self {
        let body = |wheel, given| WheelBody::new(wheel, gears.material, given, model);
        let mesh = mesh.span();
        let pinion = body(&teeth.pinion, &rig.pinion_inertia);
        let gear = body(&teeth.gear, &rig.gear_inertia);
        let mass_diagonal = masses(&pinion, &gear, rig);
        let shaft_stiffness_nm_per_rad =
            [torsional_stiffness(&rig.pinion_shaft, gears), torsional_stiffness(&rig.gear_shaft, gears)];
        let constant_stiffness = constant_stiffness(rig, shaft_stiffness_nm_per_rad);
        let directions = MeshDirections::new(&teeth.pinion, &teeth.gear);
        let mean = constant_stiffness + in_turned(&directions, &mesh.mean_stiffness);
        let modes = Modes::new(&CoordinateVector::from(mass_diagonal), &mean);
        Self {
            pinion,
            gear,
            mass_diagonal,
            shaft_stiffness_nm_per_rad,
            damping_ratio: rig.damping_ratio.per_mode(),
            constant_stiffness,
            directions,
            mesh,
            // Model: the published damping brakes the rigid rotation too.
            damps_rotation: model == Model::Published,
            modes,
            ratio: f64::from(gears.gear_teeth) / f64::from(gears.pinion_teeth),
        }
    }

    /// (Hz) Natural frequencies of the mean system, rising.
    pub fn natural_frequencies_hz(&self) -> [f64; COORDINATES] {
        self.modes.angular_frequencies.map(|omega| omega / (2.0 * PI))
    }

    /// Mode shapes of the mean system in the 13 coordinates, a column each, of unit modal mass; in the order of
    /// [`Self::natural_frequencies_hz`].
    pub fn mode_shapes(&self) -> CoordinateMatrix {
        self.directions.turn * self.modes.shapes
    }

    /// (N/m, N/rad, N m/rad) Stiffness matrix at a point of the cycle.
    ///
    /// # Arguments
    /// * `mesh` - the mesh over the cycle
    /// * `point` - under `published` a coarse point of the cycle, else an entry of the pairs' table
    pub fn stiffness_matrix_at(&self, mesh: &Mesh, point: usize) -> CoordinateMatrix {
        self.stiffness_matrix(&mesh.stiffness_at(point))
    }

    /// Stiffness matrix with a mesh stiffness that is given in the constant directions.
    pub(crate) fn stiffness_matrix(&self, mesh: &DirectionMatrix) -> CoordinateMatrix {
        self.turn_back(&(self.constant_stiffness + in_turned(&self.directions, mesh)))
    }

    /// Mean stiffness matrix over the cycle.
    pub fn mean_stiffness_matrix(&self) -> CoordinateMatrix {
        self.turn_back(&(self.constant_stiffness + in_turned(&self.directions, &self.mesh.mean_stiffness)))
    }

    /// Damping matrix `C = M Σ_n 2 ζ_n ω_n φ_n φ_nᵀ M`.
    pub fn damping_matrix(&self) -> CoordinateMatrix {
        let mass = CoordinateMatrix::from_diagonal(&CoordinateVector::from(self.mass_diagonal));
        let mass_shapes = mass * self.modes.shapes;
        let modal = CoordinateVector::from_fn(|n, _| self.modal_damping(n));
        self.turn_back(&(mass_shapes * CoordinateMatrix::from_diagonal(&modal) * mass_shapes.transpose()))
    }

    /// (1/s) `2 ζ ω` of mode `n`.
    pub fn modal_damping(&self, n: usize) -> f64 {
        2.0 * self.damping_ratio[n] * self.modes.angular_frequencies[n]
    }

    /// Rigid rotation of the train per unit rotation of the motor: gear and brake turn backwards by
    /// `z_p/z_g`.
    pub fn rigid_rotation(&self) -> CoordinateVector {
        rigid_rotation(self.ratio)
    }

    /// (N, N m) External force in the 13 coordinates: motor, brake, the flanks' deviations and, unless damping acts on the
    /// rigid rotation, the damping's reference to it.
    ///
    /// # Arguments
    /// * `excitation` - one sample's excitation
    pub fn force(&self, excitation: &Excitation) -> CoordinateVector {
        let mut force = CoordinateVector::zeros();
        for (vector, component) in self.directions.turned.iter().zip(excitation.deviation_force_n.iter()) {
            force -= self.directions.turn * vector * *component;
        }
        force[THETA_PINION] += self.shaft_stiffness_nm_per_rad[0] * excitation.motor_angle_rad;
        force[THETA_BRAKE] += excitation.brake_torque_nm;
        if !self.damps_rotation {
            force += self.damping_matrix() * self.rigid_rotation() * excitation.motor_speed_rad_per_s;
        }
        force
    }

    /// A symmetric matrix in turned coordinates, in the 13 coordinates.
    fn turn_back(&self, turned: &CoordinateMatrix) -> CoordinateMatrix {
        self.directions.turn * turned * self.directions.turn.transpose()
    }
}

/// (kg, kg m²) Diagonal of the mass matrix of the wheels and the brake.
pub(super) fn masses(pinion: &WheelBody, gear: &WheelBody, rig: &Rig) -> [f64; COORDINATES] {
    let mut mass_diagonal = [0.0; COORDINATES];
    for (wheel, coordinates) in [
        (gear, [X_GEAR, Y_GEAR, Z_GEAR, THETA_GEAR, PHI_GEAR, PSI_GEAR]),
        (pinion, [X_PINION, Y_PINION, Z_PINION, THETA_PINION, PHI_PINION, PSI_PINION]),
    ] {
        for (n, coordinate) in coordinates.into_iter().enumerate() {
            mass_diagonal[coordinate] = match n {
                0..3 => wheel.mass_kg,
                3 => wheel.polar_kgm2,
                _ => wheel.transverse_kgm2,
            };
        }
    }
    mass_diagonal[THETA_BRAKE] = rig.brake_inertia_kgm2;
    mass_diagonal
}

/// Rigid rotation of the train per unit rotation of the motor.
///
/// # Arguments
/// * `ratio` - (-) revolutions of the pinion per revolution of the gear
pub(super) fn rigid_rotation(ratio: f64) -> CoordinateVector {
    let mut rotation = CoordinateVector::zeros();
    rotation[THETA_GEAR] = -1.0 / ratio;
    rotation[THETA_PINION] = 1.0;
    rotation[THETA_BRAKE] = -1.0 / ratio;
    rotation
}

/// `B S Bᵀ` in turned coordinates.
fn in_turned(directions: &MeshDirections, stiffness: &DirectionMatrix) -> CoordinateMatrix {
    let mut sum = CoordinateMatrix::zeros();
    for (r, row) in directions.turned.iter().enumerate() {
        for (c, column) in directions.turned.iter().enumerate() {
            if stiffness[(r, c)] != 0.0 {
                sum += row * column.transpose() * stiffness[(r, c)];
            }
        }
    }
    sum
}

/// (N m/rad) `π r⁴ G/(2 l)`.
pub(super) fn torsional_stiffness(shaft: &Shaft, gears: &Gears) -> f64 {
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
