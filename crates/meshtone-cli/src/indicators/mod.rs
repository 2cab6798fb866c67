//! From recordings to indicators: what `meshtone indicators` is made of.

pub mod bearings;
pub mod figures;
pub mod files;
pub mod limits;
pub mod options;
pub mod phase;
mod phase_files;
pub mod process;
pub mod reading;
pub mod refuse;
pub mod results;
pub mod table;
pub mod train;
