//! A crack in the root of a tooth.

use std::f64::consts::PI;
use std::ops::Bound::{Excluded, Included};

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::description::{hundredths, tenths};
use super::severity::{LARGEST, SoundTooth};
use super::{DamageDescription, DamageResult, FacePatch, Kind, QuantityValue, ToothPart};
use crate::error::ScenarioError;
use crate::keys::{Check, Keys, Range, below, check_keys, keys, require};
use crate::wheel::{Gears, ToothProfile};

/// A crack from the fillet of the working flank into the tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RootCrack {
    /// (mm) Depth, from the fillet along the crack; where it is deepest.
    pub depth_mm: f64,
    /// (°) Angle to the tooth's centre line, in (0, 90]. Default 45.
    pub angle_deg: f64,
    /// (mm) Length along the face, from one side, over which the depth falls to 0; without it the crack is equally deep over
    /// the whole face.
    pub length_mm: Option<f64>,
}

keys! {
    RootCrack = Self { depth_mm: f64::NAN, angle_deg: 45.0, length_mm: None };
    depth_mm "mm" "the depth of the crack from the fillet, where it is deepest"
        .required_unless(&["severity"]).range(Range::not_negative())
        .rule("must not pass the tooth's centre line");
    angle_deg "°" "the crack's angle to the tooth's centre line"
        .range(Range::between(Excluded(0.0), Included(90.0)));
    length_mm "mm" "the length of the crack along the face, deepest at one side and ending in a parabola"
        .otherwise("over the whole face, equally deep").range(Range::positive())
        .rule("at most the face width").alternative("10.0");
}

impl Kind for RootCrack {
    const NAME: &str = "root-crack";
    const TITLE: &str = "root crack";
    const PART: ToothPart = ToothPart::Root;
    const SIZES: &[&str] = &["depth_mm", "length_mm"];

    fn example() -> Self {
        Self { depth_mm: 3.0, ..Self::start() }
    }

    /// Over the whole face.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        Some(Self { depth_mm: severity * self.largest_depth_mm(tooth), length_mm: None, ..*self })
    }

    /// The crack's area over the largest one's at its angle; two thirds of a parabola's depth and length.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        let along = self.length_mm.map_or(1.0, |length| 2.0 / 3.0 * length / tooth.face_width_mm);
        (self.depth_mm / self.largest_depth_mm(tooth) * along).min(1.0)
    }

    fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        below("fault.depth_mm", self.depth_mm, gears.tooth_height_mm(), "the tooth's height")?;
        self.length_mm.map_or(Ok(()), |length| {
            let problem = format!("must be at most {} mm, the face width", gears.face_width_mm);
            require("fault.length_mm", length, length <= gears.face_width_mm, problem).map_err(|error| {
                error.with_help("for a crack that is equally deep over the whole face, leave out length_mm")
            })
        })
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let crack = self.open(healthy.profile())?;
        tooth.crack = Some(crack);
        Ok(crack.describe(healthy))
    }
}

impl RootCrack {
    /// (mm) Depth at which the crack reaches the tooth's centre line, or nine tenths of the tooth's height where it is so steep
    /// that it would leave the tooth before.
    fn largest_depth_mm(&self, tooth: &SoundTooth) -> f64 {
        let (_, start_y_mm) = critical_point_mm(tooth.profile);
        (start_y_mm / self.angle_deg.to_radians().sin()).min(LARGEST * tooth.height_mm)
    }

    /// Where the crack lies.
    ///
    /// # Errors
    /// A crack beyond the tooth's centre line.
    fn open(&self, profile: &ToothProfile) -> Result<Crack, ScenarioError> {
        let (start_x_mm, start_y_mm) = critical_point_mm(profile);
        let angle_rad = self.angle_deg.to_radians();
        let deepest = start_y_mm / angle_rad.sin();
        if self.depth_mm > deepest {
            let problem = format!(
                "must be at most {deepest:.3} mm, where a crack at {}° from the fillet reaches the tooth's centre line",
                self.angle_deg
            );
            return Err(ScenarioError::new("fault.depth_mm", format!("{:?}", self.depth_mm), problem)
                .with_help("for a tooth that is about to break off, use kind = \"tooth-breakage\" or \"missing-tooth\""));
        }
        Ok(Crack { start_x_mm, start_y_mm, depth_mm: self.depth_mm, angle_rad, length_mm: self.length_mm })
    }
}

/// (mm) Where a root breaks: the point of the fillet whose tangent is at 30° to the tooth's centre line (ISO 6336-3), as x and
/// y. A fillet that is steeper everywhere has its end there, a flank without one its root.
fn critical_point_mm(profile: &ToothProfile) -> (f64, f64) {
    let (x, y) = (&profile.x_mm, &profile.y_mm);
    let critical = -(PI / 6.0).tan();
    let slope = |i: usize| (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    let steep = (0..profile.len() - 1).take_while(|&i| slope(i) < critical).count();
    if steep == 0 || steep + 1 == profile.len() {
        return (x[0], y[0]);
    }
    // Slopes are those of the middles between points.
    let (before, after) = (slope(steep - 1), slope(steep));
    let middle = |i: usize| (x[i] + x[i + 1]) / 2.0;
    let part = (critical - before) / (after - before);
    let at = middle(steep - 1) + part * (middle(steep) - middle(steep - 1));
    let beyond = at - x[steep];
    (at, y[steep] + beyond * if beyond < 0.0 { before } else { after })
}

/// Where a root crack lies, in the tooth's own plane.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Crack {
    /// (mm) Where it starts at the fillet, along the tooth's centre line from the wheel's centre.
    pub start_x_mm: f64,
    /// (mm) Where it starts, across the tooth from its centre line.
    pub start_y_mm: f64,
    /// (mm) Its largest depth.
    pub depth_mm: f64,
    /// (rad) Its angle to the centre line.
    pub angle_rad: f64,
    /// (mm) Length along the face from one side, over which the depth falls to 0 as a parabola, `q √(1 − s/length)` at the
    /// distance s; none for a depth that is the same over the whole face.
    pub length_mm: Option<f64>,
}

