//! The geometry of a rolling bearing, and the orders at which its defects show.

use std::fmt;

use serde::Serialize;

use super::DefectPlace;

/// Fewest and most rolling elements.
const ELEMENTS: [u32; 2] = [3, 200];

/// Geometry of a rolling bearing, as far as its defect orders depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingGeometry {
    /// Number of balls or rollers, of one row.
    pub elements: u32,
    /// (mm) Diameter of a ball or roller, of a tapered one its mean.
    pub element_mm: f64,
    /// (mm) Diameter of the circle through the centres of the elements.
    pub pitch_mm: f64,
    /// (°) Contact angle; 0 for a deep-groove ball bearing or cylindrical rollers under radial load.
    pub contact_angle_deg: f64,
}

/// Orders at which the defects of a bearing show, in orders of the shaft in its inner ring. The outer ring stands still.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DefectOrders {
    /// Fundamental train frequency (FTF): the cage turns.
    #[serde(rename = "ftf")]
    pub cage: f64,
    /// Ball pass frequency of the outer race (BPFO): the elements pass a place of the outer race.
    #[serde(rename = "bpfo")]
    pub outer_race: f64,
    /// Ball pass frequency of the inner race (BPFI): the elements pass a place of the inner race.
    #[serde(rename = "bpfi")]
    pub inner_race: f64,
    /// Ball spin frequency (BSF): an element turns about itself. A place on it meets a race twice a turn, so that its line is at 2 BSF.
    #[serde(rename = "bsf")]
    pub element_spin: f64,
}

impl DefectOrders {
    /// Order of the first line of a defect: BPFO, BPFI, or of an element 2 BSF.
    ///
    /// # Arguments
    /// * `place` - the part that has the defect
    pub fn of_defect(&self, place: DefectPlace) -> f64 {
        match place {
            DefectPlace::Outer => self.outer_race,
            DefectPlace::Inner => self.inner_race,
            DefectPlace::Element => 2.0 * self.element_spin,
        }
    }
}

/// A geometry that no bearing has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingError {
    /// Name of the value.
    pub name: &'static str,
    /// The value.
    pub value: f64,
    /// What is allowed.
    pub allowed: &'static str,
}

impl std::error::Error for BearingError {}

impl fmt::Display for BearingError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} is {}; must be {}", self.name, self.value, self.allowed)
    }
}

impl BearingGeometry {
    /// Checks a geometry.
    ///
    /// # Arguments
    /// * `elements` - number of balls or rollers, 3 to 200
    /// * `element_mm` - (mm) their diameter
    /// * `pitch_mm` - (mm) pitch diameter, more than that of an element
    /// * `contact_angle_deg` - (°) contact angle, 0 to below 90
    ///
    /// # Errors
    /// Values out of these ranges; elements that have no room beside each other.
    pub fn new(
        elements: u32,
        element_mm: f64,
        pitch_mm: f64,
        contact_angle_deg: f64,
    ) -> Result<Self, BearingError> {
        if !(ELEMENTS[0]..=ELEMENTS[1]).contains(&elements) {
            let allowed = "3 to 200, the number of rolling elements";
            return Err(refused("elements", f64::from(elements), allowed));
        }
        for (name, length_mm) in [("element_mm", element_mm), ("pitch_mm", pitch_mm)] {
            if !(length_mm > 0.0 && length_mm.is_finite()) {
                return Err(refused(name, length_mm, "more than 0 and finite"));
            }
        }
        if !(0.0..90.0).contains(&contact_angle_deg) {
            return Err(refused("contact_angle_deg", contact_angle_deg, "0 to below 90"));
        }
        // The chord between two neighbours on the pitch circle.
        if element_mm > pitch_mm * (std::f64::consts::PI / f64::from(elements)).sin() {
            let allowed = "so small that all elements have room on the pitch circle; it comes before the pitch diameter";
            return Err(refused("element_mm", element_mm, allowed));
        }
        Ok(Self { elements, element_mm, pitch_mm, contact_angle_deg })
    }

