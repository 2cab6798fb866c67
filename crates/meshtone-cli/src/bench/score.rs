//! What scoring bearings and gears have in common.

use std::sync::atomic::{AtomicU64, Ordering};

use meshtone::scenario::Scenario;
use meshtone::signal::Interpolation;
use rayon::prelude::*;
use serde_json::{Value, json};

use super::preset::{Label, Recorded, file_name};
use crate::failure::Failure;
use crate::indicators::bearings::BearingOptions;
use crate::indicators::options::{PhaseOptions, ProcessingOptions, ShaftOptions};
use crate::indicators::process::{Processed, process};
use crate::indicators::reading::Input;
use crate::progress::with_bar;

/// What came out.
pub struct Scores {
    /// Heads of the cells of each recording.
    pub heads: Vec<String>,
    /// Of each recording, or why it could not be scored.
    pub each: Vec<Result<Scored, String>>,
    /// The sums as a table.
    pub table: String,
    /// The sums in numbers.
    pub sums: Value,
}

/// What came out for one recording.
pub struct Scored {
    /// Cells of a table.
    pub cells: Vec<String>,
    /// Words behind them.
    pub words: String,
    /// All that was found.
    pub value: Value,
}

impl Scores {
    /// A row for each recording, then the sums.
    ///
    /// # Arguments
    /// * `recordings` - which were scored
    pub fn in_words(&self, recordings: &[Recorded]) -> String {
        let has_channels = recordings.windows(2).any(|of| of[0].path == of[1].path);
        let of_file = |file: &str, channel: &str, is: &str| {
            let cells = [Some(file), Some(channel).filter(|_| has_channels), Some(is)];
            cells.into_iter().flatten().map(str::to_owned).collect::<Vec<_>>()
        };
        let heads = of_file("recording", "channel", "is").into_iter();
        let heads = (heads.chain(self.heads.iter().cloned()).collect(), String::new());
        let row = |(recording, scored): (&Recorded, &Result<Scored, String>)| {
            let Label { is, size, .. } = &recording.label;
            let state = size.as_ref().map_or_else(|| is.clone(), |size| format!("{is}, {size}"));
            let mut cells = of_file(&file_name(&recording.path), &recording.channel, &state);
            let words = match scored {
                Ok(scored) => {
                    cells.extend(scored.cells.iter().cloned());
                    scored.words.clone()
                }
                Err(reason) => format!("not scored: {reason}"),
            };
            (cells, words)
        };
        let rows: Vec<_> = [heads].into_iter().chain(recordings.iter().zip(&self.each).map(row)).collect();
        format!("{}\n{}", columns(&rows), self.table)
    }

    /// What was found of each recording.
    pub fn values(&self) -> impl Iterator<Item = Value> + '_ {
        self.each.iter().map(|of| {
            of.as_ref().map_or_else(|reason| json!({ "not_scored": reason }), |scored| scored.value.clone())
        })
    }
}

/// Does something with each recording, several at once, with a progress bar.
///
/// # Arguments
/// * `recordings` - of a set
/// * `quiet` - whether nothing is to be shown
/// * `look` - what is done with one
pub fn each<T: Send>(
    recordings: &[Recorded],
    quiet: bool,
    look: impl Fn(&Recorded) -> Result<T, Failure> + Sync,
) -> Vec<Result<T, String>> {
    with_bar("recordings", !quiet, |show| {
        let done = AtomicU64::new(0);
        let one = |recording: &Recorded| {
            let found = look(recording).map_err(|failure| reason(&failure, recording));
            show(done.fetch_add(1, Ordering::Relaxed) + 1, recordings.len() as u64);
            found
        };
        recordings.par_iter().map(one).collect()
    })
}

/// Why something could not be done with a recording, whose row names the file.
pub fn reason(failure: &Failure, recording: &Recorded) -> String {
    failure.message.replacen(&format!("{}: ", recording.path.display()), "", 1)
}

/// Does with a recording what `meshtone indicators` does where no other option is given.
pub fn processed(
    input: &Input,
    recording: &Recorded,
    scenario: Option<&Scenario>,
    bearings: &BearingOptions,
) -> Result<Processed, Failure> {
    let phase = PhaseOptions { shaft_hz: recording.label.shaft_hz, ..PhaseOptions::default() };
    let processing = ProcessingOptions {
        sidebands: 2,
        low_orders: 7,
        revolutions: None,
        sound_records: None,
        iso_20816: None,
        interpolation: Interpolation::BandLimited,
    };
    process(input, &phase, &ShaftOptions::default(), scenario, &processing, bearings)
}

/// A table, the heads first: columns as wide as their widest cell, flush right where they hold numbers, and words behind them.
pub fn columns(rows: &[(Vec<String>, String)]) -> String {
    let width =
        |column: usize| rows.iter().filter_map(|(cells, _)| Some(cells.get(column)?.chars().count())).max();
    let is_number = |cell: &String| cell.parse::<f64>().is_ok();
    let is_right = |column: usize| rows.iter().any(|(cells, _)| cells.get(column).is_some_and(is_number));
    let line = |(cells, words): &(Vec<String>, String)| {
        let cell = |(column, cell): (usize, &String)| {
            let width = width(column).unwrap_or(0);
            if is_right(column) { format!("{cell:>width$}  ") } else { format!("{cell:<width$}  ") }
        };
        let cells: String = cells.iter().enumerate().map(cell).collect();
        format!("  {}\n", format!("{cells}{words}").trim_end())
    };
    rows.iter().map(line).collect()
}

/// (-) Area under the curve: in which part of all pairs the damaged one is larger; ties count half. None of none.
pub fn area(healthy: &[f64], damaged: &[f64]) -> Option<f64> {
    let orders =
        healthy.iter().flat_map(|sound| damaged.iter().map(move |broken| broken.total_cmp(sound) as i8));
    let sum: f64 = orders.map(|order| 0.5 + 0.5 * f64::from(order)).sum();
    let pairs = healthy.len() * damaged.len();
    (pairs > 0).then(|| sum / pairs as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_area_counts_pairs() {
        assert_eq!(area(&[1.0, 2.0], &[2.0, 3.0]), Some(0.875));
        assert_eq!((area(&[3.0], &[1.0, 2.0]), area(&[], &[1.0])), (Some(0.0), None));
    }

    #[test]
    fn numbers_are_flush_right() {
        let rows = [vec!["a", "number"], vec!["of one", "1.5"], vec!["b"]];
        let rows = rows.map(|cells| (cells.into_iter().map(str::to_owned).collect(), "why".to_owned()));
        assert_eq!(columns(&rows), "  a       number  why\n  of one     1.5  why\n  b       why\n");
    }
}
