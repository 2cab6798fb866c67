//! Whole arrays in NumPy's archives.
//!
//! The crate `ndarray-npy` does this for arrays of the crate `ndarray`, which nothing else here needs; the headers that it reads
//! with a grammar are read by the [`recording`](crate::recording)'s reader, which has to know more of them.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

use crate::recording::array::read_records;
use crate::recording::number::NumberKind;
use crate::recording::numpy::header::{Field, NpyHeader};

/// What an array's file is called after its name.
const NPY: &str = ".npy";
/// (bytes) Where NumPy wants an array's numbers to begin: a multiple of this.
const ALIGNMENT: usize = 64;
/// Before the header: NumPy's mark, the version of the format, the header's length.
const MARK: [u8; 8] = *b"\x93NUMPY\x01\x00";

/// An archive that is written.
pub struct NpzWriter<W: Write + Seek> {
    archive: ZipWriter<SilentAfterError<W>>,
    method: CompressionMethod,
}

impl<W: Write + Seek> NpzWriter<W> {
    /// Numbers as they are: those of computed signals hardly become smaller.
    pub fn stored(to: W) -> Self {
        Self { archive: ZipWriter::new(SilentAfterError::new(to)), method: CompressionMethod::Stored }
    }

    /// Compressed numbers.
    pub fn compressed(to: W) -> Self {
        Self { archive: ZipWriter::new(SilentAfterError::new(to)), method: CompressionMethod::Deflated }
    }

    /// Adds an array of numbers.
    ///
    /// # Arguments
    /// * `name` - of the array
    /// * `shape` - its lengths; none for a single number
    /// * `numbers` - the last dimension runs fastest
    pub fn add(&mut self, name: &str, shape: &[usize], numbers: &[f64]) -> io::Result<()> {
        let count = shape.iter().try_fold(1_usize, |product, &length| product.checked_mul(length));
        if count != Some(numbers.len()) {
            let problem = format!("{name}: {} numbers do not fill the shape {shape:?}", numbers.len());
            return Err(io::Error::other(problem));
        }
        self.add_array(name, "<f8", shape, numbers.iter().map(|number| number.to_le_bytes()))
    }

    /// Adds a single number without sign.
    pub fn add_whole(&mut self, name: &str, number: u64) -> io::Result<()> {
        self.add_array(name, "<u8", &[], [number.to_le_bytes()].into_iter())
    }

    fn add_array(
        &mut self,
        name: &str,
        element: &str,
        shape: &[usize],
        numbers: impl ExactSizeIterator<Item = [u8; 8]>,
    ) -> io::Result<()> {
        let is_large = 8 * numbers.len() as u64 > u64::from(u32::MAX) / 2;
        let options = SimpleFileOptions::default().compression_method(self.method).large_file(is_large);
        self.archive.start_file(format!("{name}{NPY}"), options)?;
        let mut to = BufWriter::new(&mut self.archive);
        to.write_all(&header(element, shape)?)?;
        for number in numbers {
            to.write_all(&number)?;
        }
        to.flush()
    }

    /// Ends the archive.
    pub fn finish(self) -> io::Result<W> {
        let SilentAfterError { to, has_failed, .. } = self.archive.finish()?;
        if has_failed { Err(io::Error::other("a part of it was not written")) } else { Ok(to) }
    }
}

/// A writer that accepts everything after its first error, which has been returned by then. Where it is dropped, the crate `zip`
/// tries to end the archive all the same, and would print on standard error that it cannot.
struct SilentAfterError<W> {
    to: W,
    /// Where it writes, or would.
    at: u64,
    has_failed: bool,
}

impl<W> SilentAfterError<W> {
    fn new(to: W) -> Self {
        Self { to, at: 0, has_failed: false }
    }
}

impl<W: Write> Write for SilentAfterError<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let done = if self.has_failed { Ok(bytes.len()) } else { self.to.write(bytes) };
        self.has_failed |= is_failure(&done);
        self.at += done.as_ref().map_or(0, |&written| written as u64);
        done
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.has_failed {
            return Ok(());
        }
        let done = self.to.flush();
        self.has_failed = is_failure(&done);
        done
    }
}

