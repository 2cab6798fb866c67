//! Recordings: measured or simulated signals, out of whatever file they came in.
//!
//! [`read_recording`] opens CSV and other separated text, Parquet (also the one that `meshtone simulate`
//! writes), NumPy's NPY and NPZ, MATLAB's MAT (version 4, 5 and 7.3), HDF5, WAV, universal files, TDMS, MDF 4 and tables of Excel's, also compressed by gzip or ZIP, and gives one [`Recording`] whatever the
//! format: channels with name, unit and samples, at one sampling rate. What is to be read, and what the file
//! does not say itself, stands in [`RecordingOptions`].
//!
//! Nothing is guessed about the numbers: a cell that is empty or no number, time that is not uniform, or a file
//! that ends early is a [`ReadRecordingError`] that names the place. Memory stays bounded by what the file
//! really holds, whatever its headers claim, and by the [limit](crate::memory::limit): how much the samples will take is known
//! before they are read, or counted meanwhile.

pub(crate) mod array;
mod assemble;
mod catalogue;
mod error;
mod fields;
mod format;
mod hdf5;
mod label;
mod mat;
mod mdf;
mod memory_need;
pub(crate) mod number;
pub(crate) mod numpy;
mod options;
mod packed;
pub(crate) mod parquet_check;
mod parquet_file;
mod rate;
mod selection;
mod signal_set;
mod tdms;
mod text;
mod time;
mod time_base;
mod unit;
mod universal;
mod warning;
mod wav;
mod workbook;

use std::fs::File;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

pub use error::{ReadRecordingError, names};
pub use format::RecordingFormat;
pub use options::{
    Calibration, ColumnChoice, DecimalSign, RecordingOptions, Separator, TextOptions, TimeColumn,
};
pub use warning::RecordingWarning;

use meshtone::sensor::GRAVITY_M_PER_S2;

use self::error::Problem;
use crate::input_file::open_ordinary;
use crate::signals::SignalFormat;

/// One channel of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name, as the file has it, without the unit in brackets.
    pub name: String,
    /// Unit of the samples, where the file or the options say it.
    pub unit: Option<String>,
    /// (unit) The samples, all finite, at the recording's sampling rate.
    pub samples: Vec<f64>,
}

impl Channel {
    /// Brings the samples to g. Returns false, and leaves them as they are, where their unit is not stated or is no acceleration.
    #[must_use]
    pub fn convert_to_g(&mut self) -> bool {
        let in_g = match self.unit.as_deref().unwrap_or("").trim() {
            "g" | "gn" | "g0" => 1.0,
            "m/s²" | "m/s2" | "m/s^2" | "m/s**2" | "m s-2" | "ms-2" | "m·s⁻²" => 1.0 / GRAVITY_M_PER_S2,
            "mm/s²" | "mm/s2" | "mm/s^2" => 1e-3 / GRAVITY_M_PER_S2,
            "mg" => 1e-3,
            _ => return false,
        };
        if in_g != 1.0 {
            self.samples.iter_mut().for_each(|value| *value *= in_g);
        }
        self.unit = Some("g".to_owned());
        true
    }
}

/// Channels that were recorded together, at one constant sampling rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// (S/s) Sampling rate of all channels.
    pub sampling_rate_hz: f64,
    /// What says the rate: a time column, a number of the file, or the options.
    pub rate_by: String,
    /// (s) Time of the first sample; 0 where no time column was read.
    pub start_s: f64,
    /// The channels, at least one, all equally long.
    pub channels: Vec<Channel>,
    /// The file that was read.
    pub source: PathBuf,
    /// The scenario of a pair or a gearbox as TOML, where the file is one that `meshtone simulate` wrote.
    pub scenario_toml: Option<String>,
    /// What is doubtful about the file.
    pub warnings: Vec<RecordingWarning>,
}

impl Recording {
    /// Samples of each channel.
    pub fn len(&self) -> usize {
        self.channels.first().map_or(0, |channel| channel.samples.len())
    }

    /// Whether there is no sample; [`read_recording`] never gives such a recording.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The channel of a name, if there is one; the first of several.
    ///
    /// # Arguments
    /// * `name` - its name, exactly
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }
}

