//! The circle that a pit cuts into the flank.

use std::ops::Bound::{Excluded, Included};

use meshtone_toml::{ReadResult, TomlTable};

use super::damaged_tooth::HealthyTooth;
use super::description::{hundredths, largest_depth_mm};
use super::fault::end_after;
use super::severity::SoundTooth;
use super::{DamageDescription, FacePatch, Kind, QuantityValue};
use crate::error::ScenarioError;
use crate::interpolation::UniformLinear;
use crate::keys::{Check, Range, keys, rows, sub_table};
use crate::wheel::{ToothProfile, first_minimum};
use std::f64::consts::PI;

/// A circle cut into the flank, in the tooth's own plane (x along its centre line from the
/// wheel's centre, y towards the working flank).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PitCircle {
    /// By the points where it meets the flank.
    Fractions {
        /// (-) First edge, as a fraction of the flank's contact part from its root side, in \[0, 1).
        start: f64,
        /// (-) Second edge, likewise, in (start, 1\].
        end: f64,
        /// (-) Depth of the pit over half its chord, in (0, 1].
        depth: f64,
    },
    /// By centre and radius.
    Circle {
        /// (mm) Centre, along the tooth's centre line.
        x_mm: f64,
        /// (mm) Centre, across the tooth.
        y_mm: f64,
        /// (mm) Radius.
        radius_mm: f64,
    },
}

keys! {
    PitCircle = Self::Fractions { start: f64::NAN, end: f64::NAN, depth: f64::NAN }, chosen with given_form;
    [Self::Fractions] start "-" "the pit's first edge, a fraction of the flank's contact part from its root"
        .required_unless(&["circle", "severity"])
        .range(Range::below_one().message("must be from 0 to less than 1; 0 is where contact starts at the root side, 1 the tip"));
    [Self::Fractions] end "-" "the pit's second edge, likewise"
        .required_unless(&["circle", "severity"]).rule("more than `start`, ≤ 1");
    [Self::Fractions] depth "-" "the pit's depth over half its chord"
        .required_unless(&["circle", "severity"])
        .range(Range::between(Excluded(0.0), Included(1.0)).help("depth is relative: the depth of the pit over half its chord"))
        .rule("the circle must not undercut the flank: about 0.7 in its middle, 0.4 at the tip");
    = { sub_table(
        "circle",
        "the circle that is cut into the flank, instead of start, end and depth",
        rows! {
            [Self::Circle] x_mm "mm" "the centre's position along the tooth's centre line, from the wheel's centre"
                .required().range(Range::positive());
            [Self::Circle] y_mm "mm" "the centre's distance from the tooth's centre line, towards the working flank"
                .required();
            [Self::Circle] radius_mm "mm" "the circle's radius" .required().range(Range::positive());
        },
    )
    .otherwise("none")
    .rule("must cut the flank twice")
    .alternative("{ x_mm = 57.5, y_mm = 3.66, radius_mm = 2.5 }") };
}

impl PitCircle {
    /// Takes the form that is given.
    fn given_form(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
        let circle = table.optional("circle");
        let any_fraction = ["start", "end", "depth"].map(|key| table.optional(key).is_some()).contains(&true);
        match (circle.is_some(), any_fraction) {
            (true, true) => Err(table
                .error("circle", "given beside start, end or depth; a pit is described in only one way")
                .with_help("remove circle, or remove start, end and depth")),
            (true, false) => {
                *self = Self::Circle { x_mm: f64::NAN, y_mm: f64::NAN, radius_mm: f64::NAN };
                Ok(())
            }
            (false, true) => Ok(()),
            (false, false) => Err(table
                .error("start", "missing, and circle too; a pit needs one of the two descriptions")
                .with_help("give start, end and depth, or circle = { x_mm = …, y_mm = …, radius_mm = … }, or severity alone")),
        }
    }
}

impl PitCircle {
    /// What a file to start from has.
    pub(super) fn example() -> Self {
        Self::Fractions { start: 0.2, end: 0.8, depth: 0.5 }
    }

    /// A pit in the middle of the flank's part in contact.
    ///
    /// # Arguments
    /// * `length` - (-) as [`Self::length`]
    pub(super) fn of_length(length: f64) -> Self {
        Self::Fractions { start: 0.5 - length / 2.0, end: 0.5 + length / 2.0, depth: SHALLOW }
    }

