//! Average over the revolutions of a shaft.

use super::{AngularSignal, SignalError};

/// (rev) The fewest revolutions that an average is computed from.
pub const FEWEST_REVOLUTIONS: usize = 2;

/// Average of a signal over whole revolutions, sample by sample.
///
/// # Arguments
/// * `signal` - the signal, from any angle of the shaft on
/// * `samples_per_revolution` - whole number of samples in a revolution
///
/// Returns `samples_per_revolution` values; an incomplete last revolution is left out. Empty where the signal is
/// shorter than a revolution.
///
/// ```
/// let average = meshtone::signal::revolution_average(&[1.0, 2.0, 3.0, 4.0, 9.0], 2);
/// assert_eq!(average, [2.0, 3.0]);
/// ```
pub fn revolution_average(signal: &[f64], samples_per_revolution: usize) -> Vec<f64> {
    let revolutions = signal.len().checked_div(samples_per_revolution).unwrap_or(0);
    if revolutions == 0 {
        return Vec::new();
    }
    let mut average = vec![0.0; samples_per_revolution];
    for revolution in signal.chunks_exact(samples_per_revolution) {
        for (sum, value) in average.iter_mut().zip(revolution) {
            *sum += value;
        }
    }
    average.iter_mut().for_each(|sum| *sum /= revolutions as f64);
    average
}

/// The part of a signal that repeats with every revolution of a shaft.
#[derive(Debug, Clone, PartialEq)]
pub struct SynchronousAverage {
    /// Number of revolutions that were averaged. What does not repeat falls with its square root.
    pub revolutions: usize,
    /// (orders) Beyond this order of the shaft the recording holds nothing.
    pub nyquist_order: f64,
    /// The average at equal angles, from the angle where the first revolution began.
    pub values: Vec<f64>,
}

impl SynchronousAverage {
    /// The average, unless there are too few revolutions to speak of one.
    pub(super) fn of_enough_revolutions(self) -> Result<Self, SignalError> {
        if self.revolutions < FEWEST_REVOLUTIONS {
            let revolutions = self.revolutions as f64;
            return Err(SignalError::TooFewRevolutions { revolutions, needed: FEWEST_REVOLUTIONS });
        }
        Ok(self)
    }
}

/// Time synchronous average: the mean of all revolutions, angle by angle.
///
/// Tones that do not repeat with the shaft and noise fall with the square root of the number of revolutions (a tone at a
/// fraction of an order as a sinc comb).
///
/// # Arguments
/// * `angular` - the signal over whole revolutions
///
/// # Errors
/// Fewer than two revolutions.
///
/// Sources: S. G. Braun, "The extraction of periodic waveforms by time domain averaging", Acustica 32 (1975) 69–77;
/// P. D. McFadden, "A revised model for the extraction of periodic waveforms by time domain averaging", Mech. Syst. Signal
/// Process. 1 (1987) 83–95.
///
/// ```
/// use meshtone::signal::{AngularSignal, synchronous_average};
///
/// let values = vec![1.0, 2.0, 3.0, 6.0];
/// let angular = AngularSignal { points_per_revolution: 2, start_rev: 0.0, nyquist_order: 1.0, values };
/// let average = synchronous_average(&angular)?;
/// assert_eq!((average.values, average.revolutions), (vec![2.0, 4.0], 2));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn synchronous_average(angular: &AngularSignal) -> Result<SynchronousAverage, SignalError> {
    average_of(angular, &angular.values).of_enough_revolutions()
}

/// Averages over segments of equally many revolutions: records in the order of time out of one long recording.
///
/// # Arguments
/// * `angular` - the signal over whole revolutions
/// * `revolutions` - (at least 2) of each segment; what is left at the end is not used
///
/// # Errors
/// Fewer than two revolutions a segment; not even one segment.
///
/// ```
/// use meshtone::signal::{AngularSignal, segmented_averages};
///
/// let values = vec![1.0, 2.0, 3.0, 6.0, 0.0, 1.0, 2.0, 1.0, 7.0, 7.0];
/// let angular = AngularSignal { points_per_revolution: 2, start_rev: 0.0, nyquist_order: 1.0, values };
/// let averages = segmented_averages(&angular, 2)?;
/// assert_eq!(averages.len(), 2);
/// assert_eq!(averages[1].values, [1.0, 1.0]);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn segmented_averages(
    angular: &AngularSignal,
    revolutions: usize,
) -> Result<Vec<SynchronousAverage>, SignalError> {
    if revolutions < FEWEST_REVOLUTIONS {
        return Err(SignalError::parameter("revolutions of a segment", revolutions as f64, "at least 2"));
    }
    let there_are = angular.revolutions();
    if there_are < revolutions {
        return Err(SignalError::TooFewRevolutions { revolutions: there_are as f64, needed: revolutions });
    }
    let segment = angular.points_per_revolution * revolutions;
    let segments = angular.values.chunks_exact(segment);
    segments.map(|values| average_of(angular, values).of_enough_revolutions()).collect()
}

/// The average of values of a signal, of however few revolutions.
pub(super) fn average_of(angular: &AngularSignal, values: &[f64]) -> SynchronousAverage {
    SynchronousAverage {
        revolutions: values.len().checked_div(angular.points_per_revolution).unwrap_or(0),
        nyquist_order: angular.nyquist_order,
        values: revolution_average(values, angular.points_per_revolution),
    }
}
