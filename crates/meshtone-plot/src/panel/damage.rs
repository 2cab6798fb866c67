//! The damage in words and as ranges of a profile.

use meshtone::Stages;
use meshtone::damage::{Crack, Damage, DamageDescription, DamagedTooth, Fault, FlankPit, PittingGrade};
use meshtone::wheel::{ToothProfile, WheelName};

use super::side::Side;
use crate::ticks::number;

/// Profile indices, first and last, of the part of the flank that one of a tooth's damages has taken.
pub(super) fn damaged_range(damage: &DamageDescription, tooth: &DamagedTooth, side: &Side) -> (usize, usize) {
    let last = side.last();
    let (first, end) = match damage {
        DamageDescription::MissingTooth => (0, last),
        DamageDescription::ToothBreakage { chip_start_index, .. } => {
            ((*chip_start_index).min(tooth.gone_from_index), last)
        }
        DamageDescription::FaceFault { pit, .. } => (pit.start_index, pit.end_index),
        DamageDescription::ToothDestruction { start_index, end_index, .. } => {
            ((*start_index).max(side.contact_index), *end_index)
        }
        DamageDescription::Pits { pits, .. } => pitted_range(pits, tooth).unwrap_or((last, last)),
        DamageDescription::Wear { start_index, end_index, .. } => {
            ((*start_index).max(side.contact_index), *end_index)
        }
        DamageDescription::RootCrack { crack } => {
            let start = side.profile.nearest_to_x(crack.start_x_mm);
            (start, start)
        }
        _ => cut_range(side.profile, &tooth.outline_y_mm()).unwrap_or((last, last)),
    };
    (first.min(last), end.min(last))
}

/// Profile indices of the first and last point that pits reach.
fn pitted_range(pits: &[FlankPit], tooth: &DamagedTooth) -> Option<(usize, usize)> {
    let along_mm = &tooth.pits.as_ref()?.along_mm;
    let is_in = |along: &f64| pits.iter().any(|pit| (along - pit.along_mm).abs() < pit.radius_mm);
    Some((along_mm.iter().position(is_in)?, along_mm.iter().rposition(is_in)?))
}

/// Where the flank lies further back than the sound one.
fn cut_range(profile: &ToothProfile, outline_y_mm: &[f64]) -> Option<(usize, usize)> {
    let is_cut = |(sound, cut): (&f64, &f64)| cut < sound;
    let mut pairs = profile.y_mm.iter().zip(outline_y_mm);
    let first = pairs.clone().position(is_cut)?;
    Some((first, pairs.rposition(is_cut)?))
}

/// The damages in words: what they are, where they are not on the gear's tooth 1, and, as far as there is room, their sizes.
///
/// # Arguments
/// * `stages` - what was simulated
/// * `fits` - whether there is room
pub(super) fn title(stages: &Stages, fits: impl Fn(&str) -> bool) -> String {
    let faults: Vec<(usize, &Fault)> = faults_that_show(stages).collect();
    let Some((first, only)) = faults.first().map(|(number, fault)| (*number, *fault)) else {
        return "Healthy gear pair".to_owned();
    };
    let usual = Fault::at_usual_place(only.damage.clone());
    let is_usual = faults.len() == 1 && (only.wheel, &only.tooth) == (usual.wheel, &usual.tooth);
    let title = |with_sizes: bool| {
        let all = faults.iter().map(|&(number, fault)| {
            let place = format!(", {} {}", fault.wheel.name(), fault.tooth.in_words());
            let sizes = if with_sizes { sizes_of_fault(stages, number) } else { Vec::new() };
            let sizes = if sizes.is_empty() { String::new() } else { format!(": {}", sizes.join(", ")) };
            let name = name(&fault.damage);
            let name = if number == first { capitalised(&name) } else { name };
            format!("{name}{}{sizes}", if is_usual { "" } else { &place })
        });
        all.collect::<Vec<_>>().join("; ")
    };
    let full = title(true);
    if is_usual || fits(&full) { full } else { title(false) }
}

