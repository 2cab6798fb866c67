//! The key `background`.

use std::path::Path;

use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::scenario_file::read_text;
use meshtone_toml::{ReadResult, TomlValue};

use super::super::{Background, Keep};
use super::{PlanFile, Reading, in_another_file, over_zero};

/// Reads the recording of a healthy machine: its name, or a table with its name, the channel and the sampling rate.
///
/// # Arguments
/// * `value` - of the key
/// * `keep` - whose sampling rate and analysed channel count
/// * `reading` - of the plan
pub(super) fn read(value: &TomlValue<'_>, keep: &Keep, reading: &mut Reading) -> ReadResult<Background> {
    let mut options = RecordingOptions::default();
    let name = if value.is_table() {
        value.table()?.read(|table| {
            let name = table.required("file", "the recording of a healthy machine")?.string()?.to_owned();
            options.channels.extend(table.read_optional("channel", TomlValue::string)?.map(Into::into));
            options.sampling_rate_hz =
                table.read_optional("sampling_rate_hz", |rate| over_zero(rate, "must be more than 0 S/s"))?;
            Ok(name)
        })?
    } else {
        value.string()?.to_owned()
    };
    let path = reading.path_of(&name, PlanFile::NAMES[3]);
    let background = if reading.is_copy {
        let text = read_text(&path).map_err(|error| in_another_file(value, error, reading))?;
        let read = Background::from_text(&text);
        read.ok_or_else(|| value.error(format!("{}: has lines that are no finite numbers", path.display())))?
    } else {
        recorded(value, &path, &options, keep)?
    };
    reading.sources.push(path);
    reading.files.push(PlanFile { name: PlanFile::NAMES[3], text: background.to_text() });
    Ok(background)
}

/// The background of a recording.
fn recorded(
    value: &TomlValue<'_>,
    path: &Path,
    options: &RecordingOptions,
    keep: &Keep,
) -> ReadResult<Background> {
    let recording = read_recording(path, options).map_err(|error| value.error(error.to_string()))?;
    let refuse = |problem: String| value.error(format!("{}: {problem}", path.display()));
    let analysed = keep.analysed.name();
    let found = match &recording.channels[..] {
        [only] => only,
        several => recording.channel(&analysed).ok_or_else(|| {
            let names: Vec<&str> = several.iter().map(|channel| channel.name.as_str()).collect();
            refuse(format!("has the channels {}", names.join(", ")))
                .with_help("name one: background = { file = \"…\", channel = \"…\" }")
        })?,
    };
    let (from_hz, to_hz) = (recording.sampling_rate_hz, keep.sampling_rate_hz);
    if from_hz < to_hz {
        let problem = format!("is sampled at {from_hz:?} S/s, below keep.sampling_rate_hz, {to_hz:?} S/s");
        return Err(refuse(problem).with_help("lower keep.sampling_rate_hz, or record at a higher rate"));
    }
    Background::of_recording(&found.samples, from_hz, to_hz).map_err(|error| refuse(error.to_string()))
}
