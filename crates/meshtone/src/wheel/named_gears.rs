//! What messages call two wheels that mesh, and where their keys stand in the scenario file.

use std::ops::Deref;

use super::{Gears, WheelName};

/// A pair of wheels with what messages call it.
pub(crate) struct NamedGears<'a> {
    gears: &'a Gears,
    /// Of a gearbox's mesh: the key of its section, and the driving and the driven wheel.
    mesh: Option<(String, [NamedWheel<'a>; 2])>,
}

/// What a wheel of a gearbox is called, and where its keys stand.
pub(crate) struct NamedWheel<'a> {
    /// Its name.
    pub(crate) name: &'a str,
    /// Key of its section, such as `wheel[1]`, or that of its planetary set.
    pub(crate) section: String,
    /// Which wheel of a planetary set it is: `sun`, `planet`, `ring`.
    pub(crate) member: Option<&'static str>,
}

/// Keys of which each wheel of a planetary set has its own.
const OF_MEMBER: [&str; 2] = ["teeth", "profile_shift"];

impl<'a> NamedGears<'a> {
    /// The pinion and the gear of `[gears]`.
    pub(crate) fn of_pair(gears: &'a Gears) -> Self {
        Self { gears, mesh: None }
    }

    /// The wheels of a gearbox's mesh.
    ///
    /// # Arguments
    /// * `gears` - the wheels
    /// * `section` - key of the mesh's section, such as `mesh[1]`
    /// * `wheels` - the driving and the driven wheel
    pub(crate) fn of_mesh(gears: &'a Gears, section: String, wheels: [NamedWheel<'a>; 2]) -> Self {
        Self { gears, mesh: Some((section, wheels)) }
    }

    /// The name of a wheel: `the pinion`, `z1`.
    pub(crate) fn name(&self, wheel: WheelName) -> String {
        match &self.mesh {
            None => format!("the {}", wheel.name()),
            Some((_, wheels)) => wheels[wheel as usize].name.to_owned(),
        }
    }

    /// A key of one of the wheels: `gears.pinion_teeth`, `wheel[0].teeth`.
    ///
    /// # Arguments
    /// * `wheel` - which
    /// * `key` - without the name of the wheel
    pub(crate) fn key_of(&self, wheel: WheelName, key: &str) -> String {
        match &self.mesh {
            None => format!("gears.{}_{key}", wheel.name()),
            Some((_, wheels)) => match &wheels[wheel as usize] {
                NamedWheel { section, member: Some(member), .. } if OF_MEMBER.contains(&key) => {
                    format!("{section}.{key}.{member}")
                }
                NamedWheel { section, .. } => format!("{section}.{key}"),
            },
        }
    }

    /// A key of one of the wheels that `[gears]` has of both while they are alike: `gears.tip_chamfer_mm`,
    /// `gears.pinion_tip_chamfer_mm`, `wheel[0].tip_chamfer_mm`.
    ///
    /// # Arguments
    /// * `wheel`, `key` - as of [`Self::key_of`]
    /// * `of_each` - what both wheels have at the key
    pub(crate) fn key_of_each<V: PartialEq>(&self, wheel: WheelName, key: &str, [a, b]: &[V; 2]) -> String {
        if self.mesh.is_none() && a == b { self.key(key) } else { self.key_of(wheel, key) }
    }

    /// A key that both wheels have in common: `gears.module_mm`, `mesh[0].module_mm`, `wheel[0].active_profile_shortening`.
    pub(crate) fn key(&self, key: &str) -> String {
        const OF_MESH: [&str; 8] = [
            "module_mm",
            "pressure_angle_deg",
            "helix_angle_deg",
            "centre_distance_mm",
            "backlash_mm",
            "end_relief.length_mm",
            "hand",
            "slices",
        ];
        match &self.mesh {
            None => format!("gears.{key}"),
            Some((section, _)) if OF_MESH.contains(&key) => format!("{section}.{key}"),
            Some(_) => self.key_of(WheelName::Pinion, key),
        }
    }

    /// The keys that shorten the path of contact, as far as they do: that of the larger chamfer, and that of the active profiles.
    pub(crate) fn shorteners(&self) -> Vec<String> {
        let [pinion_mm, gear_mm] = WheelName::BOTH.map(|wheel| self.chamfer_mm(wheel));
        let larger = if pinion_mm < gear_mm { WheelName::Gear } else { WheelName::Pinion };
        let chamfer = (pinion_mm.max(gear_mm) > 0.0)
            .then(|| self.key_of_each(larger, "tip_chamfer_mm", &self.tip_chamfer_mm));
        let is_shortened = self.active_profile_shortening.iter().any(|shortening| *shortening > 0.0);
        chamfer.into_iter().chain(is_shortened.then(|| self.key("active_profile_shortening"))).collect()
    }

    /// The key of the pair as a whole: `gears`, `mesh[0].wheels`.
    pub(crate) fn whole(&self) -> String {
        match &self.mesh {
            None => "gears".to_owned(),
            Some((section, [NamedWheel { member: Some(_), .. }, _])) => format!("{section}.teeth"),
            Some((section, _)) => format!("{section}.wheels"),
        }
    }

    /// The key that says what the mesh carries, `operation.brake_torque_nm` or `mesh[0].wheels`, and the keys that make the flanks close
    /// unevenly along the face.
    pub(crate) fn load(&self) -> (String, String) {
        match &self.mesh {
            None => {
                let uneven = "rig.misalignment_um, quality.helix_share and given helix slopes of [quality]";
                ("operation.brake_torque_nm".to_owned(), uneven.to_owned())
            }
            Some((section, _)) => {
                let slopes = WheelName::BOTH.map(|wheel| self.key_of(wheel, "helix_slope_um"));
                let uneven = format!(
                    "{section}.misalignment_um, {} and helix_share of both wheels",
                    slopes.join(", ")
                );
                (self.whole(), uneven)
            }
        }
    }

    /// The key that makes the wheels' bodies too soft, and what the user can do: `gears.foundation`, `mesh[0].wheels`.
    pub(crate) fn foundation(&self) -> (String, &'static str) {
        match &self.mesh {
            None => (self.key("foundation"), "leave it out, or state rotation = \"tooth\" beside P"),
            Some(_) => (
                self.whole(),
                "change wheel.teeth, or shaft.radius_mm where the wheels sit, or leave mesh.foundation out",
            ),
        }
    }
}

impl Deref for NamedGears<'_> {
    type Target = Gears;

    fn deref(&self) -> &Gears {
        self.gears
    }
}
