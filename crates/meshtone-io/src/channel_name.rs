//! The name of a channel in a file.

use meshtone::scenario::Sensor;
use meshtone::sensor::{Channel, ChannelKind};
use meshtone_toml::{ReadResult, TomlValue};

/// What channels are called in plans and experiments of earlier versions.
const FORMER_NAMES: [(&str, ChannelKind); 6] = [
    ("horizontal", ChannelKind::Horizontal),
    ("vertical", ChannelKind::Vertical),
    ("axial", ChannelKind::Axial),
    ("pinion-speed", ChannelKind::PinionShaftSpeed),
    ("gear-speed", ChannelKind::GearShaftSpeed),
    ("mesh-force", ChannelKind::MeshForce),
];

/// Reads the name of one of some channels. What plans and experiments of earlier versions call them is understood too: a data set
/// holds the plan that it was made from.
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
    value.choice(&choices).or_else(|error| {
        let former = FORMER_NAMES.iter().find(|(name, _)| value.string() == Ok(name));
        former.map(|(_, kind)| Channel::from(*kind)).filter(|channel| allowed.contains(channel)).ok_or(error)
    })
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

/// What a channel's column is called in files of signals of earlier versions.
pub(crate) fn former_column(kind: ChannelKind) -> &'static str {
    match kind {
        ChannelKind::Horizontal => "horizontal_acceleration_g",
        ChannelKind::Vertical => "vertical_acceleration_g",
        ChannelKind::Axial => "axial_acceleration_g",
        other => other.name(),
    }
}
