//! Undamped modes of a machine, and their damping.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::parts::{Machine, Spring};
use crate::known::Known;

/// Modes of a machine without its meshes, in rising order, in turned coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// (rad/s) Natural angular frequencies; 0 of a shaft that nothing but a mesh holds.
    pub angular_frequencies: Vec<f64>,
    /// Mass-normalised shapes, a column each: `Φᵀ M Φ = 1`.
    pub shapes: DMatrix<f64>,
    /// (-) Damping ratio of each mode.
    pub damping_ratio: Vec<f64>,
}

/// A mesh as if it were closed always, with its mean stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosedMesh {
    /// (N/m) Stiffness along the line of action.
    pub stiffness_n_per_m: f64,
    /// (s) Damping over stiffness.
    pub damping_time_s: f64,
}

/// A mode that decays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DecayingMode {
    /// (Hz) Natural frequency.
    pub frequency_hz: f64,
    /// (1/s) Rate.
    pub decay_per_s: f64,
}

impl Modes {
    /// Modes whose damping is that of the springs, weighted by their strain energy.
    ///
    /// # Arguments
    /// * `machine` - the machine
    ///
    /// Source: C. D. Johnson, D. A. Kienholz, AIAA Journal 20 (1982).
    pub fn damped_by_springs(machine: &Machine) -> Self {
        if let [spring] = &machine.springs[..] {
            return Self::damped_alike(machine, spring.damping_ratio);
        }
        let mut modes = Self::undamped(machine);
        let springs: Vec<(&Spring, Vec<usize>)> =
            machine.springs.iter().map(|spring| (spring, spring.coordinates())).collect();
        let mut force = DVector::zeros(machine.mass.nrows());
        modes.damping_ratio = (0..modes.damping_ratio.len())
            .map(|n| {
                let shape = modes.shapes.column(n);
                let mut energy = |(spring, coordinates): &(&Spring, Vec<usize>)| {
                    for &row in coordinates {
                        let of = |&column: &usize| shape[column] * spring.stiffness[(row, column)];
                        force[row] = coordinates.iter().map(of).sum();
                    }
                    let energy = force.dot(&shape);
                    coordinates.iter().for_each(|&row| force[row] = 0.0);
                    [energy, spring.damping_ratio]
                };
                let energies: Vec<[f64; 2]> = springs.iter().map(&mut energy).collect();
                let whole: f64 = energies.iter().map(|[energy, _]| energy).sum();
                let damped: f64 = energies.iter().map(|[energy, ratio]| ratio * energy).sum();
                if modes.angular_frequencies[n] > 0.0 { damped / whole } else { 0.0 }
            })
            .collect();
        modes
    }

    /// What [`Self::damped_by_springs`] takes of a machine: the entries of its masses and springs that are not 0, each with its place, and before
    /// those of a matrix the number of its entries and the spring's damping ratio.
    ///
    /// # Arguments
    /// * `machine` - the machine
    pub(crate) fn made_of(machine: &Machine) -> Vec<(usize, f64)> {
        let springs = machine.springs.iter().map(|spring| (&spring.stiffness, spring.damping_ratio));
        let matrices = std::iter::once((&machine.mass, 0.0)).chain(springs);
        let parts = matrices.flat_map(|(matrix, damping_ratio)| {
            let entries = matrix.iter().copied().enumerate().filter(|(_, entry)| *entry != 0.0);
            std::iter::once((matrix.len(), damping_ratio)).chain(entries)
        });
        parts.collect()
    }

    /// Modes of one damping ratio; free rotations have none.
    ///
    /// # Arguments
    /// * `machine` - the machine
    /// * `damping_ratio` - (-) of every mode that deforms it
    pub fn damped_alike(machine: &Machine, damping_ratio: f64) -> Self {
        let mut modes = Self::undamped(machine);
        modes.damping_ratio = modes
            .angular_frequencies
            .iter()
            .map(|omega| if *omega > 0.0 { damping_ratio } else { 0.0 })
            .collect();
        modes
    }

