//! One value of a TOML text.

use std::ops::RangeInclusive;

use toml::Spanned;
use toml::de::DeValue;

use crate::document::{line_at, written};
use crate::{ErrorKind, ReadResult, TomlError, TomlTable, nearest_name};

/// Most tables of a list: what compares each with all others takes no time then.
const MOST_TABLES: usize = 1000;

/// One value of a TOML text, with its key and line.
#[derive(Debug, Clone)]
pub struct TomlValue<'a> {
    text: &'a str,
    path: String,
    /// Byte position that errors point at: the key, or an array's entry.
    position: usize,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> TomlValue<'a> {
    pub(crate) fn new(text: &'a str, path: String, position: usize, value: &'a Spanned<DeValue<'a>>) -> Self {
        Self { text, path, position, value }
    }

    /// The dotted key.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The 1-based line.
    pub fn line(&self) -> usize {
        line_at(self.text, self.position)
    }

    /// An error about this value.
    ///
    /// # Arguments
    /// * `problem` - what is wrong and what is allowed
    pub fn error(&self, problem: impl Into<String>) -> TomlError {
        TomlError::new(&self.path, written(self.text, self.value), problem).at_line(Some(self.line()))
    }

    /// Returns whether the value is a table.
    pub fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }

    /// Returns whether the value is a whole number.
    pub fn is_whole(&self) -> bool {
        self.value.get_ref().is_integer()
    }

    /// Returns whether the value is a text.
    pub fn is_text(&self) -> bool {
        self.value.get_ref().is_str()
    }

    /// Returns whether the value is an array.
    pub fn is_array(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// A finite number; an integer is taken for one.
    ///
    /// # Errors
    /// The value is of another type, not a number (`nan`) or infinite.
    pub fn number(&self) -> ReadResult<f64> {
        let number = match self.value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => {
                i128::from_str_radix(integer.as_str(), integer.radix()).ok().map(|number| number as f64)
            }
            _ => return Err(self.wrong_type("a number")),
        };
        number.filter(|number| number.is_finite()).ok_or_else(|| self.error("must be a finite number"))
    }

    /// An integer in a range.
    ///
    /// # Arguments
    /// * `allowed` - the range
    ///
    /// # Errors
    /// The value is of another type (a float counts as one, even `17.0`) or out of range.
    pub fn integer(&self, allowed: RangeInclusive<u64>) -> ReadResult<u64> {
        let DeValue::Integer(integer) = self.value.get_ref() else {
            return Err(self.wrong_type("a whole number, written without a decimal point"));
        };
        u64::from_str_radix(integer.as_str(), integer.radix())
            .ok()
            .filter(|number| allowed.contains(number))
            .ok_or_else(|| {
                let (first, last) = (allowed.start(), allowed.end());
                self.error(format!("must be a whole number from {first} to {last}"))
            })
    }

    /// `true` or `false`.
    ///
    /// # Errors
    /// The value is of another type.
    pub fn boolean(&self) -> ReadResult<bool> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong_type("true or false"))
    }

    /// A text.
    ///
    /// # Errors
    /// The value is of another type.
    pub fn string(&self) -> ReadResult<&'a str> {
        self.value.get_ref().as_str().ok_or_else(|| self.wrong_type("text in double quotes"))
    }

    /// One of several names.
    ///
    /// # Arguments
    /// * `choices` - each name and what it stands for
    ///
    /// # Errors
    /// The value is of another type or none of the names; the nearest one is suggested.
    pub fn choice<T: Clone>(&self, choices: &[(&str, T)]) -> ReadResult<T> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        Ok(choices[self.one_of(&names)?].1.clone())
    }

    /// Finds the index of the value in a list of names.
    ///
    /// # Arguments
    /// * `names` - the names that are allowed
    ///
    /// # Errors
    /// Those of [`Self::choice`].
    pub fn one_of(&self, names: &[&str]) -> ReadResult<usize> {
        let listed = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        let Some(written) = self.value.get_ref().as_str() else {
            return Err(self.wrong_type(&format!("one of {listed}")));
        };
        if let Some(index) = names.iter().position(|name| *name == written) {
            return Ok(index);
        }
        let error = self.error(format!("must be one of {listed}"));
        if let Some(right) = names.iter().find(|name| name.to_lowercase() == written.to_lowercase()) {
            return Err(error.with_help(format!("write \"{right}\": large and small letters count")));
        }
        Err(match nearest_name(written, names.iter().copied()) {
            Some(nearest) => error.with_help(format!("did you mean \"{nearest}\"?")),
            None => error,
        })
    }

    /// The entries of an array; entry n has the key `name[n]`, counted from 0.
    ///
    /// # Errors
    /// The value is of another type, or a list of more than a thousand tables.
    pub fn array(&self) -> ReadResult<Vec<TomlValue<'a>>> {
        let DeValue::Array(entries) = self.value.get_ref() else {
            return Err(self.wrong_type("an array, [ … ]"));
        };
        let count = entries.len();
        if count > MOST_TABLES && entries.first().is_some_and(|entry| entry.get_ref().is_table()) {
            return Err(self.error(format!("has {count} entries; must have {MOST_TABLES} at most")));
        }
        let entry = |(index, value): (usize, &'a Spanned<DeValue<'a>>)| {
            TomlValue::new(self.text, format!("{}[{index}]", self.path), value.span().start, value)
        };
        Ok(entries.iter().enumerate().map(entry).collect())
    }

    /// An array of finite numbers.
    ///
    /// # Errors
    /// The value is no array, or one of its entries is no finite number.
    pub fn numbers(&self) -> ReadResult<Vec<f64>> {
        self.array()?.iter().map(Self::number).collect()
    }

    /// An array of exactly `N` finite numbers.
    ///
    /// # Errors
    /// Those of [`Self::numbers`], or there are more or fewer of them.
    pub fn exactly<const N: usize>(&self) -> ReadResult<[f64; N]> {
        <[f64; N]>::try_from(self.numbers()?)
            .map_err(|numbers| self.error(format!("has {} numbers; must have exactly {N}", numbers.len())))
    }

    /// The table.
    ///
    /// # Errors
    /// The value is of another type.
    pub fn table(&self) -> ReadResult<TomlTable<'a>> {
        self.table_at(&self.path)
    }

    /// The table, under another key than its own.
    pub(crate) fn table_at(&self, path: &str) -> ReadResult<TomlTable<'a>> {
        match self.value.get_ref() {
            DeValue::Table(table) => {
                Ok(TomlTable::new(self.text, path.to_string(), Some(self.position), Some(table)))
            }
            _ => Err(self.wrong_type("a table, { key = value, … } or a [section]")),
        }
    }

    /// An error that says what type was wanted and which one was found.
    ///
    /// # Arguments
    /// * `wanted` - the type in plain words
    pub fn wrong_type(&self, wanted: &str) -> TomlError {
        let found = match self.value.get_ref() {
            DeValue::String(_) => "text",
            DeValue::Integer(_) => "a whole number",
            DeValue::Float(_) => "a number with a decimal point",
            DeValue::Boolean(_) => "true or false",
            DeValue::Datetime(_) => "a date or time",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        self.error(format!("must be {wanted}, not {found}")).of_kind(ErrorKind::WrongType)
    }
}
