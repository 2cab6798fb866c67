//! Values as TOML.

/// The shortest text that is read back as the same number, with a decimal point or an exponent.
pub(crate) fn number(value: f64) -> String {
    // Debug writes `NaN`, which is not TOML; the reader refuses `nan` in its own words.
    if value.is_nan() { "nan".to_string() } else { format!("{value:?}") }
}

/// A number as one writes it: 1.9e8 rather than 190000000.0.
pub(crate) fn short_number(value: f64) -> String {
    let (plain, scientific) = (format!("{value:?}"), format!("{value:e}"));
    if scientific.len() + 1 < plain.len() { scientific } else { plain }
}

/// The entries of an array.
pub(crate) fn array(values: impl IntoIterator<Item = f64>) -> String {
    format!("[{}]", values.into_iter().map(number).collect::<Vec<_>>().join(", "))
}

/// Keys with their values, each on its own line.
pub(super) fn lines(entries: &[(String, String)]) -> String {
    entries.iter().map(|(name, value)| format!("{name} = {value}\n")).collect()
}

/// A table on one line.
pub(crate) fn inline_table(entries: &[(String, String)]) -> String {
    let entries: Vec<_> = entries.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    format!("{{ {} }}", entries.join(", "))
}

/// An inline table with its large numbers as a reader finds them easiest to read.
pub(super) fn with_short_numbers(text: &str) -> String {
    const LARGE: f64 = 1e5;
    let short = |word: &str| {
        let (number, comma) = word.strip_suffix(',').map_or((word, ""), |number| (number, ","));
        let large = number.parse().ok().filter(|value: &f64| value.is_finite() && value.abs() >= LARGE);
        large.map_or(word.to_owned(), |value| short_number(value) + comma)
    };
    text.split(' ').map(short).collect::<Vec<_>>().join(" ")
}

/// Names as a file has them, one after the other.
pub(super) fn quoted(names: &[&str]) -> String {
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
