//! Errors of a diagnosis.

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
    /// The wheels of the recording are not those of the scenario.
    #[error(
        "the recording is of wheels with {} teeth, the scenario has {}, in its order",
        listed(given),
        listed(expected)
    )]
    OtherWheels {
        /// Of the recording, wheel by wheel.
        given: Vec<u32>,
        /// Of the scenario.
        expected: Vec<u32>,
    },
    /// So few orders that no mesh order is whole.
    #[error(
        "the {of}, or the simulations, show orders up to {last} of the {wheel}'s shaft; at least 2 mesh orders, {needed}, are needed"
    )]
    TooFewOrders {
        /// Name of the signal.
        of: &'static str,
        /// Name of the wheel.
        wheel: String,
        /// The last whole order.
        last: usize,
        /// The least that is needed.
        needed: usize,
    },
    /// No recording.
    #[error("there is no recording to ask about")]
    NoRecording,
    /// The recordings in question and the healthy ones differ in kind.
    #[error(
        "one recording is given as `{healthy}`, another as `{asked}` (whole recording, average or difference signal); all must be the same"
    )]
    OtherSignal {
        /// Kind of one.
        healthy: &'static str,
        /// Kind of another.
        asked: &'static str,
    },
    /// A question that is unlike the one that was learnt for.
    #[error(
        "the question is unlike the one that was learnt for: another signal, with or without healthy recordings, or fewer orders"
    )]
    OtherQuestion,
    /// A speed far from those of the simulations.
    #[error(
        "{shaft} turns at {speed_hz:.4} Hz by the recording, at {nominal_hz:.4} Hz by the scenario: {reason}"
    )]
    OtherSpeed {
        /// Name of the shaft that drives, in words.
        shaft: &'static str,
        /// (Hz) Of the recording.
        speed_hz: f64,
        /// (Hz) Of the scenario.
        nominal_hz: f64,
        /// A possible reason, in words.
        reason: String,
    },
    /// Healthy recordings of different speeds, of which one reference set holds one.
    #[error(
        "the healthy recordings turn at {slowest:.3} to {fastest:.3} Hz; give those of one speed, best the one at which the recording in question turns"
    )]
    HealthySpeeds {
        /// (Hz) The least speed.
        slowest: f64,
        /// (Hz) The largest.
        fastest: f64,
    },
    /// A speed or lines that are not finite.
    #[error("a recording's {what} is {value}; must be finite{beside}")]
    NotFinite {
        /// The problem.
        what: &'static str,
        /// Its value.
        value: f64,
        /// A second requirement.
        beside: &'static str,
    },
}

/// `24, 48`
fn listed(teeth: &[u32]) -> String {
    teeth.iter().map(u32::to_string).collect::<Vec<_>>().join(", ")
}

impl From<meshtone_learn::LearnError> for DiagnoseError {
    fn from(error: meshtone_learn::LearnError) -> Self {
        match error {
            meshtone_learn::LearnError::TooFewRows => Self::NoReference,
            _ => Self::NotSolved,
        }
    }
}
