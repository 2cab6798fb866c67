//! The lines of bearings' defects, as JSON and as a table in Parquet.

use meshtone::bearing::NamedBearing;
use meshtone::signal::{DefectKind, DefectLine, FrequencyBand, RaceTest, TrainBearing, UnexplainedComb};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value, json};

use super::IndicatorResults;
use super::parquet_file::{Column, ResultTable, column};
use crate::table::{CellType, Cells};

/// What one recording shows about one bearing.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingEntry {
    /// Number of the recording, from 1.
    pub recording: usize,
    /// The bearing as it was named, such as `6205` or `9,7.94,39.04`.
    pub name: String,
    /// Its geometry, and the number of its shaft.
    pub bearing: TrainBearing,
    /// Name of its shaft.
    pub shaft: String,
    /// (Hz) Mean speed of its shaft.
    pub mean_speed_hz: f64,
    /// The verdict in one or two words, and in a sentence.
    pub verdict: (&'static str, String),
    /// What is seen of each of its races, those with a defect first.
    pub races: Vec<RaceTest>,
    /// A comb of lines on its shaft that is of no stated race.
    pub unexplained: Option<UnexplainedComb>,
    /// The band of the squared envelope that is drawn.
    pub band: FrequencyBand,
    /// (-) Kurtosis in it, where the kurtogram chose it.
    pub band_kurtosis: Option<f64>,
    /// Unit of the lines' amplitudes, such as `g²`; none where it is not known, and of a prewhitened recording.
    pub amplitude_unit: Option<String>,
    /// The lines of its defects.
    pub lines: Vec<DefectLine>,
}

impl BearingEntry {
    /// The publication that states the geometry, of a bearing by name.
    pub fn source(&self) -> Option<&'static str> {
        NamedBearing::find(&self.name).map(|named| named.source)
    }
}

impl Serialize for BearingEntry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let geometry = self.bearing.geometry;
        let orders = geometry.defect_orders();
        let order = |kind: DefectKind| (kind.line().to_owned(), json!(kind.order(&orders)));
        let orders: Map<String, Value> = DefectKind::ALL.map(order).into_iter().collect();
        let line = |line: &DefectLine| {
            json!({
                "line": line.name(),
                "part": line.kind.name(),
                "order": line.order,
                "found_order": line.found_order,
                "amplitude": line.amplitude,
                "over_median": line.over_median,
                "is_beside_shaft_order": line.is_beside_shaft_order,
            })
        };
        let race = |of: &RaceTest| {
            json!({
                "race": of.race.name(),
                "order": of.order,
                "found_order": of.found_order,
                "slip": of.slip(),
                "band_hz": [of.band.from_hz, of.band.to_hz],
                "depth": of.depth,
                "is_detected": of.is_detected(),
                "false_alarm_probability": of.stated_probability(),
            })
        };
        let unexplained = |comb: &UnexplainedComb| {
            // Several bearings have races of one name.
            let ratio = |(race, bearing, ratio): &(DefectKind, usize, f64)| json!({ "race": race.name(), "bearing": bearing, "ratio": ratio });
            json!({
                "order": comb.order,
                "band_hz": [comb.band.from_hz, comb.band.to_hz],
                "ratios": comb.ratios.iter().map(ratio).collect::<Vec<_>>(),
                "in_words": comb.to_string(),
            })
        };
        let all = json!({
            "recording": self.recording,
            "bearing": self.name,
            "source": self.source(),
            "elements": geometry.elements,
            "element_mm": geometry.element_mm,
            "pitch_mm": geometry.pitch_mm,
            "contact_angle_deg": geometry.contact_angle_deg,
            "shaft": self.shaft,
            "mean_speed_hz": self.mean_speed_hz,
            "verdict": self.verdict.0,
            "in_words": self.verdict.1,
            "races": self.races.iter().map(race).collect::<Vec<_>>(),
            "unexplained": self.unexplained.as_ref().map(unexplained),
            "defect_orders": orders,
            "band_hz": [self.band.from_hz, self.band.to_hz],
            "band_kurtosis": self.band_kurtosis,
            "amplitude_unit": self.amplitude_unit,
            "lines": self.lines.iter().map(line).collect::<Vec<_>>(),
        });
        all.serialize(serializer)
    }
}

impl IndicatorResults {
    /// The lines of the bearings' defects, one row for each.
    pub fn bearing_table(&self) -> ResultTable {
        type Line<'a> = (&'a BearingEntry, &'a DefectLine);
        let lines: Vec<Line> =
            self.bearings.iter().flat_map(|of| of.lines.iter().map(move |line| (of, line))).collect();
        let text = |name: &str, value: &dyn Fn(&Line) -> String| -> Column {
            let cells = Cells::Text(lines.iter().map(|line| Some(value(line))).collect());
            column(name, "", false, (CellType::Text, cells))
        };
        let number = |name: &str, unit: &str, value: &dyn Fn(&Line) -> f64| -> Column {
            let cells = Cells::Float64(lines.iter().map(|line| Some(value(line))).collect());
            column(name, unit, false, (CellType::Float64, cells))
        };
        let recordings = Cells::Int64(lines.iter().map(|(of, _)| Some(of.recording as i64)).collect());
        let squared = self.bearings.first().and_then(|of| of.amplitude_unit.clone()).unwrap_or_default();
        let columns = [
            column("recording", "", false, (CellType::Int64, recordings)),
            text("file", &|(of, _)| self.file(of.recording)),
            text("bearing", &|(of, _)| of.name.clone()),
            text("shaft", &|(of, _)| of.shaft.clone()),
            number("mean_speed_hz", "Hz", &|(of, _)| of.mean_speed_hz),
            number("band_from_hz", "Hz", &|(of, _)| of.band.from_hz),
            number("band_to_hz", "Hz", &|(of, _)| of.band.to_hz),
            text("line", &|(_, line)| line.name()),
            text("part", &|(_, line)| line.kind.name().to_owned()),
            number("order", "", &|(_, line)| line.order),
            number("found_order", "", &|(_, line)| line.found_order),
            number("amplitude", &squared, &|(_, line)| line.amplitude),
            number("over_median", "", &|(_, line)| line.over_median),
        ];
        ResultTable::new(columns.into(), lines.len(), &self.settings)
    }
}
