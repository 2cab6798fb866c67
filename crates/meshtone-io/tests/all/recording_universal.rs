//! Universal files, and files inside others.

#![allow(clippy::unwrap_used)]

use std::io::Write;

use meshtone_io::recording::{Recording, RecordingOptions};

use crate::recording_help;

fn read(name: &str, content: &[u8]) -> Recording {
    recording_help::read(name, content, &RecordingOptions::default()).unwrap()
}

fn problem(name: &str, content: &[u8]) -> String {
    recording_help::refused(name, content, &RecordingOptions::default())
}

/// A data set 58 of real, even samples over time, by the columns that the format prescribes.
struct Set<'a> {
    name: &'a str,
    node: u32,
    unit: &'a str,
    is_double: bool,
    increment_s: &'a str,
    values: &'a [f64],
}

impl Set<'_> {
    fn header(&self) -> String {
        let kind = if self.is_double { 4 } else { 2 };
        let axis = |kind: u32, label: &str, unit: &str| {
            format!("{kind:>10}    0    0    0 {label:<20} {unit:<20}\n")
        };
        [
            format!("{:<80}\nNONE\n28-Nov-26 12:00:00\nNONE\nNONE\n", self.name),
            format!(
                "    1         0    0         0 {:<10}{:>10}   3 {:<10}         0   0\n",
                "NONE", self.node, "NONE"
            ),
            format!(
                "{kind:>10}{:>10}         1  0.00000E+00  {}  0.00000E+00\n",
                self.values.len(),
                self.increment_s
            ),
            axis(17, "Time", "s"),
            axis(12, "Acceleration", self.unit),
            axis(0, "NONE", "NONE"),
            axis(0, "NONE", "NONE"),
        ]
        .concat()
    }

    fn text(&self) -> Vec<u8> {
        let (each, width, digits) = if self.is_double { (4, 20, 12) } else { (6, 13, 5) };
        let row = |row: &[f64]| {
            let cells = row.iter().map(|value| {
                // Rust writes exponents as short as they are, the format as two digits with a sign.
                let text = format!("{value:.digits$e}");
                let (mantissa, exponent) = text.split_once('e').unwrap();
                let cell = format!("{mantissa}E{:+03}", exponent.parse::<i32>().unwrap());
                format!("{cell:>width$}")
            });
            cells.collect::<String>() + "\n"
        };
        let rows: String = self.values.chunks(each).map(row).collect();
        format!("    -1\n    58\n{}{rows}    -1\n", self.header()).into_bytes()
    }

    fn binary(&self, big_endian: bool) -> Vec<u8> {
        let bytes: Vec<u8> = (self.values.iter())
            .flat_map(|value| match (self.is_double, big_endian) {
                (true, true) => value.to_be_bytes().to_vec(),
                (true, false) => value.to_le_bytes().to_vec(),
                (false, true) => (*value as f32).to_be_bytes().to_vec(),
                (false, false) => (*value as f32).to_le_bytes().to_vec(),
            })
            .collect();
        let order = if big_endian { 2 } else { 1 };
        let first = format!(
            "    -1\n    58b{order:>6}     2          11{:>12}     0     0           0           0\n",
            bytes.len()
        );
        [first.as_bytes(), self.header().as_bytes(), &bytes, b"\n    -1\n"].concat()
    }
}

const VALUES: [f64; 7] = [0.5, -1.25, 3.0, -4.0, 1.5e-3, -2.0, 0.0];
const OTHER: &[u8] = b"    -1\n   151\nmodel\n-1.5\n    -1\n";

fn set(is_double: bool) -> Set<'static> {
    Set { name: "bearing", node: 7, unit: "g", is_double, increment_s: "1.95313E-05", values: &VALUES }
}

#[test]
fn universal_files_as_text_and_in_binary() {
    for is_double in [false, true] {
        for content in [set(is_double).text(), set(is_double).binary(false), set(is_double).binary(true)] {
            let second = Set { name: "NONE", node: 12, values: &[1.0; 7], ..set(!is_double) };
            let recording = read("run.uff", &[OTHER, &content, &second.text()].concat());
            // The increment has six digits; the rate is the shortest number within them.
            assert_eq!(recording.sampling_rate_hz, 51_200.0);
            let names: Vec<&str> = recording.channels.iter().map(|channel| channel.name.as_str()).collect();
            assert_eq!(names, ["bearing 7+Z", "12+Z"]);
            assert_eq!(recording.channels[0].unit.as_deref(), Some("g"));
            let largest = (recording.channels[0].samples.iter().zip(VALUES))
                .map(|(read, written)| (read - written).abs())
                .fold(0.0, f64::max);
            assert!(largest < 1e-9, "{largest}");
            assert_eq!(recording.channels[1].samples, [1.0; 7]);
        }
    }
}

