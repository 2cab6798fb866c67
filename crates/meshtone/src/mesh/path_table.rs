//! Pairs of teeth from before their path of contact to beyond it: how stiff they are, and how far their flanks are apart.

use super::bridging::bridged;
use super::corner::Corner;
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
    const APART: Self = Self { stiffness_n_per_m: 0.0, separation_m: 0.0, face_centre_m: 0.0 };
}

/// What shapes the tips and flanks of all teeth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TipShape {
    /// (mm) Height of the chamfer.
    pub(crate) chamfer_mm: f64,
    /// (base pitches) By how much the path is shorter than that between the chamfers.
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

/// How a pair leaves its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PathEnds {
    /// With the corner of a tip, as spur wheels that push do.
    Corners,
    /// At once: flanks that may pull, and each place of helical teeth's contact line, of which only the last one has the corner.
    Sharp,
}

/// Tabulates the pairs of a mesh.
pub(crate) struct PairTables<'a> {
    pairs: &'a Pairs<'a>,
    shape: TipShape,
    ends: PathEnds,
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
    /// * `shape` - of all tips
    /// * `ends` - how a pair leaves its path
    pub(crate) fn new(pairs: &'a Pairs<'a>, shape: TipShape, ends: PathEnds) -> Self {
        Self { pairs, shape, ends, base_cos: pairs.teeth().pinion.base_helix_angle_rad().cos() }
    }

    fn tooth(&self, wheel: WheelName, damage: Option<&DamagedTooth>) -> Tooth {
        let teeth = self.pairs.teeth();
        let (own, profile) = (teeth.wheel(wheel), teeth.profile(wheel));
        let chamfered = own.tip_radius_mm - self.shape.chamfer_mm;
        let left = damage.map(|damage| damage.gone_from_index).filter(|&index| index < profile.len());
        let broken_mm = left.map_or(f64::INFINITY, |index| {
            let curvature_mm = teeth.flank(wheel).curvature_mm(index.saturating_sub(1));
            teeth.transverse_curvature_mm(wheel, curvature_mm)
        });
        let shortening = self.shape.active_profile_shortening;
        let active = own.curvature_mm(chamfered) - shortening / 2.0 * teeth.path.base_pitch_mm;
        let tip_curvature_mm = active.min(broken_mm).max(0.0);
        Tooth { tip_radius_mm: tip_curvature_mm.hypot(own.base_radius_mm), tip_curvature_mm }
    }

    /// (base pitches) Where the path of two sound teeth begins and ends, between their chamfers; since the start of the path of
    /// whole teeth.
    pub(crate) fn path_of_sound_teeth(&self) -> [f64; 2] {
        let path = &self.pairs.teeth().path;
        [WheelName::Gear, WheelName::Pinion]
            .map(|wheel| path.position(wheel, self.tooth(wheel, None).tip_curvature_mm))
    }

    /// A class of pairs at uniform positions.
    ///
    /// On its path a pair touches with its flanks, apart by what damage and relief take from them. Outside of it the corner of a tip
    /// touches the mate's flank, at the stiffness of the path's end and a growing distance.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `positions` - (base pitches) since the start of the path of whole teeth, rising
    /// * `step` - (base pitches) between two of them
    pub(crate) fn tabulate(&self, kind: &PairKind, positions: &[f64], step: f64) -> Vec<PairState> {
        let damages = WheelName::BOTH.map(|wheel| self.pairs.damage_of(kind, wheel));
        if damages.iter().flatten().any(|damage| damage.is_missing()) {
            return vec![PairState::APART; positions.len()];
        }
        let teeth = self.pairs.teeth();
        let path = &teeth.path;
        let [pinion, gear] = WheelName::BOTH.map(|wheel| self.tooth(wheel, damages[wheel as usize]));
        // The gear's tip begins, the pinion's ends the path.
        let begins = path.position(WheelName::Gear, gear.tip_curvature_mm);
        let ends = path.position(WheelName::Pinion, pinion.tip_curvature_mm);
        let [gear_corner, pinion_corner] =
            [(WheelName::Gear, &gear), (WheelName::Pinion, &pinion)].map(|(wheel, tooth)| {
                Corner::new(teeth.wheel(wheel), teeth.wheel(wheel.mate()), path.line_mm, tooth.tip_radius_mm)
            });
        // Where flanks touch, at the positions inside the path, and at the ends outside of it.
        let on_path: Vec<f64> =
            positions.iter().map(|position| position.max(begins.min(ends)).min(ends.max(begins))).collect();
        let [of_pinion, of_gear] =
            WheelName::BOTH.map(|wheel| self.gaps(wheel, damages[wheel as usize], &on_path));
        (0..positions.len())
            .map(|n| {
                let (corner, share) = match self.ends {
                    PathEnds::Corners => {
                        let before_mm = (begins - positions[n]) * path.base_pitch_mm;
                        let beyond_mm = (positions[n] - ends) * path.base_pitch_mm;
                        let corners =
                            gear_corner.separation_mm(before_mm) + pinion_corner.separation_mm(beyond_mm);
                        (corners, 1.0)
                    }
                    PathEnds::Sharp => (0.0, share_on_path(positions[n], step, [begins, ends])),
                };
                let separation = corner + of_pinion[n].0 + of_gear[n].0;
                // At the edge of a hollow the load acts at the edge.
                let hollow = if of_gear[n].0 > of_pinion[n].0 { of_gear[n].1 } else { of_pinion[n].1 };
                let touched = on_path[hollow];
                let curvature = WheelName::BOTH.map(|wheel| path.curvature_mm(wheel, touched));
                let state = self.pairs.loaded_at(kind, curvature);
                PairState {
                    stiffness_n_per_m: share * state.stiffness_n_per_mm * 1e3,
                    separation_m: separation * 1e-3,
                    face_centre_m: state.face_centre_m,
                }
            })
            .collect()
    }

    /// A class of pairs of helical teeth along its path, to be averaged over contact lines.
    ///
    /// # Arguments
    /// * `kind` - the class
    pub(crate) fn along_path(&self, kind: &PairKind) -> AlongPath {
        let step = 1.0 / PER_PITCH;
        let points = (self.pairs.teeth().path.contact_ratio * PER_PITCH).ceil() as i64 + 2;
        let path: Vec<f64> = (-2..points).map(|point| point as f64 * step).collect();
        let states = self.tabulate(kind, &path, step);
        let integral = |of: &dyn Fn(&PairState, f64) -> f64| {
            let weighted =
                states.iter().zip(&path).map(|(state, at)| state.stiffness_n_per_m * of(state, *at));
            Integral::new(path[0], step, weighted)
        };
        AlongPath {
            stiffness: integral(&|_, _| 1.0),
            separation: integral(&|state, _| state.separation_m),
            place: integral(&|_, at| at),
        }
    }

    /// (mm) How far one flank's damage and relief keep the mate off at each position, and the number of the position whose
    /// point it touches instead.
    fn gaps(&self, wheel: WheelName, damage: Option<&DamagedTooth>, on_path: &[f64]) -> Vec<(f64, usize)> {
        let teeth = self.pairs.teeth();
        let (own, flank, path) = (teeth.wheel(wheel), teeth.flank(wheel), &teeth.path);
        let curvature: Vec<f64> =
            on_path.iter().map(|&position| path.curvature_mm(wheel, position)).collect();
        let relief = |n: usize| self.shape.relief.gap_mm(own, curvature[n]);
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

/// Integrals along the path of contact of a class of pairs, each weighted by the pair's stiffness.
pub(crate) struct AlongPath {
    stiffness: Integral,
    separation: Integral,
    place: Integral,
}

impl AlongPath {
    /// The pairs at positions of the middle of the face: means along a slice's contact line.
    ///
    /// A spring that stands for a slice has the stiffness of all its places together and their mean separation, weighted by stiffness, and
    /// acts where their stiffnesses have their centre. While all of them touch that is exact.
    ///
    /// # Arguments
    /// * `positions` - (base pitches) since the start of the path of whole teeth
    /// * `window` - the slice
    /// * `face_width_m` - (m) of the whole face
    pub(crate) fn over_face(&self, positions: &[f64], window: Window, face_width_m: f64) -> Vec<PairState> {
        let state = |&position: &f64| {
            let [from, until] = window.around(position);
            let whole = self.stiffness.between(from, until);
            if whole <= 0.0 {
                return PairState::APART;
            }
            let beyond_middle = self.place.between(from, until) / whole - (from + until) / 2.0;
            PairState {
                stiffness_n_per_m: whole / (until - from),
                separation_m: self.separation.between(from, until) / whole,
                face_centre_m: beyond_middle / window.overlap * face_width_m,
            }
        };
        positions.iter().map(state).collect()
    }
}

/// (-) Part of the interval around a position, half a step to either side, that lies on a path: so a pair whose stiffness ends with its
/// path is in contact as long as the path is.
pub(super) fn share_on_path(position: f64, step: f64, [begins, ends]: [f64; 2]) -> f64 {
    let on_path = (position + step / 2.0).min(ends) - (position - step / 2.0).max(begins);
    (on_path / step).clamp(0.0, 1.0)
}
