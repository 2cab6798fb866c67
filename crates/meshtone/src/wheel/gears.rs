//! The two wheels of the pair.

use super::{FlankRelief, Material, WheelName};
use crate::keys::{KeyRow, Keys, Range, by_name, field, row};

/// Geometry and material of the two wheels.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gears {
    /// (mm) Module of both wheels.
    pub module_mm: f64,
    /// Tooth count of the driving wheel.
    pub pinion_teeth: u32,
    /// Tooth count of the driven wheel.
    pub gear_teeth: u32,
    /// (mm) Face width of both wheels.
    pub face_width_mm: f64,
    /// (°) Pressure angle at the pitch circle. Default 20.
    pub pressure_angle_deg: f64,
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
    /// (mm) Distance between the axes; none for the one at which the teeth have no backlash.
    pub centre_distance_mm: Option<f64>,
    /// Material of wheels and shafts. Default steel.
    pub material: Material,
    /// Relief of the flank near the tip, as a gap. Default none.
    pub flank_relief: FlankRelief,
    /// (mm) Height of the chamfer or rounding of all tips, which the flank ends below; none for 0.23 modules.
    pub tip_chamfer_mm: Option<f64>,
    /// (base pitches) By how much the path of contact is shorter than the tips between their chamfers make it, half at either end.
    /// Default 0.1.
    pub active_profile_shortening: f64,
    /// (mm) Normal backlash; none for two thirds of `0.06 + 0.0005 a + 0.03 m`, a the centre distance, and what a given centre
    /// distance opens.
    pub backlash_mm: Option<f64>,
    /// (mm) Constant reduction of the working flank. Default 0.
    pub uniform_flank_reduction_mm: f64,
    /// Number of points along a tooth's profile. Default 10 000.
    pub points_per_tooth: usize,
    /// Coefficients of the fillet foundation's compliance. Default: Sainsot et al. 2004.
    pub foundation: FoundationCoefficients,
}

/// Coefficients of the standard basic rack.
///
/// Source: ISO 53:1998, profile A.
pub(super) const STANDARD_ADDENDUM: f64 = 1.0;
pub(super) const STANDARD_DEDENDUM: f64 = 1.25;

impl Gears {
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
            pinion_profile_shift: 0.0,
            gear_profile_shift: 0.0,
            pinion_addendum: STANDARD_ADDENDUM,
            gear_addendum: STANDARD_ADDENDUM,
            pinion_dedendum: STANDARD_DEDENDUM,
            gear_dedendum: STANDARD_DEDENDUM,
            centre_distance_mm: None,
            material: Material::default(),
            flank_relief: FlankRelief::default(),
            tip_chamfer_mm: None,
            active_profile_shortening: 0.1,
            backlash_mm: None,
            uniform_flank_reduction_mm: 0.0,
            points_per_tooth: 10_000,
            foundation: FoundationCoefficients::default(),
        }
    }
}

impl Keys for Gears {
    const SECTION: &str = "gears";

    fn start() -> Self {
        Self::new(f64::NAN, 0, 0, f64::NAN)
    }

