//! A column's name and unit, as its header says them.

use meshtone::sensor::Channel;

use super::unit::{is_unit, seconds_in};
use crate::printable::printable;

/// What a file says about a column before its samples are read.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Label {
    /// As the file has it.
    pub raw: String,
    /// Without the unit in brackets.
    pub name: String,
    pub unit: Option<String>,
    /// The array that the column is one of several of.
    pub array: Option<String>,
    /// What the column holds, where that is no real numbers.
    pub not_numeric: Option<String>,
    /// Whether it is 0 throughout and another column has its name: only its number chooses it.
    pub is_zero_twin: bool,
    /// Whether it holds times of the clock, which are read as seconds.
    pub is_clock: bool,
    /// Of an array, its samples.
    pub samples: Option<u64>,
}

/// Names of columns that count samples.
const COUNTERS: [&str; 10] =
    ["index", "sample", "samples", "sample_no", "sample_number", "n", "no", "nr", "#", "column_1"];
/// Unit suffixes of a time's name.
const TIME_SUFFIXES: [&str; 7] = ["s", "sec", "ms", "us", "µs", "ns", "min"];

impl Label {
    /// From a header such as `acceleration [g]`, `voltage (mV)` or `time_s`.
    pub(super) fn from_header(header: &str) -> Label {
        let plain = Label::plain(header.trim());
        let raw = plain.raw.clone();
        match split_unit(&raw) {
            Some((name, unit)) => Label { name: name.to_string(), unit: unit.map(str::to_string), ..plain },
            None => plain,
        }
    }

    /// From a name without a unit in brackets; that of a [channel](meshtone::sensor::Channel) of Meshtone ends with its unit. Control
    /// characters, which no recorder writes, would forge lines of messages and are escaped.
    pub(super) fn plain(name: &str) -> Label {
        let name = &printable(name, &[]);
        let unit = Channel::named(name).map(|channel| channel.unit().to_owned());
        let (raw, name) = (name.to_string(), name.to_string());
        Label { raw, name, unit, ..Label::default() }
    }

    /// Of a column that has no name: a word and its number, counted from 1.
    pub(super) fn numbered(word: &str, number: usize) -> Label {
        Label::from_header(&format!("{word} {number}"))
    }

    /// (s) One unit of the column's times, if its name says that it holds time.
    pub(super) fn time_unit_s(&self) -> Option<f64> {
        if self.is_clock {
            return Some(1.0);
        }
        let (word, suffix) = self.time_word();
        match word.as_str() {
            "time" | "times" | "t" | "zeit" | "temps" | "tempo" | "tiempo" | "tijd" | "tid" | "czas"
            | "timestamp" | "timestamps" | "time_stamp" | "elapsed_time" | "elapsed" | "seconds" | "sec"
            | "zeitstempel" | "relative_time" | "sample_time" | "x_value" => {}
            _ => return None,
        }
        // `T` is rather a temperature or a torque.
        let capital = self.last_part() == "T" && self.unit.is_none();
        let unit = self.unit.clone().or(suffix).filter(|unit| !unit.is_empty());
        if capital { None } else { unit.map_or(Some(1.0), |unit| seconds_in(&unit)) }
    }

    /// (s) One unit of the column's times, if the user says that it holds time; `None` where its unit is none of
    /// time.
    pub(super) fn chosen_time_unit_s(&self) -> Option<f64> {
        let unit = self.unit.clone().or(self.time_word().1);
        unit.map_or(Some(1.0), |unit| seconds_in(&unit))
    }

    /// Whether the unit of the column's times is stated.
    pub(super) fn states_time_unit(&self) -> bool {
        let (word, suffix) = self.time_word();
        self.is_clock || self.unit.is_some() || suffix.is_some() || matches!(word.as_str(), "seconds" | "sec")
    }

    /// Whether it holds the times of another column by its name: `t_speed` or `speed_time` those of `speed`.
    pub(super) fn is_time_of(&self, other: &Label) -> bool {
        let (own, other) = (self.last_part().to_lowercase(), other.last_part().to_lowercase());
        let rest = own.strip_prefix(&other).or_else(|| own.strip_suffix(&other));
        matches!(rest, Some("_t" | "_time" | "t_" | "time_"))
    }

    /// The path before the last part.
    pub(super) fn parent(&self) -> &str {
        self.name.rsplit_once('.').map_or("", |(parent, _)| parent)
    }

