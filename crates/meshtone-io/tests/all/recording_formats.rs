//! Sixty files as practitioners have them: each is opened without an option and gives the same recording, or is refused with what to do.
//! Those of the folder `recordings/formats` were written by other programs' writers.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;

use meshtone_io::recording::{Recording, RecordingOptions, RecordingWarning};

use crate::parquet_help::{Plain, parquet};
use crate::recording_help::{rate, read, refused};

const RATE_HZ: f64 = 25_600.0;
const SAMPLES: usize = 256;

fn time_s(index: usize) -> f64 {
    index as f64 / RATE_HZ
}

fn acc(index: usize) -> f64 {
    ((index * 7919 % 1009) as f64 - 504.0) / 256.0
}

fn tacho(index: usize) -> f64 {
    if index % 64 < 6 { 5.0 } else { 0.0 }
}

/// A file of the folder.
fn written(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../meshtone-io/tests/recordings/formats");
    fs::read(folder.join(name)).unwrap()
}

/// Lines of text: a time, the acceleration and the tachometer of each sample, between separators.
fn rows(separator: &str, time: impl Fn(usize) -> String) -> String {
    let row = |index| format!("{}{separator}{:?}{separator}{:?}\n", time(index), acc(index), tacho(index));
    (0..SAMPLES).map(row).collect()
}

fn seconds(index: usize) -> String {
    format!("{:.8}", time_s(index))
}

fn clock(index: usize) -> String {
    format!("12:30:{:010.7}", 59.0 + time_s(index)).replace("12:30:60", "12:31:00")
}

fn csv(header: &str) -> String {
    header.to_owned() + &rows(",", seconds)
}

fn utf16(mark: &[u8], bytes: fn(u16) -> [u8; 2], text: &str) -> Vec<u8> {
    [mark, &text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>()].concat()
}

fn gzip(content: &[u8]) -> Vec<u8> {
    let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    gzip.write_all(content).unwrap();
    gzip.finish().unwrap()
}

fn zip(name: &str, content: &[u8]) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
    zip.write_all(content).unwrap();
    zip.finish().unwrap().into_inner()
}

/// The head of a file of LabVIEW's, and the numbers behind it.
fn lvm(x_columns: &str, decimal: &str, rows: &str) -> Vec<u8> {
    let text = format!(
        "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\nDecimal_Separator\t{decimal}\nX_Columns\t{x_columns}\n\
         ***End_of_Header***\t\n\t\nChannels\t2\t\nSamples\t256\t256\t\nY_Unit_Label\tg\tV\t\nX_Dimension\tTime\tTime\t\n\
         X0\t0.0\t0.0\t\nDelta_X\t3.90625E-5\t3.90625E-5\t\n***End_of_Header***\t\t\t\nX_Value\tacc\ttacho\tComment\n{rows}"
    );
    (if decimal == "," { text.replace('.', ",") } else { text }).into_bytes()
}

fn wav() -> Vec<u8> {
    let spec = hound::WavSpec {
        channels: 2,
        sample_rate: RATE_HZ as u32,
        bits_per_sample: 32,
        sample_format: hound::SampleFormat::Float,
    };
    let mut bytes = Cursor::new(Vec::new());
    let mut writer = hound::WavWriter::new(&mut bytes, spec).unwrap();
    for index in 0..SAMPLES {
        writer.write_sample(acc(index) as f32).unwrap();
        writer.write_sample(tacho(index) as f32).unwrap();
    }
    writer.finalize().unwrap();
    bytes.into_inner()
}

fn npz() -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let mut archive = ndarray_npy::NpzWriter::new_compressed(&mut bytes);
    archive.add_array("acc", &ndarray::Array1::from_shape_fn(SAMPLES, acc)).unwrap();
    archive.add_array("tacho", &ndarray::Array1::from_shape_fn(SAMPLES, tacho)).unwrap();
    archive.add_array("fs", &ndarray::arr0(RATE_HZ)).unwrap();
    archive.finish().unwrap();
    bytes.into_inner()
}

