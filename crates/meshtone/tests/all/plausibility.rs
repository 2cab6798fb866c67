//! Scenarios that cannot be meant, and results that cannot be.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use meshtone::scenario::{
    DampingRatio, Fault, FlankRelief, GearPair, MissingTooth, Model, Profile, Scenario, ScenarioWarning,
    WarningKind, WheelName,
};
use meshtone::sensor::{NamedSignal, SignalSource};
use meshtone::{Simulation, simulate};
use meshtone_fourier::real_spectrum;
use nalgebra::DVector;

use crate::dense::machine_of;

fn pair() -> Scenario {
    Scenario::new(GearPair::example())
}

fn about<'a>(warnings: &'a [ScenarioWarning], key: &str) -> Option<&'a str> {
    warnings.iter().find(|warning| warning.key == key).map(|warning| warning.message.as_str())
}

/// The figures of the messages are those of the textbook: v = π m z n, F = T/r_b.
#[test]
fn a_speed_in_revolutions_per_minute_is_refused_with_what_it_would_be() {
    let mut scenario = pair();
    scenario.operation.pinion_speed_hz = 1476.0;
    let error = scenario.validate().unwrap_err();
    assert_eq!((error.key.as_str(), error.value.as_str()), ("operation.pinion_speed_hz", "1476.0"));
    assert!(error.problem.contains("would run at 236 m/s"), "{}", error.problem);
    assert!(error.help.unwrap().ends_with("if 1476.0 is per minute, write 24.6000"));

    // As fast as the larger wheel of another pair.
    (scenario.meshes[0].module_mm, scenario.wheels[0].teeth) = (2.5, 27);
    assert!(scenario.validate().unwrap_err().problem.contains("313 m/s"));

    scenario.operation.pinion_speed_hz = 300.0;
    let warnings = scenario.validate().unwrap();
    let told = about(&warnings, "operation.pinion_speed_hz").unwrap();
    assert!(told.contains("run at 64 m/s"), "{told}");
    assert!(pair().validate().unwrap().is_empty());
}

/// The damping of the published model brakes the rotation of the whole machine, that of the others does not.
#[test]
fn a_braked_rotation_is_reported_under_the_published_model_alone() {
    let reported = |model: Model| {
        let mut scenario = pair();
        scenario.model = model;
        let simulation = simulate(&scenario).unwrap();
        let warnings = simulation.warnings_of_signals(meshtone::StepJudgement::Repeated);
        let braked = warnings.into_iter().find(|warning| warning.kind == WarningKind::BrakedRotation);
        (braked.map(|warning| warning.message), simulation.stages.static_force_n())
    };
    let (published, static_n) = reported(Model::Published);
    let published = published.unwrap();
    assert!(published.contains(&format!("but the load's is {static_n:.0} N")), "{published}");
    for model in [Model::Linear, Model::Contact] {
        assert_eq!(reported(model).0, None, "{model:?}");
    }
}

#[test]
fn a_profile_counts_as_the_nominal_speed_does() {
    let mut scenario = pair();
    let profile = |value: [f64; 2]| Some(Profile { time_s: vec![0.0, 2.0], value: value.to_vec() });
    scenario.operation.speed_profile_hz = profile([1000.0, 1800.0]);
    let error = scenario.validate().unwrap_err();
    assert_eq!(error.key, "operation.speed_profile_hz.value[1]");
    assert!(error.help.unwrap().ends_with("write 30.0000"));
    scenario.operation.speed_profile_hz = profile([1000.0, 1e5]);
    let help = scenario.validate().unwrap_err().help.unwrap();
    assert!(help.ends_with("these wheels turn at most 1248.3 times"), "{help}");

    // Never near the nominal speed, and a run-up through it.
    scenario.operation.speed_profile_hz = profile([50.0, 60.0]);
    let warnings = scenario.validate().unwrap();
    let told = about(&warnings, "operation.speed_profile_hz").unwrap();
    assert!(told.starts_with("is 55.0000 Hz on average"), "{told}");
    scenario.operation.speed_profile_hz = profile([5.0, 45.0]);
    assert!(scenario.validate().unwrap().is_empty());
}

