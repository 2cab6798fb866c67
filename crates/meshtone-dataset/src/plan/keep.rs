//! The signals and values that a data set keeps of each record.

use meshtone::sensor::Channel;

use super::AveragedWheels;

/// Most records in a shard.
pub const MOST_SHARD_RECORDS: u64 = 65_536;

/// The signals and values that are kept of each record.
#[derive(Debug, Clone, PartialEq)]
pub struct Keep {
    /// (S/s) Sampling rate of the raw channels.
    pub sampling_rate_hz: f64,
    /// (s) Length of the raw channels; none for a hunting-tooth period.
    pub duration_s: Option<f64>,
    /// How the raw channels lie over the angle of the first wheel of `wheel`, as many values in every record; none where they are over time.
    pub over_angle: Option<OverAngle>,
    /// Raw channels that are kept.
    pub channels: Vec<Channel>,
    /// The channel that is averaged.
    pub analysed: Channel,
    /// The wheels over whose revolutions it is averaged.
    pub wheel: AveragedWheels,
    /// Sidebands that are taken away for the difference signal.
    pub sidebands: usize,
    /// Shaft orders that are taken away for it.
    pub shaft_orders: usize,
    /// Whether the synchronous average is kept.
    pub average: bool,
    /// Whether its difference signal is kept.
    pub difference: bool,
    /// Whether the indicators are kept.
    pub indicators: bool,
    /// Whether every record begins when the damaged tooth, of several that of the first fault, comes into contact, instead of any
    /// tooth.
    pub aligned: bool,
    /// Records in a shard; by default as many as make about 32 MB, or take half a minute of a core.
    pub records_per_shard: Option<u64>,
}

/// Channels over the angle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OverAngle {
    /// Values in a revolution, of channels, average and difference.
    pub points_per_revolution: usize,
    /// Revolutions of the channels.
    pub revolutions: usize,
}

impl OverAngle {
    /// Values of a channel.
    pub fn values(self) -> usize {
        self.points_per_revolution * self.revolutions
    }
}

impl Keep {
    /// The channels that must be simulated: the raw ones, then the analysed one where it is not among them.
    pub fn simulated(&self) -> Vec<Channel> {
        let mut channels = self.channels.clone();
        if self.is_analysed() && !channels.contains(&self.analysed) {
            channels.push(self.analysed.clone());
        }
        channels
    }

    /// Returns whether anything is computed from the analysed channel.
    pub fn is_analysed(&self) -> bool {
        self.average || self.difference || self.indicators
    }
}
