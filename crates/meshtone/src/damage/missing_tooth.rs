//! A tooth that is gone.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::severity::SoundTooth;
use super::{DamageDescription, DamageResult, FacePatch, Kind, ToothPart};
use crate::keys::{Check, KeyRow, Keys};
use crate::wheel::Gears;

/// A tooth that is gone: it carries nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MissingTooth;

impl Keys for MissingTooth {
    fn start() -> Self {
        Self
    }

    fn rows() -> Vec<KeyRow<Self>> {
        Vec::new()
    }
}

impl Kind for MissingTooth {
    const NAME: &str = "missing-tooth";
    const TITLE: &str = "missing tooth";
    const PART: ToothPart = ToothPart::Whole;
    const SIZES: &[&str] = &[];

    fn example() -> Self {
        Self
    }

    fn of_severity(&self, _severity: f64, _tooth: &SoundTooth) -> Option<Self> {
        Some(*self)
    }

    fn severity(&self, _tooth: &SoundTooth) -> f64 {
        1.0
    }

    fn check(&self, _gears: &Gears) -> Check {
        Ok(())
    }

    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult {
        tooth.gone_from_index = 0;
        Ok(Self::describe(healthy))
    }
}

impl MissingTooth {
    pub(crate) fn describe(healthy: &HealthyTooth) -> DamageDescription {
        let range = [0, healthy.profile().len() - 1];
        let mut face = FacePatch::whole_width(range, healthy);
        // The root is left, so that there is no edge along it.
        face.edge_mm = [0, 3, 2, 1].map(|corner| face.outline_mm[corner]).to_vec();
        DamageDescription {
            face: vec![face],
            caption: vec!["tooth missing".to_owned()],
            ..DamageDescription::of::<Self>(range)
        }
    }
}
