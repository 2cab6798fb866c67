//! A synthetic rig: simulated "measurements" with a hidden enhancement, another damping and an unknown transmission path.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::atomic::AtomicBool;

use meshtone::scenario::{DampingRatio, Fault, GearPair, MissingTooth, Scenario, ToothBreakage};
use meshtone::tuning::*;

const HIDDEN: Enhancement =
    Enhancement { width_ratio: 0.35, fault_to_harmonics_ratio: 1.4, noise_level: 0.9 };
const HIDDEN_DAMPING: f64 = 0.09;
const RECORDS: u64 = 30;

fn base() -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: 17,
        gear_teeth: 38,
        face_width_mm: 15.0,
        pinion_speed_hz: 40.0,
        brake_torque_nm: 10.0,
    });
    scenario.quality.din_grade = 7;
    scenario.solver.sampling_rate_hz = 6e4;
    scenario.gears.points_per_tooth = 2000;
    scenario
}

fn cases() -> Vec<Case> {
    let chip = |tip_loss_mm| {
        let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm };
        vec![Fault::on_first_gear_tooth(chip)]
    };
    [vec![], chip(1.0), chip(2.0), chip(3.0), vec![Fault::on_first_gear_tooth(MissingTooth)]]
        .into_iter()
        .enumerate()
        .map(|(n, faults)| Case { label: format!("case {n}"), severity: n as f64, faults })
        .collect()
}

/// A path from the teeth to the sensor: a direct sound and a few weak echoes.
fn transmitted(signal: &[f64], echoes: &[(usize, f64)]) -> Vec<f64> {
    let n = signal.len();
    (0..n)
        .map(|i| {
            signal[i] + echoes.iter().map(|(delay, gain)| gain * signal[(i + n - delay) % n]).sum::<f64>()
        })
        .collect()
}

/// What the rig's sensor would show.
fn measured(echoes: &[(usize, f64)]) -> Measurements {
    let mut rig = base();
    rig.rig.damping_ratio = DampingRatio::Uniform(HIDDEN_DAMPING);
    let scenarios = cases().into_iter().map(|case| Scenario { faults: case.faults, ..rig.clone() }).collect();
    let signals = difference_signals(scenarios, &DifferenceChain::new(25e3)).unwrap();
    let simulated = SimulatedCases::new(signals.clone()).unwrap();
    let records: Vec<Vec<Vec<f64>>> = signals
        .iter()
        .enumerate()
        .map(|(case, signal)| {
            let enhanced = HIDDEN.without_noise(signal, &signals[0], simulated.centre_rev()).unwrap();
            (0..RECORDS)
                .map(|draw| {
                    let noisy = enhanced.with_noise(9, 1000 * case as u64 + draw).unwrap();
                    transmitted(&noisy, echoes)
                })
                .collect()
        })
        .collect();
    Measurements::from_difference_signals(vec![TuningIndicator::Rms, TuningIndicator::Kurtosis], &records)
        .unwrap()
}

fn run(measured: Measurements, keys: Vec<TunedKey>, candidates: usize) -> ExperimentResult {
    let experiment = Experiment {
        base: base(),
        cases: cases(),
        chain: DifferenceChain::new(25e3),
        measured,
        bounds: EnhancementBounds::default(),
        keys,
        candidates,
        seed: 3,
    };
    let cancelled = AtomicBool::new(false);
    run_experiment(&experiment, &ExperimentControl { progress: &|_, _| (), cancelled: &cancelled }).unwrap()
}

fn damping() -> Vec<TunedKey> {
    let range = KeyRange::Between { least: 0.02, largest: 0.3, logarithmic: true };
    vec![TunedKey { key: "rig.damping_ratio".into(), range }]
}

fn holds(tuning: &Tuning) -> [bool; 3] {
    let EnhancementIntervals { width_ratio, fault_to_harmonics_ratio, noise_level } = tuning.intervals;
    let holds = |[least, largest]: [f64; 2], value: f64| (least..=largest).contains(&value);
    [
        holds(width_ratio, HIDDEN.width_ratio),
        holds(fault_to_harmonics_ratio, HIDDEN.fault_to_harmonics_ratio),
        holds(noise_level, HIDDEN.noise_level),
    ]
}

#[test]
fn the_hidden_parameters_are_found_behind_another_damping_and_a_transmission_path() {
    let measured = measured(&[(3, 0.05), (11, -0.04), (40, 0.02)]);
    let result = run(measured.clone(), damping(), 48);
    let keys = result.with_keys.as_ref().unwrap();
    let tuning = &keys.tuning;
    println!(
        "alone {:.3?} {:.3}",
        result.enhancement_alone.enhancement, result.enhancement_alone.enhanced_error
    );
    println!("damping {:.3?} {:.3?} {:.3?}", keys.values, tuning.enhancement, tuning.intervals);
    println!("{:.3} scatter {:.3} {:?}", tuning.enhanced_error, tuning.scatter, tuning.warnings);
    assert!((keys.values[0] / HIDDEN_DAMPING).ln().abs() < 0.2);
    assert_eq!(holds(tuning), [true; 3]);
    // The path cannot be followed, but little is left.
    assert!(tuning.enhanced_error < 2.0 * tuning.scatter);
    let untouched = keys.simulated.predict(measured.indicators(), &Enhancement::default()).unwrap();
    println!(
        "original {:.3}, with the damping alone {:.3}",
        tuning.original_error,
        measured.mean_error(&untouched)
    );
    assert!(tuning.enhanced_error < 0.1 * measured.mean_error(&untouched));
    assert!(tuning.enhanced_error < tuning.original_error);
    assert!(tuning.enhanced_error < result.enhancement_alone.enhanced_error);
}
