//! The name of a channel in a file.

use meshtone::sensor::ChannelKind;
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
pub fn read_channel(value: &TomlValue<'_>, allowed: &[ChannelKind]) -> ReadResult<ChannelKind> {
    let names: Vec<_> = allowed.iter().map(|kind| (kind.name(), *kind)).collect();
    value.choice(&names).or_else(|error| {
        let former =
            FORMER_NAMES.iter().find(|(name, kind)| value.string() == Ok(name) && allowed.contains(kind));
        former.map(|(_, kind)| *kind).ok_or(error)
    })
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