/// Numbers of full width have no blank between them.
#[test]
fn numbers_of_a_universal_file_may_touch() {
    let values = [-1.234_567_890_123e-105, -2.0, -3.0, -4.0, 5.0];
    let touching = Set { values: &values, ..set(true) };
    let text =
        String::from_utf8(touching.text()).unwrap().replace(" -2.000000000000E+00", "-2.0000000000000E+00");
    assert_eq!(read("run.unv", text.as_bytes()).channels[0].samples[1..], values[1..]);
}

#[test]
fn what_is_no_time_signal_is_left_out_or_refused() {
    let text = String::from_utf8(set(false).text()).unwrap();
    let spectrum = text.replacen("\n    1  ", "\n    2  ", 1);
    assert!(
        problem("run.uff", spectrum.as_bytes())
            .contains("without a time response (data set 58); it has 1 data sets of other kinds")
    );
    let mut binary = set(false).binary(false);
    let function = binary.windows(7).position(|part| part == b"\n    1 ").unwrap() + 5;
    binary[function] = b'2';
    assert_eq!(read("run.uff", &[&binary, text.as_bytes()].concat()).channels.len(), 1);
    assert_eq!(read("run.uff", &[spectrum.as_bytes(), text.as_bytes()].concat()).channels.len(), 1);
    assert!(problem("run.uff", OTHER).contains("without a time response"));
    let replaced = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        problem("run.uff", text.replacen(from, to, 1).as_bytes())
    };
    assert!(
        replaced("         2         7", "         5         7").contains("complex numbers or uneven times")
    );
    for count in ["9", "5"] {
        assert!(
            replaced("         7         1", &format!("         {count}         1"))
                .contains(&format!("states {count} values and has 7"))
        );
    }
    assert!(replaced("3.00000E+00", "3.0x000E+00").contains("are no numbers"));
    assert!(
        replaced("Time                 s ", "Time                 Hz").contains("in Hz, no unit of time")
    );
    assert!(
        replaced("  0.00000E+00  1.95313E-05", "          NaN  1.95313E-05")
            .contains("does not state start and increment")
    );
    let later = text.replacen("  0.00000E+00  1.95313E-05", "  5.00000E-01  1.95313E-05", 1);
    assert!(
        problem("run.uff", &[text.as_bytes(), later.as_bytes()].concat())
            .contains("starts at 0.5 s, another channel at 0 s; choose channels that were recorded together")
    );
    let in_ms = text.replacen("Time                 s ", "Time                 ms", 1).replacen(
        "1.95313E-05",
        "1.95313E-02",
        1,
    );
    assert_eq!(read("run.uff", in_ms.as_bytes()).sampling_rate_hz, 51_200.0);
    let of_floats = String::from_utf8_lossy(&set(true).binary(false)).replacen(
        "         4         7",
        "         2         7",
        1,
    );
    assert!(problem("run.uff", of_floats.as_bytes()).contains("bytes for 7 values of 4 bytes"));
}

#[test]
fn universal_files_that_end_early_are_refused() {
    for whole in [set(true).binary(false), set(true).text()] {
        let delimiter = whole.len() - b"    -1\n".len();
        for length in (20..delimiter).step_by(7).chain([delimiter - 1, delimiter]) {
            let problem = problem("run.uff", &whole[..length]);
            assert!(problem.contains("is not a whole universal file"), "{length}: {problem}");
        }
    }
}

/// A column of counts may begin with -1 and a digit.
#[test]
fn numbers_are_no_universal_file() {
    let rate = RecordingOptions { sampling_rate_hz: Some(1000.0), ..RecordingOptions::default() };
    for text in ["-1\n5\n3\n", "-1\n58\n3\n", " -1\n 58\n  3\n"] {
        assert_eq!(
            recording_help::read("run.csv", text.as_bytes(), &rate).unwrap().channels[0].samples[0],
            -1.0
        );
    }
}

const CSV: &str = "time [s],acc [m/s²],größe [mV]\n0,1.5,10\n0.001,2.5,20\n0.002,-3.5,30\n";

fn is_the_csv(name: &str, content: &[u8]) {
    let recording = read(name, content);
    assert_eq!(recording.sampling_rate_hz, 1000.0, "{name}");
    assert_eq!(
        (recording.channels[0].unit.as_deref(), recording.channels[1].name.as_str()),
        (Some("m/s²"), "größe")
    );
    assert_eq!(recording.channels[0].samples, [1.5, 2.5, -3.5], "{name}");
}

