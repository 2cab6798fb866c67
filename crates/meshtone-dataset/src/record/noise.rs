//! Noise that is added to raw channels: white, or that of a recorded machine.

use meshtone::random::{Draws, Purpose};

use crate::draw::{DrawnRecord, NOISE_KEYS};
use crate::plan::Background;

/// Adds white Gaussian noise, or a piece of a machine's background, to acceleration channels, with the level that the record's values say.
///
/// # Arguments
/// * `drawn` - the record
/// * `background` - of the plan; none for white noise
/// * `channel` - number of the channel
/// * `rate_hz` - (S/s) the sampling rate
/// * `signal` - (g) its samples
///
/// # Errors
/// The background is shorter than the signal.
pub(super) fn add(
    drawn: &DrawnRecord,
    background: Option<&Background>,
    channel: u64,
    rate_hz: f64,
    signal: &mut [f32],
) -> Result<(), String> {
    let [relative_db, level_g] = NOISE_KEYS.map(|key| drawn.value(key));
    let deviation = match (relative_db, level_g) {
        (Some(ratio_db), _) => standard_deviation(signal) * libm::pow(10.0, -ratio_db / 20.0),
        (None, Some(level)) => level,
        (None, None) => return Ok(()),
    };
    let mut draws = Draws::new(drawn.seed, Purpose::RecordNoise, channel);
    if let Some(background) = background {
        background.check_length(signal.len(), rate_hz).map_err(|problem| format!("background: {problem}"))?;
        background.add(&mut draws, deviation, signal);
        return Ok(());
    }
    draws.add_normals(deviation, signal);
    Ok(())
}

/// (the signal's unit) Standard deviation, in the order of the samples: a data set keeps its values.
fn standard_deviation(signal: &[f32]) -> f64 {
    let count = signal.len().max(1) as f64;
    let mean = signal.iter().map(|&x| f64::from(x)).sum::<f64>() / count;
    (signal.iter().map(|&x| (f64::from(x) - mean).powi(2)).sum::<f64>() / count).sqrt()
}
