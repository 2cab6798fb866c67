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
            scenario.rig.pinion_shaft.radius_mm = 4.0;
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
    crowned.gears.uniform_flank_reduction_mm = 1.3;
    assert_eq!(crowned.validate().unwrap_err().key, "gears.uniform_flank_reduction_mm");
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
