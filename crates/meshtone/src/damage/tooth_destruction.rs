//! A working flank that has been ground down along a straight line.

use super::severity::SoundTooth;
use std::ops::Bound::Excluded;

use meshtone_toml::{ReadResult, TomlTable};

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::description::{hundredths, largest_depth_mm, tenths};
use super::fault::end_after;
use super::pit_circle::flank_index;
use super::{DamageDescription, DamageResult, FacePatch, Kind, PaperRig, QuantityValue, ToothPart};
use crate::error::ScenarioError;
use crate::keys::{Check, Range, below, check_keys, field, flatten, keys};
use crate::random::{Draws, Purpose};
use crate::wheel::ToothProfile;
use crate::wheel::{Gears, HALF_THICKNESS};

/// A flank ground down along a straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothDestruction {
    /// (-) Where the line starts, as a fraction of the flank's contact part from its root side,
    /// in (−1, 1); negative: below the contact part.
    pub start: f64,
    /// Where the line goes.
    pub line: DestructionLine,
    /// (mm) How far the line lies inside the flank, across the tooth. Default 0.
    pub offset_mm: f64,
    /// (mm) Half width of a uniform roughness of the ground flank. Default 0.
    pub noise_mm: f64,
}

/// Direction of a destruction's line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DestructionLine {
    /// (-) Towards the flank point of this fraction, in (start, 1].
    End(f64),
    /// (°) Falling towards the tip at this angle to the tooth's centre line.
    SlopeDeg(f64),
}

keys! {
    ToothDestruction = Self { start: f64::NAN, line: DestructionLine::start(), offset_mm: 0.0, noise_mm: 0.0 }, chosen by line;
    start "-" "where the ground line begins, a fraction of the flank's contact part from its root; negative: below it"
        .required_unless(&["severity"])
        .range(Range::between(Excluded(-1.0), Excluded(1.0)).message("must be more than -1 and less than 1 (negative: below contact)"));
    .. { flatten(field!(line)) };
    offset_mm "mm" "how far inside the flank the line begins"
        .range(Range::not_negative()).rule("less than π/4 modules, half the tooth's thickness");
    noise_mm "mm" "the amplitude of the uniform random roughness of the ground flank"
        .range(Range::not_negative()).rule("likewise");
}

keys! {
    DestructionLine = Self::End(f64::NAN), chosen with given_form;
    [Self::End, 0] end "-" "the flank point to which the line leads, likewise"
        .required_unless(&["slope_deg", "severity"]).rule("more than `start`, ≤ 1");
    [Self::SlopeDeg, 0] slope_deg "°" "the angle to the tooth's centre line by which the line falls towards the tip, instead of end"
        .otherwise("none").range(Range::between(Excluded(0.0), Excluded(90.0))).alternative("22.0");
}

impl DestructionLine {
    /// Takes the form that is given.
    fn given_form(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
        match (table.optional("end").is_some(), table.optional("slope_deg").is_some()) {
            (true, false) => Ok(()),
            (false, true) => {
                *self = Self::SlopeDeg(f64::NAN);
                Ok(())
            }
            (true, true) => Err(table
                .error("slope_deg", "given beside end; exactly one of the two must say where the line leads")
                .with_help("remove slope_deg, or remove end")),
            (false, false) => Err(table
                .error("end", "missing, and slope_deg too; exactly one of the two must say where the line \
                               leads")
                .with_help("give end, a fraction of the flank after start, or slope_deg, an angle, or severity alone")),
        }
    }
}

impl Kind for ToothDestruction {
    const NAME: &str = "tooth-destruction";
    const RIG: PaperRig = PaperRig::Destruction;
    const TITLE: &str = "tooth destruction";
    const PART: ToothPart = ToothPart::FlankLength;
    const SIZES: &[&str] = &["start", "end", "slope_deg", "offset_mm"];

    fn example() -> Self {
        Self { start: 0.2143, line: DestructionLine::End(0.9286), offset_mm: 0.0, noise_mm: 0.0 }
    }

