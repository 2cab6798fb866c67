//! Flanks that sliding has worn.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::description::hundredths;
use super::severity::SoundTooth;
use super::{DamageDescription, DamageResult, FacePatch, FaultyTeeth, Kind, QuantityValue, ToothPart};
use crate::error::ScenarioError;
use crate::keys::{Check, Range, check_keys, keys};
use crate::wheel::{Gears, Teeth, WheelName};

/// Worn working flanks: the sliding wear of Archard's law, scaled to its largest depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wear {
    /// (µm) Largest depth on the flank, along its normal; from 0 to 100.
    pub depth_um: f64,
}

/// (µm) Depth above which the flanks would bear otherwise than they wear by.
const MOST_UM: f64 = 100.0;

/// (µm) The largest depth, or half the thickness of a tooth where that is less.
fn most_um(tooth: &SoundTooth) -> f64 {
    MOST_UM.min(1e3 * tooth.least_half_thickness_mm())
}

keys! {
    Wear = Self { depth_um: f64::NAN };
    depth_um "µm" "the largest depth of wear, along the flank's normal"
        .required_unless(&["severity"])
        .range(Range::from_to(0.0, MOST_UM).help("a flank that is worn deeper touches where it was not worn before; for a flank that is destroyed, use kind = \"tooth-destruction\""));
}

impl Kind for Wear {
    const NAME: &str = "wear";
    const TITLE: &str = "wear";
    const PART: ToothPart = ToothPart::FlankSurface;
    const TEETH: FaultyTeeth = FaultyTeeth::All;
    const SIZES: &[&str] = &["depth_um"];

    fn example() -> Self {
        Self { depth_um: 30.0 }
    }

    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let most_um = most_um(tooth);
        (most_um > 0.0).then_some(Self { depth_um: severity * most_um })
    }

    /// Its depth over the largest.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        (self.depth_um / most_um(tooth)).clamp(0.0, 1.0)
    }

    fn check(&self, _gears: &Gears) -> Check {
        check_keys(self, "fault")
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let depth_mm = self.depths_mm(healthy);
        let (flank, y_mm) = (healthy.flank(), &healthy.profile().y_mm);
        let worn = |i: &usize| depth_mm[*i] > 0.0;
        for i in (0..depth_mm.len()).filter(worn) {
            let across_mm = depth_mm[i] / flank.at_curvature(flank.curvature_mm(i)).load_cos;
            if across_mm >= 2.0 * y_mm[i] {
                let problem =
                    format!("must be less than the tooth's thickness, {:.1} µm there", 2e3 * y_mm[i]);
                return Err(ScenarioError::new("fault.depth_um", self.depth_um, problem));
            }
            tooth.flank_y_mm[i] = tooth.flank_y_mm[i].min(y_mm[i] - across_mm);
            tooth.corner_y_mm[i] = tooth.corner_y_mm[i].min(tooth.flank_y_mm[i]);
        }
        Ok(self.describe(depth_mm, healthy))
    }
}

impl Wear {
    fn describe(&self, depth_mm: Vec<f64>, healthy: &HealthyTooth) -> DamageDescription {
        let first_contact = healthy.first_contact();
        let is_worn = |depth_mm: &f64| *depth_mm > 0.0;
        let start = depth_mm.iter().position(is_worn).unwrap_or(first_contact);
        let end = depth_mm.iter().rposition(is_worn).unwrap_or(first_contact);
        let range = [start.max(first_contact), end];
        let depth = format!("up to {} µm deep", hundredths(self.depth_um));
        DamageDescription {
            quantities: vec![
                ("indices", QuantityValue::Indices(vec![start, end])),
                ("depth_mm", QuantityValue::OverProfile(depth_mm)),
            ],
            face: vec![FacePatch::whole_width(range, healthy)],
            sizes: vec![depth.clone()],
            caption: vec!["flank worn".to_owned(), depth],
            ..DamageDescription::of::<Self>(range)
        }
    }

    /// (mm) Depth at the profile's points, along the flank's normal.
    fn depths_mm(&self, healthy: &HealthyTooth) -> Vec<f64> {
        let path = &healthy.teeth.path;
        // The point before the first one in contact, too: what lies between is interpolated.
        let first = healthy.first_contact().saturating_sub(1);
        let begin_mm = involutes_begin_mm(healthy.teeth);
        let shape: Vec<f64> = (0..healthy.profile().len())
            .map(|i| {
                let position = healthy.position(i).clamp(0.0, path.contact_ratio);
                if i < first { 0.0 } else { wear_rate(healthy.teeth, begin_mm, healthy.name, position) }
            })
            .collect();
        let largest = shape.iter().copied().fold(0.0, f64::max);
        shape.into_iter().map(|rate| rate / largest * self.depth_um * 1e-3).collect()
    }
}