#[test]
fn a_load_that_breaks_teeth_is_warned_of_with_their_deflection() {
    let mut scenario = pair();
    let of = |scenario: &Scenario| meshtone::stages(scenario).unwrap().warnings();
    assert_eq!(about(&of(&scenario), "operation.brake_torque_nm"), None);
    // In N mm.
    scenario.operation.brake_torque_nm = 10_000.0;
    let told = of(&scenario);
    let told = about(&told, "operation.brake_torque_nm").unwrap();
    // 187 kN over 251 000 N/mm.
    assert!(told.starts_with("10000.0 N m deflects the teeth by 0.743"), "{told}");
    assert!(told.contains("with 186698 N on 15 mm of face"), "{told}");
    assert!(told.ends_with("at most 4036 N m stays below a tenth of the module"), "{told}");
    scenario.operation.brake_torque_nm = 10.0;
    scenario.operation.torque_profile_nm =
        Some(Profile { time_s: vec![0.0, 1.0], value: vec![10.0, 10_000.0] });
    assert!(about(&of(&scenario), "operation.torque_profile_nm.value[1]").is_some());
}

/// Chamfers of two thirds of a module leave less than a pitch of the path; a relief that is shorter than a chamfer does nothing.
#[test]
fn chamfers_that_take_the_path_or_the_relief_are_told() {
    let mut chamfered = pair();
    chamfered.wheels[1].tip_chamfer_mm = Some(2.0);
    let warnings = meshtone::stages(&chamfered).unwrap().warnings();
    let told = warnings.iter().find(|warning| warning.kind == WarningKind::NoContact).unwrap();
    assert_eq!(told.key, "gears.gear_tip_chamfer_mm");
    assert!(told.message.contains("only corners of tips touch"), "{told}");
    let mut linear = chamfered.clone();
    linear.model = Model::Linear;
    let warnings = meshtone::stages(&linear).unwrap().warnings();
    let told = warnings.iter().find(|warning| warning.kind == WarningKind::NoContact).unwrap();
    assert!(
        told.message.ends_with(
            "has no stiffness; lower gears.gear_tip_chamfer_mm or gears.active_profile_shortening"
        ),
        "{told}"
    );
    chamfered.wheels.iter_mut().for_each(|wheel| wheel.tip_chamfer_mm = Some(2.9));
    let refused = meshtone::stages(&chamfered).unwrap_err();
    assert!(refused.help.unwrap().contains("gears.tip_chamfer_mm"));

    let mut relieved = pair();
    relieved.wheels.iter_mut().for_each(|wheel| {
        wheel.flank_relief = FlankRelief { length_mm: 0.5, amount_um: 20.0, ..wheel.flank_relief };
    });
    let keys = |scenario: &Scenario| {
        let warnings = meshtone::stages(scenario).unwrap().warnings();
        warnings.into_iter().map(|warning| (warning.kind, warning.key)).collect::<Vec<_>>()
    };
    assert_eq!(keys(&relieved), [(WarningKind::IgnoredKey, "gears.flank_relief.length_mm".to_owned())]);
    relieved.wheels[1].flank_relief.length_mm = 1.0;
    assert_eq!(
        keys(&relieved),
        [(WarningKind::IgnoredKey, "gears.pinion_flank_relief.length_mm".to_owned())]
    );
}

/// A pair that lacks a tooth has none in contact for 2 less its contact ratio, in pitches.
#[test]
fn places_at_which_no_teeth_meet_are_told() {
    for (wheel, teeth) in [(WheelName::Gear, 38), (WheelName::Pinion, 17)] {
        let fault =
            Fault { wheel: wheel.into(), tooth: 9.into(), ..Fault::on_first_gear_tooth(MissingTooth) };
        let mut broken = pair().with_faults(vec![fault]);
        broken.model = Model::Linear;
        let stages = meshtone::stages(&broken).unwrap();
        let warnings = stages.warnings();
        let told = warnings.iter().find(|warning| warning.kind == WarningKind::NoContact).unwrap();
        let percent: f64 = told.message.split([' ', '%']).find_map(|word| word.parse().ok()).unwrap();
        // In 38 pitches, of the gear's 38 teeth, the pinion's tooth comes two or three times.
        let times = if teeth == 38 { 1.0..=1.0 } else { 2.0..=3.0 };
        let pitches = percent / 100.0 * 38.0 / (2.0 - stages.meshes[0].contact_ratio);
        println!("{percent} % of 38 pitches, {pitches:.3} times what a tooth leaves");
        assert!((times.start() - 0.03..times.end() + 0.03).contains(&pitches), "{pitches}");

        broken.model = Model::Contact;
        let mut healthy = pair();
        healthy.model = Model::Linear;
        for scenario in [broken, healthy] {
            let warnings = meshtone::stages(&scenario).unwrap().warnings();
            assert!(warnings.iter().all(|warning| warning.kind != WarningKind::NoContact));
        }
    }
}

