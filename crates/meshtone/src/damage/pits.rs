//! Pits on the working flank, listed or drawn.

use std::f64::consts::PI;

use meshtone_toml::{ReadResult, TomlTable};

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::description::tenths;
use super::pit_circle::flank_index;
use super::severity::{LARGEST, SoundTooth};
use super::{DamageDescription, DamageResult, FacePatch, FlankPits, Kind, QuantityValue, ToothPart};
use crate::error::ScenarioError;
use crate::keys::{Check, KeyRow, Range, check_keys, keys, require, rows, sub_table};
use crate::random::{Draws, Purpose};
use crate::wheel::{Gears, ToothProfile};

/// Pits on the working flank: ellipses with upright walls and an even bottom.
#[derive(Debug, Clone, PartialEq)]
pub enum Pits {
    /// Each with its place and size.
    Listed {
        /// (-) Centres, as fractions of the flank's contact part from its root side, in \[0, 1\].
        at: Vec<f64>,
        /// (mm) Centres along the face, from its middle.
        z_mm: Vec<f64>,
        /// (mm) Radii along the flank.
        radius_mm: Vec<f64>,
        /// (mm) Radii along the face. Default: those along the flank.
        face_radius_mm: Option<Vec<f64>>,
        /// (mm) Depths along the flank's normal.
        depth_mm: Vec<f64>,
    },
    /// Drawn for each tooth, about the working pitch circle, where the flanks roll.
    Drawn {
        /// (1/cm²) Mean number of pits in a square centimetre of the flank's contact part; the number is drawn from a Poisson
        /// distribution.
        density_per_cm2: f64,
        /// (-) Standard deviation of the centres about the working pitch circle, as a fraction of the flank's contact part; normal.
        /// Along the face they lie anywhere alike.
        spread: f64,
        /// (mm) Median of the radii, which are those of circles.
        radius_mm: f64,
        /// (-) Standard deviation of the radii's natural logarithm, which is normal.
        radius_spread: f64,
        /// (mm) Depth along the flank's normal, of all.
        depth_mm: f64,
    },
}

/// A pit of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankPit {
    /// (-) Its centre, as a fraction of the flank's contact part from its root side.
    pub at: f64,
    /// (mm) The same as a length along the flank, from the root side's end of the contact part.
    pub along_mm: f64,
    /// (mm) Its centre along the face, from the face's middle.
    pub z_mm: f64,
    /// (mm) Its radius along the flank.
    pub radius_mm: f64,
    /// (mm) Its radius along the face.
    pub face_radius_mm: f64,
    /// (mm) Its depth along the flank's normal.
    pub depth_mm: f64,
}

/// (-) Depth of the pit of a severity, over the tooth's height.
const DEPTH: f64 = 0.02;
/// Pits per tooth, in the mean, above which no draw is meant.
const MOST_PITS: f64 = 1000.0;
/// Draws of a pit's place of which one must lie on the flank.
const MOST_DRAWS: usize = 100;

keys! {
    Pits = Self::Listed {
        at: Vec::new(),
        z_mm: Vec::new(),
        radius_mm: Vec::new(),
        face_radius_mm: None,
        depth_mm: Vec::new(),
    }, chosen with given_form;
    [Self::Listed] at "-" "the centre of each pit, a fraction of the flank's contact part from its root"
        .required_unless(LISTED).range(Range::from_to(0.0, 1.0));
    [Self::Listed] z_mm "mm"
        "the centre of each along the face, from the face's middle; one number per pit, as for all keys here"
        .required_unless(LISTED).rule("within half the face width and the radius");
    [Self::Listed] radius_mm "mm" "the radius of each along the flank"
        .required_unless(LISTED).range(Range::positive());
    [Self::Listed] face_radius_mm "mm" "the radius of each along the face, for ellipses"
        .otherwise("`radius_mm`: circles").range(Range::positive()).alternative("[0.8, 1.2]");
    [Self::Listed] depth_mm "mm" "the depth of each, along the flank's normal"
        .required_unless(LISTED).range(Range::not_negative()).rule("less than the tooth is thick");
    = {
        sub_table("random", "pits that are drawn for each tooth from the seed, instead of a list", Self::drawn_rows())
            .otherwise("none")
            .alternative(
                "{ density_per_cm2 = 8.0, spread = 0.1, radius_mm = 0.4, radius_spread = 0.4, depth_mm = 0.1 }",
            )
    };
}

