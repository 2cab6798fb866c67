//! Keys of the scenario file in words and units.

use crate::drawing::number;
use crate::without_unit;

/// Sections whose name says nothing beside that of the key.
const SECTIONS: [&str; 6] = ["fault", "gears", "operation", "quality", "rig", "solver"];

/// A key and its value: `rig.support.stiffness_n_per_m` and 8e7 are `support stiffness 8.00e7 N/m`.
///
/// # Arguments
/// * `key` - dotted, as in the scenario file
/// * `value` - of that key
pub(super) fn in_words(key: &str, value: f64) -> String {
    if key == "quality.seed" {
        return format!("seed of the wheels {}", number(value));
    }
    let section = SECTIONS.iter().find_map(|section| key.strip_prefix(section)?.strip_prefix('.'));
    let name = section.unwrap_or(key);
    let (name, unit) = without_unit(name);
    let words = name.replace(['.', '_'], " ");
    let gap = if unit.is_empty() || unit == "°" { "" } else { " " };
    format!("{words} {}{gap}{unit}", number(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use meshtone::scenario::sections;

    #[test]
    fn sections_and_units_are_words() {
        for (key, value, words) in [
            ("seed", 7.0, "seed 7"),
            ("quality.seed", 3.0, "seed of the wheels 3"),
            ("rig.damping_ratio", 0.034, "damping ratio 0.034"),
            ("rig.support.stiffness_n_per_m", 8e7, "support stiffness 8.00e7 N/m"),
            ("fault.chip_width_mm", 7.25, "chip width 7.25 mm"),
            ("gears.pressure_angle_deg", 20.0, "pressure angle 20°"),
        ] {
            assert_eq!(in_words(key, value), words);
        }
    }

    #[test]
    fn every_key_with_a_unit_is_named_with_one() {
        let mut tested = 0;
        for section in sections() {
            for key in section.keys.iter().filter(|key| !["", "-"].contains(&key.unit)) {
                // Text of several units, and a table's.
                if key.unit.contains(',') {
                    continue;
                }
                let words = in_words(&key.key, 1.0);
                assert!(!words.ends_with('1'), "{}: {words}", key.key);
                tested += 1;
            }
        }
        assert!(tested > 30);
    }
}
