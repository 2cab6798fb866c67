//! WAV: PCM of 8, 16, 24 and 32 bits, and floating point of 32 and 64 bits.
//!
//! The crate `hound` reads no floating point of 64 bits, which measured recordings come in; so the chunks are read here, and the
//! samples as those of any other array.

use std::fs::File;
use std::io::{self, BufReader, Read};

use super::array::{ArrayLayout, read_channels};
use super::assemble::assemble;
use super::error::Problem;
use super::label::Label;
use super::number::{NumberKind, Numbers};
use super::rate::StatedRate;
use super::selection::select;
use super::{Recording, RecordingOptions, memory_need};
use crate::memory;
use crate::signals::{WavChannel, WavComment};

/// (bytes) Longest list of texts that is looked at: a comment of Meshtone's with as many channels as a file can have in practice.
const LONGEST_LIST: u64 = 1 << 20;
/// Bytes that a format chunk always has, and those of one that states its format behind them.
const FORMAT_BYTES: usize = 16;
const EXTENSIBLE_BYTES: usize = 26;
/// Codes of formats.
const PCM: u16 = 1;
const FLOATING_POINT: u16 = 3;
const EXTENSIBLE: u16 = 0xfffe;

/// What the format chunk says.
#[derive(Debug, Clone, Copy)]
struct Format {
    channels: u16,
    rate_hz: u32,
    numbers: Numbers,
    /// The stored number that means 0, and what is to be divided by so that full scale is 1.
    zero: f64,
    full_scale: f64,
}

/// Reads a recording from WAV. PCM is scaled so that full scale is 1; a file of Meshtone's states the full scale of each channel.
pub(super) fn read(file: File, options: &RecordingOptions) -> Result<Recording, Problem> {
    let file_bytes = file.metadata()?.len();
    let mut from = BufReader::new(file);
    let (format, comment, bytes) = find_samples(&mut from)?;
    if bytes > file_bytes {
        let problem = format!("it announces {bytes} bytes of samples, but ends after {file_bytes}");
        return Err(Problem::Broken(problem));
    }
    let (channels, sample_bytes) = (usize::from(format.channels), format.numbers.element_bytes());
    let record_bytes = (channels * sample_bytes) as u64;
    if !bytes.is_multiple_of(record_bytes) {
        return Err(Problem::Broken(format!(
            "its {bytes} bytes of samples are no whole number of samples of {sample_bytes} bytes for each of {channels} channels"
        )));
    }
    let layout = ArrayLayout { channels, samples: bytes / record_bytes, interleaved: channels > 1 };
    let (labels, full_scales, by, rate_hz): (Vec<Label>, Vec<f64>, _, _) = match &comment {
        Some(WavComment { channels, sampling_rate_hz, .. }) => {
            let scaled = channels.iter().map(|channel| (channel.label(), channel.full_scale)).unzip();
            (scaled.0, scaled.1, "its comment", *sampling_rate_hz)
        }
        None => {
            let labels = (1..=channels).map(|number| Label::numbered("channel", number)).collect();
            (labels, vec![1.0; channels], "its header", f64::from(format.rate_hz))
        }
    };
    let selection = select(&labels, options)?;
    memory_need::check(memory::limit(), options, &selection, |_| layout.samples, 0)?;
    let wanted: Vec<bool> =
        (0..channels).map(|channel| selection.wanted.binary_search(&channel).is_ok()).collect();
    let mut samples = read_channels(&mut from, layout, format.numbers, &wanted, bytes)?;
    for (&channel, samples) in selection.wanted.iter().zip(&mut samples) {
        let (zero, full_scale) = (format.zero, format.full_scale);
        samples.iter_mut().for_each(|sample| *sample = (*sample - zero) / full_scale * full_scales[channel]);
    }
    let stated = [StatedRate { by: by.to_owned(), rate_hz }];
    let recording = assemble(&labels, &selection, samples, &stated, options)?;
    let start_s = comment.map_or(recording.start_s, |comment| comment.start_s);
    Ok(Recording { start_s, ..recording })
}

impl WavChannel {
    fn label(&self) -> Label {
        Label { unit: Some(self.unit.clone()), ..Label::plain(&self.name) }
    }
}

