//! The mesh over its cycle, as a step needs it.

use nalgebra::{DMatrix, DVector};

use crate::mesh::forcing::ForcingBlock;
use crate::mesh::load_state::DirectionMatrix;
use crate::simd::{Instructions, Lanes};

/// What a step needs at one point of the cycle; with `y` the deflection in the mesh's directions and `f` the
/// deviations' force, the mesh's force on the modes is `B w`, `w = −(f + S' y)`.
#[derive(Clone, Copy)]
pub(crate) struct MeshPoint<const R: usize> {
    /// (N/m) `S' = S − S_mean`.
    pub(crate) deviation: [[f64; R]; R],
    /// (-) `(1 + S' Γ)⁻¹`, Γ the step's own compliance: `w = −(1 + S' Γ)⁻¹ (f + S' ŷ)` with ŷ the deflection at
    /// `w = 0`. This is Woodbury's identity for `K̂⁻¹`.
    pub(crate) relief: [[f64; R]; R],
}

/// What a law of tables takes of the forcing at one sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TabulatedSample<const L: usize, const R: usize> {
    /// (N) Force of the flanks' deviations in the mesh's directions.
    pub(crate) errors: [Lanes<L>; R],
    /// Entries of the mesh's tables, where they are known beforehand.
    pub(crate) entries: [u32; L],
}

impl<const L: usize, const R: usize> TabulatedSample<L, R> {
    pub(crate) const NOTHING: Self = Self { errors: [Lanes([0.0; L]); R], entries: [0; L] };

    /// Spreads a block over one lane of successive samples.
    pub(crate) fn fill(samples: &mut [Self], lane: usize, block: &ForcingBlock) {
        for (r, errors) in block.errors.iter().enumerate() {
            for (sample, error) in samples.iter_mut().zip(errors) {
                sample.errors[r].0[lane] = *error;
            }
        }
        for (sample, entry) in samples.iter_mut().zip(&block.entries) {
            sample.entries[lane] = *entry;
        }
    }
}

/// Which of the mesh's constant directions are used, and what a step makes of a force in them.
pub(crate) struct Reduction<'a> {
    /// The directions.
    pub(crate) directions: &'a [usize],
    /// (N/m) Mean of `S` over the cycle, in them.
    pub(crate) mean_stiffness: &'a DMatrix<f64>,
    /// (m/N) Γ: deflection in each direction, at the end of a step, per force in each.
    pub(crate) compliance: &'a DMatrix<f64>,
}

/// Points of one simulation's mesh.
pub(crate) struct MeshTable<const R: usize> {
    pub(crate) points: Vec<MeshPoint<R>>,
}

impl<const R: usize> MeshTable<R> {
    /// Tabulates the mesh.
    ///
    /// # Arguments
    /// * `reduction` - directions and the step's compliance
    /// * `stiffness` - (N/m) `S` at each point, in the constant directions
    pub(crate) fn new(reduction: &Reduction, stiffness: impl Iterator<Item = DirectionMatrix>) -> Self {
        Self { points: stiffness.map(|stiffness| point(reduction, &stiffness)).collect() }
    }
}

fn point<const R: usize>(reduction: &Reduction, stiffness: &DirectionMatrix) -> MeshPoint<R> {
    let columns = reduction.directions.len();
    let mut entry = MeshPoint { deviation: [[0.0; R]; R], relief: [[0.0; R]; R] };
    for r in 0..R {
        entry.relief[r][r] = 1.0;
    }
    for r in 0..columns {
        for c in 0..columns {
            entry.deviation[r][c] = stiffness[(reduction.directions[r], reduction.directions[c])]
                - reduction.mean_stiffness[(r, c)];
        }
    }
    if columns == 1 {
        entry.relief[0][0] = 1.0 / (1.0 + entry.deviation[0][0] * reduction.compliance[(0, 0)]);
        return entry;
    }
    if let Some(relief) = relief(&deviation_matrix(&entry, columns), reduction.compliance) {
        for r in 0..columns {
            for c in 0..columns {
                entry.relief[r][c] = relief[(r, c)];
            }
        }
    }
    entry
}

fn deviation_matrix<const R: usize>(point: &MeshPoint<R>, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(columns, columns, |r, c| point.deviation[r][c])
}

/// `(1 + S' Γ)⁻¹`; the stiffness is positive definite, so the inverse exists.
fn relief(deviation: &DMatrix<f64>, compliance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    (DMatrix::identity(deviation.nrows(), deviation.nrows()) + deviation * compliance).try_inverse()
}

impl<const R: usize> MeshPoint<R> {
    /// (N) The mesh's force on a state that is given: `w = −(f + S' y)`.
    pub(crate) fn force_on(&self, errors: &[f64; R], deflection: &[f64; R]) -> [f64; R] {
        std::array::from_fn(|r| {
            let carried = (0..R).map(|c| self.deviation[r][c] * deflection[c]);
            -(errors[r] + carried.sum::<f64>())
        })
    }

    /// (N) The mesh's force in a static equilibrium: `w = −(1 + S' Γ₀)⁻¹ (f + S' y₀)`.
    ///
    /// # Arguments
    /// * `errors` - (N) `f`
    /// * `deflection` - (m) y₀, the deflection without it
    /// * `compliance` - (m/N) Γ₀, of the machine at rest
    pub(crate) fn static_force(
        &self,
        errors: &[f64; R],
        deflection: &DVector<f64>,
        compliance: &DMatrix<f64>,
    ) -> DVector<f64> {
        let columns = deflection.len();
        let deviation = deviation_matrix(self, columns);
        let load = DVector::from_fn(columns, |r, _| errors[r]) + &deviation * deflection;
        relief(&deviation, compliance).map_or_else(|| DVector::zeros(columns), |relief| -(relief * load))
    }
}

/// `w = −(1 + S' Γ)⁻¹ (f + S' ŷ)`: the mesh force at the end of a step whose deflection is ŷ without it.
#[inline(always)]
pub(super) fn solve<I: Instructions, const L: usize, const R: usize>(
    simd: I,
    tables: &[&MeshTable<R>; L],
    entries: &[usize; L],
    errors: &[Lanes<L>; R],
    deflection: &[Lanes<L>; R],
) -> [Lanes<L>; R] {
    let mut load = *errors;
    for r in 0..R {
        for c in 0..R {
            let deviation = Lanes::from_fn(|l| tables[l].points[entries[l]].deviation[r][c]);
            load[r] = deviation.mul_add(simd, deflection[c], load[r]);
        }
    }
    let mut force = [Lanes::splat(0.0); R];
    for r in 0..R {
        for c in 0..R {
            let relief = Lanes::from_fn(|l| tables[l].points[entries[l]].relief[r][c]);
            force[r] = relief.negative_mul_add(simd, load[c], force[r]);
        }
    }
    force
}
