//! Commented scenario files to start from.

use super::to_toml::Style;
use super::{Fault, GearPair, Scenario, Sensor};
use crate::damage::{PaperRig, damage_kinds};
use crate::keys::{KeyRow, Keys, comment, commented, commented_rows, essential_rows};

const HEALTHY: &str = "healthy";
const HELICAL: &str = "helical";

const HEAD: &str = "\
# A Meshtone scenario: a pair of gears, its operation, and its damage.
# The pinion, on the motor's shaft, drives the gear, on the brake's shaft.
";

pub(super) const HEAD_OF_ALL_KEYS: &str = "\
# Text after \"# \" is a comment. A key directly after \"#\" is optional: remove the \"#\" to set it.
";

const WITHOUT_SENSORS: &str = "\
# Sensors of a rig may be listed, each as a section [[sensor]]: their signals then come first. All
# its keys may be left out.
#
# [[sensor]]
";

const WITHOUT_FAULTS: &str = "\
# Damage may be listed, each as a section [[fault]], on any tooth of either wheel: `meshtone init KIND`
# prints every key of a kind. Every kind but a missing tooth accepts a severity from 0 to 1 instead
# of its sizes.
#
# [[fault]]
";

/// The names that [`template`] knows: a healthy pair of spur gears, one of helical gears, and each kind of damage.
pub fn template_kinds() -> Vec<&'static str> {
    [HEALTHY, HELICAL].into_iter().chain(damage_kinds().into_iter().map(|kind| kind.name)).collect()
}

/// A scenario file to start from: the keys that matter, each with its meaning. All others have their defaults.
///
/// # Arguments
/// * `kind` - one of [`template_kinds`]
///
/// # Returns
/// The file's text; none for another kind.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario, template};
///
/// let scenario = Scenario::from_toml(&template("through-face").unwrap())?;
/// assert_eq!(scenario.faults[0].damage.kind(), "through-face");
/// assert_eq!(template("rust"), None);
/// # Ok::<(), meshtone::scenario::ScenarioError>(())
/// ```
pub fn template(kind: &str) -> Option<String> {
    let text = scenario_of_kind(kind)?.in_sections(&Essential);
    let all = format!("# Every other key has its default: `meshtone init {kind} --all` prints them.\n");
    Some(format!("{HEAD}{all}\n{text}"))
}

/// The same scenario as a file with every key, its unit, meaning and default.
///
/// Text after `# ` is a comment. Text directly after `#` is a key that may be left out: take the
/// `#` away to set it.
///
/// # Arguments
/// * `kind` - one of [`template_kinds`]
///
/// # Returns
/// The file's text; none for another kind.
pub fn template_of_all_keys(kind: &str) -> Option<String> {
    let text = scenario_of_kind(kind)?.in_sections(&Commented);
    Some(format!("{HEAD}{HEAD_OF_ALL_KEYS}\n{text}"))
}

/// The scenario of a template.
fn scenario_of_kind(kind: &str) -> Option<Scenario> {
    if kind == HEALTHY {
        return Some(of_the_paper(PaperRig::Breakage));
    }
    if kind == HELICAL {
        return Some(helical());
    }
    let kind = damage_kinds().into_iter().find(|known| known.name == kind)?;
    Some(Scenario { faults: vec![Fault::at_usual_place(kind.example)], ..of_the_paper(kind.rig) })
}

/// A pair of helical gears whose overlap ratio is 1.09, so that a tooth's load moves over the whole face.
fn helical() -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: 20,
        gear_teeth: 60,
        face_width_mm: 30.0,
        pinion_speed_hz: 30.0,
        brake_torque_nm: 60.0,
    });
    scenario.meshes.iter_mut().for_each(|mesh| mesh.helix_angle_deg = 20.0);
    scenario.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 6);
    scenario
}

/// The pairs of the paper's experiments.
fn of_the_paper(rig: PaperRig) -> Scenario {
    let (mut scenario, din_grade) = match rig {
        PaperRig::Breakage => (Scenario::new(GearPair::example()), 7),
        PaperRig::Destruction => (
            Scenario::new(GearPair {
                module_mm: 3.0,
                pinion_teeth: 18,
                gear_teeth: 35,
                face_width_mm: 30.0,
                pinion_speed_hz: 45.0,
                brake_torque_nm: 15.0,
            }),
            8,
        ),
    };
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = din_grade);
    scenario
}

/// The keys that matter, each with its meaning.
struct Essential;

impl Style for Essential {
    fn keys<S>(&self, rows: &[KeyRow<S>], section: &S, start: &S, _: &str) -> String {
        essential_rows(rows, section, start)
    }

    fn fault(&self, fault: &Fault) -> String {
        fault.essential()
    }
}

/// Every key with a comment; those at their default are commented out.
pub(super) struct Commented;

impl Style for Commented {
    fn keys<S>(&self, rows: &[KeyRow<S>], section: &S, start: &S, name: &str) -> String {
        commented_rows(rows, section, start, name)
    }

    fn fault(&self, fault: &Fault) -> String {
        fault.commented()
    }

    fn without_faults(&self) -> Option<String> {
        let kinds: Vec<_> = damage_kinds().iter().map(|kind| format!("\"{}\"", kind.name)).collect();
        let kinds = comment(&format!("The kind of damage: one of {}.", kinds.join(", ")));
        Some(format!("{WITHOUT_FAULTS}{kinds}# kind = \"root-crack\"\n# severity = 0.4\n"))
    }

    /// Writes a comment throughout: keys alone, without their section, would be another section's.
    fn without_sensors(&self) -> Option<String> {
        let keys: String = commented(&Sensor::start())
            .lines()
            .map(|line| match line.strip_prefix('#') {
                Some(key) if !key.starts_with(' ') => format!("# {key}\n"),
                _ => format!("{line}\n"),
            })
            .collect();
        Some(format!("{WITHOUT_SENSORS}{keys}"))
    }
}
