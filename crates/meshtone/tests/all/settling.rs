//! A simulation that starts in equilibrium and settles shortly keeps the signal of one that settles for long.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::scenario::*;
use meshtone::{Simulation, StepJudgement, simulate};

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

fn unsettled(simulation: &Simulation) -> Option<ScenarioWarning> {
    let warnings = simulation.warnings_of_signals(StepJudgement::Estimated);
    warnings.into_iter().find(|warning| warning.kind == WarningKind::Unsettled)
}

// It starts from rest, and the motor pulls it up through its damped shaft.
#[test]
fn a_motion_that_has_not_settled_is_told_by_its_signal() {
    let mut scenario = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
    scenario.solver.sampling_rate_hz = 2e4;
    (scenario.solver.duration_s, scenario.solver.settle_fraction) = (Some(1.0), 0.01);
    // From equilibrium hardly anything has to settle, however little time it has.
    assert_eq!(unsettled(&simulate(&scenario).unwrap()), None);
    scenario.solver.initial_velocity = Some([0.0; 13]);
    let told = unsettled(&simulate(&scenario).unwrap()).unwrap();
    assert!(told.message.contains("changes the rms of the kept signal by"), "{told}");
    assert!(told.message.contains("times as long"), "{told}");
    scenario.solver.discard_and_keep(4.0, 1.0);
    assert_eq!(unsettled(&simulate(&scenario).unwrap()), None);
}

#[test]
fn the_stock_gearbox_has_settled() {
    let gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    let simulation = simulate(&gearbox).unwrap();
    assert_eq!(unsettled(&simulation), None);
    assert_eq!(simulation.channels.start_s, 0.0);
}

#[test]
fn a_profile_is_kept_from_its_first_to_its_last_value() {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).unwrap();
    gearbox.solver.sampling_rate_hz = 2e4;
    gearbox.solver.duration_s = None;
    gearbox.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 0.6], value: vec![10.0, 50.0] });
    let channels = simulate(&gearbox).unwrap().channels;
    assert_eq!(channels.start_s, 0.0);
    assert!((channels.len() as f64 / channels.sampling_rate_hz - 0.6).abs() < 1e-3, "{}", channels.len());
    let speed = channels.signal("speed_hz.input").unwrap();
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let window = speed.len() / 60;
    // Over the first and the last hundredth of a second.
    let [first, last] = [mean(&speed[..window]), mean(&speed[speed.len() - window..])];
    println!("{first:.3} to {last:.3} rev/s");
    assert!((first - 10.33).abs() < 0.3 && (last - 49.67).abs() < 0.5, "{first} {last}");
    // Another length is refused, the same one is not.
    for (duration_s, is_allowed) in [(0.6, true), (0.5, false)] {
        gearbox.solver.duration_s = Some(duration_s);
        assert_eq!(gearbox.validate().is_ok(), is_allowed, "{duration_s}");
    }
    let error = gearbox.validate().unwrap_err();
    assert_eq!(error.key, "solver.duration_s");
    assert!(error.problem.contains("a profile that ends at 0.6 s"), "{error}");
}

#[test]
fn a_speed_profile_needs_no_speed_beside_it() {
    let text = gearbox_template(None)
        .replace("input_speed_hz = 30.0", "speed_profile_hz = { time_s = [0.0, 1.0], value = [30.0, 45.0] }");
    let gearbox = Scenario::from_toml(&text).unwrap();
    assert_eq!(gearbox.operation.pinion_speed_hz, 45.0);
    assert_eq!(Scenario::from_toml(&gearbox.to_toml()).unwrap(), gearbox);
    let neither = gearbox_template(None).replace("input_speed_hz = 30.0\n", "");
    assert_eq!(Scenario::from_toml(&neither).unwrap_err().key, "operation.input_speed_hz");
}
