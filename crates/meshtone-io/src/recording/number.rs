//! Numbers as bytes.

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl NumberKind {
    /// Bytes of a number.
    pub(crate) fn size(self) -> usize {
        match self {
            NumberKind::I8 | NumberKind::U8 => 1,
            NumberKind::I16 | NumberKind::U16 => 2,
            NumberKind::I32 | NumberKind::U32 | NumberKind::F32 => 4,
            NumberKind::I64 | NumberKind::U64 | NumberKind::F64 => 8,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            NumberKind::I8 => "int8",
            NumberKind::U8 => "uint8",
            NumberKind::I16 => "int16",
            NumberKind::U16 => "uint16",
            NumberKind::I32 => "int32",
            NumberKind::U32 => "uint32",
            NumberKind::I64 => "int64",
            NumberKind::U64 => "uint64",
            NumberKind::F32 => "float32",
            NumberKind::F64 => "float64",
        }
    }
}

/// Appends one number of each record.
///
/// # Arguments
/// * `bytes` - whole records, one behind the other
/// * `record` - bytes of a record
/// * `offset` - where the number begins in a record
/// * `kind`, `big_endian` - how it is stored
/// * `to` - what it is appended to
pub(crate) fn append_strided(
    bytes: &[u8],
    record: usize,
    offset: usize,
    kind: NumberKind,
    big_endian: bool,
    to: &mut Vec<f64>,
) {
    macro_rules! append {
        ($number:ty) => {{
            const SIZE: usize = size_of::<$number>();
            if record == SIZE && offset == 0 && !big_endian {
                // Nothing between the numbers: whole vectors at a time.
                to.extend(bytes.as_chunks().0.iter().map(|bytes| <$number>::from_le_bytes(*bytes) as f64));
                return;
            }
            let records = bytes.chunks_exact(record);
            let numbers = records.filter_map(|record| record.get(offset..)?.first_chunk::<SIZE>());
            if big_endian {
                to.extend(numbers.map(|bytes| <$number>::from_be_bytes(*bytes) as f64));
            } else {
                to.extend(numbers.map(|bytes| <$number>::from_le_bytes(*bytes) as f64));
            }
        }};
    }
    match kind {
        NumberKind::I8 => append!(i8),
        NumberKind::U8 => append!(u8),
        NumberKind::I16 => append!(i16),
        NumberKind::U16 => append!(u16),
        NumberKind::I32 => append!(i32),
        NumberKind::U32 => append!(u32),
        NumberKind::I64 => append!(i64),
        NumberKind::U64 => append!(u64),
        NumberKind::F32 => append!(f32),
        NumberKind::F64 => append!(f64),
    }
}
