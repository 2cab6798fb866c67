//! A scene as pixels.
//!
//! Shapes are drawn one over the other: what part of each pixel a shape covers is found exactly, and the pixel mixed
//! with the shape's colour in that proportion.

use ab_glyph_rasterizer::{Point, Rasterizer, point};
use tiny_skia_path::{LineJoin, Path, PathBuilder, PathSegment, Rect, StrokeDash, Transform};

use crate::drawing::{
    Colour, Fill, HALO_WIDTH, HATCH_ANGLE_DEG, HATCH_PITCH, HATCH_WIDTH, Stroke, TextStyle, colour,
};
use crate::font;
use crate::scene::{Element, Scene, ScenePoint};

/// Less of a pixel than this is rounding.
const LEAST_COVERED: f32 = 1.0 / 1024.0;

/// A picture without transparency.
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Row by row from the top.
    pub(crate) pixels: Vec<Colour>,
}

/// The scene in its own size, a pixel for a pixel.
pub(crate) fn picture(scene: &Scene) -> Picture {
    let Scene { width, height, ref elements } = *scene;
    let pixels = vec![colour::WHITE; width as usize * height as usize];
    let mut raster = Raster { picture: Picture { width, height, pixels }, coverage: Coverage::new() };
    elements.iter().for_each(|element| raster.draw(element));
    raster.picture
}

struct Raster {
    picture: Picture,
    coverage: Coverage,
}

impl Raster {
    fn draw(&mut self, element: &Element) {
        match element {
            Element::Path { points, closed, stroke, fill } => {
                let Some(path) = through(points, *closed) else { return };
                if let Some(fill) = fill {
                    self.fill(&path, *fill);
                }
                if let Some(stroke) = stroke {
                    self.stroke(&path, *stroke);
                }
            }
            Element::Rectangles { corners, fill } => self.rectangles(corners, *fill),
            Element::Dots { centres, radius, fill } => self.dots(centres, *radius, *fill),
            Element::Text { at, text, style } => self.text(*at, text, *style),
        }
    }

    fn fill(&mut self, path: &Path, Fill { colour, opacity, hatched }: Fill) {
        let opacity = opacity as f32;
        if hatched {
            self.mix(path, colour, |x, y| opacity + (1.0 - opacity) * stripe(x, y));
        } else {
            self.mix(path, colour, |_, _| opacity);
        }
    }

    fn stroke(&mut self, path: &Path, Stroke { colour, width, dash }: Stroke) {
        let pen = tiny_skia_path::Stroke {
            width: width as f32,
            line_join: LineJoin::Round,
            ..tiny_skia_path::Stroke::default()
        };
        let dash = StrokeDash::new(dash.iter().map(|&length| length as f32).collect(), 0.0);
        let dashed = dash.and_then(|dash| path.dash(&dash, 1.0));
        if let Some(outline) = dashed.as_ref().unwrap_or(path).stroke(&pen, 1.0) {
            self.mix(&outline, colour, |_, _| 1.0);
        }
    }

    fn rectangles(&mut self, corners: &[[ScenePoint; 2]], fill: Fill) {
        let mut path = PathBuilder::new();
        for [from, to] in corners {
            let rectangle = Rect::from_ltrb(from.x.px(), from.y.px(), to.x.px(), to.y.px());
            rectangle.into_iter().for_each(|rectangle| path.push_rect(rectangle));
        }
        if let Some(path) = path.finish() {
            self.fill(&path, fill);
        }
    }

    fn dots(&mut self, centres: &[ScenePoint], radius: f64, fill: Fill) {
        for centre in centres {
            if let Some(disc) = PathBuilder::from_circle(centre.x.px(), centre.y.px(), radius as f32) {
                self.fill(&disc, fill);
            }
        }
    }

    fn text(&mut self, at: ScenePoint, text: &str, style: TextStyle) {
        let before = style.anchor.before(font::text_width(text, style.size, style.bold)) as f32;
        let turned = if style.upwards { Transform::from_rotate(-90.0) } else { Transform::identity() };
        let moved = turned.pre_translate(-before, 0.0).post_translate(at.x.px(), at.y.px());
        let outline = font::outline(text, style.size, style.bold).and_then(|path| path.transform(moved));
        let Some(outline) = outline else { return };
        if style.halo {
            self.stroke(&outline, Stroke::solid(colour::WHITE, HALO_WIDTH));
        }
        self.fill(&outline, Fill::solid(style.colour));
    }

