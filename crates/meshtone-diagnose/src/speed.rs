//! A check that simulations of the rig can be compared with a recording, and cover its speed and that of the healthy one.

use meshtone::scenario::{Scenario, ScenarioError};
use meshtone_learn::mean;

use crate::DiagnoseError;
use crate::layout::Layout;
use crate::observation::{Observation, Question};
use crate::prior::Prior;
use crate::reference::ReferenceSet;

/// (-) How far beyond the speeds of the simulations a recording may be to be compared with them at all.
const FARTHEST: f64 = 1.5;
/// (-) How near a ratio of speeds is to one that explains it.
const NEAR: f64 = 0.03;
/// Seconds in a minute, or minutes in an hour: one speed in the other's unit.
const SIXTY: f64 = 60.0;

/// (-) Steps of the logarithm of the ratio between the healthy recordings' speed and that of the others, of which each has a reference set: two
/// records of one pair of wheels differ by up to six tenths of a step where they are drawn at one speed.
const STEP: f64 = 0.1;

impl Question<'_> {
    /// The default prior of a rig for this question: its healthy records are at another speed where the healthy recordings are.
    ///
    /// # Arguments
    /// * `rig` - the rig's scenario, of a pair or a gearbox; its faults are left out
    ///
    /// # Errors
    /// Those of [`Prior::new`].
    pub fn prior(&self, rig: &Scenario) -> Result<Prior, ScenarioError> {
        let mut prior = Prior::new(rig)?;
        let ratio = mean_hz(self.healthy).zip(mean_hz(self.now)).map(|(healthy, now)| healthy / now);
        let steps = ratio.map_or(0.0, |ratio| (ratio.ln() / STEP).round());
        if steps.is_finite() && steps != 0.0 {
            prior.healthy_speed_hz = Some(prior.base.operation.pinion_speed_hz * (STEP * steps).exp());
        }
        Ok(prior)
    }

    /// Checks whether simulations of a rig can answer at all, before they are made.
    ///
    /// # Arguments
    /// * `prior` - what may be about the rig
    ///
    /// # Errors
    /// A recording whose speed is far from those of the simulations; healthy recordings of different speeds; recordings of other wheels, of too few
    /// orders or of different kinds.
    pub fn check(&self, prior: &Prior) -> Result<(), DiagnoseError> {
        let nominal_hz = prior.base.operation.pinion_speed_hz;
        let [least, most] = simulated_hz(nominal_hz, prior);
        for (place, asked) in self.all().enumerate() {
            let Some(speed_hz) = asked.input_speed_hz else { continue };
            if speed_hz.is_finite() && (speed_hz > most * FARTHEST || speed_hz < least / FARTHEST) {
                // Wrong pulses are seen in the recording itself.
                let reason = reason(speed_hz / nominal_hz, prior).or_else(|| asked.mismatch.clone());
                let (shaft, key) = (prior.base.words().driven, prior.base.words().speed_key);
                let reason = reason.unwrap_or_else(|| match place >= self.now.len() {
                    true => format!(
                        "a healthy recording that is compared with others turns at {:.1} to {:.1} Hz; record one at their speed",
                        least / FARTHEST,
                        most * FARTHEST
                    ),
                    false => format!(
                        "is it in Hz, not rpm, and of the shaft that was meant? Or has the scenario another speed ({key})?"
                    ),
                });
                return Err(DiagnoseError::OtherSpeed(format!(
                    "{shaft} turns at {speed_hz:.4} Hz by the recording, at {nominal_hz:.4} Hz by the scenario: {reason}"
                )));
            }
        }
        let healthy_hz = self.healthy.iter().filter_map(|asked| asked.input_speed_hz);
        let (slowest, fastest) =
            healthy_hz.fold((f64::INFINITY, 0.0f64), |(least, most), hz| (hz.min(least), hz.max(most)));
        if fastest > slowest * STEP.exp() {
            return Err(DiagnoseError::Unfit(format!(
                "the healthy recordings turn at {slowest:.3} to {fastest:.3} Hz; give those of one speed, best the one at which the recording in question turns"
            )));
        }
        // A wrong speed moves the orders too, so it is reported before them.
        Layout::of(self, &ReferenceSet { prior: prior.clone(), records: Vec::new() }).map(drop)
    }
}

/// (Hz) Mean speed of the shaft that drives, where it is known.
pub(crate) fn mean_hz(recordings: &[Observation]) -> Option<f64> {
    let speeds: Vec<f64> = recordings.iter().filter_map(|asked| asked.input_speed_hz).collect();
    (!speeds.is_empty()).then(|| mean(&speeds))
}

