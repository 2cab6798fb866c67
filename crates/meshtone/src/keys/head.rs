//! What a key is, apart from the section that it stands in.

use meshtone_toml::{ErrorKind, ReadResult, TomlError, TomlTable, TomlValue};

use super::description::{KeyDescription, KeyKind, ignored_in_words};
use super::range::Range;
use super::text::{comment, dotted, quoted, short_number, with_short_numbers};
use super::value::Written;
use crate::model::models_ignoring;

/// Everything about a key but the place of its value. None of it depends on the type of the section, so that messages and
/// descriptions are compiled once rather than for every section.
pub(crate) struct KeyHead {
    pub(crate) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) meaning: &'static str,
    pub(super) kind: KeyKind,
    pub(super) absent: Absent,
    pub(super) range: Range,
    pub(super) rule: &'static str,
    pub(super) shown: CommentedForm,
}

/// Meaning of an absent key.
pub(super) enum Absent {
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
pub(super) enum CommentedForm {
    /// With its default, to be set by taking the `#` away.
    Default,
    /// With an example, likewise.
    Example(&'static str),
    /// With an example that can stand only in place of other keys.
    Alternative(&'static str),
}

impl KeyHead {
    pub(super) fn new(name: &'static str, unit: &'static str, meaning: &'static str, kind: KeyKind) -> Self {
        Self {
            name,
            unit,
            meaning,
            kind,
            absent: Absent::Default,
            range: Range::finite(),
            rule: "",
            shown: CommentedForm::Default,
        }
    }

    pub(super) fn is_required(&self) -> bool {
        matches!(self.absent, Absent::Refused | Absent::RefusedUnless(_))
    }

    /// Finds the key's value in a table and reads it.
    ///
    /// # Arguments
    /// * `table` - the section's
    /// * `required` - whether the key must be there
    /// * `read` - takes the value
    pub(super) fn read(
        &self,
        table: &TomlTable<'_>,
        required: bool,
        read: &mut dyn FnMut(&TomlValue<'_>) -> ReadResult<()>,
    ) -> ReadResult<()> {
        let is_replaced = match &self.absent {
            Absent::RefusedUnless(others) => others.iter().any(|other| table.optional(other).is_some()),
            _ => false,
        };
        let value = if required && !is_replaced {
            if let (Absent::RefusedUnless(others), None) = (&self.absent, table.optional(self.name)) {
                others.iter().try_for_each(|other| table.refuse_misspelling_of(other))?;
            }
            table.required(self.name, &self.with_unit()).map(Some)?
        } else {
            table.optional(self.name)
        };
        // A text that must be one of some names is refused here, with the names.
        if let (Some(value), KeyKind::Name(names)) = (&value, &self.kind) {
            value.one_of(names)?;
        }
        match value {
            Some(value) => read(&value).map_err(|error| self.as_below_range(error)),
            // The message about a misspelt table would list keys of which none is like it.
            None if self.kind == KeyKind::Table => table.refuse_misspelling_of(self.name),
            None => Ok(()),
        }
    }

    /// A negative number where only whole ones from 0 on can be held: what the key allows says more than what a type does.
    fn as_below_range(&self, mut error: TomlError) -> TomlError {
        let is_negative = error.kind == ErrorKind::NotAllowed && error.value.starts_with('-');
        if is_negative
            && matches!(self.kind, KeyKind::Whole | KeyKind::Teeth)
            && let Some(words) = self.range.words(self.unit)
        {
            error.problem = words;
        }
        error
    }

    /// The key with its value, or the keys inside it with theirs.
    pub(super) fn pairs(&self, written: Written) -> Vec<(String, String)> {
        match written {
            Written::Nothing => Vec::new(),
            Written::Value(value) => vec![(self.name.to_string(), value)],
            Written::Lines(pairs) => {
                pairs.into_iter().map(|(key, value)| (format!("{}.{key}", self.name), value)).collect()
            }
        }
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
    /// * `default` - its value in the section with its defaults
    /// * `inside` - the keys inside it, as they are named there
    /// * `section` - the section's name; empty for other tables
    pub(super) fn describe(
        &self,
        default: Written,
        inside: Vec<KeyDescription>,
        section: &str,
    ) -> Vec<KeyDescription> {
        let path = dotted(section, self.name);
        let numbers = match &self.kind {
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
                Absent::Default => self.shown_value(default).unwrap_or_default(),
            },
            allowed: allowed.join("; "),
            bounds: self.range.bounds(),
            kind: self.kind.clone(),
            ignored_by: models_ignoring(&path).to_vec(),
            ignored_in_words: ignored_in_words(&path),
        };
        let named = |inner: KeyDescription| KeyDescription { key: dotted(self.name, &inner.key), ..inner };
        std::iter::once(own).chain(inside.into_iter().map(named)).collect()
    }

    /// The value as a reader finds it easiest to read.
    fn shown_value(&self, written: Written) -> Option<String> {
        match written {
            Written::Nothing => None,
            Written::Lines(_) => Some("as below".to_string()),
            Written::Value(text) if self.kind == KeyKind::Number => {
                Some(text.parse().map_or(text, short_number))
            }
            Written::Value(text) => Some(with_short_numbers(&text)),
        }
    }

    /// The line that sets the key to a value; none where the key is left out.
    fn line(&self, written: Written) -> Option<String> {
        self.shown_value(written).map(|value| format!("{} = {value}", self.name))
    }

    /// The key in a commented file: what it is, and a line that sets it.
    ///
    /// # Arguments
    /// * `written` - its value in the file
    /// * `default` - its value in the section with its defaults
    /// * `section` - the section's name
    pub(super) fn commented(&self, written: Written, default: Written, section: &str) -> String {
        let is_set = written != Written::Nothing && (self.is_required() || written != default);
        let mark = if is_set { "" } else { "#" };
        let sentences = self.sentences(default, section);
        let lines: Vec<String> = match (written, &self.shown) {
            (Written::Lines(pairs), _) => {
                pairs.iter().map(|(key, value)| format!("{mark}{}.{key} = {value}", self.name)).collect()
            }
            (_, CommentedForm::Example(value)) if !is_set => vec![format!("#{} = {value}", self.name)],
            (_, CommentedForm::Alternative(value)) if !is_set => vec![format!("# {} = {value}", self.name)],
            (written, _) => self.line(written).map(|line| format!("{mark}{line}")).into_iter().collect(),
        };
        lines.iter().fold(comment(&sentences), |text, line| text + line + "\n")
    }

    /// The key in a file of what matters, and its meaning; none where it may be left out.
    pub(super) fn essential(&self, written: Written, default: &Written) -> Option<[String; 2]> {
        if written == *default && !self.is_required() {
            return None;
        }
        Some([self.line(written)?, format!("{}{}", self.unit_before(), self.meaning)])
    }

    /// Meaning and default, in sentences.
    fn sentences(&self, default: Written, section: &str) -> String {
        let mut letters = self.meaning.chars();
        let first: String = letters.next().into_iter().flat_map(char::to_uppercase).collect();
        let names = match &self.kind {
            KeyKind::Name(names) | KeyKind::NameOrTable(names) => format!(": {}", quoted(names)),
            _ => String::new(),
        };
        let absent = match self.absent {
            Absent::Refused => "Required.".to_string(),
            Absent::RefusedUnless(others) => format!("Required, unless {} is given.", others.join(" or ")),
            Absent::Words(words) => format!("Default: {words}."),
            Absent::Default => match self.shown_value(default) {
                Some(default) if default.len() <= 20 => format!("Default {default}."),
                _ => "Default as here.".to_string(),
            },
        };
        let ignored = ignored_in_words(&dotted(section, self.name));
        format!("{}{first}{}{names}. {absent} {ignored}", self.unit_before(), letters.as_str())
    }
}
