//! A tooth with all its damage.

use std::ops::RangeInclusive;

use super::{Crack, DamageDescription, Fault, FlankPits};
use crate::error::ScenarioError;
use crate::random::{Draws, Purpose};
use crate::wheel::{Flank, PathOfContact, Teeth, ToothProfile, Wheel, WheelName};

/// What is left of one tooth, or of each of several that are alike.
///
/// Vectors run over the points of the tooth's profile. Widths are missing from one end of the face, the same for all
/// damages and for both wheels.
#[derive(Debug, Clone, PartialEq)]
pub struct DamagedTooth {
    /// Whose tooth it is.
    pub wheel: WheelName,
    /// Indices of the teeth, from 0, rising: at least one.
    pub teeth: Vec<usize>,
    /// (mm) The working flank, where it is cut over the whole width.
    pub flank_y_mm: Vec<f64>,
    /// (mm) Width that is gone, through the whole thickness.
    pub missing_width_mm: Vec<f64>,
    /// (mm) Width over which the flank is cut further back, to `corner_y_mm`.
    pub corner_width_mm: Vec<f64>,
    /// (mm) The working flank over `corner_width_mm`.
    pub corner_y_mm: Vec<f64>,
    /// First index from which on nothing of the tooth is left; the number of points where nothing is lost.
    pub gone_from_index: usize,
    /// (mm) How far the flank lies back along the line of action when it is touched there; 0 or less.
    pub deviation_mm: Vec<f64>,
    /// Where the mate does not touch the flank but turns about two edges.
    pub rolling: Vec<RollingPit>,
    /// A crack in its root.
    pub crack: Option<Crack>,
    /// Pits that take a part of the face.
    pub pits: Option<FlankPits>,
    /// What the damages are.
    pub descriptions: Vec<DamageDescription>,
}

/// A pit over the whole width: the mate turns about its edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingPit {
    /// First profile index inside the pit: the edge about which the mate turns up to `mid_index`.
    pub start_index: usize,
    /// Last index of the first half.
    pub mid_index: usize,
    /// Last profile index inside the pit: the edge about which the mate turns after `mid_index`.
    pub end_index: usize,
    /// (mm) Largest displacement: how far the two flanks bulge over the chords between their edges.
    pub deviation_mm: f64,
}

/// The healthy tooth that a damage is done to.
pub(crate) struct HealthyTooth<'a> {
    teeth: &'a Teeth,
    name: WheelName,
    tooth: usize,
    seed: u64,
}

impl<'a> HealthyTooth<'a> {
    /// Whose tooth it is.
    pub(super) fn name(&self) -> WheelName {
        self.name
    }

    /// Both healthy teeth.
    pub(super) fn teeth(&self) -> &'a Teeth {
        self.teeth
    }

    /// The path along which it touches its mate.
    pub(super) fn path(&self) -> &'a PathOfContact {
        &self.teeth.path
    }

    pub(super) fn wheel(&self) -> &'a Wheel {
        self.teeth.wheel(self.name)
    }

    pub(super) fn profile(&self) -> &'a ToothProfile {
        self.teeth.profile(self.name)
    }

    pub(super) fn flank(&self) -> Flank<'a> {
        self.teeth.flank(self.name)
    }

    /// Profile index where contact starts at the root side.
    pub(super) fn first_contact(&self) -> usize {
        self.teeth.initial_contact_index(self.name)
    }

    /// (rev) Position of a profile point in contact: pinion revolutions since the tooth entered contact.
    pub(super) fn position_rev(&self, index: usize) -> f64 {
        let position = self.teeth.path.position(self.name, self.flank().curvature_mm(index));
        position.clamp(0.0, self.teeth.path.contact_ratio) / f64::from(self.teeth.pinion.teeth)
    }

    /// The mate's flank, and the index of its point nearest to the one that meets a point of this tooth.
    pub(super) fn met_by(&self, index: usize) -> (Flank<'a>, usize) {
        let mate = self.teeth.flank(self.name.mate());
        let curvature = self.teeth.path.line_mm - self.flank().curvature_mm(index);
        (mate, mate.at_curvature(curvature).nearest())
    }

    /// Draws for the roughness of this tooth.
    ///
    /// # Arguments
    /// * `earlier` - number of rough damages that the tooth has already
    pub(super) fn roughness(&self, earlier: usize) -> Draws {
        self.draws(Purpose::DestructionNoise, earlier)
    }

    /// Draws for pits of this tooth.
    ///
    /// # Arguments
    /// * `earlier` - number of pitting damages that the tooth has already
    pub(super) fn pit_draws(&self, earlier: usize) -> Draws {
        self.draws(Purpose::Pits, earlier)
    }

    fn draws(&self, purpose: Purpose, earlier: usize) -> Draws {
        // The pinion's teeth count from 2³² on.
        let first = if self.name == WheelName::Pinion { 1 << 32 } else { 0 };
        Draws::new(self.seed, purpose, first + self.tooth as u64 + ((earlier as u64) << 33))
    }

    /// (-) Fraction of the flank's contact part, from its root side, at a distance from the wheel's centre.
    ///
    /// # Arguments
    /// * `radius_mm` - (mm) the distance
    pub(super) fn fraction_at_radius(&self, radius_mm: f64) -> f64 {
        let (first, last) = (self.first_contact(), self.profile().len() - 1);
        let index = self.profile().nearest_to_radius(radius_mm).max(first);
        (index - first) as f64 / (last - first).max(1) as f64
    }
}

