//! HDF5: MATLAB's MAT-files of version 7.3, and those of other programs.
//!
//! Groups are structs, data sets arrays. MATLAB writes its dimensions in reverse order. Arrays that others refer to, as those of cell
//! arrays, are not read.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use hdf5_pure::{AttrValue, Dataset, Datatype, DatatypeByteOrder, Error, FormatError, Group, ReadSeekSource};

use super::array::read_channels;
use super::catalogue::{ArrayEntry, MAX_ARRAYS, MAX_DEPTH, USUAL_COMPRESSION, read_arrays};
use super::error::Problem;
use super::number::{NumberKind, Numbers};
use super::{Recording, RecordingOptions};

/// What begins the names of groups in which MATLAB keeps data of its own.
const OWN_OF_MATLAB: char = '#';
/// Bytes that are read at once, where a row of the array is not longer.
const BLOCK_BYTES: u64 = 1 << 18;
/// Bits of the exponent of a number of half precision; others of two bytes have more.
const HALF_EXPONENT: u8 = 5;
/// What begins a file that MATLAB wrote.
const MATLAB: &[u8] = b"MATLAB";

/// Reads a recording from HDF5.
pub(super) fn read(mut file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let mut head = [0; MATLAB.len()];
    file.read_exact(&mut head)?;
    file.seek(SeekFrom::Start(0))?;
    let source = ReadSeekSource::new(file).map_err(Problem::broken)?;
    let opened = hdf5_pure::File::from_source(source).map_err(Problem::broken)?;
    let mut arrays = Arrays { of_matlab: head == MATLAB, file_bytes, found: Vec::new(), groups: 0 };
    arrays.collect(&opened.root(), "", &mut Vec::new())?;
    let (entries, data_sets): (Vec<ArrayEntry>, Vec<Dataset>) = arrays.found.into_iter().unzip();
    read_arrays(&entries, options, true, |index, layout, numbers, wanted| {
        let mut rows = Rows::new(&data_sets[index], file_bytes)?;
        let present = file_bytes.saturating_mul(USUAL_COMPRESSION);
        Ok(read_channels(&mut rows, layout, numbers, wanted, present)?)
    })
}

/// Names of the arrays and groups in a group.
type Members = [Vec<String>; 2];

fn names_of<T>(members: &[(String, T)]) -> Vec<String> {
    members.iter().map(|(name, _)| name.clone()).collect()
}

/// Why the members of a group cannot be listed. In groups of the old format hdf5-pure 0.47 takes a soft link for an object at the largest
/// address that there is.
fn links(error: Error) -> Problem {
    if matches!(error, Error::Format(FormatError::OffsetOverflow { .. })) {
        return Problem::convert(
            "an HDF5 file with soft links",
            "copy it without them by `h5repack --latest FILE NEW`",
        );
    }
    Problem::broken(error)
}

/// The arrays of a file that have been found.
struct Arrays {
    of_matlab: bool,
    file_bytes: u64,
    found: Vec<(ArrayEntry, Dataset)>,
    groups: usize,
}

impl Arrays {
    /// Collects the arrays of a group and of those in it. One whose members are those of a group around it is that group, to which a link
    /// leads back.
    fn collect(&mut self, group: &Group, path: &str, around: &mut Vec<Members>) -> Result<(), Problem> {
        self.groups += 1;
        let within = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
        let is_sparse =
            self.of_matlab && group.attrs().map_err(Problem::broken)?.contains_key("MATLAB_sparse");
        let data_sets: Vec<(String, Dataset)> = group.iter_datasets().map_err(links)?.collect();
        let groups: Vec<(String, Group)> = group.iter_groups().map_err(links)?.collect();
        let members = [names_of(&data_sets), names_of(&groups)];
        if !groups.is_empty() && around.contains(&members) {
            return Ok(());
        }
        for (name, data_set) in data_sets {
            let mut entry = self.entry(within(&name), &data_set)?;
            if is_sparse {
                entry.numbers = Err("a sparse array; save it with full(…)".to_owned());
            }
            self.found.push((entry, data_set));
            self.check_size(around.len())?;
        }
        around.push(members);
        for (name, inner) in groups.into_iter().filter(|(name, _)| !name.starts_with(OWN_OF_MATLAB)) {
            self.check_size(around.len())?;
            self.collect(&inner, &within(&name), around)?;
        }
        around.pop();
        Ok(())
    }

    fn check_size(&self, depth: usize) -> Result<(), Problem> {
        if depth > MAX_DEPTH || self.groups.max(self.found.len()) > MAX_ARRAYS {
            let problem = format!(
                "it holds more than {MAX_ARRAYS} arrays or groups, or groups nested more than {MAX_DEPTH} deep"
            );
            return Err(Problem::Broken(problem));
        }
        Ok(())
    }

