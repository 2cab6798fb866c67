//! What is wrong with a scenario.

/// A scenario that cannot be simulated: which key, what it says, what is allowed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}{key} = {value}: {problem}", line.map(|line| format!("line {line}: ")).unwrap_or_default())]
pub struct ScenarioError {
    /// Dotted key in the scenario file, for example `gears.module_mm`.
    pub key: String,
    /// The offending value as it was given.
    pub value: String,
    /// What is wrong with it and what is allowed.
    pub problem: String,
    /// What to do about it, where that is not plain from `problem`.
    pub help: Option<String>,
    /// 1-based line in the TOML text, where the scenario came from one.
    pub line: Option<usize>,
}

impl ScenarioError {
    /// An error about `key`, whose `value` breaks a rule.
    ///
    /// # Arguments
    /// * `key` - dotted key in the scenario file
    /// * `value` - the value as given
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
}
