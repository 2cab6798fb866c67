//! What is read off the solution.

use nalgebra::DVector;

use super::reduce::ReducedModel;

/// A signal that is read off the solution.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Output {
    /// (m or rad) Linear combination of the displacements, by the weight of each coordinate; of those left out it is 0.
    Displacement(Vec<f64>),
    /// (m/s or rad/s) Likewise of the velocities.
    Velocity(Vec<f64>),
    /// (m/s² or rad/s²) Likewise of the accelerations.
    Acceleration(Vec<f64>),
    /// (m/s²) Acceleration of the sensor, wherever the model has it, in a direction; times a factor.
    Sensor(Axis, f64),
    /// (N) Force with which the mesh presses the flanks together; negative: the linear mesh pulls.
    MeshForce,
}

/// Direction of a sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal, from shaft to shaft.
    X,
    /// Vertical.
    Y,
    /// Along the shafts.
    Z,
}

/// A linear combination of the step's own variables: `constant + sample·per_sample + u·displacement + s·velocity +
/// w·force + x·external`.
#[derive(Debug, Clone, Default)]
pub(super) struct OutputRow {
    pub(super) displacement: Vec<f64>,
    pub(super) scaled_velocity: Vec<f64>,
    pub(super) force: Vec<f64>,
    pub(super) external: [f64; EXTERNALS],
    pub(super) constant: f64,
    pub(super) per_sample: f64,
}

/// Motor lead, brake torque deviation, motor speed deviation.
pub(super) const EXTERNALS: usize = 3;

/// What an [`OutputRow`] is made from, beside the model.
pub(super) struct Scales {
    pub(super) half_step_s: f64,
    /// Modal displacement under the constant loads.
    pub(super) static_displacement: Vec<f64>,
    /// Modal force of each external.
    pub(super) external: [Vec<f64>; EXTERNALS],
}

impl Output {
    pub(super) fn row(&self, model: &ReducedModel, scales: &Scales) -> OutputRow {
        let (h, modes) = (scales.half_step_s, model.modes());
        let zeros = || vec![0.0; modes];
        let weights = |weights: &[f64]| -> (Vec<f64>, f64) {
            let row =
                DVector::from_fn(model.rigid_rotation.len(), |n, _| weights.get(n).copied().unwrap_or(0.0));
            (
                model.shapes.iter().map(|shape| sum_or_zero(shape, &row)).collect(),
                model.rigid_rotation.dot(&row),
            )
        };
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let no_force = vec![0.0; model.directions.len()];
        let acceleration = |by_coordinate: &[f64]| {
            let (row, _) = weights(by_coordinate);
            OutputRow {
                displacement: (0..modes).map(|n| -row[n] * model.stiffness[n]).collect(),
                scaled_velocity: (0..modes).map(|n| -row[n] * model.damping[n] / h).collect(),
                force: model.mesh.iter().map(|column| sum(&row, column.as_slice())).collect(),
                external: std::array::from_fn(|x| sum(&row, &scales.external[x])),
                ..OutputRow::default()
            }
        };
        match self {
            Self::Displacement(by_coordinate) => {
                let (row, rigid) = weights(by_coordinate);
                OutputRow {
                    constant: sum(&row, &scales.static_displacement),
                    per_sample: rigid * model.rotation_rad_per_s * 2.0 * h,
                    displacement: row,
                    scaled_velocity: zeros(),
                    force: no_force,
                    ..OutputRow::default()
                }
            }
            Self::Velocity(by_coordinate) => {
                let (row, rigid) = weights(by_coordinate);
                OutputRow {
                    displacement: zeros(),
                    scaled_velocity: row.iter().map(|weight| weight / h).collect(),
                    force: no_force,
                    constant: rigid * model.rotation_rad_per_s,
                    ..OutputRow::default()
                }
            }
            Self::Acceleration(by_coordinate) => acceleration(by_coordinate),
            Self::Sensor(axis, factor) => {
                let weights: Vec<f64> =
                    model.sensor[*axis as usize].iter().map(|weight| weight * factor).collect();
                acceleration(&weights)
            }
            Self::MeshForce => {
                // The direction that has weight 1 in every line of action carries the whole force.
                let whole = model.whole_force_column();
                let mut force = no_force;
                let mut displacement = zeros();
                if let Some(whole) = whole {
                    force[whole] = -1.0;
                    for (column, mesh) in model.mesh.iter().enumerate() {
                        for n in 0..modes {
                            displacement[n] += model.mean_mesh_stiffness[(whole, column)] * mesh[n];
                        }
                    }
                }
                OutputRow {
                    constant: model.static_mesh_force_n + sum(&displacement, &scales.static_displacement),
                    displacement,
                    scaled_velocity: zeros(),
                    force,
                    ..OutputRow::default()
                }
            }
        }
    }
}

/// `a·b`, or 0 where the terms cancel to rounding: wheels of equal mass move in opposition, and their sum is no signal.
fn sum_or_zero(a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    let terms = a.component_mul(b);
    let sum = terms.sum();
    if sum.abs() < ROUNDING * terms.abs().sum() { 0.0 } else { sum }
}

/// Part of the terms' own size below which a sum is rounding.
const ROUNDING: f64 = 1e-12;
