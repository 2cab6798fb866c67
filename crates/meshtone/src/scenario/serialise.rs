//! A scenario in any self-describing format that serde knows, such as JSON, with the sections and keys of the scenario file.

use serde::de::Error as _;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Scenario;

/// The sections and keys of the scenario file; nothing refers to another file. As in a scenario file, seeds above 2⁶³ − 1 cannot be
/// written: an error.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let scenario = Scenario::new(GearPair::example());
/// let json = serde_json::to_value(&scenario)?;
/// assert_eq!(json["gears"]["pinion_teeth"], 17);
/// assert_eq!(serde_json::from_value::<Scenario>(json)?, scenario);
/// # Ok::<(), serde_json::Error>(())
/// ```
impl Serialize for Scenario {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let sections: toml::Table = self.to_toml().parse().map_err(S::Error::custom)?;
        sections.serialize(serializer)
    }
}

/// A missing key has its default; an error names key and value, as for a file.
impl<'de> Deserialize<'de> for Scenario {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let sections = toml::Table::deserialize(deserializer)?;
        let text = toml::to_string(&sections).map_err(D::Error::custom)?;
        // Lines would be those of a text that nobody has seen.
        Self::from_toml(&text).map_err(|error| D::Error::custom(error.at_line(None)))
    }
}
