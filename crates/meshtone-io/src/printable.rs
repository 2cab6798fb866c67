//! Text as it may reach a terminal.

use std::fmt::Display;

/// The text with its control characters as escapes, such as `\u{1b}`: a name that comes from a file may hold any, and a terminal obeys them.
///
/// # Arguments
/// * `text` - the text
/// * `kept` - control characters that stay
///
/// ```
/// use meshtone_io::printable::printable;
///
/// assert_eq!(printable("column \x1b[2J", &[]), "column \\u{1b}[2J");
/// ```
pub fn printable(text: impl Display, kept: &[char]) -> String {
    let mut shown = String::new();
    for character in text.to_string().chars() {
        if character.is_control() && !kept.contains(&character) {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    shown
}
