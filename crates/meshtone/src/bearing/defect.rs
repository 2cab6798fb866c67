//! Spalls of a rolling bearing: what the scenario says of them, and by how much an element drops into one.

use meshtone_toml::{ReadResult, TomlTable};
use serde::Serialize;

use super::BearingGeometry;
use crate::error::ScenarioError;
use crate::keys::{Keys, NoFiles, Range, by_name, keys, read_keys};

/// Part of a bearing that has a defect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
#[serde(rename_all = "lowercase")]
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
    /// (°) From the direction of the bearing's static load to the middle of the spall, positive about z; of a race that turns (the inner one, of a planet the outer one) at the start.
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Spall {
    /// Part of the bearing that has it.
    #[serde(rename = "race")]
    pub place: DefectPlace,
    /// (mm) Width along the path of the elements, or around an element.
    pub width_mm: f64,
    /// (µm) By how much an element drops at most: down to the depth, or until it touches both edges.
    pub drop_um: f64,
    /// (°) From the direction of the static load to its middle; of a race that turns, at the start.
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

/// How an element crosses a spall.
///
/// At a distance x from the nearer edge its middle, on a circle around the edge, has dropped by `r − √(r² − x²)`, and at most by the depth: so far does the
/// spall let it, and so deep the other race must follow to press it.
///
/// It follows the first edge only as long as it is pressed, over `l = √(2 r δ)`, and as the middle between two contacts moves half as far as they
/// do, it leaves with the slope `l / 2r`. From there it flies. Seen from the race its path bends by `q`, 1/R of the outer one of radius R, which
/// curves away from it, however fast it goes: a fifth of the `1/r` that the circle asks for. It strikes the other edge
/// or the bottom, each time by the slope that its path then changes.
///
/// Source: N. Sawalhi, R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846–870, on the events of entry and impact; there the element follows both
/// circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crossing {
    pub(super) half_width_m: f64,
    radius_m: f64,
    deepest_m: f64,
    /// (1/m) q.
    flight_per_m: f64,
}

/// A strike of an element against an edge or the bottom of a spall.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Strike {
    /// (m) From the first edge.
    pub(super) at_m: f64,
    /// (-) By how much the slope of the element's path changes.
    pub(super) bend: f64,
}

impl Crossing {
    pub(super) fn new(spall: &Spall, geometry: &BearingGeometry) -> Self {
        let contact_mm = geometry.element_mm * geometry.contact_angle_deg.to_radians().cos();
        let [outer_mm, inner_mm] = [1.0, -1.0].map(|side| (geometry.pitch_mm + side * contact_mm) / 2.0);
        let flight_per_mm = match spall.place {
            DefectPlace::Outer => 1.0 / outer_mm,
            // The cage turns slower than the race turns away from it, by the ratio of the radii.
            DefectPlace::Inner => -inner_mm / (outer_mm * outer_mm),
            // To the outer race and away from the inner one, in turn.
            DefectPlace::Element => 0.0,
        };
        Self {
            half_width_m: spall.width_mm * 0.5e-3,
            radius_m: geometry.element_mm * 0.5e-3,
            deepest_m: spall.drop_um * 1e-6,
            flight_per_m: flight_per_mm * 1e3,
        }
    }

