//! Whether the sensor or its mounting was changed since the healthy recording: then the orders of all wheels change together.
//!
//! Damage makes the difference signal of its own wheel louder. What lies between the teeth and the recording, a path or a wrong unit, changes those of all wheels
//! alike where their frequencies are alike.

use meshtone_learn::{Ranking, median};

/// What changed alike in the difference signals of all wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonChange {
    /// (-) p-value: the part of the simulations, with damage and with other speeds and loads, in which as much changed alike, or more.
    pub p: f64,
    /// (dB) Least and largest change alike of a band of orders.
    pub within_db: [f64; 2],
}

/// How much changed alike in simulations.
///
/// Level and shape are weighted by their mean squares: loads change the level of everything, and hardly the shape.
pub(crate) struct CommonChanges {
    mean_squares: [f64; 2],
    ranking: Ranking,
}

impl CommonChanges {
    /// Learns how much usually changes alike.
    ///
    /// # Arguments
    /// * `simulations` - what changed alike in each
    pub fn new(simulations: &[&Alike]) -> Self {
        let sum = |at: usize| simulations.iter().map(|of| of.squares()[at]).sum::<f64>();
        let mean = |at: usize| (sum(at) / simulations.len() as f64).max(f64::MIN_POSITIVE);
        let mean_squares = [0, 1].map(mean);
        let ranking = Ranking::new(simulations.iter().map(|of| of.size(mean_squares)));
        Self { mean_squares, ranking }
    }

    /// Compares what changed alike in recordings with the simulations.
    pub fn of(&self, asked: &Alike) -> CommonChange {
        let [least, most] = [f64::min, f64::max].map(|of| asked.shape_db().iter().copied().fold(0.0, of));
        let within_db = [asked.level_db() + least, asked.level_db() + most];
        CommonChange { p: self.ranking.p_value(asked.size(self.mean_squares)), within_db }
    }
}

/// (dB) What changed alike in the difference signals of all wheels since they were healthy: the smallest of their changes, 0 where one is louder and another
/// quieter. First of the medians of the wheels' bands, then of each band of orders beside the median.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Alike(pub Vec<f64>);

impl Alike {
    /// # Arguments
    /// * `wheels` - of each wheel that is seen the mesh frequency, in orders of one shaft, and (log10) how much louder each band about a multiple of it is than
    ///   in the healthy recording
    ///
    /// Returns none of fewer than two wheels.
    pub fn new(wheels: &[(f64, Vec<f64>)]) -> Option<Self> {
        let (coarsest, of_coarsest) =
            wheels.iter().max_by(|a, b| a.0.total_cmp(&b.0)).filter(|_| wheels.len() > 1)?;
        // Damage makes a wheel louder in most bands.
        let medians: Vec<f64> = wheels.iter().map(|(_, louder)| median(louder)).collect();
        let of_band = |band: usize| {
            let order = (band + 1) as f64 * coarsest;
            let of_wheels = wheels.iter().zip(&medians);
            let changes = of_wheels
                .filter_map(|((mesh, louder), median)| Some(between(louder, order / mesh - 1.0)? - median));
            smallest_db(&changes.collect::<Vec<f64>>())
        };
        let level_db = std::iter::once(smallest_db(&medians));
        Some(Self(level_db.chain((0..of_coarsest.len()).map(of_band)).collect()))
    }

    fn level_db(&self) -> f64 {
        self.0[0]
    }

    fn shape_db(&self) -> &[f64] {
        &self.0[1..]
    }

    /// (dB²) Of level and shape.
    fn squares(&self) -> [f64; 2] {
        [self.level_db().powi(2), self.shape_db().iter().map(|db| db * db).sum()]
    }

    fn size(&self, mean_squares: [f64; 2]) -> f64 {
        let [level, shape] = self.squares();
        level / mean_squares[0] + shape / mean_squares[1]
    }
}

/// (dB) The smallest of changes (log10) of one sign, 0 of both signs.
fn smallest_db(changes: &[f64]) -> f64 {
    let [least, most] = [f64::min, f64::max].map(|of| changes.iter().copied().reduce(of).unwrap_or(0.0));
    20.0 * if least > 0.0 { least } else { most.min(0.0) }
}

/// A value between two of equal steps; none beyond the last.
fn between(values: &[f64], place: f64) -> Option<f64> {
    let (below, part) = (place.floor().max(0.0) as usize, place - place.floor());
    let first = values.get(below)?;
    let next = values.get(below + 1).unwrap_or(first);
    Some(first + part * (next - first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_wheel_alone_changes_is_no_change_of_the_mounting() {
        let (path, damage) = ([0.0, 0.6, -0.8, 0.0], [1.0, 1.2, 1.1, 0.9]);
        let quiet = [0.0; 4];
        let of = |a: &[f64], b: &[f64]| Alike::new(&[(20.0, a.to_vec()), (20.0, b.to_vec())]).unwrap();
        assert_eq!(of(&quiet, &damage), Alike(vec![0.0; 5]));
        assert_eq!(of(&path, &path), Alike(vec![0.0, 0.0, 12.0, -16.0, 0.0]));
        let both: Vec<f64> = path.iter().zip(&damage).map(|(path, damage)| path + damage).collect();
        assert!(of(&path, &both).shape_db()[2] < -10.0);
        // A wrong unit.
        let louder = of(&[1.0; 4], &damage);
        assert!(louder.level_db() >= 20.0 && louder.squares()[1] < 1e-9, "{louder:?}");
        // A wheel of another mesh has bands at other orders.
        let finer = vec![0.0, 0.0, 0.6, 0.0, -0.8, -0.4, 0.0, 0.0];
        let found = Alike::new(&[(20.0, path.to_vec()), (40.0 / 3.0, finer)]).unwrap();
        assert_eq!(found.shape_db().iter().map(|db| db.round()).collect::<Vec<_>>(), [0.0, 12.0, -8.0, 0.0]);
        assert_eq!(Alike::new(&[(20.0, path.to_vec())]), None);
    }
}
