//! The cycle's grid, and positions in it, in the floating-point arithmetic of the published code.

use crate::operation::{CycleGrid, FINE_PER_COARSE};
use crate::scenario::Scenario;
use crate::wheel::Gears;

/// The division of the cycle, which follows the nominal sampling rate. A pitch has `⌈(1/z_p)/d_f⌉` fine points: where that quotient is
/// a rounding error above a whole number (20 and 25 teeth), every pitch is a fine point too long, and the cycle by `z_g` of them.
pub(super) fn grid(scenario: &Scenario, gears: &Gears) -> CycleGrid {
    let [pinion_teeth, gear_teeth] = [gears.pinion_teeth, gears.gear_teeth];
    let grid = CycleGrid::new(pinion_teeth, gear_teeth, scenario.solver.sampling_rate_hz);
    let fine_points_per_pitch = ((1.0 / f64::from(pinion_teeth)) / grid.fine_step_rev).ceil() as usize;
    CycleGrid {
        coarse_step_rev: grid.fine_step_rev * FINE_PER_COARSE as f64,
        fine_points_per_pitch,
        points_per_gear_revolution: fine_points_per_pitch
            .saturating_mul(gear_teeth as usize)
            .div_ceil(FINE_PER_COARSE),
        ..grid
    }
}

/// Octave's remainder of a division by a number that need not be whole: 0 where the quotient is whole but for a rounding error.
pub(super) fn remainder(dividend: f64, divisor: f64) -> f64 {
    let quotient = dividend / divisor;
    let whole = quotient.round();
    if divisor.fract() != 0.0 && ((quotient - whole) / whole).abs() < f64::EPSILON {
        return 0.0;
    }
    dividend - divisor * quotient.trunc()
}
