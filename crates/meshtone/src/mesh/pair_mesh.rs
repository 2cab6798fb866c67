//! All pairs of the mesh, tabulated by class.

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::ops::Range;

use super::load_state::{DirectionMatrix, DirectionVector, LoadState};
use super::pair::{PairState, Pairs};
use super::sequence::{PairKind, PairSequence};

/// The mesh as a sequence of tooth pairs, tabulated at whole fractions of a pitch.
///
/// The rotation is the motor's: stiffness, deviations and load state of all pairs are known functions of it.
#[derive(Debug, Clone, PartialEq)]
pub struct PairMesh {
    /// Number of points from one pair to the next.
    pub points_per_pitch: usize,
    /// Which teeth meet.
    pub sequence: PairSequence,
    /// A table for each class of pairs, in the order of [`PairSequence::classes`].
    pub classes: Vec<PairTable>,
    /// How a sound pair carries its load.
    pub nominal: LoadState,
    /// Classes of the pairs in contact during a pitch, the latest first; each combination once.
    neighbourhoods: Vec<Vec<usize>>,
    /// Which of them each pitch of the cycle is.
    neighbourhood_of_pitch: Vec<u32>,
}

/// A class of pairs from the start of their contact to its end, point by point.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTable {
    /// The class.
    pub kind: PairKind,
    /// (N/m) Stiffness.
    pub stiffness_n_per_m: Vec<f64>,
    /// (m) How far damage sets the flanks back, as a deviation; empty where it does not.
    pub deviation_m: Vec<f64>,
    /// How the load is carried; empty where it always is as by a sound pair.
    pub load: Vec<LoadState>,
}

impl PairTable {
    fn new(pairs: &Pairs, kind: PairKind, path: &SampledPath) -> Self {
        let states: Vec<PairState> = (0..path.points())
            .map(|point| {
                let state = pairs.at(&kind, path.position(point));
                let stiffness_n_per_mm = path.share(point) * state.stiffness_n_per_mm;
                PairState { stiffness_n_per_mm, ..state }
            })
            .collect();
        let nominal = pairs.nominal_load();
        let loads = states.iter().any(|state| state.load != nominal);
        let deviates = states.iter().any(|state| state.deviation_mm != 0.0);
        Self {
            kind,
            stiffness_n_per_m: states.iter().map(|state| state.stiffness_n_per_mm * 1e3).collect(),
            deviation_m: if deviates {
                states.iter().map(|state| state.deviation_mm * 1e-3).collect()
            } else {
                Vec::new()
            },
            load: if loads { states.iter().map(|state| state.load).collect() } else { Vec::new() },
        }
    }
}

/// A path of contact, sampled. A point stands for the interval around it, half a point to either side: at the path's ends only
/// the part of that interval counts in which the pair touches, so that pairs are in contact as long as the path is.
struct SampledPath {
    /// (-) Length in base pitches.
    contact_ratio: f64,
    points_per_pitch: f64,
}

impl SampledPath {
    fn length(&self) -> f64 {
        self.contact_ratio * self.points_per_pitch
    }

    /// Number of points whose interval the path reaches.
    fn points(&self) -> usize {
        (self.length() + 0.5).ceil() as usize
    }

    /// (base pitches) Where on the path a point is.
    fn position(&self, point: usize) -> f64 {
        (point as f64 / self.points_per_pitch).min(self.contact_ratio)
    }

    /// (-) Part of a point's interval that lies on the path.
    fn share(&self, point: usize) -> f64 {
        let point = point as f64;
        (point + 0.5).min(self.length()) - (point - 0.5).max(0.0)
    }
}

impl PairMesh {
    /// Tabulates the pairs.
    ///
    /// # Arguments
    /// * `pairs` - the tooth pairs
    /// * `sequence` - which of them meet
    /// * `contact_ratio` - (-) length of their path in base pitches
    /// * `points_per_pitch` - number of points from one pair to the next
    pub fn new(
        pairs: &Pairs,
        sequence: PairSequence,
        contact_ratio: f64,
        points_per_pitch: NonZeroUsize,
    ) -> Self {
        let points_per_pitch = points_per_pitch.get();
        let path = SampledPath { contact_ratio, points_per_pitch: points_per_pitch as f64 };
        let classes: Vec<PairTable> =
            sequence.classes().iter().map(|&kind| PairTable::new(pairs, kind, &path)).collect();
        let ages = path.points().div_ceil(points_per_pitch) as i64;
        let mut neighbourhoods: Vec<Vec<usize>> = Vec::new();
        let mut known: HashMap<Vec<usize>, u32> = HashMap::new();
        let neighbourhood_of_pitch = (0..sequence.cycle() as i64)
            .map(|pitch| {
                let classes: Vec<usize> = (0..ages).map(|age| sequence.class(pitch - age)).collect();
                *known.entry(classes).or_insert_with_key(|classes| {
                    neighbourhoods.push(classes.clone());
                    neighbourhoods.len() as u32 - 1
                })
            })
            .collect();
        Self {
            points_per_pitch,
            sequence,
            classes,
            nominal: pairs.nominal_load(),
            neighbourhoods,
            neighbourhood_of_pitch,
        }
    }

