//! The values of keys while a record is drawn: drawn values take precedence over those of the base scenario.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use meshtone::scenario::key_of_both_wheels;

use crate::expression::derived;
use crate::plan::FaultyBase;

/// Name of the severity in conditions.
pub(super) const SEVERITY: &str = "severity";

pub(super) struct Values<'a> {
    base: &'a FaultyBase,
    /// The numbers of `base`.
    numbers: &'a BTreeMap<String, f64>,
    /// Keys and values that have been drawn so far.
    pub drawn: Vec<(String, f64)>,
    /// The grade of the severity in conditions; none where it is the same for the whole class.
    pub severity: Option<f64>,
    /// Severities that follow from the faults' sizes as drawn so far, computed when they are needed.
    severities_by_sizes: OnceCell<Option<Vec<f64>>>,
}

impl<'a> Values<'a> {
    /// Creates the values of a scenario of which nothing has been drawn yet.
    ///
    /// # Arguments
    /// * `base` - the scenario
    /// * `numbers` - all its numbers, by their keys
    pub fn new(base: &'a FaultyBase, numbers: &'a BTreeMap<String, f64>) -> Self {
        Self { base, numbers, drawn: Vec::new(), severity: None, severities_by_sizes: OnceCell::new() }
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        if key == SEVERITY {
            return self.severity;
        }
        let drawn = |key: &str| self.drawn.iter().find(|(drawn, _)| drawn == key).map(|(_, value)| *value);
        drawn(key)
            .or_else(|| drawn(&key_of_both_wheels(key)?))
            .or_else(|| self.numbers.get(key).copied())
            .or_else(|| derived(key)?.value(&|key| self.number(key)))
            .or_else(|| self.severity_by_sizes(key))
    }

    /// The severity of a fault that is given by its sizes.
    fn severity_by_sizes(&self, key: &str) -> Option<f64> {
        let fault = fault_of_severity(key, self.base.places.len())?;
        let of_drawn = || self.base.severities(&self.base.with_values(&self.drawn).ok()?);
        self.severities_by_sizes.get_or_init(of_drawn).as_ref()?.get(fault).copied()
    }

    pub fn set(&mut self, key: &str, value: f64) {
        self.severities_by_sizes.take();
        self.drawn.push((key.to_owned(), value));
    }
}

/// Finds the number of the fault, from 0, whose severity a key is: `fault.severity`, or of several `fault[1].severity`.
///
/// # Arguments
/// * `key` - any
/// * `faults` - how many there are
pub(super) fn fault_of_severity(key: &str, faults: usize) -> Option<usize> {
    let section = key.strip_suffix(".severity")?;
    let number = match (section, faults) {
        ("fault", 1) => 0,
        (_, 2..) => section.strip_prefix("fault[")?.strip_suffix(']')?.parse().ok()?,
        _ => return None,
    };
    (number < faults).then_some(number)
}
