//! The format of a file, by its first bytes and its ending.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use super::error::Problem;
use super::universal::is_universal;
use crate::scenario_file::{FileKind, read_text};

/// Bytes that are looked at: those of a MATLAB header, and the mark of HDF5 behind it.
const HEAD_BYTES: u64 = 520;
const HDF5: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Where an HDF5 file begins that MATLAB wrote.
const HDF5_OFFSET: usize = 512;
/// Where a MATLAB file states its version and byte order.
const MAT_VERSION_OFFSET: usize = 124;

/// A format of recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordingFormat {
    /// Numbers as text: CSV, TSV and alike.
    Text,
    /// Apache Parquet.
    Parquet,
    /// One NumPy array.
    Npy,
    /// An archive of NumPy arrays.
    Npz,
    /// MATLAB's MAT-file, version 5 to 7.
    Mat,
    /// WAV: PCM or floating point.
    Wav,
    /// HDF5, which MATLAB's MAT-file of version 7.3 is too.
    Hdf5,
    /// Universal file with data sets 58, as text or in binary.
    Universal,
    /// TDMS, of LabVIEW.
    Tdms,
    /// ASAM's measurement data format, MDF 4.
    Mdf,
}

/// Each format with its name in messages and the endings of its files.
const FORMATS: [(RecordingFormat, &str, &[&str]); 10] = [
    (RecordingFormat::Text, "text", &["csv", "tsv", "tab", "txt", "dat", "asc", "lvm"]),
    (RecordingFormat::Parquet, "Parquet", &["parquet", "pq"]),
    (RecordingFormat::Npy, "NPY", &["npy"]),
    (RecordingFormat::Npz, "NPZ", &["npz"]),
    (RecordingFormat::Mat, "MAT", &["mat"]),
    (RecordingFormat::Wav, "WAV", &["wav"]),
    (RecordingFormat::Hdf5, "HDF5", &["h5", "hdf5", "hdf", "he5"]),
    (RecordingFormat::Universal, "universal", &["uff", "unv", "uf"]),
    (RecordingFormat::Tdms, "TDMS", &["tdms"]),
    (RecordingFormat::Mdf, "MDF", &["mf4", "mdf"]),
];

/// Bytes that only files of one format have, and where.
const MARKS: [(usize, &[u8], RecordingFormat); 12] = [
    (0, b"PAR1", RecordingFormat::Parquet),
    (0, b"\x93NUMPY", RecordingFormat::Npy),
    (0, b"PK\x03\x04", RecordingFormat::Npz),
    (0, b"PK\x05\x06", RecordingFormat::Npz),
    (0, b"RIFF", RecordingFormat::Wav),
    (0, HDF5, RecordingFormat::Hdf5),
    (0, b"TDSm", RecordingFormat::Tdms),
    (0, b"MDF     ", RecordingFormat::Mdf),
    (0, b"UnFinMF ", RecordingFormat::Mdf),
    (MAT_VERSION_OFFSET, b"\x00\x01IM", RecordingFormat::Mat),
    (MAT_VERSION_OFFSET, b"\x01\x00MI", RecordingFormat::Mat),
    (HDF5_OFFSET, HDF5, RecordingFormat::Hdf5),
];

/// First bytes of known formats that are not read: what they are, and how to convert them.
const TO_CONVERT: [(&[u8], &str, &str); 3] = [
    (b"RF64", LARGE_WAV, CUT),
    (b"riff", LARGE_WAV, CUT),
    (b"\xd0\xcf\x11\xe0", "an Excel file (.xls)", "save it as CSV"),
];
const LARGE_WAV: &str = "a WAV file of more than 4 GiB (RF64 or Wave64)";
const CUT: &str = "cut it, for instance with `sox` or `ffmpeg`";

impl RecordingFormat {
    /// The name of the format in messages.
    pub(super) fn name(self) -> &'static str {
        FORMATS[self as usize].1
    }

    /// The format whose files have an ending.
    ///
    /// # Arguments
    /// * `ending` - in small letters, without a point
    pub fn of_ending(ending: &str) -> Option<Self> {
        FORMATS.iter().find(|(.., endings)| endings.contains(&ending)).map(|(format, ..)| *format)
    }
}

/// Finds out the format, and leaves the file at its start.
pub(super) fn detect(
    path: &Path,
    file: &mut File,
    given: Option<RecordingFormat>,
) -> Result<RecordingFormat, Problem> {
    let mut head = Vec::new();
    file.take(HEAD_BYTES).read_to_end(&mut head)?;
    file.rewind()?;
    if head.is_empty() {
        return Err(Problem::Refused("is empty (0 bytes)".to_string()));
    }
    if let Some((_, what, how)) = TO_CONVERT.iter().find(|(mark, ..)| head.starts_with(mark)) {
        return Err(Problem::convert(what, how));
    }
    let is_marked = |at: usize, mark: &[u8]| head.get(at..).is_some_and(|behind| behind.starts_with(mark));
    let marked = MARKS.iter().find(|(at, mark, _)| is_marked(*at, mark)).map(|(.., format)| *format);
    let marked = marked.or_else(|| is_universal(&head).then_some(RecordingFormat::Universal));
    if let Some(format) = given.or(marked) {
        return Ok(format);
    }
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let binary = head.contains(&0);
    // Loggers write numbers into files without an ending.
    let of_ending = RecordingFormat::of_ending(&ending);
    let of_ending = of_ending.or_else(|| ending.is_empty().then_some(RecordingFormat::Text));
    match of_ending {
        Some(format) if format != RecordingFormat::Text || !binary => Ok(format),
        _ => {
            let kind = if binary { "binary" } else { "text" };
            let first: Vec<String> = head.iter().take(4).map(|byte| format!("{byte:02x}")).collect();
            let first = first.join(" ");
            let text = if ending == "toml" { read_text(path).ok() } else { None };
            let found = if let Some(kind) = text.and_then(|text| FileKind::of(&text)) {
                format!("it is {}, which `{} {}` reads", kind.in_words(), kind.reader(), path.display())
            } else if ending.is_empty() {
                format!("it has no ending, and its {kind} begins with the bytes {first}")
            } else {
                format!("it ends in .{ending}, and its {kind} begins with the bytes {first}")
            };
            Err(Problem::UnknownFormat(found))
        }
    }
}
