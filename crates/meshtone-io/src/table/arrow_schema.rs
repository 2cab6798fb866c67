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
use super::{CellType, FoundType, TableColumn};

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
/// The field of dates, times, timestamps and durations alike that says their unit.
const UNIT: usize = 0;
/// How many of each unit make a second.
const PER_SECOND: [u32; 4] = [1, 1_000, 1_000_000, 1_000_000_000];

/// What Arrow knows about a column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct ArrowField {
    pub name: String,
    pub metadata: Vec<(String, String)>,
    /// Its type, where that is one that Parquet's integers may stand for.
    pub kind: Option<FoundType>,
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

/// A type that Parquet stores as plain integers.
fn arrow_kind(kind: FlatTable, code: u8) -> Option<FoundType> {
    let moment = |default_unit: u16| {
        let unit = usize::from(kind.u16(UNIT).unwrap_or(default_unit));
        let per_second = *PER_SECOND.get(unit)?;
        Some(FoundType::Moment { per_second })
    };
    match code {
        type_code::TIMESTAMP => moment(0),
        type_code::DURATION => moment(1),
        type_code::TIME => Some(FoundType::Other("Time")),
        type_code::DATE => Some(FoundType::Other("Date")),
        _ => None,
    }
}

/// A schema of columns as text.
pub(super) fn encode(columns: &[TableColumn]) -> String {
    let mut buffer = FlatBufferBuilder::new();
    let put = |column: &TableColumn| {
        let kind = ArrowType::of(column.cells);
        put_field(&mut buffer, &column.name, kind, column.nullable, &column.metadata)
    };
    let fields: Vec<FlatField> = columns.iter().map(put).collect();
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

/// The types that are written.
#[derive(Clone, Copy)]
enum ArrowType {
    Integer { bits: i32 },
    FloatingPoint { precision: i16 },
    Text,
    Float32List,
}

impl ArrowType {
    fn of(cells: CellType) -> Self {
        match cells {
            CellType::Int32 => Self::Integer { bits: 32 },
            CellType::Int64 => Self::Integer { bits: 64 },
            CellType::Float64 => Self::FloatingPoint { precision: floating_point::DOUBLE },
            CellType::Text => Self::Text,
            CellType::Float32List => Self::Float32List,
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
        ArrowType::Float32List => {
            let item = ArrowType::FloatingPoint { precision: floating_point::SINGLE };
            vec![put_field(buffer, LIST_ITEM, item, false, &[])]
        }
        _ => Vec::new(),
    };
    // Parts in the order of Arrow's own Rust library: then files are its files, byte by byte.
    let ((code, parameters), children) = match kind {
        ArrowType::Text | ArrowType::Float32List => (put_type(buffer, kind), buffer.create_vector(&children)),
        ArrowType::Integer { .. } | ArrowType::FloatingPoint { .. } => {
            let children = buffer.create_vector(&children);
            (put_type(buffer, kind), children)
        }
    };
    let start = buffer.start_table();
    buffer.push_slot_always(offset(field::NAME), name);
    buffer.push_slot_always(offset(field::TYPE_CODE), code);
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

/// The code of a type, and the table of what it says besides.
fn put_type(buffer: &mut FlatBufferBuilder, kind: ArrowType) -> (u8, FlatField) {
    let start = buffer.start_table();
    let code = match kind {
        ArrowType::Integer { bits } => {
            buffer.push_slot_always(offset(integer::IS_SIGNED), true);
            buffer.push_slot_always(offset(integer::BITS), bits);
            type_code::INTEGER
        }
        ArrowType::FloatingPoint { precision } => {
            buffer.push_slot_always(offset(floating_point::PRECISION), precision);
            type_code::FLOATING_POINT
        }
        ArrowType::Text => type_code::TEXT,
        ArrowType::Float32List => type_code::LIST,
    };
    (code, buffer.end_table(start))
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
            column("signal", CellType::Float32List, false, "g"),
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
