//! The results as tables, in Parquet and as text.

use std::io::{self, Write};

use meshtone::signal::{IndicatorValue, Record};
use serde_json::{Map, Value};

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

/// A table of results, to be written as Parquet or as text.
pub struct ResultTable {
    columns: Vec<Column>,
    rows: usize,
    metadata: Vec<(&'static str, String)>,
}

impl ResultTable {
    pub(super) fn new(columns: Vec<Column>, rows: usize, settings: &Map<String, Value>) -> Self {
        let settings = Value::from(settings.clone()).to_string();
        let version = env!("CARGO_PKG_VERSION").to_owned();
        Self { columns, rows, metadata: vec![(VERSION_KEY, version), (SETTINGS_KEY, settings)] }
    }

    /// Writes it as Parquet.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_parquet(self, to: impl Write + Send) -> io::Result<()> {
        let (columns, cells) = self.columns.into_iter().unzip();
        write_compressed(to, columns, self.rows, cells, self.metadata)
    }

    /// Writes it as text: a line of names, and cells between commas; those of what is not defined are empty.
    ///
    /// # Arguments
    /// * `to` - where the file is written to; it needs no buffer
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_csv(&self, to: impl Write) -> io::Result<()> {
        let mut text = csv::Writer::from_writer(to);
        text.write_record(self.columns.iter().map(|(column, _)| &column.name))?;
        for row in 0..self.rows {
            let cells = self.columns.iter().map(|(_, cells)| match cells {
                Cells::Int64(cells) => cells[row].map(|cell| cell.to_string()),
                Cells::Float64(cells) => cells[row].map(|cell| cell.to_string()),
                Cells::Text(cells) => cells[row].clone(),
                // No table of results has others.
                Cells::Int32(_) | Cells::Signal(_) | Cells::Float32List(_) => None,
            });
            text.write_record(cells.map(Option::unwrap_or_default))?;
        }
        text.flush()
    }
}

impl IndicatorResults {
    /// The records, one row for each.
    pub fn record_table(&self) -> ResultTable {
        let columns = self.circumstances().into_iter().chain(self.values()).collect();
        ResultTable::new(columns, self.records.len(), &self.settings)
    }

    /// Averages and spectra of records, one row for each value: the average and its parts over the angle, and the amplitudes of it and of the
    /// envelope of the difference over the order.
    ///
    /// # Arguments
    /// * `records` - with their entries, which say what each is of
    pub fn curve_tables(&self, records: &[(&RecordEntry, &Record)]) -> [ResultTable; 2] {
        type Curve = fn(&Record) -> &[f64];
        let unit = self.unit.as_deref().unwrap_or_default();
        let table = |place: &str, step: &dyn Fn(&Record) -> f64, curves: &[(&str, Curve)]| {
            let of = |curve: Curve| records.iter().map(move |(_, record)| curve(record).len());
            let rows: Vec<usize> = of(curves[0].1).collect();
            let entries = || {
                records.iter().zip(&rows).flat_map(|((entry, _), rows)| std::iter::repeat_n(*entry, *rows))
            };
            let recordings = entries().map(|entry| Some(entry.recording as i64));
            let segments = entries().map(|entry| entry.segment.map(|segment| segment as i64));
            let wheels = entries().map(|entry| Some(entry.wheel.clone()));
            let places = records.iter().zip(&rows).flat_map(|((_, record), rows)| {
                let step = step(record);
                (0..*rows).map(move |row| Some(row as f64 * step))
            });
            let mut columns = vec![
                column("recording", "", false, (CellType::Int64, Cells::Int64(recordings.collect()))),
                column("segment", "", true, (CellType::Int64, Cells::Int64(segments.collect()))),
                column("wheel", "", false, (CellType::Text, Cells::Text(wheels.collect()))),
                column(place, "", false, (CellType::Float64, Cells::Float64(places.collect()))),
            ];
            columns.extend(curves.iter().map(|(name, curve)| {
                let values = records.iter().flat_map(|(_, record)| curve(record).iter().copied().map(Some));
                column(name, unit, false, (CellType::Float64, Cells::Float64(values.collect())))
            }));
            ResultTable::new(columns, rows.iter().sum(), &self.settings)
        };
        let over_angle: [(&str, Curve); 4] = [
            ("average", |record| &record.average.values),
            ("regular", |record| &record.parts.regular),
            ("difference", |record| &record.parts.difference),
            ("envelope", |record| &record.envelope),
        ];
        let over_order: [(&str, Curve); 2] = [
            ("amplitude", |record| &record.order_spectrum),
            ("envelope_amplitude", |record| &record.envelope_spectrum),
        ];
        [
            table("revolution", &|record| 1.0 / record.average.values.len() as f64, &over_angle),
            table("order", &|_| 1.0, &over_order),
        ]
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
