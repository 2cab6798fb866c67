//! How much memory the samples of a recording take.

use meshtone::scenario::MemoryLimit;

use super::RecordingOptions;
use super::error::Problem;
use super::selection::Selection;

/// (bytes) Size of a number in memory.
const NUMBER_BYTES: u64 = 8;

/// Copies of the time column that are made to compare its steps.
const COPIES_OF_TIME: u64 = 2;

/// Refuses samples that would take more memory than is allowed, before they are read.
///
/// # Arguments
/// * `limit` - what is allowed; asked for once, since samples that have been read would count twice
/// * `options`, `selection` - of the recording
/// * `samples` - of each column that is read
/// * `beside_bytes` - (bytes) what reading takes beside the samples
pub(super) fn check(
    limit: MemoryLimit,
    options: &RecordingOptions,
    selection: &Selection,
    samples: impl Fn(usize) -> u64,
    beside_bytes: u64,
) -> Result<(), Problem> {
    let samples: Vec<u64> = selection.wanted.iter().map(|column| samples(*column)).collect();
    let longest = samples.iter().copied().max().unwrap_or(0);
    let later = longest.saturating_mul(options.numbers_beside_each_sample);
    let copies = match (selection.time, selection.own_time) {
        (Some(_), _) => COPIES_OF_TIME,
        (None, Some(_)) => 1 + COPIES_OF_TIME,
        (None, None) => 0,
    };
    let of_time = longest.saturating_mul(copies);
    let numbers =
        samples.iter().chain([&of_time, &later]).fold(0, |sum: u64, more| sum.saturating_add(*more));
    let needed = numbers.saturating_mul(NUMBER_BYTES).saturating_add(beside_bytes);
    let Some(objection) = limit.objection(needed) else { return Ok(()) };
    let columns =
        if samples.len() == 1 { "one column".to_string() } else { format!("{} columns", samples.len()) };
    let computed = if later > 0 { ", with what is computed from them," } else { "" };
    Err(Problem::Refused(format!(
        "{columns} of {longest} samples{computed} {objection}; choose fewer channels (option channels), cut the recording, or raise \
         the memory limit"
    )))
}
