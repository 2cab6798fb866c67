//! A tooth with all its damage.

use std::collections::BTreeMap;

use super::fault::faults_on_teeth;
use super::kind::Kind;
use super::{Crack, DamageDescription, Fault, FlankPits, ToothPart};
use crate::error::ScenarioError;
use crate::random::{Draws, Purpose};
use crate::wheel::{Flank, Teeth, ToothProfile, Wheel, WheelName};

/// What is left of one tooth, or of each of several that are alike.
///
/// Vectors run over the points of the tooth's profile. Widths are missing from one end of the face, the same for all
/// damages and for both wheels.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
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
    /// Last profile indices of pits over the whole face width, at which each has its edge towards the tip.
    pub upper_edges: Vec<usize>,
    /// A crack in its root.
    pub crack: Option<Crack>,
    /// Pits that take a part of the face.
    pub pits: Option<FlankPits>,
    /// What the damages are.
    pub descriptions: Vec<DamageDescription>,
}

/// The healthy tooth that a damage is done to.
pub(crate) struct HealthyTooth<'a> {
    /// Both healthy teeth.
    pub(super) teeth: &'a Teeth,
    /// Whose tooth it is.
    pub(super) name: WheelName,
    tooth: usize,
    seed: u64,
}

impl<'a> HealthyTooth<'a> {
    /// The gear's first tooth.
    pub(crate) fn first_of_gear(teeth: &'a Teeth, seed: u64) -> Self {
        Self { teeth, name: WheelName::Gear, tooth: 0, seed }
    }

