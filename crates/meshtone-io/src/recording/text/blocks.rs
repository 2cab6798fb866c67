//! Blocks of whole lines of a file.

use std::io::{self, Read};

use crate::recording::fields::invalid;

/// Bytes of a block.
const BLOCK_BYTES: usize = 1 << 20;
/// Longest line; a file with a longer one is no table.
const MAX_LINE_BYTES: usize = 1 << 24;

/// Reads a file in blocks that end where a line ends.
pub(super) struct Blocks<R> {
    from: R,
    buffer: Vec<u8>,
    /// Bytes that the buffer is filled with.
    block_bytes: usize,
    /// Bytes at the start of the buffer that were handed over.
    handed: usize,
}

impl<R: Read> Blocks<R> {
    pub(super) fn new(from: R) -> Blocks<R> {
        Blocks { from, buffer: Vec::with_capacity(BLOCK_BYTES), block_bytes: BLOCK_BYTES, handed: 0 }
    }

    /// The next lines; empty at the end of the file. The last line may have no end.
    pub(super) fn next(&mut self) -> io::Result<&mut [u8]> {
        self.buffer.drain(..self.handed);
        loop {
            let searched = self.buffer.len();
            let room = self.block_bytes - searched;
            let read = self.from.by_ref().take(room as u64).read_to_end(&mut self.buffer)?;
            if let Some(end) = self.buffer[searched..].iter().rposition(|byte| *byte == b'\n') {
                self.handed = searched + end + 1;
                break;
            }
            if read < room {
                self.handed = self.buffer.len();
                break;
            }
            if self.block_bytes >= MAX_LINE_BYTES {
                return Err(invalid("it has a line of more than 16 MiB"));
            }
            self.block_bytes *= 2;
        }
        Ok(&mut self.buffer[..self.handed])
    }
}

#[cfg(test)]
mod tests {
    use super::Blocks;

    #[test]
    fn blocks_end_where_lines_do() {
        let line = [b"x".repeat(700_000), b"\n".to_vec()].concat();
        let long = [b"y".repeat(3_000_000), b"\nz".to_vec()].concat();
        let text = [line.repeat(3), long].concat();
        let mut blocks = Blocks::new(&text[..]);
        let mut read = Vec::new();
        loop {
            let block = blocks.next().unwrap();
            if block.is_empty() {
                break;
            }
            assert!(block.ends_with(b"\n") || block == b"z");
            read.extend_from_slice(block);
        }
        assert!(read == text);
        assert!(Blocks::new(&vec![b'x'; 20_000_000][..]).next().is_err());
    }
}
