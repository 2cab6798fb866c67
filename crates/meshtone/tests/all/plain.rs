//! Gearboxes without what makes them sound like one.

use meshtone::scenario::{HousingModes, Scenario};

/// A gearbox as other programs and references have it: without friction and random forces, in a rigid housing, lightly damped, and with wheels
/// whose teeth are mostly alike.
///
/// # Arguments
/// * `gearbox` - with its defaults
pub fn plain(mut gearbox: Scenario) -> Scenario {
    const DAMPING_RATIO: f64 = 0.02;
    gearbox.meshes.iter_mut().for_each(|mesh| (mesh.friction, mesh.random_force) = (0.0, 0.0));
    for wheel in &mut gearbox.wheels {
        (wheel.tooth_share, wheel.pitch_share) = (0.4, 0.15);
        (wheel.run_out_share, wheel.slope_wobble) = (0.3, 0.0);
    }
    gearbox.operation.torque_ripple.clear();
    if let Some(shafts) = gearbox.structure.shafts_mut() {
        shafts.shafts.iter_mut().for_each(|shaft| shaft.damping_ratio = DAMPING_RATIO);
        shafts.bearings.iter_mut().for_each(|bearing| bearing.damping_ratio = DAMPING_RATIO);
        if let Some(housing) = &mut shafts.housing {
            (housing.modes, housing.damping_ratio) = (HousingModes::RIGID, DAMPING_RATIO);
        }
    }
    gearbox
}
