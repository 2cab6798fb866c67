//! The turns of the damaged teeth within a revolution of their wheel.

use std::collections::BTreeMap;

use meshtone::damage::{Fault, ToothPart};
use meshtone::wheel::{Gears, WheelName};
use meshtone::{MeshedPair, Stages};

use crate::drawing::{Axes, Canvas, Fill, colour};

/// The parts of a revolution in which damaged teeth are in contact.
pub(crate) const TINT: Fill = Fill::tint(colour::VERMILLION, 0.22);
/// Teeth of a wheel that a legend names one by one; of more it says how many they are.
const MOST_NAMED: usize = 3;

/// A damaged tooth of a wheel whose revolution begins where its tooth 1 enters contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DamagedTooth {
    /// Its number, from 1, in the order in which the wheel's teeth enter contact.
    pub tooth: u32,
    /// (pitches) From where to where the wheel turns while the tooth is in contact, since the middle of its face could enter contact: as
    /// [`Gears::contact_span_pitches`].
    pub contact_pitches: [f64; 2],
    /// Whether the whole tooth is gone.
    pub is_missing: bool,
}

impl DamagedTooth {
    /// The damaged teeth of a wheel, each once and in the order of their numbers.
    ///
    /// # Arguments
    /// * `faults` - what is broken, of both wheels; one of severity 0 is not
    /// * `wheel` - whose teeth
    /// * `gears` - the pair of wheels
    ///
    /// ```
    /// use meshtone::damage::{Fault, MissingTooth};
    /// use meshtone::wheel::{Gears, WheelName};
    /// use meshtone_plot::DamagedTooth;
    ///
    /// let gears = Gears::new(3.0, 17, 38, 15.0);
    /// let faults = [Fault::new(WheelName::Pinion, 3, MissingTooth), Fault::on_first_gear_tooth(MissingTooth)];
    /// let [tooth] = DamagedTooth::of_wheel(&faults, WheelName::Pinion, &gears)[..] else { panic!() };
    /// assert_eq!((tooth.tooth, tooth.is_missing), (3, true));
    /// ```
    pub fn of_wheel(faults: &[Fault], wheel: WheelName, gears: &Gears) -> Vec<Self> {
        let (teeth, contact_pitches) = (gears.teeth(wheel), gears.contact_span_pitches());
        let is_damage = |fault: &&Fault| fault.side() == wheel && fault.severity != Some(0.0);
        let faults: Vec<&Fault> = faults.iter().filter(is_damage).collect();
        let mut on_teeth: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (number, fault) in faults.iter().enumerate() {
            fault
                .tooth
                .numbers(teeth)
                .into_iter()
                .for_each(|tooth| on_teeth.entry(tooth).or_default().push(number));
        }
        let of_tooth = |(tooth, numbers): (u32, Vec<usize>)| {
            let is_missing = numbers.iter().any(|&number| faults[number].damage.part() == ToothPart::Whole);
            (Self { tooth, contact_pitches, is_missing }, numbers)
        };
        standing_out(on_teeth.into_iter().map(of_tooth).collect(), teeth)
    }

    /// The teeth of a wheel of the first mesh that a simulation has damaged, each once and in the order of their numbers.
    ///
    /// # Arguments
    /// * `stages` - what was simulated
    /// * `wheel` - whose teeth
    pub fn of_stages(stages: &Stages, wheel: WheelName) -> Vec<Self> {
        Self::of_pair(&stages.pairs[0], wheel)
    }

    /// The damaged teeth of one of two wheels in mesh.
    pub(crate) fn of_pair(MeshedPair { teeth, damaged, .. }: &MeshedPair, wheel: WheelName) -> Vec<Self> {
        let contact_pitches = teeth.contact_span_pitches();
        let of_wheel = damaged.iter().filter(|alike| alike.wheel == wheel).enumerate();
        let mut damaged: Vec<(Self, usize)> = of_wheel
            .flat_map(|(group, alike)| {
                let is_missing = alike.is_missing();
                let tooth = move |index: usize| Self { tooth: index as u32 + 1, contact_pitches, is_missing };
                alike.teeth.iter().map(move |&index| (tooth(index), group))
            })
            .collect();
        damaged.sort_by_key(|(tooth, _)| tooth.tooth);
        standing_out(damaged, teeth.wheel(wheel).teeth)
    }
}

