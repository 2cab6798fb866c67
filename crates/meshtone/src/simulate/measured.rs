//! The channels, with what sensors make of them.

use super::Stages;
use crate::error::ScenarioError;
use crate::machine::Axis;
use crate::scenario::{GearboxShaft, Scenario, ScenarioMesh};
use crate::sensor::{
    Channel, ChannelKind, Channels, Measurement, NamedSignal, Sensor, SignalSource, measure,
};
use crate::solver::{Block, MotionState, Output, Recorder, StepCounts};
use std::f64::consts::TAU;

impl Scenario {
    /// The signals that a simulation has, without their samples, in the order of files: sensors first.
    pub fn signals(&self) -> Vec<NamedSignal> {
        self.signals_and_outputs().into_iter().map(|(signal, _)| signal).collect()
    }

    /// What each of [`Self::signals`] is of the solution.
    pub(crate) fn outputs(&self) -> Vec<Output> {
        self.signals_and_outputs().into_iter().map(|(_, output)| output).collect()
    }

    /// The signals of a simulation, each with what it is of the solution: those of the sensors, and of a rig those of a pair, of shafts of beams
    /// those of each mesh and of each shaft.
    pub(crate) fn signals_and_outputs(&self) -> Vec<(NamedSignal, Output)> {
        let sets = self.set_names();
        let of_sensor = |(number, sensor): (usize, Sensor)| {
            (NamedSignal::new(sensor.channel(), SignalSource::Sensor(number)), sensor.output(&sets))
        };
        let sensors = self.all_sensors().into_iter().enumerate().map(of_sensor);
        if self.rig().is_some() {
            let fixed = ChannelKind::ALL.map(|kind| (NamedSignal::from(kind), kind.output()));
            return sensors.chain(fixed).collect();
        }
        let meshes = self.meshes.iter().enumerate().flat_map(|(number, mesh)| self.of_mesh(number, mesh));
        sensors.chain(meshes).chain(self.shafts().iter().enumerate().map(of_shaft)).collect()
    }

    /// Force and transmission error of a mesh, and the power that its friction takes.
    fn of_mesh(&self, mesh: usize, of: &ScenarioMesh) -> Vec<(NamedSignal, Output)> {
        let (name, axis) = (transmission_error_name(&of.name()), Axis::Rotation);
        let error = Output::Displacement { place: name.clone().into(), axis, factor: 1e6 };
        let force = NamedSignal::new(format!("force_n.{}", of.name()), SignalSource::MeshForce(mesh));
        let loss =
            NamedSignal::new(format!("friction_loss_w.{}", of.name()), SignalSource::FrictionLoss(mesh));
        let friction = (of.friction > 0.0).then_some((loss, Output::FrictionLoss { mesh }));
        [
            (force, Output::MeshForce { mesh }),
            (NamedSignal::new(name, SignalSource::TransmissionError(mesh)), error),
        ]
        .into_iter()
        .chain(friction)
        .collect()
    }
}

/// Speed of a shaft.
fn of_shaft((shaft, of): (usize, &GearboxShaft)) -> (NamedSignal, Output) {
    let (name, axis) = (speed_name(&of.name), Axis::Rotation);
    let output = Output::Velocity { place: name.clone().into(), axis, factor: 1.0 / TAU };
    (NamedSignal::new(name, SignalSource::ShaftSpeed(shaft)), output)
}

/// Name of the speed of a shaft.
pub(super) fn speed_name(shaft: &str) -> String {
    format!("speed_hz.{shaft}")
}

/// Name of the transmission error of a mesh.
pub(super) fn transmission_error_name(mesh: &str) -> String {
    format!("transmission_error_um.{mesh}")
}

impl Channel {
    /// Output of the solution of a scenario for it; of a sensor, before [`measure`].
    ///
    /// # Arguments
    /// * `scenario` - what is simulated
    ///
    /// # Errors
    /// A channel that the scenario does not have.
    pub(crate) fn output_of(&self, scenario: &Scenario) -> Result<Output, ScenarioError> {
        let all = scenario.signals_and_outputs();
        let output =
            all.iter().find(|(signal, _)| *signal.name == *self.name()).map(|(_, output)| output.clone());
        output.ok_or_else(|| {
            let known: Vec<&str> = all.iter().map(|(signal, _)| &*signal.name).collect();
            let problem = format!("there is no channel `{}`; there are {}", self.name(), known.join(", "));
            ScenarioError::new("sensor", "", problem)
                .with_help("list the sensor, or name a channel that is there")
        })
    }
}

impl Stages {
    /// Empty channels, with room for the kept samples and the scenario's sensors.
    pub(crate) fn channels(&self) -> Channels {
        Channels::with_room(&self.time, self.scenario.signals())
    }

    /// The channels whose sensors recorded the motion of their places, with what they show of it.
    pub(crate) fn measured(&self, mut channels: Channels) -> Channels {
        for (sensor, signal) in (0..self.sensors.len()).zip(&mut channels.signals) {
            self.add_random_part(sensor, &mut signal.values);
        }
        channels.measure(self.sensors.iter(), &self.measurement(0));
        channels
    }

    /// The signal of a channel, of what was read off the solution for it: a sensor's is what the sensor shows.
    ///
    /// # Arguments
    /// * `channel` - which
    /// * `motion` - (g, or N where the sensor's response is to the mesh force) all kept samples
    pub fn shown(&self, channel: &Channel, mut motion: Vec<f64>) -> Vec<f64> {
        let Some(index) = self.sensor_number(channel) else { return motion };
        self.add_random_part(index, &mut motion);
        measure(motion, &self.sensors[index], &self.measurement(index))
    }

    /// On what the signal of a sensor depends besides.
    fn measurement(&self, index: usize) -> Measurement {
        let is_periodic = self.is_periodic();
        let (sampling_rate_hz, seed) = (self.time.sampling_rate_hz, self.scenario.seed);
        Measurement { sampling_rate_hz, is_periodic, seed, index }
    }

    /// Whether what is kept is a steady motion over whole turns after which the same teeth meet again.
    fn is_periodic(&self) -> bool {
        self.cycle_samples().is_some_and(|cycle| self.time.kept_samples().is_multiple_of(cycle))
    }
}

/// Channels that somebody waits for, as long as they do, the motion at each tenth of them, and what the steps took.
pub(super) struct WantedChannels<'a> {
    pub channels: Channels,
    pub states: Vec<MotionState>,
    pub counts: StepCounts,
    is_wanted: &'a dyn Fn() -> bool,
    /// Number of the first kept sample, and how many there are in a tenth.
    tenths: [usize; 2],
}

impl<'a> WantedChannels<'a> {
    /// None yet.
    pub fn new(stages: &Stages, is_wanted: &'a dyn Fn() -> bool) -> Self {
        let tenths = [stages.time.first_kept_sample, stages.time.kept_samples() / 10];
        let (states, counts) = (Vec::new(), StepCounts::default());
        Self { channels: stages.channels(), states, counts, is_wanted, tenths }
    }
}

impl Recorder for WantedChannels<'_> {
    fn record(&mut self, block: &Block) {
        self.channels.record(block);
    }

    fn wants_state(&self, sample: usize) -> bool {
        let [first, samples] = self.tenths;
        samples > 0 && sample >= first + self.states.len() * samples
    }

    fn keep_state(&mut self, state: MotionState) {
        self.states.push(state);
    }

    fn count(&mut self, counts: StepCounts) {
        self.counts = counts;
    }

    fn goes_on(&self) -> bool {
        (self.is_wanted)()
    }
}
