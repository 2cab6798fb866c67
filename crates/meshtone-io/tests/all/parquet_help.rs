//! Parquet files as the `parquet` crate writes them, without anything of Arrow's.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::file::metadata::KeyValue;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::types::Type;

/// A column whose cells may be empty.
pub enum Plain {
    Whole(Vec<Option<i64>>),
    /// Microseconds since 1970.
    Moments(Vec<Option<i64>>),
    Single(Vec<Option<f32>>),
    Double(Vec<Option<f64>>),
    Text(Vec<Option<String>>),
}

impl Plain {
    pub fn doubles(numbers: impl IntoIterator<Item = f64>) -> Self {
        Self::Double(numbers.into_iter().map(Some).collect())
    }

    fn field(&self, name: &str) -> Arc<Type> {
        let (physical, logical) = match self {
            Self::Whole(_) => (Physical::INT64, None),
            Self::Moments(_) => (Physical::INT64, Some(LogicalType::timestamp(false, TimeUnit::MICROS))),
            Self::Single(_) => (Physical::FLOAT, None),
            Self::Double(_) => (Physical::DOUBLE, None),
            Self::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let field = Type::primitive_type_builder(name, physical).with_logical_type(logical);
        Arc::new(field.with_repetition(Repetition::OPTIONAL).build().unwrap())
    }
}

/// A file of columns, and what it says about itself.
pub fn parquet(columns: Vec<(&str, Plain)>, metadata: Vec<KeyValue>) -> Vec<u8> {
    let fields = columns.iter().map(|(name, cells)| cells.field(name)).collect();
    let schema = Type::group_type_builder("table").with_fields(fields).build().unwrap();
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::default()).unwrap();
    metadata.into_iter().for_each(|entry| writer.append_key_value_metadata(entry));
    let mut group = writer.next_row_group().unwrap();
    for (_, cells) in columns {
        let mut column = group.next_column().unwrap().unwrap();
        match cells {
            Plain::Whole(cells) | Plain::Moments(cells) => write::<Int64Type>(&mut column, cells),
            Plain::Single(cells) => write::<FloatType>(&mut column, cells),
            Plain::Double(cells) => write::<DoubleType>(&mut column, cells),
            Plain::Text(cells) => {
                let bytes = |text: String| ByteArray::from(text.into_bytes());
                write::<ByteArrayType>(&mut column, cells.into_iter().map(|cell| cell.map(bytes)).collect());
            }
        }
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
    bytes
}

fn write<T: DataType>(column: &mut SerializedColumnWriter, cells: Vec<Option<T::T>>) {
    let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    let values: Vec<T::T> = cells.into_iter().flatten().collect();
    column.typed::<T>().write_batch(&values, Some(&levels), None).unwrap();
}
