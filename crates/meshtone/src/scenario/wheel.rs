//! A wheel of a scenario.

use std::ops::Bound::Included;

use meshtone_toml::{ReadResult, TomlTable};

use crate::error::ScenarioWarning;
use crate::keys::{KeyKind, Keys, NumberFiles, Range, documented, field, keys, load, read_keys};
use crate::machine::{Unbalance, WheelInertia};
use crate::wheel::quality::{file_deviations, ignored_shares};
use crate::wheel::rows::*;
use crate::wheel::{ErrorTable, FlankRelief, Material, WheelDeviations, WheelName};

use super::{OfSet, ScenarioMesh};

/// A wheel on a shaft: of a rig the pinion or the gear.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ScenarioWheel {
    /// Its name.
    pub name: String,
    /// Name of its shaft.
    pub shaft: String,
    /// (-) Where along the shaft, as a part of its length.
    pub at: f64,
    /// Tooth count.
    pub teeth: u32,
    /// (mm) Face width.
    pub face_width_mm: f64,
    /// (-) Profile shift coefficient, in modules. Default 0.
    pub profile_shift: f64,
    /// (-) Addendum coefficient of the basic rack. Default 1.
    pub addendum: f64,
    /// (-) Dedendum coefficient of the basic rack. Default 1.25.
    pub dedendum: f64,
    /// (mm) Height of the tips' chamfer; none for 0.23 modules.
    pub tip_chamfer_mm: Option<f64>,
    /// (base pitches) By how much the path of contact is shorter than the tips between their chamfers make it, half of it at the end where this
    /// wheel's tips touch, half at the other one, where its mate's tips touch by the mate's. Default 0.1.
    pub active_profile_shortening: f64,
    /// (mm) Constant reduction of the working flank. Default 0.
    pub uniform_flank_reduction_mm: f64,
    /// Relief of the flank near the tip, as a gap. Default none.
    pub flank_relief: FlankRelief,
    /// Material; none for the scenario's.
    pub material: Option<Material>,
    /// Mass and inertias, instead of those of a solid disc.
    pub inertia: WheelInertia,
    /// Unbalance. Default none.
    pub unbalance: Unbalance,
    /// (mm) Eccentricity of its seat, beside its run-out. Default 0.
    pub eccentricity_mm: f64,
    /// Grade of DIN 3961 of its deviations, 1 (best) to 12; 0 for ideal teeth. Default 0.
    pub din_grade: u8,
    /// Class of ISO 1328-1:2013 instead, 1 (best) to 11; 0 for none. Default 0.
    pub iso_class: u8,
    /// (-) Part of the tolerances of slope and form that a tooth has of its own; the rest all teeth of a wheel have in common. Default 0.75,
    /// in a rig 0.5.
    pub tooth_share: f64,
    /// (-) Largest single pitch deviation as a part of its tolerance. Default 0.5, in a rig 0.25.
    pub pitch_share: f64,
    /// (-) Run-out as a part of its tolerance. Default 0.6, in a rig 0.3.
    pub run_out_share: f64,
    /// (-) Profile slope that varies once a revolution, as a part of the wheel's profile deviation. Default 1, in a rig 0.
    pub slope_wobble: f64,
    /// (-) Largest helix slope deviation as a part of its tolerance. Default 0.
    pub helix_share: f64,
    /// (µm) Amplitude of a helix slope over its face width that turns with it, as of a wheel that wobbles. Default 0.
    pub helix_wobble_um: f64,
    /// (mm) Profile errors of its teeth that are given instead of drawn: 100 rows of one number a tooth, in the order in which a tooth
    /// passes through contact in the wheel's first mesh; flanks that work in another sense have none.
    pub profile_errors_mm: Option<ErrorTable>,
    /// Deviations that are given instead of drawn.
    pub deviations: WheelDeviations,
    /// Which wheel of a planetary set it is; none of a wheel with a section of its own.
    pub of_set: Option<OfSet>,
}

