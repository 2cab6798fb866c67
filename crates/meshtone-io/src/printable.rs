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
        // Marks of direction make a terminal show text in another order.
        let is_obeyed =
            character.is_control() || matches!(character, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if is_obeyed && !kept.contains(&character) {
            shown.extend(character.escape_default());
        } else {
            shown.push(character);
        }
    }
    shown
}
