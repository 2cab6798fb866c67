//! WAV: PCM of 8, 16, 24 and 32 bits, and floating point of 32 and 64 bits.

mod double;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use hound::{Error, SampleFormat, WavReader, WavSpec};

use self::double::DoubleWav;
use super::assemble::{Parts, assemble};
use super::error::{broken, read_failed, unreadable};
use super::label::Label;
use super::rate::StatedRate;
use super::selection::select;
use super::{ReadRecordingError, Recording, RecordingOptions, memory_need};

const FORMAT: &str = "WAV";

/// Reads a recording from WAV. PCM is scaled so that full scale is 1.
pub(super) fn read(
    path: &Path,
    mut file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let double = DoubleWav::find(&mut file).map_err(|error| read_failed(path, FORMAT, error))?;
    if let Some(double) = double {
        let head =
            Head { channels: double.channels, rate_hz: double.sampling_rate_hz, samples: double.samples() };
        check_bytes(path, double.bytes(), file_bytes)?;
        if !double.is_whole() {
            let (bytes, channels) = (double.bytes(), double.channels);
            let problem = format!(
                "its {bytes} bytes of samples are no whole number of doubles for each of {channels} channels"
            );
            return Err(broken(path, FORMAT, problem));
        }
        return channels(path, head, options, |wanted| {
            double.read(file, wanted).map_err(|error| read_failed(path, FORMAT, error))
        });
    }
    let mut reader = WavReader::new(BufReader::new(file)).map_err(|error| failed(path, error))?;
    let spec = reader.spec();
    if spec.channels == 0 {
        return Err(broken(path, FORMAT, "it has 0 channels"));
    }
    check_bytes(path, u64::from(reader.len()) * u64::from(spec.bits_per_sample / 8), file_bytes)?;
    let head =
        Head { channels: spec.channels, rate_hz: spec.sample_rate, samples: u64::from(reader.duration()) };
    channels(path, head, options, |wanted| samples(&mut reader, spec, wanted).map_err(|e| failed(path, e)))
}

/// What stands before the samples.
struct Head {
    channels: u16,
    rate_hz: u32,
    /// Of each channel.
    samples: u64,
}

/// The recording of the chosen channels.
///
/// # Arguments
/// * `path`, `options` - of the recording
/// * `head` - what the file announces
/// * `read` - reads the channels that are wanted
fn channels(
    path: &Path,
    head: Head,
    options: &RecordingOptions,
    read: impl FnOnce(&[bool]) -> Result<Vec<Vec<f64>>, ReadRecordingError>,
) -> Result<Recording, ReadRecordingError> {
    let numbers = 1..=usize::from(head.channels);
    let labels: Vec<Label> = numbers.map(|number| Label::numbered("channel", number)).collect();
    let stated = [StatedRate { by: "its header".to_string(), rate_hz: f64::from(head.rate_hz) }];
    let selection = select(path, &labels, options)?;
    let wanted = selection.wanted();
    memory_need::check(path, options, &selection, wanted.iter().map(|_| head.samples), 0)?;
    let is_wanted: Vec<bool> = (0..labels.len()).map(|channel| wanted.contains(&channel)).collect();
    let samples = read(&is_wanted)?;
    assemble(Parts { path, labels: &labels, selection: &selection, samples, stated: &stated }, options)
}

/// The channels that are wanted.
fn samples(
    reader: &mut WavReader<BufReader<File>>,
    spec: WavSpec,
    wanted: &[bool],
) -> Result<Vec<Vec<f64>>, Error> {
    let length = reader.duration() as usize;
    let capacity = |wanted: &bool| Vec::with_capacity(if *wanted { length } else { 0 });
    let mut samples: Vec<Vec<f64>> = wanted.iter().map(capacity).collect();
    let mut column = 0;
    let mut keep = |sample: f64| {
        if wanted[column] {
            samples[column].push(sample);
        }
        column = (column + 1) % wanted.len();
    };
    match spec.sample_format {
        SampleFormat::Float => {
            for sample in reader.samples::<f32>() {
                keep(f64::from(sample?));
            }
        }
        SampleFormat::Int => {
            let full_scale = f64::from(spec.bits_per_sample - 1).exp2();
            for sample in reader.samples::<i32>() {
                keep(f64::from(sample?) / full_scale);
            }
        }
    }
    let columns = samples.into_iter().zip(wanted);
    Ok(columns.filter_map(|(column, wanted)| wanted.then_some(column)).collect())
}

fn check_bytes(path: &Path, bytes: u64, file_bytes: u64) -> Result<(), ReadRecordingError> {
    if bytes <= file_bytes {
        return Ok(());
    }
    let problem = format!("it announces {bytes} bytes of samples, but ends after {file_bytes}");
    Err(broken(path, FORMAT, problem))
}

fn failed(path: &Path, error: Error) -> ReadRecordingError {
    match error {
        Error::IoError(error) if error.kind() == std::io::ErrorKind::Other => {
            broken(path, FORMAT, format!("it ends too early ({error})"))
        }
        Error::IoError(error) => read_failed(path, FORMAT, error),
        Error::Unsupported => broken(
            path,
            FORMAT,
            "its samples are neither PCM of 8 to 32 bits nor floating point of 32 or 64 bits; convert it, for instance \
             with `ffmpeg -i FILE.wav -c:a pcm_f32le NEW.wav`",
        ),
        other => broken(path, FORMAT, other),
    }
}
