//! MDF 4, the measurement data format of ASAM, which recorders of vehicles and test benches write.
//!
//! A file is a tree of blocks, each with links to others: groups of data, of channels, and channels. Source: ASAM MDF 4.1.

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::rc::Rc;

use flate2::read::ZlibDecoder;

use super::array::read_records;
use super::catalogue::{MAX_ARRAYS, USUAL_COMPRESSION};
use super::error::Problem;
use super::fields::{Fields, block, invalid};
use super::label::Label;
use super::number::{NumberKind, Numbers};
use super::rate::StatedRate;
use super::selection::select;
use super::time_base::{TimeBase, assemble_bases};
use super::{Recording, RecordingOptions, memory_need};
use crate::memory;

/// Where the first block stands, and the bytes that each begins with.
const FIRST_AT: u64 = 64;
const HEAD_BYTES: u64 = 24;
/// (bytes) Longest block that is no data.
const LONGEST_BLOCK: u64 = 1 << 20;
/// (bytes) Longest text or conversion.
const LONGEST_SHARED: u64 = 4096;
/// (bytes) Longest compressed block once it is unpacked; the format allows 4 MiB.
const LONGEST_UNPACKED: u64 = 16 << 20;
/// Blocks beyond which a file is none that recordings come in.
const MOST_BLOCKS: usize = 1_000_000;
/// Kinds of channels: values, and the time of a group or what is computed as such.
const VALUES: u8 = 0;
const MASTER: u8 = 2;
const VIRTUAL_MASTER: u8 = 3;
const TIME: u8 = 1;
/// Classes of numbers by their form, which has two values for each: those of both byte orders.
const CLASSES: [&str; 3] = ["uint", "int", "float"];
/// Bits of a group whose records have no fixed length, or whose time is another group's.
const MIXED: u16 = 0b1001;
/// Bits of a channel of which no number, or not every one, is valid.
const ALL_INVALID: u32 = 1;
const SOME_INVALID: u32 = 1 << 1;
const CONVERT: &str = "save it in Python with `asammdf.MDF(…).export(\"parquet\")`";

/// A block: its kind, its links and its content.
struct Block {
    id: [u8; 4],
    links: Vec<u64>,
    content: Vec<u8>,
}

impl Block {
    fn link(&self, number: usize) -> u64 {
        self.links.get(number).copied().unwrap_or(0)
    }

    fn fields(&self) -> Fields<'_> {
        Fields { left: &self.content, big_endian: false }
    }
}

/// A channel of a group.
struct Column {
    label: Label,
    numbers: Option<Numbers>,
    /// From a stored number to a measured one: what is added, and the factor.
    scale: Option<[f64; 2]>,
    /// Byte of a record, and its bit, that says that the number is invalid.
    invalid: Option<(usize, u8)>,
    kind: u8,
    group: usize,
}

/// A group of channels that were sampled together.
struct Group {
    record_bytes: usize,
    count: u64,
    /// Where its data stand: place and length, of compressed ones the block's place.
    data: Vec<Part>,
    time: Option<usize>,
}

#[derive(Clone, Copy)]
struct Part {
    at: u64,
    bytes: u64,
    is_packed: bool,
}

struct Walk<'f> {
    file: &'f File,
    file_bytes: u64,
    seen: HashSet<u64>,
    groups: Vec<Group>,
    columns: Vec<Column>,
}

