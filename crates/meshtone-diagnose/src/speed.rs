//! A check that simulations of the rig can be compared with a recording, and cover its speed.

use crate::DiagnoseError;
use crate::learn::{Layout, Question};
use crate::prior::Prior;
use crate::reference::ReferenceSet;

/// (-) How far beyond the speeds of the simulations a recording may be to be compared with them at all.
const FARTHEST: f64 = 1.5;
/// (-) How near a ratio of speeds is to one that explains it.
const NEAR: f64 = 0.03;
/// Seconds in a minute, or minutes in an hour: one speed in the other's unit.
const SIXTY: f64 = 60.0;

impl Question<'_> {
    /// Checks whether simulations of a rig can answer at all, before they are made.
    ///
    /// # Arguments
    /// * `prior` - what may be about the rig
    ///
    /// # Errors
    /// A recording whose speed is far from those of the simulations; recordings of other wheels, of too few orders or of different kinds.
    pub fn check(&self, prior: &Prior) -> Result<(), DiagnoseError> {
        let nominal_hz = prior.base.operation.pinion_speed_hz;
        for speed_hz in self.all().filter_map(|asked| asked.input_speed_hz) {
            let [least, most] = simulated_hz(prior);
            if speed_hz.is_finite() && (speed_hz > most * FARTHEST || speed_hz < least / FARTHEST) {
                let reason = reason(speed_hz / nominal_hz, prior).unwrap_or_else(|| {
                    "is it in Hz, not rpm, and of the shaft that was meant? Or has the scenario another speed \
                     (operation.pinion_speed_hz)?"
                        .to_owned()
                });
                return Err(DiagnoseError::OtherSpeed { speed_hz, nominal_hz, reason });
            }
        }
        // A wrong speed moves the orders too, so it is reported before them.
        Layout::of(self, &ReferenceSet { prior: prior.clone(), records: Vec::new() }).map(drop)
    }
}

/// (Hz) Least and largest speed of the pinion in the simulations.
fn simulated_hz(prior: &Prior) -> [f64; 2] {
    let nominal_hz = prior.base.operation.pinion_speed_hz;
    [-1.0, 1.0].map(|sign: f64| nominal_hz * (sign * prior.speed_spread).exp())
}

/// Explanation why a recording is so many times as quick as the rig; none where nothing explains it.
fn reason(ratio: f64, prior: &Prior) -> Option<String> {
    let [pinion, gear] = [prior.base.gears.pinion_teeth, prior.base.gears.gear_teeth].map(f64::from);
    let is = |other: f64| (ratio / other - 1.0).abs() < NEAR;
    let of_shaft = |wheel: &str, mate: &str| {
        format!(
            "that is the ratio of the wheels: the speed may be of the {wheel}'s shaft, not the {mate}'s: say so with the \
             {wheel}'s teeth"
        )
    };
    if is(SIXTY) {
        Some("it is 60 times as quick: a speed in rpm that was given as Hz? 1 Hz are 60 rpm".to_owned())
    } else if is(1.0 / SIXTY) {
        Some("it is 60 times as slow: has the scenario its speed in rpm? 1 Hz are 60 rpm".to_owned())
    } else if pinion != gear && is(pinion / gear) {
        Some(of_shaft("gear", "pinion"))
    } else {
        (pinion != gear && is(gear / pinion)).then(|| of_shaft("pinion", "gear"))
    }
}

/// Warning about recordings beside the speeds of the simulations, though near them.
///
/// # Arguments
/// * `question` - the recordings
/// * `prior` - of the simulations
pub(crate) fn doubts(question: &Question, prior: &Prior) -> Vec<String> {
    let [least, most] = simulated_hz(prior);
    let nominal_hz = prior.base.operation.pinion_speed_hz;
    let mut doubts = Vec::new();
    let beside = |speed_hz: &f64| !(least..=most).contains(speed_hz);
    for speed_hz in question.all().filter_map(|asked| asked.input_speed_hz).filter(beside) {
        let reason = reason(speed_hz / nominal_hz, prior);
        let reason = reason.map_or_else(String::new, |reason| format!("; {reason}"));
        let doubt = format!(
            "the pinion turns at {speed_hz:.3} Hz, the simulations at {least:.3} to {most:.3} Hz: write the recording's speed into the \
             scenario (operation.pinion_speed_hz){reason}"
        );
        if !doubts.contains(&doubt) {
            doubts.push(doubt);
        }
    }
    doubts
}