#[test]
fn compressed_files_and_other_encodings() {
    is_the_csv("run.csv", CSV.as_bytes());
    is_the_csv("run", CSV.as_bytes());
    is_the_csv("run.csv", format!("sep=,\r\n{CSV}").as_bytes());
    let gzip = |content: &[u8]| {
        let mut gzip = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        gzip.write_all(content).unwrap();
        gzip.finish().unwrap()
    };
    let zip = |files: &[(&str, &[u8])]| {
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for (name, content) in files {
            zip.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            zip.write_all(content).unwrap();
        }
        zip.finish().unwrap().into_inner()
    };
    let packed = gzip(CSV.as_bytes());
    is_the_csv("run.csv.gz", &packed);
    assert!(problem("run.csv.gz", &packed[..packed.len() - 9]).contains("it ends too early"));
    is_the_csv("run.zip", &zip(&[("inner/run.csv", CSV.as_bytes()), ("__MACOSX/inner/._run.csv", b"x")]));
    is_the_csv("run.zip", &zip(&[("run.csv.gz", &packed)]));
    let two = zip(&[("a.csv", CSV.as_bytes()), ("b.csv", CSV.as_bytes())]);
    assert!(problem("run.zip", &two).contains("is a ZIP archive of 2 files; unpack it: a.csv, b.csv"));
    let letter = zip(&[("[Content_Types].xml", b"x"), ("word/document.xml", b"x")]);
    assert!(
        problem("run.docx", &letter).contains(
            "an Office document without a sheet of numbers, which is not read; save its table as CSV"
        )
    );
    let bomb = problem("run.csv.gz", &gzip(&vec![b'0'; 4 << 20]));
    assert!(bomb.contains("unpacked it has more than 1 MiB; unpack it first"), "{bomb}");
    let utf16 = |mark: &[u8], bytes: fn(u16) -> [u8; 2], text: &str| {
        [mark, &text.encode_utf16().flat_map(bytes).collect::<Vec<u8>>()].concat()
    };
    is_the_csv("run.csv", &utf16(b"\xff\xfe", u16::to_le_bytes, CSV));
    is_the_csv("run.csv", &utf16(b"\xfe\xff", u16::to_be_bytes, CSV));
    is_the_csv("run.zip", &zip(&[("run.csv", &utf16(b"\xff\xfe", u16::to_le_bytes, CSV))]));
    let odd = utf16(b"\xff\xfe", u16::to_le_bytes, CSV);
    assert!(problem("run.csv", &odd[..odd.len() - 1]).contains("it ends too early"));
    // Without a mark the first characters must be Latin, as names are.
    is_the_csv(
        "run.txt",
        &utf16(b"", u16::to_le_bytes, &format!("# made by a recorder of 2026, in the test hall\n{CSV}")),
    );
    is_the_csv(
        "run.txt",
        &utf16(b"", u16::to_be_bytes, &format!("# made by a recorder of 2026, in the test hall\n{CSV}")),
    );
}

/// Characters of four bytes may be cut anywhere by a block.
#[test]
fn long_text_in_utf16_is_whole() {
    let comment = "# 𝛼𝛽 ".repeat(20_000);
    let text = format!("{comment}\n{CSV}");
    let bytes: Vec<u8> = [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
    is_the_csv("run.csv", &bytes);
}

#[test]
fn slow_times_without_a_unit_are_doubted() {
    let rows = |name: &str| format!("{name},acc\n0,1\n0.05,2\n0.1,3\n0.15,4\n");
    let said = problem("run.csv", rows("elapsed").as_bytes());
    assert!(
        said.contains(
            "as seconds it gives 20 S/s, too few for a gear; name it `elapsed_ms` if it is in ms (20000 S/s)"
        ),
        "{said}"
    );
    let said = problem("run.csv", b"t,acc\n0,1\n50,2\n100,3\n150,4\n");
    assert!(said.contains("name it `t_us` if it is in us (20000 S/s)"), "{said}");
    assert_eq!(read("run.csv", rows("seconds").as_bytes()).sampling_rate_hz, 20.0);
    assert_eq!(read("run.csv", rows("elapsed [ms]").as_bytes()).sampling_rate_hz, 20_000.0);
    assert_eq!(read("run.csv", rows("elapsed [s]").as_bytes()).sampling_rate_hz, 20.0);
}
