//! Commented gearboxes to start from.

use super::planetary_template::{LABORATORY, wind_turbine};
use super::template::{Commented, HEAD_OF_ALL_KEYS};
use super::{Scenario, ScenarioError};

/// A public rig of which what is published can be printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum GearboxRig {
    /// The spur gearbox of the PHM Society's data challenge of 2009.
    Phm2009Spur,
    /// Its helical gearbox.
    Phm2009Helical,
    /// The two-stage gearbox of the University of Connecticut's gear data.
    Uconn,
    /// The two-stage gearbox of Tecnalia's data of 2025.
    Tecnalia,
    /// The wind turbine's gearbox of the NREL Gearbox Reliability Collaborative: a planetary set and two stages.
    NrelGrc,
    /// A planetary set as laboratories have it.
    PlanetaryLab,
    /// The two-stage gearbox of OEDI's submission 623.
    Oedi623,
}

// By their names on the command line.
meshtone_toml::named!(GearboxRig {
    Phm2009Spur = "phm2009-spur",
    Phm2009Helical = "phm2009-helical",
    Uconn = "uconn",
    Tecnalia = "tecnalia",
    NrelGrc = "nrel-grc",
    PlanetaryLab = "planetary-lab",
    Oedi623 = "oedi-623",
});

impl GearboxRig {
    /// The file of a rig with planetary sets, or what its two stages differ in.
    fn data(self) -> Result<RigData, String> {
        Ok(match self {
            Self::NrelGrc => return Err(wind_turbine()),
            Self::PlanetaryLab => return Err(LABORATORY.to_owned()),
            Self::Phm2009Spur => RigData {
                head: "\
# The spur gearbox of the PHM Society's data challenge of 2009.
# Published: 32/96 and 48/80 teeth, bearings MB ER-10K, input speeds of 30 to 50 rev/s, two loads,
# 66 666.67 samples a second, a tachometer of 10 pulses per revolution of the input.
# Assumed, and marked so: everything else.
",
                teeth: [32, 96, 48, 80],
                journal_radius_mm: Some(7.9375),
                sampling_rate_hz: 66_666.67,
                fault: CHALLENGE_FAULT,
                ..EXAMPLE
            },
            Self::Phm2009Helical => RigData {
                head: "\
# The helical gearbox of the PHM Society's data challenge of 2009.
# Published: 16/48 and 24/40 teeth, bearings MB ER-10K, input speeds of 30 to 50 rev/s, two loads,
# 66 666.67 samples a second, a tachometer of 10 pulses per revolution of the input.
# Assumed, and marked so: everything else. Tooth sums half those of the spur gearbox suggest the same
# centre distance, 101.6 mm: a transverse diametral pitch of 8, and with a helix angle of 20° a normal
# module of 25.4/8 cos 20° mm. Both wheels on the middle shaft have the same hand, so that their thrusts oppose.
",
                teeth: [16, 48, 24, 40],
                module_mm: 2.983_524_070_995_259,
                helix_angle_deg: 20.0,
                face_width_mm: 25.4,
                shaft_radii_mm: [18.0, 22.0, 22.0],
                journal_radius_mm: Some(7.9375),
                // At 30 rev/s three times the first mesh frequency meets a natural frequency of the assumed structure.
                input_speed_hz: 35.0,
                sampling_rate_hz: 66_666.67,
                fault: CHALLENGE_FAULT,
                ..EXAMPLE
            },
            Self::Uconn => RigData {
                head: "\
# The two-stage gearbox of the University of Connecticut's gear fault data.
# Published: 32/80 and 48/64 teeth, 20 000 samples a second, a tachometer on the input shaft, faults on
# the pinion of 32 teeth. It is simulated at 100 000 samples a second: at fewer the step changes its vibration.
# Assumed, and marked so: everything else, the input's speed included.
",
                teeth: [32, 80, 48, 64],
                fault: "\
# Its faults are on the pinion of 32 teeth: a missing tooth, a cracked root, spalls, chipped tips.
#
# [[fault]]
# wheel = \"z1\"
# kind = \"missing-tooth\"
",
                ..EXAMPLE
            },
            Self::Tecnalia => RigData {
                head: "\
# The two-stage gearbox of Tecnalia's data of 2025.
# Published: 29/100 and 36/90 teeth, bearings MB ER-16K, a broken tooth on the wheel of 36, 20 480 samples
# a second, two encoders, torque, eight accelerometers. It is simulated at 100 000: at fewer the step changes its vibration.
# Assumed, and marked so: everything else, the input's speed and the load included.
",
                teeth: [29, 100, 36, 90],
                module_mm: 1.5,
                face_width_mm: 15.0,
                shaft_radii_mm: [18.0; 3],
                journal_radius_mm: Some(12.7),
                fault: "\
# Its fault is a broken tooth on the wheel of 36 teeth. In this machine it hardly shows beside the faster mesh on the same shaft:
#
# [[fault]]
# wheel = \"z3\"
# kind = \"tooth-breakage\"
# severity = 0.6
",
                ..EXAMPLE
            },
            Self::Oedi623 => RigData {
                head: "\
# The two-stage gearbox of OEDI's submission 623 (National Renewable Energy Laboratory, SpectraQuest), the set `oedi-623` of `meshtone bench`.
# Published: a healthy and a broken tooth, loads of 0 to 90 %, 30 Hz, four sensors.
# Inferred from the lines of its recordings: 32/80 and 48/64 teeth, the input's speed, 12 800 samples a second.
# It is simulated at 100 000: at fewer the step changes its vibration.
# Assumed, and marked so: everything else, the load and the sensors' places included; the variation of the torque fits the sidebands.
",
                teeth: [32, 80, 48, 64],
                iso_class: 4,
                input_speed_hz: 29.75,
                ripple: [0.8, 0.4],
                fault: "\
# Which tooth of which wheel is broken is not published. Of the first one:
#
# [[fault]]
# wheel = \"z1\"
# kind = \"tooth-breakage\"
# severity = 0.6
",
                ..EXAMPLE
            },
        })
    }
}

