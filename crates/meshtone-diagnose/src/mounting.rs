//! Whether the sensor or its mounting was changed since the healthy recording: then the orders of all wheels change together.
//!
//! Damage makes the difference signal of its own wheel louder. What lies between the teeth and the recording, a path or a wrong unit, changes those of all wheels
//! alike where their frequencies are alike.

use meshtone_learn::quantiles;

use crate::learn::Learned;

/// What changed alike in the difference signals of all wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonChange {
    /// (-) p-value: the part of the simulations, with damage and with other speeds and loads, in which as much changed alike, or more.
    pub p: f64,
    /// (dB) Least and largest change alike of a band of orders.
    pub within_db: [f64; 2],
}

impl CommonChange {
    /// Compares what changed alike with simulations.
    ///
    /// Level and shape are weighted by their mean squares in the simulations: loads change the level of everything, and hardly the shape.
    ///
    /// # Arguments
    /// * `learned` - the simulations
    /// * `asked` - what changed alike in the recordings
    pub(crate) fn new(learned: &Learned, asked: &Alike) -> Self {
        let rows = || learned.rows.iter().filter_map(|row| row.alike.as_ref());
        let count = rows().count().max(1) as f64;
        let mean = |of: fn(&Alike) -> f64| (rows().map(of).sum::<f64>() / count).max(f64::MIN_POSITIVE);
        let scales = [Alike::level_square, Alike::shape_square].map(mean);
        let strange = |of: &Alike| of.level_square() / scales[0] + of.shape_square() / scales[1];
        let of_asked = strange(asked);
        let more = rows().filter(|row| strange(row) >= of_asked).count();
        let [least, most] = [f64::min, f64::max].map(|of| asked.shape_db.iter().copied().fold(0.0, of));
        let within_db = [asked.level_db + least, asked.level_db + most];
        Self { p: (more + 1) as f64 / (count + 1.0), within_db }
    }
}

/// What changed alike in the difference signals of all wheels since they were healthy: the smallest of their changes, 0 where one is louder and another
/// quieter.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Alike {
    /// (dB) Of the medians of the wheels' bands.
    level_db: f64,
    /// (dB) Of each band of orders, beside the median.
    shape_db: Vec<f64>,
}

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
        let median = |(_, louder): &(f64, Vec<f64>)| {
            quantiles(louder.iter().map(|level| (*level, 1.0)).collect(), [0.5])[0]
        };
        let medians: Vec<f64> = wheels.iter().map(median).collect();
        let of_band = |band: usize| {
            let order = (band + 1) as f64 * coarsest;
            let of_wheels = wheels.iter().zip(&medians);
            let changes = of_wheels
                .filter_map(|((mesh, louder), median)| Some(between(louder, order / mesh - 1.0)? - median));
            smallest_db(&changes.collect::<Vec<f64>>())
        };
        let shape_db = (0..of_coarsest.len()).map(of_band).collect();
        Some(Self { level_db: smallest_db(&medians), shape_db })
    }

    /// The mean of several, of as many bands.
    pub fn mean(all: &[&Self]) -> Option<Self> {
        let of =
            |value: &dyn Fn(&Self) -> f64| all.iter().map(|one| value(one)).sum::<f64>() / all.len() as f64;
        let shape = |band: usize| of(&|one| one.shape_db[band]);
        Some(Self {
            level_db: of(&|one| one.level_db),
            shape_db: (0..all.first()?.shape_db.len()).map(shape).collect(),
        })
    }

    fn level_square(&self) -> f64 {
        self.level_db.powi(2)
    }

    fn shape_square(&self) -> f64 {
        self.shape_db.iter().map(|db| db * db).sum()
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
        assert_eq!(of(&quiet, &damage), Alike { level_db: 0.0, shape_db: vec![0.0; 4] });
        assert_eq!(of(&path, &path), Alike { level_db: 0.0, shape_db: vec![0.0, 12.0, -16.0, 0.0] });
        let both: Vec<f64> = path.iter().zip(&damage).map(|(path, damage)| path + damage).collect();
        assert!(of(&path, &both).shape_db[2] < -10.0);
        // A wrong unit.
        let louder = of(&[1.0; 4], &damage);
        assert!(louder.level_db >= 20.0 && louder.shape_square() < 1e-9, "{louder:?}");
        // A wheel of another mesh has bands at other orders.
        let finer = vec![0.0, 0.0, 0.6, 0.0, -0.8, -0.4, 0.0, 0.0];
        let found = Alike::new(&[(20.0, path.to_vec()), (40.0 / 3.0, finer)]).unwrap().shape_db;
        assert_eq!(found.iter().map(|db| db.round()).collect::<Vec<_>>(), [0.0, 12.0, -8.0, 0.0]);
        assert_eq!(Alike::new(&[(20.0, path.to_vec())]), None);
    }
}