/// The faults that do anything to a tooth, with their numbers: not those of severity 0.
fn faults_that_show(stages: &Stages) -> impl Iterator<Item = (usize, &Fault)> {
    let faults = stages.scenario.faults.iter().enumerate();
    faults.filter(|(_, fault)| fault.sized(&stages.teeth).is_some())
}

/// What the damage is called.
fn name(damage: &Damage) -> String {
    match damage {
        Damage::PartialFace(_) => "pit over part of the face".to_owned(),
        Damage::ThroughFace(_) => "pit over the whole face".to_owned(),
        other => other.kind().replace('-', " "),
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().into_iter().flat_map(char::to_uppercase).chain(letters).collect()
}

/// The sizes of one of the faults. A tooth describes its damages in the order of the faults that do anything.
fn sizes_of_fault(stages: &Stages, number: usize) -> Vec<String> {
    let fault = &stages.scenario.faults[number];
    let on_same_tooth =
        |other: &Fault| other.wheel == fault.wheel && other.tooth.contains(fault.tooth.first());
    let before = faults_that_show(stages).take_while(|(other, _)| *other < number);
    let before = before.filter(|(_, other)| on_same_tooth(other)).count();
    let tooth = (stages.damaged.iter())
        .find(|tooth| tooth.wheel == fault.wheel && tooth.teeth.contains(&fault.tooth_index()));
    match tooth.and_then(|tooth| Some((tooth, tooth.descriptions.get(before)?))) {
        Some((tooth, description)) => {
            sizes(&fault.damage, description, tooth, stages.teeth.profile(fault.wheel))
        }
        None => Vec::new(),
    }
}

/// A damage's sizes, in short phrases; none for a missing tooth.
fn sizes(
    damage: &Damage,
    description: &DamageDescription,
    tooth: &DamagedTooth,
    profile: &ToothProfile,
) -> Vec<String> {
    match (damage, description) {
        (Damage::ToothBreakage(breakage), _) => {
            let chip = format!(
                "chip {} mm high, {} mm wide",
                number(breakage.chip_height_mm),
                number(breakage.chip_width_mm)
            );
            let loss = format!("tip loss {} mm", number(breakage.tip_loss_mm));
            [chip].into_iter().chain((breakage.tip_loss_mm > 0.0).then_some(loss)).collect()
        }
        (_, DamageDescription::FaceFault { pit, width_mm }) => {
            let depth_mm = depth_mm(tooth, profile, (pit.start_index, pit.end_index));
            vec![
                format!("{} mm wide", hundredths(*width_mm)),
                format!("{} mm long", hundredths(pit.length_mm)),
                format!("up to {} mm deep across the tooth", hundredths(depth_mm)),
            ]
        }
        (_, DamageDescription::ToothDestruction { start_index, end_index, slope_rad }) => {
            let depth_mm = depth_mm(tooth, profile, (*start_index, *end_index));
            vec![
                format!("flank ground up to {} mm deep across the tooth", hundredths(depth_mm)),
                format!("line at {}° to the centre line", tenths(slope_rad.to_degrees().abs())),
            ]
        }
        (_, DamageDescription::Pits { pits, area_percent }) => {
            let grade = PittingGrade::of(*area_percent).name();
            vec![format!("{}, {} ({grade})", number_of_pits(pits), area_of_pits(*area_percent))]
        }
        (Damage::Wear(wear), _) => vec![depth_of_wear(wear.depth_um)],
        (_, DamageDescription::RootCrack { crack }) => {
            let angle = format!("at {}° to the centre line", tenths(crack.angle_rad.to_degrees()));
            vec![depth_of_crack(crack), angle, extent_of_crack(crack)]
        }
        _ => Vec::new(),
    }
}

/// One or two short lines for the tooth's face.
pub(super) fn caption(damage: &DamageDescription) -> Vec<String> {
    match damage {
        DamageDescription::MissingTooth => vec!["tooth missing".to_owned()],
        DamageDescription::ToothBreakage { tip_loss_mm, .. } => {
            let chip = "corner chipped off".to_owned();
            let loss = format!("tip loss {} mm", number(*tip_loss_mm));
            [chip].into_iter().chain((*tip_loss_mm > 0.0).then_some(loss)).collect()
        }
        DamageDescription::FaceFault { pit, width_mm } => {
            vec![
                format!("pit {} mm wide,", hundredths(*width_mm)),
                format!("{} mm long", hundredths(pit.length_mm)),
            ]
        }
        DamageDescription::ToothDestruction { .. } => vec!["flank ground down".to_owned()],
        DamageDescription::Pits { pits, area_percent } => {
            vec![format!("{},", number_of_pits(pits)), area_of_pits(*area_percent)]
        }
        DamageDescription::Wear { depth_mm, .. } => {
            vec!["flank worn".to_owned(), depth_of_wear(depth_mm.iter().copied().fold(0.0, f64::max) * 1e3)]
        }
        DamageDescription::RootCrack { crack } => {
            vec![format!("crack {},", depth_of_crack(crack)), extent_of_crack(crack)]
        }
        _ => Vec::new(),
    }
}

fn number_of_pits(pits: &[FlankPit]) -> String {
    match pits.len() {
        1 => "1 pit".to_owned(),
        count => format!("{count} pits"),
    }
}

fn area_of_pits(area_percent: f64) -> String {
    format!("{} % of the flank", tenths(area_percent))
}

fn depth_of_wear(largest_um: f64) -> String {
    format!("up to {} µm deep", hundredths(largest_um))
}

fn depth_of_crack(crack: &Crack) -> String {
    let up_to = if crack.length_mm.is_some() { "up to " } else { "" };
    format!("{up_to}{} mm deep", hundredths(crack.depth_mm))
}

fn extent_of_crack(crack: &Crack) -> String {
    match crack.length_mm {
        Some(length_mm) => format!("{} mm along the face", hundredths(length_mm)),
        None => "over the whole face".to_owned(),
    }
}

/// Where a wheel's revolution starts.
///
/// # Arguments
/// * `damaged` - the wheel's damaged teeth
pub(super) fn start_of_revolution(damaged: &[crate::DamagedTooth]) -> &'static str {
    match damaged {
        [crate::DamagedTooth { tooth: 1, is_missing: true, .. }] => "missing tooth would enter contact",
        [crate::DamagedTooth { tooth: 1, .. }] => "damaged tooth enters contact",
        _ => "first tooth enters contact",
    }
}

