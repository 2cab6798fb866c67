//! The hybrid stage on signals whose answer is known.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::atomic::AtomicBool;

use meshtone::scenario::{Fault, GearPair, Model, Profile, Scenario, ToothBreakage};
use meshtone::signal::{kurtosis, resampling_ratio, rms, skewness};
use meshtone::simulate;
use meshtone::tuning::*;

static NEVER: AtomicBool = AtomicBool::new(false);

const POINTS: usize = 2048;

/// A healthy signal and a fault's response of growing size around the place 0.3.
fn cases(sizes: &[f64]) -> Vec<Vec<f64>> {
    let healthy = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / POINTS as f64;
        (13.0 * angle).sin() + 0.7 * (57.0 * angle + 1.0).cos() + 0.5 * (211.0 * angle).sin()
    };
    let response = |i: usize| {
        let place = (i as f64 / POINTS as f64 - 0.3) / 0.012;
        (-place * place).exp() * (0.7 * i as f64).sin()
    };
    std::iter::once(0.0)
        .chain(sizes.iter().copied())
        .map(|size| (0..POINTS).map(|i| healthy(i) + size * response(i)).collect())
        .collect()
}

#[test]
fn moments_of_a_mixture_are_those_of_the_mixed_signal() {
    let signals = cases(&[9.0]);
    let windows = WindowMoments::new(&signals[1], &signals[0], 0.3).unwrap();
    for alpha in [0.3, 1.0, 2.7] {
        let mixed = change_fault_to_harmonics_ratio(&signals[1], &signals[0], alpha).unwrap();
        let moments = windows.at_duration(1.0).mixed(alpha);
        assert!((moments.rms() / rms(&mixed) - 1.0).abs() < 1e-12);
        assert!((moments.kurtosis() / kurtosis(&mixed).unwrap() - 1.0).abs() < 1e-11);
        assert!((moments.skewness() - skewness(&mixed).unwrap()).abs() < 1e-11);
    }
}

#[test]
fn moments_of_a_window_are_those_of_the_stretched_signal() {
    let signals = cases(&[9.0]);
    let simulated = SimulatedCases::new(signals.clone()).unwrap();
    assert!((simulated.centre_rev() - 0.3).abs() < 1e-3);
    for width_ratio in [0.1, 0.33, 1.0, 1.6] {
        let enhancement = Enhancement { width_ratio, fault_to_harmonics_ratio: 1.7, noise_level: 0.0 };
        let enhanced = enhancement.without_noise(&signals[1], &signals[0], 0.3).unwrap();
        let windows = WindowMoments::new(&signals[1], &signals[0], 0.3).unwrap();
        let moments = windows.at_duration(width_ratio).mixed(1.7);
        // Between the values the signal is interpolated; shrunk, it loses some.
        assert!((moments.rms() / rms(&enhanced.signal) - 1.0).abs() < 0.02, "{width_ratio}");
        assert!(
            (moments.kurtosis() / kurtosis(&enhanced.signal).unwrap() - 1.0).abs() < 0.03,
            "{width_ratio}"
        );
    }
}

#[test]
fn the_expected_indicators_are_the_means_over_draws() {
    let signals = cases(&[9.0]);
    let simulated = SimulatedCases::new(signals.clone()).unwrap();
    let enhancement = Enhancement { width_ratio: 0.4, fault_to_harmonics_ratio: 1.5, noise_level: 1.2 };
    let indicators = [TuningIndicator::Rms, TuningIndicator::Kurtosis, TuningIndicator::Skewness];
    let predicted = simulated.predict(&indicators, &enhancement).unwrap();
    let draws = |case: usize| -> Vec<Vec<f64>> {
        let enhanced =
            enhancement.without_noise(&signals[case], &signals[0], simulated.centre_rev()).unwrap();
        (0..400).map(|draw| enhanced.with_noise(3, draw).unwrap()).collect()
    };
    let mean = |draws: &[Vec<f64>], of: &dyn Fn(&[f64]) -> f64| {
        draws.iter().map(|draw| of(draw)).sum::<f64>() / draws.len() as f64
    };
    let (healthy, faulty) = (draws(0), draws(1));
    let healthy_rms = mean(&healthy, &|draw| rms(draw));
    assert!((predicted[1][0] - mean(&faulty, &|draw| (rms(draw) / healthy_rms).log10())).abs() < 1e-3);
    assert!((predicted[1][1] - mean(&faulty, &|draw| kurtosis(draw).unwrap().log10())).abs() < 5e-3);
    assert!((predicted[1][2] - mean(&faulty, &|draw| skewness(draw).unwrap())).abs() < 5e-3);
    assert!((predicted[0][0]).abs() < 1e-12);
}

