//! Fields of the time loop.

use std::ops::Range;

use web_time::{Duration, Instant};

use super::average::average;
use super::gearbox::gearbox_trace;
use super::{Trace, static_stages};
use crate::error::Error;
use crate::scenario::Scenario;
use crate::sensor::{ChannelKind, Channels};
use crate::simulate::{Simulation, Stages, stages};
use crate::solver::{Block, Output, Recorder};

/// How many samples of each quantity a trace holds.
const ACCELERATIONS: usize = 4000;
const STATES: usize = 200;
const LAST_ACCELERATIONS: usize = 200;
const LAST_DISPLACEMENTS: usize = 20;
/// (S/s) Rate at which the published examples average, but for the tooth destruction's 50 kS/s.
const AVERAGE_RATE_HZ: f64 = 25e3;

/// Simulates a scenario and returns every stage's output by name, beside the simulation itself.
///
/// # Arguments
/// * `scenario` - what is simulated
///
/// # Errors
/// As [`crate::simulate`].
///
/// The average's fields are at 25 kS/s; [`trace_at`] takes another rate. They are missing where there is no average: fewer
/// than two revolutions of the gear, a vertical signal that is 0, a mesh frequency beyond half of that rate.
pub fn trace(scenario: impl Into<Scenario>) -> Result<(Simulation, Trace), Error> {
    trace_at(scenario, AVERAGE_RATE_HZ)
}

/// As [`trace`], with the average's fields at a rate of one's own; of a gearbox nothing is averaged.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `average_rate_hz` - (S/s) rate to which the vertical signal is resampled before it is averaged; the simulation's own
///   rate at most
///
/// # Errors
/// As [`crate::simulate`].
pub fn trace_at(scenario: impl Into<Scenario>, average_rate_hz: f64) -> Result<(Simulation, Trace), Error> {
    traced(stages(scenario)?, average_rate_hz)
}

/// Does what [`trace`] does, for those who have looked at the stages.
///
/// # Arguments
/// * `stages` - of what is simulated
///
/// # Errors
/// A motion that grows without bound.
pub fn trace_of(stages: Stages) -> Result<(Simulation, Trace), Error> {
    traced(stages, AVERAGE_RATE_HZ)
}

fn traced(stages: Stages, average_rate_hz: f64) -> Result<(Simulation, Trace), Error> {
    if stages.scenario.rig().is_none() {
        let simulation = stages.simulate()?;
        let trace = gearbox_trace(&simulation);
        return Ok((simulation, trace));
    }
    let start = Instant::now();
    let mut trace = Trace::default();
    static_stages(&mut trace, &stages);
    let mut recorder = StateRecorder::new(&stages);
    let state = state_outputs(recorder.coordinates);
    let outputs: Vec<Output> = stages.scenario.outputs().into_iter().chain(state).collect();
    stages.integrate(&outputs, stages.time.first_kept_sample, &mut recorder)?;
    let channels = recorder.finish(&mut trace);
    let stages = stages.with_random_forces_of(&channels);
    let channels = stages.measured(channels);
    average(&mut trace, &stages, &channels, average_rate_hz);
    let of_stages: Duration = stages.timings.iter().map(|time| time.elapsed).sum();
    trace.scalar("elapsed_s", (of_stages + start.elapsed()).as_secs_f64());
    Ok((stages.with_channels(channels), trace))
}

/// The outputs that are recorded beside the channels: acceleration, velocity and displacement of every coordinate.
fn state_outputs(coordinates: usize) -> impl Iterator<Item = Output> {
    let of_all = move |derivative: usize| {
        (0..coordinates).map(move |number| Output::Coordinate { number, derivative })
    };
    [2, 1, 0].into_iter().flat_map(of_all)
}

/// States of some samples, under the name of their field.
struct Window {
    name: &'static str,
    /// Which derivative of the coordinates: 2 is the acceleration.
    derivative: usize,
    samples: Range<usize>,
    /// One a sample.
    states: Vec<Vec<f64>>,
}

/// Records channels and, in windows, the state in all coordinates.
struct StateRecorder {
    channels: Channels,
    /// Number of the first output that is one of the state.
    first_state: usize,
    coordinates: usize,
    kept: Range<usize>,
    windows: [Window; 5],
    square_sum: Vec<f64>,
    velocity_sum: Vec<f64>,
}

impl StateRecorder {
    fn new(stages: &Stages) -> Self {
        let coordinates = stages.coordinates();
        let kept = stages.time.first_kept_sample..stages.time.samples;
        let window = |name, derivative, samples| Window { name, derivative, samples, states: Vec::new() };
        let first = |count: usize| kept.start..kept.start + count;
        let last = |count: usize| kept.end.saturating_sub(count)..kept.end;
        Self {
            channels: stages.channels(),
            first_state: stages.scenario.outputs().len(),
            coordinates,
            windows: [
                window("acceleration", 2, first(ACCELERATIONS)),
                window("velocity", 1, first(STATES)),
                window("displacement", 0, first(STATES)),
                window("acceleration_last_200", 2, last(LAST_ACCELERATIONS)),
                window("displacement_last_20", 0, last(LAST_DISPLACEMENTS)),
            ],
            kept,
            square_sum: vec![0.0; coordinates],
            velocity_sum: vec![0.0; coordinates],
        }
    }

    fn finish(self, trace: &mut Trace) -> Channels {
        let count = self.kept.len() as f64;
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
        for Window { name, states, .. } in &self.windows {
            trace.matrix(name, states.len(), self.coordinates, |sample, coordinate| {
                states[sample][coordinate]
            });
        }
        trace.vector("acceleration_rms", self.square_sum.iter().map(|sum| (sum / count).sqrt()));
        trace.vector("velocity_mean", self.velocity_sum.iter().map(|sum| sum / count));
        let channels = self.channels;
        trace.vector(
            "rms_g_horizontal_vertical_axial",
            ChannelKind::ACCELERATIONS.map(|kind| rms(channels.of(kind.source()))),
        );
        channels
    }
}

impl Recorder for StateRecorder {
    fn record(&mut self, block: &Block) {
        self.channels.record(block);
        for k in 0..block.len() {
            let sample = block.first_sample + k;
            // In the order of `state_outputs`.
            let all = |derivative: usize| -> Vec<f64> {
                let first = self.first_state + (2 - derivative) * self.coordinates;
                (first..first + self.coordinates).map(|output| block.output(output)[k]).collect()
            };
            for (sum, acceleration) in self.square_sum.iter_mut().zip(all(2)) {
                *sum += acceleration * acceleration;
            }
            self.velocity_sum.iter_mut().zip(all(1)).for_each(|(sum, velocity)| *sum += velocity);
            for window in self.windows.iter_mut().filter(|window| window.samples.contains(&sample)) {
                window.states.push(all(window.derivative));
            }
        }
    }
}