/// What tells one rig's file from another's.
struct RigData {
    head: &'static str,
    teeth: [u32; 4],
    module_mm: f64,
    /// (°) 0 of spur wheels.
    helix_angle_deg: f64,
    face_width_mm: f64,
    iso_class: u32,
    /// Of the input, the middle and the output shaft.
    shaft_radii_mm: [f64; 3],
    /// Of both ends of each shaft, where a published bearing fits; none for one radius.
    journal_radius_mm: Option<f64>,
    input_speed_hz: f64,
    /// (of the mean) How far the torque varies three times a revolution of the input, and once of the middle shaft.
    ripple: [f64; 2],
    sampling_rate_hz: f64,
    fault: &'static str,
}

const EXAMPLE: RigData = RigData {
    head: EXAMPLE_HEAD,
    teeth: [32, 96, 48, 80],
    module_mm: 1.5875,
    helix_angle_deg: 0.0,
    face_width_mm: 19.05,
    iso_class: 5,
    shaft_radii_mm: [20.0; 3],
    journal_radius_mm: None,
    input_speed_hz: 30.0,
    ripple: [0.3, 0.2],
    sampling_rate_hz: 100_000.0,
    fault: EXAMPLE_FAULT,
};

const CHALLENGE_FAULT: &str = "\
# Faults of the challenge are listed by label only. A broken tooth of the first stage:
#
# [[fault]]
# wheel = \"z1\"
# kind = \"tooth-breakage\"
# severity = 1.0
";

const EXAMPLE_HEAD: &str = "\
# A Meshtone gearbox: two stages of spur gears on three shafts, in a housing on four feet.
# Text after \"# \" is a comment. The guide's chapter on gearboxes has every key; keys that are left
# out here have their defaults.
";

const EXAMPLE_FAULT: &str = "\
# Damage is listed as in a scenario of one pair; wheel is the wheel's name.
#
# [[fault]]
# wheel = \"z1\"
# tooth = 1
# kind = \"tooth-breakage\"
# severity = 0.8
";

