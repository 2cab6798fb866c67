//! Damage by its severity: one scale for every kind, from none to the largest that the tooth allows.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::num::NonZeroUsize;

use meshtone::damage::damaged_teeth;
use meshtone::scenario::*;
use meshtone::{simulate, stages};
use proptest::prelude::*;

use crate::physics::*;
use crate::support::{appended, assert_refused};

/// The kinds that have a size.
fn graded() -> Vec<Damage> {
    let kinds = damage_kinds().into_iter().map(|kind| kind.example);
    kinds.filter(|damage| !matches!(damage, Damage::MissingTooth(_))).collect()
}

fn pair(model: Model, module_mm: f64, [pinion_teeth, gear_teeth]: [u32; 2]) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm,
        pinion_teeth,
        gear_teeth,
        face_width_mm: 8.0 * module_mm,
        pinion_speed_hz: 40.0,
        brake_torque_nm: 2.0 * module_mm.powi(2),
    });
    scenario.model = model;
    scenario
}

fn with_severity(scenario: &Scenario, damage: &Damage, wheel: WheelName, severity: f64) -> Scenario {
    let fault = Fault::new(wheel, 2, damage.clone()).with_severity(severity);
    scenario.clone().with_faults(vec![fault])
}

/// Pairs of any size, of all models but `published`.
fn pairs() -> impl Strategy<Value = Scenario> {
    let teeth = (12u32..45, 17u32..90);
    let angle = prop_oneof![Just(17.5), Just(20.0), Just(25.0)];
    let model = prop_oneof![Just(Model::Contact), Just(Model::Linear)];
    (0.5..12.0, teeth, angle, model, 500usize..12_000)
        .prop_map(|(module_mm, (pinion, gear), angle, model, points)| {
            let mut scenario = pair(model, module_mm, [pinion, gear]);
            scenario.meshes[0].pressure_angle_deg = angle;
            scenario.meshes[0].points_per_tooth = points;
            scenario
        })
        .prop_filter("possible wheels", |scenario| scenario.validate().is_ok())
}

fn wheels() -> impl Strategy<Value = WheelName> {
    prop_oneof![Just(WheelName::Pinion), Just(WheelName::Gear)]
}

fn few(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(11),
        ..ProptestConfig::default()
    }
}

