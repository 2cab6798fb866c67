//! Blocks of whole lines of a file.

use std::io::{self, Read};

/// Bytes of a block.
const BLOCK_BYTES: usize = 1 << 20;
/// Longest line; a file with a longer one is no table.
const MAX_LINE_BYTES: usize = 1 << 24;

/// Reads a file in blocks that end where a line ends.
pub(super) struct Blocks<R> {
    from: R,
    buffer: Vec<u8>,
    /// Bytes at the start of the buffer that were handed over, and those behind that were read.
    handed: usize,
    filled: usize,
}

impl<R: Read> Blocks<R> {
    pub(super) fn new(from: R) -> Blocks<R> {
        Blocks { from, buffer: vec![0; BLOCK_BYTES], handed: 0, filled: 0 }
    }

    /// The next lines; empty at the end of the file. The last line may have no end.
    pub(super) fn next(&mut self) -> io::Result<&mut [u8]> {
        self.buffer.copy_within(self.handed..self.filled, 0);
        self.filled -= self.handed;
        self.handed = 0;
        loop {
            let searched = self.filled;
            let read = read_some(&mut self.from, &mut self.buffer[searched..])?;
            self.filled += read;
            if read == 0 && self.filled < self.buffer.len() {
                self.handed = self.filled;
                break;
            }
            if let Some(end) = self.buffer[searched..self.filled].iter().rposition(|byte| *byte == b'\n') {
                self.handed = searched + end + 1;
                break;
            }
            if self.filled == self.buffer.len() {
                if self.buffer.len() >= MAX_LINE_BYTES {
                    return Err(io::Error::new(
                        io::ErrorKind::InvalidData,
                        "it has a line of more than 16 MiB",
                    ));
                }
                self.buffer.resize(2 * self.buffer.len(), 0);
            }
        }
        Ok(&mut self.buffer[..self.handed])
    }
}

/// Fills as much as there is; less only at the end of the file.
fn read_some(from: &mut impl Read, to: &mut [u8]) -> io::Result<usize> {
    let mut filled = 0;
    while filled < to.len() {
        match from.read(&mut to[filled..]) {
            Ok(0) => break,
            Ok(read) => filled += read,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(filled)
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
