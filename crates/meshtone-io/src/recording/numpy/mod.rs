//! NumPy's arrays, alone (NPY) or in an archive (NPZ).
//!
//! `ndarray-npy` takes memory for whatever a header announces, and cannot read a part of an array; so the
//! headers are read here, and the numbers as they come.

mod element;
pub(crate) mod header;
mod literal;

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use zip::ZipArchive;
use zip::result::ZipError;

use self::header::{Field, NpyHeader};
use super::array::{ArrayLayout, read_channels, read_records, shape_text};
use super::assemble::{Parts, assemble};
use super::catalogue::{ArrayEntry, Catalogue, MAX_ARRAYS, Numbers};
use super::error::{broken, read_failed, unreadable};
use super::number::append_strided;
use super::selection::select;
use super::{ReadRecordingError, Recording, RecordingOptions, memory_need};

const NPY: &str = "NPY";
const NPZ: &str = "NPZ";
/// Bytes that a byte of a compressed file may well stand for; memory for more is taken only as they come.
const USUAL_COMPRESSION: u64 = 16;
/// Longest element of a structured array that is read.
const MAX_RECORD_BYTES: u64 = 1 << 20;

/// An array or field in a file.
struct Stored {
    header: NpyHeader,
    field: Field,
    /// Its file in the archive.
    file: usize,
}

/// Reads a file of one array; the fields of a structured array are its columns.
pub(super) fn read_npy(
    path: &Path,
    file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let mut from = BufReader::new(file);
    let header = NpyHeader::read(&mut from).map_err(|error| read_failed(path, NPY, error))?;
    check_size(path, NPY, &header, file_bytes)?;
    let (entries, stored) = entries(vec![(String::new(), 0, header, None)]);
    let catalogue = Catalogue::new(path, &entries, options, true)?;
    let selection = select(path, &catalogue.labels, options)?;
    let wanted = selection.wanted();
    memory_need::check(path, options, &selection, catalogue.samples(&wanted, &entries), 0)?;
    let samples = catalogue.read(&wanted, &entries, |index, layout, numbers, wanted| {
        let stored = &stored[index];
        let start = SeekFrom::Start(stored.header.length);
        let there =
            from.seek(start).and_then(|_| stored.read(&mut from, layout, numbers, wanted, file_bytes));
        there.map_err(|error| read_failed(path, NPY, error))
    })?;
    let (labels, stated) = (&catalogue.labels, &catalogue.stated);
    assemble(Parts { path, labels, selection: &selection, samples, stated }, options)
}

/// Reads an archive; its arrays' names are its columns'.
pub(super) fn read_npz(
    path: &Path,
    file: File,
    options: &RecordingOptions,
) -> Result<Recording, ReadRecordingError> {
    let file_bytes = file.metadata().map_err(|source| unreadable(path, source))?.len();
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(|error| zip_failed(path, error))?;
    let (entries, stored) = entries(survey(path, &mut archive)?);
    let catalogue = Catalogue::new(path, &entries, options, true)?;
    let selection = select(path, &catalogue.labels, options)?;
    let wanted = selection.wanted();
    memory_need::check(path, options, &selection, catalogue.samples(&wanted, &entries), 0)?;
    let samples = catalogue.read(&wanted, &entries, |index, layout, numbers, wanted| {
        let stored = &stored[index];
        let mut from = archive.by_index(stored.file).map_err(|error| zip_failed(path, error))?;
        check_size(path, NPZ, &stored.header, from.size())?;
        let present =
            from.compressed_size().min(file_bytes).saturating_mul(USUAL_COMPRESSION).min(from.size());
        let header = NpyHeader::read(&mut from).map_err(|error| read_failed(path, NPZ, error))?;
        if header != stored.header {
            return Err(broken(path, NPZ, "it changes while it is read"));
        }
        let numbers = stored.read(&mut from, layout, numbers, wanted, present);
        // The checksum is compared at the end of the array.
        let whole = numbers.and_then(|numbers| io::copy(&mut from, &mut io::sink()).map(|_| numbers));
        whole.map_err(|error| in_array(path, &entries[index].name, error))
    })?;
    let (labels, stated) = (&catalogue.labels, &catalogue.stated);
    assemble(Parts { path, labels, selection: &selection, samples, stated }, options)
}

impl Stored {
    fn read(
        &self,
        from: &mut dyn Read,
        layout: ArrayLayout,
        Numbers { kind, big_endian }: Numbers,
        wanted: &[bool],
        present_bytes: u64,
    ) -> std::io::Result<Vec<Vec<f64>>> {
        if self.header.record == kind.size() as u64 {
            return read_channels(from, layout, kind, big_endian, wanted, present_bytes);
        }
        let (record, offset) = (self.header.record as usize, self.field.offset as usize);
        let sure = present_bytes / self.header.record.max(1);
        let mut column = Vec::with_capacity(layout.samples.min(sure) as usize);
        read_records(from, record, layout.samples, |block| {
            append_strided(block, record, offset, kind, big_endian, &mut column);
        })?;
        Ok(vec![column])
    }
}

