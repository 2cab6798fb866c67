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
    /// Adds what one judge says.
    ///
    /// # Arguments
    /// * `key` - its name in the results
    /// * `of_each` - what it says about each recording
    /// * `words`, `numbers` - how many it tells rightly
    pub fn add(
        &mut self,
        key: &str,
        of_each: impl IntoIterator<Item = Value>,
        (words, numbers): (String, Value),
    ) {
        self.table = format!("{}\n  {words}\n", self.table);
        self.sums[key] = numbers;
        for (scored, value) in self.each.iter_mut().zip(of_each) {
            scored.iter_mut().for_each(|scored| scored.value[key] = value.clone());
        }
    }

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
        let left_out = match self.each.iter().filter(|scored| scored.is_err()).count() {
            0 => String::new(),
            left_out => format!("\n  {left_out} of {} not scored\n", self.each.len()),
        };
        format!("{}\n{}{left_out}", columns(&rows), self.table)
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

/// A part of a recording: a healthy one is compared with its own other half.
#[derive(Clone, Copy)]
pub enum Part {
    Whole,
    FirstHalf,
    SecondHalf,
}

/// Reads a part of a recording.
pub fn read(recording: &Recorded, part: Part) -> Result<Input, Failure> {
    let mut input = Input::read(&recording.path, &recording.reading, None)?;
    let samples = &mut input.channel.samples;
    let middle = samples.len() / 2;
    match part {
        Part::Whole => {}
        Part::FirstHalf => samples.truncate(middle),
        Part::SecondHalf => drop(samples.drain(..middle)),
    }
    Ok(input)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_flush_right() {
        let rows = [vec!["a", "number"], vec!["of one", "1.5"], vec!["b"]];
        let rows = rows.map(|cells| (cells.into_iter().map(str::to_owned).collect(), "why".to_owned()));
        assert_eq!(columns(&rows), "  a       number  why\n  of one     1.5  why\n  b       why\n");
    }
}
