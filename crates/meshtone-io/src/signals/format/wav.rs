//! Signals as WAV: floating point of 32 bits, which players expect between −1 and 1.
//!
//! So each channel is divided by its full scale, a power of two, which changes no digit. The comment of the file (chunk LIST, entry
//! ICMT) states the full scales, the names, the units and the sampling rate, which the header holds only as a whole number;
//! [`read_recording`](crate::recording::read_recording) reads them.
//! Source: Microsoft and IBM, "Multimedia Programming Interface and Data Specifications 1.0" (1991). The crate `hound` writes no comment.

use std::io::{self, BufWriter, Write};

use serde::{Deserialize, Serialize};

use super::super::signal_table::SignalTable;

/// Code of floating point.
const FLOATING_POINT: u16 = 3;
/// (bytes) A sample.
const SAMPLE_BYTES: usize = size_of::<f32>();
/// (bytes) Of the format chunk.
const FORMAT_BYTES: usize = 18;
/// (bytes) All but comment and samples, behind the length of the whole: the mark, the format, the number of samples, and the heads of
/// comment and samples.
const FIXED_BYTES: usize = 4 + (8 + FORMAT_BYTES) + (8 + 4) + (8 + 12) + 8;

/// What a WAV file of Meshtone says of its channels, as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct WavComment {
    /// (S/s)
    pub sampling_rate_hz: f64,
    /// (s) Time of the first sample.
    pub start_s: f64,
    pub channels: Vec<WavChannel>,
}

/// A channel of a WAV file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct WavChannel {
    pub name: String,
    pub unit: String,
    /// (unit) What a sample of 1 means.
    pub full_scale: f64,
}

pub fn write(table: &SignalTable, to: impl Write) -> io::Result<()> {
    let channels = table.channels.signals.iter().map(|column| WavChannel {
        name: column.name.to_string(),
        unit: column.unit.to_owned(),
        full_scale: full_scale(&column.values),
    });
    let comment = WavComment {
        sampling_rate_hz: table.channels.sampling_rate_hz,
        start_s: table.channels.start_s,
        channels: channels.collect(),
    };
    let mut to = BufWriter::new(to);
    write_head(&mut to, &comment, table.channels.len())?;
    for sample in 0..table.channels.len() {
        for (column, channel) in table.channels.signals.iter().zip(&comment.channels) {
            to.write_all(&((column.values[sample] / channel.full_scale) as f32).to_le_bytes())?;
        }
    }
    to.flush()
}

/// (unit) The least power of two that no sample exceeds; 1 of a signal that is 0.
fn full_scale(values: &[f64]) -> f64 {
    let peak = values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    if peak > 0.0 { peak.log2().ceil().exp2() } else { 1.0 }
}

/// Writes all chunks before the samples.
fn write_head(to: &mut impl Write, comment: &WavComment, samples: usize) -> io::Result<()> {
    let mut text = serde_json::to_vec(comment)?;
    text.push(0);
    text.resize(text.len().next_multiple_of(2), 0);
    let record_bytes = SAMPLE_BYTES * comment.channels.len();
    let data_bytes = record_bytes * samples;
    let length = |bytes: usize| {
        let problem = format!(
            "{bytes} bytes do not fit into a WAV file (4 GiB); leave signals out, or write another format"
        );
        u32::try_from(bytes).map(u32::to_le_bytes).map_err(|_| io::Error::other(problem))
    };
    let rate = comment.sampling_rate_hz.round() as u32;
    to.write_all(b"RIFF")?;
    to.write_all(&length(FIXED_BYTES + text.len() + data_bytes)?)?;
    to.write_all(b"WAVEfmt ")?;
    to.write_all(&length(FORMAT_BYTES)?)?;
    to.write_all(&FLOATING_POINT.to_le_bytes())?;
    to.write_all(&(comment.channels.len() as u16).to_le_bytes())?;
    to.write_all(&rate.to_le_bytes())?;
    to.write_all(&length(rate as usize * record_bytes)?)?;
    to.write_all(&(record_bytes as u16).to_le_bytes())?;
    to.write_all(&(8 * SAMPLE_BYTES as u16).to_le_bytes())?;
    // No more bytes of the format.
    to.write_all(&0_u16.to_le_bytes())?;
    to.write_all(b"fact")?;
    to.write_all(&length(4)?)?;
    to.write_all(&length(samples)?)?;
    to.write_all(b"LIST")?;
    to.write_all(&length(12 + text.len())?)?;
    to.write_all(b"INFOICMT")?;
    to.write_all(&length(text.len())?)?;
    to.write_all(&text)?;
    to.write_all(b"data")?;
    to.write_all(&length(data_bytes)?)
}
