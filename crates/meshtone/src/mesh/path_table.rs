//! Pairs of teeth from before their path of contact to beyond it: how stiff they are, and how far their flanks are apart.

use std::array::from_fn;

use super::bridging::bridged;
use super::corner::{Corner, CornerReach};
use super::law::{Contact, CornerLaw};
use super::pair::Pairs;
use super::sequence::PairKind;
use super::window::{Integral, Window};
use crate::damage::DamagedTooth;
use crate::wheel::{FlankRelief, WheelName};

/// A pair at one position, outside its path too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairState {
    /// (N/m) Stiffness along the line of action if it touches; 0 where it cannot.
    pub stiffness_n_per_m: f64,
    /// (m) How far the unloaded flanks are apart, S.
    pub separation_m: f64,
    /// (m) Where along the face the load acts, from its middle.
    pub face_centre_m: f64,
}

impl PairState {
    pub(super) const APART: Self = Self { stiffness_n_per_m: 0.0, separation_m: 0.0, face_centre_m: 0.0 };
}

/// What shapes the tips and flanks of a wheel's teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TipShape {
    /// (mm) Height of the chamfer.
    pub(crate) chamfer_mm: f64,
    /// (base pitches) By how much the path is shorter than that between the chamfers, half of it at this wheel's tips.
    pub(crate) active_profile_shortening: f64,
    /// Relief of the flank near the tip.
    pub(crate) relief: FlankRelief,
}

/// One tooth of a pair, as its mate meets it.
struct Tooth {
    /// (mm) Radius of the corner of what is left of its tip.
    tip_radius_mm: f64,
    /// (mm) Radius of curvature of the flank there.
    tip_curvature_mm: f64,
}

/// Where the pairs of a class leave their path, at its start and at its end.
struct Ends {
    /// (base pitches) Since the start of the path of whole teeth.
    places: [f64; 2],
    /// Of the gear's tip, and of the pinion's.
    corners: [Corner; 2],
}

/// Tabulates the pairs of a mesh.
pub(crate) struct PairTables<'a> {
    pairs: &'a Pairs<'a>,
    /// Of the pinion and of the gear.
    shapes: [TipShape; 2],
    contact: Contact,
    /// (-) Cosine of the base helix angle: of what is lost across the teeth in the transverse section.
    base_cos: f64,
}

/// Positions in a base pitch at which helical pairs are tabulated before they are averaged along their contact lines.
const PER_PITCH: f64 = 256.0;

impl<'a> PairTables<'a> {
    /// The tables of some pairs.
    ///
    /// # Arguments
    /// * `pairs` - the tooth pairs
    /// * `shapes` - of the pinion's and of the gear's tips
    /// * `contact` - how the flanks touch: those that push leave their path with the corner of a tip, those that may pull at once
    pub(crate) fn new(pairs: &'a Pairs<'a>, shapes: [TipShape; 2], contact: Contact) -> Self {
        Self { pairs, shapes, contact, base_cos: pairs.teeth().pinion.base_helix_angle_rad().cos() }
    }

    fn tooth(&self, wheel: WheelName, damage: Option<&DamagedTooth>) -> Tooth {
        let teeth = self.pairs.teeth();
        let (own, profile) = (teeth.wheel(wheel), teeth.profile(wheel));
        let shape = &self.shapes[wheel as usize];
        let chamfered = own.tip_radius_mm - own.sign() * shape.chamfer_mm;
        let left = damage.map(|damage| damage.gone_from_index).filter(|&index| index < profile.len());
        let broken_mm = left.map_or(f64::INFINITY, |index| {
            let curvature_mm = teeth.flank(wheel).curvature_mm(index.saturating_sub(1));
            teeth.transverse_curvature_mm(wheel, curvature_mm)
        });
        let shortening = shape.active_profile_shortening;
        let active = own.curvature_mm(chamfered) - shortening / 2.0 * teeth.path.base_pitch_mm;
        // What is left of a ring's tooth ends at its root, and another one's flank on the base circle.
        let least_mm = if own.is_internal { own.curvature_mm(own.root_radius_mm) } else { 0.0 };
        let tip_curvature_mm = active.min(broken_mm).max(least_mm);
        Tooth { tip_radius_mm: tip_curvature_mm.hypot(own.base_radius_mm), tip_curvature_mm }
    }

