//! The SHA-256 of a table's metadata, which stands among them. Checksums of pages prove the rest of the file.
//!
//! Where it is computed, its own digits count as zeros, and so do those of a seal, which are put in later.

use std::io::{self, Write};
use std::ops::Range;

use parquet::errors::{ParquetError, Result};
use parquet::file::FOOTER_SIZE;
use parquet::file::metadata::{FooterTail, ParquetMetaData, ParquetMetaDataReader};
use parquet::file::reader::ChunkReader;
use sha2::{Digest, Sha256};

use super::page_checksum;

/// What a file begins with.
const MARK: &[u8] = b"PAR1";
/// Key of the hash.
pub(super) const KEY: &str = "meshtone.metadata_sha256";
/// Key of the hash of a whole file.
pub const SEAL: &str = "meshtone.seal";
/// What stands in the place of a hash until it is known.
pub const UNKNOWN_HASH: &str = "0000000000000000000000000000000000000000000000000000000000000000";
/// (bytes) Of Thrift between key and value: the value's type and its length.
const BETWEEN: usize = 2;

/// Where the digits of a hash lie.
///
/// # Arguments
/// * `bytes` - the end of a file, or its metadata
/// * `key` - of the hash
pub fn place_of_hash(bytes: &[u8], key: &str) -> Option<Range<usize>> {
    let found = bytes.windows(key.len()).rposition(|window| window == key.as_bytes())?;
    let start = found + key.len() + BETWEEN;
    let digits = start..start + UNKNOWN_HASH.len();
    (digits.end <= bytes.len()).then_some(digits)
}

fn hash(mut metadata: Vec<u8>) -> String {
    for key in [KEY, SEAL] {
        if let Some(digits) = place_of_hash(&metadata, key) {
            metadata[digits].copy_from_slice(UNKNOWN_HASH.as_bytes());
        }
    }
    Sha256::digest(metadata).iter().fold(String::new(), |text, byte| format!("{text}{byte:02x}"))
}

/// Reads the metadata of a file.
///
/// # Errors
/// The file is no Parquet file, or states another hash than its metadata have.
pub(super) fn read(file: &impl ChunkReader) -> Result<ParquetMetaData> {
    let Some(end) = file.len().checked_sub(FOOTER_SIZE as u64) else {
        return Err(ParquetError::EOF(format!("it has only {} bytes", file.len())));
    };
    let length = FooterTail::try_from(&*file.get_bytes(end, FOOTER_SIZE)?)?.metadata_length();
    let Some(start) = end.checked_sub(length as u64) else {
        return Err(ParquetError::EOF(format!("it is shorter than its metadata, which have {length} bytes")));
    };
    let tail = file.get_bytes(start, length + FOOTER_SIZE)?;
    let metadata = &tail[..length];
    let is_changed = match place_of_hash(metadata, KEY) {
        Some(digits) => metadata[digits] != *hash(metadata.to_vec()).as_bytes(),
        // Whoever writes checksums of headers writes the hash: its key has been changed.
        None => place_of_hash(metadata, page_checksum::KEY).is_some(),
    };
    if file.get_bytes(0, MARK.len())? != *MARK {
        return Err(ParquetError::General("it does not begin as Parquet files do".to_owned()));
    }
    if is_changed {
        return Err(ParquetError::General(
            "its metadata are not those that were written: the SHA-256 differs".to_owned(),
        ));
    }
    ParquetMetaDataReader::new().parse_and_finish(&tail)
}

/// Where a table is written to. Its metadata wait until their hash is among them.
pub(super) struct HashedMetadata<W> {
    to: W,
    /// What is at the file's end, with the metadata, once they are written.
    end: Option<Vec<u8>>,
}

impl<W: Write> HashedMetadata<W> {
    pub fn new(to: W) -> Self {
        Self { to, end: None }
    }

    /// Says that only the file's end is still written.
    pub fn begin_end(&mut self) {
        self.end = Some(Vec::new());
    }

    /// Puts the hash in and writes the file's end.
    pub fn finish(mut self) -> io::Result<()> {
        let mut end = self.end.unwrap_or_default();
        let behind = end.len().saturating_sub(FOOTER_SIZE);
        let length = FooterTail::try_from(&end[behind..]).map_err(io::Error::other)?.metadata_length();
        let metadata = &mut end[behind.saturating_sub(length)..behind];
        let digits = place_of_hash(metadata, KEY)
            .ok_or_else(|| io::Error::other("the metadata have no place for a hash"))?;
        let hash = hash(metadata.to_vec());
        metadata[digits].copy_from_slice(hash.as_bytes());
        self.to.write_all(&end)?;
        self.to.flush()
    }
}

impl<W: Write> Write for HashedMetadata<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.end {
            Some(end) => end.write(bytes),
            None => self.to.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}
