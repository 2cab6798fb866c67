//! A parsed TOML text.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::key_path::find;
use crate::{ErrorKind, ReadResult, TomlError, TomlTable};

/// A parsed TOML text, to be read through [`TomlDocument::root`].
#[derive(Debug)]
pub struct TomlDocument<'i> {
    text: &'i str,
    root: DeTable<'i>,
}

impl<'i> TomlDocument<'i> {
    /// Parses a text.
    ///
    /// # Arguments
    /// * `text` - the TOML text
    ///
    /// # Errors
    /// The first place where the text is not TOML: its line, what is written there, and what the
    /// parser expected. Its key is empty.
    pub fn parse(text: &'i str) -> ReadResult<Self> {
        match DeTable::parse(text) {
            Ok(root) => Ok(Self { text, root: root.into_inner() }),
            Err(error) => Err(syntax_error(text, &error)),
        }
    }

    /// The table of the top-level keys.
    pub fn root(&self) -> TomlTable<'_> {
        TomlTable::new(self.text, String::new(), None, Some(&self.root))
    }

    /// The text without layout and comments: whole numbers are numbers like others, and keys are in the order of their names. Texts that
    /// state the same keys and values have the same canonical one.
    ///
    /// # Arguments
    /// * `but` - top-level keys to leave out
    ///
    /// ```
    /// use meshtone_toml::TomlDocument;
    ///
    /// let canonical = |text| TomlDocument::parse(text).map(|document| document.canonical(&["title"]));
    /// assert_eq!(canonical("b = 2 # two\na = [1.0]\ntitle = 'x'")?, canonical("a = [\n1,\n]\nb = 2.0")?);
    /// assert_ne!(canonical("seed = 18446744073709551615")?, canonical("seed = 18446744073709551614")?);
    /// # Ok::<(), meshtone_toml::TomlError>(())
    /// ```
    pub fn canonical(&self, but: &[&str]) -> String {
        canonical_keys(&self.root, but).into_iter().map(|key| key + "\n").collect()
    }

    /// The 1-based line of a key; where the text leaves the key out, that of the nearest table
    /// around it; none where it has neither.
    ///
    /// # Arguments
    /// * `key` - dotted key; `[n]` after a name is the array's entry n, counted from 0
    pub fn line_of_key(&self, key: &str) -> Option<usize> {
        find(&self.root, key).map(|found| line_at(self.text, found.start))
    }

    /// A key's value as it is written, shortened; none where the text leaves it out or where it
    /// is a section.
    ///
    /// # Arguments
    /// * `key` - as for [`Self::line_of_key`]
    pub fn value_as_written(&self, key: &str) -> Option<String> {
        let value = find(&self.root, key)?.value?;
        Some(written(self.text, value)).filter(|written| !written.is_empty())
    }

    /// Returns the error about a key of this text, with the key's line and its value as written.
    ///
    /// # Arguments
    /// * `error` - found after reading
    pub fn locate(&self, error: impl Into<TomlError>) -> TomlError {
        let mut error = error.into();
        if error.line.is_none() {
            error.line = self.line_of_key(&error.key);
            if let Some(written) = self.value_as_written(&error.key) {
                error.value = written;
            }
        }
        error
    }
}

fn syntax_error(text: &str, error: &toml::de::Error) -> TomlError {
    let start = error.span().map_or(text.len(), |span| span.start).min(text.len());
    let line = line_at(text, start);
    let written = text.lines().nth(line - 1).unwrap_or_default().trim();
    let is_twice = error.message().contains("duplicate key");
    let help = syntax_help(written, is_twice);
    TomlError::new("", shorten(written), format!("not valid TOML: {}", error.message()))
        .of_kind(ErrorKind::NotToml)
        .with_help(help)
        .at_line(Some(line))
}

