//! One recording's records.

use std::borrow::Cow;

use meshtone::scenario::{Scenario, WheelName};
use meshtone::signal::{
    AngularSettings, ChainSettings, Record, SeparationSettings, SignalError, SignalWarning, angular_resample,
    check_channel, check_recording, process_angular, process_angular_segments,
};
use meshtone_io::indicators::WarningEntry;
use meshtone_plot::DamagedTooth;

use super::options::{PhaseOptions, ProcessingOptions};
use super::phase::{ShaftAngle, simulated};
use super::reading::Input;
use super::refuse::{RefusedInput, refuse};
use crate::failure::Failure;
use crate::warnings::about_signal;

/// A wheel whose average is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Its name.
    pub name: &'static str,
    /// Its teeth.
    pub teeth: u32,
    /// Whether it is on the shaft that speed or pulses are of.
    pub is_on_shaft: bool,
    /// The damaged teeth, where it is known which they are.
    pub damaged_teeth: Vec<DamagedTooth>,
}

/// Results of one recording for one wheel.
pub struct WheelRecords {
    /// The wheel.
    pub wheel: Wheel,
    /// (Hz) Mean speed of its shaft.
    pub mean_speed_hz: f64,
    /// One record, or one of each segment.
    pub records: Vec<Record>,
    /// (s) Middle of each, since the first sample.
    pub middles_s: Vec<f64>,
}

/// Results of one recording.
pub struct Processed {
    /// Of one wheel, or of both of a pair.
    pub wheels: Vec<WheelRecords>,
    /// The angles of the shafts.
    pub turning: ShaftAngle,
    /// Warnings.
    pub warnings: Vec<WarningEntry>,
}

/// Processes a recording.
pub fn process(
    input: &Input,
    phase: &PhaseOptions,
    processing: &ProcessingOptions,
) -> Result<Processed, Failure> {
    let of_channel = format!("channel {}", input.channel.name);
    let (turning, wheels, mut warnings) = turning(input, phase)?;
    let (subject, mut doubtful) = match &turning {
        ShaftAngle::Measured(shaft) => {
            let speed_hz = shaft.mean_speed_hz(input.sampling_rate_hz);
            (RefusedInput::Measured { speed_hz, by: phase.source() }, shaft.warnings.clone())
        }
        ShaftAngle::Simulated(_) => {
            (RefusedInput::Simulated { in_segments: processing.revolutions.is_some() }, Vec::new())
        }
    };
    check_channel(&input.channel.samples)
        .map_err(|error| refuse(&input.source, &of_channel, subject, &error))?;
    let mut processed: Vec<WheelRecords> = Vec::new();
    for (shaft, wheel) in WheelName::BOTH.into_iter().zip(&wheels) {
        let of_wheel = format!("{of_channel}, {} of {} teeth", wheel.name, wheel.teeth);
        let what = if wheels.len() > 1 { &of_wheel } else { &of_channel };
        let (of_wheel, doubts) = wheel_records(input, &turning, shaft, &wheels, phase, processing)
            .map_err(|error| refuse(&input.source, what, subject, &error))?;
        doubtful.extend(doubts);
        for warning in of_wheel.records.iter().flat_map(|record| &record.warnings) {
            if !doubtful.contains(warning) {
                doubtful.push(warning.clone());
            }
        }
        processed.push(of_wheel);
    }
    warnings.extend(doubtful.iter().map(|warning| about_signal(&input.source, warning)));
    Ok(Processed { wheels: processed, turning, warnings })
}

