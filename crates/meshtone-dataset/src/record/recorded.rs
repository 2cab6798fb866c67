//! Records of recordings: the same channels, windows and columns as those of a data set.

use std::error::Error;

use meshtone::scenario::Scenario;
use meshtone::signal::{AntiAliasing, Edge, GearTrain, ShaftPhase};

use super::kept::KeptChain;
use super::{Record, RecordWheel};
use crate::draw::DrawnRecord;
use crate::plan::Content;

/// (rev) Distance from a whole revolution that is rounding.
const ROUNDING_REV: f64 = 1e-9;

/// A recording of a machine that is to become records like those of a data set.
#[derive(Debug, Clone, Copy)]
pub struct MachineRecording<'a> {
    /// Channels by the data set's names, all as long.
    pub channels: &'a [(String, Vec<f32>)],
    /// (S/s) Their sampling rate.
    pub sampling_rate_hz: f64,
    /// The machine: its tooth counts are used, and its values stand in the columns of the plan's keys.
    pub machine: &'a Scenario,
    /// Name of the shaft that the phase is of; none for the input.
    pub shaft: Option<&'a str>,
    /// Phase of that shaft.
    pub phase: &'a ShaftPhase,
}

/// The length of a window.
enum Length {
    /// (rev) Of the first averaged wheel.
    Revolutions(f64),
    /// At the data set's rate.
    Samples(usize),
}

/// The records of a recording: one window after the other, each as long as a record of the data set, from a whole revolution of the first
/// averaged wheel on.
///
/// The channels are resampled by the filter that resamples simulated ones, and go through the same chain. The angles of all shafts are
/// counted from the start of the window, as those of a simulated record are.
///
/// # Arguments
/// * `content` - of the data set's plan
/// * `recording` - the recording
/// * `number` - of the recording, which stands in the column `unit`
/// * `first` - number of the first record
///
/// # Errors
/// A machine, shaft or channel that does not fit the plan; a lower sampling rate than the data set's; fewer revolutions than a record has;
/// those of the signal chain.
pub(crate) fn records(
    content: &Content,
    recording: &MachineRecording<'_>,
    number: u64,
    first: u64,
) -> Result<Vec<Record>, Box<dyn Error>> {
    let keep = &content.keep;
    let train = GearTrain::of_scenario(recording.machine)?;
    let wheels: Vec<usize> =
        keep.wheel.all().iter().map(|wheel| wheel_number(&train, wheel)).collect::<Result<_, _>>()?;
    let reference = train.wheels[wheels[0]].shaft;
    let (channels, analysed) = resampled(content, recording)?;
    let phase = carried(recording, &train, reference, keep.sampling_rate_hz)?;
    let (operation, rate_hz) = (&recording.machine.operation, keep.sampling_rate_hz);
    let ratio = |shaft: usize| train.speed_ratio(shaft, reference).value();
    let length = length(content, recording.machine, ratio(train.input()));
    let windows = windows(&phase, &length);
    if windows.is_empty() {
        let needed = match length {
            Length::Revolutions(revolutions) => format!("{revolutions:.3} revolutions and a sample more"),
            Length::Samples(samples) => {
                format!("{:.3} s from its first whole revolution on", samples as f64 / rate_hz)
            }
        };
        return Err(format!(
            "it turns {:.3} revolutions of the {} in {:.3} s; a record of the data set needs {needed}",
            phase.span_rev(),
            keep.wheel.all()[0],
            phase.revolutions.len() as f64 / rate_hz
        )
        .into());
    }
    let record = |(window, (start_rev, from, to)): (u64, (f64, usize, usize))| {
        let angles = &phase.revolutions[from - phase.first_sample..to - phase.first_sample];
        let turned = |shaft: usize| {
            let relative = angles.iter().map(|angle| (angle - start_rev) * ratio(shaft)).collect();
            ShaftPhase::new(0, relative)
        };
        let phases =
            wheels.iter().map(|&wheel| turned(train.wheels[wheel].shaft)).collect::<Result<_, _>>()?;
        let chain = KeptChain { keep, train: train.clone(), phases };
        let speed_hz = (angles[angles.len() - 1] - angles[0]) * rate_hz / (angles.len() - 1) as f64;
        let values = recording.machine.numbers().into_iter().map(|number| (number.key, number.value));
        let mut record = Record {
            drawn: DrawnRecord {
                index: first + window,
                unit: number,
                values: values.collect(),
                ..DrawnRecord::default()
            },
            wheels: (train.wheels.iter())
                .map(|of| RecordWheel {
                    teeth: of.teeth,
                    speed_hz: speed_hz * ratio(of.shaft),
                    angle_rev: 0.0,
                })
                .collect(),
            input_speed_hz: speed_hz * ratio(train.input()),
            brake_torque_nm: operation.brake_torque_nm,
            sampling_rate_hz: rate_hz,
            simulated_s: (to - from) as f64 / rate_hz,
            ..Record::default()
        };
        let part = |channel: &Vec<f32>| channel.get(from..to).map(<[f32]>::to_vec).unwrap_or_default();
        chain.fill(&mut record, analysed, channels.iter().map(part).collect())?;
        Ok(record)
    };
    (0..).zip(windows).map(record).collect()
}

