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
        for (asked, speed_hz) in self.all().filter_map(|asked| Some((asked, asked.input_speed_hz?))) {
            let [least, most] = simulated_hz(prior);
            if speed_hz.is_finite() && (speed_hz > most * FARTHEST || speed_hz < least / FARTHEST) {
                // Wrong pulses are seen in the recording itself.
                let reason = reason(speed_hz / nominal_hz, prior).or_else(|| asked.mismatch.clone());
                let reason = reason.unwrap_or_else(|| {
                    let (_, key) = driving(prior);
                    format!(
                        "is it in Hz, not rpm, and of the shaft that was meant? Or has the scenario another speed ({key})?"
                    )
                });
                let (shaft, _) = driving(prior);
                return Err(DiagnoseError::OtherSpeed { shaft, speed_hz, nominal_hz, reason });
            }
        }
        // A wrong speed moves the orders too, so it is reported before them.
        Layout::of(self, &ReferenceSet { prior: prior.clone(), records: Vec::new() }).map(drop)
    }
}

/// The shaft that drives in words, and the key of its speed.
fn driving(prior: &Prior) -> (&'static str, &'static str) {
    (prior.base.driven_in_words(), prior.base.speed_key())
}

/// (Hz) Least and largest speed of the shaft that drives in the simulations.
fn simulated_hz(prior: &Prior) -> [f64; 2] {
    let nominal_hz = prior.base.operation.pinion_speed_hz;
    [-1.0, 1.0].map(|sign: f64| nominal_hz * (sign * prior.speed_spread).exp())
}

/// Explanation why a recording is so many times as quick as the rig; none where nothing explains it.
fn reason(ratio: f64, prior: &Prior) -> Option<String> {
    let is = |other: f64| (ratio / other - 1.0).abs() < NEAR;
    let train = &prior.train;
    let name = |shaft: usize| prior.base.shaft_in_words(&train.shafts[shaft].name);
    let of_shaft = |shaft: usize, other: usize| {
        format!("that is their ratio of speeds: the speed may be of {}, not of {}", name(shaft), name(other))
    };
    let input = train.input();
    let others = (0..train.shafts.len()).filter(|shaft| *shaft != input);
    let others = others.map(|shaft| (shaft, train.speed_ratio(shaft, input).value()));
    let mut others = others.filter(|(_, of_input)| *of_input != 1.0);
    if is(SIXTY) {
        Some("it is 60 times as quick: a speed in rpm that was given as Hz? 1 Hz are 60 rpm".to_owned())
    } else if is(1.0 / SIXTY) {
        Some("it is 60 times as slow: has the scenario its speed in rpm? 1 Hz are 60 rpm".to_owned())
    } else {
        others.find_map(|(shaft, of_input)| match () {
            () if is(of_input) => Some(of_shaft(shaft, input)),
            () if is(1.0 / of_input) => Some(of_shaft(input, shaft)),
            () => None,
        })
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
    let ((shaft, key), mut doubts) = (driving(prior), Vec::new());
    let beside = |speed_hz: &f64| !(least..=most).contains(speed_hz);
    for speed_hz in question.all().filter_map(|asked| asked.input_speed_hz).filter(beside) {
        let reason = reason(speed_hz / nominal_hz, prior);
        let reason = reason.map_or_else(String::new, |reason| format!("; {reason}"));
        let doubt = format!(
            "{shaft} turns at {speed_hz:.3} Hz, the simulations at {least:.3} to {most:.3} Hz: write the recording's speed into the \
             scenario ({key}){reason}"
        );
        if !doubts.contains(&doubt) {
            doubts.push(doubt);
        }
    }
    doubts
}
