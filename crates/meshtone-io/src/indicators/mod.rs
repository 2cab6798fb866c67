//! Indicators of recordings, as JSON and Apache Parquet.
//!
//! One record is what one recording, or one segment of it, shows about one wheel. The JSON holds everything: settings,
//! recordings, records, warnings. The Parquet file is a table with one row for each record, for programs that compare
//! many; what belongs to the whole file stands in its key-value metadata.

mod bearings;
mod json;
mod parquet_file;

use std::path::{Path, PathBuf};

pub use bearings::BearingEntry;
use meshtone::signal::{ForeignTone, Indicators, SignalWarning};
pub use parquet_file::ResultTable;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

/// Version of the JSON's format: it grows when a key changes its name or meaning.
pub const FORMAT_VERSION: u32 = 1;
/// Metadata key of the settings, as JSON, in the Parquet file.
pub const SETTINGS_KEY: &str = "meshtone.settings";

/// The indicators of one or several recordings.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct IndicatorResults {
    /// How the recordings were processed, in the order in which it is written; what was not given is null. The unit of a number
    /// stands in the setting's name.
    pub settings: Map<String, Value>,
    /// The channel that was processed.
    pub channel: String,
    /// Its unit, where it is known: the unit of every rms and peak to peak.
    pub unit: Option<String>,
    /// The recordings, in the order of the series.
    pub recordings: Vec<RecordingEntry>,
    /// The records, in the order of the series.
    pub records: Vec<RecordEntry>,
    /// What each recording shows about each bearing.
    pub bearings: Vec<BearingEntry>,
    /// The limits of the trend, where the first records are stated to be sound.
    pub limits: Vec<LimitEntry>,
    /// What is doubtful.
    pub warnings: Vec<WarningEntry>,
}

/// The limit of an indicator of a wheel: mean and three standard deviations over the first records.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LimitEntry {
    /// Name of the wheel.
    pub wheel: String,
    /// The indicator, as the figure of the trend names it.
    pub indicator: String,
    /// (unit of the indicator) The limit.
    pub limit: f64,
    /// Recording, from 1, and segment of the first record above it.
    pub crossed_at: Option<(usize, Option<usize>)>,
}

/// One recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordingEntry {
    /// The file that was read.
    #[serde(rename = "file", serialize_with = "as_shown")]
    pub source: PathBuf,
    /// (S/s) Its sampling rate.
    pub sampling_rate_hz: f64,
    /// Its samples.
    pub samples: usize,
    /// (s) Time of its first sample.
    pub start_s: f64,
    /// (mm/s) Rms of the channel's velocity from 10 to 1000 Hz; none where it is no acceleration, or shorter than 1 s, or sampled too slowly.
    pub velocity_rms_mm_per_s: Option<f64>,
    /// The zone of ISO 20816-3, A to D, in which that velocity lies, where class and mounting of the machine were stated.
    pub velocity_zone: Option<char>,
    /// Its tones that belong to no shaft and no mesh; none where they were not looked for.
    pub foreign_lines: Option<Vec<ForeignTone>>,
    /// (-) Part of the orders at which a tone would belong to the shafts and meshes, since the recording does not distinguish it from theirs; none
    /// where foreign lines were not looked for.
    pub own_orders_part: Option<f64>,
    /// (s) Length that a recording needs for weak foreign lines to be distinguished from hunting-tooth orders; none where this one has it, or
    /// where they were not looked for.
    pub foreign_lines_need_s: Option<f64>,
}

/// What one recording, or one segment of it, shows about one wheel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordEntry {
    /// Number of the recording, from 1.
    pub recording: usize,
    /// Number of the segment in it, from 1; none where the recording is one record.
    pub segment: Option<usize>,
    /// Name of the wheel.
    pub wheel: String,
    /// Name of its shaft, in a gearbox.
    pub shaft: Option<String>,
    /// Its teeth.
    pub teeth: u32,
    /// Revolutions that were averaged.
    pub revolutions: usize,
    /// (Hz) Mean speed of its shaft over the recording.
    pub mean_speed_hz: f64,
    /// Order of the carrier against the ring at which a damaged tooth of the wheel shows; none outside of planetary sets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tooth_order_of_carrier_against_ring: Option<f64>,
    /// Values of the average.
    pub points_per_revolution: usize,
    /// (orders) Beyond this order of the shaft the recording holds nothing.
    pub nyquist_order: f64,
    /// The indicators.
    #[serde(serialize_with = "json::indicators")]
    pub indicators: Indicators,
}

/// Something doubtful.
#[derive(Debug, Clone, PartialEq)]
pub struct WarningEntry {
    /// The recording that it is about; none where it is about all.
    pub source: Option<PathBuf>,
    /// What it is.
    pub message: String,
    /// Its kind and its numbers, where it is about the signal.
    pub kind: Option<SignalWarning>,
}

impl IndicatorResults {
    /// The file of a recording, as messages show it.
    fn file(&self, recording: usize) -> String {
        let entry = recording.checked_sub(1).and_then(|index| self.recordings.get(index));
        entry.map_or_else(String::new, |entry| entry.source.display().to_string())
    }
}

/// A path as messages show it.
fn as_shown<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}
