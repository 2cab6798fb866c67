//! The figure of a tuned experiment.

#![allow(clippy::unwrap_used)]

use crate::support::check;
use meshtone::scenario::*;
use meshtone::tuning::*;
use meshtone_plot::{Figure, PlotError, tuning_figure};

/// (bytes) Of an SVG.
const LARGEST: usize = 400_000;

/// A pair with more and more of a tooth's tip lost.
fn experiment(labels: &[&str], indicators: &[TuningIndicator]) -> Experiment {
    let mut base = Scenario::new(GearPair::example());
    base.model = Model::Linear;
    base.solver.sampling_rate_hz = 25e3;
    let cases = labels.iter().enumerate().map(|(case, label)| {
        let tip_loss_mm = 0.5 * case as f64;
        let chip = ToothBreakage { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm };
        let faults = (case > 0).then(|| Fault::on_first_gear_tooth(chip)).into_iter().collect();
        Case { label: (*label).to_owned(), severity: case as f64, faults }
    });
    // Records that rise with the case and scatter.
    let record =
        |case: usize, k: usize| 0.3 + 0.9 * case as f64 / labels.len() as f64 + 0.05 * (k as f64 * 2.3).sin();
    let values = (0..labels.len())
        .map(|case| indicators.iter().map(|_| (0..40).map(|k| record(case, k)).collect()).collect())
        .collect();
    Experiment {
        base,
        cases: cases.collect(),
        chain: DifferenceChain::new(25e3),
        measured: Measurements::from_compared(indicators.to_vec(), values).unwrap(),
        bounds: EnhancementBounds::default(),
        keys: Vec::new(),
        candidates: 0,
        seed: 3,
    }
}

fn result(experiment: &Experiment) -> ExperimentResult {
    let control = ExperimentControl { progress: &|_, _| (), cancelled: &false.into() };
    run_experiment(experiment, &control).unwrap()
}

fn drawn(experiment: &Experiment, title: &str) -> Figure {
    let figure = tuning_figure(experiment, &result(experiment), title).unwrap();
    check(&figure, LARGEST);
    assert_eq!(figure.size_px(), (1600, 1000));
    figure
}

fn has(figure: &Figure, text: &str) -> bool {
    figure.labels().iter().any(|label| label.text == text)
}

const LABELS: [&str; 7] = [
    "healthy",
    "chipped, tip loss 0.50 mm",
    "chipped_tip_loss_1.000_mm",
    "chippedwithatiplossof1.5m",
    "chip & tip loss < 2.00 mm",
    "F5",
    "chipped, tip loss 3.00 mm",
];
const TWO: [TuningIndicator; 2] = [TuningIndicator::Rms, TuningIndicator::Kurtosis];

#[test]
fn seven_cases_with_long_names() {
    let figure = drawn(&experiment(&LABELS, &TWO), "A rig");
    for text in [
        "A rig",
        "healthy",
        "F5",
        "Kurtosis, decadic logarithm (–)",
        "Original simulation (over the healthy rms)",
    ] {
        assert!(has(&figure, text), "{text}");
    }
    assert!(figure.svg().matches("<circle").count() >= 7 * 2 * 40);
    assert!(figure.png().unwrap().len() < 400_000);
}

#[test]
fn two_cases_many_cases_and_one_to_three_indicators() {
    let three = [TuningIndicator::Rms, TuningIndicator::Kurtosis, TuningIndicator::Skewness];
    drawn(&experiment(&LABELS[..2], &three[..1]), "");
    drawn(&experiment(&LABELS[..3], &three), &"a very long title ".repeat(30));
    let many: Vec<String> = (0..14).map(|case| format!("chipped, tip loss no. {case}")).collect();
    let many: Vec<&str> = many.iter().map(String::as_str).collect();
    let figure = drawn(&experiment(&many, &TWO), "Many");
    assert!(has(&figure, "case 0") && has(&figure, "case 13"));
}