impl Pits {
    /// Takes the form that is given.
    fn given_form(&mut self, table: &TomlTable<'_>) -> ReadResult<()> {
        let listed = ["at", "z_mm", "radius_mm", "face_radius_mm", "depth_mm"];
        let given = listed.into_iter().find(|key| table.optional(key).is_some());
        match (table.optional("random").is_some(), given) {
            (true, Some(key)) => Err(table
                .error("random", format!("given beside {key}; pits are listed or drawn"))
                .with_help("remove random, or the list; pits of both make two faults on one tooth")),
            (true, None) => {
                let [density_per_cm2, spread, radius_mm, radius_spread, depth_mm] = [f64::NAN; 5];
                *self = Self::Drawn { density_per_cm2, spread, radius_mm, radius_spread, depth_mm };
                Ok(())
            }
            (false, Some(_)) => Ok(()),
            (false, None) => Err(table
                .error("at", "missing, and random too; pits are listed or drawn")
                .with_help("give at, z_mm, radius_mm and depth_mm, a list each, or random = { density_per_cm2 = …, … }, or severity alone")),
        }
    }
}

impl Kind for Pits {
    const NAME: &str = "pits";
    const TITLE: &str = "pits";
    const MOVES_FORCES: bool = true;
    const HAS_AREA: bool = true;
    const PART: ToothPart = ToothPart::FlankSpots;
    const SIZES: &[&str] = &["at", "z_mm", "radius_mm", "face_radius_mm", "depth_mm", "random"];

    fn example() -> Self {
        Self::Listed {
            at: vec![0.35, 0.42, 0.5],
            z_mm: vec![-3.0, 1.0, 5.0],
            radius_mm: vec![0.6, 0.9, 0.5],
            face_radius_mm: None,
            depth_mm: vec![0.1, 0.15, 0.1],
        }
    }

