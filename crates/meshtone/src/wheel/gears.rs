//! Two wheels in mesh.

use super::{EndRelief, FlankRelief, Hand, Material, WheelName};
use crate::keys::{KeyRow, Keys, by_name, field, row};

/// Geometry and material of two wheels in mesh, which a scenario states wheel by wheel.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gears {
    /// (mm) Module of both wheels, of helical ones in the normal section.
    pub module_mm: f64,
    /// Tooth count of the driving wheel.
    pub pinion_teeth: u32,
    /// Tooth count of the driven wheel.
    pub gear_teeth: u32,
    /// (mm) Face width of both wheels.
    pub face_width_mm: f64,
    /// (°) Pressure angle at the pitch circle, of helical wheels in the normal section. Default 20.
    pub pressure_angle_deg: f64,
    /// (°) Helix angle at the pitch circle. Default 0: spur wheels.
    pub helix_angle_deg: f64,
    /// Hand of the pinion's helix; the gear's is the other one. Default right.
    pub hand: Hand,
    /// (µm) Lead crowning of both wheels together: how much farther apart the flanks are at the ends of the face than at its middle.
    /// Default 0.
    pub lead_crowning_um: f64,
    /// Relief of the flanks towards both ends of the face. Default none.
    pub end_relief: EndRelief,
    /// Number of slices of the face where the gap varies along it. Default 21.
    pub slices: u32,
    /// (-) Profile shift coefficient of the pinion, in modules. Default 0.
    pub pinion_profile_shift: f64,
    /// (-) Profile shift coefficient of the gear, in modules. Default 0.
    pub gear_profile_shift: f64,
    /// (-) Addendum coefficient of the pinion's basic rack. Default 1.
    pub pinion_addendum: f64,
    /// (-) Addendum coefficient of the gear's basic rack. Default 1.
    pub gear_addendum: f64,
    /// (-) Dedendum coefficient of the pinion's basic rack. Default 1.25.
    pub pinion_dedendum: f64,
    /// (-) Dedendum coefficient of the gear's basic rack. Default 1.25.
    pub gear_dedendum: f64,
    /// (mm) Distance between the axes; none for the one at which the teeth have no backlash. In a ring it may be shorter, and otherwise
    /// longer.
    pub centre_distance_mm: Option<f64>,
    /// Material of the shafts, and of a wheel that has none of its own. Default steel.
    pub material: Material,
    /// Material of the pinion; none for that of the shafts.
    pub pinion_material: Option<Material>,
    /// Material of the gear; none for that of the shafts.
    pub gear_material: Option<Material>,
    /// Relief of the flank near the tip of pinion and gear, as a gap. Default none.
    pub flank_relief: [FlankRelief; 2],
    /// (mm) Height of the chamfer or rounding of the tips of pinion and gear, which the flank ends below; none for 0.23 modules.
    pub tip_chamfer_mm: [Option<f64>; 2],
    /// (base pitches) By how much the path of contact is shorter than the tips between their chamfers make it: half that of the pinion at its
    /// end, half that of the gear at its start. Default 0.1.
    pub active_profile_shortening: [f64; 2],
    /// (mm) Normal backlash; none for two thirds of `0.06 + 0.0005 a + 0.03 m`, a the centre distance, and what a given centre
    /// distance opens.
    pub backlash_mm: Option<f64>,
    /// (mm) Constant reduction of the working flank of pinion and gear. Default 0.
    pub uniform_flank_reduction_mm: [f64; 2],
    /// Number of points along a tooth's profile. Default 10 000.
    pub points_per_tooth: usize,
    /// Coefficients of the fillet foundation's compliance. Default: Sainsot et al. 2004.
    pub foundation: FoundationCoefficients,
    /// Whether the second wheel is a ring with internal teeth, which the first one drives from inside. Default false.
    pub internal: bool,
    /// Whether that ring pushes the first wheel instead of being pushed: the other flanks work, and a pair goes through its path from the other
    /// end. Default false.
    pub ring_drives: bool,
}

/// Coefficients of the standard basic rack.
///
/// Source: ISO 53:1998, profile A.
pub(super) const STANDARD_ADDENDUM: f64 = 1.0;
pub(super) const STANDARD_DEDENDUM: f64 = 1.25;

impl Gears {
    /// The number of slices of the face by default.
    pub(crate) const SLICES: u32 = 21;

    /// Two wheels with everything but the arguments at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(module_mm: f64, pinion_teeth: u32, gear_teeth: u32, face_width_mm: f64) -> Self {
        Self {
            module_mm,
            pinion_teeth,
            gear_teeth,
            face_width_mm,
            pressure_angle_deg: 20.0,
            helix_angle_deg: 0.0,
            hand: Hand::Right,
            lead_crowning_um: 0.0,
            end_relief: EndRelief::default(),
            slices: Self::SLICES,
            pinion_profile_shift: 0.0,
            gear_profile_shift: 0.0,
            pinion_addendum: STANDARD_ADDENDUM,
            gear_addendum: STANDARD_ADDENDUM,
            pinion_dedendum: STANDARD_DEDENDUM,
            gear_dedendum: STANDARD_DEDENDUM,
            centre_distance_mm: None,
            material: Material::default(),
            pinion_material: None,
            gear_material: None,
            flank_relief: [FlankRelief::default(); 2],
            tip_chamfer_mm: [None; 2],
            active_profile_shortening: [0.1; 2],
            backlash_mm: None,
            uniform_flank_reduction_mm: [0.0; 2],
            points_per_tooth: 10_000,
            foundation: FoundationCoefficients::default(),
            internal: false,
            ring_drives: false,
        }
    }
}

