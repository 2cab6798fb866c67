//! The gallery's scenarios, which open with one click.

/// A scenario to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Name of its file, without the ending.
    pub name: &'static str,
    /// Description, in a few words.
    pub title: &'static str,
    /// The scenario file.
    pub toml: &'static str,
}

/// One row a scenario. They are the examples, which stand here too so that a package holds all that it needs; a file that one of them
/// names is written out. A test compares them.
macro_rules! presets {
    ($($name:literal $title:literal;)+) => {
        /// The scenarios to start from, the healthy one first.
        ///
        /// ```
        /// let presets = meshtone_explore::presets();
        /// assert_eq!(presets[0].name, "healthy");
        /// ```
        pub fn presets() -> Vec<Preset> {
            vec![$(Preset { name: $name, title: $title, toml: include_str!(concat!("presets/", $name, ".toml")) }),+]
        }
    };
}

presets! {
    "healthy" "Healthy";
    "contact" "Healthy, every measure given";
    "missing_tooth" "Missing tooth";
    "tooth_breakage" "Tooth breakage";
    "root_crack" "Root crack";
    "partial_face" "Pit over a part of the face";
    "through_face" "Pit over the whole face";
    "pits" "Several pits";
    "tooth_destruction" "Ground flank";
    "wear" "Wear of all teeth";
    "several_faults" "Several faults";
    "profile_shift" "Shifted profiles";
    "helical" "Helical teeth";
    "sensors" "Three sensors";
}

#[cfg(test)]
mod tests {
    use meshtone::scenario::Scenario;
    use meshtone_io::scenario_file::ScenarioFile;

    use super::*;

    #[test]
    fn presets_are_the_examples() {
        let examples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        for preset in presets() {
            let example =
                ScenarioFile::read(&examples.join(format!("{}.toml", preset.name))).unwrap().scenario;
            let own = Scenario::from_toml(preset.toml).unwrap();
            assert_eq!(own, example, "copy examples/{}.toml to src/presets", preset.name);
        }
    }
}