    /// (base pitches) Where the path of two sound teeth begins and ends, between their chamfers; since the start of the path of
    /// whole teeth.
    pub(crate) fn path_of_sound_teeth(&self) -> [f64; 2] {
        let path = &self.pairs.teeth().path;
        let [begins, ends] = [WheelName::Gear, WheelName::Pinion]
            .map(|wheel| path.position(wheel, self.tooth(wheel, None).tip_curvature_mm));
        if self.pairs.ring_drives() { [ends, begins].map(|end| path.from_end(end)) } else { [begins, ends] }
    }

    /// Where the pairs of a class leave their path; none where a tooth is missing.
    fn ends_of(&self, kind: &PairKind) -> Option<Ends> {
        let damages = WheelName::BOTH.map(|wheel| self.pairs.damage_of(kind, wheel));
        if damages.iter().flatten().any(|damage| damage.is_missing()) {
            return None;
        }
        let teeth = self.pairs.teeth();
        let path = &teeth.path;
        // The gear's tip begins, the pinion's ends the path.
        let [begins, ends] = [WheelName::Gear, WheelName::Pinion].map(|wheel| {
            let tooth = self.tooth(wheel, damages[wheel as usize]);
            let (own, mate) = (teeth.wheel(wheel), teeth.wheel(wheel.mate()));
            let corner = Corner::new(own, mate, path.line_mm, tooth.tip_radius_mm);
            (path.position(wheel, tooth.tip_curvature_mm), corner)
        });
        Some(Ends { places: [begins.0, ends.0], corners: [begins.1, ends.1] })
    }

    /// A class of pairs at uniform positions. Where a ring drives they go through the path from its other end.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `positions` - (base pitches) since the start of the path of whole teeth, rising
    /// * `step` - (base pitches) between two of them
    pub(crate) fn tabulate(&self, kind: &PairKind, positions: &[f64], step: f64) -> Vec<PairState> {
        if !self.pairs.ring_drives() {
            return self.tabulate_from_tip_of_gear(kind, positions, step);
        }
        let path = &self.pairs.teeth().path;
        let from_end: Vec<f64> = positions.iter().rev().map(|position| path.from_end(*position)).collect();
        let mut states = self.tabulate_from_tip_of_gear(kind, &from_end, step);
        states.reverse();
        states
    }

    /// A class of pairs at uniform positions, counted from where the tip of the driven wheel's tooth touches.
    ///
    /// On its path a pair touches with its flanks, apart by what damage and relief take from them. Outside of it the corner of a tip
    /// touches the mate's flank, at the stiffness of the path's end and a growing distance.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `positions` - (base pitches) since the start of the path of whole teeth, rising
    /// * `step` - (base pitches) between two of them
    fn tabulate_from_tip_of_gear(&self, kind: &PairKind, positions: &[f64], step: f64) -> Vec<PairState> {
        let Some(Ends { places: [begins, ends], corners: [gear_corner, pinion_corner] }) = self.ends_of(kind)
        else {
            return vec![PairState::APART; positions.len()];
        };
        // Where flanks touch, at the positions inside the path, and at the ends outside of it.
        let on_path: Vec<f64> =
            positions.iter().map(|position| position.max(begins.min(ends)).min(ends.max(begins))).collect();
        let base_pitch_mm = self.pairs.teeth().path.base_pitch_mm;
        let at_end = |(mut state, position): (PairState, &f64)| {
            match self.contact {
                Contact::Unilateral => {
                    let before_mm = (begins - position) * base_pitch_mm;
                    let beyond_mm = (position - ends) * base_pitch_mm;
                    state.separation_m += 1e-3
                        * (gear_corner.separation_mm(before_mm) + pinion_corner.separation_mm(beyond_mm));
                }
                Contact::Bilateral => {
                    state.stiffness_n_per_m *= share_on_path(*position, step, [begins, ends]);
                }
            }
            state
        };
        self.flanks_at(kind, &on_path).into_iter().zip(positions).map(at_end).collect()
    }