/// The damaged teeth that stand out of the others: all of them, unless most of the wheel's teeth are damaged alike, as by wear, and some have
/// more.
///
/// # Arguments
/// * `damaged` - teeth in the order of their numbers, each with what those that are damaged alike have in common
/// * `teeth` - how many teeth the wheel has
fn standing_out<K: Ord>(damaged: Vec<(DamagedTooth, K)>, teeth: u32) -> Vec<DamagedTooth> {
    let mut counts: BTreeMap<&K, usize> = BTreeMap::new();
    damaged.iter().for_each(|(_, alike)| *counts.entry(alike).or_default() += 1);
    let most = counts.into_iter().max_by_key(|(_, count)| *count);
    let is_background = |alike: &K| match most {
        Some((common, count)) => 2 * count > teeth as usize && count < damaged.len() && alike == common,
        None => false,
    };
    damaged.iter().filter(|(_, alike)| !is_background(alike)).map(|(tooth, _)| *tooth).collect()
}

/// The damaged teeth whose turns are marked: all of them, but none where the wheel has no others.
///
/// # Arguments
/// * `damaged` - the wheel's damaged teeth
/// * `teeth` - how many teeth it has
pub(crate) fn marked(damaged: &[DamagedTooth], teeth: u32) -> &[DamagedTooth] {
    if damaged.len() < teeth as usize { damaged } else { &[] }
}

/// Tints the parts of a wheel's revolution in which its damaged teeth are in contact, or would be.
///
/// # Arguments
/// * `canvas`, `axes` - where
/// * `damaged` - the wheel's damaged teeth
/// * `teeth` - how many teeth it has
/// * `pitch` - one pitch in the unit of the horizontal axis
pub(crate) fn tint(canvas: &mut Canvas, axes: &Axes, damaged: &[DamagedTooth], teeth: u32, pitch: f64) {
    let contact = damaged.first().map_or([0.0; 2], |tooth| tooth.contact_pitches);
    let is_of_pair = |pair| is_of_pair(damaged, i64::from(teeth.max(1)), pair);
    for turn in turns([0.0, f64::from(teeth)], contact, is_of_pair) {
        let [from, to] = turn.map(|pitches| pitches * pitch);
        axes.band(canvas, from, to, TINT);
    }
}

/// Whether a damaged tooth of a wheel with so many teeth is of the pair that enters contact at a pitch.
pub(crate) fn is_of_pair(damaged: &[DamagedTooth], teeth: i64, pair: i64) -> bool {
    damaged.iter().any(|damaged| i64::from(damaged.tooth) == pair.rem_euclid(teeth) + 1)
}

/// (pitches) The parts of a window in which damaged pairs are in contact; those that overlap are one.
///
/// # Arguments
/// * `window` - (pitches) from and to
/// * `contact` - (pitches) from where to where a pair is in contact
/// * `is_damaged` - whether the pair that enters contact at a pitch is damaged
pub(crate) fn turns(
    [from, to]: [f64; 2],
    contact: [f64; 2],
    is_damaged: impl Fn(i64) -> bool,
) -> Vec<[f64; 2]> {
    let mut turns: Vec<[f64; 2]> = Vec::new();
    let pairs = (from - contact[1]).floor() as i64..(to - contact[0]).ceil() as i64;
    for pair in pairs.filter(|&pair| is_damaged(pair)) {
        let [start, end] = contact.map(|pitches| (pair as f64 + pitches).clamp(from, to));
        match turns.last_mut() {
            _ if start >= end => {}
            Some(last) if last[1] >= start => last[1] = end,
            _ => turns.push([start, end]),
        }
    }
    turns
}

