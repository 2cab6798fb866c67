//! Recordings in CSV, TSV and other text.
#![allow(clippy::unwrap_used, clippy::expect_used)]

use crate::recording_help::{rate, read, refused};
use meshtone_io::recording::{
    Calibration, DecimalSign, Recording, RecordingOptions, RecordingWarning, Separator, TextOptions,
    TimeColumn,
};

fn text(content: &str) -> Recording {
    read("run.csv", content.as_bytes(), &RecordingOptions::default()).unwrap()
}

fn described(recording: &Recording) -> Vec<(&str, Option<&str>, &[f64])> {
    let channels = recording.channels.iter();
    channels.map(|channel| (&*channel.name, channel.unit.as_deref(), &channel.samples[..])).collect()
}

#[test]
fn every_separator_and_decimal_sign_is_found() {
    let expected = [("a", Some("g"), &[1.5, -2.25, 1e-3][..]), ("b", Some("mV"), &[1.0, 2.0, 3.5])];
    let rows = [["0.0", "1.5", "1"], ["0.01", "-2.25", "2"], ["0.02", "1e-3", "3.5"]];
    for separator in [",", ";", "\t", "|", " ", "  \t"] {
        for decimal in [".", ","] {
            if separator == "," && decimal == "," {
                continue;
            }
            for end in ["\n", "\r\n"] {
                let mut content = ["time[s]", "a[g]", "b[mV]"].join(separator) + end;
                for row in rows {
                    content += &(row.map(|cell| cell.replace('.', decimal)).join(separator) + end);
                }
                for content in [content.clone(), content.trim_end().to_string(), format!("\u{feff}{content}")]
                {
                    let recording = text(&content);
                    assert_eq!(described(&recording), expected, "{content}");
                    assert_eq!((recording.sampling_rate_hz, recording.start_s), (100.0, 0.0));
                }
            }
        }
    }
}

#[test]
fn quotes_hold_separators_and_decimal_commas() {
    let recording = text("\"time_s\",\"left, outer [g]\"\n\"0,0\",\"1,5\"\n\"0,5\",\"-2\"\n");
    assert_eq!(described(&recording), [("left, outer", Some("g"), &[1.5, -2.0][..])]);
    assert_eq!(recording.sampling_rate_hz, 2.0);
}

#[test]
fn names_units_and_comments_are_optional() {
    let rate = rate(10.0);
    let plain = read("a.tsv", b"1\t2.5\n3\t4.5\n", &rate).unwrap();
    assert_eq!(described(&plain), [("column 1", None, &[1.0, 3.0][..]), ("column 2", None, &[2.5, 4.5])]);
    let with_units = text("time;acc;speed\nms;m/s\u{b2};1\n0;1,5;2\n1;2,5;3\n2;3,5;4\n");
    assert_eq!(with_units.sampling_rate_hz, 1000.0);
    assert_eq!(described(&with_units)[0], ("acc", Some("m/s²"), &[1.5, 2.5, 3.5][..]));
    let latin =
        read("l.csv", b"t [\xb5s];Schwingung [m/s\xb2]\n0;1\n20;2\n40;3\n", &RecordingOptions::default());
    let latin = latin.unwrap();
    assert_eq!((latin.sampling_rate_hz, latin.channels[0].unit.as_deref()), (50_000.0, Some("m/s²")));
    let savetxt =
        read("a.txt", b"# made by us\n# time_s a b\n0.0 1 2\n0.1 3 4\n", &RecordingOptions::default());
    assert_eq!(described(&savetxt.unwrap())[1], ("b", None, &[2.0, 4.0][..]));
    let trailing = read("a.csv", b"a;b;\n1;2;\n3;4;\n", &rate).unwrap();
    assert_eq!(described(&trailing).len(), 2);
    let one = read("a.csv", b"acc\n1,5\n2,5\n", &rate).unwrap();
    assert_eq!(described(&one), [("acc", None, &[1.5, 2.5][..])]);
}