    /// A class of pairs whose flanks touch at some positions, none of them outside the path.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `on_path` - (base pitches) positions, rising
    fn flanks_at(&self, kind: &PairKind, on_path: &[f64]) -> Vec<PairState> {
        let path = &self.pairs.teeth().path;
        let [of_pinion, of_gear] =
            WheelName::BOTH.map(|wheel| self.gaps(wheel, self.pairs.damage_of(kind, wheel), on_path));
        (0..on_path.len())
            .map(|n| {
                // At the edge of a hollow the load acts at the edge.
                let hollow = if of_gear[n].0 > of_pinion[n].0 { of_gear[n].1 } else { of_pinion[n].1 };
                let touched = on_path[hollow];
                let curvature = WheelName::BOTH.map(|wheel| path.curvature_mm(wheel, touched));
                let state = self.pairs.loaded_at(kind, curvature);
                PairState {
                    stiffness_n_per_m: state.stiffness_n_per_mm * 1e3,
                    separation_m: (of_pinion[n].0 + of_gear[n].0) * 1e-3,
                    face_centre_m: state.face_centre_m,
                }
            })
            .collect()
    }

    /// A class of pairs of helical teeth along its path, of which each contact line has a stretch; none where a tooth is missing.
    ///
    /// # Arguments
    /// * `kind` - the class
    pub(crate) fn along_path(&self, kind: &PairKind) -> Option<AlongPath> {
        let Ends { places: [begins, ends], corners } = self.ends_of(kind)?;
        let base_pitch_mm = self.pairs.teeth().path.base_pitch_mm;
        // Where broken tips leave no path, both corners touch at one place, or nearly.
        let middle = (begins + ends) / 2.0;
        let places = if begins < ends { [begins, ends] } else { [middle; 2] };
        let before_mm = [places[0] - begins, ends - places[1]].map(|inside| -inside * base_pitch_mm);
        let apart_mm: f64 =
            corners.iter().zip(before_mm).map(|(corner, before)| corner.separation_mm(before)).sum();
        let intervals = ((places[1] - places[0]) * PER_PITCH).ceil().max(1.0);
        let step = (places[1] - places[0]) / intervals;
        let positions: Vec<f64> = (0..=intervals as usize).map(|n| places[0] + n as f64 * step).collect();
        let mut states = self.flanks_at(kind, &positions);
        states.iter_mut().for_each(|state| state.separation_m += apart_mm * 1e-3);
        let integral = |of: &dyn Fn(&PairState) -> f64| {
            Integral::new(places, &states.iter().map(of).collect::<Vec<_>>())
        };
        let at_ends = [states[0], states[states.len() - 1]];
        Some(AlongPath {
            stiffness: integral(&|state| state.stiffness_n_per_m),
            separation: integral(&|state| state.stiffness_n_per_m * state.separation_m),
            stiffness_n_per_m: states.iter().map(|state| state.stiffness_n_per_m).collect(),
            places,
            corners: from_fn(|end| (CornerReach::new(&corners[end], base_pitch_mm), at_ends[end])),
        })
    }

    /// (mm) How far one flank's damage and relief keep the mate off at each position, and the number of the position whose
    /// point it touches instead.
    fn gaps(&self, wheel: WheelName, damage: Option<&DamagedTooth>, on_path: &[f64]) -> Vec<(f64, usize)> {
        let teeth = self.pairs.teeth();
        let (own, flank, path) = (teeth.wheel(wheel), teeth.flank(wheel), &teeth.path);
        let curvature: Vec<f64> =
            on_path.iter().map(|&position| path.curvature_mm(wheel, position)).collect();
        let relief = |n: usize| self.shapes[wheel as usize].relief.gap_mm(own, curvature[n]);
        let Some(damage) = damage else {
            return (0..on_path.len()).map(|n| (relief(n), n)).collect();
        };
        let lost: Vec<f64> = flank
            .profile
            .y_mm
            .iter()
            .zip(&damage.flank_y_mm)
            .map(|(sound, left)| (sound - left).max(0.0))
            .collect();
        let depth: Vec<f64> = curvature
            .iter()
            .enumerate()
            .map(|(n, &curvature)| {
                let point = flank.at_curvature(teeth.section_curvature_mm(wheel, curvature));
                point.of(&lost) * point.load_cos / self.base_cos + relief(n)
            })
            .collect();
        // Arc length of an involute.
        let along: Vec<f64> = curvature.iter().map(|rho| rho * rho / (2.0 * own.base_radius_mm)).collect();
        let relative: Vec<f64> =
            curvature.iter().map(|rho| rho * (path.line_mm - rho) / path.line_mm).collect();
        bridged(&depth, &along, &relative)
    }
}

