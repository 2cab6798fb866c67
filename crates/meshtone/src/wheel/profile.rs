//! The profile of a healthy tooth: fillet, involute, uniform reduction, tip relief.

use super::radii::Wheel;
use crate::interpolation::NaturalSpline;

/// Working flank of a tooth in its own plane: x along the tooth's centre line from the wheel's
/// centre, y towards the flank. Points are uniform in x from root to tip. A ring's x is less than 0, so that it rises towards the tip too.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothProfile {
    /// (mm) Distance from the wheel's centre along the tooth's centre line, rising.
    pub x_mm: Vec<f64>,
    /// (mm) Half thickness of the tooth.
    pub y_mm: Vec<f64>,
    /// (mm) Distance of the points from the wheel's centre before the uniform reduction and relief: how far the wheel has rolled when its
    /// mate is there.
    pub involute_radius_mm: Vec<f64>,
    /// Index of the point where the tip relief starts, in the wheel's own sampling (the pinion's before it is resampled).
    pub tip_relief_index: Option<usize>,
}

impl ToothProfile {
    /// Number of points.
    pub fn len(&self) -> usize {
        self.x_mm.len()
    }

    /// Returns whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.x_mm.is_empty()
    }

    /// (mm) Distance of point `index` from the wheel's centre.
    pub fn radius_mm(&self, index: usize) -> f64 {
        self.x_mm[index].hypot(self.y_mm[index])
    }

    /// (mm) x of the tip.
    pub fn tip_x_mm(&self) -> f64 {
        self.x_mm[self.len() - 1]
    }

    /// Index of the point nearest to `radius_mm` from the wheel's centre (the first of equals).
    pub fn nearest_to_radius(&self, radius_mm: f64) -> usize {
        let squared = |i: usize| self.x_mm[i] * self.x_mm[i] + self.y_mm[i] * self.y_mm[i];
        // The square finds the neighbourhood, the radius itself the point.
        let near = first_minimum((0..self.len()).map(|i| (squared(i) - radius_mm * radius_mm).abs()));
        let around = near.saturating_sub(2)..(near + 3).min(self.len());
        around.start + first_minimum(around.map(|i| (self.radius_mm(i) - radius_mm).abs()))
    }

    /// Index of the point whose x is nearest to `x_mm` (the first of equals).
    pub fn nearest_to_x(&self, x_mm: f64) -> usize {
        first_minimum(self.x_mm.iter().map(|x| (x - x_mm).abs()))
    }
}

/// Index of the first smallest value.
pub(crate) fn first_minimum(values: impl Iterator<Item = f64>) -> usize {
    let mut best = (0, f64::INFINITY);
    for (index, value) in values.enumerate() {
        if value < best.1 {
            best = (index, value);
        }
    }
    best.0
}

/// Generates the working flank of a healthy tooth.
///
/// # Arguments
/// * `wheel` - the tooth's wheel
/// * `points` - (≥ 2) number of points, uniform in x
/// * `uniform_flank_reduction_mm` - (mm) constant reduction of y
/// * `relief` - tip relief, or none
/// * `root` - what the flank has below the involute
pub fn tooth_profile(
    wheel: &Wheel,
    points: usize,
    uniform_flank_reduction_mm: f64,
    relief: Option<TipRelief>,
    root: Root,
) -> ToothProfile {
    let flank = Curve::new(wheel, root);
    let start = flank.start_x_mm();
    let step = (flank.tip_x_mm() - start) / (points - 1) as f64;
    let mut x_mm: Vec<f64> = (0..points).map(|i| start + step * i as f64).collect();
    x_mm[points - 1] = flank.tip_x_mm();
    let mut roll = RollAngle::default();
    let mut y_mm: Vec<f64> = x_mm.iter().map(|&x| flank.half_thickness_mm(x, &mut roll)).collect();
    let involute_radius_mm = x_mm.iter().zip(&y_mm).map(|(x, y)| (x * x + y * y).sqrt()).collect();
    for y in &mut y_mm {
        *y -= uniform_flank_reduction_mm;
    }
    let mut profile = ToothProfile { x_mm, y_mm, involute_radius_mm, tip_relief_index: None };
    if let Some(relief) = relief {
        relieve_tip(&mut profile, relief);
    }
    profile
}

/// What a flank has below the involute.
#[derive(Debug, Clone)]
pub enum Root {
    /// An arc that touches the root circle in the middle of the space and ends at the base circle, or at the root circle where that is
    /// the larger one: the arc is then the root circle itself.
    Arc,
    /// As in the published code: nothing where the root circle lies outside the base circle; elsewhere an arc, and a curve that takes
    /// the place of arc and involute round their joint, if any.
    Published(Option<NaturalSpline>),
}

