//! What is kept of each simulation.

use crate::operation::TimeGrid;
use crate::sensor::{ChannelKind, Channels, channel_outputs};
use crate::simulate::{Simulation, Stages};
use crate::solver::{Block, Output, Recorder};

/// What is kept of each of many simulations.
pub trait Keep: Sync {
    /// Takes the outputs of one simulation.
    type Recorder: Recorder + Send;
    /// What is left of one simulation.
    type Kept: Send;

    /// What is read off the solution.
    fn outputs(&self) -> Vec<Output>;

    /// (bytes) About how large what is kept of one simulation is: how many results may wait for an earlier one depends on it.
    ///
    /// # Arguments
    /// * `time` - the simulation's division of time
    fn kept_bytes(&self, time: &TimeGrid) -> usize {
        time.kept_samples().saturating_mul(self.outputs().len() * size_of::<f64>())
    }

    /// A recorder for a simulation; it is given the samples from the first kept one on.
    ///
    /// # Arguments
    /// * `stages` - the simulation's stages before the time loop
    fn recorder(&self, stages: &Stages) -> Self::Recorder;

    /// What is kept, in the thread that simulated.
    ///
    /// # Arguments
    /// * `index` - number of the scenario
    /// * `stages` - the simulation's stages before the time loop
    /// * `recorder` - with all its samples
    fn keep(&self, index: usize, stages: Stages, recorder: Self::Recorder) -> Self::Kept;
}

/// Keeps everything, as [`crate::simulate`] does.
#[derive(Debug, Clone, Copy, Default)]
pub struct KeepSimulation;

impl Keep for KeepSimulation {
    type Recorder = Channels;
    type Kept = Simulation;

    fn outputs(&self) -> Vec<Output> {
        channel_outputs().to_vec()
    }

    fn recorder(&self, stages: &Stages) -> Channels {
        Channels::new(&stages.time)
    }

    fn keep(&self, _: usize, stages: Stages, channels: Channels) -> Simulation {
        let timings = stages.timings.clone();
        Simulation { stages, channels, timings }
    }
}

/// Keeps some of the channels, in single precision.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeepChannels {
    channels: Vec<ChannelKind>,
}

impl KeepChannels {
    /// Keeps `channels`, in that order.
    pub fn new(channels: impl Into<Vec<ChannelKind>>) -> Self {
        Self { channels: channels.into() }
    }
}

impl Default for KeepChannels {
    /// Horizontal and vertical acceleration.
    fn default() -> Self {
        Self::new([ChannelKind::Horizontal, ChannelKind::Vertical])
    }
}

/// Signals of one simulation, in single precision.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first kept sample since the start of the simulation.
    pub start_s: f64,
    /// The signals, in the order of [`KeepChannels`]; units as [`ChannelKind`] has them.
    pub channels: Vec<Vec<f32>>,
}

impl Recorder for Signals {
    fn record(&mut self, block: &Block) {
        for (index, channel) in self.channels.iter_mut().enumerate() {
            channel.extend(block.output(index).iter().map(|&value| value as f32));
        }
    }
}

impl Keep for KeepChannels {
    type Recorder = Signals;
    type Kept = Signals;

    fn outputs(&self) -> Vec<Output> {
        self.channels.iter().map(|channel| channel.output()).collect()
    }

    fn kept_bytes(&self, time: &TimeGrid) -> usize {
        time.kept_samples().saturating_mul(self.channels.len() * size_of::<f32>())
    }

    fn recorder(&self, stages: &Stages) -> Signals {
        let time = &stages.time;
        Signals {
            sampling_rate_hz: time.sampling_rate_hz,
            start_s: time.first_kept_sample as f64 * time.step_s(),
            channels: self.channels.iter().map(|_| Vec::with_capacity(time.kept_samples())).collect(),
        }
    }

    fn keep(&self, _: usize, _: Stages, signals: Signals) -> Signals {
        signals
    }
}
