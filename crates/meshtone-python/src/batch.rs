//! Many simulations.

use std::borrow::Cow;
use std::sync::atomic::Ordering;

use meshtone::batch::{
    Block, Control, Keep, KeepObserved, KeepSimulation, ObservedRecorder, Output, Recorder, SteppedAlone,
    simulate_many as simulate,
};
use meshtone::scenario::{ScenarioError, ScenarioWarning};
use meshtone::sensor::{Channel, ChannelKind, Channels, Sensor};
use meshtone::{Stages, StepJudgement};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::array;
use crate::error::{simulation_error, value_error};
use crate::interrupt::interruptible;
use crate::scenario::{Scenario, in_words};

/// Simulates scenarios side by side; of each a dictionary of its channels, or the error that it gave. Where the first error is that
/// of all, what has not begun is left out then.
///
/// # Arguments
/// * `channels` - names of those that are kept; none for those that are looked at first
#[pyfunction]
pub fn simulate_many<'py>(
    py: Python<'py>,
    scenarios: Vec<PyRef<'py, Scenario>>,
    channels: Option<Vec<String>>,
    threads: Option<usize>,
    stop_at_error: bool,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let scenarios: Vec<_> = scenarios.iter().map(|scenario| scenario.0.clone()).collect();
    if let Some(names) = &channels {
        check_names(names, &scenarios)?;
    }
    let mut pool = rayon::ThreadPoolBuilder::new();
    match threads {
        Some(0) => return Err(value_error("threads = 0: must be at least 1")),
        Some(threads) => pool = pool.num_threads(threads),
        None => {}
    }
    let pool = pool.build().map_err(|error| PyOSError::new_err(error.to_string()))?;
    let all = scenarios.len() as u64;
    let results = interruptible(py, progress, all, |cancelled, report| {
        let progress = |count| report(count as u64, all);
        let control = Control { progress: &progress, cancelled, ..Control::default() };
        let mut results = Vec::with_capacity(scenarios.len());
        let take = |_: usize, result: Result<Kept, meshtone::Error>| {
            if stop_at_error && result.is_err() {
                cancelled.store(true, Ordering::Relaxed);
            }
            results.push(result);
        };
        pool.install(|| simulate(scenarios, &KeepNamed(channels), &control, take));
        results
    })?;
    results.into_iter().map(|result| signals(py, result)).collect()
}

/// Refuses a name that no scenario has a channel of.
fn check_names(names: &[String], scenarios: &[meshtone::scenario::Scenario]) -> PyResult<()> {
    let mut known: Vec<Cow<'static, str>> = Vec::new();
    for signal in scenarios.iter().flat_map(meshtone::scenario::Scenario::signals) {
        if !known.contains(&signal.name) {
            known.push(signal.name);
        }
    }
    match names.iter().find(|name| !known.iter().any(|known| known == *name)) {
        Some(name) if !scenarios.is_empty() => {
            Err(value_error(format!("channels: '{name}': must be one of {}", known.join(", "))))
        }
        _ => Ok(()),
    }
}

/// Keeps some of the channels of scenarios of any structure, with what is doubtful about them.
struct KeepNamed(Option<Vec<String>>);

impl KeepNamed {
    /// The names of what is kept of a scenario.
    fn names(&self, scenario: &meshtone::scenario::Scenario) -> Vec<String> {
        let kinds = [ChannelKind::Horizontal, ChannelKind::Vertical].map(|kind| kind.name().to_owned());
        self.0.clone().unwrap_or_else(|| match scenario.rig() {
            Some(_) => kinds.to_vec(),
            None => scenario.all_sensors().iter().map(Sensor::channel).collect(),
        })
    }

    /// The same, as what a pair keeps.
    fn of_pair(&self, scenario: &meshtone::scenario::Scenario) -> KeepObserved {
        let channel = |name: String| Channel::named(&name).unwrap_or(Channel::Sensor(name));
        KeepObserved::new(self.names(scenario).into_iter().map(channel))
    }
}

/// A simulation on its way to its kept channels: of a pair these alone, of a gearbox all.
enum KeptRecorder {
    Some(Box<ObservedRecorder>),
    All(Channels),
}

