//! An object that is read like a file.

use std::io::{self, BufReader, Read};
use std::sync::Arc;

use object_store::path::Path;
use object_store::{ObjectStore, ObjectStoreExt};
use parquet::file::reader::{ChunkReader, Length};

use super::object::wait;

/// (bytes) Largest size of a request.
const FETCHED: u64 = 1 << 20;

/// An object of known length, which is read from its start or from another position to its end.
#[derive(Clone)]
pub(super) struct RemoteFile {
    pub store: Arc<dyn ObjectStore>,
    pub path: Path,
    pub length: u64,
    /// (bytes) Position from which the object is read.
    pub position: u64,
}

impl RemoteFile {
    fn fetch(&self, start: u64, length: u64) -> io::Result<bytes::Bytes> {
        let end = start.saturating_add(length).min(self.length);
        wait(self.store.get_range(&self.path, start..end))
    }
}

impl Length for RemoteFile {
    fn len(&self) -> u64 {
        self.length
    }
}

impl ChunkReader for RemoteFile {
    type T = BufReader<Self>;

    fn get_read(&self, start: u64) -> parquet::errors::Result<Self::T> {
        Ok(BufReader::with_capacity(FETCHED as usize, Self { position: start, ..self.clone() }))
    }

    fn get_bytes(&self, start: u64, length: usize) -> parquet::errors::Result<bytes::Bytes> {
        Ok(self.fetch(start, length as u64)?)
    }
}

impl Read for RemoteFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.position >= self.length || buffer.is_empty() {
            return Ok(0);
        }
        let bytes = self.fetch(self.position, (buffer.len() as u64).min(FETCHED))?;
        buffer[..bytes.len()].copy_from_slice(&bytes);
        self.position += bytes.len() as u64;
        Ok(bytes.len())
    }
}
