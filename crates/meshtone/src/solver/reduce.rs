//! The equations of motion in modal coordinates, without what stays at rest.

use nalgebra::allocator::Allocator;
use nalgebra::{DMatrix, DVector, DefaultAllocator, Dim, OVector};

use crate::machine::coordinates::*;
use crate::machine::{Structure, System};
use crate::mesh::ROTATION;

/// Which of the five constant mesh directions one column of `B` stands for, and its vector.
struct Column {
    direction: usize,
    vector: CoordinateVector,
}

/// The system in the modes that take part in the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct ReducedModel {
    /// Mass-normalised shapes of the active modes, in the machine's coordinates.
    pub shapes: Vec<DVector<f64>>,
    /// (1/s²) ω² of the active modes.
    pub stiffness: Vec<f64>,
    /// (1/s) 2ζω of the active modes.
    pub damping: Vec<f64>,
    /// Columns of `ΦᵀB`: the mesh's directions in modal coordinates.
    pub mesh: Vec<DVector<f64>>,
    /// Which of the five constant mesh directions each column stands for.
    pub directions: Vec<usize>,
    /// (N/m) Mean over the cycle of `S`.
    pub mean_mesh_stiffness: DMatrix<f64>,
    /// Modal force per rad of motor angle.
    pub motor: Vec<f64>,
    /// Modal force per N m of brake torque.
    pub brake: Vec<f64>,
    /// Modal velocity of the rigid rotation at 1 rad/s.
    pub rigid_velocity: Vec<f64>,
    /// The rigid rotation in the machine's coordinates.
    pub rigid_rotation: DVector<f64>,
    /// Weights of the coordinates in the sensor's acceleration along x, y and z.
    pub sensor: [Vec<f64>; 3],
    /// (N) Mesh force under the constant loads that the displacements do not bring about: they are relative to it.
    pub static_mesh_force_n: f64,
    /// Whether damping acts on the rigid rotation too.
    pub damps_rotation: bool,
    /// (rad/s) Speed of the rigid rotation on top of which the modes move: the nominal one.
    pub rotation_rad_per_s: f64,
    /// Modal displacement at the start, relative to the rigid rotation; none for the static equilibrium there.
    pub initial_displacement: Option<Vec<f64>>,
    /// Modal velocity at the start, relative to the rigid rotation.
    pub initial_velocity: Vec<f64>,
}

/// Number of the constant mesh direction along the nominal line of action.
const ALONG: usize = 0;

/// Number of the one that is added to it per m along the face.
const TILT: usize = 3;

/// Below this part of the largest entry a modal entry is rounding.
const ROUNDING: f64 = 1e-13;

