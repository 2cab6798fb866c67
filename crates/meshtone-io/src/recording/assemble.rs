//! The recording out of what a file's reader gives.

use std::path::PathBuf;

use meshtone::signal::{SAMPLING_RATES_HZ, copies};

use super::error::{Problem, names};
use super::label::Label;
use super::rate::{self, StatedRate};
use super::selection::{Selection, matching, present};
use super::time::timing;
use super::unit::conversion;
use super::{Channel, Recording, RecordingOptions, RecordingWarning};

/// (S/s) Rate below which times without a unit are hardly seconds.
const LEAST_RATE_HZ: f64 = 100.0;
/// Samples of a block that is checked as a whole.
const CHECKED_TOGETHER: usize = 1024;

/// Checks and calibrates what a reader gives, and finds the sampling rate. The path is added where the readers are called.
///
/// # Arguments
/// * `labels`, `selection` - the columns, and which of them were read
/// * `samples` - of each column of [`Selection::wanted`]
/// * `stated` - rates that the file states
/// * `options` - of the recording
pub(super) fn assemble(
    labels: &[Label],
    selection: &Selection,
    mut samples: Vec<Vec<f64>>,
    stated: &[StatedRate],
    options: &RecordingOptions,
) -> Result<Recording, Problem> {
    check_lengths(labels, selection, &samples)?;
    for (index, column) in selection.wanted.iter().zip(&samples) {
        check_finite(&labels[*index], column)?;
    }
    let slot = |index: usize| selection.wanted.binary_search(&index).ok();
    let timing = match selection.time {
        Some((index, unit_s)) => {
            let times = slot(index).map(|slot| &samples[slot][..]).unwrap_or_default();
            let column = &labels[index].raw;
            let timing = timing(column, times, unit_s)?;
            if timing.rate_hz < LEAST_RATE_HZ && !labels[index].states_time_unit() {
                let rate_hz = timing.rate_hz;
                let (unit, of_unit_hz) =
                    if rate_hz < 1.0 { ("us", 1e6 * rate_hz) } else { ("ms", 1e3 * rate_hz) };
                let problem = format!(
                    "states no unit, and as seconds it gives {rate_hz} S/s, too few for a gear; name it `{column}_{unit}` if it is in {unit} \
                     ({of_unit_hz} S/s), or `{column}_s`"
                );
                return Err(Problem::time(column, &problem));
            }
            Some((&column[..], timing))
        }
        None => None,
    };
    let (StatedRate { by: rate_by, rate_hz: sampling_rate_hz }, start_s) =
        rate::decide(stated, timing, options, || present(labels))?;
    if !SAMPLING_RATES_HZ.contains(&sampling_rate_hz) {
        let problem = format!("a sampling rate of {sampling_rate_hz:e} S/s; must be from 1e-6 to 1e12 S/s");
        return Err(Problem::rate(&problem));
    }
    let channel = |index: &usize| Channel {
        name: labels[*index].name.clone(),
        unit: labels[*index].unit.clone(),
        samples: slot(*index).map(|slot| std::mem::take(&mut samples[slot])).unwrap_or_default(),
    };
    let mut channels: Vec<Channel> = selection.channels.iter().map(channel).collect();
    calibrate(labels, selection, &mut channels, options)?;
    let mut warnings: Vec<RecordingWarning> = rate::other_than_stated(stated, options).into_iter().collect();
    // As spreadsheets and data frames write before the others; one without a name only beside names.
    let first = selection.channels.first().filter(|_| options.channels.is_empty() && channels.len() > 1);
    let is_counter = |label: &Label| label.is_named_as_counter() && channels[1].name != "column 2";
    if first.is_some_and(|first| is_counter(&labels[*first])) && counts(&channels[0].samples) {
        warnings.push(RecordingWarning::Counter { name: channels.remove(0).name });
    }
    let samples: Vec<&[f64]> = channels.iter().map(|channel| &channel.samples[..]).collect();
    let copy = |[of, copy]: [usize; 2]| RecordingWarning::Copy {
        name: channels[copy].name.clone(),
        of: channels[of].name.clone(),
    };
    warnings.extend(copies(&samples).into_iter().map(copy));
    Ok(Recording {
        sampling_rate_hz,
        rate_by,
        start_s,
        channels,
        source: PathBuf::new(),
        scenario_toml: None,
        warnings,
    })
}

/// Whether samples are whole numbers, each by one more than the one before.
fn counts(samples: &[f64]) -> bool {
    samples.len() > 2 && samples[0].fract() == 0.0 && samples.windows(2).all(|pair| pair[1] == pair[0] + 1.0)
}

