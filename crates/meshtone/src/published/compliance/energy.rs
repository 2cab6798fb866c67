//! Strain energy of a tooth per unit force, split by force component.

use crate::published::damage::ToothSection;
use crate::stiffness::cumulative;
use crate::wheel::ToothProfile;

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
        let integrals = cumulative(&self.profile.x_mm, integrand);
        let of_contact = integrals.iter().enumerate().skip(self.first_contact);
        of_contact.map(|(i, integral)| at_contact(i, integral)).collect()
    }

    /// (mm) Distance of point `i` from the root along the centre line. Integrals are taken in it rather
    /// than in x, so that little cancels in `∫(x − x_i)²`.
    pub(super) fn depth_mm(&self, i: usize) -> f64 {
        self.profile.x_mm[i] - self.profile.x_mm[0]
    }
}
