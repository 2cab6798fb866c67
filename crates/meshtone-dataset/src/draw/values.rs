//! Values at keys: those drawn, over those of the base scenario.

use std::collections::HashMap;

use crate::expression::derived;

/// Name of the severity in conditions.
pub(super) const SEVERITY: &str = "severity";

pub(super) struct Values<'a> {
    base: &'a HashMap<String, f64>,
    drawn: Vec<(String, f64)>,
    severity: Option<f64>,
}

impl<'a> Values<'a> {
    pub fn new(base: &'a HashMap<String, f64>) -> Self {
        Self { base, drawn: Vec::new(), severity: None }
    }

    pub fn number(&self, key: &str) -> Option<f64> {
        if key == SEVERITY {
            return self.severity;
        }
        let drawn = self.drawn.iter().find(|(drawn, _)| drawn == key).map(|(_, value)| *value);
        drawn.or_else(|| self.base.get(key).copied()).or_else(|| derived(key)?.value(&|key| self.number(key)))
    }

    pub fn set(&mut self, key: &str, value: f64) {
        self.drawn.push((key.to_owned(), value));
    }

    pub fn set_severity(&mut self, grade: u8) {
        self.severity = Some(f64::from(grade));
    }

    pub fn drawn(self) -> Vec<(String, f64)> {
        self.drawn
    }
}
