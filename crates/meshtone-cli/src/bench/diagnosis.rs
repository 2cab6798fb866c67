//! What `meshtone diagnose` says about the recordings of a gearbox.

use meshtone::scenario::Scenario;
use meshtone_diagnose::{Answer, Observation, Prior, Question, ReferenceSet, SignalKind, p_in_words};
use serde_json::{Value, json};

use super::preset::{HEALTHY, Recorded};
use super::score::{Part, read, reason};
use crate::diagnose::observe::Observer;
use crate::diagnose::reference::{ReferenceOptions, answer};
use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions, ShaftOptions};
use crate::indicators::reading::Input;

/// Diagnoses recordings of one machine.
pub struct Diagnoser<'s> {
    scenario: &'s Scenario,
    prior: Prior,
    reference: ReferenceSet,
    quiet: bool,
}

/// What is said about a recording, or why nothing is.
pub type Diagnosed = Result<Answer, String>;

impl<'s> Diagnoser<'s> {
    /// Takes or makes the simulations.
    ///
    /// # Arguments
    /// * `scenario` - of the machine
    /// * `kept` - where the simulations are kept
    /// * `quiet` - whether nothing is to be shown
    pub fn new(scenario: &'s Scenario, kept: &ReferenceOptions, quiet: bool) -> Result<Self, Failure> {
        let prior = Prior::new(scenario).map_err(|error| Failure::failed(error.to_string()))?;
        let reference = kept.simulations(&kept.store()?, &prior, "the gearbox of the set", quiet)?;
        Ok(Self { scenario, prior, reference, quiet })
    }

    /// Diagnoses a recording beside the healthy one of its load and channel; a healthy one in halves, the later beside the earlier.
    ///
    /// # Arguments
    /// * `recording` - the recording
    /// * `healthy` - the healthy one, where there is one
    pub fn diagnose(&self, recording: &Recorded, healthy: Option<&Recorded>) -> Diagnosed {
        let Some(healthy) = healthy else {
            return Err("there is no healthy recording of its load".to_owned());
        };
        let asked = || {
            let parts = match recording.label.is == HEALTHY {
                true => [Part::SecondHalf, Part::FirstHalf],
                false => [Part::Whole; 2],
            };
            let [now, healthy] = [read(recording, parts[0])?, read(healthy, parts[1])?];
            let [now, healthy] = [[self.observe(now)?], [self.observe(healthy)?]];
            let question = Question { now: &now, healthy: &healthy };
            question.check(&self.prior)?;
            answer(&self.reference, &question, self.quiet)
        };
        asked().map_err(|failure: Failure| reason(&failure, recording))
    }

    fn observe(&self, input: Input) -> Result<Observation, Failure> {
        let (reading, phase, shafts) =
            (ReadingOptions::default(), PhaseOptions::default(), ShaftOptions::default());
        let observer = Observer::new(self.scenario, SignalKind::Recording, &reading, &phase, &shafts)?;
        Ok(observer.recording(input)?.0)
    }
}

/// What is said about a recording, in a few words and in numbers.
pub fn shown(diagnosed: &Diagnosed) -> (String, Value) {
    let answer = match diagnosed {
        Err(reason) => return (format!("refused: {reason}"), json!({ "refused": reason })),
        Ok(answer) => answer,
    };
    let p = p_in_words(answer.outside_model);
    let words = if answer.is_remounted() {
        "mounted anew since the healthy one".to_owned()
    } else if answer.is_outside() {
        format!("unlike all simulations ({p})")
    } else {
        let likeliest = answer.kinds.first().map_or("", |kind| kind.label);
        format!("damaged {:.0} %, likeliest {likeliest} ({p})", 100.0 * answer.damaged())
    };
    (words, answer.to_json())
}

/// How many recordings are inside, and what is said of these: in words and in numbers.
///
/// # Arguments
/// * `diagnosed` - whether each is healthy, and what is said about it
pub fn counted(diagnosed: &[(bool, Diagnosed)]) -> (String, Value) {
    let answers = || diagnosed.iter().filter_map(|(is_healthy, of)| Some((*is_healthy, of.as_ref().ok()?)));
    let inside = || answers().filter(|(_, answer)| !answer.is_outside());
    let right = inside().filter(|(is_healthy, answer)| (answer.damaged() < 0.5) == *is_healthy).count();
    let (all, answered, inside) = (diagnosed.len(), answers().count(), inside().count());
    let mounted_anew = answers().filter(|(_, answer)| answer.is_remounted()).count();
    let (outside, refused) = (answered - inside - mounted_anew, all - answered);
    let words = format!(
        "diagnosis: {inside} of {all} like what was simulated, of these {right} told rightly as healthy or damaged; {mounted_anew} mounted anew; {outside} unlike; {refused} refused"
    );
    (
        words,
        json!({ "of": all, "inside": inside, "right": right, "mounted_anew": mounted_anew, "outside": outside, "refused": refused }),
    )
}
