//! The rolling bearings in the summary of a simulation.

use meshtone::bearing::{DefectOrders, RollingBearing, Spall};
use serde::Serialize;

/// A rolling bearing of a gearbox.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BearingSummary {
    /// Name of its seat: shaft and place, such as `input:0`.
    pub at: String,
    /// Kind of its elements.
    pub kind: &'static str,
    /// (N) Its radial load that holds the nominal torque.
    pub static_load_n: f64,
    /// (N/m) Its stiffness along that load, averaged over the places of the cage.
    pub stiffness_n_per_m: f64,
    /// Orders of its shaft at which defects show, without slip.
    pub orders: DefectOrders,
    /// Its spalls.
    pub defects: Vec<Spall>,
}

impl BearingSummary {
    /// The main numbers of a bearing.
    ///
    /// # Arguments
    /// * `at` - name of its seat
    /// * `bearing` - with its load
    pub(super) fn new(at: String, bearing: &RollingBearing) -> Self {
        let parts = &bearing.parts;
        let [x_n, y_n] = bearing.static_load_n;
        Self {
            at,
            kind: parts.contact.element.name(),
            static_load_n: x_n.hypot(y_n),
            stiffness_n_per_m: bearing.stiffness_n_per_m,
            orders: parts.geometry.defect_orders(),
            defects: parts.spalls.clone(),
        }
    }
}
