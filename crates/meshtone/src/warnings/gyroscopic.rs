//! Gyroscopic moments: by how much they shift the modes, and what the steps leave out of them.

use std::f64::consts::TAU;

use crate::error::{ScenarioWarning, WarningKind};
use crate::machine::Spinning;
use crate::simulate::Stages;

/// (-) Shift of a mode's frequency that is left out without a warning.
const TOLERATED_SHIFT: f64 = 0.02;

/// A mode that gyroscopic moments shift.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct GyroscopicShift {
    /// (Hz) Its natural frequency without them.
    pub frequency_hz: f64,
    /// (Hz) Its natural frequency with them.
    pub shifted_hz: f64,
}

impl Stages {
    /// By how much gyroscopic moments shift each mode of shafts of beams that deforms them up to the highest stepped frequency, in rising order; none
    /// of a rig.
    ///
    /// # Arguments
    /// * `speed_hz` - (rev/s) of the motor
    pub fn gyroscopic_shifts(&self, speed_hz: f64) -> Vec<GyroscopicShift> {
        let Some((assembled, _)) = self.machine().filter(|(of, _)| !of.spinning.is_empty()) else {
            return Vec::new();
        };
        let highest = TAU * assembled.stepped_up_to_hz;
        let modes = assembled.modes.whirling(&assembled.spinning, TAU * speed_hz, highest).into_iter();
        modes
            .map(|both| both.map(|of| of / TAU))
            .map(|[frequency_hz, shifted_hz]| GyroscopicShift { frequency_hz, shifted_hz })
            .collect()
    }

    /// The mode that what is left out shifts the most, where that is much.
    pub(super) fn gyroscopic(&self) -> Option<ScenarioWarning> {
        let (assembled, _) = self.machine()?;
        let (key, speed_hz) = self.scenario.fastest_speed(&self.layout);
        let is_stepped =
            |of: &&Spinning| assembled.machine.spinning.iter().any(|stepped| stepped.about_x == of.about_x);
        let left_out: Vec<Spinning> =
            assembled.spinning.iter().filter(|of| !is_stepped(of)).copied().collect();
        let highest = TAU * assembled.stepped_up_to_hz;
        let [frequency_hz, part] = assembled
            .modes
            .largest_shift(&left_out, TAU * speed_hz, highest)
            .filter(|[_, part]| *part > TOLERATED_SHIFT)?;
        let message = format!(
            "at {speed_hz:.1} rev/s gyroscopic moments that are neglected shift the mode at {frequency_hz:.0} Hz by {:.1} %",
            100.0 * part
        );
        Some(ScenarioWarning::new(WarningKind::Gyroscopic, key, message))
    }
}
