//! The figure of bearings: kurtogram, spectra, names of lines, also of signals that nobody would draw.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use crate::support::check;
use meshtone::bearing::NamedBearing;
use meshtone::signal::*;
use meshtone_plot::Figure;
use meshtone_plot::bearings::{BearingsFigure, draw};

/// (bytes) Of an SVG.
const LARGEST: usize = 400_000;
const RATE_HZ: f64 = 20_000.0;

fn records(signal: &[f64], names: &[&str], settings: &BearingSettings) -> BearingRecords {
    let train = GearTrain::of_shaft("shaft");
    let phase = ShaftPhase::constant(30.0, RATE_HZ, signal.len()).unwrap();
    let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
    let recording = TrainRecording { signal, sampling_rate_hz: RATE_HZ, train: &train, turning: &turning };
    let named = names
        .iter()
        .map(|name| TrainBearing { geometry: NamedBearing::find(name).unwrap().geometry, shaft: 0 });
    recording.bearings(&named.collect::<Vec<_>>(), settings).unwrap()
}

fn drawn(records: &BearingRecords, unit: Option<&str>, names: &[&str]) -> Figure {
    let bearings: Vec<(&str, &str)> = names.iter().map(|name| (*name, "shaft")).collect();
    let facts = ["phase from the tachometer".to_owned()];
    let figure = draw(&BearingsFigure {
        title: "run.csv: bearing",
        facts: &facts,
        amplitude_unit: unit,
        bearings: &bearings,
        records,
    });
    check(&figure, LARGEST);
    figure
}

/// A resonance at 4 kHz that rings at an order.
fn ringing(order: f64, samples: usize) -> Vec<f64> {
    let at = |i: usize| {
        let since_s = (i as f64 / RATE_HZ * 30.0 * order).fract() / (30.0 * order);
        (-900.0 * since_s).exp() * (TAU * 4000.0 * since_s).sin() + 1e-6 * (i * i % 10_007) as f64
    };
    (0..samples).map(at).collect()
}

#[test]
fn every_line_has_its_name() {
    let names = ["6205", "ER-10K", "ZA-2115"];
    let figure =
        drawn(&records(&ringing(3.585, 80_000), &names, &BearingSettings::default()), Some("g²"), &names);
    for word in
        ["FTF", "BPFO", "2 BPFI", "6 BSF", "Order of shaft", "Amplitude (g²)", "Number of bands", "128"]
    {
        assert!(figure.labels().iter().any(|label| label.text == word), "{word}");
    }
    assert!(figure.svg().contains("6205 on shaft, squared envelope spectrum"));
}

#[test]
fn odd_recordings_can_be_drawn() {
    let stated = BearingSettings {
        separation: BearingSeparation::None,
        band: EnvelopeBand::Stated(FrequencyBand { from_hz: 0.0, to_hz: RATE_HZ / 2.0 }),
    };
    for (signal, settings) in [
        (ringing(1.0, 2_000), BearingSettings::default()),
        (ringing(3.0, 80_000).iter().map(|value| 1e-9 * value).collect(), stated),
        ((0..4_000).map(|i| f64::from(i % 2)).collect(), stated),
        ((0..40_000).map(|i| if i == 20_000 { 1e9 } else { 0.0 }).collect(), stated),
    ] {
        for unit in [None, Some(""), Some("furlongs per fortnight squared")] {
            drawn(&records(&signal, &["6203"], &settings), unit, &["6203"]);
        }
    }
}
