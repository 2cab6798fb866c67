//! Numbers as text: CSV, TSV and alike.
//!
//! Separator, decimal sign, names and units are found out from the first lines. Then the file is read in blocks,
//! numbers straight out of the bytes: splitting into records first, as the `csv` crate does, takes as long as the
//! numbers themselves.

mod blocks;
mod candidate;
mod cells;
mod end;
mod head;
mod numbers;

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use self::blocks::Blocks;
use self::end::doubtful_end;
use self::head::{Head, HeadError, Line};
use self::numbers::Numbers;
use super::assemble::{Parts, assemble};
use super::error::{broken, read_failed, unreadable};
use super::selection::select;
use super::{ReadRecordingError, Recording, RecordingOptions, memory_need};
use crate::memory;

const FORMAT: &str = "text";
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Shortest cell with its separator.
const CELL_BYTES: usize = 2;

/// Reads a recording from text.
pub(super) fn read(
    path: &Path,
    mut file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let failed = |error: io::Error| read_failed(path, FORMAT, error);
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let head = read_head(path, &mut file, options)?;
    let selection = select(path, &head.labels, options)?;
    let wanted = selection.wanted();
    file.seek(SeekFrom::Start(head.data_offset)).map_err(failed)?;
    // A little more than expected, as a column that grows is copied.
    let rows = 1.01 * file_bytes as f64 / head.line_bytes.max((CELL_BYTES * wanted.len()) as f64);
    // Asked for once, before anything of it is taken.
    let limit = memory::limit();
    let check = |rows: u64| {
        memory_need::check_within(limit, path, options, &selection, wanted.iter().map(|_| rows), 0)
    };
    check(rows as u64)?;
    let mut numbers = Numbers::new(path, &head, &wanted, rows as usize + 1);
    let mut blocks = Blocks::new(&file);
    loop {
        let block = blocks.next().map_err(failed)?;
        if block.is_empty() {
            break;
        }
        numbers.read(block)?;
        check(numbers.rows() as u64)?;
    }
    let last_line = numbers.last_line();
    let samples = numbers.finish()?;
    let parts = Parts { path, labels: &head.labels, selection: &selection, samples, stated: &[] };
    let recording = assemble(parts, options)?;
    let reads_last = wanted.last().is_some_and(|column| column + 1 == head.labels.len());
    let doubtful = if reads_last { doubtful_end(&mut file, &head, last_line).map_err(failed)? } else { None };
    Ok(Recording { warnings: doubtful.into_iter().collect(), ..recording })
}

/// Reads the first lines.
fn read_head(path: &Path, file: &mut File, options: &RecordingOptions) -> Result<Head, ReadRecordingError> {
    let mut blocks = Blocks::new(file.by_ref());
    let (mut offset, mut number) = (0_u64, 1_u64);
    loop {
        let block = blocks.next().map_err(|error| read_failed(path, FORMAT, error))?;
        let end = block.is_empty();
        if block.contains(&0) {
            return Err(broken(path, FORMAT, "it is binary (a byte is 0)"));
        }
        let block_bytes = block.len() as u64;
        let mark = if offset == 0 && block.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        let mut lines = Vec::new();
        let mut before = mark;
        for text in block[mark..].split_inclusive(|byte| *byte == b'\n') {
            if number > options.text.skip_lines as u64 {
                lines.push(Line { number, offset: offset + before as u64, text });
            }
            number += 1;
            before += text.len();
        }
        offset += block_bytes;
        // Lines that are skipped or comments may fill a whole block.
        let content = lines.iter().any(|line| !head::is_passed(line.text));
        if content || end {
            return Head::of(&lines, &options.text).map_err(|error| refuse(path, error));
        }
    }
}

fn refuse(path: &Path, error: HeadError) -> ReadRecordingError {
    let path = path.to_path_buf();
    match error {
        HeadError::NoSamples => {
            ReadRecordingError::Empty { path, problem: "holds no line of numbers".to_string() }
        }
        HeadError::Ambiguous => ReadRecordingError::Ambiguous {
            path,
            problem: "has lines such as `1,5`, which are two columns or one with a decimal comma; say which (option \
                      text.separator or text.decimal_sign)"
                .to_string(),
            present: Vec::new(),
        },
        HeadError::NoNumbers => {
            let problem = "its first lines hold no columns of numbers; if they are a head, skip them (option text.skip_lines) \
                           or begin them with #; if separator or decimal sign are unusual, say them (options \
                           text.separator and text.decimal_sign)";
            ReadRecordingError::Broken { path, format: FORMAT, problem: problem.to_string() }
        }
        HeadError::Ragged { line, found, expected } => {
            let problem = format!(
                "line {line} has {found} cells, but the numbers below have {expected}; if the line is no line of names, \
                 skip it (option text.skip_lines) or begin it with #"
            );
            ReadRecordingError::Broken { path, format: FORMAT, problem }
        }
    }
}
