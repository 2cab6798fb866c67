//! What sets that were adapted to the healthy recordings of a gearbox say about its recordings.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use meshtone::scenario::Scenario;
use meshtone::tuning::SensorRecording;
use meshtone_dataset::adapt::{AdaptSettings, Adaptation, Judged, KnownMachine, adapt};
use meshtone_dataset::generate::GenerateControl;
use meshtone_dataset::store::Destination;
use serde_json::{Value, json};

use super::preset::{HEALTHY, Recorded};
use super::score::{Part, read, reason};
use crate::diagnose::observe::to_g;
use crate::failure::Failure;
use crate::healthy::{estimated, over_shaft};
use crate::indicators::options::{PhaseOptions, ShaftOptions};
use crate::indicators::train::Turned;
use crate::progress::with_bar;

/// Units of a set.
const UNITS: u64 = 64;
/// Draws of the wheels from which a path is estimated, and their seed.
const DRAWS: u64 = 24;
const SEED: u64 = 1;

/// Adapts sets to recordings of one machine.
pub struct Adapter<'a> {
    pub scenario: &'a Scenario,
    /// Classes of damage.
    pub classes: &'a [String],
    /// Where the sets are kept.
    pub folder: PathBuf,
    pub quiet: bool,
}

/// What a set says about a recording.
pub struct ByAdapted {
    judged: Judged,
    threshold: f64,
}

impl Adapter<'_> {
    /// Adapts a set to the first halves of the healthy recordings by a channel, and judges by it their second halves and all others.
    ///
    /// # Arguments
    /// * `recordings` - by that channel
    ///
    /// Returns what is said about each, or why nothing is.
    pub fn judge(&self, recordings: &[&Recorded]) -> Vec<Result<ByAdapted, String>> {
        let healthy = recordings.iter().filter(|recording| recording.label.is == HEALTHY);
        let healthy = healthy.filter_map(|recording| self.read(recording, Part::FirstHalf).ok()).collect();
        let adaptation = match self.adapt(recordings, healthy) {
            Ok(adaptation) => adaptation,
            Err(failure) => {
                return recordings.iter().map(|_| Err(failure.message.clone())).collect();
            }
        };
        let judge = |recording: &Recorded| -> Result<ByAdapted, Failure> {
            let part = if recording.label.is == HEALTHY { Part::SecondHalf } else { Part::Whole };
            let judged = adaptation.judge(&self.read(recording, part)?)?;
            Ok(ByAdapted { judged, threshold: adaptation.threshold })
        };
        let each = recordings.iter();
        each.map(|recording| judge(recording).map_err(|failure| reason(&failure, recording))).collect()
    }

    fn adapt(&self, recordings: &[&Recorded], healthy: Vec<SensorRecording>) -> Result<Adaptation, Failure> {
        let channel = recordings.first().map_or("", |recording| &recording.channel);
        let estimate = estimated(self.scenario, &healthy, DRAWS, SEED, self.quiet);
        let estimate = estimate.map_err(|error| Failure::failed(error.to_string()))?;
        let known = KnownMachine { scenario: self.scenario, recordings: &healthy, estimate: &estimate };
        let settings = AdaptSettings { classes: self.classes.to_vec(), units: UNITS, seed: SEED };
        let to = Destination::directory(self.folder.join(channel));
        let adapted = with_bar("records", !self.quiet, |progress| {
            adapt(&known, &settings, &to, &GenerateControl { progress, cancelled: &AtomicBool::new(false) })
        });
        Ok(adapted?)
    }

    fn read(&self, recording: &Recorded, part: Part) -> Result<SensorRecording, Failure> {
        let mut input = read(recording, part)?;
        to_g(&mut input.channel, &recording.path, false)?;
        let phase = PhaseOptions { shaft_hz: recording.label.shaft_hz, ..PhaseOptions::default() };
        let turned = Turned::new(&input, &phase, &ShaftOptions::default(), Some(self.scenario))?;
        over_shaft(input, &turned)
    }
}

impl ByAdapted {
    /// (-) Probability of damage.
    pub fn damaged(&self) -> f64 {
        self.judged.damaged()
    }

    /// What is said, for programs.
    pub fn to_json(&self) -> Value {
        json!({ "damaged": self.damaged(), "threshold": self.threshold, "doubt": self.judged.doubt() })
    }
}

/// How many recordings are told rightly as healthy or damaged: in words and in numbers.
///
/// # Arguments
/// * `judged` - whether each is healthy, and what is said about it
pub fn counted(judged: &[(bool, Result<ByAdapted, String>)]) -> (String, Value) {
    let of = |healthy: bool| judged.iter().filter(move |(is_healthy, _)| *is_healthy == healthy);
    let answered = |healthy: bool| of(healthy).filter_map(|(_, answer)| answer.as_ref().ok());
    let is_right = |healthy: bool, answer: &ByAdapted| (answer.damaged() <= answer.threshold) == healthy;
    let right = |healthy: bool| answered(healthy).filter(|answer| is_right(healthy, answer)).count();
    let unlike =
        judged.iter().flat_map(|(_, answer)| answer).filter(|of| of.judged.doubt().is_some()).count();
    let refused = judged.iter().filter(|(_, answer)| answer.is_err()).count();
    let [sound, broken] = [true, false].map(|healthy| (right(healthy), answered(healthy).count()));
    let words = format!(
        "adapted sets: {} of {} healthy, {} of {} damaged told rightly; {unlike} unlike all simulations; {refused} refused",
        sound.0, sound.1, broken.0, broken.1
    );
    let number = |(right, of): (usize, usize)| json!({ "right": right, "of": of });
    (
        words,
        json!({ "healthy": number(sound), "damaged": number(broken), "unlike": unlike, "refused": refused }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_tells_healthy_from_damaged() {
        let judged = |damaged: f64, p_value: f64| {
            let judged =
                Judged { probabilities: vec![vec![1.0 - damaged, damaged]], p_values: vec![p_value] };
            Ok(ByAdapted { judged, threshold: 0.6 })
        };
        let all = [
            (true, judged(0.6, 0.5)),
            (true, judged(0.7, 0.5)),
            (false, judged(0.9, 0.001)),
            (false, Err("too short".to_owned())),
        ];
        let (words, numbers) = counted(&all);
        assert!(words.contains("1 of 2 healthy, 1 of 1 damaged told rightly; 1 unlike"), "{words}");
        assert_eq!(numbers["refused"], 1);
    }
}
