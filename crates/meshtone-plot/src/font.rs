//! The font that comes with this crate: Open Sans (Apache License 2.0, see `font/LICENSE`).

use std::sync::{Arc, LazyLock};

use resvg::usvg::fontdb::Database;
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Value of `font-family` in the SVG: viewers without Open Sans take their own sans-serif.
pub(crate) const FAMILY: &str = "Open Sans, sans-serif";

static REGULAR: &[u8] = include_bytes!("../font/OpenSans-Regular.ttf");
static SEMIBOLD: &[u8] = include_bytes!("../font/OpenSans-Semibold.ttf");

/// The fonts for the rasteriser; read once.
pub(crate) fn database() -> Arc<Database> {
    static DATABASE: LazyLock<Arc<Database>> = LazyLock::new(|| {
        let mut database = Database::new();
        database.load_font_source(resvg::usvg::fontdb::Source::Binary(Arc::new(REGULAR)));
        database.load_font_source(resvg::usvg::fontdb::Source::Binary(Arc::new(SEMIBOLD)));
        database.set_sans_serif_family("Open Sans");
        Arc::new(database)
    });
    DATABASE.clone()
}

/// (px) Width of `text` at `size_px`.
pub(crate) fn text_width(text: &str, size_px: f64, bold: bool) -> f64 {
    let Ok(font) = FontRef::new(if bold { SEMIBOLD } else { REGULAR }) else {
        return 0.6 * size_px * text.chars().count() as f64;
    };
    let characters = font.charmap();
    let metrics = font.glyph_metrics(Size::new(size_px as f32), LocationRef::default());
    text.chars()
        .map(|character| {
            let glyph = characters.map(character).unwrap_or_default();
            f64::from(metrics.advance_width(glyph).unwrap_or_default())
        })
        .sum()
}

/// `text` on lines that are no wider than `width_px`; what does not fit on the last of them is left out.
pub(crate) fn wrapped(text: &str, width_px: f64, most_lines: usize, size_px: f64, bold: bool) -> Vec<String> {
    let fits = |line: &str| text_width(line, size_px, bold) <= width_px;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_have_every_character_that_figures_use() {
        for data in [REGULAR, SEMIBOLD] {
            let font = FontRef::new(data).unwrap();
            for character in "µ°²³·×−–…’θανσω≥0123456789 abcXYZ()/".chars() {
                assert!(font.charmap().map(character).is_some(), "{character}");
            }
        }
    }

    #[test]
    fn widths_add_up_and_grow_with_size() {
        let width = |text, size| text_width(text, size, false);
        assert!((width("ab", 12.0) - width("a", 12.0) - width("b", 12.0)).abs() < 1e-9);
        assert!((width("ab", 24.0) / width("ab", 12.0) - 2.0).abs() < 1e-3);
        assert!(text_width("mesh", 12.0, true) > width("mesh", 12.0));
    }

    #[test]
    fn long_texts_are_wrapped_and_cut() {
        let lines = |text, most| wrapped(text, 100.0, most, 12.5, false);
        assert_eq!(lines("tip loss 3 mm", 3), ["tip loss 3 mm"]);
        assert_eq!(lines("chip with a tip loss of 3 mm", 3), ["chip with a tip", "loss of 3 mm"]);
        for text in
            ["chip with a tip loss of 3 mm and more", "chip_with_a_tip_loss_of_3_mm_and_more", "", "a"]
        {
            for most in 1..4 {
                let lines = lines(text, most);
                assert!(lines.len() <= most);
                assert!(lines.iter().all(|line| text_width(line, 12.5, false) <= 100.0), "{lines:?}");
            }
        }
        assert!(lines("chip with a tip loss of 3 mm and more", 1)[0].ends_with('…'));
    }
}
