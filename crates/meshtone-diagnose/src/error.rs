//! What a diagnosis fails on.

/// A diagnosis that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnoseError {
    /// Too few simulations to learn from.
    #[error(
        "too few records of the reference set could be simulated to learn from; look at what `meshtone simulate` says of the scenario"
    )]
    NoReference,
    /// Features that are not numbers.
    #[error("the regression on the reference set has no solution")]
    NotSolved,
    /// The wheels of the recording are not those of the scenario.
    #[error("the recording is of wheels with {given:?} teeth, the scenario has {expected:?} (pinion, gear)")]
    OtherWheels {
        /// Of the recording, pinion and gear.
        given: [u32; 2],
        /// Of the scenario.
        expected: [u32; 2],
    },
    /// So few orders that no mesh order is whole.
    #[error(
        "the {of} shows orders up to {last} of the gear's shaft; at least 2 mesh orders, {needed}, are needed"
    )]
    TooFewOrders {
        /// Which signal.
        of: &'static str,
        /// The last whole order.
        last: usize,
        /// The least that is needed.
        needed: usize,
    },
    /// No recording.
    #[error("there is no recording to ask about")]
    NoRecording,
    /// What is asked about and what it is compared with are not alike.
    #[error("the healthy recording is {healthy}, the one that is asked about {asked}; both must be the same")]
    OtherSignal {
        /// Kind of the healthy signal.
        healthy: &'static str,
        /// Kind of the other.
        asked: &'static str,
    },
    /// The caller has stopped it.
    #[error("cancelled")]
    Cancelled,
}
