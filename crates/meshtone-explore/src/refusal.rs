//! Why there is no answer, in the program's own words.

use meshtone::Error;
use meshtone::scenario::{ErrorKind, ScenarioError};
use meshtone::signal::SignalError;
use meshtone_diagnose::{DiagnoseError, StoreError};
use serde_json::{Value, json};

/// Why there is no answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// The request is wrong; a key of a scenario, where one is named.
    Wrong(ScenarioError),
    /// The request is wrong, but no key is to blame.
    Unfit {
        /// The problem.
        problem: String,
        /// Advice.
        help: Option<String>,
    },
    /// A later request has taken its place, or nobody waits for it any more.
    Superseded,
}

impl Refusal {
    /// A refusal that is about no key.
    ///
    /// # Arguments
    /// * `problem` - what is wrong
    pub fn unfit(problem: impl Into<String>) -> Self {
        Self::Unfit { problem: problem.into(), help: None }
    }

    /// Returns the refusal with advice.
    ///
    /// # Arguments
    /// * `advice` - what the user can do
    pub fn with_help(self, advice: impl Into<String>) -> Self {
        match self {
            Self::Unfit { problem, .. } => Self::Unfit { problem, help: Some(advice.into()) },
            other => other,
        }
    }

    /// Returns the refusal with the name of the file that it is about.
    ///
    /// # Arguments
    /// * `file` - the name
    pub fn about(self, file: &str) -> Self {
        match self {
            Self::Unfit { problem, help } => Self::Unfit { problem: format!("{file}: {problem}"), help },
            other => other,
        }
    }

    /// For the page: what kind of thing is wrong, the key, the value, what is allowed, what to do, the line, and all in a sentence.
    pub fn json(&self) -> Value {
        match self {
            Self::Wrong(error) => json!({
                "kind": kind_in_words(error.kind),
                "key": error.key,
                "value": error.value,
                "problem": error.problem,
                "help": error.help,
                "line": error.line,
                "text": error.to_string(),
            }),
            Self::Unfit { problem, help } => {
                json!({ "kind": "unfit", "problem": problem, "help": help, "text": problem })
            }
            Self::Superseded => {
                json!({ "kind": "superseded", "text": "a later request has taken its place" })
            }
        }
    }
}

fn kind_in_words(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::NotToml => "not-toml",
        ErrorKind::MissingKey => "missing-key",
        ErrorKind::UnknownKey => "unknown-key",
        ErrorKind::WrongType => "wrong-type",
        _ => "not-allowed",
    }
}

impl From<ScenarioError> for Refusal {
    fn from(error: ScenarioError) -> Self {
        Self::Wrong(error)
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::Scenario(error) => Self::Wrong(error),
            other => Self::Unfit { problem: other.to_string(), help: other.help().map(str::to_owned) },
        }
    }
}

impl From<SignalError> for Refusal {
    fn from(error: SignalError) -> Self {
        Self::unfit(error.to_string())
    }
}

impl From<DiagnoseError> for Refusal {
    fn from(error: DiagnoseError) -> Self {
        Self::unfit(error.to_string())
    }
}

impl From<StoreError> for Refusal {
    fn from(error: StoreError) -> Self {
        Self::unfit(error.to_string())
    }
}
