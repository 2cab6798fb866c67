//! The two wheels of the pair.

use super::Material;

/// Geometry and material of the two wheels.
#[derive(Debug, Clone, PartialEq)]
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
    /// Material of wheels and shafts. Default steel.
    pub material: Material,
    /// Relief of the flank near the tip; `None` for none. Default parabolic, 1 mm × 1 mm.
    pub tip_relief: Option<TipRelief>,
    /// (mm) Constant reduction of the working flank. Default 0.
    pub crowning_mm: f64,
    /// Number of points along a tooth's profile. Default 10 000.
    pub points_per_tooth: usize,
    /// Coefficients of the fillet foundation's compliance. Default: Sainsot et al. 2004.
    pub foundation: FoundationCoefficients,
}

impl Gears {
    /// Two wheels with everything but the arguments at its default.
    ///
    /// # Arguments
    /// As the fields of the same names.
    pub fn new(module_mm: f64, pinion_teeth: u32, gear_teeth: u32, face_width_mm: f64) -> Self {
        Self {
            module_mm,
            pinion_teeth,
            gear_teeth,
            face_width_mm,
            pressure_angle_deg: 20.0,
            material: Material::default(),
            tip_relief: Some(TipRelief::default()),
            crowning_mm: 0.0,
            points_per_tooth: 10_000,
            foundation: FoundationCoefficients::default(),
        }
    }
}

/// Form of the relieved part of the flank.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReliefShape {
    /// A parabola that leaves the flank with the flank's own slope.
    Parabolic,
    /// A straight line.
    Linear,
}

/// Material removed from the flank near the tip so that teeth enter contact softly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipRelief {
    /// Line or parabola.
    pub shape: ReliefShape,
    /// (mm) Length along the tooth's centre line, from the tip inwards.
    pub length_mm: f64,
    /// (mm) How far the tip lies below the flank point where the relief starts.
    pub depth_mm: f64,
}

impl Default for TipRelief {
    fn default() -> Self {
        Self { shape: ReliefShape::Parabolic, length_mm: 1.0, depth_mm: 1.0 }
    }
}

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
