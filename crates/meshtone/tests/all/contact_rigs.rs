//! The model of contact beside the paper's measurements: one set of structural defaults, the rigs' own data, nothing tuned to a rig
//! and no enhancement.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::dense::{coordinates, machine_of, outputs_from};
use crate::paper_rigs::{self, INDICATORS, RIGS};
use crate::physics::{largest, rms};
use meshtone::scenario::{Model, Scenario, Sensor};
use meshtone::sensor::{Channel, ChannelKind};
use meshtone::solver::Output;
use meshtone::tuning::{DifferenceChain, Enhancement, SimulatedCases, TuningIndicator, difference_signals};

/// The first seed of the wheels' draws: none by which a default was chosen.
const FIRST_SEED: u64 = 5001;

/// What the simulations of one rig come to.
struct Compared {
    /// (-) Error of Eq. 7, one a draw, rising.
    errors: Vec<f64>,
    /// log10 of both indicators by case, the median of the draws.
    simulated: Vec<[f64; 2]>,
    /// (g) Rms of the healthy difference signal, the median of the draws.
    healthy_g: f64,
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    (values[(values.len() - 1) / 2] + values[values.len() / 2]) / 2.0
}

fn compare(name: &str, model: Model, draws: u64) -> Compared {
    let (base, rate_hz) = paper_rigs::rig(name, model);
    let sensor = Sensor::default();
    let channel = Channel::Sensor(sensor.name());
    let base = base.with_sensors(vec![sensor]);
    let (cases, measured) = (paper_rigs::cases(name), paper_rigs::measured(name));
    // All draws in one call, so that simulations of one kind run side by side.
    let scenarios = (FIRST_SEED..FIRST_SEED + draws)
        .flat_map(|seed| cases.iter().map(move |faults| (seed, faults)))
        .map(|(seed, faults)| base.clone().with_seed(seed).with_faults(faults.clone()))
        .collect();
    let signals =
        difference_signals(scenarios, &DifferenceChain { channel, ..DifferenceChain::new(rate_hz) }).unwrap();
    let mut by_draw = Vec::new();
    let mut healthy_g = Vec::new();
    for of_draw in signals.chunks_exact(cases.len()) {
        healthy_g.push(TuningIndicator::Rms.measure(&of_draw[0]).unwrap());
        let simulated = SimulatedCases::new(of_draw.to_vec()).unwrap();
        by_draw.push(simulated.predict(&INDICATORS, &Enhancement::default()).unwrap());
    }
    let mut errors: Vec<f64> = by_draw.iter().map(|values| measured.mean_error(values)).collect();
    errors.sort_by(f64::total_cmp);
    let of_case =
        |case: usize| [0, 1].map(|j| median(by_draw.iter().map(|values| values[case][j]).collect()));
    Compared { errors, simulated: (0..cases.len()).map(of_case).collect(), healthy_g: median(healthy_g) }
}

/// Eq. 7 of the paper over the 19 cases of its three rigs, median over so many draws of the wheels, by the sensor that is the default. The
/// published simulation's errors are 0.86, 1.47 and 1.12 before its three parameters per rig are fitted, 0.17, 0.16 and 0.21 after.
fn assert_near_the_rigs(draws: u64) {
    for (name, most) in RIGS.into_iter().zip([0.42, 0.45, 0.50]) {
        let found = compare(name, Model::Contact, draws);
        let measured = paper_rigs::measured(name);
        let error = median(found.errors.clone());
        println!(
            "{name}: error {error:.3} ({:.3} to {:.3}), healthy difference {:.2} g rms",
            found.errors[0],
            found.errors[found.errors.len() - 1],
            found.healthy_g
        );
        for (case, values) in found.simulated.iter().enumerate() {
            let [rms, kurtosis] = [0, 1].map(|j| measured.median(case, j));
            println!(
                "  case {case}: log10 rms {:.2}, measured {rms:.2}; log10 kurtosis {:.2}, measured {kurtosis:.2}",
                values[0], values[1]
            );
        }
        assert!(error <= most, "{name}: {error}");
    }
}

/// Three draws; the median of the measurement's sixteen is known to about 0.02.
#[test]
fn the_rigs_indicators_without_any_enhancement() {
    assert_near_the_rigs(3);
}

/// Prints the numbers of the book's tables.
#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn the_rigs_indicators_of_many_draws() {
    assert_near_the_rigs(16);
}

/// (µm) How far the wheels of a rig, without deviations, approach each other along the line of action, and (g) the rms of the vertical
/// acceleration.
fn fall(mut scenario: Scenario) -> [f64; 2] {
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 0);
    let stages = meshtone::stages(&scenario).unwrap();
    let machine = machine_of(&stages).0;
    let line = &machine.turn * &machine.lines[0].at_middle;
    let mut outputs: Vec<Output> = coordinates(machine, 0).collect();
    outputs.push(ChannelKind::Vertical.output());
    let mut signals = outputs_from(stages.time.first_kept_sample, &stages, &outputs);
    let vertical_g = signals.pop().unwrap();
    let deflection_m = (0..vertical_g.len())
        .map(|n| line.iter().zip(&signals).map(|(share, values)| share * values[n]).sum::<f64>());
    [1e6 * largest(deflection_m), rms(&vertical_g)]
}

// Where the gap under a damaged tooth is deeper than the wheels fall until the next tooth's corner meets its mate, nothing more is felt:
// the largest pit is a missing tooth, and three destructions are alike. It is the motor that ends the fall: it turns at its speed, and the
// pinion swings about it on its shaft by twice the static twist at most, 34 um, while the gear is braked. With a shaft twenty times as
// long the falls of the same damages differ.
#[test]
fn gaps_deeper_than_the_fall_are_alike() {
    let falls = |name: &str, cases: &[usize], length_mm: f64| {
        let all = paper_rigs::cases(name);
        let of_case = |case: &usize| {
            let mut scenario = paper_rigs::rig(name, Model::Contact).0.with_faults(all[*case].clone());
            scenario.rig_mut().unwrap().pinion_shaft.length_mm = length_mm;
            fall(scenario)
        };
        let found: Vec<[f64; 2]> = cases.iter().map(of_case).collect();
        println!("{name} {cases:?}, shaft {length_mm} mm: fall in um and rms in g {found:.4?}");
        found
    };
    let [deep, deeper, deepest] = falls("destruction", &[4, 5, 6], 200.0)[..] else { panic!() };
    assert_eq!((deep, deeper), (deeper, deepest));
    assert!((deep[0] - 132.0).abs() < 0.5);
    let [pit, missing] = [falls("pitting", &[4], 200.0)[0], falls("breakage", &[6], 200.0)[0]];
    assert!((missing[0] - 127.4).abs() < 0.5 && (pit[1] / missing[1] - 1.0).abs() < 2e-3);
    let soft = falls("destruction", &[4, 5, 6], 4000.0);
    assert!(soft.windows(2).all(|pair| pair[1][0] > 1.03 * pair[0][0]));
}
