//! The start of a record within the period after which the same teeth meet again.

use meshtone::random::{Draws, Purpose};

use super::Turning;
use crate::draw::DrawnRecord;
use crate::plan::Keep;
use meshtone::scenario::Fault;

/// Where a record begins, in revolutions of the input.
pub(super) struct Start {
    /// (rev) Angle from the start of the simulation. It is negative where the tooth of a gearbox's wheel enters contact before that.
    pub input_rev: f64,
    /// (rev) Angle by which the start of a steady record may be put off: a pair begins with the same teeth again, and a gearbox with the same tooth
    /// of the wheel at whose tooth it begins.
    pub period_rev: f64,
}

/// Where a record begins: at the mark on its unit's marked wheel, in some revolution.
///
/// A rig's tachometer does not know the damaged tooth, so the mark is at any tooth, the same for all records of a unit. Where records are
/// aligned, they begin when a damaged tooth comes into contact: that of the first fault of teeth, and of a record without one the first
/// tooth of the marked wheel.
///
/// # Arguments
/// * `keep` - what is kept of the record
/// * `drawn` - the record
/// * `faults` - of the record's teeth
/// * `turning` - how its wheels turn
/// * `is_steady` - whether motor and brake are steady; if not, teeth are counted from the first time that the mark passes
pub(super) fn start(
    keep: &Keep,
    drawn: &DrawnRecord,
    faults: &[(usize, &Fault)],
    turning: &Turning,
    is_steady: bool,
) -> Start {
    let marked = &turning.wheels[turning.marked];
    let (wheel, passed, turn) = if keep.aligned {
        let of_fault = |(_, fault): &(usize, &Fault)| (turning.number(&fault.wheel), fault.tooth_index());
        let (number, tooth) = faults.first().map_or((turning.marked, 0), of_fault);
        let wheel = &turning.wheels[number];
        let of_marked = f64::from(turning.turns) * f64::from(marked.teeth);
        let pitches = of_marked * wheel.pitches_per_revolution / marked.pitches_per_revolution;
        let turns = (pitches / f64::from(wheel.teeth) + 1e-9).floor().max(1.0);
        (wheel, tooth as u64, one_of(drawn.seed, turns as u32))
    } else {
        let after = one_of(drawn.wheels_seed, marked.teeth);
        let mark = (marked.teeth - after) % marked.teeth.max(1);
        (marked, u64::from(mark), one_of(drawn.seed, turning.turns))
    };
    let teeth = u64::from(wheel.teeth.max(1));
    let pitches = match passed + u64::from(turn) * teeth {
        pitches if is_steady => pitches,
        pitches if turning.enter_together => pitches % u64::from(marked.teeth.max(1)),
        _ => passed,
    };
    let revolution = f64::from(wheel.teeth) / wheel.pitches_per_revolution;
    Start {
        input_rev: wheel.input_rev(pitches as f64),
        period_rev: if turning.enter_together { turning.cycle_rev() } else { revolution },
    }
}

/// The pitches that have passed each wheel where teeth begin to be counted: the next tooth to enter contact is the first.
///
/// # Arguments
/// * `turning` - how the wheels turn
/// * `input_rev` - (rev) angle of the input there
/// * `tolerance_rev` - (rev) how far that may have been rounded: a tooth that came so much earlier comes there
pub(super) fn counted_from(turning: &Turning, input_rev: f64, tolerance_rev: f64) -> Vec<i64> {
    let of_wheel = |wheel: &super::TurningWheel| {
        let tolerance = tolerance_rev * wheel.pitches_per_revolution + 1e-9;
        (wheel.pitches(input_rev) - tolerance).ceil() as i64
    };
    turning.wheels.iter().map(of_wheel).collect()
}

/// Number of a fault's tooth, from 1, in the order in which its wheel's teeth come into contact from where they are counted; none of a
/// fault on several teeth.
///
/// # Arguments
/// * `fault` - which
/// * `turning` - how the wheels turn
/// * `counted_from` - of [`counted_from`]
pub(super) fn tooth(fault: &Fault, turning: &Turning, counted_from: &[i64]) -> Option<u32> {
    let index = i64::from(fault.tooth.only()?.saturating_sub(1));
    let number = turning.number(&fault.wheel);
    let teeth = i64::from(turning.wheels[number].teeth.max(1));
    Some((index - counted_from[number]).rem_euclid(teeth) as u32 + 1)
}

/// A number below a count.
fn one_of(seed: u64, count: u32) -> u32 {
    let bits = Draws::new(seed, Purpose::DatasetStart, 0).bits();
    // The upper half of a product: uniform but for 2⁻³².
    ((u128::from(bits) * u128::from(count.max(1))) >> 64) as u32
}
