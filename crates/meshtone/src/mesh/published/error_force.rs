//! The profile errors' force in the mesh.

use super::load::MeshLoad;
use super::pair::{PairCurve, PairStiffness};
use crate::damage::published::{ContactWidth, Displacement, FaultGeometry};
use crate::error_table::ErrorTable;
use crate::interpolation::{NotAKnotSpline, Pchip};
use crate::operation::CycleGrid;
use crate::wheel::ProfileErrors;

/// Force that deviations of the flanks put on the mesh: stiffness × deviation, `k e`, summed over all pairs in
/// contact.
pub struct ErrorForce<'a> {
    grid: CycleGrid,
    healthy: PairCurve<'a>,
    first: PairCurve<'a>,
    has_fault: bool,
    fine_pitch: usize,
    fine_points: usize,
    pinion_errors: Vec<NotAKnotSpline<'a>>,
    gear_errors: Vec<NotAKnotSpline<'a>>,
    pinion_teeth: usize,
    gear_teeth: usize,
    pair_displacement: Option<Pchip<'a>>,
    fault: Option<&'a FaultGeometry>,
    mesh: &'a MeshLoad,
}

impl<'a> ErrorForce<'a> {
    /// The force of one pair of wheels.
    ///
    /// # Arguments
    /// * `teeth` - tooth counts of pinion and gear
    /// * `pair` - stiffness of healthy and faulty pair
    /// * `errors` - profile errors of all teeth
    /// * `fault` - the fault, for its displacement
    /// * `mesh` - mesh stiffness over the cycle
    /// * `grid` - division of the cycle
    pub fn new(
        [pinion_teeth, gear_teeth]: [u32; 2],
        pair: &'a PairStiffness,
        errors: Option<&'a ProfileErrors>,
        fault: Option<&'a FaultGeometry>,
        mesh: &'a MeshLoad,
        grid: CycleGrid,
    ) -> Self {
        let splines = |errors: &'a ErrorTable| {
            let step = pair.span_rev / (errors.points() - 1) as f64;
            errors.each_tooth().map(|tooth| NotAKnotSpline::uniform(0.0, step, tooth)).collect()
        };
        let pair_displacement = match fault.map(|fault| &fault.displacement) {
            Some(Displacement::Pair { displacement_mm }) => {
                let step = pair.span_rev / (displacement_mm.len() - 1) as f64;
                Some(Pchip::uniform(0.0, step, displacement_mm))
            }
            _ => None,
        };
        let fine_pitch = grid.fine_points_per_pitch;
        Self {
            healthy: pair.healthy_curve(),
            first: pair.faulty_curve(),
            has_fault: fault.is_some(),
            fine_pitch,
            // The published code loses what overlaps beyond two pairs.
            fine_points: grid.fine_points_in(pair.span_rev).min(2 * fine_pitch),
            pinion_errors: errors.map_or_else(Vec::new, |e| splines(&e.pinion_profile_errors_mm)),
            gear_errors: errors.map_or_else(Vec::new, |e| splines(&e.gear_profile_errors_mm)),
            pinion_teeth: pinion_teeth as usize,
            gear_teeth: gear_teeth as usize,
            pair_displacement,
            fault,
            mesh,
            grid,
        }
    }

    /// (N) The force.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) of the motor
    /// * `position_rev` - (rev) those since the gear's first tooth last entered contact
    /// * `coarse_point` - coarse point of the cycle nearest to `position_rev`
    pub fn at(&self, revolutions: f64, position_rev: f64, coarse_point: usize) -> f64 {
        self.pairs_after(revolutions) + self.mesh_terms(position_rev, coarse_point)
    }

    /// (N) The part that the pairs' own deviations make.
    pub(crate) fn pairs_after(&self, revolutions: f64) -> f64 {
        if !self.has_pairs() {
            return 0.0;
        }
        let fine = revolutions / self.grid.fine_step_rev;
        let nearest = fine.round();
        self.pairs_at(nearest.max(0.0) as usize)
    }

    /// Whether any pair's flanks deviate.
    pub(crate) fn has_pairs(&self) -> bool {
        self.pair_displacement.is_some() || !self.gear_errors.is_empty()
    }

    /// Whether the force depends on the position in the cycle beyond the pairs' own deviations.
    pub(crate) fn depends_on_position(&self) -> bool {
        self.fault.is_some_and(|fault| {
            matches!(fault.displacement, Displacement::Rolling(_))
                || fault.contact_width != ContactWidth::Whole
        })
    }

    /// (N) The part that acts on the mesh as a whole: a through fault's displacement.
    pub(crate) fn mesh_terms(&self, position_rev: f64, coarse_point: usize) -> f64 {
        match self.fault.map(|fault| &fault.displacement) {
            Some(Displacement::Rolling(rolling)) => {
                rolling.displacement_mm(position_rev) * self.mesh_n_per_mm(coarse_point)
            }
            _ => 0.0,
        }
    }

    /// Fine points of the successive samples while a pair is in contact.
    pub(crate) fn fine_points(&self, samples_per_revolution: usize) -> Vec<usize> {
        let per_revolution = self.fine_pitch * self.pinion_teeth;
        (0..)
            .map(|sample: usize| {
                (2 * sample * per_revolution + samples_per_revolution) / (2 * samples_per_revolution)
            })
            .take_while(|&fine| fine < self.fine_points)
            .collect()
    }

    /// Whether each sample of a pitch falls half way between two fine points, so that rounding errors decide which one
    /// it is given.
    pub(crate) fn half_way(&self, samples_per_revolution: usize) -> Vec<bool> {
        let per_revolution = self.fine_pitch * self.pinion_teeth;
        (0..samples_per_revolution / self.pinion_teeth)
            .map(|sample| {
                let twice = 2 * sample * per_revolution;
                twice.is_multiple_of(samples_per_revolution)
                    && !(twice / samples_per_revolution).is_multiple_of(2)
            })
            .collect()
    }

    /// (N) Force of each tooth's deviations at `fine` points since it entered contact.
    pub(crate) fn tooth_tables(&self, fine: &[usize]) -> ToothForces {
        let positions: Vec<f64> = fine.iter().map(|&point| point as f64 * self.grid.fine_step_rev).collect();
        let sample = |curve: &PairCurve| -> Vec<f64> { positions.iter().map(|&x| curve.at(x)).collect() };
        let healthy = sample(&self.healthy);
        let first = sample(&self.first);
        let deviations = |errors: &[NotAKnotSpline], tooth: usize, stiffness: &[f64]| -> Vec<f64> {
            errors.get(tooth).map_or_else(
                || vec![0.0; positions.len()],
                |spline| positions.iter().zip(stiffness).map(|(&x, k)| k * spline.at(x)).collect(),
            )
        };
        let is_first = |tooth: usize| self.has_fault && tooth == 0;
        // The published code takes the faulty stiffness for the pinion's first tooth in every pinion revolution, not only
        // when it meets the faulty gear tooth.
        let pinion = (0..self.pinion_teeth)
            .map(|tooth| {
                deviations(&self.pinion_errors, tooth, if is_first(tooth) { &first } else { &healthy })
            })
            .collect();
        let gear = (0..self.gear_teeth)
            .map(|tooth| {
                let stiffness = if is_first(tooth) { &first } else { &healthy };
                let mut force = deviations(&self.gear_errors, tooth, stiffness);
                if let Some(displacement) = self.pair_displacement.as_ref().filter(|_| is_first(tooth)) {
                    for ((force, k), &x) in force.iter_mut().zip(stiffness).zip(&positions) {
                        *force += k * displacement.at(x);
                    }
                }
                force
            })
            .collect();
        ToothForces { pinion, gear }
    }

    fn mesh_n_per_mm(&self, coarse_point: usize) -> f64 {
        self.mesh.stiffness_n_per_m[coarse_point] * 1e-3
    }

    /// Profile errors and a destroyed flank, over the pairs in contact at fine point `fine`.
    fn pairs_at(&self, fine: usize) -> f64 {
        let (latest, since) = (fine / self.fine_pitch, fine % self.fine_pitch);
        // Before the first revolutions are complete, the pairs of the cycle before are in contact.
        let turns = self.pinion_teeth * self.gear_teeth;
        let mut force = 0.0;
        for (age, point) in (since..self.fine_points).step_by(self.fine_pitch).enumerate() {
            let pair = latest + turns - age;
            let (pinion_tooth, gear_tooth) = (pair % self.pinion_teeth, pair % self.gear_teeth);
            let position = point as f64 * self.grid.fine_step_rev;
            let is_faulty = self.has_fault && gear_tooth == 0;
            let gear_stiffness = if is_faulty { self.first.at(position) } else { self.healthy.at(position) };
            if let Some(errors) = self.gear_errors.get(gear_tooth) {
                force += gear_stiffness * errors.at(position);
            }
            if let Some(errors) = self.pinion_errors.get(pinion_tooth) {
                let is_first = self.has_fault && pinion_tooth == 0;
                let stiffness = if is_first { self.first.at(position) } else { self.healthy.at(position) };
                force += stiffness * errors.at(position);
            }
            if let Some(displacement) = self.pair_displacement.as_ref().filter(|_| is_faulty) {
                force += gear_stiffness * displacement.at(position);
            }
        }
        force
    }
}

/// Force of each tooth's deviations, at every sample while its pair is in contact; one row per tooth.
pub(crate) struct ToothForces {
    /// (N) Pinion.
    pub(crate) pinion: Vec<Vec<f64>>,
    /// (N) Gear, the faulty tooth's own displacement included.
    pub(crate) gear: Vec<Vec<f64>>,
}
