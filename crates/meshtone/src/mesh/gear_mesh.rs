//! A mesh: all pairs of two wheels, tabulated by class, from before their path to beyond it.

use std::f64::consts::TAU;
use std::num::NonZeroUsize;
use std::ops::Range;

use super::corner::REACH;
use super::forcing::{CornerReading, PAIRS, Turning};
use super::law::{Contact, CornerLaw, MeshLaw, Springs, deflection_at_rest};
use super::pair::Pairs;
use super::path_table::{AlongPath, CornerTable, PairState, PairTables, TipShape, share_on_path};
use super::sequence::{PairKind, PairSequence};
use super::sliding::Friction;
use super::uneven_face::LoadAlongFace;
use super::window::{Window, place_on_face};
use crate::machine::ClosedMesh;

/// How the flanks of a pair lie along the face.
#[derive(Debug, Clone, PartialEq)]
pub enum FaceForm {
    /// Spur teeth alike along the face: they touch at one position of the path, on it or with a corner outside of it.
    Spur,
    /// Helical teeth alike along the face. Their contact line is one spring for what lies on the path, and a corner's law for what
    /// lies outside of it at either end: a sum, which is exact, and not one spring at a mean distance.
    Helical {
        /// (base pitches) How much farther on its path a pair is at the end of the face at positive z than at the other one: the overlap
        /// ratio with the sign of the end that enters contact first.
        overlap: f64,
    },
    /// A face whose gap varies, in slices: each of them is such a spur or helical face.
    Sliced {
        /// (base pitches) As of helical teeth; 0 of spur teeth.
        overlap: f64,
        /// (m) Of each slice, how much farther apart its flanks are than those in the middle of the face.
        gaps_m: Vec<f64>,
    },
}

impl FaceForm {
    /// Number of slices; 1 where the face is taken as a whole.
    pub fn slices(&self) -> usize {
        match self {
            Self::Spur | Self::Helical { .. } => 1,
            Self::Sliced { gaps_m, .. } => gaps_m.len(),
        }
    }

    /// (base pitches) Overlap of the whole face, with the sign of the end that enters contact first; 0 of spur teeth.
    pub fn overlap(&self) -> f64 {
        match self {
            Self::Spur => 0.0,
            Self::Helical { overlap } | Self::Sliced { overlap, .. } => *overlap,
        }
    }

    /// (m) How much farther apart the flanks of a slice are than those in the middle of the face.
    fn gap_m(&self, slice: usize) -> f64 {
        match self {
            Self::Spur | Self::Helical { .. } => 0.0,
            Self::Sliced { gaps_m, .. } => gaps_m[slice],
        }
    }

    /// The stretch of the path that a slice spans.
    pub(super) fn window(&self, slice: usize) -> Window {
        let slices = self.slices();
        let middle = place_on_face(slice as f64 + 0.5, slices);
        Window { overlap: self.overlap(), middle, width: 1.0 / slices as f64 }
    }

