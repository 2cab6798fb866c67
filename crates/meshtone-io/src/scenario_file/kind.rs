//! What a file is that another was expected to be.

use std::path::{Path, PathBuf};

use meshtone_toml::{ErrorKind, TomlDocument, TomlError};

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
    /// What was found so, which `meshtone tune` writes.
    Tuned,
}

impl FileKind {
    /// What a text is, by the tables that no other kind has; none where that cannot be decided.
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
        let own = [
            ("gears", Self::Scenario),
            ("mesh", Self::Scenario),
            ("class", Self::Plan),
            ("case", Self::Experiment),
            ("enhancement", Self::Tuned),
        ];
        let mut found = own.into_iter().filter(|(table, _)| document.line_of_key(table).is_some());
        // A file that looks like two is none.
        found.next().filter(|_| found.next().is_none()).map(|(_, kind)| kind)
    }

    /// What such a file is, the command that reads it, and the one that writes one to start from.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Scenario => ["a scenario", "meshtone simulate", "meshtone init healthy -o FILE"],
            Self::Plan => ["the plan of a data set", "meshtone dataset", "meshtone init dataset -o FILE"],
            Self::Experiment => ["an experiment", "meshtone tune", "meshtone init experiment -o FILE"],
            Self::Tuned => {
                let reader = "meshtone enhance SCENARIO.toml --tuned";
                ["what `meshtone tune` found", reader, "meshtone tune EXPERIMENT.toml"]
            }
        }
    }

    /// What such a file is.
    pub fn in_words(self) -> &'static str {
        self.words()[0]
    }

    /// The command that reads such a file.
    pub fn reader(self) -> &'static str {
        self.words()[1]
    }

    /// The command that writes such a file to start from.
    pub fn writer(self) -> &'static str {
        self.words()[2]
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
            _ => no_toml(expected, &path, &text, &error).unwrap_or(error),
        };
        Self::Invalid { path, text, error: Box::new(error) }
    }
}

/// The error about a text that is of another format altogether.
fn no_toml(expected: FileKind, path: &Path, text: &str, error: &TomlError) -> Option<TomlError> {
    if error.kind != ErrorKind::NotToml {
        return None;
    }
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let is_table = ["csv", "tsv", "txt", "dat", "asc"].contains(&ending.as_str());
    let (what, help) = if serde_json::from_str::<serde_json::Value>(text).is_ok_and(|json| json.is_object()) {
        ("JSON", format!("write it as TOML; `{}` writes one to start from", expected.writer()))
    } else if is_table {
        ("a table", format!("`meshtone indicators {}` reads recordings", path.display()))
    } else {
        return None;
    };
    Some(
        TomlError::new("", "", format!("is {what}, and {} is expected here", expected.in_words()))
            .with_help(help),
    )
}