type Surveyed = (String, usize, NpyHeader, Option<f64>);

/// The headers of all arrays.
fn survey(
    path: &Path,
    archive: &mut ZipArchive<BufReader<File>>,
) -> Result<Vec<Surveyed>, ReadRecordingError> {
    if archive.len() > MAX_ARRAYS {
        return Err(broken(path, NPZ, format!("it holds more than {MAX_ARRAYS} arrays")));
    }
    let mut found = Vec::new();
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).map_err(|error| zip_failed(path, error))?;
        let name = file.name().map_err(|error| zip_failed(path, error))?;
        let Some(name) = name.strip_suffix(".npy").map(str::to_string) else { continue };
        let header = NpyHeader::read(&mut file);
        let header = header.map_err(|error| in_array(path, &name, error))?;
        let single = single(&header, &mut file).map_err(|error| in_array(path, &name, error))?;
        found.push((name, index, header, single));
    }
    if found.is_empty() {
        let problem = "is a ZIP archive, but holds no NumPy array (.npy); unpack it, or save it as CSV if it is a table of \
                       Excel's (.xlsx)"
            .to_string();
        return Err(ReadRecordingError::Empty { path: path.to_path_buf(), problem });
    }
    Ok(found)
}

/// The number of an array that holds only one.
fn single(header: &NpyHeader, from: &mut dyn Read) -> std::io::Result<Option<f64>> {
    let [Field { numbers: Ok(numbers), .. }] = &header.fields[..] else { return Ok(None) };
    if header.elements() != Some(1) || header.record != numbers.kind.size() as u64 {
        return Ok(None);
    }
    let layout = ArrayLayout { channels: 1, samples: 1, interleaved: false };
    let read = read_channels(from, layout, numbers.kind, numbers.big_endian, &[true], 0)?;
    Ok(read.first().and_then(|column| column.first().copied()))
}

/// Each field as an array of its own.
fn entries(surveyed: Vec<Surveyed>) -> (Vec<ArrayEntry>, Vec<Stored>) {
    let mut entries = Vec::new();
    let mut stored = Vec::new();
    for (array, file, header, single) in surveyed {
        for field in &header.fields {
            let name = match (array.as_str(), field.name.as_str()) {
                (array, "") => array.to_string(),
                ("", field) => field.to_string(),
                (array, field) => format!("{array}.{field}"),
            };
            let long = header.record > MAX_RECORD_BYTES;
            let wide = header.fields.len() > 1
                && ArrayLayout::of_shape(&header.shape, false).is_ok_and(|layout| layout.channels > 1);
            let records = format!(
                "records of {} bytes in {}; must have one dimension and be short",
                header.record,
                shape_text(&header.shape)
            );
            entries.push(ArrayEntry {
                name,
                shape: header.shape.clone(),
                first_runs_fastest: header.first_runs_fastest,
                numbers: if wide || long { Err(records) } else { field.numbers.clone() },
                type_name: field.type_name.clone(),
                single,
                is_zero_twin: false,
            });
            stored.push(Stored { header: header.clone(), field: field.clone(), file });
        }
    }
    (entries, stored)
}

/// Whether the numbers that a header announces are there.
fn check_size(
    path: &Path,
    format: &'static str,
    header: &NpyHeader,
    bytes: u64,
) -> Result<(), ReadRecordingError> {
    let needed = header.elements().and_then(|elements| elements.checked_mul(header.record));
    let there = bytes.saturating_sub(header.length);
    if needed.is_some_and(|needed| needed <= there) {
        return Ok(());
    }
    let needed =
        needed.map_or("more bytes than any file has".to_string(), |needed| format!("{needed} bytes"));
    let shape = shape_text(&header.shape);
    Err(broken(path, format, format!("an array of shape {shape} takes {needed}, but there are {there}")))
}

fn in_array(path: &Path, name: &str, error: io::Error) -> ReadRecordingError {
    let problem = match error.kind() {
        io::ErrorKind::UnexpectedEof => "it ends too early".to_string(),
        _ => error.to_string(),
    };
    broken(path, NPZ, format!("array {name}: {problem}"))
}

fn zip_failed(path: &Path, error: ZipError) -> ReadRecordingError {
    match error {
        ZipError::Io(error) => read_failed(path, NPZ, error),
        // Its table of contents stands at the end.
        other => broken(path, NPZ, format!("{other}; is the file cut off?")),
    }
}
