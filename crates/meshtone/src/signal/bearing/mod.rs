//! Rolling bearings in a recording: a verdict about each, and the lines of a spectrum at the orders of their defects for people who look.

mod bands;
mod comb;
mod lines;
mod recording;
mod verdict;
mod words;

pub use lines::{DefectKind, DefectLine, defect_lines};
pub use recording::{BearingRecords, BearingSeparation, BearingSettings, EnvelopeBand, TrainBearing};
pub use verdict::{BearingDefects, BearingVerdict, CannotTell, RaceTest, UnexplainedComb};
