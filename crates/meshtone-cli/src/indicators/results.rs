//! The records of a whole series, as they come.

use std::path::{Path, PathBuf};

use meshtone::sensor::GRAVITY_M_PER_S2;
use meshtone::signal::{BearingRecords, Record, na4, velocity_rms};
use meshtone_io::indicators::{IndicatorResults, RecordEntry, RecordingEntry};
use serde_json::{Map, Value, json};

use super::bearings::{BearingOptions, FoundBearings};
use super::limits::ISO_20816;
use super::options::{EDGES, INTERPOLATIONS, PhaseOptions, ProcessingOptions, ShaftOptions};
use super::process::{Processed, Wheel};
use super::reading::Input;
use super::train::Turned;
use crate::choice::name_of;
use crate::failure::Failure;

/// The last record of each wheel, which the figure shows.
pub struct LatestRecords {
    /// The recording.
    pub input: Input,
    /// Each wheel with the mean speed of its shaft and its record.
    pub wheels: Vec<(Wheel, f64, Record)>,
    /// The machine, and how it turned in the recording.
    pub turned: Turned,
    /// What the recording shows about bearings, where any are looked for.
    pub bearings: Option<BearingRecords>,
}

/// All records so far. Of each but the last only its indicators and its residual are kept.
#[derive(Default)]
pub struct Series {
    /// The results.
    pub results: IndicatorResults,
    /// The last record.
    pub latest: Option<LatestRecords>,
    /// The wheels, which are the same in all recordings.
    pub wheels: Vec<Wheel>,
    /// For each wheel the middles of its records as parts of their recordings, counted on from recording to recording: 1.25 is
    /// a quarter into the second.
    pub middles: Vec<Vec<f64>>,
    /// Residuals of each wheel's records.
    residuals: Vec<Vec<Vec<f64>>>,
}

impl Series {
    /// Adds the next recording.
    pub fn add(
        &mut self,
        input: Input,
        processed: Processed,
        processing: &ProcessingOptions,
    ) -> Result<(), Failure> {
        self.check(&input, &processed)?;
        let in_segments = processing.revolutions.is_some();
        let velocity = velocity_rms_mm_per_s(&input);
        let Processed { turned, records, bearings, warnings } = processed;
        self.results.recordings.push(RecordingEntry {
            source: input.source.clone(),
            sampling_rate_hz: input.sampling_rate_hz,
            samples: input.channel.samples.len(),
            start_s: input.start_s,
            velocity_rms_mm_per_s: velocity,
            velocity_zone: processing
                .iso_20816
                .zip(velocity)
                .map(|(machine, velocity)| machine.zone(velocity)),
            own_orders_part: records.foreign.as_ref().map(|found| found.own_part),
            foreign_lines_need_s: records.foreign.as_ref().and_then(|found| found.needed_s),
            foreign_lines: records.foreign.map(|found| found.tones),
        });
        self.results.warnings.extend(warnings);
        let mut last = Vec::new();
        for of_wheel in records.wheels {
            let place = of_wheel.wheel;
            let wheel = &turned.wheels[place];
            let length_s = input.channel.samples.len() as f64 / input.sampling_rate_hz;
            let before = (self.results.recordings.len() - 1) as f64;
            self.middles[place]
                .extend(of_wheel.middles_s.iter().map(|middle_s| before + middle_s / length_s));
            let mut latest = None;
            for (number, mut record) in of_wheel.records.into_iter().enumerate() {
                self.results.records.push(RecordEntry {
                    recording: self.results.recordings.len(),
                    segment: in_segments.then_some(number + 1),
                    wheel: wheel.name.clone(),
                    shaft: wheel.shaft.clone(),
                    teeth: wheel.teeth,
                    revolutions: record.average.revolutions,
                    mean_speed_hz: of_wheel.mean_speed_hz,
                    tooth_order_of_carrier_against_ring: wheel.tooth_order_of_carrier_against_ring,
                    points_per_revolution: record.average.values.len(),
                    nyquist_order: record.average.nyquist_order,
                    indicators: record.indicators,
                });
                self.residuals[place].push(std::mem::take(&mut record.parts.residual));
                latest = Some(record);
            }
            last.extend(latest.map(|record| (wheel.clone(), of_wheel.mean_speed_hz, record)));
        }
        let recording = self.results.recordings.len();
        let bearings = bearings.map(|FoundBearings { records, mut entries }| {
            entries.iter_mut().for_each(|entry| entry.recording = recording);
            self.results.bearings.extend(entries);
            records
        });
        self.latest = Some(LatestRecords { input, wheels: last, turned, bearings });
        Ok(())
    }

