//! Motions that grow without bound are errors, not signals.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{DampingRatio, Fault, Scenario};
use meshtone::simulate;

/// Six teeth against six, one of them missing: for a part of each revolution no tooth is in contact.
#[test]
fn contact_that_is_lost() {
    let mut scenario = Scenario::new(3.0, 6, 6, 15.0, 40.0, 10.0);
    scenario.rig.pinion_shaft.radius_mm = 4.2;
    scenario.rig.gear_shaft.radius_mm = 4.2;
    scenario.fault = Some(Fault::MissingTooth);
    scenario.solver.sampling_rate_hz = 2e4;
    scenario.gears.points_per_tooth = 2000;
    scenario.rig.damping_ratio = DampingRatio::Uniform(0.005);
    let error = simulate(&scenario).map(drop).unwrap_err();
    assert_eq!(error.key, "rig.damping_ratio");
    assert!(error.problem.starts_with("the motion grows without bound within 0."), "{error}");
}
