//! The name of a channel in a file.

use meshtone::scenario::Sensor;
use meshtone::sensor::Channel;
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

/// The accelerations of a scenario, sensors first.
///
/// # Arguments
/// * `sensors` - the scenario's
pub fn accelerations(sensors: &[Sensor]) -> Vec<Channel> {
    Channel::all(sensors).into_iter().filter(Channel::is_acceleration).collect()
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
    sensor.map_or_else(|| read_channel(value, &accelerations(&[])), Ok)
}
