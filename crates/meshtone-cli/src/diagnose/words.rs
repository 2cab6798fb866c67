//! Parts of a diagnosis in words.

use meshtone::signal::AngleZero;
use meshtone_diagnose::{Answer, PlaceAnswer, SignalKind, ToothAnswer, p_in_words};

/// Explanation of "probability", in few words.
pub const PROBABILITY: &str = "probabilities are given the scenario; before the recording: healthy one half, all kinds of damage, and two at once, alike";

/// `82 %`, and nothing more certain than a hundred simulations could show.
pub fn percent(probability: f64) -> String {
    match probability {
        p if p < 0.001 => "< 0.1 %".to_owned(),
        p if p > 0.999 => "> 99.9 %".to_owned(),
        p => format!("{:.1} %", 100.0 * p),
    }
}

/// Meaning of the p-value.
pub fn outside(answer: &Answer) -> String {
    let healthy = answer.healthy_outside_model.filter(|_| answer.is_healthy_outside());
    let (means, p) = match (answer.is_recording_outside(), healthy) {
        (true, _) => ("the recording is unlike all that was simulated", answer.outside_model),
        (false, Some(p)) => ("the healthy recording is unlike the healthy pairs that were simulated", p),
        (false, None) => ("the recording is like what was simulated", answer.outside_model),
    };
    format!("{means} ({})", p_in_words(p))
}

/// Meaning of tooth 1 of the wheel that is named.
pub fn counted_from(answer: &Answer) -> Option<String> {
    let place = answer.likeliest_damage()?.place.filter(|place| place.is_on_one_tooth)?;
    let zero = answer.counted_from[place.wheel];
    Some(match zero {
        Some(AngleZero::Simulated) => "teeth are counted as in the simulation".to_owned(),
        Some(zero) => format!("tooth 1 is the one in mesh at the {}", zero.name()),
        None if answer.recordings > 1 => {
            "which tooth it is remains unknown: nothing marks the same tooth in all recordings; pulses once a revolution would mark it".to_owned()
        }
        None => "which tooth it is remains unknown: the mesh tone has no mark; pulses (--tach), or an exact --shaft-hz, would show it".to_owned(),
    })
}

/// Number of simulations from which the answer was learnt, and why not from all.
pub fn learnt(answer: &Answer) -> String {
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
pub fn place(place: &PlaceAnswer, wheels: &[String]) -> String {
    let mut text = format!("{} ({})", wheels[place.wheel], percent(place.wheel_probability));
    if let Some(ToothAnswer { number, angle_deg, probability }) = place.tooth {
        text += &format!(", tooth {number} at {angle_deg:.0}° ({})", percent(probability));
    } else if place.is_on_one_tooth {
        text += ", one tooth";
    }
    text
}
