//! Outputs of the solution: the channels, as sensors on the rig would show them.
//!
//! A channel that every simulation has is a row of one table; its name is the same in the file of signals, in the list of a data
//! set's plan, in an experiment and in Python. Sensors that the scenario lists have channels of their own, `NAME_g`: the motion of
//! their place, and what the sensor makes of it ([`measure()`]).

mod channel;
mod contact_figures;
mod frequency_response;
mod measure;
mod noise;
mod parameters;
mod passage;
mod path;
mod path_ripple;

pub use channel::{Channel, UnknownChannel};
pub use contact_figures::ContactFigures;
pub use frequency_response::FrequencyResponse;
pub use measure::{Measurement, measure};
pub use noise::{add_recorded_noise, add_white_noise, standard_deviation_of_channel};
pub(crate) use parameters::check_sensors;
pub use parameters::{ResponseInput, Sensor, SensorDirection, SensorPlace};
pub use passage::Passage;
pub use path::SensorPath;
pub use path_ripple::PathRipple;

use std::f64::consts::TAU;

use crate::machine::{Axis, GEAR, GEAR_SUPPORT, PINION, PINION_SUPPORT, SUPPORTS, WHEELS};
use crate::operation::TimeGrid;
use crate::solver::{Block, Output, Recorder};

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
            /// All channels, in the order of [`Channels`]' fields.
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

            /// Output of the solution.
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
            /// Signals of the scenario's sensors, in their order.
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
    Horizontal horizontal_g "g" "horizontal acceleration of the support of the pinion's shaft, over 9.81 m/s²; under linear and published the sum of both wheels'"
        acceleration_g(PINION_SUPPORT, Axis::X);
    Vertical vertical_g "g" "vertical acceleration of the support of the pinion's shaft, over 9.81 m/s²; under linear and published the sum of both wheels'"
        acceleration_g(PINION_SUPPORT, Axis::Y);
    Axial axial_g "g" "sum of both wheels' axial accelerations, over 9.81 m/s²"
        acceleration_g(PINION_SUPPORT, Axis::Z);
    PinionShaftSpeed pinion_shaft_speed_hz "Hz" "revolutions of the pinion per second"
        speed_hz(PINION);
    GearShaftSpeed gear_shaft_speed_hz "Hz" "revolutions of the gear per second"
        speed_hz(GEAR);
    MeshForce mesh_force_n "N"
        "force along the line of action; negative: coast flanks touch, or the linear mesh pulls where real teeth would separate"
        Output::MeshForce { mesh: 0 };
}

/// (s²/m) One over g.
const PER_G: f64 = 1.0 / GRAVITY_M_PER_S2;

/// The acceleration of a place, in g.
fn acceleration_g(place: &'static str, axis: Axis) -> Output {
    Output::Acceleration { place: place.into(), axis, factor: PER_G }
}

/// The rotational speed of a wheel, in Hz.
fn speed_hz(wheel: &'static str) -> Output {
    Output::Velocity { place: wheel.into(), axis: Axis::Rotation, factor: 1.0 / TAU }
}

impl ChannelKind {
    /// Channels that an accelerometer would show.
    pub const ACCELERATIONS: [Self; 3] = [Self::Horizontal, Self::Vertical, Self::Axial];
}

/// Outputs of the solution for [`Channels`], in the order of [`ChannelKind::ALL`].
pub fn channel_outputs() -> [Output; ChannelKind::ALL.len()] {
    ChannelKind::ALL.map(ChannelKind::output)
}

/// The outputs that [`Channels`] of a scenario with sensors are made of: those of [`channel_outputs`], then the sensors'.
///
/// # Arguments
/// * `sensors` - the scenario's
pub(crate) fn outputs_of_all(sensors: &[Sensor]) -> Vec<Output> {
    channel_outputs().into_iter().chain(sensors.iter().map(Sensor::output)).collect()
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
    /// The output that it shows: the acceleration of its place over g, or the force that goes through its frequency response. Where
    /// a model has no supports that move, every place is that of both wheels.
    pub fn output(&self) -> Output {
        if self.response_input == ResponseInput::Force {
            return Output::MeshForce { mesh: 0 };
        }
        let axis = match self.direction {
            SensorDirection::Horizontal => Axis::X,
            SensorDirection::Vertical => Axis::Y,
            SensorDirection::Axial => Axis::Z,
        };
        let place = match self.at {
            SensorPlace::Support => SUPPORTS,
            SensorPlace::PinionSupport => PINION_SUPPORT,
            SensorPlace::GearSupport => GEAR_SUPPORT,
            SensorPlace::Wheels => WHEELS,
        };
        acceleration_g(place, axis)
    }
}

impl Channels {
    /// Empty channels, with room for the kept samples.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn new(time: &TimeGrid) -> Self {
        let mut channels =
            Self { sampling_rate_hz: time.sampling_rate_hz, start_s: time.kept_from_s(), ..Self::default() };
        for kind in ChannelKind::ALL {
            channels.get_mut(kind).reserve_exact(time.kept_samples());
        }
        channels
    }

    /// Channels with room for some sensors too, which take the outputs behind those of [`ChannelKind::ALL`].
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

    /// Returns whether there are no samples.
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
