//! Files of Meshtone: scenarios, profile errors and profiles in, and everything out through
//! [`atomic_file`], so that no half-written file is ever left behind.
#![deny(missing_docs)]

pub mod atomic_file;
pub mod scenario_file;