impl<W: Seek> Seek for SilentAfterError<W> {
    fn seek(&mut self, place: SeekFrom) -> io::Result<u64> {
        if self.has_failed {
            self.at = match place {
                SeekFrom::Start(at) => at,
                SeekFrom::Current(further) => self.at.saturating_add_signed(further),
                SeekFrom::End(_) => self.at,
            };
            return Ok(self.at);
        }
        let done = self.to.seek(place);
        self.has_failed = is_failure(&done);
        self.at = done.as_ref().copied().unwrap_or(self.at);
        done
    }
}

fn is_failure<T>(done: &io::Result<T>) -> bool {
    done.as_ref().is_err_and(|error| error.kind() != io::ErrorKind::Interrupted)
}

/// What stands before an array's numbers.
fn header(element: &str, shape: &[usize]) -> io::Result<Vec<u8>> {
    let lengths: Vec<String> = shape.iter().map(usize::to_string).collect();
    // Python's tuple of one has a comma behind it.
    let comma = if lengths.len() == 1 { "," } else { "" };
    let lengths = lengths.join(", ");
    let text = format!("{{'descr': '{element}', 'fortran_order': False, 'shape': ({lengths}{comma})}}");
    let unpadded = MARK.len() + size_of::<u16>() + text.len() + 1;
    let text = text + &" ".repeat(ALIGNMENT - unpadded % ALIGNMENT) + "\n";
    let length = u16::try_from(text.len()).map_err(io::Error::other)?;
    Ok([&MARK, &length.to_le_bytes()[..], text.as_bytes()].concat())
}

/// An array that was read.
pub struct ReadArray {
    /// Its lengths.
    pub shape: Vec<u64>,
    /// Whether the first dimension runs fastest, rather than the last.
    pub first_runs_fastest: bool,
    /// In the order of the file.
    pub numbers: Vec<f64>,
}

/// An archive that is read.
pub struct NpzReader {
    archive: ZipArchive<BufReader<File>>,
}

impl NpzReader {
    /// Opens an archive.
    pub fn new(file: File) -> io::Result<Self> {
        Ok(Self { archive: ZipArchive::new(BufReader::new(file))? })
    }

    /// The names of the arrays.
    pub fn names(&self) -> io::Result<Vec<String>> {
        let name = |name: &str| name.strip_suffix(NPY).unwrap_or(name).to_owned();
        self.archive.file_names().map(|file| Ok(name(&file?))).collect()
    }

    /// Reads an array of single or double precision.
    ///
    /// # Arguments
    /// * `name` - of the array
    /// * `most` - numbers that it may have: a few bytes of a compressed file may stand for any number
    pub fn floats(&mut self, name: &str, most: u64) -> io::Result<ReadArray> {
        let mut file = self.archive.by_name(&format!("{name}{NPY}"))?;
        let there = file.size();
        let header = NpyHeader::read(&mut file)?;
        let stored = match &header.fields[..] {
            [Field { name, numbers: Ok(stored), .. }] if name.is_empty() => *stored,
            _ => return Err(io::Error::other("it holds no numbers")),
        };
        if !matches!(stored.kind, NumberKind::F32 | NumberKind::F64) {
            let problem = format!("it holds {}; must be float64 or float32", stored.kind.name());
            return Err(io::Error::other(problem));
        }
        let elements = header.elements().filter(|_| header.file_bytes().is_some_and(|bytes| bytes <= there));
        let elements = elements.ok_or_else(|| io::Error::other("it ends too early"))?;
        if elements > most {
            return Err(io::Error::other(format!("it holds {elements} numbers; must be at most {most}")));
        }
        let mut numbers = Vec::new();
        read_records(&mut file, stored.element_bytes(), elements, |block| {
            stored.append(block, 1, 0, &mut numbers);
        })?;
        // The checksum is compared at the end of the array.
        io::copy(&mut file.by_ref(), &mut io::sink())?;
        Ok(ReadArray { shape: header.shape, first_runs_fastest: header.first_runs_fastest, numbers })
    }
}
