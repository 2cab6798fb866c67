//! The recording out of what a file's reader gives.

use std::path::Path;

use super::label::Label;
use super::rate::{self, StatedRate};
use super::selection::{Selection, matching, present};
use super::time::timing;
use super::unit::volts_in;
use super::{Channel, Position, ReadRecordingError, Recording, RecordingOptions};

/// Samples of a block that is checked as a whole.
const CHECKED_TOGETHER: usize = 1024;

/// What a reader gives.
pub(super) struct Parts<'p> {
    pub path: &'p Path,
    pub labels: &'p [Label],
    pub selection: &'p Selection,
    /// Samples of each column of [`Selection::wanted`].
    pub samples: Vec<Vec<f64>>,
    pub stated: &'p [StatedRate],
}

/// Checks and calibrates the samples, and finds the sampling rate.
pub(super) fn assemble(parts: Parts, options: &RecordingOptions) -> Result<Recording, ReadRecordingError> {
    let Parts { path, labels, selection, mut samples, stated } = parts;
    let wanted = selection.wanted();
    check_lengths(path, labels, &wanted, &samples)?;
    for (index, column) in wanted.iter().zip(&samples) {
        check_finite(path, &labels[*index], column)?;
    }
    let slot = |index: usize| wanted.iter().position(|wanted| *wanted == index);
    let timing = match selection.time {
        Some((index, unit_s)) => {
            let times = slot(index).map(|slot| &samples[slot][..]).unwrap_or_default();
            let column = &labels[index].raw;
            Some((column.clone(), timing(path, column, times, unit_s)?))
        }
        None => None,
    };
    let (sampling_rate_hz, start_s) = rate::decide(path, stated, timing, options, || present(labels))?;
    let channel = |index: &usize| Channel {
        name: labels[*index].name.clone(),
        unit: labels[*index].unit.clone(),
        samples: slot(*index).map(|slot| std::mem::take(&mut samples[slot])).unwrap_or_default(),
    };
    let mut channels: Vec<Channel> = selection.channels.iter().map(channel).collect();
    calibrate(path, labels, selection, &mut channels, options)?;
    Ok(Recording {
        sampling_rate_hz,
        start_s,
        channels,
        source: path.to_path_buf(),
        scenario_toml: None,
        warnings: Vec::new(),
    })
}

fn check_lengths(
    path: &Path,
    labels: &[Label],
    wanted: &[usize],
    samples: &[Vec<f64>],
) -> Result<(), ReadRecordingError> {
    let lengths: Vec<usize> = samples.iter().map(Vec::len).collect();
    if lengths.iter().any(|length| *length != lengths[0]) {
        let lengths = wanted.iter().zip(lengths);
        let lengths = lengths.map(|(index, length)| format!("{} ({length} samples)", labels[*index].raw));
        return Err(ReadRecordingError::UnequalLengths {
            path: path.to_path_buf(),
            lengths: lengths.collect(),
        });
    }
    if lengths.first().is_none_or(|length| *length == 0) {
        let problem = "has columns, but no samples".to_string();
        return Err(ReadRecordingError::Empty { path: path.to_path_buf(), problem });
    }
    Ok(())
}

fn check_finite(path: &Path, label: &Label, samples: &[f64]) -> Result<(), ReadRecordingError> {
    // Block by block, without a way out in between: in vectors.
    let is_finite = |block: &[f64]| block.iter().fold(true, |all, sample| all & sample.is_finite());
    let start =
        samples.chunks(CHECKED_TOGETHER).take_while(|block| is_finite(block)).count() * CHECKED_TOGETHER;
    let rest = samples.get(start..).unwrap_or_default();
    let Some(index) = rest.iter().position(|sample| !sample.is_finite()).map(|index| start + index) else {
        return Ok(());
    };
    Err(ReadRecordingError::Gap {
        path: path.to_path_buf(),
        position: Position::Sample(index as u64 + 1),
        column: label.raw.clone(),
        what: if samples[index].is_nan() { "NaN" } else { "infinite" }.to_string(),
    })
}

fn calibrate(
    path: &Path,
    labels: &[Label],
    selection: &Selection,
    channels: &mut [Channel],
    options: &RecordingOptions,
) -> Result<(), ReadRecordingError> {
    for calibration in &options.calibrations {
        for index in matching(path, labels, &calibration.channel)? {
            let slot = selection.channels.iter().position(|channel| *channel == index);
            let Some(channel) = slot.map(|slot| &mut channels[slot]) else {
                let column = &labels[index].raw;
                let problem =
                    format!("a unit or sensitivity is given for column `{column}`, which is not read");
                return Err(ReadRecordingError::Option { problem });
            };
            channel.calibrate(calibration.sensitivity_v_per_unit, calibration.unit.as_deref())?;
        }
    }
    Ok(())
}

impl Channel {
    /// Gives the samples their meaning, as a [calibration](super::Calibration) of the options does.
    ///
    /// # Arguments
    /// * `sensitivity_v_per_unit` - (V/unit) finite and not 0: the samples are volts and are divided by it
    /// * `unit` - of the samples, after the division
    ///
    /// # Errors
    /// A channel whose unit is none of voltage, or that becomes infinite, where a sensitivity is given.
    pub fn calibrate(
        &mut self,
        sensitivity_v_per_unit: Option<f64>,
        unit: Option<&str>,
    ) -> Result<(), ReadRecordingError> {
        if let Some(sensitivity) = sensitivity_v_per_unit {
            divide(self, sensitivity)?;
        }
        if let Some(unit) = unit {
            self.unit = Some(unit.to_owned());
        }
        Ok(())
    }
}

/// Turns volts into what was measured; its unit is then unknown.
fn divide(channel: &mut Channel, sensitivity_v_per_unit: f64) -> Result<(), ReadRecordingError> {
    let Channel { name, unit, samples } = channel;
    let volts = match unit.as_deref() {
        None => 1.0,
        Some(unit) => volts_in(unit).ok_or_else(|| {
            let problem = format!(
                "a sensitivity is given for channel {name}, but its unit is {unit}; a sensitivity divides volts"
            );
            ReadRecordingError::Option { problem }
        })?,
    };
    // Two roundings, but none for a sensitivity in a channel of volts.
    for sample in samples.iter_mut() {
        *sample = *sample * volts / sensitivity_v_per_unit;
    }
    if samples.iter().any(|sample| !sample.is_finite()) {
        let problem = format!(
            "channel {name} becomes infinite when divided by its sensitivity, {sensitivity_v_per_unit} V per unit"
        );
        return Err(ReadRecordingError::Option { problem });
    }
    *unit = None;
    Ok(())
}
