//! The rolling bearings in the summary of a simulation.

use meshtone::bearing::{RollingBearing, Spall};
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
    pub orders: BearingOrders,
    /// Its spalls.
    pub defects: Vec<DefectSummary>,
}

/// Orders at which the defects of a bearing show.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BearingOrders {
    /// The cage turns.
    pub ftf: f64,
    /// Elements pass a place of the outer race.
    pub bpfo: f64,
    /// Elements pass a place of the inner race.
    pub bpfi: f64,
    /// An element turns about itself.
    pub bsf: f64,
}

/// A spall of a rolling bearing.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DefectSummary {
    /// Part that has it.
    pub race: &'static str,
    /// (mm) Its width along the path of the elements.
    pub width_mm: f64,
    /// (µm) By how much an element drops into it at most.
    pub drop_um: f64,
    /// (°) From the direction of the static load to its middle; of a race that turns, at the start.
    pub angle_deg: f64,
    /// (-) Its width over the diameter of an element.
    pub severity: f64,
}

impl BearingSummary {
    /// The main numbers of a bearing.
    ///
    /// # Arguments
    /// * `at` - name of its seat
    /// * `bearing` - with its load
    pub(super) fn new(at: String, bearing: &RollingBearing) -> Self {
        let parts = &bearing.parts;
        let orders = parts.geometry.defect_orders();
        let [x_n, y_n] = bearing.static_load_n;
        let defect = |spall: &Spall| DefectSummary {
            race: spall.place.name(),
            width_mm: spall.width_mm,
            drop_um: spall.drop_um,
            angle_deg: spall.angle_deg,
            severity: spall.severity,
        };
        Self {
            at,
            kind: parts.contact.element.name(),
            static_load_n: x_n.hypot(y_n),
            stiffness_n_per_m: bearing.stiffness_n_per_m,
            orders: BearingOrders {
                ftf: orders.cage,
                bpfo: orders.outer_race,
                bpfi: orders.inner_race,
                bsf: orders.element_spin,
            },
            defects: parts.spalls.iter().map(defect).collect(),
        }
    }
}
