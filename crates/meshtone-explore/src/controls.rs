//! The source of the page's controls: the same rows as the guide's lists, the commented files and Python's signatures.

use meshtone::bearing::{NAMED_BEARINGS, NamedBearing};
use meshtone::damage::{DamageKind, damage_kinds};
use meshtone::scenario::{
    Bearing, BearingKind, Fault, GearboxRig, KeyDescription, KeyKind, Scenario, SectionDescription,
    gearbox_sections, gearbox_template, sections,
};
use serde_json::{Value, json};

use crate::answer::gearbox_sections_json;
use crate::export::without_defaults;
use crate::presets::{Preset, presets};

fn section_json(SectionDescription { name, keys, .. }: &SectionDescription) -> Value {
    json!({ "name": name, "keys": keys.iter().map(key_json).collect::<Vec<_>>() })
}

/// Sections and keys of a gearbox and of a fault on one of its wheels, the kinds of damage, and the bearings by name.
pub fn gearbox_controls() -> Value {
    let mut listed: Vec<Value> = gearbox_sections().iter().map(section_json).collect();
    listed.extend(sections().iter().filter(|section| section.name == "fault").map(section_json));
    let rigs = [None].into_iter().chain(GearboxRig::ALL.map(Some));
    json!({
        "sections": listed,
        "kinds": damage_kinds().iter().map(kind_json).collect::<Vec<_>>(),
        "bearings": NAMED_BEARINGS.iter().filter_map(bearing_json).collect::<Vec<_>>(),
        "presets": rigs.filter_map(gearbox_preset).collect::<Vec<_>>(),
        "version": env!("CARGO_PKG_VERSION"),
    })
}

/// A gearbox to start from: what is published of a rig, or the example.
fn gearbox_preset(rig: Option<GearboxRig>) -> Option<Value> {
    let name = rig.map_or("example", GearboxRig::name);
    let scenario = gearbox_sections_json(&Scenario::from_toml(&gearbox_template(rig)).ok()?);
    Some(json!({ "name": name, "title": rig.map_or("Two stages", GearboxRig::name), "scenario": scenario }))
}

/// A named bearing with the kind and the sizes that a scenario gives it; none of one that a scenario cannot have.
fn bearing_json(named: &NamedBearing) -> Option<Value> {
    let NamedBearing { name, geometry, .. } = named;
    let kinds = [BearingKind::Ball, BearingKind::Roller];
    let kind = kinds.into_iter().find(|kind| {
        let mut bearing = Bearing::new("", 0.0);
        (bearing.kind, bearing.name) = (*kind, Some((*name).to_owned()));
        bearing.rolling().is_ok()
    })?;
    // Sizes of inches would have the last digits of floating point.
    let rounded = |mm: f64| (mm * 1e6).round() / 1e6;
    Some(json!({
        "name": name,
        "kind": if kind == BearingKind::Ball { "ball" } else { "roller" },
        "sizes": {
            "elements": geometry.elements,
            "element_mm": rounded(geometry.element_mm),
            "pitch_mm": rounded(geometry.pitch_mm),
            "contact_angle_deg": geometry.contact_angle_deg,
        },
    }))
}

/// Sections and keys, kinds of damage, and scenarios to start from.
pub fn controls() -> Value {
    let preset = |Preset { name, title, toml }: Preset| {
        let scenario = Scenario::from_toml(toml).ok()?;
        Some(json!({ "name": name, "title": title, "scenario": Value::Object(without_defaults(&scenario)) }))
    };
    // A pair has no planets.
    let of_pair = |mut section: SectionDescription| {
        section.keys.retain(|key| section.name != "fault" || key.key != "flank");
        section
    };
    json!({
        "sections": sections().into_iter().map(of_pair).map(|section| section_json(&section)).collect::<Vec<_>>(),
        "kinds": damage_kinds().iter().map(kind_json).collect::<Vec<_>>(),
        "presets": presets().into_iter().filter_map(preset).collect::<Vec<_>>(),
        "version": env!("CARGO_PKG_VERSION"),
    })
}

fn key_json(key: &KeyDescription) -> Value {
    let (kind, names) = match &key.kind {
        KeyKind::Number => ("number", Vec::new()),
        KeyKind::Whole => ("whole", Vec::new()),
        KeyKind::Teeth => ("teeth", Vec::new()),
        KeyKind::Name(names) | KeyKind::NameOrTable(names) => ("name", names.clone()),
        KeyKind::Numbers(_) | KeyKind::List | KeyKind::NumberOrNumbers(_) => ("numbers", Vec::new()),
        KeyKind::Table => ("table", Vec::new()),
        KeyKind::Text => ("text", Vec::new()),
        KeyKind::File => ("file", Vec::new()),
        KeyKind::Profile => ("profile", Vec::new()),
        // Frequency responses, matrices: too many numbers for a control; the scenario's text has them.
        _ => ("value", Vec::new()),
    };
    json!({
        "key": key.key,
        "unit": key.unit,
        "meaning": key.meaning,
        "required": key.required,
        "default": key.default,
        "allowed": key.allowed,
        "bounds": key.bounds,
        "kind": kind,
        "names": names,
        "ignored_by": key.ignored_by,
    })
}

fn kind_json(kind: &DamageKind) -> Value {
    json!({
        "name": kind.name,
        "summary": kind.summary,
        "sizes": kind.sizes,
        "keys": kind.keys.iter().map(key_json).collect::<Vec<_>>(),
        "example": example_json(kind),
    })
}

/// The section of a fault to start from.
fn example_json(kind: &DamageKind) -> Value {
    let healthy = presets().first().and_then(|preset| Scenario::from_toml(preset.toml).ok());
    let example =
        healthy.map(|healthy| healthy.with_faults(vec![Fault::at_usual_place(kind.example.clone())]));
    let sections = example.and_then(|example| serde_json::to_value(example).ok()).unwrap_or_default();
    sections.get("fault").cloned().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn controls_have_units_bounds_and_examples() {
        let controls = controls();
        let module = &controls["sections"][1]["keys"][0];
        assert_eq!((&module["key"], &module["unit"]), (&json!("module_mm"), &json!("mm")));
        assert_eq!(module["bounds"], json!([0.0, 100.0]));
        for kind in controls["kinds"].as_array().unwrap() {
            assert_eq!(kind["example"]["kind"], kind["name"]);
        }
        assert_eq!(controls["presets"].as_array().unwrap().len(), presets().len());
        let breakage = &controls["kinds"][1];
        assert_eq!(breakage["sizes"], json!(["chip_height_mm", "chip_width_mm", "tip_loss_mm"]));
    }

    #[test]
    fn named_bearings_are_of_the_kind_that_a_scenario_gives_them() {
        let controls = gearbox_controls();
        let bearings = controls["bearings"].as_array().unwrap();
        let names: Vec<&str> = bearings.iter().map(|bearing| bearing["name"].as_str().unwrap()).collect();
        // The rollers of a ZA-2115 stand at an angle, which cylindrical ones do not.
        assert_eq!(names, ["6203", "6205", "ER-10K", "ER-16K", "UER204"]);
        assert!(bearings.iter().all(|bearing| bearing["kind"] == "ball"));
        let sizes = json!({ "elements": 9, "element_mm": 7.94, "pitch_mm": 39.04, "contact_angle_deg": 0.0 });
        assert_eq!(bearings[1]["sizes"], sizes);
    }
}
