//! Files that are read: what kind they must be of, and how much is taken of them.

use std::fs::{File, FileType};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use crate::memory;

/// (bytes) Most that is taken of a pipe or device: how much will come cannot be known beforehand.
const MOST_STREAMED_BYTES: u64 = 64 << 20;
/// (bytes) Memory that a byte of TOML or JSON may take once it is read: a number of two characters becomes a value with its place.
const MEMORY_PER_BYTE_OF_TEXT: u64 = 64;
/// (bytes) Memory that a byte of a table may take: a number of two characters becomes one of eight bytes, and a column that grows is
/// there twice, one half as large as the other.
pub(crate) const MEMORY_PER_BYTE_OF_NUMBERS: u64 = 12;
/// Where systems keep what a shell hands over, as `/dev/stdin` and `/dev/fd/63`.
const OF_THE_SHELL: [&str; 2] = ["/dev", "/proc"];

/// Opens a file that is read at several places, so that only an ordinary one will do.
pub(crate) fn open_ordinary(path: &Path) -> io::Result<File> {
    let Some(what) = special(path.metadata()?.file_type()) else { return File::open(path) };
    let problem = format!("it is {what}; must be an ordinary file: write its content into one first");
    Err(io::Error::new(ErrorKind::InvalidInput, problem))
}

/// Opens a file that is read from its start to its end: an ordinary one, or what a shell hands over.
///
/// # Arguments
/// * `path` - the file
/// * `memory_per_byte` - (bytes) of memory that a byte of the file may take once it is read
///
/// # Errors
/// It cannot be opened; a pipe with a name, to which perhaps no program writes; more than the memory that is allowed.
/// A file that turns out to be too large is an error while it is read.
pub(crate) fn open_stream(path: &Path, memory_per_byte: u64) -> io::Result<LimitedFile<File>> {
    let metadata = path.metadata()?;
    let limit = memory::limit();
    let of_memory = limit.bytes() / memory_per_byte;
    let Some(what) = special(metadata.file_type()) else {
        let needed = metadata.len().saturating_mul(memory_per_byte);
        if let Some(objection) = limit.objection(needed) {
            let problem = format!(
                "its {} bytes of text {objection}; shorten it, or raise the memory limit",
                metadata.len()
            );
            return Err(io::Error::new(ErrorKind::FileTooLarge, problem));
        }
        let problem =
            format!("it has more than {of_memory} bytes, which is all that the memory limit allows");
        return Ok(LimitedFile { from: File::open(path)?, left: of_memory, problem });
    };
    // Opening a pipe with a name would wait until a program writes to it.
    if what == NAMED_PIPE && !OF_THE_SHELL.iter().any(|folder| path.starts_with(folder)) {
        let problem = "it is a pipe with a name, to which possibly no program writes; write its content into an ordinary file first";
        return Err(io::Error::new(ErrorKind::InvalidInput, problem));
    }
    let left = MOST_STREAMED_BYTES.min(of_memory);
    let problem = format!("it is {what} and brings more than {left} bytes, as an ordinary file may");
    Ok(LimitedFile { from: File::open(path)?, left, problem })
}

/// Reads a whole file of TOML or JSON.
pub(crate) fn read_document(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_stream(path, MEMORY_PER_BYTE_OF_TEXT)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A file that is read up to a length; more is an error, unlike the end that [`Read::take`] makes of it.
#[derive(Debug)]
pub(crate) struct LimitedFile<R> {
    from: R,
    left: u64,
    problem: String,
}

impl<R: Read> Read for LimitedFile<R> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        if self.left == 0 {
            return match self.from.read(&mut [0])? {
                0 => Ok(0),
                _ => Err(io::Error::new(ErrorKind::FileTooLarge, self.problem.clone())),
            };
        }
        let most = to.len().min(usize::try_from(self.left).unwrap_or(usize::MAX));
        let read = self.from.read(&mut to[..most])?;
        self.left -= read as u64;
        Ok(read)
    }
}

const NAMED_PIPE: &str = "a pipe";

/// What a file is that is no ordinary one. A directory is left to the error of opening it.
fn special(kind: FileType) -> Option<&'static str> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;

        if kind.is_fifo() {
            return Some(NAMED_PIPE);
        }
        if kind.is_socket() {
            return Some("a socket");
        }
    }
    (!kind.is_file() && !kind.is_dir()).then_some("a device")
}
