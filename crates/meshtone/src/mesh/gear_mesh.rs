//! A mesh: all pairs of two wheels, tabulated by class, from before their path to beyond it.

use std::num::NonZeroUsize;
use std::ops::Range;

use super::face_load::{FaceLoad, FaceSlope};
use super::forcing::{PAIRS, Turning};
use super::law::{Contact, MeshLaw, PairsSample, deflection_at_rest};
use super::pair::Pairs;
use super::path_table::{PairState, PairTables, TipShape, share_on_path};
use super::sequence::{PairKind, PairSequence};
use crate::machine::ClosedMesh;
use crate::simd::Lanes;

/// (base pitches) How far outside its path a pair is looked at: a corner there is some mm away from the flank.
const REACH: f64 = 0.6;

/// The mesh of two wheels as a sequence of tooth pairs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Mesh {
    /// Number of points from one pair to the next.
    pub points_per_pitch: usize,
    /// Which teeth meet.
    pub sequence: PairSequence,
    /// A table for each class of pairs, in the order of [`PairSequence::classes`].
    pub classes: Vec<PairTable>,
    /// Number of points before the start of the path at which the tables begin.
    pub points_before: usize,
    /// (N/m) Mean over the cycle of the stiffness of all pairs on their path, of sound teeth.
    pub mean_stiffness_n_per_m: f64,
    /// (s) Damping of a contact over its stiffness, `2 ζ √(m/k̄)`.
    pub damping_time_s: f64,
    /// (m) Normal backlash; none where the mesh may pull, so that coast flanks never touch.
    pub backlash_m: Option<f64>,
    /// (-) Contact ratio of sound teeth: the length of their path between the chamfers, in base pitches.
    pub contact_ratio: f64,
    /// (m) How far the nominal load presses the mean mesh together.
    pub nominal_deflection_m: f64,
    /// (-) Largest load per length of face over its mean, of sound teeth under the nominal load: the face load factor K_Hβ of
    /// ISO 6336-1. 1 where the flanks lie alike along the face.
    pub face_load_factor: f64,
    /// How its flanks touch.
    pub contact: Contact,
    /// How it turns with the motor.
    pub turning: Turning,
}

/// A class of pairs, point by point.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PairTable {
    /// The class.
    pub kind: PairKind,
    /// The pair at each point.
    pub states: Vec<PairState>,
}

impl PairTable {
    /// Whether its pairs can touch at all.
    pub(crate) fn can_touch(&self) -> bool {
        self.states.iter().any(|state| state.stiffness_n_per_m > 0.0)
    }
}

/// The parameters of a mesh beside its pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeshParameters {
    /// How its flanks touch.
    pub(crate) contact: Contact,
    /// How the mesh turns with the motor.
    pub(crate) turning: Turning,
    /// (-) Damping of the contact over the critical damping of the wheels' rotation on the mean mesh, ζ.
    pub(crate) damping_ratio: f64,
    /// (kg) Mass that the wheels' rotation has along the line of action.
    pub(crate) mesh_mass_kg: f64,
    /// (m) Normal backlash.
    pub(crate) backlash_m: f64,
    /// (N) Nominal load along the line of action.
    pub(crate) static_force_n: f64,
    /// How the flanks close along the face; none where they close alike.
    pub(crate) face: Option<FaceSlope>,
}

impl Mesh {
    /// (-) Largest contact ratio at which all pairs that touch are looked at: tip corners need some room before and after.
    pub(crate) const MOST_CONTACT_RATIO: f64 = PAIRS as f64 - 0.4;