    /// (-) How long it is, as a fraction of the flank's part in contact.
    pub(super) fn length(&self, tooth: &SoundTooth) -> f64 {
        match *self {
            Self::Fractions { start, end, .. } => end - start,
            Self::Circle { x_mm, y_mm, radius_mm } => {
                let x_mm = on_wheel_mm(x_mm, tooth.profile);
                let points = tooth.profile.x_mm.iter().zip(&tooth.profile.y_mm).skip(tooth.first_contact);
                let inside = points.filter(|(x, y)| (*x - x_mm).hypot(*y - y_mm) < radius_mm).count();
                inside as f64 / tooth.contact_steps()
            }
        }
    }

    /// The second edge lies behind the first.
    pub(super) fn check_edges(&self) -> Check {
        match *self {
            Self::Fractions { start, end, .. } => end_after(start, end),
            Self::Circle { .. } => Ok(()),
        }
    }
}

/// (-) Depth over half the chord that a pit of a given severity has: no flank is so slanted that its circle would undercut it.
const SHALLOW: f64 = 0.2;

/// A pit's place on the flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pit {
    /// First profile index inside the pit.
    pub(crate) start_index: usize,
    /// Middle of the pit.
    pub(crate) mid_index: usize,
    /// Last profile index inside the pit.
    pub(crate) end_index: usize,
    /// (mm) Chord between the pit's edges.
    pub(crate) length_mm: f64,
    /// (-) `length_mm` over the chord of the flank's contact part.
    pub(crate) length_fraction: f64,
    /// (rev) Position at which the pit enters contact.
    pub(crate) start_rev: f64,
    /// (rev) Position at which it leaves contact.
    pub(crate) end_rev: f64,
}

impl Pit {
    /// The pit in words and pictures.
    ///
    /// # Arguments
    /// * `width_mm` - (mm) its width along the face, from one end
    /// * `flank_y_mm` - (mm) the flank with the pit cut into it
    /// * `healthy` - the healthy tooth
    pub(crate) fn describe<K: Kind>(
        &self,
        width_mm: f64,
        flank_y_mm: &[f64],
        healthy: &HealthyTooth,
    ) -> DamageDescription {
        let (profile, face_width_mm) = (healthy.profile(), healthy.wheel().face_width_mm);
        let range = [self.start_index, self.end_index];
        let half = face_width_mm / 2.0;
        let [width, length] = [width_mm, self.length_mm].map(hundredths);
        let depth = hundredths(largest_depth_mm(profile, flank_y_mm));
        DamageDescription {
            quantities: vec![
                ("indices", QuantityValue::Indices(vec![self.start_index, self.mid_index, self.end_index])),
                ("length_mm", QuantityValue::Number(self.length_mm)),
                ("length_fraction", QuantityValue::Number(self.length_fraction)),
                ("positions_rev", QuantityValue::Numbers(vec![self.start_rev, self.end_rev])),
            ],
            is_partial: width_mm < face_width_mm,
            face: vec![FacePatch::rectangle([half - width_mm, half], range.map(|index| profile.x_mm[index]))],
            sizes: vec![
                format!("{width} mm wide"),
                format!("{length} mm long"),
                format!("up to {depth} mm deep across the tooth"),
            ],
            caption: vec![format!("pit {width} mm wide,"), format!("{length} mm long")],
            ..DamageDescription::of::<K>(range)
        }
    }
}

struct Circle {
    x_mm: f64,
    y_mm: f64,
    radius_mm: f64,
}

impl Circle {
    /// (mm) y of the lower half at `x_mm`.
    fn lower_y_mm(&self, x_mm: f64) -> f64 {
        self.y_mm - (self.radius_mm.powi(2) - (x_mm - self.x_mm).powi(2)).max(0.0).sqrt()
    }
}

/// Number of points of the lower half circle among which the pit's edges are sought.
const CIRCLE_SAMPLES: usize = 10_000;

