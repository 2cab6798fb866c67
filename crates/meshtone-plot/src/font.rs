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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_have_every_character_that_figures_use() {
        for data in [REGULAR, SEMIBOLD] {
            let font = FontRef::new(data).unwrap();
            for character in "µ°²³·×−–θαω≥0123456789 abcXYZ()/".chars() {
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
}
