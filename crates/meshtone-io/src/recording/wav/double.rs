//! WAV with floating point of 64 bits, which the crate `hound` does not read.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

use super::super::array::{ArrayLayout, read_channels};
use super::super::number::NumberKind;

/// Of the RIFF header: its mark, the length, the kind of content.
const RIFF_BYTES: u64 = 12;
/// Of a chunk's mark and length.
const CHUNK_HEAD_BYTES: u64 = 8;
/// Of what a format chunk always has, and of one that states its format behind that.
const FORMAT_BYTES: usize = 16;
const EXTENSIBLE_BYTES: usize = 26;
const FLOATING_POINT: u16 = 3;
const EXTENSIBLE: u16 = 0xfffe;
const SAMPLE_BYTES: u64 = 8;

/// Where the samples are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct DoubleWav {
    pub channels: u16,
    pub sampling_rate_hz: u32,
    /// Bytes before the samples, and of them.
    start: u64,
    bytes: u64,
}

impl DoubleWav {
    /// Looks for such samples; none where the file is of any other kind, or broken. The file is at its start afterwards.
    pub(super) fn find(file: &mut File) -> io::Result<Option<DoubleWav>> {
        let found = find(BufReader::new(&mut *file));
        file.seek(SeekFrom::Start(0))?;
        match found {
            Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
            found => found,
        }
    }

    /// Whether every channel has a sample as often as the others, and none is cut.
    pub(super) fn is_whole(&self) -> bool {
        self.bytes.is_multiple_of(SAMPLE_BYTES * u64::from(self.channels))
    }

    /// Samples of each channel.
    pub(super) fn samples(&self) -> u64 {
        self.bytes / (SAMPLE_BYTES * u64::from(self.channels))
    }

    /// (bytes) Of all samples.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Reads channels.
    ///
    /// # Arguments
    /// * `file` - the file
    /// * `wanted` - for each channel, whether it is read
    pub(super) fn read(&self, file: File, wanted: &[bool]) -> io::Result<Vec<Vec<f64>>> {
        let mut from = BufReader::new(file);
        from.seek(SeekFrom::Start(self.start))?;
        let channels = usize::from(self.channels);
        let layout = ArrayLayout { channels, samples: self.samples(), interleaved: channels > 1 };
        read_channels(&mut from, layout, NumberKind::F64, false, wanted, self.bytes)
    }
}

fn find(mut from: BufReader<&mut File>) -> io::Result<Option<DoubleWav>> {
    from.seek(SeekFrom::Start(RIFF_BYTES))?;
    let mut format = None;
    let mut at = RIFF_BYTES;
    loop {
        let mut head = [0; CHUNK_HEAD_BYTES as usize];
        from.read_exact(&mut head)?;
        let [mark @ .., a, b, c, d] = head;
        let length = u64::from(u32::from_le_bytes([a, b, c, d]));
        at += CHUNK_HEAD_BYTES;
        let mut read = 0;
        match (&mark, format) {
            (b"fmt ", _) => {
                let mut bytes = vec![0; (length as usize).min(EXTENSIBLE_BYTES)];
                from.read_exact(&mut bytes)?;
                read = bytes.len() as u64;
                format = doubles(&bytes);
                if format.is_none() {
                    return Ok(None);
                }
            }
            (b"data", Some((channels, sampling_rate_hz))) => {
                return Ok(Some(DoubleWav { channels, sampling_rate_hz, start: at, bytes: length }));
            }
            _ => {}
        }
        // Chunks have an even number of bytes.
        let padded = length.next_multiple_of(2);
        from.seek_relative((padded - read) as i64)?;
        at += padded;
    }
}

/// Channels and sampling rate of a format chunk, if it announces floating point of 64 bits.
fn doubles(format: &[u8]) -> Option<(u16, u32)> {
    let short = |at: usize| Some(u16::from_le_bytes([*format.get(at)?, *format.get(at + 1)?]));
    if format.len() < FORMAT_BYTES {
        return None;
    }
    let kind = match short(0)? {
        EXTENSIBLE => short(EXTENSIBLE_BYTES - 2)?,
        kind => kind,
    };
    let (channels, bits) = (short(2)?, short(FORMAT_BYTES - 2)?);
    let rate = u32::from(short(4)?) | u32::from(short(6)?) << 16;
    (kind == FLOATING_POINT && bits == 64 && channels > 0).then_some((channels, rate))
}