    /// (base pitches) How far outside the path pairs are looked at.
    ///
    /// # Arguments
    /// * `contact` - how their flanks touch
    /// * `path` - (base pitches) length of the path
    /// * `step` - (base pitches) from one point of the tables to the next
    fn reach(&self, contact: Contact, path: f64, step: f64) -> f64 {
        match (self.window(0).is_a_point(), contact) {
            // As many pairs of spur wheels as a step looks at reach from the first point to the last.
            (true, _) => REACH.min((PAIRS as f64 - path) / 2.0).max(0.0),
            (false, Contact::Unilateral) => self.overlap().abs() / 2.0 + REACH,
            // A point more, as the last one lies before the end of the reach.
            (false, Contact::Bilateral) => self.overlap().abs() / 2.0 + 2.0 * step,
        }
    }
}

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
    /// (N/m) The same if the whole face of all pairs touched: of coast flanks that hit, and a bound of what the drive flanks reach. It differs
    /// where slices of the face are apart under the nominal load.
    pub closed_stiffness_n_per_m: f64,
    /// (N/m) The same if the flanks lay alike along the face.
    pub(crate) even_stiffness_n_per_m: f64,
    /// (s) Damping of a contact over its stiffness, `2 ζ √(m/k̄)`.
    pub damping_time_s: f64,
    /// (m) Normal backlash; none where the mesh may pull, so that coast flanks never touch.
    pub backlash_m: Option<f64>,
    /// (-) Contact ratio of sound teeth: the length of their path between the chamfers, in base pitches of the transverse section.
    pub contact_ratio: f64,
    /// How the flanks lie along the face.
    pub face: FaceForm,
    /// (m) How far the nominal load presses the mean mesh together.
    pub nominal_deflection_m: f64,
    /// How it bears along its face at rest under the nominal load; evenly where flanks may pull, or without a load.
    pub along_face: LoadAlongFace,
    /// (m) Half the width of its face.
    pub(crate) half_face_m: f64,
    /// (m) Of a mesh that has the slope of its deflection along the face as a second unknown, by how much closer its flanks are at the end of the
    /// face at positive z than midway, while its wheels do not tilt.
    pub(crate) closer_at_end_m: Option<f64>,
    /// How its flanks touch.
    pub contact: Contact,
    /// How it turns with the motor.
    pub turning: Turning,
    /// Sound pairs of helical teeth along their path; none of spur wheels.
    along_path: Option<AlongPath>,
    /// Friction of the flanks; none of frictionless ones.
    friction: Option<Friction>,
    /// (-, m) Of each slice, friction across the line of action per force along it and its moment about the pitch point, at every point of a
    /// pair; empty without friction.
    pub(super) sliding: Vec<[Vec<f64>; 2]>,
    /// The slopes of the flanks along the face that turn with both wheels; none where pairs are alike.
    wobble: Option<[HelixWobble; 2]>,
}

/// A helix slope of a wheel that turns with it: `s cos(2πk/Z + φ)` of tooth k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct HelixWobble {
    /// (-) s, its amplitude.
    pub(crate) slope: f64,
    /// (rad) φ.
    pub(crate) phase_rad: f64,
    /// Z.
    pub(crate) teeth: u32,
}

impl HelixWobble {
    /// (-) The slope of a tooth.
    fn slope_of(&self, tooth: usize) -> f64 {
        self.slope * (TAU * tooth as f64 / f64::from(self.teeth) + self.phase_rad).cos()
    }
}

/// A class of pairs, point by point.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PairTable {
    /// The class.
    pub kind: PairKind,
    /// The pair at each point; where the face has slices all points of the first one, then those of the next one.
    pub states: Vec<PairState>,
    /// Of each slice, what its contact lines have outside the path, before its start and beyond its end; none of spur teeth, whose states
    /// are those of corners there.
    pub corners: Vec<[CornerTable; 2]>,
    /// (-) Of faces that tilt and are no slices, where the middle of what touches of each state lies along the face, from −1 to 1, and half of its
    /// width: that of an even strip with the same stiffness, centroid and moment of inertia. None where that is always the whole face, and of helical
    /// teeth what their contact lines have on the path.
    pub strips: Vec<[f64; 2]>,
}

impl PairTable {
    /// Whether what is left of its pairs' faces lies beside the middle anywhere.
    fn loses_a_part(&self) -> bool {
        self.states.iter().any(|state| state.face_centre_m != 0.0)
    }

    /// Whether its pairs can touch at all.
    pub(crate) fn can_touch(&self) -> bool {
        self.states.iter().any(|state| state.stiffness_n_per_m > 0.0)
    }
}

/// The parameters of a mesh beside its pairs.
#[derive(Debug, Clone, PartialEq)]
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
    /// (m) By how much more the flanks close at the end of the face at positive z than at the other one; of faces in slices.
    pub(crate) closer_m: f64,
    /// What turns of this slope with both wheels; none where nothing turns.
    pub(crate) wobble: Option<[HelixWobble; 2]>,
    /// How they lie along it otherwise.
    pub(crate) face: FaceForm,
    /// Whether the slope of its deflection along the face is to be a second unknown.
    pub(crate) tilts: bool,
    /// (m) Face width.
    pub(crate) face_width_m: f64,
    /// Friction of the flanks; none of frictionless ones.
    pub(crate) friction: Option<Friction>,
}

