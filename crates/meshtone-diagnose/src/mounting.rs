//! Whether the sensor's mounting was changed since the healthy recording: then the orders of all wheels change together.
//!
//! Damage makes the difference signal of its own wheel louder. What lies between the teeth and the sensor changes those of all wheels alike where their
//! frequencies are alike, here louder and there quieter.

use meshtone_learn::quantiles;

use crate::learn::Learned;

/// What changed alike in the difference signals of all wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommonChange {
    /// (-) p-value: the part of the simulations, with damage and with other speeds and loads, in which as much changed alike, or more.
    pub p: f64,
    /// (dB) Least and largest change alike of a band of orders, beside each wheel's median.
    pub within_db: [f64; 2],
}

impl CommonChange {
    /// Compares what changed alike with simulations.
    ///
    /// # Arguments
    /// * `learned` - the simulations
    /// * `common_db` - [`common_db`] of the recordings
    ///
    /// Returns none where fewer than two wheels are seen, or no healthy recording.
    pub(crate) fn new(learned: &Learned, common_db: &[f64]) -> Option<Self> {
        if common_db.is_empty() {
            return None;
        }
        let squares = |of: &[f64]| of.iter().map(|db| db * db).sum::<f64>();
        let asked = squares(common_db);
        let more = learned.rows.iter().filter(|row| squares(&row.common_db) >= asked).count();
        let p = (more + 1) as f64 / (learned.rows.len() + 1) as f64;
        let [least, most] = [f64::min, f64::max].map(|of| common_db.iter().copied().fold(0.0, of));
        Some(Self { p, within_db: [least, most] })
    }
}

/// (dB) What changed alike in the difference signals of all wheels, in bands of orders, beside the median of each wheel: of every band the smallest of the
/// wheels' changes, 0 where one is louder and another quieter. Empty of fewer than two wheels.
///
/// # Arguments
/// * `wheels` - of each wheel that is seen the mesh frequency, in orders of one shaft, and (log10) how much louder each band about a multiple of it is than in the
///   healthy recording
pub(crate) fn common_db(wheels: &[(f64, Vec<f64>)]) -> Vec<f64> {
    let Some((coarsest, of_coarsest)) = wheels.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Vec::new();
    };
    if wheels.len() < 2 {
        return Vec::new();
    }
    // Damage makes a wheel louder in most bands.
    let medians = wheels
        .iter()
        .map(|(_, louder)| quantiles(louder.iter().map(|level| (*level, 1.0)).collect(), [0.5])[0]);
    let medians: Vec<f64> = medians.collect();
    let alike = |band: usize| {
        let order = (band + 1) as f64 * coarsest;
        let of_wheels = wheels.iter().zip(&medians);
        let changes = of_wheels
            .filter_map(|((mesh, louder), median)| Some(between(louder, order / mesh - 1.0)? - median));
        let changes: Vec<f64> = changes.collect();
        let [least, most] = [f64::min, f64::max].map(|of| changes.iter().copied().reduce(of).unwrap_or(0.0));
        20.0 * if least > 0.0 {
            least
        } else if most < 0.0 {
            most
        } else {
            0.0
        }
    };
    (0..of_coarsest.len()).map(alike).collect()
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
        let of = |a: &[f64], b: &[f64]| common_db(&[(20.0, a.to_vec()), (20.0, b.to_vec())]);
        assert_eq!(of(&quiet, &damage), [0.0; 4]);
        assert_eq!(of(&path, &path), [0.0, 12.0, -16.0, 0.0]);
        let both: Vec<f64> = path.iter().zip(&damage).map(|(path, damage)| path + damage).collect();
        assert!(of(&path, &both)[2] < -10.0);
        // A wheel of another mesh has bands at other orders.
        let finer = [0.0, 0.0, 0.6, 0.0, -0.8, -0.4, 0.0, 0.0];
        let found = common_db(&[(20.0, path.to_vec()), (40.0 / 3.0, finer.to_vec())]);
        assert_eq!(found.iter().map(|db| db.round()).collect::<Vec<_>>(), [0.0, 12.0, -8.0, 0.0]);
        assert!(common_db(&[(20.0, path.to_vec())]).is_empty());
    }
}
