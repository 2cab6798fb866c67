//! The plan: what a data set consists of.
//!
//! A plan is read from TOML with [`Plan::read`]. [`crate::draw`] draws its records.

mod background;
mod check;
mod class;
mod fault;
mod growth;
mod keep;
mod question;
mod read;
mod rule;
mod split;
mod variation;
mod wheel;

use std::path::PathBuf;

use meshtone::scenario::{GearboxRig, Scenario};
use meshtone_io::experiment::Tuned;
use meshtone_toml::{TomlDocument, TomlError};

pub use background::Background;
pub(crate) use class::kinds;
pub use class::{Class, Severity};
pub use fault::ClassFault;
pub(crate) use fault::{FaultPlace, FaultyBase, with_faults};
pub use growth::{Growth, Law, RunPosition, SpreadOver};
pub use keep::{Keep, MOST_SHARD_RECORDS, OverAngle};
pub use question::Question;
pub(crate) use rule::overlap;
pub use rule::{Distribution, Level, Rule};
pub use split::{Shift, SplitBy, Splits};
pub use variation::Variation;
pub use wheel::AveragedWheels;
pub(crate) use wheel::{column_part, wheel_words};

use crate::digest::Digest;
use crate::expression::Condition;
use crate::sampling::Design;

/// Makes an error about a key of a plan.
///
/// # Arguments
/// * `place` - the key
/// * `help` - what the user can do
pub(crate) fn refused(place: impl Into<String>, problem: impl Into<String>, help: &str) -> TomlError {
    TomlError::new(place, "", problem).with_help(help)
}

/// The name of a section and, of an entry of a list such as `wheel[z1]` or `fault[1]`, what stands in the brackets.
///
/// # Arguments
/// * `section` - the first segment of a key
pub(crate) fn list_and_entry(section: &str) -> (&str, Option<&str>) {
    let entry = section.split_once('[').and_then(|(list, entry)| Some((list, entry.strip_suffix(']')?)));
    entry.map_or((section, None), |(list, entry)| (list, Some(entry)))
}

/// The plan of a data set.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The facts that the data card states about it.
    pub about: About,
    /// The settings that decide every byte of the records.
    pub content: Content,
    /// The plan's text and those of the files that it names, to be kept beside the data.
    pub files: Vec<PlanFile>,
    /// All files that were read.
    pub sources: Vec<PathBuf>,
    /// See [`Self::hash`].
    identity: String,
}

/// A text that belongs to a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanFile {
    /// Its name beside the data.
    pub name: &'static str,
    /// Its text.
    pub text: String,
}

impl PlanFile {
    /// Names that such files have: the plan, its base scenario, what was tuned, the background.
    pub const NAMES: [&'static str; 4] = ["plan.toml", "scenario.toml", "tuned.toml", "background.csv"];

    /// Keys of a plan that change no record: what the data card states, and the names of files, which count by their texts.
    const BESIDE_CONTENT: [&'static str; 13] = [
        "title",
        "description",
        "licence",
        "version",
        "published",
        "citation",
        "creator",
        "url",
        "doi",
        "questions",
        "scenario",
        "tuned",
        "background",
    ];

    /// The text as it is compared.
    fn canonical(&self) -> String {
        let but = if self.name == Self::NAMES[0] { &Self::BESIDE_CONTENT[..] } else { &[] };
        match TomlDocument::parse(&self.text) {
            Ok(document) if self.name != Self::NAMES[3] => document.canonical(but),
            // Samples of a background are compared as they are written.
            _ => self.text.clone(),
        }
    }
}

/// The facts that the data card states about a data set.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// Title.
    pub title: String,
    /// A few sentences.
    pub description: String,
    /// Licence of the data, by its SPDX identifier or in words.
    pub licence: String,
    /// Version of the data set, as `1.0.0`.
    pub version: String,
    /// The day on which it is published, as `2026-11-22`.
    pub published: Option<String>,
    /// How it is to be cited; none to cite it by its title.
    pub citation: Option<String>,
    /// Who made it.
    pub creator: Option<String>,
    /// Where it is found.
    pub url: Option<String>,
    /// Its digital object identifier, as `10.5281/zenodo.1234567`.
    pub doi: Option<String>,
    /// The questions that it asks about a record.
    pub questions: Vec<Question>,
}

