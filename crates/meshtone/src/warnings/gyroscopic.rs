//! Gyroscopic moments, which the steps leave out: by how much they would shift the modes.

use std::f64::consts::TAU;

use crate::error::{ScenarioWarning, WarningKind};
use crate::simulate::Stages;

/// (-) Shift of a mode's frequency that is left out without a warning.
const TOLERATED_SHIFT: f64 = 0.02;

/// A mode that gyroscopic moments shift.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct GyroscopicShift {
    /// (Hz) Its natural frequency without them.
    pub frequency_hz: f64,
    /// (-) By what part they shift it, whichever way.
    pub part: f64,
}

impl Stages {
    /// By how much gyroscopic moments would shift each stepped mode of shafts of beams; none of a rig.
    ///
    /// The moments are `G u̇`, and `g = φ_aᵀ G φ_b` couples two modes with opposite signs: their frequencies then solve
    /// `(ω_a² − ω²)(ω_b² − ω²) = ω² g²`. Of each mode the mate that shifts it the most counts.
    ///
    /// # Arguments
    /// * `speed_hz` - (rev/s) of the motor
    ///
    /// Source: G. Genta, *Dynamics of Rotating Systems* (2005), chapter 3.
    pub fn gyroscopic_shifts(&self, speed_hz: f64) -> Vec<GyroscopicShift> {
        let Some((assembled, modal)) = self.machine() else { return Vec::new() };
        let coupling = |a: usize, b: usize| -> f64 {
            let (one, other) = (&modal.shapes[a], &modal.shapes[b]);
            let of_node = |&(x, polar_kgm2): &(usize, f64)| {
                polar_kgm2 * (one[x] * other[x + 1] - one[x + 1] * other[x])
            };
            TAU * speed_hz * assembled.spinning.iter().map(of_node).sum::<f64>()
        };
        let squares = &modal.stiffness;
        let bending: Vec<usize> = (0..modal.modes()).filter(|&n| squares[n] > 0.0).collect();
        let of_mode = |&a: &usize| {
            let mates = bending.iter().filter(|&&b| b != a);
            let parts = mates.map(|&b| shift(squares[a], squares[b], coupling(a, b)));
            GyroscopicShift { frequency_hz: squares[a].sqrt() / TAU, part: parts.fold(0.0, f64::max) }
        };
        let is_turning = !assembled.spinning.is_empty();
        bending.iter().filter(|_| is_turning).map(of_mode).collect()
    }

    /// The mode that is shifted the most, where that is much.
    pub(super) fn gyroscopic(&self) -> Option<ScenarioWarning> {
        self.scenario.structure.shafts()?;
        let (key, speed_hz) = self.scenario.fastest_speed(&self.layout);
        let shifts = self.gyroscopic_shifts(speed_hz).into_iter();
        let worst =
            shifts.max_by(|a, b| a.part.total_cmp(&b.part)).filter(|worst| worst.part > TOLERATED_SHIFT)?;
        let message = format!(
            "at {speed_hz:.1} rev/s gyroscopic moments, which are neglected, shift the mode at {:.0} Hz by {:.1} %",
            worst.frequency_hz,
            100.0 * worst.part
        );
        Some(ScenarioWarning::new(WarningKind::Gyroscopic, key, message))
    }
}

/// (-) By what part a coupling g shifts the frequency of the first of two modes.
///
/// # Arguments
/// * `own`, `mate` - (1/s²) ω² of both
/// * `coupling` - (1/s) g
fn shift(own: f64, mate: f64, coupling: f64) -> f64 {
    let half = (own + mate + coupling * coupling) / 2.0;
    let apart = (half * half - own * mate).max(0.0).sqrt();
    // The lower mode falls and the higher one rises; their product stays.
    let higher = half + apart;
    let shifted = if own >= mate { higher } else { own * mate / higher };
    ((shifted / own).sqrt() - 1.0).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two equal modes, as of a wheel midway on its shaft: ω± = √(ω² + (g/2)²) ± g/2.
    #[test]
    fn equal_modes_part_as_in_a_closed_form() {
        let (omega, g) = (1000.0_f64, 120.0_f64);
        let exact = ((omega * omega + g * g / 4.0).sqrt() + g / 2.0) / omega - 1.0;
        assert!((shift(omega * omega, omega * omega, g) - exact).abs() < 1e-12);
        assert_eq!(shift(1e6, 4e6, 0.0), 0.0);
        // Far apart modes hardly meet.
        assert!(shift(1e6, 1e8, 100.0) < 1e-4);
    }
}
