//! Wheels on shafts that bend, in supports that move.

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use super::body::WheelBody;
use super::coordinates::*;
use super::mesh_directions::MeshDirections;
use super::modes::mass_normalised_modes;
use super::shaft_bending::wheel_flexibility;
use super::system::{masses, rigid_rotation, torsional_stiffness};
use super::{Rig, Support};
use crate::model::Model;
use crate::wheel::{Gears, Teeth, Wheel, WheelName};

/// Stage 6's result under `contact`: the equations of motion without the mesh, which is the solver's to close or open.
///
/// 17 coordinates: those of [`System`](super::System), and x and y of the two supports. Each wheel hangs in its support by the
/// flexibility of its shaft and bearings, in deflection and slope; the supports stand on the base and hold one another.
/// Matrices are in turned coordinates, see [`MeshDirections`]: the supports' too, along and across the line of action.
#[derive(Debug, Clone, PartialEq)]
pub struct Structure {
    /// Mass and inertias of the pinion.
    pub pinion: WheelBody,
    /// Mass and inertias of the gear.
    pub gear: WheelBody,
    /// (kg, kg m²) Diagonal of the mass matrix; the same in turned coordinates.
    pub mass_diagonal: Vec<f64>,
    /// (N m/rad) Torsional stiffness of the pinion's and of the gear's shaft.
    pub shaft_stiffness_nm_per_rad: [f64; 2],
    /// Stiffness without the mesh.
    pub stiffness: DMatrix<f64>,
    /// (rad/s) Natural angular frequencies without the mesh, in rising order; the first is 0: the driven train turns freely.
    pub angular_frequencies: Vec<f64>,
    /// Mass-normalised shapes of the modes without the mesh, a column each.
    pub shapes: DMatrix<f64>,
    /// (-) Damping ratio of each mode: of shafts and supports, by their share of its strain energy.
    pub damping_ratio: Vec<f64>,
    /// Lines of action in turned coordinates: at the middle of the face, and what is added per m along the face.
    pub line_of_action: [DVector<f64>; 2],
    /// Columns: the turned coordinates' unit vectors.
    pub turn: DMatrix<f64>,
    /// (-) Revolutions of the pinion per revolution of the gear.
    pub ratio: f64,
    /// (kg) Mass that the wheels' rotation has along the line of action, `1/(Rb_g²/J_g + Rb_p²/J_p)`.
    pub mesh_mass_kg: f64,
}

/// The mesh as if it were closed always, with its mean stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedMesh {
    /// (N/m) Stiffness along the line of action.
    pub stiffness_n_per_m: f64,
    /// (s) Damping over stiffness.
    pub damping_time_s: f64,
}

/// A mode that decays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DecayingMode {
    /// (Hz) Natural frequency.
    pub(crate) frequency_hz: f64,
    /// (1/s) Rate.
    pub(crate) decay_per_s: f64,
}

/// One elastic part of the machine, with its damping.
struct Part {
    stiffness: DMatrix<f64>,
    damping_ratio: f64,
}

/// Part of the geometric mean of two diagonal entries below which what couples them is rounding.
const ROUNDING: f64 = 1e-12;

