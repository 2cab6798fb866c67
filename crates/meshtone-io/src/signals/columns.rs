//! The columns of a file of signals.

use meshtone::signal::Channels;

/// A column: name, unit and meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name, with the unit at its end.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Meaning.
    pub description: &'static str,
}

/// The first column.
pub const TIME: Column =
    Column { name: "time_s", unit: "s", description: "time since the start of the simulation" };

const HORIZONTAL: Column = Column {
    name: "horizontal_acceleration_g",
    unit: "g",
    description: "sum of both wheels' horizontal accelerations, over 9.81 m/s²",
};
const VERTICAL: Column = Column {
    name: "vertical_acceleration_g",
    unit: "g",
    description: "sum of both wheels' vertical accelerations, over 9.81 m/s²",
};
const AXIAL: Column = Column {
    name: "axial_acceleration_g",
    unit: "g",
    description: "sum of both wheels' axial accelerations, over 9.81 m/s²",
};
const PINION_SPEED: Column =
    Column { name: "pinion_shaft_speed_hz", unit: "Hz", description: "revolutions of the pinion per second" };
const GEAR_SPEED: Column =
    Column { name: "gear_shaft_speed_hz", unit: "Hz", description: "revolutions of the gear per second" };
const MESH_FORCE: Column = Column {
    name: "mesh_force_n",
    unit: "N",
    description: "force along the line of action; negative: the linear mesh pulls",
};

/// The columns after [`TIME`], each with its signal.
///
/// # Arguments
/// * `channels` - the signals
pub fn columns(channels: &Channels) -> [(Column, &[f64]); 6] {
    [
        (HORIZONTAL, &channels.horizontal_g),
        (VERTICAL, &channels.vertical_g),
        (AXIAL, &channels.axial_g),
        (PINION_SPEED, &channels.pinion_speed_hz),
        (GEAR_SPEED, &channels.gear_speed_hz),
        (MESH_FORCE, &channels.mesh_force_n),
    ]
}

/// The channel of each column of [`columns`], to be filled.
pub(super) fn columns_mut(channels: &mut Channels) -> [(Column, &mut Vec<f64>); 6] {
    [
        (HORIZONTAL, &mut channels.horizontal_g),
        (VERTICAL, &mut channels.vertical_g),
        (AXIAL, &mut channels.axial_g),
        (PINION_SPEED, &mut channels.pinion_speed_hz),
        (GEAR_SPEED, &mut channels.gear_speed_hz),
        (MESH_FORCE, &mut channels.mesh_force_n),
    ]
}
