//! The plan: what a data set consists of.
//!
//! A plan is read from TOML with [`Plan::read`]; [`crate::draw`] says what its records are.

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

use std::fmt;
use std::path::PathBuf;

use meshtone::scenario::Scenario;
use meshtone_io::experiment::Tuned;
use sha2::{Digest, Sha256};

pub(crate) use class::kinds;
pub use class::{Class, Severity};
pub use files::PlanFile;
pub use growth::{Age, Growth, Law};
pub use keep::{Keep, MOST_SHARD_RECORDS, OverAngle};
pub use question::Question;
pub use rule::{Distribution, Level, Rule};
pub use split::{Shift, SplitBy, Splits};
pub use template::template;

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

/// What the data card says.
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
    /// How it is to be cited; by its title where that is left out.
    pub citation: Option<String>,
    /// What it asks of a record.
    pub questions: Vec<Question>,
}

/// What decides every byte of the records.
#[derive(Debug, Clone, PartialEq)]
pub struct Content {
    /// Seed of all draws.
    pub seed: u64,
    /// What all records have in common, healthy.
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
    /// How units are divided.
    pub splits: Splits,
    /// What is kept of each record.
    pub keep: Keep,
    /// How difference signals are enhanced, if they are.
    pub tuned: Option<Tuned>,
}

/// Stands for a plan's content and the version of the program: SHA-256.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlanHash(String);

impl fmt::Display for PlanHash {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Plan {
    /// Number of records.
    pub fn records(&self) -> u64 {
        self.content.classes.iter().map(|class| class.count).sum()
    }

    /// Those of the first 5000 records that cannot be simulated, as far as their scenarios show it before anything is computed: draws
    /// outside a fault's limits, hunting periods that are shorter than `keep.duration_s`. They will be missing.
    pub fn foreseen_failures(&self) -> Vec<FailedRecord> {
        // A plan that was read has been checked for what stands in the way of drawing.
        check::foreseen(self).unwrap_or_default()
    }

    /// What is doubtful about what the plan asks for: runs to failure of one or two records, and values that its units or mountings
    /// choose of which none is in the training.
    pub fn warnings(&self) -> Vec<String> {
        check::doubts(self).unwrap_or_default()
    }

    /// What stands for the plan: the same for plans that say the same, whatever their layout, comments and description.
    ///
    /// Another version of the program may compute other numbers, and gives another hash.
    pub fn hash(&self) -> PlanHash {
        let mut hash = Sha256::new();
        hash.update(env!("CARGO_PKG_VERSION"));
        // Every field is plain data, and numbers are written so that they are read back exactly.
        hash.update(format!("{:?}", self.content));
        PlanHash(hex(&hash.finalize()))
    }
}

/// Bytes as hexadecimal digits.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
