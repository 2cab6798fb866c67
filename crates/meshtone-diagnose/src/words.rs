//! An answer in words, as the program prints it and the page shows it.

use meshtone::signal::AngleZero;

use crate::answer::{Answer, PlaceAnswer, ToothAnswer, p_in_words};
use crate::bearings;
use crate::observation::SignalKind;

/// (-) Probability below which kinds are only counted.
const SHOWN: f64 = 0.005;
/// Explanation of "probability", in few words.
const PROBABILITY: &str = "probabilities are given the scenario; before the recording: healthy one half, all kinds of damage, and two at once, alike";

/// An answer in words. Where nothing can be said it has no probabilities.
#[derive(Debug, Clone, PartialEq)]
pub struct AnswerInWords {
    /// Summary, in a sentence or two.
    pub summary: String,
    /// Probability that something is damaged; none where nothing can be said.
    pub damaged: Option<String>,
    /// Whether the recordings are like what was simulated.
    pub likeness: String,
    /// The likely kinds, the likeliest first: the kind, its probability, its severity with the interval of 90 %, its place. Empty where
    /// nothing can be said.
    pub kinds: Vec<[String; 4]>,
    /// Number of the unlikely kinds with their probability together; none where there are none.
    pub others: Option<String>,
    /// Notes: what a rule says, what the bearings show, what probabilities mean, from where teeth are counted, how many simulations were learnt from.
    pub notes: Vec<String>,
}

impl AnswerInWords {
    /// Names of the columns of [`Self::kinds`].
    pub const COLUMNS: [&str; 4] = ["kind", "probability", "severity (90 %)", "where"];
}

impl Answer {
    /// The answer in words.
    pub fn in_words(&self) -> AnswerInWords {
        let (summary, likeness, learnt) = (self.summary.clone(), likeness(self), learnt(self));
        let bearings = bearings::notes(&self.bearings);
        if self.is_outside() {
            let (kinds, notes) = (Vec::new(), [bearings, vec![learnt]].concat());
            return AnswerInWords { summary, damaged: None, likeness, kinds, others: None, notes };
        }
        let (shown, others): (Vec<_>, Vec<_>) = self.kinds.iter().partition(|kind| kind.probability >= SHOWN);
        let dash = || "-".to_owned();
        let kinds = shown.into_iter().map(|kind| {
            let severity = kind.severity.map(|severity| {
                let [from, to] = severity.within_90;
                format!("{:.2} ({from:.2} to {to:.2})", severity.median)
            });
            let at = kind.place.as_ref().map_or_else(dash, |of| place(of, &self.wheels));
            [kind.label.to_owned(), percent(kind.probability), severity.unwrap_or_else(dash), at]
        });
        let rest: f64 = others.iter().map(|kind| kind.probability).sum();
        let counted = (!others.is_empty()).then(|| match others.len() {
            1 => format!("1 other kind: {}", percent(rest)),
            count => format!("{count} other kinds: {} together", percent(rest)),
        });
        AnswerInWords {
            summary,
            damaged: Some(format!("damaged with a probability of {}", percent(self.damaged()))),
            likeness,
            kinds: kinds.collect(),
            others: counted,
            notes: self
                .rule
                .in_words(&self.wheels)
                .into_iter()
                .chain(bearings)
                .chain([Some(PROBABILITY.to_owned()), counted_from(self), Some(learnt)].into_iter().flatten())
                .collect(),
        }
    }
}

/// `82 %`, and nothing more certain than a hundred simulations could show.
fn percent(probability: f64) -> String {
    match probability {
        p if p < 0.001 => "< 0.1 %".to_owned(),
        p if p > 0.999 => "> 99.9 %".to_owned(),
        p => format!("{:.1} %", 100.0 * p),
    }
}

/// Meaning of the p-value.
fn likeness(answer: &Answer) -> String {
    let (means, p) = match answer.common_change.filter(|_| answer.is_remounted()) {
        Some(change) => {
            ("all wheels changed alike since the healthy recording, as few that were simulated", change.p)
        }
        None if answer.is_outside() => {
            ("the recording is unlike all that was simulated", answer.outside_model)
        }
        None => ("the recording is like what was simulated", answer.outside_model),
    };
    format!("{means} ({})", p_in_words(p))
}

/// Meaning of tooth 1 of the wheel that is named.
fn counted_from(answer: &Answer) -> Option<String> {
    let place = answer.likeliest_damage()?.place.filter(|place| place.is_on_one_tooth)?;
    let zero = answer.counted_from[place.wheel];
    Some(match zero {
        Some(AngleZero::Simulated) => "teeth are counted as in the simulation".to_owned(),
        Some(zero) => format!("tooth 1 is the one in mesh at the {}", zero.name()),
        None if answer.recordings > 1 => {
            "which tooth it is remains unknown: nothing marks the same tooth in all recordings; pulses once a revolution would mark it".to_owned()
        }
        None => "which tooth it is remains unknown: the mesh tone has no mark; pulses of a tachometer, or an exact speed that is stated, would show it".to_owned(),
    })
}

/// Number of simulations from which the answer was learnt, and why not from all.
fn learnt(answer: &Answer) -> String {
    let (used, made) = (answer.reference_records, answer.simulated_records);
    if used == made {
        return format!("learnt from {used} simulations");
    }
    let others = match (answer.has_healthy, answer.signal == SignalKind::Recording) {
        (true, true) => "the others are what these are compared with",
        (true, false) => "the others are what these are compared with, or of a damaged pinion",
        (false, _) => "the others are of a damaged pinion",
    };
    format!("learnt from {used} of {made} simulations; {others}")
}

/// `gear (99.0 %), tooth 12 at 104° (88.0 %)`.
fn place(place: &PlaceAnswer, wheels: &[String]) -> String {
    let mut text = format!("{} ({})", wheels[place.wheel], percent(place.wheel_probability));
    if let Some(ToothAnswer { number, angle_deg, probability }) = place.tooth {
        text += &format!(", tooth {number} at {angle_deg:.0}° ({})", percent(probability));
    } else if place.is_on_one_tooth {
        text += ", one tooth";
    }
    text
}
