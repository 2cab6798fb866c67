//! Ways to read the first lines of a text file, and which of them does best.

use super::cells::{Cell, Dialect, clock_s, day_number, decoded};
use super::head::{Line, is_comment, label};
use crate::recording::label::Label;
use crate::recording::{DecimalSign, Separator, TextOptions};

/// Lines, the last of those, by which separator and decimal sign are judged.
const JUDGED: usize = 32;
/// What is written for a missing number.
const MISSING: [&str; 11] = ["-", "--", "nan", "n/a", "na", "#n/a", "null", "none", "error", "?", "inf"];

const QUOTED_COMMAS: Dialect = Dialect { separator: Some(Separator::Comma), decimal_comma: true };

/// One way to read the lines, and how well it does.
pub(super) struct Candidate {
    pub dialect: Dialect,
    pub columns: usize,
    pub trailing: bool,
    /// For each column, whether the judged lines hold numbers there.
    numeric: Vec<bool>,
    /// Nothing but numbers; names as many as columns; how many numbers.
    score: (bool, bool, usize),
}

/// The way that reads the lines best.
pub(super) fn best(content: &[Line], options: &TextOptions) -> Option<Candidate> {
    use Separator::{Bar, Comma, Semicolon, Tab, Whitespace};
    let separators = match options.separator {
        Some(separator) => vec![Some(separator), None],
        None => vec![Some(Tab), Some(Semicolon), Some(Comma), Some(Bar), Some(Whitespace), None],
    };
    let decimals: &[bool] = match options.decimal_sign {
        None => &[false, true],
        Some(DecimalSign::Point) => &[false],
        Some(DecimalSign::Comma) => &[true],
    };
    let dialects = separators.into_iter().flat_map(|separator| {
        decimals.iter().map(move |&decimal_comma| Dialect { separator, decimal_comma })
    });
    let candidates = dialects.filter_map(|dialect| Candidate::of(content, dialect));
    // The first of equals: the separators come in the order of their likelihood.
    candidates.reduce(|best, candidate| if candidate.score > best.score { candidate } else { best })
}

impl Candidate {
    fn of(content: &[Line], dialect: Dialect) -> Option<Candidate> {
        // Names and units are no numbers, if there may be such lines.
        let before = if content.len() > 3 { 2 } else { content.len() - 1 };
        let judged = &content[before.max(content.len().saturating_sub(JUDGED))..];
        let rows: Vec<Vec<&[u8]>> = judged.iter().map(|line| dialect.cells(line.text)).collect();
        let first = dialect.cells(content[0].text);
        // A comma that separates is no decimal sign, unless numbers are quoted.
        if dialect == QUOTED_COMMAS && !rows.iter().flatten().any(|cell| cell.contains(&b',')) {
            return None;
        }
        let all = usual_length(&rows, first.len());
        let ends_empty =
            |row: &Vec<&[u8]>| row.len() == all && row.last().is_some_and(|cell| cell.is_empty());
        let trailing = all > 1 && rows.iter().all(ends_empty) && (first.len() < all || ends_empty(&first));
        let columns = all - usize::from(trailing);
        let kinds = rows.iter().flat_map(|row| row.iter().take(columns)).map(|cell| dialect.cell(cell));
        let kinds: Vec<Cell> = kinds.collect();
        let numbers = kinds.iter().filter(|kind| matches!(kind, Cell::Number(_))).count();
        let is_all_numbers = !kinds.contains(&Cell::Text);
        let numeric = (0..columns).map(|column| {
            let cells = rows.iter().filter_map(|row| row.get(column));
            let numbers = cells.filter(|cell| dialect.is_number(cell)).count();
            2 * numbers >= rows.len()
        });
        let numeric: Vec<bool> = numeric.collect();
        let usable = if dialect.separator.is_none() { is_all_numbers } else { columns > 1 };
        let fits = first.len() == columns || (trailing && first.len() == all);
        let score = (is_all_numbers, fits, numbers);
        let is_usable = usable && numeric.contains(&true);
        is_usable.then_some(Candidate { dialect, columns, trailing, numeric, score })
    }

