//! Experiments of the hybrid stage: tuned keys, cases left out, what is warned of, and how they end early.
#![allow(clippy::unwrap_used)]

use std::sync::atomic::{AtomicBool, Ordering};

use meshtone::Error;
use meshtone::scenario::{DestructionLine, Fault, GearPair, MissingTooth, Model, Scenario, ToothDestruction};
use meshtone::signal::SeparationSettings;
use meshtone::tuning::*;

/// Tooth counts with a large common factor need few samples a revolution.
fn base() -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: 20,
        gear_teeth: 40,
        brake_torque_nm: 200.0,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 8);
    scenario.solver.sampling_rate_hz = 1e4;
    scenario
}

fn destroyed(start: f64, end: f64) -> Vec<Fault> {
    let line = DestructionLine::End(end);
    vec![Fault::on_first_gear_tooth(ToothDestruction { start, line, offset_mm: 0.0, noise_mm: 0.0 })]
}

/// A healthy pair, a destroyed flank and a missing tooth.
fn cases() -> Vec<Case> {
    [vec![], destroyed(0.1, 0.3), vec![Fault::on_first_gear_tooth(MissingTooth)]]
        .into_iter()
        .enumerate()
        .map(|(n, faults)| Case { label: format!("case {n}"), severity: n as f64, faults })
        .collect()
}

fn chain() -> DifferenceChain {
    DifferenceChain::new(1e4)
}

/// What the scenario itself would show with an enhancement: its expected indicators, with a little scatter.
fn measured(hidden: &Enhancement) -> Measurements {
    let scenarios = cases().into_iter().map(|case| base().with_faults(case.faults)).collect();
    let simulated = SimulatedCases::new(difference_signals(scenarios, &chain()).unwrap()).unwrap();
    let indicators = vec![TuningIndicator::Rms, TuningIndicator::Kurtosis];
    let records = simulated.predict(&indicators, hidden).unwrap().into_iter().map(|case| {
        let scattered = |value: f64| [-0.02, -0.01, 0.0, 0.01, 0.02].map(|change| value + change).to_vec();
        case.into_iter().map(scattered).collect()
    });
    Measurements::from_compared(indicators, records.collect()).unwrap()
}

const HIDDEN: Enhancement = Enhancement { width_ratio: 0.4, fault_to_harmonics_ratio: 1.0, noise_level: 0.5 };

fn experiment(keys: &[(&str, &[f64])]) -> Experiment {
    let key = |&(key, values): &(&str, &[f64])| TunedKey {
        key: key.into(),
        range: KeyRange::OneOf(values.to_vec()),
    };
    Experiment {
        base: base(),
        cases: cases(),
        chain: chain(),
        measured: measured(&HIDDEN),
        bounds: EnhancementBounds::default(),
        keys: keys.iter().map(key).collect(),
        candidates: 8,
        seed: 1,
    }
}

fn run(experiment: &Experiment) -> Result<ExperimentResult, HybridError> {
    run_experiment(experiment, &ExperimentControl { progress: &|_, _| (), cancelled: &false.into() })
}

#[test]
fn keys_may_be_valid_only_together() {
    // Alone each start lies beyond the base's end.
    let keys: [(&str, &[f64]); 2] = [("fault.start", &[0.5, 0.6]), ("fault.end", &[0.7, 0.9])];
    let result = run(&experiment(&keys)).unwrap();
    let failed = |warning: &TuningWarning| matches!(warning, TuningWarning::Failed { .. });
    assert!(!result.tuning().warnings.iter().any(failed), "{:?}", result.tuning().warnings);
    // Beyond every end that is tried.
    let keys: [(&str, &[f64]); 2] = [("fault.start", &[0.95]), ("fault.end", &[0.7, 0.9])];
    let error = run(&experiment(&keys)).unwrap_err();
    assert!(
        matches!(&error, HybridError::Simulation(Error::Scenario(error)) if error.key == "fault.end" && error.line.is_none()),
        "{error}"
    );
}

#[test]
fn combinations_that_are_no_scenario_are_counted() {
    let keys: [(&str, &[f64]); 3] =
        [("fault.start", &[0.1, 0.5]), ("fault.end", &[0.3, 0.9]), ("rig.damping_ratio", &[0.05])];
    let mut last = (0, 0);
    let seen = std::sync::Mutex::new(&mut last);
    let progress = |finished, all| **seen.lock().unwrap() = (finished, all);
    let experiment = Experiment { candidates: 20, ..experiment(&keys) };
    let result =
        run_experiment(&experiment, &ExperimentControl { progress: &progress, cancelled: &false.into() });
    let result = result.unwrap();
    let failures: Vec<&TuningWarning> = result
        .tuning()
        .warnings
        .iter()
        .filter(|warning| matches!(warning, TuningWarning::Failed { .. }))
        .collect();
    let [TuningWarning::Failed { failed, first }] = failures[..] else { panic!("{failures:?}") };
    assert!((1..20).contains(failed) && first.contains("fault.end"), "{failed} {first}");
    assert_eq!(last, (63, 63));
}

#[test]
fn no_candidate_is_an_error_that_says_why() {
    // Each is valid with the base's other end, none with the other.
    let error = run(&experiment(&[("fault.start", &[0.2]), ("fault.end", &[0.15])])).unwrap_err();
    let HybridError::NoCandidate { first_failure } = &error else { panic!("{error}") };
    assert!(first_failure.contains("fault.end"), "{first_failure}");
}

