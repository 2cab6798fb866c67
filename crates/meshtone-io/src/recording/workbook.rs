//! Tables of Excel's (.xlsx), as text: the sheet with the numbers, its cells between tabulators.

use std::collections::{HashMap, HashSet};
use std::fs::File;
use std::io::{BufReader, Read, Seek};

use quick_xml::events::{BytesStart, Event};
use zip::ZipArchive;

use super::error::{Problem, names};
use super::packed::Unpacked;
use super::text::date_of;

const STRINGS: &str = "xl/sharedStrings.xml";
const STYLES: &str = "xl/styles.xml";
const SHEETS: &str = "xl/worksheets/";
/// Columns of a sheet, and texts of a file, beyond which a file is none that recordings come in.
const MOST_COLUMNS: usize = 16_384;
const MOST_TEXTS: usize = 1 << 20;
/// Rows of a sheet in Excel.
const MOST_ROWS: usize = 1 << 20;
/// Times as many numbers as any other sheet has that the sheet of a recording has.
const MANY: usize = 10;
/// Days from Excel's first one to the first of 1970.
const EXCEL_TO_1970: i64 = 25_569;
/// Days of Excel's calendar, which ends with the year 9999.
const MOST_DAYS: f64 = 2_958_466.0;

/// The sheet with the numbers, as a file of text.
///
/// # Arguments
/// * `archive` - the file
/// * `most` - (bytes) what a part of it may become
pub(super) fn sheet(archive: &mut ZipArchive<impl Read + Seek>, most: u64) -> Result<File, Problem> {
    let all: Vec<String> = archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
    let mut styles = Styles::default();
    let mut texts = Texts::default();
    for (name, part) in [(STRINGS, &mut texts as &mut dyn Part), (STYLES, &mut styles)] {
        if all.iter().any(|other| other == name) {
            walk(archive.by_name(name)?, most, part)?;
        }
    }
    let mut sheets = Vec::new();
    let mut left = most;
    for name in all.iter().filter(|name| name.starts_with(SHEETS) && name.ends_with(".xml")) {
        let mut sheet = Sheet::new(&texts.all, &styles.shown, Unpacked::new(left)?);
        walk(archive.by_name(name)?, most, &mut sheet)?;
        left = sheet.to.left;
        sheets.push((sheet.numbers, name.clone(), sheet.to));
    }
    sheets.sort_by_key(|(numbers, ..)| *numbers);
    let found = sheets.pop().filter(|(numbers, ..)| *numbers > 0);
    let (numbers, name, sheet) = found.ok_or_else(|| {
        Problem::convert("an Office document without a sheet of numbers", "save its table as CSV")
    })?;
    if sheets.last().is_some_and(|(of_other, ..)| of_other * MANY > numbers) {
        let named: Vec<String> = sheets.into_iter().map(|(_, other, _)| other).chain([name]).collect();
        return Err(Problem::Refused(format!(
            "is a workbook of which several sheets hold numbers ({}); save the one of the recording as CSV",
            names(&named)
        )));
    }
    sheet.finish()
}

/// Takes what a part of the file says.
trait Part {
    fn start(&mut self, name: &[u8], element: &BytesStart) -> Result<(), Problem>;
    fn text(&mut self, text: &str);
    fn end(&mut self, name: &[u8]) -> Result<(), Problem>;
}

fn walk(from: impl Read, most: u64, to: &mut dyn Part) -> Result<(), Problem> {
    let mut reader = quick_xml::Reader::from_reader(BufReader::new(from.take(most)));
    reader.config_mut().expand_empty_elements = true;
    let mut buffer = Vec::new();
    let mut depth = 0_usize;
    loop {
        buffer.clear();
        match reader.read_event_into(&mut buffer).map_err(Problem::broken)? {
            Event::Start(element) => {
                depth += 1;
                to.start(element.local_name().as_ref(), &element)?;
            }
            Event::Text(text) => to.text(&text.decode().map_err(Problem::broken)?),
            // Of the names of characters only these matter in those of columns and units.
            Event::GeneralRef(name) => {
                let letter = name.resolve_char_ref().map_err(Problem::broken)?;
                to.text(&letter.map_or("&".to_owned(), String::from));
            }
            Event::End(element) => {
                depth = depth.saturating_sub(1);
                to.end(element.local_name().as_ref())?;
            }
            Event::Eof if depth == 0 => return Ok(()),
            Event::Eof => {
                return Err(Problem::broken(
                    "a part of it ends too early, or is far larger unpacked; save it as CSV",
                ));
            }
            _ => {}
        }
    }
}

