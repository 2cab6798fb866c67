//! The questions that a data set asks.

use super::Class;

/// A question that a data set asks of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Question {
    /// Whether there is damage.
    Detection,
    /// What kind of damage there is, and where.
    Diagnosis,
    /// How severe the damage is.
    Severity,
    /// How long it is until failure.
    RemainingLife,
}

meshtone_toml::named!(Question {
    Detection = "detection",
    Diagnosis = "diagnosis",
    Severity = "severity",
    RemainingLife = "remaining-life",
});

impl Question {
    /// The columns that hold the answer, and how answers are scored.
    pub fn target_and_score(self) -> [&'static str; 2] {
        match self {
            Self::Detection => [
                "whether `fault_kind` is null",
                "area under the ROC curve, by kind; severity from which 90 % are found at 5 % false alarms",
            ],
            Self::Diagnosis => ["`label`", "mean over the classes of the fraction classified correctly"],
            Self::Severity => [
                "`fault_severity`, 0 for healthy",
                "continuous ranked probability score of a predicted distribution, or the mean absolute error of a number",
            ],
            Self::RemainingLife => [
                "`remaining_rev` of records that have it, at least that where `censored` is 1",
                "concordance index; mean absolute error of the logarithm where the run was not censored",
            ],
        }
    }

    /// Says why some classes do not allow the question; none if they do.
    ///
    /// # Arguments
    /// * `classes` - of the plan
    pub(crate) fn obstacle(self, classes: &[Class]) -> Option<&'static str> {
        let is_damaged = |class: &Class| !class.faults.is_empty();
        let has_damaged = classes.iter().any(is_damaged);
        let has_healthy = !classes.iter().all(is_damaged);
        let (allowed, obstacle) = match self {
            Self::Detection => (has_damaged && has_healthy, "needs a healthy class and one with a fault"),
            Self::Diagnosis => (classes.len() >= 2, "needs two classes or more"),
            Self::Severity => (has_damaged, "needs a class with a fault"),
            Self::RemainingLife => (
                classes.iter().any(|class| class.growth.is_some()),
                "needs a class with growth, whose gears fail",
            ),
        };
        (!allowed).then_some(obstacle)
    }
}