fn table_of_parquet(time: &str) -> Vec<u8> {
    let columns: [(&str, &dyn Fn(usize) -> f64); 3] =
        [(time, &time_s), ("acc [g]", &acc), ("tacho [V]", &tacho)];
    parquet(columns.map(|(name, of)| (name, Plain::doubles((0..SAMPLES).map(of)))).into(), Vec::new())
}

/// Every file that is opened without an option.
fn opened() -> Vec<(&'static str, Vec<u8>)> {
    let header = "time [s],acc [g],tacho [V]\n";
    let plain = csv(header);
    let with = |time: &str, of: &dyn Fn(usize) -> String| {
        format!("{time},acc [g],tacho [V]\n{}", rows(",", of)).into_bytes()
    };
    let of = |separator: &str| (header.replace(',', separator) + &rows(separator, seconds)).into_bytes();
    let comma = |separator: &str| String::from_utf8(of(separator)).unwrap().replace('.', ",").into_bytes();
    let quoted =
        plain.lines().map(|line| format!("\"{}\"\n", line.replace(',', "\",\""))).collect::<String>();
    let as_lvm = rows("\t", seconds);
    let without_x = rows("\t", |_| String::new());
    let german = |index| format!("29.11.2026 {}", clock(index));
    let iso = |index| format!("2026-11-29T{}Z", clock(index));
    let dates =
        format!("date,time,acc [g],tacho [V]\n{}", rows(",", |index| format!("2026-11-29,{}", clock(index))));
    let counted =
        format!(",time,acc [g],tacho [V]\n{}", rows(",", |index| format!("{index},{}", seconds(index))));
    let mut files = vec![
        ("comma.csv", plain.clone().into_bytes()),
        ("semicolon.csv", of(";")),
        ("semicolon_comma.csv", comma(";")),
        ("tabulator.tsv", of("\t")),
        ("tabulator_comma.txt", comma("\t")),
        ("bar.txt", of("|")),
        ("blanks.dat", format!("# time acc tacho\n{}", rows("   ", seconds)).into_bytes()),
        ("crlf.csv", plain.replace('\n', "\r\n").into_bytes()),
        ("mark.csv", [b"\xef\xbb\xbf", plain.as_bytes()].concat()),
        (
            "latin1.csv",
            csv("Zeit [s],acc [g],gr\u{f6}\u{df}e\n").chars().map(|letter| letter as u8).collect(),
        ),
        ("utf16_le.csv", utf16(b"\xff\xfe", u16::to_le_bytes, &plain)),
        ("utf16_be.csv", utf16(b"\xfe\xff", u16::to_be_bytes, &plain)),
        (
            "utf16.txt",
            utf16(
                b"",
                u16::to_le_bytes,
                &format!("# a recorder wrote this in two bytes a letter, without a mark\n{plain}"),
            ),
        ),
        ("excel.csv", [b"sep=;\r\n", &of(";")[..]].concat()),
        ("percent.asc", format!("% rig 3, sensor 1\n% time,acc,tacho\n{}", rows(",", seconds)).into_bytes()),
        ("units.csv", csv("time,acc,tacho\ns,g,V\n").into_bytes()),
        ("units_in_brackets.csv", csv("time,acc,tacho\n[s],[g],[V]\n").into_bytes()),
        ("quoted.csv", quoted.into_bytes()),
        ("trailing.csv", plain.replace('\n', ",\n").into_bytes()),
        ("no_ending", plain.clone().into_bytes()),
        ("milliseconds.csv", with("time [ms]", &|index| format!("{:.6}", 1e3 * time_s(index)))),
        ("microseconds.csv", with("time_us", &|index| format!("{:.4}", 1e6 * time_s(index)))),
        ("timestamps.csv", with("timestamps", &seconds)),
        ("elapsed.csv", with("elapsed_s", &seconds)),
        ("sample_time.csv", with("sample_time", &seconds)),
        ("x_value.csv", with("X_Value", &seconds)),
        ("zeit.csv", with("Zeit (s)", &seconds)),
        ("clock.csv", with("time", &clock)),
        ("pm.csv", with("time", &|index| clock(index) + " PM")),
        ("iso.csv", with("timestamp", &iso)),
        ("german.csv", with("Zeitpunkt", &german)),
        ("dates.csv", dates.into_bytes()),
        ("counted.csv", counted.into_bytes()),
        ("one.lvm", lvm("One", ".", &as_lvm)),
        ("one_comma.lvm", lvm("One", ",", &as_lvm)),
        ("no.lvm", lvm("No", ".", &without_x)),
        ("text.csv.gz", gzip(plain.as_bytes())),
        ("text.zip", zip("rig/run.csv", plain.as_bytes())),
        ("utf16.zip", zip("run.csv", &utf16(b"\xff\xfe", u16::to_le_bytes, &plain))),
        ("plain.tdms.gz", gzip(&written("plain.tdms"))),
        ("float.wav", wav()),
        ("numpy.npz", npz()),
        ("table.parquet", table_of_parquet("time [s]")),
    ];
    let names = [
        "plain.tdms",
        "segments.tdms",
        "time.tdms",
        "scaled.tdms",
        "interleaved.tdms",
        "plain.mf4",
        "deflated.mf4",
        "transposed.mf4",
        "rates.mf4",
        "rates.tdms",
        "plain.xlsx",
        "units.xlsx",
        "clock.xlsx",
        "version4.mat",
        "half.h5",
        "links_old.h5",
        "links_new.h5",
        "text.uff",
        "binary.uff",
    ];
    files.extend(names.map(|name| (name, written(name))));
    files
}

