//! The classes and number types of MATLAB.

use std::io;

use super::super::number::NumberKind;
use super::source::invalid;

/// The classes of numbers, from the sixth class on.
const NUMBER_CLASSES: [&str; 10] =
    ["double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"];

/// What an array holds.
pub(super) enum Class {
    Cell,
    Struct,
    Object,
    Text,
    Sparse,
    Numbers(&'static str),
    Function,
    Opaque,
}

impl Class {
    pub(super) fn of(number: u32) -> io::Result<Class> {
        Ok(match number {
            1 => Class::Cell,
            2 => Class::Struct,
            3 => Class::Object,
            4 => Class::Text,
            5 => Class::Sparse,
            6..=15 => Class::Numbers(NUMBER_CLASSES[number as usize - 6]),
            16 => Class::Function,
            17 => Class::Opaque,
            other => return Err(invalid(format!("an array of class {other}, which does not exist"))),
        })
    }
}

/// Numbers are stored in the smallest type that holds them, whatever the array's class.
pub(super) fn stored_kind(kind: u32) -> Option<NumberKind> {
    Some(match kind {
        1 => NumberKind::I8,
        2 => NumberKind::U8,
        3 => NumberKind::I16,
        4 => NumberKind::U16,
        5 => NumberKind::I32,
        6 => NumberKind::U32,
        7 => NumberKind::F32,
        9 => NumberKind::F64,
        12 => NumberKind::I64,
        13 => NumberKind::U64,
        _ => return None,
    })
}
