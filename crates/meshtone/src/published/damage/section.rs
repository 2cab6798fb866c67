//! Cross-sections of a tooth, along its centre line.

use std::ops::RangeInclusive;

use crate::damage::Pit;
use crate::wheel::{ContactLine, ToothProfile, Wheel};

/// Cross-sections of one tooth at its profile points, and how the mate loads it there.
///
/// y is measured across the tooth from its centre line, z along the face from its middle. A fault that reaches from one
/// end of the face lies at negative z here, so this z runs opposite to that of the equations of motion
/// ([`crate::published::mesh::MeshLoad`]), where it takes the width away at positive z. The strain energy does not know
/// the difference: it is the same for the mirror image.
#[derive(Debug, Clone, PartialEq)]
pub struct ToothSection {
    /// (mm²) Area.
    pub area_mm2: Vec<f64>,
    /// (1/mm²) Shear flexibility `s` in the shear energy `F_s² ∫ s/G dx`: 0.6/A for a rectangle.
    pub shear_per_mm2: Vec<f64>,
    /// (mm⁴) Second moment of area about z, about the section's own centre.
    pub iz_mm4: Vec<f64>,
    /// (mm) y of the section's centre; `None`: 0 everywhere.
    pub yc_mm: Option<Vec<f64>>,
    /// Bending about y, where the load does not pass through the middle of the face.
    pub lateral: Option<LateralBending>,
    /// (mm) Width that presses on the wheel's body when the mate touches the point.
    pub foundation_width_mm: Vec<f64>,
    /// (mm) Width of the flank, for the contact's own (Hertz) compliance.
    pub contact_width_mm: Vec<f64>,
    /// (rad) Pressure angle when the mate touches the point; `None`: the nominal one everywhere.
    pub pressure_angle_rad: Option<Vec<f64>>,
    /// Points where the mate does not touch the flank but turns about an edge.
    pub pivot: Option<Pivot>,
}

/// Bending about y and its coupling to bending about z.
#[derive(Debug, Clone, PartialEq)]
pub struct LateralBending {
    /// (mm⁴) Second moment of area about y, about the section's own centre.
    pub iy_mm4: Vec<f64>,
    /// (mm⁴) Product of inertia.
    pub iyz_mm4: Vec<f64>,
    /// (mm) z of the section's centre.
    pub zc_mm: Vec<f64>,
    /// (mm) z of the load when the mate touches the point.
    pub load_z_mm: Vec<f64>,
}

impl LateralBending {
    /// Bending of rectangles, which is not coupled to that about z.
    pub(super) fn of_rectangles(iy_mm4: Vec<f64>, zc_mm: Vec<f64>, load_z_mm: Vec<f64>) -> Self {
        Self { iyz_mm4: vec![0.0; iy_mm4.len()], iy_mm4, zc_mm, load_z_mm }
    }
}

/// Range of profile points over which the mate turns about the range's two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pivot {
    /// First point of the range: the edge for the first points.
    pub start: usize,
    /// First point for which the mate turns about `end`.
    pub turn: usize,
    /// Last point of the range: the edge from `turn` on.
    pub end: usize,
    /// Whether bending, shear and axial energies are the edge's too, or only the foundation's.
    pub energies: bool,
}

impl Pivot {
    /// The pivots of both teeth over a pit: of the gear's, and of the pinion's, which passes its points the other
    /// way round.
    pub(super) fn over_pit(pit: &Pit, contact: &ContactLine, energies: bool) -> (Self, Self) {
        let gear = Self { start: pit.start_index, turn: pit.mid_index + 1, end: pit.end_index, energies };
        let pinion = Self {
            start: contact.mate_index(pit.end_index),
            turn: contact.mate_index(pit.mid_index),
            end: contact.mate_index(pit.start_index),
            energies,
        };
        (gear, pinion)
    }

    /// Point of the profile at which the tooth is loaded when point `index` passes contact.
    pub fn loaded_point(&self, index: usize) -> usize {
        if index < self.start || index > self.end {
            index
        } else if index < self.turn {
            self.start
        } else {
            self.end
        }
    }
}

impl ToothSection {
    /// A sound tooth: rectangles `W × 2Y`.
    ///
    /// # Arguments
    /// * `wheel` - for the face width
    /// * `profile` - the flank
    pub fn sound(wheel: &Wheel, profile: &ToothProfile) -> Self {
        let width = wheel.face_width_mm;
        Self::between_flanks(width, &profile.y_mm, &profile.y_mm)
    }

    /// Rectangles of constant width between the back flank (at −`back_y_mm`) and the working flank.
    pub(super) fn between_flanks(width_mm: f64, back_y_mm: &[f64], flank_y_mm: &[f64]) -> Self {
        let heights = || back_y_mm.iter().zip(flank_y_mm).map(|(back, flank)| back + flank);
        let area_mm2: Vec<f64> = heights().map(|height| width_mm * height).collect();
        let points = back_y_mm.len();
        Self {
            shear_per_mm2: area_mm2.iter().map(|area| 0.6 / area).collect(),
            area_mm2,
            iz_mm4: heights().map(|height| width_mm * height.powi(3) / 12.0).collect(),
            yc_mm: None,
            lateral: None,
            foundation_width_mm: vec![width_mm; points],
            contact_width_mm: vec![width_mm; points],
            pressure_angle_rad: None,
            pivot: None,
        }
    }

    /// A tooth whose working flank has been cut back to `flank_y_mm` over the whole width.
    pub(super) fn cut_flank(width_mm: f64, profile: &ToothProfile, flank_y_mm: &[f64]) -> Self {
        let mut section = Self::between_flanks(width_mm, &profile.y_mm, flank_y_mm);
        section.yc_mm =
            Some(profile.y_mm.iter().zip(flank_y_mm).map(|(back, flank)| (flank - back) / 2.0).collect());
        section
    }
}

/// Indices of the mate's profile that meet `range` of a tooth's profile.
pub(super) fn mate_range(
    range: RangeInclusive<usize>,
    mate_index: impl Fn(usize) -> usize,
) -> RangeInclusive<usize> {
    mate_index(*range.end())..=mate_index(*range.start())
}
