//! TDMS, in which LabVIEW and FlexLogger store measurements.
//!
//! A file is a list of segments, each with what changes of the list of its objects, and their numbers. Source: National Instruments, "TDMS
//! File Format Internal Structure".

mod object;

use std::collections::HashMap;
use std::fs::File;
use std::io::{Seek, SeekFrom};
use std::rc::Rc;

use self::object::{Kind, Object, TEXT, kind, parts, property, text};
use super::array::read_records;
use super::assemble::assemble;
use super::catalogue::MAX_ARRAYS;
use super::error::Problem;
use super::fields::{Fields, block};
use super::label::Label;
use super::number::Numbers;
use super::rate::StatedRate;
use super::selection::select;
use super::time_base::{TimeBase, assemble_bases};
use super::{Recording, RecordingOptions, RecordingWarning, memory_need};
use crate::memory;

const LEAD_IN_BYTES: u64 = 28;
const MARK: &[u8] = b"TDSm";
/// Bits of a segment's contents.
const HAS_METADATA: u32 = 1 << 1;
const IS_NEW_LIST: u32 = 1 << 2;
const HAS_NUMBERS: u32 = 1 << 3;
const IS_INTERLEAVED: u32 = 1 << 5;
const IS_BIG_ENDIAN: u32 = 1 << 6;
/// Indices of numbers: none, as before, and those that a driver stored unscaled.
const NO_NUMBERS: u32 = u32::MAX;
const AS_BEFORE: u32 = 0;
const OF_DRIVER: [u32; 2] = [0x1269, 0x126a];
/// What is kept of a file's structure: segments, objects in their lists, and properties.
const MOST_PLACES: usize = 4_000_000;

/// (bytes) Of any number.
const LONGEST_NUMBER: u64 = 16;
/// (bytes) Chunks up to which all of a segment are read one behind the other.
const SMALL_CHUNK: u64 = 1 << 18;

/// Numbers of an object in a chunk of a segment.
#[derive(Clone, Copy)]
struct Place {
    object: usize,
    kind: Kind,
    count: u64,
    /// (bytes) From the start of a chunk, or of a row of interleaved numbers.
    offset: u64,
}

/// The places in a chunk by the numbers of their objects, and (bytes) the chunk.
type LaidOut = (Rc<[Place]>, u64);

/// A segment's numbers: chunks of the numbers of all places.
struct Segment {
    at: u64,
    /// (bytes) A chunk.
    chunk: u64,
    chunks: u64,
    places: Rc<[Place]>,
    is_interleaved: bool,
    big_endian: bool,
}

#[derive(Default)]
struct Objects {
    all: Vec<Object>,
    by_path: HashMap<Vec<u8>, usize>,
    /// The last index of each.
    indices: HashMap<usize, Place>,
    segments: Vec<Segment>,
    places: usize,
    /// Samples of a channel, at most, in a last block that is not whole; none where the file has its end.
    left_out: Option<u64>,
}

/// Reads a recording from TDMS: a channel for each of the file's that holds real numbers.
pub(super) fn read(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let mut objects = Objects::default();
    objects.read_segments(&file, file_bytes)?;
    let channels: Vec<usize> =
        (0..objects.all.len()).filter(|index| objects.all[*index].is_channel()).collect();
    let mut namesakes: HashMap<&str, usize> = HashMap::new();
    channels.iter().for_each(|channel| *namesakes.entry(objects.all[*channel].name()).or_default() += 1);
    let labels: Vec<Label> = channels.iter().map(|channel| objects.all[*channel].label(&namesakes)).collect();
    let selection = select(&labels, options)?;
    let count = |column: usize| objects.all[channels[column]].count;
    memory_need::check(memory::limit(), options, &selection, count, 0)?;
    let mut samples = Vec::new();
    for column in &selection.wanted {
        samples.push(objects.numbers(&file, channels[*column], file_bytes)?);
    }
    // Waveforms start at times of the clock; the first of all in the file counts, whichever of them are read.
    let starts = channels.iter().map(|channel| objects.all[*channel].start_s());
    let first_s = starts.filter(|start_s| *start_s > CLOCK_S).reduce(f64::min).unwrap_or(0.0);
    let base = |column: &usize| objects.time_base(channels[*column], first_s);
    let bases: Option<Vec<TimeBase>> = selection.wanted.iter().map(base).collect();
    let mut recording = match bases.filter(|_| selection.time.is_none()) {
        Some(bases) => assemble_bases(&labels, &selection, samples, &bases, options),
        None => {
            let stated = selection.channels.iter().find_map(|column| objects.stated(channels[*column]));
            assemble(&labels, &selection, samples, stated.as_slice(), options)
        }
    }?;
    recording.warnings.extend(objects.left_out.map(|samples| RecordingWarning::BrokenOff { samples }));
    Ok(recording)
}

