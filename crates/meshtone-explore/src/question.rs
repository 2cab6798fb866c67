//! A scenario as the page sends it.

use meshtone::scenario::{FileProblem, MemoryLimit, Profile, ProfileErrors, Scenario, ScenarioFiles};
use meshtone_io::memory;
use serde_json::Value;

use crate::refusal::Refusal;

/// (bytes) What one simulation of the page may take, so that several fit beside each other.
const MOST_BYTES: u64 = 1 << 30;

/// Limit of the memory of a simulation for the page: that of any simulation, and at most 1 GiB.
pub fn memory_limit() -> MemoryLimit {
    match memory::limit() {
        limit if limit.bytes() <= MOST_BYTES => limit,
        _ => MemoryLimit::Given { bytes: MOST_BYTES },
    }
}

/// Reads and checks the scenario of a pair, as [`scenario`] does any.
///
/// # Arguments
/// * `question` - as of [`scenario`]
pub fn pair(question: &Value) -> Result<Scenario, Refusal> {
    let scenario = scenario(question)?;
    scenario.expect_pair()?;
    Ok(scenario)
}

/// Reads and checks a scenario, with the errors of a scenario file.
///
/// # Arguments
/// * `question` - with `toml`, a scenario file's text, or `scenario`, its sections and keys
pub fn scenario(question: &Value) -> Result<Scenario, Refusal> {
    let read = |text: &str| Scenario::from_toml_within(text, &NoFiles, memory_limit());
    match (question.get("toml"), question.get("scenario")) {
        (Some(Value::String(text)), _) => Ok(read(text)?),
        // Lines would be those of a text that nobody has seen.
        (_, Some(sections)) => Ok(read(&text_of(sections)?).map_err(|error| error.at_line(None))?),
        _ => Err(Refusal::unfit("a request has a scenario, or a scenario file's text as toml")),
    }
}

/// A scenario file's text of what the page has set.
fn text_of(sections: &Value) -> Result<String, Refusal> {
    let table = toml::Table::try_from(without_nulls(sections));
    let text = table.and_then(|table| toml::to_string(&table));
    text.map_err(|error| Refusal::unfit(format!("the scenario cannot be written as TOML: {error}")))
}

/// Keys without a value are left out.
fn without_nulls(value: &Value) -> Value {
    match value {
        Value::Object(entries) => {
            let kept = entries.iter().filter(|(_, value)| !value.is_null());
            Value::Object(kept.map(|(key, value)| (key.clone(), without_nulls(value))).collect())
        }
        Value::Array(entries) => Value::Array(entries.iter().map(without_nulls).collect()),
        other => other.clone(),
    }
}

/// A page reads no files beside the one that is dropped on it.
struct NoFiles;

impl ScenarioFiles for NoFiles {
    fn profile_errors(&self, name: &str) -> Result<ProfileErrors, FileProblem> {
        Err(refused(
            name,
            "`meshtone explore SCENARIO.toml` reads the files that a scenario names, and keeps their numbers",
        ))
    }

    fn profile(&self, name: &str) -> Result<Profile, FileProblem> {
        Err(refused(name, "write the values here as { time_s = […], value = […] }"))
    }
}

fn refused(name: &str, help: &str) -> FileProblem {
    FileProblem::new(format!("names the file {name}, but a page reads no other files"), help)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_the_page_sets_is_read_as_a_file_is() {
        let gears = json!({ "module_mm": 3, "pinion_teeth": 17, "gear_teeth": 38, "face_width_mm": 15.5, "backlash_mm": null });
        let operation = json!({ "pinion_speed_hz": 40.0, "brake_torque_nm": 10 });
        let read = scenario(&json!({ "scenario": { "gears": gears, "operation": operation } })).unwrap();
        assert_eq!((read.meshes[0].module_mm, read.wheels[0].face_width_mm), (3.0, 15.5));
        assert_eq!(scenario(&json!({ "toml": read.to_toml() })), Ok(read));
    }

    #[test]
    fn wrong_values_are_refused_as_in_a_file() {
        let wrong = json!({ "scenario": { "gears": { "module_mm": "three" } } });
        let Err(Refusal::Wrong(error)) = scenario(&wrong) else { panic!("it is refused") };
        assert_eq!((error.key.as_str(), error.line), ("gears.module_mm", None));
        assert_eq!(error.problem, "must be a number, not text");
        let Err(Refusal::Wrong(error)) = scenario(&json!({ "toml": "[gears]\nmodul_mm = 3" })) else {
            panic!()
        };
        assert_eq!(error.line, Some(2));
        assert!(scenario(&json!({})).is_err());
    }
}
