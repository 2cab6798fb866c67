//! A corner of the tooth that has chipped off, and a tip that is lost over the whole width.

use super::{ContactWidth, Displacement, FaultDescription, FaultGeometry, LateralBending, ToothSection};
use crate::scenario::{ScenarioError, ToothBreakage};
use crate::tooth::Teeth;

pub(super) fn geometry(fault: &ToothBreakage, teeth: &Teeth) -> Result<FaultGeometry, ScenarioError> {
    let profile = &teeth.gear_profile;
    let contact = &teeth.contact;
    let face_width = teeth.gear.face_width_mm;
    let points = profile.len();
    let tip = profile.tip_x_mm();
    let height = tip - profile.x_mm[0];
    for (key, value) in
        [("fault.chip_height_mm", fault.chip_height_mm), ("fault.tip_loss_mm", fault.tip_loss_mm)]
    {
        if value >= height {
            return Err(ScenarioError::new(
                key,
                value,
                format!("must be below the tooth's height, {height:.3} mm"),
            ));
        }
    }
    if fault.chip_width_mm > face_width {
        return Err(ScenarioError::new(
            "fault.chip_width_mm",
            fault.chip_width_mm,
            format!("must be at most the face width, {face_width} mm"),
        ));
    }

    let chip_bottom = tip - fault.chip_height_mm;
    let chip_start = profile.x_mm.partition_point(|&x| x <= chip_bottom).max(1) - 1;
    let slope = if fault.chip_height_mm > 0.0 { fault.chip_width_mm / fault.chip_height_mm } else { 0.0 };
    let missing_width: Vec<f64> = (profile.x_mm.iter().enumerate())
        .map(|(i, x)| if i < chip_start { 0.0 } else { slope * (x - profile.x_mm[chip_start]) })
        .collect();
    let exit_rev = (points - 1 - chip_start) as f64 / (contact.points - 1) as f64 * contact.span_rev;

    let gear = chipped(face_width, &profile.y_mm, &missing_width);
    // The pinion tooth is whole, but loaded over what is left of the gear's width.
    let met_width: Vec<f64> = (0..points)
        .map(|i| if i < contact.initial_contact_index { 0.0 } else { missing_width[contact.mate_index(i)] })
        .collect();
    let mut pinion = ToothSection::sound(&teeth.pinion, &teeth.pinion_profile);
    let whole = |power: i32| {
        let width = face_width.powi(power);
        teeth.pinion_profile.y_mm.iter().map(move |y| 2.0 * y * width / 12.0).collect()
    };
    pinion.lateral = Some(LateralBending {
        iy_mm4: whole(3),
        iyz_mm4: vec![0.0; points],
        zc_mm: vec![0.0; points],
        load_z_mm: met_width.iter().map(|width| width / 2.0).collect(),
        published_coupling: false,
    });
    pinion.foundation_width_mm = met_width.iter().map(|width| face_width - width).collect();

    let lost_tip = profile.x_mm.partition_point(|&x| x <= tip - fault.tip_loss_mm);
    Ok(FaultGeometry {
        gear,
        pinion,
        no_contact: lost_tip..points,
        contact_width: ContactWidth::Chip { width_mm: fault.chip_width_mm, exit_rev },
        displacement: Displacement::None,
        flank_y_mm: profile.y_mm.clone(),
        description: FaultDescription::ToothBreakage {
            exit_rev,
            chip_start_index: chip_start,
            tip_loss_mm: fault.tip_loss_mm,
            missing_width_mm: missing_width,
        },
    })
}

/// Cross-sections of a tooth whose width is `face_width − missing_width`, from one side.
fn chipped(face_width: f64, y_mm: &[f64], missing_width: &[f64]) -> ToothSection {
    let widths: Vec<f64> = missing_width.iter().map(|missing| face_width - missing).collect();
    let rows = || widths.iter().zip(y_mm);
    let area_mm2: Vec<f64> = rows().map(|(width, y)| width * 2.0 * y).collect();
    let centre: Vec<f64> = missing_width.iter().map(|missing| missing / 2.0).collect();
    ToothSection {
        shear_per_mm2: area_mm2.iter().map(|area| 0.6 / area).collect(),
        area_mm2,
        iz_mm4: rows().map(|(width, y)| width * (2.0 * y).powi(3) / 12.0).collect(),
        yc_mm: None,
        lateral: Some(LateralBending {
            iy_mm4: rows().map(|(width, y)| 2.0 * y * width.powi(3) / 12.0).collect(),
            iyz_mm4: vec![0.0; y_mm.len()],
            zc_mm: centre.clone(),
            load_z_mm: centre,
            published_coupling: false,
        }),
        foundation_width_mm: widths.clone(),
        contact_width_mm: widths,
        pressure_angle_rad: None,
        pivot: None,
    }
}
