//! Ready-made rules: what is not known of a rig.

use meshtone::scenario::{Scenario, ScenarioNumber, log_deviation, split_key};
use meshtone_toml::named;

use super::{Distribution, Level, Rule};
use crate::draw::PATH_KEYS;

/// What is known of the rig that a data set is about, and so what varies in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variation {
    /// The rig and the path to its sensor are known; its mounting and its operation scatter.
    KnownRig,
    /// The path from the gears to the sensor is not known either.
    KnownRigUnknownPath,
    /// Neither are the rig's stiffnesses, masses and dampings.
    UnknownRig,
}

named!(Variation {
    KnownRig = "known-rig",
    KnownRigUnknownPath = "known-rig-unknown-path",
    UnknownRig = "unknown-rig",
});

/// (-) Half of the range of a uniform number over its standard deviation.
const HALF_RANGE: f64 = 1.732_050_807_568_877_2;

impl Variation {
    /// The rules that it stands for, of keys that the base scenario has.
    ///
    /// Speed and torque scatter by record about those of the base scenario, the damping of the mesh, which the oil's temperature changes, too.
    /// Eccentricity and misalignment scatter by mounting, as does an unknown path. What is not known of the rig scatters by unit, uniformly
    /// in the logarithm, with the standard deviation of [`log_deviation`].
    ///
    /// # Arguments
    /// * `base` - the base scenario
    pub fn rules(self, base: &Scenario) -> Vec<Rule> {
        let mut rules: Vec<Rule> = Vec::new();
        let is_unknown_rig = self == Self::UnknownRig;
        let numbers = base.numbers();
        for number in &numbers {
            let (key, value) = (number.key.as_str(), number.value);
            // What turns the other way round has no logarithm.
            let about = |factor: f64| match value < 0.0 {
                true => Distribution::Uniform([value * factor, value / factor]),
                false => Distribution::LogUniform([value / factor, value * factor]),
            };
            let rule = match (key, split_key(key).1.unwrap_or_default()) {
                ("operation.pinion_speed_hz" | "operation.input_speed_hz", _) => {
                    Some((Level::Record, about(if is_unknown_rig { 1.1 } else { 1.02 })))
                }
                ("operation.brake_torque_nm", _) => {
                    Some((Level::Record, about(if is_unknown_rig { 1.5 } else { 1.05 })))
                }
                ("rig.eccentricity_mm", _) => {
                    Some((Level::Mounting, Distribution::Uniform([value, value + 0.02])))
                }
                ("rig.misalignment_um", _) => {
                    Some((Level::Mounting, Distribution::Uniform([value - 10.0, value + 10.0])))
                }
                // The oil's temperature changes it.
                ("rig.mesh_damping_ratio", _) if !is_unknown_rig => Some((Level::Record, about(1.3))),
                (_, "damping_ratio") if !is_unknown_rig && key.starts_with("mesh[") => {
                    Some((Level::Record, about(1.3)))
                }
                // One of the two is 0: the other one counts.
                (_, "din_grade" | "iso_class") if is_unknown_rig && value > 0.0 => {
                    Some((Level::Unit, neighbours(base, number)))
                }
                _ => log_deviation(base, key)
                    .filter(|_| is_unknown_rig)
                    .map(|deviation| (Level::Unit, about((HALF_RANGE * deviation).exp()))),
            };
            // A torque of 0 has no logarithm.
            let rule =
                rule.filter(|(_, of)| !matches!(of, Distribution::LogUniform([least, _]) if *least <= 0.0));
            rules.extend(rule.map(|(level, distribution)| one(key, level, distribution)));
        }
        if self != Self::KnownRig {
            let [gain_db, ripple_db, plate_hz, strength] = PATH_KEYS;
            let gain = Distribution::Normal { mean: 0.0, standard_deviation: 6.0, within: [-18.0, 18.0] };
            rules.push(one(gain_db, Level::Mounting, gain));
            rules.push(one(ripple_db, Level::Mounting, Distribution::Fixed(2.0)));
            rules.push(one(plate_hz, Level::Mounting, Distribution::LogUniform([1.7e3, 9.5e3])));
            rules.push(one(strength, Level::Mounting, Distribution::LogUniform([0.1, 0.4])));
        }
        rules
    }
}

