//! Numbers side by side, in the vector registers that the processor has.

mod instruction_set;
mod lanes;

pub use instruction_set::InstructionSet;
pub(crate) use instruction_set::{Instructions, Task};
pub(crate) use lanes::{Chains, Lanes};
