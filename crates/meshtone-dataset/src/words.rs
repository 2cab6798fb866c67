//! Words for numbers, units and columns.

/// Writes a count with its noun: `1 shard`, `2 shards`.
///
/// # Arguments
/// * `count` - the count
/// * `name` - the noun in the singular
///
/// ```
/// assert_eq!(meshtone_dataset::counted(1, "shard"), "1 shard");
/// ```
pub fn counted(count: u64, name: &str) -> String {
    format!("{count} {name}{}", if count == 1 { "" } else { "s" })
}

/// Endings of names that state a unit, and the unit.
const UNITS: [(&str, &str); 14] = [
    ("_n_per_m", "N/m"),
    ("_nm_per_rad", "N m/rad"),
    ("_kgm2", "kg m²"),
    ("_mm", "mm"),
    ("_um", "µm"),
    ("_g_per_rthz", "g/√Hz"),
    ("_per_cm2", "1/cm²"),
    ("_hz", "Hz"),
    ("_nm", "N m"),
    ("_deg", "°"),
    ("_kg", "kg"),
    ("_db", "dB"),
    ("_g", "g"),
    ("_s", "s"),
];

/// The unit that the ending of a name states.
pub(crate) fn unit_of(name: &str) -> &'static str {
    UNITS.iter().find(|(end, _)| name.ends_with(end)).map_or("-", |(_, unit)| unit)
}

/// A column's name in words, with its unit: `pinion speed (Hz)`.
pub(crate) fn words_of(name: &str) -> String {
    let with_unit = UNITS.iter().find_map(|(end, unit)| Some((name.strip_suffix(end)?, *unit)));
    let (bare, unit) = with_unit.unwrap_or((name, ""));
    let bare = bare.strip_prefix("latent_").unwrap_or(bare);
    let words: Vec<&str> = bare
        .strip_prefix("noise_")
        .unwrap_or(bare)
        .split('_')
        .map(|word| match word {
            "snr" => "signal to noise",
            "iso" => "ISO",
            "din" => "DIN",
            other => other,
        })
        .collect();
    if unit.is_empty() { words.join(" ") } else { format!("{} ({unit})", words.join(" ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_in_words() {
        for (name, words) in [
            ("pinion_speed_hz", "pinion speed (Hz)"),
            ("fault_2_start", "fault 2 start"),
            ("bearing_stiffness_n_per_m", "bearing stiffness (N/m)"),
            ("latent_specific_load", "specific load"),
            ("noise_snr_db", "signal to noise (dB)"),
            ("iso_class", "ISO class"),
        ] {
            assert_eq!(words_of(name), words);
        }
    }
}
