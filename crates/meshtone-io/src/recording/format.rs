//! The format of a file, by its first bytes and its ending.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use super::error::Problem;
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
}

impl RecordingFormat {
    /// The name of the format in messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Text => "text",
            Self::Parquet => "Parquet",
            Self::Npy => "NPY",
            Self::Npz => "NPZ",
            Self::Mat => "MAT",
            Self::Wav => "WAV",
        }
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
    match ending.as_str() {
        "csv" | "tsv" | "tab" | "txt" | "dat" | "asc" if !binary => Ok(RecordingFormat::Text),
        "parquet" | "pq" => Ok(RecordingFormat::Parquet),
        "npy" => Ok(RecordingFormat::Npy),
        "npz" => Ok(RecordingFormat::Npz),
        "mat" => Ok(RecordingFormat::Mat),
        "wav" => Ok(RecordingFormat::Wav),
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
    if head.starts_with(b"PAR1") {
        Some(RecordingFormat::Parquet)
    } else if head.starts_with(b"\x93NUMPY") {
        Some(RecordingFormat::Npy)
    } else if head.starts_with(b"PK\x03\x04") || head.starts_with(b"PK\x05\x06") {
        Some(RecordingFormat::Npz)
    } else if head.starts_with(b"RIFF") {
        Some(RecordingFormat::Wav)
    } else if is_mat5(head) {
        Some(RecordingFormat::Mat)
    } else {
        None
    }
}

fn is_mat5(head: &[u8]) -> bool {
    matches!(
        head.get(MAT_VERSION_OFFSET..MAT_VERSION_OFFSET + 4),
        Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I'])
    )
}

/// Known formats that are not read: what they are, and how to convert them.
fn to_convert(head: &[u8]) -> Option<(&'static str, &'static str)> {
    let hdf5_behind = head.get(HDF5_OFFSET..).is_some_and(|behind| behind.starts_with(HDF5));
    if head.starts_with(b"MATLAB 7.3") || hdf5_behind {
        Some((
            "a MATLAB file of version 7.3 (HDF5)",
            "save it again in MATLAB with `s = load('FILE.mat'); save('FILE7.mat', '-struct', 's', '-v7')`, or in Python \
             with h5py and numpy.savez",
        ))
    } else if head.starts_with(HDF5) {
        Some(("an HDF5 file", "save its data sets in Python with h5py and numpy.savez, as .npz"))
    } else if head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]) {
        Some(("text in UTF-16", "save it as UTF-8, for instance with `iconv -f UTF-16 -t UTF-8`"))
    } else if head.starts_with(&[0x1f, 0x8b]) {
        Some(("a file compressed with gzip", "uncompress it with `gunzip`"))
    } else if head.starts_with(b"RF64") || head.starts_with(b"riff") {
        Some((
            "a WAV file of more than 4 GiB (RF64 or Wave64)",
            "cut it, for instance with `sox` or `ffmpeg`",
        ))
    } else if head.starts_with(b"TDSm") {
        Some((
            "a LabVIEW TDMS file",
            "save it in Python with `nptdms.TdmsFile(…).as_dataframe().to_parquet(…)`",
        ))
    } else if head.starts_with(&[0xd0, 0xcf, 0x11, 0xe0]) {
        Some(("an Excel file (.xls)", "save it as CSV"))
    } else {
        None
    }
}
