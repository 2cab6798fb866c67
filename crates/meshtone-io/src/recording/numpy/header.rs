//! The header of a NumPy array.

use std::io::{self, Read};

use super::element::element;
use super::literal::Literal;
use crate::recording::catalogue::Numbers;

/// Longest header that is read; NumPy itself warns beyond 10 000 bytes.
const MAX_HEADER_BYTES: u32 = 1 << 20;

/// What stands before an array's numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NpyHeader {
    /// Bytes before the numbers.
    pub length: u64,
    pub shape: Vec<u64>,
    pub first_runs_fastest: bool,
    /// One, of no name; or the fields of a record.
    pub fields: Vec<Field>,
    /// Bytes of an element, all fields together; 0 where unknown.
    pub record: u64,
}

/// A number within an element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub name: String,
    pub type_name: String,
    pub numbers: Result<Numbers, String>,
    /// Bytes of the element before it.
    pub offset: u64,
}

impl NpyHeader {
    /// Reads a header; the numbers are next.
    pub(crate) fn read(from: &mut dyn Read) -> io::Result<NpyHeader> {
        let mut start = [0; 8];
        from.read_exact(&mut start)?;
        if !start.starts_with(b"\x93NUMPY") {
            return Err(invalid("it does not begin as NumPy's arrays do"));
        }
        let (text_length, before) = if start[6] == 1 {
            let mut length = [0; 2];
            from.read_exact(&mut length)?;
            (u32::from(u16::from_le_bytes(length)), 10)
        } else {
            let mut length = [0; 4];
            from.read_exact(&mut length)?;
            (u32::from_le_bytes(length), 12)
        };
        if text_length > MAX_HEADER_BYTES {
            return Err(invalid("its header is longer than any of NumPy's"));
        }
        let mut text = vec![0; text_length as usize];
        from.read_exact(&mut text)?;
        let text = String::from_utf8_lossy(&text);
        let header = Literal::parse(&text).and_then(|literal| NpyHeader::from_literal(&literal));
        let mut header = header.ok_or_else(|| invalid("its header is not as NumPy writes it"))?;
        header.length = before + u64::from(text_length);
        Ok(header)
    }

    fn from_literal(literal: &Literal) -> Option<NpyHeader> {
        let Literal::Truth(first_runs_fastest) = literal.get("fortran_order")? else { return None };
        let Literal::Sequence(lengths) = literal.get("shape")? else { return None };
        let length = |length: &Literal| match length {
            Literal::Number(length) => Some(*length),
            _ => None,
        };
        let shape = lengths.iter().map(length).collect::<Option<_>>()?;
        let (fields, record) = fields(literal.get("descr")?)?;
        Some(NpyHeader { length: 0, shape, first_runs_fastest: *first_runs_fastest, fields, record })
    }

    /// Elements, if a file can hold so many.
    pub(crate) fn elements(&self) -> Option<u64> {
        self.shape.iter().try_fold(1_u64, |product, length| product.checked_mul(*length))
    }
}

fn invalid(problem: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, problem)
}

/// The fields of an element and its bytes.
fn fields(description: &Literal) -> Option<(Vec<Field>, u64)> {
    let parts = match description {
        Literal::Text(code) => {
            let (numbers, size) = element(code);
            let field =
                Field { name: String::new(), type_name: type_name(code, &numbers), numbers, offset: 0 };
            return Some((vec![field], size.unwrap_or(0)));
        }
        Literal::Sequence(parts) => parts,
        _ => return None,
    };
    let mut fields = Vec::new();
    let mut offset: u64 = 0;
    for part in parts {
        let Literal::Sequence(part) = part else { return None };
        let [name, Literal::Text(code), shape @ ..] = &part[..] else { return None };
        let name = match name {
            Literal::Text(name) => name,
            // A title and a name.
            Literal::Sequence(names) => match &names[..] {
                [_, Literal::Text(name)] => name,
                _ => return None,
            },
            _ => return None,
        };
        let (mut numbers, size) = element(code);
        if !shape.is_empty() {
            numbers = Err("arrays within an array; must be one number".to_string());
        }
        // Padding has no name.
        if !name.is_empty() {
            let type_name = type_name(code, &numbers);
            fields.push(Field { name: name.clone(), type_name, numbers, offset });
        }
        offset = offset.checked_add(size?.checked_mul(product(shape)?)?)?;
    }
    (!fields.is_empty()).then_some((fields, offset))
}

fn product(shape: &[Literal]) -> Option<u64> {
    let mut product: u64 = 1;
    for lengths in shape {
        let lengths = match lengths {
            Literal::Sequence(lengths) => lengths,
            single => std::slice::from_ref(single),
        };
        for length in lengths {
            let Literal::Number(length) = length else { return None };
            product = product.checked_mul(*length)?;
        }
    }
    Some(product)
}

fn type_name(code: &str, numbers: &Result<Numbers, String>) -> String {
    numbers.as_ref().map_or_else(|_| code.to_string(), |numbers| numbers.kind.name().to_string())
}

#[cfg(test)]
mod tests {
    use super::NpyHeader;
    use crate::recording::number::NumberKind;

    fn header(text: &str) -> Option<NpyHeader> {
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(u16::try_from(text.len()).unwrap().to_le_bytes());
        bytes.extend(text.as_bytes());
        NpyHeader::read(&mut &bytes[..]).ok()
    }

    #[test]
    fn headers_are_read() {
        let plain = header("{'descr': '>i2', 'fortran_order': True, 'shape': (10, 2), }\n").unwrap();
        assert_eq!((plain.shape.clone(), plain.first_runs_fastest, plain.record), (vec![10, 2], true, 2));
        let numbers = plain.fields[0].numbers.clone().unwrap();
        assert_eq!((numbers.kind, numbers.big_endian), (NumberKind::I16, true));
        let record = header(
            "{'descr': [('t', '<f8'), ('', '|V4'), ('n', '<U3'), ('a', '<f4')], 'fortran_order': False, 'shape': (5,)}",
        );
        let record = record.unwrap();
        assert_eq!(record.record, 28);
        let offsets: Vec<(&str, u64)> =
            record.fields.iter().map(|field| (&field.name[..], field.offset)).collect();
        assert_eq!(offsets, [("t", 0), ("n", 12), ("a", 24)]);
        assert!(record.fields[1].numbers.is_err());
    }

    #[test]
    fn broken_headers_are_refused() {
        assert!(header("{'descr': '<f8', 'fortran_order': 0, 'shape': (1,)}").is_none());
        assert!(header("{'descr': '<f8', 'fortran_order': False, 'shape': 1}").is_none());
        assert!(
            header(
                "{'descr': [('a', '<f8', (4294967296, 4294967296))], 'fortran_order': False, 'shape': (1,)}"
            )
            .is_none()
        );
        assert!(header("{'descr': [], 'fortran_order': False, 'shape': (1,)}").is_none());
        let huge =
            header("{'descr': '<f8', 'fortran_order': False, 'shape': (4294967296, 4294967296)}").unwrap();
        assert_eq!(huge.elements(), None);
    }
}