/// (Hz) Least and largest speed of simulations about a speed.
fn simulated_hz(nominal_hz: f64, prior: &Prior) -> [f64; 2] {
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
    let sixty = [
        (SIXTY, "it is 60 times as quick: a speed in rpm that was given as Hz? 1 Hz are 60 rpm"),
        (1.0 / SIXTY, "it is 60 times as slow: has the scenario its speed in rpm? 1 Hz are 60 rpm"),
    ];
    let by_unit = sixty.into_iter().find(|(other, _)| is(*other)).map(|(_, why)| why.to_owned());
    let input = train.input();
    let by_shaft = |shaft: usize| match train.speed_ratio(shaft, input).value() {
        1.0 => None,
        of_input if is(of_input) => Some(of_shaft(shaft, input)),
        of_input if is(1.0 / of_input) => Some(of_shaft(input, shaft)),
        _ => None,
    };
    by_unit.or_else(|| (0..train.shafts.len()).filter(|shaft| *shaft != input).find_map(by_shaft))
}

/// Warnings about recordings beside the speeds of the simulations, though near them, and about a healthy recording of another speed.
///
/// # Arguments
/// * `question` - the recordings
/// * `prior` - of the simulations
pub(crate) fn doubts(question: &Question, prior: &Prior) -> Vec<String> {
    let nominal_hz = prior.base.operation.pinion_speed_hz;
    let [least, most] = simulated_hz(nominal_hz, prior);
    let (shaft, key) = (prior.base.words().driven, prior.base.words().speed_key);
    let healthy = if prior.healthy_speed_hz.is_some() { &[] } else { question.healthy };
    let speeds = question.now.iter().chain(healthy).filter_map(|asked| asked.input_speed_hz);
    let beside = speeds.filter(|speed_hz| !(least..=most).contains(speed_hz)).map(|speed_hz| {
        let reason = reason(speed_hz / nominal_hz, prior);
        let reason = reason.map_or_else(String::new, |reason| format!("; {reason}"));
        format!(
            "{shaft} turns at {speed_hz:.3} Hz, the simulations at {least:.3} to {most:.3} Hz: write the recording's speed into the \
             scenario ({key}){reason}"
        )
    });
    let speeds =
        mean_hz(question.healthy).zip(mean_hz(question.now)).filter(|_| prior.healthy_speed_hz.is_some());
    let apart = speeds.map(|(healthy_hz, now_hz)| {
        format!(
            "{shaft} turns at {healthy_hz:.3} Hz in the healthy recording, at {now_hz:.3} Hz in the other: they are compared with simulations at both \
             speeds, but damage is missed more often than at one; record both at one speed"
        )
    });
    beside.chain(apart).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{observed, prior, records};

    // The prior follows the ratio of the recordings' speeds in steps, whatever speed the scenario has, and says so; healthy recordings of several speeds
    // have no such prior.
    #[test]
    fn healthy_recordings_of_another_speed_have_a_prior_of_their_own() {
        let (rig, record) = (prior().base, &records(&prior(), 1)[0]);
        let at = |speed_hz| Observation { input_speed_hz: Some(speed_hz), ..observed(record) };
        let of = |now_hz: f64, healthy_hz: &[f64]| {
            let (now, healthy) = ([at(now_hz)], healthy_hz.iter().map(|&hz| at(hz)).collect::<Vec<_>>());
            let question = Question { now: &now, healthy: &healthy };
            let prior = question.prior(&rig).unwrap();
            (prior.healthy_speed_hz, question.check(&prior).map(|()| doubts(&question, &prior)))
        };
        for (now_hz, healthy_hz) in [(40.0, 41.9), (40.0, 38.2), (37.0, 37.0)] {
            assert_eq!(of(now_hz, &[healthy_hz]), (None, Ok(Vec::new())));
        }
        for (now_hz, healthy_hz) in [(40.0, 28.1), (40.0, 56.9), (38.0, 32.0)] {
            let (speed_hz, said) = of(now_hz, &[healthy_hz, healthy_hz]);
            let apart = (speed_hz.unwrap() / 40.0).ln() - (healthy_hz / now_hz).ln();
            assert!(apart.abs() <= 0.5 * STEP, "{apart}");
            let said = said.unwrap();
            assert!(
                said.len() == 1 && said[0].contains(&format!("{healthy_hz:.3} Hz in the healthy recording")),
                "{said:?}"
            );
        }
        let (_, refused) = of(40.0, &[28.0, 40.0]);
        assert!(refused.unwrap_err().to_string().contains("28.000 to 40.000 Hz; give those of one speed"));
        let (_, refused) = of(40.0, &[23.0]);
        assert!(
            refused.unwrap_err().to_string().contains("turns at 24.1 to 66.3 Hz; record one at their speed")
        );
    }
}
