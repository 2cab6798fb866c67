//! Shapes and text as SVG.
//!
//! Written out directly: the figures need few elements, and both chart libraries and general SVG writers hide what
//! matters here – equal scales across neighbouring axes, hatching, and where each text ends.

use std::fmt::Write;

use crate::figure::{Figure, Label};
use crate::font;
use crate::style::{Anchor, Fill, Stroke, TextStyle, colour};

/// A point in pixels, y downwards.
pub(crate) type Pixel = (f64, f64);

/// A figure in the making.
pub(crate) struct Canvas {
    width: u32,
    height: u32,
    body: String,
    hatches: Vec<Fill>,
    labels: Vec<Label>,
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self { width, height, body: String::with_capacity(1 << 17), hatches: Vec::new(), labels: Vec::new() }
    }

    pub(crate) fn line(&mut self, from: Pixel, to: Pixel, stroke: Stroke) {
        self.path(&[from, to], false, Some(stroke), None);
    }

    pub(crate) fn polyline(&mut self, points: &[Pixel], stroke: Stroke) {
        self.path(points, false, Some(stroke), None);
    }

    pub(crate) fn polygon(&mut self, points: &[Pixel], fill: Fill) {
        self.path(points, true, None, Some(fill));
    }

    /// A rectangle with the corners `a` and `b`.
    pub(crate) fn rectangle(&mut self, a: Pixel, b: Pixel, fill: Fill) {
        self.polygon(&[a, (b.0, a.1), b, (a.0, b.1)], fill);
    }

    /// A filled shape with an outline.
    pub(crate) fn outlined(&mut self, points: &[Pixel], stroke: Stroke, fill: Fill) {
        self.path(points, true, Some(stroke), Some(fill));
    }

    /// Rectangles with the corners `[a, b]`, filled as one shape.
    pub(crate) fn rectangles(&mut self, rectangles: &[[Pixel; 2]], fill: Fill) {
        if rectangles.is_empty() {
            return;
        }
        self.body.push_str("<path d=\"");
        for &[(left, top), (right, bottom)] in rectangles {
            let (width, height) = (right - left, bottom - top);
            self.push(format_args!(
                "M{} {}h{}v{}h{}Z",
                Short(left),
                Short(top),
                Short(width),
                Short(height),
                Short(-width)
            ));
        }
        self.push(format_args!("\" fill=\"{}\" fill-opacity=\"{}\"/>\n", fill.colour, Short(fill.opacity)));
    }

    /// Small discs; where they overlap the fill adds up.
    pub(crate) fn dots(&mut self, centres: &[Pixel], radius: f64, fill: Fill) {
        if centres.is_empty() {
            return;
        }
        self.push(format_args!("<g fill=\"{}\" fill-opacity=\"{}\">\n", fill.colour, Short(fill.opacity)));
        for &(x, y) in centres {
            self.push(format_args!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n",
                Short(x),
                Short(y),
                Short(radius)
            ));
        }
        self.body.push_str("</g>\n");
    }

    /// Text whose baseline starts, has its middle or ends at `at`.
    pub(crate) fn text(&mut self, at: Pixel, text: &str, style: TextStyle) {
        let (x, y) = (Short(at.0), Short(at.1));
        let anchor = match style.anchor {
            Anchor::Start => "",
            Anchor::Middle => " text-anchor=\"middle\"",
            Anchor::End => " text-anchor=\"end\"",
        };
        let place = if style.upwards {
            format!("transform=\"translate({x} {y}) rotate(-90)\"")
        } else {
            format!("x=\"{x}\" y=\"{y}\"")
        };
        let weight = if style.bold { " font-weight=\"600\"" } else { "" };
        let halo = if style.halo {
            " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\""
        } else {
            ""
        };
        self.push(format_args!(
            "<text {place} font-size=\"{}\" fill=\"{}\"{weight}{anchor}{halo}>{}</text>\n",
            Short(style.size),
            style.colour,
            Escaped(text)
        ));
        self.labels.push(label(at, text, style));
    }

    fn path(&mut self, points: &[Pixel], closed: bool, stroke: Option<Stroke>, fill: Option<Fill>) {
        if points.len() < 2 {
            return;
        }
        self.body.push_str("<path d=\"");
        for (index, &(x, y)) in points.iter().enumerate() {
            self.push(format_args!("{}{} {}", if index == 0 { "M" } else { "L" }, Short(x), Short(y)));
        }
        self.body.push_str(if closed { "Z\"" } else { "\"" });
        if let Some(stroke) = stroke {
            self.push(format_args!(" stroke=\"{}\" stroke-width=\"{}\"", stroke.colour, Short(stroke.width)));
            if !stroke.dash.is_empty() {
                self.push(format_args!(" stroke-dasharray=\"{}\"", stroke.dash));
            }
        }
        match fill {
            None => self.body.push_str(" fill=\"none\""),
            Some(fill) if fill.hatched => {
                let name = self.hatch(fill);
                self.push(format_args!(" fill=\"url(#hatch{name})\""));
            }
            Some(fill) => {
                self.push(format_args!(" fill=\"{}\"", fill.colour));
                if fill.opacity < 1.0 {
                    self.push(format_args!(" fill-opacity=\"{}\"", Short(fill.opacity)));
                }
            }
        }
        self.body.push_str("/>\n");
    }

    fn hatch(&mut self, fill: Fill) -> usize {
        let known = self.hatches.iter().position(|hatch| hatch.colour == fill.colour);
        known.unwrap_or_else(|| {
            self.hatches.push(fill);
            self.hatches.len() - 1
        })
    }

    fn push(&mut self, text: std::fmt::Arguments) {
        // Writing to a string cannot fail.
        let _ = self.body.write_fmt(text);
    }

    /// The finished figure.
    ///
    /// `title` and `description` are for readers who cannot see it.
    pub(crate) fn finish(self, title: &str, description: &str) -> Figure {
        let (width, height) = (self.width, self.height);
        let hatches: String =
            self.hatches.iter().enumerate().map(|(name, fill)| pattern(name, fill)).collect();
        let svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" font-family=\"{}\" stroke-linejoin=\"round\" role=\"img\">\n\
             <title>{}</title>\n<desc>{}</desc>\n<defs>{hatches}</defs>\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"{}\"/>\n{}</svg>\n",
            font::FAMILY,
            Escaped(title),
            Escaped(description),
            colour::WHITE,
            self.body
        );
        Figure::new(svg, width, height, self.labels)
    }
}

