//! A pair of teeth that carries a load: how stiff it is, and where along the face the load acts.

use std::sync::Arc;

use super::sequence::PairKind;
use crate::damage::{DamagedTooth, united};
use crate::stiffness::{FlankLoad, LoadedFlank, hertz_compliance_mm_per_n};
use crate::wheel::{FlankPoint, FoundationCoefficients, Gears, Material, Teeth, WheelName};

/// A pair that is loaded at one position of its path of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LoadedPair {
    /// (N/mm) Stiffness along the line of action, `cos β_b/(c_pinion + c_gear + c_contact)`, of helical teeth in the transverse
    /// section, as if the whole face touched at one position; 0 where nothing is left that could touch.
    pub stiffness_n_per_mm: f64,
    /// (m) Where along the face the load acts, from its middle: the centroid of the width that is left.
    pub face_centre_m: f64,
}

impl LoadedPair {
    /// A pair of which nothing is left that could touch.
    const NONE: Self = Self { stiffness_n_per_mm: 0.0, face_centre_m: 0.0 };
}

/// The tooth pairs of two wheels, sound or damaged.
pub struct Pairs<'a> {
    teeth: &'a Teeth,
    damaged: &'a [DamagedTooth],
    sound: Arc<[LoadedFlank<'a>; 2]>,
    broken: Vec<LoadedFlank<'a>>,
    materials: [Material; 2],
    foundation: FoundationCoefficients,
    /// (-) Cosine of the base helix angle, by which a stiffness across the teeth is less in the transverse section.
    base_cos: f64,
    /// Whether a ring drives.
    ring_drives: bool,
}

/// One of a pair's two teeth where it is touched.
struct Touched<'a> {
    damage: Option<&'a DamagedTooth>,
    loaded: &'a LoadedFlank<'a>,
    point: FlankPoint,
}

impl<'a> Pairs<'a> {
    /// Prepares the pairs.
    ///
    /// # Arguments
    /// * `teeth` - both sound teeth
    /// * `damaged` - the damaged teeth
    /// * `gears` - for the materials and the coefficients of the fillet foundation
    pub fn new(teeth: &'a Teeth, damaged: &'a [DamagedTooth], gears: &Gears) -> Self {
        let (materials, foundation) =
            (WheelName::BOTH.map(|wheel| gears.material_of(wheel)), &gears.foundation);
        let loaded = |wheel: WheelName, damage| {
            LoadedFlank::new(teeth.flank(wheel), damage, materials[wheel as usize], foundation)
        };
        Self {
            teeth,
            damaged,
            sound: Arc::new(WheelName::BOTH.map(|wheel| loaded(wheel, None))),
            broken: damaged.iter().map(|tooth| loaded(tooth.wheel, Some(tooth))).collect(),
            materials,
            foundation: *foundation,
            base_cos: teeth.pinion.base_helix_angle_rad().cos(),
            ring_drives: gears.ring_drives,
        }
    }