/// (s) Beyond it a start is a time of the clock, counted from the year 1904.
const CLOCK_S: f64 = 1e9;

impl Objects {
    fn read_segments(&mut self, mut file: &File, file_bytes: u64) -> Result<(), Problem> {
        let mut at = 0;
        let mut list: Rc<[Place]> = Rc::new([]);
        let mut laid: Option<(Rc<[Place]>, bool, LaidOut)> = None;
        while at + LEAD_IN_BYTES <= file_bytes {
            let lead = block(file, at, LEAD_IN_BYTES)?;
            let mut fields = Fields { left: &lead, big_endian: false };
            if fields.bytes(4)? != MARK {
                return Err(Problem::Broken(format!("the segment at byte {at} does not begin as one does")));
            }
            let contents = fields.u32()?;
            fields.big_endian = contents & IS_BIG_ENDIAN != 0;
            fields.u32()?;
            let (next, numbers) = (fields.u64()?, fields.u64()?);
            let start = at + LEAD_IN_BYTES;
            // A segment that was being written when the recorder stopped has no end.
            let end = if next == u64::MAX { Some(file_bytes) } else { start.checked_add(next) };
            let end = end
                .filter(|end| *end <= file_bytes)
                .ok_or_else(|| Problem::broken("it ends within a segment"))?;
            let numbers_at = start.checked_add(numbers).filter(|numbers| *numbers <= end);
            let numbers_at =
                numbers_at.ok_or_else(|| Problem::broken("a segment's numbers begin behind its end"))?;
            if contents & HAS_METADATA != 0 {
                if let Some(objection) = memory::limit().objection(numbers) {
                    return Err(Problem::Refused(format!("states metadata that {objection}")));
                }
                let metadata = block(file, start, numbers)?;
                let fields = Fields { left: &metadata, big_endian: fields.big_endian };
                list = self.metadata(fields, if contents & IS_NEW_LIST != 0 { &[] } else { &list })?;
            }
            if contents & HAS_NUMBERS != 0 {
                let is_interleaved = contents & IS_INTERLEAVED != 0;
                let (places, chunk) = match &laid {
                    Some((of, interleaved, laid))
                        if Rc::ptr_eq(of, &list) && *interleaved == is_interleaved =>
                    {
                        laid.clone()
                    }
                    _ => self.laid_out(&list, is_interleaved)?,
                };
                laid = Some((list.clone(), is_interleaved, (places.clone(), chunk)));
                let bytes = end - numbers_at;
                let chunks = bytes.checked_div(chunk).unwrap_or(0);
                let rest = bytes - chunks * chunk;
                if next == u64::MAX {
                    let per_row =
                        |place: &Place| if is_interleaved { chunk / place.count } else { place.kind.bytes };
                    let samples = places.iter().map(|place| place.count.min(rest / per_row(place)));
                    self.left_out = samples.max().or(Some(0));
                } else if rest != 0 && chunk > 0 {
                    return Err(Problem::broken("a segment has no whole number of chunks"));
                }
                if chunks > 0 {
                    self.count_places(1)?;
                    places.iter().for_each(|place| self.all[place.object].count += place.count * chunks);
                    let big_endian = fields.big_endian;
                    self.segments.push(Segment {
                        at: numbers_at,
                        chunk,
                        chunks,
                        places,
                        is_interleaved,
                        big_endian,
                    });
                }
            }
            at = end;
        }
        file.seek(SeekFrom::Start(0))?;
        if at < file_bytes { Err(Problem::broken("it ends within the head of a segment")) } else { Ok(()) }
    }

