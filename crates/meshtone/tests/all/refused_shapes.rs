//! Scenarios that can only give numbers without meaning are refused.
#![allow(clippy::unwrap_used)]

use crate::physics::pairs;
use meshtone::scenario::{Fault, GearPair, MissingTooth, Model, Profile, Scenario, WheelName};

// 1 mm × 1 mm of relief takes the whole tip of a small tooth and more: half thicknesses below 0 and stiffness of 0.
#[test]
fn relief_leaves_some_of_the_tip() {
    for teeth in [17, 60] {
        for module in [1.3, 1.4, 1.5, 1.6, 2.0, 3.0] {
            let mut scenario =
                Scenario::new(GearPair { module_mm: module, pinion_teeth: teeth, ..GearPair::example() });
            scenario.model = Model::Linear;
            scenario.rig.pinion_shaft.radius_mm = 4.0;
            let refused = scenario.validate().err().map(|error| error.key);
            let expected = (module <= 1.5).then(|| "gears.tip_relief.depth_mm".to_owned());
            assert_eq!(refused, expected, "module {module}, {teeth} teeth");
            scenario.gears.tip_relief = None;
            let stages = meshtone::stages(&scenario).unwrap();
            assert!(pairs(&stages).classes[0].stiffness_n_per_m.iter().all(|k| *k > 1e7));
        }
    }
    let mut crowned = Scenario::new(GearPair::example());
    crowned.model = Model::Linear;
    crowned.gears.tip_relief = None;
    crowned.gears.crowning_mm = 1.3;
    assert_eq!(crowned.validate().unwrap_err().key, "gears.crowning_mm");
}

// What the rule computes is what the profile has.
#[test]
fn the_limit_is_the_profiles_own() {
    let mut scenario =
        Scenario::new(GearPair { module_mm: 2.0, pinion_teeth: 25, gear_teeth: 30, ..GearPair::example() });
    scenario.model = Model::Linear;
    scenario.gears.tip_relief.as_mut().unwrap().depth_mm = 0.0;
    let stages = meshtone::stages(&scenario).unwrap();
    let limit = [&stages.teeth.pinion_profile, &stages.teeth.gear_profile]
        .map(|profile| profile.y_mm[profile.nearest_to_x(profile.tip_x_mm() - 1.0)])
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let allowed = |depth_mm: f64| {
        let mut scenario = scenario.clone();
        scenario.gears.tip_relief.as_mut().unwrap().depth_mm = depth_mm;
        scenario.validate().is_ok()
    };
    assert!(allowed(limit - 1e-3) && !allowed(limit + 1e-3), "{limit}");
}

#[test]
fn a_speed_profile_outlasts_the_settling() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.model = Model::Linear;
    let profile = |end: f64| Some(Profile { time_s: vec![0.0, end], value: vec![40.0, 41.0] });
    // Half of 76 revolutions at 40 Hz are discarded: 0.95 s.
    scenario.operation.speed_profile_hz = profile(0.9);
    assert_eq!(scenario.validate().unwrap_err().key, "operation.speed_profile_hz");
    scenario.operation.speed_profile_hz = profile(1.0);
    assert!(scenario.validate().is_ok());
    // The published code ignores speed profiles.
    scenario.model = Model::Published;
    scenario.operation.speed_profile_hz = profile(0.9);
    assert!(scenario.validate().is_ok());
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