    fn undamped(machine: &Machine) -> Self {
        let modes = mass_normalised_modes(&machine.mass, &machine.stiffness());
        let angular_frequencies: Vec<f64> = modes.iter().map(|(omega, _)| *omega).collect();
        let shapes = DMatrix::from_columns(&modes.into_iter().map(|(_, shape)| shape).collect::<Vec<_>>());
        Self { damping_ratio: vec![0.0; angular_frequencies.len()], angular_frequencies, shapes }
    }

    /// (1/s) `2 ζ ω` of mode `n`.
    pub fn damping_per_s(&self, n: usize) -> f64 {
        2.0 * self.damping_ratio[n] * self.angular_frequencies[n]
    }

    /// Damping matrix in the coordinates themselves, `C = M Σ_n 2 ζ_n ω_n φ_n φ_nᵀ M`.
    ///
    /// # Arguments
    /// * `machine` - the machine whose modes these are
    pub fn damping_matrix(&self, machine: &Machine) -> DMatrix<f64> {
        let mass_shapes = &machine.turn * &machine.mass * &self.shapes;
        let modal = DVector::from_fn(self.angular_frequencies.len(), |n, _| self.damping_per_s(n));
        &mass_shapes * DMatrix::from_diagonal(&modal) * mass_shapes.transpose()
    }
}

/// Modes of machines, by [`Modes::made_of`]: of the mountings of a data set, at some 0.2 MB each.
pub(crate) type KnownModes = Known<Vec<(usize, f64)>, Modes, 32>;

/// Part of the largest eigenvalue of connected coordinates below which another is rounding, as that of a shaft that turns freely.
const ROUNDING_OF_EIGENVALUES: f64 = 1e-13;

impl Machine {
    /// (Hz) Natural frequencies, rising, and mass-normalised shapes in the coordinates themselves, a column each, with the meshes
    /// closed.
    ///
    /// # Arguments
    /// * `mesh_stiffness_n_per_m` - (N/m) of each mesh along its line of action
    pub fn closed_modes(&self, mesh_stiffness_n_per_m: &[f64]) -> (Vec<f64>, DMatrix<f64>) {
        let modes = mass_normalised_modes(&self.mass, &self.closed_stiffness(mesh_stiffness_n_per_m));
        let frequencies = modes.iter().map(|(omega, _)| omega / TAU).collect();
        let shapes = DMatrix::from_columns(&modes.into_iter().map(|(_, shape)| shape).collect::<Vec<_>>());
        (frequencies, &self.turn * shapes)
    }
}

/// (rad/s) Natural angular frequencies and mass-normalised shapes of `K φ = ω² M φ`, in rising order.
///
/// Coordinates that no chain of stiffnesses and masses connects are solved apart, so that their modes do not mix
/// where frequencies coincide. With `M = L Lᵀ` it is a symmetric problem of `L⁻¹ K L⁻ᵀ`; a diagonal M needs no factors.
///
/// # Arguments
/// * `mass` - symmetric, positive definite mass matrix
/// * `stiffness` - symmetric stiffness matrix
fn mass_normalised_modes(mass: &DMatrix<f64>, stiffness: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    let coordinates = mass.nrows();
    let mut modes: Vec<(f64, DVector<f64>)> = Vec::with_capacity(coordinates);
    let connects = |row, column| stiffness[(row, column)] != 0.0 || mass[(row, column)] != 0.0;
    for group in connected_groups(coordinates, connects) {
        let n = group.len();
        let of_group = |of: &DMatrix<f64>| DMatrix::from_fn(n, n, |r, c| of[(group[r], group[c])]);
        let (own_mass, own_stiffness) = (of_group(mass), of_group(stiffness));
        let factor = (!is_diagonal(&own_mass)).then(|| own_mass.clone().cholesky()).flatten();
        let scale: Vec<f64> = own_mass.diagonal().iter().map(|m| 1.0 / m.sqrt()).collect();
        let scaled = match &factor {
            None => DMatrix::from_fn(n, n, |r, c| own_stiffness[(r, c)] * scale[r] * scale[c]),
            Some(factor) => {
                let lower = factor.l_dirty();
                let mut half = own_stiffness;
                lower.solve_lower_triangular_mut(&mut half);
                half.transpose_mut();
                lower.solve_lower_triangular_mut(&mut half);
                (&half + half.transpose()) / 2.0
            }
        };
        let eigen = SymmetricEigen::new(scaled);
        let rounding = ROUNDING_OF_EIGENVALUES * eigen.eigenvalues.amax();
        let mut shapes = eigen.eigenvectors;
        match &factor {
            None => {
                for (mut row, scale) in shapes.row_iter_mut().zip(&scale) {
                    row *= *scale;
                }
            }
            Some(factor) => {
                factor.l_dirty().tr_solve_lower_triangular_mut(&mut shapes);
            }
        }
        for (value, vector) in eigen.eigenvalues.iter().zip(shapes.column_iter()) {
            let mut shape = DVector::zeros(coordinates);
            for (&coordinate, entry) in group.iter().zip(vector.iter()) {
                shape[coordinate] = *entry;
            }
            modes.push((if *value > rounding { value.sqrt() } else { 0.0 }, shape));
        }
    }
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    modes
}

