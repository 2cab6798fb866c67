//! Undamped modes of the mean system.

use nalgebra::{DMatrix, SymmetricEigen};

use super::coordinates::{COORDINATES, CoordinateMatrix, CoordinateVector};
use crate::machine::connected_groups;

/// Natural frequencies and mass-normalised mode shapes, `Φᵀ M Φ = 1`, in rising order.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// (rad/s) Natural angular frequencies.
    pub angular_frequencies: CoordinateVector,
    /// Columns: mode shapes.
    pub shapes: CoordinateMatrix,
}

impl Modes {
    /// Modes of `K φ = ω² M φ` with a diagonal mass matrix. Coordinates that no chain of stiffnesses connects are solved apart, so that
    /// their modes do not mix where frequencies coincide.
    ///
    /// # Arguments
    /// * `mass` - the mass matrix's diagonal
    /// * `stiffness` - symmetric stiffness matrix
    pub(super) fn new(mass: &CoordinateVector, stiffness: &CoordinateMatrix) -> Self {
        let scale = mass.map(|mass| 1.0 / mass.sqrt());
        let mut modes: Vec<(f64, CoordinateVector)> = Vec::with_capacity(COORDINATES);
        for group in connected_groups(COORDINATES, |row, column| stiffness[(row, column)] != 0.0) {
            let scaled = DMatrix::from_fn(group.len(), group.len(), |r, c| {
                let (r, c) = (group[r], group[c]);
                stiffness[(r, c)] * scale[r] * scale[c]
            });
            let eigen = SymmetricEigen::new(scaled);
            for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
                let mut shape = CoordinateVector::zeros();
                for (&coordinate, entry) in group.iter().zip(vector.iter()) {
                    shape[coordinate] = entry * scale[coordinate];
                }
                modes.push((value.max(0.0).sqrt(), shape));
            }
        }
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self {
            angular_frequencies: CoordinateVector::from_fn(|n, _| modes[n].0),
            shapes: CoordinateMatrix::from_fn(|coordinate, n| modes[n].1[coordinate]),
        }
    }
}
