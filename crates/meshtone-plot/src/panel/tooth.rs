//! The tooth in its own plane.

use meshtone::damage::{Crack, DamageDescription, DamagedTooth, ToothPart};

use super::side::Side;
use crate::damaged_tooth;
use crate::drawing::{
    Anchor, Area, Axes, Canvas, Colour, Fill, Pixel, Stroke, TextStyle, Ticks, capitalised, colour, curve,
};

const WORKING: Stroke = Stroke::solid(colour::BLUE, 2.4);
const BACK: Stroke = Stroke::solid(colour::MUTED, 1.6);
const DAMAGED: Stroke = Stroke::solid(colour::VERMILLION, 2.6);
pub(super) const DAMAGE_EDGE: Stroke = Stroke::dashed(colour::VERMILLION, 1.6, &[6.0, 3.0]);
/// A crack that is open.
pub(super) const CRACK: Stroke = Stroke::solid(colour::VERMILLION, 3.2);
const GHOST: Stroke = Stroke::dashed(colour::INK, 1.2, &[5.0, 3.0]);
pub(super) const LOST: Fill = Fill::tint(colour::VERMILLION, 0.3);
pub(super) const PARTLY_LOST: Fill = Fill::hatch(colour::VERMILLION);

/// Draws the tooth; `across` and `along` have the same scale.
pub(super) fn draw(canvas: &mut Canvas, area: Area, across: [f64; 2], along: [f64; 2], side: &Side) {
    let axes = Axes::titled(canvas, area, across, along, &title(side));
    axes.x_axis(canvas, &Ticks::nice(across[0], across[1], 9), "Across the tooth, y (mm)");
    let ticks = Ticks::nice(along[0], along[1], 8);
    axes.y_axis(canvas, &ticks, "From the wheel’s centre, x (mm)", super::NAME_LEFT);
    let tooth = Drawing { axes, side };
    tooth.body(canvas);
    tooth.circles(canvas);
    match side.tooth {
        Some(damaged) if damaged.is_missing() => tooth.missing(canvas),
        Some(damaged) => tooth.damaged(canvas, damaged),
        None => tooth.sound(canvas),
    }
    tooth.flank_names(canvas);
    axes.frame(canvas);
}

fn title(side: &Side) -> String {
    let title = format!("{}, in its plane", capitalised(&side.tooth_name()));
    let drawn = side.tooth_index() as u32 + 1;
    let others: Vec<_> = side.damaged.iter().copied().filter(|tooth| tooth.tooth != drawn).collect();
    match &others[..] {
        [] => title,
        others => format!("{title} (also damaged: {})", damaged_tooth::numbered("", others)),
    }
}

/// (px) Room that a row of remarks takes from the bottom.
const ROW_OF_REMARKS: f64 = 24.0;

/// A piece of the working flank from which material is gone.
struct Cut {
    /// First profile index.
    first: usize,
    /// Last profile index.
    end: usize,
    /// The flank that is left.
    flank: Vec<Pixel>,
    /// Whether it is gone over a part of the face width only.
    is_partial: bool,
}

struct Drawing<'a> {
    axes: Axes,
    side: &'a Side<'a>,
}