    /// Mixes a colour into the pixels that a shape covers.
    ///
    /// # Arguments
    /// * `path` - outline of the shape
    /// * `colour`, `opacity` - of the shape; the opacity at the pixel (x, y)
    fn mix(&mut self, path: &Path, colour: Colour, opacity: impl Fn(usize, usize) -> f32) {
        let Picture { width, height, pixels } = &mut self.picture;
        let Some(window) = Window::around(path, *width, *height) else { return };
        let row = *width as usize;
        self.coverage.of(path, &window).for_each(|x, y, covered| {
            let (x, y) = (window.left + x, window.top + y);
            let pixel = &mut pixels[y * row + x];
            *pixel = pixel.mixed(colour, covered * opacity(x, y));
        });
    }
}

/// (-) Part of the pixel that a stripe of a hatching covers.
fn stripe(x: usize, y: usize) -> f32 {
    let (sin, cos) = HATCH_ANGLE_DEG.to_radians().sin_cos();
    let across = (x as f32 + 0.5) * cos + (y as f32 + 0.5) * sin;
    let from_middle = (across - HATCH_WIDTH / 2.0).rem_euclid(HATCH_PITCH);
    let from_middle = from_middle.min(HATCH_PITCH - from_middle);
    (HATCH_WIDTH / 2.0 + 0.5 - from_middle).clamp(0.0, 1.0)
}

