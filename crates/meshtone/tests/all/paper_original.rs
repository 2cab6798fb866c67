//! The paper's own simulation, before tuning: the indicators of its Figure 6, series `original`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::Path;

use meshtone::scenario::*;
use meshtone::tuning::{DifferenceChain, SimulatedCases, TuningIndicator, difference_signals};

/// Draws of the wheels' profile errors that are averaged. One draw scatters by up to 0.08, the paper shows a single one.
const DRAWS: u64 = 64;

fn rig(name: &str) -> (Scenario, f64) {
    let (mut scenario, grade, rate_hz) = match name {
        "destruction" => (
            Scenario::new(GearPair {
                module_mm: 3.0,
                pinion_teeth: 18,
                gear_teeth: 35,
                face_width_mm: 30.0,
                pinion_speed_hz: 45.0,
                brake_torque_nm: 15.0,
            }),
            8,
            50e3,
        ),
        _ => (
            Scenario::new(GearPair {
                module_mm: 3.0,
                pinion_teeth: 17,
                gear_teeth: 38,
                face_width_mm: 15.0,
                pinion_speed_hz: 40.0,
                brake_torque_nm: 10.0,
            }),
            7,
            25e3,
        ),
    };
    scenario.model = Model::Published;
    scenario.quality.din_grade = grade;
    (scenario, rate_hz)
}

/// The cases whose fault dominates, with their severity.
fn dominating(name: &str) -> Vec<(usize, Fault)> {
    let damages: Vec<Damage> = match name {
        "breakage" => [3.0, 4.0]
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
        _ => [(0.2, 13.0), (-0.6, 13.2), (-0.8, 13.2), (-1.0, 13.8)]
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
    let first = match name {
        "breakage" => 4,
        "pitting" => 1,
        _ => 3,
    };
    (first..).zip(damages.into_iter().map(Fault::on_first_gear_tooth)).collect()
}

fn original(name: &str, indicator: TuningIndicator, severity: usize) -> f64 {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/experiments/fig6_indicators.csv");
    let text = fs::read_to_string(path).unwrap();
    let start = format!("{name},{},original,{severity},", indicator.name());
    text.lines().find_map(|line| line.strip_prefix(&start)).unwrap().parse().unwrap()
}

#[test]
fn the_paper_s_original_indicators_where_the_fault_dominates() {
    let indicators = [TuningIndicator::Rms, TuningIndicator::Kurtosis];
    for name in ["breakage", "pitting", "destruction"] {
        let (base, rate_hz) = rig(name);
        let cases = dominating(name);
        // All draws in one call, so that simulations of one kind run side by side.
        let scenarios = (1..=DRAWS).flat_map(|seed| {
            let base = base.clone().with_seed(seed);
            let faulty = cases.iter().map(|(_, fault)| vec![fault.clone()]);
            let faults = std::iter::once(Vec::new()).chain(faulty).collect::<Vec<_>>();
            faults.into_iter().map(move |faults| base.clone().with_faults(faults))
        });
        let signals = difference_signals(scenarios.collect(), &DifferenceChain::new(rate_hz)).unwrap();
        let mut sums = vec![[0.0; 2]; cases.len()];
        for of_draw in signals.chunks_exact(1 + cases.len()) {
            let simulated = SimulatedCases::new(of_draw.to_vec()).unwrap();
            let values = simulated.predict(&indicators, &meshtone::tuning::Enhancement::default()).unwrap();
            for (sum, value) in sums.iter_mut().zip(&values[1..]) {
                (0..2).for_each(|j| sum[j] += value[j] / DRAWS as f64);
            }
        }
        for ((severity, _), means) in cases.iter().zip(&sums) {
            for (j, &indicator) in indicators.iter().enumerate() {
                let paper = original(name, indicator, *severity);
                println!(
                    "{name} F{severity} log10 {}: {:.3}, the paper {paper:.3}",
                    indicator.name(),
                    means[j]
                );
                assert!((means[j] - paper).abs() < 0.15, "{name} F{severity} {}", indicator.name());
            }
        }
    }
}
