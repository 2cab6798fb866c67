//! The elements of a MAT-file as a stream, compressed or not.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom, Take};

use flate2::bufread::ZlibDecoder;

use crate::recording::array::skip;
use crate::recording::fields::invalid;

/// Bytes that are read from the file at once.
const BUFFER_BYTES: usize = 1 << 16;
/// Bytes that a compressed byte may at most stand for: the limit of deflate.
const MAX_COMPRESSION: u64 = 1032;

/// The beginning of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Tag {
    pub kind: u32,
    /// Bytes of the element's data, without padding.
    pub bytes: u64,
    /// The data, where it stands in the tag itself.
    pub inline: Option<[u8; 4]>,
}

/// Where in the file a variable is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Variable {
    /// Of its element's data, from the start of the file.
    pub at: u64,
    pub bytes: u64,
    pub compressed: bool,
}

enum Bytes<'f> {
    Plain(BufReader<&'f File>),
    Compressed(Box<ZlibDecoder<BufReader<Take<&'f File>>>>),
}

/// The elements of one variable.
pub(super) struct Source<'f> {
    bytes: Bytes<'f>,
    big_endian: bool,
    /// Bytes that were read or skipped.
    pub at: u64,
    /// Bytes that there are at most.
    pub end: u64,
}

impl<'f> Source<'f> {
    /// Opens a variable.
    pub(super) fn open(mut file: &'f File, variable: Variable, big_endian: bool) -> io::Result<Source<'f>> {
        file.seek(SeekFrom::Start(variable.at))?;
        let (bytes, end) = if variable.compressed {
            let packed = BufReader::with_capacity(BUFFER_BYTES, file.take(variable.bytes));
            let end = variable.bytes.saturating_mul(MAX_COMPRESSION);
            (Bytes::Compressed(Box::new(ZlibDecoder::new(packed))), end)
        } else {
            (Bytes::Plain(BufReader::with_capacity(BUFFER_BYTES, file)), variable.bytes)
        };
        Ok(Source { bytes, big_endian, at: 0, end })
    }

    /// Reads the beginning of an element, which must end by the given place.
    pub(super) fn tag(&mut self, end: u64) -> io::Result<Tag> {
        let mut bytes = [0; 8];
        self.read_exact(&mut bytes)?;
        let [a, b, c, d, data @ ..] = bytes;
        let (first, second) = (self.u32([a, b, c, d]), self.u32(data));
        let tag = if first >> 16 == 0 {
            Tag { kind: first, bytes: u64::from(second), inline: None }
        } else {
            Tag { kind: first & 0xffff, bytes: u64::from(first >> 16), inline: Some(data) }
        };
        let left = if tag.inline.is_some() { 4 } else { end.saturating_sub(self.at) };
        if tag.bytes > left {
            return Err(invalid(format!(
                "an element of type {} announces {} bytes, but only {left} are left",
                tag.kind, tag.bytes
            )));
        }
        Ok(tag)
    }

    /// Reads a whole element of a few bytes.
    ///
    /// # Arguments
    /// * `what` - what it holds, for messages
    /// * `most` - bytes that it may have
    /// * `end` - where it must end
    pub(super) fn data(&mut self, what: &str, most: u64, end: u64) -> io::Result<Vec<u8>> {
        let tag = self.tag(end)?;
        if tag.bytes > most {
            return Err(invalid(format!("{what} of {} bytes; must be {most} at most", tag.bytes)));
        }
        if let Some(data) = tag.inline {
            return Ok(data[..tag.bytes as usize].to_vec());
        }
        let mut data = vec![0; tag.bytes as usize];
        self.read_exact(&mut data)?;
        let padded = (self.at + padding(tag.bytes)).min(end);
        self.skip_to(padded)?;
        Ok(data)
    }

    /// Reads an element of 32 bit numbers.
    pub(super) fn u32_data(&mut self, what: &str, most: u64, end: u64) -> io::Result<Vec<u32>> {
        let data = self.data(what, 4 * most, end)?;
        Ok(data.as_chunks().0.iter().map(|bytes| self.u32(*bytes)).collect())
    }

    /// Skips what stands before a place.
    pub(super) fn skip_to(&mut self, place: u64) -> io::Result<()> {
        let Some(bytes) = place.checked_sub(self.at) else {
            return Err(invalid("its elements overlap"));
        };
        match &mut self.bytes {
            Bytes::Plain(file) => file.seek_relative(i64::try_from(bytes).unwrap_or(i64::MAX))?,
            Bytes::Compressed(packed) => skip(packed, bytes)?,
        }
        self.at = place;
        Ok(())
    }

    /// Reads a compressed variable to its end, where its checksum is compared.
    pub(super) fn finish(mut self) -> io::Result<()> {
        if let Bytes::Compressed(packed) = &mut self.bytes {
            io::copy(packed, &mut io::sink())?;
        }
        Ok(())
    }

    fn u32(&self, bytes: [u8; 4]) -> u32 {
        if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) }
    }
}

impl Read for Source<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = match &mut self.bytes {
            Bytes::Plain(file) => file.read(to),
            Bytes::Compressed(packed) => packed.read(to),
        }?;
        self.at += read as u64;
        Ok(read)
    }
}

/// Bytes that fill up data to a multiple of 8.
pub(super) fn padding(bytes: u64) -> u64 {
    bytes.next_multiple_of(8) - bytes
}
