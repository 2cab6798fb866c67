//! A corner of the tooth that has chipped off, and a tip that is lost over the whole width.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::description::hundredths;
use super::severity::SoundTooth;
use super::{DamageDescription, DamageResult, FacePatch, Kind, QuantityValue, ToothPart};
use crate::error::ScenarioError;
use crate::keys::{Check, Range, below, check_keys, keys, require};
use crate::wheel::Gears;
use crate::wheel::ToothProfile;

/// A corner chipped off, and the tip lost over the whole width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothBreakage {
    /// (mm) Extent of the chip from the tip along the tooth's centre line.
    pub chip_height_mm: f64,
    /// (mm) Extent of the chip along the face width, at the tip.
    pub chip_width_mm: f64,
    /// (mm) Length of the tip that is lost over the whole width. Default 0.
    pub tip_loss_mm: f64,
}

keys! {
    ToothBreakage = Self { chip_height_mm: f64::NAN, chip_width_mm: f64::NAN, tip_loss_mm: 0.0 };
    chip_height_mm "mm" "the extent of the chipped corner from the tip along the tooth"
        .required_unless(&["severity"]).range(Range::positive()).rule("less than the tooth's height");
    chip_width_mm "mm" "its extent along the face width, at the tip"
        .required_unless(&["severity"]).range(Range::positive()).rule("at most the face width");
    tip_loss_mm "mm" "the length of tip that is lost over the whole width"
        .range(Range::not_negative()).rule("less than the tooth's height");
}

impl Kind for ToothBreakage {
    const NAME: &str = "tooth-breakage";
    const TITLE: &str = "tooth breakage";
    const MOVES_FORCES: bool = true;
    const PART: ToothPart = ToothPart::Tip;
    const SIZES: &[&str] = &["chip_height_mm", "chip_width_mm", "tip_loss_mm"];

    fn example() -> Self {
        Self { chip_height_mm: 5.0, chip_width_mm: 12.0, tip_loss_mm: 3.0 }
    }

    /// A corner that grows until its edge runs from the tip's one end to the other end of where contact starts; then the tip.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self> {
        let (height, width) = (tooth.contact_height_mm(), tooth.face_width_mm);
        let corner = (2.0 * severity).sqrt().min(1.0);
        let tip = (2.0 * severity - 1.0).max(0.0).sqrt();
        tooth.shows(corner).then_some(Self {
            chip_height_mm: corner * height,
            chip_width_mm: corner * width,
            tip_loss_mm: tip * height,
        })
    }

    /// The lost part of the flank's area in contact.
    fn severity(&self, tooth: &SoundTooth) -> f64 {
        let (height, width) = (tooth.contact_height_mm(), tooth.face_width_mm);
        let tip = self.tip_loss_mm.min(height);
        // What the chip takes below the lost tip, where it does not reach below the part in contact.
        let (from, to) = (tip, self.chip_height_mm.min(height).max(tip));
        let mean_left = 1.0 - (from + to) / (2.0 * self.chip_height_mm);
        let chip = if to > from { self.chip_width_mm * mean_left * (to - from) } else { 0.0 };
        (tip / height + chip / (height * width)).min(1.0)
    }

    fn check(&self, gears: &Gears) -> Check {
        check_keys(self, "fault")?;
        let height = gears.tooth_height_mm();
        let height_is = "the tooth's height";
        below("fault.chip_height_mm", self.chip_height_mm, height, height_is)?;
        let width = self.chip_width_mm;
        let problem = format!("must be at most {} mm, the face width", gears.face_width_mm);
        require("fault.chip_width_mm", width, width <= gears.face_width_mm, problem)?;
        below("fault.tip_loss_mm", self.tip_loss_mm, height, height_is)
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        let chipped = self.chip(healthy.profile())?;
        for (missing, of_chip) in tooth.missing_width_mm.iter_mut().zip(&chipped.missing_width_mm) {
            *missing = missing.max(*of_chip);
        }
        tooth.gone_from_index = tooth.gone_from_index.min(chipped.lost_from_index);
        Ok(self.describe(&chipped, healthy.position_rev(chipped.chip_start_index), healthy))
    }
}

