//! Pulses in a tachometer's waveform.

use crate::signal::SignalError;
use crate::signal::check::{check_channel, check_positive, check_rate};

/// Parts of the sorted waveform that stand for its low and high level: neither spikes nor short pulses decide.
const LOW_LEVEL: f64 = 0.005;
const HIGH_LEVEL: f64 = 0.995;
/// Default hysteresis, as a part of the distance of the levels.
const HYSTERESIS: f64 = 0.2;

/// Side of a tachometer's pulse that counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PulseEdge {
    /// The waveform rises through the threshold.
    #[default]
    Rising,
    /// The waveform falls through the threshold.
    Falling,
}

/// Settings by which a tachometer's waveform is read.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Tachometer {
    /// (the waveform's unit) Level that a pulse crosses; by default the middle between the levels that 0.5 % of the
    /// samples are below and above.
    pub threshold: Option<f64>,
    /// (the waveform's unit) How far the waveform must have gone back beyond the threshold before another pulse counts;
    /// by default 0.2 of the distance of those levels.
    pub hysteresis: Option<f64>,
    /// Side of a pulse that counts.
    pub edge: PulseEdge,
}

/// Times at which a tachometer's waveform crosses the threshold, by straight lines between the samples.
///
/// # Arguments
/// * `waveform` - the tachometer's channel
/// * `sampling_rate_hz` - (S/s) its sampling rate
/// * `tachometer` - how it is read
///
/// Returns the times in s; 0 is the first sample. A waveform that begins beyond the threshold has no pulse there.
/// Missing and doubled pulses are found by [`super::repair_pulses`].
///
/// # Errors
/// NaN; a constant waveform; a rate or hysteresis that is not positive; a threshold that is never crossed.
///
/// ```
/// use meshtone::signal::{Tachometer, tachometer_pulses};
///
/// let waveform = [0.0, 0.0, 4.0, 5.0, 0.0, 0.0, 1.0, 5.0, 4.9, 5.0, 0.0];
/// let settings = Tachometer { threshold: Some(2.0), hysteresis: Some(0.5), ..Tachometer::default() };
/// assert_eq!(tachometer_pulses(&waveform, 10.0, &settings)?, [0.15, 0.625]);
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn tachometer_pulses(
    waveform: &[f64],
    sampling_rate_hz: f64,
    tachometer: &Tachometer,
) -> Result<Vec<f64>, SignalError> {
    check_channel(waveform)?;
    check_rate(sampling_rate_hz)?;
    let (low, high) = levels(waveform);
    let threshold = tachometer.threshold.unwrap_or(0.5 * (low + high));
    let hysteresis = tachometer.hysteresis.unwrap_or(HYSTERESIS * (high - low));
    check_positive("tachometer's hysteresis", hysteresis)?;
    let upwards = match tachometer.edge {
        PulseEdge::Rising => 1.0,
        PulseEdge::Falling => -1.0,
    };
    let above = |x: f64| upwards * (x - threshold);
    let mut armed = above(waveform[0]) < 0.0;
    let mut times_s = Vec::new();
    for (i, pair) in waveform.windows(2).enumerate() {
        let (before, after) = (above(pair[0]), above(pair[1]));
        if armed && after >= 0.0 {
            times_s.push((i as f64 + before / (before - after)) / sampling_rate_hz);
            armed = false;
        }
        armed |= after < -hysteresis;
    }
    if times_s.is_empty() {
        return Err(SignalError::parameter(
            "tachometer's threshold",
            threshold,
            "a level that the waveform crosses",
        ));
    }
    Ok(times_s)
}

/// The waveform's low and high level. Where pulses take less than 0.5 % of the time, its least and largest value.
fn levels(waveform: &[f64]) -> (f64, f64) {
    let mut sorted = waveform.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len() - 1;
    let part = |p: f64| sorted[(p * last as f64).round() as usize];
    let (least, largest) = (sorted[0], sorted[last]);
    let (low, high) = (part(LOW_LEVEL), part(HIGH_LEVEL));
    if high - low < 0.5 * (largest - least) { (least, largest) } else { (low, high) }
}