fn one(key: &str, level: Level, distribution: Distribution) -> Rule {
    Rule { keys: vec![key.to_owned()], level, distribution, times: None, plus: None }
}

/// A grade, the next finer one and the next coarser one; itself instead of one that the key does not allow, and of 0, which is no grade.
fn neighbours(base: &Scenario, grade: &ScenarioNumber) -> Distribution {
    let is_allowed = |value: f64| value >= 1.0 && base.with_numbers(&[(&grade.key, value)]).is_ok();
    let values = [-1.0, 0.0, 1.0].map(|step| grade.value + step);
    let row = |value| vec![if is_allowed(value) { value } else { grade.value }];
    Distribution::Choice { rows: values.map(row).to_vec(), weights: vec![1.0; values.len()] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::scenario::{Bearing, BearingKind, GearPair, Operation, Scenario};

    /// Springs vary by their stiffness; balls and rollers, which have no such key in effect, vary by their clearance.
    #[test]
    fn rolling_bearings_vary_by_their_clearance() {
        let mut bearings: Vec<Bearing> = [0.0, 1.0, 1.0].map(|at| Bearing::new("input", at)).to_vec();
        bearings[0].kind = BearingKind::Ball;
        bearings[2].kind = BearingKind::Roller;
        let operation = Operation::new(25.0, 10.0);
        let base = Scenario::of_shafts(vec![], vec![], vec![], bearings, operation);
        let rules = Variation::UnknownRig.rules(&base);
        let of = |end: &str| -> Vec<&str> {
            let keys = rules.iter().map(|rule| rule.keys[0].as_str());
            keys.filter(|key| key.starts_with("bearing[") && key.ends_with(end) && !key.contains("seat"))
                .collect()
        };
        // Two bearings at one place have their numbers as names.
        assert_eq!(of("].clearance_um"), ["bearing[input:0].clearance_um", "bearing[2].clearance_um"]);
        assert_eq!(of("].stiffness_n_per_m"), ["bearing[1].stiffness_n_per_m"]);
        assert_eq!(of("].damping_ratio").len(), 3);
    }

    #[test]
    fn grades_stay_within_the_range_of_their_key() {
        let of = |key: &str, value: f64| {
            let base = Scenario::new(GearPair::example()).with_number(key, value).unwrap();
            let number = base.numbers().into_iter().find(|number| number.key == key).unwrap();
            neighbours(&base, &number).rows().concat()
        };
        assert_eq!(of("quality.din_grade", 12.0), [11.0, 12.0, 12.0]);
        assert_eq!(of("quality.iso_class", 11.0), [10.0, 11.0, 11.0]);
        assert_eq!(of("quality.din_grade", 1.0), [1.0, 1.0, 2.0]);
        assert_eq!(of("quality.iso_class", 6.0), [5.0, 6.0, 7.0]);
    }

    #[test]
    fn torque_that_drives_varies_as_one_that_brakes() {
        let torque = |brake_torque_nm: f64| {
            let base = Scenario::new(GearPair { brake_torque_nm, ..GearPair::example() });
            let mut rules = Variation::KnownRig.rules(&base).into_iter();
            rules.find(|rule| rule.keys == ["operation.brake_torque_nm"]).map(|rule| rule.distribution)
        };
        assert_eq!(torque(10.0), Some(Distribution::LogUniform([10.0 / 1.05, 10.5])));
        assert_eq!(torque(-10.0), Some(Distribution::Uniform([-10.5, -10.0 / 1.05])));
        assert_eq!(torque(0.0), None);
    }
}
