//! NumPy's names of types.

use crate::recording::catalogue::Numbers;
use crate::recording::number::NumberKind;

/// An element's type, such as `<f8`, and its bytes, where they are known.
pub(super) fn element(code: &str) -> (Result<Numbers, String>, Option<u64>) {
    let order = code.chars().next().unwrap_or_default();
    let kind = match code.get(1..) {
        Some("f8") => NumberKind::F64,
        Some("f4") => NumberKind::F32,
        Some("i8") => NumberKind::I64,
        Some("i4") => NumberKind::I32,
        Some("i2") => NumberKind::I16,
        Some("i1") => NumberKind::I8,
        Some("u8") => NumberKind::U64,
        Some("u4") => NumberKind::U32,
        Some("u2") => NumberKind::U16,
        Some("u1" | "b1") => NumberKind::U8,
        _ => return other_element(code),
    };
    let big_endian = order == '>';
    if matches!(order, '<' | '>' | '|' | '=') {
        (Ok(Numbers { kind, big_endian }), Some(kind.size() as u64))
    } else {
        other_element(code)
    }
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