/// What is missing of a section above a height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ledge {
    /// (mm) The height, from the centre line.
    pub(super) above_y_mm: f64,
    /// (mm) Width that is missing from one end of the face.
    pub(super) missing_mm: f64,
}

/// Number of ledges that a section's parabolic edge is made of: its area is exact, its moments to about a hundredth of what
/// is missing.
const LEDGES: usize = 8;

impl Crack {
    /// (mm) x and y of its tip where it is deepest.
    pub fn tip_mm(&self) -> (f64, f64) {
        let (sin, cos) = self.angle_rad.sin_cos();
        (self.start_x_mm - self.depth_mm * cos, self.start_y_mm - self.depth_mm * sin)
    }

    fn describe(&self, healthy: &HealthyTooth) -> DamageDescription {
        let (profile, half) = (healthy.profile(), healthy.wheel().face_width_mm / 2.0);
        let (tip_x_mm, tip_y_mm) = self.tip_mm();
        let end = half - self.length_mm.unwrap_or(2.0 * half);
        let (up_to, extent) = match self.length_mm {
            Some(length_mm) => ("up to ", format!("{} mm along the face", hundredths(length_mm))),
            None => ("", "over the whole face".to_owned()),
        };
        let depth = format!("{up_to}{} mm deep", hundredths(self.depth_mm));
        let angle = format!("at {}° to the centre line", tenths(self.angle_rad.to_degrees()));
        DamageDescription {
            quantities: vec![
                ("crack_x_mm", QuantityValue::Numbers(vec![self.start_x_mm, tip_x_mm])),
                ("crack_y_mm", QuantityValue::Numbers(vec![self.start_y_mm, tip_y_mm])),
            ],
            face: vec![FacePatch {
                outline_mm: Vec::new(),
                edge_mm: vec![[end, self.start_x_mm], [half, self.start_x_mm]],
            }],
            caption: vec![format!("crack {depth},"), extent.clone()],
            sizes: vec![depth, angle, extent],
            ..DamageDescription::of::<RootCrack>([0, profile.nearest_to_x(self.start_x_mm)])
        }
    }

    /// (mm) Height up to which a section is left over the whole face.
    ///
    /// # Arguments
    /// * `x_mm` - (mm) where the section is
    /// * `y_mm` - (mm) half the thickness of the sound one
    pub(super) fn left_y_mm(&self, x_mm: f64, y_mm: f64) -> f64 {
        match self.length_mm {
            None => y_mm - self.lost_mm(x_mm, y_mm),
            Some(_) => y_mm,
        }
    }

    /// (mm) How much of a section's height is lost where the crack is deepest.
    ///
    /// Between its tip and its start the crack is the section's edge. Further out nothing above its tip carries a load: a
    /// height of as much as the crack reaches across the tooth, where the tooth is as thick as at the crack's start.
    fn lost_mm(&self, x_mm: f64, y_mm: f64) -> f64 {
        let (tip_x, tip_y) = self.tip_mm();
        let lost = if x_mm >= self.start_x_mm {
            // The involute's foot can be a little thicker than the crack's start.
            y_mm.min(self.start_y_mm) - tip_y
        } else if x_mm >= tip_x {
            y_mm - self.edge_y_mm(x_mm)
        } else {
            0.0
        };
        lost.max(0.0)
    }

    /// (mm) The crack's own height, below its start.
    fn edge_y_mm(&self, x_mm: f64) -> f64 {
        self.start_y_mm - (self.start_x_mm - x_mm) * self.angle_rad.tan()
    }

    /// What a crack over a part of the face takes from a section, from its lowest height upwards.
    ///
    /// # Arguments
    /// * `x_mm` - (mm) where the section is
    /// * `y_mm` - (mm) half the thickness of the sound one
    pub(super) fn ledges(&self, x_mm: f64, y_mm: f64) -> Vec<Ledge> {
        let lost = self.lost_mm(x_mm, y_mm);
        let Some(length) = self.length_mm.filter(|_| lost > 0.0) else { return Vec::new() };
        if x_mm < self.start_x_mm {
            // As far along the face as the crack reaches down to here.
            let part = (self.start_x_mm - x_mm) / (self.depth_mm * self.angle_rad.cos());
            return vec![Ledge { above_y_mm: y_mm - lost, missing_mm: length * (1.0 - part * part) }];
        }
        let reach = self.depth_mm * self.angle_rad.sin();
        // A crack of the part t of the largest depth takes the height t · reach − spare.
        let part = |height: f64| (height + reach - lost) / reach;
        let step = lost / LEDGES as f64;
        (0..LEDGES)
            .map(|n| {
                let (below, above) = (part(lost - n as f64 * step), part(lost - (n + 1) as f64 * step));
                let mean_square = (below * below + below * above + above * above) / 3.0;
                Ledge { above_y_mm: y_mm - lost + n as f64 * step, missing_mm: length * (1.0 - mean_square) }
            })
            .collect()
    }
}
