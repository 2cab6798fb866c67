//! Stiffness of one tooth pair while it passes through contact.

use crate::error::{self, ScenarioError};
use crate::interpolation::{NotAKnotSpline, UniformLinear};
use crate::published::compliance::ToothCompliance;
use crate::published::damage::{FaultGeometry, ToothSection};
use crate::stiffness::hertz_compliance_mm_per_n;
use crate::wheel::{Gears, NamedGears, Teeth};

/// Stiffness of the healthy and of the faulty tooth pair at the points of contact.
#[derive(Debug, Clone, PartialEq)]
pub struct PairStiffness {
    /// (N/mm) Healthy pair, in the order of contact, uniform over `span_rev`.
    pub healthy_n_per_mm: Vec<f64>,
    /// (N/mm) Faulty pair, likewise.
    pub faulty_n_per_mm: Option<Vec<f64>>,
    /// (rev) Part of a pinion revolution during which a pair touches.
    pub span_rev: f64,
}

impl PairStiffness {
    /// Stiffness of the healthy pair, and of the faulty one if there is a fault.
    ///
    /// # Arguments
    /// * `gears` - material and foundation coefficients
    /// * `teeth` - both healthy teeth
    /// * `fault` - the faulty pair
    ///
    /// # Errors
    /// Foundation coefficients with which the healthy pair would not be stiff.
    pub fn new(gears: &Gears, teeth: &Teeth, fault: Option<&FaultGeometry>) -> Result<Self, ScenarioError> {
        let sound_gear = ToothSection::sound(&teeth.gear, &teeth.gear_profile);
        let sound_pinion = ToothSection::sound(&teeth.pinion, &teeth.pinion_profile);
        let healthy_n_per_mm = pair_stiffness(gears, teeth, &sound_pinion, &sound_gear);
        if healthy_n_per_mm.contains(&0.0) {
            return Err(error::not_stiff(NamedGears::of_pair(gears).foundation()));
        }
        Ok(Self {
            healthy_n_per_mm,
            faulty_n_per_mm: fault.map(|fault| {
                let mut stiffness = pair_stiffness(gears, teeth, &fault.pinion, &fault.gear);
                let last = teeth.contact.profile_points() - 1;
                for i in fault.no_contact.clone().filter(|&i| i >= teeth.contact.initial_contact_index) {
                    stiffness[last - i] = 0.0;
                }
                stiffness
            }),
            span_rev: teeth.contact.span_rev,
        })
    }

    /// The healthy pair's stiffness as a curve over the position in contact.
    pub fn healthy_curve(&self) -> PairCurve<'_> {
        PairCurve::Spline(NotAKnotSpline::uniform(0.0, self.step_rev(), &self.healthy_n_per_mm))
    }

    /// The faulty pair's stiffness as a curve; the healthy one's without a fault.
    pub fn faulty_curve(&self) -> PairCurve<'_> {
        match &self.faulty_n_per_mm {
            Some(values) => PairCurve::Lines(UniformLinear::uniform(0.0, self.step_rev(), values)),
            None => self.healthy_curve(),
        }
    }

    fn step_rev(&self) -> f64 {
        self.span_rev / (self.healthy_n_per_mm.len() - 1) as f64
    }
}

/// Stiffness of a pair over its position in contact, a fraction of a pinion revolution.
#[derive(Debug, Clone)]
pub enum PairCurve<'a> {
    /// A healthy pair: a cubic spline.
    Spline(NotAKnotSpline<'a>),
    /// A faulty pair, whose stiffness may jump: straight lines.
    Lines(UniformLinear<'a>),
}

impl PairCurve<'_> {
    /// (N/mm) Stiffness at `position_rev` since the pair entered contact.
    pub fn at(&self, position_rev: f64) -> f64 {
        match self {
            Self::Spline(spline) => spline.at(position_rev),
            Self::Lines(lines) => lines.at(position_rev),
        }
    }
}

/// `k(i) = 1/(pinion(i) + gear(reversed)(i) + Hertz(reversed)(i))` over the contact points.
fn pair_stiffness(gears: &Gears, teeth: &Teeth, pinion: &ToothSection, gear: &ToothSection) -> Vec<f64> {
    let first = teeth.contact.initial_contact_index;
    let compliance = |wheel, profile, section| {
        ToothCompliance::new(wheel, profile, section, gears.material, &gears.foundation, first)
    };
    let pinion_compliance = compliance(&teeth.pinion, &teeth.pinion_profile, pinion);
    let gear_compliance = compliance(&teeth.gear, &teeth.gear_profile, gear);
    let last = teeth.contact.points - 1;
    (0..=last)
        .map(|i| {
            let met = last - i;
            let hertz = hertz_compliance_mm_per_n([gears.material; 2], gear.contact_width_mm[first + met]);
            let total = pinion_compliance.total_mm_per_n(i) + gear_compliance.total_mm_per_n(met) + hertz;
            // Where a chip leaves no width at all the compliance is not a number: no stiffness.
            if total > 0.0 { 1.0 / total } else { 0.0 }
        })
        .collect()
}
