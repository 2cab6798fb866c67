//! Signals as a MATLAB file of version 5 without compression: a column vector for each, with the time and the sampling rate.
//!
//! Source: The MathWorks, "MAT-File Format", "Level 5 MAT-File Format". No crate writes such files without MATLAB's own libraries.

use std::io::{self, BufWriter, Write};

use super::super::signal_table::SignalTable;
use super::super::{RATE, TIME};

/// (bytes) Text of the header, and where subsystem data would be.
const TEXT_BYTES: usize = 116;
const SUBSYSTEM_BYTES: usize = 8;
/// Version 5, and the mark by which a reader finds the order of the bytes.
const VERSION_AND_ORDER: [u8; 4] = [0, 1, b'I', b'M'];
/// Types of elements.
const INT8: u32 = 1;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
/// Class of arrays of double precision.
const DOUBLE_CLASS: u32 = 6;
/// (bytes) Of an array but its name and numbers: flags, dimensions, and the tags of name and numbers.
const MATRIX_HEAD_BYTES: usize = 16 + 16 + 8 + 8;
/// Longest name of a variable that MATLAB accepts.
const LONGEST_NAME: usize = 63;

pub fn write(table: &SignalTable, to: impl Write) -> io::Result<()> {
    let mut to = BufWriter::new(to);
    let text = concat!("MATLAB 5.0 MAT-file, written by Meshtone ", env!("CARGO_PKG_VERSION"));
    write!(to, "{text:TEXT_BYTES$}")?;
    to.write_all(&[0; SUBSYSTEM_BYTES])?;
    to.write_all(&VERSION_AND_ORDER)?;
    write_variable(&mut to, RATE, &[table.channels.sampling_rate_hz])?;
    write_variable(&mut to, TIME, &table.times_s())?;
    let mut names = vec![RATE.to_owned(), TIME.to_owned()];
    for column in &table.channels.signals {
        let name = variable_name(&column.name, &names);
        write_variable(&mut to, &name, &column.values)?;
        names.push(name);
    }
    to.flush()
}

/// A name that MATLAB accepts and that no other variable has: letters, digits and underscores, beginning with a letter.
fn variable_name(name: &str, taken: &[String]) -> String {
    let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let name: String = name.chars().map(letter).collect();
    let numbered = |number: u32| match number {
        1 => name.chars().take(LONGEST_NAME).collect(),
        _ => {
            let end = format!("_{number}");
            name.chars().take(LONGEST_NAME - end.len()).chain(end.chars()).collect()
        }
    };
    (1..).map(numbered).find(|name: &String| !taken.contains(name)).unwrap_or_default()
}

/// Writes a column vector: its flags, dimensions, name and numbers, each behind a tag that states type and length.
fn write_variable(to: &mut impl Write, name: &str, numbers: &[f64]) -> io::Result<()> {
    let padding = name.len().next_multiple_of(8) - name.len();
    let bytes = MATRIX_HEAD_BYTES + name.len() + padding + 8 * numbers.len();
    let bytes = i32::try_from(bytes).map_err(|_| {
        let samples = numbers.len();
        io::Error::other(format!(
            "{samples} samples of {name} do not fit into a MAT-file of version 5 (2 GiB)"
        ))
    })?;
    let rows = numbers.len() as u32;
    let words =
        [MATRIX, bytes as u32, UINT32, 8, DOUBLE_CLASS, 0, INT32, 8, rows, 1, INT8, name.len() as u32];
    words.iter().try_for_each(|word| to.write_all(&word.to_le_bytes()))?;
    to.write_all(name.as_bytes())?;
    to.write_all(&[0; 8][..padding])?;
    [DOUBLE, 8 * rows].iter().try_for_each(|word| to.write_all(&word.to_le_bytes()))?;
    numbers.iter().try_for_each(|number| to.write_all(&number.to_le_bytes()))
}
