//! A shaft that bends between its bearings.

use std::f64::consts::PI;

use nalgebra::Matrix2;

use super::Shaft;
use crate::wheel::Material;

/// (m/N, 1/N, 1/(N m)) Deflection and slope of the shaft at its wheel, relative to what its bearings sit in, per force and
/// moment there.
///
/// A round beam on two simple supports, `1/(3EIL) [[a²b², ab(b−a)], [ab(b−a), a²−ab+b²]]` with the wheel at a from the first
/// and b from the second bearing, and in series the bearings, half of their stiffness at each end. In the plane of the
/// deflection; the slope is its derivative along the shaft.
///
/// Source: W. C. Young, R. G. Budynas, *Roark's Formulas for Stress and Strain*, 7th edition (2002), table 8.1, cases 1e and 3e.
pub(super) fn wheel_flexibility(
    shaft: &Shaft,
    bearing_stiffness_n_per_m: f64,
    material: Material,
) -> Matrix2<f64> {
    let span = shaft.bearing_span_mm * 1e-3;
    let (a, b) = (shaft.wheel_at * span, (1.0 - shaft.wheel_at) * span);
    let second_moment = PI * (shaft.radius_mm * 1e-3).powi(4) / 4.0;
    let bending = 3.0 * material.youngs_modulus_mpa() * 1e6 * second_moment * span;
    let beam = Matrix2::new(a * a * b * b, a * b * (b - a), a * b * (b - a), a * a - a * b + b * b) / bending;
    let end = bearing_stiffness_n_per_m / 2.0;
    let bearings = Matrix2::new(a * a + b * b, a - b, a - b, 2.0) / (end * span * span);
    beam + bearings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bends_as_a_beam_midway() {
        for span in [110.0, 125.0] {
            let shaft = Shaft { bearing_span_mm: span, ..Shaft::new(200.0, 10.0) };
            let stiffness = 1.0 / wheel_flexibility(&shaft, 1e15, Material::default())[(0, 0)];
            let modulus = Material::default().youngs_modulus_mpa() * 1e6;
            let expected = 48.0 * modulus * (PI / 4.0 * 1e-8) / (span * 1e-3f64).powi(3);
            assert!((stiffness / expected - 1.0).abs() < 1e-6, "{span}: {stiffness} {expected}");
        }
    }

    #[test]
    fn bearings_act_in_series() {
        let shaft = Shaft::new(200.0, 10.0);
        let [rigid, soft] =
            [1e15, 1.9e8].map(|bearing| wheel_flexibility(&shaft, bearing, Material::default()));
        assert!((soft[(0, 0)] - rigid[(0, 0)] - 1.0 / 1.9e8).abs() < 1e-14);
        assert_eq!(soft[(0, 1)], 0.0);
    }

    /// Towards the nearer bearing the deflection is less: a force tilts the wheel's plane towards the middle of the span.
    #[test]
    fn a_force_nearer_to_one_bearing_tilts_the_wheel() {
        let shaft = Shaft { wheel_at: 0.3, ..Shaft::new(200.0, 10.0) };
        let flexibility = wheel_flexibility(&shaft, 1e15, Material::default());
        let (a, b) = (0.3 * 0.13, 0.7 * 0.13);
        let bending = 3.0 * Material::default().youngs_modulus_mpa() * 1e6 * (PI / 4.0 * 1e-8) * 0.13;
        assert!((flexibility[(0, 1)] / (a * b * (b - a) / bending) - 1.0).abs() < 1e-6);
        assert!(flexibility[(0, 1)] > 0.0);
        let mirrored = wheel_flexibility(&Shaft { wheel_at: 0.7, ..shaft }, 1e15, Material::default());
        assert!((mirrored[(0, 1)] + flexibility[(0, 1)]).abs() < 1e-9 * flexibility[(0, 1)]);
    }
}
