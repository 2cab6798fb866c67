//! Materials of the wheels and shafts.

use crate::keys::by_name;

/// An isotropic elastic material, by name.
///
/// Values as in the published model's manual (`docs`: theory, compliance).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Material {
    /// E 210 GPa, ν 0.30, 7840 kg/m³. The default.
    #[default]
    Steel,
    /// E 120 GPa, ν 0.33, 8920 kg/m³.
    Copper,
    /// E 70 GPa, ν 0.33, 2700 kg/m³.
    Aluminium,
    /// E 110 GPa, ν 0.36, 8700 kg/m³.
    Brass,
    /// E 140 GPa, ν 0.25, 7800 kg/m³.
    CastIron,
    /// E 110 GPa, ν 0.35, 8300 kg/m³.
    Bronze,
}

by_name!(Material, [
    "steel" => Material::Steel,
    "copper" => Material::Copper,
    "aluminium" => Material::Aluminium,
    "brass" => Material::Brass,
    "cast-iron" => Material::CastIron,
    "bronze" => Material::Bronze,
]);

impl Material {
    /// Every material, in the order of the documentation.
    pub const ALL: [Self; 6] =
        [Self::Steel, Self::Copper, Self::Aluminium, Self::Brass, Self::CastIron, Self::Bronze];

    /// (MPa = N/mm²) Young's modulus.
    pub fn youngs_modulus_mpa(self) -> f64 {
        match self {
            Self::Steel => 210e3,
            Self::Copper => 120e3,
            Self::Aluminium => 70e3,
            Self::Brass | Self::Bronze => 110e3,
            Self::CastIron => 140e3,
        }
    }

    /// (-) Poisson's ratio.
    pub fn poisson_ratio(self) -> f64 {
        match self {
            Self::Steel => 0.30,
            Self::Copper | Self::Aluminium => 0.33,
            Self::Brass => 0.36,
            Self::CastIron => 0.25,
            Self::Bronze => 0.35,
        }
    }

    /// (kg/m³) Density.
    pub fn density_kg_per_m3(self) -> f64 {
        match self {
            Self::Steel => 7840.0,
            Self::Copper => 8920.0,
            Self::Aluminium => 2700.0,
            Self::Brass => 8700.0,
            Self::CastIron => 7800.0,
            Self::Bronze => 8300.0,
        }
    }

    /// (MPa) Shear modulus `G = E/(2(1+ν))`.
    pub fn shear_modulus_mpa(self) -> f64 {
        self.youngs_modulus_mpa() / (2.0 * (1.0 + self.poisson_ratio()))
    }
}
