//! This module gathers, while signals come, the sums by which the laws judge them.

/// Sums of the signals of all meshes and all shafts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figures {
    /// (N) Of the force of each mesh.
    pub(crate) forces: Vec<SignalFigures>,
    /// (rev/s) Of the speed of each shaft.
    pub(crate) speeds: Vec<SignalFigures>,
}

/// Sums of a signal whose length is known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SignalFigures {
    /// Samples that there will be.
    samples: usize,
    /// Samples that were added.
    added: usize,
    /// Samples that are exactly 0, and that are negative.
    zeros: usize,
    negatives: usize,
    /// The last sample, and how often the signal changed its sign from a sample to the next.
    last: f64,
    flips: usize,
    /// Sum with weights that rise evenly to the middle and fall again.
    weighted: f64,
    squares: f64,
    /// The sums of the first half, of the sample midway where there is one, and of the second half.
    parts: [f64; 3],
    least: f64,
    largest: f64,
}

impl SignalFigures {
    /// No samples yet.
    ///
    /// # Arguments
    /// * `samples` - that there will be
    pub(crate) fn new(samples: usize) -> Self {
        Self {
            samples,
            added: 0,
            zeros: 0,
            negatives: 0,
            last: 0.0,
            flips: 0,
            weighted: 0.0,
            squares: 0.0,
            parts: [0.0; 3],
            least: f64::INFINITY,
            largest: 0.0,
        }
    }

    /// Those of a whole signal.
    pub(crate) fn of(values: &[f64]) -> Self {
        let mut figures = Self::new(values.len());
        figures.add(values);
        figures
    }

    /// Adds the next samples.
    pub(crate) fn add(&mut self, values: &[f64]) {
        // Where each half ends: a sum that is chosen for every sample has to wait for memory.
        let end_of = |samples: usize| samples.saturating_sub(self.added).min(values.len());
        let ends = [end_of(self.samples / 2), end_of(self.samples.div_ceil(2)), values.len()];
        let mut from = 0;
        for (part, end) in ends.into_iter().enumerate() {
            let mut sum = self.parts[part];
            for &value in &values[from..end] {
                let before_end = self.samples.saturating_sub(self.added);
                self.added += 1;
                self.weighted += self.added.min(before_end) as f64 * value;
                self.squares += value * value;
                sum += value;
                self.largest = if value.abs() > self.largest { value.abs() } else { self.largest };
                self.least = if value < self.least { value } else { self.least };
                self.zeros += usize::from(value == 0.0);
                self.negatives += usize::from(value < 0.0);
                self.flips += usize::from(value * self.last < 0.0);
                self.last = value;
            }
            self.parts[part] = sum;
            from = end;
        }
    }

    /// The mean.
    pub(crate) fn mean(&self) -> f64 {
        self.parts.iter().sum::<f64>() / self.samples as f64
    }

    /// A mean that hardly counts the ends, so that of a vibration about as much is left as of a whole number of its periods.
    pub(crate) fn mean_in_middle(&self) -> f64 {
        self.weighted / weights(self.samples)
    }

    /// By how much the signal rises from sample to sample, in the same mean.
    pub(crate) fn rise(&self) -> f64 {
        // Σ w (s₁ − s₀) in other order: the weights of two differences beside a sample differ by 1.
        if self.samples < 2 { 0.0 } else { (self.parts[2] - self.parts[0]) / weights(self.samples - 1) }
    }

    /// The root of the mean square.
    pub(crate) fn rms(&self) -> f64 {
        (self.squares / self.samples as f64).sqrt()
    }

    /// The largest absolute value; no number where a value is none.
    pub(crate) fn largest(&self) -> f64 {
        if self.squares.is_nan() { f64::NAN } else { self.largest }
    }

    /// (-) The part of the samples that have the other sign than the sample before.
    pub(crate) fn part_of_flips(&self) -> f64 {
        self.flips as f64 / self.samples.max(1) as f64
    }

    /// (-) The part of the samples that is exactly 0.
    pub(crate) fn part_of_zeros(&self) -> f64 {
        self.zeros as f64 / self.samples.max(1) as f64
    }

    /// (-) Part of the samples that are negative.
    pub(crate) fn part_of_negatives(&self) -> f64 {
        self.negatives as f64 / self.samples.max(1) as f64
    }

    /// The least sample.
    pub(crate) fn least(&self) -> f64 {
        self.least
    }
}

/// Sum of the weights 1, 2, …, 2, 1 of some values.
fn weights(count: usize) -> f64 {
    ((count + 1) * (count + 1) / 4) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_those_of_their_definitions() {
        for count in [1, 2, 3, 6, 7, 1000, 1001] {
            let values: Vec<f64> =
                (0..count).map(|n| 3.0 + (0.1 * n as f64).cos() + 0.001 * n as f64).collect();
            let figures = SignalFigures::of(&values);
            let middle = |values: &[f64]| {
                let weight = |n: usize| (n + 1).min(values.len() - n) as f64;
                let sum: f64 = values.iter().enumerate().map(|(n, value)| weight(n) * value).sum();
                sum / (0..values.len()).map(weight).sum::<f64>()
            };
            assert!((figures.mean_in_middle() - middle(&values)).abs() < 1e-12, "{count}");
            let differences: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let rise = if count < 2 { 0.0 } else { middle(&differences) };
            assert!((figures.rise() - rise).abs() < 1e-12, "{count}: {} {rise}", figures.rise());
            assert!((figures.mean() - values.iter().sum::<f64>() / count as f64).abs() < 1e-12);
        }
        let vibration: Vec<f64> = (0..1000).map(|n| 3.0 + (0.1 * f64::from(n)).cos()).collect();
        let whole = SignalFigures::of(&vibration);
        // In blocks of any length.
        let mut vibration_in_blocks = SignalFigures::new(1000);
        vibration.chunks(97).for_each(|block| vibration_in_blocks.add(block));
        assert_eq!(vibration_in_blocks, whole);
        assert!((whole.mean_in_middle() - 3.0).abs() < 1e-3);
        let some = SignalFigures::of(&[0.0, -3.0, 0.0, 4.0]);
        assert_eq!((some.largest(), some.part_of_zeros(), some.rms()), (4.0, 0.5, 2.5));
        assert_eq!(SignalFigures::of(&[1.0, -3.0, 0.0, 4.0, -1.0]).part_of_flips(), 0.4);
        assert!(SignalFigures::of(&[1.0, f64::NAN, 2.0]).largest().is_nan());
    }
}
