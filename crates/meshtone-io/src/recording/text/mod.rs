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
mod lvm;
mod numbers;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

use self::blocks::Blocks;
pub(super) use self::cells::{date_of, decoded};
use self::end::doubtful_end;
use self::head::{Head, Line};
use self::lvm::LvmHead;
use self::numbers::Numbers;
use super::assemble::assemble;
use super::error::Problem;
use super::rate::{self, StatedRate};
use super::selection::select;
use super::{Recording, RecordingOptions, memory_need};
use crate::memory;

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// Shortest cell with its separator.
const CELL_BYTES: usize = 2;

/// Reads a recording from text.
pub(super) fn read(mut file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let head = read_head(&mut file, options)?;
    let selection = select(&head.labels, options)?;
    file.seek(SeekFrom::Start(head.data_offset))?;
    // A little more than expected, as a column that grows is copied.
    let shortest_line = (CELL_BYTES * selection.wanted.len()) as f64;
    let rows = (1.01 * file_bytes as f64 / head.line_bytes.max(shortest_line)) as usize;
    let limit = memory::limit();
    let check = |rows: usize| memory_need::check(limit, options, &selection, |_| rows as u64, 0);
    check(rows)?;
    let mut numbers = Numbers::new(&head, &selection.wanted, rows + 1);
    let mut blocks = Blocks::new(&file);
    loop {
        let block = blocks.next()?;
        if block.is_empty() {
            break;
        }
        numbers.read(block)?;
        check(numbers.rows)?;
    }
    let last_line = numbers.line - 1;
    let samples = numbers.finish()?;
    let stated: Vec<StatedRate> = head.lvm.iter().map(|lvm| lvm.stated.clone()).collect();
    let mut recording = assemble(&head.labels, &selection, samples, &stated, options)?;
    if let (Some(lvm), None) = (&head.lvm, options.sampling_rate_hz) {
        recording.start_s = lvm.start_s;
    }
    let reads_last = selection.wanted.last().is_some_and(|column| column + 1 == head.labels.len());
    let doubtful = if reads_last { doubtful_end(&mut file, &head, last_line)? } else { None };
    // The first block tells the rate.
    let own_times = |column: usize| {
        file.seek(SeekFrom::Start(head.data_offset))?;
        let mut numbers = Numbers::new(&head, &[column], 0);
        numbers.read(Blocks::new(&file).next()?)?;
        Ok(numbers.finish()?.concat())
    };
    let own_time = rate::other_than_timed(&head.labels, &selection, options, own_times);
    recording.warnings.extend(doubtful.into_iter().chain(own_time));
    Ok(recording)
}

/// Reads the first lines.
fn read_head(file: &mut File, options: &RecordingOptions) -> Result<Head, Problem> {
    let mut blocks = Blocks::new(file.by_ref());
    let (mut offset, mut number) = (0_u64, 1_u64);
    loop {
        let block = blocks.next()?;
        let end = block.is_empty();
        if block.contains(&0) {
            return Err(Problem::broken("it is binary (a byte is 0)"));
        }
        let mark = if offset == 0 && block.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        offset += mark as u64;
        let mut lines = Vec::new();
        for text in block[mark..].split_inclusive(|byte| *byte == b'\n') {
            if number > options.text.skip_lines as u64 {
                lines.push(Line { number, offset, text });
            }
            number += 1;
            offset += text.len() as u64;
        }
        // Lines that are skipped or comments may fill a whole block.
        if end || lines.iter().any(|line| !head::is_passed(line.text)) {
            return Ok(match LvmHead::of(&lines)? {
                None => Head::of(&lines, &options.text)?,
                Some((lvm, length)) => {
                    let mut lines = lines.split_off(length);
                    // Rows have no cell for the remarks that the line of names announces.
                    if let Some(names) = lines.iter_mut().find(|line| !head::is_passed(line.text)) {
                        let text = names.text.trim_ascii_end();
                        names.text = text.strip_suffix(b"Comment").map_or(text, <[u8]>::trim_ascii_end);
                    }
                    let mut head = Head::of(&lines, &options.text)?;
                    lvm.complete(&mut head.labels);
                    Head { lvm: Some(lvm), ..head }
                }
            });
        }
    }
}