#[test]
fn too_many_candidates_are_refused() {
    let many = Experiment { candidates: MOST_CANDIDATES + 1, ..experiment(&[("seed", &[1.0, 2.0])]) };
    assert_eq!(
        many.check().unwrap_err().to_string(),
        "100001 candidates; must be a whole number from 1 to 100000"
    );
    // Without keys there are none to try.
    assert!(Experiment { keys: Vec::new(), ..many }.check().is_ok());
}

#[test]
fn keys_that_do_not_help_are_not_taken() {
    let result = run(&experiment(&[("rig.damping_ratio", &[0.4, 0.5])])).unwrap();
    assert!(result.with_keys.is_none());
    assert!(
        result.tuning().warnings.contains(&TuningWarning::KeysDoNotHelp),
        "{:?}",
        result.tuning().warnings
    );
}

#[test]
fn a_parameter_at_its_bound_is_reported() {
    let mut experiment = experiment(&[]);
    experiment.bounds.width_ratio = [0.8, 2.0];
    let result = run(&experiment).unwrap();
    let at_bound = |warning: &TuningWarning| matches!(warning, TuningWarning::AtBound { parameter: "width_ratio", value } if (value - 0.8).abs() < 1e-3);
    assert!(result.tuning().warnings.iter().any(at_bound), "{:?}", result.tuning().warnings);
}

#[test]
fn it_can_be_stopped_at_any_time() {
    let (never, now) = (AtomicBool::new(false), AtomicBool::new(true));
    let experiment = experiment(&[]);
    let simulated = run(&experiment).unwrap().original;
    let (measured, bounds) = (&experiment.measured, &experiment.bounds);
    assert_eq!(fit(&simulated, measured, bounds, None, &now), Err(HybridError::Cancelled));
    assert_eq!(tune(&simulated, measured, bounds, 1, &now), Err(HybridError::Cancelled));
    assert!(fit(&simulated, measured, bounds, None, &never).is_ok());
    // When all simulations are done, so that only fits, intervals and cases left out remain.
    let cancelled = AtomicBool::new(false);
    let progress = |finished, all| cancelled.store(finished == all, Ordering::Relaxed);
    let control = ExperimentControl { progress: &progress, cancelled: &cancelled };
    assert_eq!(run_experiment(&experiment, &control).unwrap_err(), HybridError::Cancelled);
}

/// The prediction of a case that is left out must not change with what was measured of it.
#[test]
fn a_case_that_is_left_out_has_not_been_seen() {
    let rms = |records: [f64; 3]| {
        let records: Vec<Vec<Vec<f64>>> = records.iter().map(|&record| vec![vec![record]]).collect();
        Measurements::from_compared(vec![TuningIndicator::Rms], records).unwrap()
    };
    let mut experiment =
        experiment(&[("seed", &[1.0, 2.0, 3.0, 4.0]), ("rig.mesh_damping_ratio", &[0.05, 0.1, 0.2])]);
    experiment.candidates = 20;
    // Distance of the prediction from what was measured of the last case.
    let mut distance = |last: f64| {
        let records = [0.0, 0.4, last];
        experiment.measured = rms(records);
        let result = run(&experiment).unwrap();
        let mean = records.iter().sum::<f64>() / 3.0;
        let scale = (records.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
        result.with_keys.unwrap().tuning.left_out[2].error * scale
    };
    // The predictions lie below both, at about 2.8. Where the refinements end depends on the scale of the errors, so only to some thousandths; a
    // search that had seen the case would follow it by more than a tenth.
    let (near, far) = (distance(4.0), distance(5.0));
    assert!((far - near - 1.0).abs() < 5e-3, "{near} {far}");
}

#[test]
fn the_mesh_order_is_that_of_the_gear_that_is_simulated() {
    let of_teeth = |teeth| DifferenceChain { separation: Some(SeparationSettings::new(teeth)), ..chain() };
    let mut scenario = base();
    scenario.wheels[1].teeth = 50;
    let own = difference_signals(vec![scenario.clone()], &of_teeth(50)).unwrap();
    assert_eq!(difference_signals(vec![scenario], &of_teeth(40)).unwrap(), own);
    let result = run(&experiment(&[("gears.gear_teeth", &[40.0, 50.0, 60.0])])).unwrap();
    let failed = |warning: &TuningWarning| matches!(warning, TuningWarning::Failed { .. });
    assert!(!result.tuning().warnings.iter().any(failed));
}

#[test]
fn the_original_is_the_scenario_before_anything_is_tuned() {
    let mut experiment = experiment(&[("rig.damping_ratio", &[0.03, 0.05, 0.07])]);
    // The rig has another damping than the base, which the three parameters cannot make up for.
    experiment.bounds = EnhancementBounds {
        width_ratio: [HIDDEN.width_ratio; 2],
        fault_to_harmonics_ratio: [HIDDEN.fault_to_harmonics_ratio; 2],
        noise_level: [HIDDEN.noise_level; 2],
    };
    experiment.base.rig_mut().unwrap().damping_ratio = meshtone::scenario::DampingRatio::Uniform(0.5);
    let result = run(&experiment).unwrap();
    let keys = result.with_keys.as_ref().unwrap();
    let untouched =
        result.original.predict(experiment.measured.indicators(), &Enhancement::default()).unwrap();
    assert_eq!(keys.tuning.original, untouched);
    assert_eq!(keys.tuning.original_error, result.enhancement_alone.original_error);
    assert_eq!(keys.tuning.original_error, experiment.measured.mean_error(&untouched));
}
