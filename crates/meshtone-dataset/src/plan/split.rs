//! Splits: how units are divided for training, validation and test.

use crate::expression::Condition;
use crate::sampling::permuted;

/// The things that are divided into splits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SplitBy {
    /// Units: a pair of wheels is in one split, with all its mountings.
    #[default]
    Unit,
    /// Mountings: the same wheels may be in two splits, mounted anew.
    Mounting,
}

meshtone_toml::named!(SplitBy { Unit = "unit", Mounting = "mounting" });

/// The division of units, or of their mountings. Each is in one split, with all its records.
#[derive(Debug, Clone, PartialEq)]
pub struct Splits {
    /// What is divided.
    pub by: SplitBy,
    /// (-) Parts of the units, or mountings, for training, validation and test.
    pub parts: [f64; 3],
    /// Splits that are unlike the training.
    pub shifts: Vec<Shift>,
}

/// A split whose records fulfil a condition that no other record fulfils.
#[derive(Debug, Clone, PartialEq)]
pub struct Shift {
    /// Its name.
    pub name: String,
    /// (-) Part of the units, or mountings.
    pub part: f64,
    /// Conditions that all hold for every record of the split, and do not all hold for any other record.
    pub when: Vec<Condition>,
}

impl Default for Splits {
    fn default() -> Self {
        Self { by: SplitBy::Unit, parts: [0.7, 0.15, 0.15], shifts: Vec::new() }
    }
}

impl Splits {
    /// Names of the splits that are drawn alike.
    pub const ALIKE: [&'static str; 3] = ["train", "validation", "test"];

    /// All names: those drawn alike, then the shifts.
    pub fn names(&self) -> Vec<&str> {
        let shifts = self.shifts.iter().map(|shift| shift.name.as_str());
        Self::ALIKE.into_iter().chain(shifts).collect()
    }

    /// (-) Part of the units in each split.
    pub fn all_parts(&self) -> Vec<f64> {
        self.parts.iter().copied().chain(self.shifts.iter().map(|shift| shift.part)).collect()
    }

    /// Counts the units, or mountings, that each split has: by largest remainder, and at least one where its part is more than 0
    /// and there are enough.
    ///
    /// # Arguments
    /// * `units` - number of units of all splits
    ///
    /// ```
    /// use meshtone_dataset::plan::Splits;
    ///
    /// let splits = Splits::default();
    /// assert_eq!(splits.counts(20), [14, 3, 3]);
    /// assert_eq!(splits.counts(3), [1, 1, 1]);
    /// ```
    pub fn counts(&self, units: u64) -> Vec<u64> {
        let parts = self.all_parts();
        let mut counts = largest_remainder(&parts, units);
        for (split, part) in parts.iter().enumerate() {
            if *part > 0.0 && counts[split] == 0 {
                let most = (0..counts.len()).max_by_key(|&other| counts[other]);
                if let Some(most) = most.filter(|&most| counts[most] > 1) {
                    counts[most] -= 1;
                    counts[split] += 1;
                }
            }
        }
        counts
    }

    /// The split of a unit, or a mounting.
    ///
    /// # Arguments
    /// * `counts` - [how many](Self::counts) each split has
    /// * `unit`, `units` - which of how many
    /// * `seed` - of the division
    pub fn split_of(counts: &[u64], unit: u64, units: u64, seed: u64) -> usize {
        let place = permuted(unit, units, seed);
        let mut end = 0;
        let has_unit = |count: &u64| {
            end += count;
            place < end
        };
        counts.iter().position(has_unit).unwrap_or(0)
    }
}

/// Divides a whole number by parts; what is left goes to the largest remainders.
pub(crate) fn largest_remainder(parts: &[f64], whole: u64) -> Vec<u64> {
    let sum: f64 = parts.iter().sum();
    let exact = |part: f64| if sum > 0.0 { part / sum * whole as f64 } else { 0.0 };
    let mut counts: Vec<u64> = parts.iter().map(|&part| (exact(part) + 1e-9).floor() as u64).collect();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    let remainder = |i: usize| exact(parts[i]) - counts[i] as f64;
    order.sort_by(|&a, &b| remainder(b).total_cmp(&remainder(a)).then(a.cmp(&b)));
    let missing = whole.saturating_sub(counts.iter().sum());
    for &i in order.iter().cycle().take(missing as usize) {
        counts[i] += 1;
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_unit_is_in_one_split_and_the_parts_are_kept() {
        let when = vec![Condition::parse("operation.pinion_speed_hz > 50").unwrap()];
        let splits = Splits {
            by: SplitBy::Unit,
            parts: [0.6, 0.1, 0.2],
            shifts: vec![Shift { name: "fast".into(), part: 0.1, when }],
        };
        for units in [4, 10, 37, 1000] {
            let mut counts = vec![0; 4];
            let planned = splits.counts(units);
            (0..units).for_each(|unit| counts[Splits::split_of(&planned, unit, units, 9)] += 1);
            assert_eq!(counts, planned);
            assert_eq!(counts.iter().sum::<u64>(), units);
            assert!(counts.iter().all(|&count| count > 0));
        }
        assert_eq!(splits.counts(1000), [600, 100, 200, 100]);
    }

    #[test]
    fn remainders() {
        assert_eq!(largest_remainder(&[1.0, 1.0, 1.0], 10), [4, 3, 3]);
        assert_eq!(largest_remainder(&[0.5, 0.25, 0.25], 8), [4, 2, 2]);
        assert_eq!(largest_remainder(&[3.0, 1.0], 0), [0, 0]);
    }
}
