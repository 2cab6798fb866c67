//! How long it takes to read a recording of 60 s, 50 kS/s and four channels, and how much memory, format by
//! format: `cargo run --release -p meshtone-io --example recording_speed`. Takes 700 MB of disk for a moment.
//!
//! With a file and a sampling rate behind `--`, that file is read instead, once.
//!
//! Otherwise each file is read twice and the second time counts, so that the disk does not. Memory is the peak of what is
//! allocated while reading, the recording itself included.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Instant;

use meshtone_io::recording::{RecordingOptions, read_recording};
use meshtone_io::table::{CellType, Cells, TableColumn, TableWriter};
use ndarray::Array2;
use ndarray_npy::{NpzWriter, WriteNpyExt};
use peak_alloc::PeakAlloc;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

type Written = Result<(), Box<dyn Error>>;
type WriteFile = fn(&Path) -> Written;

const SAMPLES: usize = 3_000_000;
const CHANNELS: usize = 4;
const RATE_HZ: f64 = 50_000.0;
const BYTES: usize = SAMPLES * CHANNELS * size_of::<f64>();

/// Vibration with 16 bits of noise, as a converter gives it.
fn sample(index: usize, channel: usize) -> f64 {
    let mut state = (index * CHANNELS + channel) as u64;
    state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    f64::from((state >> 48) as i16) / 32768.0 * 10.0
}

