//! The section `[operation]`.

use super::super::{Operation, Profile};
use super::files::{ScenarioFiles, load};
use crate::toml_reader::{ReadResult, TomlTable};

pub(super) fn read(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Operation> {
    let speed = table.required("pinion_speed_hz", "(rev/s) the nominal speed of the driving wheel")?;
    let torque = table.required("brake_torque_nm", "(N m) the nominal load on the driven shaft")?;
    let default = Operation::new(speed.number()?, torque.number()?);
    Ok(Operation {
        speed_fluctuation_hz: table.number_or("speed_fluctuation_hz", default.speed_fluctuation_hz)?,
        torque_fluctuation_nm: table.number_or("torque_fluctuation_nm", default.torque_fluctuation_nm)?,
        speed_profile_hz: profile(table, "speed_profile_hz", files)?,
        torque_profile_nm: profile(table, "torque_profile_nm", files)?,
        ..default
    })
}

fn profile(
    table: &TomlTable<'_>,
    key: &'static str,
    files: &dyn ScenarioFiles,
) -> ReadResult<Option<Profile>> {
    let Some(value) = table.optional(key) else {
        return Ok(None);
    };
    value.table()?.read(|table| profile_table(table, files)).map(Some)
}

fn profile_table(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Profile> {
    let file = table.optional("file");
    let inline = (table.optional("time_s"), table.optional("value"));
    match (file, inline) {
        (Some(file), (None, None)) => load(&file, |name| files.profile(name)),
        (None, (Some(time_s), Some(value))) => {
            Ok(Profile { time_s: time_s.numbers()?, value: value.numbers()? })
        }
        (Some(_), _) => Err(table
            .error("file", "given beside time_s or value; a profile has only one source")
            .with_help("remove the file, or the inline values")),
        (None, (time_s, _)) => {
            let missing = if time_s.is_some() { "value" } else { "time_s" };
            Err(table.error(
                missing,
                "missing; a profile is { time_s = […], value = […] } or { file = \"….csv\" }",
            ))
        }
    }
}