/// The records of the wheel on a shaft, the first of `wheels` on the pinion's, and what does not fit.
///
/// A measured recording is resampled over the angle of the wheel's own shaft, and only the wheel whose shaft the phase is of is checked
/// against the stated facts, since the other one's angle follows from the tooth counts. A simulation knows the angles of both shafts.
fn wheel_records(
    input: &Input,
    turning: &ShaftAngle,
    shaft: WheelName,
    wheels: &[Wheel],
    options: &PhaseOptions,
    processing: &ProcessingOptions,
) -> Result<(WheelRecords, Vec<SignalWarning>), SignalError> {
    let wheel = &wheels[shaft as usize];
    let settings = settings(processing, wheel.teeth);
    let mut doubts = Vec::new();
    let rate_hz = input.sampling_rate_hz;
    let (mean_speed_hz, records, middles_s) = match turning {
        ShaftAngle::Measured(phase) => {
            let phase = match shaft {
                WheelName::Pinion => Cow::Borrowed(phase),
                WheelName::Gear => Cow::Owned(phase.of_mate(wheels[0].teeth, wheel.teeth)?),
            };
            let angular = angular_resample(&input.channel.samples, &phase, &settings.angular)?;
            if wheel.is_on_shaft {
                doubts = check_recording(&angular, &options.stated_facts(wheel.teeth), &phase, rate_hz);
            }
            let records = match processing.revolutions {
                None => vec![process_angular(&angular, wheel.teeth, &settings)?],
                Some(count) => process_angular_segments(&angular, wheel.teeth, &settings, count as usize)?,
            };
            let time_s = |angle_rev: f64| phase.sample_at(angle_rev) / rate_hz;
            let middles_s = middles(&records, angular.start_rev).map(time_s).collect();
            (phase.mean_speed_hz(rate_hz), records, middles_s)
        }
        ShaftAngle::Simulated(shafts) => {
            let signal = &input.channel.samples;
            let records = match processing.revolutions {
                None => vec![shafts.process(signal, shaft, &settings)?],
                Some(count) => shafts.process_segments(signal, shaft, &settings, count as usize)?,
            };
            let mean_speed_hz = shafts.mean_speed_hz(shaft);
            // Of both wheels alike, also where the speed varies.
            let middles_s = middles(&records, 0.0).map(|angle_rev| angle_rev / mean_speed_hz).collect();
            (mean_speed_hz, records, middles_s)
        }
    };
    Ok((WheelRecords { wheel: wheel.clone(), mean_speed_hz, records, middles_s }, doubts))
}

/// Angles of the shafts, the wheels on them, and what is doubtful about the files that say so.
fn turning(
    input: &Input,
    phase: &PhaseOptions,
) -> Result<(ShaftAngle, Vec<Wheel>, Vec<WarningEntry>), Failure> {
    match &input.scenario_toml {
        Some(toml) if phase.is_empty() => {
            let (scenario, shafts) = simulated(input, toml)?;
            let wheels = WheelName::BOTH.map(|shaft| Wheel {
                name: shaft.name(),
                teeth: shafts.teeth(shaft),
                is_on_shaft: shaft == WheelName::Pinion,
                damaged_teeth: damaged_teeth(&scenario, shaft),
            });
            Ok((ShaftAngle::Simulated(shafts), wheels.to_vec(), input.warnings.clone()))
        }
        _ => {
            phase.check(input)?;
            let wheels = [("wheel", true, phase.teeth), ("mate", false, phase.mate_teeth)].into_iter();
            let wheels = wheels.filter_map(|(name, is_on_shaft, teeth)| {
                Some(Wheel { name, teeth: teeth?, is_on_shaft, damaged_teeth: Vec::new() })
            });
            let (shaft, of_phase) = phase.measured(input)?;
            Ok((ShaftAngle::Measured(shaft), wheels.collect(), [input.warnings.clone(), of_phase].concat()))
        }
    }
}

/// The teeth on a shaft that the scenario damages.
fn damaged_teeth(scenario: &Scenario, wheel: WheelName) -> Vec<DamagedTooth> {
    let contact_pitches = scenario.gears.contact_ratio();
    DamagedTooth::of_wheel(&scenario.faults, wheel, scenario.gears.teeth(wheel), contact_pitches)
}

/// (rev) Angles of the middles of records that follow one another.
fn middles(records: &[Record], start_rev: f64) -> impl Iterator<Item = f64> {
    let counts = records.iter().map(|record| record.average.revolutions as f64);
    counts.scan(start_rev, |from, count| {
        let middle = *from + 0.5 * count;
        *from += count;
        Some(middle)
    })
}

fn settings(processing: &ProcessingOptions, teeth: u32) -> ChainSettings {
    let separation = SeparationSettings {
        sidebands: processing.sidebands as usize,
        shaft_orders: (1..=processing.low_orders as usize).collect(),
        ..SeparationSettings::new(teeth as usize)
    };
    let angular = AngularSettings { interpolation: processing.interpolation, ..AngularSettings::default() };
    ChainSettings { angular, separation: Some(separation) }
}
