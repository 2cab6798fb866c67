//! The mesh stiffness over a revolution of the gear, and some of its pitches enlarged.

use std::ops::Range;

use meshtone::Stages;
use meshtone::wheel::WheelName;

use super::damage;
use crate::damaged_tooth::{self, DamagedTooth};
use crate::drawing::{Area, Axes, Canvas, Sample, Stroke, Ticks, axes, colour};

const MESH: Stroke = Stroke::solid(colour::BLUE, 1.6);
const HEALTHY: Stroke = Stroke::dashed(colour::INK, 1.4, &[5.0, 3.0]);
/// (px) Width of the enlarged part and the gap before it.
const ENLARGED_WIDTH: f64 = 430.0;
const GAP: f64 = 40.0;
/// Pitches that the enlarged part shows, counted from where the first damaged pair enters contact.
const ENLARGED: [i64; 2] = [-1, 3];

/// Draws both.
pub(super) fn draw(canvas: &mut Canvas, area: Area, stages: &Stages) {
    let damage = DamagedPairs::new(stages);
    let revolution = damage.revolution();
    let around = damage.first + ENLARGED[0]..damage.first + ENLARGED[1];
    let mesh = Mesh::new(stages, revolution.start.min(around.start)..revolution.end.max(around.end));
    let y = axes::range(mesh.values(), 0.07);
    let ticks = Ticks::nice(y[0], y[1], 5);
    let whole = Area { width: area.width - ENLARGED_WIDTH - GAP, ..area };
    let enlarged = Area { left: whole.right() + GAP, width: ENLARGED_WIDTH, ..area };
    let [whole, enlarged] = [(whole, &revolution), (enlarged, &around)]
        .map(|(area, pitches)| Axes::new(area, [pitches.start as f64, pitches.end as f64], y));
    for axes in [&whole, &enlarged] {
        for [from, to] in damage.turns(axes.x) {
            axes.band(canvas, from, to, damaged_tooth::TINT);
        }
    }
    whole.title(canvas, "Mesh stiffness over a gear revolution");
    let start = damage::start_of_revolution(&damage.wheels[1].1);
    let name = format!("Pitches since the gear’s {start}");
    whole.x_axis(canvas, &Ticks::whole(whole.x[0], whole.x[1], 20), &name);
    whole.y_axis(canvas, &ticks, "Stiffness (N/µm)", super::NAME_LEFT);
    enlarged.title(canvas, &damage.title_of_enlarged());
    enlarged.x_axis(canvas, &Ticks::nice(enlarged.x[0], enlarged.x[1], 8), "Pitches");
    enlarged.y_grid(canvas, &ticks);
    for axes in [&whole, &enlarged] {
        mesh.draw(canvas, axes, &damage.turns(axes.x));
        axes.frame(canvas);
    }
    damage.legend(canvas, &whole);
}

/// The pairs that a damaged tooth is in. Pair n enters contact n pitches after the start of the simulation.
struct DamagedPairs {
    /// Teeth of pinion and gear, and the damaged ones among them.
    wheels: [(i64, Vec<DamagedTooth>); 2],
    /// The first of the pairs; 0 where there is none.
    first: i64,
}

impl DamagedPairs {
    fn new(stages: &Stages) -> Self {
        let wheels = WheelName::BOTH.map(|wheel| {
            let teeth = i64::from(stages.layout.gears[0].teeth(wheel).max(1));
            (teeth, DamagedTooth::of_stages(stages, wheel))
        });
        let damaged = wheels.iter().flat_map(|(_, damaged)| damaged);
        let first = damaged.map(|tooth| i64::from(tooth.tooth) - 1).min().unwrap_or(0);
        Self { wheels, first }
    }

    /// The gear's revolution that the first one is in.
    fn revolution(&self) -> Range<i64> {
        let gear_teeth = self.wheels[1].0;
        let start = self.first / gear_teeth * gear_teeth;
        start..start + gear_teeth
    }

    /// (pitches) The parts of a window in which one of them is in contact; none where a wheel has no other teeth.
    fn turns(&self, window: [f64; 2]) -> Vec<[f64; 2]> {
        if !self.are_some() {
            return Vec::new();
        }
        let damaged = self.wheels.iter().flat_map(|(_, damaged)| damaged).next();
        let contact = damaged.map_or([0.0; 2], |tooth| tooth.contact_pitches);
        damaged_tooth::turns(window, contact, |pair| {
            self.wheels.iter().any(|(teeth, damaged)| damaged_tooth::is_of_pair(damaged, *teeth, pair))
        })
    }

    /// Whether the damaged teeth are but some of their wheels'.
    fn are_some(&self) -> bool {
        self.wheels.iter().all(|(teeth, damaged)| (damaged.len() as i64) < *teeth)
    }

    fn title_of_enlarged(&self) -> String {
        let is_first = |wheel: usize| {
            let (_, damaged) = &self.wheels[wheel];
            damaged.iter().any(|tooth| i64::from(tooth.tooth) == self.first + 1)
        };
        let tooth = self.first + 1;
        match (is_first(0), is_first(1)) {
            (_, true) if self.first == 0 => "Its first pitches, enlarged".to_owned(),
            (_, true) => format!("Around gear tooth {tooth}, enlarged"),
            (true, _) => format!("Around pinion tooth {tooth}, enlarged"),
            _ => "Four pitches, enlarged".to_owned(),
        }
    }

