//! Points in the unit cube that values are drawn at.
//!
//! Any point can be computed without the points before it, so that a record depends on its number alone.

mod normal;
mod permutation;

pub use normal::{normal_distribution, normal_quantile};
pub use permutation::permuted;

use meshtone::random::{Draws, Purpose};

/// A way in which points fill the cube.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Design {
    /// Each point by itself.
    Independent,
    /// Every axis has as many layers as there are points, and each layer has one point.
    ///
    /// Source: M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979) 239–245.
    LatinHypercube,
    /// Sobol's sequence, scrambled anew after every 65 536 points.
    ///
    /// Sources: I. M. Sobol', USSR Comput. Math. Math. Phys. 7 (1967) 86–112; B. Burley, "Practical hash-based Owen
    /// scrambling", J. Comput. Graph. Tech. 9(4) (2020).
    #[default]
    Sobol,
}

meshtone_toml::named!(Design {
    Independent = "independent",
    LatinHypercube = "latin-hypercube",
    Sobol = "sobol",
});

/// Number of points after which Sobol's sequence, as it is computed here, is exhausted.
const SOBOL_BITS: u32 = 16;
const SOBOL_DIMENSIONS: usize = 256;
/// Index from which the seeds of blocks of Sobol's sequence are drawn, beyond those of the attempts.
const BLOCKS: u64 = 1 << 32;

/// The points of one design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Points {
    /// How they fill the cube.
    pub design: Design,
    /// Seed of the design.
    pub seed: u64,
    /// Purpose of the draws.
    pub purpose: Purpose,
    /// How many points there are.
    pub count: u64,
}

impl Points {
    /// A point; coordinates are from 0 to less than 1.
    ///
    /// # Arguments
    /// * `index` - its number, below [`Self::count`]
    /// * `attempt` - 0, or more where the point of an earlier attempt broke a constraint: another design of the same kind
    /// * `dimensions` - of the cube
    ///
    /// ```
    /// use meshtone::random::Purpose;
    /// use meshtone_dataset::sampling::{Design, Points};
    ///
    /// let points = Points { design: Design::LatinHypercube, seed: 1, purpose: Purpose::DatasetUnit, count: 10 };
    /// let mut layers: Vec<u32> = (0..10).map(|i| (points.point(i, 0, 3)[2] * 10.0) as u32).collect();
    /// layers.sort();
    /// assert_eq!(layers, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
    /// ```
    pub fn point(&self, index: u64, attempt: u32, dimensions: usize) -> Vec<f64> {
        let seed = match attempt {
            0 => self.seed,
            _ => Draws::new(self.seed, Purpose::DatasetDesign, u64::from(attempt)).bits(),
        };
        let mut draws = Draws::new(seed, self.purpose, index);
        // Rounding must not give 1.
        let mut uniform = || draws.uniform(0.5, 0.5).min(1.0 - f64::EPSILON);
        match self.design {
            Design::Independent => (0..dimensions).map(|_| uniform()).collect(),
            Design::LatinHypercube => {
                let count = self.count.max(1);
                let layer = |axis: usize| permuted(index % count, count, seed ^ (axis as u64 + 1));
                (0..dimensions)
                    .map(|axis| ((layer(axis) as f64 + uniform()) / count as f64).min(1.0 - f64::EPSILON))
                    .collect()
            }
            Design::Sobol => (0..dimensions).map(|axis| sobol(seed, index, axis)).collect(),
        }
    }
}

fn sobol(seed: u64, index: u64, axis: usize) -> f64 {
    let block = (index >> SOBOL_BITS) * SOBOL_DIMENSIONS as u64 + (axis / SOBOL_DIMENSIONS) as u64;
    let scrambling = Draws::new(seed, Purpose::DatasetDesign, BLOCKS + block).bits() as u32;
    let number = (index & ((1 << SOBOL_BITS) - 1)) as u32;
    f64::from(sobol_burley::sample(number, (axis % SOBOL_DIMENSIONS) as u32, scrambling))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(design: Design) -> Points {
        Points { design, seed: 5, purpose: Purpose::DatasetRecord, count: 256 }
    }

    /// Largest difference between the part of points below a bound and the bound, over both axes.
    fn discrepancy(points: Points, count: u64, attempt: u32) -> f64 {
        let mut largest = 0.0f64;
        for axis in 0..2 {
            let mut values: Vec<f64> = (0..count).map(|i| points.point(i, attempt, 2)[axis]).collect();
            values.sort_by(f64::total_cmp);
            for (rank, value) in values.iter().enumerate() {
                assert!((0.0..1.0).contains(value));
                largest = largest.max((value - (rank as f64 + 0.5) / count as f64).abs());
            }
        }
        largest
    }

    #[test]
    fn layered_designs_fill_evenly() {
        let layer = 1.0 / 256.0;
        assert!(discrepancy(points(Design::LatinHypercube), 256, 0) <= layer);
        assert!(discrepancy(points(Design::Sobol), 256, 0) <= layer);
        assert!(discrepancy(points(Design::Sobol), 256, 7) <= layer);
        assert!(discrepancy(points(Design::Independent), 256, 0) > 2.0 * layer);
    }

    #[test]
    fn sobol_goes_on_beyond_its_last_point() {
        let later = Points { count: 1 << 20, ..points(Design::Sobol) };
        let block = |first: u64| (first..first + 4).map(|i| later.point(i, 0, 1)[0]).collect::<Vec<_>>();
        assert_ne!(block(0), block(1 << 16));
        assert!(block(1 << 19).iter().all(|value| (0.0..1.0).contains(value)));
    }

    #[test]
    fn attempts_and_seeds_give_other_points() {
        for (_, design) in Design::NAMES {
            let points = points(design);
            assert_eq!(points.point(3, 0, 4), points.point(3, 0, 4));
            assert_ne!(points.point(3, 0, 4), points.point(3, 1, 4));
            assert_ne!(points.point(3, 0, 4), Points { seed: 6, ..points }.point(3, 0, 4));
        }
    }
}
