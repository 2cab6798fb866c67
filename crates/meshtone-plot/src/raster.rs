//! A scene as pixels.

use tiny_skia::{
    FillRule, FilterQuality, Paint, Path, PathBuilder, Pattern, Pixmap, Rect, Shader, SpreadMode, StrokeDash,
    Transform,
};

use crate::scene::{Element, Place, Scene};
use crate::style::{
    Colour, Fill, HALO_WIDTH, HATCH_ANGLE_DEG, HATCH_PITCH, HATCH_WIDTH, Stroke, TextStyle, colour,
};
use crate::{PlotError, font};

/// The scene in its own size, a pixel for a pixel.
pub(crate) fn pixels(scene: &Scene) -> Result<Pixmap, PlotError> {
    let Scene { width, height, .. } = *scene;
    let mut raster = Raster { pixmap: pixmap(width, height)? };
    raster.pixmap.fill(paint_colour(colour::WHITE, 1.0));
    for element in &scene.elements {
        raster.draw(element)?;
    }
    Ok(raster.pixmap)
}

struct Raster {
    pixmap: Pixmap,
}

impl Raster {
    fn draw(&mut self, element: &Element) -> Result<(), PlotError> {
        match element {
            Element::Path { points, closed, stroke, fill } => {
                let Some(path) = through(points, *closed) else { return Ok(()) };
                if let Some(fill) = fill {
                    self.fill(&path, *fill)?;
                }
                if let Some(stroke) = stroke {
                    self.stroke(&path, *stroke);
                }
            }
            Element::Rectangles { corners, fill } => self.rectangles(corners, *fill),
            Element::Dots { centres, radius, fill } => self.dots(centres, *radius, *fill),
            Element::Text { at, text, style } => self.text(*at, text, *style),
        }
        Ok(())
    }

    fn fill(&mut self, path: &Path, fill: Fill) -> Result<(), PlotError> {
        if !fill.hatched {
            self.fill_solid(path, fill.colour, fill.opacity);
            return Ok(());
        }
        let tile = hatching(fill)?;
        let turned = Transform::from_rotate(HATCH_ANGLE_DEG);
        let stripes = Pattern::new(tile.as_ref(), SpreadMode::Repeat, FilterQuality::Bicubic, 1.0, turned);
        self.pixmap.fill_path(path, &paint(stripes), FillRule::Winding, Transform::identity(), None);
        Ok(())
    }

    fn fill_solid(&mut self, path: &Path, colour: Colour, opacity: f64) {
        let paint = solid(colour, opacity);
        self.pixmap.fill_path(path, &paint, FillRule::Winding, Transform::identity(), None);
    }

    fn stroke(&mut self, path: &Path, Stroke { colour, width, dash }: Stroke) {
        let dash = dash.iter().map(|&length| length as f32).collect();
        let stroke = tiny_skia::Stroke {
            width: width as f32,
            line_join: tiny_skia::LineJoin::Round,
            dash: StrokeDash::new(dash, 0.0),
            ..tiny_skia::Stroke::default()
        };
        self.pixmap.stroke_path(path, &solid(colour, 1.0), &stroke, Transform::identity(), None);
    }

    fn rectangles(&mut self, corners: &[[Place; 2]], fill: Fill) {
        let mut path = PathBuilder::new();
        for [from, to] in corners {
            let rectangle = Rect::from_ltrb(from.x.px(), from.y.px(), to.x.px(), to.y.px());
            rectangle.into_iter().for_each(|rectangle| path.push_rect(rectangle));
        }
        if let Some(path) = path.finish() {
            self.fill_solid(&path, fill.colour, fill.opacity);
        }
    }

    fn dots(&mut self, centres: &[Place], radius: f64, fill: Fill) {
        for centre in centres {
            if let Some(disc) = PathBuilder::from_circle(centre.x.px(), centre.y.px(), radius as f32) {
                self.fill_solid(&disc, fill.colour, fill.opacity);
            }
        }
    }

    fn text(&mut self, at: Place, text: &str, style: TextStyle) {
        let before = style.anchor.before(font::text_width(text, style.size, style.bold)) as f32;
        let turned = if style.upwards { Transform::from_rotate(-90.0) } else { Transform::identity() };
        let moved = turned.pre_translate(-before, 0.0).post_translate(at.x.px(), at.y.px());
        let outline = font::outline(text, style.size, style.bold).and_then(|path| path.transform(moved));
        let Some(outline) = outline else { return };
        if style.halo {
            self.stroke(&outline, Stroke::solid(colour::WHITE, HALO_WIDTH));
        }
        self.fill_solid(&outline, style.colour, 1.0);
    }
}

/// Straight lines from point to point.
fn through(points: &[Place], closed: bool) -> Option<Path> {
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

/// One stripe and what lies between it and the next.
fn hatching(fill: Fill) -> Result<Pixmap, PlotError> {
    let mut tile = pixmap(HATCH_PITCH, HATCH_PITCH)?;
    tile.fill(paint_colour(fill.colour, fill.opacity));
    if let Some(stripe) = Rect::from_xywh(0.0, 0.0, HATCH_WIDTH, HATCH_PITCH as f32) {
        tile.fill_rect(stripe, &solid(fill.colour, 1.0), Transform::identity(), None);
    }
    Ok(tile)
}

fn pixmap(width: u32, height: u32) -> Result<Pixmap, PlotError> {
    Pixmap::new(width, height).ok_or(PlotError::Bitmap { width, height })
}

fn paint(shader: Shader) -> Paint {
    Paint { shader, ..Paint::default() }
}

fn solid(colour: Colour, opacity: f64) -> Paint<'static> {
    paint(Shader::SolidColor(paint_colour(colour, opacity)))
}

fn paint_colour(Colour { red, green, blue }: Colour, opacity: f64) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba8(red, green, blue, (opacity * 255.0).round() as u8)
}
