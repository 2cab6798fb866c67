//! A pit over a part of the face width, from one side.

use super::face_circle::{CutFlank, cut_flank};
use super::section::mate_range;
use super::{
    ContactWidth, Displacement, FaultDescription, FaultGeometry, LateralBending, Pivot, ToothSection,
};
use crate::scenario::{Convention, PartialFace, ScenarioError};
use crate::tooth::Teeth;

pub(super) fn geometry(
    fault: &PartialFace,
    teeth: &Teeth,
    convention: Convention,
) -> Result<FaultGeometry, ScenarioError> {
    let CutFlank { pit, flank_y_mm } = cut_flank(&fault.pit, teeth, convention)?;
    let face_width = teeth.gear.face_width_mm;
    if fault.width_mm >= face_width {
        return Err(ScenarioError::new(
            "fault.width_mm",
            fault.width_mm,
            format!("must be below the face width, {face_width} mm"),
        )
        .with_help("a pit over the whole width is kind = \"through-face\""));
    }
    let inside = pit.start_index..=pit.end_index;
    let mut gear = ToothSection::sound(&teeth.gear, &teeth.gear_profile);
    cut_corner(&mut gear, face_width, fault.width_mm, &teeth.gear_profile.y_mm, &flank_y_mm, inside.clone());
    if let Some(lateral) = &mut gear.lateral {
        // Convention: the published coupling has the sign of a pit on the other side, with the load left where it is.
        lateral.published_coupling = convention == Convention::Published;
    }

    let mut pinion = ToothSection::sound(&teeth.pinion, &teeth.pinion_profile);
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
    if convention == Convention::Published {
        // The published foundation is loaded at the pit's edges, as if the mate turned about them.
        let (gear_pivot, pinion_pivot) = Pivot::over_pit(&pit, &teeth.contact, false);
        gear.pivot = Some(gear_pivot);
        pinion.pivot = Some(pinion_pivot);
    }
    Ok(FaultGeometry {
        gear,
        pinion,
        no_contact: 0..0,
        contact_width: ContactWidth::Pit {
            width_mm: fault.width_mm,
            start_rev: pit.start_rev,
            end_rev: pit.end_rev,
        },
        displacement: Displacement::None,
        flank_y_mm,
        description: FaultDescription::FaceFault { pit, width_mm: fault.width_mm },
    })
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
    let mut lateral = LateralBending {
        iy_mm4: y_mm.iter().map(|y| 2.0 * y * face_width.powi(3) / 12.0).collect(),
        iyz_mm4: vec![0.0; points],
        zc_mm: vec![0.0; points],
        load_z_mm: vec![0.0; points],
        published_coupling: false,
    };
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
        section.shear_per_mm2[i] =
            shear_flexibility(face_width, face_width - pit_width, [-y - yc, cut_y - yc, y - yc])
                / (2.0 * section.iz_mm4[i].powi(2));
    }
    section.yc_mm = Some(yc_mm);
    section.lateral = Some(lateral);
}

/// (mm⁵) `∫ Q²/b dy` over a section that is `lower_width` wide between the first two of the heights
/// `[bottom, step, top]`, measured from its centre, and `upper_width` between the last two.
///
/// On each piece `Q(y) = Q_end + b (y_end² − y²)/2`, with `Q_end` the first moment beyond the piece.
fn shear_flexibility(lower_width: f64, upper_width: f64, [bottom, step, top]: [f64; 3]) -> f64 {
    let piece = |width: f64, from: f64, to: f64, beyond: f64| {
        // Q²/b with Q = a − b y²/2.
        let a = beyond + width * to * to / 2.0;
        let integral = |y: f64| a * a * y / width - a * y.powi(3) / 3.0 + width * y.powi(5) / 20.0;
        integral(to) - integral(from)
    };
    let upper_moment = upper_width * (top * top - step * step) / 2.0;
    piece(upper_width, step, top, 0.0) + piece(lower_width, bottom, step, upper_moment)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_flexibility_of_a_rectangle_is_known() {
        // ∫ Q²/b dy = 4 b h⁵/15 for a rectangle of width b and height 2h, however it is split.
        let (b, h) = (3.0, 2.0f64);
        for step in [-1.0, 0.0, 1.5] {
            let value = shear_flexibility(b, b, [-h, step, h]);
            assert!((value / (4.0 * b * h.powi(5) / 15.0) - 1.0).abs() < 1e-14, "{step}");
        }
    }

    #[test]
    fn shear_flexibility_agrees_with_a_sum() {
        let (w, u, heights) = (15.0, 9.0, [-2.3, 0.4, 1.9]);
        let steps = 200_000;
        let (mut moment, mut sum) = (0.0, 0.0);
        let h = (heights[2] - heights[0]) / f64::from(steps);
        for k in 0..steps {
            let y = heights[2] - h * (f64::from(k) + 0.5);
            let b = if y > heights[1] { u } else { w };
            sum += (moment + b * h * y / 2.0f64).powi(2) / b * h;
            moment += b * h * y;
        }
        assert!((shear_flexibility(w, u, heights) / sum - 1.0).abs() < 1e-4);
    }
}
