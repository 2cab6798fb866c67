//! The cells of a line, and the numbers in them.

use std::borrow::Cow;

use crate::recording::Separator;

/// How the cells of a text file are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Dialect {
    /// `None` where there is one column only.
    pub separator: Option<Separator>,
    pub decimal_comma: bool,
}

/// What a cell holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cell {
    Number(f64),
    Empty,
    Text,
}

impl Dialect {
    /// Splits a line into its cells, without blanks and quotes around them.
    pub(super) fn cells<'l>(&self, line: &'l [u8]) -> Vec<&'l [u8]> {
        match self.separator {
            None => vec![unquoted(line.trim_ascii())],
            Some(Separator::Whitespace) => {
                let cells = line.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty());
                cells.map(unquoted).collect()
            }
            Some(separator) => split(line, byte_of(separator)),
        }
    }

    /// The cells of a line of so many columns, without the empty one behind a separator at the end.
    ///
    /// # Arguments
    /// * `line` - the line
    /// * `columns` - its columns
    /// * `trailing` - whether lines may end in a separator behind the last column
    pub(super) fn cells_of<'l>(&self, line: &'l [u8], columns: usize, trailing: bool) -> Vec<&'l [u8]> {
        let mut cells = self.cells(line);
        if trailing && cells.len() == columns + 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        cells
    }

    /// What a cell holds.
    pub(super) fn cell(&self, cell: &[u8]) -> Cell {
        if cell.is_empty() {
            return Cell::Empty;
        }
        let with_point = match (self.decimal_comma, cell.contains(&b','), cell.contains(&b'.')) {
            (true, _, true) | (false, true, _) => return clock_s(cell).map_or(Cell::Text, Cell::Number),
            (true, true, false) => {
                Cow::Owned(cell.iter().map(|byte| if *byte == b',' { b'.' } else { *byte }).collect())
            }
            _ => Cow::Borrowed(cell),
        };
        let number = fast_float2::parse(with_point).ok();
        number.or_else(|| clock_s(cell)).map_or(Cell::Text, Cell::Number)
    }

    /// Whether a cell holds a number.
    pub(super) fn is_number(&self, cell: &[u8]) -> bool {
        matches!(self.cell(cell), Cell::Number(_))
    }

    /// Whether a cell is a number with a typing error in it, such as `0.1x2`, `1..5` or `2.5e`, and no name such as `0.5Hz`, `1X` or a date.
    pub(super) fn is_spoiled_number(&self, cell: &[u8]) -> bool {
        let sign = if self.decimal_comma { b',' } else { b'.' };
        let digits = |text: &[u8]| text.iter().take_while(|byte| byte.is_ascii_digit()).count();
        let unsigned = cell.strip_prefix(b"-").or(cell.strip_prefix(b"+")).unwrap_or(cell);
        let whole = digits(unsigned);
        let Some(fraction) = unsigned[whole..].strip_prefix(&[sign]).filter(|_| whole > 0) else {
            return false;
        };
        let rest = &fraction[digits(fraction)..];
        // A sign has its place behind an exponent's e only: `0.1-10kHz` is a name.
        let follows_e = |at: usize| at > 0 && matches!(rest[at - 1], b'e' | b'E');
        let is_word = rest.iter().enumerate().all(|(at, byte)| match byte {
            b'+' | b'-' => follows_e(at),
            _ => byte.is_ascii_alphanumeric() || [b'.', b','].contains(byte),
        });
        let mixed = rest.iter().any(u8::is_ascii_alphabetic) && rest.iter().any(u8::is_ascii_digit);
        let cut_exponent = matches!(rest, [b'e' | b'E'] | [b'e' | b'E', b'+' | b'-']);
        is_word && (mixed || cut_exponent || rest.first() == Some(&sign) && fraction.first() == Some(&sign))
    }
}

