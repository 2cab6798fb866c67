//! The sections of the scenario file and their keys.

use super::{Gears, Model, Operation, Quality, Rig, Scenario, Sensor, Solver};
use crate::damage::keys_of_every_fault;
use crate::keys::{KeyDescription, KeyRow, Keys, describe, field, row};

/// The keys at the top level, above the sections.
impl Keys for Scenario {
    fn start() -> Self {
        Self {
            model: Model::default(),
            seed: 1,
            gears: Gears::start(),
            operation: Operation::start(),
            quality: Quality::start(),
            faults: Vec::new(),
            rig: Rig::start(),
            sensors: Vec::new(),
            solver: Solver::start(),
        }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row(
                "model",
                "",
                "the model: teeth that touch and separate, a linear mesh that is always closed, or the published code with its known errors",
                field!(model),
            ),
            row(
                "seed",
                "",
                "the seed of every random draw: profile errors, fluctuations, roughness of a destroyed flank, sensors' noise",
                field!(seed),
            ),
        ]
    }
}

/// A section of the scenario file, for documentation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SectionDescription {
    /// Its name; empty for the keys above the sections.
    pub name: &'static str,
    /// Its keys; of `fault`, those of every kind of damage beside `kind`.
    pub keys: Vec<KeyDescription>,
}

/// The sections of the scenario file, in order.
///
/// ```
/// let sections = meshtone::scenario::sections();
/// let gears = sections.iter().find(|section| section.name == "gears").unwrap();
/// let module = &gears.keys[0];
/// assert_eq!((module.key.as_str(), module.unit, module.required), ("module_mm", "mm", true));
/// assert_eq!(module.allowed, "> 0, ≤ 100");
/// ```
pub fn sections() -> Vec<SectionDescription> {
    let section = |name, keys| SectionDescription { name, keys };
    vec![
        section("", describe::<Scenario>()),
        section("gears", describe::<Gears>()),
        section("operation", describe::<Operation>()),
        section("quality", describe::<Quality>()),
        section("fault", keys_of_every_fault()),
        section("rig", describe::<Rig>()),
        section("sensor", describe::<Sensor>()),
        section("solver", describe::<Solver>()),
    ]
}