impl Recorder for KeptRecorder {
    fn record(&mut self, block: &Block) {
        match self {
            Self::Some(recorder) => recorder.record(block),
            Self::All(channels) => channels.record(block),
        }
    }
}

/// The kept channels of a simulation.
struct Kept {
    sampling_rate_hz: f64,
    start_s: f64,
    channels: Vec<(String, Vec<f32>)>,
    warnings: Vec<ScenarioWarning>,
    stepped_alone: Option<SteppedAlone>,
}

impl Keep for KeepNamed {
    type Recorder = KeptRecorder;
    type Kept = Kept;

    fn outputs(&self, scenario: &meshtone::scenario::Scenario) -> Result<Vec<Output>, ScenarioError> {
        let known = scenario.signals();
        if let Some(name) = self.names(scenario).iter().find(|name| !known.iter().any(|of| of.name == **name))
        {
            let names: Vec<&str> = known.iter().map(|signal| &*signal.name).collect();
            let problem = format!("there is no channel `{name}`; there are {}", names.join(", "));
            return Err(ScenarioError::new("sensor", "", problem)
                .with_help("list the sensor, or name a channel that is there"));
        }
        match scenario.rig() {
            Some(_) => self.of_pair(scenario).outputs(scenario),
            None => KeepSimulation.outputs(scenario),
        }
    }

    fn kept_bytes(&self, scenario: &meshtone::scenario::Scenario) -> usize {
        let samples = scenario.time_grid().kept_samples();
        samples.saturating_mul(self.names(scenario).len() * size_of::<f32>())
    }

    fn recorder(&self, stages: &Stages) -> KeptRecorder {
        match stages.scenario.rig() {
            Some(_) => KeptRecorder::Some(Box::new(self.of_pair(&stages.scenario).recorder(stages))),
            None => KeptRecorder::All(KeepSimulation.recorder(stages)),
        }
    }

    fn keep(&self, index: usize, stages: Stages, recorder: KeptRecorder) -> Kept {
        let names = self.names(&stages.scenario);
        match recorder {
            KeptRecorder::Some(recorder) => {
                let observed = self.of_pair(&stages.scenario).keep(index, stages, *recorder);
                let (signals, observation) = (observed.signals, observed.observation);
                Kept {
                    sampling_rate_hz: signals.sampling_rate_hz,
                    start_s: signals.start_s,
                    channels: names.into_iter().zip(signals.channels).collect(),
                    warnings: observation.warnings,
                    stepped_alone: observation.stepped_alone,
                }
            }
            KeptRecorder::All(channels) => {
                let simulation = KeepSimulation.keep(index, stages, channels);
                let (stages, channels) = (&simulation.stages, &simulation.channels);
                let single = |name: String| {
                    let values = channels.signal(&name).unwrap_or_default();
                    let values = values.iter().map(|&value| value as f32).collect();
                    (name, values)
                };
                Kept {
                    sampling_rate_hz: channels.sampling_rate_hz,
                    start_s: channels.start_s,
                    channels: names.into_iter().map(single).collect(),
                    // No gearbox is simulated a second time to judge its step, whatever the number of gearboxes.
                    warnings: [stages.warnings(), simulation.warnings_of_signals(StepJudgement::Estimated)]
                        .concat(),
                    // Every gearbox is: there is nothing to say about one of them.
                    stepped_alone: None,
                }
            }
        }
    }
}

fn signals(py: Python<'_>, result: Result<Kept, meshtone::Error>) -> PyResult<Bound<'_, PyAny>> {
    let kept = match result {
        Ok(kept) => kept,
        Err(error) => return Ok(simulation_error(&error).into_value(py).into_bound(py).into_any()),
    };
    let all = PyDict::new(py);
    all.set_item("sampling_rate_hz", kept.sampling_rate_hz)?;
    all.set_item("start_s", kept.start_s)?;
    all.set_item("stepped_alone", kept.stepped_alone.map(|reason| reason.to_string()))?;
    let (messages, codes) = in_words(&kept.warnings);
    all.set_item("warnings", messages)?;
    all.set_item("warning_codes", codes)?;
    for (name, channel) in kept.channels {
        all.set_item(name, array(py, channel))?;
    }
    Ok(all.into_any())
}
