//! The formats that signals are written in, one file each.

pub(super) mod csv;
pub(super) mod mat;
pub(super) mod npz;
pub(super) mod parquet;
pub(super) mod wav;

use std::path::Path;

/// A format of signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignalFormat {
    /// Apache Parquet, with the scenario in it.
    Parquet,
    /// Numbers as text, separated by commas.
    Csv,
    /// MATLAB's MAT-file of version 5, which SciPy reads too.
    Mat,
    /// An archive of NumPy arrays.
    Npz,
    /// WAV: floating point of 32 bits, each channel divided by its full scale.
    Wav,
}

// The names are also the endings of their files; the default comes first.
meshtone_toml::named!(SignalFormat { Parquet = "parquet", Csv = "csv", Mat = "mat", Npz = "npz", Wav = "wav" });

impl SignalFormat {
    /// Name of the file of signals in a folder of results.
    pub const fn file_name(self) -> &'static str {
        match self {
            Self::Parquet => "signals.parquet",
            Self::Csv => "signals.csv",
            Self::Mat => "signals.mat",
            Self::Npz => "signals.npz",
            Self::Wav => "signals.wav",
        }
    }

    /// The format that the ending of a file's name says.
    ///
    /// # Arguments
    /// * `path` - the file
    pub fn of_path(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_lowercase();
        Self::ALL.into_iter().find(|format| format.name() == ending)
    }
}
