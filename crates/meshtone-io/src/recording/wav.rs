//! WAV: PCM of 8, 16, 24 and 32 bits, and floating point of 32 bits.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use hound::{Error, SampleFormat, WavReader};

use super::assemble::{Parts, assemble};
use super::error::{broken, read_failed, unreadable};
use super::label::Label;
use super::rate::StatedRate;
use super::selection::select;
use super::{ReadRecordingError, Recording, RecordingOptions};

const FORMAT: &str = "WAV";

/// Reads a recording from WAV. PCM is scaled so that full scale is 1.
pub(super) fn read(
    path: &Path,
    file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let mut reader = WavReader::new(BufReader::new(file)).map_err(|error| failed(path, error))?;
    let spec = reader.spec();
    if spec.channels == 0 {
        return Err(broken(path, FORMAT, "it has 0 channels"));
    }
    let bytes = u64::from(reader.len()) * u64::from(spec.bits_per_sample / 8);
    if bytes > file_bytes {
        let problem = format!("it announces {bytes} bytes of samples, but ends after {file_bytes}");
        return Err(broken(path, FORMAT, problem));
    }
    let numbers = 1..=usize::from(spec.channels);
    let labels: Vec<Label> = numbers.map(|number| Label::numbered("channel", number)).collect();
    let rate_hz = f64::from(spec.sample_rate);
    let stated = [StatedRate { by: "its header".to_string(), rate_hz }];
    let selection = select(path, &labels, options)?;
    let wanted = selection.wanted();
    let length = reader.duration() as usize;
    let mut samples: Vec<Vec<f64>> = wanted.iter().map(|_| Vec::with_capacity(length)).collect();
    let mut slots: Vec<Option<usize>> = vec![None; labels.len()];
    wanted.iter().enumerate().for_each(|(slot, column)| slots[*column] = Some(slot));
    let mut column = 0;
    let mut keep = |sample: f64| {
        if let Some(slot) = slots[column] {
            samples[slot].push(sample);
        }
        column = (column + 1) % slots.len();
    };
    match spec.sample_format {
        SampleFormat::Float => {
            for sample in reader.samples::<f32>() {
                keep(f64::from(sample.map_err(|error| failed(path, error))?));
            }
        }
        SampleFormat::Int => {
            let full_scale = f64::from(spec.bits_per_sample - 1).exp2();
            for sample in reader.samples::<i32>() {
                keep(f64::from(sample.map_err(|error| failed(path, error))?) / full_scale);
            }
        }
    }
    assemble(Parts { path, labels: &labels, selection: &selection, samples, stated: &stated }, options)
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
            "its samples are neither PCM of 8 to 32 bits nor floating point of 32 bits; convert it, for instance \
             with `ffmpeg -i FILE.wav -c:a pcm_f32le NEW.wav`",
        ),
        other => broken(path, FORMAT, other),
    }
}
