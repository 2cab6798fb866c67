//! Phase by integration of the speed.

use super::{AngleZero, ShaftPhase};
use crate::signal::check::{check_count, check_finite, check_length, check_positive, check_rate};
use crate::signal::{SignalError, SignalWarning};

impl ShaftPhase {
    /// A shaft of constant speed, at angle 0 at the first sample.
    ///
    /// # Arguments
    /// * `speed_hz` - (Hz) its speed
    /// * `sampling_rate_hz` - (S/s) of the recording
    /// * `samples` - length of the recording
    ///
    /// # Errors
    /// A speed or rate that is not positive; fewer than two samples.
    ///
    /// ```
    /// let phase = meshtone::signal::ShaftPhase::constant(25.0, 1000.0, 3)?;
    /// assert_eq!(phase.revolutions, [0.0, 0.025, 0.05]);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn constant(speed_hz: f64, sampling_rate_hz: f64, samples: usize) -> Result<Self, SignalError> {
        check_positive("speed_hz", speed_hz)?;
        check_rate(sampling_rate_hz)?;
        let step_rev = speed_hz / sampling_rate_hz;
        let revolutions = (0..samples).map(|i| i as f64 * step_rev).collect();
        Ok(Self::new(0, revolutions)?.with_zero(AngleZero::FirstSample))
    }

    /// A shaft whose speed is known at some times: straight lines between them, integrated exactly.
    ///
    /// Before the first time and after the last the speed is constant; where the recording goes on after the last one, a
    /// warning says so. The angle is 0 at the first sample.
    ///
    /// # Arguments
    /// * `time_s` - (s) strictly rising; 0 is the first sample
    /// * `speed_hz` - (Hz) the speed at those times, positive
    /// * `sampling_rate_hz` - (S/s) of the recording
    /// * `samples` - length of the recording
    ///
    /// # Errors
    /// Times that do not rise; different lengths; fewer than two times; a speed that is not positive.
    ///
    /// ```
    /// use meshtone::signal::ShaftPhase;
    ///
    /// // From 20 to 60 Hz in 1 s: 20 t + 20 t².
    /// let phase = ShaftPhase::from_speed_profile(&[0.0, 1.0], &[20.0, 60.0], 1000.0, 1001)?;
    /// assert!((phase.revolutions[500] - 15.0).abs() < 1e-12);
    /// assert!((phase.revolutions[1000] - 40.0).abs() < 1e-12);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn from_speed_profile(
        time_s: &[f64],
        speed_hz: &[f64],
        sampling_rate_hz: f64,
        samples: usize,
    ) -> Result<Self, SignalError> {
        check_profile(time_s, speed_hz)?;
        check_rate(sampling_rate_hz)?;
        // Angle at the profile's own times, relative to the first of them.
        let mut at_knots = vec![0.0; time_s.len()];
        for i in 1..time_s.len() {
            let mean_hz = 0.5 * (speed_hz[i - 1] + speed_hz[i]);
            at_knots[i] = at_knots[i - 1] + mean_hz * (time_s[i] - time_s[i - 1]);
        }
        let last = time_s.len() - 1;
        let mut piece = 0;
        let mut angle = |t: f64| {
            while piece + 1 < last && time_s[piece + 1] <= t {
                piece += 1;
            }
            let since = t - time_s[piece];
            if t < time_s[0] {
                return speed_hz[0] * since;
            }
            if t > time_s[last] {
                return at_knots[last] + speed_hz[last] * (t - time_s[last]);
            }
            let slope = (speed_hz[piece + 1] - speed_hz[piece]) / (time_s[piece + 1] - time_s[piece]);
            at_knots[piece] + since * (speed_hz[piece] + 0.5 * slope * since)
        };
        let start = angle(0.0);
        let revolutions = (0..samples).map(|i| angle(i as f64 / sampling_rate_hz) - start).collect();
        let recording_end_s = samples.saturating_sub(1) as f64 / sampling_rate_hz;
        let profile_end_s = time_s[last];
        let early = profile_end_s < recording_end_s * (1.0 - 1e-9) - 1.0 / sampling_rate_hz;
        let warning = early.then_some(SignalWarning::ProfileEndsEarly { profile_end_s, recording_end_s });
        let phase = Self::new(0, revolutions)?.with_zero(AngleZero::FirstSample);
        Ok(phase.with_warnings(warning.into_iter().collect()))
    }

    /// A shaft whose speed is known at every sample: trapezoidal rule, angle 0 at the first sample.
    ///
    /// # Arguments
    /// * `speed_hz` - (Hz) the speed at each sample, positive
    /// * `sampling_rate_hz` - (S/s) of the recording
    ///
    /// # Errors
    /// A shaft that stands still or turns backwards; fewer than two samples; NaN.
    ///
    /// ```
    /// let phase = meshtone::signal::ShaftPhase::from_speed_samples(&[10.0, 20.0, 30.0], 100.0)?;
    /// assert!((phase.revolutions[2] - 0.4).abs() < 1e-15);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn from_speed_samples(speed_hz: &[f64], sampling_rate_hz: f64) -> Result<Self, SignalError> {
        check_rate(sampling_rate_hz)?;
        check_finite(speed_hz)?;
        let mut sum = 0.0;
        let first = speed_hz.first().map(|_| 0.0);
        let others = speed_hz.windows(2).map(|pair| {
            sum += 0.5 * (pair[0] + pair[1]);
            sum / sampling_rate_hz
        });
        let phase = Self::new(0, first.into_iter().chain(others).collect())?;
        Ok(phase.with_zero(AngleZero::FirstSample))
    }
}

fn check_profile(time_s: &[f64], speed_hz: &[f64]) -> Result<(), SignalError> {
    check_length("speeds of the profile", speed_hz.len(), time_s.len())?;
    check_count("points of the speed profile", time_s.len(), 2)?;
    check_finite(time_s)?;
    check_finite(speed_hz)?;
    for &speed in speed_hz {
        check_positive("speed of the profile", speed)?;
    }
    match time_s.windows(2).find(|pair| pair[1] <= pair[0]) {
        Some(pair) => {
            Err(SignalError::parameter("time of the speed profile", pair[1], "later than the one before it"))
        }
        None => Ok(()),
    }
}
