//! Named arrays: what a trace is made of.

/// A named array.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct TraceField {
    /// Name, with the unit at its end.
    pub name: String,
    /// Length of each dimension, slowest first; empty for a single number.
    pub shape: Vec<usize>,
    /// The numbers, the last dimension running fastest.
    pub values: Vec<f64>,
}

/// Every how many points a flank and a section of a fault are given.
pub(crate) const FAULT_STRIDE: usize = 25;

/// Every stage's output; the fields are described in the documentation's chapter "Trace".
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Trace {
    /// The fields, in the order of the stages.
    pub fields: Vec<TraceField>,
}

impl Trace {
    /// The field called `name`.
    pub fn get(&self, name: &str) -> Option<&TraceField> {
        self.fields.iter().find(|field| field.name == name)
    }

    pub(crate) fn scalar(&mut self, name: &str, value: f64) {
        self.fields.push(TraceField { name: name.into(), shape: Vec::new(), values: vec![value] });
    }

    pub(crate) fn vector(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        let values: Vec<f64> = values.into_iter().collect();
        self.fields.push(TraceField { name: name.into(), shape: vec![values.len()], values });
    }

    pub(crate) fn matrix(
        &mut self,
        name: &str,
        rows: usize,
        columns: usize,
        at: impl Fn(usize, usize) -> f64,
    ) {
        let values = (0..rows * columns).map(|n| at(n / columns, n % columns)).collect();
        self.fields.push(TraceField { name: name.into(), shape: vec![rows, columns], values });
    }
}
