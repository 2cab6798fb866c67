//! Errors of drawing.

use thiserror::Error;

/// Why a figure could not be drawn or encoded.
#[derive(Debug, Error)]
pub enum PlotError {
    /// A tooth without a profile.
    #[error("{wheel}'s tooth profile has {points} points; at least 2 are needed to draw it")]
    NoProfile {
        /// `the pinion`, `z1`.
        wheel: String,
        /// Number of points.
        points: usize,
    },
    /// Signals that do not belong to the simulation.
    #[error(
        "the signals have {channels_hz} samples per second, but the simulation they are drawn with has \
         {simulation_hz}; draw the signals as simulated, before any resampling"
    )]
    SamplingRate {
        /// (S/s) Rate of the signals.
        channels_hz: f64,
        /// (S/s) Rate of the simulation.
        simulation_hz: f64,
    },
    /// An experiment and a result that do not belong together, or signals that cannot be enhanced.
    #[error(transparent)]
    Hybrid(#[from] meshtone::tuning::HybridError),
    /// The PNG could not be written.
    #[error("the figure could not be encoded as PNG: {0}")]
    Png(#[from] png::EncodingError),
}
