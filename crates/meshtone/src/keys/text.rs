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

/// A table on one line.
pub(crate) fn inline_table(entries: &[(String, String)]) -> String {
    let entries: Vec<_> = entries.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    format!("{{ {} }}", entries.join(", "))
}