    /// One pit in the middle of the flank, an ellipse of as many parts of the flank's length as of the face.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let part = LARGEST * severity.sqrt();
        let depth_mm = (DEPTH * tooth.height_mm).min(tooth.least_half_thickness_mm() / 2.0);
        tooth.shows(part).then(|| Self::Listed {
            at: vec![0.5],
            z_mm: vec![0.0],
            radius_mm: vec![part * tooth.contact_length_mm() / 2.0],
            face_radius_mm: Some(vec![part * tooth.face_width_mm / 2.0]),
            depth_mm: vec![depth_mm],
        })
    }

    /// Its pits' area over the largest one's, each counted whole; of drawn ones the mean.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        let flank_mm2 = tooth.contact_length_mm() * tooth.face_width_mm;
        let area_mm2 = match self {
            Self::Listed { radius_mm, face_radius_mm, .. } => {
                let along = face_radius_mm.as_ref().unwrap_or(radius_mm);
                radius_mm.iter().zip(along).map(|(radius, along)| PI * radius * along).sum::<f64>()
            }
            Self::Drawn { density_per_cm2, radius_mm, radius_spread, .. } => {
                let mean_mm2 = PI * radius_mm * radius_mm * (2.0 * radius_spread * radius_spread).exp();
                density_per_cm2 * 1e-2 * flank_mm2 * mean_mm2
            }
        };
        (area_mm2 / (flank_mm2 * PI / 4.0 * LARGEST * LARGEST)).clamp(0.0, 1.0)
    }

    fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        match self {
            Self::Listed { at, z_mm, radius_mm, face_radius_mm, depth_mm } => {
                if at.is_empty() {
                    return Err(ScenarioError::new("fault.at", "[]", "must have at least one pit"));
                }
                let face = face_radius_mm.as_ref().map(|radii| ("fault.face_radius_mm", radii));
                let others =
                    [("fault.z_mm", z_mm), ("fault.radius_mm", radius_mm), ("fault.depth_mm", depth_mm)];
                for (key, list) in others.into_iter().chain(face) {
                    if list.len() != at.len() {
                        let problem =
                            format!("has {} numbers; must have {}, as fault.at", list.len(), at.len());
                        return Err(ScenarioError::new(key, "", problem));
                    }
                }
                let half = gears.face_width_mm / 2.0;
                for (place, (z, radius)) in
                    z_mm.iter().zip(face_radius_mm.as_ref().unwrap_or(radius_mm)).enumerate()
                {
                    let problem = format!(
                        "must be less than {:?} mm from the face's middle, or the pit misses the face, {} mm wide",
                        half + radius,
                        gears.face_width_mm
                    );
                    require(&format!("fault.z_mm[{place}]"), *z, z.abs() < half + radius, problem)?;
                }
                Ok(())
            }
            Self::Drawn { .. } => Ok(()),
        }
    }

    fn is_drawn(&self) -> bool {
        matches!(self, Self::Drawn { .. })
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let face_width_mm = healthy.wheel().face_width_mm;
        let none = FlankPits::none(healthy);
        let draws = healthy.draws(Purpose::Pits, tooth.count_of::<Self>());
        let pits = self.on_flank(healthy, &none, draws)?;
        let own = FlankPits { pits: pits.clone(), ..none.clone() };
        let on_flank = tooth.pits.get_or_insert(none);
        on_flank.pits.extend(&pits);
        let left_mm = on_flank.least_left_mm();
        if left_mm <= LEAST_LEFT * face_width_mm {
            let problem = format!(
                "leave{} no more than {:.0} % of the face at some height of tooth {}'s flank: the mating gear would have no contact there",
                if on_flank.pits.len() > pits.len() { " together with other pits" } else { "" },
                100.0 * LEAST_LEFT,
                tooth.first_tooth() + 1,
            );
            return Err(ScenarioError::new("fault", "", problem).with_help(
                "make them smaller or fewer; for a pit over the whole face, use kind = \"through-face\"",
            ));
        }
        self.refuse_deep(&own)?;
        Ok(own.describe(healthy.profile()))
    }
}

/// Pieces of a pit's outline.
const OUTLINE: usize = 48;

impl FlankPits {
    /// The pits in words and pictures.
    fn describe(&self, profile: &ToothProfile) -> DamageDescription {
        let last = profile.len() - 1;
        let is_pitted =
            |along_mm: &f64| self.pits.iter().any(|pit| (along_mm - pit.along_mm).abs() < pit.radius_mm);
        let reached = [self.along_mm.iter().position(is_pitted), self.along_mm.iter().rposition(is_pitted)];
        let every =
            |of: fn(&FlankPit) -> f64| QuantityValue::Numbers(self.pits.iter().map(of).collect::<Vec<_>>());
        let area_percent = self.area_percent();
        let grade = pitting_grade(area_percent);
        let number = match self.pits.len() {
            1 => "1 pit".to_owned(),
            count => format!("{count} pits"),
        };
        let area = format!("{} % of the flank", tenths(area_percent));
        DamageDescription {
            quantities: vec![
                ("area_percent", QuantityValue::Number(area_percent)),
                ("grade", QuantityValue::Word(grade)),
                ("at", every(|pit| pit.at)),
                ("z_mm", every(|pit| pit.z_mm)),
                ("radius_mm", every(|pit| pit.radius_mm)),
                ("face_radius_mm", every(|pit| pit.face_radius_mm)),
                ("depth_mm", every(|pit| pit.depth_mm)),
            ],
            is_partial: true,
            face: self.pits.iter().map(|pit| self.patch(pit, profile)).collect(),
            sizes: vec![format!("{number}, {area} ({grade})")],
            caption: vec![format!("{number},"), area],
            ..DamageDescription::of::<Pits>(reached.map(|index| index.unwrap_or(last)))
        }
    }