/// A commented two-stage gearbox, or what is published of a rig.
///
/// # Arguments
/// * `rig` - which; none for the example
///
/// ```
/// use meshtone::scenario::{Scenario, GearboxRig, gearbox_template};
///
/// for rig in GearboxRig::ALL {
///     assert!(Scenario::from_toml(&gearbox_template(Some(rig)))?.shafts().len() >= 2);
/// }
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn gearbox_template(rig: Option<GearboxRig>) -> String {
    let RigData {
        head,
        teeth: [z1, z2, z3, z4],
        module_mm,
        helix_angle_deg,
        face_width_mm,
        iso_class,
        shaft_radii_mm,
        journal_radius_mm,
        input_speed_hz,
        ripple: [of_input, of_middle],
        sampling_rate_hz,
        fault,
    } = match rig.map_or(Ok(EXAMPLE), GearboxRig::data) {
        Ok(two_stages) => two_stages,
        Err(planetary) => return planetary,
    };
    let assumed = if rig.is_some() { "  # assumed" } else { "" };
    let wheel = |name: &str, shaft: &str, at: f64, teeth: u32| {
        format!(
            "[[wheel]]\nname = \"{name}\"\nshaft = \"{shaft}\"\nat = {at:?}{assumed}\nteeth = {teeth}\n\
             face_width_mm = {face_width_mm:?}{assumed}\niso_class = {iso_class}{assumed}\n"
        )
    };
    let shaft = |name: &str, radius_mm: f64, comment: &str, coupled: &str| {
        let outline = match journal_radius_mm {
            Some(journal_mm) => {
                format!(
                    "# The length and the radius of its pieces.\nsegments = [[15.0, {journal_mm:?}], [210.0, {radius_mm:?}], [15.0, {journal_mm:?}]]"
                )
            }
            None => format!("radius_mm = {radius_mm:?}"),
        };
        format!(
            "# {comment}\n[[shaft]]\nname = \"{name}\"\nlength_mm = 240.0{assumed}\n{outline}{assumed}\n{coupled}"
        )
    };
    let mesh = |wheels: [&str; 2], hand: &str| {
        let helix = if helix_angle_deg == 0.0 {
            String::new()
        } else {
            // Helical teeth are quiet: with the default force nothing but that would be heard, and lines of recorded boxes have half of the power.
            format!(
                "helix_angle_deg = {helix_angle_deg:?}{assumed}\nhand = \"{hand}\"{assumed}\nrandom_force = 0.005{assumed}\n"
            )
        };
        format!(
            "[[mesh]]\nwheels = [\"{}\", \"{}\"]\nmodule_mm = {module_mm:?}{assumed}\n\
             pressure_angle_deg = 20.0{assumed}\n{helix}",
            wheels[0], wheels[1]
        )
    };
    let bearings: String = ["input", "middle", "output"]
        .iter()
        .flat_map(|shaft| ["0.0", "1.0"].map(|at| format!("[[bearing]]\nshaft = \"{shaft}\"\nat = {at}\n")))
        .collect();
    [
        head.to_owned(),
        "seed = 1\nmaterial = \"steel\"\n".to_owned(),
        format!(
            "# Shafts run along z, from 0 to their length. Without position_mm they stand side by side.\n{}",
            shaft("input", shaft_radii_mm[0], "The input shaft, which the motor drives.", "couples_to = \"motor\"\n")
        ),
        shaft("middle", shaft_radii_mm[1], "The middle shaft, with the driven wheel of the first stage and the driving wheel of the second.", ""),
        shaft("output", shaft_radii_mm[2], "The output shaft, which the brake loads.", "couples_to = \"brake\"\n"),
        format!("# at is the place along the shaft, as a part of its length.\n{}", wheel("z1", "input", 0.25, z1)),
        wheel("z2", "middle", 0.25, z2),
        wheel("z3", "middle", 0.75, z3),
        wheel("z4", "output", 0.75, z4),
        format!("# The first wheel of a mesh drives.\n{}", mesh(["z1", "z2"], "right")),
        mesh(["z3", "z4"], "left"),
        format!(
            "# Stiffnesses of bearings, seats, housing and couplings are at their defaults{}.\n{bearings}",
            if rig.is_some() { ", which are assumed, as their places are" } else { "" }
        ),
        format!("[housing]\nmass_kg = 30.0{assumed}\n"),
        format!(
            "[operation]\ninput_speed_hz = {input_speed_hz:?}{}\nbrake_torque_nm = 60.0{assumed}\n\
             # The torque varies as a coupling of three jaws makes it at the input, and with the middle shaft.\n\
             torque_ripple = [{{ shaft = \"input\", order = 3.0, amplitude = {of_input:?} }}, {{ shaft = \"middle\", order = 1.0, amplitude = {of_middle:?} }}]{assumed}\n\
             # The speed wanders slowly, as that of an induction motor does.\nspeed_wander_percent = 0.03{assumed}\n",
            if matches!(rig, Some(GearboxRig::Uconn | GearboxRig::Tecnalia)) { assumed } else { "" }
        ),
        fault.to_owned(),
        format!(
            "# Without [[sensor]] a vertical one sits on every bearing's seat.\n[[sensor]]\nat = \"input:0\"{assumed}\n\n[[sensor]]\nat = \"output:1\"{assumed}\n\n\
             [solver]\nsampling_rate_hz = {sampling_rate_hz:?}\nduration_s = 1.0\n"
        ),
    ]
    .join("\n")
}

/// The same gearbox as a file with every key, its unit, meaning and default, as of a scenario of one pair.
///
/// # Arguments
/// * `rig` - as of [`gearbox_template`]
///
/// # Errors
/// None, unless this version's own template cannot be read.
///
/// ```
/// use meshtone::scenario::{Scenario, gearbox_template, gearbox_template_of_all_keys};
///
/// let all = gearbox_template_of_all_keys(None)?;
/// assert!(all.contains("#highest_mode_hz") || all.contains("# highest_mode_hz"));
/// assert_eq!(Scenario::from_toml(&all)?, Scenario::from_toml(&gearbox_template(None))?);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn gearbox_template_of_all_keys(rig: Option<GearboxRig>) -> Result<String, ScenarioError> {
    let gearbox = Scenario::from_toml(&gearbox_template(rig))?;
    let all = gearbox.structure.shafts().map(|shafts| gearbox.in_long_sections(shafts, &Commented));
    Ok(format!("{HEAD_OF_ALL_KEYS}\n{}", all.unwrap_or_default()))
}
