//! The name of a channel in a file.

use meshtone::scenario::Scenario;
use meshtone::sensor::{Channel, ChannelKind};
use meshtone_toml::{ReadResult, TomlValue};

/// Reads the name of one of some channels.
///
/// # Arguments
/// * `value` - a name
/// * `allowed` - the channels that may be named
///
/// # Errors
/// The value is no text, or names none of them; the error names all.
pub fn read_channel(value: &TomlValue<'_>, allowed: &[Channel]) -> ReadResult<Channel> {
    let names: Vec<_> = allowed.iter().map(|channel| (channel.name(), channel)).collect();
    let choices: Vec<(&str, Channel)> =
        names.iter().map(|(name, channel)| (name.as_ref(), (*channel).clone())).collect();
    value.choice(&choices)
}

/// The accelerations of a scenario, sensors first: of shafts of beams those of its sensors alone.
///
/// # Arguments
/// * `scenario` - a valid one
pub fn accelerations(scenario: &Scenario) -> Vec<Channel> {
    let sensors = scenario.all_sensors();
    match scenario.rig() {
        Some(_) => Channel::all(&sensors).into_iter().filter(Channel::is_acceleration).collect(),
        None => sensors.iter().map(|sensor| Channel::Sensor(sensor.name())).collect(),
    }
}

/// Reads the name of an acceleration of a scenario that is not known: any sensor may be named.
///
/// # Arguments
/// * `value` - a name
///
/// # Errors
/// The value is no text, or no such name.
pub(crate) fn read_any_acceleration(value: &TomlValue<'_>) -> ReadResult<Channel> {
    let sensor = value.string().ok().and_then(Channel::named).filter(Channel::is_acceleration);
    sensor.map_or_else(|| read_channel(value, &ChannelKind::ACCELERATIONS.map(Channel::Fixed)), Ok)
}
