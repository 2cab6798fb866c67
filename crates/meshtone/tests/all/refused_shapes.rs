//! Scenarios that can only give numbers without meaning are refused.
#![allow(clippy::unwrap_used)]

use crate::physics::mesh;
use meshtone::mesh::PairState;
use meshtone::scenario::{Fault, GearPair, MissingTooth, Model, Profile, Scenario, WheelName};

// 1 mm × 1 mm of relief, which the published model always has, takes the whole tip of a small tooth and more: half thicknesses below
// 0 and stiffness of 0.
#[test]
fn relief_leaves_some_of_the_tip() {
    for teeth in [17, 60] {
        for module in [1.3, 1.4, 1.5, 1.6, 2.0, 3.0] {
            let mut scenario =
                Scenario::new(GearPair { module_mm: module, pinion_teeth: teeth, ..GearPair::example() });
            scenario.rig_mut().unwrap().pinion_shaft.radius_mm = 4.0;
            scenario.model = Model::Published;
            let refused = scenario.validate().err().map(|error| error.key);
            let expected = (module <= 1.5).then(|| "gears.module_mm".to_owned());
            assert_eq!(refused, expected, "module {module}, {teeth} teeth");
            scenario.model = Model::Linear;
            let stages = meshtone::stages(&scenario).unwrap();
            let stiff = |state: &PairState| state.stiffness_n_per_m == 0.0 || state.stiffness_n_per_m > 1e6;
            let sound = &mesh(&stages).classes[0].states;
            assert!(sound.iter().all(stiff) && sound.iter().any(|state| state.stiffness_n_per_m > 1e7));
        }
    }
    let mut crowned = Scenario::new(GearPair::example());
    crowned.model = Model::Linear;
    crowned.wheels.iter_mut().for_each(|wheel| wheel.uniform_flank_reduction_mm = 1.3);
    assert_eq!(crowned.validate().unwrap_err().key, "gears.uniform_flank_reduction_mm");
}

/// The settling is a fraction of the simulated time, also where a speed profile or a stated length sets it.
#[test]
fn the_kept_signal_has_one_length() {
    let kept_s = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = Scenario::new(GearPair::example());
        change(&mut scenario);
        scenario.validate().map_err(|error| error.key)?;
        let time = scenario.time_grid();
        let discarded = time.first_kept_sample as f64 / time.samples as f64;
        assert!((discarded - scenario.solver.settle_fraction).abs() < 1e-4, "{discarded}");
        Ok::<_, String>(time.kept_samples() as f64 * time.step_s())
    };
    let profile = |scenario: &mut Scenario, end: f64| {
        scenario.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, end], value: vec![40.0, 41.0] });
    };
    let is = |kept_s: Result<f64, String>, expected_s: f64| {
        let kept_s = kept_s.unwrap();
        assert!((kept_s - expected_s).abs() < 1e-5, "{kept_s} {expected_s}");
    };
    is(kept_s(&|_| ()), 38.0 / 40.0);
    is(kept_s(&|scenario| scenario.solver.duration_s = Some(0.3)), 0.3);
    is(kept_s(&|scenario| scenario.solver.pinion_revolutions = Some(7.5)), 7.5 / 40.0);
    is(kept_s(&|scenario| profile(scenario, 0.9)), 0.9);
    let both = |scenario: &mut Scenario, duration_s: f64| {
        profile(scenario, 0.9);
        scenario.solver.duration_s = Some(duration_s);
        scenario.solver.settle_fraction = 0.25;
    };
    is(kept_s(&|scenario| both(scenario, 0.9)), 0.9);

    let refused = |change: &dyn Fn(&mut Scenario)| kept_s(change).unwrap_err();
    let with_profile = |scenario: &mut Scenario| {
        profile(scenario, 0.9);
        scenario.solver.pinion_revolutions = Some(7.5);
    };
    assert_eq!(refused(&with_profile), "solver.pinion_revolutions");
    assert_eq!(refused(&|scenario| both(scenario, 0.6)), "solver.duration_s");
    let twice = |scenario: &mut Scenario| {
        (scenario.solver.duration_s, scenario.solver.pinion_revolutions) = (Some(0.3), Some(7.5));
    };
    assert_eq!(refused(&twice), "solver.pinion_revolutions");
    assert_eq!(refused(&|scenario| scenario.solver.duration_s = Some(1e-9)), "solver.duration_s");
    assert_eq!(refused(&|scenario| scenario.solver.duration_s = Some(0.0)), "solver.duration_s");
}

#[test]
fn wheels_without_a_tooth_are_refused() {
    let pair = GearPair::example();
    let all = |wheel, teeth| (1..=teeth).map(|tooth| Fault::new(wheel, tooth, MissingTooth)).collect();
    for model in [Model::Linear, Model::Contact] {
        for faults in [all(WheelName::Gear, 38), all(WheelName::Pinion, 17)] {
            let mut scenario = Scenario::new(pair).with_faults(faults);
            scenario.model = model;
            let error = meshtone::stages(&scenario).err().map(|error| error.to_string());
            assert!(error.is_some_and(|error| error.contains("no pair of teeth")));
        }
        let mut scenario = Scenario::new(pair).with_faults(all(WheelName::Gear, 37));
        scenario.model = model;
        assert!(meshtone::stages(&scenario).is_ok());
    }
}

/// Eight stages of 397/401 teeth have a ratio of twenty-one digits, which no fraction of ours holds; seven have one of eighteen.
#[test]
fn a_train_of_too_many_prime_tooth_counts_is_refused() {
    let refused = |stages: usize| {
        let mut text = String::new();
        for shaft in 0..=stages {
            let end = match shaft {
                0 => "couples_to = \"motor\"\n",
                _ if shaft == stages => "couples_to = \"brake\"\n",
                _ => "",
            };
            text += &format!("[[shaft]]\nname = \"s{shaft}\"\nlength_mm = 200.0\nradius_mm = 20.0\n{end}");
            text += &format!(
                "[[bearing]]\nshaft = \"s{shaft}\"\nat = 0.0\n[[bearing]]\nshaft = \"s{shaft}\"\nat = 1.0\n"
            );
        }
        for stage in 0..stages {
            for (name, shaft, teeth) in [("a", stage, 397), ("b", stage + 1, 401)] {
                text += &format!(
                    "[[wheel]]\nname = \"{name}{stage}\"\nshaft = \"s{shaft}\"\nat = {}\nteeth = {teeth}\nface_width_mm = 10.0\n",
                    0.1 + 0.1 * stage as f64
                );
            }
            text += &format!("[[mesh]]\nwheels = [\"a{stage}\", \"b{stage}\"]\nmodule_mm = 1.0\n");
        }
        text += "[housing]\nmass_kg = 30.0\n[operation]\ninput_speed_hz = 10.0\nbrake_torque_nm = 50.0\n";
        Scenario::from_toml(&text).err().map(|error| error.to_string())
    };
    assert_eq!(refused(7), None);
    let error = refused(8).unwrap();
    assert!(error.contains("makes the ratio of shaft \"s8\" a fraction of too many digits"), "{error}");
}
