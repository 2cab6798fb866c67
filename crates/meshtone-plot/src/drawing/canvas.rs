//! Shapes and text of a figure in the making.
//!
//! The figures need few elements, and both chart libraries and general SVG writers hide what matters here – equal
//! scales across neighbouring axes, hatching, and where each text ends.

use super::style::{Fill, Stroke, TextStyle, colour};
use crate::figure::Figure;
use crate::scene::{Element, Scene, ScenePoint};

pub(crate) use crate::scene::Pixel;

/// (px) Width of every figure.
pub(crate) const WIDTH: u32 = 1600;
/// (px) From the edge of most figures to their title and facts.
pub(crate) const EDGE: f64 = 17.0;
/// What separates facts in a line.
pub(crate) const BETWEEN_FACTS: &str = "  ·  ";

/// A figure in the making.
pub(crate) struct Canvas {
    scene: Scene,
}

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        Self { scene: Scene { width, height, elements: Vec::new() } }
    }

    /// A figure with its title and the facts below it, both `edge` from its left and, shortened, from its right.
    pub(crate) fn page(height: u32, edge: f64, title: &str, facts: &[String]) -> Self {
        let mut canvas = Self::new(WIDTH, height);
        let width = f64::from(WIDTH) - 2.0 * edge;
        canvas.heading(edge, width, (36.0, title), (61.0, &facts.join(BETWEEN_FACTS)));
        canvas
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

    /// Rectangles with the corners `[upper left, lower right]`, filled as one shape.
    pub(crate) fn rectangles(&mut self, rectangles: &[[Pixel; 2]], fill: Fill) {
        if rectangles.is_empty() {
            return;
        }
        let corners = rectangles.iter().map(|corners| corners.map(ScenePoint::from)).collect();
        self.scene.elements.push(Element::Rectangles { corners, fill });
    }

    /// Small discs; where they overlap the fill adds up.
    pub(crate) fn dots(&mut self, centres: &[Pixel], radius: f64, fill: Fill) {
        if centres.is_empty() {
            return;
        }
        let centres = places(centres);
        self.scene.elements.push(Element::Dots { centres, radius, fill });
    }

    /// Text whose baseline starts, has its middle or ends at `at`.
    pub(crate) fn text(&mut self, at: Pixel, text: &str, style: TextStyle) {
        self.scene.elements.push(Element::Text { at: at.into(), text: shown(text), style });
    }

    /// The figure's title and the line of facts below it, each with its baseline and shortened to `width`.
    pub(crate) fn heading(&mut self, left: f64, width: f64, title: (f64, &str), facts: (f64, &str)) {
        for ((baseline, text), style) in [(title, TextStyle::TITLE), (facts, TextStyle::FACTS)] {
            self.text((left, baseline), &style.fitted(text, width), style);
        }
    }

    /// The heading of several axes, shortened to `width`, with a rule of that width `rule_below` its baseline.
    pub(crate) fn section(&mut self, (left, baseline): Pixel, width: f64, text: &str, rule_below: f64) {
        self.text((left, baseline), &TextStyle::HEADING.fitted(text, width), TextStyle::HEADING);
        let y = baseline + rule_below;
        self.line((left, y), (left + width, y), Stroke::solid(colour::INK, 1.2));
    }

    fn path(&mut self, points: &[Pixel], closed: bool, stroke: Option<Stroke>, fill: Option<Fill>) {
        if points.len() < 2 {
            return;
        }
        let points = places(points);
        self.scene.elements.push(Element::Path { points, closed, stroke, fill });
    }

    /// The finished figure.
    ///
    /// `title` and `description` are for readers who cannot see it.
    pub(crate) fn finish(self, title: &str, description: &str) -> Figure {
        Figure::new(self.scene, title, description)
    }
}

/// What a figure is and its facts in sentences, for readers who cannot see it.
pub(crate) fn described(what: &str, facts: &[String]) -> String {
    format!("{what} {}.", facts.join(", "))
}

fn places(points: &[Pixel]) -> Vec<ScenePoint> {
    points.iter().copied().map(ScenePoint::from).collect()
}

/// The text as viewers of SVG show it, white space being one space and none at the ends; without the control
/// characters that XML does not allow.
fn shown(text: &str) -> String {
    let words = text.split_whitespace().map(|word| word.replace(char::is_control, ""));
    words.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_space_is_one_space() {
        assert_eq!(shown(" 17 and 38 teeth  ·\tmodule\n3 mm "), "17 and 38 teeth · module 3 mm");
        assert_eq!(shown("a\u{7}b"), "ab");
    }
}
