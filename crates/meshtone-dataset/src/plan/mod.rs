//! The plan: what a data set consists of.
//!
//! A plan is read from TOML with [`Plan::read`]. [`crate::draw`] draws its records.

mod check;
mod class;
mod files;
mod growth;
mod keep;
mod question;
mod read;
mod rule;
mod split;
mod template;

use std::collections::BTreeMap;
use std::path::PathBuf;

use meshtone::scenario::Scenario;
use meshtone_io::experiment::Tuned;

pub(crate) use class::kinds;
pub use class::{Class, Severity};
pub use files::PlanFile;
pub use growth::{Growth, Law, RunPosition};
pub use keep::{Keep, MOST_SHARD_RECORDS, OverAngle};
pub use question::Question;
pub use rule::{Distribution, Level, Rule};
pub use split::{Shift, SplitBy, Splits};
pub use template::template;

use crate::digest::Digest;
use crate::expression::Condition;
use crate::sampling::Design;
use crate::shard::FailedRecord;

/// What a data set consists of.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What the data card says about it.
    pub about: About,
    /// What decides every byte of the records.
    pub content: Content,
    /// The plan's text and those of the files that it names, to be kept beside the data.
    pub files: Vec<PlanFile>,
    /// All files that were read.
    pub sources: Vec<PathBuf>,
}

/// What the data card says about a data set.
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
    /// The questions that it asks about a record.
    pub questions: Vec<Question>,
}

/// What decides every byte of the records.
#[derive(Debug, Clone, PartialEq)]
pub struct Content {
    /// Seed of all draws.
    pub seed: u64,
    /// The healthy scenario that all records have in common.
    pub base: Scenario,
    /// How many units there are: pairs of wheels.
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

    /// Number of units, or mountings, in each split that has any.
    pub(crate) fn units_of_split(&self) -> BTreeMap<String, u64> {
        let counts = self.splits.counts(self.divided());
        let names = self.splits.names().into_iter().map(str::to_owned);
        names.zip(counts).filter(|(_, units)| *units > 0).collect()
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

    /// Those of the first 5000 records whose scenarios show that they cannot be simulated, for example because a draw is outside a
    /// fault's limits or the hunting period is shorter than `keep.duration_s`. The data set will lack these records.
    pub fn foreseen_failures(&self) -> Vec<FailedRecord> {
        // A plan that was read has been checked, so that its records can be drawn.
        check::foreseen(self).unwrap_or_default()
    }

    /// Warnings about what the plan asks for: runs to failure of only one or two records, and values of units or mountings that no
    /// record of the training has.
    pub fn warnings(&self) -> Vec<String> {
        check::doubts(self).unwrap_or_default()
    }

    /// The SHA-256 of the plan's content and the program's version, in hexadecimal digits. Plans that say the same have the same hash,
    /// whatever their layout, comments and description.
    ///
    /// Another version of the program may compute other numbers, and therefore gives another hash.
    pub fn hash(&self) -> String {
        // Every field is plain data, and numbers are written so that they are read back exactly.
        let text = format!("{}{:?}", env!("CARGO_PKG_VERSION"), self.content);
        Digest::of(text.as_bytes()).sha256.to_string()
    }
}