impl Mesh {
    /// (-) Largest contact ratio at which all pairs that touch are looked at: tip corners need some room before and after.
    pub(crate) const MOST_CONTACT_RATIO: f64 = PAIRS as f64 - 0.4;

    /// Tabulates the pairs.
    ///
    /// The tables reach as far beyond the path as a tip corner can touch.
    ///
    /// # Arguments
    /// * `faces` - the tooth pairs of each slice
    /// * `shapes` - of the pinion's and of the gear's tips
    /// * `sequence` - which of them meet
    /// * `points_per_pitch` - number of points from one pair to the next
    /// * `parameters` - contact, damping, coast flanks, load along the face
    pub(crate) fn new(
        faces: &[Pairs],
        shapes: [TipShape; 2],
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
            closer_m,
            wobble,
            face,
            tilts,
            face_width_m,
            friction,
        } = parameters;
        let points_per_pitch = points_per_pitch.get();
        let per_pitch = points_per_pitch as f64;
        let step = 1.0 / per_pitch;
        let tables: Vec<PairTables> =
            faces.iter().map(|pairs| PairTables::new(pairs, shapes, contact)).collect();
        let [begins, ends] = tables[0].path_of_sound_teeth();
        let reach = face.reach(contact, ends - begins, step);
        let points_before = ((reach - begins) * per_pitch).floor().max(0.0) as usize;
        let points = ((ends + reach) * per_pitch).floor() as usize + points_before;
        let is_spur = face.window(0).is_a_point();
        let points = if is_spur { points.min(PAIRS * points_per_pitch) } else { points };
        let positions: Vec<f64> =
            (0..points).map(|point| (point as f64 - points_before as f64) / per_pitch).collect();
        let sound = sequence.classes()[0];
        // Slices of sound pairs are alike.
        let along_path = if is_spur { None } else { tables[0].along_path(&sound) };
        let along_path_of = |kind: &PairKind, slice: usize| {
            if kind.is_sound() { along_path.clone() } else { tables[slice].along_path(kind) }
        };
        let table = |&kind: &PairKind| {
            let mut table = PairTable { kind, states: Vec::new(), corners: Vec::new(), strips: Vec::new() };
            for slice in 0..face.slices() {
                let window = face.window(slice);
                let mut states = match along_path_of(&kind, slice) {
                    _ if is_spur => tables[slice].tabulate(&kind, &positions, step),
                    None => vec![PairState::APART; points],
                    Some(along_path) => {
                        if contact == Contact::Unilateral {
                            let mut corners = along_path.corners(&positions, window);
                            corners.iter_mut().for_each(|corner| corner.separation_m += face.gap_m(slice));
                            table.corners.push(corners);
                        }
                        if tilts && face.slices() == 1 {
                            table.strips = along_path.strips(&positions, window);
                        }
                        along_path.over_face(&positions, window)
                    }
                };
                states.iter_mut().for_each(|state| state.separation_m += face.gap_m(slice));
                table.states.append(&mut states);
            }
            table
        };
        let classes: Vec<PairTable> = sequence.classes().iter().map(table).collect();
        // Spur teeth keep their stiffness where only a corner touches.
        let share = |at: f64| match (is_spur, contact) {
            (true, Contact::Unilateral) => share_on_path(at, step, [begins, ends]),
            _ => 1.0,
        };
        let mean_stiffness = |classes: &[PairTable]| {
            let states = classes[0].states.iter().zip(positions.iter().cycle());
            states.map(|(state, at)| share(*at) * state.stiffness_n_per_m).sum::<f64>() / per_pitch
        };
        let mean_stiffness_n_per_m = mean_stiffness(&classes);
        let sliding = (friction.iter())
            .flat_map(|friction| {
                let of_slice = |slice| friction.tabulate([begins, ends], &positions, face.window(slice));
                (0..face.slices()).map(of_slice).collect::<Vec<_>>()
            })
            .collect();
        let mut mesh = Self {
            points_per_pitch,
            sequence,
            classes,
            points_before,
            mean_stiffness_n_per_m,
            closed_stiffness_n_per_m: mean_stiffness_n_per_m,
            even_stiffness_n_per_m: mean_stiffness_n_per_m,
            damping_time_s: 0.0,
            backlash_m: (contact == Contact::Unilateral).then_some(backlash_m),
            contact_ratio: ends - begins,
            face,
            nominal_deflection_m: 0.0,
            along_face: LoadAlongFace::EVEN,
            half_face_m: face_width_m / 2.0,
            closer_at_end_m: None,
            contact,
            turning,
            along_path,
            friction,
            sliding,
            wobble,
        };
        mesh.nominal_deflection_m = static_force_n / mesh.mean_stiffness_n_per_m;
        if mesh.slices() > 1 {
            mesh.close_slices(closer_m);
            if contact == Contact::Unilateral && static_force_n > 0.0 {
                mesh.mean_stiffness_n_per_m = mesh.mean_of_sound_n_per_m();
            }
        }
        mesh.damping_time_s = 2.0 * damping_ratio * (mesh_mass_kg / mesh.mean_stiffness_n_per_m).sqrt();
        mesh.nominal_deflection_m = static_force_n / mesh.mean_stiffness_n_per_m;
        mesh
    }

    /// Brings the slices closer together towards one end of the face.
    ///
    /// # Arguments
    /// * `closer_m` - (m) by how much more over the whole face
    fn close_slices(&mut self, closer_m: f64) {
        let points = self.points();
        let closer_m = |slice: usize| closer_m * self.face.window(slice).middle;
        for PairTable { states, corners, .. } in &mut self.classes {
            let numbered = states.iter_mut().enumerate();
            numbered.for_each(|(n, state)| state.separation_m -= closer_m(n / points));
            for (slice, corners) in corners.iter_mut().enumerate() {
                corners.iter_mut().for_each(|corner| corner.separation_m -= closer_m(slice));
            }
        }
    }

    /// (-) λ, half of what closes the flanks by more at one end of the face over the mean deflection, less what the wheels yield: while the whole face bears,
    /// 1 + λ is the face load factor.
    ///
    /// # Arguments
    /// * `closer_m` - (m) what closes them
    /// * `static_force_n` - (N) nominal load
    pub(crate) fn unevenness_of(&self, closer_m: f64, static_force_n: f64) -> f64 {
        let deflection_m = static_force_n / self.even_stiffness_n_per_m;
        closer_m.abs() / (2.0 * deflection_m * (1.0 + self.along_face.tilt_product))
    }

    /// Number of slices of the face; 1 where it is taken as a whole.
    pub fn slices(&self) -> usize {
        self.face.slices()
    }

    /// (-) Where the middle of a slice lies along the face, from −1 to 1, and half of its width.
    pub(super) fn strip_of_slice(&self, slice: usize) -> [f64; 2] {
        [2.0 * self.face.window(slice).middle, 1.0 / self.slices() as f64]
    }

    /// (-) The same of what touches of a state.
    ///
    /// # Arguments
    /// * `class`, `number` - of the pair, and of the state in its table
    pub(super) fn strip(&self, class: usize, number: usize) -> [f64; 2] {
        let of_state = self.classes[class].strips.get(number).copied();
        of_state.unwrap_or_else(|| self.strip_of_slice(number / self.points()))
    }

    /// (-) Where along the face a corner touches, from −1 to 1: where the path ends on a pair's contact line, and of a slice, over which a corner may
    /// reach, midway along what lies outside the path.
    ///
    /// # Arguments
    /// * `slice`, `end` - of which slice, and at which end of the path
    /// * `place` - (base pitches) where the end is
    /// * `point` - of the pair's tables
    pub(super) fn corner_strip(&self, slice: usize, end: usize, place: f64, point: f64) -> f64 {
        let [middle, half_width] = self.strip_of_slice(slice);
        let position = (point - self.points_before as f64) / self.points_per_pitch as f64;
        let along = 2.0 * (place - position) / self.face.overlap();
        let along = along.clamp(middle - half_width, middle + half_width);
        if self.slices() == 1 {
            return along;
        }
        let outwards = if end == 0 { -self.face.overlap() } else { self.face.overlap() };
        (along + middle + half_width.copysign(outwards)) / 2.0
    }

    /// Whether that differs from state to state.
    pub(super) fn has_strips(&self) -> bool {
        self.classes.iter().any(|class| !class.strips.is_empty())
    }

    /// Number of pairs that are looked at together.
    pub(crate) fn pairs_at_once(&self) -> usize {
        self.points().div_ceil(self.points_per_pitch).max(PAIRS)
    }

    /// Number of springs that are looked at together: slices of pairs.
    pub(crate) fn springs(&self) -> usize {
        self.pairs_at_once() * self.slices()
    }

    /// The laws of all corners: of each class, of each slice, at the start of the path and at its end; none of spur teeth. Classes of missing
    /// teeth have laws of no stiffness.
    pub(crate) fn corner_laws(&self) -> Vec<CornerLaw> {
        let of_class = |class: &PairTable| -> Vec<CornerLaw> {
            let none = vec![CornerLaw::NONE; 2 * self.slices()];
            let laws = class.corners.iter().flatten().map(|corner| corner.law);
            if class.corners.is_empty() { none } else { laws.collect() }
        };
        if self.has_corners() { self.classes.iter().flat_map(of_class).collect() } else { Vec::new() }
    }

    /// (m) By how much closer the flanks of a pair are at the end of the face at positive z than midway, by the slopes that turn with its wheels. Wheels
    /// whose tilt is no unknown yield to a part of it.
    pub(super) fn wobble_m(&self, pair: i64) -> f64 {
        let Some(wheels) = &self.wobble else { return 0.0 };
        let teeth: [usize; 2] = self.sequence.teeth(pair).into();
        let slope: f64 = wheels.iter().zip(teeth).map(|(wheel, tooth)| wheel.slope_of(tooth)).sum();
        let yields = if self.tilts() { 0.0 } else { self.along_face.tilt_product };
        slope * self.half_face_m / (1.0 + yields)
    }

    /// Whether the slope of its deflection along the face is a second unknown.
    pub(crate) fn tilts(&self) -> bool {
        self.closer_at_end_m.is_some()
    }

    /// (m) By how much closer that brings a slice of a mesh with one unknown; where the tilt is another, the law knows.
    pub(super) fn slice_closer_m(&self, slice: usize, wobble_m: f64) -> f64 {
        if self.tilts() { 0.0 } else { wobble_m * self.strip_of_slice(slice)[0] }
    }

    /// Whether a slope turns with its wheels.
    pub(crate) fn wobbles(&self) -> bool {
        self.wobble.is_some()
    }

    /// Whether each pair leans in its own way, and the law is to know it.
    pub(crate) fn leans_with_pairs(&self) -> bool {
        self.tilts() && (self.wobbles() || matches!(self.face, FaceForm::Helical { .. }))
    }

    /// Whether its flanks rub.
    pub(crate) fn has_friction(&self) -> bool {
        self.friction.is_some()
    }

    /// (-, m) Of each of [`Self::corner_laws`], friction across the line of action per force along it, and its moment about the pitch point.
    pub(crate) fn sliding_of_corner_laws(&self) -> Vec<[f64; 2]> {
        let Some(friction) = self.friction.filter(|_| self.has_corners()) else { return Vec::new() };
        let of_class = |class: &PairTable| -> Vec<[f64; 2]> {
            let none = vec![[0.0; 2]; 2 * self.slices()];
            let places = class.corners.iter().flatten().map(|corner| friction.at(corner.place));
            if class.corners.is_empty() { none } else { places.collect() }
        };
        self.classes.iter().flat_map(of_class).collect()
    }

    /// Points by which the flanks' tables begin before a pair's, and end after it: as many as the first slice is ahead of the middle.
    pub(super) fn flank_margin(&self) -> usize {
        match self.face {
            FaceForm::Spur | FaceForm::Helical { .. } => 0,
            FaceForm::Sliced { overlap, .. } => {
                (overlap.abs() / 2.0 * self.points_per_pitch as f64).ceil() as usize
            }
        }
    }

    /// (base pitches) Positions of the path at which the deviations of flanks are tabulated.
    pub(super) fn flank_positions(&self) -> impl Iterator<Item = f64> {
        let margin = self.flank_margin();
        let position = move |point: usize| {
            (point as f64 - (self.points_before + margin) as f64) / self.points_per_pitch as f64
        };
        (0..self.points() + 2 * margin).map(position)
    }

    /// The point of the flanks' tables that a slice is at when its pair is at the pair's first point.
    ///
    /// # Arguments
    /// * `slice` - its number
    pub(super) fn first_flank_point(&self, slice: usize) -> usize {
        let ahead = self.face.overlap() * self.face.window(slice).middle * self.points_per_pitch as f64;
        (self.flank_margin() as i64 + ahead.round() as i64).max(0) as usize
    }

    /// Whether its teeth have corners beside the springs of their path.
    pub(crate) fn has_corners(&self) -> bool {
        self.contact == Contact::Unilateral && self.along_path.is_some()
    }

    /// Where the flanks' deviations are read that a corner feels.
    ///
    /// # Arguments
    /// * `slice`, `end` - of which slice, and at which end of the path
    /// * `place` - (base pitches) where the end is
    pub(super) fn corner_reading(&self, slice: usize, end: usize, place: f64) -> CornerReading {
        let per_pitch = self.points_per_pitch as f64;
        let window = self.face.window(slice);
        let [ahead, half] = [window.middle * window.overlap, window.overlap.abs() * window.width / 2.0];
        let margin = self.flank_margin() as f64;
        let (at_end, last) = (
            place * per_pitch + self.points_before as f64 + margin,
            self.points() as f64 + 2.0 * margin - 1.0,
        );
        match end {
            0 => CornerReading { first: margin + (ahead + half) * per_pitch, outside: [0.0, at_end] },
            _ => CornerReading { first: margin + (ahead - half) * per_pitch, outside: [at_end, last] },
        }
    }

    /// Tables over the points of flanks as the springs of a whole face take them, and by how much more each deviates at the end of the face at positive z
    /// than midway.
    ///
    /// Of helical teeth alike along the face a deviation is the mean along what their contact lines have on the path; where the face tilts it is the straight
    /// line along the face with that mean and that first moment, read off midway. All others are read off where they are, and have no slopes.
    ///
    /// # Arguments
    /// * `tables` - a quantity of each tooth, at the mesh's points of flanks
    pub(super) fn along_face(&self, tables: &[Vec<f64>]) -> [Vec<Vec<f64>>; 2] {
        // Slices are so narrow that they are read off at their middle.
        let (FaceForm::Helical { overlap }, Some(along_path)) = (&self.face, &self.along_path) else {
            return [tables.to_vec(), Vec::new()];
        };
        let positions: Vec<f64> = self.flank_positions().collect();
        let window = self.face.window(0);
        let mean = |of: &dyn Fn(f64) -> f64| along_path.mean(&positions, window, of);
        let at = |table: &[f64], position: f64| {
            let place = (position - positions[0]) * self.points_per_pitch as f64;
            let place = place.clamp(0.0, (table.len() - 1) as f64);
            let (point, part) = (place as usize, place - place.floor());
            let next = table[(point + 1).min(table.len() - 1)];
            table[point] + part * (next - table[point])
        };
        if !self.tilts() {
            return [tables.iter().map(|table| mean(&|position| at(table, position))).collect(), Vec::new()];
        }
        let places = along_path.places(&positions, window);
        let lines = tables.iter().map(|table| {
            let means = mean(&|position| at(table, position));
            let moments = mean(&|position| at(table, position) * position);
            let line = |n: usize| {
                let [place, spread] = places[n];
                let covariance = moments[n] - means[n] * place;
                // Of hardly anything on the path rounding would be the slope.
                let per_pitch = if spread > LEAST_SPREAD { covariance / spread } else { 0.0 };
                (means[n] - (place - positions[n]) * per_pitch, per_pitch * overlap / 2.0)
            };
            (0..positions.len()).map(line).unzip()
        });
        <[Vec<Vec<f64>>; 2]>::from(lines.unzip())
    }

    /// Number of points of a pair.
    pub fn points(&self) -> usize {
        self.classes[0].states.len() / self.slices()
    }

    /// (base pitches) Position of a point of a pair since the start of its path.
    ///
    /// # Arguments
    /// * `point` - from 0
    pub fn position(&self, point: usize) -> f64 {
        (point as f64 - self.points_before as f64) / self.points_per_pitch as f64
    }

    /// The mesh as if it were closed always, with its mean stiffness.
    pub(crate) fn closed(&self) -> ClosedMesh {
        ClosedMesh { stiffness_n_per_m: self.mean_stiffness_n_per_m, damping_time_s: self.damping_time_s }
    }

    /// (m) What the tilt of the wheels under the nominal load adds to the deflection at the end of the face at positive z.
    pub(super) fn tilt_at_rest_m(&self) -> f64 {
        self.along_face.tilt_m / 2.0
    }

    /// (m) Of a mesh that has the slope of its deflection along the face as a second unknown: the width of its face, and by how much more its flanks
    /// close at the end at positive z than at the other one, while its wheels do not tilt.
    pub fn two_unknowns(&self) -> Option<[f64; 2]> {
        self.closer_at_end_m.map(|closer_m| [2.0 * self.half_face_m, 2.0 * closer_m])
    }

    /// Its law.
    pub fn law(&self) -> MeshLaw {
        MeshLaw {
            contact: self.contact,
            damping_time_s: self.damping_time_s,
            back_stiffness_n_per_m: self.closed_stiffness_n_per_m,
            backlash_m: self.backlash_m,
        }
    }

    /// (N/m) Sum of the stiffnesses of the pairs that touch at a point, counted from the start of the simulation: under a light load, and
    /// where the face has slices under the nominal one.
    pub(crate) fn whole_stiffness_at(&self, point: usize) -> f64 {
        let pairs = self
            .pairs_at(point)
            .map(|(pair, number, state)| (self.strip(self.sequence.class(pair), number), *state));
        self.touching_n_per_m(&pairs.collect::<Vec<_>>())
    }

    /// (N/mm) Sum of the stiffnesses of the pairs that touch, at every point of some pitches: under a light load, and where the face has slices
    /// under the nominal one.
    ///
    /// # Arguments
    /// * `pitches` - counted from the start of the simulation
    pub fn stiffness_n_per_mm(&self, pitches: Range<usize>) -> Vec<f64> {
        let points = pitches.start * self.points_per_pitch..pitches.end * self.points_per_pitch;
        points.map(|point| self.whole_stiffness_at(point) * 1e-3).collect()
    }

    /// (N/mm) The same of sound teeth, over one pitch.
    pub fn healthy_stiffness_n_per_mm(&self) -> Vec<f64> {
        let first = |since: usize| (since + self.points_before) % self.points_per_pitch;
        (0..self.points_per_pitch).map(|since| self.sound_n_per_m(first(since)) * 1e-3).collect()
    }

    /// (N/m) Its mean.
    fn mean_of_sound_n_per_m(&self) -> f64 {
        let points = 0..self.points_per_pitch;
        points.map(|first| self.sound_n_per_m(first)).sum::<f64>() / self.points_per_pitch as f64
    }

    /// (N/m) The same where the tables' point of the newest pair is one of the first pitch.
    fn sound_n_per_m(&self, first: usize) -> f64 {
        let points = (first..self.points()).step_by(self.points_per_pitch);
        let numbers = (0..self.slices()).flat_map(|slice| points.clone().map(move |point| (slice, point)));
        let numbers = numbers.map(|(slice, point)| slice * self.points() + point);
        let state = |number: usize| (self.strip(0, number), self.classes[0].states[number]);
        self.touching_n_per_m(&numbers.map(state).collect::<Vec<_>>())
    }

    /// Whether it is of spur teeth of which some have lost a part of their faces: its load would tilt the wheels, at hardly any cost.
    pub(crate) fn loses_a_part(&self) -> bool {
        self.face == FaceForm::Spur && self.classes.iter().any(PairTable::loses_a_part)
    }

    /// Makes the slope of its deflection along the face a second unknown.
    ///
    /// # Arguments
    /// * `closer_m` - (m) by how much more its flanks close at the end of the face at positive z than at the other one, while its wheels do not tilt
    pub(crate) fn tilt(&mut self, closer_m: f64) {
        self.closer_at_end_m = Some(closer_m / 2.0);
        if self.slices() > 1 {
            return;
        }
        let half_face_m = self.half_face_m;
        for class in &mut self.classes {
            if class.loses_a_part() {
                let places = class.states.iter().map(|state| state.face_centre_m / half_face_m);
                class.strips = places.map(|place| [place, 1.0 - place.abs()]).collect();
            }
        }
    }

    /// Takes how it bears along its face at rest under the nominal load. The mean stiffness of a mesh with two unknowns whose flanks close by more at
    /// one end of the face is that of what bears then.
    ///
    /// # Arguments
    /// * `load` - how it bears
    pub(crate) fn bear(&mut self, load: LoadAlongFace) {
        self.along_face = load;
        if self.closer_at_end_m.is_some_and(|closer_m| closer_m != 0.0) {
            let mean_n_per_m = self.mean_of_sound_n_per_m();
            let part = mean_n_per_m / self.mean_stiffness_n_per_m;
            self.mean_stiffness_n_per_m = mean_n_per_m;
            self.nominal_deflection_m /= part;
            self.damping_time_s /= part.sqrt();
        }
    }

    /// (N/m) Stiffness of the pairs that carry a light load: those that are hardly farther apart than the nearest, or all where they
    /// may pull. Of slices, and of flanks that close by more at one end of the face, what the nominal load brings together.
    ///
    /// # Arguments
    /// * `states` - with the strip of each
    fn touching_n_per_m(&self, states: &[([f64; 2], PairState)]) -> f64 {
        if let Some(closer_m) = self.closer_at_end_m.filter(|closer_m| *closer_m != 0.0) {
            let numbers = states.iter().map(|(_, state)| (state.stiffness_n_per_m, -state.separation_m));
            let (stiffness, offset): (Vec<f64>, Vec<f64>) = numbers.unzip();
            let strips: Vec<[f64; 2]> = states.iter().map(|(strip, _)| *strip).collect();
            let springs =
                Springs { strips: &strips, closer_m, ..Springs::frictionless(&stiffness, &offset, &[], &[]) };
            let force_n = self.nominal_deflection_m * self.mean_stiffness_n_per_m;
            let at_rest_m = self.law().tilted_at_rest(springs, self.tilt_at_rest_m(), force_n);
            return self.law().tilted(springs, [at_rest_m, self.tilt_at_rest_m()]).slopes[0];
        }
        let states = || states.iter().map(|(_, state)| state);
        let pairs = || states().filter(|state| state.stiffness_n_per_m > 0.0);
        let farthest_m = match self.contact {
            Contact::Unilateral if self.slices() == 1 || self.nominal_deflection_m <= 0.0 => {
                nearest_m(pairs()) + TOUCHING_M
            }
            Contact::Unilateral => {
                let force_n = self.nominal_deflection_m * self.mean_stiffness_n_per_m;
                deflection_of_springs(self.contact, states(), force_n)
            }
            Contact::Bilateral => f64::INFINITY,
        };
        let touching = pairs().filter(|state| state.separation_m < farthest_m);
        // A sum of no numbers is −0.
        touching.fold(0.0, |sum, state| sum + state.stiffness_n_per_m)
    }
}

