//! Average over the revolutions of a shaft.

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
