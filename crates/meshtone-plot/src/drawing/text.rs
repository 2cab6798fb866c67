//! Text that must fit: its width, and how it is shortened and wrapped.

use super::style::TextStyle;
use crate::font;

impl TextStyle {
    /// (px) Width of `text` in this style.
    pub(crate) fn width(self, text: &str) -> f64 {
        font::text_width(text, self.size, self.bold)
    }

    /// The text, shortened in its middle where it is wider than `width_px`.
    pub(crate) fn fitted(self, text: &str, width_px: f64) -> String {
        let fits = |text: &str| self.width(text) <= width_px;
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

    /// `text` on lines that are no wider than `width_px`; what does not fit on the last of them is left out.
    pub(crate) fn wrapped(self, text: &str, width_px: f64, most_lines: usize) -> Vec<String> {
        let fits = |line: &str| self.width(line) <= width_px;
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            let mut rest = word.to_owned();
            if let Some(line) = lines.last_mut() {
                let longer = format!("{line} {word}");
                if fits(&longer) {
                    *line = longer;
                    continue;
                }
            }
            // A word that is wider than a line is cut.
            while !fits(&rest) && rest.chars().count() > 1 {
                let mut part = rest.clone();
                while !fits(&part) && part.chars().count() > 1 {
                    part.pop();
                }
                // Rather where it has a joint.
                if let Some(joint) = part.rfind(['_', '-', '/']).filter(|&joint| 2 * joint > part.len()) {
                    part.truncate(joint + 1);
                }
                rest = rest.split_off(part.len());
                lines.push(part);
            }
            lines.push(rest);
        }
        let cut = lines.len() > most_lines;
        lines.truncate(most_lines);
        if let Some(line) = lines.last_mut().filter(|_| cut) {
            while !fits(&format!("{line}…")) && line.pop().is_some() {}
            *line = format!("{}…", line.trim_end());
        }
        lines
    }
}

/// The text with a capital first letter.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_lose_their_middle() {
        assert_eq!(TextStyle::NOTE.fitted("mesh", 100.0), "mesh");
        let short = TextStyle::NOTE.fitted(&"recording".repeat(20), 100.0);
        assert!(short.starts_with("rec") && short.ends_with("ing") && short.contains('…'), "{short}");
        assert!(TextStyle::NOTE.width(&short) <= 100.0);
    }

    #[test]
    fn long_texts_are_wrapped_and_cut() {
        let lines = |text, most| TextStyle::NOTE.wrapped(text, 100.0, most);
        assert_eq!(lines("tip loss 3 mm", 3), ["tip loss 3 mm"]);
        assert_eq!(lines("chip with a tip loss of 3 mm", 3), ["chip with a tip", "loss of 3 mm"]);
        for text in
            ["chip with a tip loss of 3 mm and more", "chip_with_a_tip_loss_of_3_mm_and_more", "", "a"]
        {
            for most in 1..4 {
                let lines = lines(text, most);
                assert!(lines.len() <= most);
                assert!(lines.iter().all(|line| TextStyle::NOTE.width(line) <= 100.0), "{lines:?}");
            }
        }
        assert!(lines("chip with a tip loss of 3 mm and more", 1)[0].ends_with('…'));
    }
}