/// The exact curve that the profile samples.
///
/// With the roll angle `u = tan a` and `β = θ0 + inv α − u` the involute `r = Rb/cos a`,
/// `θ = θ0 + inv α − inv a` reads `x = Rb (cos β − u sin β)`, `y = Rb (sin β + u cos β)`.
struct Curve {
    /// Less than 0 of a ring.
    base_radius_mm: f64,
    /// (rad) `θ0 + inv α`: polar angle of the involute's foot on the base circle.
    foot_angle_rad: f64,
    /// Roll angle where the sampled part of the involute starts.
    first_roll: f64,
    last_roll: f64,
    fillet: Option<Fillet>,
    bridge: Option<NaturalSpline>,
}

/// A circular arc from the root circle, mid-way between two teeth, to the start of the involute.
///
/// Along the ray at angle γ from the arc's centre the near intersection is
/// `r = c − √(c² − Rd (Rd + 2ρ))`, `c = (Rd + ρ) cos γ`: a circle of radius ρ round the point
/// (Rd + ρ, π/z) in polar coordinates.
struct Fillet {
    /// Less than 0 where the centre lies on the wheel's side: −Rd on the root circle itself.
    radius_mm: f64,
    centre_x_mm: f64,
    centre_y_mm: f64,
    start_x_mm: f64,
    end_x_mm: f64,
}

/// Number of points on the involute among which the root circle is sought.
const INVOLUTE_SAMPLES: usize = 15_001;

impl Curve {
    fn new(wheel: &Wheel, root: Root) -> Self {
        let (base, root_radius) = (wheel.base_radius_mm, wheel.root_radius_mm);
        let tip_angle = (base / wheel.tip_radius_mm).acos();
        let fillet = match root {
            Root::Published(_) if root_radius >= base => None,
            _ => Fillet::new(wheel),
        };
        let first_roll = match root {
            Root::Arc => ((root_radius / base).powi(2) - 1.0).max(0.0).sqrt(),
            Root::Published(_) if fillet.is_some() => 0.0,
            Root::Published(_) => {
                let angle = |k: usize| tip_angle * k as f64 / (INVOLUTE_SAMPLES - 1) as f64;
                // The radius rises with k: the nearest is next to the exact solution.
                let exact = (base / root_radius).acos() / angle(1);
                let first = (exact as usize).saturating_sub(1);
                let distance = |k: usize| ((base / angle(k).cos()).powi(2) - root_radius * root_radius).abs();
                let near = (first..first + 4).filter(|&k| k < INVOLUTE_SAMPLES);
                angle(first + first_minimum(near.map(distance))).tan()
            }
        };
        let bridge = match root {
            Root::Published(bridge) => bridge,
            Root::Arc => None,
        };
        Self {
            base_radius_mm: wheel.sign() * base,
            foot_angle_rad: wheel.foot_angle_rad(),
            first_roll,
            last_roll: tip_angle.tan(),
            fillet,
            bridge,
        }
    }

    fn involute_point_mm(&self, roll: f64) -> (f64, f64) {
        let (sin, cos) = (self.foot_angle_rad - roll).sin_cos();
        (self.base_radius_mm * (cos - roll * sin), self.base_radius_mm * (sin + roll * cos))
    }

    fn start_x_mm(&self) -> f64 {
        self.fillet.as_ref().map_or_else(|| self.involute_point_mm(self.first_roll).0, |f| f.start_x_mm)
    }

    fn tip_x_mm(&self) -> f64 {
        self.involute_point_mm(self.last_roll).0
    }

    /// y at `x`; `roll` carries the solution from one point to the next, rising x.
    fn half_thickness_mm(&self, x: f64, roll: &mut RollAngle) -> f64 {
        if let Some(bridge) = &self.bridge
            && x > bridge.range().0
            && x < bridge.range().1
        {
            return bridge.at(x);
        }
        if let Some(fillet) = &self.fillet
            && x < fillet.end_x_mm
        {
            return fillet.y_mm(x);
        }
        // dx/d(u²) = Rb cos β / 2 does not vanish at the base circle, dx/du does: solve for u².
        let least_roll = self.first_roll.min(self.last_roll);
        let mut squared = roll.predicted().max(least_roll * least_roll);
        let mut y = 0.0;
        for _ in 0..MAX_NEWTON_STEPS {
            let u = squared.sqrt();
            let (sin, cos) = roll.turned.sin_cos(self.foot_angle_rad - u);
            let step = 2.0 * (x / self.base_radius_mm - (cos - u * sin)) / cos;
            squared = (squared + step).max(0.0);
            // y at the end of the step, to first order.
            y = self.base_radius_mm * (sin + u * cos + 0.5 * step * sin);
            // The next step, and the error of y, are quadratic in this one: below rounding.
            if step.abs() < 1e-9 * (1e-6 + squared) {
                break;
            }
        }
        roll.remember(squared);
        y
    }
}

const MAX_NEWTON_STEPS: usize = 20;

/// Squares of the roll angle at the last three points, from which the next is predicted, and the last angle's sine and cosine.
#[derive(Default)]
struct RollAngle {
    squared: [f64; 3],
    known: usize,
    turned: TurnedAngle,
}

