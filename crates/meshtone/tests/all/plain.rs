//! Gearboxes without what makes them sound like one.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{BodyRotation, HousingModes, Scenario};

/// A template as other programs and references have it: without friction and random forces, in a rigid housing, lightly damped, with wheels
/// whose teeth are mostly alike and whose bodies turn with each pair of teeth, on shafts so slender that the load is at one end of the faces.
///
/// # Arguments
/// * `gearbox` - a template
pub fn plain(mut gearbox: Scenario) -> Scenario {
    const DAMPING_RATIO: f64 = 0.02;
    for mesh in &mut gearbox.meshes {
        (mesh.friction, mesh.random_force) = (0.0, 0.0);
        mesh.foundation.rotation = BodyRotation::Tooth;
    }
    gearbox.operation.brake_torque_nm = 20.0;
    for wheel in &mut gearbox.wheels {
        (wheel.tooth_share, wheel.pitch_share) = (0.4, 0.15);
        (wheel.run_out_share, wheel.slope_wobble) = (0.3, 0.0);
        wheel.iso_class = if wheel.iso_class == 0 { 0 } else { 6 };
    }
    gearbox.operation.torque_ripple.clear();
    gearbox.operation.speed_wander_percent = 0.0;
    if let Some(shafts) = gearbox.structure.shafts_mut() {
        for shaft in &mut shafts.shafts {
            (shaft.radius_mm, shaft.damping_ratio) = (Some(7.9375), DAMPING_RATIO);
            shaft.segments.clear();
        }
        shafts.bearings.iter_mut().for_each(|bearing| bearing.damping_ratio = DAMPING_RATIO);
        if let Some(housing) = &mut shafts.housing {
            (housing.modes, housing.damping_ratio) = (HousingModes::RIGID, DAMPING_RATIO);
        }
    }
    gearbox
}

/// The same with meshes that bear evenly on such shafts under the nominal torque: the wheels' helices take back the lean of the shafts, as a misalignment
/// does. They have one unknown each then, as the programs have them that figures are from.
///
/// # Arguments
/// * `gearbox` - with its torque and its teeth
#[allow(dead_code)] // Not in every package that has this file.
pub fn even(mut gearbox: Scenario) -> Scenario {
    let leans_um =
        meshtone::stages(&gearbox).unwrap().meshes.into_iter().map(|mesh| mesh.along_face.lean_m * 1e6);
    gearbox.meshes.iter_mut().zip(leans_um).for_each(|(mesh, lean_um)| mesh.misalignment_um -= lean_um);
    gearbox
}