/// Number of a wheel of the plan in the machine that was recorded.
fn wheel_number(train: &GearTrain, wheel: &str) -> Result<usize, String> {
    let names: Vec<&str> = train.wheels.iter().map(|known| known.name.as_str()).collect();
    let number = names.iter().position(|name| *name == wheel);
    number.ok_or_else(|| {
        format!("the machine has no wheel {:?}, which the data set averages, but {}", wheel, names.join(", "))
    })
}

/// The phase of a shaft at the data set's rate, as far as it is known.
///
/// # Arguments
/// * `recording` - with the phase of another shaft
/// * `train` - of its machine
/// * `shaft` - number of the shaft
/// * `to_hz` - (S/s) the data set's rate
fn carried(
    recording: &MachineRecording<'_>,
    train: &GearTrain,
    shaft: usize,
    to_hz: f64,
) -> Result<ShaftPhase, Box<dyn Error>> {
    let names: Vec<&str> = train.shafts.iter().map(|shaft| shaft.name.as_str()).collect();
    let known = match recording.shaft {
        None => train.input(),
        Some(name) => names
            .iter()
            .position(|known| *known == name)
            .ok_or_else(|| format!("the machine has no shaft {name:?}, but {}", names.join(", ")))?,
    };
    let phase = train.carried(recording.phase, known, shaft)?;
    let samples = recording.channels.iter().map(|(_, samples)| samples.len()).min().unwrap_or(0);
    let (first, end) = (phase.first_sample, phase.first_sample + phase.revolutions.len());
    if end > samples {
        return Err(format!("it has {samples} samples, but its phase is known up to sample {end}").into());
    }
    let step = recording.sampling_rate_hz / to_hz;
    let from = (first as f64 / step).ceil() as usize;
    let to = ((end - 1) as f64 / step).floor() as usize;
    let angle = |sample: usize| {
        let place = sample as f64 * step - first as f64;
        let before = (place as usize).min(phase.revolutions.len() - 2);
        let [a, b] = [phase.revolutions[before], phase.revolutions[before + 1]];
        a + (place - before as f64) * (b - a)
    };
    Ok(ShaftPhase::new(from, (from..=to).map(angle).collect())?)
}