/// A segment of TDMS: its contents, where it ends, metadata and numbers.
fn segment(contents: u32, end: Option<u64>, metadata: &[u8], numbers: &[u8]) -> Vec<u8> {
    let length = end.unwrap_or((metadata.len() + numbers.len()) as u64);
    let head = [&b"TDSm"[..], &contents.to_le_bytes(), &4713_u32.to_le_bytes(), &length.to_le_bytes()];
    [&head.concat(), &(metadata.len() as u64).to_le_bytes()[..], metadata, numbers].concat()
}

/// A text of TDMS.
fn text(words: &str) -> Vec<u8> {
    [&(words.len() as u32).to_le_bytes()[..], words.as_bytes()].concat()
}

/// The object of a TDMS channel of doubles, with its interval and the unit of that.
fn channel(name: &str, samples: u64, increment: f64, unit: &str) -> Vec<u8> {
    let index = [20_u32, 10, 1].map(u32::to_le_bytes).concat();
    let start = [text(&format!("/'run'/'{name}'")), index, samples.to_le_bytes().to_vec()].concat();
    let interval = [text("wf_increment"), 10_u32.to_le_bytes().to_vec(), increment.to_le_bytes().to_vec()];
    let unit = [text("wf_xunit_string"), 0x20_u32.to_le_bytes().to_vec(), text(unit)];
    [start, 2_u32.to_le_bytes().to_vec(), interval.concat(), unit.concat()].concat()
}

/// A TDMS file of one segment.
fn tdms(channels: &[Vec<u8>], numbers: &[f64], end: Option<u64>) -> Vec<u8> {
    let metadata = [&(channels.len() as u32).to_le_bytes()[..], &channels.concat()].concat();
    let numbers: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    segment(0b1110, end, &metadata, &numbers)
}

/// What is not opened, and what its message says.
fn not_opened() -> Vec<(&'static str, Vec<u8>, &'static str)> {
    let numbers = rows(",", seconds);
    vec![
        ("no_rate.csv", csv("a,b,c\n").into_bytes(), "give the sampling rate"),
        (
            "milliseconds.csv",
            format!("t,acc,tacho\n{}", rows(",", |index| format!("{:.6}", 1e3 * time_s(index)))).into_bytes(),
            "`t_ms`",
        ),
        ("head.csv", format!("Recorder: X3\nOperator: nobody\n{numbers}").into_bytes(), "skip"),
        ("soft_old.h5", written("soft_old.h5"), "h5repack"),
        ("rates.mat", written("rates.mat"), "not equally long; choose those that belong together"),
    ]
}

