//! Pages with checksums.
//!
//! The `parquet` crate compares the checksums of pages and writes none. One stands in its page's header, which is written in Thrift's
//! compact protocol: each field says of what type it is and by how much its number is above that of the field before.

use std::io::Write;

use parquet::column::page::{CompressedPage, PageWriteSpec, PageWriter};
use parquet::errors::{ParquetError, Result};
use parquet::file::writer::{SerializedPageWriter, TrackedWrite};

use super::chunk_checksum::crc32;

/// Fields of a header before the checksum: the page's kind, and its sizes.
const BEFORE: usize = 3;
/// The checksum's field: a step of one, and an integer of 32 bits.
const CHECKSUM: u8 = 0x15;
/// A step of one, as it stands in a field's first byte.
const STEP: u8 = 0x10;
/// Set in all bytes of a number but its last.
const MORE: u8 = 0x80;

/// Writes pages, each with the CRC-32 of what follows its header.
pub(super) struct ChecksummedPages<'p> {
    pub to: &'p mut Vec<u8>,
}

impl PageWriter for ChecksummedPages<'_> {
    fn write_page(&mut self, page: CompressedPage) -> Result<PageWriteSpec> {
        let checksum = crc32(page.data());
        let start = self.to.len();
        let mut to = TrackedWrite::new(&mut *self.to);
        let mut written = SerializedPageWriter::new(&mut to).write_page(page)?;
        to.flush()?;
        drop(to);
        let place = start
            + place(&self.to[start..])
                .ok_or_else(|| ParquetError::General("a page without a header".into()))?;
        let mut field = vec![CHECKSUM];
        push_number(&mut field, checksum.cast_signed());
        self.to[place] -= STEP;
        let added = field.len();
        self.to.splice(place..place, field);
        written.offset = start as u64;
        written.bytes_written += added as u64;
        written.compressed_size += added;
        written.uncompressed_size += added;
        Ok(written)
    }

    fn close(&mut self) -> Result<()> {
        Ok(())
    }
}

/// Where the field behind the sizes begins.
fn place(header: &[u8]) -> Option<usize> {
    (0..BEFORE).try_fold(0, |at, _| {
        let number = at + 1;
        let last = header.get(number..)?.iter().position(|byte| byte & MORE == 0)?;
        Some(number + last + 1)
    })
}

/// Adds a number: sign last, seven bits a byte, the lowest first.
fn push_number(to: &mut Vec<u8>, number: i32) {
    let mut rest = ((number << 1) ^ (number >> 31)).cast_unsigned();
    while rest >= MORE.into() {
        to.push(rest as u8 | MORE);
        rest >>= 7;
    }
    to.push(rest as u8);
}