impl DamagedTooth {
    /// Teeth of which nothing is missing.
    pub(super) fn sound(name: WheelName, teeth: Vec<usize>, profile: &ToothProfile) -> Self {
        let points = profile.len();
        Self {
            wheel: name,
            teeth,
            flank_y_mm: profile.y_mm.clone(),
            missing_width_mm: vec![0.0; points],
            corner_width_mm: vec![0.0; points],
            corner_y_mm: profile.y_mm.clone(),
            gone_from_index: points,
            deviation_mm: vec![0.0; points],
            rolling: Vec::new(),
            crack: None,
            pits: None,
            descriptions: Vec::new(),
        }
    }

    /// (mm) Height of the flank where another cut would leave less: what has worn deeper stays.
    ///
    /// # Arguments
    /// * `index` - profile index
    /// * `cut_y_mm` - (mm) what the cut leaves of a sound flank
    /// * `profile` - the sound flank
    pub(super) fn cut_y_mm(&self, index: usize, cut_y_mm: f64, profile: &ToothProfile) -> f64 {
        let worn_y_mm = self.flank_y_mm[index];
        if worn_y_mm < profile.y_mm[index] { worn_y_mm.min(cut_y_mm) } else { cut_y_mm }
    }

    /// Index of the tooth, of several of the first.
    pub fn first_tooth(&self) -> usize {
        self.teeth.first().copied().unwrap_or(0)
    }

    /// (mm) The working flank where it is cut furthest back.
    pub fn outline_y_mm(&self) -> Vec<f64> {
        let lost_mm = |index: usize| self.pits.as_ref().map_or(0.0, |pits| pits.lost_mm(index));
        let cut = self.flank_y_mm.iter().zip(&self.corner_y_mm).map(|(flank, corner)| flank.min(*corner));
        match &self.pits {
            None => cut.collect(),
            Some(pits) => {
                cut.zip(&pits.y_mm).enumerate().map(|(i, (cut, y))| cut.min(y - lost_mm(i))).collect()
            }
        }
    }

    /// Whether nothing of the tooth is left.
    pub fn is_missing(&self) -> bool {
        self.gone_from_index == 0
    }

    /// The rolling pit that a profile index lies in.
    pub(crate) fn rolling_at(&self, index: usize) -> Option<&RollingPit> {
        self.rolling.iter().find(|pit| (pit.start_index..=pit.end_index).contains(&index))
    }

    /// Profile indices at which the flank is cut by one of the damages.
    fn cut_range(description: &DamageDescription) -> Option<RangeInclusive<usize>> {
        match description {
            DamageDescription::FaceFault { pit, .. } => Some(pit.start_index..=pit.end_index),
            DamageDescription::ToothDestruction { start_index, end_index, .. } => {
                Some(*start_index..=*end_index)
            }
            DamageDescription::MissingTooth
            | DamageDescription::ToothBreakage { .. }
            | DamageDescription::RootCrack { .. }
            | DamageDescription::Pits { .. }
            | DamageDescription::Wear { .. } => None,
        }
    }

