//! The header of a NumPy array.

use std::io::{self, Read};

use serde_json::Value;

use crate::recording::fields::invalid;
use crate::recording::number::{NumberKind, Numbers};

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

/// A part of an element.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub name: String,
    pub type_name: String,
    /// Where its numbers stand in each element; what it holds instead, if those are not real numbers.
    pub numbers: Result<Numbers, String>,
}

impl NpyHeader {
    /// Reads a header; the numbers are next.
    pub(crate) fn read(from: &mut dyn Read) -> io::Result<NpyHeader> {
        let mut start = [0; 8];
        from.read_exact(&mut start)?;
        if !start.starts_with(b"\x93NUMPY") {
            return Err(invalid("it does not begin as NumPy's arrays do"));
        }
        // The length of the header has two bytes in version 1, four in later ones.
        let mut length = [0; 4];
        let length_bytes = if start[6] == 1 { 2 } else { 4 };
        from.read_exact(&mut length[..length_bytes])?;
        let text_length = u32::from_le_bytes(length);
        if text_length > MAX_HEADER_BYTES {
            return Err(invalid("its header is longer than any of NumPy's"));
        }
        let mut text = vec![0; text_length as usize];
        from.read_exact(&mut text)?;
        let description = json_of(&String::from_utf8_lossy(&text));
        let description = description.and_then(|json| serde_json::from_str(&json).ok());
        let header = description.and_then(|description| NpyHeader::from_description(&description));
        let header = header.ok_or_else(|| invalid("its header is not as NumPy writes it"))?;
        Ok(NpyHeader { length: (start.len() + length_bytes) as u64 + u64::from(text_length), ..header })
    }

    fn from_description(description: &Value) -> Option<NpyHeader> {
        let first_runs_fastest = description.get("fortran_order")?.as_bool()?;
        let shape = description.get("shape")?.as_array()?;
        let shape = shape.iter().map(Value::as_u64).collect::<Option<_>>()?;
        let (fields, record) = match description.get("descr")? {
            Value::String(code) => {
                let (numbers, size) = element(code);
                (vec![Field::new("", code, numbers)], size.unwrap_or(0))
            }
            Value::Array(parts) => fields(parts)?,
            _ => return None,
        };
        Some(NpyHeader { length: 0, shape, first_runs_fastest, fields, record })
    }

    /// Elements, if a file can hold so many.
    pub(crate) fn elements(&self) -> Option<u64> {
        self.shape.iter().try_fold(1_u64, |product, length| product.checked_mul(*length))
    }

    /// (bytes) What the header and the numbers take, if a file can hold so many.
    pub(crate) fn file_bytes(&self) -> Option<u64> {
        self.elements()?.checked_mul(self.record)?.checked_add(self.length)
    }
}

impl Field {
    fn new(name: &str, code: &str, numbers: Result<Numbers, String>) -> Self {
        let type_name = numbers.as_ref().map_or(code, |numbers| numbers.kind.name()).to_string();
        Self { name: name.to_string(), type_name, numbers }
    }
}

/// The JSON of a Python literal, as far as NumPy writes it: its text, whole numbers, truth values, tuples and lists become strings,
/// numbers, truth values and arrays; its dictionary becomes an object.
fn json_of(literal: &str) -> Option<String> {
    let mut json = String::new();
    let mut rest = literal.trim();
    while let Some(first) = rest.chars().next() {
        let behind = &rest[first.len_utf8()..];
        rest = match first {
            '\'' | '"' => {
                let (text, behind) = behind.split_once(first).filter(|(text, _)| !text.contains('\\'))?;
                json += &Value::from(text).to_string();
                behind
            }
            // Python allows a comma behind the last item.
            ',' if behind.trim_start().starts_with([')', ']', '}']) => behind,
            '(' | '[' => {
                json.push('[');
                behind
            }
            ')' | ']' => {
                json.push(']');
                behind
            }
            _ if first.is_ascii_alphanumeric() => {
                let end = rest.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(rest.len());
                let (word, behind) = rest.split_at(end);
                // Python 2 wrote long integers with an L.
                json += word.to_lowercase().trim_end_matches('l');
                behind
            }
            other => {
                json.push(other);
                behind
            }
        };
    }
    Some(json)
}

