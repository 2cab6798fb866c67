//! What a data set asks.

use super::Class;

/// A question that a data set asks of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Question {
    /// Whether it is damaged.
    Detection,
    /// What kind of damage it has, and on which wheel.
    Diagnosis,
    /// How severe that is.
    Severity,
    /// How long until it fails.
    RemainingLife,
}

impl Question {
    /// All with their names in a plan.
    pub const NAMES: [(&'static str, Self); 4] = [
        ("detection", Self::Detection),
        ("diagnosis", Self::Diagnosis),
        ("severity", Self::Severity),
        ("remaining-life", Self::RemainingLife),
    ];

    /// Its name in a plan.
    pub fn name(self) -> &'static str {
        Self::NAMES[self as usize].0
    }

    /// What is to be told, by its columns.
    pub fn target(self) -> &'static str {
        match self {
            Self::Detection => "whether `fault_kind` is null",
            Self::Diagnosis => "`label`",
            Self::Severity => "`fault_severity`, 0 for healthy",
            Self::RemainingLife => {
                "`remaining_rev` of records that have it, at least that where `censored` is 1"
            }
        }
    }

    /// How answers are scored.
    pub fn score(self) -> &'static str {
        match self {
            Self::Detection => {
                "area under the ROC curve, by kind; severity from which 90 % are found at 5 % false alarms"
            }
            Self::Diagnosis => "mean over the classes of the part that is named rightly",
            Self::Severity => {
                "continuous ranked probability score of a predicted distribution, or the mean absolute error of a number"
            }
            Self::RemainingLife => {
                "concordance index; mean absolute error of the logarithm where the run was not censored"
            }
        }
    }

    /// What keeps some classes from asking it; none where they do.
    ///
    /// # Arguments
    /// * `classes` - of the plan
    pub(crate) fn obstacle(self, classes: &[Class]) -> Option<&'static str> {
        let damaged = classes.iter().filter(|class| !class.faults.is_empty()).count();
        let healthy = classes.len() - damaged;
        match self {
            Self::Detection => {
                (damaged == 0 || healthy == 0).then_some("needs a healthy class and one with a fault")
            }
            Self::Diagnosis => (classes.len() < 2).then_some("needs two classes or more"),
            Self::Severity => (damaged == 0).then_some("needs a class with a fault"),
            Self::RemainingLife => (!classes.iter().any(|class| class.growth.is_some()))
                .then_some("needs a class with growth, whose gears fail"),
        }
    }
}