/// (-) Depth that a flank loses in a mesh at a position of the path, but for a factor that is the same for all positions:
/// Archard's `dh = k p ds`, integrated while the contact passes the point, is `k F' |1 − v'/v|`, with the load per width and the
/// rolling speeds of the mate's and of its own flank.
///
/// Sources: J. F. Archard, "Contact and rubbing of flat surfaces", Journal of Applied Physics 24 (1953) 981–988; A. Flodin,
/// S. Andersson, "Simulation of mild wear in spur gears", Wear 207 (1997) 16–23.
fn wear_rate(teeth: &Teeth, begin_mm: [f64; 2], wheel: WheelName, position: f64) -> f64 {
    load_share(position, teeth.path.contact_ratio) * slide(teeth, begin_mm, wheel, position)
}

/// (modules) Least radius of curvature that a slide is computed with, of teeth without undercut: on the base circle itself a slide
/// is no number.
const LEAST_CURVATURE: f64 = 1e-3;

/// (mm) Radii of curvature at which the involutes of pinion and gear begin. What the rack has undercut bears nothing, though the
/// profile still has it there.
fn involutes_begin_mm(teeth: &Teeth) -> [f64; 2] {
    WheelName::BOTH.map(|wheel| {
        let wheel = teeth.wheel(wheel);
        wheel.undercut_curvature_mm().max(LEAST_CURVATURE * wheel.module_mm)
    })
}

/// (-) `|1 − v'/v|`: how far the mate slides over a point of a flank while the contact passes it, over the contact's length. The
/// speed at which the contact rolls along a flank is `v = ω ρ`. Where a flank would be touched below the beginning of its involute,
/// as of wheels that are undercut, the slide is that of the beginning.
///
/// # Arguments
/// * `teeth` - the wheels
/// * `wheel` - whose flank
/// * `position` - (base pitches) where on the path
///
/// ```
/// use meshtone::damage::slide_factor;
/// use meshtone::wheel::{Gears, WheelName, teeth};
///
/// let teeth = teeth(&Gears::new(3.0, 17, 38, 15.0), [10.0; 2]);
/// assert!((slide_factor(&teeth, WheelName::Pinion, 0.0) - 9.264).abs() < 5e-4);
/// assert!((slide_factor(&teeth, WheelName::Gear, 0.0) - 0.903).abs() < 5e-4);
/// ```
pub fn slide_factor(teeth: &Teeth, wheel: WheelName, position: f64) -> f64 {
    slide(teeth, involutes_begin_mm(teeth), wheel, position)
}

/// (-) The same where the involutes are known to begin.
fn slide(teeth: &Teeth, begin_mm: [f64; 2], wheel: WheelName, position: f64) -> f64 {
    let speed = |wheel: WheelName| {
        let (own, curvature_mm) = (teeth.wheel(wheel), teeth.path.curvature_mm(wheel, position));
        (own.sign() * curvature_mm).max(begin_mm[wheel as usize]) / f64::from(own.teeth)
    };
    (1.0 - speed(wheel.mate()) / speed(wheel)).abs()
}

/// (-) Part of the load that a pair carries at a position of its path, if all pairs were sound: the one with the least strain
/// energy, with the stiffness of a pair `cos(b (t − ε/2))`, `b = 1/√((1 + ε/2)²/2 − 1)`, over its largest.
///
/// Source: J. I. Pedrero, M. Pleguezuelos, M. Artés, J. A. Antona, "Load distribution model along the line of contact for involute
/// external gears", Mechanism and Machine Theory 45 (2010) 780–794, Eq. 13 to 16.
///
/// # Arguments
/// * `position` - (base pitches) of the pair on its path
/// * `contact_ratio` - (-) the path's length in base pitches
///
/// ```
/// use meshtone::damage::load_share;
///
/// // About a third where a pair enters, two thirds where the one before leaves, all where it is alone.
/// assert_eq!([0.0, 0.55, 0.8].map(|at| (load_share(at, 1.6) * 100.0).round()), [35.0, 62.0, 100.0]);
/// ```
pub fn load_share(position: f64, contact_ratio: f64) -> f64 {
    let middle = contact_ratio / 2.0;
    let b = ((1.0 + middle).powi(2) / 2.0 - 1.0).powf(-0.5);
    let stiffness = |position: f64| {
        let on_path = (0.0..=contact_ratio).contains(&position);
        if on_path { (b * (position - middle)).cos() } else { 0.0 }
    };
    let pairs = contact_ratio.ceil() as i32;
    stiffness(position) / (-pairs..=pairs).map(|pair| stiffness(position + f64::from(pair))).sum::<f64>()
}
