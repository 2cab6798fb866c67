//! What a kind of damage has to say about itself.

use super::damaged_tooth::{DamagedTooth, HealthyTooth};
use super::severity::SoundTooth;
use super::{DamageResult, FaultyTeeth, ToothPart};
use crate::keys::{Check, Keys};
use crate::wheel::Gears;

/// A kind of damage: its parameters are the keys of its section, beside those that every fault has.
pub(crate) trait Kind: Keys {
    /// The value of `kind` in the scenario file.
    const NAME: &str;

    /// The rig of a file to start from.
    const RIG: PaperRig = PaperRig::Breakage;

    /// What it is called in a title.
    const TITLE: &str;

    /// Whether its pairs' forces act beside the middle of the face or at another angle than the nominal one, which makes a step of
    /// the solver cost more.
    const MOVES_FORCES: bool = false;

    /// What it takes of a tooth.
    const PART: ToothPart;

    /// Whether its quantities have `area_percent`, the part of the flank that it takes.
    const HAS_AREA: bool = false;

    /// The teeth that it is on where none are named.
    const TEETH: FaultyTeeth = FaultyTeeth::One(1);

    /// Its keys that a severity stands in place of, by their names; none of a damage without a size, which is of severity 1.
    const SIZES: &[&str];

    /// The damage in a file to start from.
    fn example() -> Self;

    /// The damage with the sizes of a severity, of which [`Self::severity`] is the inverse; its other keys stay as they are.
    ///
    /// # Arguments
    /// * `severity` - (-) more than 0, at most 1
    /// * `tooth` - the sound tooth
    ///
    /// # Returns
    /// None where it is smaller than the profile's points can show.
    fn of_severity(&self, severity: f64, tooth: &SoundTooth) -> Option<Self>;

    /// (-) How severe it is: from 0, none, to 1, the largest that the tooth allows.
    ///
    /// # Arguments
    /// * `tooth` - the sound tooth
    fn severity(&self, tooth: &SoundTooth) -> f64;

    /// Whether the damage can be, alone and on a tooth of these wheels, as far as no profile is needed. Its keys are named
    /// `fault.…`.
    fn check(&self, gears: &Gears) -> Check;

    /// Whether each tooth has random draws of its own, so that no two are alike.
    fn is_drawn(&self) -> bool {
        false
    }

    /// Does the damage to a tooth, and describes it.
    ///
    /// # Arguments
    /// * `tooth` - what is left of it after the damages before
    /// * `healthy` - the healthy tooth and its mate
    ///
    /// # Errors
    /// A damage that does not fit the tooth. Its keys are named `fault.…`.
    fn damage(&self, tooth: &mut DamagedTooth, healthy: &HealthyTooth) -> DamageResult;
}

/// The rigs of the paper's experiments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PaperRig {
    /// Of breakage and pitting: 17 and 38 teeth.
    Breakage,
    /// Of involute destruction: 18 and 35 teeth.
    Destruction,
}
