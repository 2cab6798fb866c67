//! Files that hold another one: compressed by gzip or ZIP, a table of Excel's, or text in UTF-16.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::error::{Problem, names};
use super::numpy::zip_failed;
use super::workbook::sheet;
use crate::memory;

const GZIP: &[u8] = b"\x1f\x8b";
const ZIP: &[u8] = b"PK\x03\x04";
const LITTLE_ENDIAN: [u8; 2] = *b"\xff\xfe";
const BIG_ENDIAN: [u8; 2] = *b"\xfe\xff";
/// Bytes by which text in UTF-16 without a mark is known.
const LOOKED_AT: usize = 64;
/// Files inside one another: text in UTF-16 in a file of gzip in an archive.
const LAYERS: usize = 3;
/// Times as large as it is that a file may become; text of a recorder becomes some ten times as large.
const MOST_EXPANSION: u64 = 200;
/// (bytes) What any file may become.
const ALWAYS_ALLOWED: u64 = 1 << 20;

/// The file that is inside, and its name; the file itself where it is no such.
pub(super) fn unpacked(path: &Path, file: File) -> Result<(PathBuf, File), Problem> {
    let most = (file.metadata()?.len().saturating_mul(MOST_EXPANSION)).max(ALWAYS_ALLOWED);
    let most = most.min(memory::limit().bytes());
    let (mut path, mut file) = (path.to_owned(), file);
    for _ in 0..LAYERS {
        match layer(&path, &mut file, most)? {
            Some((inner_path, inner)) => (path, file) = (inner_path, inner),
            None => break,
        }
    }
    Ok((path, file))
}

/// What is inside of one; none of a file that holds no other. The file is left at its start.
fn layer(path: &Path, file: &mut File, most: u64) -> Result<Option<(PathBuf, File)>, Problem> {
    let mut head = Vec::new();
    file.take(LOOKED_AT as u64).read_to_end(&mut head)?;
    file.rewind()?;
    let inside = if head.starts_with(GZIP) {
        Some((path.with_extension(""), written(MultiGzDecoder::new(BufReader::new(&*file)), most)?))
    } else if head.starts_with(ZIP) {
        of_archive(path, file, most)?
    } else {
        let utf8 =
            byte_order(&head).map(|from_bytes| Utf8 { from: BufReader::new(&*file), from_bytes, half: None });
        utf8.map(|utf8| Ok::<_, Problem>((path.to_owned(), written(utf8, most)?))).transpose()?
    };
    file.rewind()?;
    Ok(inside)
}

/// The only file of an archive; none of one of NumPy's arrays. Folders, and what macOS adds, do not count.
fn of_archive(path: &Path, file: &File, most: u64) -> Result<Option<(PathBuf, File)>, Problem> {
    let mut archive = ZipArchive::new(BufReader::new(file)).map_err(zip_failed)?;
    let mut files: Vec<(usize, String)> = Vec::new();
    for index in 0..archive.len() {
        let inside = archive.by_index(index).map_err(zip_failed)?;
        let name = inside.name().map_err(zip_failed)?.into_owned();
        if name.ends_with(".npy") {
            return Ok(None);
        }
        if inside.is_file() && !name.starts_with("__MACOSX/") {
            files.push((index, name));
        }
    }
    match files.as_slice() {
        [(index, name)] => {
            let inside = written(archive.by_index(*index).map_err(zip_failed)?, most)?;
            Ok(Some((path.with_file_name(Path::new(name).file_name().unwrap_or_default()), inside)))
        }
        // Of a table of Excel's the text has no ending that says otherwise.
        _ if files.iter().any(|(_, name)| name == "[Content_Types].xml") => {
            Ok(Some((path.with_extension("txt"), sheet(&mut archive, most)?)))
        }
        _ => {
            let all: Vec<String> = files.into_iter().map(|(_, name)| name).collect();
            Err(Problem::Refused(format!(
                "is a ZIP archive of {} files; unpack it: {}",
                all.len(),
                names(&all)
            )))
        }
    }
}

