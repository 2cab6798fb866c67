//! Errors about a text.

use std::fmt;

/// Kind of a mistake, for programs; people read [`TomlError::problem`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The text is not TOML.
    NotToml,
    /// A key that has no default is absent.
    MissingKey,
    /// There is no such key.
    UnknownKey,
    /// The value is of another type than the key's.
    WrongType,
    /// The value breaks a rule, alone or beside others.
    NotAllowed,
}

/// A key of a TOML text that cannot be read or that breaks a rule: which key, what it says, what is allowed.
///
/// ```
/// use meshtone_toml::{ErrorKind, TomlDocument, TomlTable};
///
/// let document = TomlDocument::parse("[motor]\nspeed_hz = \"fast\"\n")?;
/// let speed = |motor: &TomlTable| motor.required("speed_hz", "(rev/s) speed")?.number();
/// let error = document.root().table_or_empty("motor")?.read(speed).unwrap_err();
/// assert_eq!((error.kind, error.key.as_str(), error.line), (ErrorKind::WrongType, "motor.speed_hz", Some(2)));
/// assert_eq!(error.to_string(), "line 2: motor.speed_hz = \"fast\": must be a number, not text");
/// # Ok::<(), meshtone_toml::TomlError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TomlError {
    /// Kind of the mistake.
    pub kind: ErrorKind,
    /// Dotted key, for example `motor.speed_hz`, or `motor.weights[2]` for the third entry of an array. Empty where
    /// the text is not TOML.
    pub key: String,
    /// The offending value as it was given; empty where a key is missing.
    pub value: String,
    /// The problem, and what is allowed.
    pub problem: String,
    /// Advice, where `problem` does not make it plain.
    pub help: Option<String>,
    /// 1-based line in the text.
    pub line: Option<usize>,
}

impl std::error::Error for TomlError {}

impl fmt::Display for TomlError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(formatter, "line {line}: ")?;
        }
        let place = self.place_in_words().map(|place| format!(" ({place})")).unwrap_or_default();
        match (self.key.as_str(), self.value.as_str()) {
            ("", "") => {}
            ("", value) => write!(formatter, "{value}: ")?,
            (key, "") => write!(formatter, "{key}{place}: ")?,
            (key, value) => write!(formatter, "{key} = {value}{place}: ")?,
        }
        formatter.write_str(&self.problem)
    }
}

impl TomlError {
    /// An error about `key`, whose `value` breaks a rule: [`ErrorKind::NotAllowed`].
    ///
    /// # Arguments
    /// * `key` - dotted key
    /// * `value` - the value as given; empty where it is missing
    /// * `problem` - what is wrong and what is allowed
    pub fn new(key: impl Into<String>, value: impl ToString, problem: impl Into<String>) -> Self {
        let (key, value, problem) = (key.into(), value.to_string(), problem.into());
        Self { kind: ErrorKind::NotAllowed, key, value, problem, help: None, line: None }
    }

    /// Tables of lists that hold the key, as people count: `the 2nd fault` for `fault[1].tooth`, `the 1st vary of the 3rd class`
    /// for `class[2].vary[0].key`. None where it is in no list.
    fn place_in_words(&self) -> Option<String> {
        let segments: Vec<&str> = self.key.split('.').collect();
        // What the key itself is a number of is a table only where it has no value, or one in braces.
        let is_table = self.value.is_empty() || self.value.starts_with('{');
        let tables = if is_table { &segments[..] } else { &segments[..segments.len() - 1] };
        let words: Vec<String> = tables.iter().rev().filter_map(|segment| entry_in_words(segment)).collect();
        (!words.is_empty()).then(|| words.join(" of "))
    }