    /// The wheel, of helical ones that of the normal section.
    pub(super) fn wheel(&self) -> &'a Wheel {
        self.teeth.section(self.name)
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
        self.position(index).clamp(0.0, self.teeth.path.contact_ratio) / f64::from(self.teeth.pinion.teeth)
    }

    /// (base pitches) Position of the path at which a profile point is touched, at the middle of the face.
    pub(super) fn position(&self, index: usize) -> f64 {
        let curvature_mm = self.teeth.transverse_curvature_mm(self.name, self.flank().curvature_mm(index));
        self.teeth.path.position(self.name, curvature_mm)
    }

    /// Random draws for a damage of this tooth.
    ///
    /// # Arguments
    /// * `purpose` - what is drawn
    /// * `earlier` - number of damages of the same kind that the tooth has already
    pub(super) fn draws(&self, purpose: Purpose, earlier: usize) -> Draws {
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
    ///
    /// # Arguments
    /// * `name` - whose teeth they are
    /// * `teeth` - their indices, from 0, rising
    /// * `profile` - of the healthy tooth
    pub fn sound(name: WheelName, teeth: Vec<usize>, profile: &ToothProfile) -> Self {
        let points = profile.len();
        Self {
            wheel: name,
            teeth,
            flank_y_mm: profile.y_mm.clone(),
            missing_width_mm: vec![0.0; points],
            corner_width_mm: vec![0.0; points],
            corner_y_mm: profile.y_mm.clone(),
            gone_from_index: points,
            upper_edges: Vec::new(),
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

    /// How many damages of a kind the tooth has.
    pub(super) fn count_of<K: Kind>(&self) -> usize {
        self.descriptions.iter().filter(|damage| damage.kind == K::NAME).count()
    }

    /// Refuses a cut where there is one already, and a pit without its edge towards the tip: what becomes of such a
    /// flank is not known.
    fn refuse_overlap(&self) -> Result<(), ScenarioError> {
        let place = format!("tooth {}", self.first_tooth() + 1);
        if self.upper_edges.iter().any(|&index| index >= self.gone_from_index) {
            let problem = format!(
                "leaves a pit without its edge at the tip on {place}{}; a pit over the whole face must end below what has broken off",
                beside(self.descriptions.split_last().map_or(&[], |(_, earlier)| earlier))
            );
            return Err(ScenarioError::new("fault", "", problem)
                .with_help("move the pit towards the root, or reduce the breakage's tip_loss_mm"));
        }
        let is_cut = |damage: &&DamageDescription| damage.part == ToothPart::FlankLength;
        let Some((last, earlier)) = self.descriptions.split_last() else { return Ok(()) };
        let overlaps =
            |other: &&DamageDescription| last.range[0] <= other.range[1] && other.range[0] <= last.range[1];
        let cuts = || earlier.iter().filter(is_cut);
        match Some(last).filter(is_cut).and_then(|_| cuts().find(overlaps)) {
            None => Ok(()),
            Some(other) => {
                let problem = format!(
                    "cuts the flank of {place} where {} has cut it; must leave a piece of undamaged flank between them",
                    named(other)
                );
                Err(ScenarioError::new("fault", "", problem)
                    .with_help("move one of them along the flank, or to another tooth"))
            }
        }
    }
}

/// A fault by its number and kind.
fn named(damage: &DamageDescription) -> String {
    format!("fault[{}] ({})", damage.fault, damage.kind)
}

/// ` beside fault[0] (tooth-breakage)`; nothing where there is no other.
fn beside(others: &[DamageDescription]) -> String {
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
}

/// The damaged teeth, those with the same faults together unless each has draws of its own; in the order in which they are
/// first named.
fn alike(faults: &[Fault], teeth: &Teeth) -> Vec<Alike> {
    let on_teeth = faults_on_teeth(faults, |wheel| teeth.wheel(wheel).teeth);
    // In the order in which the teeth are named.
    let mut named: Vec<_> = on_teeth.into_iter().collect();
    named.sort_by_cached_key(|((wheel, tooth), on_tooth)| {
        let first = on_tooth[0];
        let of_first = faults[first].tooth.numbers(teeth.wheel(faults[first].side()).teeth);
        (first, of_first.iter().position(|number| number == tooth), *wheel)
    });
    let mut all: Vec<Alike> = Vec::new();
    let mut groups: BTreeMap<(usize, Vec<usize>), usize> = BTreeMap::new();
    for ((wheel, tooth), on_tooth) in named {
        let index = tooth.saturating_sub(1) as usize;
        let is_drawn = on_tooth.iter().any(|&number| faults[number].damage.is_drawn());
        let group = groups.get(&(wheel, on_tooth.clone())).filter(|_| !is_drawn);
        match group {
            Some(&group) => all[group].teeth.push(index),
            None => {
                groups.insert((wheel, on_tooth.clone()), all.len());
                let wheel = faults[on_tooth[0]].side();
                all.push(Alike { wheel, teeth: vec![index], faults: on_tooth });
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
    let numbers: Vec<usize> = (0..faults.len()).collect();
    damaged_teeth_of_file(faults, &numbers, faults.len(), teeth, seed)
}

/// Does what [`damaged_teeth`] does, of some of a file's faults.
///
/// # Arguments
/// * `faults` - those of the pair
/// * `numbers` - of each in the file
/// * `entries` - how many faults the file has
/// * `teeth` - the healthy teeth
/// * `seed` - seed of what is drawn for each tooth
///
/// # Errors
/// Those of [`damaged_teeth`].
pub(crate) fn damaged_teeth_of_file(
    faults: &[Fault],
    numbers: &[usize],
    entries: usize,
    teeth: &Teeth,
    seed: u64,
) -> Result<Vec<DamagedTooth>, ScenarioError> {
    let sized = |(&number, fault): (&usize, &Fault)| {
        Some((number, Fault { damage: fault.sized(teeth)?, ..fault.clone() }))
    };
    let (numbers, shown): (Vec<usize>, Vec<Fault>) = numbers.iter().zip(faults).filter_map(sized).unzip();
    let groups = alike(&shown, teeth);
    let sound =
        |group: &Alike| DamagedTooth::sound(group.wheel, group.teeth.clone(), teeth.profile(group.wheel));
    let mut damaged: Vec<DamagedTooth> = groups.iter().map(sound).collect();
    let mut groups_of: Vec<Vec<usize>> = vec![Vec::new(); shown.len()];
    for (number, group) in groups.iter().enumerate() {
        group.faults.iter().for_each(|&fault| groups_of[fault].push(number));
    }
    for (place, fault) in shown.iter().enumerate() {
        for &group in &groups_of[place] {
            let (tooth, wheel) = (&mut damaged[group], groups[group].wheel);
            let healthy = HealthyTooth { teeth, name: wheel, tooth: tooth.first_tooth(), seed };
            let number = numbers[place];
            let done = fault.damage.damage(tooth, &healthy).and_then(|description| {
                tooth.descriptions.push(DamageDescription { fault: number, ..description });
                tooth.refuse_overlap()
            });
            done.map_err(|error| error.in_entry("fault", number, entries))?;
        }
    }
    Ok(damaged)
}
