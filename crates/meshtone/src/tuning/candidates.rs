//! Combinations of the keys' values that are tried.

use super::{KeyRange, TunedKey};
use crate::random::{Draws, Purpose};

/// Part of all candidates that is spread over the whole ranges; the others go near the best so far.
const SPREAD: f64 = 0.4;
/// Rounds of candidates near the best.
const ROUNDS: usize = 4;
/// Number of the best combinations that are refined.
const PARENTS: usize = 4;
/// Width of a round's neighbourhood over the round's before.
const SHRINK: f64 = 0.5;
/// Width of the first neighbourhood, over the whole range.
const FIRST_WIDTH: f64 = 0.35;

/// Sizes of the rounds: the first is spread, the others are near the best.
pub(super) fn rounds(candidates: usize) -> Vec<usize> {
    let spread = ((candidates as f64 * SPREAD).ceil() as usize).max(1);
    let left = candidates.saturating_sub(spread);
    let each = |round: usize| left * (round + 1) / ROUNDS - left * round / ROUNDS;
    std::iter::once(spread).chain((0..ROUNDS).map(each)).filter(|&count| count > 0).collect()
}

/// Where a combination is drawn: anywhere in the ranges, or near another combination.
#[derive(Clone, Copy)]
pub(super) enum Region<'a> {
    Anywhere,
    Near {
        /// Where the other one lies, each in \[0, 1) of its range.
        parent: &'a [f64],
        /// By how much of its range a value changes at most.
        width: f64,
    },
}

impl<'a> Region<'a> {
    /// The region of a combination of the first round: of every two, one is near the scenario's own values.
    pub(super) fn of_first_round(number: usize, own: &'a [f64]) -> Self {
        if number.is_multiple_of(2) { Self::Anywhere } else { Self::Near { parent: own, width: FIRST_WIDTH } }
    }

    /// The region of a combination of a later round: near one of the best so far.
    ///
    /// # Arguments
    /// * `best` - where they lie, the best first
    pub(super) fn of_round(round: usize, number: usize, best: &'a [Vec<f64>]) -> Self {
        match best.get(number % PARENTS.min(best.len()).max(1)) {
            Some(parent) => Self::Near { parent, width: FIRST_WIDTH * SHRINK.powi(round as i32 - 1) },
            None => Self::Anywhere,
        }
    }
}

/// Draws a combination: the place of each key's value, in \[0, 1) of its range.
///
/// # Arguments
/// * `keys` - whose values are drawn
/// * `seed`, `index` - of the draw
/// * `region` - where
pub(super) fn place(keys: &[TunedKey], seed: u64, index: usize, region: Region) -> Vec<f64> {
    let mut draws = Draws::new(seed, Purpose::Candidate, index as u64);
    let mut unit = || draws.uniform(0.5, 0.5);
    keys.iter()
        .enumerate()
        .map(|(n, key)| {
            let (change, fresh) = (unit(), unit());
            match region {
                Region::Anywhere => fresh,
                // A discrete value is kept, or drawn anew now and then.
                Region::Near { parent, width } if matches!(key.range, KeyRange::OneOf(_)) => {
                    if change < width { fresh } else { parent[n] }
                }
                Region::Near { parent, width } => reflected(parent[n] + width * (2.0 * change - 1.0)),
            }
        })
        .collect()
}

/// Into \[0, 1).
fn reflected(place: f64) -> f64 {
    let folded = place.rem_euclid(2.0);
    let inside = if folded < 1.0 { folded } else { 2.0 - folded };
    inside.min(1.0 - f64::EPSILON)
}

/// The value at a place in \[0, 1) of a range.
pub(super) fn value(key: &TunedKey, place: f64) -> f64 {
    match &key.range {
        KeyRange::Between { least, largest, logarithmic: true } => {
            (least.ln() + place * (largest.ln() - least.ln())).exp()
        }
        KeyRange::Between { least, largest, .. } => least + place * (largest - least),
        KeyRange::OneOf(values) => values[((place * values.len() as f64) as usize).min(values.len() - 1)],
    }
}

/// The place of a value in \[0, 1) of a range; the nearest one where the range does not hold the value.
pub(super) fn place_of(key: &TunedKey, value: f64) -> f64 {
    let place = match &key.range {
        KeyRange::Between { least, largest, logarithmic: true } => {
            (value / least).ln() / (largest / least).ln()
        }
        KeyRange::Between { least, largest, .. } => (value - least) / (largest - least),
        KeyRange::OneOf(values) => {
            let nearest = |(a, b): (&f64, &f64)| (a - value).abs().total_cmp(&(b - value).abs());
            let index = (0..values.len()).min_by(|&a, &b| nearest((&values[a], &values[b])));
            (index.unwrap_or(0) as f64 + 0.5) / values.len() as f64
        }
    };
    // A range of one value has no places, and a logarithm may have none either.
    if place.is_finite() { place.clamp(0.0, 1.0 - f64::EPSILON) } else { 0.5 }
}
