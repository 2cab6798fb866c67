//! What is to be read, and what the file does not say itself.

use meshtone::signal::SAMPLING_RATES_HZ;

use super::RecordingFormat;
use super::error::Problem;

/// A column of a file, by its name or its number.
///
/// ```
/// use meshtone_io::recording::ColumnChoice;
///
/// assert_eq!(ColumnChoice::from("bearing"), ColumnChoice::Name("bearing".to_string()));
/// assert_eq!(ColumnChoice::from(2), ColumnChoice::Number(2));
/// assert_eq!(ColumnChoice::parse("2"), ColumnChoice::Number(2));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ColumnChoice {
    /// Its name: as [`super::Channel::name`], or as the file has it, with the unit in brackets. In NPZ and MAT
    /// files also the name of an array, for all its columns, or the last part of a dotted path.
    Name(String),
    /// Its number in the file, counted from 1, all columns counted.
    Number(usize),
}

impl ColumnChoice {
    /// A choice as a user writes it: a whole number is a number, all else a name.
    ///
    /// # Arguments
    /// * `text` - what the user wrote
    pub fn parse(text: &str) -> ColumnChoice {
        text.parse().map_or_else(|_| ColumnChoice::Name(text.to_string()), ColumnChoice::Number)
    }
}

impl From<&str> for ColumnChoice {
    fn from(name: &str) -> ColumnChoice {
        ColumnChoice::Name(name.to_string())
    }
}

impl From<usize> for ColumnChoice {
    fn from(number: usize) -> ColumnChoice {
        ColumnChoice::Number(number)
    }
}

impl std::fmt::Display for ColumnChoice {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ColumnChoice::Name(name) => write!(to, "`{name}`"),
            ColumnChoice::Number(number) => write!(to, "number {number}"),
        }
    }
}

/// Which column holds the time.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum TimeColumn {
    /// The one whose name says so: `time`, `t`, `time_s`, `Time [ms]`, `Zeit`, `temps`, `timestamp`, … None, if
    /// no name does.
    #[default]
    ByName,
    /// This one. Its unit is that of its name, s if that says none.
    Chosen(ColumnChoice),
    /// None: a column whose name says time is a channel like any other.
    Absent,
}

/// What a channel's samples mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// The channel, one of those that are read.
    pub channel: ColumnChoice,
    /// (V/unit) Sensitivity of the sensor, above or below 0: the samples are volts and are divided by it. Samples
    /// that the file states in mV or µV are turned into V first; any other unit than that of a voltage is an
    /// error.
    pub sensitivity_v_per_unit: Option<f64>,
    /// Unit of the samples, after the division; it replaces what the file says.
    pub unit: Option<String>,
}

/// What stands between two cells of a text file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Separator {
    /// `,`
    Comma,
    /// `;`
    Semicolon,
    /// The tabulator.
    Tab,
    /// `|`
    Bar,
    /// Any number of spaces and tabulators.
    Whitespace,
}

/// The decimal sign of a text file's numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DecimalSign {
    /// `0.5`
    Point,
    /// `0,5`
    Comma,
}

/// How a text file is written, where it is not to be found out from its first lines.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TextOptions {
    /// What stands between two cells; found out where absent.
    pub separator: Option<Separator>,
    /// The decimal sign; found out where absent.
    pub decimal_sign: Option<DecimalSign>,
    /// Lines at the start of the file that are skipped unread.
    pub skip_lines: usize,
}

/// What is read, and what the file does not say itself. The default reads every column, and takes all else from
/// the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordingOptions {
    /// The channels, in the order of the result; all numeric columns where empty.
    pub channels: Vec<ColumnChoice>,
    /// The time column.
    pub time: TimeColumn,
    /// (S/s) Sampling rate, above 0. It goes before anything the file says: a time column is then neither read
    /// nor checked, and the recording starts at 0 s.
    pub sampling_rate_hz: Option<f64>,
    /// For NPZ and MAT: the variable that holds the recording, in MAT files as a dotted path such as
    /// `run.sensors`, `runs(2).data` or `cells{3}`. All arrays of the file where absent. Of a data set in the schema of the Python
    /// package `bearing-datasets`: the `recording_id`.
    pub variable: Option<String>,
    /// Units and sensitivities of the channels.
    pub calibrations: Vec<Calibration>,
    /// The format; found out where absent.
    pub format: Option<RecordingFormat>,
    /// How a text file is written.
    pub text: TextOptions,
    /// Numbers that are held for each sample of a column beside the sample itself, by what is done with the recording: they count
    /// when it is compared with the memory that may be taken.
    pub numbers_beside_each_sample: u64,
}

impl RecordingOptions {
    /// Checks the numbers, which the types do not rule out.
    pub(super) fn check(&self) -> Result<(), Problem> {
        if let Some(rate) = self.sampling_rate_hz.filter(|rate| !SAMPLING_RATES_HZ.contains(rate)) {
            let problem = format!("sampling_rate_hz is {rate:e}; must be from 1e-6 to 1e12 S/s");
            return Err(Problem::Option(problem));
        }
        for calibration in &self.calibrations {
            let usable = |sensitivity: &f64| sensitivity.is_finite() && *sensitivity != 0.0;
            if let Some(wrong) = calibration.sensitivity_v_per_unit.filter(|given| !usable(given)) {
                return Err(Problem::Option(format!(
                    "the sensitivity of channel {} is {wrong} V per unit; must be a finite number other than 0",
                    calibration.channel
                )));
            }
        }
        Ok(())
    }
}
