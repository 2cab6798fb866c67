//! The section `[quality]`.

use nalgebra::DMatrix;

use super::super::{ProfileErrors, Quality, ScenarioError};
use super::files::{ScenarioFiles, load};
use crate::toml_reader::{ReadResult, TomlDocument, TomlTable, TomlValue};

const INLINE_KEYS: [&str; 2] = ["pinion_profile_errors_mm", "gear_profile_errors_mm"];

pub(super) fn read(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Quality> {
    let grade = table.optional("din_grade");
    let din_grade = grade.as_ref().map(|value| value.integer(0..=12)).transpose()?.unwrap_or(0);
    let profile_errors = profile_errors(table, files)?;
    let seed = table.optional("seed").map(|value| value.integer(0..=u64::MAX)).transpose()?;
    Ok(Quality { din_grade: u8::try_from(din_grade).unwrap_or(u8::MAX), seed, profile_errors })
}

fn profile_errors(table: &TomlTable<'_>, files: &dyn ScenarioFiles) -> ReadResult<Option<ProfileErrors>> {
    let file = table.optional("errors_file");
    let [pinion, gear] = INLINE_KEYS.map(|key| table.optional(key));
    match (file, pinion, gear) {
        (None, None, None) => Ok(None),
        (Some(file), None, None) => load(&file, |name| files.profile_errors(name)).map(Some),
        (None, Some(pinion), Some(gear)) => Ok(Some(ProfileErrors {
            pinion_profile_errors_mm: matrix(&pinion)?,
            gear_profile_errors_mm: matrix(&gear)?,
        })),
        (Some(_), _, _) => Err(table
            .error("errors_file", "given beside inline profile errors; they have only one source")
            .with_help("remove errors_file, or pinion_profile_errors_mm and gear_profile_errors_mm")),
        (None, pinion, _) => {
            let missing = if pinion.is_some() { INLINE_KEYS[1] } else { INLINE_KEYS[0] };
            Err(table.error(missing, "missing; profile errors are given for both wheels or for neither"))
        }
    }
}

fn matrix(value: &TomlValue<'_>) -> ReadResult<DMatrix<f64>> {
    let rows = value.array()?;
    let columns = rows.first().map_or(Ok(0), |row| row.array().map(|entries| entries.len()))?;
    let mut entries = Vec::with_capacity(rows.len() * columns);
    for row in &rows {
        let numbers = row.numbers()?;
        if numbers.len() != columns {
            let problem = format!(
                "has {} numbers, the first row has {columns}; every row must have one number per tooth",
                numbers.len()
            );
            return Err(row.error(problem));
        }
        entries.extend(numbers);
    }
    Ok(DMatrix::from_row_slice(rows.len(), columns, &entries))
}

/// An error about profile errors that came from a file is about the key that names the file.
pub(super) fn in_its_file(document: &TomlDocument<'_>, mut error: ScenarioError) -> ScenarioError {
    let Some(entry) = error.key.strip_prefix("quality.") else {
        return error;
    };
    let from_file = document.value_as_written("quality.errors_file").is_some();
    if from_file && INLINE_KEYS.iter().any(|key| entry.starts_with(key)) {
        error.problem = format!("{entry}: {}", error.problem);
        error.key = "quality.errors_file".to_string();
    }
    error
}
