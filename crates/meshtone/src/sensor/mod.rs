//! What is read off the solution: the channels, as sensors on the rig would show them.
//!
//! A channel that every simulation has is a row of one table; its name is the same in the file of signals, in the list of a data
//! set's plan, in an experiment and in Python. Sensors that the scenario lists have channels of their own, `NAME_g`: the motion of
//! their place, and what the sensor makes of it ([`measure()`]).

mod channel;
mod contact_figures;
mod frequency_response;
mod measure;
mod parameters;
mod path_ripple;

pub use channel::{Channel, UnknownChannel};
pub use contact_figures::ContactFigures;
pub use frequency_response::FrequencyResponse;
pub use measure::{Measurement, measure};
pub(crate) use parameters::check_sensors;
pub use parameters::{ResponseInput, Sensor, SensorDirection, SensorPlace};
pub use path_ripple::PathRipple;

use std::f64::consts::TAU;

use crate::machine::coordinates::*;
use crate::model::Model;
use crate::operation::TimeGrid;
use crate::solver::{Axis, Block, Output, Recorder};

/// (m/s²) One g, as the published model has it.
pub const GRAVITY_M_PER_S2: f64 = 9.81;

/// One row a channel: its kind, its name with the unit at the end, unit, meaning, and what of the solution it is.
macro_rules! channels {
    ($($kind:ident $name:ident $unit:literal $meaning:literal $output:expr;)+) => {
        /// A signal of [`Channels`].
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[non_exhaustive]
        pub enum ChannelKind {
            $(#[doc = concat!("(", $unit, ") ", $meaning, ".")] $kind,)+
        }

        impl ChannelKind {
            /// All of them, in the order of [`Channels`]' fields.
            pub const ALL: [Self; [$($unit),+].len()] = [$(Self::$kind),+];

            /// Name with the unit at its end, the same wherever a channel is named.
            pub fn name(self) -> &'static str {
                match self { $(Self::$kind => stringify!($name),)+ }
            }

            /// Unit.
            pub fn unit(self) -> &'static str {
                match self { $(Self::$kind => $unit,)+ }
            }

            /// Meaning, in a few words.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$kind => $meaning,)+ }
            }

            /// What is read off the solution.
            pub fn output(self) -> Output {
                match self { $(Self::$kind => $output,)+ }
            }
        }

        /// The kept signals, all at the same rate and equally long.
        #[derive(Debug, Clone, PartialEq, Default)]
        #[non_exhaustive]
        pub struct Channels {
            /// (S/s) Sampling rate.
            pub sampling_rate_hz: f64,
            /// (s) Time of the first kept sample since the start of the simulation.
            pub start_s: f64,
            $(#[doc = concat!("(", $unit, ") ", $meaning, ".")] pub $name: Vec<f64>,)+
            /// What the scenario's sensors show, in their order.
            pub sensors: Vec<SensorSignal>,
        }

        impl Channels {
            /// The signal of a kind.
            pub fn get(&self, kind: ChannelKind) -> &[f64] {
                match kind { $(ChannelKind::$kind => &self.$name,)+ }
            }

            /// The signal of a kind, to be filled.
            pub fn get_mut(&mut self, kind: ChannelKind) -> &mut Vec<f64> {
                match kind { $(ChannelKind::$kind => &mut self.$name,)+ }
            }
        }
    };
}

channels! {
    Horizontal horizontal_g "g" "horizontal acceleration of the supports, their mean, over 9.81 m/s²; under linear and published the sum of both wheels'"
        Output::Sensor(Axis::X, PER_G);
    Vertical vertical_g "g" "vertical acceleration of the supports, their mean, over 9.81 m/s²; under linear and published the sum of both wheels'"
        Output::Sensor(Axis::Y, PER_G);
    Axial axial_g "g" "sum of both wheels' axial accelerations, over 9.81 m/s²"
        Output::Sensor(Axis::Z, PER_G);
    PinionShaftSpeed pinion_shaft_speed_hz "Hz" "revolutions of the pinion per second"
        Output::Velocity(weighted(&[(THETA_PINION, 1.0 / TAU)]));
    GearShaftSpeed gear_shaft_speed_hz "Hz" "revolutions of the gear per second"
        Output::Velocity(weighted(&[(THETA_GEAR, -1.0 / TAU)]));
    MeshForce mesh_force_n "N"
        "force along the line of action; negative: back flanks touch, or the linear mesh pulls where real teeth would part"
        Output::MeshForce;
}

/// (s²/m) One over g.
const PER_G: f64 = 1.0 / GRAVITY_M_PER_S2;

fn weighted(terms: &[(usize, f64)]) -> Vec<f64> {
    let mut weights = vec![0.0; COORDINATES];
    for &(coordinate, weight) in terms {
        weights[coordinate] = weight;
    }
    weights
}

