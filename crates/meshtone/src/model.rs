//! The model that is simulated.

/// The model of the mesh.
///
/// The published code differs from the theory of its own paper in several places (listed in the
/// chapter "Published, linear and contact" of the documentation).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[non_exhaustive]
pub enum Model {
    /// Teeth that push and never pull, on shafts that bend, in supports that a sensor sits on. The default.
    #[default]
    Contact,
    /// The theory of a linear mesh: flanks that are conjugate, loads that act at the flank's own angle, one angle for
    /// stiffness and deviations.
    Linear,
    /// The published code, its known errors included, so that results can be compared number by number.
    Published,
}

impl Model {
    /// All models, the default first.
    pub const ALL: [Self; 3] = [Self::Contact, Self::Linear, Self::Published];

    /// Whether the model is a machine around meshes; the published one is not.
    pub(crate) fn has_meshes(self) -> bool {
        self != Self::Published
    }

    /// Whether it simulates the default of a key whatever the scenario says.
    ///
    /// # Arguments
    /// * `key` - with its section
    pub(crate) fn ignores(self, key: &str) -> bool {
        let ignored = match self {
            Self::Contact => IGNORED_BY_CONTACT,
            Self::Linear => IGNORED_BY_LINEAR,
            Self::Published => IGNORED_BY_PUBLISHED,
        };
        ignored.contains(&key)
    }

    /// The name in the scenario file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Contact => "contact",
            Self::Linear => "linear",
            Self::Published => "published",
        }
    }
}

/// Keys that `contact` ignores, with their sections: its shafts bend instead of tilting on springs and have damping of their own, and it
/// has no relief that thins the tips.
const IGNORED_BY_CONTACT: &[&str] = &[
    "gears.tip_relief",
    "rig.wheel_rotational_stiffness_nm_per_rad",
    "rig.damping_ratio",
    "solver.initial_displacement",
];

/// Keys that `linear` ignores, with their sections: its flanks may pull, so that backlash and misalignment are out of reach, and its
/// supports are held.
const IGNORED_BY_LINEAR: &[&str] = &[
    "gears.tip_relief",
    "gears.backlash_mm",
    "quality.helix_share",
    "quality.pinion_helix_slope_um",
    "quality.gear_helix_slope_um",
    "rig.misalignment_um",
    "rig.support",
    "sensor.at",
];

/// Keys that the published model ignores, with their sections: their defaults are simulated.
const IGNORED_BY_PUBLISHED: &[&str] = &[
    "gears.tip_relief",
    "gears.flank_relief",
    "gears.tip_chamfer_mm",
    "gears.backlash_mm",
    "gears.foundation",
    "operation.speed_profile_hz",
    "quality.iso_class",
    "quality.tooth_share",
    "quality.pitch_share",
    "quality.run_out_share",
    "quality.helix_share",
    "quality.pinion_run_out_um",
    "quality.pinion_run_out_phase_rad",
    "quality.pinion_helix_slope_um",
    "quality.gear_run_out_um",
    "quality.gear_run_out_phase_rad",
    "quality.gear_helix_slope_um",
    "rig.bearing_stiffness_n_per_m",
    "rig.eccentricity_mm",
    "rig.misalignment_um",
    "rig.support",
    "rig.mesh_damping_ratio",
    "sensor.at",
];

/// Names of the models that ignore a key.
///
/// # Arguments
/// * `key` - with its section
pub(crate) fn models_ignoring(key: &str) -> Vec<&'static str> {
    let models = [Model::Linear, Model::Published, Model::Contact];
    models.into_iter().filter(|model| model.ignores(key)).map(Model::name).collect()
}
