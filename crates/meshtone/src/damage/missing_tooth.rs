//! A tooth that is gone.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::kind::MeshEffect;
use super::published::{self, FaultGeometry};
use super::severity::SoundTooth;
use super::{DamageDescription, Kind};
use crate::error::ScenarioError;
use crate::keys::{Check, Keys, Row};
use crate::wheel::Gears;
use crate::wheel::Teeth;

/// A tooth that is gone: it carries nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct MissingTooth;

impl Keys for MissingTooth {
    fn start() -> Self {
        Self
    }

    fn rows() -> Vec<Row<Self>> {
        Vec::new()
    }
}

impl Kind for MissingTooth {
    const NAME: &str = "missing-tooth";
    const EFFECT: MeshEffect = MeshEffect::Flat;
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

    fn damage(&self, tooth: &mut DamagedTooth, _: &HealthyTooth) -> Result<(), ScenarioError> {
        tooth.gone_from_index = 0;
        tooth.descriptions.push(DamageDescription::MissingTooth);
        Ok(())
    }

    fn published_geometry(&self, teeth: &Teeth, _seed: u64) -> Result<FaultGeometry, ScenarioError> {
        Ok(published::missing_tooth::geometry(teeth))
    }
}
