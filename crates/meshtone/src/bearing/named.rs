//! Bearings whose geometry is published.

use super::{BearingGeometry, RollingElement};

/// A bearing by name.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct NamedBearing {
    /// Its designation.
    pub name: &'static str,
    /// Kind of its elements.
    pub element: RollingElement,
    /// Its geometry; that of another maker's bearing of the same designation may differ.
    pub geometry: BearingGeometry,
    /// The publication that states the geometry.
    pub source: &'static str,
}

/// (mm) An inch.
const INCH: f64 = 25.4;

const fn named(
    name: &'static str,
    (elements, element_mm, pitch_mm, contact_angle_deg): (u32, f64, f64, f64),
    source: &'static str,
) -> NamedBearing {
    let geometry = BearingGeometry { elements, element_mm, pitch_mm, contact_angle_deg };
    NamedBearing { name, element: RollingElement::Ball, geometry, source }
}

/// The bearings of public recordings, as far as the publications state their geometry.
pub const NAMED_BEARINGS: [NamedBearing; 6] = [
    named(
        "6203",
        (8, 0.2656 * INCH, 1.122 * INCH, 0.0),
        "Case Western Reserve University Bearing Data Center, bearing information, fan end, SKF 6203-2RS JEM",
    ),
    named(
        "6205",
        (9, 7.94, 39.04, 0.0),
        "Case Western Reserve University Bearing Data Center, bearing information, drive end, SKF 6205-2RS JEM: 0.3126 and 1.537 inches",
    ),
    named(
        "ER-10K",
        (8, 0.3125 * INCH, 1.319 * INCH, 0.0),
        "PHM Society, data challenge 2009, apparatus: MB Manufacturing ER-10K",
    ),
    named(
        "ER-16K",
        (9, 7.94, 38.52, 0.0),
        "H. Huang, N. Baddour, Data in Brief 21 (2018) 1745–1749, table 1: MB Manufacturing ER16K",
    ),
    named(
        "UER204",
        (8, 7.92, 34.55, 0.0),
        "B. Wang, Y. Lei, N. Li, N. Li, IEEE Trans. Reliability 69 (2020) 401–412: LDK UER204",
    ),
    NamedBearing {
        element: RollingElement::Roller,
        ..named(
            "ZA-2115",
            (16, 0.331 * INCH, 2.815 * INCH, 15.17),
            "H. Qiu, J. Lee, J. Lin, G. Yu, J. Sound Vib. 289 (2006) 1066–1090: Rexnord ZA-2115, one of two rows",
        )
    },
];

impl NamedBearing {
    /// The bearing of a name, whatever its capitals and hyphens.
    ///
    /// # Arguments
    /// * `name` - such as `6205` or `er10k`
    pub fn find(name: &str) -> Option<&'static Self> {
        let plain = |name: &str| {
            name.chars()
                .filter(|letter| !matches!(letter, '-' | ' '))
                .collect::<String>()
                .to_ascii_lowercase()
        };
        NAMED_BEARINGS.iter().find(|known| plain(known.name) == plain(name))
    }
}
