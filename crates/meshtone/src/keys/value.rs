//! Values of keys: how they are read, written and checked.

use meshtone_toml::{ReadResult, TomlValue};

use super::check::Check;
use super::description::{KeyDescription, KeyKind};
use super::files::NumberFiles;
use super::range::Range;
use super::table::{Keys, check_keys, describe_from, read_keys, written_pairs};
use super::text::{array, inline_table, number};

/// Written form of a key's value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Written {
    /// The key is left out.
    Nothing,
    /// The value.
    Value(String),
    /// Keys inside it, each on its own line with its dotted name.
    Lines(Vec<(String, String)>),
}

impl Written {
    /// A table of keys, each on its own line or all on one.
    fn table(pairs: Vec<(String, String)>, in_lines: bool) -> Self {
        match pairs {
            pairs if pairs.is_empty() => Self::Nothing,
            pairs if in_lines => Self::Lines(pairs),
            pairs => Self::Value(inline_table(&pairs)),
        }
    }
}

/// A value that a key may have.
pub(crate) trait KeyValue: Clone + PartialEq + 'static {
    /// Reads it over what is there, which is the default.
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()>;

    /// Its written form.
    fn write(&self) -> Written;

    /// Checks whether its numbers are allowed.
    fn check(&self, _key: &str, _range: &Range, _unit: &str) -> Check {
        Ok(())
    }

    /// Kind of the value.
    fn kind() -> KeyKind;

    /// The keys inside it.
    fn inside(&self) -> Vec<KeyDescription> {
        Vec::new()
    }
}

impl KeyValue for f64 {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.number()?;
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(number(*self))
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        range.check(key, *self, format_args!("{self:?}"), unit)
    }

    fn kind() -> KeyKind {
        KeyKind::Number
    }
}

macro_rules! whole_numbers {
    ($($type:ty),+) => {$(
        impl KeyValue for $type {
            fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
                // What is more than the type can hold is refused with what is more than the key may have.
                *self = <$type>::try_from(value.integer(0..=u64::MAX)?).unwrap_or(<$type>::MAX);
                Ok(())
            }

            fn write(&self) -> Written {
                Written::Value(self.to_string())
            }

            fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
                range.check(key, *self as f64, format_args!("{self}"), unit)
            }

            fn kind() -> KeyKind {
                KeyKind::Whole
            }
        }
    )+};
}
whole_numbers!(u8, u32, u64, usize);

impl<const N: usize> KeyValue for [f64; N] {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.exactly()?;
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(array(self.iter().copied()))
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        check_entries(self, key, range, unit)
    }

    fn kind() -> KeyKind {
        KeyKind::Numbers(N)
    }
}

/// Each number of an array, under its place in it.
fn check_entries(entries: &[f64], key: &str, range: &Range, unit: &str) -> Check {
    let mut entries = entries.iter().enumerate();
    entries.try_for_each(|(index, entry)| {
        entry.check(key, range, unit).map_err(|error| error.with_key(format!("{key}[{index}]")))
    })
}

/// A list whose length other keys state.
impl KeyValue for Vec<f64> {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.numbers()?;
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(array(self.iter().copied()))
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        check_entries(self, key, range, unit)
    }

    fn kind() -> KeyKind {
        KeyKind::List
    }
}

/// A value that may be left out.
impl<V: KeyValue + Default> KeyValue for Option<V> {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        self.insert(V::default()).read(value, files)
    }

    fn write(&self) -> Written {
        self.as_ref().map_or(Written::Nothing, KeyValue::write)
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        self.as_ref().map_or(Ok(()), |value| value.check(key, range, unit))
    }

    fn kind() -> KeyKind {
        V::kind()
    }
}

/// A text.
impl KeyValue for String {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.string()?.to_string();
        Ok(())
    }

    fn write(&self) -> Written {
        Written::Value(toml::Value::from(self.as_str()).to_string())
    }

    fn kind() -> KeyKind {
        KeyKind::Text
    }
}

/// Two texts.
impl KeyValue for [String; 2] {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        let entries = value.array()?;
        let texts: Vec<&str> = entries.iter().map(TomlValue::string).collect::<ReadResult<_>>()?;
        let [first, second] = texts[..] else {
            return Err(value.error(format!("has {} texts; must have two", texts.len())));
        };
        *self = [first, second].map(str::to_owned);
        Ok(())
    }

    fn write(&self) -> Written {
        let [first, second] = self.each_ref().map(|text| toml::Value::from(text.as_str()).to_string());
        Written::Value(format!("[{first}, {second}]"))
    }

    fn kind() -> KeyKind {
        KeyKind::Texts
    }
}

/// Rows of two numbers, as many as there are.
impl KeyValue for Vec<[f64; 2]> {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        *self = value.array()?.iter().map(TomlValue::exactly).collect::<ReadResult<_>>()?;
        Ok(())
    }

    fn write(&self) -> Written {
        let rows: Vec<String> = self.iter().map(|row| array(*row)).collect();
        if rows.is_empty() { Written::Nothing } else { Written::Value(format!("[{}]", rows.join(", "))) }
    }

    fn check(&self, key: &str, range: &Range, unit: &str) -> Check {
        let mut rows = self.iter().enumerate();
        rows.try_for_each(|(index, row)| check_entries(row, &format!("{key}[{index}]"), range, unit))
    }

    fn kind() -> KeyKind {
        KeyKind::Matrix
    }
}

/// Tables of keys of their own, as many as there are.
impl<S: Keys> KeyValue for Vec<S> {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let read = |entry: &TomlValue<'_>| {
            let mut section = S::start();
            entry.table()?.read(|table| read_keys(&mut section, table, files)).map(|()| section)
        };
        *self = value.array()?.iter().map(read).collect::<ReadResult<_>>()?;
        Ok(())
    }

    fn write(&self) -> Written {
        let tables: Vec<String> =
            self.iter().map(|section| inline_table(&written_pairs(&S::rows(), section))).collect();
        if tables.is_empty() { Written::Nothing } else { Written::Value(format!("[{}]", tables.join(", "))) }
    }

    fn check(&self, key: &str, _range: &Range, _unit: &str) -> Check {
        let mut sections = self.iter().enumerate();
        sections.try_for_each(|(index, section)| check_keys(section, &format!("{key}[{index}]")))
    }

    fn kind() -> KeyKind {
        KeyKind::Tables
    }

    fn inside(&self) -> Vec<KeyDescription> {
        describe_from(&S::start())
    }
}

/// A table of keys of its own.
impl<S: Keys> KeyValue for S {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        value.table()?.read(|table| read_keys(self, table, files))
    }

    fn write(&self) -> Written {
        Written::table(written_pairs(&S::rows(), self), S::IN_LINES)
    }

    fn check(&self, key: &str, _range: &Range, _unit: &str) -> Check {
        check_keys(self, key)
    }

    fn kind() -> KeyKind {
        KeyKind::Table
    }

    fn inside(&self) -> Vec<KeyDescription> {
        describe_from(self)
    }
}
