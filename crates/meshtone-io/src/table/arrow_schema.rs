//! The schema that programs built on Arrow keep in a Parquet file.
//!
//! A message of Arrow's format for streams (<https://arrow.apache.org/docs/format/Columnar.html#schema-message>): a flat buffer
//! with a mark and its length before it, in base 64. The numbers of fields and of types are those of Arrow's `Schema.fbs` and
//! `Message.fbs`.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use flatbuffers::{FlatBufferBuilder, TableFinishedWIPOffset, VOffsetT, WIPOffset};

use super::flat_buffer::{BEFORE_PLACES, FlatTable};
use super::write::LIST_ITEM;
use super::{CellType, TableColumn, TimeUnit};

/// The metadata key.
pub(super) const KEY: &str = "ARROW:schema";

/// What stands before the message's length.
const MARK: [u8; 4] = [0xff; 4];
const SCHEMA_MESSAGE: u8 = 1;
/// The fifth version of Arrow's format, of all releases since 2020.
const VERSION_5: i16 = 4;

mod message {
    pub const VERSION: usize = 0;
    pub const HEADER_TYPE: usize = 1;
    pub const HEADER: usize = 2;
}
mod schema {
    pub const FIELDS: usize = 1;
}
mod field {
    pub const NAME: usize = 0;
    pub const NULLABLE: usize = 1;
    pub const TYPE_CODE: usize = 2;
    pub const TYPE: usize = 3;
    pub const CHILDREN: usize = 5;
    pub const METADATA: usize = 6;
}
mod key_value {
    pub const KEY: usize = 0;
    pub const VALUE: usize = 1;
}
mod integer {
    pub const BITS: usize = 0;
    pub const IS_SIGNED: usize = 1;
}
mod floating_point {
    pub const PRECISION: usize = 0;
    pub const SINGLE: i16 = 1;
    pub const DOUBLE: i16 = 2;
}
mod type_code {
    pub const INTEGER: u8 = 2;
    pub const FLOATING_POINT: u8 = 3;
    pub const TEXT: u8 = 5;
    pub const DATE: u8 = 8;
    pub const TIME: u8 = 9;
    pub const TIMESTAMP: u8 = 10;
    pub const LIST: u8 = 12;
    pub const DURATION: u8 = 18;
}
/// Of dates, times, timestamps and durations alike.
const UNIT: usize = 0;

/// What Arrow knows about a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ArrowField {
    pub name: String,
    pub metadata: Vec<(String, String)>,
    /// Its type, where that is one that Parquet's integers may stand for.
    pub kind: Option<ArrowKind>,
}

/// A type that Parquet stores as plain integers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ArrowKind {
    Timestamp(TimeUnit),
    Duration(TimeUnit),
    Time,
    Date,
}

/// Reads the columns of a schema; none where it is no schema.
pub(super) fn decode(text: &str) -> Option<Vec<ArrowField>> {
    let bytes = BASE64_STANDARD.decode(text).ok()?;
    let buffer = match bytes.strip_prefix(&MARK) {
        Some(behind) => behind.get(4..)?,
        None => &bytes,
    };
    let message = FlatTable::root(buffer)?;
    if message.u8(message::HEADER_TYPE)? != SCHEMA_MESSAGE {
        return None;
    }
    // Places may be shared, so that a hostile buffer stands for far more than it holds.
    let mut left = buffer.len();
    let fields = message.table(message::HEADER)?.tables(schema::FIELDS);
    fields.map(|field| arrow_field(field, &mut left)).collect()
}

/// * `left` - (bytes) of what the buffer may still stand for; none where that is used up
fn arrow_field(table: FlatTable, left: &mut usize) -> Option<ArrowField> {
    let mut take = |text: Option<&str>| -> Option<String> {
        let text = text.unwrap_or_default();
        // The text's length stands before it, and the way to it elsewhere.
        *left = left.checked_sub(text.len() + 8)?;
        Some(text.to_owned())
    };
    let entries = table.tables(field::METADATA);
    let metadata = entries
        .map(|entry| Some((take(entry.text(key_value::KEY))?, take(entry.text(key_value::VALUE))?)))
        .collect::<Option<_>>()?;
    let name = take(table.text(field::NAME))?;
    // Of a dictionary, the type is that of its values.
    let kind = table.table(field::TYPE).zip(table.u8(field::TYPE_CODE));
    Some(ArrowField { name, metadata, kind: kind.and_then(|(kind, code)| arrow_kind(kind, code)) })
}

