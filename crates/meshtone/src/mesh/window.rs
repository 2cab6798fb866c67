//! Means along contact lines: of a quantity over a stretch of the path of contact.
//!
//! Helical teeth touch along a line that runs over the face from one position of the path to another, ε_β base pitches away. What is read
//! at a single position of spur teeth is the mean over that stretch here; over the stretch of a slice, where the face has slices. The
//! mean is that of the tabulated quantity, taken as constant between the middles of its steps, so that no number of slices adds anything
//! of its own.

/// The integral of a tabulated quantity, from the left of its table on.
pub(super) struct Integral {
    /// (base pitches) Left edge of the table's first step.
    from: f64,
    /// (base pitches) From one position of the table to the next.
    step: f64,
    /// Up to each edge.
    until_edge: Vec<f64>,
}

impl Integral {
    /// Sums a table up.
    ///
    /// # Arguments
    /// * `first`, `step` - (base pitches) position of the first value, and from one to the next
    /// * `values` - constant half a step to either side
    pub(super) fn new(first: f64, step: f64, values: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let sums = values.map(|value| {
            sum += value * step;
            sum
        });
        Self { from: first - step / 2.0, step, until_edge: std::iter::once(0.0).chain(sums).collect() }
    }

    /// The integral between two positions; beyond the table the quantity is 0.
    pub(super) fn between(&self, from: f64, until: f64) -> f64 {
        self.until(until) - self.until(from)
    }

    fn until(&self, position: f64) -> f64 {
        let last = self.until_edge.len() - 1;
        let place = ((position - self.from) / self.step).clamp(0.0, last as f64);
        let edge = (place as usize).min(last.saturating_sub(1));
        let [before, after] = [edge, (edge + 1).min(last)].map(|edge| self.until_edge[edge]);
        before + (place - edge as f64) * (after - before)
    }
}

/// (-) A place along the face, from −½ to ½, after a number of slices from its end at negative z.
///
/// # Arguments
/// * `passed` - how many slices lie before it, of the middle of one a half more
/// * `slices` - of the whole face
pub(crate) fn place_on_face(passed: f64, slices: usize) -> f64 {
    passed / slices as f64 - 0.5
}

/// The stretch of the path that a slice of the face spans.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// (base pitches) Overlap of the whole face: how much farther on its path a pair is at the end of the face at positive z than at the
    /// other one.
    pub(crate) overlap: f64,
    /// (-) Middle of the slice, from −½ to ½.
    pub(crate) middle: f64,
    /// (-) Width of the slice as a part of the face's.
    pub(crate) width: f64,
}

impl Window {
    /// (base pitches) The stretch while the middle of the face is at a position.
    pub(super) fn around(&self, position: f64) -> [f64; 2] {
        let (at, half) = (position + self.overlap * self.middle, self.overlap.abs() * self.width / 2.0);
        [at - half, at + half]
    }
}
