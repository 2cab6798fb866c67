//! How deeply a Parquet file's columns are nested.
//!
//! The `parquet` crate builds the tree of columns recursively, so that a hostile file of a megabyte ends the stack,
//! which no one can catch. The list of columns is therefore looked through first: it stands at the start of the
//! metadata, in Thrift's compact protocol, each group before its members.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// Groups inside each other beyond which a file is none that recordings come in.
const MAX_DEPTH: usize = 64;
/// Length of the metadata, and the mark behind it.
const END_BYTES: u64 = 8;
const MARK: &[u8] = b"PAR1";
const SCHEMA_FIELD: i64 = 2;
const CHILDREN_FIELD: i64 = 5;
const I32: u8 = 5;
const LIST: u8 = 9;
const STRUCT: u8 = 12;

/// Whether the columns are nested too deeply; a file that is broken otherwise is left to the `parquet` crate. The
/// file is at its start afterwards.
pub(super) fn is_too_deep(file: &mut File, file_bytes: u64) -> io::Result<bool> {
    let Some(end) = file_bytes.checked_sub(END_BYTES) else { return Ok(false) };
    file.seek(SeekFrom::Start(end))?;
    let (mut length, mut mark) = ([0; 4], [0; 4]);
    file.read_exact(&mut length)?;
    file.read_exact(&mut mark)?;
    let start = end.checked_sub(u64::from(u32::from_le_bytes(length))).filter(|_| mark == MARK);
    let mut metadata = Vec::new();
    if let Some(start) = start {
        file.seek(SeekFrom::Start(start))?;
        file.take(end - start).read_to_end(&mut metadata)?;
    }
    file.seek(SeekFrom::Start(0))?;
    let depth = Scan { bytes: &metadata }.schema_depth();
    // What cannot be scanned is not read either.
    Ok(start.is_some() && depth.is_none_or(|depth| depth > MAX_DEPTH))
}

struct Scan<'b> {
    bytes: &'b [u8],
}

impl Scan<'_> {
    fn schema_depth(&mut self) -> Option<usize> {
        let mut last = 0;
        while let Some((field, kind)) = self.field(&mut last)? {
            if field == SCHEMA_FIELD && kind == LIST {
                let (count, kind) = self.list()?;
                return if kind == STRUCT { self.depth_of(count) } else { None };
            }
            self.skip(kind, 0)?;
        }
        Some(0)
    }

    /// The greatest depth of a list of columns.
    fn depth_of(&mut self, count: u64) -> Option<usize> {
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
                break;
            }
            while open.last() == Some(&0) {
                open.pop();
            }
        }
        Some(deepest)
    }

    /// The members of the next column, if it is a group.
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

    /// Length and type of a list.
    fn list(&mut self) -> Option<(u64, u8)> {
        let head = self.byte()?;
        let count = if head >> 4 == 15 { self.unsigned()? } else { u64::from(head >> 4) };
        Some((count, head & 0xf))
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > MAX_DEPTH {
            return None;
        }
        match kind {
            // Truth values, which stand in the type.
            1 | 2 => Some(()),
            3 => self.pass(1),
            4..=6 => self.unsigned().map(drop),
            7 => self.pass(8),
            8 => {
                let length = self.unsigned()?;
                self.pass(usize::try_from(length).ok()?)
            }
            9 | 10 => {
                let (count, kind) = self.list()?;
                // A truth value in a list is a byte.
                let kind = if matches!(kind, 1 | 2) { 3 } else { kind };
                (0..count).try_for_each(|_| self.skip(kind, depth + 1))
            }
            STRUCT => {
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
        let (first, rest) = self.bytes.split_first()?;
        self.bytes = rest;
        Some(*first)
    }

    fn pass(&mut self, bytes: usize) -> Option<()> {
        self.bytes = self.bytes.get(bytes..)?;
        Some(())
    }
}
