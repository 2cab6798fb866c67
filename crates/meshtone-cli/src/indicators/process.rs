//! One recording's records.

use meshtone::scenario::Scenario;
use meshtone::signal::{
    AngularSettings, SeparationSettings, TrainRecording, TrainRecords, TrainSettings, TrainTurning,
    check_channel,
};
use meshtone_io::indicators::WarningEntry;
use meshtone_plot::DamagedTooth;

use super::bearings::{BearingOptions, FoundBearings};
use super::options::{PhaseOptions, ProcessingOptions, ShaftOptions};
use super::reading::Input;
use super::refuse::{RefusedInput, refuse};
use super::train::Turned;
use crate::failure::Failure;
use crate::warnings::about_signal;

/// A wheel whose average is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Wheel {
    /// Its name.
    pub name: String,
    /// Its teeth.
    pub teeth: u32,
    /// Name of its shaft; none of a pair, whose wheels have a shaft each.
    pub shaft: Option<String>,
    /// Order of the carrier against the ring at which a damaged tooth of it shows; none outside of planetary sets.
    pub tooth_order_of_carrier_against_ring: Option<f64>,
    /// What belongs to the regular part of its average.
    pub separation: SeparationSettings,
    /// Meaning of its tooth 1.
    pub first_tooth: String,
    /// The damaged teeth, where it is known which they are.
    pub damaged_teeth: Vec<DamagedTooth>,
}

/// Results of one recording.
pub struct Processed {
    /// The machine, and how it turned.
    pub turned: Turned,
    /// What the recording shows.
    pub records: TrainRecords,
    /// What it shows about bearings, where any are looked for.
    pub bearings: Option<FoundBearings>,
    /// Warnings.
    pub warnings: Vec<WarningEntry>,
}

/// Processes a recording.
pub fn process(
    input: &Input,
    phase: &PhaseOptions,
    shafts: &ShaftOptions,
    scenario: Option<&Scenario>,
    processing: &ProcessingOptions,
    bearings: &BearingOptions,
) -> Result<Processed, Failure> {
    let of_channel = format!("channel {}", input.channel.name);
    let knows_wheels = phase.teeth.is_some() || scenario.is_some() || input.scenario_toml.is_some();
    let turned = if knows_wheels || bearings.bearings.is_empty() || !shafts.is_empty() {
        Turned::new(input, phase, shafts, scenario)?
    } else {
        Turned::without_wheels(input, phase)?
    };
    let Turned { train, turning, source, .. } = &turned;
    let subject = match turning {
        TrainTurning::Shaft { phase, .. } if source != PhaseOptions::SIMULATED => {
            RefusedInput::Measured { speed_hz: phase.mean_speed_hz(input.sampling_rate_hz), by: source }
        }
        _ => RefusedInput::Simulated { in_segments: processing.revolutions.is_some() },
    };
    let signal = &input.channel.samples;
    check_channel(signal).map_err(|error| refuse(&input.source, &of_channel, subject, &error))?;
    let recording = TrainRecording { signal, sampling_rate_hz: input.sampling_rate_hz, train, turning };
    let records = recording.process(&settings(processing)).map_err(|of| {
        let of_wheel = format!("{of_channel}, {} of {} teeth", of.wheel, of.teeth);
        let what = if train.wheels.len() > 1 { &of_wheel } else { &of_channel };
        refuse(&input.source, what, subject, &of.error)
    })?;
    let bearings = bearings.look_for(&recording, input.channel.unit.as_deref(), |error| {
        refuse(&input.source, &of_channel, subject, error)
    })?;
    let of_bearings = bearings.iter().flat_map(|found| &found.records.warnings);
    let doubtful =
        records.warnings.iter().chain(of_bearings).map(|warning| about_signal(&input.source, warning));
    let warnings = turned.warnings.iter().cloned().chain(doubtful).collect();
    Ok(Processed { turned, records, bearings, warnings })
}

/// The settings that the options state.
pub fn settings(processing: &ProcessingOptions) -> TrainSettings {
    let defaults = TrainSettings::default();
    TrainSettings {
        separation: SeparationSettings {
            sidebands: processing.sidebands as usize,
            shaft_orders: (1..=processing.low_orders as usize).collect(),
            ..defaults.separation
        },
        angular: AngularSettings { interpolation: processing.interpolation, ..defaults.angular },
        revolutions: processing.revolutions.map(|count| count as usize),
    }
}
