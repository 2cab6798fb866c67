//! The tooth's profile errors, among those of all teeth.

use super::face::{CONTACT, RELIEF};
use super::side::Side;
use crate::drawing::{Area, Axes, Canvas, Fill, Pixel, Sample, Stroke, Ticks, axes, colour, legend};
use meshtone::wheel::ErrorTable;

const THIS: Stroke = Stroke::solid(colour::BLUE, 2.0);
const ALL: Fill = Fill::tint(colour::BLUE, 0.2);

/// Draws the errors; `along` is the tooth's own range.
pub(super) fn draw(canvas: &mut Canvas, area: Area, along: [f64; 2], side: &Side) {
    let errors = side.errors_mm.filter(|errors| errors.points() > 1 && errors.teeth() > side.tooth_index());
    let largest = 1e3 * axes::largest(errors.into_iter().flat_map(ErrorTable::each_tooth).flatten());
    let half = if largest > 0.0 { 1.15 * largest } else { 10.0 };
    let axes = Axes::titled(canvas, area, [-half, half], along, "Profile errors");
    axes.x_axis(canvas, &Ticks::about_zero(half), "Error (µm)");
    axes.y_grid(canvas, &Ticks::nice(along[0], along[1], 8));
    let zero = [side.contact_x_mm(), side.profile.tip_x_mm()].map(|x| axes.at(0.0, x));
    canvas.line(zero[0], zero[1], Stroke::solid(colour::MUTED, 0.9));
    match errors {
        Some(errors) => curves(canvas, &axes, side, errors),
        None => axes.note(canvas, "ideal teeth"),
    }
    axes.horizontal(canvas, side.contact_x_mm(), CONTACT);
    for (shape, _) in side.tip_shapes.iter().filter(|(x_mm, _)| *x_mm > side.contact_x_mm()) {
        axes.horizontal(canvas, *shape, RELIEF);
    }
    axes.frame(canvas);
}

fn curves(canvas: &mut Canvas, axes: &Axes, side: &Side, errors: &ErrorTable) {
    let rows = errors.points();
    let (low, high) = (side.profile.radius_mm(side.contact_index), side.wheel.tip_radius_mm);
    let x_mm: Vec<f64> = (0..rows)
        .map(|row| side.x_at_radius_mm(low + (high - low) * row as f64 / (rows - 1) as f64))
        .collect();
    // From the start of contact to the tip, whichever way the rows run.
    let row = |place: usize| if side.errors_from_tip { rows - 1 - place } else { place };
    let extreme = |pick: fn(f64, f64) -> f64, start: f64| -> Vec<Pixel> {
        axes.along_y((0..rows).map(|place| {
            (1e3 * errors.each_tooth().map(|tooth| tooth[row(place)]).fold(start, pick), x_mm[place])
        }))
    };
    let mut band = extreme(f64::min, f64::INFINITY);
    band.extend(extreme(f64::max, f64::NEG_INFINITY).into_iter().rev());
    canvas.polygon(&band, ALL);
    let all = (Sample::Area(ALL), "all teeth");
    let start = (axes.area.left + 6.0, axes.area.bottom() - 26.0);
    if side.is_missing() {
        legend::column(canvas, start, &[all]);
        return;
    }
    let tooth = side.tooth_index();
    let own = (0..rows).map(|place| (1e3 * errors[(row(place), tooth)], x_mm[place]));
    canvas.polyline(&axes.along_y(own), THIS);
    legend::column(canvas, start, &[(Sample::Line(THIS), &side.tooth_name()), all]);
}
