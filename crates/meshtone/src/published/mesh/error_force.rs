//! The force of the flanks' deviations.

use super::PublishedMesh;
use super::pair::PairCurve;
use crate::error_table::ErrorTable;
use crate::interpolation::{NotAKnotSpline, Pchip};
use crate::published::damage::Displacement;
use crate::wheel::ProfileErrors;

/// Force that deviations of the flanks put on the mesh: stiffness × deviation, `k e`, summed over all pairs in contact.
pub struct ErrorForce<'a> {
    mesh: &'a PublishedMesh,
    healthy: PairCurve<'a>,
    first: PairCurve<'a>,
    /// Number of fine points at which a pair is in contact.
    fine_points: usize,
    pinion_errors: Vec<NotAKnotSpline<'a>>,
    gear_errors: Vec<NotAKnotSpline<'a>>,
    /// What the fault adds to the gear's first tooth.
    pair_displacement: Option<Pchip<'a>>,
}

impl<'a> ErrorForce<'a> {
    /// The force of one pair of wheels.
    ///
    /// # Arguments
    /// * `mesh` - pairs, fault and cycle
    /// * `errors` - profile errors of all teeth
    pub fn new(mesh: &'a PublishedMesh, errors: Option<&'a ProfileErrors>) -> Self {
        let span_rev = mesh.pair.span_rev;
        let step_rev = |points: usize| span_rev / (points - 1) as f64;
        let splines = |errors: &'a ErrorTable| -> Vec<NotAKnotSpline<'a>> {
            let step = step_rev(errors.points());
            errors.each_tooth().map(|tooth| NotAKnotSpline::uniform(0.0, step, tooth)).collect()
        };
        let pair_displacement = match mesh.fault.as_ref().map(|fault| &fault.displacement) {
            Some(Displacement::Pair { displacement_mm }) => {
                Some(Pchip::uniform(0.0, step_rev(displacement_mm.len()), displacement_mm))
            }
            _ => None,
        };
        Self {
            mesh,
            healthy: mesh.pair.healthy_curve(),
            first: mesh.pair.faulty_curve(),
            // The published code loses what overlaps beyond two pairs.
            fine_points: mesh.grid.fine_points_in(span_rev).min(2 * mesh.grid.fine_points_per_pitch),
            pinion_errors: errors.map_or_else(Vec::new, |e| splines(&e.pinion_profile_errors_mm)),
            gear_errors: errors.map_or_else(Vec::new, |e| splines(&e.gear_profile_errors_mm)),
            pair_displacement,
        }
    }

    /// (N) The force.
    ///
    /// # Arguments
    /// * `revolutions` - (rev) of the motor since the start
    pub fn at(&self, revolutions: f64) -> f64 {
        self.of_pairs(revolutions) + self.of_mesh(revolutions)
    }

    /// (N) The part that acts on the mesh as a whole: a through fault's displacement.
    fn of_mesh(&self, revolutions: f64) -> f64 {
        let Some(Displacement::Rolling(rolling)) = self.mesh.fault.as_ref().map(|fault| &fault.displacement)
        else {
            return 0.0;
        };
        match rolling.displacement_mm(self.mesh.position_rev(revolutions)) {
            0.0 => 0.0,
            displacement_mm => {
                displacement_mm * self.mesh.stiffness.mesh_n_per_mm[self.mesh.coarse_point(revolutions)]
            }
        }
    }

    /// (N) The part of profile errors and of a destroyed flank, over the pairs in contact at the fine point nearest to the motor's angle.
    /// Before the first revolutions are complete, the pairs of the cycle before are in contact.
    fn of_pairs(&self, revolutions: f64) -> f64 {
        if self.pair_displacement.is_none() && self.gear_errors.is_empty() {
            return 0.0;
        }
        let grid = &self.mesh.grid;
        let fine = (revolutions / grid.fine_step_rev).round().max(0.0) as usize;
        let (latest, since) = (fine / grid.fine_points_per_pitch, fine % grid.fine_points_per_pitch);
        let [pinion_teeth, gear_teeth] = self.mesh.teeth.map(|teeth| teeth as usize);
        let turns = pinion_teeth * gear_teeth;
        let mut force = 0.0;
        for (age, point) in (since..self.fine_points).step_by(grid.fine_points_per_pitch).enumerate() {
            let pair = latest + turns - age;
            let (pinion_tooth, gear_tooth) = (pair % pinion_teeth, pair % gear_teeth);
            let position_rev = point as f64 * grid.fine_step_rev;
            // The published code takes the faulty stiffness for the pinion's first tooth in every pinion revolution, not only when it
            // meets the faulty gear tooth.
            let stiffness = |tooth: usize| {
                if tooth == 0 { self.first.at(position_rev) } else { self.healthy.at(position_rev) }
            };
            if let Some(errors) = self.gear_errors.get(gear_tooth) {
                force += stiffness(gear_tooth) * errors.at(position_rev);
            }
            if let Some(errors) = self.pinion_errors.get(pinion_tooth) {
                force += stiffness(pinion_tooth) * errors.at(position_rev);
            }
            if let Some(displacement) = self.pair_displacement.as_ref().filter(|_| gear_tooth == 0) {
                force += stiffness(gear_tooth) * displacement.at(position_rev);
            }
        }
        force
    }
}
