//! Figures of a simulation, and of a simulation tuned to measurements, as SVG and PNG.
//!
//! One file or folder per figure; what they share (axes, ticks, legends, text that knows its own width) is
//! `drawing`. A figure is drawn once, as a `scene`, which `svg` writes out and `raster`
//! fills in with the font that this crate brings along, so that both look alike on every machine.
//!
//! * [`panel`]: teeth, damage, profile errors, averages, mesh stiffness and spectrum of one simulation
//! * [`record`]: a recording, its average, order spectrum and difference signal
//! * [`order_map`]: the orders of a shaft over the time of a run-up
//! * [`bearings`]: kurtogram and squared envelope spectra of a recording, with the lines of bearings' defects
//! * [`trend`]: indicators over a series of recordings
//! * [`diagnosis`]: what may be wrong with a gear: probabilities, severity, and what explains a recording
//! * [`dataset::dataset_figure`]: a data set, examples, distributions and indicators by class
//! * [`tuning_figure`]: an experiment of the hybrid stage, measured, simulated and enhanced
#![deny(missing_docs)]

pub mod bearings;
mod damaged_tooth;
pub mod dataset;
pub mod diagnosis;
mod drawing;
mod error;
mod figure;
mod font;
pub mod order_map;
mod palette_png;
pub mod panel;
mod raster;
pub mod record;
mod scene;
mod svg;
pub mod trend;
mod tuning;
mod units;

pub use damaged_tooth::DamagedTooth;
pub use error::PlotError;
pub use figure::{Figure, Label};
pub use tuning::tuning_figure;
pub use units::without_unit;