impl Structure {
    /// Assembles the machine.
    ///
    /// # Arguments
    /// * `gears` - for the material
    /// * `rig` - shafts, bearings, supports, brake
    /// * `teeth` - both wheels
    ///
    /// A mode's damping is that of the parts, weighted by their strain energy: C. D. Johnson, D. A. Kienholz, AIAA Journal 20
    /// (1982).
    pub fn new(gears: &Gears, rig: &Rig, teeth: &Teeth) -> Self {
        let body = |wheel, given| WheelBody::new(wheel, gears.material, given, Model::Contact);
        let pinion = body(&teeth.pinion, &rig.pinion_inertia);
        let gear = body(&teeth.gear, &rig.gear_inertia);
        let mut mass_diagonal = masses(&pinion, &gear, rig).to_vec();
        mass_diagonal.resize(COORDINATES_WITH_SUPPORTS, rig.support.mass_kg);
        let torsion =
            [torsional_stiffness(&rig.pinion_shaft, gears), torsional_stiffness(&rig.gear_shaft, gears)];
        let directions = MeshDirections::new(&teeth.pinion, &teeth.gear);
        let turn = turn_with_supports(&directions);
        let mut parts = [
            bent_shaft(WheelName::Gear, rig, gears),
            bent_shaft(WheelName::Pinion, rig, gears),
            twisted_shaft(
                &[(THETA_GEAR, 1.0), (THETA_BRAKE, -1.0)],
                torsion[1],
                rig.gear_shaft.damping_ratio,
            ),
            twisted_shaft(&[(THETA_PINION, 1.0)], torsion[0], rig.pinion_shaft.damping_ratio),
            supports(&rig.support),
        ];
        for part in &mut parts {
            part.stiffness = without_rounding(turn.transpose() * &part.stiffness * &turn);
        }
        let stiffness = parts.iter().fold(zeros(), |sum, part| sum + &part.stiffness);
        let modes = mass_normalised_modes(&mass_diagonal, &stiffness);
        let mut angular_frequencies: Vec<f64> = modes.iter().map(|(frequency, _)| *frequency).collect();
        // Nothing holds the driven train but the mesh; what is not 0 is rounding.
        angular_frequencies[0] = 0.0;
        let shapes = DMatrix::from_columns(&modes.into_iter().map(|(_, shape)| shape).collect::<Vec<_>>());
        let damping_ratio = (0..COORDINATES_WITH_SUPPORTS)
            .map(|n| {
                let shape = shapes.column(n);
                let energy = |part: &Part| (&part.stiffness * shape).dot(&shape);
                let whole: f64 = parts.iter().map(energy).sum();
                let damped: f64 = parts.iter().map(|part| part.damping_ratio * energy(part)).sum();
                if angular_frequencies[n] > 0.0 { damped / whole } else { 0.0 }
            })
            .collect();
        let [flat, _, rotation, tilt, _] = &directions.turned;
        let of_rotation =
            |wheel: &Wheel, body: &WheelBody| (wheel.base_radius_mm * 1e-3).powi(2) / body.polar_kgm2;
        Self {
            mesh_mass_kg: 1.0 / (of_rotation(&teeth.pinion, &pinion) + of_rotation(&teeth.gear, &gear)),
            pinion,
            gear,
            mass_diagonal,
            shaft_stiffness_nm_per_rad: torsion,
            stiffness,
            angular_frequencies,
            shapes,
            damping_ratio,
            line_of_action: [with_supports(&(flat + rotation)), with_supports(tilt)],
            turn,
            ratio: f64::from(gears.gear_teeth) / f64::from(gears.pinion_teeth),
        }
    }

    /// (1/s) `2 ζ ω` of mode `n` without the mesh.
    pub fn modal_damping(&self, n: usize) -> f64 {
        2.0 * self.damping_ratio[n] * self.angular_frequencies[n]
    }

    /// (Hz) Natural frequencies, rising, and mass-normalised shapes in the 17 coordinates, a column each, with the mesh closed.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of the closed mesh along the line of action
    pub fn closed_modes(&self, mesh_stiffness_n_per_m: f64) -> (Vec<f64>, DMatrix<f64>) {
        let modes = self.turned_closed_modes(mesh_stiffness_n_per_m);
        let frequencies = modes.iter().map(|(omega, _)| omega / (2.0 * PI)).collect();
        let shapes = DMatrix::from_columns(&modes.into_iter().map(|(_, shape)| shape).collect::<Vec<_>>());
        (frequencies, &self.turn * shapes)
    }

    /// (rad/s) Natural angular frequencies and shapes with the mesh closed, in turned coordinates.
    fn turned_closed_modes(&self, mesh_stiffness_n_per_m: f64) -> Vec<(f64, DVector<f64>)> {
        let line = &self.line_of_action[0];
        let closed = &self.stiffness + line * line.transpose() * mesh_stiffness_n_per_m;
        mass_normalised_modes(&self.mass_diagonal, &closed)
    }

