//! What motor and brake do.

use crate::operation::{MotionSample, TimeGrid};
use crate::scenario::Scenario;

/// Motor and brake, sample by sample from the start. The published code adds the revolutions up sample by sample, and its rounding
/// errors decide which of two equally near grid points a sample is given.
pub(super) fn motion<'a>(
    scenario: &'a Scenario,
    time: &TimeGrid,
) -> impl Iterator<Item = MotionSample> + use<'a> {
    let step_s = time.step_s();
    scenario.motion(time).scan(0.0, move |sum, sample| {
        let revolutions = *sum;
        *sum += sample.speed_hz * step_s;
        Some(MotionSample { revolutions, ..sample })
    })
}