impl ReducedModel {
    /// Leaves out the modes and mesh directions that nothing sets in motion.
    ///
    /// # Arguments
    /// * `system` - the equations of motion
    /// * `rotation_rad_per_s` - nominal speed of the motor
    /// * `initial_displacement` - in the 13 coordinates; none for the static equilibrium of the loaded mesh
    /// * `initial_velocity` - in the 13 coordinates
    pub fn new(
        system: &System,
        rotation_rad_per_s: f64,
        initial_displacement: Option<&CoordinateVector>,
        initial_velocity: &CoordinateVector,
    ) -> Self {
        let turn = &system.directions.turn;
        let modal = |turned: &CoordinateVector| clean(system.modes.shapes.transpose() * turned);
        let mass = CoordinateVector::from(system.mass_diagonal);
        let modal_motion =
            |motion: &CoordinateVector| modal(&(turn.transpose() * motion).component_mul(&mass));
        let columns = columns(system);
        let coupled = &system.mesh.coupled;
        let mesh: Vec<CoordinateVector> = columns.iter().map(|column| modal(&column.vector)).collect();
        let mut unit = CoordinateVector::zeros();
        unit[THETA_PINION] = system.shaft_stiffness_nm_per_rad[0];
        let motor = modal(&unit);
        unit = CoordinateVector::zeros();
        unit[THETA_BRAKE] = 1.0;
        let brake = modal(&unit);
        let displacement = initial_displacement.map(modal_motion);
        let displaced = displacement.unwrap_or_else(CoordinateVector::zeros);
        let rigid_rotation = system.rigid_rotation();
        let velocity = modal_motion(&(initial_velocity - rigid_rotation * rotation_rad_per_s));
        let rigid = modal_motion(&rigid_rotation);

        let moved =
            |n: usize| [&motor, &brake, &displaced, &velocity, &rigid].iter().any(|vector| vector[n] != 0.0);
        let mut active_modes: Vec<bool> = (0..COORDINATES).map(moved).collect();
        let mut active_columns = vec![false; columns.len()];
        loop {
            let before = (active_modes.clone(), active_columns.clone());
            for (c, (column, vector)) in columns.iter().zip(&mesh).enumerate() {
                let reached = (0..COORDINATES).any(|n| active_modes[n] && vector[n] != 0.0)
                    || (0..columns.len())
                        .any(|d| active_columns[d] && coupled[(column.direction, columns[d].direction)]);
                active_columns[c] |= reached;
                for n in 0..COORDINATES {
                    active_modes[n] |= active_columns[c] && vector[n] != 0.0;
                }
            }
            if before == (active_modes.clone(), active_columns.clone()) {
                break;
            }
        }

        let modes: Vec<usize> = (0..COORDINATES).filter(|&n| active_modes[n]).collect();
        let kept: Vec<usize> = (0..columns.len()).filter(|&c| active_columns[c]).collect();
        let pick = |vector: &CoordinateVector| modes.iter().map(|&n| vector[n]).collect::<Vec<f64>>();
        let directions: Vec<usize> = kept.iter().map(|&c| columns[c].direction).collect();
        let mean = &system.mesh.mean_stiffness;
        let dynamic = |vector: CoordinateVector| DVector::from_column_slice(vector.as_slice());
        Self {
            shapes: modes.iter().map(|&n| dynamic(turn * system.modes.shapes.column(n))).collect(),
            stiffness: modes.iter().map(|&n| system.modes.angular_frequencies[n].powi(2)).collect(),
            damping: modes.iter().map(|&n| system.modal_damping(n)).collect(),
            mesh: kept.iter().map(|&c| DVector::from_vec(pick(&mesh[c]))).collect(),
            mean_mesh_stiffness: DMatrix::from_fn(kept.len(), kept.len(), |r, c| {
                mean[(directions[r], directions[c])]
            }),
            directions,
            motor: pick(&motor),
            brake: pick(&brake),
            rigid_velocity: pick(&rigid),
            rigid_rotation: dynamic(rigid_rotation),
            sensor: [[X_GEAR, X_PINION], [Y_GEAR, Y_PINION], [Z_GEAR, Z_PINION]]
                .map(|wheels| ones(&wheels, 1.0)),
            static_mesh_force_n: 0.0,
            damps_rotation: system.damps_rotation,
            rotation_rad_per_s,
            initial_displacement: displacement.as_ref().map(pick),
            initial_velocity: pick(&velocity),
        }
    }

