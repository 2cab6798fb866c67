//! Stage 8: the channels, with what sensors make of them.

use super::Stages;
use crate::sensor::{Channel, Channels, Measurement, measure, outputs_of_all};
use crate::solver::Output;

impl Stages {
    /// What [`Self::channels`] take of the solution.
    pub(crate) fn channel_outputs(&self) -> Vec<Output> {
        outputs_of_all(&self.scenario.sensors)
    }

    /// Empty channels, with room for the kept samples and the scenario's sensors.
    pub(crate) fn channels(&self) -> Channels {
        Channels::new(&self.time).with_sensors(&self.scenario.sensors)
    }

    /// The channels whose sensors recorded the motion of their places, with what they show of it.
    pub(crate) fn measured(&self, mut channels: Channels) -> Channels {
        for (index, signal) in channels.sensors.iter_mut().enumerate() {
            signal.values_g = self.shown_by(index, std::mem::take(&mut signal.values_g));
        }
        channels
    }

    /// The signal of a channel, of what was read off the solution for it: a sensor's is what the sensor shows.
    ///
    /// # Arguments
    /// * `channel` - which
    /// * `motion` - (g, or N where the sensor's response is to the mesh force) all kept samples
    pub fn shown(&self, channel: &Channel, motion: Vec<f64>) -> Vec<f64> {
        let index = match channel {
            Channel::Fixed(_) => None,
            Channel::Sensor(name) => self.scenario.sensors.iter().position(|sensor| sensor.name() == *name),
        };
        match index {
            Some(index) => self.shown_by(index, motion),
            None => motion,
        }
    }

    fn shown_by(&self, index: usize, raw: Vec<f64>) -> Vec<f64> {
        let measurement = Measurement {
            sampling_rate_hz: self.time.sampling_rate_hz,
            is_periodic: self.is_periodic(),
            seed: self.scenario.seed,
            index,
        };
        match self.scenario.sensors.get(index) {
            Some(sensor) => measure(raw, sensor, &measurement),
            None => raw,
        }
    }

    /// Whether what is kept is a steady motion over whole turns after which the same teeth meet again.
    fn is_periodic(&self) -> bool {
        let period = self.time.hunting_period_samples(&self.scenario.gears);
        self.is_steady() && self.time.kept_samples().is_multiple_of(period)
    }
}