    /// The slowest to decay of the modes that the mesh moves, with the mesh closed: at the rate `φᵀ C φ/2`, as if damping did not
    /// couple modes.
    ///
    /// # Arguments
    /// * `mesh` - the closed mesh
    pub(crate) fn slowest_mode(&self, mesh: &ClosedMesh) -> DecayingMode {
        let line = &self.line_of_action[0];
        let mass = DVector::from_column_slice(&self.mass_diagonal);
        let modes = self.turned_closed_modes(mesh.stiffness_n_per_m);
        let decay_per_s = |shape: &DVector<f64>| {
            let own = self.shapes.transpose() * shape.component_mul(&mass);
            let structural: f64 = (0..own.len()).map(|n| self.modal_damping(n) * own[n] * own[n]).sum();
            let deflection = line.dot(shape);
            (structural + mesh.stiffness_n_per_m * mesh.damping_time_s * deflection * deflection) / 2.0
        };
        let largest = modes.iter().map(|(_, shape)| line.dot(shape).abs()).fold(0.0, f64::max);
        let moved = modes.iter().filter(|(_, shape)| line.dot(shape).abs() > ROUNDING * largest);
        let decaying = moved.map(|(omega, shape)| DecayingMode {
            frequency_hz: omega / (2.0 * PI),
            decay_per_s: decay_per_s(shape),
        });
        let none = DecayingMode { frequency_hz: 0.0, decay_per_s: f64::INFINITY };
        decaying
            .fold(none, |slowest, mode| if mode.decay_per_s < slowest.decay_per_s { mode } else { slowest })
    }

    /// (rad/(N m)) How far a moment of the mesh's force about the middle of the face tilts the wheels against one another, at rest.
    pub(crate) fn tilt_rad_per_nm(&self) -> f64 {
        let tilt = self.shapes.transpose() * &self.line_of_action[1];
        let yields = tilt.iter().zip(&self.angular_frequencies).filter(|(_, omega)| **omega > 0.0);
        yields.map(|(tilt, omega)| (tilt / omega).powi(2)).sum()
    }

    /// Damping matrix without the mesh, in the 17 coordinates, `C = M Σ_n 2 ζ_n ω_n φ_n φ_nᵀ M`.
    pub fn damping_matrix(&self) -> DMatrix<f64> {
        let mass = DMatrix::from_diagonal(&DVector::from_column_slice(&self.mass_diagonal));
        let mass_shapes = &self.turn * mass * &self.shapes;
        let modal = DVector::from_fn(COORDINATES_WITH_SUPPORTS, |n, _| self.modal_damping(n));
        &mass_shapes * DMatrix::from_diagonal(&modal) * mass_shapes.transpose()
    }

    /// Stiffness matrix without the mesh, in the 17 coordinates.
    pub fn stiffness_matrix(&self) -> DMatrix<f64> {
        &self.turn * &self.stiffness * self.turn.transpose()
    }

    /// Stiffness matrix with the mesh closed, in the 17 coordinates.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of the closed mesh along the line of action
    pub fn closed_stiffness_matrix(&self, mesh_stiffness_n_per_m: f64) -> DMatrix<f64> {
        let line = &self.turn * &self.line_of_action[0];
        self.stiffness_matrix() + &line * line.transpose() * mesh_stiffness_n_per_m
    }

    /// Rigid rotation of the train per unit rotation of the motor, in the 17 coordinates.
    pub fn rigid_rotation(&self) -> DVector<f64> {
        with_supports(&rigid_rotation(self.ratio))
    }
}

fn zeros() -> DMatrix<f64> {
    DMatrix::zeros(COORDINATES_WITH_SUPPORTS, COORDINATES_WITH_SUPPORTS)
}

/// The wheels' turn, and the same of the supports.
fn turn_with_supports(directions: &MeshDirections) -> DMatrix<f64> {
    let mut turn = zeros();
    for row in 0..COORDINATES {
        for column in 0..COORDINATES {
            turn[(row, column)] = directions.turn[(row, column)];
        }
    }
    for (x, y) in [(X_GEAR_SUPPORT, Y_GEAR_SUPPORT), (X_PINION_SUPPORT, Y_PINION_SUPPORT)] {
        for (row, gear_row) in [(x, X_GEAR), (y, Y_GEAR)] {
            for (column, gear_column) in [(x, X_GEAR), (y, Y_GEAR)] {
                turn[(row, column)] = directions.turn[(gear_row, gear_column)];
            }
        }
    }
    turn
}

