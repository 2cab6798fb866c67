//! The numbers of a text file.
//!
//! A line of plain numbers is read in one pass, without looking for its cells first. Where that meets anything
//! else (quotes, an empty cell, text), the line is read again, cell by cell, and an error names the place.

use super::cells::{Cell, Dialect, byte_of, decoded};
use super::head::{Head, is_passed};
use crate::recording::Separator;
use crate::recording::error::{Problem, column_words};

/// Stands for a point where the comma is the decimal sign, so that a point is not taken for one.
const NOT_DECIMAL: u8 = 1;

/// Reads lines of numbers.
pub(super) struct Numbers<'h> {
    head: &'h Head,
    /// For each column, where its samples go, if it is read.
    slots: Vec<Option<usize>>,
    samples: Vec<Vec<f64>>,
    /// The next line, counted from 1.
    pub(super) line: u64,
    /// Lines of numbers that were read.
    pub(super) rows: usize,
    /// The first blank line and the rows above it, where a blank line may be a missing sample.
    blank: Option<(u64, usize)>,
}

impl<'h> Numbers<'h> {
    /// # Arguments
    /// * `head` - what its first lines say
    /// * `wanted` - the columns that are read, rising
    /// * `rows` - lines for which memory is taken at once
    pub(super) fn new(head: &'h Head, wanted: &[usize], rows: usize) -> Numbers<'h> {
        let mut slots = vec![None; head.labels.len()];
        wanted.iter().enumerate().for_each(|(slot, column)| slots[*column] = Some(slot));
        let samples = wanted.iter().map(|_| Vec::with_capacity(rows)).collect();
        Numbers { head, slots, samples, line: head.data_line, rows: 0, blank: None }
    }

    /// Reads whole lines; the block is not the same afterwards.
    pub(super) fn read(&mut self, block: &mut [u8]) -> Result<(), Problem> {
        if self.head.dialect.decimal_comma {
            swap(block, [(b'.', NOT_DECIMAL), (b',', b'.')]);
        }
        let mut at = 0;
        while at < block.len() {
            match self.plain_line(block, at) {
                Some(next) => {
                    at = next;
                    self.rows += 1;
                }
                None => {
                    self.samples.iter_mut().for_each(|column| column.truncate(self.rows));
                    let end = block[at..].iter().position(|byte| *byte == b'\n');
                    let end = end.map_or(block.len(), |end| at + end);
                    let mut line = block[at..end].to_vec();
                    if self.head.dialect.decimal_comma {
                        swap(&mut line, [(b'.', b','), (NOT_DECIMAL, b'.')]);
                    }
                    self.any_line(&line)?;
                    at = end + 1;
                }
            }
            self.line += 1;
        }
        Ok(())
    }

    /// The samples of each column, after the last line.
    pub(super) fn finish(self) -> Result<Vec<Vec<f64>>, Problem> {
        match self.blank {
            // In a single column, a blank line is an empty cell, if it is not below all numbers.
            Some((line, rows)) if self.rows > rows && self.slots == [Some(0)] => {
                Err(Problem::gap(format!("line {line}"), &self.head.labels[0].raw, "empty"))
            }
            _ => Ok(self.samples),
        }
    }

    /// Reads a line of plain numbers from its first byte on; gives where the next line begins. `None` if it is
    /// anything else.
    ///
    /// The line is not split into cells first, which would take as long as reading the numbers. A column that is not read is skipped
    /// up to its separator. Numbers may have been pushed where `None` is given, and the caller removes them.
    #[inline]
    fn plain_line(&mut self, block: &[u8], mut at: usize) -> Option<usize> {
        let (separator, blanks) = match self.head.dialect.separator {
            // A comma that separates would have become a point.
            Some(Separator::Comma) if self.head.dialect.decimal_comma => return None,
            Some(Separator::Whitespace) | None => (None, true),
            Some(separator) => (Some(byte_of(separator)), separator != Separator::Tab),
        };
        let skip_blanks = |mut at: usize| {
            while matches!(block.get(at), Some(b' ' | b'\r')) || (blanks && block.get(at) == Some(&b'\t')) {
                at += 1;
            }
            at
        };
        let last = self.slots.len() - 1;
        for (column, slot) in self.slots.iter().enumerate() {
            at = skip_blanks(at);
            if let Some(slot) = slot {
                let (number, length) = fast_float2::parse_partial::<f64, _>(&block[at..]).ok()?;
                if !number.is_finite() {
                    return None;
                }
                self.samples[*slot].push(number);
                at += length;
            } else {
                let ends = |byte: &u8| match separator {
                    Some(separator) => *byte == separator || *byte == b'\n',
                    None => byte.is_ascii_whitespace(),
                };
                let length = block[at..].iter().position(ends)?;
                // Only a line that begins with a comment sign is a comment.
                if block[at..at + length].contains(&b'"')
                    || (column == 0 && is_passed(&block[at..at + length]))
                {
                    return None;
                }
                at += length;
            }
            let behind = skip_blanks(at);
            if column < last {
                let separated =
                    separator.map_or(behind > at, |separator| block.get(behind) == Some(&separator));
                if !separated {
                    return None;
                }
                at = behind + usize::from(separator.is_some());
            } else {
                at = behind;
            }
        }
        if self.head.trailing && block.get(at).copied() == separator {
            at = skip_blanks(at + 1);
        }
        match block.get(at) {
            None => Some(at),
            Some(b'\n') => Some(at + 1),
            Some(_) => None,
        }
    }

    /// Reads a line cell by cell.
    fn any_line(&mut self, line: &[u8]) -> Result<(), Problem> {
        if is_passed(line) {
            let may_be_missing = self.head.labels.len() == 1 && line.trim_ascii().is_empty();
            if may_be_missing && self.blank.is_none() {
                self.blank = Some((self.line, self.rows));
            }
            return Ok(());
        }
        let Head { dialect, labels, trailing, .. } = self.head;
        let cells = dialect.cells_of(line, labels.len(), *trailing);
        if cells.len() != labels.len() {
            return Err(Problem::Refused(format!(
                "line {} has {} cells, but the lines above it have {}; mend or remove it (if the file ends there, it is cut off)",
                self.line,
                cells.len(),
                labels.len()
            )));
        }
        for ((cell, slot), label) in cells.iter().zip(&self.slots).zip(labels) {
            let Some(slot) = slot else { continue };
            let what = match dialect.cell(cell) {
                Cell::Number(number) if number.is_finite() => {
                    self.samples[*slot].push(number);
                    continue;
                }
                Cell::Number(number) if number.is_nan() => "NaN",
                Cell::Number(_) => "infinite",
                Cell::Empty => "empty",
                Cell::Text => return Err(self.not_a_number(&label.raw, cell, dialect)),
            };
            return Err(Problem::gap(format!("line {}", self.line), &label.raw, what));
        }
        self.rows += 1;
        Ok(())
    }

    fn not_a_number(&self, column: &str, cell: &[u8], dialect: &Dialect) -> Problem {
        let text: String = decoded(cell).chars().take(40).collect();
        let (is, other) = if dialect.decimal_comma { ("comma", "point") } else { ("point", "comma") };
        let other_dialect = Dialect { decimal_comma: !dialect.decimal_comma, ..*dialect };
        let help = if matches!(other_dialect.cell(cell), Cell::Number(_)) {
            format!(
                "the first lines are read with the decimal {is}; if it is the {other}, say so (option text.decimal_sign)"
            )
        } else if text.contains(':') {
            "times are read as hh:mm:ss, with a date as 2026-11-29 or 29.11.2026: state the sampling rate (option sampling_rate_hz)".to_string()
        } else if self.rows == 0 {
            "if the line belongs to the file's head, skip it (option text.skip_lines) or begin it with #; if the column \
             holds no numbers, choose others (option channels)"
                .to_string()
        } else {
            "mend it, or choose other columns (option channels)".to_string()
        };
        Problem::Refused(format!(
            "line {}, {}: `{text}` is not a number; {help}",
            self.line,
            column_words(column)
        ))
    }
}

/// Replaces bytes: the first of each pair by the second.
fn swap(block: &mut [u8], [(a, new_a), (b, new_b)]: [(u8, u8); 2]) {
    for byte in block {
        *byte = match *byte {
            old if old == a => new_a,
            old if old == b => new_b,
            other => other,
        };
    }
}
