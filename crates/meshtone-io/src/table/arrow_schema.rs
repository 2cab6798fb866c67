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

/// Numbers of the fields of Arrow's tables.
const MESSAGE_VERSION: usize = 0;
const MESSAGE_HEADER_TYPE: usize = 1;
const MESSAGE_HEADER: usize = 2;
const SCHEMA_FIELDS: usize = 1;
const FIELD_NAME: usize = 0;
const FIELD_NULLABLE: usize = 1;
const FIELD_TYPE_CODE: usize = 2;
const FIELD_TYPE: usize = 3;
const FIELD_CHILDREN: usize = 5;
const FIELD_METADATA: usize = 6;
const KEY_VALUE_KEY: usize = 0;
const KEY_VALUE_VALUE: usize = 1;
const INTEGER_BITS: usize = 0;
const INTEGER_IS_SIGNED: usize = 1;
const FLOATING_POINT_PRECISION: usize = 0;
/// Precisions of floating point.
const SINGLE_PRECISION: i16 = 1;
const DOUBLE_PRECISION: i16 = 2;
/// Codes of types.
const TYPE_INTEGER: u8 = 2;
const TYPE_FLOATING_POINT: u8 = 3;
const TYPE_TEXT: u8 = 5;
const TYPE_DATE: u8 = 8;
const TYPE_TIME: u8 = 9;
const TYPE_TIMESTAMP: u8 = 10;
const TYPE_LIST: u8 = 12;
const TYPE_DURATION: u8 = 18;
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
    if message.u8(MESSAGE_HEADER_TYPE)? != SCHEMA_MESSAGE {
        return None;
    }
    // Places may be shared, so that a hostile buffer stands for far more than it holds.
    let mut left = buffer.len();
    let fields = message.table(MESSAGE_HEADER)?.tables(SCHEMA_FIELDS);
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
    let entries = table.tables(FIELD_METADATA);
    let metadata = entries
        .map(|entry| Some((take(entry.text(KEY_VALUE_KEY))?, take(entry.text(KEY_VALUE_VALUE))?)))
        .collect::<Option<_>>()?;
    let name = take(table.text(FIELD_NAME))?;
    // Of a dictionary, the type is that of its values.
    let kind = table.table(FIELD_TYPE).zip(table.u8(FIELD_TYPE_CODE));
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
        TYPE_TIMESTAMP => moment(0),
        TYPE_DURATION => moment(1),
        TYPE_TIME => Some(FoundType::Other("Time")),
        TYPE_DATE => Some(FoundType::Other("Date")),
        _ => None,
    }
}

/// A schema of columns as text.
pub(super) fn encode(columns: &[TableColumn]) -> String {
    let mut buffer = FlatBufferBuilder::new();
    let put = |column: &TableColumn| {
        put_field(&mut buffer, &column.name, Some(column.cells), column.nullable, &column.metadata)
    };
    let fields: Vec<FlatField> = columns.iter().map(put).collect();
    let fields = buffer.create_vector(&fields);
    let start = buffer.start_table();
    buffer.push_slot_always(offset(SCHEMA_FIELDS), fields);
    let schema = buffer.end_table(start);
    let start = buffer.start_table();
    buffer.push_slot_always(offset(MESSAGE_VERSION), VERSION_5);
    buffer.push_slot_always(offset(MESSAGE_HEADER_TYPE), SCHEMA_MESSAGE);
    buffer.push_slot_always(offset(MESSAGE_HEADER), schema);
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

/// Puts a column, or with no type of cells the numbers in single precision that a column of lists consists of.
fn put_field(
    buffer: &mut FlatBufferBuilder,
    name: &str,
    cells: Option<CellType>,
    nullable: bool,
    metadata: &[(String, String)],
) -> FlatField {
    let mut metadata: Vec<&(String, String)> = metadata.iter().collect();
    metadata.sort();
    let metadata: Vec<FlatField> =
        metadata.into_iter().map(|(key, value)| put_entry(buffer, key, value)).collect();
    let metadata = (!metadata.is_empty()).then(|| buffer.create_vector(&metadata));
    let name = buffer.create_string(name);
    let is_list = cells == Some(CellType::Float32List);
    let item = is_list.then(|| put_field(buffer, LIST_ITEM, None, false, &[]));
    let children: Vec<FlatField> = item.into_iter().collect();
    // Parts in the order of Arrow's own Rust library: then files are its files, byte by byte.
    let ((code, parameters), children) = if is_list || cells == Some(CellType::Text) {
        (put_type(buffer, cells), buffer.create_vector(&children))
    } else {
        let children = buffer.create_vector(&children);
        (put_type(buffer, cells), children)
    };
    let start = buffer.start_table();
    buffer.push_slot_always(offset(FIELD_NAME), name);
    buffer.push_slot_always(offset(FIELD_TYPE_CODE), code);
    buffer.push_slot(offset(FIELD_NULLABLE), nullable, false);
    buffer.push_slot_always(offset(FIELD_CHILDREN), children);
    buffer.push_slot_always(offset(FIELD_TYPE), parameters);
    if let Some(metadata) = metadata {
        buffer.push_slot_always(offset(FIELD_METADATA), metadata);
    }
    buffer.end_table(start)
}

fn put_entry(buffer: &mut FlatBufferBuilder, key: &str, value: &str) -> FlatField {
    let (key, value) = (buffer.create_string(key), buffer.create_string(value));
    let start = buffer.start_table();
    buffer.push_slot_always(offset(KEY_VALUE_KEY), key);
    buffer.push_slot_always(offset(KEY_VALUE_VALUE), value);
    buffer.end_table(start)
}

/// The code of a type, and the table of what it says besides; with no type of cells those of numbers in single precision.
fn put_type(buffer: &mut FlatBufferBuilder, cells: Option<CellType>) -> (u8, FlatField) {
    let start = buffer.start_table();
    let code = match cells {
        Some(CellType::Int32 | CellType::Int64) => {
            let bits = if cells == Some(CellType::Int32) { 32 } else { 64 };
            buffer.push_slot_always(offset(INTEGER_IS_SIGNED), true);
            buffer.push_slot_always::<i32>(offset(INTEGER_BITS), bits);
            TYPE_INTEGER
        }
        Some(CellType::Float64) | None => {
            let precision = if cells.is_some() { DOUBLE_PRECISION } else { SINGLE_PRECISION };
            buffer.push_slot_always(offset(FLOATING_POINT_PRECISION), precision);
            TYPE_FLOATING_POINT
        }
        Some(CellType::Text) => TYPE_TEXT,
        Some(CellType::Float32List) => TYPE_LIST,
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
