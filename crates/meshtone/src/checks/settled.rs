//! This module tells by a signal itself whether it still holds a transient.

/// Windows that a signal is divided into, at most.
const MOST_WINDOWS: usize = 16;
/// Fewest windows in which a trend can be told from chance.
const FEWEST_WINDOWS: usize = 6;
/// (g, N) Rms below which a signal is less than what sensors tell from nothing.
const NOTHING: f64 = 1e-4;
/// (-) Part of a force's mean that it varies by at least, as far as a judgement of it is concerned.
const LEAST_VARYING: f64 = 0.05;
/// (-) Standard errors from which on a trend is not chance.
const CERTAIN: f64 = 4.0;

/// Standard deviation of a signal, and at least a twentieth of its mean: of a force that hardly varies less is of no interest.
///
/// # Arguments
/// * `mean`, `mean_square` - of the signal
pub(crate) fn varying(mean: f64, mean_square: f64) -> f64 {
    (mean_square - mean * mean).max(0.0).sqrt().max(LEAST_VARYING * mean.abs())
}

/// Sums over successive windows of a signal, gathered while it comes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct WindowSums {
    /// Samples of a window.
    length: usize,
    /// Samples that were added.
    samples: usize,
    /// The sum and the sum of squares of each window.
    sums: Vec<[f64; 2]>,
}

impl WindowSums {
    /// No samples yet.
    ///
    /// # Arguments
    /// * `samples` - that there will be
    /// * `samples_per_turn` - of the slowest shaft: a window holds whole turns of it where the signal is long enough
    pub(crate) fn new(samples: usize, samples_per_turn: usize) -> Self {
        let turns = samples.checked_div(samples_per_turn).unwrap_or(0);
        let (windows, length) = if turns >= FEWEST_WINDOWS {
            let windows = turns.min(MOST_WINDOWS);
            // Of the turns that are left over, none is looked at.
            (windows, turns / windows * samples_per_turn)
        } else {
            (MOST_WINDOWS, samples / MOST_WINDOWS)
        };
        Self { length, samples: 0, sums: vec![[0.0; 2]; if length == 0 { 0 } else { windows }] }
    }

    /// Adds the next samples.
    pub(crate) fn add(&mut self, mut signal: &[f64]) {
        while !signal.is_empty() && self.samples < self.length * self.sums.len() {
            let (window, place) = (self.samples / self.length, self.samples % self.length);
            let (now, later) = signal.split_at(signal.len().min(self.length - place));
            let [sum, squares] = &mut self.sums[window];
            for value in now {
                *sum += value;
                *squares += value * value;
            }
            self.samples += now.len();
            signal = later;
        }
    }

    /// Square of what the signal varies by in each window, see [`varying`].
    pub(crate) fn variances(&self) -> Vec<f64> {
        let count = self.length as f64;
        self.sums.iter().map(|[sum, squares]| varying(sum / count, squares / count).powi(2)).collect()
    }

    /// Samples of a window.
    pub(crate) fn window_samples(&self) -> usize {
        self.length
    }
}

/// (-) By what part a transient raises (or lowers) the rms of a signal; 0 where the windows show none that is not chance.
///
/// The variance of a steady motion is the same in every window but for chance, and a transient's falls with twice the rate of its mode:
/// `v_k = a + b exp(−2 δ t_k)` is fitted with the least squares.
///
/// # Arguments
/// * `variances` - of the signal in equal windows, in order
/// * `decay_per_window` - (-) δ times the length of a window
pub(crate) fn transient_part(variances: &[f64], decay_per_window: f64) -> f64 {
    let count = variances.len();
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / count as f64;
    let whole = mean(&mut variances.iter().copied());
    if count < FEWEST_WINDOWS || whole.is_nan() || whole.sqrt() < NOTHING {
        return 0.0;
    }
    // A mode that hardly decays is still one that fades: its trend is straight.
    let rate = decay_per_window.clamp(1e-3, 5.0);
    let left: Vec<f64> = (0..count).map(|k| (-2.0 * rate * (k as f64 + 0.5)).exp()).collect();
    let left_mean = mean(&mut left.iter().copied());
    let spread: f64 = left.iter().map(|left| (left - left_mean).powi(2)).sum();
    let slope =
        (left.iter().zip(variances)).map(|(left, v)| (left - left_mean) * (v - whole)).sum::<f64>() / spread;
    let steady = whole - slope * left_mean;
    let misses: f64 = (left.iter().zip(variances)).map(|(left, v)| (v - steady - slope * left).powi(2)).sum();
    let error = (misses / (count - 2) as f64 / spread).sqrt();
    if slope.abs() <= CERTAIN * error {
        0.0
    } else if steady > 0.0 {
        ((whole / steady).sqrt() - 1.0).abs()
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Draws, Purpose};

    /// A steady noise with a transient of a given amplitude.
    fn windows(amplitude: f64, turns: usize) -> WindowSums {
        let mut draws = Draws::new(5, Purpose::Candidate, 0);
        let signal: Vec<f64> = (0..16_000)
            .map(|n| {
                let t = n as f64 / 16_000.0;
                draws.uniform(0.0, 3f64.sqrt()) + amplitude * (-3.0 * t).exp() * (700.0 * t).cos()
            })
            .collect();
        let mut windows = WindowSums::new(signal.len(), signal.len() / turns);
        signal.chunks(97).for_each(|block| windows.add(block));
        windows
    }

    #[test]
    fn a_transient_is_told_from_chance() {
        for turns in [1, 7, 16, 33] {
            let of = |amplitude: f64| {
                let windows = windows(amplitude, turns);
                transient_part(&windows.variances(), 3.0 * windows.window_samples() as f64 / 16_000.0)
            };
            assert_eq!(of(0.0), 0.0, "{turns}");
            // The mean square of the transient is 1/12 of the square of its amplitude.
            let expected = (1.0 + 1.0 / 12.0_f64).sqrt() - 1.0;
            assert!((of(1.0) / expected - 1.0).abs() < 0.3, "{turns}: {}", of(1.0));
        }
        assert_eq!(transient_part(&[1.0; 3], 1.0), 0.0);
        // A force that varies by a hundredth of itself at first, and by nothing later, is steady.
        let mut force = WindowSums::new(16_000, 1000);
        let fading = |n: u32| 100.0 + (-f64::from(n) / 2000.0).exp() * f64::from(n).sin();
        force.add(&(0..16_000).map(fading).collect::<Vec<_>>());
        assert!(transient_part(&force.variances(), 0.5) < 1e-5);
        assert_eq!(WindowSums::new(3, 1000).variances(), [0.0; 0]);
    }
}