/// An angle whose sine and cosine are known, and from which those of angles nearby follow.
#[derive(Default)]
struct TurnedAngle {
    angle_rad: f64,
    sin: f64,
    cos: f64,
    turns_left: usize,
}

impl TurnedAngle {
    /// (rad) Largest turn: the series' first neglected terms are below 1e-24.
    const LARGEST_RAD: f64 = 1e-3;
    /// Turns until rounding errors, one more with each, are forgotten.
    const MOST_TURNS: usize = 32;

    /// Sine and cosine, by the addition theorem where the angle before is near.
    fn sin_cos(&mut self, angle_rad: f64) -> (f64, f64) {
        let turn = angle_rad - self.angle_rad;
        if self.turns_left == 0 || turn.abs() > Self::LARGEST_RAD {
            (self.sin, self.cos) = angle_rad.sin_cos();
            self.turns_left = Self::MOST_TURNS;
        } else {
            let square = turn * turn;
            let sin = turn * (1.0 - square / 6.0 * (1.0 - square / 20.0));
            let versine = square / 2.0 * (1.0 - square / 12.0 * (1.0 - square / 30.0));
            let (before_sin, before_cos) = (self.sin, self.cos);
            self.sin = before_sin + (before_cos * sin - before_sin * versine);
            self.cos = before_cos - (before_sin * sin + before_cos * versine);
            self.turns_left -= 1;
        }
        self.angle_rad = angle_rad;
        (self.sin, self.cos)
    }
}

impl RollAngle {
    /// The parabola through the last three points, which are uniform in x.
    fn predicted(&self) -> f64 {
        let [a, b, c] = self.squared;
        if self.known < 3 { c } else { (3.0 * (c - b) + a).max(0.0) }
    }

    fn remember(&mut self, squared: f64) {
        self.squared = [self.squared[1], self.squared[2], squared];
        self.known += 1;
    }
}

/// (-) Least curvature of the arc, over that of the root circle: nearly a straight line.
const STRAIGHT: f64 = 1e-9;

impl Fillet {
    /// None where the flanks of two teeth meet above the root circle, and of a ring, whose root circle bends away from its teeth.
    fn new(wheel: &Wheel) -> Option<Self> {
        if wheel.is_internal {
            return None;
        }
        let root = wheel.root_radius_mm;
        // Where the involute starts, and the angle from the middle of the space to it.
        let end = wheel.base_radius_mm.max(root);
        let end_angle = wheel.half_thickness_angle_at_rad(end);
        let psi = wheel.half_pitch_angle_rad() - end_angle;
        if psi <= 0.0 {
            return None;
        }
        let versed = 4.0 * root * end * libm::pow((psi / 2.0).sin(), 2.0);
        let squared_chord = (end - root) * (end - root) + versed;
        let room = 2.0 * (end - root) - versed / root;
        let curvature = room / squared_chord;
        let radius_mm = 1.0 / if curvature.abs() * root < STRAIGHT { STRAIGHT / root } else { curvature };
        let (sin, cos) = wheel.half_pitch_angle_rad().sin_cos();
        Some(Self {
            radius_mm,
            centre_x_mm: (root + radius_mm) * cos,
            centre_y_mm: (root + radius_mm) * sin,
            start_x_mm: root * cos,
            end_x_mm: end * end_angle.cos(),
        })
    }

    fn y_mm(&self, x: f64) -> f64 {
        let dx = x - self.centre_x_mm;
        let height = (self.radius_mm * self.radius_mm - dx * dx).max(0.0).sqrt();
        self.centre_y_mm - height.copysign(self.radius_mm)
    }
}

/// Material removed near the tip along a parabola that leaves the flank with the flank's own slope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipRelief {
    /// (mm) Length along the tooth's centre line, from the tip inwards.
    pub length_mm: f64,
    /// (mm) How far the tip lies below the flank point where the relief starts.
    pub depth_mm: f64,
}

impl TipRelief {
    /// The relief that the published code gives all teeth, whatever their module; the other models have none that thins the tooth.
    pub const PUBLISHED: Self = Self { length_mm: 1.0, depth_mm: 1.0 };
}

fn relieve_tip(profile: &mut ToothProfile, relief: TipRelief) {
    let tip = profile.tip_x_mm();
    let edge = profile.nearest_to_x(tip - relief.length_mm);
    let (x_edge, y_edge) = (profile.x_mm[edge], profile.y_mm[edge]);
    let slope =
        if edge == 0 { 0.0 } else { (y_edge - profile.y_mm[edge - 1]) / (x_edge - profile.x_mm[edge - 1]) };
    let reach = tip - x_edge;
    let quadratic = (-relief.depth_mm - slope * reach) / (reach * reach);
    for (x, y) in profile.x_mm.iter().zip(&mut profile.y_mm).skip(edge) {
        let dx = x - x_edge;
        *y = y_edge + dx * (slope + quadratic * dx);
    }
    profile.tip_relief_index = Some(edge);
}