/// Cuts the circle into a flank.
///
/// # Arguments
/// * `given` - the circle
/// * `profile` - the healthy flank
/// * `first_contact` - profile index where contact starts at the root side
/// * `edge_samples` - which samples of the lower half circle are the pit's edges, the root side's first, by their heights above
///   the flank
/// * `position_rev` - (rev) position of a profile point in contact
///
/// # Returns
/// Where the pit lies, and (mm) the flank with it, over the profile points.
///
/// # Errors
/// A circle that does not cut the contact part of the flank in two points, or reaches through the tooth.
pub(crate) fn cut_flank(
    given: &PitCircle,
    profile: &ToothProfile,
    first_contact: usize,
    edge_samples: impl Fn(&[f64]) -> (usize, usize),
    position_rev: impl Fn(usize) -> f64,
) -> Result<(Pit, Vec<f64>), ScenarioError> {
    let (key, value) = match given {
        PitCircle::Fractions { start, end, depth } => {
            ("fault", format!("start {start}, end {end}, depth {depth}"))
        }
        PitCircle::Circle { x_mm, y_mm, radius_mm } => {
            ("fault.circle", format!("{{ x_mm = {x_mm}, y_mm = {y_mm}, radius_mm = {radius_mm} }}"))
        }
    };
    let refuse = |problem: String| ScenarioError::new(key, &value, problem);
    let circle = resolve(given, profile, first_contact);
    if let PitCircle::Fractions { start, end, depth } = given {
        let most = deepest(*start, *end, profile, first_contact);
        if *depth > most {
            let problem = format!("must be at most {most:.4} on this flank, or the circle would undercut it");
            return Err(ScenarioError::new("fault.depth", format!("{depth:?}"), problem));
        }
    }
    let (start_y, end_y) = edges(&circle, profile, first_contact, edge_samples)
        .ok_or_else(|| refuse(misses_flank(profile, first_contact)))?;

    // The flank falls with x, so "above an edge's y" is "before it".
    let above = |y_mm: f64| profile.y_mm.iter().rposition(|&y| y > y_mm);
    let (start, end) = above(start_y)
        .zip(above(end_y).and_then(|i| i.checked_sub(1)))
        .map(|(before, end)| (before + 1, end))
        .filter(|&(start, end)| start >= first_contact && end > start + 1)
        .ok_or_else(|| refuse(misses_flank(profile, first_contact)))?;

    let mut flank_y_mm = profile.y_mm.clone();
    for i in start..=end {
        flank_y_mm[i] = circle.lower_y_mm(profile.x_mm[i]);
        if flank_y_mm[i] <= -profile.y_mm[i] {
            return Err(refuse(format!(
                "must be less deep than the tooth, which is {:.3} mm thick at x = {:.3} mm",
                2.0 * profile.y_mm[i],
                profile.x_mm[i].abs()
            )));
        }
    }
    let chord =
        |a: usize, b: usize| (profile.x_mm[a] - profile.x_mm[b]).hypot(profile.y_mm[a] - profile.y_mm[b]);
    let length_mm = chord(start, end);
    // A driving tooth enters contact at its root side, a driven one at its tip.
    let positions_rev = [start, end].map(position_rev);
    let pit = Pit {
        start_index: start,
        mid_index: (start + end) / 2,
        end_index: end,
        length_mm,
        length_fraction: length_mm / chord(first_contact, profile.len() - 1),
        start_rev: positions_rev[0].min(positions_rev[1]),
        end_rev: positions_rev[0].max(positions_rev[1]),
    };
    Ok((pit, flank_y_mm))
}

fn misses_flank(profile: &ToothProfile, initial_contact: usize) -> String {
    format!(
        "must cut the contact part of the flank in two points, with its half nearer to the tooth's centre line; the flank \
         runs from x = {:.3}, y = {:.3} mm to \
         x = {:.3}, y = {:.3} mm",
        profile.x_mm[initial_contact].abs(),
        profile.y_mm[initial_contact],
        profile.tip_x_mm().abs(),
        profile.y_mm[profile.len() - 1]
    )
}

/// Centre and radius, where the pit is given by fractions of the flank.
fn resolve(circle: &PitCircle, profile: &ToothProfile, initial_contact: usize) -> Circle {
    match *circle {
        PitCircle::Circle { x_mm, y_mm, radius_mm } => {
            Circle { x_mm: on_wheel_mm(x_mm, profile), y_mm, radius_mm }
        }
        PitCircle::Fractions { start, end, depth } => {
            let point = |fraction: f64| {
                let i = flank_index(fraction, profile, initial_contact);
                (profile.x_mm[i], profile.y_mm[i])
            };
            let ((x1, y1), (x2, y2)) = (point(start), point(end));
            let chord = (x2 - x1).hypot(y2 - y1);
            let radius_mm = chord / 4.0 * (depth + 1.0 / depth);
            let rise = (radius_mm * radius_mm - chord * chord / 4.0).max(0.0).sqrt();
            // The flank falls with x: its normal towards larger x and y.
            let (normal_x, normal_y) = ((y1 - y2) / chord, (x2 - x1) / chord);
            Circle {
                x_mm: (x1 + x2) / 2.0 + rise * normal_x,
                y_mm: (y1 + y2) / 2.0 + rise * normal_y,
                radius_mm,
            }
        }
    }
}