fn check_lengths(labels: &[Label], selection: &Selection, samples: &[Vec<f64>]) -> Result<(), Problem> {
    let length = samples.first().map_or(0, Vec::len);
    if samples.iter().any(|column| column.len() != length) {
        let columns = selection.wanted.iter().zip(samples);
        let described = |(index, column): (&usize, &Vec<f64>)| {
            format!("{} ({} samples)", labels[*index].raw, column.len())
        };
        let lengths: Vec<String> = columns.map(described).collect();
        return Err(Problem::Refused(format!(
            "the channels are not equally long; choose those that belong together (option channels, or variable): {}",
            names(&lengths)
        )));
    }
    if length == 0 {
        return Err(Problem::Refused("has columns, but no samples".to_string()));
    }
    Ok(())
}

fn check_finite(label: &Label, samples: &[f64]) -> Result<(), Problem> {
    // Block by block, without a way out in between: in vectors.
    let is_finite = |block: &[f64]| block.iter().fold(true, |all, sample| all & sample.is_finite());
    let whole = samples.chunks(CHECKED_TOGETHER).take_while(|block| is_finite(block)).count();
    let mut rest = samples.iter().enumerate().skip(whole * CHECKED_TOGETHER);
    let Some((index, sample)) = rest.find(|(_, sample)| !sample.is_finite()) else { return Ok(()) };
    let what = if sample.is_nan() { "NaN" } else { "infinite" };
    Err(Problem::gap(format!("sample {}", index + 1), &label.raw, what))
}

fn calibrate(
    labels: &[Label],
    selection: &Selection,
    channels: &mut [Channel],
    options: &RecordingOptions,
) -> Result<(), Problem> {
    for calibration in &options.calibrations {
        for index in matching(labels, &calibration.channel)? {
            let Some(slot) = selection.channels.iter().position(|channel| *channel == index) else {
                let column = &labels[index].raw;
                return Err(Problem::Option(format!(
                    "a unit or sensitivity is given for column `{column}`, which is not read"
                )));
            };
            let (sensitivity, unit) = (calibration.sensitivity_v_per_unit, calibration.unit.as_deref());
            channels[slot].calibrate(sensitivity, unit).map_err(Problem::Option)?;
        }
    }
    Ok(())
}

impl Channel {
    /// Gives the samples their meaning, as a [calibration](super::Calibration) of the options does.
    ///
    /// # Arguments
    /// * `sensitivity_v_per_unit` - (V/unit) finite and not 0: the samples are volts and are divided by it
    /// * `unit` - of the samples, after the division; samples in another unit of the same quantity are converted
    ///
    /// # Errors
    /// The channel's own unit contradicts `unit`; it is none of voltage, or the channel becomes infinite, where a sensitivity is given: what is
    /// wrong.
    pub fn calibrate(
        &mut self,
        sensitivity_v_per_unit: Option<f64>,
        unit: Option<&str>,
    ) -> Result<(), String> {
        if let Some(sensitivity) = sensitivity_v_per_unit {
            self.divide(sensitivity)?;
        }
        let Some(stated) = unit else { return Ok(()) };
        if let Some(own) = &self.unit {
            let factor = conversion(own, stated).ok_or_else(|| {
                format!(
                    "the unit {stated} is stated for channel {}, but the file says {own}, which does not convert to it; leave the unit out, \
                     state the sensitivity where the samples are volts, or correct the file",
                    self.name
                )
            })?;
            if factor != 1.0 {
                self.samples.iter_mut().for_each(|sample| *sample *= factor);
            }
        }
        self.unit = Some(stated.to_owned());
        Ok(())
    }

    /// Turns volts into what was measured; its unit is then unknown.
    fn divide(&mut self, sensitivity_v_per_unit: f64) -> Result<(), String> {
        let Channel { name, unit, samples } = self;
        let volts = match unit.as_deref() {
            None => 1.0,
            Some(unit) => conversion(unit, "V").ok_or_else(|| {
                format!(
                    "a sensitivity is given for channel {name}, but its unit is {unit}; a sensitivity divides volts"
                )
            })?,
        };
        // Two roundings, but none for a sensitivity in a channel of volts.
        samples.iter_mut().for_each(|sample| *sample = *sample * volts / sensitivity_v_per_unit);
        if samples.iter().any(|sample| !sample.is_finite()) {
            return Err(format!(
                "channel {name} becomes infinite when divided by its sensitivity, {sensitivity_v_per_unit} V per unit"
            ));
        }
        *unit = None;
        Ok(())
    }
}
