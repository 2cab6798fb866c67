//! A number for each point of each tooth.

use std::ops::{Index, IndexMut};

/// A number for each point of each tooth of a wheel: rows are points, columns teeth.
///
/// ```
/// use meshtone::wheel::ErrorTable;
///
/// let mut errors_mm = ErrorTable::from_fn(100, 17, |point, tooth| 1e-5 * point as f64 * tooth as f64);
/// errors_mm[(3, 0)] = 2e-3;
/// assert_eq!(errors_mm.tooth(0)[2..5], [0.0, 2e-3, 0.0]);
/// assert_eq!((errors_mm.points(), errors_mm.teeth()), (100, 17));
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ErrorTable {
    points: usize,
    teeth: usize,
    /// Tooth after tooth.
    numbers: Vec<f64>,
}

impl ErrorTable {
    /// A table of what a function gives.
    ///
    /// # Arguments
    /// * `points` - number of points of a tooth
    /// * `teeth` - number of teeth
    /// * `number` - takes point and tooth, both from 0
    pub fn from_fn(points: usize, teeth: usize, number: impl Fn(usize, usize) -> f64) -> Self {
        let numbers = (0..teeth).flat_map(|tooth| (0..points).map(move |point| (point, tooth)));
        Self { points, teeth, numbers: numbers.map(|(point, tooth)| number(point, tooth)).collect() }
    }

    /// A table of one number.
    ///
    /// # Arguments
    /// * `points` - number of points of a tooth
    /// * `teeth` - number of teeth
    pub fn filled(points: usize, teeth: usize, number: f64) -> Self {
        Self { points, teeth, numbers: vec![number; points * teeth] }
    }

    /// Number of points of a tooth.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// A tooth's numbers, point by point.
    ///
    /// # Panics
    /// There is no such tooth.
    pub fn tooth(&self, tooth: usize) -> &[f64] {
        &self.numbers[tooth * self.points..(tooth + 1) * self.points]
    }

    /// The teeth, one after the other.
    pub fn each_tooth(&self) -> impl Iterator<Item = &[f64]> {
        (0..self.teeth).map(|tooth| self.tooth(tooth))
    }

    /// Every number changed.
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        Self { numbers: self.numbers.iter().map(|number| change(*number)).collect(), ..*self }
    }
}

/// By point and tooth.
impl Index<(usize, usize)> for ErrorTable {
    type Output = f64;

    fn index(&self, (point, tooth): (usize, usize)) -> &f64 {
        &self.numbers[tooth * self.points..(tooth + 1) * self.points][point]
    }
}

impl IndexMut<(usize, usize)> for ErrorTable {
    fn index_mut(&mut self, (point, tooth): (usize, usize)) -> &mut f64 {
        &mut self.numbers[tooth * self.points..(tooth + 1) * self.points][point]
    }
}