/// A file without a name that holds what is read, up to a size.
fn written(from: impl Read, most: u64) -> Result<File, Problem> {
    let mut from = BufReader::new(from);
    let mut to = Unpacked::new(most)?;
    loop {
        let block = io::BufRead::fill_buf(&mut from)?;
        if block.is_empty() {
            return to.finish();
        }
        to.write(block)?;
        let length = block.len();
        io::BufRead::consume(&mut from, length);
    }
}

/// A file without a name that is written, up to a size.
pub(super) struct Unpacked {
    to: BufWriter<File>,
    pub(super) left: u64,
    most: u64,
}

impl Unpacked {
    /// * `most` - (bytes) the size
    pub(super) fn new(most: u64) -> Result<Self, Problem> {
        let file = tempfile::tempfile_in(std::env::temp_dir()).map_err(elsewhere)?;
        Ok(Self { to: BufWriter::new(file), left: most, most })
    }

    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<(), Problem> {
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or_else(|| {
            Problem::Refused(format!("unpacked it has more than {} MiB; unpack it first", self.most >> 20))
        })?;
        self.to.write_all(bytes).map_err(elsewhere)
    }

    /// The file, at its start.
    pub(super) fn finish(self) -> Result<File, Problem> {
        let mut file = self.to.into_inner().map_err(|error| elsewhere(error.into_error()))?;
        file.rewind().map_err(elsewhere)?;
        Ok(file)
    }
}

/// What goes wrong with the temporary file is not said of the recording.
fn elsewhere(error: io::Error) -> Problem {
    Problem::Refused(format!("cannot be unpacked into {}: {error}", std::env::temp_dir().display()))
}

/// How text in UTF-16 makes a number of two bytes: by its mark, or by the zeros of its first characters, which are Latin.
fn byte_order(head: &[u8]) -> Option<fn([u8; 2]) -> u16> {
    let (pairs, _) = head.as_chunks::<2>();
    let all = |is_so: fn(&[u8; 2]) -> bool| pairs.len() > 1 && pairs.iter().all(is_so);
    match *pairs.first()? {
        LITTLE_ENDIAN => Some(u16::from_le_bytes),
        BIG_ENDIAN => Some(u16::from_be_bytes),
        _ if all(|pair| pair[0] != 0 && pair[1] == 0) => Some(u16::from_le_bytes),
        _ if all(|pair| pair[0] == 0 && pair[1] != 0) => Some(u16::from_be_bytes),
        _ => None,
    }
}

/// Text in UTF-16, read as UTF-8.
struct Utf8<R> {
    from: R,
    from_bytes: fn([u8; 2]) -> u16,
    /// The first half of a character of four bytes.
    half: Option<u16>,
}

impl<R: Read> Read for Utf8<R> {
    /// As many characters as fit: one of two bytes becomes three at most. A buffer that does not hold one is an error.
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let mut bytes = Vec::new();
        let most = (to.len().saturating_sub(4) / 4 * 2) as u64;
        self.from.by_ref().take(most).read_to_end(&mut bytes)?;
        let (pairs, rest) = bytes.as_chunks::<2>();
        if !rest.is_empty() {
            return Err(io::Error::new(ErrorKind::UnexpectedEof, "half a character"));
        }
        let units = pairs.iter().map(|pair| (self.from_bytes)(*pair));
        let mut units: Vec<u16> = self.half.take().into_iter().chain(units).collect();
        // The other half comes with the next bytes.
        if bytes.len() as u64 == most && units.last().is_some_and(|unit| (0xd800..0xdc00).contains(unit)) {
            self.half = units.pop();
        }
        let text = String::from_utf16_lossy(&units);
        to.get_mut(..text.len()).ok_or(ErrorKind::InvalidInput)?.copy_from_slice(text.as_bytes());
        Ok(text.len())
    }
}