#[test]
fn a_shaft_that_turns_at_another_speed_is_told() {
    let mut scenario = pair();
    scenario.solver.sampling_rate_hz = 3e4;
    let mut simulation = simulate(&scenario).unwrap();
    assert_eq!(
        about(&simulation.warnings_of_signals(meshtone::StepJudgement::Repeated), "solver.settle_fraction"),
        None
    );
    let of_gear = |signal: &&mut NamedSignal| signal.source == SignalSource::ShaftSpeed(1);
    let signal = simulation.channels.signals.iter_mut().find(of_gear).unwrap();
    signal.values.iter_mut().for_each(|speed_hz| *speed_hz *= 0.75);
    let warnings = simulation.warnings_of_signals(meshtone::StepJudgement::Repeated);
    let told = about(&warnings, "solver.settle_fraction").unwrap();
    let words = "the gear turns at 13.4211 Hz on average, while the motor drives it at 17.8947 Hz";
    assert!(told.starts_with(words), "{told}");
}

/// A mode of the linear model with hardly any damping, and a mesh harmonic on it.
fn resonant(damping_ratio: f64, harmonic: f64) -> Scenario {
    let mut scenario = pair();
    crate::physics::with_own_structure(&mut scenario);
    scenario.model = Model::Linear;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 0);
    scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(damping_ratio);
    scenario.meshes[0].damping_ratio = damping_ratio;
    // Their mesh cycle is short, so that the step can be long.
    (scenario.wheels[0].teeth, scenario.wheels[1].teeth) = (18, 36);
    let stages = meshtone::stages(&scenario).unwrap();
    let machine = machine_of(&stages).0;
    let line = &machine.turn * &machine.lines[0].at_middle;
    let of_mesh = |shape: &[f64]| line.dot(&DVector::from_column_slice(shape)).abs();
    // The mode in which the mesh deflects most.
    let modes = stages.mode_shapes().into_iter().zip(stages.natural_frequencies_hz());
    let (_, mode_hz) = modes.max_by(|(a, _), (b, _)| of_mesh(a).total_cmp(&of_mesh(b))).unwrap();
    scenario.operation.pinion_speed_hz = mode_hz / (18.0 * harmonic);
    scenario
}

fn rms(signal: &[f64]) -> f64 {
    (signal.iter().map(|value| value * value).sum::<f64>() / signal.len() as f64).sqrt()
}

fn at_rate(scenario: &Scenario, sampling_rate_hz: f64) -> Simulation {
    let mut scenario = scenario.clone();
    scenario.solver.sampling_rate_hz = sampling_rate_hz;
    simulate(&scenario).unwrap()
}

/// What the warning of a long step tells: how far the rms changes with half of it, and a rate that mends it.
fn long_step(simulation: &Simulation) -> Option<(f64, f64)> {
    let warnings = simulation.warnings_of_signals(meshtone::StepJudgement::Repeated);
    let told = about(&warnings, "solver.sampling_rate_hz")?;
    let number = |after: &str| {
        let rest = told.split(after).nth(1).unwrap();
        rest.split([' ', ',']).next().unwrap().parse::<f64>().unwrap()
    };
    let sign = if told.contains("% larger") { 1.0 } else { -1.0 };
    Some((sign * number("S/s the rms is ") / 100.0, number("sampling_rate_hz = ")))
}