    /// Tabulates the pairs.
    ///
    /// The tables reach as far beyond the path as a tip corner can touch. Where the flanks close unevenly along the face, the states of
    /// all pairs are changed to those of the part of the face that bears under the nominal load.
    ///
    /// # Arguments
    /// * `pairs` - the tooth pairs
    /// * `shape` - of all tips
    /// * `sequence` - which of them meet
    /// * `points_per_pitch` - number of points from one pair to the next
    /// * `parameters` - contact, damping, coast flanks, load along the face
    pub(crate) fn new(
        pairs: &Pairs,
        shape: TipShape,
        sequence: PairSequence,
        points_per_pitch: NonZeroUsize,
        parameters: MeshParameters,
    ) -> Self {
        let MeshParameters {
            contact,
            turning,
            damping_ratio,
            mesh_mass_kg,
            backlash_m,
            static_force_n,
            face,
        } = parameters;
        let points_per_pitch = points_per_pitch.get();
        let per_pitch = points_per_pitch as f64;
        let tables = PairTables::new(pairs, shape, contact);
        let [begins, ends] = tables.path_of_sound_teeth();
        // As many pairs as a step looks at reach from the first point to the last.
        let reach = REACH.min((PAIRS as f64 - (ends - begins)) / 2.0).max(0.0);
        let points_before = ((reach - begins) * per_pitch).floor().max(0.0) as usize;
        let points =
            (((ends + reach) * per_pitch).floor() as usize + points_before).min(PAIRS * points_per_pitch);
        let positions: Vec<f64> =
            (0..points).map(|point| (point as f64 - points_before as f64) / per_pitch).collect();
        let mut classes: Vec<PairTable> = (sequence.classes().iter())
            .map(|&kind| PairTable { kind, states: tables.tabulate(&kind, &positions, 1.0 / per_pitch) })
            .collect();
        let mean_stiffness = |classes: &[PairTable]| {
            let share = |at: f64| match contact {
                Contact::Unilateral => share_on_path(at, 1.0 / per_pitch, [begins, ends]),
                // The stiffness ends with the path.
                Contact::Bilateral => 1.0,
            };
            let states = classes[0].states.iter().zip(&positions);
            states.map(|(state, at)| share(*at) * state.stiffness_n_per_m).sum::<f64>() / per_pitch
        };
        let mut mean_stiffness_n_per_m = mean_stiffness(&classes);
        let mut face_load_factor = 1.0;
        if let Some(face) = face {
            let of_mean = FaceLoad::new(face, static_force_n / mean_stiffness_n_per_m);
            let middle_m = of_mean.middle_m();
            let sound: Vec<FaceLoad> = (0..points_per_pitch)
                .map(|from| pressed_m(&classes[0].states, from, points_per_pitch, static_force_n))
                .map(|deflection_m| FaceLoad::new(face, deflection_m))
                .collect();
            for (at, state) in classes.iter_mut().flat_map(|class| class.states.iter_mut().enumerate()) {
                sound[at % points_per_pitch].lean(state, middle_m);
            }
            mean_stiffness_n_per_m = mean_stiffness(&classes);
            face_load_factor = of_mean.factor();
        }
        Self {
            points_per_pitch,
            sequence,
            classes,
            points_before,
            mean_stiffness_n_per_m,
            damping_time_s: 2.0 * damping_ratio * (mesh_mass_kg / mean_stiffness_n_per_m).sqrt(),
            backlash_m: (contact == Contact::Unilateral).then_some(backlash_m),
            contact_ratio: ends - begins,
            nominal_deflection_m: static_force_n / mean_stiffness_n_per_m,
            face_load_factor,
            contact,
            turning,
        }
    }

    /// Number of points of a pair.
    pub fn points(&self) -> usize {
        self.classes[0].states.len()
    }

    /// (base pitches) Position of a point of a pair since the start of its path.
    ///
    /// # Arguments
    /// * `point` - from 0
    pub fn position(&self, point: usize) -> f64 {
        (point as f64 - self.points_before as f64) / self.points_per_pitch as f64
    }

    /// (m) How far from the middle of the face the load of a pair acts at most; 0 where no load tilts the wheels.
    pub fn face_reach_m(&self) -> f64 {
        let states = self.classes.iter().flat_map(|class| &class.states);
        states.map(|state| state.face_centre_m.abs()).fold(0.0, f64::max)
    }

    /// The mesh as if it were closed always, with its mean stiffness.
    pub(crate) fn closed(&self) -> ClosedMesh {
        ClosedMesh { stiffness_n_per_m: self.mean_stiffness_n_per_m, damping_time_s: self.damping_time_s }
    }

    /// Its law.
    pub fn law(&self) -> MeshLaw {
        MeshLaw {
            contact: self.contact,
            damping_time_s: self.damping_time_s,
            back_stiffness_n_per_m: self.mean_stiffness_n_per_m,
            backlash_m: self.backlash_m,
        }
    }

