//! Places of wheels and sensors in the words of the schema of `bearing-datasets`.

use meshtone::scenario::{Coupled, Gearbox, Model, ScenarioForm, Sensor, SensorPlace};
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
pub(super) fn wheel_location(wheel: &str, base: &ScenarioForm) -> String {
    let stage = match base {
        ScenarioForm::Gearbox(gearbox) => {
            let shaft =
                gearbox.wheels.iter().find(|other| other.name == wheel).map_or("", |wheel| &wheel.shaft);
            stage(gearbox, shaft)
        }
        _ if wheel == "pinion" => "input",
        _ => "output",
    };
    format!("gearbox_gear_{stage}")
}

/// The same of a damaged bearing, by its shaft and place.
pub(super) fn bearing_location(bearing: &str, base: &ScenarioForm) -> String {
    let shaft = bearing.split_once(':').map_or("", |(shaft, _)| shaft);
    match base {
        ScenarioForm::Gearbox(gearbox) => format!("gearbox_bearing_{}", stage(gearbox, shaft)),
        _ => "gearbox_bearing".to_owned(),
    }
}

/// The stage of a gearbox that a shaft is, in the schema's words.
fn stage(gearbox: &Gearbox, shaft: &str) -> &'static str {
    match gearbox.shafts.iter().find(|other| other.name == shaft).map(|shaft| shaft.couples_to) {
        Some(Coupled::Motor) => "input",
        Some(Coupled::Brake) => "output",
        _ => "intermediate",
    }
}

/// Returns whether one of two places is or contains the other, as the package compares them.
pub(super) fn is_at(sensor: &str, fault: &str) -> bool {
    let contains = |a: &str, b: &str| a == b || b.strip_prefix(a).is_some_and(|rest| rest.starts_with('_'));
    contains(sensor, fault) || contains(fault, sensor)
}

/// The schema's words for the place and the measurement of a channel.
pub(super) fn facts(channel: &Channel, base: &ScenarioForm) -> ChannelFacts {
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
                match base {
                    ScenarioForm::Pair(pair) if Model::teeth_part(pair.model) => {
                        facts("gearbox_bearing_input", "pedestal", "acceleration", axis)
                    }
                    _ => facts("gearbox", "unknown", "acceleration", axis),
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
fn sensor_facts(channel: &str, base: &ScenarioForm) -> (String, &'static str, &'static str) {
    match base {
        ScenarioForm::Gearbox(gearbox) => {
            let sensors = gearbox.all_sensors();
            let Some(sensor) = sensors.iter().find(|sensor| sensor.channel() == channel) else {
                return ("unknown".to_owned(), "unknown", "unknown");
            };
            let axis = sensor.direction.name();
            match sensor.at.name().split(':').collect::<Vec<_>>()[..] {
                ["shaft", shaft, _] => (format!("gearbox_shaft_{}", stage(gearbox, shaft)), "shaft", axis),
                ["housing", ..] => ("gearbox".to_owned(), "casing", axis),
                [shaft, ..] => (format!("gearbox_bearing_{}", stage(gearbox, shaft)), "casing", axis),
                [] => ("gearbox".to_owned(), "unknown", axis),
            }
        }
        ScenarioForm::Pair(pair) => {
            let is_meant = |sensor: &&Sensor| Channel::Sensor(sensor.name()).name() == channel;
            let Some(sensor) = pair.sensors.iter().find(is_meant) else {
                return ("unknown".to_owned(), "unknown", "unknown");
            };
            let (location, mounting) = match sensor.at {
                SensorPlace::Support => ("gearbox", "pedestal"),
                SensorPlace::PinionSupport => ("gearbox_bearing_input", "pedestal"),
                SensorPlace::GearSupport => ("gearbox_bearing_output", "pedestal"),
                SensorPlace::Wheels => ("gearbox_gear", "unknown"),
                SensorPlace::Of(_) => ("gearbox", "unknown"),
            };
            (location.to_owned(), mounting, sensor.direction.name())
        }
    }
}