    fn legend(&self, canvas: &mut Canvas, axes: &Axes) {
        let [(_, pinion), (_, gear)] = &self.wheels;
        let Some(text) = damaged_tooth::in_words(&[("pinion", pinion), ("gear", gear)]) else { return };
        let [this, healthy] = match pinion[..] {
            [] => ["this gear", "healthy gear"],
            _ => ["this pair", "healthy pair"],
        };
        let tint = (Sample::Area(damaged_tooth::TINT), &*text);
        let curves = [(Sample::Line(MESH), this), (Sample::Line(HEALTHY), healthy)];
        let entries: Vec<_> = curves.into_iter().chain(self.are_some().then_some(tint)).collect();
        axes.legend(canvas, &entries);
    }
}

/// Stiffness of the mesh.
struct Mesh {
    /// From pitch `first_pitch` on, and a pitch more than is shown.
    mesh_n_per_um: Vec<f64>,
    first_pitch: i64,
    /// Of a pitch.
    healthy_n_per_um: Vec<f64>,
}

impl Mesh {
    /// The machine's first mesh.
    fn new(stages: &Stages, pitches: Range<i64>) -> Self {
        let first_pitch = pitches.start;
        let curve = stages.mesh_curves_over(first_pitch..pitches.end + 1).into_iter().next();
        let per_um = |of_mm: Vec<f64>| of_mm.into_iter().map(|stiffness| 1e-3 * stiffness).collect();
        let (mesh_n_per_um, healthy_n_per_um) = curve.map_or_else(Default::default, |curve| {
            (per_um(curve.stiffness_n_per_mm), per_um(curve.healthy_stiffness_n_per_mm))
        });
        Self { mesh_n_per_um, first_pitch, healthy_n_per_um }
    }

    fn values(&self) -> impl Iterator<Item = f64> {
        self.mesh_n_per_um.iter().chain(&self.healthy_n_per_um).copied()
    }

    /// Draws the mesh, and over the damaged `turns` the healthy one; also elsewhere, unless the two are the same there.
    fn draw(&self, canvas: &mut Canvas, axes: &Axes, turns: &[[f64; 2]]) {
        if self.mesh_n_per_um.is_empty() || self.healthy_n_per_um.is_empty() {
            axes.note(canvas, "no mesh stiffness");
            return;
        }
        let whole = [axes.x];
        let healthy = if self.differs_outside(turns, axes.x) { &whole } else { turns };
        for &part in healthy {
            axes.line(canvas, self.curve(&self.healthy_n_per_um, 0, part), HEALTHY);
        }
        axes.line(canvas, self.curve(&self.mesh_n_per_um, self.first_pitch, axes.x), MESH);
    }

    /// Returns whether it differs from the healthy one outside the turns of the damaged teeth that stand out, as where all others are worn.
    fn differs_outside(&self, turns: &[[f64; 2]], window: [f64; 2]) -> bool {
        // At the ends of a turn one point of each may hold a part of a pair.
        const PART: f64 = 0.1;
        let healthy = self.curve(&self.healthy_n_per_um, 0, window);
        let of_both = self.curve(&self.mesh_n_per_um, self.first_pitch, window).zip(healthy);
        let outside: Vec<bool> = of_both
            .filter(|((pitch, _), _)| !turns.iter().any(|[from, to]| (*from..=*to).contains(pitch)))
            .map(|((_, this), (_, healthy))| (this - healthy).abs() > 1e-3 * healthy)
            .collect();
        outside.iter().filter(|differs| **differs).count() as f64 > PART * outside.len() as f64
    }

    /// (pitches, N/µm) Values of a window.
    ///
    /// Where a pair enters or leaves contact, a point holds a part of that pair; to the window's edges reach the values beside them.
    fn curve<'a>(
        &self,
        values: &'a [f64],
        first_pitch: i64,
        [from, to]: [f64; 2],
    ) -> impl Iterator<Item = (f64, f64)> + use<'a> {
        let points_per_pitch = self.healthy_n_per_um.len();
        let per_pitch = points_per_pitch as f64;
        let first_point = first_pitch * points_per_pitch as i64;
        let (first, last) = ((from * per_pitch).ceil() as i64, (to * per_pitch).floor() as i64);
        let inside = move |k: i64| if last - first > 1 { k.clamp(first + 1, last - 1) } else { k };
        let value = move |k: i64| values[(k - first_point).rem_euclid(values.len() as i64) as usize];
        (first..=last).map(move |k| (k as f64 / per_pitch, value(inside(k))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pairs in contact over the first half of a pitch, one over the second; half of a pair where one enters.
    #[test]
    fn a_window_has_no_parts_of_pairs_at_its_edges() {
        let pitch: Vec<f64> =
            (0..10).map(|k| [1.5e3, 2e3, 1e3][if k == 0 { 0 } else { 1 + k / 5 }]).collect();
        let mesh = Mesh { mesh_n_per_um: pitch.repeat(4), first_pitch: -1, healthy_n_per_um: pitch.clone() };
        let of = |window| mesh.curve(&mesh.mesh_n_per_um, mesh.first_pitch, window).collect::<Vec<_>>();
        let whole = of([0.0, 2.0]);
        assert_eq!((whole[0], whole[1]), ((0.0, 2e3), (0.1, 2e3)));
        assert_eq!((whole[20], whole[19]), ((2.0, 1e3), (1.9, 1e3)));
        // Within the window a pair enters as it does.
        assert_eq!(whole[10], (1.0, 1.5e3));
        assert_eq!(of([0.25, 0.35]), [(0.3, 2e3)]);
    }
}