    /// Finds where in a chunk each object's numbers stand.
    fn laid_out(&mut self, list: &[Place], is_interleaved: bool) -> Result<LaidOut, Problem> {
        self.count_places(list.len())?;
        if is_interleaved
            && list.iter().any(|place| place.count != list[0].count || place.kind.bytes > LONGEST_NUMBER)
        {
            return Err(Problem::broken("interleaved channels are not equally long, or are texts"));
        }
        let (mut chunk, mut row) = (0_u64, 0);
        let place = |place: &Place| {
            let offset = if is_interleaved { row } else { chunk };
            row = place.kind.bytes.saturating_add(row);
            chunk = chunk.saturating_add(place.count.saturating_mul(place.kind.bytes));
            Place { offset, ..*place }
        };
        let has_numbers = |place: &&Place| place.count > 0 && place.kind.bytes > 0;
        let mut places: Vec<Place> = list.iter().filter(has_numbers).map(place).collect();
        places.sort_unstable_by_key(|place| place.object);
        Ok((places.into(), chunk))
    }

    /// Refuses a structure that would take much memory or time whatever the file holds.
    fn count_places(&mut self, more: usize) -> Result<(), Problem> {
        self.places += more;
        if self.places > MOST_PLACES {
            return Err(Problem::Refused(format!(
                "is in pieces, more than {MOST_PLACES}; defragment it in LabVIEW"
            )));
        }
        Ok(())
    }

    /// Reads what a segment says of objects, and gives its list of those that have numbers.
    fn metadata(&mut self, mut fields: Fields, before: &[Place]) -> Result<Rc<[Place]>, Problem> {
        self.count_places(before.len())?;
        let mut list = before.to_vec();
        for _ in 0..fields.u32()? {
            self.count_places(1)?;
            let length = fields.u32()?;
            let path = fields.bytes(length.into())?;
            let object = match self.by_path.get(path) {
                Some(object) => *object,
                None if self.all.len() < MAX_ARRAYS => {
                    self.all.push(Object { path: parts(&text(path)), ..Object::default() });
                    self.by_path.insert(path.to_vec(), self.all.len() - 1);
                    self.all.len() - 1
                }
                None => {
                    return Err(Problem::Refused(format!("has more than {MAX_ARRAYS} channels and groups")));
                }
            };
            if let Some(place) = self.index(&mut fields, object)? {
                match list.iter_mut().find(|other| other.object == object) {
                    Some(other) => *other = place,
                    None => list.push(place),
                }
            } else {
                list.retain(|place| place.object != object);
            }
            for _ in 0..fields.u32()? {
                let length = fields.u32()?;
                let name = text(fields.bytes(length.into())?);
                if let Some(property) = property(&mut fields)?
                    && self.all[object].properties.insert(name, property).is_none()
                {
                    self.count_places(1)?;
                }
            }
        }
        Ok(list.into())
    }

    /// Reads which numbers an object has in the segment.
    fn index(&mut self, fields: &mut Fields, object: usize) -> Result<Option<Place>, Problem> {
        match fields.u32()? {
            NO_NUMBERS => Ok(None),
            AS_BEFORE => {
                let place = self.indices.get(&object).copied();
                place
                    .map(Some)
                    .ok_or_else(|| Problem::broken("an object has numbers as before, and had none"))
            }
            driver if OF_DRIVER.contains(&driver) => Err(Problem::convert(
                "a TDMS file with the raw numbers of a driver (DAQmx)",
                "save it in Python with `nptdms.TdmsFile.read(…).as_dataframe().to_parquet(…)`",
            )),
            _ => {
                let (code, dimensions, count) = (fields.u32()?, fields.u32()?, fields.u64()?);
                let kind =
                    if code == TEXT { Kind { numbers: None, bytes: fields.u64()? } } else { kind(code)? };
                if dimensions != 1 {
                    return Err(Problem::Broken(format!("an array of {dimensions} dimensions")));
                }
                // The bytes of texts are stated together.
                let count = if code == TEXT { 1 } else { count };
                let place = Place { object, kind, count, offset: 0 };
                let of_object = &mut self.all[object].kind;
                if of_object.is_some_and(|before| before.numbers != kind.numbers) {
                    return Err(Problem::broken("a channel changes its type"));
                }
                *of_object = Some(kind);
                self.indices.insert(object, place);
                Ok(Some(place))
            }
        }
    }