#[test]
fn a_stated_unit_converts_or_is_refused() {
    let with = |header: &str, unit: &str| {
        let content = format!("{header}\n9.80665\n-19.6133\n");
        let calibration =
            Calibration { channel: 1.into(), sensitivity_v_per_unit: None, unit: Some(unit.to_owned()) };
        let options = RecordingOptions { calibrations: vec![calibration], ..rate(1.0) };
        (content, options)
    };
    for (header, unit, expected) in [
        ("acc [m/s^2]", "g", [1.0, -2.0]),
        ("acc [m/s²]", "m/s2", [9.80665, -19.6133]),
        ("acc", "g", [9.80665, -19.6133]),
        ("acc [mm/s]", "m/s", [9.80665e-3, -19.6133e-3]),
    ] {
        let (content, options) = with(header, unit);
        let recording = read("run.csv", content.as_bytes(), &options).unwrap();
        let [channel] = &recording.channels[..] else { panic!("{header}") };
        let error = channel.samples.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-12 && channel.unit.as_deref() == Some(unit), "{header} {unit}: {channel:?}");
    }
    for (header, unit) in [("acc [m/s^2]", "V"), ("acc [mV]", "g"), ("acc [EU]", "g")] {
        let (content, options) = with(header, unit);
        let message = refused("run.csv", content.as_bytes(), &options);
        assert!(message.contains("does not convert"), "{message}");
    }
}

#[test]
fn columns_are_chosen_and_calibrated() {
    let content = b"when_s,note,a [mV],b,c\n0.0,start,100,5,x\n0.1,,-200,6,y\n0.2,end,50,7,z\n";
    let options = RecordingOptions {
        channels: vec!["b".into(), 3.into()],
        time: TimeColumn::Chosen("when_s".into()),
        calibrations: vec![Calibration {
            channel: "a".into(),
            sensitivity_v_per_unit: Some(0.1),
            unit: Some("g".to_string()),
        }],
        ..RecordingOptions::default()
    };
    let recording = read("run.csv", content, &options).unwrap();
    assert_eq!(
        described(&recording),
        [("b", None, &[5.0, 6.0, 7.0][..]), ("a", Some("g"), &[1.0, -2.0, 0.5])]
    );
    assert_eq!(recording.sampling_rate_hz, 10.0);
    let message =
        refused("run.csv", content, &RecordingOptions { channels: vec!["nota".into()], ..rate(1.0) });
    assert_eq!(
        message,
        "run.csv: has no column `nota` (did you mean `note`?); it has when_s, note, a [mV], b, c"
    );
    // Time is no channel, whether its times are needed or not.
    for options in [rate(1.0), RecordingOptions::default()] {
        for time in ["t".into(), 1.into()] {
            let message = refused(
                "run.csv",
                b"t [s],a\n0,1\n1,3\n",
                &RecordingOptions { channels: vec![time], ..options.clone() },
            );
            assert_eq!(
                message,
                "run.csv: column `t [s]` is the time; choose another (option channels); it has t [s], a"
            );
        }
    }
    let message = refused("run.csv", content, &RecordingOptions { channels: vec![9.into()], ..rate(1.0) });
    assert!(message.contains("has no column number 9; it has when_s, note"), "{message}");
    let message = refused("run.csv", content, &RecordingOptions { channels: vec!["c".into()], ..rate(1.0) });
    assert!(message.contains("line 2, column c: `x` is not a number"), "{message}");
}