fn main() -> Written {
    let mut arguments = std::env::args().skip(1);
    if let Some(path) = arguments.next() {
        let sampling_rate_hz = arguments.next().map(|rate| rate.parse()).transpose()?;
        let options = RecordingOptions { sampling_rate_hz, ..RecordingOptions::default() };
        let start = Instant::now();
        let recording = read_recording(path.as_ref(), &options)?;
        let seconds = start.elapsed().as_secs_f64();
        println!("{} channels of {} samples: {seconds:.3} s", recording.channels.len(), recording.len());
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let write: [(&str, WriteFile); 8] = [
        ("time.csv", |path| text(path, true, ",", 6)),
        ("plain.csv", |path| text(path, false, ",", 6)),
        ("all digits.csv", |path| text(path, true, ",", 17)),
        ("recording.parquet", parquet),
        ("recording.npy", |path| Ok(table().write_npy(BufWriter::new(File::create(path)?))?)),
        ("recording.npz", npz),
        ("recording.mat", mat),
        ("recording.wav", wav),
    ];
    println!("{:20} {:>8} {:>8} {:>14}", "file", "MB", "s", "memory / size");
    for (name, write) in write {
        let path = folder.path().join(name);
        write(&path)?;
        let options = RecordingOptions { sampling_rate_hz: rate_for(name), ..RecordingOptions::default() };
        read_recording(&path, &options)?;
        let before = MEMORY.current_usage();
        MEMORY.reset_peak_usage();
        let start = Instant::now();
        let recording = read_recording(&path, &options)?;
        let seconds = start.elapsed().as_secs_f64();
        let memory = (MEMORY.peak_usage() - before) as f64 / BYTES as f64;
        assert_eq!((recording.len(), recording.channels.len()), (SAMPLES, CHANNELS));
        assert!((recording.sampling_rate_hz - RATE_HZ).abs() < 1e-9);
        let megabytes = std::fs::metadata(&path)?.len() as f64 / 1e6;
        println!("{name:20} {megabytes:8.1} {seconds:8.3} {memory:14.2}");
        std::fs::remove_file(&path)?;
    }
    Ok(())
}

/// Where the file itself does not say it.
fn rate_for(name: &str) -> Option<f64> {
    ["plain.csv", "recording.npy"].contains(&name).then_some(RATE_HZ)
}

fn table() -> Array2<f64> {
    Array2::from_shape_fn((SAMPLES, CHANNELS), |(index, channel)| sample(index, channel))
}

fn column(channel: usize) -> Vec<f64> {
    (0..SAMPLES).map(|index| sample(index, channel)).collect()
}

fn text(path: &Path, time: bool, separator: &str, decimals: usize) -> Written {
    let mut to = BufWriter::new(File::create(path)?);
    writeln!(to, "{}a,b,c,d", if time { "time_s," } else { "" })?;
    for index in 0..SAMPLES {
        if time {
            write!(to, "{:.5}{separator}", index as f64 / RATE_HZ)?;
        }
        for channel in 0..CHANNELS {
            let end = if channel + 1 < CHANNELS { separator } else { "\n" };
            let scale = if decimals > 6 { 1.0 / 3.0 } else { 1.0 };
            write!(to, "{:.decimals$}{end}", sample(index, channel) * scale)?;
        }
    }
    Ok(to.flush()?)
}

fn parquet(path: &Path) -> Written {
    let time = (0..SAMPLES).map(|index| index as f64 / RATE_HZ).collect();
    let columns = [("time", time), ("a", column(0)), ("b", column(1)), ("c", column(2)), ("d", column(3))];
    let heads = columns.iter().map(|(name, _)| TableColumn {
        name: name.to_string(),
        cells: CellType::Float64,
        nullable: false,
        metadata: Vec::new(),
    });
    let mut table = TableWriter::new(File::create(path)?, heads.collect(), Default::default())?;
    table.write_rows(columns.iter().map(|(_, column)| Cells::Signal(column)).collect())?;
    Ok(table.close()?)
}

fn npz(path: &Path) -> Written {
    let mut archive = NpzWriter::new_compressed(BufWriter::new(File::create(path)?));
    archive.add_array("data", &table())?;
    archive.add_array("fs", &ndarray::arr0(RATE_HZ))?;
    archive.finish()?.flush()?;
    Ok(())
}

/// One compressed struct of four arrays and the rate, as MATLAB saves it.
fn mat(path: &Path) -> Written {
    let element = |kind: u32, data: &[u8]| {
        let mut bytes = [kind.to_le_bytes(), (data.len() as u32).to_le_bytes()].concat();
        bytes.extend_from_slice(data);
        bytes.resize(bytes.len().next_multiple_of(8), 0);
        bytes
    };
    let head = |class: u32, rows: u32, name: &str| {
        let flags = element(6, &[class.to_le_bytes(), [0; 4]].concat());
        let lengths = element(5, &[rows.to_le_bytes(), 1_u32.to_le_bytes()].concat());
        [flags, lengths, element(1, name.as_bytes())].concat()
    };
    let array = |numbers: &[f64]| {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        element(14, &[head(6, numbers.len() as u32, ""), element(9, &bytes)].concat())
    };
    let mut run = head(2, 1, "run");
    run.extend(element(5, &4_u32.to_le_bytes()));
    run.extend(element(1, b"a\0\0\0b\0\0\0c\0\0\0d\0\0\0fs\0\0"));
    (0..CHANNELS).for_each(|channel| run.extend(array(&column(channel))));
    run.extend(array(&[RATE_HZ]));
    let run = element(14, &run);
    let mut compressed = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    compressed.write_all(&run)?;
    let compressed = compressed.finish()?;
    let mut to = File::create(path)?;
    to.write_all(format!("{:124}\0\x01IM", "MATLAB 5.0 MAT-file").as_bytes())?;
    to.write_all(&[15_u32.to_le_bytes(), (compressed.len() as u32).to_le_bytes()].concat())?;
    to.write_all(&compressed)?;
    Ok(())
}

fn wav(path: &Path) -> Written {
    let sample_format = hound::SampleFormat::Float;
    let spec = hound::WavSpec { channels: 4, sample_rate: 50_000, bits_per_sample: 32, sample_format };
    let mut writer = hound::WavWriter::create(path, spec)?;
    for index in 0..SAMPLES {
        for channel in 0..CHANNELS {
            writer.write_sample(sample(index, channel) as f32)?;
        }
    }
    Ok(writer.finalize()?)
}
