//! A scene as an SVG document.
//!
//! Text stays text, to be searched and copied, in the font's name; a viewer without it takes its own sans-serif.

use std::fmt::{self, Display, Formatter, Write};

use crate::drawing::{
    Anchor, Fill, HALO_WIDTH, HATCH_ANGLE_DEG, HATCH_PITCH, HATCH_WIDTH, Stroke, TextStyle, colour,
};
use crate::font;
use crate::scene::{Element, Hundredths, Scene, ScenePoint};

/// The document.
///
/// # Arguments
/// * `scene` - what it shows
/// * `title`, `description` - for readers who cannot see it
pub(crate) fn document(scene: &Scene, title: &str, description: &str) -> String {
    let Scene { width, height, elements } = scene;
    let mut body = Body { text: String::with_capacity(1 << 17), hatches: Vec::new() };
    elements.iter().for_each(|element| body.push(element));
    let hatches: String = body.hatches.iter().enumerate().map(|(name, fill)| pattern(name, fill)).collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{}\" stroke-linejoin=\"round\" role=\"img\">\n\
         <title>{}</title>\n<desc>{}</desc>\n<defs>{hatches}</defs>\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n{}</svg>\n",
        font::FAMILY,
        escaped(title),
        escaped(description),
        colour::WHITE,
        body.text
    )
}

/// The elements, and the fills that the document must define for them.
struct Body {
    text: String,
    hatches: Vec<Fill>,
}

impl Body {
    fn push(&mut self, element: &Element) {
        match element {
            Element::Path { points, closed, stroke, fill } => self.path(points, *closed, *stroke, *fill),
            Element::Rectangles { corners, fill } => self.rectangles(corners, *fill),
            Element::Dots { centres, radius, fill } => self.dots(centres, (*radius).into(), *fill),
            Element::Text { at, text, style } => self.text(*at, text, *style),
        }
    }

    fn path(&mut self, points: &[ScenePoint], closed: bool, stroke: Option<Stroke>, fill: Option<Fill>) {
        self.text.push_str("<path d=\"");
        for (index, point) in points.iter().enumerate() {
            self.text.push(if index == 0 { 'M' } else { 'L' });
            self.write(format_args!("{} {}", point.x, point.y));
        }
        self.text.push_str(if closed { "Z\"" } else { "\"" });
        if let Some(Stroke { colour, width, dash }) = stroke {
            self.write(format_args!(" stroke=\"{colour}\" stroke-width=\"{}\"", Hundredths::from(width)));
            if !dash.is_empty() {
                let lengths: Vec<String> =
                    dash.iter().map(|&length| Hundredths::from(length).to_string()).collect();
                self.write(format_args!(" stroke-dasharray=\"{}\"", lengths.join(" ")));
            }
        }
        match fill {
            None => self.text.push_str(" fill=\"none\""),
            Some(fill) if fill.hatched => {
                let name = self.hatch(fill);
                self.write(format_args!(" fill=\"url(#hatch{name})\""));
            }
            Some(Fill { colour, opacity: 1.0, .. }) => self.write(format_args!(" fill=\"{colour}\"")),
            Some(fill) => self.translucent(fill),
        }
        self.text.push_str("/>\n");
    }

    fn rectangles(&mut self, corners: &[[ScenePoint; 2]], fill: Fill) {
        self.text.push_str("<path d=\"");
        for [from, to] in corners {
            let width = to.x.0.saturating_sub(from.x.0);
            let height = to.y.0.saturating_sub(from.y.0);
            let [width, height, back] = [width, height, -width].map(Hundredths);
            self.write(format_args!("M{} {}h{width}v{height}h{back}Z", from.x, from.y));
        }
        self.text.push('"');
        self.translucent(fill);
        self.text.push_str("/>\n");
    }

