//! One key of a section.

use meshtone_toml::{ErrorKind, ReadResult, TomlError, TomlTable};

use super::cell::{Cell, Field, ReadElsewhere, SubTable};
use super::check::Check;
use super::description::{KeyDescription, KeyKind, ignored_in_words};
use super::files::NumberFiles;
use super::range::Range;
use super::text::short_number;
use super::value::{KeyValue, Written};
use crate::model::models_ignoring;

/// One key of a section: everything about it that does not depend on other keys.
pub(crate) struct KeyRow<S> {
    pub(crate) name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    absent: Absent,
    range: Range,
    rule: &'static str,
    shown: CommentedForm,
    cell: Box<dyn Cell<S>>,
}

/// Meaning of an absent key.
enum Absent {
    /// It must be given.
    Refused,
    /// It must be given, unless another key is.
    RefusedUnless(&'static [&'static str]),
    /// The value in [`Keys::start`](super::Keys::start).
    Default,
    /// Something that is found elsewhere, in words.
    Words(&'static str),
}

/// The form in which a commented file shows a key that is not set in it.
enum CommentedForm {
    /// With its default, to be set by taking the `#` away.
    Default,
    /// With an example, likewise.
    Example(&'static str),
    /// With an example that can stand only in place of other keys.
    Alternative(&'static str),
}

/// A row with a default that the section starts with and no limit to its numbers.
///
/// # Arguments
/// * `name` - the key
/// * `unit` - of its numbers; empty for none
/// * `meaning` - what it says, in words that follow "it is"; without full stop
/// * `field` - where the value is kept: [`field!`](super::field)
pub(crate) fn row<S: 'static, V: KeyValue>(
    name: &'static str,
    unit: &'static str,
    meaning: &'static str,
    field: Field<S, V>,
) -> KeyRow<S> {
    KeyRow::new(name, unit, meaning, Box::new(field))
}

/// A row of a table inside the section whose keys are values of the section itself.
///
/// # Arguments
/// * `name` - the key
/// * `meaning` - what it says
/// * `rows` - the keys inside it
pub(crate) fn sub_table<S: 'static>(
    name: &'static str,
    meaning: &'static str,
    rows: Vec<KeyRow<S>>,
) -> KeyRow<S> {
    KeyRow::new(name, "", meaning, Box::new(SubTable(rows)))
}

/// A row that is read together with others, in [`Keys::choose`](super::Keys::choose).
///
/// # Arguments
/// * `name` - the key
/// * `meaning` - what it says
/// * `kind` - of its value
pub(crate) fn documented<S>(name: &'static str, meaning: &'static str, kind: KeyKind) -> KeyRow<S> {
    KeyRow::new(name, "", meaning, Box::new(ReadElsewhere(kind)))
}

impl<S> KeyRow<S> {
    fn new(name: &'static str, unit: &'static str, meaning: &'static str, cell: Box<dyn Cell<S>>) -> Self {
        Self {
            name,
            unit,
            meaning,
            absent: Absent::Default,
            range: Range::finite(),
            rule: "",
            shown: CommentedForm::Default,
            cell,
        }
    }

    /// The key must be given.
    pub(crate) fn required(self) -> Self {
        Self { absent: Absent::Refused, ..self }
    }

