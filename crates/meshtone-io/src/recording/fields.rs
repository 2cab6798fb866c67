//! Numbers and texts of a header in binary, one behind the other.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};

/// What is left of a block of bytes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'b> {
    pub left: &'b [u8],
    pub big_endian: bool,
}

impl<'b> Fields<'b> {
    /// The next bytes; fewer are an error.
    pub(super) fn bytes(&mut self, count: u64) -> io::Result<&'b [u8]> {
        let count = usize::try_from(count).map_err(|_| ErrorKind::UnexpectedEof)?;
        let (bytes, left) = self.left.split_at_checked(count).ok_or(ErrorKind::UnexpectedEof)?;
        self.left = left;
        Ok(bytes)
    }

    /// The next number, its bytes the lowest first.
    fn number<const SIZE: usize>(&mut self) -> io::Result<[u8; SIZE]> {
        let mut bytes = [0; SIZE];
        bytes.copy_from_slice(self.bytes(SIZE as u64)?);
        if self.big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    pub(super) fn u8(&mut self) -> io::Result<u8> {
        self.number().map(u8::from_le_bytes)
    }

    pub(super) fn u16(&mut self) -> io::Result<u16> {
        self.number().map(u16::from_le_bytes)
    }

    pub(super) fn u32(&mut self) -> io::Result<u32> {
        self.number().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> io::Result<u64> {
        self.number().map(u64::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> io::Result<f64> {
        self.number().map(f64::from_le_bytes)
    }
}

/// The error of a file that does not follow the rules of its format.
pub(super) fn invalid(problem: impl Into<String>) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, problem.into())
}

/// Bytes of a file, which must be there.
pub(super) fn block(mut file: &File, at: u64, bytes: u64) -> io::Result<Vec<u8>> {
    file.seek(SeekFrom::Start(at))?;
    let mut block = Vec::new();
    file.take(bytes).read_to_end(&mut block)?;
    if (block.len() as u64) < bytes { Err(ErrorKind::UnexpectedEof.into()) } else { Ok(block) }
}