    /// The cells of a line, without the empty one behind a separator at the end.
    pub(super) fn cells<'l>(&self, line: &'l [u8]) -> Vec<&'l [u8]> {
        self.dialect.cells_of(line, self.columns, self.trailing)
    }

    /// Whether a line holds names: words, and at most whole numbers (of channels) behind the first.
    pub(super) fn is_header(&self, line: &[u8]) -> bool {
        let cells = self.cells(line);
        let is_numeric = |column: usize| *self.numeric.get(column).unwrap_or(&true);
        let judged = cells.iter().enumerate().filter(|(column, _)| is_numeric(*column));
        let judged: Vec<&[u8]> = judged.map(|(_, cell)| *cell).collect();
        let kinds: Vec<Cell> = judged.iter().map(|cell| self.dialect.cell(cell)).collect();
        let texts = kinds.iter().filter(|kind| **kind == Cell::Text).count();
        let is_number = |cell: &&&[u8]| self.dialect.is_number(cell);
        let numbers = judged.iter().filter(is_number).count();
        let only_counts = judged.iter().filter(is_number).all(|cell| cell.iter().all(u8::is_ascii_digit));
        // Names come in rows; a single cell that is nearly a number is a sample with a typing error in it.
        let is_sample = texts == 1 && judged.iter().any(|cell| self.dialect.is_spoiled_number(cell));
        let all_missing = judged.iter().all(|cell| is_missing(cell));
        only_counts
            && texts > 0
            && !is_sample
            && !all_missing
            && (texts > numbers || kinds.first() == Some(&Cell::Text))
    }

    /// Notes which columns hold times of the clock, and which dates, beside which such times stand.
    ///
    /// # Arguments
    /// * `data` - the first lines of numbers
    /// * `labels` - of the columns
    pub(super) fn note_clocks(&self, data: &[Line], labels: &mut [Label]) {
        let rows: Vec<Vec<&[u8]>> = data.iter().take(JUDGED).map(|line| self.cells(line.text)).collect();
        for (column, label) in labels.iter_mut().enumerate() {
            let all = |is: &dyn Fn(&[u8]) -> bool| {
                rows.iter().all(|row| row.get(column).is_some_and(|cell| is(cell)))
            };
            label.is_clock = all(&|cell| clock_s(cell).is_some());
            if all(&|cell| day_number(cell).is_some()) {
                label.not_numeric = Some("dates".to_owned());
            }
        }
    }

    /// Whether two columns may as well be one with a decimal comma.
    pub(super) fn may_be_one_number(&self, line: &[u8]) -> bool {
        let line = line.trim_ascii();
        let one = Dialect { separator: None, decimal_comma: true };
        let commas = self.dialect.separator == Some(Separator::Comma) && self.columns == 2;
        commas && line.contains(&b',') && one.is_number(line)
    }

    /// Whether the line behind the names holds units: no numbers, but 1 for no unit.
    pub(super) fn is_unit_row(&self, line: &[u8]) -> bool {
        let cells = self.cells(line);
        let is_number = |cell: &[u8]| self.dialect.is_number(cell) && !is_missing(cell);
        let says_something = |cell: &[u8]| !is_missing(cell) && self.dialect.cell(cell) == Cell::Text;
        cells.len() == self.columns
            && cells.iter().any(|cell| says_something(cell))
            && !cells.iter().any(|cell| self.dialect.is_spoiled_number(cell))
            && !cells.iter().any(|cell| is_number(cell) && *cell != b"1")
    }

    /// The names in a comment right above the numbers, as NumPy's `savetxt` writes them; numbers otherwise.
    pub(super) fn names_in_comment(&self, lines: &[Line], first: Line) -> Vec<Label> {
        let above = lines.iter().take_while(|line| line.number < first.number).last();
        let comment = above.filter(|line| is_comment(line.text)).map(|line| {
            let text = line.text.trim_ascii_start();
            &text[text.iter().take_while(|byte| matches!(byte, b'#' | b'%')).count()..]
        });
        let names = comment.map(|comment| self.cells(comment)).unwrap_or_default();
        let fits = names.len() == self.columns && self.columns > 1;
        let are_words = names.iter().all(|name| self.dialect.cell(name) == Cell::Text);
        if fits && are_words {
            names.iter().enumerate().map(|(index, name)| label(index, &decoded(name))).collect()
        } else {
            (1..=self.columns).map(|number| Label::numbered("column", number)).collect()
        }
    }
}

fn is_missing(cell: &[u8]) -> bool {
    cell.is_empty() || MISSING.contains(&decoded(cell).to_lowercase().as_str())
}

/// The length that most rows have; of equally frequent ones that of the first line, or the largest.
fn usual_length(rows: &[Vec<&[u8]>], first: usize) -> usize {
    let count = |length: usize| rows.iter().filter(|row| row.len() == length).count();
    let lengths = rows.iter().map(Vec::len);
    lengths.max_by_key(|length| (count(*length), *length == first, *length)).unwrap_or(1)
}