/// Reads a recording from MDF 4: a channel for each that holds real numbers over time.
pub(super) fn read(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let head = block(&file, 0, FIRST_AT)?;
    if !head.starts_with(b"MDF     4") {
        let what = if head.starts_with(b"UnFinMF") {
            "an MDF file that its recorder did not finish"
        } else {
            "an MDF file of another version than 4"
        };
        return Err(Problem::convert(what, CONVERT));
    }
    let mut walk =
        Walk { file: &file, file_bytes, seen: HashSet::new(), groups: Vec::new(), columns: Vec::new() };
    walk.data_groups()?;
    let Walk { groups, columns, .. } = walk;
    let channels: Vec<&Column> = columns.iter().filter(|column| column.kind == VALUES).collect();
    let labels: Vec<Label> = channels.iter().map(|column| column.label.clone()).collect();
    let selection = select(&labels, options)?;
    let wanted: Vec<&Column> = selection.wanted.iter().map(|column| channels[*column]).collect();
    // The times of every group, and two copies of them by which their steps are compared.
    let times_bytes = |of_group: &[&Column]| groups[of_group[0].group].count.saturating_mul(3 * 8);
    let beside =
        wanted.chunk_by(|one, next| one.group == next.group).map(times_bytes).fold(0, u64::saturating_add);
    let count = |column: usize| groups[channels[column].group].count;
    memory_need::check(memory::limit(), options, &selection, count, beside)?;
    let (mut samples, mut bases) = (Vec::new(), Vec::new());
    for of_group in wanted.chunk_by(|one, next| one.group == next.group) {
        let group = &groups[of_group[0].group];
        let time = group.time.map(|time| &columns[time]);
        let time = time.ok_or_else(|| {
            Problem::Refused(format!(
                "channel {} has no times; choose others (option channels)",
                of_group[0].label.raw
            ))
        })?;
        let is_virtual = time.kind == VIRTUAL_MASTER;
        let read: Vec<&Column> = of_group.iter().copied().chain((!is_virtual).then_some(time)).collect();
        let mut read = group.numbers(&file, file_bytes, &read)?;
        let base = match time.scale {
            // Its times are computed from the numbers of the records.
            Some([start_s, step_s]) if is_virtual => {
                let stated = StatedRate { by: format!("channel {}", time.label.raw), rate_hz: 1.0 / step_s };
                TimeBase::Uniform { stated, start_s }
            }
            _ => TimeBase::Times {
                of: time.label.raw.clone(),
                times_s: Rc::new(read.pop().unwrap_or_default()),
            },
        };
        samples.append(&mut read);
        // The times are shared, not copied.
        bases.extend(vec![base; of_group.len()]);
    }
    assemble_bases(&labels, &selection, samples, &bases, options)
}