/// The sizes of a severity have that severity again, and can be.
fn assert_inverse(scenario: &Scenario, wheel: WheelName, drawn: f64) -> Result<(), TestCaseError> {
    let teeth = stages(scenario).unwrap().pairs.swap_remove(0).teeth;
    for damage in graded() {
        for severity in [drawn, 1e-7, 1e-3, 0.02, 0.5, 1.0] {
            let given = with_severity(scenario, &damage, wheel, severity);
            let sized = given.with_own_sizes().unwrap();
            let Some(fault) = sized.faults.first() else {
                // Smaller than the profile's points can show.
                prop_assert!(severity < 0.03, "{} {severity}", damage.kind());
                continue;
            };
            prop_assert_eq!(fault.severity, None);
            prop_assert!(sized.validate().is_ok(), "{:?}: {:?}", fault, sized.validate());
            let back = sized.fault_severities().unwrap()[0];
            prop_assert!((back - severity).abs() < 1e-9, "{:?}: {severity} is {back}", fault);
            prop_assert_eq!(given.fault_severities().unwrap(), [severity]);
            for faults in [&given.faults, &sized.faults] {
                let damaged = damaged_teeth(faults, &teeth, 1);
                prop_assert!(damaged.is_ok(), "{:?}: {:?}", fault, damaged);
                prop_assert_eq!(damaged.unwrap().len(), 1);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(few(12))]

    // Twelve wheels; the measurement below looks for the rare ones.
    #[test]
    fn sizes_and_severity_are_each_others_inverse(scenario in pairs(), wheel in wheels(), drawn in 0.0..1.0) {
        assert_inverse(&scenario, wheel, drawn)?;
    }
}

proptest! {
    #![proptest_config(few(200))]

    #[test]
    #[ignore = "a measurement: cargo xtask measure"]
    fn sizes_and_severity_are_each_others_inverse_of_many_wheels(
        scenario in pairs(), wheel in wheels(), drawn in 0.0..1.0
    ) {
        assert_inverse(&scenario, wheel, drawn)?;
    }
}

fn relative(value: f64, expected: f64) -> f64 {
    (value / expected - 1.0).abs()
}

/// A quick simulation of a pair with deviations.
fn quick(model: Model, teeth: [u32; 2]) -> Scenario {
    let mut scenario = pair(model, 3.0, teeth);
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
    // Both wheels turn whole times, and every tooth meets.
    (scenario.solver.sampling_rate_hz, scenario.solver.pinion_revolutions) = (1e5, Some(12.0));
    scenario.solver.settle_fraction = 0.2;
    scenario
}

#[test]
fn severity_0_is_the_healthy_signal() {
    for model in [Model::Contact, Model::Linear, Model::Published] {
        let healthy = quick(model, [17, 38]);
        let of_healthy = simulate(&healthy).unwrap().channels;
        for damage in graded() {
            // Nothing, and less than the profile's points can show.
            for severity in [0.0, 1e-15] {
                let fault = Fault::on_first_gear_tooth(damage.clone()).with_severity(severity);
                let given = healthy.clone().with_faults(vec![fault]);
                if model == Model::Published
                    && matches!(damage, Damage::Pits(_) | Damage::RootCrack(_) | Damage::Wear(_))
                {
                    let error = given.validate().unwrap_err();
                    assert_eq!(error.key, "fault.kind", "{error}");
                    continue;
                }
                let simulation = simulate(&given).unwrap();
                assert_eq!(simulation.stages.fault_severities, [severity]);
                let difference = simulation.channels["vertical_g"].iter().zip(&of_healthy["vertical_g"]);
                let most = largest(difference.map(|(faulty, healthy)| (faulty - healthy).abs()));
                let limit = if severity == 0.0 {
                    0.0
                } else {
                    1e-12 * largest(of_healthy["vertical_g"].iter().map(|x| x.abs()))
                };
                assert!(most <= limit, "{} {severity}: {most}", damage.kind());
            }
        }
    }
}

#[test]
fn severity_1_can_be_simulated() {
    for teeth in [[17, 38], [18, 35], [27, 53], [12, 36], [40, 23]] {
        for model in [Model::Contact, Model::Linear] {
            let healthy = quick(model, teeth);
            let kinds = damage_kinds().into_iter().map(|kind| kind.example);
            for (damage, wheel) in
                kinds.flat_map(|damage| WheelName::BOTH.map(|wheel| (damage.clone(), wheel)))
            {
                let simulation = simulate(with_severity(&healthy, &damage, wheel, 1.0));
                let simulation = simulation
                    .unwrap_or_else(|error| panic!("{} {teeth:?} {model:?}: {error}", damage.kind()));
                assert!(simulation.channels["vertical_g"].iter().all(|x| x.is_finite()));
                assert_eq!(simulation.stages.fault_severities, [1.0]);
            }
        }
    }
}

/// (N/mm) Stiffness of a pair of the damaged tooth over its path, and (m) how far apart its flanks are on it and beyond.
fn of_damaged_pair(scenario: &Scenario) -> [Vec<f64>; 2] {
    let stages = stages(scenario).unwrap();
    let mesh = &stages.meshes_at(NonZeroUsize::new(200).unwrap()).unwrap()[0];
    let [_, damaged] = sound_and_damaged(mesh);
    let (pairs, ratio) = (stages.tooth_pairs(), stages.pairs[0].teeth.path.contact_ratio);
    let stiffness = |k: i32| pairs.at(&damaged.kind, ratio * f64::from(k) / 200.0).stiffness_n_per_mm;
    [(0..=200).map(stiffness).collect(), damaged.states.iter().map(|state| state.separation_m).collect()]
}

proptest! {
    #![proptest_config(few(12))]

    // What is missing at a severity is missing at any larger one too.
    #[test]
    fn stiffness_falls_with_severity(scenario in pairs(), wheel in wheels()) {
        let mut scenario = scenario;
        scenario.meshes[0].points_per_tooth = 2_000;
        for damage in graded() {
            let severities = [0.05, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0];
            let states = severities.map(|severity| of_damaged_pair(&with_severity(&scenario, &damage, wheel, severity)));
            for pair in states.windows(2) {
                let ([less, less_apart], [more, apart]) = (&pair[0], &pair[1]);
                prop_assert!(mean(more) < mean(less), "{}", damage.kind());
                for (softer, stiffer) in more.iter().zip(less) {
                    prop_assert!(*softer <= stiffer * (1.0 + 1e-9), "{} {softer} {stiffer}", damage.kind());
                }
                for (farther, nearer) in apart.iter().zip(less_apart) {
                    prop_assert!(*farther >= nearer - 1e-15, "{} {farther} {nearer}", damage.kind());
                }
            }
        }
    }
}

#[test]
fn a_severity_follows_the_wheels() {
    let keys = "kind = \"root-crack\"\nangle_deg = 60.0\nseverity = 0.5";
    let scenario = Scenario::from_toml(&appended(&format!("[fault]\n{keys}"))).unwrap();
    assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario.clone()));
    assert!(!scenario.to_toml().contains("depth_mm =\n") && scenario.number("fault.depth_mm").is_none());
    assert_eq!(scenario.number("fault.severity"), Some(0.5));
    let depth_mm = |scenario: &Scenario| scenario.with_own_sizes().unwrap().number("fault.depth_mm").unwrap();
    let larger = scenario.with_numbers(&[("gears.module_mm", 6.0), ("fault.severity", 0.25)]).unwrap();
    assert!(relative(depth_mm(&larger), depth_mm(&scenario)) < 1e-3);
    // What is simulated has the sizes beside the severity.
    let stages = stages(&scenario).unwrap();
    let simulated = &stages.scenario;
    let Damage::RootCrack(RootCrack { depth_mm: of_stages, .. }) = simulated.faults[0].damage else {
        panic!("no crack")
    };
    assert_eq!((simulated.faults[0].severity, of_stages), (Some(0.5), depth_mm(&scenario)));
}

