//! Files that hold another one: compressed by gzip or ZIP, a table of Excel's, or text in UTF-16.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::error::{Problem, names};
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
        let text = byte_order(&head).map(|from_bytes| in_utf8(file, from_bytes, most)).transpose()?;
        text.map(|text| (path.to_owned(), text))
    };
    file.rewind()?;
    Ok(inside)
}

/// The only file of an archive; none of one of NumPy's arrays. Folders, and what macOS adds, do not count.
fn of_archive(path: &Path, file: &File, most: u64) -> Result<Option<(PathBuf, File)>, Problem> {
    let mut archive = ZipArchive::new(BufReader::new(file))?;
    let mut files: Vec<(usize, String)> = Vec::new();
    for index in 0..archive.len() {
        let inside = archive.by_index(index)?;
        let name = inside.name()?.into_owned();
        if name.ends_with(".npy") {
            return Ok(None);
        }
        if inside.is_file() && !name.starts_with("__MACOSX/") {
            files.push((index, name));
        }
    }
    match files.as_slice() {
        [(index, name)] => {
            let inside = written(archive.by_index(*index)?, most)?;
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

/// Text in UTF-16 as a file of UTF-8.
fn in_utf8(file: &File, from_bytes: fn([u8; 2]) -> u16, most: u64) -> Result<File, Problem> {
    let bytes = file.metadata()?.len();
    if !bytes.is_multiple_of(2) {
        return Err(io::Error::new(ErrorKind::UnexpectedEof, "half a character").into());
    }
    let mut from = BufReader::new(file);
    let mut last = Ok(());
    let units = (0..bytes / 2).map_while(|_| {
        let mut pair = [0; 2];
        last = from.read_exact(&mut pair);
        last.is_ok().then(|| from_bytes(pair))
    });
    let mut to = Unpacked::new(most)?;
    for letter in char::decode_utf16(units) {
        let letter = letter.unwrap_or(char::REPLACEMENT_CHARACTER);
        to.write(letter.encode_utf8(&mut [0; 4]).as_bytes())?;
    }
    last?;
    to.finish()
}