impl Walk<'_> {
    /// A block; each but texts and conversions must be new, so that no list has an end that is its beginning.
    fn block(&mut self, at: u64, ids: &[&[u8; 4]]) -> Result<Block, Problem> {
        let head = block(self.file, at, HEAD_BYTES)?;
        let mut fields = Fields { left: &head, big_endian: false };
        let name = fields.bytes(4)?;
        let id = [name[0], name[1], name[2], name[3]];
        fields.u32()?;
        let (length, links) = (fields.u64()?, fields.u64()?);
        let broken = |what: &str| Problem::Broken(format!("the block at byte {at} {what}"));
        if !ids.contains(&&id) {
            return Err(broken("is none of the kind that belongs there"));
        }
        let shared = [*b"##TX", *b"##MD", *b"##CC"].contains(&id);
        if !shared && (self.seen.len() >= MOST_BLOCKS || !self.seen.insert(at)) {
            return Err(broken("is linked twice, or one of too many"));
        }
        // What follows the links of data is read later; and of what many blocks may link to, only the beginning is kept.
        let is_data = [*b"##DT", *b"##DZ"].contains(&id);
        let most = if is_data { HEAD_BYTES + 24 } else { HEAD_BYTES + LONGEST_SHARED };
        let bytes = if is_data || shared { length.min(most) } else { length };
        let links = if shared { links.min(LONGEST_SHARED / 8) } else { links };
        if !(HEAD_BYTES..=LONGEST_BLOCK).contains(&bytes)
            || links > (bytes - HEAD_BYTES) / 8
            || at.checked_add(length).is_none_or(|end| end > self.file_bytes)
        {
            return Err(broken("states an impossible length"));
        }
        let content = block(self.file, at + HEAD_BYTES, bytes - HEAD_BYTES)?;
        let mut fields = Fields { left: &content, big_endian: false };
        let links = (0..links).map(|_| fields.u64()).collect::<io::Result<_>>()?;
        let content = if is_data {
            length.to_le_bytes().into_iter().chain(fields.left.iter().copied()).collect()
        } else {
            fields.left.to_vec()
        };
        Ok(Block { id, links, content })
    }

    fn text(&mut self, at: u64) -> Result<Option<String>, Problem> {
        if at == 0 {
            return Ok(None);
        }
        let block = self.block(at, &[b"##TX", b"##MD"])?;
        let text = String::from_utf8_lossy(&block.content);
        let text = text.trim_end_matches('\0').trim();
        // A comment in XML has its words in an element.
        let inner = text.split_once("<TX").and_then(|(_, rest)| rest.split_once('>')?.1.split_once("</TX>"));
        let text = if block.id == *b"##MD" { inner.map_or("", |(text, _)| text) } else { text };
        Ok(Some(text.to_owned()).filter(|text| !text.is_empty()))
    }

    fn data_groups(&mut self) -> Result<(), Problem> {
        let mut at = self.block(FIRST_AT, &[b"##HD"])?.link(0);
        while at != 0 {
            let group = self.block(at, &[b"##DG"])?;
            at = group.link(0);
            if group.link(1) == 0 {
                continue;
            }
            let channels = self.block(group.link(1), &[b"##CG"])?;
            let mut fields = channels.fields();
            let (_, count, flags) = (fields.u64()?, fields.u64()?, fields.u16()?);
            fields.bytes(6)?;
            let (data_bytes, invalidation_bytes) = (fields.u32()?, fields.u32()?);
            if channels.link(0) != 0 || flags & MIXED != 0 {
                let what = "an MDF file whose records of several groups are mixed, or that stands in columns";
                return Err(Problem::convert(what, CONVERT));
            }
            if count == 0 {
                continue;
            }
            // Behind a number of the group, of one, two, four or eight bytes.
            let before = usize::from(group.fields().u8()?);
            if before > 8 {
                return Err(Problem::broken("the number of a group has more than 8 bytes"));
            }
            let record_bytes = before + data_bytes as usize + invalidation_bytes as usize;
            if record_bytes as u64 > LONGEST_BLOCK {
                return Err(Problem::Broken(format!("its records have {record_bytes} bytes")));
            }
            let data = self.parts(group.link(2))?;
            self.groups.push(Group { record_bytes, count, data, time: None });
            self.channels(channels.link(1), before, record_bytes, invalidation_bytes as usize)?;
        }
        if self.columns.is_empty() {
            Err(Problem::Refused("holds no channel with samples".to_owned()))
        } else {
            Ok(())
        }
    }

    /// Where the data of a group stand: in one block, or in those of a list.
    fn parts(&mut self, mut at: u64) -> Result<Vec<Part>, Problem> {
        let part = |at: u64, found: &Block| -> io::Result<Part> {
            let bytes = found.fields().u64()?;
            let is_packed = found.id == *b"##DZ";
            Ok(if is_packed {
                Part { at, bytes, is_packed }
            } else {
                Part { at: at + HEAD_BYTES, bytes: bytes - HEAD_BYTES, is_packed }
            })
        };
        let mut parts = Vec::new();
        while at != 0 {
            let found = self.block(at, &[b"##DT", b"##DZ", b"##DL", b"##HL"])?;
            match &found.id {
                b"##HL" => at = found.link(0),
                b"##DL" => {
                    for data in found.links.iter().skip(1).filter(|data| **data != 0) {
                        parts.push(part(*data, &self.block(*data, &[b"##DT", b"##DZ"])?)?);
                    }
                    at = found.link(0);
                }
                _ => {
                    parts.push(part(at, &found)?);
                    at = 0;
                }
            }
        }
        Ok(parts)
    }

    /// * `at` - the first
    /// * `before`, `record_bytes`, `invalidation_bytes` - of a record: before its numbers, all, and those that say which numbers are invalid
    fn channels(
        &mut self,
        mut at: u64,
        before: usize,
        record_bytes: usize,
        invalidation_bytes: usize,
    ) -> Result<(), Problem> {
        let group = self.groups.len() - 1;
        while at != 0 {
            let channel = self.block(at, &[b"##CN"])?;
            at = channel.link(0);
            if self.columns.len() >= MAX_ARRAYS {
                return Err(Problem::Refused(format!("has more than {MAX_ARRAYS} channels")));
            }
            let name =
                self.text(channel.link(2))?.unwrap_or_else(|| format!("channel {}", self.columns.len() + 1));
            let mut fields = channel.fields();
            let (kind, sync, form, bit) = (fields.u8()?, fields.u8()?, fields.u8()?, fields.u8()?);
            let (byte, bits) = (fields.u32()? as usize, fields.u32()?);
            let (flags, invalid_bit) = (fields.u32()?, fields.u32()? as usize);
            let has_invalid = flags & SOME_INVALID != 0 && invalidation_bytes > 0;
            if has_invalid && invalid_bit / 8 >= invalidation_bytes {
                return Err(Problem::Broken(format!("channel {name} has its validity behind its record")));
            }
            let at_bit = (record_bytes - invalidation_bytes + invalid_bit / 8, 1 << (invalid_bit % 8));
            let mut unit = self.text(channel.link(6))?;
            let scale = self.scale(channel.link(4), &mut unit)?;
            let stored = CLASSES.get(usize::from(form / 2)).and_then(|class| NumberKind::of(class, bits));
            let numbers = stored.filter(|kind| bit == 0 && before + byte + kind.size() <= record_bytes);
            let numbers = numbers.map(|kind| {
                let before = before + byte;
                Numbers {
                    before,
                    behind: record_bytes - before - kind.size(),
                    ..Numbers::plain(kind, form % 2 == 1)
                }
            });
            let of = match (kind, numbers, scale) {
                _ if flags & ALL_INVALID != 0 => Some("numbers that its recorder marked as invalid"),
                (VALUES | MASTER, Some(_), Some(_)) if channel.link(1) == 0 => None,
                (VIRTUAL_MASTER, _, Some(_)) => None,
                (_, _, None) => Some("numbers that are converted by a formula or a table"),
                _ => Some("no real numbers of whole bytes"),
            };
            if matches!(kind, MASTER | VIRTUAL_MASTER) && sync == TIME && of.is_none() {
                self.groups[group].time = Some(self.columns.len());
            }
            let label = Label { unit, not_numeric: of.map(str::to_owned), ..Label::plain(&name) };
            let invalid = has_invalid.then_some(at_bit);
            self.columns.push(Column { label, numbers, scale, invalid, kind, group });
        }
        Ok(())
    }

    /// How a stored number becomes a measured one; none where that is not linear. A unit of the conversion counts where the channel has none.
    fn scale(&mut self, at: u64, unit: &mut Option<String>) -> Result<Option<[f64; 2]>, Problem> {
        if at == 0 {
            return Ok(Some([0.0, 1.0]));
        }
        let conversion = self.block(at, &[b"##CC"])?;
        if unit.is_none() {
            *unit = self.text(conversion.link(1))?;
        }
        let mut fields = conversion.fields();
        let kind = fields.u8()?;
        fields.bytes(23)?;
        Ok(match kind {
            0 => Some([0.0, 1.0]),
            1 => Some([fields.f64()?, fields.f64()?]),
            _ => None,
        })
    }
}