/// A class of pairs of helical teeth along its path of contact.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AlongPath {
    /// Of the stiffness.
    stiffness: Integral,
    /// Of the separation, weighted by the stiffness.
    separation: Integral,
    /// (N/m) Stiffness at equal distances from one end to the other.
    stiffness_n_per_m: Vec<f64>,
    /// (base pitches) Where it begins and ends.
    places: [f64; 2],
    /// The corners there, each with the pair that touches there.
    corners: [(CornerReach, PairState); 2],
}

impl AlongPath {
    /// The pairs at positions of the middle of the face: what a slice's contact line has on the path.
    ///
    /// A spring that stands for it has the stiffness of all its places together and their mean separation, weighted by stiffness. While
    /// all of them touch that is exact.
    ///
    /// # Arguments
    /// * `positions` - (base pitches) since the start of the path of whole teeth
    /// * `window` - the slice
    pub(super) fn over_face(&self, positions: &[f64], window: Window) -> Vec<PairState> {
        let state = |&position: &f64| {
            let stretch = window.around(position);
            let whole = self.stiffness.between(stretch);
            if whole <= 0.0 {
                return PairState::APART;
            }
            PairState {
                stiffness_n_per_m: whole / (stretch[1] - stretch[0]),
                separation_m: self.separation.between(stretch) / whole,
                face_centre_m: 0.0,
            }
        };
        positions.iter().map(state).collect()
    }

    /// Where what contact lines of the whole face have on the path lies along it, from −1 to 1: its middle and half of its width, those of an even
    /// strip with the same stiffness, centroid and moment of inertia.
    ///
    /// # Arguments
    /// * `positions`, `window` - as of [`Self::over_face`]
    pub(super) fn strips(&self, positions: &[f64], window: Window) -> Vec<[f64; 2]> {
        let strip = |(position, [mean, spread]): (&f64, [f64; 2])| {
            let half_width = (3.0 * spread).max(0.0).sqrt();
            [2.0 * (mean - position) / window.overlap, 2.0 * half_width / window.overlap.abs()]
        };
        positions.iter().zip(self.places(positions, window)).map(strip).collect()
    }

    /// (base pitches, and squared) Mean and variance of the places that contact lines have on the path, weighted by stiffness.
    ///
    /// # Arguments
    /// * `positions`, `window` - as of [`Self::over_face`]
    pub(super) fn places(&self, positions: &[f64], window: Window) -> Vec<[f64; 2]> {
        let means = self.mean(positions, window, |position| position);
        let squares = self.mean(positions, window, |position| position * position);
        means.into_iter().zip(squares).map(|(mean, square)| [mean, square - mean * mean]).collect()
    }

    /// What the same contact lines have outside the path: that before its start, and that beyond its end.
    ///
    /// # Arguments
    /// * `positions`, `window` - as of [`Self::over_face`]
    pub(super) fn corners(&self, positions: &[f64], window: Window) -> [CornerTable; 2] {
        let stretches: Vec<[f64; 2]> = positions.iter().map(|position| window.around(*position)).collect();
        let of_end = |end: usize| {
            let (reach, state) = self.corners[end];
            let outside = |[from, until]: [f64; 2]| match end {
                0 => [self.places[0] - until, self.places[0] - from],
                _ => [from - self.places[1], until - self.places[1]],
            };
            let edges =
                |edge: usize| stretches.iter().map(|stretch| outside(*stretch)[edge].max(0.0)).collect();
            CornerTable {
                law: CornerLaw {
                    stiffness_n_per_m: state.stiffness_n_per_m / (window.overlap.abs() * window.width),
                    coefficients: reach.coefficients,
                },
                reach,
                separation_m: state.separation_m,
                place: self.places[end],
                near: edges(0),
                far: edges(1),
            }
        };
        from_fn(of_end)
    }

