//! Stage 8: the channels, with what sensors make of them.

use super::Stages;
use crate::scenario::{Scenario, ScenarioForm};
use crate::sensor::{
    Channel, ChannelKind, Channels, Measurement, NamedSignal, Sensor, SignalSource, measure,
};
use crate::solver::{Block, Output, Recorder, StepCounts};

impl Scenario {
    /// The signals that a simulation has, without their samples, in the order of files: sensors first.
    pub fn signals(&self) -> Vec<NamedSignal> {
        let of_sensor = |(number, sensor): (usize, &Sensor)| {
            NamedSignal::new(sensor.channel(), SignalSource::Sensor(number))
        };
        let sensors = self.sensors.iter().enumerate().map(of_sensor);
        sensors.chain(ChannelKind::ALL.map(NamedSignal::from)).collect()
    }

    /// What each of [`Self::signals`] is of the solution.
    pub(crate) fn outputs(&self) -> Vec<Output> {
        self.sensors.iter().map(Sensor::output).chain(ChannelKind::ALL.map(ChannelKind::output)).collect()
    }
}

impl ScenarioForm {
    /// The signals that a simulation has, without their samples, in the order of files: sensors first.
    pub fn signals(&self) -> Vec<NamedSignal> {
        match self {
            Self::Pair(scenario) => scenario.signals(),
            Self::Gearbox(gearbox) => gearbox.signals(),
        }
    }
}

impl Stages {
    /// Empty channels, with room for the kept samples and the scenario's sensors.
    pub(crate) fn channels(&self) -> Channels {
        Channels::with_room(&self.time, self.scenario.signals())
    }

    /// The channels whose sensors recorded the motion of their places, with what they show of it.
    pub(crate) fn measured(&self, mut channels: Channels) -> Channels {
        channels.measure(self.scenario.sensors.iter(), &self.measurement(0));
        channels
    }

    /// The signal of a channel, of what was read off the solution for it: a sensor's is what the sensor shows.
    ///
    /// # Arguments
    /// * `channel` - which
    /// * `motion` - (g, or N where the sensor's response is to the mesh force) all kept samples
    pub fn shown(&self, channel: &Channel, motion: Vec<f64>) -> Vec<f64> {
        let is_meant = |sensor: &Sensor| matches!(channel, Channel::Sensor(name) if sensor.name() == *name);
        match self.scenario.sensors.iter().enumerate().find(|(_, sensor)| is_meant(sensor)) {
            Some((index, sensor)) => measure(motion, sensor, &self.measurement(index)),
            None => motion,
        }
    }

    /// On what the signal of a sensor depends besides.
    fn measurement(&self, index: usize) -> Measurement {
        let is_periodic = self.is_periodic();
        let (sampling_rate_hz, seed) = (self.time.sampling_rate_hz, self.scenario.seed);
        Measurement { sampling_rate_hz, is_periodic, seed, index }
    }

    /// Whether what is kept is a steady motion over whole turns after which the same teeth meet again.
    fn is_periodic(&self) -> bool {
        let period = self.time.hunting_period_samples(&self.scenario.gears);
        self.is_steady() && self.time.kept_samples().is_multiple_of(period)
    }
}

/// Channels that somebody waits for, as long as they do, and what the steps took.
pub(super) struct WantedChannels<'a> {
    pub channels: Channels,
    pub counts: StepCounts,
    pub is_wanted: &'a dyn Fn() -> bool,
}

impl Recorder for WantedChannels<'_> {
    fn record(&mut self, block: &Block) {
        self.channels.record(block);
    }

    fn count(&mut self, counts: StepCounts) {
        self.counts = counts;
    }

    fn goes_on(&self) -> bool {
        (self.is_wanted)()
    }
}