/// The settings that decide every byte of the records.
#[derive(Debug, Clone, PartialEq)]
pub struct Content {
    /// Seed of all draws.
    pub seed: u64,
    /// The healthy scenario that all records have in common.
    pub base: Scenario,
    /// How many units there are: pairs of wheels, or gearboxes.
    pub units: u64,
    /// How often each unit is mounted: its records are spread evenly over that many mountings.
    pub mountings: u64,
    /// How drawn values fill their ranges.
    pub design: Design,
    /// Rules for all classes.
    pub rules: Vec<Rule>,
    /// What every record must satisfy, where its class has the keys.
    pub constraints: Vec<Condition>,
    /// The classes.
    pub classes: Vec<Class>,
    /// How units are divided into splits.
    pub splits: Splits,
    /// What is kept of each record.
    pub keep: Keep,
    /// How difference signals are enhanced; none if they are not.
    pub tuned: Option<Tuned>,
    /// The noise of a healthy machine, which is added in place of white noise; none for white noise.
    pub background: Option<Background>,
}

impl Content {
    /// The rules for all classes, then the rules of each class.
    pub(crate) fn all_rules(&self) -> impl Iterator<Item = &Rule> {
        self.rules.iter().chain(self.classes.iter().flat_map(|class| &class.rules))
    }

    /// The rules of one class, each with its key in the plan.
    pub(crate) fn class_rules(&self, class: usize) -> impl Iterator<Item = (&Rule, String)> {
        let rules = self.classes[class].rules.iter().enumerate();
        rules.map(move |(i, rule)| (rule, format!("class[{class}].vary[{i}]")))
    }

    /// The rules for all classes, each with its key in the plan.
    pub(crate) fn top_rules(&self) -> impl Iterator<Item = (&Rule, String)> {
        self.rules.iter().enumerate().map(|(i, rule)| (rule, format!("vary[{i}]")))
    }

    /// Number of mountings of all units.
    pub(crate) fn all_mountings(&self) -> u64 {
        self.units.saturating_mul(self.mountings)
    }

    /// The splits that have any units, or mountings, and how many.
    pub(crate) fn units_of_split(&self) -> Vec<(&str, u64)> {
        let counts = self.splits.counts(self.divided());
        self.splits.names().into_iter().zip(counts).filter(|(_, units)| *units > 0).collect()
    }

    /// Number of what is divided into splits: units, or mountings.
    pub(crate) fn divided(&self) -> u64 {
        match self.splits.by {
            SplitBy::Unit => self.units,
            SplitBy::Mounting => self.all_mountings(),
        }
    }
}

impl Plan {
    /// Number of records.
    pub fn records(&self) -> u64 {
        self.content.classes.iter().map(|class| class.count).sum()
    }

    /// The plan's identity, in hexadecimal digits: the SHA-256 of its canonical TOML and that of its files as they were read, and of the versions
    /// of the program, of its numbers and of what it makes of a plan.
    ///
    /// Plans with the same keys and values have the same hash, whatever their layout, comments and description. A default that is written out is
    /// another key.
    pub fn hash(&self) -> &str {
        &self.identity
    }
}

/// Version of what the program makes of a plan. It grows with every change of a default, or of what a key of a plan stands for, so that a data
/// set is not continued with other records.
const PLAN_VERSION: u32 = 1;

/// The identity of a plan that consists of some files.
fn identity(files: &[PlanFile]) -> String {
    let versions = format!("{} {} {PLAN_VERSION}", env!("CARGO_PKG_VERSION"), meshtone::PHYSICS_VERSION);
    let files = files.iter().map(|file| format!("\n{}\n{}", file.name, file.canonical()));
    Digest::of((versions + &files.collect::<String>()).as_bytes()).sha256
}

/// A commented plan: every key with its meaning.
///
/// ```
/// use std::path::Path;
/// use meshtone_dataset::plan::{Plan, template};
///
/// let plan = Plan::read_text(template().to_owned(), Path::new("plan.toml"))?;
/// assert_eq!(plan.records(), 600);
/// # Ok::<(), meshtone_io::scenario_file::ReadScenarioError>(())
/// ```
pub fn template() -> &'static str {
    include_str!("template.toml")
}

