//! All that may be doubtful about a recording and what is stated about it.

use super::{AngularSignal, ShaftPhase, SignalWarning, StatedFacts, find_mismatch, lines_off_shafts};

/// Looks for a sign that a recording does not fit the stated facts, and for tones that belong to neither shaft.
///
/// Where a stated fact does not fit, the lines at wrong orders follow from it, and only that is reported. Tones are looked for where the mate's
/// teeth are stated, since they may be its own orders otherwise, and where the recording is not [a run-up](ShaftPhase::is_run_up). That nothing repeats with the shaft is
/// among the warnings of a [`Record`](super::Record).
///
/// # Arguments
/// * `angular` - the recording over the angle of the shaft, as it is stated
/// * `stated` - the facts that the user states
/// * `phase` - of the shaft
/// * `sampling_rate_hz` - (S/s) of the recording
///
/// ```
/// use meshtone::signal::{AngularSettings, ShaftPhase, SignalWarning, StatedFacts, StatedTurning, angular_resample, check_recording};
///
/// let wave = |hz: f64, i: usize| (std::f64::consts::TAU * hz * i as f64 / 1e4).cos();
/// let noise = |i: usize| 4e-5 * (i * i % 10_007) as f64;
/// let signal: Vec<f64> = (0..20_000).map(|i| wave(380.0, i) + wave(1313.0, i) + noise(i)).collect();
/// let phase = ShaftPhase::constant(20.0, 1e4, signal.len())?;
/// let angular = angular_resample(&signal, &phase, &AngularSettings::default())?;
/// let stated = StatedFacts { teeth: 19, mate_teeth: Some(38), turning: StatedTurning::Other };
/// let warnings = check_recording(&angular, &stated, &phase, 1e4);
/// assert!(matches!(&warnings[..], [SignalWarning::ForeignTones(tones)] if (tones.strongest[0].frequency_hz - 1313.0).abs() < 0.1));
/// # Ok::<(), meshtone::signal::SignalError>(())
/// ```
pub fn check_recording(
    angular: &AngularSignal,
    stated: &StatedFacts,
    phase: &ShaftPhase,
    sampling_rate_hz: f64,
) -> Vec<SignalWarning> {
    if let Some(mismatch) = find_mismatch(angular, stated) {
        return vec![SignalWarning::DoesNotFit(mismatch)];
    }
    // Over a run-up, what rings at a resonance looks like a foreign tone, and a tone of a constant frequency has no order.
    if phase.is_run_up(sampling_rate_hz) {
        return Vec::new();
    }
    let mean_speed_hz = phase.mean_speed_hz(sampling_rate_hz);
    let tones =
        |mate_teeth| lines_off_shafts(angular, stated.teeth, mate_teeth).tones(angular, mean_speed_hz);
    stated.mate_teeth.and_then(tones).map(SignalWarning::ForeignTones).into_iter().collect()
}
