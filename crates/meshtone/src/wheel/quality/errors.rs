//! Manufacturing quality.

use meshtone_toml::{ReadResult, TomlTable, TomlValue};

use super::measured::{DEVIATION_KEYS, WheelDeviations};
use crate::error_table::ErrorTable;
use crate::keys::{
    Field, KeyKind, KeyRow, KeyValue, Keys, NumberFiles, Range, Written, array, documented, field, load, row,
};
use crate::wheel::WheelName;

/// Number of radii at which a tooth's profile error is given.
pub const ERROR_POINTS: usize = 100;

/// Manufacturing quality of the teeth.
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

/// The rows of a wheel's deviations that are given beside the profiles.
macro_rules! deviation_rows {
    ($field:ident, $keys:expr) => {{
        let [pitch, run_out, phase, helix] = $keys;
        [
            row(
                pitch,
                "µm",
                "the working flanks' cumulative pitch deviations along the pitch circle, positive where \
                 metal is added; they are added to given profile errors",
                field!($field.cumulative_pitch_um),
            )
            .otherwise("drawn, or none beside given profile errors")
            .rule("one a tooth, each below the module")
            .alternative("[ one number a tooth ]"),
            row(
                run_out,
                "µm",
                "the run-out F_r, of which the deviation is F_r/2 sin(θ + φ)",
                field!($field.run_out_um),
            )
            .otherwise("drawn, or none beside given profile errors or pitches, which contain it")
            .range(Range::not_negative().implausible_above(1e4))
            .alternative("0.0"),
            row(
                phase,
                "rad",
                "its phase φ; θ counts from where the wheel's first tooth enters contact",
                field!($field.run_out_phase_rad),
            )
            .otherwise("drawn, or 0 beside given profile errors")
            .alternative("0.0"),
            row(
                helix,
                "µm",
                "the helix slope deviation over the face width, positive where metal is added towards positive z",
                field!($field.helix_slope_um),
            )
            .otherwise("drawn, or none beside given profile errors")
            .range(Range::from_to(-1e3, 1e3))
            .alternative("0.0"),
        ]
    }};
}

const ERROR_KEYS: [&str; 2] = ["pinion_profile_errors_mm", "gear_profile_errors_mm"];

impl Keys for Quality {
    const SECTION: &str = "quality";

    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        let share = |name, meaning, field| row(name, "-", meaning, field).range(Range::from_to(0.0, 1.0));
        let errors_row = |name, field| {
            row(name, "mm", "the profile errors, instead of a draw: 100 rows of one number a tooth", field)
                .otherwise("none")
                .rule("100 × teeth, each below the module")
                .alternative("[ 100 rows of one number a tooth ]")
        };
        vec![
            row(
                "din_grade",
                "",
                "the grade of DIN 3961 of the deviations, 1 (best) to 12; 0: ideal teeth",
                field!(din_grade),
            )
            .range(Range::from_to(0.0, 12.0).message(
                "must be a whole number from 0 to 12: a grade of DIN 3961, from 1 (best) to 12, or 0 for ideal teeth",
            )),
            row(
                "seed",
                "",
                "the seed of the wheels alone, for several scenarios of the same wheels",
                field!(seed),
            )
            .otherwise("the scenario's `seed`")
            .alternative("2"),
            row(
                "iso_class",
                "",
                "the class of ISO 1328-1:2013 of the deviations, 1 (best) to 11, instead of din_grade; 0: none",
                field!(iso_class),
            )
            .range(Range::from_to(0.0, 11.0).message(
                "must be a whole number from 0 to 11: a class of ISO 1328-1:2013, from 1 (best) to 11, or 0 for none",
            )),
            share(
                "tooth_share",
                "the part of the tolerances of profile slope and form that each tooth has of its own; the rest is \
                 common to a wheel's teeth",
                field!(tooth_share),
            ),
            share(
                "pitch_share",
                "a wheel's largest single pitch deviation over its tolerance f_p",
                field!(pitch_share),
            ),
            share("run_out_share", "a wheel's run-out over its tolerance F_r", field!(run_out_share)),
            share(
                "helix_share",
                "a wheel's largest helix slope deviation, of either sign, over its tolerance f_Hβ",
                field!(helix_share),
            ),
            documented(
                "errors_file",
                "an .npz with the profile errors, instead of a draw, as `meshtone wheels` writes it; its entries are \
                 the keys below",
                KeyKind::File,
            )
            .otherwise("none")
            .alternative("\"wheels.npz\""),
            errors_row(
                ERROR_KEYS[0],
                Field::new(
                    |quality: &Self| quality.profile_errors.as_ref().map(|errors| &errors.pinion_profile_errors_mm),
                    |quality| quality.profile_errors.as_mut().map(|errors| &mut errors.pinion_profile_errors_mm),
                ),
            ),
            errors_row(
                ERROR_KEYS[1],
                Field::new(
                    |quality: &Self| quality.profile_errors.as_ref().map(|errors| &errors.gear_profile_errors_mm),
                    |quality| quality.profile_errors.as_mut().map(|errors| &mut errors.gear_profile_errors_mm),
                ),
            ),
        ]
        .into_iter()
        .chain(deviation_rows!(pinion_deviations, DEVIATION_KEYS[0]))
        .chain(deviation_rows!(gear_deviations, DEVIATION_KEYS[1]))
        .collect()
    }

    /// Profile errors from a file, from the two inline keys, or none.
    fn choose(&mut self, table: &TomlTable<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let file = table.optional("errors_file");
        let [pinion, gear] = ERROR_KEYS.map(|key| table.optional(key));
        self.profile_errors = match (file, pinion, gear) {
            (None, None, None) => None,
            (Some(file), None, None) => {
                let [pinion_profile_errors_mm, gear_profile_errors_mm] =
                    load(&file, |name| files.matrices(name))?;
                [self.pinion_deviations, self.gear_deviations] = file_deviations(table, &file, files, Some)?;
                Some(ProfileErrors { pinion_profile_errors_mm, gear_profile_errors_mm })
            }
            (None, Some(_), Some(_)) => Some(ProfileErrors {
                pinion_profile_errors_mm: ErrorTable::default(),
                gear_profile_errors_mm: ErrorTable::default(),
            }),
            (Some(_), _, _) => {
                return Err(table
                    .error("errors_file", "given beside inline profile errors; they have only one source")
                    .with_help(
                        "remove errors_file, or pinion_profile_errors_mm and gear_profile_errors_mm",
                    ));
            }
            (None, pinion, _) => {
                let missing = if pinion.is_some() { ERROR_KEYS[1] } else { ERROR_KEYS[0] };
                let problem = "missing; profile errors are given for both wheels or for neither";
                return Err(table.error(missing, problem));
            }
        };
        Ok(())
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
