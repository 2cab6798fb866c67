//! Every stage's output under one name each, for checking number by number.

mod average;
mod run;
mod stages;

pub(crate) use average::wheel_record;
pub use run::{trace, trace_at};
use stages::static_stages;

use crate::simulate::Stages;

/// A named array.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceField {
    /// Name, with the unit at its end.
    pub name: String,
    /// Length of each dimension, slowest first; empty for a single number.
    pub shape: Vec<usize>,
    /// The numbers, the last dimension running fastest.
    pub values: Vec<f64>,
}

/// The fields of a trace that belong to the stages before the time loop.
///
/// # Arguments
/// * `stages` - of a simulation
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let stages = meshtone::stages(&Scenario::new(GearPair::example()))?;
/// let trace = meshtone::stage_trace(&stages);
/// assert_eq!(trace.get("natural_frequencies_hz").map(|field| field.values.len()), Some(17));
/// # Ok::<(), meshtone::Error>(())
/// ```
pub fn stage_trace(stages: &Stages) -> Trace {
    let mut trace = Trace::default();
    static_stages(&mut trace, stages);
    trace
}

/// Every stage's output; the fields are described in the documentation's chapter "Trace".
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Trace {
    /// The fields, in the order of the stages.
    pub fields: Vec<TraceField>,
}

impl Trace {
    /// The field called `name`.
    pub fn get(&self, name: &str) -> Option<&TraceField> {
        self.fields.iter().find(|field| field.name == name)
    }

    fn scalar(&mut self, name: &str, value: f64) {
        self.fields.push(TraceField { name: name.into(), shape: Vec::new(), values: vec![value] });
    }

    fn vector(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        let values: Vec<f64> = values.into_iter().collect();
        self.fields.push(TraceField { name: name.into(), shape: vec![values.len()], values });
    }

    fn matrix(&mut self, name: &str, rows: usize, columns: usize, at: impl Fn(usize, usize) -> f64) {
        let values = (0..rows * columns).map(|n| at(n / columns, n % columns)).collect();
        self.fields.push(TraceField { name: name.into(), shape: vec![rows, columns], values });
    }
}