/// What is told is most of what a much finer step shows, and the rate that is named mends it.
#[test]
fn a_step_that_shifts_a_resonance_is_told_with_its_error() {
    // At 0.005 and the second harmonic the varying stiffness adds more than the damping takes: that is refused.
    assert!(matches!(simulate(resonant(0.005, 2.0)), Err(meshtone::Error::Diverged { .. })));
    for (damping_ratio, harmonic) in [(0.01, 4.0), (0.02, 3.0), (0.02, 2.0)] {
        let scenario = resonant(damping_ratio, harmonic);
        let coarse = at_rate(&scenario, 5e4);
        let fine = at_rate(&scenario, 2e6);
        let acceleration = |of: &Simulation| rms(&of.channels["vertical_g"]);
        let force = |of: &Simulation| rms(&of.channels["mesh_force_n"]);
        let error = |of: &Simulation| {
            let gains = [acceleration(&fine) / acceleration(of) - 1.0, force(&fine) / force(of) - 1.0];
            gains.into_iter().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap()
        };
        let shown = error(&coarse);
        let (told, mut rate_hz) = long_step(&coarse).unwrap();
        println!("{damping_ratio} {harmonic}: {told:.3}, shown {shown:.3}");
        // Of second order half the step shows 3/4 of all, of fourth order 15/16.
        assert!((0.65..1.1).contains(&(told / shown)), "{damping_ratio} {harmonic}: {told}, shown {shown}");
        let mut better = at_rate(&scenario, rate_hz);
        while let Some((_, next_hz)) = long_step(&better) {
            assert!(next_hz > rate_hz);
            rate_hz = next_hz;
            better = at_rate(&scenario, rate_hz);
        }
        let left = [rms_below_10_khz(&fine) / rms_below_10_khz(&better), force(&fine) / force(&better)];
        // What was told is of the whole signal; of a part of it somewhat more may be left.
        assert!(
            left.iter().all(|ratio| (ratio - 1.0).abs() < 0.03),
            "{damping_ratio} {harmonic}: {left:?} at {rate_hz}"
        );
    }
}

/// (g) Rms of the vertical acceleration below 10 kHz: the jumps of a linear mesh's stiffness reach beyond every rate.
fn rms_below_10_khz(simulation: &Simulation) -> f64 {
    let signal = &simulation.channels["vertical_g"];
    let lines = (1e4 * signal.len() as f64 / simulation.channels.sampling_rate_hz) as usize;
    let spectrum = real_spectrum(signal);
    spectrum[1..lines].iter().map(|line| line.norm_sqr()).sum::<f64>().sqrt() / signal.len() as f64
}

/// Silence means that the step is short enough, wherever the mesh stays closed and has settled.
#[test]
fn what_is_not_warned_of_is_right() {
    let mut silent = 0;
    for seed in 1..=12_u32 {
        let model = if seed % 2 == 0 { Model::Contact } else { Model::Linear };
        let mut scenario = pair();
        (scenario.model, scenario.seed) = (model, u64::from(seed));
        scenario.wheels[1].teeth = 38 + 3 * seed;
        scenario.operation.pinion_speed_hz = 11.0 + 4.3 * f64::from(seed);
        scenario.operation.brake_torque_nm = 60.0;
        scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(0.01 + 0.01 * f64::from(seed % 4));
        let coarse = at_rate(&scenario, 1e5);
        let parts = coarse.contact_figures().is_some_and(|figures| figures.apart_fraction > 0.0);
        if long_step(&coarse).is_some()
            || parts
            || coarse.stages.warnings().iter().any(|warning| warning.key.contains("settle"))
        {
            continue;
        }
        let fine = at_rate(&scenario, 4e5);
        let error = rms_below_10_khz(&fine) / rms_below_10_khz(&coarse) - 1.0;
        println!("seed {seed} {}: {error:.4}", model.name());
        assert!(error.abs() < 0.02, "seed {seed}: {error}");
        silent += 1;
    }
    assert!(silent >= 6, "{silent}");
}

#[test]
fn examples_at_their_own_rate_are_not_warned_of() {
    for model in [Model::Linear, Model::Contact] {
        let mut scenario = pair();
        scenario.model = model;
        let warnings = simulate(&scenario).unwrap().warnings_of_signals(meshtone::StepJudgement::Repeated);
        assert_eq!(about(&warnings, "solver.sampling_rate_hz"), None, "{}", model.name());
        assert_eq!(about(&warnings, "operation.pinion_speed_hz"), None, "{}", model.name());
    }
    // Drawn anew for every sample: a finer step would be another machine's.
    let mut fluctuating = pair();
    fluctuating.model = Model::Linear;
    fluctuating.operation.speed_fluctuation_hz = 0.5;
    let warnings = simulate(&fluctuating).unwrap().warnings_of_signals(meshtone::StepJudgement::Repeated);
    assert_eq!(about(&warnings, "solver.sampling_rate_hz"), None);
}

#[test]
fn a_resonance_beyond_all_measure_is_told() {
    let mut scenario = resonant(0.02, 2.0);
    scenario.operation.brake_torque_nm = 0.005;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
    let simulation = simulate(&scenario).unwrap();
    let warnings = simulation.warnings_of_signals(meshtone::StepJudgement::Repeated);
    let told = about(&warnings, "operation.pinion_speed_hz").unwrap();
    assert!(
        told.contains("times the static 0.0985 N: a resonance that no machine survives, or a load too light"),
        "{told}"
    );
}
