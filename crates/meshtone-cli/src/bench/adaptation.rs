//! Judges the recordings of a gearbox by sets that are adapted to its healthy ones.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use meshtone::scenario::Scenario;
use meshtone::tuning::{PathError, SensorRecording};
use meshtone_dataset::adapt::{AdaptSettings, Adaptation, Judged, KnownMachine, adapt};
use meshtone_dataset::generate::GenerateControl;
use meshtone_dataset::store::Destination;
use serde_json::{Value, json};

use super::preset::{HEALTHY, Recorded, file_name};
use super::score::{Part, read, reason};
use crate::diagnose::observe::to_g;
use crate::failure::Failure;
use crate::healthy::{estimated, over_shaft};
use crate::indicators::options::{PhaseOptions, ShaftOptions};
use crate::indicators::train::Turned;
use crate::progress::with_bar;
use crate::terminal::warn;

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

/// What a set says about a recording, or why it says nothing.
pub type ByAdapted = Result<Judged, String>;

impl Adapter<'_> {
    /// Adapts a set to the first halves of the healthy recordings by each channel, and judges by it their second halves and all others.
    pub fn judge(&self, recordings: &[Recorded]) -> Vec<ByAdapted> {
        let mut sets: BTreeMap<String, Result<Adaptation, String>> = BTreeMap::new();
        let of_each = |recording: &Recorded| {
            let Recorded { channel, label, .. } = recording;
            let made = sets.entry(channel.clone()).or_insert_with(|| {
                self.adapt(channel, recordings).map_err(|Failure { message, help, .. }| match help {
                    Some(help) => format!("{message}; {help}"),
                    None => message,
                })
            });
            let set = made.as_ref().map_err(String::clone)?;
            let part = if label.is == HEALTHY { Part::SecondHalf } else { Part::Whole };
            let judged = self.read(recording, part).and_then(|of_part| Ok(set.judge(&of_part)?));
            judged.map_err(|failure| reason(&failure, recording))
        };
        recordings.iter().map(of_each).collect()
    }

    /// Adapts the set of a channel. A healthy recording that cannot be read is left out, with a warning.
    fn adapt(&self, channel: &str, recordings: &[Recorded]) -> Result<Adaptation, Failure> {
        let (mut healthy, mut names) = (Vec::new(), Vec::new());
        for of in recordings.iter().filter(|of| of.label.is == HEALTHY && of.channel == channel) {
            let name = file_name(&of.path);
            match self.read(of, Part::FirstHalf) {
                Ok(half) => {
                    healthy.push(half);
                    names.push(name);
                }
                Err(failure) => {
                    warn(format_args!("{name}, {channel}: not adapted to: {}", reason(&failure, of)));
                }
            }
        }
        let estimate = estimated(self.scenario, &healthy, DRAWS, SEED, self.quiet);
        let estimate = estimate.map_err(|error| match error {
            PathError::Recording { index, problem } => {
                Failure::failed(format!("{}: {problem}", names[index]))
            }
            error => Failure::failed(error.to_string()),
        })?;
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

/// What a set says about a recording, for programs.
pub fn in_numbers(answer: &ByAdapted) -> Value {
    match answer {
        Ok(of) => json!({ "damaged": of.damaged(), "threshold": of.threshold, "doubt": of.doubt() }),
        Err(reason) => json!({ "refused": reason }),
    }
}

/// How many recordings are told rightly as healthy or damaged: in words and in numbers.
///
/// # Arguments
/// * `answers` - whether each is healthy, and what is said about it
pub fn counted<'a>(answers: impl Iterator<Item = (bool, &'a ByAdapted)>) -> (String, Value) {
    let (mut right, mut answered, mut unlike, mut refused) = ([0; 2], [0; 2], 0, Vec::new());
    for (is_healthy, answer) in answers {
        let judged = answer.as_ref().inspect_err(|reason| refused.push(reason.as_str()));
        let Ok(judged) = judged else { continue };
        let is_damaged = judged.damaged() > judged.threshold;
        answered[usize::from(!is_healthy)] += 1;
        right[usize::from(!is_healthy)] += usize::from(is_damaged != is_healthy);
        unlike += usize::from(judged.doubt().is_some());
    }
    let [healthy, damaged] = [0, 1].map(|of| format!("{} of {}", right[of], answered[of]));
    let number = |of: usize| json!({ "right": right[of], "of": answered[of] });
    (
        format!(
            "adapted sets: {healthy} healthy, {damaged} damaged told rightly; {unlike} unlike all simulations; {} refused{}",
            refused.len(),
            refused.first().map(|reason| format!(", the first: {reason}")).unwrap_or_default()
        ),
        json!({ "healthy": number(0), "damaged": number(1), "unlike": unlike, "refused": refused.len() }),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_tells_healthy_from_damaged() {
        let judged = |damaged: f64, p_value: f64| {
            let probabilities = vec![vec![1.0 - damaged, damaged]];
            Ok(Judged { probabilities, p_values: vec![p_value], threshold: 0.6 })
        };
        let all = [
            (true, judged(0.6, 0.5)),
            (true, judged(0.7, 0.5)),
            (false, judged(0.9, 0.001)),
            (false, Err("too short".to_owned())),
        ];
        let (words, numbers) = counted(all.iter().map(|(is_healthy, answer)| (*is_healthy, answer)));
        assert!(words.contains("1 of 2 healthy, 1 of 1 damaged told rightly; 1 unlike"), "{words}");
        assert_eq!(numbers["refused"], 1);
    }
}
