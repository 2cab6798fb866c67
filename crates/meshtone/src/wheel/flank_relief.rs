//! Relief of the flank near the tip, as a gap of some micrometres.

use super::{ReliefShape, Wheel};
use crate::keys::{Range, keys};

/// Material removed from the flank near the tip, so that loaded teeth enter and leave contact softly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlankRelief {
    /// Line or parabola. Default parabolic.
    pub shape: ReliefShape,
    /// (mm) Length along the tooth's centre line, from the tip inwards. Default 1.
    pub length_mm: f64,
    /// (µm) How far the flank lies back at the tip, along its normal. Default 0: no relief.
    pub amount_um: f64,
}

impl FlankRelief {
    /// (mm) How far the flank lies back where its radius of curvature is `curvature_mm`.
    ///
    /// # Arguments
    /// * `wheel` - whose flank it is
    /// * `curvature_mm` - (mm) radius of curvature of the involute there
    pub fn gap_mm(&self, wheel: &Wheel, curvature_mm: f64) -> f64 {
        let radius_mm = curvature_mm.hypot(wheel.base_radius_mm);
        let below_tip_mm = wheel.sign() * (wheel.tip_radius_mm - radius_mm);
        let part = (1.0 - below_tip_mm / self.length_mm).clamp(0.0, 1.0);
        let shape = match self.shape {
            ReliefShape::Parabolic => part * part,
            ReliefShape::Linear => part,
        };
        self.amount_um * 1e-3 * shape
    }
}

keys! {
    FlankRelief = default Self { shape: ReliefShape::Parabolic, length_mm: 1.0, amount_um: 0.0 };
    shape "" "a parabola that leaves the flank smoothly, or a straight line";
    length_mm "mm" "the length from the tip along the tooth's centre line"
        .range(Range::positive()).rule("less than 2 modules");
    amount_um "µm" "the depth of the relief at the tip, along the flank's normal; usually 10 to 40"
        .range(Range::not_negative().implausible_above(1000.0));
}