/// Whether a matrix has nothing beside its diagonal.
fn is_diagonal(matrix: &DMatrix<f64>) -> bool {
    (0..matrix.ncols()).all(|c| (0..matrix.nrows()).all(|r| r == c || matrix[(r, c)] == 0.0))
}

/// Groups of coordinates that chains of stiffnesses connect.
///
/// # Arguments
/// * `coordinates` - how many there are
/// * `connects` - whether a stiffness connects two of them
pub(crate) fn connected_groups(
    coordinates: usize,
    connects: impl Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let mut seen = vec![false; coordinates];
    let mut groups = Vec::new();
    for first in 0..coordinates {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() {
            let row = group[next];
            next += 1;
            for column in 0..coordinates {
                if !seen[column] && connects(row, column) {
                    seen[column] = true;
                    group.push(column);
                }
            }
        }
        groups.push(group);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Masses on springs.
    fn machine(mass_kg: f64, stiffness_n_per_m: f64, damping_ratio: f64) -> Machine {
        let stiffness = DMatrix::identity(4, 4) * stiffness_n_per_m;
        Machine {
            names: vec!["x".into(); 4],
            mass: DMatrix::identity(4, 4) * mass_kg,
            turn: DMatrix::identity(4, 4),
            springs: vec![Spring { stiffness, damping_ratio }],
            lines: Vec::new(),
            bearings: Vec::new(),
            turning_forces: Vec::new(),
            spinning: Vec::new(),
            drives: Vec::new(),
            places: Vec::new(),
            rigid_rotation: DVector::zeros(4),
        }
    }

    #[test]
    fn machines_are_told_apart_by_all_that_their_modes_depend_on() {
        let made_of = |mass_kg, stiffness_n_per_m, damping_ratio| {
            Modes::made_of(&machine(mass_kg, stiffness_n_per_m, damping_ratio))
        };
        let one = made_of(1.0, 1e8, 0.02);
        assert_eq!(one, made_of(1.0, 1e8, 0.02));
        for other in [made_of(2.0, 1e8, 0.02), made_of(1.0, 2e8, 0.02), made_of(1.0, 1e8, 0.03)] {
            assert_ne!(one, other);
        }
        // What stands in another place, or belongs to another spring, is something else.
        let mut moved = machine(1.0, 1e8, 0.02);
        moved.springs[0].stiffness[(0, 1)] = 1e7;
        let mut back = machine(1.0, 1e8, 0.02);
        back.springs[0].stiffness[(1, 0)] = 1e7;
        assert_ne!(Modes::made_of(&moved), Modes::made_of(&back));
        let mut two = machine(1.0, 1e8, 0.02);
        two.springs.push(Spring { stiffness: DMatrix::zeros(4, 4), damping_ratio: 0.02 });
        assert_ne!(one, Modes::made_of(&two));
    }
}
