//! How much memory the samples of a recording take.

use std::path::Path;

use meshtone::scenario::MemoryLimit;

use super::selection::Selection;
use super::{ReadRecordingError, RecordingOptions};
use crate::memory;

/// (bytes) Of a number in memory.
const NUMBER_BYTES: u64 = 8;

/// Copies of the time column that are made to compare its steps.
const COPIES_OF_TIME: u64 = 2;

/// Refuses samples that would take more memory than is allowed, before they are read.
///
/// # Arguments
/// * `path`, `options`, `selection` - of the recording
/// * `samples` - of each column that is read
/// * `beside_bytes` - (bytes) what reading takes beside the samples
pub(super) fn check(
    path: &Path,
    options: &RecordingOptions,
    selection: &Selection,
    samples: impl Iterator<Item = u64>,
    beside_bytes: u64,
) -> Result<(), ReadRecordingError> {
    check_within(memory::limit(), path, options, selection, samples, beside_bytes)
}

/// As [`check`], with a limit that was asked for before: what is free grows less while samples are read, and they would count
/// twice.
pub(super) fn check_within(
    limit: MemoryLimit,
    path: &Path,
    options: &RecordingOptions,
    selection: &Selection,
    samples: impl Iterator<Item = u64>,
    beside_bytes: u64,
) -> Result<(), ReadRecordingError> {
    let (mut columns, mut all, mut longest) = (0_u64, 0_u64, 0_u64);
    for samples in samples {
        columns += 1;
        all = all.saturating_add(samples);
        longest = longest.max(samples);
    }
    let later = longest.saturating_mul(options.numbers_beside_each_sample);
    let of_time = if selection.time.is_some() { longest.saturating_mul(COPIES_OF_TIME) } else { 0 };
    let needed = all
        .saturating_add(of_time)
        .saturating_add(later)
        .saturating_mul(NUMBER_BYTES)
        .saturating_add(beside_bytes);
    let Some(objection) = limit.objection(needed) else { return Ok(()) };
    let columns = if columns == 1 { "one column".to_string() } else { format!("{columns} columns") };
    let computed = if later > 0 { ", with what is computed from them," } else { "" };
    Err(ReadRecordingError::TooLarge {
        path: path.to_path_buf(),
        problem: format!("{columns} of {longest} samples{computed} {objection}"),
    })
}
