//! Laws that a result must obey before it leaves, as functions of what was simulated: bounds that a machine can reach, the balance of torques,
//! a motion that has settled.
//!
//! They know no scenario: [`Stages`](crate::Stages) and warnings say in its words which law is broken.

mod bounds;
mod figures;
mod settled;
mod torques;

pub(crate) use bounds::{crossings, overlap_modules, speed_factor};
pub(crate) use figures::{Figures, SignalFigures};
pub(crate) use settled::{WindowSums, transient_part, varying};
pub(crate) use torques::TorqueBalance;
