//! Universal files: data sets 58, functions at nodal points, as text and in binary (58b).
//!
//! Source: Structural Dynamics Research Laboratory, University of Cincinnati, "Universal File Datasets Summary", data set 58.

use std::fs::File;
use std::io::Read;

use super::error::Problem;
use super::label::Label;
use super::number::{NumberKind, Numbers};
use super::rate::StatedRate;
use super::selection::select;
use super::text::decoded;
use super::time::shortest_within;
use super::time_base::{TimeBase, assemble_bases};
use super::unit::seconds_in;
use super::{Recording, RecordingOptions, memory_need};
use crate::memory;

/// The line before and behind a data set.
const DELIMITER: &[u8] = b"-1";
/// Lines of text that a data set 58 begins with, behind its number.
const HEADER_LINES: usize = 11;
/// Part by which an increment of six digits is uncertain.
const INCREMENT_UNCERTAINTY: f64 = 5e-6;
/// Functions that are samples over time, and abscissas that are time; 0 says nothing.
const TIME_RESPONSE: [i64; 2] = [0, 1];
const TIME: [i64; 2] = [0, 17];

/// Whether a file begins as universal files do: with a delimiter and the number of a data set, each at the end of six columns. A column of
/// numbers may begin with -1, but is not written so.
///
/// # Arguments
/// * `head` - first bytes of the file
pub(super) fn is_universal(head: &[u8]) -> bool {
    let lines = head.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii_end);
    let mut lines = lines.filter(|line| !line.is_empty());
    let is_set = |line: &[u8]| {
        let (number, rest) = line.split_at(line.len().min(6));
        let digits = number.trim_ascii_start();
        number.len() == 6
            && !digits.is_empty()
            && digits.iter().all(u8::is_ascii_digit)
            && matches!(rest.first(), None | Some(b'b' | b'B' | b' '))
    };
    lines.next() == Some(b"    -1") && lines.next().is_some_and(is_set)
}

/// Reads a recording: a channel for each data set 58 that is samples over time; others are left out.
pub(super) fn read(mut file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let (limit, bytes) = (memory::limit(), file.metadata()?.len());
    if let Some(objection) = limit.objection(bytes) {
        return Err(Problem::Refused(format!("has {bytes} bytes, which {objection}")));
    }
    let mut content = Vec::new();
    file.read_to_end(&mut content)?;
    let functions = functions(&content)?;
    let labels: Vec<Label> = functions.iter().map(|function| function.label.clone()).collect();
    let selection = select(&labels, options)?;
    memory_need::check(limit, options, &selection, |column| functions[column].count as u64, bytes)?;
    let wanted = || selection.wanted.iter().map(|column| &functions[*column]);
    let samples = wanted().map(Function::samples).collect::<Result<Vec<_>, _>>()?;
    let bases: Vec<TimeBase> = wanted()
        .map(|function| {
            let by = format!("the abscissa of {}", function.label.raw);
            let rate_hz = shortest_within(1.0 / function.increment_s, INCREMENT_UNCERTAINTY);
            TimeBase::Uniform { stated: StatedRate { by, rate_hz }, start_s: function.start_s }
        })
        .collect();
    assemble_bases(&labels, &selection, samples, &bases, options)
}

/// A data set 58 of samples over time, before its numbers are read.
struct Function<'a> {
    label: Label,
    count: usize,
    start_s: f64,
    increment_s: f64,
    is_double: bool,
    /// Of binary numbers whether the most significant byte comes first; none of text.
    big_endian: Option<bool>,
    data: &'a [u8],
    /// For messages: which data set 58 of the file it is, from 1.
    number: usize,
}

/// What is left of the file, line by line.
struct Lines<'a>(&'a [u8]);

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a [u8]> {
        if self.0.is_empty() {
            return None;
        }
        let end = self.0.iter().position(|byte| *byte == b'\n').map_or(self.0.len(), |end| end + 1);
        let (line, rest) = self.0.split_at(end);
        self.0 = rest;
        Some(line)
    }

    /// Goes behind the next delimiter, and returns what stands before it; none where the file ends without one.
    fn up_to_delimiter(&mut self) -> Option<&'a [u8]> {
        let start = self.0;
        while let Some(line) = self.next() {
            if line.trim_ascii() == DELIMITER {
                return Some(&start[..start.len() - self.0.len() - line.len()]);
            }
        }
        None
    }
}

