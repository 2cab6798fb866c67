//! A corner of the tooth that has chipped off, and a tip that is lost over the whole width.

use super::{ContactWidth, FaultGeometry, LateralBending, ToothSection};
use crate::damage::{HealthyTooth, ToothBreakage};
use crate::error::ScenarioError;
use crate::wheel::Teeth;

pub(super) fn geometry(fault: &ToothBreakage, teeth: &Teeth) -> Result<FaultGeometry, ScenarioError> {
    let profile = &teeth.gear_profile;
    let contact = &teeth.contact;
    let face_width = teeth.gear.face_width_mm;
    let points = profile.len();
    let chip = fault.chip(profile)?;
    let (chip_start, missing_width) = (chip.chip_start_index, &chip.missing_width_mm);
    let exit_rev = (points - 1 - chip_start) as f64 / (contact.points - 1) as f64 * contact.span_rev;

    let gear = chipped(face_width, &profile.y_mm, missing_width);
    // The pinion tooth is whole, but loaded over what is left of the gear's width.
    let met_width: Vec<f64> = (0..points)
        .map(|i| if i < contact.initial_contact_index { 0.0 } else { missing_width[contact.mate_index(i)] })
        .collect();
    let description = fault.describe(&chip, exit_rev, &HealthyTooth::first_of_gear(teeth, 0));
    let mut geometry = FaultGeometry::of_sound_pair(teeth, description);
    let iy_mm4 = teeth.pinion_profile.y_mm.iter().map(|y| 2.0 * y * face_width.powi(3) / 12.0).collect();
    let load_z_mm = met_width.iter().map(|width| width / 2.0).collect();
    geometry.pinion.lateral = Some(LateralBending::of_rectangles(iy_mm4, vec![0.0; points], load_z_mm));
    geometry.pinion.foundation_width_mm = met_width.iter().map(|width| face_width - width).collect();
    Ok(FaultGeometry {
        gear,
        no_contact: chip.lost_from_index..points,
        contact_width: ContactWidth::Chip { width_mm: fault.chip_width_mm, exit_rev },
        ..geometry
    })
}

/// Cross-sections of a tooth whose width is `face_width − missing_width`, from one side.
fn chipped(face_width: f64, y_mm: &[f64], missing_width: &[f64]) -> ToothSection {
    let widths: Vec<f64> = missing_width.iter().map(|missing| face_width - missing).collect();
    let rows = || widths.iter().zip(y_mm);
    let iy_mm4 = rows().map(|(width, y)| 2.0 * y * width.powi(3) / 12.0).collect();
    let area_mm2: Vec<f64> = rows().map(|(width, y)| width * 2.0 * y).collect();
    let centre: Vec<f64> = missing_width.iter().map(|missing| missing / 2.0).collect();
    ToothSection {
        shear_per_mm2: area_mm2.iter().map(|area| 0.6 / area).collect(),
        area_mm2,
        iz_mm4: rows().map(|(width, y)| width * (2.0 * y).powi(3) / 12.0).collect(),
        yc_mm: None,
        lateral: Some(LateralBending::of_rectangles(iy_mm4, centre.clone(), centre)),
        foundation_width_mm: widths.clone(),
        contact_width_mm: widths,
        pressure_angle_rad: None,
        pivot: None,
    }
}
