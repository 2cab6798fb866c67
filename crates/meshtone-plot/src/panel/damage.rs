//! The damage in words and as ranges of the gear's profile.

use meshtone::Stages;
use meshtone::fault::{FaultDescription, FaultGeometry};
use meshtone::scenario::Fault;
use meshtone::tooth::Teeth;

use super::side::Side;
use crate::DamagedTooth;
use crate::ticks::number;

/// Profile indices, first and last, of the damaged part of the flank.
pub(super) fn damaged_range(fault: &FaultGeometry, side: &Side) -> (usize, usize) {
    let last = side.last();
    let (first, end) = match &fault.description {
        FaultDescription::MissingTooth => (0, last),
        FaultDescription::ToothBreakage { chip_start_index, .. } => {
            ((*chip_start_index).min(fault.no_contact.start), last)
        }
        FaultDescription::FaceFault { pit, .. } => (pit.start_index, pit.end_index),
        FaultDescription::ToothDestruction { start_index, end_index, .. } => {
            ((*start_index).max(side.contact_index), *end_index)
        }
    };
    (first.min(last), end.min(last))
}

/// What the damage is called.
pub(super) fn name(fault: Option<&Fault>) -> &'static str {
    match fault {
        None => "Healthy gear pair",
        Some(Fault::MissingTooth) => "Missing tooth",
        Some(Fault::ToothBreakage(_)) => "Tooth breakage",
        Some(Fault::PartialFace(_)) => "Pit over part of the face",
        Some(Fault::ThroughFace(_)) => "Pit over the whole face",
        Some(Fault::ToothDestruction(_)) => "Tooth destruction",
    }
}

/// The damage's sizes, in short phrases; none for a missing tooth.
pub(super) fn sizes(fault: &Fault, geometry: &FaultGeometry, teeth: &Teeth) -> Vec<String> {
    match (fault, &geometry.description) {
        (Fault::ToothBreakage(breakage), _) => {
            let chip = format!(
                "chip {} mm high, {} mm wide",
                number(breakage.chip_height_mm),
                number(breakage.chip_width_mm)
            );
            let loss = format!("tip loss {} mm", number(breakage.tip_loss_mm));
            [chip].into_iter().chain((breakage.tip_loss_mm > 0.0).then_some(loss)).collect()
        }
        (_, FaultDescription::FaceFault { pit, width_mm }) => vec![
            format!("{} mm wide", hundredths(*width_mm)),
            format!("{} mm long", hundredths(pit.length_mm)),
            format!("up to {} mm deep across the tooth", hundredths(depth_mm(geometry, teeth))),
        ],
        (_, FaultDescription::ToothDestruction { slope_rad, .. }) => vec![
            format!("flank ground up to {} mm deep across the tooth", hundredths(depth_mm(geometry, teeth))),
            format!("line at {}° to the centre line", tenths(slope_rad.to_degrees().abs())),
        ],
        _ => Vec::new(),
    }
}

/// One or two short lines for the tooth's face.
pub(super) fn caption(geometry: &FaultGeometry) -> Vec<String> {
    match &geometry.description {
        FaultDescription::MissingTooth => vec!["tooth missing".to_owned()],
        FaultDescription::ToothBreakage { tip_loss_mm, .. } => {
            let chip = "corner chipped off".to_owned();
            let loss = format!("tip loss {} mm", number(*tip_loss_mm));
            [chip].into_iter().chain((*tip_loss_mm > 0.0).then_some(loss)).collect()
        }
        FaultDescription::FaceFault { pit, width_mm } => {
            vec![
                format!("pit {} mm wide,", hundredths(*width_mm)),
                format!("{} mm long", hundredths(pit.length_mm)),
            ]
        }
        FaultDescription::ToothDestruction { .. } => vec!["flank ground down".to_owned()],
    }
}

/// Whether the whole tooth is gone.
pub(super) fn is_missing(geometry: &FaultGeometry) -> bool {
    matches!(geometry.description, FaultDescription::MissingTooth)
}

/// Where the gear's revolution starts.
pub(super) fn start_of_revolution(geometry: Option<&FaultGeometry>) -> &'static str {
    match geometry {
        None => "first tooth enters contact",
        Some(geometry) if is_missing(geometry) => "missing tooth would enter contact",
        Some(_) => "damaged tooth enters contact",
    }
}

/// The damaged tooth, if there is one.
pub(super) fn damaged_tooth(stages: &Stages) -> Option<DamagedTooth> {
    let contact_pitches = stages.teeth.contact.contact_ratio;
    let of = |fault| DamagedTooth { contact_pitches, is_missing: is_missing(fault) };
    stages.fault.as_ref().map(of)
}

/// Whether a part of the face width is sound where the flank is damaged.
pub(super) fn is_partial(geometry: &FaultGeometry, face_width_mm: f64) -> bool {
    match &geometry.description {
        FaultDescription::ToothBreakage { .. } => true,
        FaultDescription::FaceFault { width_mm, .. } => *width_mm < face_width_mm,
        _ => false,
    }
}

fn depth_mm(geometry: &FaultGeometry, teeth: &Teeth) -> f64 {
    let depths = teeth.gear_profile.y_mm.iter().zip(&geometry.flank_y_mm).map(|(sound, cut)| sound - cut);
    depths.fold(0.0, f64::max)
}

fn hundredths(value: f64) -> String {
    number((value * 100.0).round() / 100.0)
}

fn tenths(value: f64) -> String {
    number((value * 10.0).round() / 10.0)
}
