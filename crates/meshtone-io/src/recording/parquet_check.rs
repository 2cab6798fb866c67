//! Checks of a Parquet file's metadata, where the `parquet` crate would panic or end the stack rather than refuse.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData};

use super::error::Problem;

/// Bytes of samples that a byte of a file may at most stand for, as pages may repeat a number any number of times.
const MAX_COMPRESSION: u64 = 4096;
/// Bytes of samples that any file may have.
const ALWAYS_BYTES: u64 = 1 << 30;
/// Groups inside each other beyond which a file is none that recordings come in.
const MAX_DEPTH: usize = 64;
/// The length of the metadata, and the mark behind it.
const END_BYTES: u64 = 8;
const MARK: &[u8] = b"PAR1";
/// Numbers of the fields of Thrift's structs that are looked at.
const SCHEMA_FIELD: i64 = 2;
const CHILDREN_FIELD: i64 = 5;
/// Thrift's types.
const I32: u8 = 5;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// Finds what is impossible in the metadata.
///
/// # Arguments
/// * `metadata` - of the file
/// * `file_bytes` - its length
pub(super) fn check_metadata(metadata: &ParquetMetaData, file_bytes: u64) -> Result<(), String> {
    let mut rows: i64 = 0;
    for (index, group) in metadata.row_groups().iter().enumerate() {
        let there = group.num_rows();
        rows = rows.checked_add(there).filter(|_| there >= 0).ok_or("it has an impossible number of rows")?;
        if let Some(column) = group.columns().iter().find(|column| !is_inside(column, file_bytes)) {
            let name = column.column_path().string();
            return Err(format!("column {name} of row group {} is not inside the file", index + 1));
        }
    }
    let stated = metadata.file_metadata().num_rows();
    if rows != stated {
        return Err(format!("it states {stated} rows, but its row groups have {rows}"));
    }
    let columns = metadata.file_metadata().schema_descr().num_columns();
    let bytes = (rows as u64).saturating_mul(8 * columns as u64);
    if bytes > file_bytes.saturating_mul(MAX_COMPRESSION).max(ALWAYS_BYTES) {
        return Err(format!("it states {rows} rows, which is not possible in {file_bytes} bytes"));
    }
    Ok(())
}

fn is_inside(column: &ColumnChunkMetaData, file_bytes: u64) -> bool {
    let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
    let range = u64::try_from(start).ok().zip(u64::try_from(column.compressed_size()).ok());
    let end = range.and_then(|(start, length)| start.checked_add(length));
    end.is_some_and(|end| end <= file_bytes) && column.data_page_offset() >= 0 && column.num_values() >= 0
}

/// Refuses columns that are nested too deeply, and metadata that cannot be looked through; a file that is broken otherwise is left to
/// the `parquet` crate. The file is at its start afterwards.
///
/// The crate builds the tree of columns recursively, so that a hostile file of a megabyte ends the stack, which cannot be
/// caught; and a list of truth values that it does not know it skips entry by entry, without a look whether they are there, which takes
/// seconds of two thousand million in a file of a kilobyte. The metadata is therefore looked through first, in Thrift's compact protocol:
/// the list of columns, each group before its members, stands at its start.
pub(super) fn check_depth(file: &mut File, file_bytes: u64) -> Result<(), Problem> {
    match is_sound(file, file_bytes)? {
        false => Err(Problem::broken("its list of columns is damaged, or nested more than 64 deep")),
        true => Ok(()),
    }
}

/// Whether [`check_depth`] finds nothing.
pub(crate) fn is_sound(file: &mut File, file_bytes: u64) -> io::Result<bool> {
    let Some(end) = file_bytes.checked_sub(END_BYTES) else { return Ok(true) };
    file.seek(SeekFrom::Start(end))?;
    let (mut length, mut mark) = ([0; 4], [0; 4]);
    file.read_exact(&mut length)?;
    file.read_exact(&mut mark)?;
    let start = end.checked_sub(u64::from(u32::from_le_bytes(length))).filter(|_| mark == MARK);
    let mut is_sound = true;
    if let Some(start) = start {
        let mut metadata = Vec::new();
        file.seek(SeekFrom::Start(start))?;
        file.take(end - start).read_to_end(&mut metadata)?;
        is_sound = Scan(&metadata).schema_depth().is_some_and(|depth| depth <= MAX_DEPTH);
    }
    file.rewind()?;
    Ok(is_sound)
}

