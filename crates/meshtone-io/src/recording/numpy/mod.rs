//! NumPy's arrays, alone (NPY) or in an archive (NPZ).
//!
//! `ndarray-npy` takes memory for whatever a header announces, and cannot read a part of an array; so the
//! headers are read here, and the numbers as they come.

pub(crate) mod header;

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

use zip::ZipArchive;

use self::header::{Field, NpyHeader};
use super::array::{ArrayLayout, read_channels, shape_text};
use super::catalogue::{ArrayEntry, MAX_ARRAYS, USUAL_COMPRESSION, read_arrays};
use super::error::Problem;
use super::{Recording, RecordingOptions};

/// Longest record that is read: an element of each channel.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// Reads a file of one array; the fields of a structured array are its columns.
pub(super) fn read_npy(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let mut from = BufReader::new(file);
    let header = NpyHeader::read(&mut from)?;
    check_size(&header, file_bytes)?;
    let entries: Vec<ArrayEntry> = entries("", &header, None).collect();
    read_arrays(&entries, options, true, |_, layout, numbers, wanted| {
        from.seek(SeekFrom::Start(header.length))?;
        Ok(read_channels(&mut from, layout, numbers, wanted, file_bytes)?)
    })
}

/// Reads an archive; its arrays' names are its columns'.
pub(super) fn read_npz(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let mut archive = ZipArchive::new(BufReader::new(file))?;
    let arrays = arrays(&mut archive)?;
    let (mut all, mut array_of) = (Vec::new(), Vec::new());
    for (index, array) in arrays.iter().enumerate() {
        all.extend(entries(&array.name, &array.header, array.single));
        array_of.resize(all.len(), index);
    }
    read_arrays(&all, options, true, |index, layout, numbers, wanted| {
        let array = &arrays[array_of[index]];
        let mut from = archive.by_index(array.file)?;
        check_size(&array.header, from.size())?;
        let present =
            from.compressed_size().min(file_bytes).saturating_mul(USUAL_COMPRESSION).min(from.size());
        if NpyHeader::read(&mut from)? != array.header {
            return Err(Problem::broken("it changes while it is read"));
        }
        let samples = read_channels(&mut from, layout, numbers, wanted, present);
        // The checksum is compared at the end of the array.
        let whole = samples.and_then(|samples| io::copy(&mut from, &mut io::sink()).map(|_| samples));
        whole.map_err(|error| in_array(&array.name, error))
    })
}

/// An array of an archive.
struct NpzArray {
    name: String,
    /// Its file in the archive.
    file: usize,
    header: NpyHeader,
    /// Its number, if it holds only one.
    single: Option<f64>,
}

/// The arrays of an archive, without their numbers.
fn arrays(archive: &mut ZipArchive<BufReader<File>>) -> Result<Vec<NpzArray>, Problem> {
    if archive.len() > MAX_ARRAYS {
        return Err(Problem::Broken(format!("it holds more than {MAX_ARRAYS} arrays")));
    }
    let mut arrays = Vec::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index)?;
        let name = file.name()?;
        let Some(name) = name.strip_suffix(".npy").map(str::to_string) else { continue };
        let header = NpyHeader::read(&mut file).map_err(|error| in_array(&name, error))?;
        let single = single(&header, &mut file).map_err(|error| in_array(&name, error))?;
        arrays.push(NpzArray { name, file: index, header, single });
    }
    if arrays.is_empty() {
        let problem = "is a ZIP archive, but holds no NumPy array (.npy); unpack it, or save it as CSV if it is a table of \
                       Excel's (.xlsx)";
        return Err(Problem::Refused(problem.to_string()));
    }
    Ok(arrays)
}

/// The number of an array that holds only one.
fn single(header: &NpyHeader, from: &mut dyn Read) -> io::Result<Option<f64>> {
    match &header.fields[..] {
        [Field { numbers: Ok(numbers), .. }]
            if header.elements() == Some(1) && header.record == numbers.kind.size() as u64 =>
        {
            numbers.read_one(from).map(Some)
        }
        _ => Ok(None),
    }
}

/// Each field of an array as an array of its own.
fn entries<'a>(
    array: &'a str,
    header: &'a NpyHeader,
    single: Option<f64>,
) -> impl Iterator<Item = ArrayEntry> + 'a {
    let channels = ArrayLayout::of_shape(&header.shape, false).map_or(1, |layout| layout.channels);
    let record_bytes = header.record.saturating_mul(channels as u64);
    header.fields.iter().map(move |field| ArrayEntry {
        name: match (array, field.name.as_str()) {
            (array, "") => array.to_string(),
            ("", field) => field.to_string(),
            (array, field) => format!("{array}.{field}"),
        },
        shape: header.shape.clone(),
        first_runs_fastest: header.first_runs_fastest,
        numbers: match record_bytes {
            ..=MAX_RECORD_BYTES => field.numbers.clone(),
            bytes => Err(format!("records of {bytes} bytes; must be of {MAX_RECORD_BYTES} bytes at most")),
        },
        type_name: field.type_name.clone(),
        single,
        beside_bytes: 0,
        is_zero_twin: false,
    })
}

/// Checks that the numbers that a header announces are there.
///
/// # Arguments
/// * `header` - of the array
/// * `bytes` - of the array's file, header included
fn check_size(header: &NpyHeader, bytes: u64) -> Result<(), Problem> {
    if header.file_bytes().is_some_and(|needed| needed <= bytes) {
        return Ok(());
    }
    let needed = header.file_bytes().map(|needed| format!("{} bytes", needed - header.length));
    let needed = needed.unwrap_or_else(|| "more bytes than any file has".to_string());
    let there = bytes.saturating_sub(header.length);
    let shape = shape_text(&header.shape);
    Err(Problem::Broken(format!("an array of shape {shape} takes {needed}, but there are {there}")))
}

fn in_array(name: &str, error: io::Error) -> Problem {
    let problem = match error.kind() {
        io::ErrorKind::UnexpectedEof => "it ends too early".to_string(),
        _ => error.to_string(),
    };
    Problem::Broken(format!("array {name}: {problem}"))
}
