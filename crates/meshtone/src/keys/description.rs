//! What a key of the scenario file is, for documentation.

/// What a key of the scenario file is: what the guide's tables, the commented files of `meshtone init` and Python's signatures
/// are made from.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct KeyDescription {
    /// Dotted key within its section, for example `tip_relief.depth_mm`.
    pub key: String,
    /// Unit of its numbers; empty where there is none.
    pub unit: &'static str,
    /// What it says.
    pub meaning: &'static str,
    /// Whether it must be given.
    pub required: bool,
    /// What is taken where it is left out: a TOML value, or words; empty where it is required whatever else is given.
    pub default: String,
    /// What is allowed; empty where that is plain from `kind`.
    pub allowed: String,
    /// Bounds of its numbers whatever the other keys say, the least and the largest, where there are such; they may themselves not be
    /// allowed, as `allowed` says.
    pub bounds: [Option<f64>; 2],
    /// What kind of value it has.
    pub kind: KeyKind,
    /// Names of the models that simulate its default whatever it says.
    pub ignored_by: &'static [&'static str],
}

impl KeyDescription {
    /// Which models ignore it, as a sentence; empty where all heed it.
    pub fn ignored_in_words(&self) -> String {
        ignored_in_words(self.ignored_by)
    }
}

/// Which models ignore a key, as a sentence.
pub(super) fn ignored_in_words(models: &[&str]) -> String {
    if models.is_empty() { String::new() } else { format!("Ignored by {}.", models.join(" and ")) }
}

/// What kind of value a key has.
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
    /// An array of that many numbers.
    Numbers(usize),
    /// An array of numbers, as many as other keys say.
    List,
    /// A number, or an array of that many.
    NumberOrNumbers(usize),
    /// A table, whose keys are described too.
    Table,
    /// A table, whose keys are described too, or `false`.
    TableOrFalse,
    /// A table of the arrays `time_s` and `value`, or of a `file`.
    Profile,
    /// A table of the arrays `frequency_hz`, `magnitude` and `phase_deg`, or of a `file`.
    FrequencyResponse,
    /// An array of rows of numbers.
    Matrix,
    /// A text.
    Text,
    /// The name of a file.
    File,
}