    /// Refuses a recording that differs from others of its series where it must not.
    fn check(&mut self, input: &Input, processed: &Processed) -> Result<(), Failure> {
        let wheels = &processed.turned.wheels;
        let Some(first) = self.results.recordings.first() else {
            self.residuals = vec![Vec::new(); wheels.len()];
            self.middles = vec![Vec::new(); wheels.len()];
            self.wheels.clone_from(wheels);
            self.results.channel.clone_from(&input.channel.name);
            self.results.unit.clone_from(&input.channel.unit);
            return Ok(());
        };
        let refuse = |of: &str, here: String, there: String| {
            let (path, first) = (input.source.display(), first.source.display());
            let problem = format!("{path}: {of} {here}, but {first} {there}; must be the same in a series");
            Failure::refuse(problem, "process them one by one, each with its own -o")
        };
        let teeth = |wheels: &[Wheel]| -> Vec<String> {
            wheels.iter().map(|wheel| wheel.teeth.to_string()).collect()
        };
        if teeth(wheels) != teeth(&self.wheels) {
            let words = |wheels: &[Wheel]| format!("has {} teeth", teeth(wheels).join(" and "));
            return refuse("is of a machine that", words(wheels), words(&self.wheels));
        }
        if input.channel.unit != self.results.unit {
            let words = |unit: &Option<String>| unit.clone().unwrap_or_else(|| "no stated unit".to_string());
            let (here, there) = (words(&input.channel.unit), words(&self.results.unit));
            return refuse("is in", here, format!("in {there}"));
        }
        Ok(())
    }

    /// Gives every record the NA4 that it has in the series.
    pub fn finish(&mut self) -> Result<(), Failure> {
        let with_records =
            self.wheels.iter().zip(&self.residuals).filter(|(_, residuals)| !residuals.is_empty());
        for (wheel, residuals) in with_records {
            let values = na4(residuals).map_err(|error| Failure::failed(format!("NA4: {error}")))?;
            let records = self.results.records.iter_mut().filter(|record| record.wheel == wheel.name);
            for (record, value) in records.zip(values) {
                // A residual that is rounding has none, alone as in the series.
                record.indicators.na4 = record.indicators.na4.and(value);
            }
            let last = self.results.records.iter().rfind(|record| record.wheel == wheel.name);
            let shown = self.latest.iter_mut().flat_map(|latest| &mut latest.wheels);
            for (_, _, record) in shown.filter(|(shown, ..)| shown.name == wheel.name) {
                record.indicators.na4 = last.and_then(|last| last.indicators.na4);
            }
        }
        Ok(())
    }

    /// The records of a wheel, in the order of the series.
    pub fn of<'s>(&'s self, wheel: &'s Wheel) -> impl Iterator<Item = &'s RecordEntry> + 's {
        self.results.records.iter().filter(|record| record.wheel == wheel.name)
    }

    /// Returns whether there are several records, so that there is a trend.
    pub fn is_series(&self) -> bool {
        let is_later = |record: &RecordEntry| record.recording > 1 || record.segment > Some(1);
        self.results.records.iter().any(is_later)
    }
}

/// (mm/s) Rms of the velocity from 10 to 1000 Hz of a channel that is an acceleration.
fn velocity_rms_mm_per_s(input: &Input) -> Option<f64> {
    let mut channel = input.channel.clone();
    let rms = |samples: &[f64]| velocity_rms(samples, input.sampling_rate_hz).ok();
    channel.convert_to_g().then(|| rms(&channel.samples)).flatten().map(|rms| rms * GRAVITY_M_PER_S2)
}

/// Settings of the command line, with its defaults.
///
/// # Arguments
/// * `latest` - of the last recording: the source of its phase, and its machine
/// * the others - the options
pub fn settings(
    phase: &PhaseOptions,
    shafts: &ShaftOptions,
    scenario: Option<&Path>,
    latest: Option<&LatestRecords>,
    processing: &ProcessingOptions,
    bearings: &BearingOptions,
) -> Map<String, Value> {
    let file = |path: &Option<PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let has_pulses = phase.tach.is_some() || phase.pulse_times.is_some();
    let edge = phase.tach.as_ref().and_then(|_| name_of(&EDGES, phase.edge));
    let turned = latest.map(|latest| &latest.turned);
    let looked_for = turned.map_or_else(Vec::new, |turned| bearings.names(&turned.train));
    let separation = bearings.separation().filter(|_| !looked_for.is_empty());
    let settings = [
        ("phase", json!(turned.map_or("", |turned| &turned.source))),
        ("scenario", json!(scenario.map(|path| path.display().to_string()))),
        ("shaft", json!(shafts.shaft)),
        ("mesh", json!(shafts.mesh)),
        ("teeth", json!(phase.teeth)),
        ("mate_teeth", json!(phase.mate_teeth)),
        ("shaft_hz", json!(phase.shaft_hz)),
        ("tach", json!(phase.tach)),
        ("pulse_times", json!(file(&phase.pulse_times))),
        ("speed_channel", json!(phase.speed_channel)),
        ("speed_profile", json!(file(&phase.speed_profile))),
        ("pulses_per_rev", json!(has_pulses.then_some(phase.pulses_per_rev))),
        ("threshold", json!(phase.threshold)),
        ("hysteresis", json!(phase.hysteresis)),
        ("edge", json!(edge)),
        ("sidebands", json!(processing.sidebands)),
        ("low_orders", json!(processing.low_orders)),
        ("revolutions_of_a_segment", json!(processing.revolutions)),
        ("sound_records", json!(processing.sound_records)),
        ("iso_20816", json!(processing.iso_20816.and_then(|machine| name_of(&ISO_20816, machine)))),
        ("interpolation", json!(name_of(&INTERPOLATIONS, processing.interpolation))),
        ("bearings", json!(looked_for)),
        ("band_hz", bearings.stated_band()),
        ("bearing_separation", json!(separation)),
    ];
    settings.into_iter().map(|(name, setting)| (name.to_owned(), setting)).collect()
}
