//! Places of wheels and sensors in the words of the schema of `bearing-datasets`.

use meshtone::scenario::{Coupled, Scenario, SensorPlace};
use meshtone::sensor::{Channel, ChannelKind};

/// The columns of a raw channel.
pub(super) struct ChannelFacts {
    pub(super) name: String,
    pub(super) location: String,
    pub(super) mounting: &'static str,
    pub(super) quantity: &'static str,
    pub(super) unit: &'static str,
    pub(super) axis: &'static str,
}

/// A damaged wheel's place in the schema's words. The pinion of a pair is on the input shaft.
pub(super) fn wheel_location(wheel: &str, base: &Scenario) -> String {
    let shaft = base.wheels.iter().find(|other| other.name == wheel).map_or("", |wheel| &wheel.shaft);
    format!("gearbox_gear_{}", stage(base, shaft))
}

/// The same of a damaged bearing, by its shaft and place.
pub(super) fn bearing_location(bearing: &str, base: &Scenario) -> String {
    let shaft = bearing.split_once(':').map_or("", |(shaft, _)| shaft);
    format!("gearbox_bearing_{}", stage(base, shaft))
}

/// The stage of a machine that a shaft is, in the schema's words.
fn stage(base: &Scenario, shaft: &str) -> &'static str {
    match base.coupled(shaft) {
        Coupled::Motor => "input",
        Coupled::Brake => "output",
        _ => "intermediate",
    }
}

/// Returns whether one of two places is or contains the other, as the package compares them.
pub(super) fn is_at(sensor: &str, fault: &str) -> bool {
    let contains = |a: &str, b: &str| a == b || b.strip_prefix(a).is_some_and(|rest| rest.starts_with('_'));
    contains(sensor, fault) || contains(fault, sensor)
}

/// The schema's words for the place and the measurement of a channel.
pub(super) fn facts(channel: &Channel, base: &Scenario) -> ChannelFacts {
    let name = channel.name().into_owned();
    let facts = |location: &str, mounting, quantity, axis| ChannelFacts {
        name: name.clone(),
        location: location.to_owned(),
        mounting,
        quantity,
        unit: channel.unit(),
        axis,
    };
    match channel {
        Channel::Fixed(kind) => match kind {
            ChannelKind::PinionShaftSpeed => facts("gearbox_shaft_input", "none", "speed", "none"),
            ChannelKind::GearShaftSpeed => facts("gearbox_shaft_output", "none", "speed", "none"),
            ChannelKind::MeshForce => facts("gearbox_gear", "none", "force", "none"),
            ChannelKind::Axial => facts("gearbox", "unknown", "acceleration", "axial"),
            kind => {
                let axis = if *kind == ChannelKind::Horizontal { "horizontal" } else { "vertical" };
                if base.rig().is_some() && base.model.teeth_part() {
                    facts("gearbox_bearing_input", "pedestal", "acceleration", axis)
                } else {
                    facts("gearbox", "unknown", "acceleration", axis)
                }
            }
        },
        _ => {
            let (location, mounting, axis) = sensor_facts(&name, base);
            facts(&location, mounting, "acceleration", axis)
        }
    }
}

/// Place, mounting and direction of a listed sensor.
fn sensor_facts(channel: &str, base: &Scenario) -> (String, &'static str, &'static str) {
    let sensors = base.all_sensors();
    let Some(sensor) = sensors.iter().find(|sensor| sensor.channel() == channel) else {
        return ("unknown".to_owned(), "unknown", "unknown");
    };
    let (location, mounting) = match &sensor.at {
        SensorPlace::Support => ("gearbox".to_owned(), "pedestal"),
        SensorPlace::PinionSupport => ("gearbox_bearing_input".to_owned(), "pedestal"),
        SensorPlace::GearSupport => ("gearbox_bearing_output".to_owned(), "pedestal"),
        SensorPlace::Wheels => ("gearbox_gear".to_owned(), "unknown"),
        SensorPlace::Of(place) => match place.split(':').collect::<Vec<_>>()[..] {
            ["shaft", shaft, _] => (format!("gearbox_shaft_{}", stage(base, shaft)), "shaft"),
            ["housing", ..] => ("gearbox".to_owned(), "casing"),
            [shaft, ..] => (format!("gearbox_bearing_{}", stage(base, shaft)), "casing"),
            [] => ("gearbox".to_owned(), "unknown"),
        },
    };
    (location, mounting, sensor.direction.name())
}
