//! Broken and hostile recordings: no reader panics, and none takes much more memory than the file has.
//!
//! A test program of its own, because it counts the memory of the whole program.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "all/parquet_help.rs"]
#[allow(dead_code)]
mod parquet_help;
#[path = "all/recording_help.rs"]
mod recording_help;

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};

use meshtone_io::recording::{RecordingFormat, RecordingOptions};
use ndarray::{Array2, arr0};
use ndarray_npy::{NpzWriter, WriteNpyExt};
use parquet_help::{Plain, parquet};
use peak_alloc::PeakAlloc;
use proptest::prelude::*;
use recording_help::{rate, read, refused};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Memory that reading a small file may take: buffers, and what compression makes of some kilobytes.
const MOST_BYTES: usize = 64 << 20;

const FORMATS: [(&str, RecordingFormat); 8] = [
    ("a.csv", RecordingFormat::Text),
    ("a.parquet", RecordingFormat::Parquet),
    ("a.npy", RecordingFormat::Npy),
    ("a.npz", RecordingFormat::Npz),
    ("a.mat", RecordingFormat::Mat),
    ("a.wav", RecordingFormat::Wav),
    ("a.tdms", RecordingFormat::Tdms),
    ("a.mf4", RecordingFormat::Mdf),
];

fn table() -> Array2<f64> {
    Array2::from_shape_fn((40, 2), |(row, column)| row as f64 / 8.0 - column as f64)
}

