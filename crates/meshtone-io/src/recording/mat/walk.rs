//! All arrays of a MAT-file, without their samples.

use std::io;

use super::super::catalogue::{ArrayEntry, MAX_ARRAYS, MAX_DEPTH};
use super::super::fields::invalid;
use super::super::number::{NumberKind, Numbers};
use super::source::{Source, Variable, padding};

/// The type of an element that is an array.
pub(super) const MATRIX: u32 = 14;
const MAX_DIMENSIONS: u64 = 32;
const MAX_NAME_BYTES: u64 = 4096;
/// Bytes of all field names of one struct.
const MAX_FIELD_BYTES: u64 = 1 << 20;
/// Bytes of the names of all arrays together.
const MAX_NAMES_BYTES: usize = 1 << 24;
/// Bytes that are not looked through before they are wanted.
const MIN_SAMPLES_BYTES: u64 = 1 << 16;
const COMPLEX: u32 = 0x0800;
/// MATLAB's classes of arrays, from class 1 on.
const CLASSES: [&str; 17] = [
    "cell", "struct", "object", "char", "sparse", "double", "single", "int8", "uint8", "int16", "uint16",
    "int32", "uint32", "int64", "uint64", "function", "opaque",
];
/// The types that numbers are stored in, with their codes: the smallest one that holds them, whatever the array's class.
const STORED: [(u32, NumberKind); 10] = [
    (1, NumberKind::I8),
    (2, NumberKind::U8),
    (3, NumberKind::I16),
    (4, NumberKind::U16),
    (5, NumberKind::I32),
    (6, NumberKind::U32),
    (7, NumberKind::F32),
    (9, NumberKind::F64),
    (12, NumberKind::I64),
    (13, NumberKind::U64),
];

/// Where an array's real numbers are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ArrayLocation {
    pub variable: Variable,
    /// Bytes of the variable before the numbers.
    pub offset: u64,
    pub bytes: u64,
}

/// Collects the arrays of a file.
pub(super) struct Walk {
    pub big_endian: bool,
    pub arrays: Vec<(ArrayEntry, ArrayLocation)>,
    names_bytes: usize,
}

impl Walk {
    pub(super) fn new(big_endian: bool) -> Walk {
        Walk { big_endian, arrays: Vec::new(), names_bytes: 0 }
    }

    /// Collects the arrays of one array element, which stands behind its tag.
    ///
    /// An element has flags, dimensions and a name, and then what its class prescribes: numbers, or other arrays, which are collected
    /// in the same way. An array inside another has the path to it as its name.
    ///
    /// # Arguments
    /// * `source` - the variable's elements
    /// * `bytes` - of the array element
    /// * `name` - path to it; its own name if none
    /// * `depth` - structs and cells around it
    pub(super) fn matrix(
        &mut self,
        source: &mut Source,
        variable: Variable,
        bytes: u64,
        name: Option<String>,
        depth: usize,
    ) -> io::Result<()> {
        if bytes == 0 {
            return Ok(());
        }
        if depth > MAX_DEPTH {
            return Err(invalid(format!("its structs and cells are nested more than {MAX_DEPTH} deep")));
        }
        let end = source.at + bytes;
        let flags = source.u32_data("array flags", 2, end)?.first().copied();
        let flags = flags.ok_or_else(|| invalid("an array without flags"))?;
        let class = flags & 0xff;
        let class = class
            .checked_sub(1)
            .and_then(|index| CLASSES.get(index as usize))
            .ok_or_else(|| invalid(format!("an array of class {class}, which does not exist")))?;
        let shape = if *class == "opaque" {
            vec![0]
        } else {
            let lengths = source.u32_data("array dimensions", MAX_DIMENSIONS, end)?;
            lengths.into_iter().map(u64::from).collect()
        };
        let own = source.data("an array name", MAX_NAME_BYTES, end)?;
        let name = name.unwrap_or_else(|| text(&own));
        // MATLAB keeps data of its own in a variable without a name.
        if !name.is_empty() {
            let inside = ArrayHeader { variable, end, name, depth };
            match *class {
                "cell" => self.cells(source, inside)?,
                "struct" => self.fields(source, inside, &shape)?,
                "object" => {
                    source.data("a class name", MAX_NAME_BYTES, end)?;
                    self.fields(source, inside, &shape)?;
                }
                "char" => self.push(inside, shape, "char", Err("text"), None, (0, 0))?,
                "sparse" => {
                    let what = "a sparse array; save it with full(…)";
                    self.push(inside, shape, "sparse", Err(what), None, (0, 0))?;
                }
                "function" | "opaque" => {
                    let what = "a MATLAB object (table, timetable, string, function or alike); save its columns as arrays, for \
                                instance with s = table2struct(t, 'ToScalar', true)";
                    self.push(inside, shape, "object", Err(what), None, (0, 0))?;
                }
                of_numbers => self.numbers(source, inside, shape, of_numbers, flags)?,
            }
        }
        leave(source, end, depth)
    }

