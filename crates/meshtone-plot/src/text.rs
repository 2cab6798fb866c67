//! Text that must fit.

use crate::font;
use crate::style::TextStyle;

/// The text, shortened in its middle where it is wider than `width_px`.
pub(crate) fn fitted(text: &str, style: TextStyle, width_px: f64) -> String {
    let fits = |text: &str| font::text_width(text, style.size, style.bold) <= width_px;
    if fits(text) {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let shortened = |kept: usize| {
        let (head, tail) = (kept.div_ceil(2), kept / 2);
        letters[..head].iter().chain(&['…']).chain(&letters[letters.len() - tail..]).collect::<String>()
    };
    (0..letters.len()).rev().map(shortened).find(|text| fits(text)).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_lose_their_middle() {
        assert_eq!(fitted("mesh", TextStyle::NOTE, 100.0), "mesh");
        let short = fitted(&"recording".repeat(20), TextStyle::NOTE, 100.0);
        assert!(short.starts_with("rec") && short.ends_with("ing") && short.contains('…'), "{short}");
        assert!(font::text_width(&short, TextStyle::NOTE.size, false) <= 100.0);
    }
}
