//! Checksums of a column's part of a group of rows, which the table's metadata list: those of pages leave their headers out.

use std::fmt::Write as _;

use bytes::Bytes;
use bytes::buf::Reader;
use flate2::Crc;
use parquet::errors::{ParquetError, Result};
use parquet::file::reader::{ChunkReader, Length};

/// Key of the list: eight digits a part, those of the first group of rows first.
pub(super) const KEY: &str = "meshtone.column_chunks_crc32";
/// Digits of a checksum.
const DIGITS: usize = 8;

/// The CRC-32 of bytes.
pub(super) fn crc32(bytes: &[u8]) -> u32 {
    let mut checksum = Crc::new();
    checksum.update(bytes);
    checksum.sum()
}

/// Adds a checksum to the list.
pub(super) fn push(list: &mut String, bytes: &[u8]) {
    // A text takes everything.
    let _ = write!(list, "{:0DIGITS$x}", crc32(bytes));
}

/// The checksum of a part; none in files of others.
///
/// # Arguments
/// * `list` - of the file
/// * `number` - of the part
pub(super) fn stated(list: &str, number: usize) -> Option<u32> {
    let start = DIGITS * number;
    u32::from_str_radix(list.get(start..start + DIGITS)?, 16).ok()
}

/// A part of a file, of which all has been read.
pub(super) struct Chunk {
    /// Where in the file it begins.
    start: u64,
    bytes: Bytes,
}

impl Chunk {
    /// Reads a part.
    ///
    /// # Errors
    /// The file cannot be read, or has other bytes there than were written.
    pub fn read(file: &impl ChunkReader, (start, length): (u64, u64), checksum: u32) -> Result<Self> {
        let bytes = file.get_bytes(start, usize::try_from(length)?)?;
        if crc32(&bytes) == checksum {
            Ok(Self { start, bytes })
        } else {
            Err(ParquetError::General(
                "its bytes are not those that were written: the CRC-32 differs".to_owned(),
            ))
        }
    }

    fn place(&self, start: u64) -> Result<u64> {
        start.checked_sub(self.start).ok_or_else(|| ParquetError::EOF("a page before its column".to_owned()))
    }
}

impl Length for Chunk {
    fn len(&self) -> u64 {
        self.start + self.bytes.len() as u64
    }
}

impl ChunkReader for Chunk {
    type T = Reader<Bytes>;

    fn get_read(&self, start: u64) -> Result<Self::T> {
        self.bytes.get_read(self.place(start)?)
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        self.bytes.get_bytes(self.place(start)?, length)
    }
}
