//! A diagnosis, for reading.

use meshtone_diagnose::Answer;

use super::words::{PROBABILITY, counted_from, learnt, outside, percent, place};

/// (-) Probability below which kinds are only counted.
const SHOWN: f64 = 0.005;

/// The table of a diagnosis.
pub fn table(answer: &Answer) -> String {
    let mut text = format!("  {}\n", answer.summary);
    if answer.is_outside() {
        text += &format!("  {}\n\n", outside(answer));
        return text + &format!("  {}\n", learnt(answer));
    }
    text += &format!("  damaged with a probability of {}\n", percent(answer.damaged()));
    text += &format!("  {}\n\n", outside(answer));
    let (shown, others): (Vec<_>, Vec<_>) = answer.kinds.iter().partition(|kind| kind.probability >= SHOWN);
    let width = shown.iter().map(|kind| kind.label.len()).max().unwrap_or(0).max(6);
    text += &format!("  {:<width$}  probability  severity (90 %)      where\n", "kind");
    for kind in shown {
        let severity = kind.severity.map(|severity| {
            let [from, to] = severity.within_90;
            format!("{:.2} ({from:.2} to {to:.2})", severity.median)
        });
        let severity = severity.unwrap_or_else(|| "-".to_owned());
        let at = kind.place.as_ref().map_or_else(|| "-".to_owned(), |of| place(of, &answer.wheels));
        let probability = percent(kind.probability);
        text += &format!("  {:<width$}  {probability:>11}  {severity:<19}  {at}\n", kind.label);
    }
    if !others.is_empty() {
        let rest: f64 = others.iter().map(|kind| kind.probability).sum();
        text += &format!("  {} other kinds: {} together\n", others.len(), percent(rest));
    }
    text += &format!("\n  {PROBABILITY}\n");
    for line in counted_from(answer).into_iter().chain([learnt(answer)]) {
        text += &format!("  {line}\n");
    }
    text
}
