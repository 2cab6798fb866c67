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
    /// The published code with its known errors, so that results can be compared number by number.
    Published,
}

impl Model {
    /// All models, the default first.
    pub const ALL: [Self; 3] = [Self::Contact, Self::Linear, Self::Published];

    /// Whether teeth part that are pulled, as real ones do; a linear mesh pulls.
    pub fn teeth_part(self) -> bool {
        self == Self::Contact
    }

    /// Whether the model is a machine around meshes, which starts in equilibrium, so that no more is simulated than settles; the
    /// published one is not, and simulates all from the start.
    pub fn has_meshes(self) -> bool {
        self != Self::Published
    }

    /// Whether it simulates the default of a key whatever the scenario says.
    ///
    /// # Arguments
    /// * `key` - with its section
    pub fn ignores(self, key: &str) -> bool {
        models_ignoring(key).contains(&self.name())
    }
}

/// Which models ignore which keys, these with their sections: their defaults are simulated.
///
/// The shafts of `contact` bend instead of tilting on springs, and have damping of their own. The flanks of `linear` may pull, so that
/// backlash and misalignment are out of reach, and its supports are held.
static IGNORED_KEYS: [(&[&str], &[&str]); 3] = [
    (
        &["contact"],
        &["rig.wheel_rotational_stiffness_nm_per_rad", "rig.damping_ratio", "solver.initial_displacement"],
    ),
    (
        &["linear", "published"],
        &[
            "gears.active_profile_shortening",
            "gears.backlash_mm",
            "gears.lead_crowning_um",
            "gears.end_relief",
            "quality.helix_share",
            "quality.pinion_helix_slope_um",
            "quality.gear_helix_slope_um",
            "rig.misalignment_um",
            "rig.support",
            "sensor.at",
            "sensor.path",
        ],
    ),
    (
        &["published"],
        &[
            "gears.pinion_material",
            "gears.gear_material",
            "gears.hand",
            "gears.slices",
            "gears.flank_relief",
            "gears.pinion_flank_relief",
            "gears.gear_flank_relief",
            "gears.tip_chamfer_mm",
            "gears.pinion_tip_chamfer_mm",
            "gears.gear_tip_chamfer_mm",
            "gears.foundation",
            "operation.speed_profile_hz",
            "operation.torque_ripple",
            "quality.iso_class",
            "quality.tooth_share",
            "quality.pitch_share",
            "quality.run_out_share",
            "quality.pinion_run_out_um",
            "quality.pinion_run_out_phase_rad",
            "quality.gear_run_out_um",
            "quality.gear_run_out_phase_rad",
            "rig.bearing_stiffness_n_per_m",
            "rig.eccentricity_mm",
            "rig.pinion_unbalance",
            "rig.gear_unbalance",
            "rig.mesh_damping_ratio",
        ],
    ),
];

/// Names of the models that ignore a key.
///
/// # Arguments
/// * `key` - with its section
pub(crate) fn models_ignoring(key: &str) -> &'static [&'static str] {
    IGNORED_KEYS.iter().find(|(_, keys)| keys.contains(&key)).map_or(&[][..], |(models, _)| *models)
}

/// A key that the published model alone takes: of the others, those that do not ignore it refuse it.
pub(crate) struct PublishedKey {
    /// With its section.
    pub(crate) key: &'static str,
    /// Says so, in the words of the documentation.
    pub(crate) words: &'static str,
    /// Why the others cannot heed it.
    pub(crate) why: &'static str,
}

/// These keys.
pub(crate) static PUBLISHED_KEYS: [PublishedKey; 3] = [
    PublishedKey {
        key: "rig.wheel_rotational_stiffness_nm_per_rad",
        words: "Accepted by published only; linear refuses it.",
        why: "the wheels tilt with their shafts, which bend between their bearings",
    },
    PublishedKey {
        key: "rig.damping_ratio",
        words: "Several values are accepted by published only; linear refuses them.",
        why: "the damping ratio is one for all modes",
    },
    PublishedKey {
        key: "solver.initial_displacement",
        words: "Accepted by published only; linear refuses it.",
        why: "the simulation starts in the static equilibrium of the loaded mesh",
    },
];