fn arrow_kind(kind: FlatTable, code: u8) -> Option<ArrowKind> {
    let unit = |default: TimeUnit| kind.u16(UNIT).map_or(Some(default), TimeUnit::from_code);
    Some(match code {
        type_code::TIMESTAMP => ArrowKind::Timestamp(unit(TimeUnit::Second)?),
        type_code::DURATION => ArrowKind::Duration(unit(TimeUnit::Millisecond)?),
        type_code::TIME => ArrowKind::Time,
        type_code::DATE => ArrowKind::Date,
        _ => return None,
    })
}

/// A schema of columns as text.
pub(super) fn encode(columns: &[TableColumn]) -> String {
    let mut buffer = FlatBufferBuilder::new();
    let fields: Vec<FlatField> = columns.iter().map(|column| put_column(&mut buffer, column)).collect();
    let fields = buffer.create_vector(&fields);
    let start = buffer.start_table();
    buffer.push_slot_always(offset(schema::FIELDS), fields);
    let schema = buffer.end_table(start);
    let start = buffer.start_table();
    buffer.push_slot_always(offset(message::VERSION), VERSION_5);
    buffer.push_slot_always(offset(message::HEADER_TYPE), SCHEMA_MESSAGE);
    buffer.push_slot_always(offset(message::HEADER), schema);
    let message = buffer.end_table(start);
    buffer.finish_minimal(message);
    let message = buffer.finished_data();
    let length = u32::try_from(message.len()).unwrap_or(u32::MAX);
    BASE64_STANDARD.encode([&MARK, &length.to_le_bytes()[..], message].concat())
}

/// A table that has been put into a buffer.
type FlatField = WIPOffset<TableFinishedWIPOffset>;

/// Where a table's list says the place of a field.
fn offset(field: usize) -> VOffsetT {
    (BEFORE_PLACES + 2 * field) as VOffsetT
}

fn put_column(buffer: &mut FlatBufferBuilder, column: &TableColumn) -> FlatField {
    put_field(buffer, &column.name, ArrowType::of(column.cells), column.nullable, &column.metadata)
}

/// The types that are written.
#[derive(Clone, Copy)]
enum ArrowType {
    Integer { bits: i32, is_signed: bool },
    FloatingPoint { precision: i16 },
    Text,
    Float32List { nullable_items: bool },
}

impl ArrowType {
    fn of(cells: CellType) -> Self {
        match cells {
            CellType::Int32 => Self::Integer { bits: 32, is_signed: true },
            CellType::Int64 => Self::Integer { bits: 64, is_signed: true },
            CellType::UInt32 => Self::Integer { bits: 32, is_signed: false },
            CellType::UInt64 => Self::Integer { bits: 64, is_signed: false },
            CellType::Float64 => Self::FloatingPoint { precision: floating_point::DOUBLE },
            CellType::Text => Self::Text,
            CellType::Float32List { nullable_items } => Self::Float32List { nullable_items },
        }
    }

    fn code(self) -> u8 {
        match self {
            Self::Integer { .. } => type_code::INTEGER,
            Self::FloatingPoint { .. } => type_code::FLOATING_POINT,
            Self::Text => type_code::TEXT,
            Self::Float32List { .. } => type_code::LIST,
        }
    }
}

