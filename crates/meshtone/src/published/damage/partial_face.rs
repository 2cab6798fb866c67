//! A pit over a part of the face width, from one side.

use super::face_circle::pit_on_gear;
use super::section::mate_range;
use super::{ContactWidth, FaultGeometry, LateralBending, Pivot, ToothSection};
use crate::damage::{HealthyTooth, PartialFace, shear_flexibility};
use crate::error::ScenarioError;
use crate::wheel::Teeth;

pub(super) fn geometry(fault: &PartialFace, teeth: &Teeth) -> Result<FaultGeometry, ScenarioError> {
    let (pit, flank_y_mm) = pit_on_gear(&fault.pit, teeth)?;
    let face_width = teeth.gear.face_width_mm;
    let inside = pit.start_index..=pit.end_index;
    let healthy = HealthyTooth::first_of_gear(teeth, 0);
    let description = pit.describe::<PartialFace>(fault.width_mm, &flank_y_mm, &healthy);
    let mut geometry = FaultGeometry::of_sound_pair(teeth, description);
    let FaultGeometry { gear, pinion, .. } = &mut geometry;
    cut_corner(gear, face_width, fault.width_mm, &teeth.gear_profile.y_mm, &flank_y_mm, inside.clone());
    let left = (face_width - fault.width_mm) / face_width;
    let met = mate_range(inside, |i| teeth.contact.mate_index(i));
    for i in met {
        pinion.iz_mm4[i] *= left;
        pinion.foundation_width_mm[i] *= left;
    }
    for i in pit.start_index..=pit.end_index {
        gear.foundation_width_mm[i] *= left;
        gear.contact_width_mm[i] *= left;
    }
    // The published foundation is loaded at the pit's edges, as if the mate turned about them.
    let (gear_pivot, pinion_pivot) = Pivot::over_pit(&pit, &teeth.contact, false);
    gear.pivot = Some(gear_pivot);
    pinion.pivot = Some(pinion_pivot);
    let contact_width =
        ContactWidth::Pit { width_mm: fault.width_mm, start_rev: pit.start_rev, end_rev: pit.end_rev };
    Ok(FaultGeometry { contact_width, flank_y_mm, ..geometry })
}

/// Removes the rectangle `pit_width × (Y − Y_def)` from the upper corner of each section inside the pit.
fn cut_corner(
    section: &mut ToothSection,
    face_width: f64,
    pit_width: f64,
    y_mm: &[f64],
    flank_y_mm: &[f64],
    inside: std::ops::RangeInclusive<usize>,
) {
    let points = y_mm.len();
    let mut yc_mm = vec![0.0; points];
    let iy_mm4 = y_mm.iter().map(|y| 2.0 * y * face_width.powi(3) / 12.0).collect();
    let mut lateral = LateralBending::of_rectangles(iy_mm4, vec![0.0; points], vec![0.0; points]);
    for i in inside {
        let (y, cut_y) = (y_mm[i], flank_y_mm[i]);
        let whole = 2.0 * y * face_width;
        let cut_height = y - cut_y;
        let cut = pit_width * cut_height;
        let (cut_centre_y, cut_centre_z) = ((y + cut_y) / 2.0, -(face_width - pit_width) / 2.0);
        let area = whole - cut;
        let yc = -cut * cut_centre_y / area;
        let zc = -cut * cut_centre_z / area;
        section.area_mm2[i] = area;
        section.iz_mm4[i] = face_width * (2.0 * y).powi(3) / 12.0 + whole * yc * yc
            - pit_width * cut_height.powi(3) / 12.0
            - cut * (cut_centre_y - yc).powi(2);
        lateral.iy_mm4[i] = 2.0 * y * face_width.powi(3) / 12.0 + whole * zc * zc
            - cut_height * pit_width.powi(3) / 12.0
            - cut * (cut_centre_z - zc).powi(2);
        lateral.iyz_mm4[i] = whole * yc * zc - cut * (cut_centre_y - yc) * (cut_centre_z - zc);
        yc_mm[i] = yc;
        lateral.zc_mm[i] = zc;
        lateral.load_z_mm[i] = pit_width / 2.0;
        let (bottom, step, top) = (-y - yc, cut_y - yc, y - yc);
        let rectangles = [(face_width, [bottom, step]), (face_width - pit_width, [step, top])];
        section.shear_per_mm2[i] =
            shear_flexibility(rectangles.into_iter()) / (2.0 * section.iz_mm4[i].powi(2));
    }
    section.yc_mm = Some(yc_mm);
    section.lateral = Some(lateral);
}
