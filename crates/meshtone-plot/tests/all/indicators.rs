//! The figures of a record and of a trend: everything readable, nothing over the edge.

#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use crate::support::check;
use meshtone::signal::{
    ChainSettings, Record, SeparationSettings, ShaftPhase, SynchronousAverage, process_average,
    process_channel,
};
use meshtone_plot::record::{self, RecordFigure, SignalView, WheelView};
use meshtone_plot::trend::{self, Along, Trend, TrendFigure};
use meshtone_plot::{DamagedTooth, Figure};

const RATE_HZ: f64 = 1e4;
/// (bytes) Of an SVG: curves of all samples, a line for each order, or a trend of thousands of records.
const LARGEST: usize = 1_500_000;

fn signal(size: f64) -> Vec<f64> {
    let mesh = |t: f64| (1.0 + 0.1 * (TAU * 20.0 * t).cos()) * (TAU * 380.0 * t).cos();
    (0..40_000).map(|i| size * (mesh(f64::from(i) / RATE_HZ) + f64::from(i * i % 97) / 300.0)).collect()
}

fn processed(signal: &[f64], shaft_hz: f64, teeth: u32, sidebands: usize, low_orders: usize) -> Record {
    let phase = ShaftPhase::constant(shaft_hz, RATE_HZ, signal.len()).unwrap();
    let separation = SeparationSettings {
        sidebands,
        shaft_orders: (1..=low_orders).collect(),
        ..SeparationSettings::new(teeth as usize)
    };
    let settings = ChainSettings { separation: Some(separation), ..ChainSettings::default() };
    process_channel(signal, &phase, teeth, &settings).unwrap()
}

fn shown(figure: &Figure, words: &[&str]) {
    for word in words {
        assert!(figure.labels().iter().any(|label| label.text.contains(word)), "no {word}");
    }
}

const FIRST: [DamagedTooth; 1] = [DamagedTooth { tooth: 1, contact_pitches: [0.0, 1.6], is_missing: false }];

#[test]
fn one_wheel_and_both_of_a_pair() {
    for size in [1.0, 1e-7, 1e9] {
        let samples = signal(size);
        let records = [
            processed(&samples, 20.0, 19, 2, 7),
            processed(&samples, 38.0, 10, 0, 0),
            processed(&samples, 3.8, 100, 5, 1),
        ];
        let wheel = |name, teeth, sidebands, low_orders, record| WheelView {
            name,
            teeth,
            shaft: None,
            other_teeth: &[],
            other_orders: &[],
            mean_speed_hz: 380.0 / f64::from(teeth),
            sidebands,
            low_orders,
            first_tooth: "1: in mesh at the first sample",
            damaged_teeth: if name == "gear" { &FIRST } else { &[] },
            record,
        };
        let wheels = [
            wheel("pinion", 19, 2, 7, &records[0]),
            wheel("gear", 10, 0, 0, &records[1]),
            wheel("gear", 100, 5, 1, &records[2]),
        ];
        let signal = SignalView {
            quantity: "bearing",
            unit: Some("m/s²"),
            sampling_rate_hz: RATE_HZ,
            start_s: 12.5,
            samples: &samples,
        };
        let facts = vec!["a fact of some length, and another one".to_owned(); 9];
        for wheels in [&wheels[..1], &wheels[1..2], &wheels[..2], &wheels[1..]] {
            let title = "a recording with a very long name ".repeat(9);
            let figure = record::draw(&RecordFigure { title: &title, facts: &facts, signal, wheels });
            check(&figure, LARGEST);
            shown(
                &figure,
                &["Time (s)", "Signal (m/s²)", "Amplitude (m/s²)", "Order spectrum", "Tooth of the"],
            );
            shown(&figure, &["mesh orders", "difference", "envelope", "FM4"]);
        }
        let figure = record::draw(&RecordFigure { title: "run", facts: &[], signal, wheels: &wheels[..2] });
        shown(&figure, &["±2 sidebands", "shaft orders 1–7", "damaged tooth in contact", "Pinion, 19 teeth"]);
    }
}

/// A record whose average is the mesh tone of 38 teeth and a tone at another order.
fn tones(order: usize, points: usize) -> Record {
    let turn = |i: usize| TAU * i as f64 / points as f64;
    let value = |i: usize| (38.0 * turn(i)).cos() + 3.0 * (order as f64 * turn(i)).cos();
    let values = (0..points).map(value).collect();
    let average = SynchronousAverage { revolutions: 17, nyquist_order: points as f64 / 2.0, values };
    process_average(average, 38, &ChainSettings::default()).unwrap()
}

fn of_tones(record: &Record, damaged_teeth: &[DamagedTooth]) -> Figure {
    let samples = [0.0, 1.0];
    let signal = SignalView {
        quantity: "bearing",
        unit: Some("g"),
        sampling_rate_hz: RATE_HZ,
        start_s: 0.0,
        samples: &samples,
    };
    let wheel = WheelView {
        name: "gear",
        teeth: 38,
        shaft: None,
        other_teeth: &[],
        other_orders: &[],
        mean_speed_hz: 20.0,
        sidebands: 2,
        low_orders: 7,
        first_tooth: "each enters contact at the left of its pitch",
        damaged_teeth,
        record,
    };
    let figure = record::draw(&RecordFigure { title: "tones", facts: &[], signal, wheels: &[wheel; 2] });
    check(&figure, LARGEST);
    figure
}

