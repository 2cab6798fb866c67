//! Simulated difference signals.

use super::HybridError;
use crate::batch::{ChannelKind, Keep};
use crate::signal::{Record, SeparationSettings};
use crate::simulate::Stages;
use crate::solver::{Block, Output, Recorder};

/// How a difference signal is taken from a simulation: of the gear, which carries the fault.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceChain {
    /// The channel.
    pub channel: ChannelKind,
    /// (S/s) The rig's sampling rate, to which the simulated signal is brought first; at most the simulation's.
    pub sampling_rate_hz: f64,
    /// Sidebands and shaft orders that are taken away; by default as the paper has them.
    pub separation: Option<SeparationSettings>,
}

impl DifferenceChain {
    /// The vertical acceleration at a rig's sampling rate.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s)
    pub fn new(sampling_rate_hz: f64) -> Self {
        Self { channel: ChannelKind::Vertical, sampling_rate_hz, separation: None }
    }

    /// The gear's average, its difference signal and indicators.
    ///
    /// # Arguments
    /// * `stages` - of the simulation
    /// * `signal` - the channel, all kept samples
    /// * `pinion_speed_hz` - (Hz) likewise; read where the speed follows a profile
    ///
    /// # Errors
    /// As of [`crate::signal::process_channel`].
    pub fn record(
        &self,
        stages: &Stages,
        signal: &[f64],
        pinion_speed_hz: &[f64],
    ) -> Result<Record, HybridError> {
        let rate_hz = self.sampling_rate_hz.min(stages.time.sampling_rate_hz);
        Ok(crate::trace::gear_record(stages, signal, pinion_speed_hz, rate_hz, self.separation.clone())?)
    }
}

/// Keeps the difference signal of each of many simulations.
pub(super) struct KeepDifference<'a>(pub(super) &'a DifferenceChain);

/// The channel and the pinion's speed of one simulation.
#[derive(Default)]
pub(super) struct ChannelAndSpeed {
    channel: Vec<f64>,
    pinion_speed_hz: Vec<f64>,
}

impl Recorder for ChannelAndSpeed {
    fn record(&mut self, block: &Block) {
        self.channel.extend_from_slice(block.output(0));
        self.pinion_speed_hz.extend_from_slice(block.output(1));
    }
}

impl Keep for KeepDifference<'_> {
    type Recorder = ChannelAndSpeed;
    type Kept = Result<Vec<f64>, HybridError>;

    fn outputs(&self) -> Vec<Output> {
        vec![self.0.channel.output(), ChannelKind::PinionSpeed.output()]
    }

    fn recorder(&self, _: &Stages) -> ChannelAndSpeed {
        ChannelAndSpeed::default()
    }

    fn keep(&self, _: usize, stages: Stages, kept: ChannelAndSpeed) -> Self::Kept {
        Ok(self.0.record(&stages, &kept.channel, &kept.pinion_speed_hz)?.parts.difference)
    }
}
