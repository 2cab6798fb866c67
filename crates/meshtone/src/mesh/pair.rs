//! A pair of teeth on its way through contact: how stiff it is, how far its flanks deviate, how it carries its load.

use super::load_state::LoadState;
use super::sequence::PairKind;
use crate::damage::{DamagedTooth, RollingPit, united};
use crate::stiffness::{FlankLoad, LoadedFlank, hertz_compliance_mm_per_n};
use crate::wheel::{Flank, FlankPoint, FoundationCoefficients, Material, Teeth, WheelName};

/// A pair at one position of its path of contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairState {
    /// (N/mm) Stiffness along the line of action, `1/(c_pinion + c_gear + c_contact)`; 0 where nothing touches.
    pub stiffness_n_per_mm: f64,
    /// (mm) How far damage sets the flanks back along the line of action, as a deviation: 0 or less.
    pub deviation_mm: f64,
    /// Where and in which direction it carries its load.
    pub load: LoadState,
}

/// The tooth pairs of two wheels, sound or damaged.
pub struct Pairs<'a> {
    teeth: &'a Teeth,
    damaged: &'a [DamagedTooth],
    sound: [LoadedFlank<'a>; 2],
    broken: Vec<LoadedFlank<'a>>,
    material: Material,
    nominal: LoadState,
}

/// One of a pair's two teeth where it is touched.
struct Touched<'a> {
    name: WheelName,
    flank: Flank<'a>,
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
    /// * `material` - of both wheels
    /// * `foundation` - coefficients of the fillet foundation
    pub fn new(
        teeth: &'a Teeth,
        damaged: &'a [DamagedTooth],
        material: Material,
        foundation: &FoundationCoefficients,
    ) -> Self {
        let loaded = |wheel, damage| LoadedFlank::new(teeth.flank(wheel), damage, material, foundation);
        let half_width_m = teeth.gear.face_width_mm * 1e-3 / 2.0;
        Self {
            teeth,
            damaged,
            sound: WheelName::BOTH.map(|wheel| loaded(wheel, None)),
            broken: damaged.iter().map(|tooth| loaded(tooth.wheel, Some(tooth))).collect(),
            material,
            nominal: LoadState::spread(-half_width_m, half_width_m, teeth.gear.working_pressure_angle_rad),
        }
    }

    /// How a sound pair carries its load.
    pub fn nominal_load(&self) -> LoadState {
        self.nominal
    }

    /// How a pair of a class carries a load where its flanks have given radii of curvature, whether or not they touch there: its
    /// stiffness and where along the face the load acts. The deviation is 0.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `curvature_mm` - (mm) of the pinion's and of the gear's flank; on what is left of a broken tooth
    pub(crate) fn loaded_at(&self, kind: &PairKind, curvature_mm: [f64; 2]) -> PairState {
        let pair = self.touched(kind, curvature_mm);
        let is_missing = |tooth: &Touched| tooth.damage.is_some_and(DamagedTooth::is_missing);
        if pair.iter().any(is_missing) {
            return self.apart();
        }
        let points = pair.each_ref().map(|tooth| tooth.point);
        self.carried(&pair, points, 0.0).unwrap_or_else(|| self.apart())
    }

    /// Both teeth of a pair of a class, touched where their flanks have given radii of curvature.
    fn touched(&self, kind: &PairKind, curvature_mm: [f64; 2]) -> [Touched<'_>; 2] {
        [(WheelName::Pinion, kind.pinion), (WheelName::Gear, kind.gear)].map(|(name, damage)| {
            let flank = self.teeth.flank(name);
            Touched {
                name,
                flank,
                damage: damage.map(|index| &self.damaged[index]),
                loaded: damage.map_or(&self.sound[name as usize], |index| &self.broken[index]),
                point: flank.at_curvature(curvature_mm[name as usize]),
            }
        })
    }

    /// A pair of which nothing touches.
    fn apart(&self) -> PairState {
        PairState { stiffness_n_per_mm: 0.0, deviation_mm: 0.0, load: self.nominal }
    }

    /// How a pair carries a load on what is left of its width, without deviation; none where nothing is left.
    ///
    /// # Arguments
    /// * `pair` - both teeth where they would touch
    /// * `points` - where the load acts on each
    /// * `turn_rad` - (rad) how far the line of action has turned
    fn carried(&self, pair: &[Touched; 2], points: [FlankPoint; 2], turn_rad: f64) -> Option<PairState> {
        let Bearing { width_mm: width, z_mm, load } = self.bearing(pair, turn_rad)?;
        // The load acts at a point; the wheels have turned on, so that its angle is the one of where they would touch, and the
        // turn of the line of action: on the mate of a pit, the mate's own normal at the edge.
        let (sin, cos) = turn_rad.sin_cos();
        let compliance = pair.iter().zip(points).map(|(tooth, point)| {
            let nominal = tooth.point;
            tooth.loaded.compliance_mm_per_n(&FlankLoad {
                point,
                sin: nominal.load_sin * cos + nominal.load_cos * sin,
                cos: nominal.load_cos * cos - nominal.load_sin * sin,
                z_mm,
                width_mm: width,
            })
        });
        let compliance = compliance.sum::<f64>() + hertz_compliance_mm_per_n(self.material, width);
        Some(PairState {
            // What has no width left has no compliance that is a number.
            stiffness_n_per_mm: if compliance > 0.0 { 1.0 / compliance } else { 0.0 },
            deviation_mm: 0.0,
            load,
        })
    }

    /// What bears of a pair's face; none where nothing does.
    ///
    /// # Arguments
    /// * `pair` - both teeth where they would touch
    /// * `turn_rad` - (rad) how far the line of action has turned
    fn bearing(&self, pair: &[Touched; 2], turn_rad: f64) -> Option<Bearing> {
        let face_width = self.teeth.gear.face_width_mm;
        let angle = self.nominal.pressure_angle_rad + turn_rad;
        let unloaded = pair.iter().map(Touched::unloaded_width_mm).fold(0.0, f64::max);
        let mut gone: Vec<[f64; 2]> = pair.iter().flat_map(Touched::pitted_mm).collect();
        if gone.is_empty() {
            let width_mm = face_width - unloaded;
            let half_width_m = face_width * 1e-3 / 2.0;
            let load = LoadState::spread(-half_width_m, half_width_m - unloaded * 1e-3, angle);
            return (width_mm > 0.0).then_some(Bearing { width_mm, z_mm: unloaded / 2.0, load });
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
        let pieces_m: Vec<[f64; 2]> = left.iter().map(|piece| piece.map(|z| z * 1e-3)).collect();
        (width_mm > 0.0).then(|| {
            let load = LoadState::over(&pieces_m, angle);
            // The sections' z runs the other way.
            Bearing { width_mm, z_mm: -load.mean_z_m * 1e3, load }
        })
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

    /// A pair of a class at a position of its path.
    ///
    /// # Arguments
    /// * `kind` - the class
    /// * `position` - (base pitches) since it entered contact
    pub fn at(&self, kind: &PairKind, position: f64) -> PairState {
        let path = &self.teeth.path;
        let pair = self.touched(kind, WheelName::BOTH.map(|wheel| path.curvature_mm(wheel, position)));
        if pair.iter().any(Touched::is_gone) {
            return self.apart();
        }
        let rolling = pair.iter().filter_map(|tooth| tooth.rolling(position, self.teeth));
        let turned = rolling.clone().max_by(|a, b| a.pit.deviation_mm.total_cmp(&b.pit.deviation_mm));
        let points = pair.each_ref().map(|tooth| match &turned {
            None => tooth.point,
            Some(rolling) => tooth.flank.at_curvature(rolling.edge_curvature_mm(tooth.name)),
        });
        let Some(carried) = self.carried(&pair, points, turned.map_or(0.0, |rolling| rolling.turn_rad))
        else {
            return self.apart();
        };
        PairState {
            deviation_mm: pair.iter().map(Touched::deviation_mm).sum::<f64>()
                + rolling.map(|rolling| rolling.displacement_mm).sum::<f64>(),
            ..carried
        }
    }
}

/// What bears of a pair's face.
struct Bearing {
    /// (mm) How much of its width.
    width_mm: f64,
    /// (mm) The middle of it, in the sections' z.
    z_mm: f64,
    load: LoadState,
}

/// A pair whose mate turns about the edges of a pit.
struct Rolling<'a> {
    pit: &'a RollingPit,
    pitted: WheelName,
    /// (mm) Radius of curvature of the pitted flank at the edge.
    edge_mm: f64,
    line_mm: f64,
    /// (rad) How far the line of action has turned.
    turn_rad: f64,
    displacement_mm: f64,
}

