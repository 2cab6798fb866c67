//! What a damage leaves of one slice of the face.

use super::{Crack, DamagedTooth, FlankPit, FlankPits};

/// Part of a slice from which on a pit that reaches in from one side takes it whole.
const WHOLE: f64 = 1.0 - 1e-9;

impl DamagedTooth {
    /// Whether what is lost differs along the face, or along the flank, along which the contact line of helical teeth runs.
    pub(crate) fn varies_over_face(&self) -> bool {
        let is_partial = |widths_mm: &[f64]| widths_mm.iter().any(|width_mm| *width_mm > 0.0);
        !self.is_missing()
            && (self.descriptions.iter().any(|damage| damage.part.is_of_flank())
                || is_partial(&self.missing_width_mm)
                || is_partial(&self.corner_width_mm)
                || self.pits.is_some()
                || self.crack.is_some_and(|crack| crack.length_mm.is_some()))
    }

    /// The tooth as one whose face is a slice of it.
    ///
    /// # Arguments
    /// * `from_mm`, `until_mm` - (mm) the slice, from the middle of the face
    /// * `face_width_mm` - (mm) of the whole tooth
    pub(crate) fn slice(&self, [from_mm, until_mm]: [f64; 2], face_width_mm: f64) -> Self {
        let (half_mm, width_mm) = (face_width_mm / 2.0, until_mm - from_mm);
        // What is missing reaches in from the end at positive z.
        let of_slice = |missing_mm: f64| (until_mm - (half_mm - missing_mm)).clamp(0.0, width_mm);
        let mut slice = Self {
            missing_width_mm: self.missing_width_mm.iter().copied().map(of_slice).collect(),
            corner_width_mm: self.corner_width_mm.iter().copied().map(of_slice).collect(),
            crack: self.crack.and_then(|crack| crack.slice([half_mm - until_mm, half_mm - from_mm])),
            pits: self.pits.as_ref().and_then(|pits| pits.slice([from_mm, until_mm])),
            ..self.clone()
        };
        for index in 0..slice.corner_width_mm.len() {
            if slice.corner_width_mm[index] >= WHOLE * width_mm {
                // The flank of the slice lies farther back, but the mate may reach it.
                slice.corner_width_mm[index] = 0.0;
                slice.flank_y_mm[index] = slice.flank_y_mm[index].min(slice.corner_y_mm[index]);
            }
        }
        slice
    }
}

impl Crack {
    /// The crack as deep as on average over a slice; none where it does not reach.
    ///
    /// # Arguments
    /// * `from_mm`, `until_mm` - (mm) the slice, from the end of the face at which the crack is deepest
    fn slice(self, [from_mm, until_mm]: [f64; 2]) -> Option<Self> {
        let Some(length_mm) = self.length_mm else { return Some(self) };
        // ∫ √(1 − s/l) ds = −⅔ l (1 − s/l)^(3/2)
        let beyond = |s_mm: f64| (1.0 - s_mm / length_mm).max(0.0).powf(1.5);
        let mean = 2.0 / 3.0 * length_mm * (beyond(from_mm) - beyond(until_mm)) / (until_mm - from_mm);
        (mean > 0.0).then_some(Self { depth_mm: self.depth_mm * mean, length_mm: None, ..self })
    }
}

impl FlankPits {
    /// The pits that a slice has a part of; none where there are none.
    fn slice(&self, [from_mm, until_mm]: [f64; 2]) -> Option<Self> {
        let middle_mm = (from_mm + until_mm) / 2.0;
        let reaches = |pit: &&FlankPit| {
            pit.z_mm + pit.face_radius_mm > from_mm && pit.z_mm - pit.face_radius_mm < until_mm
        };
        let moved = |pit: &FlankPit| FlankPit { z_mm: pit.z_mm - middle_mm, ..*pit };
        let pits: Vec<FlankPit> = self.pits.iter().filter(reaches).map(moved).collect();
        (!pits.is_empty()).then(|| Self { pits, face_width_mm: until_mm - from_mm, ..self.clone() })
    }
}

#[cfg(test)]
mod tests {
    use crate::scenario::{Fault, GearPair, MissingTooth, RootCrack, Scenario, ToothBreakage, Wear};
    use crate::simulate::stages;

    fn damaged(damage: impl Into<crate::damage::Damage>) -> crate::damage::DamagedTooth {
        let mut scenario = Scenario::new(GearPair::example());
        scenario.faults = vec![Fault::on_first_gear_tooth(damage)];
        stages(&scenario).unwrap().pairs[0].damaged.swap_remove(0)
    }

    #[test]
    fn slices_have_their_part_of_what_is_lost() {
        let width_mm = Scenario::new(GearPair::example()).gears().face_width_mm;
        let chipped = damaged(ToothBreakage { chip_height_mm: 3.0, chip_width_mm: 10.0, tip_loss_mm: 0.0 });
        let edges: Vec<f64> = (0..=11).map(|n| width_mm * (f64::from(n) / 11.0 - 0.5)).collect();
        let last = chipped.missing_width_mm.len() - 1;
        let parts = |tooth: &crate::damage::DamagedTooth| -> Vec<crate::damage::DamagedTooth> {
            edges.windows(2).map(|ends| tooth.slice([ends[0], ends[1]], width_mm)).collect()
        };
        let slices = parts(&chipped);
        let missing: f64 = slices.iter().map(|slice| slice.missing_width_mm[last]).sum();
        assert!((missing - chipped.missing_width_mm[last]).abs() < 1e-12);
        assert!(slices[0].missing_width_mm[last] == 0.0 && slices[10].missing_width_mm[last] > 1.0);
        // A parabola's area is two thirds of its depth and length.
        let cracked = damaged(RootCrack { depth_mm: 2.0, angle_deg: 45.0, length_mm: Some(9.0) });
        let area: f64 =
            (parts(&cracked).iter()).filter_map(|slice| Some(slice.crack?.depth_mm * width_mm / 11.0)).sum();
        assert!((area - 2.0 / 3.0 * 2.0 * 9.0).abs() < 1e-12, "{area}");
        assert!(cracked.varies_over_face() && chipped.varies_over_face());
        assert!(damaged(Wear { depth_um: 20.0 }).varies_over_face());
        assert!(!damaged(MissingTooth).varies_over_face());
    }
}