    /// Whether its name is that of a column that counts samples.
    pub(super) fn is_named_as_counter(&self) -> bool {
        COUNTERS.contains(&self.time_word().0.as_str())
    }

    /// Whether it is the value over an axis, as LabVIEW names columns: `X_Value`.
    pub(super) fn is_value_of(&self, axis: &str) -> bool {
        self.time_word().0.strip_suffix("_value") == Some(axis)
    }

    /// The last part of a dotted path.
    pub(super) fn last_part(&self) -> &str {
        self.name.rsplit('.').next().unwrap_or(&self.name)
    }

    /// The name in small letters without a suffix that is a unit of time, and that suffix.
    fn time_word(&self) -> (String, Option<String>) {
        let word = self.last_part().trim().to_lowercase().replace([' ', '-'], "_");
        let split = word.rsplit_once('_').filter(|(_, suffix)| TIME_SUFFIXES.contains(suffix));
        match split {
            Some((start, suffix)) => (start.to_string(), Some(suffix.to_string())),
            None => (word, None),
        }
    }
}

/// `name [unit]`, always; `name (unit)`, where the word in parentheses is a unit.
fn split_unit(raw: &str) -> Option<(&str, Option<&str>)> {
    let bracketed = |open: char, close: char| {
        let (name, unit) = raw.strip_suffix(close)?.rsplit_once(open)?;
        Some((name.trim_end(), unit.trim()))
    };
    let (name, unit) = bracketed('[', ']')
        .or_else(|| {
            bracketed('(', ')').filter(|(_, unit)| unit.is_empty() || (!unit.contains(')') && is_unit(unit)))
        })
        .or_else(|| parenthesised_with_inner(raw))?;
    (!name.is_empty()).then_some((name, Some(unit).filter(|unit| !matches!(*unit, "" | "-"))))
}

/// `name (N/(m/s))`: the outer parentheses.
fn parenthesised_with_inner(raw: &str) -> Option<(&str, &str)> {
    let (name, unit) = raw.strip_suffix(')')?.split_once('(')?;
    is_unit(unit).then_some((name.trim_end(), unit.trim()))
}

/// The unit that a cell of a unit row says.
pub(super) fn unit_of_cell(cell: &str) -> Option<String> {
    let cell = cell.trim();
    let inner = |open: char, close: char| cell.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
    let unit = inner('[', ']').or_else(|| inner('(', ')')).unwrap_or(cell).trim();
    (!matches!(unit, "" | "-")).then(|| unit.to_string())
}

#[cfg(test)]
mod tests {
    use super::{Label, unit_of_cell};

    fn split(header: &str) -> (String, Option<String>) {
        let label = Label::from_header(header);
        (label.name, label.unit)
    }

    #[test]
    fn units_are_split_from_names() {
        let expect = |name: &str, unit: Option<&str>| (name.to_string(), unit.map(str::to_string));
        assert_eq!(split("acc [m/s²]"), expect("acc", Some("m/s²")));
        assert_eq!(split(" acc (mV) "), expect("acc", Some("mV")));
        assert_eq!(split("acc (horizontal)"), expect("acc (horizontal)", None));
        assert_eq!(split("acc (horizontal) [g]"), expect("acc (horizontal)", Some("g")));
        assert_eq!(split("damping (N/(m/s))"), expect("damping", Some("N/(m/s)")));
        assert_eq!(split("count [-]"), expect("count", None));
        assert_eq!(split("[g]"), expect("[g]", None));
        assert_eq!(unit_of_cell("[g]").as_deref(), Some("g"));
        assert_eq!(unit_of_cell("-"), None);
    }

    #[test]
    fn time_is_known_by_its_name() {
        let unit = |header: &str| Label::from_header(header).time_unit_s();
        for seconds in [
            "time",
            "t",
            "time_s",
            "Time [s]",
            "Zeit",
            "TIME (s)",
            "run.t",
            "Elapsed time",
            "t [s]",
            "T [s]",
            "X_Value",
            "elapsed_s",
        ] {
            assert_eq!(unit(seconds), Some(1.0), "{seconds}");
        }
        assert_eq!(unit("time_ms"), Some(1e-3));
        assert_eq!(unit("Zeit [µs]"), Some(1e-6));
        for other in ["T", "torque", "time [samples]", "uptime", "acceleration"] {
            assert_eq!(unit(other), None, "{other}");
        }
    }
}
