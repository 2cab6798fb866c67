//! Words for numbers and columns.

use meshtone_plot::without_unit;

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

/// Writes a column's name in words, with its unit: `pinion speed (Hz)`.
pub(crate) fn words_of(name: &str) -> String {
    let (bare, unit) = without_unit(name);
    let bare = bare.strip_prefix("latent_").unwrap_or(bare);
    let words = bare.strip_prefix("noise_").unwrap_or(bare).split('_').map(|word| match word {
        "snr" => "signal to noise",
        "iso" => "ISO",
        "din" => "DIN",
        other => other,
    });
    let words = words.collect::<Vec<_>>().join(" ");
    if unit.is_empty() { words } else { format!("{words} ({unit})") }
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