/// The damaged teeth of a wheel, to be marked.
pub(super) fn damaged_teeth(stages: &Stages, wheel: WheelName) -> Vec<crate::DamagedTooth> {
    let contact_pitches = stages.teeth.contact.contact_ratio;
    let teeth = stages.teeth.wheel(wheel).teeth;
    let faults: Vec<Fault> = faults_that_show(stages).map(|(_, fault)| fault.clone()).collect();
    crate::DamagedTooth::of_wheel(&faults, wheel, teeth, contact_pitches)
}

/// Whether a part of the face width is sound where a damage has taken the flank.
pub(super) fn is_partial(damage: &DamageDescription, face_width_mm: f64) -> bool {
    match damage {
        DamageDescription::ToothBreakage { .. } | DamageDescription::Pits { .. } => true,
        DamageDescription::FaceFault { width_mm, .. } => *width_mm < face_width_mm,
        _ => false,
    }
}

/// (mm) How far the flank is cut back between two profile points.
fn depth_mm(tooth: &DamagedTooth, profile: &ToothProfile, (first, end): (usize, usize)) -> f64 {
    let depths = profile.y_mm.iter().zip(tooth.outline_y_mm()).map(|(sound, cut)| sound - cut);
    depths.skip(first).take((end + 1).saturating_sub(first)).fold(0.0, f64::max)
}

fn hundredths(value: f64) -> String {
    number((value * 100.0).round() / 100.0)
}

fn tenths(value: f64) -> String {
    number((value * 10.0).round() / 10.0)
}
