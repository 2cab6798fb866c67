//! The base scenario.

use meshtone::scenario::Scenario;
use meshtone_io::experiment::Tuned;
use meshtone_io::scenario_file::{FilesBeside, ScenarioFile};
use meshtone_toml::{ReadResult, TomlError, TomlTable, TomlValue};

use super::super::refused;
use super::{PlanFile, Reading, in_another_file};

/// Key of the base scenario.
const KEY: &str = "scenario";

pub(super) fn read(root: &TomlTable<'_>, reading: &mut Reading) -> ReadResult<Scenario> {
    let value =
        root.required(KEY, "the scenario that all records have in common: a file's name or a table")?;
    let scenario = if value.is_table() && !reading.is_copy {
        let files = FilesBeside::new(reading.directory);
        let scenario = value.table()?.read(|table| Scenario::from_table(table, &files))?;
        scenario.validate().map_err(|error| {
            let key = format!("{KEY}.{}", error.key);
            error.with_key(key)
        })?;
        scenario
    } else {
        let name = if value.is_table() { "" } else { value.string()? };
        let file = ScenarioFile::read(&reading.path_of(name, PlanFile::NAMES[1]));
        let file = file.map_err(|error| in_another_file(&value, error, reading))?;
        reading.sources.extend(file.sources().map(std::path::Path::to_path_buf));
        file.scenario
    };
    // Also of one that is written in the plan: it may name files.
    reading
        .files
        .push(PlanFile { name: PlanFile::NAMES[1], text: meshtone::written_out(&scenario.to_toml()) });
    if let Some(ignored) = scenario.ignored_by_model().into_iter().next() {
        return Err(TomlError::new(format!("{KEY}.{}", ignored.key), "", ignored.message));
    }
    if !scenario.faults.is_empty() {
        let problem = "the base scenario has a fault; must be healthy";
        let help = "faults belong to the classes: [[class]] with fault = { kind = … }";
        return Err(refused(format!("{KEY}.fault"), problem, help));
    }
    Ok(scenario)
}

/// The base with the numbers that were tuned.
pub(super) fn tuned(base: &Scenario, tuned: &Tuned, value: &TomlValue<'_>) -> ReadResult<Scenario> {
    if base.rig().is_none() {
        let error = value.error("is given, but data sets do not enhance the signals of gearboxes");
        return Err(error.with_help("leave it out, or make signals with `meshtone enhance`"));
    }
    if let Some(warning) = tuned.warning_for(base) {
        return Err(value.error(warning));
    }
    if !base.wheel_names().contains(&tuned.wheel.as_str()) {
        return Err(
            value.error(format!("averages over `{}`, which is no wheel of the scenario", tuned.wheel))
        );
    }
    tuned.apply(base).map_err(|error| value.error(error.to_string()))
}