#[test]
fn the_expected_indicators_of_envelopes_are_the_means_over_draws() {
    use TuningIndicator::{EnvelopeKurtosis, EnvelopeRms, EnvelopeSkewness};

    let signals = cases(&[9.0]);
    let simulated = SimulatedCases::new(signals.clone()).unwrap();
    let indicators = [EnvelopeRms, EnvelopeKurtosis, EnvelopeSkewness];
    for (width_ratio, fault_to_harmonics_ratio, noise_level) in
        [(1.0, 1.0, 0.1), (1.0, 0.6, 1.2), (0.4, 1.5, 0.8), (0.15, 0.7, 0.4), (1.5, 1.3, 0.6)]
    {
        let enhancement = Enhancement { width_ratio, fault_to_harmonics_ratio, noise_level };
        let predicted = simulated.predict(&indicators, &enhancement).unwrap();
        let draws = |case: usize| -> Vec<Vec<f64>> {
            let enhanced =
                enhancement.without_noise(&signals[case], &signals[0], simulated.centre_rev()).unwrap();
            (0..200).map(|draw| enhanced.with_noise(3, draw).unwrap()).collect()
        };
        let mean = |indicator: TuningIndicator, draws: &[Vec<f64>]| {
            draws.iter().map(|draw| indicator.measure(draw).unwrap()).sum::<f64>() / draws.len() as f64
        };
        let (healthy, faulty) = (draws(0), draws(1));
        for (j, indicator) in indicators.into_iter().enumerate() {
            let drawn = indicator.compared(mean(indicator, &faulty), mean(indicator, &healthy));
            println!("{enhancement:?} {indicator:?} {drawn:.4} {:.4}", predicted[1][j]);
            // Where the cycle is cut, its stretched part begins and ends otherwise than it went on.
            assert!((predicted[1][j] - drawn).abs() < 0.02, "{enhancement:?} {indicator:?}");
        }
    }
    let upside_down = Enhancement { width_ratio: -1.0, ..Enhancement::default() };
    assert!(matches!(simulated.predict(&indicators, &upside_down), Err(HybridError::Parameter { .. })));
}

/// Measured signals made by an enhancement that is then to be found.
fn records(hidden: &Enhancement, sizes: &[f64], count: u64) -> Measurements {
    let signals = cases(sizes);
    let simulated = SimulatedCases::new(signals.clone()).unwrap();
    let measured: Vec<Vec<Vec<f64>>> = (0..signals.len())
        .map(|case| {
            let enhanced = hidden.without_noise(&signals[case], &signals[0], simulated.centre_rev()).unwrap();
            (0..count).map(|draw| enhanced.with_noise(77, 1000 * case as u64 + draw).unwrap()).collect()
        })
        .collect();
    Measurements::from_difference_signals(vec![TuningIndicator::Rms, TuningIndicator::Kurtosis], &measured)
        .unwrap()
}

fn holds(interval: [f64; 2], value: f64) -> bool {
    interval[0] <= value && value <= interval[1]
}

