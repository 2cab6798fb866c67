//! Friction of the flanks: how the force of a pair on its path is turned across the line of action.
//!
//! The flanks roll on one another at the pitch point and slide elsewhere, at a speed in proportion to the distance d from it and with a sense
//! that changes there. Coulomb friction pushes the driving wheel across the line of action with `μ f tanh(d/δ)`, and the driven one
//! against it, both at the contact point: beside the force at the pitch point, the moment of either wheel is `μ f d tanh(d/δ)` more. That
//! moment is the loss: its power is the moment times the sum of both wheels' speeds, in a ring their difference.
//!
//! Source: S. He, R. Gunda, R. Singh, "Effect of sliding friction on the dynamics of spur gear pair with realistic time-varying stiffness",
//! Journal of Sound and Vibration 301 (2007) 927-949. Here its sense changes smoothly.

use super::window::{Integral, Window};

/// (base pitches) δ: how far from the pitch point friction has 0.76 of its whole size.
const CHANGES_WITHIN: f64 = 0.05;

/// Places on the path at which the force is tabulated before it is averaged along contact lines.
const PLACES: usize = 512;

/// Friction of a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Friction {
    /// (-) μ times the force across the teeth over that in the transverse section.
    pub(crate) coefficient: f64,
    /// (base pitches) Where the pitch point lies on the path.
    pub(crate) pitch_point: f64,
    /// (m) Base pitch.
    pub(crate) base_pitch_m: f64,
}

impl Friction {
    /// (-, m) Force across the line of action per force along it, and its moment about the pitch point.
    ///
    /// # Arguments
    /// * `place` - (base pitches) of the contact on the path
    pub(super) fn at(&self, place: f64) -> [f64; 2] {
        let distance = place - self.pitch_point;
        let across = self.coefficient * (distance / CHANGES_WITHIN).tanh();
        [across, across * distance * self.base_pitch_m]
    }

    /// The same of pairs of a slice of the face at some positions: the mean over what their contact line has on the path. What lies outside
    /// it touches at the path's end.
    ///
    /// # Arguments
    /// * `ends` - (base pitches) of the path
    /// * `positions` - (base pitches) of the pairs, at the middle of the face
    /// * `window` - of the slice
    pub(super) fn tabulate(&self, ends: [f64; 2], positions: &[f64], window: Window) -> [Vec<f64>; 2] {
        let [begins, until] = ends;
        let on_path = |place: f64| place.clamp(begins, until.max(begins));
        let step = (until - begins) / (PLACES - 1) as f64;
        let along_path: Vec<[f64; 2]> = (0..PLACES).map(|n| self.at(begins + step * n as f64)).collect();
        [0, 1].map(|number| {
            let values: Vec<f64> = along_path.iter().map(|numbers| numbers[number]).collect();
            let integral = Integral::new(ends, &values);
            let mean = |position: &f64| {
                let [from, to] = window.around(*position).map(on_path);
                if window.is_a_point() || to - from < step {
                    return self.at((from + to) / 2.0)[number];
                }
                integral.between([from, to]) / (to - from)
            };
            positions.iter().map(mean).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs of spur teeth are read off where they touch, with the path's end outside of it, and contact lines as the mean of what they touch.
    #[test]
    fn whole_contact_lines_have_the_mean_of_their_points() {
        let friction = Friction { coefficient: 0.06, pitch_point: 0.8, base_pitch_m: 5e-3 };
        let spur = Window { overlap: 0.0, middle: 0.0, width: 1.0 };
        let helical = Window { overlap: 0.5, ..spur };
        let [across, moment] = friction.tabulate([0.1, 1.7], &[-1.0, 0.2, 0.8, 1.6, 3.0], spur);
        assert_eq!(across[2], 0.0);
        assert!((across[1] + 0.06).abs() < 1e-9 && (across[3] - 0.06).abs() < 1e-9);
        assert!((moment[1] - 0.06 * 0.6 * 5e-3).abs() < 1e-9 && moment[2] == 0.0);
        // Outside the path as at its end.
        assert!((moment[0] - 0.06 * 0.7 * 5e-3).abs() < 1e-9 && (moment[4] - 0.06 * 0.9 * 5e-3).abs() < 1e-9);
        let [across, moment] = friction.tabulate([0.1, 1.7], &[0.8, 1.2], helical);
        assert!(across[0].abs() < 1e-6);
        // ∫ |d| over ±0.25 is 0.0625, less where the sense changes.
        assert!((moment[0] / (0.06 * 0.125 * 5e-3) - 1.0).abs() < 0.05, "{}", moment[0]);
        assert!((across[1] - 0.06).abs() < 1e-3, "{}", across[1]);
    }
}