fn attribute(element: &BytesStart, name: &str) -> Option<String> {
    let found = element.try_get_attribute(name).ok()??;
    Some(String::from_utf8_lossy(&found.value).into_owned())
}

/// The texts that cells refer to by number.
#[derive(Default)]
struct Texts {
    all: Vec<String>,
    is_within: bool,
}

impl Part for Texts {
    fn start(&mut self, name: &[u8], _: &BytesStart) -> Result<(), Problem> {
        if name == b"si" {
            if self.all.len() >= MOST_TEXTS {
                return Err(Problem::Refused(format!(
                    "is a workbook of more than {MOST_TEXTS} texts; save it as CSV"
                )));
            }
            self.all.push(String::new());
        }
        self.is_within = name == b"t";
        Ok(())
    }

    fn text(&mut self, text: &str) {
        if let (Some(last), true) = (self.all.last_mut(), self.is_within) {
            last.push_str(text);
        }
    }

    fn end(&mut self, _: &[u8]) -> Result<(), Problem> {
        self.is_within = false;
        Ok(())
    }
}

/// How a style of cells shows a number.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shown {
    Plain,
    Percent,
    /// A number of days as a date, or as a time with or without one.
    Date,
    Time,
}

/// How the styles of cells show numbers.
#[derive(Default)]
struct Styles {
    of_formats: HashMap<String, Shown>,
    shown: Vec<Shown>,
    is_within: bool,
}

impl Part for Styles {
    fn start(&mut self, name: &[u8], element: &BytesStart) -> Result<(), Problem> {
        let id = attribute(element, "numFmtId");
        match name {
            b"numFmt" => {
                let shown = attribute(element, "formatCode").map_or(Shown::Plain, |code| shown_by(&code));
                self.of_formats.extend(id.map(|id| (id, shown)));
            }
            b"cellXfs" => self.is_within = true,
            b"xf" if self.is_within => {
                let id = id.unwrap_or_default();
                self.shown.push(match id.parse() {
                    Ok(9 | 10) => Shown::Percent,
                    Ok(14..=17) => Shown::Date,
                    Ok(18..=22 | 45..=47) => Shown::Time,
                    _ => self.of_formats.get(&id).copied().unwrap_or(Shown::Plain),
                });
            }
            _ => {}
        }
        Ok(())
    }

    fn text(&mut self, _: &str) {}

    fn end(&mut self, name: &[u8]) -> Result<(), Problem> {
        self.is_within &= name != b"cellXfs";
        Ok(())
    }
}

/// What a format such as `hh:mm:ss.000` or `[h]:mm` shows; words in quotes, letters behind `\`, and colours in brackets, say nothing of it.
fn shown_by(code: &str) -> Shown {
    let mut plain = String::new();
    let code = code.replace("&quot;", "\"");
    let mut letters = code.chars();
    while let Some(letter) = letters.next() {
        match letter {
            // Shown as it stands, as wide a gap, or filled with.
            '\\' | '_' | '*' => {
                letters.next();
            }
            _ => plain.push(letter),
        }
    }
    let outside: String = plain.split('"').step_by(2).collect();
    let bare: String = outside
        .split('[')
        .map(|part| {
            part.split_once(']').map_or(part, |(inside, rest)| if inside.len() < 3 { part } else { rest })
        })
        .collect();
    let bare = bare.to_lowercase();
    let signs: [(&[char], Shown); 3] =
        [(&['h', 's'], Shown::Time), (&['y', 'd'], Shown::Date), (&['%'], Shown::Percent)];
    signs.iter().find(|(letters, _)| bare.contains(*letters)).map_or(Shown::Plain, |(_, shown)| *shown)
}

/// A sheet, row by row.
struct Sheet<'f> {
    texts: &'f [String],
    styles: &'f [Shown],
    to: Unpacked,
    /// Columns that have `%` in a text.
    of_percent: HashSet<usize>,
    /// The column of the next cell of the row.
    next: usize,
    rows: usize,
    kind: String,
    shown: Shown,
    value: String,
    is_within: bool,
    /// Cells that hold one.
    numbers: usize,
}

impl<'f> Sheet<'f> {
    fn new(texts: &'f [String], styles: &'f [Shown], to: Unpacked) -> Self {
        Self {
            texts,
            styles,
            to,
            of_percent: HashSet::new(),
            next: 0,
            rows: 0,
            kind: String::new(),
            shown: Shown::Plain,
            value: String::new(),
            is_within: false,
            numbers: 0,
        }
    }

