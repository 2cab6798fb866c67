//! Errors of learning.

/// A regression that cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LearnError {
    /// There are too few simulations to learn from.
    #[error("there are too few simulations to learn from")]
    TooFewRows,
    /// Features are not finite, or a search for probabilities found none.
    #[error("the regression has no solution")]
    NotSolved,
}
