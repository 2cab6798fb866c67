//! Errors of a diagnosis.

use meshtone_learn::LearnError;

/// A diagnosis that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// Too few simulations to learn from.
    #[error(
        "there are too few simulations of some kind of damage to learn from: make more of them, or look at what `meshtone simulate` says of the \
         scenario, where few could be simulated"
    )]
    NoReference,
    /// Features that are not numbers, or a search for probabilities that found none.
    #[error("the regression on the reference set has no solution")]
    NotSolved,
    /// So few orders that no mesh order is whole, in words.
    #[error("{0}")]
    TooFewOrders(String),
    /// A speed far from those of the simulations, in words.
    #[error("{0}")]
    OtherSpeed(String),
    /// Recordings that cannot be compared with the simulations, or with each other, in words.
    #[error("{0}")]
    Unfit(String),
}

impl From<LearnError> for DiagnoseError {
    fn from(error: LearnError) -> Self {
        match error {
            LearnError::TooFewRows => Self::NoReference,
            _ => Self::NotSolved,
        }
    }
}
