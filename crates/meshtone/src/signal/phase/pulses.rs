//! Phase from pulses.

use super::{AngleZero, PulseTrain, ShaftPhase, repair_pulses};
use crate::interpolation::PchipThrough;
use crate::signal::SignalError;
use crate::signal::check::{check_positive, check_rate};

/// Relative deviation of the stated from the found speed that is no mistake.
const SPEED_TOLERANCE: f64 = 0.05;

impl ShaftPhase {
    /// A shaft with pulses at equal angles; the first pulse is angle 0.
    ///
    /// Between the pulses PCHIP (monotone, continuous in speed). Missing and doubled pulses are repaired as
    /// [`repair_pulses`] does, with a warning for each. The phase covers the samples from the first to the last pulse, and at each end the
    /// one beyond, by a straight line: N pulses once a revolution are N − 1 whole revolutions wherever they fall between samples.
    ///
    /// # Arguments
    /// * `time_s` - (s) the pulses' times, strictly rising; 0 is the recording's first sample
    /// * `pulses_per_revolution` - at least 1
    /// * `stated_speed_hz` - (Hz) what the speed should be, to be checked to 5 %
    /// * `sampling_rate_hz` - (S/s) of the recording
    /// * `samples` - length of the recording
    ///
    /// # Errors
    /// Those of [`repair_pulses`]; a stated speed that is not theirs; no
    /// samples between the pulses.
    ///
    /// ```
    /// use meshtone::signal::ShaftPhase;
    ///
    /// let pulses = [0.005, 0.055, 0.105, 0.155];
    /// let phase = ShaftPhase::from_pulses(&pulses, 1, Some(20.0), 1000.0, 200)?;
    /// assert_eq!(phase.first_sample, 5);
    /// assert_eq!(phase.revolutions.len(), 151);
    /// let error = ShaftPhase::from_pulses(&pulses, 2, Some(20.0), 1000.0, 200).unwrap_err();
    /// assert!(error.to_string().starts_with("the pulses give 10.0000 Hz, but 20.0000 Hz is stated (+100.0 %)"));
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn from_pulses(
        time_s: &[f64],
        pulses_per_revolution: u32,
        stated_speed_hz: Option<f64>,
        sampling_rate_hz: f64,
        samples: usize,
    ) -> Result<Self, SignalError> {
        check_positive("pulses_per_revolution", f64::from(pulses_per_revolution))?;
        check_rate(sampling_rate_hz)?;
        let PulseTrain { time_s, warnings } = repair_pulses(time_s)?;
        let (first_s, last_s) = (time_s[0], time_s[time_s.len() - 1]);
        let per_pulse = 1.0 / f64::from(pulses_per_revolution);
        check_speed(stated_speed_hz, (time_s.len() - 1) as f64 * per_pulse / (last_s - first_s))?;
        let speed_hz = |pulse: usize| per_pulse / (time_s[pulse + 1] - time_s[pulse]);
        let (first_speed_hz, last_speed_hz) = (speed_hz(0), speed_hz(time_s.len() - 2));
        let angles = (0..time_s.len()).map(|pulse| pulse as f64 * per_pulse).collect();
        let curve = PchipThrough::new(time_s, angles);
        let first_sample = (first_s * sampling_rate_hz).floor().max(0.0) as usize;
        let end = ((last_s * sampling_rate_hz).ceil() + 1.0).clamp(0.0, samples as f64) as usize;
        let time_s = |i: usize| i as f64 / sampling_rate_hz;
        let between = (first_sample..end).map(|i| time_s(i).clamp(first_s, last_s));
        let mut revolutions = curve.at_rising(between);
        if let Some(first) = revolutions.first_mut() {
            *first += (time_s(first_sample) - first_s).min(0.0) * first_speed_hz;
        }
        if let Some(last) = revolutions.last_mut() {
            *last += (time_s(end - 1) - last_s).max(0.0) * last_speed_hz;
        }
        let zero = if pulses_per_revolution == 1 { AngleZero::Pulse } else { AngleZero::FirstPulse };
        Ok(Self::new(first_sample, revolutions)?.with_zero(zero).with_warnings(warnings))
    }
}

fn check_speed(stated_hz: Option<f64>, found_hz: f64) -> Result<(), SignalError> {
    let Some(stated_hz) = stated_hz else { return Ok(()) };
    check_positive("stated_speed_hz", stated_hz)?;
    if (stated_hz / found_hz - 1.0).abs() > SPEED_TOLERANCE {
        return Err(SignalError::SpeedMismatch { found_hz, stated_hz });
    }
    Ok(())
}