/// A commented plan of a data set of the gearbox that [`meshtone::scenario::gearbox_template`] prints.
///
/// ```
/// use std::path::Path;
/// use meshtone_dataset::plan::{Plan, gearbox_template};
///
/// let plan = Plan::read_text(gearbox_template(), Path::new("plan.toml"))?;
/// assert_eq!((plan.records(), plan.content.keep.wheel.names()), (200, "z1, z2, z3, z4".to_owned()));
/// # Ok::<(), meshtone_io::scenario_file::ReadScenarioError>(())
/// ```
pub fn gearbox_template() -> String {
    // At the example's rate a data set would take twice as long, and its lowest mode decays slowly.
    const SOLVER: &str = "\
[scenario.solver]
sampling_rate_hz = 50000.0
duration_s = 1.0
settle_fraction = 0.81
settle_tolerance = 1e-2
";
    let gearbox = meshtone::scenario::gearbox_template(None);
    with_gearbox(include_str!("template_gearbox.toml"), &gearbox, SOLVER)
}

/// A commented plan of a data set of a planetary set.
///
/// ```
/// use std::path::Path;
/// use meshtone_dataset::plan::{Plan, planetary_template};
///
/// let plan = Plan::read_text(planetary_template(), Path::new("plan.toml"))?;
/// assert_eq!(plan.content.keep.wheel.names(), "p.sun, p.planet1, p.planet2, p.planet3, p.ring");
/// # Ok::<(), meshtone_io::scenario_file::ReadScenarioError>(())
/// ```
pub fn planetary_template() -> String {
    const SOLVER: &str = "\
[scenario.solver]
sampling_rate_hz = 100000.0
duration_s = 5.0
settle_tolerance = 1e-2
";
    let gearbox = meshtone::scenario::gearbox_template(Some(GearboxRig::PlanetaryLab));
    with_gearbox(include_str!("template_planetary.toml"), &gearbox, SOLVER)
}

/// A plan with the sections of a gearbox, but for its solver's.
fn with_gearbox(plan: &str, gearbox: &str, solver: &str) -> String {
    let has_section =
        |part: &&str| part.lines().any(|line| line.starts_with('[')) && !part.contains("[solver]");
    let of_scenario = |line: &str| {
        let brackets = line.len() - line.trim_start_matches('[').len();
        let scenario = if brackets > 0 { "scenario." } else { "" };
        format!("{}{scenario}{}\n", &line[..brackets], &line[brackets..])
    };
    let parts = gearbox.split("\n\n").filter(has_section);
    // Of a steady motion one cycle is simulated and repeated, of a speed that wanders the whole record.
    let is_steady = |line: &&str| !line.contains("wander");
    let parts: String = parts
        .map(|part| part.lines().filter(is_steady).map(of_scenario).collect::<String>() + "\n")
        .collect();
    plan.replace("# <gearbox>\n", &format!("{parts}{solver}\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_plan_is_identified_by_its_keys_and_values() {
        let hash = |text: String| Plan::read_text(text, Path::new("plan.toml")).unwrap().hash().to_owned();
        let plan = template().to_owned();
        let first = hash(plan.clone());
        assert_eq!(hash(plan.replace("\n[", "\n\n# Another layout.\n[")), first);
        assert_eq!(hash(format!("licence = \"MIT\"\n{}", plan.replace("licence", "# licence"))), first);
        assert_eq!(hash(plan.replace("pinion_speed_hz = 40.0", "pinion_speed_hz = 40")), first);
        for (there, instead) in [("records = 600", "records = 601"), ("module_mm = 3.0", "module_mm = 2.5")] {
            assert!(plan.contains(there), "{there}");
            assert_ne!(hash(plan.replace(there, instead)), first, "{there}");
        }
        let first_keys = "records = 600\nunits = 20\n";
        let reordered = "units = 20\nrecords = 600\n";
        let short = |keys: &str, rest: &str| {
            format!("{keys}{rest}{}", plan[plan.find("[scenario").unwrap()..].to_owned())
        };
        assert_eq!(hash(short(first_keys, "")), hash(short(reordered, "")));
        // More digits than a float has, and more than a signed number.
        for [one, other] in [[9_007_199_254_740_993, 9_007_199_254_740_992], [u64::MAX, u64::MAX - 1]] {
            let seeded =
                |seed: u64, comment: &str| hash(short(first_keys, &format!("seed = {seed}{comment}\n")));
            assert_ne!(seeded(one, ""), seeded(other, ""));
            assert_eq!(seeded(one, ""), seeded(one, " # the same"));
        }
    }
}
