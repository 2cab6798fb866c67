//! Channels that are kept, with what is doubtful about them.

use super::keep::{Keep, KeepChannels, SignalRecorder, Signals};
use crate::error::{Error, ScenarioError, ScenarioWarning};
use crate::scenario::Scenario;
use crate::sensor::Channel;
use crate::simulate::Stages;
use crate::solver::{Block, Output, Recorder, SteppedAlone};
use crate::warnings::{Observer, StepJudgement};

/// Keeps some of the channels, as [`KeepChannels`] does, and the warnings that a user of [`crate::simulate`] gets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeepObserved {
    kept: KeepChannels,
    /// Those that are read beside the kept ones.
    seen: Vec<Channel>,
    /// Where the outputs of [`Observer::CHANNELS`] are.
    places: [usize; Observer::CHANNELS.len()],
}

impl KeepObserved {
    /// Keeps `channels`, in that order.
    pub fn new(channels: impl IntoIterator<Item = impl Into<Channel>>) -> Self {
        let mut read: Vec<Channel> = channels.into_iter().map(Into::into).collect();
        let kept = KeepChannels::new(read.iter().cloned());
        let first_seen = read.len();
        let places = Observer::CHANNELS.map(|kind| {
            let channel = Channel::Fixed(kind);
            read.iter().position(|other| *other == channel).unwrap_or_else(|| {
                read.push(channel);
                read.len() - 1
            })
        });
        Self { kept, seen: read.split_off(first_seen), places }
    }
}

/// Signals of one simulation, and what is doubtful about it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ObservedSignals {
    /// The kept signals.
    pub signals: Signals,
    /// What was seen in them and in others.
    pub observation: Observation,
}

/// What is seen in the signals of one simulation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Observation {
    /// What deserves attention: of the scenario and its stages, then of the signals.
    pub warnings: Vec<ScenarioWarning>,
    /// Why the simulation cannot be stepped side by side with others, so that it takes several times as long; none where it can.
    pub stepped_alone: Option<SteppedAlone>,
    /// (-) Part of the kept time in which no teeth touch.
    pub apart_fraction: f64,
    /// (-) Part of the kept time in which the mesh force is negative.
    pub tension_fraction: f64,
}

/// The signals of one simulation on their way to [`ObservedSignals`].
pub struct ObservedRecorder {
    signals: SignalRecorder,
    observer: Observer,
    places: [usize; Observer::CHANNELS.len()],
}

impl ObservedRecorder {
    /// The recorder of the signals alone, once all samples are recorded.
    pub fn into_signals(self) -> SignalRecorder {
        self.signals
    }

    /// Refuses what no machine can have, once all samples are recorded.
    ///
    /// # Arguments
    /// * `stages` - as of [`Keep::recorder`]
    ///
    /// # Errors
    /// Does what [`Keep::check`] does.
    pub fn check(&self, stages: &Stages) -> Result<(), Error> {
        stages.check_laws(&self.observer.figures)
    }

    /// What is doubtful, once all samples are recorded.
    ///
    /// # Arguments
    /// * `stages` - as of [`Keep::recorder`]
    /// * `judgement` - how the step is judged where a resonance is suspected
    pub fn observation(&self, stages: &Stages, judgement: StepJudgement) -> Observation {
        let observer = &self.observer;
        Observation {
            warnings: [stages.warnings(), stages.warnings_of_signals(observer, judgement)].concat(),
            stepped_alone: stages.stepped_alone(),
            apart_fraction: observer.apart_fraction(),
            tension_fraction: observer.tension_fraction(),
        }
    }
}

impl Recorder for ObservedRecorder {
    fn record(&mut self, block: &Block) {
        self.observer.observe(self.places.map(|place| block.output(place)));
        self.signals.record(block);
    }
}

impl Keep for KeepObserved {
    type Recorder = ObservedRecorder;
    type Kept = ObservedSignals;

    fn outputs(&self, scenario: &Scenario) -> Result<Vec<Output>, ScenarioError> {
        let mut outputs = self.kept.outputs(scenario)?;
        for channel in &self.seen {
            outputs.push(channel.output_of(scenario)?);
        }
        Ok(outputs)
    }

    fn kept_bytes(&self, scenario: &Scenario) -> usize {
        self.kept.kept_bytes(scenario)
    }

    fn recorder(&self, stages: &Stages) -> ObservedRecorder {
        ObservedRecorder {
            signals: self.kept.recorder(stages),
            observer: Observer::new(stages),
            places: self.places,
        }
    }

    fn check(&self, stages: &Stages, recorder: &ObservedRecorder) -> Result<(), Error> {
        recorder.check(stages)
    }

    fn keep(&self, _: usize, stages: Stages, recorder: ObservedRecorder) -> ObservedSignals {
        let observation = recorder.observation(&stages, StepJudgement::Repeated);
        ObservedSignals { signals: recorder.into_signals().finish(&stages), observation }
    }
}
