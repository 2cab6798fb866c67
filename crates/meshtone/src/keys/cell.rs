//! The place in a section at which a row's value is kept.

use meshtone_toml::{ReadResult, TomlValue};

use super::check::Check;
use super::description::KeyDescription;
use super::files::NumberFiles;
use super::range::Range;
use super::row::KeyRow;
use super::table::{Keys, check_rows, describe_rows, read_rows, written_pairs};
use super::text::inline_table;
use super::value::{KeyValue, Written};
use crate::error::ScenarioError;

/// The value of one row of a section, whatever its type.
pub(super) trait Cell<S> {
    /// Reads the value; a form of the section that has no such key keeps what it has.
    fn read(&self, section: &mut S, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()>;
    /// The written value; none where the section has a form without this key.
    fn write(&self, section: &S) -> Option<Written>;
    fn check(&self, section: &S, key: &str, range: &Range, unit: &str) -> Check;
    fn copy(&self, from: &S, to: &mut S);
    /// Describes the keys inside the value.
    fn inside(&self, section: &S) -> Vec<KeyDescription>;
}

/// A value that is read together with others, in [`Keys::choose`], and never written: it has another key for that.
pub(super) struct ReadElsewhere;

impl<S> Cell<S> for ReadElsewhere {
    fn read(&self, _section: &mut S, _value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        Ok(())
    }

    fn write(&self, _section: &S) -> Option<Written> {
        Some(Written::Nothing)
    }

    fn check(&self, _section: &S, _key: &str, _range: &Range, _unit: &str) -> Check {
        Ok(())
    }

    fn copy(&self, _from: &S, _to: &mut S) {}

    fn inside(&self, _section: &S) -> Vec<KeyDescription> {
        Vec::new()
    }
}

/// A table inside a section whose values are the section's own.
pub(super) struct SubTable<S>(pub(super) Vec<KeyRow<S>>);

impl<S> Cell<S> for SubTable<S> {
    fn read(&self, section: &mut S, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        value.table()?.read(|table| read_rows(&self.0, section, table, files))
    }

    fn write(&self, section: &S) -> Option<Written> {
        let pairs = written_pairs(&self.0, section);
        (!pairs.is_empty()).then(|| Written::Value(inline_table(&pairs)))
    }

    fn check(&self, section: &S, key: &str, _range: &Range, _unit: &str) -> Check {
        check_rows(&self.0, section, key)
    }

    fn copy(&self, from: &S, to: &mut S) {
        self.0.iter().for_each(|row| row.copy(from, to));
    }

    fn inside(&self, section: &S) -> Vec<KeyDescription> {
        describe_rows(&self.0, section, "")
    }
}

/// A field of a section: see [`field!`](super::field).
#[derive(Debug)]
pub(crate) struct Field<S, V> {
    get: fn(&S) -> Option<&V>,
    get_mut: fn(&mut S) -> Option<&mut V>,
}

impl<S, V> Clone for Field<S, V> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, V> Copy for Field<S, V> {}

impl<S, V> Field<S, V> {
    pub(crate) const fn new(get: fn(&S) -> Option<&V>, get_mut: fn(&mut S) -> Option<&mut V>) -> Self {
        Self { get, get_mut }
    }
}

impl<S, V: KeyValue> Cell<S> for Field<S, V> {
    fn read(&self, section: &mut S, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        (self.get_mut)(section).map_or(Ok(()), |field| field.read(value, files))
    }

    fn write(&self, section: &S) -> Option<Written> {
        (self.get)(section).map(KeyValue::write)
    }

    fn check(&self, section: &S, key: &str, range: &Range, unit: &str) -> Check {
        (self.get)(section).map_or(Ok(()), |field| field.check(key, range, unit))
    }

    fn copy(&self, from: &S, to: &mut S) {
        if let (Some(from), Some(to)) = ((self.get)(from), (self.get_mut)(to)) {
            to.clone_from(from);
        }
    }

    fn inside(&self, section: &S) -> Vec<KeyDescription> {
        (self.get)(section).map(V::inside).unwrap_or_default()
    }
}

/// A value of a part of a section, or that several parts have in common: it is read into all of them, and written where `get` gives any.
struct PartsCell<P, G, M> {
    get: G,
    get_mut: M,
    cell: Box<dyn Cell<P>>,
}

impl<S, P, G: Fn(&S) -> &[P], M: Fn(&mut S) -> &mut [P]> Cell<S> for PartsCell<P, G, M> {
    fn read(&self, section: &mut S, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let parts = (self.get_mut)(section);
        parts.iter_mut().try_for_each(|part| self.cell.read(part, value, files))
    }

    fn write(&self, section: &S) -> Option<Written> {
        (self.get)(section).first().and_then(|part| self.cell.write(part))
    }

    fn check(&self, section: &S, key: &str, range: &Range, unit: &str) -> Check {
        let Some((first, others)) = (self.get)(section).split_first() else { return Ok(()) };
        self.cell.check(first, key, range, unit)?;
        let written = self.cell.write(first);
        if others.iter().any(|part| self.cell.write(part) != written) {
            let problem = "differs between the two wheels; a rig of condensed shafts has one of both";
            return Err(ScenarioError::new(key, "", problem).with_help("give both wheels the same"));
        }
        Ok(())
    }

    fn copy(&self, from: &S, to: &mut S) {
        let parts = (self.get)(from).iter().zip((self.get_mut)(to));
        parts.for_each(|(from, to)| self.cell.copy(from, to));
    }

    fn inside(&self, section: &S) -> Vec<KeyDescription> {
        (self.get)(section).first().map(|part| self.cell.inside(part)).unwrap_or_default()
    }
}

impl<P: 'static> KeyRow<P> {
    /// The row among those of a section that has its value in a part.
    ///
    /// # Arguments
    /// * `part` - the part
    pub(crate) fn of<S: 'static>(self, part: Field<S, P>) -> KeyRow<S> {
        self.of_all(
            move |section| (part.get)(section).map_or(&[], std::slice::from_ref),
            move |section| (part.get_mut)(section).map_or(&mut [], std::slice::from_mut),
        )
    }

    /// The row among those of a section several parts of which have the same value.
    ///
    /// # Arguments
    /// * `get`, `get_mut` - the parts
    pub(crate) fn of_all<S: 'static>(
        self,
        get: impl Fn(&S) -> &[P] + 'static,
        get_mut: impl Fn(&mut S) -> &mut [P] + 'static,
    ) -> KeyRow<S> {
        let KeyRow { head, cell } = self;
        KeyRow { head, cell: Box::new(PartsCell { get, get_mut, cell }) }
    }
}

/// The rows of a part of a section, whose keys stand among the section's own rather than in a table of theirs.
pub(crate) fn flatten<S: 'static, P: Keys>(part: Field<S, P>) -> impl Iterator<Item = KeyRow<S>> {
    P::rows().into_iter().map(move |row| row.of(part))
}
