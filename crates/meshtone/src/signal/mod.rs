//! Stage 8: the signals.

mod channels;

pub use channels::{ChannelRecorder, Channels, GRAVITY_M_PER_S2};
