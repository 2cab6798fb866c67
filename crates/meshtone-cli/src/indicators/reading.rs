//! A recording, and the channel of it that is processed.

use std::path::{Path, PathBuf};

use meshtone::scenario::Scenario;
use meshtone::sensor::{ChannelKind, Channels};
use meshtone_io::indicators::WarningEntry;
use meshtone_io::recording::{
    Channel, ColumnChoice, Recording, RecordingOptions, RecordingWarning, TextOptions, TimeColumn, names,
    read_recording,
};

use super::options::ReadingOptions;
use super::refuse::unreadable;
use crate::failure::Failure;
use crate::warnings::about;

/// Numbers that processing holds for each sample at most, beside the recording: its phase, what is resampled, averages, spectra.
const NUMBERS_BESIDE_EACH_SAMPLE: u64 = 8;

/// The channel of a simulation that is processed unless another is chosen: the first sensor's, or the vertical acceleration.
fn leading_of(scenario_toml: &str) -> String {
    // What another version wrote has no sensors, or is looked at without them.
    let signals = Scenario::from_toml(scenario_toml).map_or_else(|_| Vec::new(), |form| form.signals());
    let channels = Channels::new(0.0, 0.0, signals);
    let leading = channels.leading().map(|signal| signal.name.to_string());
    leading.unwrap_or_else(|| ChannelKind::Vertical.name().to_owned())
}

/// A recording with the channel that is processed and the one that gives the phase.
#[derive(Debug)]
pub struct Input {
    /// The file that was read.
    pub source: PathBuf,
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// (s) Time of the first sample.
    pub start_s: f64,
    /// The channel that is processed.
    pub channel: Channel,
    /// Tachometer or speed.
    pub turning: Option<Channel>,
    /// Whether the file itself says when its samples were taken.
    pub has_own_time: bool,
    /// Scenario of a simulation, as TOML; none of a measurement.
    pub scenario_toml: Option<String>,
    /// Warnings about the file.
    pub warnings: Vec<WarningEntry>,
}

impl Input {
    /// Reads a recording.
    ///
    /// # Arguments
    /// * `path` - a file, or a directory that `meshtone simulate` wrote
    /// * `options` - what is read
    /// * `turning` - name or number of the channel that gives the phase, behind the option that says so
    pub fn read(
        path: &Path,
        options: &ReadingOptions,
        turning: Option<(&str, &str)>,
    ) -> Result<Self, Failure> {
        // The tachometer comes by itself: only so is it known which of the columns it is.
        let turning = turning.map(|(option, choice)| read_one(path, options, option, choice)).transpose()?;
        let mut recording = read_recording(path, &columns(options, options.channel.as_deref()))?;
        let clock = |of: &Recording| [of.sampling_rate_hz, of.start_s];
        let turning = match turning {
            Some(turning) if clock(&turning) != clock(&recording) => {
                if !turning.covers(&recording) {
                    let name = &turning.channels[0].name;
                    let problem =
                        format!("{}: channel {name} was recorded over another time", path.display());
                    return Failure::refuse(problem, "name channels that were recorded together");
                }
                Some(turning.at_samples_of(&recording))
            }
            same => same,
        };
        let mut warnings: Vec<WarningEntry> = turning.iter().flat_map(warnings_of).collect();
        let turning = turning.and_then(|mut turning| turning.channels.pop());
        warnings.extend(options.in_kilohertz().map(|message| about(path, message)));
        warnings.extend(warnings_of(&recording));
        warnings.dedup();
        let simulated = recording.scenario_toml.as_deref().map(leading_of);
        if options.channel.is_none() {
            let keep = |channel: &Channel| {
                let is_turning = turning.as_ref().is_some_and(|turning| turning.name == channel.name);
                !is_turning && simulated.as_ref().is_none_or(|name| channel.name == *name)
            };
            recording.channels.retain(keep);
            let (live, warned) = without_silent_channels(recording.channels, path);
            recording.channels = live;
            warnings.extend(warned);
        }
        let mut channel = one(path, recording.channels, options.channel.as_deref())?;
        if let Some(turning) = &turning {
            check_turning(path, options, turning, &channel)?;
        }
        calibrate(&mut channel, options)?;
        Ok(Self {
            source: path.to_path_buf(),
            sampling_rate_hz: recording.sampling_rate_hz,
            start_s: recording.start_s,
            channel,
            turning,
            has_own_time: options.sampling_rate_hz.is_none() && options.time_column.is_none(),
            scenario_toml: recording.scenario_toml,
            warnings,
        })
    }
}

/// Names of columns that say where in a revolution its values are.
const PLACES: [&str; 6] = ["angle", "time", "revolution", "rev", "tooth", "pitch"];

/// Reads one revolution of a wheel; when or where its values were taken is not looked at.
///
/// # Arguments
/// * `path` - a file
/// * `options` - what is read
pub fn read_revolution(
    path: &Path,
    options: &ReadingOptions,
) -> Result<(Channel, Vec<WarningEntry>), Failure> {
    let chosen = RecordingOptions {
        // Whatever it is, no sample is asked when it was taken.
        sampling_rate_hz: Some(options.sampling_rate_hz.unwrap_or(1.0)),
        ..columns(options, options.channel.as_deref())
    };
    let mut recording = read_recording(path, &chosen)?;
    recording.warnings.retain(|warning| !matches!(warning, RecordingWarning::OtherRate { .. }));
    let warnings = warnings_of(&recording);
    if options.channel.is_none() && recording.channels.len() > 1 {
        recording.channels.retain(|channel| {
            let name = channel.name.to_lowercase();
            let word = name.split(|letter: char| !letter.is_alphabetic()).next();
            !word.is_some_and(|word| PLACES.contains(&word))
        });
    }
    let mut channel = one(path, recording.channels, options.channel.as_deref())?;
    calibrate(&mut channel, options)?;
    Ok((channel, warnings))
}

