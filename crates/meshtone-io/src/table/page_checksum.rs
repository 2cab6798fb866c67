//! Pages with checksums.
//!
//! The `parquet` crate compares the checksums of pages and writes none. One stands in its page's header, which is written in Thrift's
//! compact protocol: each field says of what type it is and by how much its number is above that of the field before. The headers
//! themselves have checksums in the table's metadata: the crate would read a page with a changed header as other values, or panic.

use std::fmt::Write as _;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

use bytes::Bytes;
use parquet::column::page::{CompressedPage, PageWriteSpec, PageWriter};
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};
use parquet::file::writer::{SerializedPageWriter, TrackedWrite};

/// Key of the headers' checksums, of eight digits: first those of the first column's pages in the first group of rows, then a comma.
pub(super) const KEY: &str = "meshtone.page_headers_crc32";
/// Digits of a checksum.
const DIGITS: usize = 8;
/// Between a column's checksums and the next one's.
pub(super) const BETWEEN_COLUMNS: char = ',';
/// Fields of a header before the checksum: the page's kind, and its sizes.
const BEFORE: usize = 3;
/// The checksum's field: a step of one, and an integer of 32 bits.
const CHECKSUM: u8 = 0x15;
/// A step of one, as it stands in a field's first byte.
const STEP: u8 = 0x10;
/// Set in all bytes of a number but its last.
const MORE: u8 = 0x80;

/// Writes pages, each with the CRC-32 of what follows its header.
pub(super) struct ChecksummedPages<'p> {
    pub to: &'p mut Vec<u8>,
    /// Checksums of the headers.
    pub headers: &'p mut String,
}

impl PageWriter for ChecksummedPages<'_> {
    fn write_page(&mut self, page: CompressedPage) -> Result<PageWriteSpec> {
        let (checksum, length) = (crc32fast::hash(page.data()), page.compressed_size());
        let start = self.to.len();
        let mut to = TrackedWrite::new(&mut *self.to);
        let mut written = SerializedPageWriter::new(&mut to).write_page(page)?;
        to.flush()?;
        drop(to);
        let place = start + place(&self.to[start..]).ok_or_else(|| broken("a page without a header"))?;
        let mut field = vec![CHECKSUM];
        push_number(&mut field, checksum.cast_signed());
        self.to[place] -= STEP;
        let added = field.len();
        self.to.splice(place..place, field);
        let header = &self.to[start..self.to.len() - length];
        // A text takes everything.
        let _ = write!(self.headers, "{:0DIGITS$x}", crc32fast::hash(header));
        written.offset = start as u64;
        written.bytes_written += added as u64;
        written.compressed_size += added;
        written.uncompressed_size += added;
        Ok(written)
    }

    fn close(&mut self) -> Result<()> {
        Ok(())
    }
}

fn broken(problem: &str) -> ParquetError {
    ParquetError::General(problem.to_owned())
}

/// Where the field behind the sizes begins.
fn place(header: &[u8]) -> Option<usize> {
    (0..BEFORE).try_fold(0, |at, _| {
        let number = at + 1;
        let last = header.get(number..)?.iter().position(|byte| byte & MORE == 0)?;
        Some(number + last + 1)
    })
}

/// Adds a number: sign last, seven bits a byte, the lowest first.
fn push_number(to: &mut Vec<u8>, number: i32) {
    let mut rest = ((number << 1) ^ (number >> 31)).cast_unsigned();
    while rest >= MORE.into() {
        to.push(rest as u8 | MORE);
        rest >>= 7;
    }
    to.push(rest as u8);
}

/// The checksums of a table's headers, by columns in groups of rows; none in files of others.
pub(super) fn of_headers(list: &str) -> Vec<Vec<u32>> {
    let checksum = |digits: &[u8]| u32::from_str_radix(str::from_utf8(digits).ok()?, 16).ok();
    list.split_terminator(BETWEEN_COLUMNS)
        .map(|column| column.as_bytes().chunks(DIGITS).filter_map(checksum).collect())
        .collect()
}

/// A file of which pages are read one after the other, each header compared with its checksum before its page is decoded.
pub(super) struct CheckedPages<R> {
    file: Arc<R>,
    headers: Vec<u32>,
    /// Where reading began last, and before that: a header, or what follows one that was looked at beforehand.
    started: AtomicU64,
    started_before: AtomicU64,
    /// Pages that have been read.
    pages: AtomicUsize,
}

impl<R> CheckedPages<R> {
    pub fn new(file: Arc<R>, headers: Vec<u32>) -> Self {
        Self {
            file,
            headers,
            started: AtomicU64::new(0),
            started_before: AtomicU64::new(0),
            pages: AtomicUsize::new(0),
        }
    }
}

impl<R: ChunkReader> Length for CheckedPages<R> {
    fn len(&self) -> u64 {
        self.file.len()
    }
}

impl<R: ChunkReader> ChunkReader for CheckedPages<R> {
    type T = R::T;

    /// Reads a header.
    fn get_read(&self, start: u64) -> Result<Self::T> {
        self.started_before.store(self.started.swap(start, Ordering::Relaxed), Ordering::Relaxed);
        self.file.get_read(start)
    }

    /// Reads what follows the header.
    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        let header = match self.started.load(Ordering::Relaxed) {
            // The end of a list is known by the next page's header, which is looked at before its page is read.
            last if last == start => self.started_before.load(Ordering::Relaxed),
            last => last,
        };
        let before = usize::try_from(start.saturating_sub(header))?;
        let page = self.file.get_bytes(header, before + length)?;
        let checksum = self.headers.get(self.pages.fetch_add(1, Ordering::Relaxed));
        if checksum != Some(&crc32fast::hash(&page[..before])) {
            return Err(broken("a page's header is not as it was written: the CRC-32 differs"));
        }
        Ok(page.slice(before..))
    }
}