#[test]
fn text_options_go_before_what_is_found() {
    let skipping =
        RecordingOptions { text: TextOptions { skip_lines: 2, ..TextOptions::default() }, ..rate(10.0) };
    let recording = read("a.csv", b"Operator;x;y\n12;13\na,b\n1,2\n3,4\n", &skipping).unwrap();
    assert_eq!(described(&recording)[1], ("b", None, &[2.0, 4.0][..]));
    let ambiguous = b"1,5\n2,5\n3,5\n4,5\n";
    let message = refused("a.csv", ambiguous, &rate(1.0));
    assert!(message.contains("two columns or one with a decimal comma"), "{message}");
    let with = |text: TextOptions| {
        let recording = read("a.csv", ambiguous, &RecordingOptions { text, ..rate(1.0) }).unwrap();
        recording.channels.into_iter().map(|channel| channel.samples[0]).collect::<Vec<_>>()
    };
    assert_eq!(with(TextOptions { separator: Some(Separator::Comma), ..TextOptions::default() }), [1.0, 5.0]);
    let comma = TextOptions { decimal_sign: Some(DecimalSign::Comma), ..TextOptions::default() };
    assert_eq!(with(comma), [1.5]);
}

#[test]
fn bad_lines_are_named() {
    let cases: [(&str, &str); 14] = [
        ("a,b\n1,2\n3,\n5,6\n", "line 3 of column b is empty; every sample must be a finite number: cut"),
        ("a,b\n1,2\n3,NaN\n5,6\n", "line 3 of column b is NaN"),
        ("a,b\n1,2\n-inf,4\n5,6\n", "line 3 of column a is infinite"),
        ("a,b\n1,2\n3,1e999\n5,6\n", "line 3 of column b is infinite"),
        ("a,b\n1,2\n3\n5,6\n", "line 3 has 1 cells, but the lines above it have 2"),
        ("a,b\n1,2\n3,4,5\n5,6\n", "line 3 has 3 cells, but the lines above it have 2"),
        (
            "a,b\n1,2\n3,4\n5",
            "line 4 has 1 cells, but the lines above it have 2; mend or remove it (if the file ends",
        ),
        ("a,b\n1,2\n3,x4\n5,6\n", "line 3, column b: `x4` is not a number; mend it, or choose other columns"),
        (
            "a;b\n1;2.5\n3;4.5\n5;6.5\n7;8,5\n",
            "line 5, column b: `8,5` is not a number; the first lines are read with",
        ),
        ("0.1x2\n0.2\n0.3\n0.4\n", "line 1, column 1: `0.1x2` is not a number; if the line belongs"),
        ("a\n0.1x2\n0.2\n0.3\n0.4\n", "line 2, column a: `0.1x2` is not a number"),
        ("1;0,1x2\n2;0,2\n3;0,3\n4;0,4\n", "line 1, column 2: `0,1x2` is not a number"),
        ("a\n1\n\n3\n", "line 3 of column a is empty"),
        ("a,b\n", "holds no line of numbers"),
    ];
    for (content, words) in cases {
        let message = refused("run.csv", content.as_bytes(), &rate(1.0));
        assert!(message.starts_with("run.csv: ") && message.contains(words), "{content:?}: {message}");
    }
    let dates = b"timestamp,a\n10:00 AM,1\n10:01 AM,2\n10:02 AM,3\n";
    let message = refused("run.csv", dates, &RecordingOptions::default());
    assert!(message.contains("not a number; times are read as hh:mm:ss"), "{message}");
}

#[test]
fn time_must_be_uniform() {
    let content = |times: &[f64]| {
        let lines = times.iter().map(|time| format!("{time},1\n"));
        "time_s,a\n".to_string() + &lines.collect::<String>()
    };
    let mut times: Vec<f64> = (0..1000).map(|index| f64::from(index) / 50_000.0).collect();
    times.remove(700);
    let message = refused("run.csv", content(&times).as_bytes(), &RecordingOptions::default());
    assert!(message.contains("time column time_s is not uniform: from sample 700 to the next"), "{message}");
    assert!(message.contains("by 0.00004 s, elsewhere by 0.00002 s"), "{message}");
    let no_time = RecordingOptions { time: TimeColumn::Absent, ..RecordingOptions::default() };
    let message = refused("run.csv", b"time,a\n0,1\n1,2\n", &no_time);
    assert!(message.contains("does not state its sampling rate"), "{message}");
    assert!(message.contains("option sampling_rate_hz") && message.contains("it has time, a"), "{message}");
    let recording = read("run.csv", content(&times).as_bytes(), &rate(50_000.0)).unwrap();
    assert_eq!((recording.len(), recording.channels.len()), (999, 1));
}

