//! A shaft that turns steadily.

use super::{AngleZero, ShaftPhase};
use crate::signal::SignalError;
use crate::signal::check::{check_positive, check_rate};

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
}
