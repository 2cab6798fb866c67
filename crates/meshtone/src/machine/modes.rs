//! Undamped modes of the mean system.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::coordinates::{COORDINATES, CoordinateMatrix, CoordinateVector};

/// Natural frequencies and mass-normalised mode shapes, `Φᵀ M Φ = 1`, in rising order.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// (rad/s) Natural angular frequencies.
    pub angular_frequencies: [f64; COORDINATES],
    /// Columns: mode shapes.
    pub shapes: CoordinateMatrix,
}

impl Modes {
    /// Modes of `K φ = ω² M φ` with a diagonal mass matrix.
    ///
    /// # Arguments
    /// * `mass` - the mass matrix's diagonal
    /// * `stiffness` - symmetric stiffness matrix
    pub fn new(mass: &CoordinateVector, stiffness: &CoordinateMatrix) -> Self {
        let stiffness = DMatrix::from_fn(COORDINATES, COORDINATES, |r, c| stiffness[(r, c)]);
        let modes = mass_normalised_modes(mass.as_slice(), &stiffness);
        let mut angular_frequencies = [0.0; COORDINATES];
        let mut shapes = CoordinateMatrix::zeros();
        for (n, (frequency, shape)) in modes.into_iter().enumerate() {
            angular_frequencies[n] = frequency;
            shapes.set_column(n, &CoordinateVector::from_column_slice(shape.as_slice()));
        }
        Self { angular_frequencies, shapes }
    }
}

/// (rad/s) Natural angular frequencies and mass-normalised shapes of `K φ = ω² M φ` with a diagonal mass matrix, in rising
/// order.
///
/// Coordinates that no chain of stiffnesses connects are solved apart, so that their modes do not mix
/// where frequencies coincide.
///
/// # Arguments
/// * `mass` - the mass matrix's diagonal
/// * `stiffness` - symmetric stiffness matrix
pub(super) fn mass_normalised_modes(mass: &[f64], stiffness: &DMatrix<f64>) -> Vec<(f64, DVector<f64>)> {
    let scale: Vec<f64> = mass.iter().map(|m| 1.0 / m.sqrt()).collect();
    let mut modes: Vec<(f64, DVector<f64>)> = Vec::with_capacity(mass.len());
    for group in connected_groups(stiffness) {
        let n = group.len();
        let scaled = DMatrix::from_fn(n, n, |r, c| {
            stiffness[(group[r], group[c])] * scale[group[r]] * scale[group[c]]
        });
        let eigen = SymmetricEigen::new(scaled);
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            let mut shape = DVector::zeros(mass.len());
            for (&coordinate, entry) in group.iter().zip(vector.iter()) {
                shape[coordinate] = entry * scale[coordinate];
            }
            modes.push((value.max(0.0).sqrt(), shape));
        }
    }
    modes.sort_by(|a, b| a.0.total_cmp(&b.0));
    modes
}

/// Groups of coordinates that are connected by non-zero entries.
fn connected_groups(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let mut seen = vec![false; matrix.nrows()];
    let mut groups = Vec::new();
    for first in 0..matrix.nrows() {
        if seen[first] {
            continue;
        }
        seen[first] = true;
        let mut group = vec![first];
        let mut next = 0;
        while next < group.len() {
            let row = group[next];
            next += 1;
            for column in 0..matrix.nrows() {
                if !seen[column] && matrix[(row, column)] != 0.0 {
                    seen[column] = true;
                    group.push(column);
                }
            }
        }
        groups.push(group);
    }
    groups
}
