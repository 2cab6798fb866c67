//! Noise in the samples of a channel.

use crate::random::Draws;

/// (the signal's unit) Standard deviation of samples in single precision, of the whole population; 0 for none.
///
/// # Arguments
/// * `signal` - the samples
///
/// ```
/// assert_eq!(meshtone::sensor::standard_deviation_of_channel(&[1.0, 3.0, 1.0, 3.0]), 1.0);
/// ```
pub fn standard_deviation_of_channel(signal: &[f32]) -> f64 {
    let count = signal.len().max(1) as f64;
    let mean = signal.iter().map(|&x| f64::from(x)).sum::<f64>() / count;
    (signal.iter().map(|&x| (f64::from(x) - mean).powi(2)).sum::<f64>() / count).sqrt()
}

/// Adds white Gaussian noise to a channel.
///
/// # Arguments
/// * `draws` - of the noise
/// * `deviation` - (the channel's unit) its standard deviation
/// * `signal` - the channel
pub fn add_white_noise(draws: &mut Draws, deviation: f64, signal: &mut [f32]) {
    for pair in signal.chunks_mut(2) {
        for (sample, normal) in pair.iter_mut().zip(draws.normals()) {
            *sample = (f64::from(*sample) + deviation * normal) as f32;
        }
    }
}

/// Adds recorded noise to a channel. A piece that reaches the end of the recording goes on at its beginning.
///
/// # Arguments
/// * `noise` - (-) the recording, of the standard deviation 1
/// * `first` - the sample where the piece begins
/// * `deviation` - (the channel's unit) standard deviation of what is added
/// * `signal` - the channel
pub fn add_recorded_noise(noise: &[f32], first: usize, deviation: f64, signal: &mut [f32]) {
    let piece = noise.iter().cycle().skip(first);
    for (sample, noise) in signal.iter_mut().zip(piece) {
        *sample = (f64::from(*sample) + deviation * f64::from(*noise)) as f32;
    }
}
