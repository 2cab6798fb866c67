//! Spalls of a rolling bearing: what the scenario says of them, and by how much an element drops into one.

use meshtone_toml::{ReadResult, TomlTable};

use super::BearingGeometry;
use crate::error::ScenarioError;
use crate::keys::{Keys, NoFiles, Range, by_name, keys, read_keys};

/// Part of a bearing that has a defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DefectPlace {
    /// The race of the outer ring, which stands still.
    #[default]
    Outer,
    /// The race of the inner ring, which turns with the shaft.
    Inner,
    /// One of the balls or rollers.
    Element,
}

by_name!(DefectPlace, ["outer" => DefectPlace::Outer, "inner" => DefectPlace::Inner, "element" => DefectPlace::Element]);

impl DefectPlace {
    /// The name of a spall there among the kinds of damage.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Outer => "outer-race",
            Self::Inner => "inner-race",
            Self::Element => "rolling-element",
        }
    }
}

/// A defect of a rolling bearing: a spall.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct BearingDefect {
    /// Part of the bearing that has it.
    pub race: DefectPlace,
    /// (-) Width of the spall as a part of the diameter of an element, in place of `width_mm`.
    pub severity: Option<f64>,
    /// (mm) Width of the spall along the path of the elements, or around an element.
    pub width_mm: Option<f64>,
    /// (µm) Depth of the spall. Default 100. An element does not drop deeper than the edges of the spall let it.
    pub depth_um: f64,
    /// (°) From the direction of the bearing's static load to the middle of the spall, positive about z; of the inner race at the start.
    pub angle_deg: f64,
}

impl BearingDefect {
    /// A defect of a severity.
    ///
    /// # Arguments
    /// * `race` - the part that has it
    /// * `severity` - (-) width of the spall as a part of the diameter of an element, more than 0, at most 1
    pub fn new(race: DefectPlace, severity: f64) -> Self {
        Self { race, severity: Some(severity), ..Self::start() }
    }

    /// Reads a defect; its sizes are checked with its bearing.
    ///
    /// # Arguments
    /// * `table` - its section
    ///
    /// # Errors
    /// A missing key, a value of the wrong type.
    pub fn from_table(table: &TomlTable<'_>) -> ReadResult<Self> {
        let mut defect = Self::start();
        read_keys(&mut defect, table, &NoFiles).map(|()| defect)
    }
}

/// (-) A severity that stands for nothing is no defect.
const SEVERITY: Range = Range::between(std::ops::Bound::Excluded(0.0), std::ops::Bound::Included(1.0));

keys! {
    BearingDefect = Self { race: DefectPlace::Outer, severity: None, width_mm: None, depth_um: 100.0, angle_deg: 0.0 };
    race "" "the part with the spall: a race, or one of the balls or rollers" .required();
    severity "-" "the width of the spall as a fraction of the diameter of an element"
        .otherwise("required, unless width_mm is given").range(SEVERITY).alternative("0.25");
    width_mm "mm" "the width of the spall along the path of the elements"
        .otherwise("required, unless severity is given").range(Range::positive())
        .rule("at most the diameter of an element, and on the inner race the spacing of the elements")
        .alternative("1.0");
    depth_um "µm" "the depth of the spall; an element drops at most until it touches both edges"
        .range(Range::positive().implausible_above(1e5));
    angle_deg "°"
        "the angle from the static load of the bearing to the middle of the spall, about z; on the inner race at time 0, before settling"
        .range(Range::from_to(-360.0, 360.0));
}

/// A spall with its sizes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Spall {
    /// Part of the bearing that has it.
    pub place: DefectPlace,
    /// (mm) Width along the path of the elements, or around an element.
    pub width_mm: f64,
    /// (µm) By how much an element drops at most: down to the depth, or until it touches both edges.
    pub drop_um: f64,
    /// (°) From the direction of the static load to its middle, of the inner race at the start.
    pub angle_deg: f64,
    /// (-) Width over the diameter of an element.
    pub severity: f64,
}