    /// The same wheels with other damaged teeth.
    ///
    /// # Arguments
    /// * `damaged` - the damaged teeth
    pub(crate) fn with_damaged(&self, damaged: &'a [DamagedTooth]) -> Self {
        let loaded = |tooth: &'a DamagedTooth| {
            let material = self.materials[tooth.wheel as usize];
            LoadedFlank::new(self.teeth.flank(tooth.wheel), Some(tooth), material, &self.foundation)
        };
        Self { damaged, broken: damaged.iter().map(loaded).collect(), sound: self.sound.clone(), ..*self }
    }

    /// A pair of a class at a position of its path.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `position` - (base pitches) since it entered contact
    pub fn at(&self, kind: &PairKind, position: f64) -> LoadedPair {
        let path = &self.teeth.path;
        let pair = self.touched(kind, WheelName::BOTH.map(|wheel| path.curvature_mm(wheel, position)));
        if pair.iter().any(Touched::is_gone) { LoadedPair::NONE } else { self.carried(&pair) }
    }

    /// A pair of a class that is loaded where its flanks have given radii of curvature, whether or not they touch there.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `curvature_mm` - (mm) of the pinion's and of the gear's flank in the transverse section; on what is left of a broken tooth
    pub(crate) fn loaded_at(&self, kind: &PairKind, curvature_mm: [f64; 2]) -> LoadedPair {
        let pair = self.touched(kind, curvature_mm);
        let is_missing = |tooth: &Touched| tooth.damage.is_some_and(DamagedTooth::is_missing);
        if pair.iter().any(is_missing) { LoadedPair::NONE } else { self.carried(&pair) }
    }

    /// Both teeth of a pair of a class, touched where their flanks have given radii of curvature.
    fn touched(&self, kind: &PairKind, curvature_mm: [f64; 2]) -> [Touched<'_>; 2] {
        [(WheelName::Pinion, kind.pinion), (WheelName::Gear, kind.gear)].map(|(name, damage)| {
            let flank = self.teeth.flank(name);
            Touched {
                damage: damage.map(|index| &self.damaged[index]),
                loaded: damage.map_or(&self.sound[name as usize], |index| &self.broken[index]),
                point: flank.at_curvature(self.teeth.section_curvature_mm(name, curvature_mm[name as usize])),
            }
        })
    }

    /// A pair that carries a load on what is left of its width.
    ///
    /// # Arguments
    /// * `pair` - both teeth where they touch
    fn carried(&self, pair: &[Touched; 2]) -> LoadedPair {
        let Some(Bearing { width_mm, z_mm, face_centre_m }) = self.bearing(pair) else {
            return LoadedPair::NONE;
        };
        let compliance = pair.iter().map(|tooth| {
            let FlankPoint { load_sin: sin, load_cos: cos, .. } = tooth.point;
            tooth.loaded.compliance_mm_per_n(&FlankLoad { point: tooth.point, sin, cos, z_mm, width_mm })
        });
        let compliance = compliance.sum::<f64>() + hertz_compliance_mm_per_n(self.materials, width_mm);
        // What has no width left has no compliance that is a number.
        let stiffness_n_per_mm = if compliance > 0.0 { self.base_cos / compliance } else { 0.0 };
        LoadedPair { stiffness_n_per_mm, face_centre_m }
    }

    /// The part of a pair's face that bears; none where nothing does.
    ///
    /// # Arguments
    /// * `pair` - both teeth where they touch
    fn bearing(&self, pair: &[Touched; 2]) -> Option<Bearing> {
        let face_width = self.teeth.gear.face_width_mm;
        let unloaded = pair.iter().map(Touched::unloaded_width_mm).fold(0.0, f64::max);
        let mut gone: Vec<[f64; 2]> = pair.iter().flat_map(Touched::pitted_mm).collect();
        if gone.is_empty() {
            let width_mm = face_width - unloaded;
            let half_width_m = face_width * 1e-3 / 2.0;
            let face_centre_m = (-half_width_m + (half_width_m - unloaded * 1e-3)) / 2.0;
            return (width_mm > 0.0).then_some(Bearing { width_mm, z_mm: unloaded / 2.0, face_centre_m });
        }
        let half = face_width / 2.0;
        gone.push([half - unloaded, half]);
        let mut from = -half;
        let mut left: Vec<[f64; 2]> = Vec::with_capacity(gone.len() + 1);
        for [start, end] in united(gone, half) {
            left.push([from, start]);
            from = end;
        }
        left.push([from, half]);
        let width_mm: f64 = left.iter().map(|[from, to]| to - from).sum();
        (width_mm > 0.0).then(|| {
            let pieces_m: Vec<[f64; 2]> = left.iter().map(|piece| piece.map(|z| z * 1e-3)).collect();
            let width_m: f64 = pieces_m.iter().map(|[from, to]| to - from).sum();
            let moment_m2: f64 = pieces_m.iter().map(|[from, to]| (to * to - from * from) / 2.0).sum();
            let face_centre_m = moment_m2 / width_m;
            // The sections' z runs the other way.
            Bearing { width_mm, z_mm: -face_centre_m * 1e3, face_centre_m }
        })
    }

    /// Whether a ring drives, so that pairs go through their path from its end.
    pub(crate) fn ring_drives(&self) -> bool {
        self.ring_drives
    }

    /// The wheels' sound teeth.
    pub(crate) fn teeth(&self) -> &'a Teeth {
        self.teeth
    }

    /// The damage of a tooth of a class.
    pub(crate) fn damage_of(&self, kind: &PairKind, wheel: WheelName) -> Option<&'a DamagedTooth> {
        let index = match wheel {
            WheelName::Pinion => kind.pinion,
            WheelName::Gear => kind.gear,
        };
        index.map(|index| &self.damaged[index])
    }
}

/// The part of a pair's face that bears.
struct Bearing {
    /// (mm) How much of its width.
    width_mm: f64,
    /// (mm) Its middle, in the sections' z.
    z_mm: f64,
    /// (m) Its centroid, from the middle of the face.
    face_centre_m: f64,
}

impl Touched<'_> {
    fn is_gone(&self) -> bool {
        self.damage.is_some_and(|damage| self.point.nearest() >= damage.gone_from_index)
    }

    fn unloaded_width_mm(&self) -> f64 {
        self.damage.map_or(0.0, |damage| {
            // A chip's edge is slanted, a pit's upright.
            self.point.of(&damage.missing_width_mm).max(damage.corner_width_mm[self.point.nearest()])
        })
    }

    /// (mm) Parts of the face that pits take, from the face's middle.
    fn pitted_mm(&self) -> Vec<[f64; 2]> {
        let pits = self.damage.and_then(|damage| damage.pits.as_ref());
        pits.map_or_else(Vec::new, |pits| pits.gone_at(&self.point))
    }
}