/// Meaning of the tint; empty where no tooth is damaged.
///
/// # Arguments
/// * `wheels` - names of the wheels, each with its damaged teeth
pub(crate) fn in_words(wheels: &[(&str, &[DamagedTooth])]) -> Option<String> {
    let all: Vec<(&str, DamagedTooth)> =
        wheels.iter().flat_map(|(name, teeth)| teeth.iter().map(|tooth| (*name, *tooth))).collect();
    let missing = all.iter().filter(|(_, tooth)| tooth.is_missing).count();
    // Where there is but the gear's tooth 1, as is usual, its number says nothing.
    if let [(wheel, DamagedTooth { tooth: 1, is_missing, .. })] = all[..]
        && wheel != "pinion"
    {
        let text = if is_missing { "turn of the missing tooth" } else { "damaged tooth in contact" };
        return Some(text.to_owned());
    }
    let named = |state: &str| {
        let damaged = wheels.iter().filter(|(_, teeth)| !teeth.is_empty());
        let names = damaged.map(|(name, teeth)| numbered(&format!("{state} {name} "), teeth));
        names.collect::<Vec<_>>().join(" and ")
    };
    match (all.len(), missing) {
        (0, _) => None,
        (_, 0) => Some(format!("{} in contact", named("damaged"))),
        (1, _) => Some(format!("turn of {}", named("missing"))),
        (count, missing) if count == missing => Some(format!("turns of {}", named("missing"))),
        _ => Some(format!("turns of {}", named("damaged"))),
    }
}

/// Teeth with their numbers, such as `gear tooth 6` or `gear teeth 2 and 6`; of many, how many they are.
///
/// # Arguments
/// * `of` - what stands before `tooth`, with a space: which teeth, or nothing
/// * `teeth` - at least one
pub(crate) fn numbered(of: &str, teeth: &[DamagedTooth]) -> String {
    let numbers: Vec<String> = teeth.iter().map(|tooth| tooth.tooth.to_string()).collect();
    match &numbers[..] {
        [one] => format!("{of}tooth {one}"),
        [first @ .., last] if numbers.len() <= MOST_NAMED => {
            format!("{of}teeth {} and {last}", first.join(", "))
        }
        _ => format!("{} {of}teeth", numbers.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tooth(tooth: u32, is_missing: bool) -> DamagedTooth {
        DamagedTooth { tooth, contact_pitches: [0.0, 1.6], is_missing }
    }

    #[test]
    fn turns_go_round_and_join() {
        let at = |damaged: &'static [i64]| {
            turns([0.0, 10.0], [0.0, 1.6], |pair| damaged.contains(&pair.rem_euclid(10)))
        };
        assert_eq!(at(&[0]), [[0.0, 1.6]]);
        assert_eq!(at(&[3, 4]), [[3.0, 5.6]]);
        assert_eq!(at(&[2, 6]), [[2.0, 3.6], [6.0, 7.6]]);
        let [start, end] = at(&[9])[..] else { unreachable!() };
        assert!((start[1] - 0.6).abs() < 1e-12 && start[0] == 0.0 && end == [9.0, 10.0]);
    }

    #[test]
    fn words_name_wheel_and_tooth() {
        let words = |pinion: &[DamagedTooth], gear: &[DamagedTooth]| {
            in_words(&[("pinion", pinion), ("gear", gear)]).unwrap_or_default()
        };
        assert_eq!(words(&[], &[]), "");
        assert_eq!(words(&[], &[tooth(1, false)]), "damaged tooth in contact");
        assert_eq!(words(&[], &[tooth(1, true)]), "turn of the missing tooth");
        assert_eq!(words(&[tooth(1, false)], &[]), "damaged pinion tooth 1 in contact");
        assert_eq!(words(&[], &[tooth(6, true)]), "turn of missing gear tooth 6");
        let both = words(&[tooth(3, false)], &[tooth(2, false), tooth(6, false)]);
        assert_eq!(both, "damaged pinion tooth 3 and damaged gear teeth 2 and 6 in contact");
        assert_eq!(words(&[], &[tooth(2, true), tooth(6, false)]), "turns of damaged gear teeth 2 and 6");
        let many: Vec<_> = (1..=5).map(|number| tooth(number, false)).collect();
        assert_eq!(words(&[], &many), "5 damaged gear teeth in contact");
    }
}
