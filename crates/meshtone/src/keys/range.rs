//! The range of numbers that a key may have.

use std::fmt::Arguments;
use std::ops::Bound::{self, Excluded, Included, Unbounded};
use std::ops::RangeBounds;

use super::check::{Check, refuse};
use crate::error::ScenarioError;

/// The numbers that a key may have, whatever the other keys say. All are finite.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Range {
    least: Bound<f64>,
    most: Bound<f64>,
    /// A number above it can only be a typing error or in another unit.
    implausible_above: Option<f64>,
    message: Option<&'static str>,
    help: Option<&'static str>,
}

impl Range {
    /// Every finite number.
    pub const fn finite() -> Self {
        Self { least: Unbounded, most: Unbounded, implausible_above: None, message: None, help: None }
    }

    /// More than 0.
    pub const fn positive() -> Self {
        Self { least: Excluded(0.0), ..Self::finite() }
    }

    /// 0 or more.
    pub const fn not_negative() -> Self {
        Self { least: Included(0.0), ..Self::finite() }
    }

    /// Between two bounds.
    pub const fn between(least: Bound<f64>, most: Bound<f64>) -> Self {
        Self { least, most, ..Self::finite() }
    }

    /// From `least` to `most`, both included.
    pub const fn from_to(least: f64, most: f64) -> Self {
        Self::between(Included(least), Included(most))
    }

    /// From 0 to less than 1.
    pub const fn below_one() -> Self {
        Self::between(Included(0.0), Excluded(1.0))
    }

    /// This range up to `largest` only: a larger number can only be a typing error or in another unit.
    pub const fn implausible_above(self, largest: f64) -> Self {
        Self { implausible_above: Some(largest), ..self }
    }

    /// Returns the range with a message of its own, which says what is allowed.
    pub const fn message(self, message: &'static str) -> Self {
        Self { message: Some(message), ..self }
    }

    /// Returns the range with advice.
    pub const fn help(self, help: &'static str) -> Self {
        Self { help: Some(help), ..self }
    }

    /// Checks whether a number is in it.
    ///
    /// # Arguments
    /// * `key` - dotted key, for the message
    /// * `value` - the number
    /// * `written` - the number as the message has it
    /// * `unit` - its unit
    pub fn check(&self, key: &str, value: f64, written: Arguments<'_>, unit: &str) -> Check {
        let refused = |problem: String| ScenarioError::new(key, written, problem);
        if !value.is_finite() {
            return Err(refuse(key, value, "must be a finite number"));
        }
        if !(self.least, self.most).contains(&value) {
            let error = refused(self.message.map_or_else(|| self.must(unit), str::to_string));
            return Err(match self.help {
                Some(help) => error.with_help(help),
                None => error,
            });
        }
        match self.implausible_above {
            Some(largest) if value > largest => {
                let problem = format!("must be at most {}", with_unit(largest, unit));
                Err(refused(problem).with_help(format!("check the unit: it is {unit}")))
            }
            _ => Ok(()),
        }
    }

    /// The least and the largest number, as far as there are such: the bounds themselves, be they allowed or not.
    pub fn bounds(&self) -> [Option<f64>; 2] {
        let number = |bound| match bound {
            Unbounded => None,
            Included(number) | Excluded(number) => Some(number),
        };
        [number(self.least), number(self.most).or(self.implausible_above)]
    }

    /// The allowed numbers, in words; none where every finite number is allowed.
    ///
    /// # Arguments
    /// * `unit` - the key's
    pub fn words(&self, unit: &str) -> Option<String> {
        let is_bounded = !matches!((self.least, self.most), (Unbounded, Unbounded));
        is_bounded.then(|| self.message.map_or_else(|| self.must(unit), str::to_string))
    }

    fn must(&self, unit: &str) -> String {
        let number = |value| with_unit(value, unit);
        match (self.least, self.most) {
            (Unbounded, Unbounded) => "must be a finite number".to_string(),
            (Excluded(least), Unbounded) => format!("must be more than {}", number(least)),
            (Included(least), Unbounded) => format!("must be {} or more", number(least)),
            (Unbounded, Excluded(most)) => format!("must be less than {}", number(most)),
            (Unbounded, Included(most)) => format!("must be at most {}", number(most)),
            (Included(least), Included(most)) => {
                format!("must be from {} to {}", number(least), number(most))
            }
            (Included(least), Excluded(most)) => {
                format!("must be from {} to less than {}", number(least), number(most))
            }
            (Excluded(least), Included(most)) => {
                format!("must be more than {} and at most {}", number(least), number(most))
            }
            (Excluded(least), Excluded(most)) => {
                format!("must be more than {} and less than {}", number(least), number(most))
            }
        }
    }

    /// The range as a table has it: `> 0, ≤ 100`; empty where every number is allowed.
    pub fn in_short(&self) -> String {
        let least = match self.least {
            Unbounded => None,
            Included(least) => Some(format!("≥ {}", short(least))),
            Excluded(least) => Some(format!("> {}", short(least))),
        };
        let most = match self.most {
            Unbounded => self.implausible_above.map(|largest| format!("≤ {}", short(largest))),
            Included(most) => Some(format!("≤ {}", short(most))),
            Excluded(most) => Some(format!("< {}", short(most))),
        };
        let bounds = match (self.least, self.most) {
            (Included(least), Included(most)) => format!("{}…{}", short(least), short(most)),
            _ => least.into_iter().chain(most).collect::<Vec<_>>().join(", "),
        };
        bounds.replace('-', "−")
    }
}

fn with_unit(value: f64, unit: &str) -> String {
    let number = short(value);
    match unit {
        "" | "-" => number,
        "°" => format!("{number}°"),
        unit => format!("{number} {unit}"),
    }
}

/// A bound as one reads it.
fn short(value: f64) -> String {
    if value.abs() >= 1e9 { format!("{value:e}") } else { value.to_string() }
}
