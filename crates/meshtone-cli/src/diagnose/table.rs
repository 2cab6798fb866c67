//! A diagnosis, for reading.

use meshtone_diagnose::{Answer, AnswerInWords};

/// The table of a diagnosis.
pub fn table(answer: &Answer) -> String {
    let AnswerInWords { summary, damaged, likeness, kinds, others, notes } = answer.in_words();
    let lines = [Some(summary), damaged, Some(likeness)].into_iter().flatten();
    let mut text: String = lines.map(|line| format!("  {line}\n")).collect();
    text += "\n";
    let width = kinds.iter().map(|[kind, ..]| kind.len()).max().unwrap_or(0).max(6);
    let row = |[kind, probability, severity, place]: [&str; 4]| {
        format!("  {kind:<width$}  {probability:>11}  {severity:<19}  {place}\n")
    };
    if !kinds.is_empty() {
        text += &row(AnswerInWords::COLUMNS);
        text.extend(kinds.iter().map(|kind| row(kind.each_ref().map(String::as_str))));
        text.extend(others.map(|others| format!("  {others}\n")));
        text += "\n";
    }
    text.extend(notes.iter().map(|note| format!("  {note}\n")));
    text
}