    fn cells(&mut self, source: &mut Source, inside: ArrayHeader) -> io::Result<()> {
        let mut number = 1_u64;
        while source.at < inside.end {
            let name = format!("{}{{{number}}}", inside.name);
            self.child(source, &inside, name)?;
            number += 1;
        }
        Ok(())
    }

    fn fields(&mut self, source: &mut Source, inside: ArrayHeader, shape: &[u64]) -> io::Result<()> {
        let length = source.u32_data("a length of field names", 1, inside.end)?.first().copied();
        let length = length.filter(|length| (1..=MAX_NAME_BYTES as u32).contains(length));
        let length = length.ok_or_else(|| invalid("a struct whose field names have no possible length"))?;
        let names = source.data("field names", MAX_FIELD_BYTES, inside.end)?;
        let names: Vec<String> = names.chunks_exact(length as usize).map(text).collect();
        if names.is_empty() {
            return Ok(());
        }
        let single = shape.iter().all(|length| *length == 1);
        let mut number = 0;
        while source.at < inside.end {
            let (element, field) = (number / names.len() + 1, &names[number % names.len()]);
            let name = match single {
                true => format!("{}.{field}", inside.name),
                false => format!("{}({element}).{field}", inside.name),
            };
            self.child(source, &inside, name)?;
            number += 1;
        }
        Ok(())
    }

    fn child(&mut self, source: &mut Source, inside: &ArrayHeader, name: String) -> io::Result<()> {
        let tag = source.tag(inside.end)?;
        if tag.kind != MATRIX || tag.inline.is_some() {
            return Err(invalid(format!("{name} is an element of type {}; must be an array", tag.kind)));
        }
        self.matrix(source, inside.variable, tag.bytes, Some(name), inside.depth + 1)
    }

    fn numbers(
        &mut self,
        source: &mut Source,
        inside: ArrayHeader,
        shape: Vec<u64>,
        type_name: &'static str,
        flags: u32,
    ) -> io::Result<()> {
        let tag = source.tag(inside.end)?;
        let stored = STORED.iter().find(|(code, _)| *code == tag.kind);
        let (_, kind) = *stored.ok_or_else(|| {
            invalid(format!("{} holds elements of type {}; must be numbers", inside.name, tag.kind))
        })?;
        let count = shape.iter().fold(1_u128, |count, length| count.saturating_mul(u128::from(*length)));
        if count.saturating_mul(kind.size() as u128) != u128::from(tag.bytes) {
            return Err(invalid(format!(
                "{} announces {count} numbers, but has {} bytes of {}",
                inside.name,
                tag.bytes,
                kind.name()
            )));
        }
        let numbers = Numbers::plain(kind, self.big_endian);
        // Few bytes stand in the tag itself, the last four of its eight.
        let offset = source.at - if tag.inline.is_some() { 4 } else { 0 };
        let single = match (count, tag.inline) {
            (1, Some(data)) => Some(numbers.read_one(&mut &data[..])?),
            (1, None) => Some(numbers.read_one(source)?),
            _ => None,
        };
        let is_complex = flags & COMPLEX != 0;
        let numbers = if is_complex { Err("complex numbers") } else { Ok(numbers) };
        let single = single.filter(|_| !is_complex);
        if tag.inline.is_none() {
            let data_end = offset + tag.bytes;
            leave(source, (data_end + padding(tag.bytes)).min(inside.end), inside.depth)?;
        }
        self.push(inside, shape, type_name, numbers, single, (offset, tag.bytes))
    }

    fn push(
        &mut self,
        inside: ArrayHeader,
        shape: Vec<u64>,
        type_name: &str,
        numbers: Result<Numbers, &str>,
        single: Option<f64>,
        (offset, bytes): (u64, u64),
    ) -> io::Result<()> {
        self.names_bytes += inside.name.len();
        if self.arrays.len() >= MAX_ARRAYS || self.names_bytes > MAX_NAMES_BYTES {
            return Err(invalid(format!("it holds more than {MAX_ARRAYS} arrays, or very long names")));
        }
        let entry = ArrayEntry {
            name: inside.name,
            shape,
            first_runs_fastest: true,
            numbers: numbers.map_err(str::to_owned),
            type_name: type_name.to_string(),
            single,
            beside_bytes: 0,
            is_zero_twin: false,
        };
        self.arrays.push((entry, ArrayLocation { variable: inside.variable, offset, bytes }));
        Ok(())
    }
}

/// Goes to the end of an element. Behind the samples of a variable of its own comes nothing that is looked for, and they are
/// not decompressed only to be decompressed again.
fn leave(source: &mut Source, end: u64, depth: usize) -> io::Result<()> {
    let samples = depth == 0 && end.saturating_sub(source.at) > MIN_SAMPLES_BYTES;
    if samples { Ok(()) } else { source.skip_to(end) }
}

/// What is known about an array before its content.
struct ArrayHeader {
    variable: Variable,
    end: u64,
    name: String,
    depth: usize,
}

/// A name, up to its first zero.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}
