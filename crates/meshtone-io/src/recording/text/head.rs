//! What the first lines of a text file say: how it is written, the columns, and where the numbers begin.

use super::candidate::best;
use super::cells::{Dialect, decoded};
use crate::recording::TextOptions;
use crate::recording::label::{Label, unit_of_cell};

/// Lines that are looked at.
const LINES: usize = 200;
/// A line of the head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Line<'h> {
    /// Counted from 1.
    pub number: u64,
    /// Bytes of the file before it.
    pub offset: u64,
    pub text: &'h [u8],
}

/// What the first lines say.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Head {
    pub dialect: Dialect,
    pub labels: Vec<Label>,
    /// Whether lines may end in a separator behind the last column.
    pub trailing: bool,
    /// Line and offset of the first line of numbers.
    pub data_line: u64,
    pub data_offset: u64,
    /// Mean bytes of a line of numbers.
    pub line_bytes: f64,
}

/// Why the first lines do not tell.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum HeadError {
    /// There are names, but no numbers.
    NoSamples,
    /// A comma may separate, or be the decimal sign.
    Ambiguous,
    /// No line looks like numbers.
    NoNumbers,
    /// The line of names has not as many cells as the numbers.
    Ragged { line: u64, found: usize, expected: usize },
}

impl Head {
    /// Finds out what a file's first lines say.
    ///
    /// # Arguments
    /// * `lines` - the first whole lines, blank ones and comments included
    /// * `options` - what is known about them
    pub(super) fn of(lines: &[Line], options: &TextOptions) -> Result<Head, HeadError> {
        let content: Vec<Line> = lines.iter().filter(|line| !is_passed(line.text)).copied().collect();
        let content = &content[..content.len().min(LINES)];
        let Some(first) = content.first() else { return Err(HeadError::NoSamples) };
        let Some(candidate) = best(content, options) else {
            return Err(if content.len() <= 2 { HeadError::NoSamples } else { HeadError::NoNumbers });
        };
        let named = candidate.is_header(first.text);
        let names = if named { candidate.cells(first.text) } else { Vec::new() };
        if named && names.len() != candidate.columns {
            let (found, expected) = (names.len(), candidate.columns);
            return Err(HeadError::Ragged { line: first.number, found, expected });
        }
        let undecided = options.separator.is_none() && options.decimal_sign.is_none();
        if undecided && !named && content.iter().all(|line| candidate.may_be_one_number(line.text)) {
            return Err(HeadError::Ambiguous);
        }
        let mut labels = if named {
            names.iter().enumerate().map(|(index, name)| label(index, &decoded(name))).collect()
        } else {
            candidate.names_in_comment(lines, *first)
        };
        let units = content.get(1).filter(|line| named && candidate.is_unit_row(line.text));
        if let Some(units) = units {
            for (label, cell) in labels.iter_mut().zip(candidate.cells(units.text)) {
                label.unit = unit_of_cell(&decoded(cell)).or(label.unit.take());
            }
        }
        let data = &content[usize::from(named) + usize::from(units.is_some())..];
        let Some(data_start) = data.first() else { return Err(HeadError::NoSamples) };
        let bytes: usize = data.iter().map(|line| line.text.len()).sum();
        Ok(Head {
            dialect: candidate.dialect,
            labels,
            trailing: candidate.trailing,
            data_line: data_start.number,
            data_offset: data_start.offset,
            line_bytes: bytes as f64 / data.len() as f64,
        })
    }
}

/// Whether a line is passed over: blank, or a comment.
pub(super) fn is_passed(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line.is_empty() || is_comment(line)
}

pub(super) fn is_comment(line: &[u8]) -> bool {
    matches!(line.trim_ascii_start().first(), Some(b'#' | b'%'))
}

pub(super) fn label(index: usize, name: &str) -> Label {
    if name.trim().is_empty() { Label::numbered("column", index + 1) } else { Label::from_header(name) }
}