    fn rows() -> Vec<KeyRow<Self>> {
        const TEETH: Range = Range::from_to(6.0, 10_000.0).message("must be from 6 to 10000 teeth");
        const SHIFT: Range =
            Range::from_to(-2.0, 2.0).help("usual shifts are −0.5 to 1; in mm they are x times the module");
        const ADDENDUM: Range = Range::from_to(0.3, 2.0).help("the standard basic rack has 1");
        const DEDENDUM: Range = Range::from_to(0.5, 2.5).help("the standard basic rack has 1.25");
        let teeth = |name, field| {
            row(name, "", "the tooth count", field)
                .required()
                .range(TEETH)
                .rule("contact ratio at least 1; undercut (fewer than 17 at 20°) is left out, with a warning")
        };
        let shift = |name, field| {
            row(name, "-", "the profile shift coefficient x, in modules", field)
                .range(SHIFT)
                .rule("no undercut, no pointed tip")
        };
        let addendum = |name, field| {
            row(name, "-", "the addendum coefficient of the basic rack, in modules", field)
                .range(ADDENDUM)
                .rule("tips not pointed, clear of the mate's fillets")
        };
        let dedendum = |name, field| {
            row(name, "-", "the dedendum coefficient of the basic rack, in modules", field)
                .range(DEDENDUM)
                .rule("roots clear of the mate's tips")
        };
        vec![
            row("module_mm", "mm", "the module of both wheels", field!(module_mm))
                .required()
                .range(Range::positive().implausible_above(100.0)),
            teeth("pinion_teeth", field!(pinion_teeth)),
            teeth("gear_teeth", field!(gear_teeth)),
            row("face_width_mm", "mm", "the face width of both wheels", field!(face_width_mm))
                .required()
                .range(Range::positive().implausible_above(10_000.0)),
            row(
                "pressure_angle_deg",
                "°",
                "the pressure angle at the pitch circle",
                field!(pressure_angle_deg),
            )
            .range(Range::from_to(10.0, 35.0).help("usual pressure angles are 14.5°, 20° and 25°"))
            .rule("no teeth pointed below full height"),
            shift("pinion_profile_shift", field!(pinion_profile_shift)),
            shift("gear_profile_shift", field!(gear_profile_shift)),
            addendum("pinion_addendum", field!(pinion_addendum)),
            addendum("gear_addendum", field!(gear_addendum)),
            dedendum("pinion_dedendum", field!(pinion_dedendum)),
            dedendum("gear_dedendum", field!(gear_dedendum)),
            row("centre_distance_mm", "mm", "the distance between the axes", field!(centre_distance_mm))
                .otherwise("that without backlash")
                .range(Range::positive())
                .rule("at least the default; contact ratio at least 1")
                .alternative("83.0"),
            row("material", "", "the material of wheels and shafts", field!(material)),
            row(
                "flank_relief",
                "",
                "the relief of the flanks near the tips, as a gap in µm",
                field!(flank_relief),
            ),
            row(
                "tip_chamfer_mm",
                "mm",
                "the height of the chamfer or rounding of all tips",
                field!(tip_chamfer_mm),
            )
            .otherwise("0.23 modules")
            .alternative("0.69")
            .range(Range::not_negative())
            .rule("less than 1 module"),
            row(
                "active_profile_shortening",
                "-",
                "by how much the path of contact is shorter than that between the chamfers, in base pitches, half at either \
                 end",
                field!(active_profile_shortening),
            )
            .range(Range::from_to(0.0, 0.5)),
            row("backlash_mm", "mm", "the backlash along the line of action", field!(backlash_mm))
                .otherwise("⅔ (0.06 + 0.0005 a + 0.03 m), a the centre distance, and what a given one opens")
                .range(Range::not_negative())
                .rule("less than 1 module; at least what a given centre distance opens")
                .alternative("0.1275"),
            row(
                "uniform_flank_reduction_mm",
                "mm",
                "a constant reduction of the working flank",
                field!(uniform_flank_reduction_mm),
            )
            .range(Range::not_negative())
            .rule("less than π/4 modules, half the tooth's thickness"),
            row(
                "points_per_tooth",
                "",
                "the number of points along a tooth's profile",
                field!(points_per_tooth),
            )
            .range(Range::from_to(500.0, 1e6).message("must be from 500 to 1000000; the default is 10000")),
            row(
                "foundation",
                "",
                "the coefficients A to F of the four polynomials of the fillet foundation's compliance, by Sainsot, \
                 Velex and Duverger (2004)",
                field!(foundation),
            ),
        ]
    }
}

impl Gears {
    /// (mm) Height of the tips' chamfer, given or by default.
    pub fn chamfer_mm(&self) -> f64 {
        self.tip_chamfer_mm.unwrap_or(0.23 * self.module_mm)
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
        let distance = self.centre_distance_mm.map(|distance_mm| ("gears.centre_distance_mm", distance_mm));
        changed.map(|(key, value, _)| (key, value)).chain(distance).collect()
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
}

impl Default for FoundationCoefficients {
    fn default() -> Self {
        Self {
            l: [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.77021e-3, 0.0271, 6.8045],
            m: [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
            p: [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
            q: [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
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
        ]
    }
}
