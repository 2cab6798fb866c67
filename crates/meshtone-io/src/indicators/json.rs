//! The results as JSON.

use meshtone::signal::{Indicators, SignalWarning};
use serde::Serializer;
use serde_json::{Map, Value, json};

use super::{FORMAT_VERSION, IndicatorResults};

impl IndicatorResults {
    /// The results as JSON.
    ///
    /// ```
    /// use meshtone_io::indicators::IndicatorResults;
    ///
    /// let results = IndicatorResults { channel: "bearing".to_string(), ..IndicatorResults::default() };
    /// assert_eq!(results.to_json()["channel"], "bearing");
    /// ```
    pub fn to_json(&self) -> Value {
        let warnings = self.warnings.iter().map(|warning| {
            let recording = warning.source.as_ref().map(|source| source.display().to_string());
            let values = warning.kind.iter().flat_map(SignalWarning::values);
            let values: Map<String, Value> = values.map(|(name, value)| (name, json!(value))).collect();
            json!({
                "recording": recording,
                "code": warning.kind.as_ref().map(SignalWarning::code),
                "message": warning.message,
                "values": values,
            })
        });
        json!({
            "format_version": FORMAT_VERSION,
            "meshtone_version": env!("CARGO_PKG_VERSION"),
            "settings": self.settings,
            "channel": self.channel,
            "unit": self.unit,
            "recordings": self.recordings,
            "records": self.records,
            "bearings": self.bearings,
            "limits": self.limits,
            "warnings": warnings.collect::<Vec<_>>(),
        })
    }
}

/// Every indicator by its name; what is not defined is null.
pub(super) fn indicators<S: Serializer>(indicators: &Indicators, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(indicators.table("").into_iter().map(|entry| (entry.name, entry.value)))
}