/// What `experiment` simulates, as if it had been measured: each record begins elsewhere and is noisy.
fn measured_signals(experiment: &Experiment) -> Vec<Vec<Vec<f64>>> {
    let of_case = |case: &Case| experiment.base.clone().with_faults(case.faults.clone());
    let scenarios = experiment.cases.iter().map(of_case).collect();
    let noisy = |signal: &Vec<f64>, record: usize| {
        let mut noisy: Vec<f64> =
            signal.iter().enumerate().map(|(i, x)| x + (i * (record + 7)) as f64 % 1.7).collect();
        noisy.rotate_left(300 + 211 * record);
        noisy
    };
    let signals = difference_signals(scenarios, &experiment.chain).unwrap();
    signals.iter().map(|signal| (0..3).map(|record| noisy(signal, record)).collect()).collect()
}

#[test]
fn measured_difference_signals_stand_below_the_enhanced_ones() {
    let mut experiment = experiment(&LABELS[..4], &TWO);
    let without = tuning_figure(&experiment, &result(&experiment), "A rig").unwrap();
    assert!(!without.labels().iter().any(|label| label.text.starts_with("Measured")));
    let signals = measured_signals(&experiment);
    experiment.measured = Measurements::from_difference_signals(TWO.to_vec(), &signals).unwrap();
    let figure = tuning_figure(&experiment, &result(&experiment), "A rig").unwrap();
    check(&figure, LARGEST);
    assert_eq!(figure.size_px(), (1600, 1136));
    assert!(has(
        &figure,
        "Measured, of each case the record that is the nearest to the medians (over the healthy rms)"
    ));

    // The largest case's burst lies in the middle, wherever its records begin; all are relative to the healthy ones.
    let typical = experiment.measured.typical_difference(3).unwrap();
    let largest = typical.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap().0;
    assert!(largest.abs_diff(typical.len() / 2) < typical.len() / 20, "{largest} of {}", typical.len());
    let healthy = experiment.measured.typical_difference(0).unwrap();
    let rms = (healthy.iter().map(|x| x * x).sum::<f64>() / healthy.len() as f64).sqrt();
    assert!((rms - 1.0).abs() < 0.05, "{rms}");
}

#[test]
fn the_shaft_that_is_averaged_over_is_named() {
    let mut experiment = experiment(&LABELS[..2], &TWO[..1]);
    for (wheel, over, angle) in [
        (WheelName::Gear, "over one revolution of the gear", "Angle of the gear from the middle"),
        (WheelName::Pinion, "over one revolution of the pinion", "Angle of the pinion from the middle"),
    ] {
        experiment.chain.wheel = wheel.into();
        experiment
            .cases
            .iter_mut()
            .flat_map(|case| &mut case.faults)
            .for_each(|fault| fault.wheel = wheel.into());
        let figure = drawn(&experiment, "A rig");
        for text in [over, angle] {
            assert!(figure.labels().iter().any(|label| label.text.contains(text)), "{text}");
        }
    }
}

#[test]
fn every_indicator() {
    let figure = drawn(&experiment(&LABELS, &TuningIndicator::ALL), "All");
    assert!(has(&figure, "Skewness of the envelope (–)"));
}

#[test]
fn tuned_keys_are_listed() {
    let mut experiment = experiment(&LABELS[..4], &TWO);
    let range = KeyRange::Between { least: 0.01, largest: 0.3, logarithmic: true };
    experiment.keys = vec![TunedKey { key: "rig.damping_ratio".into(), range }];
    experiment.candidates = 16;
    let figure = drawn(&experiment, "With a key");
    assert!(figure.labels().iter().any(|label| label.text.contains("rig.damping_ratio = 0.")));
}

#[test]
fn a_result_of_other_cases_is_refused() {
    let result = result(&experiment(&LABELS[..2], &TWO));
    let error = tuning_figure(&experiment(&LABELS[..3], &TWO), &result, "").unwrap_err();
    assert!(matches!(error, PlotError::Hybrid(HybridError::Cases { .. })), "{error}");
}
