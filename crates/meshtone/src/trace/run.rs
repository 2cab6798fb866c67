//! Fields of the time loop.

use web_time::Instant;

use super::average::average;
use super::{Trace, static_stages};
use crate::error::Error;
use crate::machine::coordinates::{COORDINATES, CoordinateVector};
use crate::scenario::Scenario;
use crate::sensor::Channels;
use crate::simulate::{Simulation, Stages, stages};
use crate::solver::{Block, Output, Recorder};

/// How many samples of each quantity a trace holds.
const FIRST_FORCES: usize = 200;
const KEPT_FORCES: usize = 500;
const ERROR_FORCES: usize = 2000;
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
pub fn trace(scenario: &Scenario) -> Result<(Simulation, Trace), Error> {
    trace_at(scenario, AVERAGE_RATE_HZ)
}

/// As [`trace`], with the average's fields at a rate of one's own.
///
/// # Arguments
/// * `scenario` - what is simulated
/// * `average_rate_hz` - (S/s) rate to which the vertical signal is resampled before it is averaged; the simulation's own
///   rate at most
///
/// # Errors
/// As [`crate::simulate`].
pub fn trace_at(scenario: &Scenario, average_rate_hz: f64) -> Result<(Simulation, Trace), Error> {
    let start = Instant::now();
    let stages = stages(scenario)?;
    let mut trace = Trace::default();
    static_stages(&mut trace, &stages);
    forces(&mut trace, &stages);
    let model = stages.reduced_model();
    let mut recorder = StateRecorder::new(&stages);
    let outputs: Vec<Output> = stages.channel_outputs().into_iter().chain(state_outputs()).collect();
    stages.integrate(&model, &outputs, stages.time.first_kept_sample, &mut recorder)?;
    let channels = stages.measured(recorder.finish(&mut trace));
    average(&mut trace, &stages, &channels, average_rate_hz);
    trace.scalar("elapsed_s", start.elapsed().as_secs_f64());
    let timings = stages.timings.clone();
    Ok((Simulation { stages, channels, timings }, trace))
}

fn forces(trace: &mut Trace, stages: &Stages) {
    // Under `contact` the force of the deviations depends on which teeth touch.
    if stages.structure.is_some() {
        return;
    }
    let system = &stages.system;
    let kept = stages.time.first_kept_sample;
    let mut first = Vec::with_capacity(FIRST_FORCES);
    let mut of_kept = Vec::with_capacity(KEPT_FORCES);
    let mut errors = Vec::with_capacity(ERROR_FORCES);
    for (sample, excitation) in stages.excitation().take(stages.time.samples).enumerate() {
        let force = || system.force(&excitation);
        if sample < FIRST_FORCES {
            first.push(force());
        }
        if sample >= kept {
            errors.push(excitation.error_force_n());
            if sample < kept + KEPT_FORCES {
                of_kept.push(force());
            }
            if sample + 1 == kept + ERROR_FORCES {
                break;
            }
        }
    }
    let by_coordinate = |trace: &mut Trace, name: &str, forces: &[CoordinateVector]| {
        trace.matrix(name, COORDINATES, forces.len(), |coordinate, sample| forces[sample][coordinate]);
    };
    by_coordinate(trace, "force_first_200", &first);
    by_coordinate(trace, "force_kept_first_500", &of_kept);
    trace.vector("mesh_error_force_n", errors);
}

/// What is recorded beside the channels: the 13 coordinates' accelerations, velocities and displacements.
fn state_outputs() -> Vec<Output> {
    let each = |output: fn(Vec<f64>) -> Output| {
        (0..COORDINATES).map(move |coordinate| {
            let mut weights = vec![0.0; COORDINATES];
            weights[coordinate] = 1.0;
            output(weights)
        })
    };
    each(Output::Acceleration).chain(each(Output::Velocity)).chain(each(Output::Displacement)).collect()
}

/// Records channels and, in windows, the state in all 13 coordinates.
struct StateRecorder {
    channels: Channels,
    /// Number of the first output that is one of the state.
    first_state: usize,
    kept: usize,
    samples: usize,
    acceleration: Vec<[f64; COORDINATES]>,
    velocity: Vec<[f64; COORDINATES]>,
    displacement: Vec<[f64; COORDINATES]>,
    last_acceleration: Vec<[f64; COORDINATES]>,
    last_displacement: Vec<[f64; COORDINATES]>,
    square_sum: [f64; COORDINATES],
    velocity_sum: [f64; COORDINATES],
}

impl StateRecorder {
    fn new(stages: &Stages) -> Self {
        Self {
            channels: stages.channels(),
            first_state: stages.channel_outputs().len(),
            kept: stages.time.first_kept_sample,
            samples: stages.time.samples,
            acceleration: Vec::new(),
            velocity: Vec::new(),
            displacement: Vec::new(),
            last_acceleration: Vec::new(),
            last_displacement: Vec::new(),
            square_sum: [0.0; COORDINATES],
            velocity_sum: [0.0; COORDINATES],
        }
    }

    fn finish(self, trace: &mut Trace) -> Channels {
        let states = |trace: &mut Trace, name: &str, rows: &[[f64; COORDINATES]]| {
            trace.matrix(name, rows.len(), COORDINATES, |sample, coordinate| rows[sample][coordinate]);
        };
        let count = (self.samples - self.kept) as f64;
        let rms = |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / count).sqrt();
        states(trace, "acceleration", &self.acceleration);
        states(trace, "velocity", &self.velocity);
        states(trace, "displacement", &self.displacement);
        states(trace, "acceleration_last_200", &self.last_acceleration);
        states(trace, "displacement_last_20", &self.last_displacement);
        trace.vector("acceleration_rms", self.square_sum.map(|sum| (sum / count).sqrt()));
        trace.vector("velocity_mean", self.velocity_sum.map(|sum| sum / count));
        let channels = self.channels;
        trace.vector(
            "rms_g_horizontal_vertical_axial",
            [rms(&channels.horizontal_g), rms(&channels.vertical_g), rms(&channels.axial_g)],
        );
        channels
    }
}

impl Recorder for StateRecorder {
    fn record(&mut self, block: &Block) {
        self.channels.record(block);
        let states = self.first_state;
        for k in 0..block.len() {
            let sample = block.first_sample + k;
            let (since, until) = (sample - self.kept, self.samples - sample);
            let all = |kind: usize| -> [f64; COORDINATES] {
                std::array::from_fn(|n| block.output(states + kind * COORDINATES + n)[k])
            };
            let (acceleration, velocity) = (all(0), all(1));
            for coordinate in 0..COORDINATES {
                self.square_sum[coordinate] += acceleration[coordinate] * acceleration[coordinate];
                self.velocity_sum[coordinate] += velocity[coordinate];
            }
            if since < ACCELERATIONS {
                self.acceleration.push(acceleration);
            }
            if since < STATES {
                self.velocity.push(velocity);
                self.displacement.push(all(2));
            }
            if until <= LAST_ACCELERATIONS {
                self.last_acceleration.push(acceleration);
            }
            if until <= LAST_DISPLACEMENTS {
                self.last_displacement.push(all(2));
            }
        }
    }
}