    /// Refuses a cut where there is one already, and a pit without an edge that the mate can turn about: what becomes of such a
    /// flank is not known.
    ///
    /// # Arguments
    /// * `faults` - numbers and kinds of the damages, in the order of the descriptions; the last is the one that is refused
    fn refuse_overlap(&self, faults: &[(usize, &'static str)]) -> Result<(), ScenarioError> {
        let place = format!("the {}'s tooth {}", self.wheel.name(), self.first_tooth() + 1);
        if self.rolling.iter().any(|pit| pit.end_index >= self.gone_from_index) {
            let problem = format!(
                "leaves a pit without its edge at the tip on {place}{}; a pit over the whole face must end below what has broken off",
                beside(faults.split_last().map_or(&[], |(_, earlier)| earlier))
            );
            return Err(ScenarioError::new("fault", "", problem)
                .with_help("move the pit towards the root, or lessen the breakage's tip_loss_mm"));
        }
        let Some((last, earlier)) = self.descriptions.split_last() else { return Ok(()) };
        let Some(range) = Self::cut_range(last) else { return Ok(()) };
        let overlaps =
            |other: RangeInclusive<usize>| range.start() <= other.end() && other.start() <= range.end();
        match earlier.iter().position(|earlier| Self::cut_range(earlier).is_some_and(overlaps)) {
            None => Ok(()),
            Some(other) => {
                let problem = format!(
                    "cuts the flank of {place} where {} has cut it; must leave a piece of sound flank between them",
                    faults.get(other).map_or_else(|| "another fault".to_owned(), named)
                );
                Err(ScenarioError::new("fault", "", problem)
                    .with_help("move one of them along the flank, or to another tooth"))
            }
        }
    }
}

/// A fault by its number and kind.
fn named((number, kind): &(usize, &'static str)) -> String {
    format!("fault[{number}] ({kind})")
}

/// ` beside fault[0] (tooth-breakage)`; nothing where there is no other.
fn beside(others: &[(usize, &'static str)]) -> String {
    let names: Vec<String> = others.iter().map(named).collect();
    if names.is_empty() { String::new() } else { format!(" beside {}", names.join(" and ")) }
}

/// Teeth of a wheel with the same faults.
struct Alike {
    wheel: WheelName,
    /// Indices of the teeth, from 0.
    teeth: Vec<usize>,
    /// Numbers of the faults.
    faults: Vec<usize>,
    /// The teeth have draws of their own, and are one.
    is_drawn: bool,
}

/// The damaged teeth, those with the same faults together unless each has draws of its own; in the order in which they are
/// first named.
fn alike(faults: &[Fault], teeth: &Teeth) -> Vec<Alike> {
    let mut all: Vec<Alike> = Vec::new();
    let mut seen: [Vec<bool>; 2] =
        WheelName::BOTH.map(|wheel| vec![false; teeth.wheel(wheel).teeth as usize]);
    for fault in faults {
        for tooth in fault.tooth.numbers(teeth.wheel(fault.wheel).teeth) {
            let index = tooth.saturating_sub(1) as usize;
            // What the wheel has not is refused where the pairs are counted.
            let seen = seen[fault.wheel as usize].get_mut(index);
            if seen.is_some_and(|seen| std::mem::replace(seen, true)) {
                continue;
            }
            let on_tooth =
                |(_, other): &(usize, &Fault)| other.wheel == fault.wheel && other.tooth.contains(tooth);
            let on_tooth: Vec<usize> =
                faults.iter().enumerate().filter(on_tooth).map(|(number, _)| number).collect();
            let is_drawn = on_tooth.iter().any(|&number| faults[number].damage.is_drawn());
            let like = |other: &&mut Alike| {
                !is_drawn && !other.is_drawn && other.wheel == fault.wheel && other.faults == on_tooth
            };
            match all.iter_mut().find(like) {
                Some(group) => group.teeth.push(index),
                None => {
                    all.push(Alike { wheel: fault.wheel, teeth: vec![index], faults: on_tooth, is_drawn })
                }
            }
        }
    }
    all.iter_mut().for_each(|group| group.teeth.sort_unstable());
    all
}

/// The teeth that are damaged, each with all its damages, those that are alike together; in the order in which they are first
/// named.
///
/// # Arguments
/// * `faults` - what is broken, checked by [`crate::scenario::Scenario::validate`]
/// * `teeth` - the healthy teeth
/// * `seed` - seed of what is drawn for each tooth
///
/// # Errors
/// A fault that does not fit its tooth: a pit that misses the flank or is deeper than the tooth, a chip larger than the
/// tooth, a line that leaves no tooth; faults that cut the same piece of a flank.
pub fn damaged_teeth(faults: &[Fault], teeth: &Teeth, seed: u64) -> Result<Vec<DamagedTooth>, ScenarioError> {
    let sized = |(number, fault): (usize, &Fault)| {
        Some((number, Fault { damage: fault.sized(teeth)?, ..fault.clone() }))
    };
    let (numbers, shown): (Vec<usize>, Vec<Fault>) = faults.iter().enumerate().filter_map(sized).unzip();
    let groups = alike(&shown, teeth);
    let sound =
        |group: &Alike| DamagedTooth::sound(group.wheel, group.teeth.clone(), teeth.profile(group.wheel));
    let mut damaged: Vec<DamagedTooth> = groups.iter().map(sound).collect();
    for (place, fault) in shown.iter().enumerate() {
        for (group, tooth) in
            groups.iter().zip(&mut damaged).filter(|(group, _)| group.faults.contains(&place))
        {
            let healthy = HealthyTooth { teeth, name: group.wheel, tooth: tooth.first_tooth(), seed };
            let so_far = group.faults.iter().filter(|&&other| other <= place);
            let so_far: Vec<_> = so_far.map(|&other| (numbers[other], shown[other].damage.kind())).collect();
            fault
                .damage
                .damage(tooth, &healthy)
                .and_then(|()| tooth.refuse_overlap(&so_far))
                .map_err(|error| error.in_entry("fault", numbers[place], faults.len()))?;
        }
    }
    Ok(damaged)
}