impl Group {
    /// The numbers of some of its channels.
    fn numbers(&self, file: &File, file_bytes: u64, columns: &[&Column]) -> Result<Vec<Vec<f64>>, Problem> {
        let sure =
            self.count.min(file_bytes.saturating_mul(USUAL_COMPRESSION) / self.record_bytes.max(1) as u64);
        let mut samples = vec![Vec::with_capacity(sure as usize); columns.len()];
        let mut from = Parts { file, parts: self.data.iter(), now: io::Cursor::new(Vec::new()), left: 0 };
        let mut invalid = None;
        read_records(&mut from, self.record_bytes.max(1), self.count, |block| {
            for (column, samples) in columns.iter().zip(&mut samples) {
                let is_invalid = |(byte, bit): (usize, u8)| {
                    block.iter().skip(byte).step_by(self.record_bytes.max(1)).any(|flags| flags & bit != 0)
                };
                if column.invalid.is_some_and(is_invalid) {
                    invalid.get_or_insert(&column.label.raw);
                }
                if let Some(numbers) = column.numbers {
                    numbers.append(block, 1, 0, samples);
                }
            }
        })?;
        if let Some(name) = invalid {
            return Err(Problem::Refused(format!(
                "channel {name} has numbers that its recorder marked as invalid; cut the recording there, or choose others (option channels)"
            )));
        }
        for (column, samples) in columns.iter().zip(&mut samples) {
            if let Some([offset, factor]) = column.scale.filter(|scale| *scale != [0.0, 1.0]) {
                samples.iter_mut().for_each(|sample| *sample = offset + factor * *sample);
            }
        }
        Ok(samples)
    }
}

