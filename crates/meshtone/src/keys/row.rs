//! One key of a section.

use meshtone_toml::{ReadResult, TomlTable};

use super::cell::{Cell, Field, ReadElsewhere, SubTable};
use super::check::Check;
use super::description::KeyKind;
use super::files::NumberFiles;
use super::head::{Absent, CommentedForm, KeyHead};
use super::range::Range;
use super::text::dotted;
use super::value::{KeyValue, Written};

/// One key of a section: everything about it that does not depend on other keys.
pub(crate) struct KeyRow<S> {
    pub(crate) head: KeyHead,
    pub(super) cell: Box<dyn Cell<S>>,
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
    KeyRow { head: KeyHead::new(name, unit, meaning, V::kind()), cell: Box::new(field) }
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
    KeyRow { head: KeyHead::new(name, "", meaning, KeyKind::Table), cell: Box::new(SubTable(rows)) }
}

/// A row that is read together with others, in [`Keys::choose`](super::Keys::choose).
///
/// # Arguments
/// * `name` - the key
/// * `meaning` - what it says
/// * `kind` - of its value
pub(crate) fn documented<S>(name: &'static str, meaning: &'static str, kind: KeyKind) -> KeyRow<S> {
    KeyRow { head: KeyHead::new(name, "", meaning, kind), cell: Box::new(ReadElsewhere) }
}

impl<S> KeyRow<S> {
    /// The key must be given.
    pub(crate) fn required(self) -> Self {
        Self { head: KeyHead { absent: Absent::Refused, ..self.head }, ..self }
    }

    /// The key must be given, unless one of `others` is, which is read in its place.
    pub(crate) fn required_unless(self, others: &'static [&'static str]) -> Self {
        Self { head: KeyHead { absent: Absent::RefusedUnless(others), ..self.head }, ..self }
    }

    /// States in words what is taken where the key is left out; the section starts without a value.
    pub(crate) fn otherwise(self, words: &'static str) -> Self {
        Self { head: KeyHead { absent: Absent::Words(words), ..self.head }, ..self }
    }

    /// The row with another meaning.
    pub(crate) fn meaning(self, meaning: &'static str) -> Self {
        Self { head: KeyHead { meaning, ..self.head }, ..self }
    }

    /// The numbers that are allowed whatever the other keys say.
    pub(crate) fn range(self, range: Range) -> Self {
        Self { head: KeyHead { range, ..self.head }, ..self }
    }

    /// The row with another key.
    pub(crate) fn named(self, name: &'static str) -> Self {
        Self { head: KeyHead { name, ..self.head }, ..self }
    }

    /// States another kind than that of the value's type, such as the names that a text must be one of.
    pub(crate) fn kind(self, kind: KeyKind) -> Self {
        Self { head: KeyHead { kind, ..self.head }, ..self }
    }

    /// States a further rule, in the words of the documentation; a function beside the rows checks it.
    pub(crate) fn rule(self, rule: &'static str) -> Self {
        Self { head: KeyHead { rule, ..self.head }, ..self }
    }

    /// Sets how a commented file shows the key: with an example that may be set as it stands.
    pub(crate) fn example(self, value: &'static str) -> Self {
        Self { head: KeyHead { shown: CommentedForm::Example(value), ..self.head }, ..self }
    }

    /// Sets how a commented file shows the key: with an example that stands in place of other keys.
    pub(crate) fn alternative(self, value: &'static str) -> Self {
        Self { head: KeyHead { shown: CommentedForm::Alternative(value), ..self.head }, ..self }
    }

    /// Sets the key in one section to its value in another.
    pub(crate) fn copy(&self, from: &S, to: &mut S) {
        self.cell.copy(from, to);
    }

    pub(super) fn read(
        &self,
        section: &mut S,
        table: &TomlTable<'_>,
        files: &dyn NumberFiles,
    ) -> ReadResult<()> {
        let required = self.head.is_required() && self.cell.write(section).is_some();
        self.head.read(table, required, &mut |value| self.cell.read(section, value, files))
    }

    pub(super) fn write(&self, section: &S) -> Written {
        self.cell.write(section).unwrap_or(Written::Nothing)
    }

    pub(super) fn check(&self, section: &S, path: &str) -> Check {
        self.cell.check(section, &dotted(path, self.head.name), &self.head.range, self.head.unit)
    }
}
