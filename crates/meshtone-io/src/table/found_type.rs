//! What a column of any Parquet file holds.

use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit as ParquetUnit, Type as Physical};
use parquet::schema::types::Type;

use super::arrow_schema::ArrowKind;

/// What a column holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FoundType {
    /// Numbers.
    Number(NumberType),
    /// Points in time or times between them, as integers.
    Moment(TimeUnit),
    /// Text.
    Text,
    /// Something else, in Arrow's words.
    Other(String),
}

/// A type of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberType {
    /// 8 bits with sign
    Int8,
    /// 16 bits with sign
    Int16,
    /// 32 bits with sign
    Int32,
    /// 64 bits with sign
    Int64,
    /// 8 bits without sign
    UInt8,
    /// 16 bits without sign
    UInt16,
    /// 32 bits without sign
    UInt32,
    /// 64 bits without sign
    UInt64,
    /// single precision
    Float32,
    /// double precision
    Float64,
}

/// A unit of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeUnit {
    /// 1 s
    Second,
    /// 1 ms
    Millisecond,
    /// 1 µs
    Microsecond,
    /// 1 ns
    Nanosecond,
}

impl TimeUnit {
    /// The unit of a number in Arrow's schemas.
    pub(super) fn from_code(code: u16) -> Option<Self> {
        [Self::Second, Self::Millisecond, Self::Microsecond, Self::Nanosecond].get(usize::from(code)).copied()
    }

    /// How many make a second.
    pub fn per_second(self) -> f64 {
        match self {
            Self::Second => 1.0,
            Self::Millisecond => 1e3,
            Self::Microsecond => 1e6,
            Self::Nanosecond => 1e9,
        }
    }
}

impl From<ParquetUnit> for TimeUnit {
    fn from(unit: ParquetUnit) -> Self {
        match unit {
            ParquetUnit::MILLIS => Self::Millisecond,
            ParquetUnit::MICROS => Self::Microsecond,
            ParquetUnit::NANOS => Self::Nanosecond,
        }
    }
}

impl FoundType {
    /// Of a column of the file's schema, and what Arrow's schema says of it.
    pub(super) fn of(column: &Type, arrow: Option<ArrowKind>) -> Self {
        let info = column.get_basic_info();
        if info.has_repetition() && info.repetition() == Repetition::REPEATED {
            return Self::Other("List".to_owned());
        }
        if column.is_group() {
            return Self::Other(group(info.logical_type_ref(), info.converted_type()).to_owned());
        }
        if matches!(info.logical_type_ref(), Some(LogicalType::Unknown)) {
            return Self::Other("Null".to_owned());
        }
        let stored = primitive(column.get_physical_type(), info.logical_type_ref(), info.converted_type());
        match (stored, arrow) {
            // Arrow has types that Parquet lacks; they are stored as integers.
            (Self::Number(_), Some(kind)) if is_integer(column) => Self::of_arrow(kind),
            (stored, _) => stored,
        }
    }

    fn of_arrow(kind: ArrowKind) -> Self {
        match kind {
            ArrowKind::Timestamp(unit) | ArrowKind::Duration(unit) => Self::Moment(unit),
            ArrowKind::Time => Self::Other("Time".to_owned()),
            ArrowKind::Date => Self::Other("Date".to_owned()),
        }
    }
}

fn is_integer(column: &Type) -> bool {
    matches!(column.get_physical_type(), Physical::INT32 | Physical::INT64)
}

/// A type that is made of others.
fn group(logical: Option<&LogicalType>, converted: ConvertedType) -> &'static str {
    match (logical, converted) {
        (Some(LogicalType::List), _) | (None, ConvertedType::LIST) => "List",
        (Some(LogicalType::Map), _) | (None, ConvertedType::MAP | ConvertedType::MAP_KEY_VALUE) => "Map",
        _ => "Struct",
    }
}

/// A type of single values; older files have only the converted type.
fn primitive(physical: Physical, logical: Option<&LogicalType>, converted: ConvertedType) -> FoundType {
    let other = |name: &str| FoundType::Other(name.to_owned());
    match (logical, converted) {
        (Some(LogicalType::Integer(kind)), _) => integer(kind.bit_width, kind.is_signed),
        (Some(LogicalType::Timestamp(kind)), _) => FoundType::Moment(kind.unit.into()),
        (Some(LogicalType::String | LogicalType::Json), _) => FoundType::Text,
        (Some(LogicalType::Date), _) => other("Date32"),
        (Some(LogicalType::Time(_)), _) => other("Time"),
        (Some(LogicalType::Decimal(_)), _) => other("Decimal"),
        (Some(LogicalType::Float16), _) => other("Float16"),
        (None, ConvertedType::INT_8) => integer(8, true),
        (None, ConvertedType::INT_16) => integer(16, true),
        (None, ConvertedType::UINT_8) => integer(8, false),
        (None, ConvertedType::UINT_16) => integer(16, false),
        (None, ConvertedType::UINT_32) => integer(32, false),
        (None, ConvertedType::UINT_64) => integer(64, false),
        (None, ConvertedType::TIMESTAMP_MILLIS) => FoundType::Moment(TimeUnit::Millisecond),
        (None, ConvertedType::TIMESTAMP_MICROS) => FoundType::Moment(TimeUnit::Microsecond),
        (None, ConvertedType::UTF8 | ConvertedType::JSON) => FoundType::Text,
        (None, ConvertedType::DATE) => other("Date32"),
        (None, ConvertedType::TIME_MILLIS | ConvertedType::TIME_MICROS) => other("Time"),
        (None, ConvertedType::DECIMAL) => other("Decimal"),
        (None, ConvertedType::INTERVAL) => other("Interval"),
        _ => match physical {
            Physical::INT32 => integer(32, true),
            Physical::INT64 => integer(64, true),
            Physical::FLOAT => FoundType::Number(NumberType::Float32),
            Physical::DOUBLE => FoundType::Number(NumberType::Float64),
            // Old programs' timestamps.
            Physical::INT96 => FoundType::Moment(TimeUnit::Nanosecond),
            Physical::BOOLEAN => other("Boolean"),
            Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY => other("Binary"),
        },
    }
}

fn integer(bits: i8, is_signed: bool) -> FoundType {
    use NumberType::*;
    FoundType::Number(match (bits, is_signed) {
        (8, true) => Int8,
        (16, true) => Int16,
        (32, true) => Int32,
        (8, false) => UInt8,
        (16, false) => UInt16,
        (32, false) => UInt32,
        (64, false) => UInt64,
        _ => Int64,
    })
}

impl std::fmt::Display for FoundType {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(kind) => write!(formatter, "{kind:?}"),
            Self::Moment(unit) => write!(formatter, "Timestamp({unit:?})"),
            Self::Text => formatter.write_str("Utf8"),
            Self::Other(name) => formatter.write_str(name),
        }
    }
}