fn pattern(name: usize, fill: &Fill) -> String {
    let Fill { colour, opacity, .. } = fill;
    format!(
        "<pattern id=\"hatch{name}\" width=\"7\" height=\"7\" patternUnits=\"userSpaceOnUse\" \
         patternTransform=\"rotate(45)\"><rect width=\"7\" height=\"7\" fill=\"{colour}\" \
         fill-opacity=\"{opacity}\"/><rect width=\"1.5\" height=\"7\" fill=\"{colour}\"/></pattern>"
    )
}

/// Part of the font size by which letters rise above and fall below the baseline.
const ASCENT: f64 = 0.76;
const DESCENT: f64 = 0.22;

fn label((x, y): Pixel, text: &str, style: TextStyle) -> Label {
    let width = font::text_width(text, style.size, style.bold);
    let before = match style.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    let (up, down) = (ASCENT * style.size, DESCENT * style.size);
    let (left, top, right, bottom) = if style.upwards {
        (x - up, y + before - width, x + down, y + before)
    } else {
        (x - before, y - up, x - before + width, y + down)
    };
    Label { text: text.to_owned(), left, top, right, bottom }
}

/// A number with at most two decimals.
struct Short(f64);

impl std::fmt::Display for Short {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let hundredths = (self.0 * 100.0).round() as i64;
        let (sign, size) = (if hundredths < 0 { "-" } else { "" }, hundredths.unsigned_abs());
        let (whole, rest) = (size / 100, size % 100);
        match rest {
            0 => write!(f, "{sign}{whole}"),
            _ if rest % 10 == 0 => write!(f, "{sign}{whole}.{}", rest / 10),
            _ => write!(f, "{sign}{whole}.{rest:02}"),
        }
    }
}

/// Text with the characters that mean something to XML escaped.
struct Escaped<'a>(&'a str);

impl std::fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        for character in self.0.chars() {
            match character {
                '<' => f.write_str("&lt;")?,
                '>' => f.write_str("&gt;")?,
                '&' => f.write_str("&amp;")?,
                '"' => f.write_str("&quot;")?,
                other => f.write_char(other)?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let short = |value: f64| Short(value).to_string();
        assert_eq!(short(3.0), "3");
        assert_eq!(short(-0.5), "-0.5");
        assert_eq!(short(12.345), "12.35");
        assert_eq!(short(7.05), "7.05");
        assert_eq!(short(-0.001), "0");
    }

    #[test]
    fn markup_is_escaped() {
        assert_eq!(Escaped("a < b & \"c\"").to_string(), "a &lt; b &amp; &quot;c&quot;");
    }
}