/// What a breakage leaves of a flank.
pub(crate) struct ChippedFlank {
    /// Last profile index below the chip.
    pub(crate) chip_start_index: usize,
    /// First profile index of the lost tip.
    pub(crate) lost_from_index: usize,
    /// (mm) Missing width over the profile points.
    pub(crate) missing_width_mm: Vec<f64>,
}

impl ToothBreakage {
    /// Chips a flank's corner off.
    ///
    /// # Arguments
    /// * `profile` - the healthy flank
    ///
    /// # Errors
    /// A chip or a lost tip that is larger than the tooth, whose corner at the tip lies a little below the tip circle.
    pub(crate) fn chip(&self, profile: &ToothProfile) -> Result<ChippedFlank, ScenarioError> {
        let tip = profile.tip_x_mm();
        let height = tip - profile.x_mm[0];
        for (key, value) in
            [("fault.chip_height_mm", self.chip_height_mm), ("fault.tip_loss_mm", self.tip_loss_mm)]
        {
            if value >= height {
                let problem = format!("must be below the tooth's height, {height:.3} mm");
                return Err(ScenarioError::new(key, value, problem));
            }
        }
        let chip_bottom = tip - self.chip_height_mm;
        let chip_start = profile.x_mm.partition_point(|&x| x <= chip_bottom).max(1) - 1;
        let slope = if self.chip_height_mm > 0.0 { self.chip_width_mm / self.chip_height_mm } else { 0.0 };
        let missing_width_mm = (profile.x_mm.iter().enumerate())
            .map(|(i, x)| if i < chip_start { 0.0 } else { slope * (x - profile.x_mm[chip_start]) })
            .collect();
        Ok(ChippedFlank {
            chip_start_index: chip_start,
            lost_from_index: profile.x_mm.partition_point(|&x| x <= tip - self.tip_loss_mm),
            missing_width_mm,
        })
    }

    /// The chip and the lost tip in words and pictures.
    ///
    /// # Arguments
    /// * `chipped` - what is left
    /// * `exit_rev` - (rev) position at which contact with the chip ends
    /// * `healthy` - the healthy tooth
    pub(crate) fn describe(
        &self,
        chipped: &ChippedFlank,
        exit_rev: f64,
        healthy: &HealthyTooth,
    ) -> DamageDescription {
        let (profile, half) = (healthy.profile(), healthy.wheel().face_width_mm / 2.0);
        let last = profile.len() - 1;
        let (bottom, tip) = (profile.x_mm[chipped.chip_start_index], profile.tip_x_mm());
        let tip_is_lost = self.tip_loss_mm > 0.0;
        // The lost tip takes the chip's upper part with it.
        let end = if tip_is_lost { profile.x_mm[chipped.lost_from_index.min(last)] } else { tip };
        let mut face = Vec::new();
        if bottom < end {
            let width = chipped.missing_width_mm[last] * (end - bottom) / (tip - bottom);
            let [below, corner, along] = [[half, bottom], [half, end], [half - width, end]];
            face.push(FacePatch { outline_mm: vec![below, corner, along], edge_mm: vec![below, along] });
        }
        let mut sizes = vec![format!(
            "chip {} mm high, {} mm wide",
            hundredths(self.chip_height_mm),
            hundredths(self.chip_width_mm)
        )];
        let mut caption = vec!["corner chipped off".to_owned()];
        if tip_is_lost {
            let edge_mm = vec![[-half, end], [half, end]];
            face.push(FacePatch { edge_mm, ..FacePatch::rectangle([-half, half], [end, tip]) });
            let loss = format!("tip loss {} mm", hundredths(self.tip_loss_mm));
            sizes.push(loss.clone());
            caption.push(loss);
        }
        let range = [chipped.chip_start_index.min(chipped.lost_from_index).min(last), last];
        DamageDescription {
            quantities: vec![("exit_rev", QuantityValue::Number(exit_rev))],
            is_partial: true,
            face,
            sizes,
            caption,
            ..DamageDescription::of::<Self>(range)
        }
    }
}
