//! Numbers as bytes.

use std::io::{self, Read};

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NumberKind {
    I8,
    U8,
    I16,
    U16,
    I24,
    I32,
    U32,
    I64,
    U64,
    F16,
    F32,
    F64,
}

/// Name and bytes of each kind, in their order.
const KINDS: [(NumberKind, &str, usize); 12] = [
    (NumberKind::I8, "int8", 1),
    (NumberKind::U8, "uint8", 1),
    (NumberKind::I16, "int16", 2),
    (NumberKind::U16, "uint16", 2),
    (NumberKind::I24, "int24", 3),
    (NumberKind::I32, "int32", 4),
    (NumberKind::U32, "uint32", 4),
    (NumberKind::I64, "int64", 8),
    (NumberKind::U64, "uint64", 8),
    (NumberKind::F16, "float16", 2),
    (NumberKind::F32, "float32", 4),
    (NumberKind::F64, "float64", 8),
];

impl NumberKind {
    /// The kind of a class of numbers, `int`, `uint` or `float`, of so many bits.
    pub(crate) fn of(class: &str, bits: u32) -> Option<Self> {
        let wanted = format!("{class}{bits}");
        KINDS.iter().find(|(_, name, _)| *name == wanted).map(|(kind, ..)| *kind)
    }

    /// Bytes of a number.
    pub(crate) fn size(self) -> usize {
        KINDS[self as usize].2
    }

    pub(crate) fn name(self) -> &'static str {
        KINDS[self as usize].1
    }
}

/// How the numbers of an array stand in a file: one in each element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Numbers {
    pub kind: NumberKind,
    pub big_endian: bool,
    /// Bytes of an element before its number, as those of other fields.
    pub before: usize,
    /// Bytes of an element behind its number.
    pub behind: usize,
}

impl Numbers {
    /// Numbers without anything between them.
    pub(crate) fn plain(kind: NumberKind, big_endian: bool) -> Self {
        Self { kind, big_endian, before: 0, behind: 0 }
    }

    /// Bytes of an element.
    pub(crate) fn element_bytes(self) -> usize {
        self.before + self.kind.size() + self.behind
    }

    /// Reads one element.
    pub(crate) fn read_one(self, from: &mut dyn Read) -> io::Result<f64> {
        let mut bytes = vec![0; self.element_bytes()];
        from.read_exact(&mut bytes)?;
        let mut number = Vec::with_capacity(1);
        self.append(&bytes, 1, 0, &mut number);
        number.pop().ok_or_else(|| io::ErrorKind::UnexpectedEof.into())
    }

    /// Appends one number of each record.
    ///
    /// # Arguments
    /// * `bytes` - whole records, one behind the other
    /// * `elements` - elements of a record
    /// * `element` - the one of a record whose number is appended
    /// * `to` - what the numbers are appended to
    pub(crate) fn append(self, bytes: &[u8], elements: usize, element: usize, to: &mut Vec<f64>) {
        let position = NumberPosition {
            record: elements * self.element_bytes(),
            offset: element * self.element_bytes() + self.before,
            big_endian: self.big_endian,
        };
        match self.kind {
            NumberKind::I8 => position.append(bytes, to, |number| i8::from_le_bytes(number).into()),
            NumberKind::U8 => position.append(bytes, to, |number| u8::from_le_bytes(number).into()),
            NumberKind::I16 => position.append(bytes, to, |number| i16::from_le_bytes(number).into()),
            NumberKind::U16 => position.append(bytes, to, |number| u16::from_le_bytes(number).into()),
            // As the upper bytes of 32 bits, so that the sign is that of the number.
            NumberKind::I24 => {
                position.append(bytes, to, |[a, b, c]| (i32::from_le_bytes([0, a, b, c]) >> 8).into());
            }
            NumberKind::I32 => position.append(bytes, to, |number| i32::from_le_bytes(number).into()),
            NumberKind::U32 => position.append(bytes, to, |number| u32::from_le_bytes(number).into()),
            NumberKind::I64 => position.append(bytes, to, |number| i64::from_le_bytes(number) as f64),
            NumberKind::U64 => position.append(bytes, to, |number| u64::from_le_bytes(number) as f64),
            NumberKind::F16 => position.append(bytes, to, half),
            NumberKind::F32 => position.append(bytes, to, |number| f32::from_le_bytes(number).into()),
            NumberKind::F64 => position.append(bytes, to, f64::from_le_bytes),
        }
    }
}

/// A number of half precision.
fn half(bytes: [u8; 2]) -> f64 {
    let bits = u16::from_le_bytes(bytes);
    let (exponent, fraction) = (i32::from(bits >> 10 & 0x1f), f64::from(bits & 0x3ff) / 1024.0);
    let size = match exponent {
        0 => fraction * 2.0_f64.powi(-14),
        0x1f if fraction == 0.0 => f64::INFINITY,
        0x1f => f64::NAN,
        _ => (1.0 + fraction) * 2.0_f64.powi(exponent - 15),
    };
    if bits >> 15 == 1 { -size } else { size }
}

/// Where a number stands in each record.
struct NumberPosition {
    record: usize,
    offset: usize,
    big_endian: bool,
}

impl NumberPosition {
    /// * `number` - reads a number whose lowest byte is the first
    #[inline]
    fn append<const SIZE: usize>(&self, bytes: &[u8], to: &mut Vec<f64>, number: impl Fn([u8; SIZE]) -> f64) {
        if self.record == SIZE && !self.big_endian {
            // Nothing stands between the numbers: they are converted in vectors.
            to.extend(bytes.as_chunks().0.iter().map(|bytes| number(*bytes)));
            return;
        }
        let found = bytes.chunks_exact(self.record);
        let found = found.filter_map(|record| record.get(self.offset..)?.first_chunk::<SIZE>().copied());
        to.extend(found.map(|mut bytes| {
            if self.big_endian {
                bytes.reverse();
            }
            number(bytes)
        }));
    }
}
