//! Stage 8: the signals.

mod average;
mod channels;

pub use average::revolution_average;
pub use channels::{ChannelRecorder, Channels, GRAVITY_M_PER_S2};
