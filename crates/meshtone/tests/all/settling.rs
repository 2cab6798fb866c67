//! A simulation that starts in equilibrium and settles shortly keeps the signal of one that settles for long.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::scenario::*;
use meshtone::{simulate, stages, stages_and_warnings};

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|x| x * x).sum::<f64>().sqrt()
}

/// Rms of the difference over rms, of the vertical acceleration and of the mesh force.
fn differences(scenario: &Scenario, tolerance: f64) -> (usize, usize, [f64; 2]) {
    let with = |settle_tolerance| {
        let mut scenario = scenario.clone();
        scenario.solver.settle_tolerance = settle_tolerance;
        simulate(&scenario).unwrap()
    };
    let (long, short) = (with(0.0), with(tolerance));
    let (a, b) = (&long.channels, &short.channels);
    assert_eq!((a.len(), a.start_s, a.sampling_rate_hz), (b.len(), b.start_s, b.sampling_rate_hz));
    let of = |a: &[f64], b: &[f64]| rms(a.iter().zip(b).map(|(a, b)| a - b)) / rms(a.iter().copied());
    let time = &short.stages.time;
    (
        time.first_kept_sample,
        time.first_simulated_sample,
        ["vertical_g", "mesh_force_n"].map(|name| of(&a[name], &b[name])),
    )
}

#[test]
fn the_kept_signal_is_that_of_the_long_settling() {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.4 };
    for damage in [
        None,
        Some(Damage::MissingTooth(MissingTooth)),
        Some(Damage::ToothBreakage(ToothBreakage {
            chip_height_mm: 5.0,
            chip_width_mm: 12.0,
            tip_loss_mm: 0.0,
        })),
        Some(Damage::PartialFace(PartialFace { width_mm: 5.0, pit })),
        Some(Damage::ThroughFace(ThroughFace { pit })),
        Some(Damage::ToothDestruction(ToothDestruction {
            start: 0.2,
            line: DestructionLine::SlopeDeg(22.0),
            offset_mm: 0.0,
            noise_mm: 0.0,
        })),
    ] {
        let mut scenario = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
        scenario.model = Model::Linear;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
        scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
        for tolerance in [1e-3, 1e-6] {
            let (kept, start, differences) = differences(&scenario, tolerance);
            println!(
                "{} at {tolerance:e}: {} of {kept} samples of settling left out; vertical {:.1e}, force {:.1e}",
                scenario.faults.first().map_or("healthy", |fault| fault.damage.kind()),
                start,
                differences[0],
                differences[1]
            );
            assert!(start > 0);
            // The transient is never larger than the signal itself.
            assert!(differences.iter().all(|difference| *difference < tolerance));
        }
    }
}

#[test]
fn what_does_not_repeat_settles_for_long() {
    let mut steady = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
    steady.model = Model::Linear;
    let start = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = steady.clone();
        change(&mut scenario);
        meshtone::stages(&scenario).unwrap().time.first_simulated_sample
    };
    assert!(start(&|_| {}) > 0);
    assert_eq!(start(&|scenario| scenario.model = Model::Published), 0);
    assert_eq!(start(&|scenario| scenario.operation.torque_fluctuation_nm = 1.0), 0);
    assert_eq!(start(&|scenario| scenario.operation.speed_fluctuation_hz = 1.0), 0);
    assert_eq!(start(&|scenario| scenario.solver.initial_velocity = Some([0.0; 13])), 0);
    assert_eq!(start(&|scenario| scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(0.0)), 0);
}

/// The number that follows some words of a warning.
fn advised(warnings: &[ScenarioWarning], words: &str) -> Option<f64> {
    let (_, rest) = warnings.iter().find_map(|warning| warning.message.split_once(words))?;
    let number = rest.split(|sign: char| !sign.is_ascii_digit() && sign != '.').next()?;
    number.trim_end_matches('.').parse().ok()
}

/// Follows the advice of all warnings about settling and profiles at once.
fn follow(warnings: &[ScenarioWarning], operation: &mut Operation, solver: &mut Solver) {
    solver.duration_s = advised(warnings, "give solver.duration_s = ").or(solver.duration_s);
    solver.settle_fraction =
        advised(warnings, "raise solver.settle_fraction to ").unwrap_or(solver.settle_fraction);
    // What settling needs stands first, and is at least what the profile itself asks for.
    if let Some(later_s) = advised(warnings, ", and add ").or(advised(warnings, "; add ")) {
        for profile in [&mut operation.speed_profile_hz, &mut operation.torque_profile_nm] {
            profile.iter_mut().flat_map(|profile| &mut profile.time_s).for_each(|time_s| *time_s += later_s);
        }
    }
}

fn is_of_start(warning: &ScenarioWarning) -> bool {
    matches!(warning.kind, WarningKind::Unsettled | WarningKind::ProfileEnded)
}

#[test]
fn advice_on_settling_and_profiles_can_be_followed_together() {
    let run_up = |end_s: f64| Profile { time_s: vec![0.0, end_s], value: vec![30.0, 50.0] };
    // Length given or not; a profile that ends before a start that settles, or lasts.
    for (end_s, duration_s, settle_fraction) in [
        (0.1, Some(1.0), 0.5),
        (0.1, Some(0.1), 0.1),
        (0.1, Some(0.2), 0.01),
        (0.05, None, 0.3),
        (3.0, None, 0.01),
    ] {
        let mut scenario = Scenario::new(GearPair::example());
        scenario.operation.speed_profile_hz = Some(run_up(end_s));
        (scenario.solver.duration_s, scenario.solver.settle_fraction) = (duration_s, settle_fraction);
        let warnings = |scenario: &Scenario| {
            let (_, warnings) = stages_and_warnings(scenario, MemoryLimit::default()).unwrap();
            warnings.into_iter().filter(is_of_start).collect::<Vec<_>>()
        };
        let before = warnings(&scenario);
        assert!(!before.is_empty(), "{end_s} {duration_s:?}");
        follow(&before, &mut scenario.operation, &mut scenario.solver);
        let after = warnings(&scenario);
        assert!(after.is_empty(), "{before:?}\n{after:?}");
        let profile = scenario.operation.speed_profile_hz.as_ref().unwrap();
        assert!(*profile.time_s.last().unwrap() > scenario.time_grid().kept_from_s());
    }
}

#[test]
fn a_gearbox_whose_profile_ends_says_how_it_can_last() {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    gearbox.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 0.3], value: vec![20.0, 30.0] });
    (gearbox.solver.duration_s, gearbox.solver.settle_fraction) = (Some(0.5), 0.5);
    let warnings = |gearbox: &Scenario| {
        let warnings = stages(gearbox).unwrap().warnings();
        warnings.into_iter().filter(is_of_start).collect::<Vec<_>>()
    };
    let before = warnings(&gearbox);
    assert!(before.iter().any(|warning| warning.kind == WarningKind::ProfileEnded), "{before:?}");
    assert!(before.iter().any(|warning| warning.kind == WarningKind::Unsettled), "{before:?}");
    follow(&before, &mut gearbox.operation, &mut gearbox.solver);
    let after = warnings(&gearbox);
    assert!(after.is_empty(), "{before:?}\n{after:?}");
}
