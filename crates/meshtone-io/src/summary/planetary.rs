//! The planetary sets in the summary of a simulation.

use meshtone::scenario::{PlanetarySet, SetOrders};
use serde::Serialize;

/// A planetary set of a gearbox.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SetSummary {
    /// Its name.
    pub name: String,
    /// The orders at which its events repeat.
    pub orders_per_carrier_revolution: SetOrders,
}

impl SetSummary {
    /// The main numbers of a set.
    pub(super) fn new(set: &PlanetarySet) -> Self {
        let orders_per_carrier_revolution = set.teeth.orders(set.planet_angles_rad().len());
        Self { name: set.name.clone(), orders_per_carrier_revolution }
    }
}
