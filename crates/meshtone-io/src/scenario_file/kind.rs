//! What a file is that another was expected to be.

use std::path::PathBuf;

use meshtone_toml::{TomlDocument, TomlError};

use super::ReadScenarioError;

/// The files that users write.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FileKind {
    /// What is simulated.
    Scenario,
    /// What a data set consists of.
    Plan,
    /// What simulations are tuned to.
    Experiment,
}

impl FileKind {
    /// What a text is, by the tables that no other kind has; none where that cannot be told.
    ///
    /// # Arguments
    /// * `text` - of the file
    ///
    /// ```
    /// use meshtone_io::scenario_file::FileKind;
    ///
    /// assert_eq!(FileKind::of("records = 10\n[[class]]\nlabel = \"healthy\"\n"), Some(FileKind::Plan));
    /// assert_eq!(FileKind::of("[sensor]\n"), None);
    /// ```
    pub fn of(text: &str) -> Option<Self> {
        let document = TomlDocument::parse(text).ok()?;
        let own = [("gears", Self::Scenario), ("class", Self::Plan), ("case", Self::Experiment)];
        let mut found = own.into_iter().filter(|(table, _)| document.line_of_key(table).is_some());
        // A file that looks like two is none.
        found.next().filter(|_| found.next().is_none()).map(|(_, kind)| kind)
    }

    /// What such a file is.
    pub fn in_words(self) -> &'static str {
        match self {
            Self::Scenario => "a scenario",
            Self::Plan => "the plan of a data set",
            Self::Experiment => "an experiment",
        }
    }

    /// The command that reads such a file.
    pub fn reader(self) -> &'static str {
        match self {
            Self::Scenario => "meshtone simulate",
            Self::Plan => "meshtone dataset",
            Self::Experiment => "meshtone tune",
        }
    }
}

impl ReadScenarioError {
    /// A text that is refused: for what is wrong in it, or for being another kind of file.
    ///
    /// # Arguments
    /// * `expected` - what it should be
    /// * `path`, `text` - the file
    /// * `error` - what is wrong with it as that
    pub fn invalid(expected: FileKind, path: PathBuf, text: String, error: TomlError) -> Self {
        let error = match FileKind::of(&text) {
            Some(other) if other != expected => {
                let problem =
                    format!("is {}, and {} is expected here", other.in_words(), expected.in_words());
                let help = format!("`{} {}` reads it", other.reader(), path.display());
                TomlError::new("", "", problem).with_help(help)
            }
            _ => error,
        };
        Self::Invalid { path, text, error: Box::new(error) }
    }
}
