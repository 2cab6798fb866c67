//! The tooth's face: the drive flank seen along the normal of the tooth's plane of symmetry.
//!
//! z is that of the equations of motion: a fault that reaches from one end of the face reaches from positive z
//! ([`meshtone::mesh::PairState`]).

use meshtone::damage::{DamageDescription, DamagedTooth, ToothPart};

use super::side::Side;
use super::tooth::{CRACK, DAMAGE_EDGE, LOST};
use crate::drawing::{Anchor, Area, Axes, Canvas, Fill, Stroke, TextStyle, Ticks, colour};

/// Where contact starts, here and at the profile errors.
pub(super) const CONTACT: Stroke = Stroke::dashed(colour::GREEN, 1.6, &[7.0, 3.0]);
/// Where helical teeth touch at one instant.
const CONTACT_LINE: Stroke = Stroke::solid(colour::GREEN, 0.8);
/// Where the tip relief and the chamfer start.
pub(super) const RELIEF: Stroke = Stroke::dashed(colour::PURPLE, 1.6, &[2.0, 2.5]);
const CONTACT_NAME: &str = "start of active profile";
/// (px) From a line to the baseline of its name.
const ABOVE: f64 = -5.0;
const BELOW: f64 = 15.0;
/// (px) From a line to the top of the name above it.
const NAME_HEIGHT: f64 = 19.0;
/// (px) From line to line of the caption.
const CAPTION_LINE: f64 = 16.0;
/// Lines of the caption for which there is room.
const MOST_LINES: usize = 4;
const EDGE: Stroke = Stroke::solid(colour::VERMILLION, 1.8);

/// Draws the face; `along` is the tooth's own range.
pub(super) fn draw(canvas: &mut Canvas, area: Area, along: [f64; 2], side: &Side) {
    let half = side.wheel.face_width_mm / 2.0;
    let title = if side.contact_lines_mm.is_empty() { "Tooth face" } else { "Face, contact lines" };
    let axes = Axes::titled(canvas, area, [-1.12 * half, 1.12 * half], along, title);
    axes.x_axis(canvas, &Ticks::about_zero(half), "Face width, z (mm)");
    axes.y_grid(canvas, &Ticks::nice(along[0], along[1], 8));
    let (root, tip) = (side.profile.x_mm[0], side.profile.tip_x_mm());
    let top = if side.is_missing() { root } else { tip };
    canvas.rectangle(axes.at(-half, along[0]), axes.at(half, top), Fill::solid(colour::STEEL));
    for line in &side.contact_lines_mm {
        canvas.polyline(&line.iter().map(|&[z, x]| axes.at(z, x)).collect::<Vec<_>>(), CONTACT_LINE);
    }
    if let Some(tooth) = side.tooth {
        tooth.descriptions.iter().for_each(|damage| damaged(canvas, &axes, damage));
    }
    let outline = Stroke::solid(colour::MUTED, 1.6);
    canvas.line(axes.at(-half, root), axes.at(half, root), Stroke::solid(colour::MUTED, 0.9));
    let corners = [(-half, along[0]), (-half, top), (half, top), (half, along[0])];
    canvas.polyline(&corners.map(|(z, x)| axes.at(z, x)), outline);
    let is_below = contact_name_is_below(&axes, side);
    let contact_name = if is_below { BELOW } else { ABOVE };
    landmark(canvas, &axes, (side.contact_x_mm(), CONTACT_NAME), CONTACT, contact_name);
    for (n, &shape) in side.tip_shapes.iter().filter(|(x_mm, _)| *x_mm > side.contact_x_mm()).enumerate() {
        // A chamfer and a relief start near each other.
        landmark(canvas, &axes, shape, RELIEF, if n == 0 { ABOVE } else { BELOW });
    }
    if let Some(tooth) = side.tooth {
        caption(canvas, &axes, side, tooth, if is_below { CAPTION_LINE } else { 0.0 });
    }
    axes.frame(canvas);
}

/// A line across the face, with its name at a height from it.
fn landmark(canvas: &mut Canvas, axes: &Axes, (x_mm, name): (f64, &str), stroke: Stroke, height: f64) {
    axes.horizontal(canvas, x_mm, stroke);
    // At the end of the face that no one-sided fault reaches first.
    let style = TextStyle::NOTE.coloured(stroke.colour).with_halo();
    canvas.text((name_left(axes), axes.py(x_mm) + height), name, style);
}

fn name_left(axes: &Axes) -> f64 {
    axes.px(axes.x[0] / 1.12) + 5.0
}

/// Whether the edge of a damage would cross the name above the start of contact.
fn contact_name_is_below(axes: &Axes, side: &Side) -> bool {
    let Some(tooth) = side.tooth.filter(|tooth| !tooth.is_missing()) else { return false };
    let name_right = name_left(axes) + TextStyle::NOTE.width(CONTACT_NAME);
    let mut edges =
        tooth.descriptions.iter().flat_map(|damage| &damage.face).flat_map(|patch| &patch.edge_mm);
    edges.any(|&[z_mm, x_mm]| {
        let above = axes.py(side.contact_x_mm()) - axes.py(x_mm);
        axes.px(z_mm) < name_right && above > 0.0 && above < NAME_HEIGHT
    })
}

/// What a damage has taken of the face, and the edges of what is left.
fn damaged(canvas: &mut Canvas, axes: &Axes, damage: &DamageDescription) {
    let edge = match damage.part {
        ToothPart::Whole => DAMAGE_EDGE,
        ToothPart::Root => CRACK,
        _ => EDGE,
    };
    let pixels = |points: &[[f64; 2]]| points.iter().map(|&[z, x]| axes.at(z, x)).collect::<Vec<_>>();
    for patch in &damage.face {
        canvas.polygon(&pixels(&patch.outline_mm), LOST);
        canvas.polyline(&pixels(&patch.edge_mm), edge);
    }
}

/// Below the start of contact and the damage, as far as there is room.
fn caption(canvas: &mut Canvas, axes: &Axes, side: &Side, tooth: &DamagedTooth, lowered: f64) {
    let style = TextStyle::NOTE.coloured(colour::VERMILLION).anchored(Anchor::Middle).with_halo();
    let lines: Vec<&String> =
        tooth.descriptions.iter().flat_map(|damage| &damage.caption).take(MOST_LINES).collect();
    let starts = tooth.descriptions.iter().map(|damage| damage.range[0]);
    let below = if side.is_missing() { side.last() } else { starts.min().unwrap_or(side.last()) };
    let lowest = side.contact_x_mm().min(side.profile.x_mm[below]);
    let first = axes.py(lowest) + 18.0 + lowered;
    let first = first.min(axes.area.bottom() - 6.0 - CAPTION_LINE * lines.len().saturating_sub(1) as f64);
    for (row, text) in lines.iter().enumerate() {
        canvas.text((axes.area.middle().0, first + CAPTION_LINE * row as f64), text, style);
    }
}
