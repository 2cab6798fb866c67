//! Stage 8: the signals.

mod average;
mod channels;
mod statistics;

pub use average::revolution_average;
pub use channels::{Channels, GRAVITY_M_PER_S2, channel_outputs};
pub use statistics::{kurtosis, peak, rms};
