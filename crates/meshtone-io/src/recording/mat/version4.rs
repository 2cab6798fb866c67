//! MATLAB's MAT-files of version 4, which older recorders and programs still write: each variable a head, a name and its numbers.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use crate::recording::array::read_channels;
use crate::recording::catalogue::{ArrayEntry, MAX_ARRAYS, read_arrays};
use crate::recording::error::Problem;
use crate::recording::fields::{Fields, block};
use crate::recording::number::{NumberKind, Numbers};
use crate::recording::{Recording, RecordingOptions};

/// Bytes of a head: type, rows, columns, whether there is an imaginary part, and the length of the name.
const HEAD_BYTES: u64 = 20;
/// Longest name, with the zero behind it.
const LONGEST_NAME: u32 = 1024;
const KINDS: [NumberKind; 6] =
    [NumberKind::F64, NumberKind::F32, NumberKind::I32, NumberKind::I16, NumberKind::U16, NumberKind::U8];

/// The head of a variable in a file that may be of version 4: how its numbers stand, what it holds in place of a matrix, and its rows, columns,
/// imaginary parts and bytes of the name.
fn variable(head: &[u8]) -> Option<(Numbers, Option<&'static str>, [u32; 4])> {
    let kind: [u8; 4] = head.get(..4)?.try_into().ok()?;
    let (little, big) = (u32::from_le_bytes(kind), u32::from_be_bytes(kind));
    let (big_endian, kind) = if little < 1000 { (false, little) } else { (true, big.checked_sub(1000)?) };
    let what = match kind % 10 {
        0 => None,
        1 => Some("text"),
        2 => Some("a sparse array"),
        _ => return None,
    };
    let numbers = Numbers::plain(*KINDS.get((kind / 10) as usize)?, big_endian);
    let mut fields = Fields { left: &head[4..], big_endian };
    let mut next = || fields.u32().ok();
    let [rows, columns, imaginary, name_bytes] = [next()?, next()?, next()?, next()?];
    let is_possible = imaginary <= 1 && (1..=LONGEST_NAME).contains(&name_bytes);
    is_possible.then_some((numbers, what, [rows, columns, imaginary, name_bytes]))
}

/// Whether a file begins as those of version 4 do.
pub(super) fn is_version4(head: &[u8]) -> bool {
    variable(head).is_some()
}

/// Reads a recording from a file of version 4.
pub(super) fn read(mut file: &File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let (mut entries, mut places) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < file_bytes {
        let head = block(file, at, HEAD_BYTES)?;
        let broken = || Problem::Broken(format!("the variable at byte {at} is none; is the file cut off?"));
        let (numbers, what, [rows, columns, imaginary, length]) =
            variable(&head).filter(|_| entries.len() < MAX_ARRAYS).ok_or_else(broken)?;
        let kind = numbers.kind;
        let name = block(file, at + HEAD_BYTES, length.into())?;
        let name =
            String::from_utf8_lossy(name.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned();
        let start = at + HEAD_BYTES + u64::from(length);
        let bytes = u64::from(rows) * u64::from(columns);
        let bytes = bytes.checked_mul(kind.size() as u64 * (1 + u64::from(imaginary))).ok_or_else(broken)?;
        at = start.checked_add(bytes).filter(|end| *end <= file_bytes).ok_or_else(broken)?;
        let single = if rows == 1 && columns == 1 && what.is_none() {
            Some(numbers.read_one(&mut &block(file, start, kind.size() as u64)?[..])?)
        } else {
            None
        };
        let what = if imaginary == 1 { Some("complex numbers") } else { what };
        entries.push(ArrayEntry {
            name,
            shape: vec![rows.into(), columns.into()],
            first_runs_fastest: true,
            type_name: what.unwrap_or(kind.name()).to_owned(),
            numbers: what.map_or(Ok(numbers), |what| Err(what.to_owned())),
            single,
            beside_bytes: 0,
            is_zero_twin: false,
        });
        places.push(start);
    }
    read_arrays(&entries, options, false, |index, layout, numbers, channels| {
        file.seek(SeekFrom::Start(places[index]))?;
        Ok(read_channels(&mut file.by_ref(), layout, numbers, channels, file_bytes)?)
    })
}
