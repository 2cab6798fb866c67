//! The ripple of the path from one place to another over frequency.

use crate::random::{Draws, Purpose};

/// (Hz) Where the ripple begins; it is the same below.
const FIRST_HZ: f64 = 16.0;
/// Draws of the ripple in an octave.
const DRAWS_PER_OCTAVE: f64 = 2.0;
/// Octaves that are drawn: to a megahertz.
const OCTAVES: usize = 16;
/// (-) How far the lines of one binomial series are from their middle, over its frequency.
const SERIES_REACH: f64 = 1.0 / 64.0;
/// (-) Distance of steep lines from their middle, over its frequency, times the power of the frequency that they are: the terms fall by
/// as much each.
const STEEP_REACH: f64 = 1.0 / 12.0;
/// Its terms.
const SERIES_TERMS: usize = 9;

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
        let (index, part) = self.place(hz);
        self.db[index] + part * (self.db[index + 1] - self.db[index])
    }

    /// (-) The gains at equally spaced frequencies from 0 on, as factors: `10^(db/20)`.
    ///
    /// A straight line over the logarithm of the frequency is a power of the frequency. It is summed as a binomial series around the
    /// middle of some lines at a time, to 1e-13 of itself: a logarithm and a power of each line would take longer than the transform
    /// that they are for.
    ///
    /// # Arguments
    /// * `step_hz` - (Hz) from one frequency to the next; positive
    /// * `count` - how many
    ///
    /// ```
    /// let ripple = meshtone::sensor::PathRipple::new(1, 0, 3.0);
    /// let gains = ripple.gains(10.0, 200);
    /// assert!((20.0 * gains[150].log10() - ripple.db_at(1500.0)).abs() < 1e-11);
    /// ```
    pub fn gains(&self, step_hz: f64, count: usize) -> Vec<f64> {
        let mut gains = Vec::with_capacity(count);
        while gains.len() < count {
            let first = gains.len();
            let (db_per_octave, to_hz) = self.line(first as f64 * step_hz);
            let power = db_per_octave / (20.0 * std::f64::consts::LOG10_2);
            let reach = SERIES_REACH.min(STEEP_REACH / power.abs());
            // The line after the last of those that are on one straight line and near enough to each other.
            let end = (first as f64 * (1.0 + 2.0 * reach)).min(to_hz / step_hz).ceil() as usize;
            let end = end.clamp(first + 1, count);
            let middle = (first + end - 1) as f64 / 2.0;
            let at_middle = libm::pow(10.0, self.db_at(middle * step_hz) / 20.0);
            if end == first + 1 {
                gains.push(at_middle);
                continue;
            }
            let mut coefficients = [at_middle; SERIES_TERMS];
            for k in 1..SERIES_TERMS {
                coefficients[k] = coefficients[k - 1] * (power - (k - 1) as f64) / k as f64;
            }
            gains.extend((first..end).map(|line| {
                let off = (line as f64 - middle) / middle;
                coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * off + coefficient)
            }));
        }
        gains
    }

    /// (dB in an octave) How the straight line rises that starts at a frequency or goes through it, and (Hz) where it ends.
    fn line(&self, hz: f64) -> (f64, f64) {
        let last_hz = self.knot_hz(self.db.len() - 1);
        if hz < FIRST_HZ || hz >= last_hz {
            return (0.0, if hz < FIRST_HZ { FIRST_HZ } else { f64::INFINITY });
        }
        let (index, _) = self.place(hz);
        (DRAWS_PER_OCTAVE * (self.db[index + 1] - self.db[index]), self.knot_hz(index + 1))
    }

    fn knot_hz(&self, index: usize) -> f64 {
        FIRST_HZ * libm::exp2(index as f64 / DRAWS_PER_OCTAVE)
    }

    /// The knot below a frequency, and what part of the way to the next one it is.
    fn place(&self, hz: f64) -> (usize, f64) {
        let last = (self.db.len() - 1) as f64;
        let place = (DRAWS_PER_OCTAVE * libm::log2(hz.max(FIRST_HZ) / FIRST_HZ)).min(last);
        let index = (place as usize).min(self.db.len() - 2);
        (index, place - index as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few lines and many to an octave, from below the first knot to beyond the last.
    #[test]
    fn gains_are_those_of_each_frequency() {
        for (seed, deviation_db) in [(7, 0.0), (7, 3.0), (8, 10.0), (9, 40.0), (10, 40.0)] {
            let ripple = PathRipple::new(seed, 1, deviation_db);
            for (step_hz, count) in
                [(0.37, 40_000), (16.0, 3000), (900.0, 2000), (5000.0, 3), (1.0, 1), (1.0, 0)]
            {
                let gains = ripple.gains(step_hz, count);
                assert_eq!(gains.len(), count);
                for (line, gain) in gains.iter().enumerate() {
                    let expected = libm::pow(10.0, ripple.db_at(line as f64 * step_hz) / 20.0);
                    assert!(
                        (gain / expected - 1.0).abs() < 2e-12,
                        "{line} of {step_hz} Hz, {deviation_db} dB"
                    );
                }
            }
        }
    }
}