    /// A channel, its group and the file.
    fn around(&self, channel: usize) -> Vec<&Object> {
        let path = &self.all[channel].path;
        let within = |other: &&Object| path.starts_with(&other.path);
        let mut around: Vec<&Object> = self.all.iter().filter(within).collect();
        around.sort_by_key(|object| std::cmp::Reverse(object.path.len()));
        around
    }

    /// The rate that a channel states, or else its group, or the file.
    fn stated(&self, channel: usize) -> Option<StatedRate> {
        let object = &self.all[channel];
        let increment = object.number("wf_increment").filter(|increment| *increment != 0.0);
        match increment {
            Some(increment) => Some(StatedRate {
                by: format!("wf_increment of {}", object.path.join(".")),
                rate_hz: 1.0 / (increment * object.abscissa_unit_s()?),
            }),
            None => self.around(channel).into_iter().find_map(Object::stated),
        }
    }

    /// * `first_s` - (s) what counts as 0 of times of the clock
    fn time_base(&self, channel: usize, first_s: f64) -> Option<TimeBase> {
        let stated =
            self.stated(channel).filter(|stated| stated.rate_hz.is_finite() && stated.rate_hz > 0.0)?;
        let start_s = self.all[channel].start_s();
        Some(TimeBase::Uniform {
            stated,
            start_s: if start_s > CLOCK_S { start_s - first_s } else { start_s },
        })
    }

    /// The numbers of a channel, out of all segments.
    fn numbers(&self, mut file: &File, channel: usize, file_bytes: u64) -> Result<Vec<f64>, Problem> {
        let object = &self.all[channel];
        let mut samples = Vec::with_capacity(object.count.min(file_bytes) as usize);
        for Segment { at, chunk, chunks, places, is_interleaved, big_endian } in &self.segments {
            let Ok(place) = places.binary_search_by_key(&channel, |place| place.object) else { continue };
            let Place { count, offset, kind: Kind { numbers: Some(number), bytes: size }, .. } =
                places[place]
            else {
                continue;
            };
            let numbers = Numbers::plain(number, *big_endian);
            file.seek(SeekFrom::Start(*at))?;
            if *is_interleaved {
                let (row, before) = ((chunk / count) as usize, offset as usize);
                let numbers = Numbers { before, behind: row - before - size as usize, ..numbers };
                read_records(&mut file, row, count * chunks, |block| {
                    numbers.append(block, 1, 0, &mut samples)
                })?;
            } else if *chunk <= SMALL_CHUNK {
                let (chunk, own) = (*chunk as usize, offset as usize..(offset + count * size) as usize);
                read_records(&mut file, chunk, *chunks, |block| {
                    let chunks = block.chunks_exact(chunk);
                    chunks.for_each(|chunk| numbers.append(&chunk[own.clone()], 1, 0, &mut samples));
                })?;
            } else {
                for index in 0..*chunks {
                    file.seek(SeekFrom::Start(at + index * chunk + offset))?;
                    read_records(&mut file, size as usize, count, |block| {
                        numbers.append(block, 1, 0, &mut samples)
                    })?;
                }
            }
        }
        if let Some(scaling) = self.around(channel).into_iter().find(|object| object.scales() > 0) {
            scaling.scale(&object.path.join("."), &mut samples)?;
        }
        Ok(samples)
    }
}