/// `k · v vᵀ` of a few coordinates.
fn add_spring(stiffness: &mut DMatrix<f64>, stretch: &[(usize, f64)], n_per_m: f64) {
    for &(row, of_row) in stretch {
        for &(column, of_column) in stretch {
            stiffness[(row, column)] += n_per_m * of_row * of_column;
        }
    }
}

/// The shaft and bearings of a wheel: deflection relative to its support, slope, and the axial stiffness.
///
/// Along the shaft x grows by ψ and y falls by φ.
fn bent_shaft(wheel: WheelName, rig: &Rig, gears: &Gears) -> Part {
    let shaft = rig.shaft(wheel);
    let bearing = shaft.bearing_stiffness_n_per_m.unwrap_or(rig.bearing_stiffness_n_per_m);
    let flexibility = wheel_flexibility(shaft, bearing, gears.material);
    let [x, y, z, phi, psi, x_support, y_support] = match wheel {
        WheelName::Gear => [X_GEAR, Y_GEAR, Z_GEAR, PHI_GEAR, PSI_GEAR, X_GEAR_SUPPORT, Y_GEAR_SUPPORT],
        WheelName::Pinion => {
            [X_PINION, Y_PINION, Z_PINION, PHI_PINION, PSI_PINION, X_PINION_SUPPORT, Y_PINION_SUPPORT]
        }
    };
    let mut stiffness = zeros();
    // The inverse of a 2 × 2 flexibility.
    let determinant = flexibility.determinant();
    let (direct, cross, slope) = (
        flexibility[(1, 1)] / determinant,
        -flexibility[(0, 1)] / determinant,
        flexibility[(0, 0)] / determinant,
    );
    for (deflection, support, tilt, sign) in [(x, x_support, psi, 1.0), (y, y_support, phi, -1.0)] {
        let stretch = [(deflection, 1.0), (support, -1.0)];
        add_spring(&mut stiffness, &stretch, direct);
        stiffness[(tilt, tilt)] += slope;
        for (coordinate, of_coordinate) in stretch {
            stiffness[(coordinate, tilt)] += cross * of_coordinate * sign;
            stiffness[(tilt, coordinate)] += cross * of_coordinate * sign;
        }
    }
    stiffness[(z, z)] += bearing;
    Part { stiffness, damping_ratio: shaft.damping_ratio }
}

fn twisted_shaft(twist: &[(usize, f64)], stiffness_nm_per_rad: f64, damping_ratio: f64) -> Part {
    let mut stiffness = zeros();
    add_spring(&mut stiffness, twist, stiffness_nm_per_rad);
    Part { stiffness, damping_ratio }
}

fn supports(support: &Support) -> Part {
    let mut stiffness = zeros();
    for [gear, pinion] in [[X_GEAR_SUPPORT, X_PINION_SUPPORT], [Y_GEAR_SUPPORT, Y_PINION_SUPPORT]] {
        add_spring(&mut stiffness, &[(gear, 1.0)], support.stiffness_n_per_m);
        add_spring(&mut stiffness, &[(pinion, 1.0)], support.stiffness_n_per_m);
        add_spring(&mut stiffness, &[(gear, 1.0), (pinion, -1.0)], support.coupling_n_per_m);
    }
    Part { stiffness, damping_ratio: support.damping_ratio }
}

