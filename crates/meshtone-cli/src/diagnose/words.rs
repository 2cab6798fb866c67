//! Parts of a diagnosis in words.

use meshtone_diagnose::{Answer, PlaceAnswer};

/// (-) p-value below which a recording is unlike all that was simulated.
const OUTSIDE: f64 = 0.05;

/// What "probability" is, in few words.
pub const PROBABILITY: &str =
    "probabilities are given the scenario; before the recording: healthy one half, all kinds of damage alike";

/// `82 %`, and nothing more certain than a hundred simulations could tell.
pub fn percent(probability: f64) -> String {
    match probability {
        p if p < 0.001 => "< 0.1 %".to_owned(),
        p if p > 0.999 => "> 99.9 %".to_owned(),
        p => format!("{:.1} %", 100.0 * p),
    }
}

/// What the p-value means.
pub fn outside(answer: &Answer) -> String {
    let means = match answer.outside_model < OUTSIDE {
        true => "the recording is unlike all that was simulated",
        false => "the recording is like what was simulated",
    };
    format!("{means} (p = {:.3})", answer.outside_model)
}

/// `gear (99.0 %), tooth 12 at 104° (88.0 %)`.
pub fn place(place: &PlaceAnswer) -> String {
    let mut text = format!("{} ({})", place.wheel.name(), percent(place.wheel_probability));
    if let (Some(tooth), Some(angle), Some(probability)) =
        (place.tooth, place.angle_deg, place.tooth_probability)
    {
        text += &format!(", tooth {tooth} at {angle:.0}° ({})", percent(probability));
    }
    text
}
