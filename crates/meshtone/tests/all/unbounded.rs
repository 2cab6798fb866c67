//! Motions that grow without bound are errors, not signals.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{
    DampingRatio, Fault, FaultyTeeth, GearPair, MissingTooth, Model, Scenario, Wear, WheelName,
};
use meshtone::{Error, simulate};

/// Few teeth, one of them missing: for a part of each revolution no tooth is in contact. Next to no damping.
#[test]
fn contact_that_is_lost() {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: 10,
        gear_teeth: 11,
        pinion_speed_hz: 170.0,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.rig_mut().unwrap().pinion_shaft.radius_mm = 4.2;
    scenario.rig_mut().unwrap().gear_shaft.radius_mm = 4.2;
    scenario.faults = vec![Fault::on_first_gear_tooth(MissingTooth)];
    scenario.solver.sampling_rate_hz = 1e5;
    scenario.meshes[0].points_per_tooth = 2000;
    scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(0.0005);
    scenario.meshes[0].damping_ratio = 0.0;
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

// Nothing bears while many neighbours pass: more damping is no help, and the message says which faults take the teeth.
#[test]
fn neighbours_that_are_missing_are_named() {
    let pair = GearPair::example();
    let together = 20;
    let mut scenario = Scenario::new(pair);
    // Over the last tooth, too.
    scenario.faults = vec![
        Fault::new(WheelName::Gear, (1..together).collect::<Vec<_>>(), MissingTooth),
        Fault::new(WheelName::Pinion, 1, Wear { depth_um: 1.0 }),
        Fault::new(WheelName::Gear, 38, MissingTooth),
    ];
    let error = simulate(&scenario).map(drop).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains(&format!("{together} neighbouring teeth of the gear are missing (fault[0], fault[2])"))
            && text.contains("grows without bound within"),
        "{text}"
    );
    assert!(error.help().unwrap().contains("remove some of these faults"));
    let mut none = Scenario::new(pair);
    none.model = Model::Contact;
    none.faults = vec![Fault::new(WheelName::Gear, FaultyTeeth::All, MissingTooth)];
    let text = simulate(&none).map(drop).unwrap_err().to_string();
    assert!(
        text.contains("the faults leave no pair of teeth that could touch; at least one must be left"),
        "{text}"
    );
}