    /// A pit's ellipse, within the face and the flank.
    fn patch(&self, pit: &FlankPit, profile: &ToothProfile) -> FacePatch {
        let half_mm = self.face_width_mm / 2.0;
        let x_mm = |along_mm: f64| {
            let index = self.along_mm.partition_point(|&other| other < along_mm);
            profile.x_mm[index.min(profile.len() - 1)]
        };
        let point = |k: usize| {
            let (sin, cos) = (2.0 * PI * k as f64 / OUTLINE as f64).sin_cos();
            let z_mm = pit.z_mm + pit.face_radius_mm * cos;
            [z_mm.clamp(-half_mm, half_mm), x_mm(pit.along_mm + pit.radius_mm * sin)]
        };
        let outline_mm: Vec<[f64; 2]> = (0..=OUTLINE).map(point).collect();
        FacePatch { edge_mm: outline_mm.clone(), outline_mm }
    }
}

/// Part of the face that must be left at any height.
const LEAST_LEFT: f64 = 0.02;

/// What may be given in place of a list.
const LISTED: &[&str] = &["random", "severity"];

impl Pits {
    fn drawn_rows() -> Vec<KeyRow<Self>> {
        rows! {
            [Self::Drawn] density_per_cm2 "1/cm²" "the mean number of pits in a square centimetre of flank; Poisson"
                .required().range(Range::not_negative()).rule("at most 1000 a tooth");
            [Self::Drawn] spread "-"
                "the standard deviation of their centres about the working pitch circle, a fraction of the contact part; normal"
                .required().range(Range::from_to(0.0, 1.0));
            [Self::Drawn] radius_mm "mm" "the median of their radii; lognormal" .required().range(Range::positive());
            [Self::Drawn] radius_spread "-" "the standard deviation of the radii's natural logarithm"
                .required().range(Range::from_to(0.0, 2.0));
            [Self::Drawn] depth_mm "mm" "the depth of all, along the flank's normal" .required().range(Range::not_negative());
        }
    }

    /// The pits of a tooth, listed or drawn.
    ///
    /// # Errors
    /// More pits than can be meant.
    fn on_flank(
        &self,
        healthy: &HealthyTooth,
        flank: &FlankPits,
        mut draws: Draws,
    ) -> Result<Vec<FlankPit>, ScenarioError> {
        let along_mm = |at: f64| flank.along_mm[flank_index(at, healthy.profile(), healthy.first_contact())];
        let (density_per_cm2, spread, radius_mm, radius_spread, depth_mm) = match self {
            Self::Listed { at, z_mm, radius_mm, face_radius_mm, depth_mm } => {
                let face_radius_mm = face_radius_mm.as_ref().unwrap_or(radius_mm);
                let pit = |n: usize| FlankPit {
                    at: at[n],
                    along_mm: along_mm(at[n]),
                    z_mm: z_mm[n],
                    radius_mm: radius_mm[n],
                    face_radius_mm: face_radius_mm[n],
                    depth_mm: depth_mm[n],
                };
                return Ok((0..at.len()).map(pit).collect());
            }
            Self::Drawn { density_per_cm2, spread, radius_mm, radius_spread, depth_mm } => {
                (*density_per_cm2, *spread, *radius_mm, *radius_spread, *depth_mm)
            }
        };
        let area_cm2 = flank.length_mm() * flank.face_width_mm * 1e-2;
        let mean = density_per_cm2 * area_cm2;
        if mean > MOST_PITS {
            let most = MOST_PITS / area_cm2;
            let problem = format!("must be at most {most:.1} 1/cm² on this flank of {area_cm2:.2} cm²");
            return Err(ScenarioError::new("fault.random.density_per_cm2", density_per_cm2, problem));
        }
        let pitch_circle = healthy.fraction_at_radius(healthy.wheel().working_pitch_radius_mm);
        let pit = |draws: &mut Draws| {
            let on_flank = |at: &f64| (0.0..=1.0).contains(at);
            let mut places = (0..MOST_DRAWS).map(|_| pitch_circle + spread * draws.normal());
            let at = places.find(on_flank).unwrap_or(pitch_circle);
            let z_mm = draws.uniform(0.0, flank.face_width_mm / 2.0);
            let radius_mm = radius_mm * (radius_spread * draws.normal()).exp();
            FlankPit { at, along_mm: along_mm(at), z_mm, radius_mm, face_radius_mm: radius_mm, depth_mm }
        };
        let count = poisson(mean, &mut draws);
        Ok((0..count).map(|_| pit(&mut draws)).collect())
    }

