//! What is wrong with a text.

use std::fmt;

/// What kind of thing is wrong, for programs; people read [`TomlError::problem`].
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
    /// What kind of thing is wrong.
    pub kind: ErrorKind,
    /// Dotted key, for example `motor.speed_hz`, or `motor.weights[2]` for the third entry of an array. Empty where
    /// the text is not TOML.
    pub key: String,
    /// The offending value as it was given; empty where a key is missing.
    pub value: String,
    /// What is wrong with it and what is allowed.
    pub problem: String,
    /// What to do about it, where that is not plain from `problem`.
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
        match (self.key.as_str(), self.value.as_str()) {
            ("", "") => {}
            ("", value) => write!(formatter, "{value}: ")?,
            (key, "") => write!(formatter, "{key}: ")?,
            (key, value) => write!(formatter, "{key} = {value}: ")?,
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

    /// The same error, of another kind.
    ///
    /// # Arguments
    /// * `kind` - what kind of thing is wrong
    pub fn of_kind(mut self, kind: ErrorKind) -> Self {
        self.kind = kind;
        self
    }

    /// The same error with advice.
    ///
    /// # Arguments
    /// * `help` - what the user can do
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same error at a line of the text.
    ///
    /// # Arguments
    /// * `line` - 1-based line, where known
    pub fn at_line(mut self, line: Option<usize>) -> Self {
        self.line = line;
        self
    }

    /// The same error under another key, as of a table that stands within another text.
    ///
    /// # Arguments
    /// * `key` - dotted key
    pub fn with_key(mut self, key: impl Into<String>) -> Self {
        self.key = key.into();
        self
    }
}
