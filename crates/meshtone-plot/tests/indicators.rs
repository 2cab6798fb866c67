//! The figures of a record and of a trend: everything readable, nothing over the edge.

#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use meshtone::signal::{
    ChainSettings, Record, SeparationSettings, ShaftPhase, SynchronousAverage, process_average,
    process_channel,
};
use meshtone_plot::Figure;
use meshtone_plot::record::{self, RecordFigure, SignalView, WheelView};
use meshtone_plot::trend::{self, Trend, TrendFigure};

const RATE_HZ: f64 = 1e4;

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

fn check(figure: &Figure) {
    roxmltree::Document::parse(figure.svg()).unwrap();
    assert!(figure.svg().len() < 1_500_000, "{} bytes", figure.svg().len());
    let (width, height) = figure.size_px();
    let labels = figure.labels();
    for (index, label) in labels.iter().enumerate() {
        let inside = label.left >= 0.0
            && label.top >= 0.0
            && label.right <= f64::from(width)
            && label.bottom <= f64::from(height);
        assert!(inside, "{label:?} leaves the figure");
        for other in &labels[index + 1..] {
            assert!(!label.overlaps(other), "{label:?} overlaps {other:?}");
        }
    }
    assert!(figure.png().unwrap().starts_with(b"\x89PNG"));
}

fn shown(figure: &Figure, words: &[&str]) {
    for word in words {
        assert!(figure.labels().iter().any(|label| label.text.contains(word)), "no {word}");
    }
}

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
            mean_speed_hz: 380.0 / f64::from(teeth),
            sidebands,
            low_orders,
            first_tooth: "1: in mesh at the first sample",
            is_first_damaged: name == "gear",
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
            check(&figure);
            shown(
                &figure,
                &["Time (s)", "Signal (m/s²)", "Amplitude (m/s²)", "Order spectrum", "Tooth of the"],
            );
            shown(&figure, &["mesh orders", "difference", "envelope", "FM4"]);
        }
        let figure = record::draw(&RecordFigure { title: "run", facts: &[], signal, wheels: &wheels[..2] });
        shown(&figure, &["±2 sidebands", "shaft orders 1–7", "tooth 1, the damaged one", "Pinion, 19 teeth"]);
    }
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
        mean_speed_hz: 20.0,
        sidebands: 2,
        low_orders: 7,
        first_tooth: "1: in mesh at the pulse",
        is_first_damaged: false,
        record: &record,
    };
    let figure = record::draw(&RecordFigure { title: "tone", facts: &[], signal, wheels: &[wheel] });
    check(&figure);
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
            };
            let mut indicators: Vec<Trend> = ["a", "b", "c", "d", "e", "f", "g", "h"].map(trend).to_vec();
            let none = vec![vec![None; records]; 2];
            indicators.push(Trend { name: "NA4".to_owned(), unit: String::new(), values: none });
            let wheels = ["pinion, 17 teeth".to_owned(), "gear, 38 teeth".to_owned()];
            let facts = ["12 recordings".to_owned()];
            let counted = "Recording";
            let figure = TrendFigure {
                title: "day01.csv … day12.csv",
                facts: &facts,
                counted,
                wheels: &wheels,
                indicators,
            };
            let figure = trend::draw(&figure);
            check(&figure);
            shown(&figure, &["not defined", "gear, 38 teeth", "Recording", "(m/s²)"]);
        }
    }
}