    /// The text of the present cell.
    fn cell(&mut self) -> Result<String, Problem> {
        let value = std::mem::take(&mut self.value);
        let column = self.next.saturating_sub(1);
        if matches!(self.kind.as_str(), "" | "n") && !value.is_empty() {
            self.numbers += 1;
            return Ok(self.as_shown(value, column));
        }
        let text = if self.kind == "s" {
            let text = value.trim().parse().ok().and_then(|number: usize| self.texts.get(number));
            text.cloned().ok_or_else(|| Problem::broken("a cell refers to a text that is not there"))?
        } else {
            value
        };
        if text.contains('%') {
            self.of_percent.insert(column);
        }
        Ok(text)
    }

    /// A number as text: of percent where the column's name or unit says so, and times as those of the clock, so that no unit of the
    /// column's is taken for theirs.
    fn as_shown(&self, value: String, column: usize) -> String {
        let Ok(number) = value.trim().parse::<f64>() else { return value };
        match self.shown {
            Shown::Percent if self.of_percent.contains(&column) => (100.0 * number).to_string(),
            Shown::Date if number.fract() == 0.0 && (0.0..MOST_DAYS).contains(&number) => {
                date_of(number as i64 - EXCEL_TO_1970)
            }
            Shown::Date | Shown::Time if (0.0..MOST_DAYS).contains(&number) => {
                let parts = (number * 864e9).round() as u64;
                let (seconds, part) = (parts / 10_000_000, parts % 10_000_000);
                format!("{}:{:02}:{:02}.{part:07}", seconds / 3600, seconds / 60 % 60, seconds % 60)
            }
            _ => value,
        }
    }
}

impl Part for Sheet<'_> {
    fn start(&mut self, name: &[u8], element: &BytesStart) -> Result<(), Problem> {
        match name {
            b"row" => {
                let number =
                    attribute(element, "r").and_then(|number| number.parse().ok()).unwrap_or(self.rows + 1);
                if !(self.rows + 1..=MOST_ROWS).contains(&number) {
                    return Err(Problem::broken(
                        "a row stands before the one that precedes it, or is one that Excel has not",
                    ));
                }
                // Rows without cells are not stored.
                for _ in self.rows + 1..number {
                    self.to.write(b"\n")?;
                }
                self.rows = number;
            }
            b"c" => {
                let place = attribute(element, "r").and_then(|place| column(&place)).unwrap_or(self.next);
                if !(self.next..MOST_COLUMNS).contains(&place) {
                    return Err(Problem::broken(
                        "a cell stands before the one that precedes it, or in a column that Excel has not",
                    ));
                }
                // Cells that are empty are not stored.
                for _ in self.next.saturating_sub(1)..place {
                    self.to.write(b"\t")?;
                }
                self.next = place + 1;
                self.kind = attribute(element, "t").unwrap_or_default();
                let style = attribute(element, "s").and_then(|style| style.parse::<usize>().ok());
                self.shown = style.and_then(|style| self.styles.get(style)).copied().unwrap_or(Shown::Plain);
            }
            _ => {}
        }
        self.is_within = matches!(name, b"v" | b"t");
        Ok(())
    }

    fn text(&mut self, text: &str) {
        if self.is_within {
            self.value.push_str(text);
        }
    }

    fn end(&mut self, name: &[u8]) -> Result<(), Problem> {
        self.is_within = false;
        match name {
            b"c" => {
                let cell = self.cell()?.replace(['\t', '\n', '\r'], " ");
                self.to.write(cell.as_bytes())?;
            }
            b"row" => {
                self.next = 0;
                self.to.write(b"\n")?;
            }
            _ => {}
        }
        Ok(())
    }
}

/// The column of a place such as `AB12`, counted from 0.
fn column(place: &str) -> Option<usize> {
    let letters = place.bytes().take_while(u8::is_ascii_uppercase).take(4);
    letters.fold(0, |number: usize, letter| 26 * number + usize::from(letter - b'A' + 1)).checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::{Shown, shown_by};

    #[test]
    fn formats_of_times() {
        for code in ["hh:mm:ss.000", "[h]:mm", "[$-409]d/m/yyyy", "yyyy\\-mm\\-dd", "mm:ss.0;@"] {
            assert!([Shown::Date, Shown::Time].contains(&shown_by(code)), "{code}");
        }
        for code in ["General", "0.00E+00", "0.0\\s", "0.0\\ &quot;days&quot;", "[Red]0.0", "_d0.0", "0%"] {
            assert_eq!(shown_by(code), if code == "0%" { Shown::Percent } else { Shown::Plain }, "{code}");
        }
    }
}