/// (m) Deflection at which pairs without deviations carry a force at rest, of which all that can touch are springs of the time loop.
///
/// # Arguments
/// * `contact` - how they touch
/// * `states` - the pairs, without corners of their own
/// * `force_n` - (N) the force, 0 or more
fn deflection_of_springs<'a>(
    contact: Contact,
    states: impl Iterator<Item = &'a PairState>,
    force_n: f64,
) -> f64 {
    let can_touch = |state: &&PairState| state.stiffness_n_per_m > 0.0;
    let (stiffness, offset): (Vec<f64>, Vec<f64>) =
        states.filter(can_touch).map(|state| (state.stiffness_n_per_m, -state.separation_m)).unzip();
    let springs = Springs::frictionless(&stiffness, &offset, &[], &[]);
    deflection_at_rest(contact, springs, force_n)
}

/// (m) Least separation of some pairs.
fn nearest_m<'a>(states: impl Iterator<Item = &'a PairState>) -> f64 {
    states.map(|state| state.separation_m).fold(f64::INFINITY, f64::min)
}

/// (base pitches squared) Variance of the places that a contact line has on the path, below which a deviation has no slope along it.
const LEAST_SPREAD: f64 = 1e-8;

/// (m) How much farther apart than the nearest a pair is counted as touching in the mesh's stiffness.
const TOUCHING_M: f64 = 1e-9;