/// A whole file of each format; two of MATLAB.
fn whole() -> &'static [(&'static str, Vec<u8>)] {
    static WHOLE: OnceLock<Vec<(&'static str, Vec<u8>)>> = OnceLock::new();
    WHOLE.get_or_init(|| {
        let lines = (0..40).map(|row| format!("{:.2};{},5;\"{}\"\n", row, row % 7, row));
        let csv = "t [s];a [g];b\n".to_string() + &lines.collect::<String>();
        let column = |column| Plain::doubles(table().column(column).to_vec());
        let parquet = parquet(vec![("a", column(0)), ("b", column(1))], Vec::new());
        let mut npy = Vec::new();
        table().write_npy(&mut npy).unwrap();
        let mut npz = Cursor::new(Vec::new());
        let mut archive = NpzWriter::new_compressed(&mut npz);
        archive.add_array("a", &table()).unwrap();
        archive.add_array("fs", &arr0(100.0)).unwrap();
        archive.finish().unwrap();
        let spec = hound::WavSpec {
            channels: 2,
            sample_rate: 8000,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let mut wav = Cursor::new(Vec::new());
        let mut writer = hound::WavWriter::new(&mut wav, spec).unwrap();
        (0..80).for_each(|sample| writer.write_sample(sample).unwrap());
        writer.finalize().unwrap();
        let mat = |name: &str| {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-io/tests/recordings");
            fs::read(folder.join(name)).unwrap()
        };
        let format = |name| mat(&format!("formats/{name}"));
        let lvm = "LabVIEW Measurement\nX_Columns\tOne\n***End_of_Header***\nY_Unit_Label\tg\nX0\t0\nDelta_X\t0.01\n***End_of_Header***\n";
        vec![
            ("a.lvm", format!("{lvm}X_Value\ta\tComment\n0\t1.5\n0.01\t2\n0.02\t0\n").into_bytes()),
            ("a.tdms", format("segments.tdms")),
            ("a.tdms", format("interleaved.tdms")),
            ("a.tdms", format("scaled.tdms")),
            ("a.mf4", format("rates.mf4")),
            ("a.mf4", format("transposed.mf4")),
            ("a.xlsx", format("units.xlsx")),
            ("a.mat", format("version4.mat")),
            ("a.csv", csv.into_bytes()),
            ("a.parquet", parquet),
            ("a.npy", npy),
            ("a.npz", npz.into_inner()),
            ("a.mat", mat("nested.mat")),
            ("a.mat", mat("nested_compressed.mat")),
            ("a.wav", wav.into_inner()),
        ]
    })
}

/// Reads, and checks that what comes is a recording or a message, within the memory.
fn check(name: &str, bytes: &[u8], options: &RecordingOptions) {
    // One at a time, as the memory is that of all tests.
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    match read(name, bytes, options) {
        Ok(recording) => {
            assert!(recording.sampling_rate_hz > 0.0 && !recording.is_empty());
            let length = recording.len();
            for channel in &recording.channels {
                assert!(channel.samples.len() == length && channel.samples.iter().all(|s| s.is_finite()));
            }
        }
        Err(error) => assert!(error.to_string().len() < 20_000),
    }
    let peak = MEMORY.peak_usage().saturating_sub(before);
    assert!(peak <= MOST_BYTES, "{name}: {peak} bytes of memory for {} bytes", bytes.len());
}

fn check_both(name: &str, bytes: &[u8]) {
    check(name, bytes, &rate(100.0));
    check(name, bytes, &RecordingOptions::default());
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bytes(format in 0..FORMATS.len(), bytes in prop::collection::vec(any::<u8>(), 0..600)) {
        let (name, format) = FORMATS[format];
        check(name, &bytes, &RecordingOptions { format: Some(format), ..rate(100.0) });
        check_both(name, &bytes);
    }

    #[test]
    fn random_text(text in "[-+0-9.,;eEnaN\"# \t\r\n|a-c\\[\\]]{0,300}") {
        check_both("a.csv", text.as_bytes());
    }

    #[test]
    fn cut_files(file in 0..15_usize, part in 0.0..1.0) {
        let (name, bytes) = &whole()[file];
        check_both(name, &bytes[..(part * bytes.len() as f64) as usize]);
    }

    #[test]
    fn changed_files(
        file in 0..15_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        run in prop::option::of((any::<prop::sample::Index>(), 1..16_usize, prop::sample::select(vec![0_u8, 0x7f, 0xff]))),
    ) {
        let (name, bytes) = &whole()[file];
        let mut bytes = bytes.clone();
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        // A run of one byte makes large numbers of lengths.
        if let Some((at, length, byte)) = run {
            let at = at.index(bytes.len());
            let end = (at + length).min(bytes.len());
            bytes[at..end].fill(byte);
        }
        check_both(name, &bytes);
    }

    #[test]
    fn cut_and_joined_files(file in 0..15_usize, from in 0.0..1.0, to in 0.0..1.0) {
        let (name, bytes) = &whole()[file];
        let at = |part: f64| (part * bytes.len() as f64) as usize;
        check_both(name, &[&bytes[..at(from)], &bytes[at(to)..]].concat());
    }
}

/// The inputs with which fuzzing begins, among them those that it has found.
#[test]
fn seeds_of_fuzzing_are_read_or_refused() {
    let seeds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    for (target, ending) in [
        ("text", "csv"),
        ("parquet", "parquet"),
        ("npy", "npy"),
        ("npz", "npz"),
        ("mat", "mat"),
        ("hdf5", "h5"),
        ("wav", "wav"),
        ("universal", "uff"),
        ("packed", "csv.gz"),
        ("tdms", "tdms"),
        ("mdf", "mf4"),
        ("workbook", "xlsx"),
    ] {
        for seed in fs::read_dir(seeds.join(target)).unwrap() {
            check_both(&format!("a.{ending}"), &fs::read(seed.unwrap().path()).unwrap());
        }
    }
}

/// Every single byte of a whole file, set to what makes lengths large.
#[test]
fn every_byte_may_be_wrong() {
    for (name, bytes) in whole() {
        let step = 1 + bytes.len() / 500;
        for at in (0..bytes.len()).step_by(step) {
            for byte in [0, 0x7f, 0xff] {
                let mut bytes = bytes.clone();
                bytes[at] = byte;
                check(name, &bytes, &rate(100.0));
            }
        }
    }
}

#[test]
fn deep_nesting_does_not_end_the_stack() {
    let mut npy = b"\x93NUMPY\x02\x00".to_vec();
    let header = "{'descr': ".to_string() + &"[(".repeat(100_000);
    npy.extend((header.len() as u32).to_le_bytes());
    npy.extend(header.as_bytes());
    assert!(refused("a.npy", &npy, &rate(1.0)).contains("header"));
}

/// A schema of groups inside groups, in Thrift's compact protocol.
#[test]
fn deeply_nested_parquet_does_not_end_the_stack() {
    for depth in [10_u32, 1000, 30_000, 300_000] {
        let mut metadata = vec![0x15, 2, 0x19, 0xfc];
        let mut count = depth + 1;
        while count > 0x7f {
            metadata.push((count & 0x7f) as u8 | 0x80);
            count >>= 7;
        }
        metadata.push(count as u8);
        (0..depth).for_each(|_| metadata.extend([0x35, 0, 0x18, 1, b'a', 0x15, 2, 0]));
        metadata.extend([0x15, 10, 0x25, 0, 0x18, 1, b'a', 0]);
        metadata.extend([0x16, 0, 0x19, 0x0c, 0]);
        let length = (metadata.len() as u32).to_le_bytes();
        let file = [b"PAR1", &metadata[..], &length, b"PAR1"].concat();
        assert!(refused("a.parquet", &file, &rate(1.0)).starts_with("a.parquet: "));
    }
}
