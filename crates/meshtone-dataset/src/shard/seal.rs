//! The seal of a shard: the SHA-256 of its file, which stands in the file's own footer.
//!
//! The seal's digits count as zeros in what is hashed, so that it proves every bit of the file, itself included. It is computed while the
//! file is written, and not from the disk.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

use meshtone_io::table::{SEAL, UNKNOWN_HASH, place_of_hash};

use crate::digest::{Digest, Hashing};

/// (bytes) The end of a file in which its seal lies: behind it stand the hash of the metadata and two bytes a column.
const TAIL: usize = 1 << 16;
/// (bytes) Size of the pieces in which a file is read.
const READ_BYTES: u64 = 1 << 20;

/// Puts the seal into a file that is written to its end.
///
/// # Arguments
/// * `file` - the file, open for reading and writing
/// * `hash` - of what has been written
pub(crate) fn seal(file: &mut File, hash: &str) -> io::Result<()> {
    let end = file.seek(SeekFrom::End(0))?;
    let from = file.seek(SeekFrom::Start(end.saturating_sub(TAIL as u64)))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let place =
        place_of_hash(&tail, SEAL).ok_or_else(|| io::Error::other("the footer has no place for a seal"))?;
    file.seek(SeekFrom::Start(from + place.start as u64))?;
    file.write_all(hash.as_bytes())?;
    file.seek(SeekFrom::End(0)).map(drop)
}

/// Reads a shard from its start to its end. Returns its size and its seal; none where it is not as it was written.
pub(crate) fn proven(mut from: impl Read) -> io::Result<Option<Digest>> {
    let (mut hashing, mut tail) = (Hashing::new(io::sink()), Vec::new());
    // What may hold the seal is hashed last.
    while from.by_ref().take(READ_BYTES).read_to_end(&mut tail)? > 0 {
        let settled = tail.len().saturating_sub(TAIL);
        hashing.write_all(&tail[..settled])?;
        tail.drain(..settled);
    }
    let Some(place) = place_of_hash(&tail, SEAL) else { return Ok(None) };
    let digits = &mut tail[place];
    let stated = String::from_utf8_lossy(digits).into_owned();
    digits.copy_from_slice(UNKNOWN_HASH.as_bytes());
    hashing.write_all(&tail)?;
    Ok(Some(hashing.digest()).filter(|found| found.sha256 == stated))
}
