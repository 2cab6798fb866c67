//! A channel: one that every simulation has, or a sensor's.

use std::borrow::Cow;

use super::parameters::{channel_of, is_name};
use super::{ChannelKind, NamedSignal, Sensor, SignalSource};

/// A signal of a simulation, by its name.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Channel {
    /// One that every simulation has.
    Fixed(ChannelKind),
    /// The channel of the sensor of this name.
    Sensor(String),
}

impl From<ChannelKind> for Channel {
    fn from(kind: ChannelKind) -> Self {
        Self::Fixed(kind)
    }
}

/// A text that names no channel.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no channel `{name}`; there are {}", known.join(", "))]
#[non_exhaustive]
pub struct UnknownChannel {
    /// The text.
    pub name: String,
    /// The channels that there are.
    pub known: Vec<String>,
}

impl UnknownChannel {
    fn among(name: &str, known: &[Channel]) -> Self {
        let known = known.iter().map(|channel| channel.name().into_owned()).collect();
        Self { name: name.to_owned(), known }
    }
}

impl Channel {
    /// The channels of a simulation, sensors first.
    ///
    /// # Arguments
    /// * `sensors` - the scenario's
    ///
    /// ```
    /// use meshtone::scenario::Sensor;
    /// use meshtone::sensor::Channel;
    ///
    /// let names: Vec<_> = Channel::all(&[Sensor::default()]).iter().map(|channel| channel.name().into_owned()).collect();
    /// assert_eq!(names[..2], ["pinion_support_vertical_g", "horizontal_g"]);
    /// ```
    pub fn all(sensors: &[Sensor]) -> Vec<Self> {
        let sensors = sensors.iter().map(|sensor| Self::Sensor(sensor.name()));
        sensors.chain(ChannelKind::ALL.map(Self::Fixed)).collect()
    }

    /// The channel that is looked at first: the first sensor's, or the vertical acceleration where none is listed.
    ///
    /// # Arguments
    /// * `sensors` - the scenario's
    pub fn leading(sensors: &[Sensor]) -> Self {
        sensors.first().map_or(Self::Fixed(ChannelKind::Vertical), |sensor| Self::Sensor(sensor.name()))
    }

    /// The channel of a name, `NAME_g` for a sensor's, whatever sensors a scenario has.
    ///
    /// # Arguments
    /// * `name` - with the unit at its end
    ///
    /// ```
    /// use meshtone::sensor::{Channel, ChannelKind};
    ///
    /// assert_eq!(Channel::named("vertical_g"), Some(Channel::Fixed(ChannelKind::Vertical)));
    /// assert_eq!(Channel::named("bearing_1_g"), Some(Channel::Sensor("bearing_1".into())));
    /// assert_eq!(Channel::named("bearing 1"), None);
    /// ```
    pub fn named(name: &str) -> Option<Self> {
        let fixed = ChannelKind::ALL.into_iter().find(|kind| kind.name() == name).map(Self::Fixed);
        let sensor =
            || name.strip_suffix("_g").filter(|name| is_name(name)).map(str::to_owned).map(Self::Sensor);
        fixed.or_else(sensor)
    }

    /// The channel of a name, of a simulation with some sensors.
    ///
    /// # Arguments
    /// * `name` - with the unit at its end
    /// * `sensors` - the scenario's
    ///
    /// # Errors
    /// There is none of that name; the error lists those that there are.
    pub fn of(name: &str, sensors: &[Sensor]) -> Result<Self, UnknownChannel> {
        let all = Self::all(sensors);
        let of_name = all.iter().find(|channel| channel.name() == name).cloned();
        of_name.ok_or_else(|| UnknownChannel::among(name, &all))
    }

    /// Name with the unit at its end, the same wherever a channel is named.
    pub fn name(&self) -> Cow<'static, str> {
        match self {
            Self::Fixed(kind) => kind.name().into(),
            Self::Sensor(name) => channel_of(name).into(),
        }
    }

    /// Unit.
    pub fn unit(&self) -> &'static str {
        match self {
            Self::Fixed(kind) => kind.unit(),
            Self::Sensor(_) => SignalSource::Sensor(0).unit(),
        }
    }

    /// Meaning, in a few words.
    pub fn meaning(&self) -> &'static str {
        match self {
            Self::Fixed(kind) => kind.meaning(),
            Self::Sensor(_) => NamedSignal::MEANING_OF_SENSOR,
        }
    }

    /// Returns whether it is an acceleration: a sensor's, or one that a sensor on all supports or wheels would show.
    pub fn is_acceleration(&self) -> bool {
        match self {
            Self::Fixed(kind) => ChannelKind::ACCELERATIONS.contains(kind),
            Self::Sensor(_) => true,
        }
    }
}
