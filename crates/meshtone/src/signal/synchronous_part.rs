//! The part of a recording that repeats with every revolution of a shaft.

/// Part of a recording's mean square that its synchronous average holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SynchronousPart {
    /// (-) Mean square of the average over that of the recording, both without their means.
    pub of_mean_square: f64,
    /// Revolutions that were averaged; noise alone leaves 1/revolutions of its mean square.
    pub revolutions: usize,
}

impl SynchronousPart {
    /// Returns whether at least half of the average is what noise leaves: nothing in the recording clearly repeats with the shaft.
    ///
    /// With part \\(\rho\\) of the mean square synchronous, the average of N revolutions holds \\(\rho + (1 - \rho)/N\\) of it. Of two
    /// revolutions the average holds half of noise and all of what repeats, so that the bound lies midway there.
    pub fn is_noise(&self) -> bool {
        let revolutions = self.revolutions as f64;
        self.of_mean_square * revolutions < 1.0 + (0.5 * (revolutions - 1.0)).min(1.0)
    }
}

/// The part of the mean square of some revolutions that their average holds. None of fewer than two revolutions, or of a constant.
///
/// # Arguments
/// * `angular` - the signal over whole revolutions
/// * `average` - its synchronous average
///
/// ```
/// use meshtone::signal::{AngularSignal, synchronous_average, synchronous_part};
///
/// let values = vec![1.0, -1.0, 3.0, -3.0];
/// let angular = AngularSignal { points_per_revolution: 2, start_rev: 0.0, nyquist_order: 1.0, values };
/// let average = synchronous_average(&angular)?;
/// let part = synchronous_part(&angular.values, &average.values).ok_or("constant")?;
/// assert_eq!(part.of_mean_square, 0.8);
/// assert!(!part.is_noise());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn synchronous_part(values: &[f64], average: &[f64]) -> Option<SynchronousPart> {
    let mean_square = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
    };
    let revolutions = values.len().checked_div(average.len())?;
    let whole = mean_square(&values[..revolutions * average.len()]);
    (revolutions >= 2 && whole > 0.0)
        .then(|| SynchronousPart { of_mean_square: mean_square(average) / whole, revolutions })
}
