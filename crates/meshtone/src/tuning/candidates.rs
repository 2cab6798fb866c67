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

/// Values for one candidate, each in \[0, 1) of its range.
///
/// # Arguments
/// * `keys` - how many
/// * `seed`, `index` - of the draw
/// * `round` - 0 spreads over the whole range
/// * `best` - candidates so far, the best first; not empty where `round` is not 0
pub(super) fn place(
    ranges: &[TunedKey],
    seed: u64,
    index: usize,
    round: usize,
    best: &[Vec<f64>],
) -> Vec<f64> {
    let mut draws = Draws::new(seed, Purpose::Candidate, index as u64);
    let parent = best.get(index % PARENTS.min(best.len()).max(1));
    let width = FIRST_WIDTH * SHRINK.powi(round as i32 - 1);
    let mut unit = || draws.uniform(0.5, 0.5);
    ranges
        .iter()
        .enumerate()
        .map(|(n, key)| {
            let (change, fresh) = (unit(), unit());
            match (round, parent) {
                (0, _) | (_, None) => fresh,
                // A discrete value is kept, or drawn anew now and then.
                (_, Some(parent)) if matches!(key.range, KeyRange::OneOf(_)) => {
                    if change < width {
                        fresh
                    } else {
                        parent[n]
                    }
                }
                (_, Some(parent)) => reflected(parent[n] + width * (2.0 * change - 1.0)),
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