    /// An error about `NAME.…` as one about that entry of the list of that name.
    ///
    /// # Arguments
    /// * `name` - the list's: `fault` or `sensor`
    /// * `index` - which of its entries, from 0
    /// * `entries` - how many there are; a single one needs no number
    pub fn in_entry(mut self, name: &str, index: usize, entries: usize) -> Self {
        if let Some(rest) = self.key.strip_prefix(name).filter(|_| entries > 1) {
            self.key = format!("{name}[{index}]{rest}");
            self.problem = with_number(&self.problem, name, index);
            self.help = self.help.map(|help| with_number(&help, name, index));
        }
        self
    }

    /// Returns the error with another kind.
    ///
    /// # Arguments
    /// * `kind` - what kind of thing is wrong
    pub fn of_kind(mut self, kind: ErrorKind) -> Self {
        self.kind = kind;
        self
    }

    /// Returns the error with advice.
    ///
    /// # Arguments
    /// * `help` - what the user can do
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Returns the error at a line of the text.
    ///
    /// # Arguments
    /// * `line` - 1-based line, where known
    pub fn at_line(mut self, line: Option<usize>) -> Self {
        self.line = line;
        self
    }

    /// Returns the error under another key, as of a table that stands within another text.
    ///
    /// # Arguments
    /// * `key` - dotted key
    pub fn with_key(mut self, key: impl Into<String>) -> Self {
        self.key = key.into();
        self
    }
}

/// A text about one of several entries of a list, whose keys `NAME.…` get its number.
fn with_number(text: &str, name: &str, index: usize) -> String {
    let end = format!("{name}.");
    let mut parts = text.split(&end);
    let mut numbered = parts.next().unwrap_or_default().to_owned();
    for rest in parts {
        // A sentence may end with the word.
        let is_key = rest.starts_with(|letter: char| letter.is_ascii_lowercase());
        numbered += &if is_key { format!("{name}[{index}].") } else { end.clone() };
        numbered += rest;
    }
    numbered
}

/// `the 2nd fault` for `fault[1]`.
fn entry_in_words(segment: &str) -> Option<String> {
    let (name, index) = segment.strip_suffix(']')?.split_once('[')?;
    let number = index.parse::<u64>().ok()?.checked_add(1)?;
    let end = match (number % 10, number % 100) {
        (1, hundred) if hundred != 11 => "st",
        (2, hundred) if hundred != 12 => "nd",
        (3, hundred) if hundred != 13 => "rd",
        _ => "th",
    };
    let one = name.strip_suffix('s').filter(|one| !one.ends_with('s')).unwrap_or(name);
    Some(format!("the {number}{end} {one}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_of_lists_are_counted_as_people_do() {
        let message = |key: &str, value: &str| TomlError::new(key, value, "no").to_string();
        assert_eq!(message("fault[1].tooth", "39"), "fault[1].tooth = 39 (the 2nd fault): no");
        assert_eq!(message("fault[0]", ""), "fault[0] (the 1st fault): no");
        assert_eq!(
            message("class[2].vary[11].key", ""),
            "class[2].vary[11].key (the 12th vary of the 3rd class): no"
        );
        assert_eq!(message("constraints[22]", ""), "constraints[22] (the 23rd constraint): no");
        // A number in a list is no place.
        assert_eq!(message("rig.damping_ratio[2]", "0.5"), "rig.damping_ratio[2] = 0.5: no");
        assert_eq!(message("gears.module_mm", "0"), "gears.module_mm = 0: no");
    }

    #[test]
    fn texts_about_one_of_several_faults_name_it() {
        let error = || {
            TomlError::new("fault.end", 0.1, "must be more than fault.start, 0.2")
                .with_help("mend the fault. Or raise fault.end")
        };
        let second = error().in_entry("fault", 1, 2);
        assert_eq!(
            (second.key.as_str(), second.problem.as_str()),
            ("fault[1].end", "must be more than fault[1].start, 0.2")
        );
        assert_eq!(second.help.as_deref(), Some("mend the fault. Or raise fault[1].end"));
        assert_eq!(error().in_entry("fault", 0, 1), error());
    }
}
