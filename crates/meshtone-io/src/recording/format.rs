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

/// First bytes that only files of one format have.
const MARKS: [(&[u8], RecordingFormat); 9] = [
    (b"PAR1", RecordingFormat::Parquet),
    (b"\x93NUMPY", RecordingFormat::Npy),
    (b"PK\x03\x04", RecordingFormat::Npz),
    (b"PK\x05\x06", RecordingFormat::Npz),
    (b"RIFF", RecordingFormat::Wav),
    (HDF5, RecordingFormat::Hdf5),
    (b"TDSm", RecordingFormat::Tdms),
    (b"MDF     ", RecordingFormat::Mdf),
    (b"UnFinMF ", RecordingFormat::Mdf),
];

/// First bytes of known formats that are not read: what they are, and how to convert them.
const TO_CONVERT: [(&[&[u8]], &str, &str); 2] = [
    (
        &[b"RF64", b"riff"],
        "a WAV file of more than 4 GiB (RF64 or Wave64)",
        "cut it, for instance with `sox` or `ffmpeg`",
    ),
    (&[b"\xd0\xcf\x11\xe0"], "an Excel file (.xls)", "save it as CSV"),
];

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
    if let Some((what, how)) = to_convert(&head) {
        return Err(Problem::convert(what, how));
    }
    if let Some(format) = given.or_else(|| by_content(&head)) {
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
            let found = if let Some(kind) = file_kind(path, &ending) {
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

/// What a file is that is written for another command.
fn file_kind(path: &Path, ending: &str) -> Option<FileKind> {
    if ending != "toml" {
        return None;
    }
    FileKind::of(&read_text(path).ok()?)
}

fn by_content(head: &[u8]) -> Option<RecordingFormat> {
    let marked = MARKS.iter().find(|(mark, _)| head.starts_with(mark)).map(|(_, format)| *format);
    let of_matlab = || head.get(HDF5_OFFSET..).is_some_and(|behind| behind.starts_with(HDF5));
    marked
        .or_else(|| is_mat5(head).then_some(RecordingFormat::Mat))
        .or_else(|| of_matlab().then_some(RecordingFormat::Hdf5))
        .or_else(|| is_universal(head).then_some(RecordingFormat::Universal))
}

fn is_mat5(head: &[u8]) -> bool {
    matches!(
        head.get(MAT_VERSION_OFFSET..MAT_VERSION_OFFSET + 4),
        Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I'])
    )
}

/// Known formats that are not read: what they are, and how to convert them.
fn to_convert(head: &[u8]) -> Option<(&'static str, &'static str)> {
    let is_known = |marks: &[&[u8]]| marks.iter().any(|mark| head.starts_with(mark));
    let known = TO_CONVERT.iter().find(|(marks, ..)| is_known(marks));
    known.map(|(_, what, how)| (*what, *how))
}