#[test]
fn hidden_parameters_lie_in_their_intervals() {
    let sizes = [1.0, 3.0, 9.0, 20.0];
    for (hidden, known) in [
        (Enhancement { width_ratio: 0.18, fault_to_harmonics_ratio: 2.0, noise_level: 1.5 }, true),
        (Enhancement { width_ratio: 0.6, fault_to_harmonics_ratio: 0.7, noise_level: 0.4 }, true),
        // So much noise that only its ratio to the fault shows.
        (Enhancement { width_ratio: 0.3, fault_to_harmonics_ratio: 1.2, noise_level: 2.5 }, false),
    ] {
        let simulated = SimulatedCases::new(cases(&sizes)).unwrap();
        let tuning =
            tune(&simulated, &records(&hidden, &sizes, 40), &EnhancementBounds::default(), 1, &NEVER)
                .unwrap();
        println!("{hidden:.3?}\n{:.3?}\n{:.3?}", tuning.enhancement, tuning.intervals);
        let EnhancementBounds { width_ratio, fault_to_harmonics_ratio, noise_level } = tuning.intervals;
        assert!(holds(width_ratio, hidden.width_ratio));
        assert!(holds(fault_to_harmonics_ratio, hidden.fault_to_harmonics_ratio));
        assert!(holds(noise_level, hidden.noise_level));
        assert!(tuning.enhanced_error < 1.1 * tuning.scatter);
        assert!(tuning.enhanced_error < tuning.original_error);
        assert_eq!(tuning.warnings.is_empty(), known, "{:?}", tuning.warnings);
    }
}

#[test]
fn what_cannot_be_known_is_said() {
    // Faults that dominate everything: α and noise scale together.
    let sizes = [300.0, 320.0];
    let hidden = Enhancement { width_ratio: 0.5, fault_to_harmonics_ratio: 1.0, noise_level: 3.0 };
    let simulated = SimulatedCases::new(cases(&sizes)).unwrap();
    let measured = Measurements::from_compared(
        vec![TuningIndicator::Kurtosis],
        simulated
            .predict(&[TuningIndicator::Kurtosis], &hidden)
            .unwrap()
            .into_iter()
            .map(|case| vec![vec![case[0] - 0.05, case[0] + 0.05]])
            .collect(),
    )
    .unwrap();
    let tuning = tune(&simulated, &measured, &EnhancementBounds::default(), 1, &NEVER).unwrap();
    let unknown = |warning: &TuningWarning| matches!(warning, TuningWarning::Unknown { .. });
    assert!(tuning.warnings.iter().any(unknown), "{:?} {:?}", tuning.warnings, tuning.intervals);
    let few = |warning: &TuningWarning| matches!(warning, TuningWarning::FewRecords { records: 2, .. });
    assert!(tuning.warnings.iter().any(few));
}

#[test]
fn indicators_of_the_envelope_can_be_tuned_by() {
    let sizes = [3.0, 9.0, 20.0];
    let hidden = Enhancement { width_ratio: 0.25, fault_to_harmonics_ratio: 1.5, noise_level: 1.0 };
    let simulated = SimulatedCases::new(cases(&sizes)).unwrap();
    let measured: Vec<Vec<Vec<f64>>> = simulated
        .differences()
        .iter()
        .map(|difference| {
            let enhanced = hidden
                .without_noise(difference, &simulated.differences()[0], simulated.centre_rev())
                .unwrap();
            (0..10).map(|draw| enhanced.with_noise(5, draw).unwrap()).collect()
        })
        .collect();
    let indicators = vec![TuningIndicator::Rms, TuningIndicator::EnvelopeKurtosis];
    let measured = Measurements::from_difference_signals(indicators, &measured).unwrap();
    let found = fit(&simulated, &measured, &EnhancementBounds::default(), None, &NEVER).unwrap();
    println!("{found:?}");
    assert!((found.enhancement.width_ratio / hidden.width_ratio - 1.0).abs() < 0.15);
    assert!(found.error < 1.3 * measured.scatter());
}