// In one column of two there is room for some 200 orders, one by one.
#[test]
fn no_order_is_off_the_chart() {
    let figure = of_tones(&tones(5555, 14_440), &[]);
    shown(
        &figure,
        &[
            "Order spectrum, all 7220 orders",
            "shown below, 10 % of the power",
            "(order 1000 is 20000 Hz at mean speed)",
        ],
    );
    shown(&figure, &["Orders 1 to 209", "7000"]);
    let figure = of_tones(&tones(100, 14_440), &[]);
    shown(&figure, &["shown below, 100 % of the power"]);
    // Where all orders have room they are shown once.
    let figure = of_tones(&tones(100, 300), &[]);
    assert!(!figure.labels().iter().any(|label| label.text.contains("shown below")));
    shown(&figure, &["Order spectrum"]);
}

#[test]
fn the_damaged_tooth_is_tinted_as_long_as_it_is_in_contact() {
    let tones = tones(5555, 14_440);
    let left_to_right = |contact_pitches: f64| {
        let figure =
            of_tones(&tones, &[DamagedTooth { contact_pitches: [0.0, contact_pitches], ..FIRST[0] }]);
        let document = roxmltree::Document::parse(figure.svg()).unwrap();
        let tinted = |node: &roxmltree::Node| node.attribute("fill") == Some("#d55e00");
        let paths: Vec<String> =
            document.descendants().filter(tinted).map(|node| node.attribute("d").unwrap().into()).collect();
        // For each wheel average and difference, and what explains them.
        assert_eq!(paths.len(), 8);
        // `M<left> <top>L<right> <top>L…`
        let mut ends = paths[1].split(['M', 'L', ' ']).filter(|part| !part.is_empty());
        let left: f64 = ends.next().unwrap().parse().unwrap();
        let right: f64 = ends.nth(1).unwrap().parse().unwrap();
        right - left
    };
    let pitch = left_to_right(1.0);
    assert!((left_to_right(1.609) / pitch - 1.609).abs() < 2e-3);
    let missing = DamagedTooth { is_missing: true, ..FIRST[0] };
    shown(&of_tones(&tones, &[missing]), &["turn of the missing tooth"]);
}

#[test]
fn nothing_but_the_mesh_tone() {
    let samples: Vec<f64> = (0..20_000).map(|i| (TAU * 380.0 * f64::from(i) / RATE_HZ).cos()).collect();
    let values = (0..512).map(|i| (TAU * 19.0 * f64::from(i) / 512.0).cos()).collect();
    let average = SynchronousAverage { revolutions: 39, nyquist_order: 250.0, values };
    let record = process_average(average, 19, &ChainSettings::default()).unwrap();
    let signal = SignalView {
        quantity: "bearing",
        unit: None,
        sampling_rate_hz: RATE_HZ,
        start_s: 0.0,
        samples: &samples,
    };
    let wheel = WheelView {
        name: "wheel",
        teeth: 19,
        shaft: None,
        other_teeth: &[],
        other_orders: &[],
        mean_speed_hz: 20.0,
        sidebands: 2,
        low_orders: 7,
        first_tooth: "1: in mesh at the pulse",
        damaged_teeth: &[],
        record: &record,
    };
    let figure = record::draw(&RecordFigure { title: "tone", facts: &[], signal, wheels: &[wheel] });
    check(&figure, LARGEST);
    shown(&figure, &["FM4 –", "Signal (unit not stated)"]);
}

#[test]
fn trends_of_any_length_with_gaps() {
    for records in [1, 2, 12, 100, 5000] {
        for size in [1e-6, 1.0, 3e7] {
            let values = |wheel: usize| {
                let value = |k: usize| (k % 7 != 3).then_some(size * (k + wheel) as f64);
                (0..records).map(value).collect::<Vec<_>>()
            };
            let trend = |name: &str| Trend {
                name: name.to_owned(),
                unit: "m/s²".to_owned(),
                values: vec![values(0), values(1)],
                limits: vec![Some(1.0), None],
            };
            let mut indicators: Vec<Trend> = ["a", "b", "c", "d", "e", "f", "g", "h"].map(trend).to_vec();
            let none = vec![vec![None; records]; 2];
            indicators.push(Trend {
                name: "NA4".to_owned(),
                unit: String::new(),
                values: none,
                limits: Vec::new(),
            });
            let wheels = ["pinion, 17 teeth".to_owned(), "gear, 38 teeth".to_owned()];
            let facts = ["12 recordings".to_owned()];
            let places = vec![(1..=records).map(|k| k as f64).collect::<Vec<_>>(); 2];
            let names: Vec<String> = (1..=records).map(|day| format!("day{day:02}")).collect();
            let figure = TrendFigure {
                title: "day01.csv … day12.csv",
                facts: &facts,
                along: Along::Recordings { names: &names },
                wheels: &wheels,
                places: &places,
                indicators,
            };
            let figure = trend::draw(&figure);
            check(&figure, LARGEST);
            shown(&figure, &["not defined", "gear, 38 teeth", "Recording", "day01", "(m/s²)"]);
        }
    }
}

// Wheels of 17 and 38 teeth, each cut into segments of as many of its own revolutions: the ends of both curves are at the same time.
#[test]
fn segments_of_both_wheels_lie_at_their_times() {
    let middles =
        |count: usize| -> Vec<f64> { (0..count).map(|k| 2.0 * (k as f64 + 0.5) / count as f64).collect() };
    let places = [middles(38), middles(17)];
    let values =
        places.iter().map(|places| places.iter().map(|time_s| Some(3.0 * time_s)).collect()).collect();
    let figure = trend::draw(&TrendFigure {
        title: "run.csv",
        facts: &[],
        along: Along::Time { start_s: 0.0, end_s: 2.0 },
        wheels: &["wheel".to_owned(), "mate".to_owned()],
        places: &places,
        indicators: vec![Trend { name: "FM4".to_owned(), unit: String::new(), values, limits: Vec::new() }],
    });
    check(&figure, LARGEST);
    shown(&figure, &["Time (s)"]);
}
