//! The results as JSON.

use std::io::{self, Write};

use meshtone::signal::Indicators;
use serde_json::{Map, Value, json};

use super::{FORMAT_VERSION, IndicatorResults, RecordEntry, RecordingEntry, Setting};

impl IndicatorResults {
    /// Writes the results as indented JSON.
    ///
    /// # Arguments
    /// * `to` - where they are written to
    ///
    /// # Errors
    /// Those of `to`.
    ///
    /// ```
    /// use meshtone_io::indicators::IndicatorResults;
    ///
    /// let results = IndicatorResults { channel: "bearing".to_string(), ..IndicatorResults::default() };
    /// let mut text = Vec::new();
    /// results.write_json(&mut text)?;
    /// assert!(String::from_utf8_lossy(&text).contains("\"channel\": \"bearing\""));
    /// # Ok::<(), std::io::Error>(())
    /// ```
    pub fn write_json(&self, mut to: impl Write) -> io::Result<()> {
        writeln!(to, "{:#}", self.to_json())
    }

    fn to_json(&self) -> Value {
        let warnings = self.warnings.iter().map(|warning| {
            let recording = warning.source.as_ref().map(|source| source.display().to_string());
            json!({ "recording": recording, "message": warning.message })
        });
        json!({
            "format_version": FORMAT_VERSION,
            "meshtone_version": env!("CARGO_PKG_VERSION"),
            "settings": self.settings_json(),
            "channel": self.channel,
            "unit": self.unit,
            "recordings": self.recordings.iter().map(recording).collect::<Vec<_>>(),
            "records": self.records.iter().map(record).collect::<Vec<_>>(),
            "warnings": warnings.collect::<Vec<_>>(),
        })
    }

    pub(super) fn settings_json(&self) -> Value {
        let value = |setting: &Setting| match setting {
            Setting::Text(text) => json!(text),
            Setting::Number(number) => json!(number),
            Setting::Count(count) => json!(count),
            Setting::Absent => Value::Null,
        };
        let entries = self.settings.iter().map(|(name, setting)| ((*name).to_string(), value(setting)));
        Value::Object(entries.collect::<Map<_, _>>())
    }
}

fn recording(entry: &RecordingEntry) -> Value {
    json!({
        "file": entry.source.display().to_string(),
        "sampling_rate_hz": entry.sampling_rate_hz,
        "samples": entry.samples,
        "start_s": entry.start_s,
    })
}

fn record(entry: &RecordEntry) -> Value {
    json!({
        "recording": entry.recording,
        "segment": entry.segment,
        "wheel": entry.wheel,
        "teeth": entry.teeth,
        "revolutions": entry.revolutions,
        "mean_speed_hz": entry.mean_speed_hz,
        "points_per_revolution": entry.points_per_revolution,
        "nyquist_order": entry.nyquist_order,
        "indicators": indicators(&entry.indicators),
    })
}

/// Every indicator by its name; what is not defined is null.
pub(crate) fn indicators(indicators: &Indicators) -> Value {
    let entries = indicators.table("").into_iter().map(|entry| (entry.name, json!(entry.value)));
    Value::Object(entries.collect::<Map<_, _>>())
}
