//! Writing sections and keys.

use std::fmt::Display;

use nalgebra::DMatrix;

/// The text of one section.
pub(super) struct Section {
    text: String,
}

impl Section {
    pub fn top_level() -> Self {
        Self { text: String::new() }
    }

    pub fn new(name: &str) -> Self {
        Self { text: format!("[{name}]\n") }
    }

    pub fn finish(self) -> String {
        self.text
    }

    /// A key with its value in TOML.
    pub fn raw(&mut self, key: &str, value: &str) -> &mut Self {
        self.text.extend([key, " = ", value, "\n"]);
        self
    }

    pub fn text(&mut self, key: &str, value: &str) -> &mut Self {
        self.raw(key, &format!("\"{value}\""))
    }

    pub fn whole(&mut self, key: &str, value: impl Display) -> &mut Self {
        self.raw(key, &value.to_string())
    }

    pub fn number(&mut self, key: &str, value: f64) -> &mut Self {
        self.raw(key, &number(value))
    }

    pub fn numbers(&mut self, key: &str, values: &[f64]) -> &mut Self {
        self.raw(key, &array(values.iter().copied()))
    }

    /// A table on one line.
    pub fn table(&mut self, key: &str, entries: &[(&str, f64)]) -> &mut Self {
        self.raw(key, &format!("{{ {} }}", pairs(entries)))
    }

    /// One line a row.
    pub fn matrix(&mut self, key: &str, matrix: &DMatrix<f64>) -> &mut Self {
        let rows = matrix.row_iter().map(|row| format!("    {},\n", array(row.iter().copied())));
        let rows: String = rows.collect();
        self.raw(key, &format!("[\n{rows}]"))
    }
}

/// The entries of a table on one line, without its braces.
pub(super) fn pairs(entries: &[(&str, f64)]) -> String {
    entries.iter().map(|(key, value)| format!("{key} = {}", number(*value))).collect::<Vec<_>>().join(", ")
}

fn array(values: impl Iterator<Item = f64>) -> String {
    format!("[{}]", values.map(number).collect::<Vec<_>>().join(", "))
}

/// The shortest text that is read back as the same number, with a decimal point or an exponent.
fn number(value: f64) -> String {
    // Debug writes `NaN`, which is not TOML; the reader refuses `nan` in its own words.
    if value.is_nan() { "nan".to_string() } else { format!("{value:?}") }
}
