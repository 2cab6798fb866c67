//! Many simulations.

use std::sync::atomic::Ordering;

use meshtone::batch::{Control, KeepObserved, ObservedSignals, simulate_many as simulate};
use meshtone::sensor::{Channel, Sensor};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::array::array;
use crate::error::{simulation_error, value_error};
use crate::interrupt::interruptible;
use crate::scenario::Scenario;

/// Simulates scenarios side by side; of each a dictionary of its channels, or the error that it gave. Where the first error is that
/// of all, what has not begun is left out then.
#[pyfunction]
pub fn simulate_many<'py>(
    py: Python<'py>,
    scenarios: Vec<PyRef<'py, Scenario>>,
    channels: Vec<String>,
    threads: Option<usize>,
    stop_at_error: bool,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let sensors = listed(scenarios.iter().map(|scenario| &scenario.0));
    let kept = channels.iter().map(|name| channel(name, &sensors)).collect::<PyResult<Vec<_>>>()?;
    let scenarios: Vec<_> = scenarios.iter().map(|scenario| scenario.0.clone()).collect();
    let batch = Batch { all: scenarios.len(), threads, stop_at_error };
    let results = batch.run(py, progress, |control, take| {
        simulate(scenarios, &KeepObserved::new(kept), control, take);
    })?;
    results.into_iter().map(|result| signals(py, &channels, result)).collect()
}

/// Many simulations that a caller waits for.
pub struct Batch {
    /// Number of simulations.
    pub all: usize,
    /// Number of threads; none: of all cores.
    pub threads: Option<usize>,
    /// Whether what has not begun is left out after the first error.
    pub stop_at_error: bool,
}

impl Batch {
    /// Runs the simulations in threads of their own, while Python can interrupt them.
    ///
    /// # Arguments
    /// * `progress` - called with the numbers of those that are finished and of all
    /// * `simulate` - simulates all; given what controls them, and who takes the results in their order
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<Bound<'_, PyAny>>,
        simulate: impl FnOnce(&Control, &mut (dyn FnMut(usize, Result<T, meshtone::Error>) + Send)) + Send,
    ) -> PyResult<Vec<Result<T, meshtone::Error>>> {
        let mut pool = rayon::ThreadPoolBuilder::new();
        match self.threads {
            Some(0) => return Err(value_error("threads = 0: must be at least 1")),
            Some(threads) => pool = pool.num_threads(threads),
            None => {}
        }
        let pool = pool.build().map_err(|error| PyOSError::new_err(error.to_string()))?;
        let all = self.all as u64;
        interruptible(py, progress, all, |cancelled, report| {
            let progress = |count| report(count as u64, all);
            let control = Control { progress: &progress, cancelled, ..Control::default() };
            let mut results = Vec::with_capacity(self.all);
            let mut take = |_: usize, result: Result<T, meshtone::Error>| {
                if self.stop_at_error && result.is_err() {
                    cancelled.store(true, Ordering::Relaxed);
                }
                results.push(result);
            };
            pool.install(|| simulate(&control, &mut take));
            results
        })
    }
}

/// The sensors of some scenarios, each name once.
fn listed<'s>(scenarios: impl Iterator<Item = &'s meshtone::scenario::Scenario>) -> Vec<Sensor> {
    let mut sensors: Vec<Sensor> = Vec::new();
    for sensor in scenarios.flat_map(|scenario| &scenario.sensors) {
        if sensors.iter().all(|known| known.name() != sensor.name()) {
            sensors.push(sensor.clone());
        }
    }
    sensors
}

fn channel(name: &str, sensors: &[Sensor]) -> PyResult<Channel> {
    Channel::of(name, sensors).map_err(|unknown| {
        value_error(format!("channels: '{name}': must be one of {}", unknown.known.join(", ")))
    })
}

fn signals<'py>(
    py: Python<'py>,
    names: &[String],
    result: Result<ObservedSignals, meshtone::Error>,
) -> PyResult<Bound<'py, PyAny>> {
    let (signals, observation) = match result {
        Ok(observed) => (observed.signals, observed.observation),
        Err(error) => return Ok(simulation_error(&error).into_value(py).into_bound(py).into_any()),
    };
    let all = PyDict::new(py);
    all.set_item("sampling_rate_hz", signals.sampling_rate_hz)?;
    all.set_item("start_s", signals.start_s)?;
    all.set_item("stepped_alone", observation.stepped_alone.map(|reason| reason.to_string()))?;
    let warnings = observation.warnings.iter().map(|warning| (warning.to_string(), warning.kind.code()));
    let (messages, codes): (Vec<_>, Vec<_>) = warnings.unzip();
    all.set_item("warnings", messages)?;
    all.set_item("warning_codes", codes)?;
    for (name, channel) in names.iter().zip(signals.channels) {
        all.set_item(name, array(py, channel))?;
    }
    Ok(all.into_any())
}
