//! The classes of a data set.

use super::{ClassFault, Growth, Rule};
use crate::expression::Expression;

/// Records of one label.
#[derive(Debug, Clone, PartialEq)]
pub struct Class {
    /// The label.
    pub label: String,
    /// The faults, before their varied keys are drawn; empty for healthy records.
    pub faults: Vec<ClassFault>,
    /// How many records.
    pub count: u64,
    /// How severe they are.
    pub severity: Severity,
    /// Rules for this class alone.
    pub rules: Vec<Rule>,
    /// How the damage of each unit grows to failure, record by record; none if the records of a unit do not follow one another.
    pub growth: Option<Growth>,
}

/// The kinds of some faults, in their order; none of a healthy pair or gearbox.
pub(crate) fn kinds(faults: &[ClassFault]) -> Option<String> {
    let kinds: Vec<_> = faults.iter().map(ClassFault::kind).collect();
    (!kinds.is_empty()).then(|| kinds.join(" + "))
}

/// The rule for the severity of a record's fault: a grade, 0 for healthy ones.
#[derive(Debug, Clone, PartialEq)]
pub enum Severity {
    /// The same for all records of the class.
    Grade(u8),
    /// By a number.
    Measured {
        /// The number.
        measure: Expression,
        /// The grade is 1 plus the number of these that the measure is not below; rising.
        breaks: Vec<f64>,
    },
}

impl Severity {
    /// Grade and, where there is one, measure.
    ///
    /// # Arguments
    /// * `number` - the number at a key
    ///
    /// ```
    /// use meshtone_dataset::expression::Expression;
    /// use meshtone_dataset::plan::Severity;
    ///
    /// let measure = Expression::parse("fault.tip_loss_mm")?;
    /// let severity = Severity::Measured { measure, breaks: vec![1.0, 2.0] };
    /// assert_eq!(severity.of(&|_| Some(0.5)), Some((1, Some(0.5))));
    /// assert_eq!(severity.of(&|_| Some(2.0)), Some((3, Some(2.0))));
    /// # Ok::<(), String>(())
    /// ```
    pub fn of(&self, number: &dyn Fn(&str) -> Option<f64>) -> Option<(u8, Option<f64>)> {
        match self {
            Self::Grade(grade) => Some((*grade, None)),
            Self::Measured { measure, breaks } => {
                let value = measure.value(number)?;
                let passed = breaks.iter().filter(|&&limit| value >= limit).count();
                Some((u8::try_from(passed).unwrap_or(u8::MAX).saturating_add(1), Some(value)))
            }
        }
    }
}
