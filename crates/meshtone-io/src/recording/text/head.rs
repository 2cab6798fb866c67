//! What the first lines of a text file say: how it is written, the columns, and where the numbers begin.

use super::candidate::best;
use super::cells::{Dialect, decoded};
use super::lvm::LvmHead;
use crate::recording::TextOptions;
use crate::recording::error::Problem;
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
    /// What the head of LabVIEW's states.
    pub lvm: Option<LvmHead>,
}

impl Head {
    /// Finds out what a file's first lines say.
    ///
    /// The dialect is chosen that reads most of the lines as numbers. The first line may then name the columns, and the second their
    /// units. Lines that a decimal comma would make one column as well are refused unless the options decide.
    ///
    /// # Arguments
    /// * `lines` - the first whole lines, blank ones and comments included
    /// * `options` - what is known about them
    pub(super) fn of(lines: &[Line], options: &TextOptions) -> Result<Head, Problem> {
        let no_samples = || Problem::Refused("holds no line of numbers".to_string());
        let content: Vec<Line> = lines.iter().filter(|line| !is_passed(line.text)).copied().collect();
        let content = &content[..content.len().min(LINES)];
        let first = content.first().ok_or_else(no_samples)?;
        let Some(candidate) = best(content, options) else {
            return Err(if content.len() <= 2 { no_samples() } else { Problem::broken(NO_COLUMNS) });
        };
        let named = candidate.is_header(first.text);
        let names = if named { candidate.cells(first.text) } else { Vec::new() };
        if named && names.len() != candidate.columns {
            return Err(Problem::Broken(format!(
                "line {} has {} cells, but the numbers below have {}; if the line is no line of names, skip it (option \
                 text.skip_lines) or begin it with #",
                first.number,
                names.len(),
                candidate.columns
            )));
        }
        let undecided = options.separator.is_none() && options.decimal_sign.is_none();
        if undecided && !named && content.iter().all(|line| candidate.may_be_one_number(line.text)) {
            let problem = "has lines such as `1,5`, which are two columns or one with a decimal comma; state \
                           which (option text.separator or text.decimal_sign)";
            return Err(Problem::Refused(problem.to_string()));
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
        let data_start = data.first().ok_or_else(no_samples)?;
        candidate.note_clocks(data, &mut labels);
        let bytes: usize = data.iter().map(|line| line.text.len()).sum();
        Ok(Head {
            dialect: candidate.dialect,
            labels,
            trailing: candidate.trailing,
            data_line: data_start.number,
            data_offset: data_start.offset,
            line_bytes: bytes as f64 / data.len() as f64,
            lvm: None,
        })
    }
}

/// The problem of lines none of which looks like numbers.
const NO_COLUMNS: &str = "its first lines hold no columns of numbers; if they are a head, skip them (option \
                          text.skip_lines) or begin them with #; if separator or decimal sign are unusual, \
                          state them (options text.separator and text.decimal_sign)";

/// Whether a line is passed over: blank, a comment, or Excel's `sep=;`.
pub(super) fn is_passed(line: &[u8]) -> bool {
    let line = line.trim_ascii();
    line.is_empty() || is_comment(line) || (line.len() <= 5 && line.starts_with(b"sep="))
}

pub(super) fn is_comment(line: &[u8]) -> bool {
    matches!(line.trim_ascii_start().first(), Some(b'#' | b'%'))
}

pub(super) fn label(index: usize, name: &str) -> Label {
    if name.trim().is_empty() { Label::numbered("column", index + 1) } else { Label::from_header(name) }
}