fn check(name: &str, recording: &Recording) {
    assert!(
        (recording.sampling_rate_hz / RATE_HZ - 1.0).abs() < 2e-6,
        "{name}: {} S/s",
        recording.sampling_rate_hz
    );
    assert_eq!(recording.len(), SAMPLES, "{name}");
    let channels: Vec<&str> = recording.channels.iter().map(|channel| channel.name.as_str()).collect();
    for (place, word, unit, of) in [(0, "acc", "g", acc as fn(usize) -> f64), (1, "tacho", "V", tacho)] {
        let channel = &recording.channels[place];
        let is_named =
            channel.name.contains(word) || ["float.wav", "latin1.csv", "numpy.npz"].contains(&name);
        assert!(is_named, "{name}: {channels:?}");
        assert!(channel.unit.as_deref().is_none_or(|own| own == unit), "{name}: {:?}", channel.unit);
        let is_right = |(index, sample): (usize, &f64)| (sample - of(index)).abs() < 1e-5;
        assert!(channel.samples.iter().enumerate().all(is_right), "{name}, {}", channel.name);
    }
}

#[test]
fn sixty_files_are_opened_or_say_what_to_do() {
    let (opened, not_opened) = (opened(), not_opened());
    assert!(opened.len() >= 55 && opened.len() + not_opened.len() >= 60);
    let mut failed = Vec::new();
    for (name, bytes) in &opened {
        match read(name, bytes, &RecordingOptions::default()) {
            Ok(recording) => check(name, &recording),
            Err(error) => failed.push(error.to_string()),
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
    println!("{} files opened without an option, {} refused with what to do", opened.len(), not_opened.len());
    for (name, bytes, words) in not_opened {
        let said = refused(name, &bytes, &RecordingOptions::default());
        assert!(said.contains(words), "{said}");
    }
}

/// A slow channel is brought to the others' rate, which a warning says; alone it has its own.
#[test]
fn channels_of_several_rates_become_one_recording() {
    for name in ["rates.tdms", "rates.mf4"] {
        let recording = read(name, &written(name), &RecordingOptions::default()).unwrap();
        let speed = recording.channel("speed").unwrap();
        // At 1 kS/s from 25 Hz on, by an eighth a sample; the last one is held.
        let expected = |index: usize| 25.0 + (1000.0 * time_s(index)).min(9.0) / 8.0;
        assert!(
            speed.samples.iter().enumerate().all(|(index, speed)| (speed - expected(index)).abs() < 1e-9),
            "{name}"
        );
        let is_said = matches!(&recording.warnings[..], [RecordingWarning::Interpolated { name, .. }] if name == "speed");
        assert!(is_said, "{name}: {:?}", recording.warnings);
        let alone = RecordingOptions { channels: vec!["speed".into()], ..RecordingOptions::default() };
        let alone = read(name, &written(name), &alone).unwrap();
        assert_eq!((alone.len(), alone.warnings.len()), (10, 0));
        assert!((alone.sampling_rate_hz - 1000.0).abs() < 1e-6);
    }
    // Times that are uneven are said to be.
    let uneven = changed("rates.mf4", &0.004_f64.to_le_bytes(), &0.0048_f64.to_le_bytes());
    let recording = read("uneven.mf4", &uneven, &RecordingOptions::default()).unwrap();
    let said = recording.warnings[0].to_string();
    assert!(said.contains("1000 S/s on average, with up to 0.0018 s from one sample"), "{said}");
    // A channel that was recorded for a part of the time stands for no other.
    let numbers: Vec<f64> = (0..130).map(f64::from).collect();
    for (slow, is_read) in [(30, true), (26, false)] {
        let channels = [channel("acc", 100, 1e-3, "s"), channel("speed", slow, 1.0 / 300.0, "s")];
        let file = tdms(&channels, &numbers[..100 + slow as usize], None);
        match read("covered.tdms", &file, &RecordingOptions::default()) {
            Ok(recording) => assert!(is_read && recording.channels[1].samples[50] == 115.0),
            Err(error) => {
                assert!(!is_read && error.to_string().contains("speed has samples from"), "{error}")
            }
        }
    }
    // The times of arrays are those that are as long.
    for (channel, samples, rate_hz) in [("acc", 256, RATE_HZ), ("speed", 10, 1000.0)] {
        let options = RecordingOptions { channels: vec![channel.into()], ..RecordingOptions::default() };
        let recording = read("rates.mat", &written("rates.mat"), &options).unwrap();
        assert_eq!(recording.len(), samples);
        assert!((recording.sampling_rate_hz / rate_hz - 1.0).abs() < 1e-6, "{}", recording.sampling_rate_hz);
    }
}

/// A stated rate that is not the file's is named with both; where times may be in ms it is not.
#[test]
fn a_stated_rate_is_compared_with_the_files() {
    let said = |name: &str, bytes: &[u8], rate_hz: f64| -> Vec<String> {
        let recording = read(name, bytes, &rate(rate_hz)).unwrap();
        assert_eq!((recording.sampling_rate_hz, recording.start_s), (rate_hz, 0.0));
        recording.warnings.iter().map(ToString::to_string).collect()
    };
    let table = csv("time [s],acc [g],tacho\n");
    for (name, bytes) in [
        ("run.csv", table.as_bytes()),
        ("run.npz", &npz()),
        ("run.tdms", &written("plain.tdms")),
        ("run.parquet", &table_of_parquet("time [s]")),
    ] {
        let by = read(name, bytes, &RecordingOptions::default()).unwrap().rate_by;
        let said = said(name, bytes, 20_000.0);
        assert!(
            said.len() == 1 && said[0].contains(&format!("20000 S/s, but {by} says 25600 S/s")),
            "{name}: {said:?}"
        );
    }
    assert!(said("run.csv", table.as_bytes(), RATE_HZ).is_empty());
    let milliseconds = format!("t,acc,tacho\n{}", rows(",", |index| format!("{:.6}", 1e3 * time_s(index))));
    assert!(said("run.csv", milliseconds.as_bytes(), RATE_HZ).is_empty());
}

/// A column that counts samples, as data frames write it, is no channel unless it is chosen.
#[test]
fn counters_are_left_out() {
    let text =
        format!(",time,acc [g],tacho [V]\n{}", rows(",", |index| format!("{index},{}", seconds(index))));
    let recording = read("run.csv", text.as_bytes(), &RecordingOptions::default()).unwrap();
    assert!(matches!(&recording.warnings[..], [RecordingWarning::Counter { .. }]));
    let chosen = RecordingOptions { channels: vec![1.into()], ..RecordingOptions::default() };
    assert_eq!(read("run.csv", text.as_bytes(), &chosen).unwrap().channels[0].samples[2], 2.0);
}

/// Midnight is passed with a date; without one time goes back.
#[test]
fn clocks_pass_midnight_with_a_date() {
    let rows = |before: &str, after: &str| {
        format!("time,acc\n{before}23:59:59.998,1\n{before}23:59:59.999,2\n{after}00:00:00.000,3\n")
    };
    let recording =
        read("run.csv", rows("2026-02-28 ", "2026-03-01 ").as_bytes(), &RecordingOptions::default()).unwrap();
    assert_eq!(recording.sampling_rate_hz, 1000.0);
    assert!(refused("run.csv", rows("", "").as_bytes(), &RecordingOptions::default()).contains("goes back"));
}

/// A file of the folder with other words in place of some, as long as these.
fn changed(name: &str, from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let mut bytes = written(name);
    let at = bytes.windows(from.len()).position(|part| part == from).unwrap();
    bytes[at..at + to.len()].copy_from_slice(to);
    bytes
}

/// Raw numbers of TDMS are scaled unless the file says that they are; a scale that is not read is refused.
#[test]
fn scales_of_tdms_are_applied_or_refused() {
    let unsaid = changed("scaled.tdms", b"NI_Scaling_Status", b"XX_Scaling_Status");
    check("unsaid.tdms", &read("unsaid.tdms", &unsaid, &RecordingOptions::default()).unwrap());
    let uncounted = changed("scaled.tdms", b"NI_Number_Of_Scales", b"XX_Number_Of_Scales");
    check("uncounted.tdms", &read("uncounted.tdms", &uncounted, &RecordingOptions::default()).unwrap());
    let said = refused(
        "a.tdms",
        &changed("scaled.tdms", b"_Linear_Slope", b"_Linear_Slopx"),
        &RecordingOptions::default(),
    );
    assert!(said.contains("Linear without Slope"), "{said}");
}

/// The interval of a waveform of TDMS has a unit; what is not over time has no rate, and neither has LabVIEW's text.
#[test]
fn waveforms_are_over_time() {
    let of = |unit: &str| tdms(&[channel("acc", 100, 0.5, unit)], &[1.5; 100], None);
    assert_eq!(read("a.tdms", &of("ms"), &RecordingOptions::default()).unwrap().sampling_rate_hz, 2000.0);
    let said = refused("a.tdms", &of("Hz"), &RecordingOptions::default());
    assert!(said.contains("does not state its sampling rate"), "{said}");
    let text = String::from_utf8(lvm("One", ".", &rows("\t", seconds))).unwrap();
    let said = refused(
        "a.lvm",
        text.replace("Time\tTime", "Time\tFrequency").as_bytes(),
        &RecordingOptions::default(),
    );
    assert!(said.contains("values over Frequency, not over time"), "{said}");
}

/// A file of TDMS that its recorder did not end says how much of it is left out; one in too many pieces is refused.
#[test]
fn broken_and_scattered_files_of_tdms_are_said() {
    let channels = [channel("acc", 50, 1e-3, "s"), channel("tacho", 50, 1e-3, "s")];
    let numbers: Vec<f64> = (0..130).map(f64::from).collect();
    let recording = read("a.tdms", &tdms(&channels, &numbers, Some(u64::MAX)), &RecordingOptions::default());
    let recording = recording.unwrap();
    assert_eq!((recording.len(), recording.channels[1].samples[49]), (50, 99.0));
    assert!(
        matches!(recording.warnings[..], [RecordingWarning::BrokenOff { samples: 30 }]),
        "{:?}",
        recording.warnings
    );
    let many: Vec<Vec<u8>> = (0..1000).map(|number| channel(&number.to_string(), 1, 1e-3, "s")).collect();
    let mut pieces = tdms(&many, &[0.0; 1000], None);
    (0..2100).for_each(|_| pieces.extend(segment(0b1010, None, &[0; 4], &[])));
    let said = refused("a.tdms", &pieces, &RecordingOptions::default());
    assert!(said.contains("in pieces, more than 4000000"), "{said}");
}

/// Numbers of MDF that the recorder marked as invalid are no samples.
#[test]
fn invalid_numbers_of_mdf_are_refused() {
    let plain = written("plain.mf4");
    let blocks = |id: &[u8]| -> Vec<usize> {
        let starts = (0..plain.len()).filter(|at| plain[*at..].starts_with(id));
        starts.map(|at| at + 24 + 8 * usize::from(plain[at + 16])).collect()
    };
    let (group, channel) = (blocks(b"##CG")[0], blocks(b"##CN")[1]);
    let options = RecordingOptions { channels: vec!["acc".into()], ..RecordingOptions::default() };
    let marked = |flags: u8, bit: u8| {
        let mut bytes = plain.clone();
        // The last four bytes of a record, 0 or 5 in single precision, become those of validity.
        (bytes[group + 24], bytes[group + 28]) = (16, 4);
        (bytes[channel + 12], bytes[channel + 16]) = (flags, bit);
        bytes
    };
    assert_eq!(read("a.mf4", &marked(2, 0), &options).unwrap().channels[0].samples[1], acc(1));
    for (flags, bit, words) in
        [(2, 30, "marked as invalid"), (1, 0, "marked as invalid"), (2, 32, "validity")]
    {
        let said = refused("a.mf4", &marked(flags, bit), &options);
        assert!(said.contains(words), "{said}");
    }
}

/// A workbook of one sheet.
fn workbook(sheet: &str) -> Vec<u8> {
    let mut zip = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let styles = "<styleSheet><cellXfs><xf/><xf numFmtId=\"10\"/><xf numFmtId=\"47\"/><xf numFmtId=\"14\"/></cellXfs></styleSheet>";
    let types = ("[Content_Types].xml", "<Types/>");
    for (name, text) in [types, ("xl/styles.xml", styles), ("xl/worksheets/sheet1.xml", sheet)] {
        zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
        zip.write_all(text.as_bytes()).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

/// Numbers are read as they are shown: times in seconds whatever their column's unit, percent where that is the unit, dates as none.
#[test]
fn cells_of_workbooks_are_read_as_shown() {
    let names =
        ["time [ms]", "day", "load [%]", "part"].map(|name| format!("<c t=\"str\"><v>{name}</v></c>"));
    let row = |n: u32| {
        let time_days = f64::from(n) / 1000.0 / 86_400.0;
        let part = f64::from(n % 7) / 8.0;
        format!(
            "<row><c s=\"2\"><v>{time_days}</v></c><c s=\"3\"><v>46355</v></c><c s=\"1\"><v>{part}</v></c><c s=\"1\"><v>{part}</v></c></row>"
        )
    };
    let rows: String = (0..400).map(row).collect();
    let sheet = format!("<worksheet><sheetData><row>{}</row>{rows}</sheetData></worksheet>", names.concat());
    let recording = read("a.xlsx", &workbook(&sheet), &RecordingOptions::default()).unwrap();
    assert_eq!((recording.sampling_rate_hz, recording.channels.len()), (1000.0, 2));
    assert_eq!([0, 1].map(|channel| recording.channels[channel].samples[3]), [37.5, 0.375]);
}

/// Cells that are not stored are empty ones; a place that there is not, and a sheet that ends too early, are refused.
#[test]
fn workbooks_are_read_whole_or_refused() {
    let cell = |place: &str, value: usize| format!("<c r=\"{place}\"><v>{value}</v></c>");
    let row = |number: &str, cells: String| format!("<row r=\"{number}\">{cells}</row>");
    let rows: String = (2..60)
        .map(|n| row(&n.to_string(), cell(&format!("A{n}"), n) + &cell(&format!("B{n}"), n * n % 7)))
        .collect();
    let names = "<row r=\"1\"><c r=\"A1\" t=\"str\"><v>n</v></c><c r=\"B1\" t=\"str\"><v>acc</v></c></row>";
    let whole = format!("<worksheet><sheetData>{names}{rows}</sheetData></worksheet>");
    let recording = read("a.xlsx", &workbook(&whole), &rate(1000.0)).unwrap();
    assert_eq!((recording.len(), recording.channels[0].name.as_str()), (58, "acc"));
    let last = row("18446744073709551615", cell("A61", 1));
    for (sheet, words) in [
        (whole.replace("</sheetData>", &format!("{last}</sheetData>")), "Excel has not"),
        (whole.replace("</sheetData></worksheet>", ""), "ends too early"),
    ] {
        let said = refused("a.xlsx", &workbook(&sheet), &rate(1000.0));
        assert!(said.contains(words), "{said}");
    }
}
