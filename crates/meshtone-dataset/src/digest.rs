//! The length and the SHA-256 of a file, which prove that its bytes are unchanged.

use std::io::{self, Write};

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

/// Length and SHA-256 of some bytes.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digest {
    /// (bytes) Length.
    pub bytes: u64,
    /// SHA-256, 64 hexadecimal digits.
    pub sha256: String,
}

impl Digest {
    /// The digest of bytes in memory.
    ///
    /// # Arguments
    /// * `bytes` - all of them
    pub fn of(bytes: &[u8]) -> Self {
        Self { bytes: bytes.len() as u64, sha256: hexadecimal(Sha256::digest(bytes)) }
    }
}

fn hexadecimal(hash: impl IntoIterator<Item = u8>) -> String {
    hash.into_iter().fold(String::new(), |text, byte| format!("{text}{byte:02x}"))
}

/// A writer that passes on what is written to it and computes its digest.
pub(crate) struct Hashing<W> {
    to: W,
    hash: Sha256,
    bytes: u64,
}

impl<W: Write> Hashing<W> {
    /// Creates a writer to which nothing has been written yet.
    pub fn new(to: W) -> Self {
        Self { to, hash: Sha256::new(), bytes: 0 }
    }

    /// The digest of everything that has been written.
    pub fn digest(&self) -> Digest {
        Digest { bytes: self.bytes, sha256: hexadecimal(self.hash.clone().finalize()) }
    }
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let written = self.to.write(buffer)?;
        self.hash.update(&buffer[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    /// FIPS 180-2, appendix B.1.
    const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

    #[test]
    fn written_in_pieces_and_at_once() {
        let mut hashing = Hashing::new(Vec::new());
        hashing.write_all(b"a").unwrap();
        hashing.write_all(b"bc").unwrap();
        assert_eq!(hashing.digest(), Digest::of(b"abc"));
        assert_eq!((hashing.to.as_slice(), hashing.digest().bytes), (&b"abc"[..], 3));
        assert_eq!(hashing.digest().sha256, ABC);
    }
}