#[test]
fn a_severity_stands_in_place_of_sizes() {
    let refused = |keys: &str, key: &str, line: usize, words: &[&str]| {
        assert_refused(&appended(&format!("[[fault]]\n{keys}")), key, line, words);
    };
    let crack = "kind = \"root-crack\"\n";
    refused(
        &format!("{crack}severity = 0.5\ndepth_mm = 1.0"),
        "fault.depth_mm",
        12,
        &["beside severity", "depth_mm, length_mm"],
    );
    refused(&format!("{crack}severity = 1.5"), "fault.severity", 11, &["from 0 to 1"]);
    refused(&format!("{crack}severity = nan"), "fault.severity", 11, &["finite"]);
    refused(&format!("{crack}severity = 0.5\nangle_deg = 95"), "fault.angle_deg", 12, &["90"]);
    refused(&format!("{crack}severity = 0.5\nwidth_mm = 9"), "fault.width_mm", 12, &["unknown key"]);
    refused(crack, "fault.depth_mm", 9, &["required, unless severity is given"]);
    refused("kind = \"through-face\"", "fault.start", 9, &["or severity alone"]);
    refused(
        "kind = \"partial-face\"\nseverity = 0.2\ncircle = { x_mm = 57.5, y_mm = 3.66, radius_mm = 2.5 }",
        "fault.circle",
        12,
        &["beside severity"],
    );
    refused(
        "kind = \"missing-tooth\"\nseverity = 0.5",
        "fault.severity",
        11,
        &["must be 1", "tooth-breakage"],
    );
    for kind in damage_kinds() {
        let text = appended(&format!("[[fault]]\nkind = \"{}\"\nseverity = 1", kind.name));
        assert_eq!(Scenario::from_toml(&text).unwrap().faults[0].severity, Some(1.0));
    }
}