    /// Defect orders, for rolling without slip.
    ///
    /// With `γ = d cos α / D` of Z elements of diameter d on the pitch diameter D: FTF = (1 − γ)/2, BPFO = Z (1 − γ)/2, BPFI = Z (1 + γ)/2 and
    /// BSF = D (1 − γ²)/(2 d). Slip moves them by up to some 1 or 2 %.
    ///
    /// Source: R. B. Randall, J. Antoni, "Rolling element bearing diagnostics – a tutorial", Mech. Syst. Signal Process. 25 (2011) 485–520,
    /// equations 1 to 4.
    ///
    /// ```
    /// let bearing = meshtone::bearing::BearingGeometry::new(9, 7.94, 39.04, 0.0)?;
    /// let orders = bearing.defect_orders();
    /// assert!((orders.outer_race - 3.58478).abs() < 1e-5 && (orders.element_spin - 2.35675).abs() < 1e-5);
    /// # Ok::<(), meshtone::bearing::BearingError>(())
    /// ```
    pub fn defect_orders(&self) -> DefectOrders {
        let elements = f64::from(self.elements);
        let ratio = self.element_mm / self.pitch_mm;
        let gamma = ratio * self.contact_angle_deg.to_radians().cos();
        DefectOrders {
            cage: 0.5 * (1.0 - gamma),
            outer_race: 0.5 * elements * (1.0 - gamma),
            inner_race: 0.5 * elements * (1.0 + gamma),
            element_spin: 0.5 / ratio * (1.0 - gamma * gamma),
        }
    }
}

fn refused(name: &'static str, value: f64, allowed: &'static str) -> BearingError {
    BearingError { name, value, allowed }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bearing::{NAMED_BEARINGS, NamedBearing};

    fn orders(name: &str) -> DefectOrders {
        NamedBearing::find(name).unwrap_or_else(|| panic!("{name}")).geometry.defect_orders()
    }

    fn near(found: f64, stated: f64, tolerance: f64) {
        assert!((found - stated).abs() <= tolerance, "{found} {stated}");
    }

    #[test]
    fn orders_of_bearings_whose_geometry_is_published() {
        let of_6205 = orders("6205");
        near(of_6205.cage, 0.39831, 1e-5);
        near(of_6205.outer_race, 3.58478, 1e-5);
        near(of_6205.inner_race, 5.41522, 1e-5);
        near(of_6205.element_spin, 2.35675, 1e-5);
        let er_10k = orders("er-10k");
        near(er_10k.cage, 0.38154, 1e-5);
        near(er_10k.outer_race, 3.05231, 1e-5);
        near(er_10k.inner_race, 4.94769, 1e-5);
        near(er_10k.element_spin, 1.99194, 1e-5);
    }

    // Defect frequencies that the sources of the geometries state themselves, with their digits.
    #[test]
    fn orders_agree_with_those_that_the_sources_state() {
        for (name, outer, inner, twice_spin, digits) in
            [("6205", 3.5848, 5.4152, 4.7135, 1e-4), ("6203", 3.0530, 4.9469, 3.9874, 3e-4)]
        {
            let of = orders(name);
            near(of.outer_race, outer, digits);
            near(of.inner_race, inner, digits);
            near(2.0 * of.element_spin, twice_spin, digits);
        }
        near(orders("ER-16K").outer_race, 3.57, 5e-3);
        near(orders("ER-16K").inner_race, 5.43, 5e-3);
        // 107.91 Hz at 35 Hz, and 236.4 Hz at 2000 1/min.
        near(35.0 * orders("UER204").outer_race, 107.91, 5e-3);
        near(2000.0 / 60.0 * orders("ZA-2115").outer_race, 236.4, 0.05);
    }

    #[test]
    fn impossible_bearings_are_refused() {
        let refused = |elements, element_mm, pitch_mm, angle_deg| {
            BearingGeometry::new(elements, element_mm, pitch_mm, angle_deg).unwrap_err().to_string()
        };
        assert!(refused(2, 5.0, 40.0, 0.0).starts_with("elements is 2"));
        // Count and pitch diameter exchanged with the diameter of an element.
        assert!(refused(9, 39.04, 7.94, 0.0).starts_with("element_mm is 39.04"));
        assert!(refused(9, 7.94, f64::NAN, 0.0).starts_with("pitch_mm is NaN"));
        assert!(refused(9, 7.94, 39.04, 90.0).starts_with("contact_angle_deg is 90"));
        assert!(NAMED_BEARINGS.iter().all(|NamedBearing { geometry: of, .. }| {
            BearingGeometry::new(of.elements, of.element_mm, of.pitch_mm, of.contact_angle_deg) == Ok(*of)
        }));
    }
}