impl ChannelKind {
    /// Those that an accelerometer would show.
    pub const ACCELERATIONS: [Self; 3] = [Self::Horizontal, Self::Vertical, Self::Axial];
}

/// What [`Channels`] reads off the solution, in the order of [`ChannelKind::ALL`].
pub fn channel_outputs() -> [Output; ChannelKind::ALL.len()] {
    ChannelKind::ALL.map(ChannelKind::output)
}

/// What [`Channels`] of a scenario with sensors reads off the solution: that of [`channel_outputs`], then the sensors'.
///
/// # Arguments
/// * `sensors` - the scenario's
/// * `model` - of the mesh
pub(crate) fn outputs_of_all(sensors: &[Sensor], model: Model) -> Vec<Output> {
    channel_outputs().into_iter().chain(sensors.iter().map(|sensor| sensor.output(model))).collect()
}

/// The signal of a sensor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensorSignal {
    /// The sensor's name.
    pub name: String,
    /// (g) What it shows.
    pub values_g: Vec<f64>,
}

impl SensorSignal {
    /// The name of its channel, with the unit at the end.
    pub fn channel(&self) -> String {
        parameters::channel_of(&self.name)
    }
}

impl Sensor {
    /// What is read off the solution for it: its place's acceleration over g, or the force that goes through its frequency response.
    ///
    /// # Arguments
    /// * `model` - of the mesh: under `linear` and `published` there are no supports that move, and the wheels are read
    pub fn output(&self, model: Model) -> Output {
        if self.response_input == ResponseInput::Force {
            return Output::MeshForce;
        }
        let (axis, [pinion, gear], [pinion_support, gear_support]) = match self.direction {
            SensorDirection::Horizontal => (Axis::X, [X_PINION, X_GEAR], [X_PINION_SUPPORT, X_GEAR_SUPPORT]),
            SensorDirection::Vertical => (Axis::Y, [Y_PINION, Y_GEAR], [Y_PINION_SUPPORT, Y_GEAR_SUPPORT]),
            // No support moves along the shafts.
            SensorDirection::Axial => (Axis::Z, [Z_PINION, Z_GEAR], [Z_PINION, Z_GEAR]),
        };
        let of = |coordinates: &[usize]| {
            let mut weights = vec![0.0; COORDINATES_WITH_SUPPORTS];
            coordinates.iter().for_each(|&coordinate| weights[coordinate] = PER_G);
            Output::Acceleration(weights)
        };
        match (model, self.at) {
            (Model::Linear | Model::Published, _) | (Model::Contact, SensorPlace::Support) => {
                Output::Sensor(axis, PER_G)
            }
            (Model::Contact, SensorPlace::PinionSupport) => of(&[pinion_support]),
            (Model::Contact, SensorPlace::GearSupport) => of(&[gear_support]),
            (Model::Contact, SensorPlace::Wheels) => of(&[pinion, gear]),
        }
    }
}

impl Channels {
    /// Empty channels, with room for the kept samples.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn new(time: &TimeGrid) -> Self {
        let mut channels = Self {
            sampling_rate_hz: time.sampling_rate_hz,
            start_s: time.first_kept_sample as f64 * time.step_s(),
            ..Self::default()
        };
        for kind in ChannelKind::ALL {
            channels.get_mut(kind).reserve_exact(time.kept_samples());
        }
        channels
    }

    /// The same with room for some sensors too, which take the outputs behind those of [`ChannelKind::ALL`].
    ///
    /// # Arguments
    /// * `sensors` - the scenario's
    pub fn with_sensors(mut self, sensors: &[Sensor]) -> Self {
        let room = self.vertical_g.capacity();
        let signal =
            |sensor: &Sensor| SensorSignal { name: sensor.name(), values_g: Vec::with_capacity(room) };
        self.sensors = sensors.iter().map(signal).collect();
        self
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.vertical_g.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.vertical_g.is_empty()
    }

    /// (s) Time of sample `index` since the start of the simulation.
    pub fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / self.sampling_rate_hz
    }

    /// (-) Part of the kept time in which the mesh force is negative.
    pub fn tension_fraction(&self) -> f64 {
        let pulling = self.mesh_force_n.iter().filter(|&&force| force < 0.0).count();
        pulling as f64 / self.mesh_force_n.len().max(1) as f64
    }
}

impl Recorder for Channels {
    fn record(&mut self, block: &Block) {
        for (index, kind) in ChannelKind::ALL.into_iter().enumerate() {
            self.get_mut(kind).extend_from_slice(block.output(index));
        }
        for (index, sensor) in self.sensors.iter_mut().enumerate() {
            sensor.values_g.extend_from_slice(block.output(ChannelKind::ALL.len() + index));
        }
    }
}
