//! Files that the page offers for download: the scenario as TOML and as Python, the picture as SVG, the signals as Parquet.

use meshtone::damage::damage_kinds;
use meshtone::scenario::{GearPair, KeyDescription, Scenario};
use meshtone_io::run_identity::RunIdentity;
use meshtone_io::signals::SignalTable;
use serde_json::{Map, Value};

use crate::question::memory_limit;
use crate::refusal::Refusal;

/// A file for the user.
pub struct Exported {
    /// Its ending.
    pub ending: &'static str,
    /// Media type that a browser receives.
    pub media_type: &'static str,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Makes a file of a scenario.
///
/// # Arguments
/// * `form` - `toml`, `python`, `svg` or `parquet`
/// * `scenario` - what is handed out
/// * `is_wanted` - whether it still is
///
/// # Errors
/// Another form; a scenario that cannot be simulated or drawn; no longer wanted.
pub fn export(form: &str, scenario: &Scenario, is_wanted: &dyn Fn() -> bool) -> Result<Exported, Refusal> {
    let simulated = || {
        let stages = meshtone::stages_within(scenario, memory_limit())?;
        stages.simulate_while(is_wanted)?.ok_or(Refusal::Superseded)
    };
    let text = |ending, media_type, text: String| Exported { ending, media_type, bytes: text.into_bytes() };
    match form {
        "toml" => Ok(text("toml", "application/toml", meshtone::written_out(&scenario.to_toml()))),
        "python" => Ok(text("py", "text/x-python", python(scenario))),
        "svg" => {
            let simulation = simulated()?;
            let drawn = meshtone_plot::panel::draw(&simulation);
            let figure = drawn.map_err(|error| Refusal::unfit(error.to_string()))?;
            let run = RunIdentity::of(scenario).to_string();
            Ok(text("svg", "image/svg+xml", figure.of_run(&run).svg().to_owned()))
        }
        "parquet" => {
            let mut bytes = Vec::new();
            SignalTable::of_scenario(scenario, &simulated()?.channels)
                .write_parquet(&mut bytes)
                .map_err(|error| Refusal::unfit(format!("the signals cannot be written: {error}")))?;
            Ok(Exported { ending: "parquet", media_type: "application/vnd.apache.parquet", bytes })
        }
        other => {
            Err(Refusal::unfit(format!("`{other}` is not a format; must be toml, python, svg or parquet")))
        }
    }
}

/// The sections and keys of a scenario without those that are at their defaults.
///
/// # Arguments
/// * `scenario` - the whole
pub fn without_defaults(scenario: &Scenario) -> Map<String, Value> {
    let (own, default) = (sections(scenario), sections(&with_defaults(scenario)));
    let required = required();
    let kept = own.into_iter().filter_map(|(name, value)| {
        let Some(default) = default.get(&name) else { return Some((name, value)) };
        let kept = match (value, default) {
            (Value::Object(keys), Value::Object(defaults)) => {
                let is_kept = |key: &String, value: &Value| {
                    required.contains(&key.as_str()) || defaults.get(key) != Some(value)
                };
                Value::Object(keys.into_iter().filter(|(key, value)| is_kept(key, value)).collect())
            }
            (value, default) if value == *default => return None,
            (value, _) => value,
        };
        (kept != Value::Object(Map::new())).then_some((name, kept))
    });
    kept.collect()
}

/// A scenario of the same gears, speed and load, with every other key at its default.
fn with_defaults(scenario: &Scenario) -> Scenario {
    let gears = scenario.gears();
    Scenario::new(GearPair {
        module_mm: gears.module_mm,
        pinion_teeth: gears.pinion_teeth,
        gear_teeth: gears.gear_teeth,
        face_width_mm: gears.face_width_mm,
        pinion_speed_hz: scenario.operation.pinion_speed_hz,
        brake_torque_nm: scenario.operation.brake_torque_nm,
    })
}

/// Names of the keys that have no default.
fn required() -> Vec<&'static str> {
    vec!["module_mm", "pinion_teeth", "gear_teeth", "face_width_mm", "pinion_speed_hz", "brake_torque_nm"]
}

fn sections(scenario: &Scenario) -> Map<String, Value> {
    match serde_json::to_value(scenario) {
        Ok(Value::Object(sections)) => sections,
        _ => Map::new(),
    }
}