impl Rolling<'_> {
    fn edge_curvature_mm(&self, wheel: WheelName) -> f64 {
        if wheel == self.pitted { self.edge_mm } else { self.line_mm - self.edge_mm }
    }
}

impl<'a> Touched<'a> {
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

    fn deviation_mm(&self) -> f64 {
        self.damage.map_or(0.0, |damage| self.point.of(&damage.deviation_mm))
    }

    /// The mate turns about the edge by the arc that it would have rolled: from the pit's root-side edge in the first half of
    /// the pit, about the tip-side edge in the second, `(ρ_edge' − ρ')/Rb'` with the mate's ρ' and Rb'; and the flanks come
    /// together by `h (1 − cos 2πξ)/2` over the pit.
    fn rolling(&self, position: f64, teeth: &Teeth) -> Option<Rolling<'a>> {
        let index = self.point.nearest();
        let pit = self.damage?.rolling_at(index)?;
        let edge = if index <= pit.mid_index { pit.start_index } else { pit.end_index };
        let edge_mm = self.flank.curvature_mm(edge);
        let mate = teeth.wheel(self.name.mate());
        let ends = [pit.start_index, pit.end_index]
            .map(|edge| teeth.path.position(self.name, self.flank.curvature_mm(edge)));
        let passed = ((position - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0);
        let curvature = teeth.path.curvature_mm(self.name, position);
        Some(Rolling {
            pit,
            pitted: self.name,
            edge_mm,
            line_mm: teeth.path.line_mm,
            turn_rad: (curvature - edge_mm) / mate.base_radius_mm,
            displacement_mm: -pit.deviation_mm * (1.0 - (std::f64::consts::TAU * passed).cos()) / 2.0,
        })
    }
}