    /// The strikes of an element, on circles that are taken as parabolas.
    ///
    /// # Arguments
    /// * `pressed_m` - (m) by how much it is pressed together beside the spall
    pub(super) fn strikes(&self, pressed_m: f64) -> [Strike; 2] {
        let (width_m, radius_m, flight) = (2.0 * self.half_width_m, self.radius_m, self.flight_per_m);
        let bottom_m = (2.0 * radius_m * self.deepest_m).sqrt();
        let held_m = (2.0 * radius_m * pressed_m.max(0.0)).sqrt();
        let lowest_m = bottom_m.min(self.half_width_m);
        let slope = |way_m: f64| way_m / radius_m;
        if held_m >= lowest_m {
            // It is pressed throughout: its middle moves half as far as the race lets it.
            return [lowest_m, width_m - lowest_m].map(|at_m| Strike { at_m, bend: slope(lowest_m) / 2.0 });
        }
        // Where a path of `l² + l s + q r s²`, 2 r times the drop on the way s of the flight, meets what is on its way: the smaller root.
        let meets_m = |square: f64, linear: f64, constant: f64| {
            let discriminant = linear * linear - 4.0 * square * constant;
            let root_m = 2.0 * constant / (linear + discriminant.sqrt());
            if root_m.is_finite() { root_m } else { f64::INFINITY }
        };
        let rest_m = width_m - held_m;
        let to_edge_m =
            meets_m(1.0 - flight * radius_m, held_m + 2.0 * rest_m, rest_m * rest_m - held_m * held_m);
        let to_bottom_m = meets_m(-flight * radius_m, held_m, bottom_m * bottom_m - held_m * held_m);
        // Where it flies back to the other race and rolls on to where that presses it against the edge.
        let to_other_m = if flight < 0.0 { -slope(held_m) / flight } else { f64::INFINITY };
        let fallen = |way_m: f64| slope(held_m) / 2.0 + flight * way_m;
        if to_other_m <= to_edge_m.min(to_bottom_m) {
            [Strike { at_m: rest_m, bend: slope(held_m) / 2.0 }, Strike::default()]
        } else if to_bottom_m < to_edge_m {
            let landing = Strike { at_m: held_m + to_bottom_m, bend: fallen(to_bottom_m) };
            [landing, Strike { at_m: width_m - bottom_m, bend: slope(bottom_m) }]
        } else {
            let bend = fallen(to_edge_m) + slope(rest_m - to_edge_m);
            [Strike { at_m: held_m + to_edge_m, bend }, Strike::default()]
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
        let wide = Crossing::new(&spall(4.0, 50.0), &geometry);
        assert_eq!([wide.at_m(2e-3), wide.at_m(-3e-3)], [0.0, 0.0]);
        assert!((wide.at_m(0.0) - 50e-6).abs() < 1e-15);
        // On a circle around the edge: 1 mm behind it r − √(r² − 1), and at √(r² − (r − e)²) as deep as the spall.
        let on_circle_m = 1e-3 * (3.97 - f64::sqrt(3.97f64.powi(2) - 0.5f64.powi(2)));
        assert!((wide.at_m(1.5e-3) - on_circle_m).abs() < 1e-15);
        let edge_m = f64::sqrt(3.97e-3f64.powi(2) - (3.97e-3f64 - 50e-6).powi(2));
        assert!((wide.at_m(2e-3 - edge_m) - 50e-6).abs() < 1e-12);
        // A narrow one has its kink in the middle, where both edges are touched.
        let narrow = spall(1.0, 100.0);
        let drop = Crossing::new(&narrow, &geometry);
        assert!((drop.at_m(0.0) - narrow.drop_um * 1e-6).abs() < 1e-12);
        let slope = (drop.at_m(0.0) - drop.at_m(1e-6)) / 1e-6;
        assert!((slope - 0.5 / (3.97f64.powi(2) - 0.25).sqrt()).abs() < 1e-3, "{slope}");
    }

    fn crossing(place: DefectPlace, width_mm: f64, depth_um: f64) -> Crossing {
        let geometry = BearingGeometry::new(8, 7.9375, 33.5026, 0.0).unwrap();
        let spall = Spall { place, ..spall(width_mm, depth_um) };
        Crossing::new(&spall, &geometry)
    }

    /// A ball of an ER-10K with its mass between both contacts of a loaded ring of 1 kg, solved in steps of 0.2 µs by another program, first strikes the
    /// far edge of a deep spall of the outer race at these parts of the width.
    #[test]
    fn a_ball_flies_to_the_far_edge_as_in_an_independent_solution() {
        for (load_n, width_mm, at, blow) in [
            (90.0, 2.0, 0.648, 1.3e-3),
            (90.0, 3.0, 0.664, 1.8e-3),
            (200.0, 2.0, 0.628, 1.4e-3),
            (200.0, 3.0, 0.650, 1.9e-3),
            (400.0, 2.0, 0.602, 1.5e-3),
            (400.0, 3.0, 0.630, 2.0e-3),
        ] {
            let pressed_m = f64::powf(load_n / 8e9, 2.0 / 3.0);
            let [strike, none] = crossing(DefectPlace::Outer, width_mm, 1e3).strikes(pressed_m);
            let found = strike.at_m / width_mm * 1e3;
            println!("{load_n} N, {width_mm} mm: {found:.3}, {at}");
            assert!((found - at).abs() < 0.025 && none == Strike::default());
            // With other losses at the contact.
            let momentum = 1.5 * 2.055e-3 * 1.490 * strike.bend;
            assert!((0.8..1.0).contains(&(momentum / blow)), "{momentum:.2e} {blow:.2e}");
        }
    }

    #[test]
    fn strikes_have_their_limits() {
        // Without load it flies straight: √(w − x) is to √x as the radii of the ball and the race.
        let [free, _] = crossing(DefectPlace::Outer, 2.0, 1e3).strikes(-1e-6);
        let outer_mm: f64 = (33.5026 + 7.9375) / 2.0;
        let expected_m = 2e-3 / (1.0 + (3.97 / outer_mm).sqrt());
        assert!((free.at_m / expected_m - 1.0).abs() < 0.01, "{}", free.at_m);
        // From the inner race it flies off.
        assert_eq!(crossing(DefectPlace::Inner, 2.0, 1e3).strikes(-1e-6)[0].bend, 0.0);
        // Pressed as deep as it can drop it follows the edges: one kink in the middle, or one at each end of the bottom, of half the slope of the edges.
        let [first, last] = crossing(DefectPlace::Outer, 1.0, 1e3).strikes(1e-4);
        assert_eq!([first.at_m, last.at_m], [0.5e-3, 0.5e-3]);
        assert!((first.bend + last.bend - 0.5 / 3.96875).abs() < 1e-12);
        let [first, last] = crossing(DefectPlace::Outer, 4.0, 5.0).strikes(1e-4);
        assert!((first.at_m - f64::sqrt(2.0 * 3.96875e-3 * 5e-6)).abs() < 1e-9 && first.bend == last.bend);
        // Shallow ones have a bottom to land on, from which it meets the far edge later.
        let [landing, edge] = crossing(DefectPlace::Outer, 4.0, 50.0).strikes(5e-6);
        assert!(landing.at_m < 2e-3 && edge.at_m > 3e-3 && landing.bend > 0.0 && edge.bend > landing.bend);
    }
}
