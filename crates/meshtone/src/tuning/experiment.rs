//! A rig's experiment: cases, measurements, and what is tuned.

use super::{DifferenceChain, EnhancementBounds, HybridError, Measurements};
use crate::damage::Fault;
use crate::scenario::Scenario;

/// Most combinations of the keys' values that an experiment may try: days of simulations.
pub const MOST_CANDIDATES: usize = 100_000;
/// Combinations of the other keys' values with which a value is tried that is refused alone.
const MOST_COMBINATIONS: usize = 243;

/// One state of the rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Its name.
    pub label: String,
    /// Severity of the fault, in the experiment's own unit; 0 for the healthy state.
    pub severity: f64,
    /// The faults; none for the healthy state.
    pub faults: Vec<Fault>,
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

impl KeyRange {
    /// Values that stand for all: the ends, and between them one that is no round number, since whole numbers are to be listed.
    fn some_values(&self) -> Vec<f64> {
        match self {
            Self::Between { least, largest, .. } => vec![*least, *largest, least + 0.437 * (largest - least)],
            Self::OneOf(values) => values.clone(),
        }
    }

    fn ends_and_middle(&self) -> Vec<f64> {
        let values = self.some_values();
        match self {
            Self::Between { .. } => values,
            Self::OneOf(_) => vec![values[0], values[values.len() - 1], values[values.len() / 2]],
        }
    }
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
    /// The scenario that all cases share; its fault does not count.
    pub base: Scenario,
    /// The cases; the first is the healthy one.
    pub cases: Vec<Case>,
    /// The processing that gives difference signals.
    pub chain: DifferenceChain,
    /// Measurements of the same cases.
    pub measured: Measurements,
    /// Bounds within which the enhancement is searched.
    pub bounds: EnhancementBounds,
    /// Numbers of the scenario that are tuned as well; none for the paper's three parameters alone.
    pub keys: Vec<TunedKey>,
    /// Number of combinations of the keys' values that are simulated, all cases each.
    pub candidates: usize,
    /// Of the combinations and the bootstrap.
    pub seed: u64,
}

impl Experiment {
    /// Refuses an experiment that cannot be run.
    ///
    /// # Errors
    /// Fewer than two cases; a first case that has a fault, or another that has none; other cases than were
    /// measured; those of [`DifferenceChain::wheel_of`]; bounds that hold nothing; no candidates or more than [`MOST_CANDIDATES`]; as of [`Self::check_key`].
    pub fn check(&self) -> Result<(), HybridError> {
        let (simulated, measured) = (self.cases.len(), self.measured.cases());
        if simulated < 2 || simulated != measured {
            return Err(HybridError::Cases { simulated, measured });
        }
        for (case, Case { label, faults, .. }) in self.cases.iter().enumerate() {
            if faults.is_empty() != (case == 0) {
                return Err(HybridError::HealthyCase { case, label: label.clone() });
            }
        }
        self.chain.wheel_of(&self.base)?;
        self.bounds.check()?;
        if !self.keys.is_empty() && !(1..=MOST_CANDIDATES).contains(&self.candidates) {
            return Err(HybridError::Candidates { candidates: self.candidates, most: MOST_CANDIDATES });
        }
        (0..self.keys.len()).try_for_each(|number| self.check_key(number))
    }

    /// Refuses a tuned key that cannot be tuned.
    ///
    /// # Arguments
    /// * `number` - of the key
    ///
    /// # Errors
    /// A range that holds nothing; a key that an earlier one is; a key that no case has, or that the model ignores; a value
    /// that no scenario of this experiment can have, whatever the other keys' values.
    pub fn check_key(&self, number: usize) -> Result<(), HybridError> {
        let key = &self.keys[number];
        key.check()?;
        if self.keys[..number].iter().any(|other| other.key == key.key) {
            return Err(HybridError::KeyTwice { key: key.key.clone() });
        }
        let values = key.range.some_values();
        let (mut known, mut honoured) = (false, values.iter().all(|value| *value == values[0]));
        for case in &self.cases {
            let scenario = self.scenario(case);
            let Some(before) = scenario.number(&key.key) else { continue };
            known = true;
            for &value in &values {
                match scenario.with_number(&key.key, value) {
                    Ok(changed) => {
                        honoured |= value != before
                            && changed.without_ignored_keys() != scenario.without_ignored_keys();
                    }
                    Err(_) if self.allows_together(&scenario, number, value) => honoured = true,
                    Err(error) => return Err(error.into()),
                }
            }
        }
        match (known, honoured) {
            (false, _) => Err(HybridError::NoSuchKey { key: key.key.clone() }),
            (true, false) => Err(HybridError::IgnoredKey { key: key.key.clone() }),
            (true, true) => Ok(()),
        }
    }

    /// Returns whether a value that the scenario refuses is allowed together with values of the other keys.
    fn allows_together(&self, scenario: &Scenario, number: usize, value: f64) -> bool {
        let others: Vec<(&str, Vec<f64>)> = self
            .keys
            .iter()
            .enumerate()
            .filter(|(other, key)| *other != number && scenario.number(&key.key).is_some())
            .map(|(_, key)| (key.key.as_str(), key.range.ends_and_middle()))
            .collect();
        let combinations: usize = others.iter().map(|(_, values)| values.len()).product();
        (0..combinations.min(MOST_COMBINATIONS)).any(|mut combination| {
            let mut numbers = vec![(self.keys[number].key.as_str(), value)];
            for (key, values) in &others {
                numbers.push((*key, values[combination % values.len()]));
                combination /= values.len();
            }
            scenario.with_numbers(&numbers).is_ok()
        })
    }

    /// The scenario of a case.
    ///
    /// # Arguments
    /// * `case` - of this experiment
    pub fn scenario(&self, case: &Case) -> Scenario {
        Scenario { faults: case.faults.clone(), ..self.base.clone() }
    }

    /// The scenario of a case with other numbers at the tuned keys, all set before anything is checked.
    ///
    /// # Arguments
    /// * `case` - of this experiment
    /// * `values` - in the order of the keys
    ///
    /// # Errors
    /// A value that is not allowed in a scenario.
    pub fn scenario_with(&self, case: &Case, values: &[f64]) -> Result<Scenario, HybridError> {
        let scenario = self.scenario(case);
        let numbers: Vec<(&str, f64)> =
            self.keys.iter().zip(values).map(|(key, &value)| (key.key.as_str(), value)).collect();
        Ok(scenario.with_known_numbers(&numbers)?)
    }
}
