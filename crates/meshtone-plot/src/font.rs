//! The font that comes with this crate: Open Sans (Apache License 2.0, see `font/LICENSE`).
//!
//! It has no kerning and no ligatures, so a text is its characters one after the other, and as wide as the sum of
//! their widths.

use std::sync::LazyLock;

use tiny_skia_path::{Path, PathBuilder, Transform};
use ttf_parser::{Face, GlyphId, OutlineBuilder};
use unicode_normalization::UnicodeNormalization;

/// Value of `font-family` in the SVG: viewers without Open Sans take their own sans-serif.
pub(crate) const FAMILY: &str = "Open Sans, sans-serif";

static REGULAR: &[u8] = include_bytes!("../font/OpenSans-Regular.ttf");
static SEMIBOLD: &[u8] = include_bytes!("../font/OpenSans-Semibold.ttf");

/// One of the font's weights, read once.
fn face(bold: bool) -> Option<&'static Face<'static>> {
    static FACES: LazyLock<[Option<Face>; 2]> =
        LazyLock::new(|| [REGULAR, SEMIBOLD].map(|data| Face::parse(data, 0).ok()));
    FACES[usize::from(bold)].as_ref()
}

/// The glyphs of a text, a box in the place of each character that the font does not have, with how far each moves the next one, in
/// units of the font.
fn glyphs<'t>(face: &'t Face, text: &'t str) -> impl Iterator<Item = (GlyphId, u16)> + 't {
    text.nfc().filter(|&character| !is_invisible(character)).map(|character| {
        let id = face.glyph_index(character).unwrap_or_default();
        (id, face.glyph_hor_advance(id).unwrap_or_default())
    })
}

/// Characters that only steer how their neighbours are set.
fn is_invisible(character: char) -> bool {
    matches!(character, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2064}'
        | '\u{fe00}'..='\u{fe0f}' | '\u{feff}')
}

fn scale(face: &Face, size_px: f64) -> f64 {
    size_px / f64::from(face.units_per_em())
}

/// (px) Width of `text` at `size_px`.
pub(crate) fn text_width(text: &str, size_px: f64, bold: bool) -> f64 {
    let Some(face) = face(bold) else { return 0.6 * size_px * text.chars().count() as f64 };
    let advances = glyphs(face, text).map(|(_, advance)| u32::from(advance)).sum::<u32>();
    scale(face, size_px) * f64::from(advances)
}

/// The outlines of a text from the start of its baseline, in pixels, y downwards; none of a text without ink.
///
/// # Arguments
/// * `text` - the text
/// * `size_px` - (px) its size
/// * `bold` - whether it is semibold
pub(crate) fn outline(text: &str, size_px: f64, bold: bool) -> Option<Path> {
    let face = face(bold)?;
    let mut pen = Pen { path: PathBuilder::new(), left: 0.0 };
    for (id, advance) in glyphs(face, text) {
        face.outline_glyph(id, &mut pen);
        pen.left += f32::from(advance);
    }
    let scale = scale(face, size_px) as f32;
    pen.path.finish()?.transform(Transform::from_scale(scale, -scale))
}

/// Draws glyphs beside each other, in units of the font, y upwards.
struct Pen {
    path: PathBuilder,
    /// Left end of the glyph.
    left: f32,
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.left + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.left + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.left + x1, y1, self.left + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.left + x1, y1, self.left + x2, y2, self.left + x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_weights_have_every_character_that_figures_use() {
        for bold in [false, true] {
            for character in "µ°²³·×−–…’θανσω≥0123456789 abcXYZ()/".chars() {
                assert!(face(bold).unwrap().glyph_index(character).is_some(), "{character}");
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
    fn outlines_fill_the_width() {
        for (text, bold) in [("Hm", false), ("Über 17 µm", true)] {
            let bounds = outline(text, 50.0, bold).unwrap().bounds();
            let width = text_width(text, 50.0, bold) as f32;
            // Letters have some pixels of space beside them.
            assert!(bounds.left() > 0.0 && bounds.left() < 6.0 && width - bounds.right() < 6.0, "{bounds:?}");
            assert!(bounds.right() < width && bounds.top() < -30.0, "{bounds:?}");
        }
        assert_eq!(outline(" ", 50.0, false), None);
    }

    #[test]
    fn letters_and_their_accents_are_one_character() {
        assert_eq!(outline("Pru\u{308}fstand", 12.0, false), outline("Prüfstand", 12.0, false));
        assert_eq!(text_width("u\u{308}\u{200b}", 12.0, false), text_width("ü", 12.0, false));
    }

    #[test]
    fn characters_that_the_font_lacks_are_boxes() {
        assert!(outline("歯", 12.0, false).is_some() && text_width("歯", 12.0, false) > 0.0);
    }
}