/// Straight lines from point to point.
fn through(points: &[ScenePoint], closed: bool) -> Option<Path> {
    let mut path = PathBuilder::with_capacity(points.len() + 1, points.len());
    for (index, point) in points.iter().enumerate() {
        let (x, y) = (point.x.px(), point.y.px());
        if index == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

/// The part of the picture in which a shape is seen, in pixels.
struct Window {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
}

impl Window {
    fn around(path: &Path, width: u32, height: u32) -> Option<Self> {
        let bounds = path.bounds();
        let inside = |low: f32, high: f32, size: u32| {
            let (low, high) = (low.floor().max(0.0), high.ceil().min(size as f32));
            (low < high).then_some((low as usize, (high - low) as usize))
        };
        let (left, width) = inside(bounds.left(), bounds.right(), width)?;
        let (top, height) = inside(bounds.top(), bounds.bottom(), height)?;
        Some(Self { left, top, width, height })
    }
}

/// Part of each pixel of a window that a shape covers.
struct Coverage {
    rasterizer: Rasterizer,
    /// (px) Right edge of the window, its left one being 0.
    right: f32,
}

impl Coverage {
    fn new() -> Self {
        Self { rasterizer: Rasterizer::new(0, 0), right: 0.0 }
    }

    /// Takes in a shape, whose open ends are joined.
    fn of(&mut self, path: &Path, window: &Window) -> &Self {
        self.rasterizer.reset(window.width, window.height);
        self.right = window.width as f32;
        let at = |p: tiny_skia_path::Point| point(p.x - window.left as f32, p.y - window.top as f32);
        let (mut start, mut last) = (Point::default(), Point::default());
        for segment in path.segments() {
            last = match segment {
                PathSegment::MoveTo(to) => {
                    self.line(last, start);
                    start = at(to);
                    start
                }
                PathSegment::LineTo(to) => {
                    self.line(last, at(to));
                    at(to)
                }
                PathSegment::QuadTo(control, to) => {
                    let [from, control, to] = [last, at(control), at(to)].map(|p| self.clamped(p));
                    self.rasterizer.draw_quad(from, control, to);
                    to
                }
                PathSegment::CubicTo(first, second, to) => {
                    let [from, first, second, to] =
                        [last, at(first), at(second), at(to)].map(|p| self.clamped(p));
                    self.rasterizer.draw_cubic(from, first, second, to);
                    to
                }
                PathSegment::Close => {
                    self.line(last, start);
                    start
                }
            };
        }
        self.line(last, start);
        self
    }

    /// A straight line; what is left or right of the window goes along its edge, as the rasterizer knows no other places.
    fn line(&mut self, from: Point, to: Point) {
        let mut edges = [0.0, self.right];
        if from.x > to.x {
            edges.reverse();
        }
        let mut start = from;
        for edge in edges {
            let part = (edge - from.x) / (to.x - from.x);
            if part > 0.0 && part < 1.0 {
                let cut = point(edge, from.y + part * (to.y - from.y));
                self.rasterizer.draw_line(self.clamped(start), self.clamped(cut));
                start = cut;
            }
        }
        self.rasterizer.draw_line(self.clamped(start), self.clamped(to));
    }

    fn clamped(&self, p: Point) -> Point {
        point(p.x.clamp(0.0, self.right), p.y)
    }

    /// Calls `f` for every pixel, given by its place in the window, and the part of it that is covered.
    fn for_each(&self, mut f: impl FnMut(usize, usize, f32)) {
        let (width, _) = self.rasterizer.dimensions();
        self.rasterizer.for_each_pixel(|index, windings| {
            if windings > LEAST_COVERED {
                f(index % width, index / width, windings.min(1.0));
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INK: Colour = Colour(0);

    /// Greys of a picture in which one element is drawn.
    fn greys(width: u32, height: u32, element: Element) -> Vec<u32> {
        let picture = picture(&Scene { width, height, elements: vec![element] });
        picture.pixels.iter().map(|pixel| pixel.0 & 0xff).collect()
    }

    fn polygon(points: &[(f64, f64)], fill: Fill) -> Element {
        let points = points.iter().copied().map(ScenePoint::from).collect();
        Element::Path { points, closed: true, stroke: None, fill: Some(fill) }
    }

    #[test]
    fn pixels_are_as_dark_as_they_are_covered() {
        let corners = [(0.5, 0.0), (2.0, 0.0), (2.0, 1.0), (0.5, 1.0)];
        assert_eq!(greys(3, 1, polygon(&corners, Fill::solid(INK))), [128, 0, 255]);
        assert_eq!(greys(3, 1, polygon(&corners, Fill::tint(INK, 0.5))), [191, 128, 255]);
    }

    // A triangle whose slopes cross the edges of the picture: inside, it is as if there were no edges.
    #[test]
    fn what_leaves_the_picture_is_cut_off() {
        let wide = |from: f64| polygon(&[(from, 0.0), (from + 20.0, 10.0), (from, 10.0)], Fill::solid(INK));
        let all = greys(60, 10, wide(20.0));
        let cut = greys(10, 10, wide(-5.0));
        let seen = |y: usize| all[60 * y + 25..60 * y + 35].to_vec();
        let rows: Vec<u32> = (0..10).flat_map(seen).collect();
        assert!(cut.iter().zip(&rows).all(|(a, b)| a.abs_diff(*b) <= 1), "{cut:?} {rows:?}");
        assert!(greys(4, 4, wide(1e6)).iter().all(|&grey| grey == 255));
        assert!(greys(4, 4, wide(-1e6)).iter().all(|&grey| grey == 255));
    }

    #[test]
    fn hatching_is_stripes_over_a_tint() {
        let corners = [(0.0, 0.0), (70.0, 0.0), (70.0, 70.0), (0.0, 70.0)];
        let greys = greys(70, 70, polygon(&corners, Fill::hatch(INK)));
        let mean = greys.iter().sum::<u32>() as f64 / 4900.0;
        // A stripe is 1.5 of 7 pixels, and the tint 12 % of what lies between.
        let expected = 255.0 * (1.0 - 1.5 / 7.0) * (1.0 - 0.12);
        assert!((mean - expected).abs() < 3.0, "{mean} {expected}");
    }

    #[test]
    fn upward_text_is_turned_text() {
        let ink = |upwards: bool| {
            let style = TextStyle { upwards, ..TextStyle::TITLE };
            let at = if upwards { (30.0, 90.0) } else { (10.0, 30.0) }.into();
            let greys = greys(100, 100, Element::Text { at, text: "Zahn".to_owned(), style });
            (0..100)
                .map(move |y| (0..100).map(|x| greys[100 * y + x]).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        let (along, up) = (ink(false), ink(true));
        let same = |x: usize, y: usize| along[y][x].abs_diff(up[99 - x][y]) <= 2;
        assert!((0..100).all(|y| (0..100).all(|x| same(x, y))));
        assert!(along.iter().flatten().filter(|&&grey| grey < 100).count() > 100);
    }
}
