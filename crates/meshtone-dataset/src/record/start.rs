//! Where a record begins.

use meshtone::random::{Draws, Purpose};

use crate::draw::DrawnRecord;

/// Where a record begins: at the mark on its unit's gear, in some revolution of the hunting period.
///
/// A rig's tachometer does not know the damaged tooth, so the mark is at any tooth, the same for all records of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// Number of the simulation's first tooth, the damaged one, as counted from the mark, from 1.
    pub first_tooth: u32,
    /// Revolution of the gear.
    pub revolution: u32,
}

impl Start {
    /// The start of a record.
    ///
    /// # Arguments
    /// * `drawn` - the record
    /// * `gear_teeth` - of its gear
    /// * `revolutions` - of the gear that were simulated
    /// * `aligned` - whether the mark is at the damaged tooth
    pub fn new(drawn: &DrawnRecord, gear_teeth: u32, revolutions: u32, aligned: bool) -> Self {
        let one_of = |seed: u64, count: u32| {
            let bits = Draws::new(seed, Purpose::DatasetStart, 0).bits();
            // The upper half of a product: uniform but for 2⁻³².
            ((u128::from(bits) * u128::from(count.max(1))) >> 64) as u32
        };
        let first_tooth = if aligned { 1 } else { 1 + one_of(drawn.wheels_seed, gear_teeth) };
        Self { first_tooth, revolution: one_of(drawn.seed, revolutions) }
    }

    /// (teeth) How far the gear has turned at the mark since the simulation's first tooth came into contact.
    ///
    /// # Arguments
    /// * `gear_teeth` - of the gear
    pub fn mark_teeth(&self, gear_teeth: u32) -> u32 {
        (gear_teeth + 1 - self.first_tooth) % gear_teeth.max(1)
    }
}
