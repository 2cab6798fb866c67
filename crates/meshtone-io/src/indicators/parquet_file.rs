//! The results as a table in Parquet.

use std::io::{self, Write};

use meshtone::signal::IndicatorValue;
use serde_json::Value;

use super::{IndicatorResults, RecordEntry, SETTINGS_KEY};
use crate::signals::VERSION_KEY;
use crate::table::{CellType, Cells, TableColumn, write_compressed};

/// A column and its cells.
pub(super) type Column = (TableColumn, Cells<'static>);

pub(super) fn column(
    name: &str,
    unit: &str,
    nullable: bool,
    (kind, cells): (CellType, Cells<'static>),
) -> Column {
    let unit = (!unit.is_empty()).then_some(("unit", unit));
    (TableColumn { nullable, ..TableColumn::new(name, kind).with_metadata(unit) }, cells)
}

impl IndicatorResults {
    /// Writes the records as Parquet, one row for each.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_parquet(&self, to: impl Write + Send) -> io::Result<()> {
        let (columns, cells) = self.circumstances().into_iter().chain(self.values()).unzip();
        let metadata = [
            (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
            (SETTINGS_KEY, Value::from(self.settings.clone()).to_string()),
        ];
        write_compressed(to, columns, self.records.len(), cells, metadata)
    }

    /// What each record is of.
    fn circumstances(&self) -> Vec<Column> {
        let text = |value: &dyn Fn(&RecordEntry) -> Option<String>| {
            (CellType::Text, Cells::Text(self.records.iter().map(value).collect()))
        };
        let count = |value: &dyn Fn(&RecordEntry) -> Option<usize>| {
            let counts = self.records.iter().map(|record| value(record).map(|count| count as i64));
            (CellType::Int64, Cells::Int64(counts.collect()))
        };
        let number = |value: &dyn Fn(&RecordEntry) -> f64| {
            let numbers = self.records.iter().map(|record| Some(value(record)));
            (CellType::Float64, Cells::Float64(numbers.collect()))
        };
        vec![
            column("recording", "", false, count(&|record| Some(record.recording))),
            column("file", "", false, text(&|record| Some(self.file(record.recording)))),
            column("segment", "", true, count(&|record| record.segment)),
            column("channel", "", false, text(&|_| Some(self.channel.clone()))),
            column("unit", "", true, text(&|_| self.unit.clone())),
            column("wheel", "", false, text(&|record| Some(record.wheel.clone()))),
            column("shaft", "", true, text(&|record| record.shaft.clone())),
            column("teeth", "", false, count(&|record| Some(record.teeth as usize))),
            column("revolutions", "", false, count(&|record| Some(record.revolutions))),
            column("mean_speed_hz", "Hz", false, number(&|record| record.mean_speed_hz)),
            column("points_per_revolution", "", false, count(&|record| Some(record.points_per_revolution))),
            column("nyquist_order", "", false, number(&|record| record.nyquist_order)),
        ]
    }

    /// The indicators.
    fn values(&self) -> Vec<Column> {
        let unit = self.unit.as_deref().unwrap_or_default();
        let tables: Vec<Vec<IndicatorValue>> =
            self.records.iter().map(|record| record.indicators.table(unit)).collect();
        let Some(first) = tables.first() else { return Vec::new() };
        let indicator = |(index, entry): (usize, &IndicatorValue)| {
            let values = tables.iter().map(|table| table.get(index).and_then(|entry| entry.value));
            column(&entry.name, &entry.unit, true, (CellType::Float64, Cells::Float64(values.collect())))
        };
        first.iter().enumerate().map(indicator).collect()
    }
}
