//! Parts of the simulations, of which each is predicted by the others.

use meshtone::random::{Draws, Purpose};

/// Number of parts: each is predicted by a regression on the others.
pub const FOLDS: usize = 5;

/// The part of the simulations to which a unit belongs, below [`FOLDS`]: a pair of wheels is never divided.
///
/// The part is drawn, since classes come in turn, so that a class would be in some parts alone.
///
/// # Arguments
/// * `unit` - number of the pair of wheels
pub fn fold_of(unit: u64) -> usize {
    (shuffled(unit) % FOLDS as u64) as usize
}

/// A number of a unit that does not follow the turn of the classes.
pub(crate) fn shuffled(unit: u64) -> u64 {
    Draws::new(0, Purpose::DiagnosisUnit, unit).bits()
}
