//! One table of a TOML text.

use std::cell::RefCell;

use toml::de::DeTable;

use crate::document::{line_at, written};
use crate::nearest::{has_another_unit, is_misspelling, is_rpm_of, nearest_name};
use crate::{ErrorKind, ReadResult, TomlError, TomlValue};

/// Keys that are named where a name says not whose it is; more of them have no more in common than a unit.
const MOST_OWNERS: usize = 3;

/// One table of a TOML text, read key by key.
///
/// It remembers which keys were asked for, so that [`TomlTable::read`] can refuse the others.
#[derive(Debug)]
#[must_use = "call `read`, so that unknown keys are refused"]
pub struct TomlTable<'a> {
    text: &'a str,
    path: String,
    /// Byte position, whose line errors about what the table lacks name: it is counted only then.
    position: Option<usize>,
    /// None where the text leaves the table out: every key is then at its default.
    table: Option<&'a DeTable<'a>>,
    /// The table that this one is a section of, where that is known.
    around: Option<&'a DeTable<'a>>,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> TomlTable<'a> {
    pub(crate) fn new(
        text: &'a str,
        path: String,
        position: Option<usize>,
        table: Option<&'a DeTable<'a>>,
    ) -> Self {
        Self { text, path, position, table, around: None, asked: RefCell::default() }
    }

    /// The dotted key of this table, empty for the top level.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The dotted key of one of this table's keys.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    pub fn path_of(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) }
    }

    /// Whether the text has a key, which does not allow it.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    pub fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.get(key).is_some())
    }

    /// The value of a key, if it is there.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    pub fn optional(&self, key: &'static str) -> Option<TomlValue<'a>> {
        self.remember(key);
        let (written, value) = self.table?.get_key_value(key)?;
        Some(TomlValue::new(self.text, self.path_of(key), written.span().start, value))
    }

    /// The value of a key that must be there.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    /// * `meaning` - unit and meaning, for the message to a user who left it out
    ///
    /// # Errors
    /// The key is missing; where another key looks like it misspelt, that key is named instead.
    pub fn required(&self, key: &'static str, meaning: &str) -> ReadResult<TomlValue<'a>> {
        if let Some(value) = self.optional(key) {
            return Ok(value);
        }
        self.refuse_misspelling(key, Some(meaning))?;
        self.refuse_outside(key)?;
        let problem = format!("missing, and it has no default; it is {meaning}");
        Err(self.error(key, problem).of_kind(ErrorKind::MissingKey))
    }

    /// A finite number, if it is there.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    ///
    /// # Errors
    /// The value is not a finite number.
    pub fn number(&self, key: &'static str) -> ReadResult<Option<f64>> {
        self.read_optional(key, TomlValue::number)
    }

    /// The value of a key as something else, if it is there.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    /// * `read` - what the value is read as
    ///
    /// # Errors
    /// Those of `read`.
    pub fn read_optional<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(&TomlValue<'a>) -> ReadResult<T>,
    ) -> ReadResult<Option<T>> {
        self.optional(key).as_ref().map(read).transpose()
    }

    /// A table, or an empty one where it is absent, so that every key in it takes its default.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    ///
    /// # Errors
    /// The value is no table, or it is absent and another key looks like it misspelt.
    pub fn table_or_empty(&self, key: &'static str) -> ReadResult<TomlTable<'a>> {
        match self.optional(key) {
            Some(value) => Ok(Self { around: self.table, ..value.table()? }),
            None => {
                self.refuse_misspelling_of(key)?;
                Ok(Self {
                    around: self.table,
                    ..Self::new(self.text, self.path_of(key), self.position, None)
                })
            }
        }
    }

    /// A list of tables: `[key]` once, or `[[key]]` any number of times; none where the key is absent.
    ///
    /// The keys of a single one are named `key.…`, those of entry n of several `key[n].…`, counted from 0.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    ///
    /// # Errors
    /// The value, or an entry of it, is no table.
    ///
    /// ```
    /// use meshtone_toml::TomlDocument;
    ///
    /// let document = TomlDocument::parse("[[motor]]\nname = \"a\"\n[[motor]]\nname = \"b\"\n")?;
    /// let motors = document.root().tables("motor")?;
    /// assert_eq!((motors.len(), motors[1].path()), (2, "motor[1]"));
    ///
    /// let document = TomlDocument::parse("[[motor]]\nname = \"a\"\n")?;
    /// assert_eq!(document.root().tables("motor")?[0].path(), "motor");
    /// # Ok::<(), meshtone_toml::TomlError>(())
    /// ```
    pub fn tables(&self, key: &'static str) -> ReadResult<Vec<TomlTable<'a>>> {
        let Some(value) = self.optional(key) else {
            return Ok(Vec::new());
        };
        if !value.is_array() {
            return Ok(vec![value.table()?]);
        }
        let entries = value.array()?;
        let only = entries.len() == 1;
        let named = |entry: &TomlValue<'a>| if only { entry.table_at(value.path()) } else { entry.table() };
        entries.iter().map(named).collect()
    }

    /// Reads the table and then refuses the first key that was not asked for.
    ///
    /// # Arguments
    /// * `read` - asks for every key that may be here
    ///
    /// # Errors
    /// Those of `read`, then those of [`Self::refuse_unknown`].
    pub fn read<T>(self, read: impl FnOnce(&Self) -> ReadResult<T>) -> ReadResult<T> {
        let value = read(&self)?;
        self.refuse_unknown(&[])?;
        Ok(value)
    }

    /// Refuses the first key that nobody has asked for, and nobody will: it is reported before what is missing because of it.
    ///
    /// # Arguments
    /// * `later` - keys that may be here and have not been asked for yet
    ///
    /// # Errors
    /// The unknown key, its line, the nearest right name and all the names allowed here.
    pub fn refuse_unknown(&self, later: &[&'static str]) -> ReadResult<()> {
        let mut allowed = self.asked.borrow().clone();
        allowed.extend(later.iter().filter(|key| !allowed.contains(key)).copied().collect::<Vec<_>>());
        let unknown = self.unasked().filter(|(_, name)| !allowed.contains(name));
        match unknown.min_by_key(|(start, _)| *start) {
            None => Ok(()),
            Some((_, name)) => Err(self.unknown(name, &allowed)),
        }
    }

    /// An error about a key of this table, at its line or else at the table's.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    /// * `problem` - what is wrong and what is allowed
    pub fn error(&self, key: &str, problem: impl Into<String>) -> TomlError {
        let entry = self.table.and_then(|table| table.get_key_value(key));
        let value = entry.map(|(_, value)| written(self.text, value)).unwrap_or_default();
        let position = entry.map(|(key, _)| key.span().start).or(self.position);
        let line = position.map(|position| line_at(self.text, position));
        TomlError::new(self.path_of(key), value, problem).at_line(line)
    }

    fn remember(&self, key: &'static str) {
        let mut asked = self.asked.borrow_mut();
        if !asked.contains(&key) {
            asked.push(key);
        }
    }

    fn unasked(&self) -> impl Iterator<Item = (usize, &'a str)> {
        let asked = self.asked.borrow().clone();
        self.table
            .into_iter()
            .flat_map(|table| table.keys())
            .map(|key| (key.span().start, key.get_ref().as_ref()))
            .filter(move |(_, name)| !asked.contains(name))
    }

    /// A key that is missing while a misspelt one stands in its place: the misspelt one is the
    /// mistake that the user has to mend.
    ///
    /// # Arguments
    /// * `key` - its name in this table
    ///
    /// # Errors
    /// A key that nobody has asked for looks like this one misspelt.
    pub fn refuse_misspelling_of(&self, key: &'static str) -> ReadResult<()> {
        self.refuse_misspelling(key, None)
    }

    /// Does what [`Self::refuse_misspelling_of`] does, and names the right unit to a user who wrote another one.
    fn refuse_misspelling(&self, key: &'static str, meaning: Option<&str>) -> ReadResult<()> {
        let Some((_, name)) =
            self.unasked().find(|(_, name)| is_misspelling(name, key) || is_rpm_of(name, key))
        else {
            return Ok(());
        };
        let is =
            meaning.filter(|_| has_another_unit(name, key)).map(|meaning| format!(", which is {meaning}"));
        // Which other keys are allowed is not known yet: they have not been asked for.
        Err(self
            .error(name, format!("unknown key, while `{key}` is missing{}", is.unwrap_or_default()))
            .of_kind(ErrorKind::UnknownKey)
            .with_help(self.meant(name, key)))
    }

    /// The key that is meant, with its value where that is of revolutions per minute.
    fn meant(&self, name: &str, key: &str) -> String {
        let value = self.table.and_then(|table| table.get_key_value(name));
        let number =
            value.and_then(|(_, value)| written(self.text, value).replace('_', "").parse::<f64>().ok());
        match number.filter(|rpm| rpm.is_finite() && is_rpm_of(name, key)) {
            Some(rpm) => format!(
                "did you mean `{key}`? Write `{key} = {}`: revolutions per second, a sixtieth of those per minute",
                rpm / 60.0
            ),
            None => format!("did you mean `{key}`?"),
        }
    }

    /// A key that is missing here while it stands in the table around.
    fn refuse_outside(&self, key: &str) -> ReadResult<()> {
        let Some((name, value)) = self.around.and_then(|around| around.get_key_value(key)) else {
            return Ok(());
        };
        let problem = format!("stands outside of its section, `[{}]`", self.path);
        Err(TomlError::new(key, written(self.text, value), problem)
            .of_kind(ErrorKind::UnknownKey)
            .at_line(Some(line_at(self.text, name.span().start)))
            .with_help(format!(
                "write [{}] on a line above it, and every other key below its own section",
                self.path
            )))
    }

    /// The keys of which a name says only what, and not whose: of `addendum` those of pinion and gear.
    fn whose(&self, name: &str) -> Vec<String> {
        let is_of = |key: &&&str| key.strip_suffix(name).is_some_and(|owner| owner.ends_with('_'));
        self.asked.borrow().iter().filter(is_of).map(|key| format!("`{key}`")).collect()
    }

    fn unknown(&self, name: &str, keys: &[&str]) -> TomlError {
        let (allowed, nearest) = (keys.join(", "), nearest_name(name, keys.iter().copied()));
        let place = match self.path.as_str() {
            "" => "at the top level".to_string(),
            path => format!("in `{path}`"),
        };
        let error = self.error(name, format!("unknown key; allowed {place}: {allowed}"));
        let several = self.whose(name);
        error.of_kind(ErrorKind::UnknownKey).with_help(match nearest {
            _ if (2..=MOST_OWNERS).contains(&several.len()) => {
                format!("did you mean {}?", several.join(" or "))
            }
            Some(nearest) => self.meant(name, nearest),
            None => "remove it, or move it to the section it belongs to".to_string(),
        })
    }
}
