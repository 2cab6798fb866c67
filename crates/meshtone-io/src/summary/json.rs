//! The summary's JSON.

use std::io::{self, Write};
use std::time::Duration;

use meshtone::damage::{FaultyTeeth, QuantityValue};
use meshtone::sensor::ChannelKind;
use meshtone::signal::{IndicatorValue, Indicators, Shaft};
use serde_json::{Map, Value, json};

use super::{ChannelSummary, FaultSummary, MeshForce, PittedTooth, Summary};

/// A fault's kind, place and severity, and the pits of each of its teeth, as a scenario file may list them.
fn fault(summary: &FaultSummary) -> Value {
    let FaultSummary { kind, wheel, severity, .. } = summary;
    let mut entry =
        json!({ "kind": kind, "wheel": wheel, "tooth": tooth(&summary.tooth), "severity": severity });
    if !summary.pitted_teeth.is_empty() {
        entry["pitted_teeth"] = summary.pitted_teeth.iter().map(pitted_tooth).collect();
    }
    entry
}

fn pitted_tooth((tooth, quantities): &PittedTooth) -> Value {
    let mut entry = json!({ "tooth": tooth });
    for (name, value) in quantities {
        entry[name] = match value {
            QuantityValue::Number(value) => json!(value),
            QuantityValue::Word(word) => json!(word),
            several => json!(several.numbers()),
        };
    }
    entry
}

/// A number, an array of them, or `"all"`, as in the scenario file.
fn tooth(teeth: &FaultyTeeth) -> Value {
    match teeth {
        FaultyTeeth::One(tooth) => json!(tooth),
        FaultyTeeth::These(teeth) => json!(teeth),
        FaultyTeeth::All => json!("all"),
    }
}

impl Summary {
    /// Writes the summary as indented JSON.
    ///
    /// # Arguments
    /// * `to` - where it is written to
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_json(&self, mut to: impl Write) -> io::Result<()> {
        writeln!(to, "{:#}", self.to_json())
    }

    fn to_json(&self) -> Value {
        let channels = self.channels.iter().map(|channel| (channel.name.clone(), indicators(channel)));
        let (stiffness, force) = (&self.mesh_stiffness, &self.mesh_force);
        let warnings = self.warnings.iter();
        let warnings = warnings.map(
            |warning| json!({ "code": warning.kind.code(), "key": warning.key, "message": warning.message }),
        );
        let faults = self.faults.iter().map(fault);
        let mut summary = json!({
            "format_version": self.format_version,
            "meshtone_version": self.meshtone_version,
            "run": self.run.to_string(),
            "model": self.model,
            "seed": self.seed,
            "faults": faults.collect::<Vec<_>>(),
            "sampling_rate_hz": self.sampling_rate_hz,
            "samples": self.samples,
            "start_s": self.start_s,
            "samples_per_pinion_revolution": self.samples_per_pinion_revolution,
            "contact_ratio": self.contact_ratio,
            "face_load_factor": self.face_load_factor,
            "natural_frequencies_hz": self.natural_frequencies_hz,
            "mesh_stiffness": {
                "min_n_per_mm": stiffness.min_n_per_mm,
                "mean_n_per_mm": stiffness.mean_n_per_mm,
                "max_n_per_mm": stiffness.max_n_per_mm,
            },
            "mesh_force": mesh_force(force),
            "channels": channels.collect::<Map<_, _>>(),
            "indicators": self.indicators_json(),
            "computing_time_ms": self.times(),
            "warnings": warnings.collect::<Vec<_>>(),
        });
        // Of a simulation without listed sensors they are the vertical acceleration's, as ever.
        if self.averaged != ChannelKind::Vertical.name() {
            summary["indicators_of"] = json!(self.averaged);
        }
        summary
    }

    /// Of average and difference, and of the gear, by the shaft's wheel.
    fn indicators_json(&self) -> Map<String, Value> {
        let wheel = |(shaft, indicators): (Shaft, &Option<Indicators>)| {
            (shaft.wheel().to_string(), indicators.as_ref().map_or(Value::Null, averaged))
        };
        Shaft::BOTH.into_iter().zip(&self.indicators).map(wheel).collect()
    }

    fn times(&self) -> Map<String, Value> {
        let stages = self.computing_time.iter().map(|(stage, time)| (stage.replace(' ', "_"), *time));
        let total = ("total".to_string(), self.total_time());
        stages.chain([total]).map(|(stage, time)| (stage, json!(milliseconds(time)))).collect()
    }
}

/// Every indicator of a wheel but those of the parts between average and difference.
fn averaged(indicators: &Indicators) -> Value {
    let left_out = ["regular_", "residual_", "envelope_"];
    let entries = indicators.table("g").into_iter();
    let entries = entries.filter(|entry| !left_out.iter().any(|part| entry.name.starts_with(part)));
    let named = |entry: IndicatorValue| match entry.unit.as_str() {
        "-" => (entry.name, json!(entry.value)),
        unit => (format!("{}_{unit}", entry.name), json!(entry.value)),
    };
    Value::Object(entries.map(named).collect())
}

/// With what the model says of it: for how long the mesh pulls, or how its teeth touch.
fn mesh_force(force: &MeshForce) -> Value {
    let mut entries = Map::new();
    let mut insert = |name: &str, value: Value| entries.insert(name.to_string(), value);
    insert("min_n", json!(force.min_n));
    insert("mean_n", json!(force.mean_n));
    insert("max_n", json!(force.max_n));
    if let Some(fraction) = force.tension_fraction {
        insert("tension_fraction", json!(fraction));
    }
    if let Some(contact) = &force.contact {
        insert("apart_fraction", json!(contact.apart_fraction));
        insert("back_flank_fraction", json!(contact.back_flank_fraction));
        insert("back_flank_hits", json!(contact.back_flank_hits));
        insert("largest_n", json!(contact.largest_force_n));
    }
    Value::Object(entries)
}

fn indicators(channel: &ChannelSummary) -> Value {
    let unit = channel.unit.to_lowercase();
    let entries = [
        (format!("rms_{unit}"), json!(channel.rms)),
        (format!("peak_{unit}"), json!(channel.peak)),
        ("kurtosis".to_string(), json!(channel.kurtosis)),
    ];
    Value::Object(entries.into_iter().collect())
}

/// (ms) To the microsecond.
fn milliseconds(time: Duration) -> f64 {
    time.as_micros() as f64 / 1e3
}