/// The data of a group, one part behind the other.
struct Parts<'g> {
    file: &'g File,
    parts: std::slice::Iter<'g, Part>,
    /// Of a compressed part all bytes.
    now: io::Cursor<Vec<u8>>,
    /// (bytes) Of one that is not compressed, what is left in the file.
    left: u64,
}

impl Read for Parts<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        loop {
            let most = to.len().min(usize::try_from(self.left).unwrap_or(usize::MAX));
            let read = if self.left > 0 { self.file.read(&mut to[..most])? } else { self.now.read(to)? };
            self.left = self.left.saturating_sub(read as u64);
            if read > 0 || to.is_empty() {
                return Ok(read);
            }
            let Some(part) = self.parts.next() else { return Ok(0) };
            if part.is_packed {
                (self.now, self.left) = (io::Cursor::new(unpacked(self.file, *part)?), 0);
            } else {
                self.file.seek(SeekFrom::Start(part.at))?;
                self.left = part.bytes;
            }
        }
    }
}

/// The bytes of a compressed block. They may have been transposed: first of each record the first byte, then the second.
fn unpacked(mut file: &File, part: Part) -> io::Result<Vec<u8>> {
    let head = block(file, part.at, part.bytes.min(HEAD_BYTES + 24))?;
    let mut fields = Fields { left: &head[HEAD_BYTES as usize..], big_endian: false };
    fields.u16()?;
    let (kind, _, width) = (fields.u8()?, fields.u8()?, fields.u32()? as usize);
    let (length, stored) = (fields.u64()?, fields.u64()?);
    if length > LONGEST_UNPACKED || kind > 1 {
        return Err(invalid("a compressed block of an unknown kind, or of more than 16 MiB"));
    }
    file.seek(SeekFrom::Start(part.at + HEAD_BYTES + 24))?;
    let mut bytes = Vec::new();
    ZlibDecoder::new(file.take(stored)).take(length + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 != length {
        return Err(invalid("a compressed block does not have the length that it states"));
    }
    if kind == 1 && width > 1 {
        let rows = bytes.len() / width;
        let whole = rows * width;
        let mut turned = vec![0; whole];
        for (index, byte) in bytes[..whole].iter().enumerate() {
            turned[index % rows * width + index / rows] = *byte;
        }
        bytes[..whole].copy_from_slice(&turned);
    }
    Ok(bytes)
}
