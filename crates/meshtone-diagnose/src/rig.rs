//! The wheels of a rig.

use meshtone::scenario::Scenario;
use meshtone::wheel::WheelName;

/// A wheel of a rig.
#[derive(Debug, Clone, PartialEq)]
pub struct RigWheel {
    /// Its name.
    pub name: String,
    /// Teeth of the wheel.
    pub teeth: u32,
    /// Teeth of the other wheels on its shaft.
    pub beside_teeth: Vec<u32>,
    /// (-) Speed of its shaft over that of the shaft that drives.
    pub speed_ratio: f64,
}

/// The wheels of a rig, of a pair pinion and gear.
///
/// # Arguments
/// * `rig` - its scenario
pub fn rig_wheels(rig: &Scenario) -> Vec<RigWheel> {
    let pinion_teeth = f64::from(rig.gears.pinion_teeth);
    let wheel = |wheel: WheelName| {
        let teeth = rig.gears.teeth(wheel);
        RigWheel {
            name: wheel.name().to_owned(),
            teeth,
            beside_teeth: Vec::new(),
            speed_ratio: pinion_teeth / f64::from(teeth),
        }
    };
    WheelName::BOTH.map(wheel).into()
}