/// Reads a recording.
///
/// # Arguments
/// * `path` - the file; or a folder that `meshtone simulate` wrote, whose signals are read, as Parquet where they are there in several
///   formats; or the folder of a data set in the schema of the Python package `bearing-datasets`, of which `variable` names the recording
/// * `options` - what is read, and what the file does not say itself
///
/// The format is known by the file's first bytes, and by its ending where those decide nothing (text). The
/// sampling rate is that of the options; else what the file states (WAV, our own signals, a number named
/// `sampling_rate_hz`, `fs` or alike); else that of the time column. Where the file states a rate and has a time
/// column too, the two must agree.
///
/// # Errors
/// The file cannot be read, is of no known format, is broken or cut off; its samples would take more memory than is
/// [allowed](crate::memory::limit); a column or variable does not exist;
/// a sample is missing or not finite; time is not uniform; there is no sampling rate. Every message names the
/// file, the place in it, and what to do.
///
/// ```
/// use meshtone_io::recording::{RecordingOptions, read_recording};
///
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("run-up.csv");
/// std::fs::write(&path, "time [s];acceleration [g]\n0,00;1,5\n0,01;-2,25\n0,02;0,5\n")?;
///
/// let recording = read_recording(&path, &RecordingOptions::default())?;
/// assert_eq!(recording.sampling_rate_hz, 100.0);
/// assert_eq!(recording.channels[0].name, "acceleration");
/// assert_eq!(recording.channels[0].unit.as_deref(), Some("g"));
/// assert_eq!(recording.channels[0].samples, [1.5, -2.25, 0.5]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Columns are chosen by name or number; a sensitivity turns volts into what was measured:
///
/// ```
/// use meshtone_io::recording::{Calibration, RecordingOptions, read_recording};
///
/// let directory = tempfile::tempdir()?;
/// let path = directory.path().join("run.csv");
/// std::fs::write(&path, "bearing,tacho\n0.10,5\n-0.20,0\n")?;
///
/// let options = RecordingOptions {
///     channels: vec!["bearing".into()],
///     sampling_rate_hz: Some(25_600.0),
///     calibrations: vec![Calibration {
///         channel: "bearing".into(),
///         sensitivity_v_per_unit: Some(0.1),
///         unit: Some("g".to_string()),
///     }],
///     ..RecordingOptions::default()
/// };
/// let recording = read_recording(&path, &options)?;
/// assert_eq!(recording.channels.len(), 1);
/// assert_eq!(recording.channels[0].samples, [1.0, -2.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_recording(path: &Path, options: &RecordingOptions) -> Result<Recording, ReadRecordingError> {
    let inside = signals_in(path);
    let path = inside.as_deref().unwrap_or(path);
    if let Some(folder) = signal_set::folder(path) {
        let recording = options.check().and_then(|()| decoded(|| signal_set::read(folder, options)));
        let recording =
            recording.map_err(|problem| problem.of_file(path, RecordingFormat::Parquet.name()))?;
        return Ok(Recording { source: path.to_path_buf(), ..recording });
    }
    let opened = options.check().and_then(|()| open(path, options));
    let (file, format) = opened.map_err(|problem| problem.of_file(path, "recording"))?;
    let recording = match format {
        RecordingFormat::Text => text::read(file, options),
        RecordingFormat::Parquet => decoded(|| parquet_file::read(file, options)),
        RecordingFormat::Npy => numpy::read_npy(file, options),
        RecordingFormat::Npz => numpy::read_npz(file, options),
        RecordingFormat::Mat => mat::read(file, options),
        RecordingFormat::Wav => wav::read(file, options),
        RecordingFormat::Hdf5 => decoded(|| hdf5::read(file, options)),
        RecordingFormat::Universal => universal::read(file, options),
        RecordingFormat::Tdms => tdms::read(file, options),
        RecordingFormat::Mdf => mdf::read(file, options),
    };
    let recording = recording.map_err(|problem| problem.of_file(path, format.name()))?;
    Ok(Recording { source: path.to_path_buf(), ..recording })
}

/// What a reader of another library's gives. Those of Parquet and HDF5 panic where parts of a file contradict each other, which no check finds
/// before they are decoded; nothing but what is dropped with the panic has changed by then.
fn decoded(read: impl FnOnce() -> Result<Recording, Problem>) -> Result<Recording, Problem> {
    let result = catch_unwind(AssertUnwindSafe(read));
    result.unwrap_or_else(|panic| {
        let message = panic.downcast_ref::<String>().map(String::as_str);
        let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
        Err(Problem::Broken(format!("it cannot be decoded ({message})")))
    })
}

/// The file of signals in a folder that `meshtone simulate` wrote, if there is one: the Parquet file where there are several.
///
/// # Arguments
/// * `directory` - the folder
pub fn signals_in(directory: &Path) -> Option<PathBuf> {
    SignalFormat::ALL.map(|format| directory.join(format.file_name())).into_iter().find(|path| path.is_file())
}

/// Opens a file and finds its format.
fn open(path: &Path, options: &RecordingOptions) -> Result<(File, RecordingFormat), Problem> {
    let (inside, mut file) = packed::unpacked(path, open_ordinary(path)?)?;
    let format = format::detect(&inside, &mut file, options.format)?;
    match &options.variable {
        Some(variable)
            if !matches!(format, RecordingFormat::Npz | RecordingFormat::Mat | RecordingFormat::Hdf5) =>
        {
            let path = path.display();
            let problem = format!(
                "{path}: variable `{variable}` is given, but only NPZ, MAT and HDF5 files and sets of recordings hold variables"
            );
            Err(Problem::Option(problem))
        }
        _ => Ok((file, format)),
    }
}
