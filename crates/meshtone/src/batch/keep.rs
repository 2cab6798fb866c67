//! What is kept of each simulation.

use crate::error::{Error, ScenarioError};
use crate::scenario::Scenario;
use crate::sensor::{Channel, ChannelKind, Channels};
use crate::simulate::{Simulation, Stages};
use crate::solver::{Block, Output, Recorder};

/// What is kept of each of many simulations.
pub trait Keep: Sync {
    /// Takes the outputs of one simulation.
    type Recorder: Recorder + Send;
    /// What is left of one simulation.
    type Kept: Send;

    /// What is read off the solution.
    ///
    /// # Arguments
    /// * `scenario` - what is simulated, with what its model ignores at its default
    ///
    /// # Errors
    /// What is to be kept is not there, such as a sensor that is not listed.
    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError>;

    /// (bytes) About how large what is kept of one simulation is: how many results may wait for an earlier one depends on it.
    ///
    /// # Arguments
    /// * `scenario` - what is simulated, which need not be valid
    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        let outputs = self.outputs(scenario).map_or(0, |outputs| outputs.len());
        scenario.time_grid().kept_samples().saturating_mul(outputs * size_of::<f64>())
    }

    /// A recorder for a simulation; it is given the samples from the first kept one on. A block may have further outputs behind
    /// those that were asked for.
    ///
    /// # Arguments
    /// * `stages` - the simulation's stages before the time loop
    fn recorder(&self, stages: &Stages) -> Self::Recorder;

    /// Refuses a simulation that no machine can have, or that breaks a law, as [`crate::simulate`] does. By default that is not looked at:
    /// a recorder may have seen neither forces nor speeds.
    ///
    /// # Arguments
    /// * `stages` - the simulation's stages before the time loop
    /// * `recorder` - with all its samples
    ///
    /// # Errors
    /// Those of [`Stages::simulate`] about its result.
    fn check(&self, stages: &Stages, recorder: &Self::Recorder) -> Result<(), Error> {
        let _ = (stages, recorder);
        Ok(())
    }

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

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        Ok(scenario.outputs())
    }

    fn recorder(&self, stages: &Stages) -> Channels {
        stages.channels()
    }

    fn check(&self, stages: &Stages, channels: &Channels) -> Result<(), Error> {
        stages.check_laws(&stages.figures(channels))
    }

    fn keep(&self, _: usize, stages: Stages, channels: Channels) -> Simulation {
        let channels = stages.measured(channels);
        stages.with_channels(channels)
    }
}

/// Keeps what a function makes of each simulation, by its number.
#[derive(Debug, Clone, Copy, Default)]
pub struct KeepOf<F>(
    /// The function.
    pub F,
);

impl<T: Send, F: Fn(usize, Simulation) -> T + Sync> Keep for KeepOf<F> {
    type Recorder = Channels;
    type Kept = T;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        KeepSimulation.outputs(scenario)
    }

    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        scenario.time_grid().kept_samples().saturating_mul(size_of::<f64>())
    }

    fn recorder(&self, stages: &Stages) -> Channels {
        KeepSimulation.recorder(stages)
    }

    fn check(&self, stages: &Stages, channels: &Channels) -> Result<(), Error> {
        KeepSimulation.check(stages, channels)
    }

    fn keep(&self, index: usize, stages: Stages, channels: Channels) -> T {
        (self.0)(index, KeepSimulation.keep(index, stages, channels))
    }
}

/// Keeps some of the channels, in single precision.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeepChannels {
    channels: Vec<Channel>,
}

impl KeepChannels {
    /// Keeps `channels`, in that order; a sensor's of every scenario, or the scenario gives an error that lists its channels.
    pub fn new(channels: impl IntoIterator<Item = impl Into<Channel>>) -> Self {
        Self { channels: channels.into_iter().map(Into::into).collect() }
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
#[non_exhaustive]
pub struct Signals {
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first kept sample since the start of the simulation.
    pub start_s: f64,
    /// The signals, in the order of [`KeepChannels`]; units as [`Channel`] has them.
    pub channels: Vec<Vec<f32>>,
}

/// The signals of one simulation on their way to [`Signals`].
pub struct SignalRecorder {
    channels: Vec<(Channel, Recorded)>,
}

/// One of them.
enum Recorded {
    /// As it is kept.
    Final(Vec<f32>),
    /// The motion of a sensor's place, of which the sensor makes its signal in double precision.
    Raw(Vec<f64>),
}

impl SignalRecorder {
    /// Room for some channels of a simulation.
    ///
    /// # Arguments
    /// * `channels` - which, in the order of their outputs
    /// * `stages` - the simulation's stages before the time loop
    fn new(channels: &[Channel], stages: &Stages) -> Self {
        let samples = stages.time.kept_samples();
        let room = |channel: &Channel| match channel {
            Channel::Fixed(_) => Recorded::Final(Vec::with_capacity(samples)),
            Channel::Sensor(_) => Recorded::Raw(Vec::with_capacity(samples)),
        };
        Self { channels: channels.iter().map(|channel| (channel.clone(), room(channel))).collect() }
    }

    /// The signals, once all samples are recorded.
    ///
    /// # Arguments
    /// * `stages` - as of [`Keep::recorder`]
    pub fn finish(self, stages: &Stages) -> Signals {
        let time = &stages.time;
        Signals {
            sampling_rate_hz: time.sampling_rate_hz,
            start_s: 0.0,
            channels: self.channels_by(|channel, motion| stages.shown(channel, motion)),
        }
    }

    /// The channels, once all samples are recorded.
    ///
    /// # Arguments
    /// * `of_sensor` - what is made of the motion of a sensor's place
    pub fn channels_by(self, of_sensor: impl Fn(&Channel, Vec<f64>) -> Vec<f64>) -> Vec<Vec<f32>> {
        let single = |(channel, recorded): (Channel, Recorded)| match recorded {
            Recorded::Final(values) => values,
            Recorded::Raw(motion) => {
                of_sensor(&channel, motion).into_iter().map(|value| value as f32).collect()
            }
        };
        self.channels.into_iter().map(single).collect()
    }
}

impl Recorder for SignalRecorder {
    fn record(&mut self, block: &Block) {
        for (index, (_, channel)) in self.channels.iter_mut().enumerate() {
            let values = block.output(index);
            match channel {
                Recorded::Final(channel) => channel.extend(values.iter().map(|&value| value as f32)),
                Recorded::Raw(channel) => channel.extend_from_slice(values),
            }
        }
    }
}

/// All outputs are kept as they are.
impl Recorder for Vec<Vec<f64>> {
    fn record(&mut self, block: &Block) {
        self.resize_with(block.outputs().len(), Vec::new);
        self.iter_mut().zip(block.outputs()).for_each(|(all, block)| all.extend_from_slice(block));
    }
}

impl Keep for KeepChannels {
    type Recorder = SignalRecorder;
    type Kept = Signals;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        self.channels.iter().map(|channel| channel.output_of(scenario)).collect()
    }

    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        scenario.time_grid().kept_samples().saturating_mul(self.channels.len() * size_of::<f32>())
    }

    fn recorder(&self, stages: &Stages) -> SignalRecorder {
        SignalRecorder::new(&self.channels, stages)
    }

    fn keep(&self, _: usize, stages: Stages, recorder: SignalRecorder) -> Signals {
        recorder.finish(&stages)
    }
}