    /// The key must be given, unless one of `others` is, which is read in its place.
    pub(crate) fn required_unless(self, others: &'static [&'static str]) -> Self {
        Self { absent: Absent::RefusedUnless(others), ..self }
    }

    fn is_required(&self) -> bool {
        matches!(self.absent, Absent::Refused | Absent::RefusedUnless(_))
    }

    /// States in words what is taken where the key is left out; the section starts without a value.
    pub(crate) fn otherwise(self, words: &'static str) -> Self {
        Self { absent: Absent::Words(words), ..self }
    }

    /// The numbers that are allowed whatever the other keys say.
    pub(crate) fn range(self, range: Range) -> Self {
        Self { range, ..self }
    }

    /// States a further rule, in the words of the documentation; a function beside the rows checks it.
    pub(crate) fn rule(self, rule: &'static str) -> Self {
        Self { rule, ..self }
    }

    /// Sets how a commented file shows the key: with an example that may be set as it stands.
    pub(crate) fn example(self, value: &'static str) -> Self {
        Self { shown: CommentedForm::Example(value), ..self }
    }

    /// Sets how a commented file shows the key: with an example that stands in place of other keys.
    pub(crate) fn alternative(self, value: &'static str) -> Self {
        Self { shown: CommentedForm::Alternative(value), ..self }
    }

    /// Moves the row to another section, with the value elsewhere.
    pub(super) fn moved<T>(self, move_cell: impl FnOnce(Box<dyn Cell<S>>) -> Box<dyn Cell<T>>) -> KeyRow<T> {
        let Self { name, unit, meaning, absent, range, rule, shown, cell } = self;
        let cell = move_cell(cell);
        KeyRow { name, unit, meaning, absent, range, rule, shown, cell }
    }

    /// Sets the key in one section to its value in another.
    pub(crate) fn copy(&self, from: &S, to: &mut S) {
        self.cell.copy(from, to);
    }

    pub(crate) fn read(
        &self,
        section: &mut S,
        table: &TomlTable<'_>,
        files: &dyn NumberFiles,
    ) -> ReadResult<()> {
        let required = self.is_required() && self.cell.write(section).is_some();
        let value = if required {
            if let (Absent::RefusedUnless(others), None) = (&self.absent, table.optional(self.name)) {
                others.iter().try_for_each(|other| table.refuse_misspelling_of(other))?;
            }
            table.required(self.name, &self.with_unit()).map(Some)?
        } else {
            table.optional(self.name)
        };
        match value {
            Some(value) => self.cell.read(section, &value, files).map_err(|error| self.as_below_range(error)),
            // The message about a misspelt table would list keys of which none is like it.
            None if self.cell.kind() == KeyKind::Table => table.refuse_misspelling_of(self.name),
            None => Ok(()),
        }
    }

    /// A negative number where only whole ones from 0 on can be held: what the key allows says more than what a type does.
    fn as_below_range(&self, mut error: TomlError) -> TomlError {
        let is_negative = error.kind == ErrorKind::NotAllowed && error.value.starts_with('-');
        if is_negative
            && matches!(self.cell.kind(), KeyKind::Whole | KeyKind::Teeth)
            && let Some(words) = self.range.words(self.unit)
        {
            error.problem = words;
        }
        error
    }

    pub(super) fn write(&self, section: &S) -> Written {
        self.cell.write(section).unwrap_or(Written::Nothing)
    }

    pub(super) fn check(&self, section: &S, path: &str) -> Check {
        self.cell.check(section, &dotted(path, self.name), &self.range, self.unit)
    }

    /// The unit before other words; nothing where there is none.
    fn unit_before(&self) -> String {
        if self.unit.is_empty() { String::new() } else { format!("({}) ", self.unit) }
    }

    /// Unit and meaning: `(mm) the module`.
    fn with_unit(&self) -> String {
        let unless = match self.absent {
            Absent::RefusedUnless(others) => format!("; required, unless {} is given", others.join(" or ")),
            _ => String::new(),
        };
        format!("{}{}{unless}", self.unit_before(), self.meaning)
    }

    /// Describes the key, and then the keys inside it.
    ///
    /// # Arguments
    /// * `start` - the section with its defaults
    /// * `section` - its name; empty for other tables
    pub(super) fn describe(&self, start: &S, section: &str) -> Vec<KeyDescription> {
        let kind = self.cell.kind();
        let path = dotted(section, self.name);
        let numbers = match &kind {
            KeyKind::Name(names) | KeyKind::NameOrTable(names) => quoted(names),
            KeyKind::Whole | KeyKind::Teeth => format!("whole number {}", self.range.in_short()),
            _ => self.range.in_short(),
        };
        let allowed: Vec<_> =
            [numbers.trim(), self.rule].into_iter().filter(|words| !words.is_empty()).collect();
        let own = KeyDescription {
            key: self.name.to_string(),
            unit: self.unit,
            meaning: self.meaning,
            required: matches!(self.absent, Absent::Refused),
            default: match self.absent {
                Absent::Refused => String::new(),
                Absent::RefusedUnless(others) => {
                    let others: Vec<_> = others.iter().map(|other| format!("`{other}`")).collect();
                    format!("required, unless {} is given", others.join(" or "))
                }
                Absent::Words(words) => words.to_string(),
                Absent::Default => self.shown_value(start).unwrap_or_default(),
            },
            allowed: allowed.join("; "),
            bounds: self.range.bounds(),
            kind,
            ignored_by: models_ignoring(&path).to_vec(),
            ignored_in_words: ignored_in_words(&path),
        };
        let inside = self
            .cell
            .inside(start)
            .into_iter()
            .map(|inner| KeyDescription { key: dotted(self.name, &inner.key), ..inner });
        std::iter::once(own).chain(inside).collect()
    }

    /// The value as a reader finds it easiest to read.
    fn shown_value(&self, section: &S) -> Option<String> {
        match self.cell.write(section)? {
            Written::Nothing => None,
            Written::Lines(_) => Some("as below".to_string()),
            Written::Value(text) if self.cell.kind() == KeyKind::Number => {
                Some(text.parse().map_or(text, short_number))
            }
            Written::Value(text) => Some(with_short_numbers(&text)),
        }
    }

    /// The key in a commented file, in a section of a name: what it is, and a line that sets it.
    pub(super) fn commented(&self, section: &S, start: &S, name: &str) -> String {
        let written = self.cell.write(section).unwrap_or(Written::Nothing);
        let is_default = self.cell.write(start).is_some_and(|default| default == written);
        let is_set = written != Written::Nothing && (self.is_required() || !is_default);
        let lines = match (written, &self.shown) {
            (Written::Lines(pairs), _) => {
                let mark = if is_set { "" } else { "#" };
                let line = |(key, value): &(String, String)| format!("{mark}{}.{key} = {value}", self.name);
                pairs.iter().map(line).collect()
            }
            (Written::Value(_), _) if is_set => {
                vec![format!("{} = {}", self.name, self.shown_value(section).unwrap_or_default())]
            }
            (_, CommentedForm::Example(value)) => vec![format!("#{} = {value}", self.name)],
            (_, CommentedForm::Alternative(value)) => vec![format!("# {} = {value}", self.name)],
            (Written::Value(_), CommentedForm::Default) => {
                vec![format!("#{} = {}", self.name, self.shown_value(section).unwrap_or_default())]
            }
            (Written::Nothing, CommentedForm::Default) => Vec::new(),
        };
        let mut text = comment(&self.sentences(start, name));
        for line in lines {
            text.extend([line.as_str(), "\n"]);
        }
        text
    }

    /// The key in a file of what matters, and its meaning; none where it may be left out.
    pub(super) fn essential(&self, section: &S, start: &S) -> Option<[String; 2]> {
        let written = self.cell.write(section)?;
        let is_default = self.cell.write(start).is_some_and(|default| default == written);
        if is_default && !self.is_required() {
            return None;
        }
        let line = format!("{} = {}", self.name, self.shown_value(section)?);
        Some([line, format!("{}{}", self.unit_before(), self.meaning)])
    }

    /// Meaning and default, in sentences.
    fn sentences(&self, start: &S, section: &str) -> String {
        let mut letters = self.meaning.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
        let names = match self.cell.kind() {
            KeyKind::Name(names) | KeyKind::NameOrTable(names) => format!(": {}", quoted(&names)),
            _ => String::new(),
        };
        let absent = match self.absent {
            Absent::Refused => "Required.".to_string(),
            Absent::RefusedUnless(others) => format!("Required, unless {} is given.", others.join(" or ")),
            Absent::Words(words) => format!("Default: {words}."),
            Absent::Default => match self.shown_value(start) {
                Some(default) if default.len() <= 20 => format!("Default {default}."),
                _ => "Default as here.".to_string(),
            },
        };
        let ignored = ignored_in_words(&dotted(section, self.name));
        format!("{}{first}{}{names}. {absent} {ignored}", self.unit_before(), letters.as_str())
    }
}

/// An inline table with its large numbers as a reader finds them easiest to read.
fn with_short_numbers(text: &str) -> String {
    const LARGE: f64 = 1e5;
    let short = |word: &str| {
        let (number, comma) = word.strip_suffix(',').map_or((word, ""), |number| (number, ","));
        let large = number.parse().ok().filter(|value: &f64| value.is_finite() && value.abs() >= LARGE);
        large.map_or(word.to_owned(), |value| short_number(value) + comma)
    };
    text.split(' ').map(short).collect::<Vec<_>>().join(" ")
}

/// Names as a file has them, one after the other.
fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

pub(super) fn dotted(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_string() } else { format!("{path}.{name}") }
}

/// A text as lines of a comment.
pub(crate) fn comment(text: &str) -> String {
    const WIDTH: usize = 100;
    let mut lines = vec![String::from("#")];
    for word in text.split_whitespace() {
        let line = lines.len() - 1;
        if lines[line].chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(format!("# {word}"));
        } else {
            lines[line].extend([" ", word]);
        }
    }
    lines.join("\n") + "\n"
}