/// The fields of a record and its bytes.
fn fields(parts: &[Value]) -> Option<(Vec<Field>, u64)> {
    let mut fields = Vec::new();
    let mut offset: u64 = 0;
    for part in parts {
        let [name, Value::String(code), shape @ ..] = &part.as_array()?[..] else { return None };
        let name = match name {
            // A title and a name.
            Value::Array(names) if names.len() == 2 => names[1].as_str()?,
            name => name.as_str()?,
        };
        let (numbers, size) = element(code);
        let before = offset;
        offset = offset.checked_add(size?.checked_mul(product(shape)?)?)?;
        let numbers = match shape {
            [] => numbers.map(|numbers| Numbers { before: before as usize, ..numbers }),
            _ => Err("arrays within an array; must be one number".to_string()),
        };
        // Padding has no name.
        if !name.is_empty() {
            fields.push(Field::new(name, code, numbers));
        }
    }
    for numbers in fields.iter_mut().filter_map(|field| field.numbers.as_mut().ok()) {
        numbers.behind = offset as usize - numbers.element_bytes();
    }
    (!fields.is_empty()).then_some((fields, offset))
}

/// The product of all lengths of a field's shape.
fn product(shape: &[Value]) -> Option<u64> {
    let mut product: u64 = 1;
    for lengths in shape {
        for length in lengths.as_array().map_or(std::slice::from_ref(lengths), Vec::as_slice) {
            product = product.checked_mul(length.as_u64()?)?;
        }
    }
    Some(product)
}

/// An element's type, such as `<f8`, and its bytes, where they are known.
fn element(code: &str) -> (Result<Numbers, String>, Option<u64>) {
    let kind = code.strip_prefix(['<', '>', '|', '=']).and_then(|kind| match kind {
        "f8" => Some(NumberKind::F64),
        "f4" => Some(NumberKind::F32),
        "i8" => Some(NumberKind::I64),
        "i4" => Some(NumberKind::I32),
        "i2" => Some(NumberKind::I16),
        "i1" => Some(NumberKind::I8),
        "u8" => Some(NumberKind::U64),
        "u4" => Some(NumberKind::U32),
        "u2" => Some(NumberKind::U16),
        "u1" | "b1" => Some(NumberKind::U8),
        _ => None,
    });
    let Some(kind) = kind else { return other_element(code) };
    (Ok(Numbers::plain(kind, code.starts_with('>'))), Some(kind.size() as u64))
}

fn other_element(code: &str) -> (Result<Numbers, String>, Option<u64>) {
    let letter = code.chars().nth(1).unwrap_or_default();
    let what = match letter {
        'c' => "complex numbers",
        'f' => "floating-point numbers of an unusual size",
        'U' | 'S' | 'a' => "text",
        'O' => "Python objects",
        'M' => "dates",
        'm' => "durations as integers",
        _ => "elements",
    };
    let digits = code.get(2..).unwrap_or_default();
    let digits = digits.split('[').next().unwrap_or_default();
    let count: Option<u64> = digits.parse().ok();
    let size = count.and_then(|count| if letter == 'U' { count.checked_mul(4) } else { Some(count) });
    (Err(format!("{what} ({code})")), size.filter(|_| letter != 'O'))
}

#[cfg(test)]
mod tests {
    use super::{Field, NpyHeader};
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
        let place =
            |field: &Field| field.numbers.as_ref().map(|numbers| (numbers.before, numbers.behind)).ok();
        let places: Vec<_> = record.fields.iter().map(|field| (&field.name[..], place(field))).collect();
        assert_eq!(places, [("t", Some((0, 20))), ("n", None), ("a", Some((24, 0)))]);
    }

    #[test]
    fn long_integers_and_names_with_brackets_are_read() {
        let header = header(
            "{'descr': [('a (x, y)', '<f8'), (('title', 'b'), '<i2', (3,))], 'fortran_order': False, 'shape': (10L, 2), }   \n",
        );
        let header = header.unwrap();
        assert_eq!((header.shape, header.record), (vec![10, 2], 14));
        let names: Vec<&str> = header.fields.iter().map(|field| &field.name[..]).collect();
        assert_eq!(names, ["a (x, y)", "b"]);
    }

    #[test]
    fn broken_headers_are_refused() {
        for broken in ["", "{", "{'a'}", "(1 2)", "'open", "((((((((((1))))))))))", "ä"] {
            assert!(header(broken).is_none(), "{broken}");
        }
        let shape =
            |shape: &str| header(&format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}}}"));
        assert!(shape("(3,)").is_some());
        for broken in
            ["(1 2)", "(1,,)", "(1,) x", "(99999999999999999999,)", "((1,),)", "(-1,)", "(1.5,)", "('1',)"]
        {
            assert!(shape(broken).is_none(), "{broken}");
        }
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
