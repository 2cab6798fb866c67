//! A long steady motion is simulated until two hunting-tooth periods agree; the rest repeats the second.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario, Sensor, WheelName};
use meshtone::simulate;

/// 20/40 teeth, whose same teeth meet again after two revolutions of the pinion.
fn scenario(torque_nm: f64, revolutions: f64) -> Scenario {
    let pair =
        GearPair { pinion_teeth: 20, gear_teeth: 40, brake_torque_nm: torque_nm, ..GearPair::example() };
    let mut scenario = Scenario::new(pair);
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
    scenario.solver.pinion_revolutions = Some(revolutions);
    scenario
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|x| x * x).sum::<f64>().sqrt()
}

/// Number of the first period that has the bits of the one before; none where all differ.
fn first_repeated(signal: &[f64], period: usize) -> Option<usize> {
    let periods: Vec<&[f64]> = signal.chunks_exact(period).collect();
    (1..periods.len()).find(|&n| periods[n] == periods[n - 1])
}

#[test]
fn a_settled_motion_is_repeated() {
    let long = simulate(scenario(10.0, 40.0)).unwrap();
    let period = long.stages.time.hunting_period_samples(&long.stages.layout.gears[0]);
    assert_eq!(period, 2 * long.stages.time.samples_per_pinion_revolution);
    let signal = &long.channels["vertical_g"];
    // Of 20 periods some are simulated until two agree.
    let repeated = first_repeated(signal, period).unwrap();
    println!("the first of the periods that repeat another is number {repeated}");
    assert!((2..15).contains(&repeated), "{repeated}");
    let same = &signal[(repeated - 1) * period..repeated * period];
    assert!(signal[repeated * period..].chunks_exact(period).all(|later| later == same));

    // Two periods are too few to be compared, so that all of a signal that starts later is simulated.
    let mut late = scenario(10.0, 4.0);
    late.solver.settle_fraction = 1.0 - 4.0 / 80.0;
    let simulated = simulate(&late).unwrap();
    let end = &signal[signal.len() - 2 * period..];
    let difference =
        rms(end.iter().zip(&simulated.channels["vertical_g"]).map(|(a, b)| a - b)) / rms(end.iter().copied());
    println!("repeated against simulated: {difference:.1e} of rms");
    assert!(difference < 2e-6 && difference > 0.0, "{difference}");
}

/// Under a light load teeth bounce and no period is like another.
#[test]
fn a_motion_without_a_period_is_simulated_on() {
    let mut bouncing = scenario(1.0, 20.0);
    bouncing.faults = vec![Fault::new(WheelName::Gear, 3, MissingTooth)];
    let simulation = simulate(&bouncing).unwrap();
    let period = simulation.stages.time.hunting_period_samples(&bouncing.gears());
    assert_eq!(first_repeated(&simulation.channels["vertical_g"], period), None);
}

/// Neither does a fluctuating speed repeat.
#[test]
fn an_unsteady_motion_is_simulated_on() {
    let mut unsteady = scenario(10.0, 20.0);
    unsteady.operation.speed_fluctuation_hz = 0.01;
    let simulation = simulate(&unsteady).unwrap();
    let period = simulation.stages.time.hunting_period_samples(&unsteady.gears());
    assert_eq!(first_repeated(&simulation.channels["vertical_g"], period), None);
}

/// A sensor's noise is drawn for every sample, also of a motion that is repeated.
#[test]
fn noise_does_not_repeat() {
    let mut noisy = scenario(10.0, 40.0);
    let mut sensor = Sensor::default();
    sensor.noise_density_g_per_rthz = 1e-3;
    noisy.sensors = vec![sensor];
    let simulation = simulate(&noisy).unwrap();
    let period = simulation.stages.time.hunting_period_samples(&noisy.gears());
    let signal = &simulation.channels.signals[0].values;
    assert_eq!(first_repeated(signal, period), None);
    let pair: Vec<&[f64]> = signal.chunks_exact(period).skip(5).take(2).collect();
    let noise = rms(pair[0].iter().zip(pair[1]).map(|(a, b)| (a - b) / 2f64.sqrt())) / (period as f64).sqrt();
    // Over half the sampling rate.
    let expected = 1e-3 * (simulation.stages.time.sampling_rate_hz / 2.0).sqrt();
    assert!((noise / expected - 1.0).abs() < 0.05, "{noise} {expected}");
}
