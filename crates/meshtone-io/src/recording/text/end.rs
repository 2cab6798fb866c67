//! Whether a text file may end within its last number.
//!
//! A file that is cut off there still has a number in every cell. It has no end of the last line, but neither have the files of
//! some programs; those write all numbers of a column alike, or end a line in another way.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use super::cells::decoded;
use super::head::{Head, is_passed};
use crate::recording::RecordingWarning;

/// Bytes of the file's end that are looked at.
const LOOKED_AT: u64 = 1 << 14;
/// Lines above the last one that it is compared with.
const COMPARED: usize = 32;

/// The warning that a file's last number may be cut off.
///
/// # Arguments
/// * `file` - the file
/// * `head` - what its first lines say
/// * `last_line` - number of its last line
pub(super) fn doubtful_end(
    file: &mut File,
    head: &Head,
    last_line: u64,
) -> io::Result<Option<RecordingWarning>> {
    let bytes = file.metadata()?.len();
    file.seek(SeekFrom::Start(bytes.saturating_sub(LOOKED_AT).max(head.data_offset)))?;
    let mut end = Vec::new();
    file.take(LOOKED_AT).read_to_end(&mut end)?;
    let mut lines = end.rsplit(|byte| *byte == b'\n');
    let last = lines.next().unwrap_or_default();
    let within_a_number =
        last.last().is_some_and(|byte| byte.is_ascii_alphanumeric() || b".,".contains(byte));
    let Some(cell) = last_cell(last, head).filter(|_| within_a_number && !is_passed(last)) else {
        return Ok(None);
    };
    // The first line that was looked at may have lost its beginning, but not its end.
    let above = lines.filter(|line| !is_passed(line)).take(COMPARED);
    let shapes: Vec<Option<Vec<u8>>> =
        above.map(|line| last_cell(line, head).map(|cell| shape(cell, head))).collect();
    let own = Some(shape(cell, head));
    if !shapes.is_empty() && shapes.iter().all(|shape| *shape == own) {
        return Ok(None);
    }
    let column = head.labels.last().map(|label| label.raw.clone()).unwrap_or_default();
    Ok(Some(RecordingWarning::MayBeCut { line: last_line, column, text: decoded(cell) }))
}

/// The last cell of a line; none behind a separator that ends the line.
fn last_cell<'l>(line: &'l [u8], head: &Head) -> Option<&'l [u8]> {
    head.dialect.cells(line).pop().filter(|cell| !cell.is_empty())
}

/// How a number is written: what stands behind its decimal sign, or all of it, with any digit and any sign alike.
fn shape(cell: &[u8], head: &Head) -> Vec<u8> {
    let sign = if head.dialect.decimal_comma { b',' } else { b'.' };
    let from = cell.iter().position(|byte| *byte == sign).unwrap_or(0);
    let behind = cell[from..].iter().filter(|byte| from > 0 || !b"+-".contains(byte));
    let alike = |byte: &u8| match byte {
        b'0'..=b'9' => b'0',
        b'+' => b'-',
        other => other.to_ascii_lowercase(),
    };
    behind.map(alike).collect()
}
