//! The orders of a run-up, and of signals that nobody would draw.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;

use crate::support::check;
use meshtone::signal::{OrderMap, OrderMapSettings, ShaftPhase, order_map};
use meshtone_plot::Figure;
use meshtone_plot::order_map::{OrderMapFigure, draw};

/// (bytes) Of an SVG.
const LARGEST: usize = 400_000;

fn drawn(map: &OrderMap, unit: Option<&str>, teeth: u32) -> Figure {
    let facts = ["phase from the tachometer".to_owned()];
    let figure = draw(&OrderMapFigure {
        title: "run.csv: bearing",
        facts: &facts,
        unit,
        wheel: "wheel",
        teeth,
        start_s: 12.0,
        map,
    });
    check(&figure, LARGEST);
    figure
}

#[test]
fn a_run_up_has_mesh_orders_and_its_speed() {
    let phase = ShaftPhase::from_speed_profile(&[0.0, 6.0], &[5.0, 40.0], 1e4, 60_001).unwrap();
    let noise = |i: usize| 2e-5 * (i * i % 10_007) as f64;
    let mesh = |(i, turned): (usize, &f64)| (TAU * 19.0 * turned).cos() + noise(i);
    let signal: Vec<f64> = phase.revolutions.iter().enumerate().map(mesh).collect();
    let settings = OrderMapSettings {
        highest_order: Some(OrderMapSettings::MESH_ORDERS * 19.0),
        ..OrderMapSettings::default()
    };
    let map = order_map(&signal, &phase, 1e4, &settings).unwrap();
    let figure = drawn(&map, Some("g"), 19);
    for word in [
        "Order of the wheel’s shaft (mesh orders 19, 38, …)",
        "Speed of the wheel (Hz)",
        "114",
        "15",
        "Amplitude (g)",
    ] {
        assert!(figure.labels().iter().any(|label| label.text == word), "{word}");
    }
}

#[test]
fn odd_maps_can_be_drawn() {
    let map = |amplitudes: Vec<Vec<f64>>| OrderMap {
        revolutions: 2,
        times_s: (0..amplitudes.len()).map(|part| part as f64).collect(),
        speeds_hz: vec![10.0; amplitudes.len()],
        amplitudes,
    };
    for amplitudes in [
        vec![vec![0.0; 50]; 3],
        vec![vec![1e-9; 50]],
        vec![vec![1.0]; 2],
        vec![],
        vec![vec![f64::NAN, f64::INFINITY, 1e6, 3.0]; 4],
    ] {
        for unit in [None, Some(""), Some("furlongs per fortnight squared")] {
            drawn(&map(amplitudes.clone()), unit, 1);
        }
    }
}
