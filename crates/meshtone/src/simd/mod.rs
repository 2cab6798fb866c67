//! Numbers side by side, in the vector registers that the processor has.

mod instruction_set;
mod lanes;

#[cfg(test)]
pub(crate) use instruction_set::Plain;
pub(crate) use instruction_set::{Dispatch, Instructions, OneByOne, Registers, Task};
pub use instruction_set::{InstructionSet, NoSuchInstructionSet};
pub(crate) use lanes::{Chains, Lanes};