    fn entry(&self, name: String, data_set: &Dataset) -> Result<ArrayEntry, Problem> {
        let mut shape = data_set.shape().map_err(Problem::broken)?;
        let mut numbers = numbers_of(data_set)?;
        let mut single = None;
        let rows = Rows::new(data_set, self.file_bytes);
        let beside_bytes = rows.as_ref().map_or(0, |rows| rows.block_bytes);
        if let (Ok(kind), true) = (&numbers, shape.iter().all(|length| *length == 1)) {
            match rows.and_then(|mut rows| Ok(kind.read_one(&mut rows)?)) {
                Ok(number) => single = Some(number),
                Err(_) => numbers = Err("a number that cannot be read".to_owned()),
            }
        }
        if self.of_matlab {
            shape.reverse();
        }
        Ok(ArrayEntry {
            name,
            shape,
            first_runs_fastest: self.of_matlab,
            type_name: match &numbers {
                Ok(numbers) => numbers.kind.name().to_owned(),
                Err(what) => what.clone(),
            },
            numbers,
            single,
            beside_bytes,
            is_zero_twin: false,
        })
    }
}

/// How the numbers of a data set stand in the file; what it holds instead, if those are not real numbers.
fn numbers_of(data_set: &Dataset) -> Result<Result<Numbers, String>, Problem> {
    let attributes = data_set.attrs().map_err(Problem::broken)?;
    let class = attributes.get("MATLAB_class").and_then(AttrValue::as_str).map(str::trim_end);
    if let Some("char") = class {
        return Ok(Err("text".to_owned()));
    }
    // Instead of an empty array MATLAB writes its dimensions.
    if attributes.contains_key("MATLAB_empty") {
        return Ok(Err("an empty array".to_owned()));
    }
    let kind = match data_set.datatype().map_err(Problem::broken)? {
        Datatype::FixedPoint { size, byte_order, layout } => {
            let class = if layout.signed { "int" } else { "uint" };
            match NumberKind::of(class, size.saturating_mul(8)) {
                Some(kind) => Some((kind, byte_order)),
                None => return Ok(Err(format!("integers of {size} bytes"))),
            }
        }
        Datatype::FloatingPoint { size, byte_order, layout }
            if size != 2 || layout.exponent_size == HALF_EXPONENT =>
        {
            NumberKind::of("float", size.saturating_mul(8)).map(|kind| (kind, byte_order))
        }
        _ => None,
    };
    Ok(match (kind, class) {
        (Some((_, DatatypeByteOrder::Vax)), _) => Err("numbers in VAX order".to_owned()),
        (Some((kind, order)), _) => Ok(Numbers::plain(kind, order == DatatypeByteOrder::BigEndian)),
        (None, Some("cell")) => {
            Err("a cell array; save its arrays as variables, or the file with -v7".to_owned())
        }
        (None, _) => Err("no real numbers (text, complex numbers, records or references)".to_owned()),
    })
}

/// The bytes of a data set, rows of its first dimension at a time.
struct Rows<'d> {
    data_set: &'d Dataset,
    file_bytes: u64,
    rows: u64,
    at_once: u64,
    /// (bytes) The largest block.
    block_bytes: u64,
    next_row: u64,
    block: Vec<u8>,
    at: usize,
}

impl<'d> Rows<'d> {
    fn new(data_set: &'d Dataset, file_bytes: u64) -> Result<Self, Problem> {
        let shape = data_set.shape().map_err(Problem::broken)?;
        let element = data_set.element_size().map_err(Problem::broken)?;
        let row_bytes = shape.iter().skip(1).fold(element, |bytes, length| bytes.saturating_mul(*length));
        // A chunk is decompressed as a whole.
        let chunk = data_set.chunk_shape().map_err(Problem::broken)?.and_then(|shape| shape.first().copied());
        let at_once = (BLOCK_BYTES / row_bytes.max(1)).max(chunk.unwrap_or(1)).max(1);
        let rows = shape.first().copied().unwrap_or(1);
        let block_bytes = row_bytes.saturating_mul(at_once.min(rows));
        Ok(Self { data_set, file_bytes, rows, at_once, block_bytes, next_row: 0, block: Vec::new(), at: 0 })
    }

    /// hdf5-pure 0.47 makes room for chunks that adjoin before it looks whether the file is so long.
    fn check_chunks(&self) -> io::Result<()> {
        let chunks = self.data_set.chunks().unwrap_or_default();
        match chunks.iter().map(|chunk| chunk.storage_size).find(|bytes| *bytes > self.file_bytes) {
            None => Ok(()),
            Some(bytes) => Err(io::Error::other(format!("a chunk of {bytes} bytes is longer than the file"))),
        }
    }
}

impl Read for Rows<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.at == self.block.len() && self.next_row < self.rows {
            if self.next_row == 0 {
                self.check_chunks()?;
            }
            self.block =
                self.data_set.read_raw_rows(self.next_row, self.at_once).map_err(io::Error::other)?;
            self.next_row = self.next_row.saturating_add(self.at_once);
            self.at = 0;
        }
        let count = to.len().min(self.block.len() - self.at);
        to[..count].copy_from_slice(&self.block[self.at..self.at + count]);
        self.at += count;
        Ok(count)
    }
}
