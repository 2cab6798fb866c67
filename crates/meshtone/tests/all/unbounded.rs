//! Motions that grow without bound are errors, not signals.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{DampingRatio, Fault, GearPair, MissingTooth, Model, Scenario};
use meshtone::{Error, simulate};

/// Few teeth, one of them missing: for a part of each revolution no tooth is in contact. Next to no damping.
#[test]
fn contact_that_is_lost() {
    let mut scenario = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: 10,
        gear_teeth: 11,
        face_width_mm: 15.0,
        pinion_speed_hz: 150.0,
        brake_torque_nm: 10.0,
    });
    scenario.model = Model::Linear;
    scenario.rig.pinion_shaft.radius_mm = 4.2;
    scenario.rig.gear_shaft.radius_mm = 4.2;
    scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
    scenario.solver.sampling_rate_hz = 2e4;
    scenario.gears.points_per_tooth = 2000;
    scenario.rig.damping_ratio = DampingRatio::Uniform(0.0005);
    let error = simulate(&scenario).map(drop).unwrap_err();
    assert!(
        matches!(&error, Error::Diverged { damping_ratios, .. } if *damping_ratios == [0.0005; 13]),
        "{error:?}"
    );
    let text = error.to_string();
    assert!(
        text.starts_with("the motion grows without bound within 0.")
            && text.contains("rig.damping_ratio = 0.0005"),
        "{text}"
    );
}