/// Advice on what to write instead of a line.
///
/// # Arguments
/// * `written` - the line
/// * `is_twice` - whether what it names is there already
fn syntax_help(written: &str, is_twice: bool) -> String {
    // A table stands once, or is one of a list from its first time on.
    if written.starts_with("[[") {
        return "write the table's name in double brackets wherever it stands, the first time too".to_owned();
    }
    if let Some(name) = written.strip_prefix('[').and_then(|rest| rest.split(']').next()).filter(|_| is_twice)
    {
        return format!(
            "write all its keys below one [{name}]; or, where several are allowed, [[{name}]] in double brackets above each, the \
             first too"
        );
    }
    match (written.split_once('='), is_twice) {
        (Some((key, _)), true) => format!("write `{}` once", key.trim()),
        (Some((key, value)), false) => match with_decimal_point(value) {
            Some(number) => format!("write a decimal point: {} = {number}", key.trim()),
            None => GENERAL_HELP.to_owned(),
        },
        _ => GENERAL_HELP.to_owned(),
    }
}

const GENERAL_HELP: &str = "write `key = value`, one key a line, text in double quotes, below a `[section]`";

/// `5,0` as `5.0`; none of anything else.
fn with_decimal_point(value: &str) -> Option<String> {
    let number = value.split('#').next().unwrap_or_default().trim();
    let (whole, part) = number.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (digits(whole.trim_start_matches(['-', '+'])) && digits(part)).then(|| format!("{whole}.{part}"))
}

/// A value on one line, as [`TomlDocument::canonical`] has it.
fn canonical(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("{text:?}"),
        DeValue::Integer(integer) => {
            let number = i128::from_str_radix(integer.as_str(), integer.radix());
            // A seed may have more digits than a float.
            match number {
                Ok(number) if (number as f64) as i128 == number => format!("{:?}", number as f64),
                Ok(number) => number.to_string(),
                Err(_) => integer.as_str().to_owned(),
            }
        }
        DeValue::Float(float) => match float.as_str().parse::<f64>() {
            Ok(number) => format!("{number:?}"),
            Err(_) => float.as_str().to_owned(),
        },
        DeValue::Boolean(value) => value.to_string(),
        DeValue::Datetime(value) => value.to_string(),
        DeValue::Array(values) => {
            let values: Vec<String> = values.iter().map(|value| canonical(value.get_ref())).collect();
            format!("[{}]", values.join(", "))
        }
        DeValue::Table(table) => format!("{{{}}}", canonical_keys(table, &[]).join(", ")),
    }
}

/// The keys of a table with their values, in the order of their names.
///
/// # Arguments
/// * `but` - keys to leave out
fn canonical_keys(table: &DeTable<'_>, but: &[&str]) -> Vec<String> {
    let kept = table.iter().filter(|(key, _)| !but.contains(&key.get_ref().as_ref()));
    let mut keys: Vec<_> = kept.collect();
    keys.sort_by(|a, b| a.0.get_ref().cmp(b.0.get_ref()));
    keys.into_iter()
        .map(|(key, value)| format!("{:?} = {}", key.get_ref(), canonical(value.get_ref())))
        .collect()
}

/// The 1-based line of a byte position.
pub(crate) fn line_at(text: &str, position: usize) -> usize {
    let before = &text.as_bytes()[..position.min(text.len())];
    1 + before.iter().filter(|&&byte| byte == b'\n').count()
}

/// A value as written, on one line and of bounded length; empty for a section, which is not
/// written in one place.
pub(crate) fn written(text: &str, value: &Spanned<DeValue<'_>>) -> String {
    let source = text.get(value.span()).unwrap_or_default();
    if value.get_ref().is_table() && !source.starts_with('{') {
        return String::new();
    }
    let mut lines = source.lines();
    let first = shorten(lines.next().unwrap_or_default());
    if lines.next().is_some() { format!("{first} …") } else { first }
}

fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        return text.to_string();
    }
    text.chars().take(LONGEST).chain([' ', '…']).collect()
}