    /// The mean of a quantity over what contact lines have on the path, weighted by stiffness: as long as that touches, its deviation is
    /// this mean. At the nearer end of lines that have nothing on it.
    ///
    /// # Arguments
    /// * `positions`, `window` - as of [`Self::over_face`]
    /// * `of` - the quantity at a position
    pub(super) fn mean(&self, positions: &[f64], window: Window, of: impl Fn(f64) -> f64) -> Vec<f64> {
        let [begins, ends] = self.places;
        let intervals = self.stiffness_n_per_m.len().saturating_sub(1).max(1) as f64;
        let at = |n: usize| begins + n as f64 / intervals * (ends - begins);
        let weighted: Vec<f64> =
            self.stiffness_n_per_m.iter().enumerate().map(|(n, stiffness)| stiffness * of(at(n))).collect();
        let weighted = Integral::new(self.places, &weighted);
        let mean = |&position: &f64| {
            let stretch = window.around(position);
            let whole = self.stiffness.between(stretch);
            if whole > 0.0 { weighted.between(stretch) / whole } else { of(position.clamp(begins, ends)) }
        };
        positions.iter().map(mean).collect()
    }
}

/// What the contact lines of a slice have outside the path at one of its ends, point by point.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct CornerTable {
    /// The corner's law.
    pub law: CornerLaw,
    /// How far the corner touches beyond the path.
    pub reach: CornerReach,
    /// (m) How far the flanks are apart at the end of the path.
    pub separation_m: f64,
    /// (base pitches) Where the end is.
    pub place: f64,
    /// (base pitches) How far outside the path the edge of the stretch is that is nearer to it; 0 of one that reaches onto it.
    pub near: Vec<f64>,
    /// (base pitches) The same of the other edge; 0 of one that is on the path.
    pub far: Vec<f64>,
}

impl CornerTable {
    /// (√m) The v at which the corner reaches near and far edge at a point, with the damping's lead.
    ///
    /// What penetrates with the lead ℓ, in base pitches, is `D − S ∓ ℓ S'`: a pair that leaves its path parts from its mate, one that enters
    /// it approaches. As S begins as s², that is `D + S(ℓ) − S(s ± ℓ)`: the corner's law, deeper by S(ℓ), over a stretch that is
    /// shifted by the lead, of a pair that enters to the other side of the corner where S is the same.
    ///
    /// # Arguments
    /// * `end` - 0 at the start of the path, 1 at its end
    /// * `lead` - (base pitches) ℓ
    pub(super) fn roots(&self, end: usize, lead: f64) -> [Vec<f64>; 2] {
        let shift = if end == 0 { -lead } else { lead };
        // Most edges are on the path, where all are 0.
        let on_path = self.reach.signed_root_at(shift);
        let root = |edge: &f64| match *edge == 0.0 {
            true => on_path,
            false => self.reach.signed_root_at(edge + shift),
        };
        let shifted = |edges: &[f64]| edges.iter().map(root).collect();
        [shifted(&self.near), shifted(&self.far)]
    }

    /// (m) S(ℓ), by which a lead makes the penetration deeper.
    ///
    /// # Arguments
    /// * `lead` - (base pitches) ℓ
    pub(super) fn deeper_m(&self, lead: f64) -> f64 {
        self.reach.root_at(lead).powi(2)
    }
}

/// (-) Part of the interval around a position, half a step to either side, that lies on a path: so a pair whose stiffness ends with its
/// path is in contact as long as the path is.
pub(super) fn share_on_path(position: f64, step: f64, [begins, ends]: [f64; 2]) -> f64 {
    let on_path = (position + step / 2.0).min(ends) - (position - step / 2.0).max(begins);
    (on_path / step).clamp(0.0, 1.0)
}