impl Spall {
    /// A defect with the sizes that its bearing gives it.
    ///
    /// # Arguments
    /// * `defect` - as the scenario says it
    /// * `geometry` - of its bearing
    ///
    /// # Errors
    /// Neither or both of width and severity; a spall wider than an element. The key is that within the defect.
    pub(crate) fn new(defect: &BearingDefect, geometry: &BearingGeometry) -> Result<Self, ScenarioError> {
        let element_mm = geometry.element_mm;
        let width_mm = match (defect.width_mm, defect.severity) {
            (Some(width_mm), None) => width_mm,
            (None, Some(severity)) => severity * element_mm,
            (Some(width_mm), Some(_)) => {
                let problem = "given beside severity, which states the width too";
                return Err(
                    ScenarioError::new("width_mm", width_mm, problem).with_help("remove one of the two")
                );
            }
            (None, None) => {
                let problem = "missing; a spall needs a width_mm, or a severity above 0 and up to 1";
                return Err(ScenarioError::new("width_mm", "", problem));
            }
        };
        // Two elements are never in one spall.
        let contact_mm = element_mm * geometry.contact_angle_deg.to_radians().cos();
        let spacing_mm = |race_mm: f64| std::f64::consts::PI * race_mm / f64::from(geometry.elements);
        let (largest_mm, what) = match defect.race {
            DefectPlace::Inner if spacing_mm(geometry.pitch_mm - contact_mm) < element_mm => {
                (spacing_mm(geometry.pitch_mm - contact_mm), "the spacing of the elements on the inner race")
            }
            _ => (element_mm, "the diameter of an element"),
        };
        if width_mm > largest_mm {
            // Rounded down, but not by what a number of four decimals is off in binary.
            let largest_mm = (1e4 * largest_mm + 1e-6).floor() / 1e4;
            return Err(match defect.severity {
                Some(severity) => {
                    let most = (1e3 * largest_mm / element_mm).floor() / 1e3;
                    let problem = format!("must be at most {most}, which is {largest_mm} mm, {what}");
                    ScenarioError::new("severity", severity, problem)
                }
                None => ScenarioError::new(
                    "width_mm",
                    width_mm,
                    format!("must be at most {largest_mm} mm, {what}"),
                ),
            });
        }
        if defect.race == DefectPlace::Element && defect.angle_deg != 0.0 {
            let problem = "has no effect on a rolling element, which starts at a random angle";
            return Err(ScenarioError::new("angle_deg", defect.angle_deg, problem).with_help("remove it"));
        }
        let radius_mm = element_mm / 2.0;
        let both_edges_mm = radius_mm - (radius_mm * radius_mm - width_mm * width_mm / 4.0).max(0.0).sqrt();
        Ok(Self {
            place: defect.race,
            width_mm,
            drop_um: defect.depth_um.min(both_edges_mm * 1e3),
            angle_deg: defect.angle_deg,
            severity: width_mm / element_mm,
        })
    }
}

/// By how much an element drops into a spall on its way: over each edge on a circle around that, and flat between them.
///
/// At a distance x from the nearer edge an element of radius r, whose middle stands on a circle around the edge, has dropped by
/// `r − √(r² − x²)`, and at most by the depth. Where it touches both edges before it touches the bottom the two circles meet in the middle.
/// Elements have no mass here: one that drops deeper than it is pressed is unloaded near the first edge and loaded again near the last, and is not heard
/// in between.
///
/// Source: N. Sawalhi, R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846–870, on the events of entry and impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drop {
    half_width_m: f64,
    radius_m: f64,
    deepest_m: f64,
}

impl Drop {
    pub(super) fn new(spall: &Spall, geometry: &BearingGeometry) -> Self {
        Self {
            half_width_m: spall.width_mm * 0.5e-3,
            radius_m: geometry.element_mm * 0.5e-3,
            deepest_m: spall.drop_um * 1e-6,
        }
    }

    /// (m) How deep an element has dropped.
    ///
    /// # Arguments
    /// * `from_middle_m` - (m) its way from the middle of the spall
    pub(super) fn at_m(&self, from_middle_m: f64) -> f64 {
        let from_edge_m = (self.half_width_m - from_middle_m.abs()).max(0.0);
        let on_circle_m = self.radius_m - (self.radius_m.powi(2) - from_edge_m.powi(2)).max(0.0).sqrt();
        on_circle_m.min(self.deepest_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spall(width_mm: f64, depth_um: f64) -> Spall {
        let geometry = BearingGeometry::new(9, 7.94, 39.04, 0.0).unwrap();
        let defect = BearingDefect { width_mm: Some(width_mm), depth_um, ..BearingDefect::start() };
        Spall::new(&defect, &geometry).unwrap()
    }

    /// A ball of 7.94 mm over 1 mm drops by 31.6 µm.
    #[test]
    fn narrow_spalls_limit_the_drop() {
        assert!((spall(1.0, 100.0).drop_um - 31.6).abs() < 0.05);
        assert_eq!(spall(1.0, 10.0).drop_um, 10.0);
        assert_eq!(spall(4.0, 100.0).drop_um, 100.0);
    }

    #[test]
    fn elements_drop_over_the_edges_and_stay_flat_between_them() {
        let geometry = BearingGeometry::new(9, 7.94, 39.04, 0.0).unwrap();
        let wide = Drop::new(&spall(4.0, 50.0), &geometry);
        assert_eq!([wide.at_m(2e-3), wide.at_m(-3e-3)], [0.0, 0.0]);
        assert!((wide.at_m(0.0) - 50e-6).abs() < 1e-15);
        // On a circle around the edge: 1 mm behind it r − √(r² − 1), and at √(r² − (r − e)²) as deep as the spall.
        let on_circle_m = 1e-3 * (3.97 - f64::sqrt(3.97f64.powi(2) - 0.5f64.powi(2)));
        assert!((wide.at_m(1.5e-3) - on_circle_m).abs() < 1e-15);
        let edge_m = f64::sqrt(3.97e-3f64.powi(2) - (3.97e-3f64 - 50e-6).powi(2));
        assert!((wide.at_m(2e-3 - edge_m) - 50e-6).abs() < 1e-12);
        // A narrow one has its kink in the middle, where both edges are touched.
        let narrow = spall(1.0, 100.0);
        let drop = Drop::new(&narrow, &geometry);
        assert!((drop.at_m(0.0) - narrow.drop_um * 1e-6).abs() < 1e-12);
        let slope = (drop.at_m(0.0) - drop.at_m(1e-6)) / 1e-6;
        assert!((slope - 0.5 / (3.97f64.powi(2) - 0.25).sqrt()).abs() < 1e-3, "{slope}");
    }
}
