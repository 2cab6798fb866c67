//! Materials of the wheels and shafts.

use std::ops::Bound::Excluded;

use meshtone_toml::{ReadResult, TomlValue};

use crate::keys::{
    Check, KeyDescription, KeyKind, KeyValue, Keys, NumberFiles, Range, Written, check_keys, describe, keys,
};

/// An isotropic elastic material, by name or by its constants.
///
/// Values as in the published model's manual (`docs`: theory, compliance).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
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
    /// Any other.
    Given(MaterialConstants),
}

/// The constants of an isotropic elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaterialConstants {
    /// (GPa) Young's modulus.
    pub youngs_modulus_gpa: f64,
    /// (-) Poisson's ratio.
    pub poisson_ratio: f64,
    /// (kg/m³) Density.
    pub density_kg_per_m3: f64,
}

keys! {
    MaterialConstants = Self { youngs_modulus_gpa: f64::NAN, poisson_ratio: f64::NAN, density_kg_per_m3: f64::NAN };
    youngs_modulus_gpa "GPa" "Young's modulus" .required().range(Range::positive().implausible_above(2e3));
    poisson_ratio "-" "Poisson's ratio"
        .required()
        .range(Range::between(Excluded(-1.0), Excluded(0.5)).message("must be more than −1 and less than 0.5"));
    density_kg_per_m3 "kg/m³" "the density" .required().range(Range::positive().implausible_above(1e5));
}

/// Names of the materials in the scenario file, in the order of [`Material::ALL`].
const NAMES: [&str; 6] = ["steel", "copper", "aluminium", "brass", "cast-iron", "bronze"];

/// One of the names, or a table of constants.
impl KeyValue for Material {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        if value.is_table() {
            let mut constants = MaterialConstants::start();
            constants.read(value, files)?;
            *self = Self::Given(constants);
        } else {
            *self = Self::ALL[value.one_of(&NAMES)?];
        }
        Ok(())
    }

    fn write(&self) -> Written {
        match self {
            Self::Given(constants) => constants.write(),
            named => Written::Value(format!("\"{}\"", named.name())),
        }
    }

    fn check(&self, key: &str, _range: &Range, _unit: &str) -> Check {
        match self {
            Self::Given(constants) => check_keys(constants, key),
            _ => Ok(()),
        }
    }

    fn kind() -> KeyKind {
        KeyKind::NameOrTable(NAMES.to_vec())
    }

    fn inside(&self) -> Vec<KeyDescription> {
        describe::<MaterialConstants>()
    }
}

impl Material {
    /// Every material, in the order of the documentation.
    pub const ALL: [Self; 6] =
        [Self::Steel, Self::Copper, Self::Aluminium, Self::Brass, Self::CastIron, Self::Bronze];

    /// The name in the scenario file; `given` of one that has its constants in place of a name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().zip(NAMES).find(|(named, _)| **named == self).map_or("given", |(_, name)| name)
    }

    /// (MPa = N/mm²) Young's modulus.
    pub fn youngs_modulus_mpa(self) -> f64 {
        match self {
            Self::Steel => 210e3,
            Self::Copper => 120e3,
            Self::Aluminium => 70e3,
            Self::Brass | Self::Bronze => 110e3,
            Self::CastIron => 140e3,
            Self::Given(constants) => constants.youngs_modulus_gpa * 1e3,
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
            Self::Given(constants) => constants.poisson_ratio,
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
            Self::Given(constants) => constants.density_kg_per_m3,
        }
    }

    /// (MPa) Shear modulus `G = E/(2(1+ν))`.
    pub fn shear_modulus_mpa(self) -> f64 {
        self.youngs_modulus_mpa() / (2.0 * (1.0 + self.poisson_ratio()))
    }
}
