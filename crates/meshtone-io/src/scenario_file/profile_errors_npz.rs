//! Profile errors of both wheels and their other deviations, in a NumPy archive.

use std::io::{BufWriter, Write};
use std::path::Path;

use meshtone::scenario::{FileProblem, ProfileErrors, WheelDeviations};
use meshtone::wheel::ErrorTable;

use super::unreadable;
use crate::atomic_file::{WriteFileError, write_atomically};
use crate::input_file::open_ordinary;
use crate::npz::{NpzReader, NpzWriter, ReadArray};

/// More numbers than the errors of any wheel have: 100 for each of 10 000 teeth.
const MOST_NUMBERS: u64 = 1_000_000;
const PINION: &str = "pinion_profile_errors_mm";
const GEAR: &str = "gear_profile_errors_mm";
const HELP: &str = "save both wheels' errors with numpy.savez(name, pinion_profile_errors_mm=…, \
                    gear_profile_errors_mm=…), each 100 × teeth, in mm";

pub(super) fn read(path: &Path) -> Result<ProfileErrors, FileProblem> {
    let (mut archive, present) = open(path)?;
    Ok(ProfileErrors {
        pinion_profile_errors_mm: read_entry(path, &mut archive, &present, PINION)?,
        gear_profile_errors_mm: read_entry(path, &mut archive, &present, GEAR)?,
    })
}

/// Pitches, run-out and helix slopes, as far as the archive has them.
pub(super) fn read_deviations(path: &Path) -> Result<[WheelDeviations; 2], FileProblem> {
    let (mut archive, present) = open(path)?;
    let mut both = [WheelDeviations::default(), WheelDeviations::default()];
    for key in WheelDeviations::keys().filter(|key| present.iter().any(|entry| entry == key)) {
        let numbers = floats(path, &mut archive, key)?.numbers;
        WheelDeviations::set(&mut both, key, &numbers).ok_or_else(|| {
            problem(path, &format!("has {} numbers as its entry {key}; must have one", numbers.len()))
        })?;
    }
    Ok(both)
}

/// Opens an archive, and gives the names of its arrays.
fn open(path: &Path) -> Result<(NpzReader, Vec<String>), FileProblem> {
    let file = open_ordinary(path).map_err(|error| unreadable(path, &error))?;
    let archive =
        NpzReader::new(file).map_err(|error| problem(path, &format!("is not an .npz archive: {error}")))?;
    let names = archive.names().map_err(|error| problem(path, &format!("cannot be read: {error}")))?;
    Ok((archive, names))
}

fn floats(path: &Path, archive: &mut NpzReader, name: &str) -> Result<ReadArray, FileProblem> {
    archive
        .floats(name, MOST_NUMBERS)
        .map_err(|error| problem(path, &format!("has an entry {name} that cannot be read: {error}")))
}

fn problem(path: &Path, what: &str) -> FileProblem {
    FileProblem::new(format!("{} {what}", path.display()), HELP)
}

fn read_entry(
    path: &Path,
    archive: &mut NpzReader,
    present: &[String],
    name: &str,
) -> Result<ErrorTable, FileProblem> {
    if !present.iter().any(|entry| entry == name) {
        let present = if present.is_empty() { "nothing".to_string() } else { present.join(", ") };
        return Err(problem(path, &format!("has no entry {name}; it has {present}")));
    }
    let array = floats(path, archive, name)?;
    let [rows, columns] = array.shape[..] else {
        let shape = &array.shape;
        let what = format!("has an entry {name} of shape {shape:?}; must be of two dimensions, 100 × teeth");
        return Err(problem(path, &what));
    };
    let (rows, columns) = (rows as usize, columns as usize);
    Ok(match array.first_runs_fastest {
        true => ErrorTable::from_fn(rows, columns, |row, column| array.numbers[column * rows + row]),
        false => ErrorTable::from_fn(rows, columns, |row, column| array.numbers[row * columns + column]),
    })
}

/// Writes all deviations of both wheels to a NumPy archive, as `quality.errors_file` reads them.
///
/// # Arguments
/// * `path` - the archive; it is replaced if it exists
/// * `errors` - (mm) both wheels' profile errors, 100 × teeth
/// * `deviations` - what else is known of the pinion and of the gear
///
/// # Errors
/// The file cannot be written; what was there before is then still there.
///
/// ```
/// use meshtone::scenario::{ProfileErrors, ScenarioFiles, WheelDeviations};
/// use meshtone_io::scenario_file::{FilesBeside, write_wheels_npz};
/// use meshtone::wheel::ErrorTable;
///
/// let directory = tempfile::tempdir()?;
/// let errors = ProfileErrors {
///     pinion_profile_errors_mm: ErrorTable::filled(100, 17, 0.002),
///     gear_profile_errors_mm: ErrorTable::filled(100, 38, 0.003),
/// };
/// let mut deviations = [WheelDeviations::default(), WheelDeviations::default()];
/// deviations[0].run_out_um = Some(12.0);
/// write_wheels_npz(&directory.path().join("wheels.npz"), &errors, &deviations)?;
/// assert_eq!(FilesBeside::new(directory.path()).wheel_deviations("wheels.npz")?, deviations);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_wheels_npz(
    path: &Path,
    errors: &ProfileErrors,
    deviations: &[WheelDeviations; 2],
) -> Result<(), WriteFileError> {
    write_atomically(path, |file| {
        let mut archive = NpzWriter::compressed(BufWriter::new(file));
        for (name, errors) in
            [(PINION, &errors.pinion_profile_errors_mm), (GEAR, &errors.gear_profile_errors_mm)]
        {
            let (points, teeth) = (errors.points(), errors.teeth());
            let rows: Vec<f64> = (0..points * teeth).map(|n| errors[(n / teeth, n % teeth)]).collect();
            archive.add(name, &[points, teeth], &rows)?;
        }
        for (name, numbers) in WheelDeviations::entries(deviations) {
            archive.add(name, &[numbers.len()], &numbers)?;
        }
        archive.finish()?.flush()
    })
}