fn put_field(
    buffer: &mut FlatBufferBuilder,
    name: &str,
    kind: ArrowType,
    nullable: bool,
    metadata: &[(String, String)],
) -> FlatField {
    let mut metadata: Vec<&(String, String)> = metadata.iter().collect();
    metadata.sort();
    let metadata: Vec<FlatField> =
        metadata.into_iter().map(|(key, value)| put_entry(buffer, key, value)).collect();
    let metadata = (!metadata.is_empty()).then(|| buffer.create_vector(&metadata));
    let name = buffer.create_string(name);
    let children: Vec<FlatField> = match kind {
        ArrowType::Float32List { nullable_items } => {
            let item = ArrowType::FloatingPoint { precision: floating_point::SINGLE };
            vec![put_field(buffer, LIST_ITEM, item, nullable_items, &[])]
        }
        _ => Vec::new(),
    };
    // Parts in the order of Arrow's own Rust library: then files are its files, byte by byte.
    let (parameters, children) = match kind {
        ArrowType::Text | ArrowType::Float32List { .. } => {
            let parameters = put_parameters(buffer, kind);
            (parameters, buffer.create_vector(&children))
        }
        ArrowType::Integer { .. } | ArrowType::FloatingPoint { .. } => {
            let children = buffer.create_vector(&children);
            (put_parameters(buffer, kind), children)
        }
    };
    let start = buffer.start_table();
    buffer.push_slot_always(offset(field::NAME), name);
    buffer.push_slot_always(offset(field::TYPE_CODE), kind.code());
    buffer.push_slot(offset(field::NULLABLE), nullable, false);
    buffer.push_slot_always(offset(field::CHILDREN), children);
    buffer.push_slot_always(offset(field::TYPE), parameters);
    if let Some(metadata) = metadata {
        buffer.push_slot_always(offset(field::METADATA), metadata);
    }
    buffer.end_table(start)
}

fn put_entry(buffer: &mut FlatBufferBuilder, key: &str, value: &str) -> FlatField {
    let (key, value) = (buffer.create_string(key), buffer.create_string(value));
    let start = buffer.start_table();
    buffer.push_slot_always(offset(key_value::KEY), key);
    buffer.push_slot_always(offset(key_value::VALUE), value);
    buffer.end_table(start)
}

/// What a type says besides its code.
fn put_parameters(buffer: &mut FlatBufferBuilder, kind: ArrowType) -> FlatField {
    let start = buffer.start_table();
    match kind {
        ArrowType::Integer { bits, is_signed } => {
            buffer.push_slot(offset(integer::IS_SIGNED), is_signed, false);
            buffer.push_slot_always(offset(integer::BITS), bits);
        }
        ArrowType::FloatingPoint { precision } => {
            buffer.push_slot_always(offset(floating_point::PRECISION), precision);
        }
        ArrowType::Text | ArrowType::Float32List { .. } => {}
    }
    buffer.end_table(start)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns() -> Vec<TableColumn> {
        let column = |name: &str, cells, nullable, unit: &str| TableColumn {
            name: name.to_owned(),
            cells,
            nullable,
            metadata: vec![("unit".to_owned(), unit.to_owned()), ("description".to_owned(), "ä".to_owned())],
        };
        vec![
            column("label", CellType::Text, false, ""),
            column("speed", CellType::Float64, true, "Hz"),
            column("signal", CellType::Float32List { nullable_items: false }, false, "g"),
        ]
    }

    #[test]
    fn names_and_metadata_are_read_back() {
        let fields = decode(&encode(&columns())).unwrap();
        for (field, column) in fields.iter().zip(columns()) {
            let mut metadata = column.metadata;
            metadata.sort();
            assert_eq!((&field.name, &field.metadata, field.kind), (&column.name, &metadata, None));
        }
        assert_eq!(fields.len(), 3);
    }

    /// Every cut and every changed byte gives a schema or none, and never a panic.
    #[test]
    fn broken_schemas_are_none() {
        assert_eq!(decode("no base 64!"), None);
        assert_eq!(decode(""), None);
        let whole = BASE64_STANDARD.decode(encode(&columns())).unwrap();
        for place in 0..whole.len() {
            let _ = decode(&BASE64_STANDARD.encode(&whole[..place]));
            for change in [0x01, 0x7f, 0xff] {
                let mut changed = whole.clone();
                changed[place] ^= change;
                let _ = decode(&BASE64_STANDARD.encode(&changed));
            }
        }
    }
}
