//! A pair in a rig as TOML.

use super::short::{self, Section};
use super::{Fault, Scenario, Sensor};
use crate::keys::{KeyRow, Keys, write_rows};

impl Scenario {
    /// The file's text, each section in its own style.
    pub(super) fn in_sections(&self, style: &impl Style) -> String {
        let start = Self::start_of_rig();
        let section = |Section { name, rows }: Section| match style.keys(&rows, self, &start, name).as_str() {
            keys if keys.is_empty() || name.is_empty() => keys.to_owned(),
            keys => format!("[{name}]\n{keys}"),
        };
        let mut sections = vec![
            section(short::top()),
            section(short::gears()),
            section(short::operation()),
            section(short::quality()),
        ];
        let faults = style.entry_header("fault", self.faults.len());
        sections.extend(self.faults.iter().map(|fault| format!("{faults}\n{}", style.fault(fault))));
        if self.faults.is_empty() {
            sections.extend(style.without_faults());
        }
        sections.push(section(short::rig()));
        let header = style.entry_header("sensor", self.sensors.len());
        let (rows, start_of_sensor) = (Sensor::rows(), Sensor::start());
        let sensor = |of: &Sensor| format!("{header}\n{}", style.keys(&rows, of, &start_of_sensor, "sensor"));
        sections.extend(self.sensors.iter().map(sensor));
        if self.sensors.is_empty() {
            sections.extend(style.without_sensors());
        }
        sections.push(section(short::solver()));
        sections.retain(|text| !text.is_empty());
        sections.join("\n")
    }
}

/// Style in which the keys of a section are written.
pub(super) trait Style {
    /// Some keys of a section.
    ///
    /// # Arguments
    /// * `rows` - the keys
    /// * `section`, `start` - the section, and the one with its defaults
    /// * `name` - its name
    fn keys<S>(&self, rows: &[KeyRow<S>], section: &S, start: &S, name: &str) -> String;
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
pub(super) struct Plain;

impl Style for Plain {
    fn keys<S>(&self, rows: &[KeyRow<S>], section: &S, _: &S, _: &str) -> String {
        write_rows(rows, section)
    }

    fn fault(&self, fault: &Fault) -> String {
        fault.write()
    }

    /// A single one is a section like others, with keys without a number.
    fn entry_header(&self, name: &str, entries: usize) -> String {
        if entries > 1 { format!("[[{name}]]") } else { format!("[{name}]") }
    }
}
