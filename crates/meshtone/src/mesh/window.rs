//! Means along contact lines: of a quantity over a stretch of the path of contact.
//!
//! Helical teeth touch along a line that runs over the face from one position of the path to another, ε_β base pitches away. What is read
//! at a single position of spur teeth is the mean over that stretch here; over the stretch of a slice, where the face has slices. The
//! integrals are exact to the last place between the ends of the path, so that no number of slices adds anything of its own.

/// The integral along the path of a quantity that is given at equal distances, straight between them and 0 outside the path.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Integral {
    /// (base pitches) Where the path begins.
    from: f64,
    /// (base pitches) From one value to the next.
    step: f64,
    values: Vec<f64>,
    /// Up to each value.
    until_value: Vec<f64>,
}

impl Integral {
    /// Sums a quantity up.
    ///
    /// # Arguments
    /// * `ends` - (base pitches) of the path
    /// * `values` - from one end to the other, at least two
    pub(super) fn new([begins, ends]: [f64; 2], values: &[f64]) -> Self {
        let step = (ends - begins) / values.len().saturating_sub(1).max(1) as f64;
        let mut sum = 0.0;
        let sums = values.windows(2).map(|pair| {
            sum += (pair[0] + pair[1]) / 2.0 * step;
            sum
        });
        let until_value = std::iter::once(0.0).chain(sums).collect();
        Self { from: begins, step, values: values.to_vec(), until_value }
    }

    /// The integral between two positions.
    pub(super) fn between(&self, [from, until]: [f64; 2]) -> f64 {
        self.until(until) - self.until(from)
    }

    fn until(&self, position: f64) -> f64 {
        let last = self.values.len() - 1;
        if self.step <= 0.0 {
            return 0.0;
        }
        let place = ((position - self.from) / self.step).clamp(0.0, last as f64);
        let n = (place as usize).min(last.saturating_sub(1));
        let (part, [here, next]) = (place - n as f64, [n, (n + 1).min(last)].map(|n| self.values[n]));
        self.until_value[n] + self.step * part * (here + part / 2.0 * (next - here))
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

/// Whether teeth of an overlap are helical ones: below a millionth of a base pitch they touch at one position of the path, as spur teeth do. The
/// limit is for rounding alone, the two laws are the same there.
///
/// # Arguments
/// * `overlap` - (base pitches) of the face or of a slice
pub(crate) fn is_slanted(overlap: f64) -> bool {
    overlap.abs() > 1e-6
}

impl Window {
    /// Whether the slice touches at one position, as spur teeth do.
    pub(crate) fn is_a_point(&self) -> bool {
        !is_slanted(self.overlap * self.width)
    }

    /// (base pitches) The stretch while the middle of the face is at a position.
    pub(super) fn around(&self, position: f64) -> [f64; 2] {
        let (at, half) = (position + self.overlap * self.middle, self.overlap.abs() * self.width / 2.0);
        [at - half, at + half]
    }
}
