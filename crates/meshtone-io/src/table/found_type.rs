//! What a column of any Parquet file holds.

use std::fmt;

use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit, Type as Physical};
use parquet::schema::types::Type;

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FoundType {
    /// Numbers.
    Number(NumberType),
    /// Points in time or times between them, as integers.
    Moment {
        /// How many units of time make a second.
        per_second: u32,
    },
    /// Text.
    Text,
    /// Something else, in Arrow's words.
    Other(&'static str),
}

/// A type of numbers, with its bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberType {
    /// Integers with sign.
    Int(u8),
    /// Integers without sign.
    UInt(u8),
    /// Floating point.
    Float(u8),
}

impl FoundType {
    /// Of a column of the file's schema, and what Arrow's schema says of it.
    pub(super) fn of(column: &Type, arrow: Option<FoundType>) -> Self {
        let info = column.get_basic_info();
        if info.has_repetition() && info.repetition() == Repetition::REPEATED {
            return Self::Other("List");
        }
        // Older files have only the converted type, which says less.
        let logical = info.logical_type_ref();
        let converted = logical.map_or(info.converted_type(), |logical| Some(logical.clone()).into());
        if column.is_group() {
            return Self::Other(match converted {
                ConvertedType::LIST => "List",
                ConvertedType::MAP | ConvertedType::MAP_KEY_VALUE => "Map",
                _ => "Struct",
            });
        }
        let physical = column.get_physical_type();
        match (primitive(physical, logical, converted), arrow) {
            // Arrow has types that Parquet lacks; they are stored as integers.
            (Self::Number(_), Some(arrow)) if matches!(physical, Physical::INT32 | Physical::INT64) => arrow,
            (stored, _) => stored,
        }
    }
}

/// A type of single values.
///
/// Types of which the converted type says too little are found by their logical type, all others by the converted one, and those
/// without either by how they are stored.
fn primitive(physical: Physical, logical: Option<&LogicalType>, converted: ConvertedType) -> FoundType {
    use FoundType::{Moment, Number, Other, Text};
    use NumberType::{Float, Int, UInt};

    match logical {
        Some(LogicalType::Timestamp(kind)) => {
            let per_second = match kind.unit {
                TimeUnit::MILLIS => 1_000,
                TimeUnit::MICROS => 1_000_000,
                TimeUnit::NANOS => 1_000_000_000,
            };
            return Moment { per_second };
        }
        Some(LogicalType::Time(_)) => return Other("Time"),
        Some(LogicalType::Float16) => return Other("Float16"),
        Some(LogicalType::Unknown) => return Other("Null"),
        _ => {}
    }
    match converted {
        ConvertedType::INT_8 => Number(Int(8)),
        ConvertedType::INT_16 => Number(Int(16)),
        ConvertedType::UINT_8 => Number(UInt(8)),
        ConvertedType::UINT_16 => Number(UInt(16)),
        ConvertedType::UINT_32 => Number(UInt(32)),
        ConvertedType::UINT_64 => Number(UInt(64)),
        ConvertedType::TIMESTAMP_MILLIS => Moment { per_second: 1_000 },
        ConvertedType::TIMESTAMP_MICROS => Moment { per_second: 1_000_000 },
        ConvertedType::UTF8 | ConvertedType::JSON => Text,
        ConvertedType::DATE => Other("Date32"),
        ConvertedType::TIME_MILLIS | ConvertedType::TIME_MICROS => Other("Time"),
        ConvertedType::DECIMAL => Other("Decimal"),
        ConvertedType::INTERVAL => Other("Interval"),
        _ => match physical {
            Physical::INT32 => Number(Int(32)),
            Physical::INT64 => Number(Int(64)),
            Physical::FLOAT => Number(Float(32)),
            Physical::DOUBLE => Number(Float(64)),
            // Old programs' timestamps.
            Physical::INT96 => Moment { per_second: 1_000_000_000 },
            Physical::BOOLEAN => Other("Boolean"),
            Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY => Other("Binary"),
        },
    }
}

impl fmt::Display for FoundType {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(NumberType::Int(bits)) => write!(formatter, "Int{bits}"),
            Self::Number(NumberType::UInt(bits)) => write!(formatter, "UInt{bits}"),
            Self::Number(NumberType::Float(bits)) => write!(formatter, "Float{bits}"),
            Self::Moment { per_second } => write!(formatter, "Timestamp({per_second} a second)"),
            Self::Text => formatter.write_str("Utf8"),
            Self::Other(name) => formatter.write_str(name),
        }
    }
}
