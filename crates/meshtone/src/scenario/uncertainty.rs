//! How well the numbers of a rig are known.

use super::Scenario;

/// (-) Standard deviation of the logarithm of a number of the scenario file that is not known well of a rig whose drawings are at hand:
/// stiffnesses, frequencies, masses, spans, dampings, friction, random forces, tip chamfer, backlash and the clearance of rolling bearings, which
/// have no stiffness of their own; none of the others.
///
/// They are wide enough for the difference signals of the three rigs of arXiv:2410.05073 to be among those that are simulated; 15 % of the
/// stiffnesses alone are not.
///
/// # Arguments
/// * `base` - the rig's scenario
/// * `key` - dotted, as in the scenario file
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario, log_deviation};
///
/// let base = Scenario::new(GearPair::example());
/// assert_eq!(log_deviation(&base, "rig.support.base_hz"), Some(0.3));
/// assert_eq!(log_deviation(&base, "gears.module_mm"), None);
/// ```
pub fn log_deviation(base: &Scenario, key: &str) -> Option<f64> {
    const OF_PAIR: [(&str, f64); 16] = [
        ("rig.bearing_stiffness_n_per_m", 0.3),
        // A rig is given by these frequencies or by the stiffnesses; the others it does not have.
        ("rig.support.base_hz", 0.3),
        ("rig.support.differential_hz", 0.3),
        ("rig.support.stiffness_n_per_m", 0.6),
        ("rig.support.coupling_n_per_m", 0.6),
        ("rig.support.mass_kg", 0.3),
        ("rig.pinion_shaft.bearing_span_mm", 0.15),
        ("rig.gear_shaft.bearing_span_mm", 0.15),
        ("rig.support.damping_ratio", 0.5),
        ("rig.pinion_shaft.damping_ratio", 0.5),
        ("rig.gear_shaft.damping_ratio", 0.5),
        ("rig.mesh_damping_ratio", 0.5),
        ("gears.tip_chamfer_mm", 0.3),
        ("gears.pinion_tip_chamfer_mm", 0.3),
        ("gears.gear_tip_chamfer_mm", 0.3),
        ("gears.backlash_mm", 0.2),
    ];
    if let Some((_, deviation)) = OF_PAIR.into_iter().find(|(own, _)| *own == key) {
        return Some(deviation);
    }
    let is_of = |sections: &[&str]| sections.iter().any(|section| key.starts_with(section));
    match key.rsplit('.').next().unwrap_or(key) {
        "stiffness_n_per_m" if is_of(&["bearing["]) && !key.contains("].seat") => {
            (!is_of_rolling_bearing(base, key)).then_some(0.3)
        }
        // A clearance class of ISO 5753-1 goes from about half to twice its middle.
        "clearance_um" => is_of_rolling_bearing(base, key).then_some(0.4),
        "stiffness_n_per_m" if is_of(&["bearing[", "housing"]) => Some(0.6),
        "coupling_stiffness_nm_per_rad" => Some(0.6),
        "mass_kg" if is_of(&["bearing[", "housing"]) => Some(0.3),
        "damping_ratio" if is_of(&["shaft[", "bearing[", "mesh", "housing"]) => Some(0.5),
        // Measured coefficients go from 0.02 to 0.1, and recorded gearboxes fit random forces from 0.02 to 0.2.
        "friction" if is_of(&["mesh"]) => Some(0.35),
        "random_force" if is_of(&["mesh"]) => Some(0.6),
        "per_khz" | "first_hz" if is_of(&["housing.modes"]) => Some(0.35),
        "backlash_mm" if is_of(&["mesh"]) => Some(0.2),
        _ => None,
    }
}

/// Returns whether a key is that of a bearing with balls or rollers.
fn is_of_rolling_bearing(base: &Scenario, key: &str) -> bool {
    let Some((name, _)) = key.strip_prefix("bearing[").and_then(|rest| rest.split_once(']')) else {
        return false;
    };
    let bearing = match name.parse::<usize>() {
        Ok(number) => base.bearings().get(number),
        Err(_) => base.bearings().iter().find(|bearing| bearing.seat_name() == name),
    };
    bearing.is_some_and(|bearing| bearing.element().is_some())
}