/// How long a record of the data set is.
///
/// # Arguments
/// * `content` - of the plan
/// * `machine` - that was recorded
/// * `input_ratio` - speed of the input over that of the first averaged wheel
fn length(content: &Content, machine: &Scenario, input_ratio: f64) -> Length {
    let (keep, solver) = (&content.keep, &content.base.solver);
    match (keep.over_angle, keep.duration_s.or(solver.duration_s)) {
        (Some(angle), _) => Length::Revolutions(angle.revolutions as f64),
        (None, Some(seconds)) => Length::Samples((seconds * keep.sampling_rate_hz).round() as usize),
        (None, None) => {
            let mut machine = machine.clone();
            machine.solver = solver.clone();
            let time = machine.time_grid();
            let input_rev = time.kept_samples() as f64 / time.samples_per_pinion_revolution as f64;
            Length::Revolutions(input_rev / input_ratio)
        }
    }
}

/// Start (rev), first sample and end of each window.
fn windows(phase: &ShaftPhase, length: &Length) -> Vec<(f64, usize, usize)> {
    let (first, end) = (phase.first_sample, phase.first_sample + phase.revolutions.len());
    let whole = |angle: f64| (angle - ROUNDING_REV).ceil();
    let last_rev = phase.revolutions[phase.revolutions.len() - 1];
    let mut windows = Vec::new();
    let mut start_rev = whole(phase.revolutions[0]);
    while start_rev < last_rev {
        let from = phase.sample_at(start_rev).floor() as usize;
        let to = match length {
            Length::Samples(samples) => from + samples,
            Length::Revolutions(revolutions) if start_rev + revolutions <= last_rev + ROUNDING_REV => {
                (phase.sample_at(start_rev + revolutions).ceil() as usize + 1).min(end)
            }
            Length::Revolutions(_) => break,
        };
        if to > end || to < from + 2 {
            break;
        }
        windows.push((start_rev, from, to));
        start_rev = match length {
            Length::Samples(_) => whole(phase.revolutions[to - 1 - first]),
            Length::Revolutions(revolutions) => whole(start_rev + revolutions),
        };
    }
    windows
}

/// The channels in the order of [`Keep::simulated`] at the data set's rate, empty where one was not recorded, and the number of the analysed
/// one.
///
/// [`Keep::simulated`]: crate::plan::Keep::simulated
fn resampled(
    content: &Content,
    recording: &MachineRecording<'_>,
) -> Result<(Vec<Vec<f32>>, Option<usize>), String> {
    let keep = &content.keep;
    let simulated = keep.simulated();
    let names: Vec<String> = simulated.iter().map(|channel| channel.name().into_owned()).collect();
    if let Some((name, _)) = recording.channels.iter().find(|(name, _)| !names.contains(name)) {
        return Err(format!("the data set has no channel {name:?}, but {}", names.join(", ")));
    }
    let (from_hz, to_hz) = (recording.sampling_rate_hz, keep.sampling_rate_hz);
    if from_hz < to_hz * (1.0 - ROUNDING_REV) {
        return Err(format!(
            "it is sampled at {from_hz} Hz, below the {to_hz} Hz of the data set: make a data set with \
             keep.sampling_rate_hz = {from_hz:?}"
        ));
    }
    let filter = AntiAliasing::steep(from_hz, to_hz).map_err(|error| error.to_string())?;
    let step = from_hz / to_hz;
    let channels = names.iter().map(|name| {
        let Some((_, samples)) = recording.channels.iter().find(|(known, _)| known == name) else {
            return Vec::new();
        };
        let count = (samples.len().saturating_sub(1) as f64 / step).floor() as usize + 1;
        filter.read(&[samples], (0..count).map(|i| i as f64 * step), Edge::Reflect).swap_remove(0)
    });
    let channels: Vec<Vec<f32>> = channels.collect();
    let analysed = simulated.iter().position(|channel| *channel == keep.analysed);
    match analysed.filter(|_| keep.is_analysed()) {
        Some(number) if channels[number].is_empty() => {
            Err(format!("it has no channel {:?}, which the data set analyses", names[number]))
        }
        analysed => Ok((channels, analysed)),
    }
}
