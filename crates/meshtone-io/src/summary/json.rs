//! The summary's JSON, as far as it is not that of the fields.

use std::io::{self, Write};
use std::time::Duration;

use meshtone::damage::{FaultyTeeth, QuantityValue};
use meshtone::sensor::ChannelKind;
use meshtone::signal::{IndicatorValue, Indicators};
use meshtone::wheel::WheelName;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use super::{ChannelSummary, PittedTooth};
use crate::run_identity::RunIdentity;

/// Writes a summary as indented JSON.
///
/// # Arguments
/// * `summary` - of a pair or of a gearbox
/// * `to` - where it is written to
///
/// # Errors
/// Those of `to`.
pub fn write_json(summary: &impl Serialize, mut to: impl Write) -> io::Result<()> {
    to.write_all(format!("{:#}\n", json!(summary)).as_bytes())
}

pub(super) fn run<S: Serializer>(run: &RunIdentity, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(run)
}

/// A number, an array of them, or `"all"`, as in the scenario file.
pub(super) fn tooth<S: Serializer>(teeth: &FaultyTeeth, serializer: S) -> Result<S::Ok, S::Error> {
    match teeth {
        FaultyTeeth::One(tooth) => tooth.serialize(serializer),
        FaultyTeeth::These(teeth) => teeth.serialize(serializer),
        FaultyTeeth::All => "all".serialize(serializer),
    }
}

/// The pits of each tooth, as a scenario file may list them.
pub(super) fn pitted_teeth<S: Serializer>(teeth: &[PittedTooth], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(teeth.iter().map(|(tooth, quantities)| {
        let mut entry = json!({ "tooth": tooth });
        for (name, value) in quantities {
            entry[name] = match value {
                QuantityValue::Number(value) => json!(value),
                QuantityValue::Word(word) => json!(word),
                several => json!(several.numbers()),
            };
        }
        entry
    }))
}

pub(super) fn channels<S: Serializer>(channels: &[ChannelSummary], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(channels.iter().map(|channel| {
        let unit = channel.unit.to_lowercase();
        let entries = [
            (format!("rms_{unit}"), json!(channel.rms)),
            (format!("peak_{unit}"), json!(channel.peak)),
            ("kurtosis".to_string(), json!(channel.kurtosis)),
        ];
        (&channel.name, Map::from_iter(entries))
    }))
}

/// Of average and difference, and of the gear, by the shaft's wheel.
pub(super) fn indicators<S: Serializer>(
    of_shafts: &[Option<Indicators>; 2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let wheels = WheelName::BOTH.map(WheelName::name).into_iter();
    serializer.collect_map(wheels.zip(of_shafts.each_ref().map(|of_shaft| of_shaft.as_ref().map(averaged))))
}

/// Every indicator of a wheel but those of the parts between average and difference.
fn averaged(indicators: &Indicators) -> Map<String, Value> {
    let left_out = ["regular_", "residual_", "envelope_"];
    let entries = indicators.table("g").into_iter();
    let entries = entries.filter(|entry| !left_out.iter().any(|part| entry.name.starts_with(part)));
    let named = |entry: IndicatorValue| match entry.unit.as_str() {
        "-" => (entry.name, json!(entry.value)),
        unit => (format!("{}_{unit}", entry.name), json!(entry.value)),
    };
    entries.map(named).collect()
}

/// (ms) Each stage's time, and the total, to the microsecond.
pub(super) fn times<S: Serializer>(stages: &[(String, Duration)], serializer: S) -> Result<S::Ok, S::Error> {
    let total = ("total".to_string(), stages.iter().map(|(_, elapsed)| *elapsed).sum());
    let stages = stages.iter().map(|(stage, time)| (stage.replace(' ', "_"), *time)).chain([total]);
    serializer.collect_map(stages.map(|(stage, time)| (stage, time.as_micros() as f64 / 1e3)))
}

pub(super) fn is_vertical(channel: &str) -> bool {
    channel == ChannelKind::Vertical.name()
}
