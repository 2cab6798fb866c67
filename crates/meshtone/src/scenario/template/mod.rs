//! Commented scenario files to start from.

use super::FoundationCoefficients;

/// The names that [`template`] knows: a healthy pair, and each kind of fault.
pub const TEMPLATE_KINDS: [&str; 6] =
    ["healthy", "missing-tooth", "tooth-breakage", "partial-face", "through-face", "tooth-destruction"];

/// A commented scenario file: every key with its unit, meaning and default.
///
/// What follows `# ` is a comment. What follows `#` directly is a key that may be left out: take the
/// `#` away to set it.
///
/// # Arguments
/// * `kind` - one of [`TEMPLATE_KINDS`]
///
/// # Returns
/// The file's text; none for another kind.
///
/// ```
/// use meshtone::scenario::{Scenario, template};
///
/// let scenario = Scenario::from_toml(&template("through-face").unwrap())?;
/// assert_eq!(scenario.fault.unwrap().kind(), "through-face");
/// assert_eq!(template("wear"), None);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn template(kind: &str) -> Option<String> {
    let (fault, machine) = match kind {
        "healthy" => (include_str!("fault_healthy.toml"), &BREAKAGE_RIG),
        "missing-tooth" => (include_str!("fault_missing_tooth.toml"), &BREAKAGE_RIG),
        "tooth-breakage" => (include_str!("fault_tooth_breakage.toml"), &BREAKAGE_RIG),
        "partial-face" => {
            (concat!(include_str!("fault_partial_face.toml"), include_str!("fault_pit.toml")), &BREAKAGE_RIG)
        }
        "through-face" => {
            (concat!(include_str!("fault_through_face.toml"), include_str!("fault_pit.toml")), &BREAKAGE_RIG)
        }
        "tooth-destruction" => (include_str!("fault_tooth_destruction.toml"), &DESTRUCTION_RIG),
        _ => return None,
    };
    let sections =
        [machine.fill(include_str!("machine.toml")), fault.into(), include_str!("rig.toml").into()];
    Some(sections.join("\n"))
}

/// What differs between the machines of the two kinds of experiment.
struct Machine {
    pinion_teeth: u32,
    gear_teeth: u32,
    face_width_mm: f64,
    pinion_speed_hz: f64,
    brake_torque_nm: f64,
    din_grade: u8,
}

const BREAKAGE_RIG: Machine = Machine {
    pinion_teeth: 17,
    gear_teeth: 38,
    face_width_mm: 15.0,
    pinion_speed_hz: 40.0,
    brake_torque_nm: 10.0,
    din_grade: 7,
};

const DESTRUCTION_RIG: Machine = Machine {
    pinion_teeth: 18,
    gear_teeth: 35,
    face_width_mm: 30.0,
    pinion_speed_hz: 45.0,
    brake_torque_nm: 15.0,
    din_grade: 8,
};

impl Machine {
    fn fill(&self, text: &str) -> String {
        let foundation = FoundationCoefficients::default();
        [
            ("{pinion_teeth}", self.pinion_teeth.to_string()),
            ("{gear_teeth}", self.gear_teeth.to_string()),
            ("{face_width_mm}", format!("{:?}", self.face_width_mm)),
            ("{pinion_speed_hz}", format!("{:?}", self.pinion_speed_hz)),
            ("{brake_torque_nm}", format!("{:?}", self.brake_torque_nm)),
            ("{din_grade}", self.din_grade.to_string()),
            ("{L}", format!("{:?}", foundation.l)),
            ("{M}", format!("{:?}", foundation.m)),
            ("{P}", format!("{:?}", foundation.p)),
            ("{Q}", format!("{:?}", foundation.q)),
        ]
        .iter()
        .fold(text.to_string(), |text, (name, value)| text.replace(name, value))
    }
}
