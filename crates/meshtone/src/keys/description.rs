//! The description of a key of the scenario file, for documentation.

use crate::model::{PUBLISHED_KEYS, models_ignoring};

/// Description of a key of the scenario file, from which the guide's lists, the commented files of `meshtone init` and Python's signatures
/// are made.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct KeyDescription {
    /// Dotted key within its section, for example `flank_relief.amount_um`.
    pub key: String,
    /// Unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
    /// Whether it must be given.
    pub required: bool,
    /// Its default: a TOML value, or words; empty where it is required whatever else is given.
    pub default: String,
    /// The allowed values; empty where `kind` makes them plain.
    pub allowed: String,
    /// Bounds of its numbers whatever the other keys say, the least and the largest, where there are such; they may themselves not be
    /// allowed, as `allowed` says.
    pub bounds: [Option<f64>; 2],
    /// Kind of its value.
    pub kind: KeyKind,
    /// Names of the models that simulate its default whatever it says.
    pub ignored_by: Vec<&'static str>,
    /// A sentence that names the models that ignore or refuse it; empty where all heed it.
    pub ignored_in_words: String,
}

/// A sentence that names the models that ignore or refuse a key, empty where all heed it.
///
/// # Arguments
/// * `key` - with its section
pub(super) fn ignored_in_words(key: &str) -> String {
    let models = models_ignoring(key);
    let ignored = (!models.is_empty()).then(|| format!("Ignored by {}.", models.join(", ")));
    let refused = PUBLISHED_KEYS.iter().find(|of_published| of_published.key == key);
    ignored.into_iter().chain(refused.map(|refused| refused.words.to_owned())).collect::<Vec<_>>().join(" ")
}

/// Kind of the value of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum KeyKind {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// The number of a tooth, an array of several, or `"all"`.
    Teeth,
    /// One of some names, in double quotes.
    Name(Vec<&'static str>),
    /// One of some names, in double quotes, or a table, whose keys are described too.
    NameOrTable(Vec<&'static str>),
    /// An array of that many numbers.
    Numbers(usize),
    /// An array of numbers, as many as other keys say.
    List,
    /// A number, or an array of that many.
    NumberOrNumbers(usize),
    /// A table, whose keys are described too.
    Table,
    /// An array of such tables.
    Tables,
    /// A table of the arrays `time_s` and `value`, or of a `file`.
    Profile,
    /// A table of the arrays `frequency_hz`, `magnitude` and `phase_deg`, or of a `file`.
    FrequencyResponse,
    /// An array of rows of numbers.
    Matrix,
    /// A text.
    Text,
    /// An array of two texts.
    Texts,
    /// The name of a file.
    File,
}