/// (mm) A distance from the wheel's centre, counted as the profile's x are: less than 0 of a ring.
fn on_wheel_mm(x_mm: f64, profile: &ToothProfile) -> f64 {
    x_mm.copysign(profile.x_mm[0])
}

/// Profile index at a fraction of the flank's contact part, from its root side.
pub(super) fn flank_index(fraction: f64, profile: &ToothProfile, initial_contact: usize) -> usize {
    let last = profile.len() - 1;
    let offset = (fraction * (last - initial_contact) as f64).round();
    (initial_contact as f64 + offset).clamp(0.0, last as f64) as usize
}

/// Largest relative depth at which both edges lie on the circle's half nearer to the tooth's centre line.
///
/// A chord at φ to the centre line carries an arc of half angle θ with `depth = tan(θ/2)`; its ends lie on the lower half
/// while `θ + φ ≤ 90°`.
fn deepest(start: f64, end: f64, profile: &ToothProfile, initial_contact: usize) -> f64 {
    let [a, b] = [start, end].map(|fraction| flank_index(fraction, profile, initial_contact));
    let (dx, dy) = (profile.x_mm[b] - profile.x_mm[a], profile.y_mm[b] - profile.y_mm[a]);
    (PI / 4.0 - dy.abs().atan2(dx) / 2.0).tan()
}

/// (mm) y of the flank at the two points where the lower half circle meets it, the root side's first.
fn edges(
    circle: &Circle,
    profile: &ToothProfile,
    initial_contact: usize,
    edge_samples: impl Fn(&[f64]) -> (usize, usize),
) -> Option<(f64, f64)> {
    let first = profile.nearest_to_x(circle.x_mm - circle.radius_mm).max(initial_contact);
    let last = profile.nearest_to_x(circle.x_mm + circle.radius_mm);
    if last < first + 2 {
        return None;
    }
    let (x, y) = (&profile.x_mm[first..=last], &profile.y_mm[first..=last]);
    let samples: Vec<(f64, f64)> = (0..CIRCLE_SAMPLES)
        .map(|k| {
            let angle = PI + PI * k as f64 / (CIRCLE_SAMPLES - 1) as f64;
            (circle.x_mm + circle.radius_mm * angle.cos(), circle.y_mm + circle.radius_mm * angle.sin())
        })
        .collect();
    let above: Vec<f64> = samples.iter().map(|&(sx, sy)| sy - linear(x, y, sx)).collect();
    // A circle that meets the flank dips below it between the two edges.
    let deepest = first_minimum(above.iter().copied());
    if above[deepest] >= 0.0 || above[0] < 0.0 || above[CIRCLE_SAMPLES - 1] < 0.0 {
        return None;
    }
    let (a, b) = edge_samples(&above);
    let flank_y = |k: usize| samples[k].1 - above[k];
    Some((flank_y(a), flank_y(b)))
}

/// The samples of a half circle that are nearest to the flank on either side of the deepest one.
fn nearest_on_either_side(above: &[f64]) -> (usize, usize) {
    let deepest = first_minimum(above.iter().copied());
    let nearest = |range: &[f64]| first_minimum(range.iter().map(|d| d.abs()));
    (nearest(&above[..deepest]), deepest + nearest(&above[deepest..]))
}

/// Straight lines through (x, y), x uniform; the end pieces extrapolate.
fn linear(x: &[f64], y: &[f64], at: f64) -> f64 {
    let step = (x[x.len() - 1] - x[0]) / (x.len() - 1) as f64;
    UniformLinear::uniform(x[0], step, y).at(at)
}

impl HealthyTooth<'_> {
    /// Cuts a circle into this tooth's flank: where the pit lies, and the flank with it.
    ///
    /// # Errors
    /// As [`cut_flank`].
    pub(super) fn cut(&self, circle: &PitCircle) -> Result<(Pit, Vec<f64>), ScenarioError> {
        let position_rev = |index| self.position_rev(index);
        cut_flank(circle, self.profile(), self.first_contact(), nearest_on_either_side, position_rev)
    }
}
