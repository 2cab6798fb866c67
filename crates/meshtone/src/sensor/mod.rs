//! Outputs of the solution: the channels, as sensors on the rig would show them.
//!
//! The signals of a simulation are a list ([`Channels`]), whatever the form of the machine: each has a name, which is the same in the file
//! of signals, in the list of a data set's plan, in an experiment and in Python, a unit, and a source, the part of the machine that it is
//! of. Sensors come first, as `NAME_g`: the motion of their place, and what the sensor makes of it ([`measure()`]).

mod channel;
mod channels;
mod contact_figures;
mod frequency_response;
mod measure;
mod noise;
mod parameters;
mod passage;
mod path;
mod path_ripple;

pub use channel::{Channel, UnknownChannel};
pub use channels::{Channels, NamedSignal, SignalSource};
pub use contact_figures::ContactFigures;
pub use frequency_response::FrequencyResponse;
pub use measure::{Measurement, measure};
pub use noise::{add_recorded_noise, add_white_noise, standard_deviation_of_channel};
pub use parameters::{ResponseInput, Sensor, SensorDirection, SensorPlace};
pub(crate) use parameters::{RingPlace, check_own_name, check_sensors};
pub use passage::Passage;
pub use path::SensorPath;
pub use path_ripple::PathRipple;

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, TAU};

use crate::machine::{Axis, GEAR, GEAR_SUPPORT, PINION, PINION_SUPPORT, SUPPORTS, WHEELS};
use crate::solver::{OnRing, Output};

/// (m/s²) One g, as the published model has it.
pub const GRAVITY_M_PER_S2: f64 = 9.81;

/// A signal that every simulation of a pair has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ChannelKind {
    /// (g) Horizontal acceleration of the pinion's support.
    Horizontal,
    /// (g) Vertical acceleration of the pinion's support.
    Vertical,
    /// (g) Sum of both wheels' axial accelerations.
    Axial,
    /// (Hz) Speed of the pinion.
    PinionShaftSpeed,
    /// (Hz) Speed of the gear.
    GearShaftSpeed,
    /// (N) Force along the line of action.
    MeshForce,
}

/// (s²/m) One over g.
const PER_G: f64 = 1.0 / GRAVITY_M_PER_S2;

/// The acceleration of a place, in g.
fn acceleration_g(place: impl Into<Cow<'static, str>>, axis: Axis) -> Output {
    Output::Acceleration { place: place.into(), axis, factor: PER_G }
}

/// The rotational speed of a wheel, in Hz.
fn speed_hz(wheel: &'static str) -> Output {
    Output::Velocity { place: wheel.into(), axis: Axis::Rotation, factor: 1.0 / TAU }
}

// In the order of files, each with its unit at the end of its name, the same wherever a channel is named.
meshtone_toml::named!(ChannelKind {
    Horizontal = "horizontal_g",
    Vertical = "vertical_g",
    Axial = "axial_g",
    PinionShaftSpeed = "pinion_shaft_speed_hz",
    GearShaftSpeed = "gear_shaft_speed_hz",
    MeshForce = "mesh_force_n",
});

impl ChannelKind {
    /// Channels that an accelerometer would show.
    pub const ACCELERATIONS: [Self; 3] = [Self::Horizontal, Self::Vertical, Self::Axial];

    /// What the signal is of.
    pub fn source(self) -> SignalSource {
        self.row().0
    }

    /// Meaning, in a few words.
    pub fn meaning(self) -> &'static str {
        self.row().1
    }

    /// Unit.
    pub fn unit(self) -> &'static str {
        self.source().unit()
    }

    fn row(self) -> (SignalSource, &'static str) {
        use SensorDirection::{Axial, Horizontal, Vertical};
        use SignalSource::{MeshForce, ShaftSpeed, Supports};
        match self {
            Self::Horizontal => (
                Supports(Horizontal),
                "horizontal acceleration of the support of the pinion's shaft, over 9.81 m/s²; under linear and published the sum of both wheels'",
            ),
            Self::Vertical => (
                Supports(Vertical),
                "vertical acceleration of the support of the pinion's shaft, over 9.81 m/s²; under linear and published the sum of both wheels'",
            ),
            Self::Axial => (Supports(Axial), "sum of both wheels' axial accelerations, over 9.81 m/s²"),
            Self::PinionShaftSpeed => (ShaftSpeed(0), "revolutions of the pinion per second"),
            Self::GearShaftSpeed => (ShaftSpeed(1), "revolutions of the gear per second"),
            Self::MeshForce => (
                MeshForce(0),
                "force along the line of action; negative: coast flanks touch, or the linear mesh pulls where real teeth would separate",
            ),
        }
    }

    /// Output of the solution.
    pub fn output(self) -> Output {
        match self {
            Self::Horizontal => acceleration_g(PINION_SUPPORT, Axis::X),
            Self::Vertical => acceleration_g(PINION_SUPPORT, Axis::Y),
            Self::Axial => acceleration_g(PINION_SUPPORT, Axis::Z),
            Self::PinionShaftSpeed => speed_hz(PINION),
            Self::GearShaftSpeed => speed_hz(GEAR),
            Self::MeshForce => Output::MeshForce { mesh: 0 },
        }
    }
}

impl SensorDirection {
    /// The axis that is measured along.
    pub(crate) fn axis(self) -> Axis {
        match self {
            Self::Horizontal => Axis::X,
            Self::Vertical => Axis::Y,
            Self::Axial => Axis::Z,
            // Of a place on a ring, which no axis measures.
            Self::Radial | Self::Tangential => Axis::Rotation,
        }
    }

    /// (rad) The direction at a place on a ring, from x towards y; none along the shafts.
    fn on_ring_rad(self, angle_rad: f64) -> Option<f64> {
        match self {
            Self::Radial => Some(angle_rad),
            Self::Tangential => Some(angle_rad + FRAC_PI_2),
            Self::Horizontal => Some(0.0),
            Self::Vertical => Some(FRAC_PI_2),
            Self::Axial => None,
        }
    }
}

impl Sensor {
    /// The output that it shows: the acceleration of its place over g, or the force that goes through its frequency response. Where
    /// a model has no supports that move, every place is that of both wheels.
    ///
    /// # Arguments
    /// * `sets` - names of the planetary sets
    pub fn output(&self, sets: &[&str]) -> Output {
        if self.response_input == ResponseInput::Force {
            return Output::MeshForce { mesh: 0 };
        }
        if let Some(RingPlace { set, angle_rad, is_far }) = RingPlace::of(self.at.name())
            && let Some(set) = sets.iter().position(|name| *name == set)
            && let Some(direction_rad) = self.direction.on_ring_rad(angle_rad)
        {
            return Output::OnRing(OnRing { set, angle_rad, direction_rad, is_far, factor: PER_G });
        }
        let (place, axis) = self.place();
        acceleration_g(place, axis)
    }

    /// The name of the machine's place that it sits on, and the axis that it measures along.
    pub(crate) fn place(&self) -> (Cow<'static, str>, Axis) {
        let place = match self.at {
            SensorPlace::Support => Cow::from(SUPPORTS),
            SensorPlace::PinionSupport => PINION_SUPPORT.into(),
            SensorPlace::GearSupport => GEAR_SUPPORT.into(),
            SensorPlace::Wheels => WHEELS.into(),
            // The machine of shafts of beams has a place for each sensor.
            SensorPlace::Of(_) => self.name().into(),
        };
        (place, self.direction.axis())
    }
}
