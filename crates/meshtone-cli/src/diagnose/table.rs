//! A diagnosis, for reading.

use std::fmt::Write;

use meshtone_diagnose::Answer;

use super::words::{PROBABILITY, counted_from, learnt, outside, percent, place};

/// (-) Probability below which kinds are only counted.
const SHOWN: f64 = 0.005;

/// The table of a diagnosis.
pub fn table(answer: &Answer) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(text, "  {}", answer.summary);
    let _ = writeln!(text, "  damaged with a probability of {}", percent(answer.damaged()));
    let _ = writeln!(text, "  {}\n", outside(answer));
    let (shown, others): (Vec<_>, Vec<_>) = answer.kinds.iter().partition(|kind| kind.probability >= SHOWN);
    let width = shown.iter().map(|kind| kind.label.len()).max().unwrap_or(0).max(6);
    let _ = writeln!(text, "  {:<width$}  probability  severity (90 %)      where", "kind");
    for kind in shown {
        let severity = kind.severity.map_or_else(
            || "-".to_owned(),
            |severity| {
                let [from, to] = severity.within_90;
                format!("{:.2} ({from:.2} to {to:.2})", severity.median)
            },
        );
        let at = kind.place.as_ref().map_or_else(|| "-".to_owned(), place);
        let _ = writeln!(
            text,
            "  {:<width$}  {:>11}  {severity:<19}  {at}",
            kind.label,
            percent(kind.probability)
        );
    }
    if !others.is_empty() {
        let rest: f64 = others.iter().map(|kind| kind.probability).sum();
        let _ = writeln!(text, "  {} other kinds: {} together", others.len(), percent(rest));
    }
    let _ = writeln!(text, "\n  {PROBABILITY}");
    for line in [counted_from(answer), Some(learnt(answer))].into_iter().flatten() {
        let _ = writeln!(text, "  {line}");
    }
    text
}
