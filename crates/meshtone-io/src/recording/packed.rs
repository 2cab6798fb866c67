//! Files that hold another one: compressed by gzip or ZIP, or text in UTF-16.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use zip::ZipArchive;

use super::error::Problem;
use crate::memory;

const GZIP: &[u8] = b"\x1f\x8b";
const ZIP: &[u8] = b"PK\x03\x04";
const LITTLE_ENDIAN: [u8; 2] = *b"\xff\xfe";
const BIG_ENDIAN: [u8; 2] = *b"\xfe\xff";
/// Bytes by which text in UTF-16 without a mark is known.
const LOOKED_AT: usize = 64;

/// The file that is inside, and its name; the file itself where it is no such.
pub(super) fn unpacked(path: &Path, mut file: File) -> Result<(PathBuf, File), Problem> {
    let mut head = [0; LOOKED_AT];
    let length = file.read(&mut head)?;
    let head = &head[..length];
    file.rewind()?;
    if head.starts_with(GZIP) {
        let inside = written(MultiGzDecoder::new(BufReader::new(file)))?;
        return Ok((path.with_extension(""), inside));
    }
    if head.starts_with(ZIP) {
        return only_one(path, file);
    }
    match byte_order(head) {
        Some(from_bytes) => Ok((path.to_owned(), written(Utf8::new(BufReader::new(file), from_bytes))?)),
        None => Ok((path.to_owned(), file)),
    }
}

/// The only file of an archive that is none of NumPy's.
fn only_one(path: &Path, mut file: File) -> Result<(PathBuf, File), Problem> {
    let opened = ZipArchive::new(BufReader::new(file.try_clone()?));
    // The clone has moved the file's own place.
    file.rewind()?;
    let mut archive = match opened {
        Ok(archive) if archive.len() == 1 => archive,
        // What else it is, its reader says.
        _ => return Ok((path.to_owned(), file)),
    };
    let broken = |error: zip::result::ZipError| Problem::Broken(error.to_string());
    let inside = archive.by_index(0).map_err(broken)?;
    let name = inside.name().map_err(broken)?.into_owned();
    if name.ends_with(".npy") {
        drop(inside);
        file.rewind()?;
        return Ok((path.to_owned(), file));
    }
    Ok((path.with_file_name(Path::new(&name).file_name().unwrap_or_default()), written(inside)?))
}

/// A file without a name that holds what is read, as far as memory for it would be allowed.
fn written(from: impl Read) -> Result<File, Problem> {
    let most = memory::limit().bytes();
    let mut to = BufWriter::new(tempfile::tempfile()?);
    if io::copy(&mut from.take(most.saturating_add(1)), &mut to)? > most {
        let problem =
            format!("unpacked it has more than {most} bytes, all that is allowed; unpack it by hand");
        return Err(Problem::Refused(problem));
    }
    to.flush()?;
    let mut file = to.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.rewind()?;
    Ok(file)
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

impl<R: Read> Utf8<R> {
    fn new(from: R, from_bytes: fn([u8; 2]) -> u16) -> Self {
        Self { from, from_bytes, half: None }
    }
}

impl<R: Read> Read for Utf8<R> {
    /// As many characters as fit: one of two bytes becomes three at most.
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let mut bytes = Vec::new();
        let most = (to.len() / 4 * 2).max(2) as u64;
        self.from.by_ref().take(most).read_to_end(&mut bytes)?;
        let units =
            bytes.chunks(2).map(|pair| (self.from_bytes)([pair[0], pair.get(1).copied().unwrap_or(0)]));
        let mut units: Vec<u16> = self.half.take().into_iter().chain(units).collect();
        // The other half comes with the next bytes.
        if bytes.len() as u64 == most && units.last().is_some_and(|unit| (0xd800..0xdc00).contains(unit)) {
            self.half = units.pop();
        }
        let text = String::from_utf16_lossy(&units);
        let length = text.len().min(to.len());
        to[..length].copy_from_slice(&text.as_bytes()[..length]);
        Ok(length)
    }
}
