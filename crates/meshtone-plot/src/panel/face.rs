//! The tooth's face: the working flank seen along the normal of the tooth's plane of symmetry.
//!
//! z is that of the equations of motion: a fault that reaches from one end of the face reaches from positive z
//! ([`meshtone::mesh::LoadState`]).

use meshtone::damage::{DamageDescription, DamagedTooth, FlankPit};

use super::damage;
use super::side::Side;
use super::tooth::{CRACK, DAMAGE_EDGE, LOST};
use crate::axes::{Area, Axes};
use crate::canvas::{Canvas, Pixel};
use crate::font;
use crate::style::{Anchor, Fill, Stroke, TextStyle, colour};
use crate::ticks::Ticks;

/// Where contact starts, here and at the profile errors.
pub(super) const CONTACT: Stroke = Stroke::dashed(colour::GREEN, 1.6, &[7.0, 3.0]);
/// Where the tip relief and the chamfer start.
pub(super) const RELIEF: Stroke = Stroke::dashed(colour::PURPLE, 1.6, &[2.0, 2.5]);
const CONTACT_NAME: &str = "contact start";
/// (px) From a line to the baseline of its name.
const ABOVE: f64 = -5.0;
const BELOW: f64 = 15.0;
/// (px) From a line to the top of the name above it.
const NAME_HEIGHT: f64 = 19.0;
/// (px) From line to line of the caption.
const CAPTION_LINE: f64 = 16.0;
/// Lines of the caption for which there is room.
const MOST_LINES: usize = 4;
/// Pieces of a pit's outline.
const OUTLINE: usize = 48;
const EDGE: Stroke = Stroke::solid(colour::VERMILLION, 1.8);

