//! Straight lines between points.

use super::locate;

/// Straight lines between the points of a uniform grid.
///
/// ```
/// use meshtone::interpolation::UniformLinear;
/// let line = UniformLinear::uniform(0.0, 1.0, &[1.0, 3.0, 2.0]);
/// assert_eq!(line.at(1.5), 2.5);
/// ```
#[derive(Debug, Clone)]
pub struct UniformLinear<'a> {
    start: f64,
    step: f64,
    values: &'a [f64],
}

impl<'a> UniformLinear<'a> {
    /// Lines through `values` at `start`, `start + step`, ….
    ///
    /// # Arguments
    /// * `start`, `step` - the grid
    /// * `values` - (at least 2) the points
    pub fn uniform(start: f64, step: f64, values: &'a [f64]) -> Self {
        Self { start, step, values }
    }

    /// The curve at `x`.
    pub fn at(&self, x: f64) -> f64 {
        let (i, t) = locate(x, self.start, self.step, self.values.len());
        self.values[i] + t * (self.values[i + 1] - self.values[i])
    }
}

/// The value at a place on straight lines between points that need not be uniform, and that of the nearest point outside.
///
/// # Arguments
/// * `places` - rising
/// * `values` - at these; at least one
/// * `place` - where the value is wanted
pub(crate) fn straight_between(places: &[f64], values: &[f64], place: f64) -> f64 {
    let above = places.partition_point(|&point| point <= place);
    match (above.checked_sub(1), values.get(above)) {
        (Some(below), Some(to)) => {
            let part = (place - places[below]) / (places[above] - places[below]);
            values[below] + part * (to - values[below])
        }
        (_, nearest) => *nearest.unwrap_or(&values[values.len() - 1]),
    }
}
