//! Finding a dotted key in a parsed text.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Location of a key, or of the nearest table or array around it.
pub(crate) struct Found<'t> {
    /// Byte position.
    pub start: usize,
    /// The key's own value; none where only something around it was found.
    pub value: Option<&'t Spanned<DeValue<'t>>>,
}

/// Finds `key`, or else the nearest table or array around it.
pub(crate) fn find<'t>(root: &'t DeTable<'t>, key: &str) -> Option<Found<'t>> {
    let mut table = Some(root);
    let mut found: Option<Found<'t>> = None;
    for segment in key.split('.') {
        let (name, indices) = split_indices(segment);
        let Some((written, mut value)) = table.and_then(|table| table.get_key_value(name)) else {
            return found.map(|around| Found { value: None, ..around });
        };
        let mut start = written.span().start;
        for index in indices {
            let entry = index.and_then(|index| value.get_ref().as_array()?.get(index));
            let Some(entry) = entry else {
                return Some(Found { start, value: None });
            };
            value = entry;
            start = value.span().start;
        }
        table = value.get_ref().as_table().or_else(|| only_table(value));
        found = Some(Found { start, value: Some(value) });
    }
    found
}

/// The table of a list that has no other: its keys are named without a number.
fn only_table<'t>(value: &'t Spanned<DeValue<'t>>) -> Option<&'t DeTable<'t>> {
    let entries = value.get_ref().as_array()?;
    entries.first().filter(|_| entries.len() == 1)?.get_ref().as_table()
}

fn split_indices(segment: &str) -> (&str, impl Iterator<Item = Option<usize>>) {
    let (name, rest) = segment.split_at(segment.find('[').unwrap_or(segment.len()));
    let indices = rest.split('[').skip(1).map(|part| part.strip_suffix(']')?.parse().ok());
    (name, indices)
}
