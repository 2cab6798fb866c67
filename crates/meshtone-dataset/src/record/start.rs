//! The start of a record within the hunting period.

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Fault, Gears, WheelName};

use crate::draw::DrawnRecord;

/// The start of a record: at the mark on its unit's gear, in some revolution of the hunting period.
///
/// A rig's tachometer does not know the damaged tooth, so the mark is at any tooth, the same for all records of a unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// (teeth) How far the gear has turned at the mark since the simulation's first teeth came into contact.
    pub mark_teeth: u32,
    /// Revolution of the gear.
    pub revolution: u32,
}

impl Start {
    /// The start of a record.
    ///
    /// # Arguments
    /// * `drawn` - the record
    /// * `gears` - the wheels
    /// * `revolutions` - of the gear that were simulated
    pub fn new(drawn: &DrawnRecord, gears: &Gears, revolutions: u32) -> Self {
        let after = one_of(drawn.wheels_seed, gears.gear_teeth);
        let mark_teeth = (gears.gear_teeth - after) % gears.gear_teeth.max(1);
        Self { mark_teeth, revolution: one_of(drawn.seed, revolutions) }
    }

    /// The start of a record that begins when a damaged tooth comes into contact: that of the first fault, and in a healthy
    /// pair the first tooth.
    ///
    /// # Arguments
    /// * `drawn`, `gears`, `revolutions` - as for [`Self::new`]
    /// * `faults` - of the record
    pub fn aligned(drawn: &DrawnRecord, gears: &Gears, revolutions: u32, faults: &[Fault]) -> Self {
        let (wheel, tooth) =
            faults.first().map_or((WheelName::Gear, 0), |fault| (fault.wheel, fault.tooth_index() as u32));
        let turn = gears.teeth(wheel);
        let turns = u64::from(revolutions) * u64::from(gears.gear_teeth) / u64::from(turn.max(1));
        let passed = tooth + one_of(drawn.seed, turns as u32) * turn;
        let gear_teeth = gears.gear_teeth.max(1);
        Self { mark_teeth: passed % gear_teeth, revolution: passed / gear_teeth }
    }

    /// Number of a fault's tooth, from 1, in the order in which its wheel's teeth come into contact from the start of the
    /// record on; none of a fault on several teeth.
    ///
    /// # Arguments
    /// * `fault` - which
    /// * `gears` - the wheels
    pub fn tooth(&self, fault: &Fault, gears: &Gears) -> Option<u32> {
        let index = u64::from(fault.tooth.only()?.saturating_sub(1));
        let passed = u64::from(self.mark_teeth) + u64::from(self.revolution) * u64::from(gears.gear_teeth);
        let teeth = u64::from(gears.teeth(fault.wheel)).max(1);
        let since = (index + teeth - passed % teeth) % teeth;
        Some(since as u32 + 1)
    }
}

/// A number below a count.
fn one_of(seed: u64, count: u32) -> u32 {
    let bits = Draws::new(seed, Purpose::DatasetStart, 0).bits();
    // The upper half of a product: uniform but for 2⁻³².
    ((u128::from(bits) * u128::from(count.max(1))) >> 64) as u32
}