// The scales' formulas by hand: 17 and 38 teeth of module 3, 15 mm wide.
#[test]
fn severities_of_sizes_by_hand() {
    let healthy = Scenario::from_toml(&appended("[quality]\ndin_grade = 0")).unwrap();
    let severity = |damage: Damage| {
        let given = healthy.clone().with_faults(vec![Fault::on_first_gear_tooth(damage)]);
        given.fault_severities().unwrap()[0]
    };
    // Contact of the gear's flank begins where the pinion's tip circle meets the line of action.
    let alpha = 20f64.to_radians();
    let (pinion, gear) = ((28.5f64, 25.5 * alpha.cos()), (60.0f64, 57.0 * alpha.cos()));
    let line = 82.5 * alpha.sin();
    let curvature = line - (pinion.0.powi(2) - pinion.1.powi(2)).sqrt();
    let flank_x = |radius: f64| {
        let involute = |angle: f64| angle.tan() - angle;
        let polar = std::f64::consts::PI / 76.0 + involute(alpha) - involute((gear.1 / radius).acos());
        radius * polar.cos()
    };
    let height = flank_x(gear.0) - flank_x(curvature.hypot(gear.1));
    let chip = |chip_height_mm, chip_width_mm, tip_loss_mm| {
        Damage::from(ToothBreakage { chip_height_mm, chip_width_mm, tip_loss_mm })
    };
    let near = |value: f64, expected: f64| assert!((value - expected).abs() < 5e-4, "{value} {expected}");
    near(severity(chip(3.0, 6.0, 0.0)), 9.0 / (15.0 * height));
    near(severity(chip(3.0, 6.0, 3.0)), 3.0 / height);
    near(severity(chip(3.0, 6.0, 1.0)), (15.0 + 4.0) / (15.0 * height));
    let pit = PitCircle::Fractions { start: 0.3, end: 0.6, depth: 0.5 };
    near(severity(PartialFace { width_mm: 5.0, pit }.into()), 0.3 / 3.0 / 0.81);
    near(severity(ThroughFace { pit }.into()), 0.3 / 0.9);
    let circle = PitCircle::Circle { x_mm: 57.5, y_mm: 3.66, radius_mm: 2.5 };
    let simulated =
        stages(healthy.clone().with_faults(vec![Fault::on_first_gear_tooth(ThroughFace { pit: circle })]))
            .unwrap();
    let length_fraction = simulated.pairs[0].damaged[0].descriptions[0].numbers("length_fraction")[0];
    assert!((simulated.fault_severities[0] - length_fraction / 0.9).abs() < 0.01);
    // The table of cracks: the fillet's point is 3.0109 mm from the centre line.
    let crack = |depth_mm, length_mm| Damage::from(RootCrack { depth_mm, angle_deg: 45.0, length_mm });
    near(severity(crack(2.0, None)), 2.0 * 0.5f64.sqrt() / 3.0109);
    near(severity(crack(2.0, Some(9.0))), 2.0 * 0.5f64.sqrt() / 3.0109 * 0.4);
    // The paper's line, and one along the tooth's centre line up to the tip.
    let ground =
        |start, line, offset_mm| Damage::from(ToothDestruction { start, line, offset_mm, noise_mm: 0.0 });
    near(severity(ground(0.2143, DestructionLine::End(0.9286), 0.0)), 0.7143);
    near(severity(ground(-0.1, DestructionLine::End(0.5), 0.0)), 0.5);
    near(severity(ground(0.6, DestructionLine::SlopeDeg(1e-6), 1.0)), 0.4);
    assert_eq!(severity(MissingTooth.into()), 1.0);
}