/// Draws the face; `along` is the tooth's own range.
pub(super) fn draw(canvas: &mut Canvas, area: Area, along: [f64; 2], side: &Side) {
    let half = side.wheel.face_width_mm / 2.0;
    let axes = Axes::new(area, [-1.12 * half, 1.12 * half], along);
    axes.title(canvas, "Tooth face");
    axes.x_axis(canvas, &Ticks::about_zero(half), "Face width, z (mm)");
    axes.y_grid(canvas, &Ticks::nice(along[0], along[1], 8));
    let (root, tip) = (side.profile.x_mm[0], side.profile.tip_x_mm());
    let top = if side.is_missing() { root } else { tip };
    canvas.rectangle(axes.at(-half, along[0]), axes.at(half, top), Fill::solid(colour::STEEL));
    if let Some(tooth) = side.tooth {
        for description in &tooth.descriptions {
            damaged(canvas, &axes, side, tooth, description);
        }
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

/// Whether the lower edge of a damage would cross the name above the start of contact.
fn contact_name_is_below(axes: &Axes, side: &Side) -> bool {
    let Some(tooth) = side.tooth.filter(|tooth| !tooth.is_missing()) else { return false };
    let half = side.wheel.face_width_mm / 2.0;
    let name_right = name_left(axes) + font::text_width(CONTACT_NAME, TextStyle::NOTE.size, false);
    tooth.descriptions.iter().any(|description| {
        let z_mm = match description {
            DamageDescription::ToothBreakage { .. } => return false,
            DamageDescription::FaceFault { width_mm, .. } => half - width_mm,
            DamageDescription::RootCrack { crack } => half - crack.length_mm.unwrap_or(2.0 * half),
            _ => -half,
        };
        let edge_x_mm = side.profile.x_mm[damage::damaged_range(description, tooth, side).0];
        let above = axes.py(side.contact_x_mm()) - axes.py(edge_x_mm);
        axes.px(z_mm) < name_right && above > 0.0 && above < NAME_HEIGHT
    })
}

fn damaged(
    canvas: &mut Canvas,
    axes: &Axes,
    side: &Side,
    tooth: &DamagedTooth,
    description: &DamageDescription,
) {
    let half = side.wheel.face_width_mm / 2.0;
    let (first, end) = damage::damaged_range(description, tooth, side);
    let x = |index: usize| side.profile.x_mm[index.min(side.last())];
    let tip = side.profile.tip_x_mm();
    match description {
        DamageDescription::MissingTooth => {
            canvas.rectangle(axes.at(-half, x(0)), axes.at(half, tip), LOST);
            let ghost = [(-half, x(0)), (-half, tip), (half, tip), (half, x(0))];
            canvas.polyline(&ghost.map(|(z, x)| axes.at(z, x)), DAMAGE_EDGE);
        }
        DamageDescription::ToothBreakage { chip_start_index, missing_width_mm, tip_loss_mm, .. } => {
            let bottom = x(*chip_start_index);
            let top = tooth.gone_from_index.min(side.last());
            let width = missing_width_mm.last().copied().unwrap_or(0.0);
            // The lost tip takes the chip's upper part with it.
            let end = if *tip_loss_mm > 0.0 { x(top) } else { tip };
            if bottom < end {
                let width = width * (end - bottom) / (tip - bottom);
                let chip = [(half, bottom), (half, end), (half - width, end)].map(|(z, x)| axes.at(z, x));
                canvas.polygon(&chip, LOST);
                canvas.line(chip[0], chip[2], EDGE);
            }
            if *tip_loss_mm > 0.0 {
                canvas.rectangle(axes.at(-half, end), axes.at(half, tip), LOST);
                canvas.line(axes.at(-half, end), axes.at(half, end), EDGE);
            }
        }
        DamageDescription::FaceFault { width_mm, .. } => {
            rectangle(canvas, axes, [half - width_mm, half], [x(first), x(end)]);
        }
        DamageDescription::Pits { pits, .. } => {
            let Some(flank) = &tooth.pits else { return };
            for pit in pits {
                let outline = ellipse(pit, side, &flank.along_mm, half);
                let outline: Vec<Pixel> = outline.into_iter().map(|(z, x)| axes.at(z, x)).collect();
                canvas.polygon(&outline, LOST);
                canvas.polyline(&outline, EDGE);
            }
        }
        DamageDescription::RootCrack { crack } => {
            let end = half - crack.length_mm.unwrap_or(2.0 * half);
            let (from, to) = (axes.at(end, crack.start_x_mm), axes.at(half, crack.start_x_mm));
            canvas.line(from, to, CRACK);
        }
        _ => {
            rectangle(canvas, axes, [-half, half], [x(first), x(end)]);
        }
    }
}

/// (mm) z and x of a pit's outline, within the face and the flank.
fn ellipse(pit: &FlankPit, side: &Side, along_mm: &[f64], half_mm: f64) -> Vec<(f64, f64)> {
    let x_at = |along: f64| {
        let index = along_mm.partition_point(|&other| other < along);
        side.profile.x_mm[index.min(side.last())]
    };
    (0..=OUTLINE)
        .map(|k| std::f64::consts::TAU * k as f64 / OUTLINE as f64)
        .map(|angle| {
            let z = pit.z_mm + pit.face_radius_mm * angle.cos();
            (z.clamp(-half_mm, half_mm), x_at(pit.along_mm + pit.radius_mm * angle.sin()))
        })
        .collect()
}

fn rectangle(canvas: &mut Canvas, axes: &Axes, z: [f64; 2], x: [f64; 2]) {
    canvas.rectangle(axes.at(z[0], x[0]), axes.at(z[1], x[1]), LOST);
    let corners = [(z[0], x[0]), (z[1], x[0]), (z[1], x[1]), (z[0], x[1]), (z[0], x[0])];
    canvas.polyline(&corners.map(|(z, x)| axes.at(z, x)), EDGE);
}

/// Below the start of contact and the damage, as far as there is room.
fn caption(canvas: &mut Canvas, axes: &Axes, side: &Side, tooth: &DamagedTooth, lowered: f64) {
    let middle = axes.area.left + axes.area.width / 2.0;
    let style = TextStyle::NOTE.coloured(colour::VERMILLION).anchored(Anchor::Middle).with_halo();
    let lines: Vec<String> = tooth.descriptions.iter().flat_map(damage::caption).take(MOST_LINES).collect();
    let below = if side.is_missing() {
        side.last()
    } else {
        let starts = tooth.descriptions.iter().map(|damage| match damage {
            // It lies just above the line of the root.
            DamageDescription::RootCrack { .. } => 0,
            _ => damage::damaged_range(damage, tooth, side).0,
        });
        starts.min().unwrap_or(side.last())
    };
    let lowest = side.contact_x_mm().min(side.profile.x_mm[below]);
    let first = axes.py(lowest) + 18.0 + lowered;
    let first = first.min(axes.area.bottom() - 6.0 - CAPTION_LINE * lines.len().saturating_sub(1) as f64);
    for (row, text) in lines.iter().enumerate() {
        canvas.text((middle, first + CAPTION_LINE * row as f64), text, style);
    }
}