/// (S/s) The sampling rate that a file says itself; none where it does not, as of values over an angle.
///
/// # Arguments
/// * `path` - the file
/// * `options` - what is read
pub fn own_rate_hz(path: &Path, options: &ReadingOptions) -> Option<f64> {
    read_recording(path, &columns(options, None)).ok().map(|recording| recording.sampling_rate_hz)
}

/// Warnings about a file that was read.
pub fn warnings_of(recording: &Recording) -> Vec<WarningEntry> {
    recording.warnings.iter().map(|warning| about(&recording.source, warning)).collect()
}

fn read_one(path: &Path, options: &ReadingOptions, option: &str, choice: &str) -> Result<Recording, Failure> {
    let recording = read_recording(path, &columns(options, Some(choice)));
    let recording = recording.map_err(|error| unreadable(error, option))?;
    let channels = vec![one(path, recording.channels, Some(choice))?];
    Ok(Recording { channels, ..recording })
}

/// Refuses a channel that gives the phase and is the vibration too, or has another number of samples.
fn check_turning(
    path: &Path,
    options: &ReadingOptions,
    turning: &Channel,
    channel: &Channel,
) -> Result<(), Failure> {
    let (name, shown) = (&channel.name, path.display());
    // Two columns may have one name; without a sensitivity the same one has the same samples.
    if let Some(choice) = options.channel.as_deref()
        && turning.name == *name
        && read_one(path, options, "--channel", choice)?.channels[0].samples == turning.samples
    {
        let problem = format!("{shown}: channel {name} is both processed and what gives the phase");
        let help =
            "name the vibration with --channel, and tachometer or speed with --tach or --speed-channel";
        return Failure::refuse(problem, help);
    }
    let [of_turning, of_channel] = [turning, channel].map(|channel| channel.samples.len());
    if of_turning != of_channel {
        return Err(Failure::bad_input(format!(
            "{shown}: channel {} has {of_turning} samples, but {name} has {of_channel}; must be equally many",
            turning.name
        )));
    }
    Ok(())
}

/// The only channel there is.
fn one(path: &Path, mut channels: Vec<Channel>, choice: Option<&str>) -> Result<Channel, Failure> {
    let path = path.display();
    let count = channels.len();
    if count == 0 {
        let problem = format!("{path}: has no channel besides the one that gives the phase");
        return Err(Failure::bad_input(problem));
    }
    if count == 1 {
        return Ok(channels.swap_remove(0));
    }
    let list = names(&channels.into_iter().map(|channel| channel.name).collect::<Vec<_>>());
    let (problem, help) = match choice {
        Some(choice) => (format!("channel `{choice}` is {count} columns"), "choose one of them"),
        None => (format!("has {count} channels"), "choose one with --channel NAME"),
    };
    Failure::refuse(format!("{path}: {problem}: {list}"), help)
}

/// Options by which a column is read, or all columns.
fn columns(options: &ReadingOptions, choice: Option<&str>) -> RecordingOptions {
    let time = match options.time_column.as_deref() {
        None => TimeColumn::ByName,
        Some("none") => TimeColumn::Absent,
        Some(choice) => TimeColumn::Chosen(ColumnChoice::parse(choice)),
    };
    RecordingOptions {
        channels: choice.map(ColumnChoice::parse).into_iter().collect(),
        time,
        sampling_rate_hz: options.sampling_rate_hz,
        variable: options.variable.clone(),
        text: TextOptions {
            separator: options.separator,
            decimal_sign: options.decimal_sign,
            skip_lines: options.skip_lines,
        },
        numbers_beside_each_sample: NUMBERS_BESIDE_EACH_SAMPLE,
        ..RecordingOptions::default()
    }
}

/// Sets the meaning of the samples of the channel, where the options state it: whether or not they name the channel.
fn calibrate(channel: &mut Channel, options: &ReadingOptions) -> Result<(), Failure> {
    let sensitivity = options.sensitivity_mv_per_unit;
    if let Some(wrong) = sensitivity.filter(|sensitivity| !sensitivity.is_finite() || *sensitivity == 0.0) {
        let problem = format!("--sensitivity-mv-per-unit: is {wrong}; must be a finite number other than 0");
        return Err(Failure::bad_input(problem));
    }
    let sensitivity_v_per_unit = sensitivity.map(|millivolts| millivolts / 1e3);
    channel.calibrate(sensitivity_v_per_unit, options.unit.as_deref()).map_err(Failure::bad_input)
}

/// Leaves out what is 0 throughout beside channels that are not, as of inputs that nothing was connected to. A warning names it.
fn without_silent_channels(channels: Vec<Channel>, source: &Path) -> (Vec<Channel>, Option<WarningEntry>) {
    let is_dead = |channel: &Channel| channel.samples.iter().all(|sample| *sample == 0.0);
    if channels.iter().all(is_dead) || !channels.iter().any(is_dead) {
        return (channels, None);
    }
    let (dead, live): (Vec<Channel>, Vec<Channel>) = channels.into_iter().partition(is_dead);
    let names: Vec<&str> = dead.iter().map(|channel| channel.name.as_str()).collect();
    let (names, is) = (names.join(", "), if dead.len() == 1 { "is" } else { "are" });
    let message = format!("{names} {is} 0 throughout and left out; --channel NAME reads it all the same");
    (live, Some(about(source, message)))
}