/// A symmetric matrix without the couplings that only rounding makes: coordinates that they do not connect stay apart.
fn without_rounding(matrix: DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |r, c| {
        let both = (matrix[(r, c)] + matrix[(c, r)]) / 2.0;
        let scale = (matrix[(r, r)] * matrix[(c, c)]).abs().sqrt();
        if both.abs() <= ROUNDING * scale { 0.0 } else { both }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Shaft;
    use crate::wheel::teeth;

    fn structure(rig: &Rig) -> Structure {
        let gears = Gears::new(3.0, 17, 38, 15.0);
        Structure::new(&gears, rig, &teeth(&gears, [10.0; 2], Model::Contact))
    }

    #[test]
    fn turns_freely_without_the_mesh() {
        let structure = structure(&Rig::default());
        let free = structure.angular_frequencies.iter().filter(|omega| **omega == 0.0).count();
        assert_eq!(free, 1);
        let shape = structure.shapes.column(0);
        assert!((shape[THETA_GEAR] / shape[THETA_BRAKE] - 1.0).abs() < 1e-6);
        assert!(structure.angular_frequencies[1] > 1.0);
        // Damping only where parts deform.
        assert_eq!(structure.damping_ratio[0], 0.0);
        assert!(structure.damping_ratio[1..].iter().all(|ratio| (ratio - 0.025).abs() < 1e-9));
    }

    #[test]
    fn a_force_deflects_shaft_and_supports_in_series() {
        let rig = Rig::default();
        let structure = structure(&rig);
        let flexible =
            wheel_flexibility(&rig.gear_shaft, rig.bearing_stiffness_n_per_m, Default::default())[(0, 0)];
        let Support { stiffness_n_per_m: base, coupling_n_per_m: between, .. } = rig.support;
        // One support pushed: base and, through the other, coupling in series with its base.
        let support = 1.0 / (base + 1.0 / (1.0 / between + 1.0 / base));
        let mut stiffness = structure.stiffness_matrix();
        stiffness[(THETA_BRAKE, THETA_BRAKE)] += 1.0;
        let mut force = DVector::zeros(COORDINATES_WITH_SUPPORTS);
        force[Y_GEAR] = 1.0;
        let deflection = stiffness.lu().solve(&force).unwrap();
        assert!((deflection[Y_GEAR] / (flexible + support) - 1.0).abs() < 1e-6);
        assert!(deflection[X_GEAR].abs() < 1e-9 * deflection[Y_GEAR]);
    }

    /// A wheel nearer to the bearing at negative z tilts so that x and y grow along the shaft: ψ positive, φ negative.
    #[test]
    fn a_force_on_a_wheel_off_the_middle_tilts_it() {
        let shaft = Shaft { wheel_at: 0.3, ..Shaft::new(600.0, 10.0) };
        let structure = structure(&Rig { gear_shaft: shaft, ..Rig::default() });
        let mut stiffness = structure.stiffness_matrix();
        stiffness[(THETA_BRAKE, THETA_BRAKE)] += 1.0;
        let solved = stiffness.lu();
        for (pushed, tilted, sign) in [(X_GEAR, PSI_GEAR, 1.0), (Y_GEAR, PHI_GEAR, -1.0)] {
            let mut force = DVector::zeros(COORDINATES_WITH_SUPPORTS);
            force[pushed] = 1.0;
            let deflection = solved.solve(&force).unwrap();
            assert!(deflection[pushed] > 0.0 && sign * deflection[tilted] > 0.0);
        }
    }

    #[test]
    fn shapes_are_mass_normalised_and_the_line_of_action_turns_back() {
        let structure = structure(&Rig {
            pinion_shaft: Shaft { wheel_at: 0.3, ..Shaft::new(200.0, 10.0) },
            ..Rig::default()
        });
        let mass = DMatrix::from_diagonal(&DVector::from_column_slice(&structure.mass_diagonal));
        let unit = structure.shapes.transpose() * mass * &structure.shapes;
        assert!((unit - DMatrix::identity(17, 17)).amax() < 1e-9);
        let (sin, cos) = 20f64.to_radians().sin_cos();
        let line = &structure.turn * &structure.line_of_action[0];
        let expected =
            [(X_GEAR, sin), (Y_GEAR, cos), (X_PINION, -sin), (Y_PINION, -cos), (X_GEAR_SUPPORT, 0.0)];
        assert!(expected.iter().all(|&(n, value)| (line[n] - value).abs() < 1e-12));
        let tilt = &structure.turn * &structure.line_of_action[1];
        let expected = [(PHI_GEAR, -cos), (PHI_PINION, cos), (PSI_GEAR, sin), (PSI_PINION, -sin)];
        assert!(expected.iter().all(|&(n, value)| (tilt[n] - value).abs() < 1e-12));
    }
}
