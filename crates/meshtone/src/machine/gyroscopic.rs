//! Gyroscopic moments of what spins: `G u̇`, with which a tilt about x turns into one about y.
//!
//! A part with the polar moment of inertia I_p that turns at Ω about z resists a tilt rate `φ̇_y` with the moment `I_p Ω φ̇_y` about x, and `φ̇_x` with
//! `−I_p Ω φ̇_x` about y. They take no energy.
//!
//! Source: G. Genta, *Dynamics of Rotating Systems* (2005), chapter 3.

use nalgebra::DMatrix;

use super::modes::Modes;

/// (-) Shift of a mode from which on the moments are stepped.
const STEPPED_SHIFT: f64 = 0.01;
/// (-) Part of the largest moment of inertia below which one is left out: what that shifts is told.
const LEAST_PART: f64 = 0.02;
/// (-) Shift by a part alone below which it is left out too.
const LEAST_SHIFT: f64 = 1e-3;
/// Most parts whose moments are stepped.
const MOST_SPINNING: usize = 16;

/// What turns with a node of a shaft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spinning {
    /// Number of the node's rotation about x, behind which stands that about y.
    pub about_x: usize,
    /// (kg m²) Polar moment of inertia times the speed of its shaft over that of the motor.
    pub polar_kgm2: f64,
}

impl Modes {
    /// (1/s) `φ_aᵀ G φ_b` of all modes that deform the machine up to a frequency, which are the first of all, with their ω² in 1/s².
    ///
    /// # Arguments
    /// * `spinning` - what turns
    /// * `motor_rad_per_s` - (rad/s) speed of the motor
    /// * `highest_rad_per_s` - (rad/s) natural frequency of the highest mode that counts
    fn whirled(
        &self,
        spinning: &[Spinning],
        motor_rad_per_s: f64,
        highest_rad_per_s: f64,
    ) -> (Vec<f64>, DMatrix<f64>) {
        let counts =
            |n: &usize| (f64::MIN_POSITIVE..=highest_rad_per_s).contains(&self.angular_frequencies[*n]);
        let counted: Vec<usize> = (0..self.angular_frequencies.len()).filter(counts).collect();
        let tilts = |about: usize, factor: &dyn Fn(&Spinning) -> f64| {
            DMatrix::from_fn(spinning.len(), counted.len(), |part, mode| {
                factor(&spinning[part]) * self.shapes[(spinning[part].about_x + about, counted[mode])]
            })
        };
        let half = tilts(0, &|of| motor_rad_per_s * of.polar_kgm2).transpose() * tilts(1, &|_| 1.0);
        let squares = counted.iter().map(|&n| self.angular_frequencies[n].powi(2)).collect();
        (squares, &half - half.transpose())
    }

    /// (-) The largest part by which two modes alone shift one another: `(ω_a² − ω²)(ω_b² − ω²) = ω² g²`. Arguments as of [`Self::whirled`].
    ///
    /// Returns the natural frequency of that mode in Hz with it; none where nothing shifts.
    pub(crate) fn largest_shift(
        &self,
        spinning: &[Spinning],
        motor_rad_per_s: f64,
        highest_rad_per_s: f64,
    ) -> Option<[f64; 2]> {
        let (squares, coupling) = self.whirled(spinning, motor_rad_per_s, highest_rad_per_s);
        let pairs = (0..squares.len()).flat_map(|a| (0..squares.len()).map(move |b| (a, b)));
        let of_pair = |(a, b): (usize, usize)| {
            [squares[a].sqrt() / std::f64::consts::TAU, shift(squares[a], squares[b], coupling[(a, b)])]
        };
        pairs.filter(|(a, b)| coupling[(*a, *b)] != 0.0).map(of_pair).max_by(|a, b| a[1].total_cmp(&b[1]))
    }

    /// What is to be stepped of what spins: nothing where it hardly shifts a mode. Arguments as of [`Self::whirled`].
    pub(crate) fn stepped_spinning(
        &self,
        spinning: &[Spinning],
        motor_rad_per_s: f64,
        highest_rad_per_s: f64,
    ) -> Vec<Spinning> {
        let shifted = self.largest_shift(spinning, motor_rad_per_s, highest_rad_per_s);
        if shifted.is_none_or(|[_, part]| part < STEPPED_SHIFT) {
            return Vec::new();
        }
        let mut nodes: Vec<Spinning> = Vec::new();
        for part in spinning {
            match nodes.iter_mut().find(|node| node.about_x == part.about_x) {
                Some(node) => node.polar_kgm2 += part.polar_kgm2,
                None => nodes.push(*part),
            }
        }
        nodes.sort_by(|a, b| b.polar_kgm2.abs().total_cmp(&a.polar_kgm2.abs()));
        let least = LEAST_PART * nodes[0].polar_kgm2.abs();
        nodes.retain(|node| node.polar_kgm2.abs() >= least);
        nodes.truncate(MOST_SPINNING);
        let shifts = |node: &Spinning| {
            let shifted = self.largest_shift(std::slice::from_ref(node), motor_rad_per_s, highest_rad_per_s);
            shifted.is_some_and(|[_, part]| part >= LEAST_SHIFT)
        };
        nodes.retain(shifts);
        nodes
    }

    /// (rad/s) Natural frequencies with the gyroscopic moments, in rising order, each twice. Arguments as of [`Self::whirled`].
    ///
    /// With `x = ω q` and `v = q̇` the motion is `(x, v)′ = A (x, v)`, whose A has `A = −Aᵀ`: their squares are the eigenvalues of `AᵀA`.
    ///
    /// Returns the natural frequencies without them beside these.
    pub(crate) fn whirling(
        &self,
        spinning: &[Spinning],
        motor_rad_per_s: f64,
        highest_rad_per_s: f64,
    ) -> Vec<[f64; 2]> {
        let (squares, coupling) = self.whirled(spinning, motor_rad_per_s, highest_rad_per_s);
        let modes = squares.len();
        let motion =
            DMatrix::from_fn(2 * modes, 2 * modes, |row, column| match (row < modes, column < modes) {
                (true, true) => 0.0,
                (true, false) if row + modes == column => squares[row].sqrt(),
                (false, true) if row == column + modes => -squares[column].sqrt(),
                (false, false) => -coupling[(row - modes, column - modes)],
                _ => 0.0,
            });
        let mut whirled: Vec<f64> = motion.tr_mul(&motion).symmetric_eigenvalues().iter().copied().collect();
        whirled.sort_by(f64::total_cmp);
        let each = whirled.chunks_exact(2).map(|pair| (pair[0] + pair[1]) / 2.0);
        let mut own = squares;
        own.sort_by(f64::total_cmp);
        own.iter().zip(each).map(|(own, whirled)| [own.sqrt(), whirled.max(0.0).sqrt()]).collect()
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