    /// (N/m) Sum of the stiffnesses of the pairs that touch under a light load at a point, counted from the start of the simulation.
    pub(crate) fn whole_stiffness_at(&self, point: usize) -> f64 {
        let (pitch, since) = ((point / self.points_per_pitch) as i64, point % self.points_per_pitch);
        let ages = (since + self.points_before..self.points()).step_by(self.points_per_pitch).enumerate();
        let state =
            |(age, at): (usize, usize)| self.classes[self.sequence.class(pitch - age as i64)].states[at];
        self.touching_n_per_m(&ages.map(state).collect::<Vec<_>>())
    }

    /// (N/mm) Sum of the stiffnesses of the pairs that touch under a light load, at every point of some pitches.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation
    pub fn stiffness_n_per_mm(&self, pitches: Range<usize>) -> Vec<f64> {
        let points = pitches.start * self.points_per_pitch..pitches.end * self.points_per_pitch;
        points.map(|point| self.whole_stiffness_at(point) * 1e-3).collect()
    }

    /// (N/mm) The same of sound teeth, over one pitch.
    pub fn healthy_stiffness_n_per_mm(&self) -> Vec<f64> {
        let states = &self.classes[0].states;
        (0..self.points_per_pitch)
            .map(|since| {
                let pairs = states[since + self.points_before..].iter().step_by(self.points_per_pitch);
                self.touching_n_per_m(&pairs.copied().collect::<Vec<_>>()) * 1e-3
            })
            .collect()
    }

    /// (N/m) Stiffness of the pairs that carry a light load: those that are hardly farther apart than the nearest, or all where they
    /// may pull.
    fn touching_n_per_m(&self, states: &[PairState]) -> f64 {
        let pairs = || states.iter().filter(|state| state.stiffness_n_per_m > 0.0);
        let farthest_m = match self.contact {
            Contact::Unilateral => nearest_m(pairs()) + TOUCHING_M,
            Contact::Bilateral => f64::INFINITY,
        };
        let touching = pairs().filter(|state| state.separation_m < farthest_m);
        // A sum of no numbers is −0.
        touching.fold(0.0, |sum, state| sum + state.stiffness_n_per_m)
    }

    /// (m) Deflection at which some pairs carry a force at rest, and whether any of them can touch at all.
    ///
    /// # Arguments
    /// * `states` - of the pairs that are looked at together
    /// * `force_n` - (N) the force, 0 or more
    pub(super) fn deflection_at_rest<'a>(
        &self,
        states: impl Iterator<Item = &'a PairState>,
        force_n: f64,
    ) -> Option<f64> {
        let sample = sample_of(states);
        let touches = sample.stiffness.iter().any(|stiffness| stiffness.0[0] > 0.0);
        touches.then(|| deflection_at_rest(self.contact, &sample, 0, force_n))
    }
}

/// Pairs without deviations as a sample of the time loop.
fn sample_of<'a>(states: impl Iterator<Item = &'a PairState>) -> PairsSample<1> {
    let mut sample = PairsSample::<1>::NONE;
    for (place, state) in states.take(PAIRS).enumerate() {
        sample.stiffness[place] = Lanes([state.stiffness_n_per_m]);
        sample.offset[place] = Lanes([-state.separation_m]);
    }
    sample
}

/// (m) How far a load presses the nearest of sound pairs together at rest.
///
/// # Arguments
/// * `states` - of sound pairs
/// * `from` - first point of those that pairs are at together
/// * `per_pitch` - number of points from one pair to the next
/// * `force_n` - (N) the load
fn pressed_m(states: &[PairState], from: usize, per_pitch: usize, force_n: f64) -> f64 {
    let together =
        || states.iter().skip(from).step_by(per_pitch).filter(|state| state.stiffness_n_per_m > 0.0);
    deflection_at_rest(Contact::Unilateral, &sample_of(together()), 0, force_n) - nearest_m(together())
}

/// (m) Least separation of some pairs.
fn nearest_m<'a>(states: impl Iterator<Item = &'a PairState>) -> f64 {
    states.map(|state| state.separation_m).fold(f64::INFINITY, f64::min)
}

/// (m) How much farther apart than the nearest a pair is counted as touching in the mesh's stiffness.
const TOUCHING_M: f64 = 1e-9;
