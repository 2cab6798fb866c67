//! MATLAB's MAT-files of version 5 (which `save` calls v6 and v7), and of version 4.
//!
//! A file is a list of elements, each a type, a length and as many bytes; an array is an element of elements, and
//! so are structs and cell arrays of arrays. Each variable may be compressed. The file is walked twice: first for
//! the names, shapes and places of all arrays, then for the samples of those that are wanted, so that nothing
//! else is ever held in memory.

mod source;
mod version4;
mod walk;

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek};

use self::source::{Source, Variable, padding};
use self::walk::{ArrayLocation, MATRIX, Walk};
use super::array::read_channels;
use super::catalogue::{ArrayEntry, USUAL_COMPRESSION, read_arrays};
use super::error::Problem;
use super::fields::invalid;
use super::{Recording, RecordingOptions};

const HEADER_BYTES: u64 = 128;
const TAG_BYTES: u64 = 8;
/// The type of an element that is a compressed array.
const COMPRESSED: u32 = 15;

/// Reads a recording from a MAT-file.
pub(super) fn read(mut file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let mut head = Vec::new();
    file.by_ref().take(HEADER_BYTES).read_to_end(&mut head)?;
    file.rewind()?;
    // Its first four bytes state a type, and those of version 5 are letters.
    if version4::is_version4(&head) {
        return version4::read(&file, options);
    }
    let Walk { big_endian, arrays, .. } = walk(&file)?;
    let (mut entries, places): (Vec<ArrayEntry>, Vec<ArrayLocation>) = arrays.into_iter().unzip();
    mark_zero_twins(&file, big_endian, &mut entries, &places)?;
    let mut open: Option<(Variable, Source)> = None;
    let recording = read_arrays(&entries, options, false, |index, layout, numbers, channels| {
        let ArrayLocation { variable, offset, bytes } = places[index];
        let mut source = match open.take() {
            Some((same, source)) if same == variable && source.at <= offset => source,
            other => {
                other.map_or(Ok(()), |(_, done)| done.finish())?;
                Source::open(&file, variable, big_endian)?
            }
        };
        source.skip_to(offset)?;
        let present = if variable.compressed { bytes.min(USUAL_COMPRESSION * variable.bytes) } else { bytes };
        let samples = read_channels(&mut source, layout, numbers, channels, present)?;
        open = Some((variable, source));
        Ok(samples)
    })?;
    open.map_or(Ok(()), |(_, done)| done.finish())?;
    Ok(recording)
}

/// Arrays of one name that are looked at.
const MOST_TWINS: usize = 16;

/// Finds, among the arrays of one name, those that are 0 throughout, where another is not.
fn mark_zero_twins(
    file: &File,
    big_endian: bool,
    entries: &mut [ArrayEntry],
    places: &[ArrayLocation],
) -> io::Result<()> {
    let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, entry) in entries.iter().enumerate().filter(|(_, entry)| entry.numbers.is_ok()) {
        by_name.entry(&entry.name).or_default().push(index);
    }
    let mut zero = Vec::new();
    // Each is decompressed from its variable's start, and a user hardly chooses among more by number.
    for twins in by_name.values().filter(|twins| (2..=MOST_TWINS).contains(&twins.len())) {
        let zeros = twins.iter().map(|&twin| Ok((twin, is_zero(file, big_endian, places[twin])?)));
        let zeros: Vec<(usize, bool)> = zeros.collect::<io::Result<_>>()?;
        if zeros.iter().any(|(_, is_zero)| !is_zero) {
            zero.extend(zeros.into_iter().filter(|(_, is_zero)| *is_zero).map(|(twin, _)| twin));
        }
    }
    zero.into_iter().for_each(|twin| entries[twin].is_zero_twin = true);
    Ok(())
}

/// Whether an array's numbers are all 0, of which every byte is 0 then; read only as far as they are.
fn is_zero(
    file: &File,
    big_endian: bool,
    ArrayLocation { variable, offset, bytes }: ArrayLocation,
) -> io::Result<bool> {
    let mut source = Source::open(file, variable, big_endian)?;
    source.skip_to(offset)?;
    let mut block = [0; 1 << 12];
    let mut left = bytes;
    while left > 0 {
        let part = &mut block[..left.min(1 << 12) as usize];
        source.read_exact(part)?;
        if part.iter().any(|byte| *byte != 0) {
            return Ok(false);
        }
        left -= part.len() as u64;
    }
    Ok(bytes > 0)
}

/// Finds all arrays of the file.
fn walk(mut file: &File) -> Result<Walk, Problem> {
    let mut header = [0; HEADER_BYTES as usize];
    file.read_exact(&mut header)?;
    let big_endian = match header {
        [.., 0, 1, b'I', b'M'] => false,
        [.., 1, 0, b'M', b'I'] => true,
        _ => {
            return Err(Problem::broken(
                "its head is that of no version of MATLAB; it may be text or of another program",
            ));
        }
    };
    let mut walk = Walk::new(big_endian);
    let file_bytes = file.metadata()?.len();
    let mut at = HEADER_BYTES;
    while at < file_bytes {
        let broken = |problem: String| {
            Problem::Broken(format!("the variable at byte {at}{problem}; is the file cut off?"))
        };
        at += element(&mut walk, file, at, file_bytes - at).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => broken(" ends too early".to_owned()),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput | io::ErrorKind::Other => {
                broken(format!(": {error}"))
            }
            _ => Problem::Io(error),
        })?;
    }
    if walk.arrays.is_empty() {
        return Err(Problem::Refused("holds no variable".to_string()));
    }
    Ok(walk)
}

/// Finds the arrays of one variable, and gives the bytes of its element.
fn element(walk: &mut Walk, file: &File, at: u64, left: u64) -> io::Result<u64> {
    let whole = Variable { at, bytes: left, compressed: false };
    let tag = Source::open(file, whole, walk.big_endian)?.tag(left)?;
    let variable = Variable { at: at + TAG_BYTES, bytes: tag.bytes, compressed: tag.kind == COMPRESSED };
    let bytes = match tag.kind {
        _ if tag.inline.is_some() => return Err(invalid("it is no array")),
        MATRIX => {
            let mut source = Source::open(file, variable, walk.big_endian)?;
            walk.matrix(&mut source, variable, tag.bytes, None, 0)?;
            tag.bytes + padding(tag.bytes)
        }
        COMPRESSED => {
            let mut source = Source::open(file, variable, walk.big_endian)?;
            let inner = source.tag(source.end)?;
            if inner.kind != MATRIX || inner.inline.is_some() {
                return Err(invalid(format!(
                    "a compressed element of type {}; must be an array",
                    inner.kind
                )));
            }
            walk.matrix(&mut source, variable, inner.bytes, None, 0)?;
            tag.bytes
        }
        other => return Err(invalid(format!("an element of type {other}; must be an array"))),
    };
    Ok(TAG_BYTES + bytes)
}
