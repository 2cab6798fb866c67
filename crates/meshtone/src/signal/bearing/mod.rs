//! Rolling bearings in a recording: the lines of a spectrum at the orders of their defects.

mod defects;
mod lines;
mod recording;

pub use defects::{BearingDefects, RaceTest};
pub use lines::{DefectKind, DefectLine, defect_lines};
pub use recording::{BearingRecords, BearingSeparation, BearingSettings, TrainBearing};
