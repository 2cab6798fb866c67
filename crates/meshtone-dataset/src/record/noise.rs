//! Noise that is added to raw channels: white, or that of a recorded machine.

use meshtone::random::{Draws, Purpose};
use meshtone::sensor::{add_white_noise, standard_deviation_of_channel};

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
        (Some(ratio_db), _) => standard_deviation_of_channel(signal) * libm::pow(10.0, -ratio_db / 20.0),
        (None, Some(level)) => level,
        (None, None) => return Ok(()),
    };
    let mut draws = Draws::new(drawn.seed, Purpose::RecordNoise, channel);
    if let Some(background) = background {
        background.check_length(signal.len(), rate_hz).map_err(|problem| format!("background: {problem}"))?;
        background.add(&mut draws, deviation, signal);
        return Ok(());
    }
    add_white_noise(&mut draws, deviation, signal);
    Ok(())
}