impl Gears {
    /// (mm) Height of the chamfer of a wheel's tips, given or by default.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn chamfer_mm(&self, wheel: WheelName) -> f64 {
        self.tip_chamfer_mm[wheel as usize].unwrap_or(0.23 * self.module_mm)
    }

    /// Whether the flank of either wheel is relieved near its tip.
    pub(crate) fn is_relieved(&self) -> bool {
        self.flank_relief.iter().any(|relief| relief.amount_um > 0.0)
    }

    /// The same wheels where the gear drives the pinion; not of a ring, which is always the second wheel.
    pub(crate) fn exchanged(mut self) -> Self {
        debug_assert!(!self.internal, "a ring is always the second wheel");
        std::mem::swap(&mut self.pinion_teeth, &mut self.gear_teeth);
        std::mem::swap(&mut self.pinion_profile_shift, &mut self.gear_profile_shift);
        std::mem::swap(&mut self.pinion_addendum, &mut self.gear_addendum);
        std::mem::swap(&mut self.pinion_dedendum, &mut self.gear_dedendum);
        std::mem::swap(&mut self.pinion_material, &mut self.gear_material);
        self.flank_relief.reverse();
        self.tip_chamfer_mm.reverse();
        self.active_profile_shortening.reverse();
        self.uniform_flank_reduction_mm.reverse();
        self.hand = self.hand.other();
        self
    }

    /// (-) −1 of a ring, else 1: see [`Wheel::sign`](super::Wheel::sign).
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub(super) fn sign(&self, wheel: WheelName) -> f64 {
        if self.internal { wheel.choose(1.0, -1.0) } else { 1.0 }
    }

    /// Material of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn material_of(&self, wheel: WheelName) -> Material {
        wheel.choose(self.pinion_material, self.gear_material).unwrap_or(self.material)
    }

    /// Tooth count of a wheel.
    ///
    /// # Arguments
    /// * `wheel` - which of the two
    pub fn teeth(&self, wheel: WheelName) -> u32 {
        wheel.choose(self.pinion_teeth, self.gear_teeth)
    }
}

impl Gears {
    /// The keys of profile shift, basic racks and centre distance that are not at their default, in the file's order.
    pub(crate) fn beyond_standard(&self) -> Vec<(&'static str, f64)> {
        let coefficients = [
            ("gears.pinion_profile_shift", self.pinion_profile_shift, 0.0),
            ("gears.gear_profile_shift", self.gear_profile_shift, 0.0),
            ("gears.pinion_addendum", self.pinion_addendum, STANDARD_ADDENDUM),
            ("gears.gear_addendum", self.gear_addendum, STANDARD_ADDENDUM),
            ("gears.pinion_dedendum", self.pinion_dedendum, STANDARD_DEDENDUM),
            ("gears.gear_dedendum", self.gear_dedendum, STANDARD_DEDENDUM),
        ];
        let changed = coefficients.into_iter().filter(|(_, value, default)| value != default);
        let helix = self.is_helical().then_some(("gears.helix_angle_deg", self.helix_angle_deg));
        let distance = self.centre_distance_mm.map(|distance_mm| ("gears.centre_distance_mm", distance_mm));
        changed.map(|(key, value, _)| (key, value)).chain(helix).chain(distance).collect()
    }
}

/// Form of the relieved part of the flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReliefShape {
    /// A parabola that leaves the flank with the flank's own slope.
    Parabolic,
    /// A straight line.
    Linear,
}

by_name!(ReliefShape, ["parabolic" => ReliefShape::Parabolic, "linear" => ReliefShape::Linear]);

/// Coefficients `A…F` of the four polynomials `L, M, P, Q` of the fillet foundation's compliance,
/// `X = A/θ_f² + B h² + C h/θ_f + D/θ_f + E h + F`.
///
/// Source: P. Sainsot, P. Velex, O. Duverger, "Contribution of gear body to tooth deflections",
/// Journal of Mechanical Design 126 (2004), table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FoundationCoefficients {
    /// (-) `A…F` of `L`, the factor of `u²`.
    pub l: [f64; 6],
    /// (-) `A…F` of `M`, the factor of `u`.
    pub m: [f64; 6],
    /// (-) `A…F` of `P`, the constant term.
    pub p: [f64; 6],
    /// (-) `A…F` of `Q`, the factor of `tan²α`.
    pub q: [f64; 6],
    /// The place of the rotation of the wheel's whole body, which `P` has too. By default the machine has it; `published` has it in the teeth.
    pub rotation: BodyRotation,
}

/// Where the rotation of a wheel's whole body about its bore is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyRotation {
    /// It is a torsional spring between bore and wheel, once for all pairs of teeth, and is taken out of `P`, which is read within 7 bores.
    Machine,
    /// It is in the compliance of each pair of teeth, as it is published, and the body does not turn otherwise.
    Tooth,
}

by_name!(BodyRotation, ["machine" => BodyRotation::Machine, "tooth" => BodyRotation::Tooth]);

impl Default for FoundationCoefficients {
    fn default() -> Self {
        Self {
            l: [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.77021e-3, 0.0271, 6.8045],
            m: [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
            p: [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
            q: [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
            rotation: BodyRotation::Machine,
        }
    }
}

impl Keys for FoundationCoefficients {
    const IN_LINES: bool = true;

    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("L", "", "A to F of L, the factor of u²", field!(l)),
            row("M", "", "A to F of M, the factor of u", field!(m)),
            row("P", "", "A to F of P, the constant term", field!(p)),
            row("Q", "", "A to F of Q, the factor of tan²α", field!(q)),
            row(
                "rotation",
                "",
                "where the rotation of the wheel's whole body is, which P has too: \"machine\" takes it out of P and makes it a \
                 torsional spring between bore and wheel, \"tooth\" leaves it in each pair of teeth",
                field!(rotation),
            ),
        ]
    }
}
