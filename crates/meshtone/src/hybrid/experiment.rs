//! A rig's experiment: cases, measurements, and what is tuned.

use super::{DifferenceChain, EnhancementBounds, HybridError, Measurements};
use crate::scenario::{Fault, Scenario};

/// One state of the rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its name.
    pub label: String,
    /// How severe the fault is, in the experiment's own unit; 0 for the healthy state.
    pub severity: f64,
    /// The fault; none for the healthy state.
    pub fault: Option<Fault>,
}

/// Values that a scenario key is tuned over.
#[derive(Debug, Clone, PartialEq)]
pub enum KeyRange {
    /// Everything between two values.
    Between {
        /// Least value.
        least: f64,
        /// Largest value.
        largest: f64,
        /// Whether values are tried at equal ratios instead of at equal distances.
        logarithmic: bool,
    },
    /// One of some values, such as seeds.
    OneOf(Vec<f64>),
}

/// A number of the scenario that is tuned beside the enhancement.
#[derive(Debug, Clone, PartialEq)]
pub struct TunedKey {
    /// Its key in the scenario file, dotted. One of the fault's applies to every case whose fault has it.
    pub key: String,
    /// Its values.
    pub range: KeyRange,
}

impl TunedKey {
    /// Refuses a range that holds nothing.
    ///
    /// # Errors
    /// No values; values that are not finite; a least value above the largest; a logarithmic range that is not above 0.
    pub fn check(&self) -> Result<(), HybridError> {
        let refuse = |value: String, allowed: &str| {
            let name = format!("the range of {}", self.key);
            Err(HybridError::Parameter { name, value, allowed: allowed.into() })
        };
        match &self.range {
            KeyRange::Between { least, largest, logarithmic } => {
                let given = format!("{least} to {largest}");
                if !(least.is_finite() && largest.is_finite() && least <= largest) {
                    refuse(given, "two finite numbers, the smaller first")
                } else if *logarithmic && *least <= 0.0 {
                    refuse(given, "above 0 where it is logarithmic")
                } else {
                    Ok(())
                }
            }
            KeyRange::OneOf(values) if values.is_empty() => refuse("empty".into(), "one value or more"),
            KeyRange::OneOf(values) => match values.iter().find(|value| !value.is_finite()) {
                Some(value) => refuse(format!("{value}"), "finite numbers"),
                None => Ok(()),
            },
        }
    }
}

/// A rig's experiment.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// What all cases have in common; its fault does not count.
    pub base: Scenario,
    /// The cases; the first is the healthy one.
    pub cases: Vec<Case>,
    /// How difference signals are taken.
    pub chain: DifferenceChain,
    /// What was measured, of the same cases.
    pub measured: Measurements,
    /// Where the enhancement is searched.
    pub bounds: EnhancementBounds,
    /// Numbers of the scenario that are tuned as well; none for the paper's three parameters alone.
    pub keys: Vec<TunedKey>,
    /// How many combinations of the keys' values are simulated, all cases each.
    pub candidates: usize,
    /// Of the combinations and the bootstrap.
    pub seed: u64,
}

impl Experiment {
    /// Refuses an experiment that cannot be run.
    ///
    /// # Errors
    /// Fewer than two cases; a first case that has a fault, or another that has none; other cases than were
    /// measured; bounds or ranges that hold nothing; a key that no case has.
    pub fn check(&self) -> Result<(), HybridError> {
        let (simulated, measured) = (self.cases.len(), self.measured.cases());
        if simulated < 2 || simulated != measured {
            return Err(HybridError::Cases { simulated, measured });
        }
        for (case, Case { label, fault, .. }) in self.cases.iter().enumerate() {
            if fault.is_some() == (case == 0) {
                return Err(HybridError::HealthyCase { case, label: label.clone() });
            }
        }
        self.bounds.check()?;
        for (number, key) in self.keys.iter().enumerate() {
            key.check()?;
            if self.keys[..number].iter().any(|other| other.key == key.key) {
                return Err(HybridError::KeyTwice { key: key.key.clone() });
            }
            self.check_effect(key)?;
        }
        Ok(())
    }

    /// Refuses a key that no case has, values that a scenario refuses, and a key that the convention ignores.
    fn check_effect(&self, key: &TunedKey) -> Result<(), HybridError> {
        let values = match &key.range {
            // The middle, too: whole numbers have none, and are to be listed.
            KeyRange::Between { least, largest, .. } => {
                vec![*least, *largest, least + 0.437 * (largest - least)]
            }
            KeyRange::OneOf(values) => values.clone(),
        };
        let (mut known, mut honoured) = (false, false);
        for case in &self.cases {
            let scenario = self.scenario(case);
            let Some(number) = scenario.number(&key.key) else { continue };
            known = true;
            for &value in &values {
                let changed = scenario.with_number(&key.key, value)?;
                honoured |= value != number && changed.as_honoured() != scenario.as_honoured();
            }
        }
        let distinct = values.iter().any(|value| *value != values[0]);
        match (known, honoured || !distinct) {
            (false, _) => Err(HybridError::NoSuchKey { key: key.key.clone() }),
            (true, false) => Err(HybridError::IgnoredKey { key: key.key.clone() }),
            (true, true) => Ok(()),
        }
    }

    /// The scenario of a case.
    ///
    /// # Arguments
    /// * `case` - of this experiment
    pub fn scenario(&self, case: &Case) -> Scenario {
        Scenario { fault: case.fault.clone(), ..self.base.clone() }
    }

    /// The scenario of a case with other numbers at the tuned keys.
    ///
    /// # Arguments
    /// * `case` - of this experiment
    /// * `values` - in the order of the keys
    ///
    /// # Errors
    /// A value that is not allowed in a scenario.
    pub fn scenario_with(&self, case: &Case, values: &[f64]) -> Result<Scenario, HybridError> {
        let mut scenario = self.scenario(case);
        for (key, &value) in self.keys.iter().zip(values) {
            // A fault's key that another fault has not.
            if scenario.number(&key.key).is_some() {
                scenario = scenario.with_number(&key.key, value)?;
            }
        }
        Ok(scenario)
    }
}
