//! Whole arrays in NumPy's archives.
//!
//! The crate `ndarray-npy` does this for arrays of the crate `ndarray`, which nothing else here needs; the headers that it reads
//! with a grammar are read by the [`recording`](crate::recording)'s reader, which has to know more of them.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Cursor, Read, Write};

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

/// An archive, in memory until it is whole: the crate `zip` ends an archive even where it is dropped after an error, and then
/// prints on standard error that it cannot.
pub struct NpzWriter {
    archive: ZipWriter<Cursor<Vec<u8>>>,
    method: CompressionMethod,
}

impl NpzWriter {
    /// Numbers as they are: those of computed signals hardly become smaller.
    pub fn stored() -> Self {
        Self { archive: ZipWriter::new(Cursor::default()), method: CompressionMethod::Stored }
    }

    /// Compressed numbers.
    pub fn compressed() -> Self {
        Self { method: CompressionMethod::Deflated, ..Self::stored() }
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

    /// Ends the archive and writes it.
    pub fn write(self, mut to: impl Write) -> io::Result<()> {
        to.write_all(self.archive.finish()?.get_ref())
    }
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