    /// The machine under `contact`, without the mesh: its modes are decoupled.
    ///
    /// # Arguments
    /// * `structure` - the machine
    /// * `tilts` - whether the load moves along the face
    /// * `rotation_rad_per_s` - nominal speed of the motor
    /// * `brake_torque_nm` - nominal torque of the brake
    /// * `initial_displacement` - in the wheels' 13 coordinates; none for the static equilibrium of the loaded mesh
    /// * `initial_velocity` - in the wheels' 13 coordinates
    pub(crate) fn of_structure(
        structure: &Structure,
        tilts: bool,
        rotation_rad_per_s: f64,
        brake_torque_nm: f64,
        initial_displacement: Option<&CoordinateVector>,
        initial_velocity: &CoordinateVector,
    ) -> Self {
        let shapes = structure.shapes.transpose();
        let mass = DVector::from_column_slice(&structure.mass_diagonal);
        let modal = |turned: &DVector<f64>| clean(&shapes * turned);
        let rigid_rotation = structure.rigid_rotation();
        let modal_motion =
            |motion: &DVector<f64>| modal(&(structure.turn.transpose() * motion).component_mul(&mass));
        let unit = |coordinate: usize, size: f64| {
            let mut unit = DVector::zeros(COORDINATES_WITH_SUPPORTS);
            unit[coordinate] = size;
            modal(&unit)
        };
        let motor = unit(THETA_PINION, structure.shaft_stiffness_nm_per_rad[0]);
        let brake = unit(THETA_BRAKE, 1.0);
        let rigid = modal_motion(&rigid_rotation);
        let displacement = initial_displacement.map(|given| modal_motion(&with_supports(given)));
        let velocity =
            modal_motion(&(with_supports(initial_velocity) - &rigid_rotation * rotation_rad_per_s));
        let columns: Vec<DVector<f64>> =
            structure.line_of_action.iter().take(if tilts { 2 } else { 1 }).map(modal).collect();
        let driven = [Some(&motor), Some(&brake), Some(&rigid), Some(&velocity), displacement.as_ref()];
        let moved = |n: usize| {
            driven.iter().flatten().any(|vector| vector[n] != 0.0)
                || columns.iter().any(|line| line[n] != 0.0)
        };
        let modes: Vec<usize> = (0..COORDINATES_WITH_SUPPORTS).filter(|&n| moved(n)).collect();
        let pick = |vector: &DVector<f64>| modes.iter().map(|&n| vector[n]).collect::<Vec<f64>>();
        // The freely turning train is in balance.
        let static_mesh_force_n = brake_torque_nm * brake[0] / columns[0][0];
        let count = columns.len();
        Self {
            shapes: modes.iter().map(|&n| &structure.turn * structure.shapes.column(n)).collect(),
            stiffness: modes.iter().map(|&n| structure.angular_frequencies[n].powi(2)).collect(),
            damping: modes.iter().map(|&n| structure.modal_damping(n)).collect(),
            mesh: columns.iter().map(|column| DVector::from_vec(pick(column))).collect(),
            directions: [ALONG, TILT][..count].to_vec(),
            mean_mesh_stiffness: DMatrix::zeros(count, count),
            motor: pick(&motor),
            brake: pick(&brake),
            rigid_velocity: pick(&rigid),
            rigid_rotation,
            sensor: [
                ones(&[X_GEAR_SUPPORT, X_PINION_SUPPORT], 0.5),
                ones(&[Y_GEAR_SUPPORT, Y_PINION_SUPPORT], 0.5),
                ones(&[Z_GEAR, Z_PINION], 1.0),
            ],
            static_mesh_force_n,
            damps_rotation: false,
            rotation_rad_per_s,
            initial_displacement: displacement.as_ref().map(pick),
            initial_velocity: pick(&velocity),
        }
    }

    /// Column of [`Self::mesh`] whose direction has weight 1 in every line of action, so that its component of the
    /// mesh's force is the whole force.
    pub(crate) fn whole_force_column(&self) -> Option<usize> {
        let rotation = self.directions.iter().position(|&direction| direction == ROTATION);
        rotation.or_else(|| self.directions.iter().position(|&direction| direction == ALONG))
    }

    /// (1/s) Rate at which the slowest active mode decays, `min ζω`; of a machine without its mesh 0, that of the free rotation.
    pub fn slowest_decay_per_s(&self) -> f64 {
        self.damping.iter().copied().fold(f64::INFINITY, f64::min) / 2.0
    }

    /// Number of active modes.
    pub fn modes(&self) -> usize {
        self.shapes.len()
    }
}

/// A weight for each of some coordinates.
fn ones(coordinates: &[usize], weight: f64) -> Vec<f64> {
    let mut weights = vec![0.0; COORDINATES_WITH_SUPPORTS];
    for &coordinate in coordinates {
        weights[coordinate] = weight;
    }
    weights
}

/// The directions that the line of action takes. At a constant pressure angle two are enough: the line
/// itself and its tilt.
fn columns(system: &System) -> Vec<Column> {
    let turned = &system.directions.turned;
    if system.mesh.constant_angle {
        vec![
            Column { direction: 0, vector: turned[0] + turned[2] },
            Column { direction: 3, vector: turned[3] },
        ]
    } else {
        (0..turned.len()).map(|direction| Column { direction, vector: turned[direction] }).collect()
    }
}

/// A modal vector without the entries that only rounding makes.
fn clean<D: Dim>(vector: OVector<f64, D>) -> OVector<f64, D>
where
    DefaultAllocator: Allocator<D>,
{
    let largest = vector.amax();
    vector.map(|entry| if entry.abs() < ROUNDING * largest { 0.0 } else { entry })
}
