//! Contact of the teeth, by the force between them.

use serde::Serialize;

/// Contact of the teeth of a mesh over the kept time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[non_exhaustive]
pub struct ContactFigures {
    /// (-) Part of the time in which no teeth touched.
    pub apart_fraction: f64,
    /// (-) Part of the time in which coast flanks touched.
    pub back_flank_fraction: f64,
    /// Number of hits of coast flanks.
    pub back_flank_hits: usize,
    /// (N) Largest force, of either sign.
    #[serde(rename = "largest_n")]
    pub largest_force_n: f64,
}

impl ContactFigures {
    /// The figures of one mesh.
    ///
    /// # Arguments
    /// * `force` - (N) along its line of action, 0 where no teeth touch, negative where coast flanks do
    ///
    /// ```
    /// use meshtone::sensor::ContactFigures;
    ///
    /// let figures = ContactFigures::of_force(&[180.0, 0.0, -20.0, -35.0, 0.0, 0.0, -5.0, 210.0]);
    /// assert_eq!((figures.apart_fraction, figures.back_flank_fraction), (0.375, 0.375));
    /// assert_eq!((figures.back_flank_hits, figures.largest_force_n), (2, 210.0));
    /// ```
    pub fn of_force(force: &[f64]) -> Self {
        let part = |is: fn(f64) -> bool| {
            force.iter().filter(|&&force| is(force)).count() as f64 / force.len().max(1) as f64
        };
        let before = std::iter::once(&0.0).chain(force);
        Self {
            apart_fraction: part(|force| force == 0.0),
            back_flank_fraction: part(|force| force < 0.0),
            back_flank_hits: before.zip(force).filter(|(before, now)| **before >= 0.0 && **now < 0.0).count(),
            largest_force_n: force.iter().fold(0.0, |largest, force| force.abs().max(largest)),
        }
    }
}
