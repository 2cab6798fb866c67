//! Files of earlier versions.

use std::borrow::Cow;

/// The scenario that a file holds, as this version reads it: the first line of an earlier one's names its `convention`, which is
/// called `model` now.
///
/// # Arguments
/// * `scenario` - TOML, as [`meshtone::scenario::Scenario::to_toml`] of the version that wrote the file gave it
pub(crate) fn with_model(scenario: &str) -> Cow<'_, str> {
    const RENAMED: [(&str, &str); 2] = [
        ("convention = \"corrected\"\n", "model = \"linear\"\n"),
        ("convention = \"published\"\n", "model = \"published\"\n"),
    ];
    let rest = RENAMED.iter().find_map(|(line, model)| Some((scenario.strip_prefix(line)?, model)));
    rest.map_or(Cow::Borrowed(scenario), |(rest, model)| Cow::Owned([*model, rest].concat()))
}

#[cfg(test)]
mod tests {
    use super::with_model;

    #[test]
    fn only_the_first_line_is_renamed() {
        for (earlier, now) in [
            ("convention = \"corrected\"\nseed = 1\n", "model = \"linear\"\nseed = 1\n"),
            ("convention = \"published\"\nseed = 1\n", "model = \"published\"\nseed = 1\n"),
            ("model = \"linear\"\nseed = 1\n", "model = \"linear\"\nseed = 1\n"),
            ("seed = 1\nconvention = \"corrected\"\n", "seed = 1\nconvention = \"corrected\"\n"),
        ] {
            assert_eq!(with_model(earlier), now);
        }
    }
}
