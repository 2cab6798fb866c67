//! How the path from one place to another passes frequencies differently.

use crate::random::{Draws, Purpose};

/// (Hz) Where the ripple begins; it is the same below.
const FIRST_HZ: f64 = 16.0;
/// Draws of the ripple in an octave.
const DRAWS_PER_OCTAVE: f64 = 2.0;
/// Octaves that are drawn: to a megahertz.
const OCTAVES: usize = 16;

/// Gains in decibels over frequency, drawn at random: normal at half octaves, along straight lines over the logarithm of the
/// frequency between them.
///
/// ```
/// use meshtone::sensor::PathRipple;
///
/// let ripple = PathRipple::new(1, 0, 3.0);
/// assert_eq!(ripple.db_at(100.0), PathRipple::new(1, 0, 3.0).db_at(100.0));
/// assert_eq!(ripple.db_at(5.0), ripple.db_at(16.0)); // the same below
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PathRipple {
    /// At half octaves from [`FIRST_HZ`] on.
    db: Vec<f64>,
}

impl PathRipple {
    /// A path of its own.
    ///
    /// # Arguments
    /// * `seed` - of the mounting
    /// * `channel` - which of its channels
    /// * `deviation_db` - (dB) standard deviation
    pub fn new(seed: u64, channel: u64, deviation_db: f64) -> Self {
        let mut draws = Draws::new(seed, Purpose::PathRipple, channel);
        let count = OCTAVES * DRAWS_PER_OCTAVE as usize + 1;
        let db = (0..count.div_ceil(2)).flat_map(|_| draws.normals()).map(|normal| normal * deviation_db);
        Self { db: db.collect() }
    }

    /// (dB) The gain at a frequency.
    ///
    /// # Arguments
    /// * `hz` - (Hz) the frequency
    pub fn db_at(&self, hz: f64) -> f64 {
        let place =
            (DRAWS_PER_OCTAVE * libm::log2(hz.max(FIRST_HZ) / FIRST_HZ)).min((self.db.len() - 1) as f64);
        let index = (place as usize).min(self.db.len() - 2);
        self.db[index] + (place - index as f64) * (self.db[index + 1] - self.db[index])
    }
}