/// Bytes of Thrift's compact protocol that are still to be read; `None` is given where they are broken.
struct Scan<'b>(&'b [u8]);

impl<'b> Scan<'b> {
    /// The greatest depth of the columns.
    fn schema_depth(&mut self) -> Option<usize> {
        let mut last = 0;
        let mut schema = None;
        while let Some((field, kind)) = self.field(&mut last)? {
            if field == SCHEMA_FIELD && kind == LIST {
                schema = Some(self.byte()?);
                break;
            }
            self.skip(kind, 0)?;
        }
        let Some(head) = schema else { return Some(0) };
        let count = self.count(head)?;
        if head & 0xf != STRUCT {
            return None;
        }
        // Members that each open group still has.
        let mut open: Vec<u64> = Vec::new();
        let mut deepest = 0;
        for _ in 0..count {
            let children = self.children()?;
            if let Some(left) = open.last_mut() {
                *left -= 1;
            }
            if children > 0 {
                open.push(children);
            }
            deepest = deepest.max(open.len());
            if deepest > MAX_DEPTH {
                return Some(deepest);
            }
            while open.last() == Some(&0) {
                open.pop();
            }
        }
        while let Some((_, kind)) = self.field(&mut last)? {
            self.skip(kind, 0)?;
        }
        Some(deepest)
    }

    /// The entries of a list whose first byte is given.
    fn count(&mut self, head: u8) -> Option<u64> {
        if head >> 4 == 15 { self.unsigned() } else { Some(u64::from(head >> 4)) }
    }

    /// The members of the next column; 0 if it is no group.
    fn children(&mut self) -> Option<u64> {
        let (mut last, mut children) = (0, 0);
        while let Some((field, kind)) = self.field(&mut last)? {
            if field == CHILDREN_FIELD && kind == I32 {
                children = u64::try_from(self.signed()?).ok()?;
            } else {
                self.skip(kind, 0)?;
            }
        }
        Some(children)
    }

    /// Number and type of a struct's next field; none at its end.
    fn field(&mut self, last: &mut i64) -> Option<Option<(i64, u8)>> {
        let head = self.byte()?;
        if head == 0 {
            return Some(None);
        }
        *last = match head >> 4 {
            0 => self.signed()?,
            step => last.checked_add(i64::from(step))?,
        };
        Some(Some((*last, head & 0xf)))
    }

    /// Skips a value of a type that metadata have: a truth value, which stands in the type, a number, text, or a list or struct of these.
    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        match kind {
            1 | 2 => Some(()),
            3 => self.bytes(1).map(drop),
            4..=6 => self.unsigned().map(drop),
            7 => self.bytes(8).map(drop),
            8 => {
                let length = self.unsigned()?;
                self.bytes(usize::try_from(length).ok()?).map(drop)
            }
            LIST if depth <= MAX_DEPTH => {
                let head = self.byte()?;
                let count = self.count(head)?;
                for _ in 0..count {
                    // In a list a truth value is a byte.
                    let kind = if head & 0xf <= 2 { 3 } else { head & 0xf };
                    self.skip(kind, depth + 1)?;
                }
                Some(())
            }
            STRUCT if depth <= MAX_DEPTH => {
                let mut last = 0;
                while let Some((_, kind)) = self.field(&mut last)? {
                    self.skip(kind, depth + 1)?;
                }
                Some(())
            }
            _ => None,
        }
    }

    fn signed(&mut self) -> Option<i64> {
        let number = self.unsigned()?;
        Some((number >> 1) as i64 ^ -((number & 1) as i64))
    }

    fn unsigned(&mut self) -> Option<u64> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Some(number);
            }
        }
        None
    }

    fn byte(&mut self) -> Option<u8> {
        self.bytes(1).map(|bytes| bytes[0])
    }

    fn bytes(&mut self, count: usize) -> Option<&'b [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }
}
