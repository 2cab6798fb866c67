//! The mesh under `contact`: all pairs, tabulated by class, from before their path to beyond it.

use std::num::NonZeroUsize;
use std::ops::Range;

use super::contact_forcing::PAIRS;
use super::contact_pairs::{ContactPairs, ContactState, TipShape};
use super::law::ContactConstants;
use super::load_state::{DirectionMatrix, LoadState};
use super::pair::Pairs;
use super::sequence::{PairKind, PairSequence};

/// (base pitches) How far outside its path a pair is looked at: a corner there is some mm away from the flank.
const REACH: f64 = 0.6;

/// The mesh as a sequence of pairs that push and never pull.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactMesh {
    /// Number of points from one pair to the next.
    pub points_per_pitch: usize,
    /// Which teeth meet.
    pub sequence: PairSequence,
    /// A table for each class of pairs, in the order of [`PairSequence::classes`].
    pub classes: Vec<ContactTable>,
    /// Number of points before the start of the path at which the tables begin.
    pub points_before: usize,
    /// (N/m) Mean over the cycle of the stiffness of all pairs on their path, of sound teeth.
    pub mean_stiffness_n_per_m: f64,
    /// (s) Damping of a contact over its stiffness, `2 ζ √(m/k̄)`.
    pub damping_time_s: f64,
    /// (m) Normal backlash.
    pub backlash_m: f64,
    /// (-) Contact ratio of sound teeth: the length of their path between the chamfers, in base pitches.
    pub contact_ratio: f64,
    /// How a sound pair carries its load.
    pub nominal: LoadState,
}

/// A class of pairs, point by point.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactTable {
    /// The class.
    pub kind: PairKind,
    /// The pair at each point.
    pub states: Vec<ContactState>,
}

impl ContactTable {
    /// Whether its pairs can touch at all.
    pub(crate) fn can_touch(&self) -> bool {
        self.states.iter().any(|state| state.stiffness_n_per_m > 0.0)
    }
}

/// What the damping and the back flanks need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ContactParameters {
    /// (-) ζ.
    pub(crate) damping_ratio: f64,
    /// (kg) Mass that the wheels' rotation has along the line of action.
    pub(crate) mesh_mass_kg: f64,
    /// (m) Normal backlash.
    pub(crate) backlash_m: f64,
}

impl ContactMesh {
    /// (-) Largest contact ratio at which all pairs that touch are looked at: tip corners need some room before and after.
    pub(crate) const MOST_CONTACT_RATIO: f64 = PAIRS as f64 - 0.4;

    /// Tabulates the pairs.
    ///
    /// # Arguments
    /// * `pairs` - the tooth pairs
    /// * `shape` - of all tips
    /// * `sequence` - which of them meet
    /// * `points_per_pitch` - number of points from one pair to the next
    /// * `parameters` - damping and back flanks
    pub(crate) fn new(
        pairs: &Pairs,
        shape: TipShape,
        sequence: PairSequence,
        points_per_pitch: NonZeroUsize,
        parameters: ContactParameters,
    ) -> Self {
        let points_per_pitch = points_per_pitch.get();
        let per_pitch = points_per_pitch as f64;
        let contact = ContactPairs::new(pairs, shape);
        let [begins, ends] = contact.path_of_sound_teeth();
        // As many pairs as a step looks at reach from the first point to the last.
        let reach = REACH.min((PAIRS as f64 - (ends - begins)) / 2.0).max(0.0);
        let points_before = ((reach - begins) * per_pitch).floor().max(0.0) as usize;
        let points =
            (((ends + reach) * per_pitch).floor() as usize + points_before).min(PAIRS * points_per_pitch);
        let positions: Vec<f64> =
            (0..points).map(|point| (point as f64 - points_before as f64) / per_pitch).collect();
        let classes: Vec<ContactTable> = (sequence.classes().iter())
            .map(|&kind| ContactTable { kind, states: contact.tabulate(&kind, &positions) })
            .collect();
        let on_path =
            classes[0].states.iter().zip(&positions).filter(|(_, at)| (begins..=ends).contains(*at));
        let mean_stiffness_n_per_m =
            on_path.map(|(state, _)| state.stiffness_n_per_m).sum::<f64>() / per_pitch;
        let ContactParameters { damping_ratio, mesh_mass_kg, backlash_m } = parameters;
        Self {
            points_per_pitch,
            sequence,
            classes,
            points_before,
            mean_stiffness_n_per_m,
            damping_time_s: 2.0 * damping_ratio * (mesh_mass_kg / mean_stiffness_n_per_m).sqrt(),
            backlash_m,
            contact_ratio: ends - begins,
            nominal: pairs.nominal_load(),
        }
    }

    /// (N/m) A closed mesh of a stiffness, as by sound pairs, in the constant directions.
    pub(crate) fn closed(&self, stiffness_n_per_m: f64) -> DirectionMatrix {
        self.nominal.mean_square(self.nominal.pressure_angle_rad) * stiffness_n_per_m
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

    /// Whether the load of some pair lies off the middle of the face, so that the wheels tilt.
    pub fn tilts(&self) -> bool {
        self.classes.iter().flat_map(|class| &class.states).any(|state| state.face_centre_m != 0.0)
    }

    /// What the law needs beside the pairs.
    ///
    /// # Arguments
    /// * `static_force_n` - (N) mesh force under the constant loads
    pub(crate) fn constants(&self, static_force_n: f64) -> ContactConstants {
        ContactConstants {
            damping_time_s: self.damping_time_s,
            static_force_n,
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
        touching_n_per_m(&ages.map(state).collect::<Vec<_>>())
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
                touching_n_per_m(&pairs.copied().collect::<Vec<_>>()) * 1e-3
            })
            .collect()
    }
}

/// (N/m) Stiffness of the pairs that a light load presses together: those that are hardly farther apart than the nearest.
fn touching_n_per_m(states: &[ContactState]) -> f64 {
    let pairs = || states.iter().filter(|state| state.stiffness_n_per_m > 0.0);
    let nearest = pairs().map(|state| state.separation_m).fold(f64::INFINITY, f64::min);
    let touching = pairs().filter(|state| state.separation_m < nearest + TOUCHING_M);
    // A sum of no numbers is −0.
    touching.fold(0.0, |sum, state| sum + state.stiffness_n_per_m)
}

/// (m) How much farther apart than the nearest a pair is counted as touching in the mesh's stiffness.
const TOUCHING_M: f64 = 1e-9;