    /// The flank's chord up to the tip, the longer the more severe; of a ring, whose concave flank no chord cuts, the tangent.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let start = 1.0 - severity;
        let line = if tooth.is_concave() {
            let (at, ToothProfile { x_mm, y_mm, .. }) =
                (flank_index(start, tooth.profile, tooth.first_contact), tooth.profile);
            let next = (at + 1).min(x_mm.len() - 1);
            DestructionLine::SlopeDeg((y_mm[at] - y_mm[next]).atan2(x_mm[next] - x_mm[at]).to_degrees())
        } else {
            DestructionLine::End(1.0)
        };
        let ground = Self { start, line, offset_mm: 0.0, ..*self };
        (tooth.shows(severity) && ground.last_below(tooth.profile, tooth.first_contact).is_some())
            .then_some(ground)
    }

    /// The part of the flank's length in contact that is ground.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        if let (DestructionLine::End(end), 0.0) = (self.line, self.offset_mm) {
            return end - self.start.max(0.0);
        }
        let start = flank_index(self.start, tooth.profile, tooth.first_contact).max(tooth.first_contact);
        let last = self.last_below(tooth.profile, tooth.first_contact).unwrap_or(start);
        last.saturating_sub(start) as f64 / tooth.contact_steps()
    }

    fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        if let DestructionLine::End(end) = self.line {
            end_after(self.start, end)?;
        }
        let thickness = gears.half_thickness_mm();
        below("fault.offset_mm", self.offset_mm, thickness, HALF_THICKNESS)?;
        below("fault.noise_mm", self.noise_mm, thickness, HALF_THICKNESS)
    }

    fn is_drawn(&self) -> bool {
        self.noise_mm > 0.0
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let roughness = healthy.draws(Purpose::DestructionNoise, tooth.count_of::<Self>());
        let ground = self.grind(healthy.profile(), healthy.first_contact(), roughness, f64::min)?;
        for i in 0..ground.flank_y_mm.len() {
            if ground.deviation_mm[i] < 0.0 {
                tooth.flank_y_mm[i] = tooth.cut_y_mm(i, ground.flank_y_mm[i], healthy.profile());
                tooth.corner_y_mm[i] = tooth.flank_y_mm[i];
            }
        }
        Ok(ground.describe(healthy))
    }
}

/// A flank that has been ground down.
pub(crate) struct GroundFlank {
    /// First profile index that is ground.
    pub(crate) start_index: usize,
    /// Last profile index that is ground.
    pub(crate) end_index: usize,
    /// (rad) Angle of the line to the tooth's centre line.
    pub(crate) slope_rad: f64,
    /// (mm) The flank, over the profile points.
    pub(crate) flank_y_mm: Vec<f64>,
    /// (mm) How far the flank lies back along its own normal, the line of action when it is touched there; less than 0 where
    /// material is missing. Over the profile points.
    pub(crate) deviation_mm: Vec<f64>,
}

impl GroundFlank {
    /// The ground flank in words and pictures.
    ///
    /// # Arguments
    /// * `healthy` - the healthy tooth
    pub(crate) fn describe(&self, healthy: &HealthyTooth) -> DamageDescription {
        let depth = hundredths(largest_depth_mm(healthy.profile(), &self.flank_y_mm));
        let range = [self.start_index, self.end_index];
        DamageDescription {
            quantities: vec![
                ("indices", QuantityValue::Indices(vec![self.start_index, self.end_index])),
                ("slope_rad", QuantityValue::Number(self.slope_rad)),
            ],
            face: vec![FacePatch::whole_width(range, healthy)],
            sizes: vec![
                format!("flank ground up to {depth} mm deep across the tooth"),
                format!("line at {}° to the centre line", tenths(self.slope_rad.to_degrees().abs())),
            ],
            caption: vec!["flank ground down".to_owned()],
            ..DamageDescription::of::<ToothDestruction>(range)
        }
    }
}

/// The straight line that a flank is ground along.
struct GroundLine {
    /// Profile index where it starts.
    start_index: usize,
    x_mm: f64,
    y_mm: f64,
    /// (-) Tangent of its angle to the tooth's centre line; below 0 where it falls towards the tip.
    tangent: f64,
}

impl GroundLine {
    /// (mm) Its distance from the tooth's centre line.
    fn y_mm(&self, x_mm: f64) -> f64 {
        self.y_mm + self.tangent * (x_mm - self.x_mm)
    }
}

/// Part of the flank's height below which a line that meets the flank does so by rounding.
const ROUNDING: f64 = 1e-12;