/// (s) A time of the clock, since midnight or, with a date, since 1970: `12:30:00.5`, `2026-11-29T12:30:00,5Z`, `29.11.2026 12:30:00`,
/// `12:30:00 PM`; or a time that has passed, `123:30:00`.
pub(super) fn clock_s(cell: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(cell).ok().filter(|text| text.contains(':'))?;
    let half = text.len().checked_sub(2).filter(|at| text.is_char_boundary(*at)).map(|at| text.split_at(at));
    let half = half.filter(|(_, half)| half.eq_ignore_ascii_case("am") || half.eq_ignore_ascii_case("pm"));
    let (text, half) = half.map_or((text, None), |(text, half)| (text.trim_end(), Some(half)));
    let (date, clock) = match text.split_once(['T', ' ', '_']) {
        Some((date, clock)) => (Some(date), clock.trim()),
        None => (None, text),
    };
    // A zone is the same in all lines.
    let clock = clock.split(['Z', '+', '-']).next()?;
    let mut parts = clock.split(':');
    let (hours, minutes, seconds) = (parts.next()?, parts.next()?, parts.next()?);
    let whole = |text: &str, digits: usize| {
        (text.len() <= digits).then(|| text.parse::<u32>().ok()).flatten().map(f64::from)
    };
    let hours = whole(hours, LONGEST_HOURS)?;
    let hours = match half {
        Some(_) if !(1.0..=12.0).contains(&hours) => return None,
        // Twelve stands before one.
        Some(half) => hours % 12.0 + if half.eq_ignore_ascii_case("pm") { 12.0 } else { 0.0 },
        None => hours,
    };
    let starts_with_digit = seconds.starts_with(|letter: char| letter.is_ascii_digit());
    let seconds: f64 =
        seconds.replace(',', ".").parse().ok().filter(|_| starts_with_digit && parts.next().is_none())?;
    let days = date.map_or(Some(0), |date| day_number(date.as_bytes()))?;
    Some(86_400.0 * days as f64 + 3600.0 * hours + 60.0 * whole(minutes, 2)? + seconds)
}

/// Digits of hours since the year 1900, which a workbook's times may count from.
const LONGEST_HOURS: usize = 8;

/// Days from the first of 1970 to a date, such as `2026-11-29`, `2026/11/29` or `29.11.2026`.
pub(super) fn day_number(date: &[u8]) -> Option<i64> {
    let parts = std::str::from_utf8(date).ok()?.split(['-', '/', '.']).map(|part| part.parse::<i64>().ok());
    let parts: Vec<i64> = parts.collect::<Option<_>>()?;
    let [year, month, day] = match parts[..] {
        [year @ 1000..=9999, month, day] => [year, month, day],
        [day, month, year @ 1000..=9999] if date.contains(&b'.') => [year, month, day],
        _ => return None,
    };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // Years that begin in March end with the leap day.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some(365 * year + year / 4 - year / 100 + year / 400 + (153 * month + 2) / 5 + day - 1 - 719_468)
}

/// The date of a number of days from the first of 1970, as [`day_number`] counts them.
pub(in crate::recording) fn date_of(day: i64) -> String {
    // From the first of March of the year 0 on: the leap day ends a year of four, of a hundred, of four hundred.
    let day = day + 719_468;
    let (era, day) = (day.div_euclid(146_097), day.rem_euclid(146_097));
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = (400 * era + year, month + 3);
    let (year, month) = if month > 12 { (year + 1, month - 12) } else { (year, month) };
    format!("{year:04}-{month:02}-{day:02}")
}

pub(super) fn byte_of(separator: Separator) -> u8 {
    match separator {
        Separator::Comma => b',',
        Separator::Semicolon => b';',
        Separator::Tab => b'\t',
        Separator::Bar => b'|',
        Separator::Whitespace => b' ',
    }
}

/// Splits at a byte that is not within quotes.
fn split(line: &[u8], separator: u8) -> Vec<&[u8]> {
    let mut cells = Vec::new();
    let mut start = 0;
    let mut quoted = false;
    for (at, byte) in line.iter().enumerate() {
        if *byte == b'"' {
            quoted = !quoted;
        } else if *byte == separator && !quoted {
            cells.push(unquoted(line[start..at].trim_ascii()));
            start = at + 1;
        }
    }
    cells.push(unquoted(line[start..].trim_ascii()));
    cells
}

