//! The planetary sets in the summary of a simulation.

use meshtone::scenario::{PlanetarySet, SetOrders};
use serde::Serialize;

/// A planetary set of a gearbox.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SetSummary {
    /// Its name.
    pub name: String,
    /// The orders of its carrier against its ring at which its events repeat.
    pub orders_of_carrier_against_ring: SetOrders,
}

impl SetSummary {
    /// The main numbers of a set.
    pub(super) fn new(set: &PlanetarySet) -> Self {
        let orders_of_carrier_against_ring = set.teeth.orders(set.planet_angles_rad().len());
        Self { name: set.name.clone(), orders_of_carrier_against_ring }
    }
}
