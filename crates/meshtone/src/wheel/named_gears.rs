//! What messages call two wheels that mesh, and where their keys stand in the scenario file.

use std::ops::Deref;

use super::{Gears, WheelName};

/// A pair of wheels with what messages call it.
pub(crate) struct NamedGears<'a> {
    gears: &'a Gears,
    names: PairNames<'a>,
}

/// Names of a pair of wheels, and the places of their keys.
pub(crate) enum PairNames<'a> {
    /// The pinion and the gear of `[gears]`.
    OnePair,
    /// The wheels of a gearbox's mesh.
    OfMesh {
        /// Key of the mesh's section, such as `mesh[1]`.
        section: String,
        /// Number and name of the driving and of the driven wheel.
        wheels: [(usize, &'a str); 2],
    },
}

impl<'a> NamedGears<'a> {
    /// Names a pair of wheels.
    ///
    /// # Arguments
    /// * `gears` - the wheels
    /// * `names` - of the wheels, and the places of their keys
    pub(crate) fn new(gears: &'a Gears, names: PairNames<'a>) -> Self {
        Self { gears, names }
    }

    /// The name of a wheel: `the pinion`, `z1`.
    pub(crate) fn name(&self, wheel: WheelName) -> String {
        match &self.names {
            PairNames::OnePair => format!("the {}", wheel.name()),
            PairNames::OfMesh { wheels, .. } => wheels[wheel as usize].1.to_owned(),
        }
    }

    /// A key of one of the wheels: `gears.pinion_teeth`, `wheel[0].teeth`.
    ///
    /// # Arguments
    /// * `wheel` - which
    /// * `key` - without the name of the wheel
    pub(crate) fn key_of(&self, wheel: WheelName, key: &str) -> String {
        match &self.names {
            PairNames::OnePair => format!("gears.{}_{key}", wheel.name()),
            PairNames::OfMesh { wheels, .. } => format!("wheel[{}].{key}", wheels[wheel as usize].0),
        }
    }

    /// A key that both wheels have in common: `gears.module_mm`, `mesh[0].module_mm`, `wheel[0].tip_chamfer_mm`.
    pub(crate) fn key(&self, key: &str) -> String {
        const OF_MESH: [&str; 4] = ["module_mm", "pressure_angle_deg", "centre_distance_mm", "backlash_mm"];
        match &self.names {
            PairNames::OnePair => format!("gears.{key}"),
            PairNames::OfMesh { section, .. } if OF_MESH.contains(&key) => format!("{section}.{key}"),
            PairNames::OfMesh { .. } => self.key_of(WheelName::Pinion, key),
        }
    }

    /// The key of the pair as a whole: `gears`, `mesh[0].wheels`.
    pub(crate) fn whole(&self) -> String {
        match &self.names {
            PairNames::OnePair => "gears".to_owned(),
            PairNames::OfMesh { section, .. } => format!("{section}.wheels"),
        }
    }
}

impl Deref for NamedGears<'_> {
    type Target = Gears;

    fn deref(&self) -> &Gears {
        self.gears
    }
}