impl Drawing<'_> {
    /// The wheel around the tooth, and the tooth as far as it is there.
    fn body(&self, canvas: &mut Canvas) {
        let side = self.side;
        let last = side.last();
        let mut outline = self.space(-1.0);
        outline.reverse();
        match side.tooth {
            Some(tooth) if tooth.is_missing() => outline.extend(self.root_gap()),
            Some(tooth) => {
                let top = tooth.gone_from_index.clamp(1, last);
                outline.extend(self.flank(-1.0, 0, top));
                let outline_y_mm = tooth.outline_y_mm();
                let working = |index: usize| (outline_y_mm[index], side.profile.x_mm[index]);
                outline.extend(self.axes.along_y((0..=top).map(working)).into_iter().rev());
            }
            None => {
                outline.extend(self.slab(0, last));
            }
        }
        outline.extend(self.space(1.0));
        let (bottom, left, right) = (self.axes.area.bottom(), self.axes.area.left, self.axes.area.right());
        outline.extend([(right, bottom), (left, bottom)]);
        canvas.polygon(&outline, Fill::solid(colour::STEEL));
        for sign in [-1.0, 1.0] {
            canvas.polyline(&self.space(sign), BACK);
        }
        if side.is_missing() {
            canvas.polyline(&self.root_gap(), BACK);
        }
    }

    /// From the tooth's foot outwards to the frame: the bottom of the tooth space and the neighbour's flank.
    fn space(&self, sign: f64) -> Vec<Pixel> {
        let (profile, side) = (self.side.profile, self.side);
        let reach = self.axes.x[1];
        let pitch = std::f64::consts::TAU / f64::from(side.wheel.teeth);
        let polar = |index: usize| {
            let (y, x) = (profile.y_mm[index], profile.x_mm[index]);
            (x.hypot(y), y.atan2(x))
        };
        let (foot, foot_angle) = polar(0);
        let arc =
            (0..=20).map(|k| (foot, foot_angle + (pitch - 2.0 * foot_angle).max(0.0) * f64::from(k) / 20.0));
        let stride = (profile.len() / 400).max(1);
        let neighbour = (1..profile.len()).step_by(stride).map(|index| {
            let (radius, angle) = polar(index);
            (radius, pitch - angle)
        });
        let mut points = Vec::new();
        let (mut y, mut x) = (0.0, f64::NAN);
        for (radius, angle) in arc.chain(neighbour) {
            let (next_y, next_x) = (radius * angle.sin(), radius * angle.cos());
            if next_y > reach {
                let t = if next_y > y { (reach - y) / (next_y - y) } else { 1.0 };
                points.push((reach, if x.is_nan() { next_x } else { x + t * (next_x - x) }));
                break;
            }
            (y, x) = (next_y, next_x);
            points.push((y, x));
        }
        let lowest = self.axes.y[0];
        let pixels: Vec<Pixel> =
            points.into_iter().map(|(y, x)| self.axes.at(sign * y, x.max(lowest))).collect();
        curve::simplify(&pixels)
    }

    /// The root circle where the tooth has been.
    fn root_gap(&self) -> Vec<Pixel> {
        let (y, x) = self.side.flank(0, 1.0);
        let (radius, angle) = (x.hypot(y), y.atan2(x));
        (-10..=10)
            .map(|k| angle * f64::from(k) / 10.0)
            .map(|angle| self.axes.at(radius * angle.sin(), (radius * angle.cos()).max(self.axes.y[0])))
            .collect()
    }

    fn flank(&self, sign: f64, first: usize, last: usize) -> Vec<Pixel> {
        self.axes.along_y((first..=last).map(|index| self.side.flank(index, sign)))
    }

    /// The part of the sound tooth between two profile points.
    fn slab(&self, first: usize, last: usize) -> Vec<Pixel> {
        let mut outline = self.flank(-1.0, first, last);
        outline.extend(self.flank(1.0, first, last).into_iter().rev());
        outline
    }

    fn across_at(&self, canvas: &mut Canvas, index: usize, stroke: Stroke) {
        let [(a_y, a_x), (b_y, b_x)] = [self.side.flank(index, -1.0), self.side.flank(index, 1.0)];
        canvas.line(self.axes.at(a_y, a_x), self.axes.at(b_y, b_x), stroke);
    }

    fn sound(&self, canvas: &mut Canvas) {
        let last = self.side.last();
        self.across_at(canvas, last, BACK);
        canvas.polyline(&self.flank(-1.0, 0, last), BACK);
        canvas.polyline(&self.flank(1.0, 0, last), WORKING);
    }

    fn missing(&self, canvas: &mut Canvas) {
        let last = self.side.last();
        let mut ghost = self.slab(0, last);
        canvas.polyline(&ghost, DAMAGE_EDGE);
        // Down to the root that is left, which rises between the feet.
        ghost.extend(self.root_gap().into_iter().rev());
        canvas.polygon(&ghost, LOST);
        let wheel = self.side.wheel;
        // Between the circles, and beside the names of the flanks.
        let at = self.axes.at(0.0, (wheel.pitch_radius_mm + wheel.tip_radius_mm) / 2.0);
        let style = TextStyle::NOTE.coloured(colour::VERMILLION).anchored(Anchor::Middle).bold();
        canvas.text(at, "missing", style);
    }

    /// Draws a damaged tooth: what is lost, what is left of its outline, and the edges of the damage.
    ///
    /// Areas are filled before lines are drawn, so that no fill hides a line. Of the flank that works, the sound pieces are drawn between
    /// the cuts, and each cut closes the outline to both of its neighbours.
    fn damaged(&self, canvas: &mut Canvas, tooth: &DamagedTooth) {
        let last = self.side.last();
        let top = tooth.gone_from_index.min(last);
        let chips = tooth.descriptions.iter().filter(|damage| damage.part == ToothPart::Tip);
        let chips: Vec<usize> = chips.map(|damage| damage.range[0].min(top)).collect();
        let cuts = self.cuts(tooth, top);
        for &chip in &chips {
            canvas.polygon(&self.slab(chip, top), PARTLY_LOST);
            canvas.polygon(&self.slab(top, last), LOST);
        }
        for cut in &cuts {
            let sound = self.flank(1.0, cut.first, cut.end);
            let between: Vec<Pixel> = cut.flank.iter().chain(sound.iter().rev()).copied().collect();
            canvas.polygon(&between, if cut.is_partial { PARTLY_LOST } else { LOST });
            canvas.polyline(&sound, GHOST);
        }
        if top < last {
            canvas.polyline(&self.flank(-1.0, top, last), GHOST);
            canvas.polyline(&self.flank(1.0, top, last), GHOST);
        }
        self.across_at(canvas, last, if top < last { GHOST } else { BACK });
        canvas.polyline(&self.flank(-1.0, 0, top), BACK);
        let mut sound_from = 0;
        for cut in &cuts {
            canvas.polyline(&self.flank(1.0, sound_from, cut.first.max(sound_from)), WORKING);
            sound_from = cut.end;
        }
        canvas.polyline(&self.flank(1.0, sound_from, top), WORKING);
        for cut in &cuts {
            // From edge to edge of the sound flank, so that the damaged one leaves no gap to it.
            let (head, tail) = (self.side.flank(cut.first, 1.0), self.side.flank(cut.end, 1.0));
            let mut closed = vec![self.axes.at(head.0, head.1)];
            closed.extend(&cut.flank);
            closed.push(self.axes.at(tail.0, tail.1));
            canvas.polyline(&closed, DAMAGED);
        }
        for &chip in &chips {
            self.across_at(canvas, chip, DAMAGE_EDGE);
        }
        if top < last {
            self.across_at(canvas, top, DAMAGED);
        }
        if let Some(crack) = &tooth.crack {
            self.crack(canvas, crack);
        }
        if tooth.descriptions.iter().any(|damage| damage.is_partial) {
            self.remark(canvas, 0, "hatched: lost over part of the face width", colour::VERMILLION);
        } else if tooth.crack.is_some() {
            self.remark(canvas, 0, "dashed: nothing beyond carries load", colour::VERMILLION);
        }
    }

    /// Where material is gone from the flank below `top`, from the root outwards.
    fn cuts(&self, tooth: &DamagedTooth, top: usize) -> Vec<Cut> {
        let outline_y_mm = tooth.outline_y_mm();
        let at = |index: usize| (outline_y_mm[index], self.side.profile.x_mm[index]);
        let cut = |damage: &DamageDescription| {
            let [first, end] = damage.range.map(|index| index.min(top));
            Cut { first, end, flank: self.axes.along_y((first..=end).map(at)), is_partial: damage.is_partial }
        };
        let of_flank = tooth.descriptions.iter().filter(|damage| damage.part.is_of_flank());
        let mut cuts: Vec<Cut> = of_flank.map(cut).collect();
        cuts.sort_by_key(|cut| cut.first);
        cuts
    }

    /// The crack, and the height above which the tooth's sections carry nothing there.
    fn crack(&self, canvas: &mut Canvas, crack: &Crack) {
        let (tip_x, tip_y) = crack.tip_mm();
        let tip = self.axes.at(tip_y, tip_x);
        canvas.line(tip, self.axes.at(tip_y, self.side.profile.tip_x_mm()), DAMAGE_EDGE);
        canvas.line(self.axes.at(crack.start_y_mm, crack.start_x_mm), tip, CRACK);
    }

    /// Words in the wheel's body, in a row counted from the bottom.
    fn remark(&self, canvas: &mut Canvas, row: usize, text: &str, colour: Colour) {
        let style = TextStyle::NOTE.coloured(colour).anchored(Anchor::Middle);
        let area = self.axes.area;
        let at = (area.left + area.width / 2.0, area.bottom() - 8.0 - 1.15 * style.size * row as f64);
        canvas.text(at, text, style);
    }

    /// Root, base, pitch and tip circle, with their names right of the frame.
    fn circles(&self, canvas: &mut Canvas) {
        let wheel = self.side.wheel;
        let circles = [
            ("root", wheel.root_radius_mm, Stroke::solid(colour::MUTED, 0.9)),
            ("base", wheel.base_radius_mm, Stroke::dashed(colour::MUTED, 0.9, &[3.0, 3.0])),
            ("pitch", wheel.pitch_radius_mm, Stroke::dashed(colour::MUTED, 0.9, &[10.0, 3.0, 2.0, 3.0])),
            ("tip", wheel.tip_radius_mm, Stroke::solid(colour::MUTED, 0.9)),
        ];
        let mut names = Vec::new();
        for (name, radius, stroke) in circles {
            let arc: Vec<Pixel> = self.arc(radius);
            if name == "base" && self.leaves_the_view(radius) {
                self.remark(canvas, 1, "base circle below the root", colour::MUTED);
            } else if arc.len() > 1 {
                canvas.polyline(&arc, stroke);
                let end = arc[arc.len() - 1];
                names.push((name, end.1, end.0 > self.axes.area.right() - 1.0));
            }
        }
        let size = TextStyle::NOTE.size;
        // From the bottom upwards, each name clear of the one below.
        let mut ceiling = self.axes.area.bottom() + size;
        names.sort_by(|a, b| b.1.total_cmp(&a.1));
        let right = self.axes.area.right();
        for (name, y, reaches_frame) in names {
            let baseline = (y + 0.36 * size).min(ceiling - 1.2 * size);
            ceiling = baseline;
            if reaches_frame {
                let leader = Stroke::solid(colour::MUTED, 0.8);
                canvas.line((right, y), (right + 8.0, baseline - 0.36 * size), leader);
            }
            canvas.text((right + 11.0, baseline), name, TextStyle::NOTE.coloured(colour::MUTED));
        }
    }

    /// Whether a circle lies so far below the root that it would meet the remarks or not be seen at all. The base circle
    /// is below the root from 42 teeth on, where the pressure angle is 20°.
    fn leaves_the_view(&self, radius: f64) -> bool {
        radius < self.side.wheel.root_radius_mm
            && self.axes.py(radius) > self.axes.area.bottom() - ROW_OF_REMARKS
    }

    /// The visible part of a circle round the wheel's centre, from left to right.
    fn arc(&self, radius: f64) -> Vec<Pixel> {
        let reach = self.axes.x[1];
        let [low, high] = self.axes.y;
        let widest = (radius * radius - low * low).max(0.0).sqrt().min(reach);
        (-40..=40)
            .map(|k| widest * f64::from(k) / 40.0)
            .map(|y| (y, (radius * radius - y * y).max(0.0).sqrt()))
            .filter(|&(_, x)| x >= low - 1e-9 * radius && x <= high)
            .map(|(y, x)| self.axes.at(y, x))
            .collect()
    }

    fn flank_names(&self, canvas: &mut Canvas) {
        let wheel = self.side.wheel;
        let area = self.axes.area;
        let middle = self.axes.py((wheel.pitch_radius_mm + wheel.tip_radius_mm) / 2.0);
        let line = 1.2 * TextStyle::NOTE.size;
        let drive = TextStyle::NOTE.coloured(colour::BLUE).anchored(Anchor::End).bold().with_halo();
        let coast = TextStyle::NOTE.coloured(colour::MUTED).bold().with_halo();
        for (row, [left, right]) in [["back", "working"], ["flank", "flank"]].into_iter().enumerate() {
            let y = middle + line * row as f64;
            canvas.text((area.left + 10.0, y), left, coast);
            canvas.text((area.right() - 10.0, y), right, drive);
        }
    }
}
