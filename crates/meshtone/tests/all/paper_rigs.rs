//! The paper's three rigs: what runs in them, what is broken, what was measured.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use meshtone::scenario::*;
use meshtone::tuning::{Measurements, TuningIndicator};

/// The rigs' names.
pub const RIGS: [&str; 3] = ["breakage", "pitting", "destruction"];

/// What is measured: rms and kurtosis of the difference signal.
pub const INDICATORS: [TuningIndicator; 2] = [TuningIndicator::Rms, TuningIndicator::Kurtosis];

/// The rig's own data and its recordings' sampling rate, in S/s; all else is at its default.
pub fn rig(name: &str, model: Model) -> (Scenario, f64) {
    let (pair, din_grade, rate_hz) = if name == "destruction" {
        let pair = GearPair {
            module_mm: 3.0,
            pinion_teeth: 18,
            gear_teeth: 35,
            face_width_mm: 30.0,
            pinion_speed_hz: 45.0,
            brake_torque_nm: 15.0,
        };
        (pair, 8, 50e3)
    } else {
        let pair = GearPair::example();
        (pair, 7, 25e3)
    };
    let mut scenario = Scenario::new(pair);
    scenario.model = model;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = din_grade);
    (scenario, rate_hz)
}

/// The faults of every case, the healthy one first.
pub fn cases(name: &str) -> Vec<Vec<Fault>> {
    let damages: Vec<Damage> = match name {
        "breakage" => [0.0, 1.0, 2.0, 3.0, 4.0]
            .map(|tip_loss_mm| {
                Damage::ToothBreakage(ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm })
            })
            .into_iter()
            .chain([MissingTooth.into()])
            .collect(),
        "pitting" => [(57.12, 3.59, 1.7), (57.69, 3.71, 2.1), (57.37, 4.00, 2.4), (57.49, 3.66, 2.4)]
            .map(|(x_mm, y_mm, radius_mm)| {
                Damage::ThroughFace(ThroughFace { pit: PitCircle::Circle { x_mm, y_mm, radius_mm } })
            })
            .to_vec(),
        _ => [(5.0, 12.0), (3.5, 12.2), (0.2, 13.0), (-0.6, 13.2), (-0.8, 13.2), (-1.0, 13.8)]
            .map(|(start, end)| {
                Damage::ToothDestruction(ToothDestruction {
                    start: start / 14.0,
                    line: DestructionLine::End(end / 14.0),
                    offset_mm: 0.0,
                    noise_mm: 0.0,
                })
            })
            .to_vec(),
    };
    std::iter::once(Vec::new())
        .chain(damages.into_iter().map(|damage| vec![Fault::on_first_gear_tooth(damage)]))
        .collect()
}

/// log10 of an indicator in a series of the paper's Figure 6.
pub fn values(name: &str, indicator: TuningIndicator, series: &str, severity: usize) -> Vec<f64> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/experiments/fig6_indicators.csv");
    let text = fs::read_to_string(path).unwrap();
    let start = format!("{name},{},{series},{severity},", indicator.name());
    text.lines().filter_map(|line| line.strip_prefix(&start)).map(|value| value.parse().unwrap()).collect()
}

/// What was measured.
pub fn measured(name: &str) -> Measurements {
    let of_case = |case| INDICATORS.map(|indicator| values(name, indicator, "measured", case)).to_vec();
    let values = (0..cases(name).len()).map(of_case).collect();
    Measurements::from_compared(INDICATORS.to_vec(), values).unwrap()
}
