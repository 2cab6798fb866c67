//! Manufacturing quality.

use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::measured::WheelDeviations;
use crate::error_table::ErrorTable;
use crate::keys::{KeyKind, KeyValue, NumberFiles, Written, array, load};
use crate::wheel::WheelName;

/// Number of radii at which a tooth's profile error is given.
pub const ERROR_POINTS: usize = 100;

/// Manufacturing quality of the teeth of two wheels in mesh, which a scenario states wheel by wheel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Quality {
    /// Grade of DIN 3961, 1 (best) to 12; 0 for ideal teeth. Default 0.
    pub din_grade: u8,
    /// Seed of the draw by `din_grade`: which wheels they are. Default: the scenario's seed.
    pub seed: Option<u64>,
    /// Class of ISO 1328-1:2013, 1 (best) to 11, instead of a DIN grade; 0 for none. Default 0.
    pub iso_class: u8,
    /// (-) Part of the tolerances of slope and form that a tooth has of its own; the rest all teeth of a wheel have in common.
    /// Default 0.5.
    pub tooth_share: f64,
    /// (-) Largest single pitch deviation as a part of its tolerance. Default 0.25.
    pub pitch_share: f64,
    /// (-) Run-out as a part of its tolerance. Default 0.3.
    pub run_out_share: f64,
    /// (-) Profile slope that varies once a revolution, over the rms deviation of the wheel's profiles. Default 0.
    pub slope_wobble: f64,
    /// (-) Largest helix slope deviation as a part of its tolerance. Default 0.
    pub helix_share: f64,
    /// The errors themselves, instead of a draw by `din_grade`: several simulations that are
    /// given the same errors share one pair of wheels.
    pub profile_errors: Option<ProfileErrors>,
    /// Other deviations of the pinion that are given instead of drawn.
    pub pinion_deviations: WheelDeviations,
    /// Other deviations of the gear that are given instead of drawn.
    pub gear_deviations: WheelDeviations,
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            din_grade: 0,
            seed: None,
            iso_class: 0,
            tooth_share: 0.5,
            pitch_share: 0.25,
            run_out_share: 0.3,
            slope_wobble: 0.0,
            helix_share: 0.0,
            profile_errors: None,
            pinion_deviations: WheelDeviations::default(),
            gear_deviations: WheelDeviations::default(),
        }
    }
}

impl Quality {
    /// Teeth of a grade of DIN 3961, drawn by the scenario's seed.
    ///
    /// # Arguments
    /// * `din_grade` - 1 (best) to 12; 0 for ideal teeth
    pub fn of_grade(din_grade: u8) -> Self {
        Self { din_grade, ..Self::default() }
    }

    /// Teeth with given errors, such as measured ones.
    ///
    /// # Arguments
    /// * `errors` - of every tooth
    pub fn of_errors(errors: ProfileErrors) -> Self {
        Self { profile_errors: Some(errors), ..Self::default() }
    }

    /// Two wheels of which all deviations are given.
    ///
    /// # Arguments
    /// * `errors` - the profile errors of every tooth
    /// * `deviations` - what else is known of the pinion and of the gear; what is not is none
    pub fn of_wheels(errors: ProfileErrors, [pinion, gear]: [WheelDeviations; 2]) -> Self {
        Self { pinion_deviations: pinion, gear_deviations: gear, ..Self::of_errors(errors) }
    }

    /// Other deviations of a wheel that are given instead of drawn.
    pub(crate) fn given(&self, wheel: WheelName) -> &WheelDeviations {
        wheel.choose(&self.pinion_deviations, &self.gear_deviations)
    }
}

/// Deviations of both wheels from the file of profile errors, which the table does not give again.
///
/// # Arguments
/// * `table` - that names the file
/// * `file` - its name
/// * `files` - loads it
/// * `key_here` - the table's own key of an entry of the file, if it has one
pub(crate) fn file_deviations(
    table: &TomlTable<'_>,
    file: &TomlValue<'_>,
    files: &dyn NumberFiles,
    key_here: impl Fn(&'static str) -> Option<&'static str>,
) -> ReadResult<[WheelDeviations; 2]> {
    let mut both = [WheelDeviations::default(), WheelDeviations::default()];
    for (key, numbers) in load(file, |name| files.named_numbers(name))? {
        if let Some(key) = key_here(key).filter(|key| table.optional(key).is_some()) {
            return Err(table
                .error(key, "given beside errors_file, which has it too; it has only one source")
                .with_help(format!("remove {key} here or in the file")));
        }
        if WheelDeviations::set(&mut both, key, &numbers).is_none() {
            let problem = format!("has {} numbers as its entry {key}; must have one", numbers.len());
            return Err(table.error("errors_file", problem));
        }
    }
    Ok(both)
}

/// An array of rows, one line a row.
impl KeyValue for ErrorTable {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        let rows = value.array()?;
        let columns = rows.first().map_or(Ok(0), |row| row.array().map(|entries| entries.len()))?;
        let mut entries = Vec::with_capacity(rows.len());
        for row in &rows {
            let numbers = row.numbers()?;
            if numbers.len() != columns {
                let problem = format!(
                    "has {} numbers, the first row has {columns}; every row must have one number per tooth",
                    numbers.len()
                );
                return Err(row.error(problem));
            }
            entries.push(numbers);
        }
        *self = Self::from_fn(rows.len(), columns, |row, column| entries[row][column]);
        Ok(())
    }

    fn write(&self) -> Written {
        let numbers = |point| (0..self.teeth()).map(move |tooth| self[(point, tooth)]);
        let rows = (0..self.points()).map(|point| format!("    {},\n", array(numbers(point))));
        Written::Value(format!("[\n{}]", rows.collect::<String>()))
    }

    fn kind() -> KeyKind {
        KeyKind::Matrix
    }
}

/// Deviation of every tooth's flank from the ideal profile.
///
/// Each table has [`ERROR_POINTS`] rows, uniform in radius, and one column per tooth. The
/// pinion's rows run from the initial contact radius to the tip, the gear's from the tip to the
/// initial contact radius: both in the order in which a tooth pair passes through contact.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileErrors {
    /// (mm) Pinion, 100 × pinion teeth.
    pub pinion_profile_errors_mm: ErrorTable,
    /// (mm) Gear, 100 × gear teeth.
    pub gear_profile_errors_mm: ErrorTable,
}
