//! The mesh stiffness over a revolution of the gear, and its first pitches enlarged.

use meshtone::Stages;

use super::damage;
use crate::DamagedTooth;
use crate::axes::{self, Area, Axes};
use crate::canvas::Canvas;
use crate::legend::{self, Entry, Sample};
use crate::style::{Stroke, colour};
use crate::ticks::Ticks;

const MESH: Stroke = Stroke::solid(colour::BLUE, 1.6);
const HEALTHY: Stroke = Stroke::dashed(colour::INK, 1.4, &[5.0, 3.0]);
/// (px) Width of the enlarged part and the gap before it.
const ENLARGED_WIDTH: f64 = 430.0;
const GAP: f64 = 40.0;
/// Pitches that the enlarged part shows, counted from where the first tooth enters contact.
const ENLARGED: [f64; 2] = [-1.0, 3.0];

/// Draws both.
pub(super) fn draw(canvas: &mut Canvas, area: Area, stages: &Stages) {
    let mesh = Mesh::new(stages);
    let damaged = damage::damaged_tooth(stages);
    let y = axes::range(mesh.values().map(|stiffness| stiffness / 1e3), 0.07);
    let ticks = Ticks::nice(y[0], y[1], 5);
    let whole = Axes::new(
        Area::new(area.left, area.top, area.width - ENLARGED_WIDTH - GAP, area.height),
        [0.0, mesh.pitches()],
        y,
    );
    let enlarged =
        Axes::new(Area::new(whole.area.right() + GAP, area.top, ENLARGED_WIDTH, area.height), ENLARGED, y);
    for axes in [&whole, &enlarged] {
        if let Some(tooth) = damaged {
            tooth.tint(canvas, axes, 1.0);
        }
    }
    whole.title(canvas, "Mesh stiffness over a gear revolution");
    let start = damage::start_of_revolution(stages.fault.as_ref());
    let name = format!("Pitches since the gear’s {start}");
    whole.x_axis(canvas, &Ticks::whole(0.0, mesh.pitches(), 20), &name);
    whole.y_axis(canvas, &ticks, "Stiffness (N/µm)", super::NAME_LEFT);
    enlarged.title(
        canvas,
        if damaged.is_some() { "Its first pitches, enlarged" } else { "Four pitches, enlarged" },
    );
    enlarged.x_axis(canvas, &Ticks::nice(ENLARGED[0], ENLARGED[1], 8), "Pitches");
    enlarged.y_grid(canvas, &ticks);
    for axes in [&whole, &enlarged] {
        mesh.draw(canvas, axes, damaged.map(|tooth| tooth.contact_pitches));
        axes.frame(canvas);
    }
    if let Some(tooth) = damaged {
        legend(canvas, &whole, tooth);
    }
}

fn legend(canvas: &mut Canvas, axes: &Axes, tooth: DamagedTooth) {
    let entries = [
        Entry { sample: Sample::Line(MESH), text: "this gear" },
        Entry { sample: Sample::Line(HEALTHY), text: "healthy gear" },
        tooth.legend_entry(),
    ];
    legend::row(canvas, (axes.area.right(), axes.area.top - axes::TITLE_ABOVE), &entries);
}

/// Stiffness on the grid of the cycle.
struct Mesh<'a> {
    mesh_n_per_mm: &'a [f64],
    healthy_n_per_mm: &'a [f64],
}

impl<'a> Mesh<'a> {
    fn new(stages: &'a Stages) -> Self {
        Self {
            mesh_n_per_mm: &stages.mesh.mesh_n_per_mm,
            healthy_n_per_mm: &stages.mesh.healthy_mesh_n_per_mm,
        }
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.mesh_n_per_mm.iter().chain(self.healthy_n_per_mm).copied()
    }

    /// Number of points from one tooth to the next.
    fn per_pitch(&self) -> usize {
        self.healthy_n_per_mm.len().max(1)
    }

    fn pitches(&self) -> f64 {
        (self.mesh_n_per_mm.len() as f64 / self.per_pitch() as f64).max(1.0)
    }

    fn draw(&self, canvas: &mut Canvas, axes: &Axes, damaged_contact: Option<f64>) {
        if self.mesh_n_per_mm.is_empty() || self.healthy_n_per_mm.is_empty() {
            axes.note(canvas, "no mesh stiffness");
            return;
        }
        let per_pitch = self.per_pitch() as f64;
        // The cycle repeats: what comes before the first tooth is the revolution's end.
        let curve = |values: &'a [f64], [from, to]: [f64; 2]| {
            let length = values.len() as i64;
            let (first, last) = ((from * per_pitch).ceil() as i64, (to * per_pitch).floor() as i64);
            (first..=last).map(move |k| (k as f64 / per_pitch, values[k.rem_euclid(length) as usize] / 1e3))
        };
        // Elsewhere the two are the same.
        if let Some(contact) = damaged_contact {
            axes.line(canvas, curve(self.healthy_n_per_mm, [0.0, contact.min(axes.x[1])]), HEALTHY);
        }
        axes.line(canvas, curve(self.mesh_n_per_mm, axes.x), MESH);
    }
}