impl WavComment {
    /// The comment in a list of texts, if it is one of Meshtone's and fits the format.
    fn of_list(list: &[u8], format: &Format) -> Option<Self> {
        let text = list.strip_prefix(b"INFOICMT")?.get(4..)?;
        let text = text.split(|byte| *byte == 0).next()?;
        let comment: Self = serde_json::from_slice(text).ok()?;
        let is_scale = |channel: &WavChannel| channel.full_scale.is_normal() && channel.full_scale > 0.0;
        let fits = comment.channels.len() == usize::from(format.channels)
            && comment.channels.iter().all(is_scale)
            && comment.start_s.is_finite()
            && (comment.sampling_rate_hz - f64::from(format.rate_hz)).abs() <= 0.5;
        fits.then_some(comment)
    }
}

/// Goes to the samples, and returns their format, the comment, and how many bytes they have.
fn find_samples(from: &mut BufReader<File>) -> Result<(Format, Option<WavComment>, u64), Problem> {
    let mut riff = [0; 12];
    from.read_exact(&mut riff)?;
    if !(riff.starts_with(b"RIFF") && riff.ends_with(b"WAVE")) {
        return Err(Problem::broken("it does not begin as WAV files do"));
    }
    let (mut format, mut comment) = (None, None);
    loop {
        let mut head = [0; 8];
        from.read_exact(&mut head)?;
        let [mark @ .., a, b, c, d] = head;
        let length = u64::from(u32::from_le_bytes([a, b, c, d]));
        let mut read = 0;
        match (&mark, format) {
            (b"fmt ", _) => {
                let mut chunk = vec![0; (length as usize).min(EXTENSIBLE_BYTES)];
                from.read_exact(&mut chunk)?;
                read = chunk.len() as u64;
                format = Some(format_of(&chunk)?);
            }
            (b"LIST", Some(format)) if length <= LONGEST_LIST => {
                let mut list = Vec::new();
                read = from.by_ref().take(length).read_to_end(&mut list)? as u64;
                if read < length {
                    return Err(io::Error::from(io::ErrorKind::UnexpectedEof).into());
                }
                comment = WavComment::of_list(&list, &format).or(comment);
            }
            (b"data", Some(format)) => return Ok((format, comment, length)),
            (b"data", None) => return Err(Problem::broken("it has samples, but no format before them")),
            _ => {}
        }
        // Chunks have an even number of bytes.
        from.seek_relative((length.next_multiple_of(2) - read) as i64)?;
    }
}

fn format_of(chunk: &[u8]) -> Result<Format, Problem> {
    if chunk.len() < FORMAT_BYTES {
        return Err(Problem::broken("its format chunk is too short"));
    }
    // Absent numbers, behind the end of the chunk, are 0.
    let short = |at: usize| chunk.get(at..at + 2).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]));
    let code = if short(0) == EXTENSIBLE { short(EXTENSIBLE_BYTES - 2) } else { short(0) };
    let channels = short(2);
    let rate_hz = u32::from(short(4)) | u32::from(short(6)) << 16;
    let (record_bytes, stored_bits) = (short(12), short(FORMAT_BYTES - 2));
    if channels == 0 {
        return Err(Problem::broken("it has 0 channels"));
    }
    // An extensible chunk may say that fewer bits count than are stored.
    let counting_bits = short(FORMAT_BYTES + 2);
    let is_shortened = short(0) == EXTENSIBLE && counting_bits > 0;
    let bits = if is_shortened { counting_bits } else { stored_bits };
    let kind = match (code, bits) {
        (PCM, 8) => NumberKind::U8,
        (PCM, 16) => NumberKind::I16,
        (PCM, 24) => NumberKind::I24,
        (PCM, 32) => NumberKind::I32,
        (FLOATING_POINT, 32) => NumberKind::F32,
        (FLOATING_POINT, 64) => NumberKind::F64,
        _ => return Err(Problem::broken(UNSUPPORTED)),
    };
    let numbers = Numbers {
        // 24 bits may stand in four bytes, of which the last is empty.
        behind: usize::from(kind == NumberKind::I24 && record_bytes / channels == 4),
        ..Numbers::plain(kind, false)
    };
    if usize::from(record_bytes) != numbers.element_bytes() * usize::from(channels) {
        return Err(Problem::broken(UNSUPPORTED));
    }
    let zero = if kind == NumberKind::U8 { 128.0 } else { 0.0 };
    let full_scale = if code == PCM { f64::from(bits - 1).exp2() } else { 1.0 };
    Ok(Format { channels, rate_hz, numbers, zero, full_scale })
}

const UNSUPPORTED: &str = "its samples are neither PCM of 8 to 32 bits nor floating point of 32 or 64 bits; convert it, for instance \
                           with `ffmpeg -i FILE.wav -c:a pcm_f32le NEW.wav`";
