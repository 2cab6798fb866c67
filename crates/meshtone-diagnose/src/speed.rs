//! A check that simulations of the rig cover a recording's speed.

use crate::DiagnoseError;
use crate::learn::Question;
use crate::prior::Prior;

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
    /// A recording whose speed is far from those of the simulations.
    pub fn check(&self, prior: &Prior) -> Result<(), DiagnoseError> {
        let nominal_hz = prior.base.operation.pinion_speed_hz;
        for speed_hz in self.now.iter().chain(self.healthy).filter_map(|asked| asked.pinion_speed_hz) {
            let [least, most] = simulated_hz(prior);
            if speed_hz.is_finite() && (speed_hz > most * FARTHEST || speed_hz < least / FARTHEST) {
                let reason = reason(speed_hz / nominal_hz, prior);
                return Err(DiagnoseError::OtherSpeed { speed_hz, nominal_hz, reason });
            }
        }
        Ok(())
    }
}

/// (Hz) Least and largest speed of the pinion in the simulations.
fn simulated_hz(prior: &Prior) -> [f64; 2] {
    let nominal_hz = prior.base.operation.pinion_speed_hz;
    [-1.0, 1.0].map(|sign: f64| nominal_hz * (sign * prior.speed_spread).exp())
}

/// Explanation why a recording is so many times as quick as the rig.
fn reason(ratio: f64, prior: &Prior) -> String {
    let [pinion, gear] = [prior.base.gears.pinion_teeth, prior.base.gears.gear_teeth].map(f64::from);
    let is = |other: f64| (ratio / other - 1.0).abs() < NEAR;
    let of_gear = "the gear's shaft, not the pinion's: say so with the gear's teeth";
    let of_pinion = "the pinion's shaft, not the gear's: say so with the pinion's teeth";
    if is(SIXTY) {
        "it is 60 times as quick: a speed in rpm that was given as Hz? 1 Hz are 60 rpm".to_owned()
    } else if is(1.0 / SIXTY) {
        "it is 60 times as slow: has the scenario its speed in rpm? 1 Hz are 60 rpm".to_owned()
    } else if pinion != gear && is(pinion / gear) {
        format!("that is the ratio of the wheels: the speed may be of {of_gear}")
    } else if pinion != gear && is(gear / pinion) {
        format!("that is the ratio of the wheels: the speed may be of {of_pinion}")
    } else {
        "is it in Hz, not rpm, and of the shaft that was meant? Or has the scenario another speed \
         (operation.pinion_speed_hz)?"
            .to_owned()
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
    for speed_hz in question.now.iter().chain(question.healthy).filter_map(|asked| asked.pinion_speed_hz) {
        if (least..=most).contains(&speed_hz) {
            continue;
        }
        let ratio = speed_hz / nominal_hz;
        let [pinion, gear] = [prior.base.gears.pinion_teeth, prior.base.gears.gear_teeth].map(f64::from);
        let is_of_wheels =
            [pinion / gear, gear / pinion].iter().any(|other| (ratio / other - 1.0).abs() < NEAR);
        let reason = if is_of_wheels { format!("; {}", reason(ratio, prior)) } else { String::new() };
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