impl ScenarioWheel {
    /// A wheel with the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(name: &str, shaft: &str, at: f64, teeth: u32, face_width_mm: f64) -> Self {
        Self { name: name.to_owned(), shaft: shaft.to_owned(), at, teeth, face_width_mm, ..Self::start() }
    }

    /// Reads a wheel.
    ///
    /// # Arguments
    /// * `table` - its section
    /// * `meshes` - the first in which it is tells whether it is a file's pinion or its gear
    /// * `files` - loads the file that it names
    pub(super) fn read(
        table: &TomlTable<'_>,
        meshes: &[ScenarioMesh],
        files: &dyn NumberFiles,
    ) -> ReadResult<Self> {
        let mut wheel = Self::start();
        if let Some(file) = table.optional("errors_file") {
            if table.optional("profile_errors_mm").is_some() {
                let problem = "given beside profile_errors_mm; profile errors have only one source";
                return Err(table.error("errors_file", problem).with_help("remove one of the two"));
            }
            let name = table.optional("name").map(|name| name.string().map(str::to_owned)).transpose()?;
            let drives = |mesh: &ScenarioMesh| mesh.wheels.iter().position(|of| Some(of) == name.as_ref());
            let side = WheelName::BOTH[meshes.iter().find_map(drives).unwrap_or(0)];
            let own = |key: &'static str| key.strip_prefix(side.name())?.strip_prefix('_');
            let [pinion, gear] = load(&file, |name| files.matrices(name))?;
            wheel.profile_errors_mm = Some(side.choose(pinion, gear));
            let [pinion, gear] = file_deviations(table, &file, files, own)?;
            wheel.deviations = side.choose(pinion, gear);
        }
        read_keys(&mut wheel, table, files).map(|()| wheel)
    }

    /// Shares of what is given and so not drawn, which have no effect.
    ///
    /// # Arguments
    /// * `section` - of its keys
    pub(super) fn ignored_shares(&self, section: &str) -> Vec<ScenarioWarning> {
        let (default, given) = (Self::start(), &self.deviations);
        let shares = [
            ("tooth_share", self.tooth_share != default.tooth_share, false),
            ("pitch_share", self.pitch_share != default.pitch_share, given.cumulative_pitch_um.is_some()),
            ("run_out_share", self.run_out_share != default.run_out_share, given.run_out_um.is_some()),
            ("slope_wobble", self.slope_wobble != default.slope_wobble, false),
            ("helix_share", self.helix_share != default.helix_share, given.helix_slope_um.is_some()),
        ];
        ignored_shares(section, self.profile_errors_mm.is_some(), &shares)
    }
}

/// (-) A place along a shaft.
const ALONG: Range = Range::between(Included(0.0), Included(1.0))
    .message("must be from 0 to 1, the part of the shaft's length from its beginning");

const SHARE: Range = Range::from_to(0.0, 1.0);
/// (-) Largest slope that varies once a revolution, over the rms deviation of the profiles.
pub(crate) const MOST_WOBBLE: f64 = 3.0;