    /// Number of points at which a pair is in contact.
    pub fn contact_points(&self) -> usize {
        self.classes[0].stiffness_n_per_m.len()
    }

    /// Number of entries: points of the mesh that differ.
    pub fn entries(&self) -> usize {
        self.neighbourhoods.len() * self.points_per_pitch
    }

    /// The entry of a point: its row in a table of the points that differ, as
    /// [`System::stiffness_matrix_at`](crate::machine::System::stiffness_matrix_at) takes it.
    ///
    /// # Arguments
    /// * `point` - points since the start of the simulation
    pub fn entry(&self, point: usize) -> usize {
        let (pitch, since) = (point / self.points_per_pitch, point % self.points_per_pitch);
        let neighbourhood = self.neighbourhood_of_pitch[pitch % self.neighbourhood_of_pitch.len()];
        neighbourhood as usize * self.points_per_pitch + since
    }

    /// The pairs in contact at an entry: table and point of each.
    fn pairs_at(&self, entry: usize) -> impl Iterator<Item = (&PairTable, usize)> {
        let since = entry % self.points_per_pitch;
        let classes = &self.neighbourhoods[entry / self.points_per_pitch];
        let points = (since..self.contact_points()).step_by(self.points_per_pitch);
        classes.iter().map(|&class| &self.classes[class]).zip(points)
    }

    /// (N/m) `Σ k · mean(g gᵀ)` at an entry, in the constant directions.
    pub(crate) fn stiffness_at(&self, entry: usize) -> DirectionMatrix {
        let nominal = self.nominal.pressure_angle_rad;
        let (mut as_sound, mut others) = (0.0, DirectionMatrix::zeros());
        for (table, point) in self.pairs_at(entry) {
            match table.load.get(point) {
                None => as_sound += table.stiffness_n_per_m[point],
                Some(load) => others += load.mean_square(nominal) * table.stiffness_n_per_m[point],
            }
        }
        others + self.nominal.mean_square(nominal) * as_sound
    }

    /// (N/m) `Σ k · mean(g)` at an entry, in the constant directions.
    pub(crate) fn direction_stiffness_at(&self, entry: usize) -> DirectionVector {
        let nominal = self.nominal.pressure_angle_rad;
        let of_pair = |(table, point): (&PairTable, usize)| {
            let load = table.load.get(point).unwrap_or(&self.nominal);
            load.mean_direction(nominal) * table.stiffness_n_per_m[point]
        };
        self.pairs_at(entry).map(of_pair).sum()
    }

    /// (N/m) Sum of the stiffnesses of the pairs in contact at an entry.
    pub(crate) fn whole_stiffness_at(&self, entry: usize) -> f64 {
        self.pairs_at(entry).map(|(table, point)| table.stiffness_n_per_m[point]).sum()
    }

    /// (N/m) Mean of [`Self::stiffness_at`] over the cycle.
    pub(crate) fn mean_stiffness(&self) -> DirectionMatrix {
        let nominal = self.nominal.pressure_angle_rad;
        let mut sum = DirectionMatrix::zeros();
        for table in &self.classes {
            let weight = table.kind.pairs_per_cycle as f64;
            let of_pair = if table.load.is_empty() {
                self.nominal.mean_square(nominal) * table.stiffness_n_per_m.iter().sum::<f64>()
            } else {
                let points = table.load.iter().zip(&table.stiffness_n_per_m);
                points.map(|(load, k)| load.mean_square(nominal) * *k).sum()
            };
            sum += of_pair * weight;
        }
        sum / (self.sequence.cycle() * self.points_per_pitch) as f64
    }

    /// (N/m) Mean of [`Self::whole_stiffness_at`] over the cycle.
    pub(crate) fn mean_whole_stiffness_n_per_m(&self) -> f64 {
        let of_class = |table: &PairTable| {
            table.kind.pairs_per_cycle as f64 * table.stiffness_n_per_m.iter().sum::<f64>()
        };
        self.classes.iter().map(of_class).sum::<f64>()
            / (self.sequence.cycle() * self.points_per_pitch) as f64
    }

    /// (N/mm) Sum of the stiffnesses of the pairs in contact at every point of some pitches.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation
    pub fn stiffness_n_per_mm(&self, pitches: Range<usize>) -> Vec<f64> {
        let points = pitches.start * self.points_per_pitch..pitches.end * self.points_per_pitch;
        points.map(|point| self.whole_stiffness_at(self.entry(point)) * 1e-3).collect()
    }

    /// (N/mm) The same of a healthy pair of wheels, over one pitch.
    pub fn healthy_stiffness_n_per_mm(&self) -> Vec<f64> {
        let pair = &self.classes[0].stiffness_n_per_m;
        (0..self.points_per_pitch)
            .map(|since| pair[since..].iter().step_by(self.points_per_pitch).sum::<f64>() * 1e-3)
            .collect()
    }

    /// Load states that differ from the sound pair's.
    pub(crate) fn other_loads(&self) -> impl Iterator<Item = &LoadState> {
        self.classes.iter().flat_map(|table| &table.load)
    }
}
