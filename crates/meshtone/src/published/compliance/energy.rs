//! Strain energy of a tooth per unit force, split by force component.

use crate::published::damage::ToothSection;
use crate::stiffness::LoadDirection;
use crate::wheel::ToothProfile;

/// Strain energy under a force `F` along the line of action, at each contact point:
/// `U = F_s² ss + F_s F_a sa + F_a² aa`, with `F_s = F cos α` across and `F_a = F sin α` along the
/// tooth.
///
/// The split lets the force's direction differ from point to point (a through fault) although each
/// integral is evaluated once for all points (paper, Eq. 2 → 3).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct EnergyCoefficients {
    pub(super) ss: f64,
    pub(super) sa: f64,
    pub(super) aa: f64,
}

impl EnergyCoefficients {
    /// (mm/N) Compliance `2U` of a unit force.
    pub(super) fn compliance(&self, load: LoadDirection) -> f64 {
        let (fa, fs) = (load.sin, load.cos);
        2.0 * (fs * fs * self.ss + fs * fa * self.sa + fa * fa * self.aa)
    }
}

/// One tooth as the strain energy integrals see it.
pub(super) struct LoadedTooth<'a> {
    pub(super) profile: &'a ToothProfile,
    pub(super) section: &'a ToothSection,
    pub(super) youngs_modulus_mpa: f64,
    pub(super) shear_modulus_mpa: f64,
    pub(super) first_contact: usize,
}

impl LoadedTooth<'_> {
    /// Runs `integrand` through a cumulative trapezoid from the root, and hands the integral up to each
    /// contact point to `at_contact`.
    pub(super) fn integrate<const N: usize, T>(
        &self,
        integrand: impl Fn(usize) -> [f64; N],
        at_contact: impl Fn(usize, &[f64; N]) -> T,
    ) -> Vec<T> {
        let x = &self.profile.x_mm;
        let mut integral = [0.0; N];
        let mut before = integrand(0);
        let mut results = Vec::with_capacity(x.len() - self.first_contact);
        if self.first_contact == 0 {
            results.push(at_contact(0, &integral));
        }
        for i in 1..x.len() {
            let here = integrand(i);
            let half_step = 0.5 * (x[i] - x[i - 1]);
            for n in 0..N {
                integral[n] += half_step * (before[n] + here[n]);
            }
            before = here;
            if i >= self.first_contact {
                results.push(at_contact(i, &integral));
            }
        }
        results
    }

    /// (mm) Distance of point `i` from the root along the centre line. Integrals are taken in it rather
    /// than in x, so that little cancels in `∫(x − x_i)²`.
    pub(super) fn depth_mm(&self, i: usize) -> f64 {
        self.profile.x_mm[i] - self.profile.x_mm[0]
    }
}