    /// Refuses pits that are as deep as the tooth is thick.
    fn refuse_deep(&self, own: &FlankPits) -> Result<(), ScenarioError> {
        let y_mm = &own.y_mm;
        for (number, pit) in own.pits.iter().enumerate() {
            let cuts = |i: &usize| pit.chord_mm(own.along_mm[*i]).is_some();
            for i in (0..y_mm.len()).filter(cuts) {
                if pit.depth_mm / own.normal_cos[i] >= 2.0 * y_mm[i] {
                    let key = match self {
                        Self::Listed { .. } => format!("fault.depth_mm[{number}]"),
                        Self::Drawn { .. } => "fault.random.depth_mm".to_owned(),
                    };
                    let problem = format!(
                        "must be less deep than the tooth, which is {:.3} mm thick there",
                        2.0 * y_mm[i]
                    );
                    return Err(ScenarioError::new(key, format!("{:?}", pit.depth_mm), problem));
                }
            }
        }
        Ok(())
    }
}

/// A number of events that come at random with a mean of `mean`: as many exponential gaps as fit.
///
/// Source: D. E. Knuth, *The Art of Computer Programming*, volume 2, 3rd edition (1997), 3.4.1.
fn poisson(mean: f64, draws: &mut Draws) -> usize {
    let mut time = 0.0;
    let mut events = 0;
    loop {
        time -= (1.0 - draws.uniform(0.5, 0.5)).ln();
        if time > mean {
            return events;
        }
        events += 1;
    }
}

/// The grade of pitting by the area of the pits, (%) of the flank's contact part: slight below 3 %, severe above 10 %.
fn pitting_grade(area_percent: f64) -> &'static str {
    match area_percent {
        area if area > 10.0 => "severe",
        area if area >= 3.0 => "moderate",
        _ => "slight",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_is_graded() {
        let grades = [2.9, 3.0, 10.0, 10.1].map(pitting_grade);
        assert_eq!(grades, ["slight", "moderate", "moderate", "severe"]);
    }

    #[test]
    fn counts_have_the_mean_and_the_variance_of_poisson() {
        for mean in [0.0, 0.7, 12.0, 300.0] {
            let counts: Vec<f64> = (0..4000)
                .map(|index| poisson(mean, &mut Draws::new(7, Purpose::Pits, index)) as f64)
                .collect();
            let of = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
            let average = of(&counts);
            let variance = of(&counts.iter().map(|count| (count - average).powi(2)).collect::<Vec<_>>());
            assert!((average - mean).abs() <= 4.0 * (mean / 4000.0).sqrt(), "{average} for {mean}");
            assert!((variance - mean).abs() <= 0.12 * mean, "{variance} for {mean}");
        }
    }
}