impl ToothDestruction {
    /// Last profile index at which the line lies below the flank; none where there is no such point beyond its start.
    fn last_below(&self, profile: &ToothProfile, first_contact: usize) -> Option<usize> {
        let ToothProfile { x_mm, y_mm, .. } = profile;
        let line = self.line(profile, first_contact)?;
        let first = line.start_index.max(first_contact);
        // Without an offset the line meets the flank at the end's own point: there it does not lie below the flank, whichever
        // way the last bit is rounded.
        (first + 1..x_mm.len()).rev().find(|&i| line.y_mm(x_mm[i]) < y_mm[i] * (1.0 - ROUNDING))
    }

    /// The line, or none where it would end where it starts.
    fn line(&self, profile: &ToothProfile, first_contact: usize) -> Option<GroundLine> {
        let start = flank_index(self.start, profile, first_contact);
        let (x_start, y_start) = (profile.x_mm[start], profile.y_mm[start] - self.offset_mm);
        let tangent = match self.line {
            DestructionLine::SlopeDeg(slope) => -slope.abs().to_radians().tan(),
            DestructionLine::End(end) => {
                let end = flank_index(end, profile, first_contact);
                if end == start {
                    return None;
                }
                (profile.y_mm[end] - self.offset_mm - y_start) / (profile.x_mm[end] - x_start)
            }
        };
        Some(GroundLine { start_index: start, x_mm: x_start, y_mm: y_start, tangent })
    }

    /// Grinds a flank down.
    ///
    /// # Arguments
    /// * `profile` - the healthy flank
    /// * `first_contact` - profile index where contact starts at the root side
    /// * `roughness` - draws of the ground flank's roughness
    /// * `left_y_mm` - what is left of the flank, of the ground one and the healthy one
    ///
    /// # Errors
    /// A line that starts below the root, does not cut the flank, or leaves no tooth.
    pub(crate) fn grind(
        &self,
        profile: &ToothProfile,
        first_contact: usize,
        mut roughness: Draws,
        left_y_mm: impl Fn(f64, f64) -> f64,
    ) -> Result<GroundFlank, ScenarioError> {
        let contact_points = profile.len() - first_contact;
        let least_start = -(first_contact as f64) / (contact_points - 1) as f64;
        if self.start < least_start {
            let problem = format!("must be at least {least_start:.4}, where this tooth has its root");
            return Err(ScenarioError::new("fault.start", format!("{:?}", self.start), problem));
        }
        let Some(ground_line) = self.line(profile, first_contact) else {
            return Err(ScenarioError::new("fault.end", "", "must lie beyond the start of the line"));
        };
        let GroundLine { start_index: start, tangent, .. } = ground_line;
        let first = start.max(first_contact);
        let Some(last) = self.last_below(profile, first_contact) else {
            let problem = "the line must cut the flank: nowhere beyond its start does it lie below the flank";
            return Err(ScenarioError::new("fault.start", self.start, problem)
                .with_help("increase fault.offset_mm, or the slope or the distance from start to end"));
        };

        let mut flank_y_mm = profile.y_mm.clone();
        for i in first..=last {
            let ground = ground_line.y_mm(profile.x_mm[i]) + roughness.uniform(0.0, self.noise_mm);
            flank_y_mm[i] = left_y_mm(ground, profile.y_mm[i]);
            if flank_y_mm[i] <= -profile.y_mm[i] {
                let slope_deg = tangent.atan().to_degrees();
                let value = format!("offset_mm = {}, slope {slope_deg:.3}°", self.offset_mm);
                let (thickness, x) = (2.0 * profile.y_mm[i], profile.x_mm[i]);
                let problem = format!(
                    "must leave some of the tooth, which is {thickness:.3} mm thick at x = {x:.3} mm"
                );
                return Err(ScenarioError::new("fault", value, problem));
            }
        }

        let slope_rad = tangent.atan();
        let flank_angle = |i: usize, before: usize| {
            let (dx, dy) = (profile.x_mm[i] - profile.x_mm[before], profile.y_mm[i] - profile.y_mm[before]);
            (dy / dx).atan().abs()
        };
        let deviation_mm = (0..profile.len())
            .map(|i| {
                let angle = if i == 0 { 0.0 } else { flank_angle(i, i - 1) };
                -(profile.y_mm[i] - flank_y_mm[i]) * slope_rad.cos() / (angle + slope_rad).cos()
            })
            .collect();
        Ok(GroundFlank { start_index: first, end_index: last, slope_rad, flank_y_mm, deviation_mm })
    }
}