fn unquoted(cell: &[u8]) -> &[u8] {
    let inner = cell.strip_prefix(b"\"").and_then(|rest| rest.strip_suffix(b"\""));
    inner.map_or(cell, <[u8]>::trim_ascii)
}

/// Text in UTF-8, or else in Latin-1, which spreadsheets of Western Europe still write.
pub(in crate::recording) fn decoded(bytes: &[u8]) -> String {
    let utf8 = std::str::from_utf8(bytes).map(str::to_string);
    utf8.unwrap_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect())
}

#[cfg(test)]
mod tests {
    use super::{Cell, Dialect, Separator, clock_s, date_of, day_number, decoded};

    fn dialect(separator: Separator, decimal_comma: bool) -> Dialect {
        Dialect { separator: Some(separator), decimal_comma }
    }

    #[test]
    fn lines_are_split() {
        let commas = dialect(Separator::Comma, true);
        assert_eq!(commas.cells(b" 1 , \"2,5\",,x \r\n"), [&b"1"[..], b"2,5", b"", b"x"]);
        assert_eq!(commas.cell(b"2,5"), Cell::Number(2.5));
        assert_eq!(dialect(Separator::Tab, false).cells(b"\t1\t\r\n"), [&b""[..], b"1", b""]);
        assert_eq!(dialect(Separator::Whitespace, false).cells(b"  1 \t 2\n"), [&b"1"[..], b"2"]);
    }

    #[test]
    fn clocks_and_dates_are_read() {
        for (text, seconds) in [
            ("00:00:01.5", 1.5),
            ("12:00:01 AM", 1.0),
            ("12:00:01pm", 43_201.0),
            ("1:00:00,5 PM", 46_800.5),
            ("123:00:00", 442_800.0),
            ("1970-01-02T00:00:01Z", 86_401.0),
            ("02.01.1970 1:00:00 pm", 133_200.0),
        ] {
            assert_eq!(clock_s(text.as_bytes()), Some(seconds), "{text}");
        }
        for text in ["13:00:00 PM", "0:00:00 AM", "1:00 PM", "ä:m", "1:2:3m"] {
            assert_eq!(clock_s(text.as_bytes()), None, "{text}");
        }
        for day in (-30_000..60_000).step_by(7) {
            assert_eq!(day_number(date_of(day).as_bytes()), Some(day));
        }
        assert_eq!(date_of(11_016), "2000-02-29");
    }

    #[test]
    fn numbers_are_distinguished_from_text() {
        let (point, comma) = (dialect(Separator::Semicolon, false), dialect(Separator::Semicolon, true));
        assert_eq!(point.cell(b"-1.5e-3"), Cell::Number(-1.5e-3));
        assert_eq!(point.cell(b"+2"), Cell::Number(2.0));
        assert_eq!(comma.cell(b"-1,5E+3"), Cell::Number(-1500.0));
        for text in ["1,5", "1.234,5", "1 5", "x", "-", "0x10", "1e"] {
            assert_eq!(point.cell(text.as_bytes()), Cell::Text, "{text}");
        }
        for text in ["1.5", "1.234,5", "1,234,567"] {
            assert_eq!(comma.cell(text.as_bytes()), Cell::Text, "{text}");
        }
        for spoiled in ["0.1x2", "-1..5", "2.5e", "+2.5E-", "0.1O2", "2.5e-1x"] {
            assert!(point.is_spoiled_number(spoiled.as_bytes()), "{spoiled}");
            assert!(comma.is_spoiled_number(spoiled.replace('.', ",").as_bytes()), "{spoiled}");
        }
        for name in [
            "0.5Hz",
            "0.1-10kHz",
            "1X",
            "3rd",
            "10.05.2024",
            "0.5 g2",
            "0.5[m/s2]",
            "x0.1",
            "1.5",
            ".1x2",
            "1x2",
        ] {
            assert!(!point.is_spoiled_number(name.as_bytes()), "{name}");
        }
        assert_eq!(point.cell(b""), Cell::Empty);
        assert_eq!(decoded(b"\xb5m"), "µm");
    }
}
