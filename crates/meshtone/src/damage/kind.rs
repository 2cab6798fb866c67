//! What a kind of damage has to say about itself.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use crate::error::ScenarioError;
use crate::keys::{Check, Keys};
use crate::wheel::Gears;

/// A kind of damage: its parameters are the keys of its section, beside those that every fault has.
pub(crate) trait Kind: Keys {
    /// The value of `kind` in the scenario file.
    const NAME: &str;

    /// The rig of a file to start from.
    const RIG: PaperRig = PaperRig::Breakage;

    /// The damage in a file to start from.
    fn example() -> Self;

    /// Whether the damage can be, alone and on a tooth of these wheels, as far as no profile is needed. Its keys are named
    /// `fault.…`.
    fn check(&self, gears: &Gears) -> Check;

    /// Does the damage to a tooth.
    ///
    /// # Arguments
    /// * `tooth` - what is left of it after the damages before
    /// * `healthy` - the healthy tooth and its mate
    ///
    /// # Errors
    /// A damage that does not fit the tooth. Its keys are named `fault.…`.
    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> Result<(), ScenarioError>;
}

/// The rigs of the paper's experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PaperRig {
    /// Of breakage and pitting: 17 and 38 teeth.
    Breakage,
    /// Of involute destruction: 18 and 35 teeth.
    Destruction,
}