// At a rate whose ratio to the simulation's is no fraction, the difference signal is that at a rate beside it whose ratio is one.
#[test]
fn difference_signals_of_any_speed_and_rate() {
    for (speed_hz, has_profile) in
        [(24.600_3, false), (24.583_1, false), (29.170_7, false), (31.415_926_535, true)]
    {
        let gears = GearPair { pinion_speed_hz: speed_hz, ..GearPair::example() };
        let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 2.0 };
        let mut scenario = Scenario::new(gears).with_faults(vec![Fault::on_first_gear_tooth(chip)]);
        scenario.model = Model::Linear;
        if has_profile {
            // Not periodic: what is kept is read at its own angles.
            let constant = Profile { time_s: vec![0.0, 2.0], value: vec![speed_hz; 2] };
            scenario.operation.speed_profile_hz = Some(constant);
        }
        let own_hz = simulate(&scenario).unwrap().channels.sampling_rate_hz;
        let rate_hz = 50_000.0;
        let beside_hz = own_hz / 50_021.0 * (rate_hz * 50_021.0 / own_hz).round();
        let at = |rate_hz: f64| {
            difference_signals(vec![scenario.clone()], &DifferenceChain::new(rate_hz)).unwrap().remove(0)
        };
        assert!(resampling_ratio(own_hz, beside_hz).is_ok());
        let fraction = resampling_ratio(own_hz, rate_hz).is_ok();
        let (difference, beside) = (at(rate_hz), at(beside_hz));
        let off: Vec<f64> = difference.iter().zip(&beside).map(|(a, b)| a - b).collect();
        let relative = rms(&off) / rms(&beside);
        println!(
            "{speed_hz} Hz, fraction {fraction}: off by {relative:.1e} beside it by {:.1e}",
            beside_hz / rate_hz - 1.0
        );
        // What lies between 0.8 of half the rate and half of it is read a little differently where samples fall elsewhere.
        assert!(!fraction && relative < 5e-3);
    }
}

#[test]
fn bad_input_is_refused() {
    let signals = cases(&[9.0]);
    let message = |error: HybridError| error.to_string();
    assert_eq!(
        message(change_duration(&signals[0], 0.0, 0.0).unwrap_err()),
        "width_ratio is 0, but must be above 0"
    );
    assert!(message(add_noise(&signals[0], -1.0, 1.0, 0, 0).unwrap_err()).starts_with("noise_level is -1"));
    assert!(change_fault_to_harmonics_ratio(&signals[0], &signals[1][..100], 1.0).is_err());
    let mut gap = signals[1].clone();
    gap[17] = f64::NAN;
    assert_eq!(
        message(SimulatedCases::new(vec![signals[0].clone(), gap]).unwrap_err()),
        "value 17 of a simulated difference signal is not a finite number"
    );
    assert!(SimulatedCases::new(vec![signals[0].clone()]).is_err());
    assert!(SimulatedCases::new(vec![vec![0.0; 64], vec![1.0; 64]]).is_err());
    let measured =
        Measurements::from_compared(vec![TuningIndicator::Rms], vec![vec![vec![0.0]], vec![vec![]]]);
    assert_eq!(
        message(measured.unwrap_err()),
        "case 1 has no measured rms; every case needs at least one record of every indicator"
    );
    let equal =
        Measurements::from_compared(vec![TuningIndicator::Rms], vec![vec![vec![1.0]], vec![vec![1.0]]]);
    assert!(equal.is_err());
    let simulated = SimulatedCases::new(signals).unwrap();
    let measured = records(&Enhancement::default(), &[9.0], 5);
    let upside_down = EnhancementBounds { width_ratio: [1.0, 0.1], ..EnhancementBounds::default() };
    assert_eq!(
        message(fit(&simulated, &measured, &upside_down, None, &NEVER).unwrap_err()),
        "the range of width_ratio is [1, 0.1], but must be two numbers above 0, the smaller first"
    );
}
