//! What forces across the lines of action make of a machine whose meshes stay closed: transfer functions to its sensors.

use std::f64::consts::TAU;

use meshtone_fourier::Complex64;
use nalgebra::{DMatrix, DVector};

use super::ModalMachine;
use crate::machine::ClosedMesh;

/// (-) Steps from one frequency to the next, as a part of the frequency: a third of the least damping ratio resolves a resonance within 2 %.
const STEPS: [f64; 2] = [0.002, 0.02];
/// (Hz) Lowest frequency of which the transfer functions are computed. They rise from 0 to it with the square of the frequency.
const LOWEST_HZ: f64 = 1.0;

/// Transfer functions from a force across the line of action of each mesh, at its pitch point, to accelerations.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LateralResponse {
    /// (Hz) Frequencies, rising.
    frequency_hz: Vec<f64>,
    /// (m/s²/N) At each: a row for each place, a column for each mesh.
    gains: Vec<DMatrix<Complex64>>,
}

impl LateralResponse {
    /// The transfer functions up to a frequency; those of a machine without forces across its lines are 0.
    ///
    /// The machine is taken in its modes without the meshes. A unit force across each line deflects the closed meshes; what they push back with
    /// follows from as many equations as there are meshes, and both forces together move the sensors.
    ///
    /// # Arguments
    /// * `model` - the machine
    /// * `meshes` - closed
    /// * `places` - weights of the machine's coordinates in each acceleration
    /// * `highest_hz` - (Hz) the highest frequency
    pub(crate) fn new(
        model: &ModalMachine,
        meshes: &[ClosedMesh],
        places: &[DVector<f64>],
        highest_hz: f64,
    ) -> Self {
        let damping_ratio = |(stiffness, damping): (&f64, &f64)| damping / (2.0 * stiffness.sqrt());
        let held = model.stiffness.iter().zip(&model.damping).filter(|(stiffness, _)| **stiffness > 0.0);
        let least = held.map(damping_ratio).fold(f64::INFINITY, f64::min);
        let step = (least / 3.0).clamp(STEPS[0], STEPS[1]);
        let count = ((highest_hz / LOWEST_HZ).ln() / step.ln_1p()).ceil() as usize;
        let frequency_hz: Vec<f64> =
            (0..=count).map(|n| LOWEST_HZ * (n as f64 * step.ln_1p()).exp()).collect();
        let places: Vec<Vec<f64>> = places.iter().map(|weights| model.of_coordinates(weights).0).collect();
        let gains = frequency_hz.iter().map(|hz| gains_at(model, meshes, &places, TAU * hz)).collect();
        Self { frequency_hz, gains }
    }

    /// (m/s²/N) The transfer function from a mesh to a place at equally spaced frequencies from 0 on, straight between those computed.
    ///
    /// # Arguments
    /// * `place`, `mesh` - their numbers
    /// * `step_hz` - (Hz) from one frequency to the next
    /// * `count` - how many
    pub(crate) fn at(&self, place: usize, mesh: usize, step_hz: f64, count: usize) -> Vec<Complex64> {
        let mut next = 1;
        let gain = |n: usize| self.gains[n][(place, mesh)];
        let last = self.frequency_hz.len() - 1;
        let between = |line: usize| {
            let hz = line as f64 * step_hz;
            if hz < self.frequency_hz[0] {
                return gain(0) * (hz / self.frequency_hz[0]).powi(2);
            }
            while next < last && self.frequency_hz[next] < hz {
                next += 1;
            }
            let [before_hz, after_hz] = [self.frequency_hz[next - 1], self.frequency_hz[next]];
            let part = ((hz - before_hz) / (after_hz - before_hz)).min(1.0);
            gain(next - 1) * (1.0 - part) + gain(next) * part
        };
        (0..count).map(between).collect()
    }
}

/// (m/s²/N) The transfer functions at one frequency.
fn gains_at(
    model: &ModalMachine,
    meshes: &[ClosedMesh],
    sensors: &[Vec<f64>],
    rad_per_s: f64,
) -> DMatrix<Complex64> {
    let count = model.lines.len();
    let zeros = |rows: usize| DMatrix::from_element(rows, count, Complex64::ZERO);
    // Deflections and accelerations per force along the lines, and across them.
    let [mut line_of_line, mut line_of_across] = [zeros(count), zeros(count)];
    let [mut sensor_of_line, mut sensor_of_across] = [zeros(sensors.len()), zeros(sensors.len())];
    let inertia = rad_per_s * rad_per_s;
    for n in 0..model.modes() {
        let displacement = Complex64::new(model.stiffness[n] - inertia, model.damping[n] * rad_per_s).inv();
        for (mesh, line) in model.lines.iter().enumerate() {
            let along = displacement * line.at_middle[n];
            let across =
                displacement * line.across.as_ref().map_or(0.0, |[at_pitch_point, _]| at_pitch_point[n]);
            for (other, row) in model.lines.iter().enumerate() {
                line_of_line[(other, mesh)] += along * row.at_middle[n];
                line_of_across[(other, mesh)] += across * row.at_middle[n];
            }
            for (sensor, entries) in sensors.iter().enumerate() {
                sensor_of_line[(sensor, mesh)] -= along * (inertia * entries[n]);
                sensor_of_across[(sensor, mesh)] -= across * (inertia * entries[n]);
            }
        }
    }
    let stiffness: DVector<Complex64> = DVector::from_iterator(
        count,
        meshes
            .iter()
            .map(|mesh| Complex64::new(1.0, rad_per_s * mesh.damping_time_s) * mesh.stiffness_n_per_m),
    );
    let stiffness = DMatrix::from_diagonal(&stiffness);
    let one = DMatrix::from_diagonal_element(count, count, Complex64::ONE);
    // Singular for no frequency: the closed meshes are damped.
    let forces = (one + &stiffness * line_of_line).lu().solve(&(stiffness * line_of_across));
    forces.map_or_else(|| sensor_of_across.clone(), |forces| &sensor_of_across - sensor_of_line * forces)
}
