//! The results as a table in Parquet.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use arrow::array::{ArrayRef, Float64Array, StringArray, UInt32Array, UInt64Array};
use arrow::datatypes::{DataType, Field, Schema};
use arrow::record_batch::RecordBatch;
use meshtone::signal::IndicatorValue;
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;

use super::{IndicatorResults, RecordEntry, SETTINGS_KEY};
use crate::signals::VERSION_KEY;

/// A column: name, unit (empty for none) and values.
struct Column {
    name: String,
    unit: String,
    nullable: bool,
    values: ArrayRef,
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
        self.try_write(to).map_err(io::Error::other)
    }

    fn try_write(&self, to: impl Write + Send) -> Result<(), parquet::errors::ParquetError> {
        let columns: Vec<Column> = self.circumstances().into_iter().chain(self.values()).collect();
        let fields = columns.iter().map(|column| {
            let metadata: HashMap<_, _> = [("unit".to_string(), column.unit.clone())]
                .into_iter()
                .filter(|(_, unit)| !unit.is_empty())
                .collect();
            let kind: DataType = column.values.data_type().clone();
            Field::new(&column.name, kind, column.nullable).with_metadata(metadata)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let arrays = columns.into_iter().map(|column| column.values).collect();
        let batch = RecordBatch::try_new(schema.clone(), arrays)?;
        let metadata = [
            (VERSION_KEY, env!("CARGO_PKG_VERSION").to_string()),
            (SETTINGS_KEY, self.settings_json().to_string()),
        ];
        let metadata = metadata.map(|(key, value)| KeyValue::new(key.to_string(), value));
        let properties = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::try_new(1)?))
            .set_key_value_metadata(Some(metadata.to_vec()))
            .build();
        let mut writer = ArrowWriter::try_new(to, schema, Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(())
    }

    /// What each record is of.
    fn circumstances(&self) -> Vec<Column> {
        let of = |name: &str, unit: &str, values: ArrayRef| Column {
            name: name.to_string(),
            unit: unit.to_string(),
            nullable: values.null_count() > 0 || name == "segment" || name == "unit",
            values,
        };
        let file = |record: &RecordEntry| {
            let recording = record.recording.checked_sub(1).and_then(|index| self.recordings.get(index));
            recording.map_or_else(String::new, |entry| entry.source.display().to_string())
        };
        let text = |value: &dyn Fn(&RecordEntry) -> Option<String>| -> ArrayRef {
            Arc::new(self.records.iter().map(value).collect::<StringArray>())
        };
        let count = |value: &dyn Fn(&RecordEntry) -> Option<usize>| -> ArrayRef {
            let counts = self.records.iter().map(|record| value(record).map(|count| count as u64));
            Arc::new(counts.collect::<UInt64Array>())
        };
        let number = |value: &dyn Fn(&RecordEntry) -> f64| -> ArrayRef {
            Arc::new(Float64Array::from_iter_values(self.records.iter().map(value)))
        };
        let teeth = UInt32Array::from_iter_values(self.records.iter().map(|record| record.teeth));
        vec![
            of("recording", "", count(&|record| Some(record.recording))),
            of("file", "", text(&|record| Some(file(record)))),
            of("segment", "", count(&|record| record.segment)),
            of("channel", "", text(&|_| Some(self.channel.clone()))),
            of("unit", "", text(&|_| self.unit.clone())),
            of("wheel", "", text(&|record| Some(record.wheel.clone()))),
            of("teeth", "", Arc::new(teeth)),
            of("revolutions", "", count(&|record| Some(record.revolutions))),
            of("mean_speed_hz", "Hz", number(&|record| record.mean_speed_hz)),
            of("points_per_revolution", "", count(&|record| Some(record.points_per_revolution))),
            of("nyquist_order", "", number(&|record| record.nyquist_order)),
        ]
    }

    /// The indicators.
    fn values(&self) -> Vec<Column> {
        let unit = self.unit.as_deref().unwrap_or_default();
        let tables: Vec<Vec<IndicatorValue>> =
            self.records.iter().map(|record| record.indicators.table(unit)).collect();
        let Some(first) = tables.first() else { return Vec::new() };
        let column = |(index, entry): (usize, &IndicatorValue)| {
            let values = tables.iter().map(|table| table.get(index).and_then(|entry| entry.value));
            Column {
                name: entry.name.clone(),
                unit: entry.unit.clone(),
                nullable: true,
                values: Arc::new(values.collect::<Float64Array>()),
            }
        };
        first.iter().enumerate().map(column).collect()
    }
}