keys! {
    "wheel": ScenarioWheel = Self {
        name: String::new(),
        shaft: String::new(),
        at: f64::NAN,
        teeth: 0,
        face_width_mm: f64::NAN,
        profile_shift: 0.0,
        addendum: 1.0,
        dedendum: 1.25,
        tip_chamfer_mm: None,
        active_profile_shortening: 0.1,
        uniform_flank_reduction_mm: 0.0,
        flank_relief: FlankRelief::default(),
        material: None,
        inertia: WheelInertia::default(),
        unbalance: Unbalance::default(),
        eccentricity_mm: 0.0,
        din_grade: 0,
        iso_class: 0,
        tooth_share: 0.75,
        pitch_share: 0.5,
        run_out_share: 0.6,
        slope_wobble: 1.0,
        helix_share: 0.0,
        helix_wobble_um: 0.0,
        profile_errors_mm: None,
        deviations: WheelDeviations::default(),
        of_set: None,
    };
    name "" "the wheel's name" .required().rule("no other wheel's");
    shaft "" "the name of its shaft" .required();
    at "-" "the position along the shaft, as a fraction of its length from its beginning"
        .required().range(ALONG).rule("within half a face width of its mating wheels");
    = { teeth_row("teeth", field!(teeth)) };
    = { face_width_row("the face width; a mesh has what both faces have in common", field!(face_width_mm))
        .rule("on its shaft, clear of other wheels") };
    = { profile_shift_row("profile_shift", field!(profile_shift)) };
    = { addendum_row("addendum", field!(addendum)) };
    = { dedendum_row("dedendum", field!(dedendum)) };
    = { chamfer_row(field!(tip_chamfer_mm)) };
    = { shortening_row(field!(active_profile_shortening)) };
    = { flank_reduction_row(field!(uniform_flank_reduction_mm)) };
    flank_relief "" "the relief of the flanks near the tips, as a gap in µm";
    material "" "its material" .otherwise("that of the gearbox").alternative("\"steel\"");
    inertia "" "its mass and inertias, any of the three"
        .otherwise("those of a solid disc of pitch radius")
        .alternative("{ mass_kg = 0.24, polar_inertia_kgm2 = 7.8e-5, transverse_inertia_kgm2 = 4.4e-5 }");
    unbalance "" "its unbalance" .otherwise("none").alternative("{ g_mm = 50.0 }");
    eccentricity_mm "mm" "the eccentricity of its seat"
        .range(Range::not_negative()).rule("less than the module; of a wheel in one mesh");
    = { din_grade_row("the grade of DIN 3961 of the deviations, 1 (best) to 12; 0: ideal teeth", field!(din_grade)) };
    = { iso_class_row(field!(iso_class)) };
    tooth_share "-"
        "the part of the tolerances of profile slope and form that each tooth has of its own; the rest is common to a wheel's teeth"
        .range(SHARE);
    pitch_share "-" "a wheel's largest single pitch deviation over its tolerance f_p" .range(SHARE);
    run_out_share "-" "a wheel's run-out over its tolerance F_r" .range(SHARE);
    slope_wobble "-" "the profile slope that varies once a revolution, over the rms deviation of the wheel's profiles"
        .range(Range::from_to(0.0, MOST_WOBBLE));
    helix_share "-" "a wheel's largest helix slope deviation, of either sign, over its tolerance f_Hβ"
        .range(SHARE);
    helix_wobble_um "µm" "the amplitude of a helix slope over its face width that turns with it, as of a wheel that wobbles"
        .range(Range::from_to(0.0, 1e3));
    = { documented(
        "errors_file",
        "an .npz with its deviations, as `meshtone wheels` writes it: the pinion's of a wheel that drives in its first mesh, the \
         gear's of one that is driven there",
        KeyKind::File,
    )
    .otherwise("none")
    .alternative("\"wheels.npz\"") };
    profile_errors_mm "mm"
        "its profile errors, instead of a draw: 100 rows of one number a tooth, in the order of contact in its first mesh"
        .otherwise("none")
        .rule("100 × teeth, each below the module; not beside errors_file, din_grade, iso_class")
        .alternative("[ 100 rows of one number a tooth ]");
    (deviations) cumulative_pitch_um "µm"
        "the working flanks' cumulative pitch deviations along the pitch circle, positive where metal is added"
        .otherwise("drawn").rule("one a tooth, each below the module").alternative("[ one number a tooth ]");
    (deviations) run_out_um "µm" "the run-out F_r, of which the deviation is F_r/2 sin(θ + φ)"
        .otherwise("drawn").range(Range::not_negative().implausible_above(1e4)).alternative("0.0");
    (deviations) run_out_phase_rad "rad"
        "its phase φ; θ counts from where the wheel's first tooth enters contact"
        .otherwise("drawn").alternative("0.0");
    (deviations) helix_slope_um "µm"
        "the helix slope deviation over the face width, positive where metal is added towards positive z"
        .otherwise("drawn by `helix_share`, or none").range(Range::from_to(-1e3, 1e3)).alternative("0.0");
}
