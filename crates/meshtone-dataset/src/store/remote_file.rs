//! An object that is read like a file.

use std::io::{self, BufReader, Read};
use std::sync::Arc;

use object_store::path::Path;
use object_store::{ObjectStore, ObjectStoreExt};
use parquet::file::reader::{ChunkReader, Length};

use super::object::wait;

/// (bytes) What is fetched at once.
const FETCHED: u64 = 1 << 20;

/// An object of known length.
pub(super) struct RemoteFile {
    pub store: Arc<dyn ObjectStore>,
    pub path: Path,
    pub length: u64,
}

impl RemoteFile {
    /// Reads from a place to the end.
    pub fn reader(&self, start: u64) -> RemoteReader {
        RemoteReader { store: self.store.clone(), path: self.path.clone(), length: self.length, place: start }
    }

    fn bytes(&self, start: u64, length: usize) -> io::Result<bytes::Bytes> {
        let end = start.saturating_add(length as u64).min(self.length);
        wait(self.store.get_range(&self.path, start..end))
    }
}

impl Length for RemoteFile {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for RemoteFile {
    type T = BufReader<RemoteReader>;

    fn get_read(&self, start: u64) -> parquet::errors::Result<Self::T> {
        Ok(BufReader::with_capacity(FETCHED as usize, self.reader(start)))
    }

    fn get_bytes(&self, start: u64, length: usize) -> parquet::errors::Result<bytes::Bytes> {
        Ok(self.bytes(start, length)?)
    }
}

/// Reads an object from its start to its end.
pub(super) struct RemoteReader {
    store: Arc<dyn ObjectStore>,
    path: Path,
    length: u64,
    place: u64,
}

impl Read for RemoteReader {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let end = (self.place + (buffer.len() as u64).min(FETCHED)).min(self.length);
        if end <= self.place {
            return Ok(0);
        }
        let bytes = wait(self.store.get_range(&self.path, self.place..end))?;
        buffer[..bytes.len()].copy_from_slice(&bytes);
        self.place += bytes.len() as u64;
        Ok(bytes.len())
    }
}