fn functions(content: &[u8]) -> Result<Vec<Function<'_>>, Problem> {
    let mut lines = Lines(content);
    let (mut found, mut number, mut others) = (Vec::new(), 0, 0);
    // Each data set stands between two delimiters.
    while lines.up_to_delimiter().is_some() {
        let Some(first) = lines.next().map(<[u8]>::trim_ascii) else { break };
        let is_58 = first.starts_with(b"58") && first.get(2).is_none_or(|next| !next.is_ascii_digit());
        number += usize::from(is_58);
        match if is_58 { Function::of(first, &mut lines, number)? } else { None } {
            Some(function) => found.push(function),
            None => others += 1,
        }
        if lines.up_to_delimiter().is_none() {
            return Err(Problem::broken("it ends within a data set, before its delimiter"));
        }
    }
    if found.is_empty() {
        let problem = format!(
            "is a universal file without a time response (data set 58); it has {others} data sets of other kinds, such as spectra; export \
             the time signals"
        );
        return Err(Problem::Refused(problem));
    }
    Ok(found)
}

impl<'a> Function<'a> {
    /// Reads all but the numbers of a data set 58, and goes behind these; none of a function that is not over time.
    fn of(first: &[u8], lines: &mut Lines<'a>, number: usize) -> Result<Option<Self>, Problem> {
        let broken = |what: &str| Problem::Broken(format!("data set 58 number {number}: {what}"));
        let records: Vec<&[u8]> = (0..HEADER_LINES).map_while(|_| lines.next()).collect();
        let [id, .., place, form, abscissa, ordinate, _, _] = records.as_slice() else {
            return Err(broken("it ends within its header"));
        };
        let whole = |line: &[u8], from: usize, to: usize| field(line, from, to).parse::<i64>().ok();
        let real = |line: &[u8], from: usize, to: usize| {
            fast_float2::parse(field(line, from, to)).ok().filter(|value: &f64| value.is_finite())
        };
        let (Some(kind), Some(axis)) = (whole(place, 0, 5), whole(abscissa, 0, 10)) else {
            return Err(broken("record 6 or 8 begins with no whole number"));
        };
        let (Some(values), Some(count), Some(spacing)) =
            (whole(form, 0, 10), whole(form, 10, 20), whole(form, 20, 30))
        else {
            return Err(broken("record 7 does not state type, number and spacing"));
        };
        let (Some(start), Some(increment)) = (real(form, 30, 43), real(form, 43, 56)) else {
            return Err(broken("record 7 does not state start and increment"));
        };
        let count = usize::try_from(count).map_err(|_| broken("its number of values is negative"))?;
        let is_binary = first.get(2).is_some_and(|mark| mark.eq_ignore_ascii_case(&b'b'));
        let (big_endian, data) =
            if is_binary { binary(&first[3..], lines) } else { text(lines) }.map_err(broken)?;
        if !TIME_RESPONSE.contains(&kind) || !TIME.contains(&axis) {
            return Ok(None);
        }
        if !matches!(values, 2 | 4) || spacing != 1 {
            return Err(Problem::Refused(format!(
                "holds complex numbers or uneven times (data set 58 number {number}); export real numbers at a constant rate"
            )));
        }
        let is_double = values == 4;
        let size = if is_double { size_of::<f64>() } else { size_of::<f32>() };
        if is_binary && count.checked_mul(size) != Some(data.len()) {
            let bytes = data.len();
            return Err(broken(&format!("it has {bytes} bytes for {count} values of {size} bytes")));
        }
        let unit = field(abscissa, 47, 67);
        let unit_s = if matches!(&*unit, "" | "NONE") { Some(1.0) } else { seconds_in(&unit) };
        let unit_s = unit_s.ok_or_else(|| broken(&format!("its abscissa is in {unit}, no unit of time")))?;
        let label = label(id, place, ordinate, number);
        let (start_s, increment_s) = (start * unit_s, increment * unit_s);
        Ok(Some(Self { label, count, start_s, increment_s, is_double, big_endian, data, number }))
    }