/// Python that makes the scenario.
fn python(scenario: &Scenario) -> String {
    let head = "import meshtone as mt\n\n";
    let tail = "\nsimulation = mt.simulate(scenario)\n";
    if scenario.rig().is_none() || scenario.quality().profile_errors.is_some() {
        // Thousands of numbers read better in a file, and so do the lists of a gearbox.
        let toml = scenario.to_toml();
        return format!("{head}scenario = mt.Scenario.from_toml(\n    \"\"\"\n{toml}\"\"\"\n)\n{tail}");
    }
    let mut own = without_defaults(scenario);
    let mut lines = Vec::new();
    // In the order of the scenario file, but for what is broken and what listens, which come last.
    let of_lists = ["fault", "sensor"];
    for section in
        meshtone::scenario::sections().into_iter().filter(|section| !of_lists.contains(&section.name))
    {
        let keys = match section.name {
            "" => own.clone(),
            name => own.remove(name).and_then(|keys| keys.as_object().cloned()).unwrap_or_default(),
        };
        for (key, value) in in_order(&keys, &section.keys) {
            let key = if section.name == "quality" && key == "seed" { "wheels_seed" } else { key };
            lines.push(format!("{key}={}", literal(value)));
        }
    }
    for (section, argument) in [("fault", "faults"), ("sensor", "sensors")] {
        let of_entry = if section == "fault" { fault_in_python } else { sensor_in_python };
        lines.extend(own.remove(section).map(|value| entries(argument, value, of_entry)));
    }
    let lines: String = lines.iter().map(|line| format!("    {line},\n")).collect();
    format!("{head}scenario = mt.Scenario(\n{lines})\n{tail}")
}

/// The entries that are described, in the order of the descriptions.
fn in_order<'a>(
    keys: &'a Map<String, Value>,
    described: &'a [KeyDescription],
) -> impl Iterator<Item = (&'a str, &'a Value)> {
    described.iter().filter_map(|key| Some((key.key.as_str(), keys.get(&key.key)?)))
}

/// An argument that is a list of a section's entries, be it one or several.
fn entries(argument: &str, value: Value, entry: fn(&Map<String, Value>) -> String) -> String {
    let all = if let Value::Array(all) = value { all } else { vec![value] };
    let written: Vec<String> = all.iter().filter_map(Value::as_object).map(entry).collect();
    format!("{argument}=[{}]", written.join(", "))
}

fn fault_in_python(section: &Map<String, Value>) -> String {
    let kind = section.get("kind").and_then(Value::as_str).unwrap_or_default();
    let Some(kind) = damage_kinds().into_iter().find(|known| known.name == kind) else {
        return String::new();
    };
    let described = [kind.keys, kind.place].concat();
    format!("mt.{}({})", kind.type_name, arguments(in_order(section, &described)))
}

fn sensor_in_python(section: &Map<String, Value>) -> String {
    let described = meshtone::scenario::sections().into_iter().find(|known| known.name == "sensor");
    format!(
        "mt.Sensor({})",
        described.map_or(String::new(), |known| arguments(in_order(section, &known.keys)))
    )
}

fn arguments<'a>(entries: impl Iterator<Item = (&'a str, &'a Value)>) -> String {
    entries.map(|(key, value)| format!("{key}={}", literal(value))).collect::<Vec<_>>().join(", ")
}

/// A value as Python has it. Texts are written alike in JSON, in ASCII.
fn literal(value: &Value) -> String {
    match value {
        Value::Null => "None".to_owned(),
        Value::Bool(true) => "True".to_owned(),
        Value::Bool(false) => "False".to_owned(),
        Value::Array(entries) => format!("[{}]", entries.iter().map(literal).collect::<Vec<_>>().join(", ")),
        Value::Object(entries) => {
            let entry = |(key, value): (&String, &Value)| format!("\"{key}\": {}", literal(value));
            format!("{{{}}}", entries.iter().map(entry).collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::presets;

    fn preset(name: &str) -> Scenario {
        let preset = presets().into_iter().find(|preset| preset.name == name).unwrap();
        Scenario::from_toml(preset.toml).unwrap()
    }

    #[test]
    fn python_names_what_is_not_default() {
        let text = python(&preset("tooth_breakage"));
        assert!(text.contains("    module_mm=3.0,\n    pinion_teeth=17,\n"), "{text}");
        assert!(
            text.contains("    din_grade=7,\n    faults=[mt.ToothBreakage(chip_height_mm=5.0, "),
            "{text}"
        );
        assert!(!text.contains("pressure_angle_deg"), "{text}");
    }

    #[test]
    fn what_is_not_default_makes_the_same_scenario() {
        for preset in presets() {
            let scenario = Scenario::from_toml(preset.toml).unwrap();
            let brief = Value::Object(without_defaults(&scenario));
            assert_eq!(serde_json::from_value::<Scenario>(brief).unwrap(), scenario, "{}", preset.name);
        }
    }
}