    fn dots(&mut self, centres: &[ScenePoint], radius: Hundredths, fill: Fill) {
        self.text.push_str("<g");
        self.translucent(fill);
        self.text.push_str(">\n");
        for centre in centres {
            let ScenePoint { x, y } = centre;
            self.write(format_args!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>\n"));
        }
        self.text.push_str("</g>\n");
    }

    fn text(&mut self, at: ScenePoint, text: &str, style: TextStyle) {
        let ScenePoint { x, y } = at;
        self.text.push_str("<text ");
        if style.upwards {
            self.write(format_args!("transform=\"translate({x} {y}) rotate(-90)\""));
        } else {
            self.write(format_args!("x=\"{x}\" y=\"{y}\""));
        }
        let size = Hundredths::from(style.size);
        self.write(format_args!(" font-size=\"{size}\" fill=\"{}\"", style.colour));
        if style.bold {
            self.text.push_str(" font-weight=\"600\"");
        }
        self.text.push_str(match style.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        });
        if style.halo {
            let (white, width) = (colour::WHITE, Hundredths::from(HALO_WIDTH));
            self.write(format_args!(
                " stroke=\"{white}\" stroke-width=\"{width}\" stroke-linejoin=\"round\" paint-order=\"stroke\""
            ));
        }
        self.write(format_args!(">{}</text>\n", escaped(text)));
    }

    fn translucent(&mut self, Fill { colour, opacity, .. }: Fill) {
        let opacity = Hundredths::from(opacity);
        self.write(format_args!(" fill=\"{colour}\" fill-opacity=\"{opacity}\""));
    }

    /// Number of the hatching in the document's definitions.
    fn hatch(&mut self, fill: Fill) -> usize {
        let known = self.hatches.iter().position(|hatch| hatch.colour == fill.colour);
        known.unwrap_or_else(|| {
            self.hatches.push(fill);
            self.hatches.len() - 1
        })
    }

    fn write(&mut self, text: fmt::Arguments) {
        // Writing to a string cannot fail.
        let _ = self.text.write_fmt(text);
    }
}

/// A number with at most two decimals.
impl Display for Hundredths {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let size = self.0.unsigned_abs();
        let (sign, whole) = (if self.0 < 0 { "-" } else { "" }, size / 100);
        // Whole numbers are written faster than fractions, and a figure is tens of thousands of numbers.
        match (size % 100, size % 10) {
            (0, _) => write!(f, "{sign}{whole}"),
            (rest, 0) => write!(f, "{sign}{whole}.{}", rest / 10),
            (rest, _) => write!(f, "{sign}{whole}.{rest:02}"),
        }
    }
}

/// Text with the characters that mean something to XML escaped.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn pattern(name: usize, fill: &Fill) -> String {
    let Fill { colour, opacity, .. } = fill;
    format!(
        "<pattern id=\"hatch{name}\" width=\"{HATCH_PITCH}\" height=\"{HATCH_PITCH}\" \
         patternUnits=\"userSpaceOnUse\" patternTransform=\"rotate({HATCH_ANGLE_DEG})\">\
         <rect width=\"{HATCH_PITCH}\" height=\"{HATCH_PITCH}\" fill=\"{colour}\" \
         fill-opacity=\"{opacity}\"/>\
         <rect width=\"{HATCH_WIDTH}\" height=\"{HATCH_PITCH}\" fill=\"{colour}\"/></pattern>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let short = |value: f64| Hundredths::from(value).to_string();
        assert_eq!(short(3.0), "3");
        assert_eq!(short(-0.5), "-0.5");
        assert_eq!(short(12.345), "12.35");
        assert_eq!(short(7.05), "7.05");
        assert_eq!(short(-0.001), "0");
        assert_eq!(short(f64::MAX), "21474836.47");
        assert_eq!(short(f64::MIN), "-21474836.48");
    }

    #[test]
    fn markup_is_escaped() {
        assert_eq!(escaped("a < b & \"c\""), "a &lt; b &amp; &quot;c&quot;");
    }
}