/// Half a second is lost: a stated rate counts, but not in silence.
#[test]
fn a_gap_under_a_stated_rate_is_said() {
    let lost = |i: u32| f64::from(i) / 1000.0 + if i < 2500 { 0.0 } else { 0.5 };
    let content = |time_s: &dyn Fn(u32) -> f64| {
        let rows = (0..5000).map(|i| format!("{:.3},1.25\n", time_s(i)));
        format!("time_s,a\n{}", rows.collect::<String>())
    };
    let warned = |time_s: &dyn Fn(u32) -> f64| {
        read("run.csv", content(time_s).as_bytes(), &rate(1000.0)).unwrap().warnings
    };
    assert_eq!(warned(&|i| f64::from(i) / 1000.0), []);
    let said = warned(&lost)[0].to_string();
    assert!(said.contains("stated as 1000 S/s, but time column time_s says 909.074 S/s"), "{said}");
}

#[test]
fn a_last_number_that_may_be_cut_off_is_warned_about() {
    let warned = |content: &str| text(content).warnings;
    let cut = |line: u64, column: &str, text: &str| {
        [RecordingWarning::MayBeCut { line, column: column.to_string(), text: text.to_string() }]
    };
    let head = "time_s,a [g]\n0.0,0.125\n0.1,-1.125\n";
    for (end, text) in [("0.2,2.12", "2.12"), ("0.2,2.", "2."), ("0.2,2", "2"), ("0.2,2.1255", "2.1255")] {
        assert_eq!(warned(&format!("{head}{end}")), cut(4, "a [g]", text), "{end}");
        assert_eq!(warned(&format!("{head}{end}\n")), []);
        assert_eq!(warned(&format!("{head}{end} ")), []);
        assert_eq!(warned(&format!("{head}{end}\r")), []);
    }
    // Written like the others, it is whole.
    assert_eq!(warned(&format!("{head}0.2,17.625")), []);
    assert_eq!(warned("time_s;a\n0,0;1,25e-03\n0,1;-1,75e+00\n0,2;-2,25e+01"), []);
    assert_eq!(warned("time_s;a\n0,0;1,25e-03\n0,1;-1,75e+00\n0,2;-2,25e+0"), cut(4, "a", "-2,25e+0"));
    assert_eq!(warned("time_s,tacho\n0.0,5\n0.1,0\n0.2,5"), []);
    assert_eq!(warned("time_s,rpm\n0.0,1200\n0.1,1200\n0.2,120"), cut(4, "rpm", "120"));
    // Another sign ends the number.
    assert_eq!(warned("time_s,a,\n0.0,1.25,\n0.1,1.25,\n0.2,1.2,"), []);
    assert_eq!(warned("\"time_s\",\"a\"\n\"0,0\",\"1,5\"\n\"0,1\",\"1,55\""), []);
    assert_eq!(warned("time_s,a\n0.0,1.25\n0.1,1.25\n# the end"), []);
    // A column that is not read does no harm.
    let first = RecordingOptions { channels: vec!["a".into()], ..rate(10.0) };
    assert_eq!(read("run.csv", b"a,b\n1.25,2.25\n1.25,2.2", &first).unwrap().warnings, []);
    // Longer than one block.
    let long = "time_s,a\n".to_string() + &(0..200_000).map(|i| format!("{i},1.250\n")).collect::<String>();
    assert_eq!(warned(&long), []);
    assert_eq!(warned(&long[..long.len() - 2]), cut(200_001, "a", "1.25"));
}
