//! What is wrong, or doubtful, about a scenario.

use std::fmt;

/// A scenario that cannot be simulated: which key, what it says, what is allowed.
///
/// ```
/// use meshtone::scenario::Scenario;
///
/// let text = "[gears]\nmodule_mm = -3.0\npinion_teeth = 17\ngear_teeth = 38\nface_width_mm = 15.0\n\
///             [operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 10.0\n";
/// let error = Scenario::from_toml(text).unwrap_err();
/// assert_eq!(error.key, "gears.module_mm");
/// assert_eq!(error.line, Some(2));
/// assert_eq!(error.to_string(), "line 2: gears.module_mm = -3.0: must be more than 0 mm");
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioError {
    /// Dotted key in the scenario file, for example `gears.module_mm`, or
    /// `rig.damping_ratio[2]` for the third entry of an array. Empty where the text is not TOML.
    pub key: String,
    /// The offending value as it was given; empty where a key is missing.
    pub value: String,
    /// What is wrong with it and what is allowed.
    pub problem: String,
    /// What to do about it, where that is not plain from `problem`.
    pub help: Option<String>,
    /// 1-based line in the TOML text, where the scenario came from one.
    pub line: Option<usize>,
}

impl std::error::Error for ScenarioError {}

impl fmt::Display for ScenarioError {
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

impl ScenarioError {
    /// An error about `key`, whose `value` breaks a rule.
    ///
    /// # Arguments
    /// * `key` - dotted key in the scenario file
    /// * `value` - the value as given; empty where it is missing
    /// * `problem` - what is wrong and what is allowed
    pub fn new(key: impl Into<String>, value: impl ToString, problem: impl Into<String>) -> Self {
        Self { key: key.into(), value: value.to_string(), problem: problem.into(), help: None, line: None }
    }

    /// The same error with advice.
    ///
    /// # Arguments
    /// * `help` - what the user can do
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The same error at a line of the file.
    ///
    /// # Arguments
    /// * `line` - 1-based line, where known
    pub fn at_line(mut self, line: Option<usize>) -> Self {
        self.line = line;
        self
    }
}

/// Something about a scenario that can be simulated but deserves the user's attention.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioWarning {
    /// Dotted key in the scenario file.
    pub key: String,
    /// What is doubtful, and what could be done.
    pub message: String,
}

impl ScenarioWarning {
    /// A warning about `key`.
    ///
    /// # Arguments
    /// * `key` - dotted key in the scenario file
    /// * `message` - what is doubtful, and what could be done
    pub fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into() }
    }
}

impl fmt::Display for ScenarioWarning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.key, self.message)
    }
}