    fn samples(&self) -> Result<Vec<f64>, Problem> {
        let samples = match self.big_endian {
            Some(big_endian) => {
                let kind = if self.is_double { NumberKind::F64 } else { NumberKind::F32 };
                let mut samples = Vec::new();
                Numbers::plain(kind, big_endian).append(self.data, 1, 0, &mut samples);
                samples
            }
            None => self.numbers_in_text()?,
        };
        if samples.len() == self.count {
            return Ok(samples);
        }
        let problem = format!("{} states {} values and has {}", self.label.raw, self.count, samples.len());
        Err(Problem::Broken(problem))
    }

    /// Numbers of a fixed width, which need no blanks between them; those of writers that do not keep to it stand apart by blanks.
    fn numbers_in_text(&self) -> Result<Vec<f64>, Problem> {
        let width = if self.is_double { 20 } else { 13 };
        let mut samples = Vec::new();
        for line in self.data.split(|byte| *byte == b'\n') {
            let line = line.trim_ascii_end();
            let fixed: Option<Vec<f64>> =
                line.chunks(width).map(|cell| fast_float2::parse(cell.trim_ascii()).ok()).collect();
            let apart = || {
                let cells = line.split(u8::is_ascii_whitespace).filter(|cell| !cell.is_empty());
                cells.map(|cell| fast_float2::parse(cell).ok()).collect()
            };
            samples.extend(fixed.or_else(apart).ok_or_else(|| {
                let (number, line) = (self.number, String::from_utf8_lossy(line));
                Problem::Broken(format!("data set 58 number {number}: {line:?} are no numbers"))
            })?);
        }
        Ok(samples)
    }
}

/// Whether numbers of a data set have the most significant byte first, none of text, and their bytes.
type Stored<'a> = Result<(Option<bool>, &'a [u8]), &'static str>;

/// Binary numbers, whose order and length the data set's first line states behind `58b`.
fn binary<'a>(first: &[u8], lines: &mut Lines<'a>) -> Stored<'a> {
    let text = String::from_utf8_lossy(first);
    let numbers: Vec<usize> = text.split_whitespace().map_while(|number| number.parse().ok()).collect();
    let [order @ (1 | 2), 2, HEADER_LINES, bytes, ..] = numbers[..] else {
        return Err(
            "its first line does not state byte order (1, 2), IEEE 754 (2), 11 lines and a number of bytes",
        );
    };
    let (data, rest) = lines.0.split_at_checked(bytes).ok_or("it ends within its numbers")?;
    lines.0 = rest;
    Ok((Some(order == 2), data))
}

/// Numbers as text, up to the delimiter.
fn text<'a>(lines: &mut Lines<'a>) -> Stored<'a> {
    let data = Lines(lines.0).up_to_delimiter().ok_or("it ends within its numbers, before its delimiter")?;
    lines.0 = &lines.0[data.len()..];
    Ok((None, data))
}

/// Columns of a line.
fn field(line: &[u8], from: usize, to: usize) -> String {
    decoded(line.get(from..to.min(line.len())).unwrap_or_default()).trim().to_owned()
}

/// The name of a channel: that of the response, or else of the function, with node and direction.
fn label(id: &[u8], place: &[u8], ordinate: &[u8], number: usize) -> Label {
    let named = |text: String| Some(text).filter(|text| !matches!(text.as_str(), "" | "NONE"));
    let name = named(field(place, 31, 41)).or_else(|| named(field(id, 0, 80)));
    let node = named(field(place, 41, 51)).filter(|node| node != "0");
    let direction = match field(place, 51, 55).parse() {
        Ok(direction @ (1 | 2 | 3 | -1 | -2 | -3)) => {
            let axis = ["X", "Y", "Z"][i32::unsigned_abs(direction) as usize - 1];
            format!("{}{axis}", if direction > 0 { '+' } else { '-' })
        }
        _ => String::new(),
    };
    let place = node.map(|node| format!("{node}{direction}"));
    let name = match (name, place) {
        (Some(name), Some(place)) => format!("{name} {place}"),
        (Some(one), None) | (None, Some(one)) => one,
        (None, None) => format!("channel {number}"),
    };
    Label { unit: named(field(ordinate, 47, 67)), ..Label::plain(&name) }
}
