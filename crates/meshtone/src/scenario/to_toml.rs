//! A scenario as TOML.

use super::{Fault, Scenario};
use crate::keys::{Keys, write_keys};

impl Scenario {
    /// The scenario as a scenario file that needs no other file: profile errors and profiles are
    /// written inline, defaults explicitly.
    ///
    /// A valid scenario is read back exactly by [`Scenario::from_toml`]. A seed above `i64::MAX` is
    /// read back by it too, but not by other TOML readers.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// let text = scenario.to_toml();
    /// assert!(text.starts_with("model = \"contact\"\nseed = 1\n"));
    /// assert_eq!(Scenario::from_toml(&text)?, scenario);
    /// # Ok::<(), meshtone::scenario::ScenarioError>(())
    /// ```
    pub fn to_toml(&self) -> String {
        self.in_sections(&Plain)
    }

    /// The file's text, each section in its own style.
    pub(super) fn in_sections(&self, style: &impl Style) -> String {
        let section = |name: &str, keys: String| match keys.as_str() {
            "" => String::new(),
            keys => format!("[{name}]\n{keys}"),
        };
        let mut sections = vec![
            style.keys(self),
            section("gears", style.keys(&self.gears)),
            section("operation", style.keys(&self.operation)),
            section("quality", style.keys(&self.quality)),
        ];
        let faults = style.entry_header("fault", self.faults.len());
        sections.extend(self.faults.iter().map(|fault| format!("{faults}\n{}", style.fault(fault))));
        if self.faults.is_empty() {
            sections.extend(style.without_faults());
        }
        sections.push(section("rig", style.keys(&self.rig)));
        let sensors = style.entry_header("sensor", self.sensors.len());
        sections.extend(self.sensors.iter().map(|sensor| format!("{sensors}\n{}", style.keys(sensor))));
        if self.sensors.is_empty() {
            sections.extend(style.without_sensors());
        }
        sections.push(section("solver", style.keys(&self.solver)));
        sections.retain(|text| !text.is_empty());
        sections.join("\n")
    }
}

/// Style in which the keys of a section are written.
pub(super) trait Style {
    fn keys<S: Keys>(&self, section: &S) -> String;
    fn fault(&self, fault: &Fault) -> String;
    /// Header above an entry of a list, by default one beside which others can be added.
    fn entry_header(&self, name: &str, _entries: usize) -> String {
        format!("[[{name}]]")
    }
    /// Text in place of faults, where nothing is broken.
    fn without_faults(&self) -> Option<String> {
        None
    }
    /// Text in place of sensors, where none is listed.
    fn without_sensors(&self) -> Option<String> {
        None
    }
}

/// Every key with its value.
struct Plain;

impl Style for Plain {
    fn keys<S: Keys>(&self, section: &S) -> String {
        write_keys(section)
    }

    fn fault(&self, fault: &Fault) -> String {
        fault.write()
    }

    /// A single one is a section like others, with keys without a number.
    fn entry_header(&self, name: &str, entries: usize) -> String {
        if entries > 1 { format!("[[{name}]]") } else { format!("[{name}]") }
    }
}
