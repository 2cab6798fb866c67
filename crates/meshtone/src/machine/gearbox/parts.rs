//! The keys of a gearbox's shafts, bearings and housing.

use std::ops::Bound::{Excluded, Included};

use super::super::{Bow, Unbalance};
use super::housing_modes::HousingModes;
use crate::bearing::{
    BearingDefect, BearingGeometry, ElementContact, NAMED_BEARINGS, NamedBearing, RollingElement,
    RollingParts, Spall,
};
use crate::error::ScenarioError;
use crate::keys::{Keys, Range, by_name, keys};

/// A round shaft between two ends, with wheels and bearings on it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GearboxShaft {
    /// Its name.
    pub name: String,
    /// (mm) Length.
    pub length_mm: f64,
    /// (mm) z of its beginning. Default 0.
    pub start_mm: f64,
    /// (mm) Radius, also of the bores of the wheels on it; of a shaft of several radii see [`Self::segments`].
    pub radius_mm: Option<f64>,
    /// (mm) Length and radius of each piece, from its beginning on, instead of one radius. Empty: one radius.
    pub segments: Vec<[f64; 2]>,
    /// (mm) Radius of the shaft's own bore. Default 0: solid.
    pub bore_radius_mm: f64,
    /// (mm) x and y of its axis; none for the place that the meshes give it, with the centres side by side.
    pub position_mm: Option<[f64; 2]>,
    /// Number of beam elements, shared among its pieces by their length. Default 12.
    pub elements: u32,
    /// What it is coupled to at an end: the motor at its beginning, the brake at the other. Default nothing.
    pub couples_to: Coupled,
    /// (N m/rad) Torsional stiffness of that coupling. Default 2e3 of a motor's, 4e3 of a brake's.
    pub coupling_stiffness_nm_per_rad: Option<f64>,
    /// (-) Damping ratio of the shaft and its coupling. Default 0.05.
    pub damping_ratio: f64,
    /// Unbalance midway along the shaft. Default none.
    pub unbalance: Unbalance,
    /// Bow of a shaft that is not straight. Default none.
    pub bow: Bow,
}

impl GearboxShaft {
    /// A shaft of one radius, with the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(name: &str, length_mm: f64, radius_mm: f64) -> Self {
        Self { name: name.to_owned(), length_mm, radius_mm: Some(radius_mm), ..Self::start() }
    }

    /// (N m/rad) Torsional stiffness of its coupling, given or by default.
    pub fn coupling_nm_per_rad(&self) -> f64 {
        let usual = if self.couples_to == Coupled::Brake { 4e3 } else { 2e3 };
        self.coupling_stiffness_nm_per_rad.unwrap_or(usual)
    }

    /// (mm) z of a place.
    ///
    /// # Arguments
    /// * `at` - (-) the place as a part of the length
    pub fn z_mm(&self, at: f64) -> f64 {
        self.start_mm + at * self.length_mm
    }

    /// (mm) Length and radius of each piece.
    pub fn pieces_mm(&self) -> Vec<[f64; 2]> {
        match self.radius_mm {
            Some(radius_mm) if self.segments.is_empty() => vec![[self.length_mm, radius_mm]],
            _ => self.segments.clone(),
        }
    }

    /// (mm) The largest radius between two places.
    ///
    /// # Arguments
    /// * `ends_mm` - (mm) z of the places
    pub fn largest_radius_mm(&self, [from_mm, until_mm]: [f64; 2]) -> f64 {
        let mut end_mm = self.start_mm;
        let reaches = |[length_mm, radius_mm]: [f64; 2]| {
            let begins_mm = end_mm;
            end_mm += length_mm;
            if begins_mm < until_mm && end_mm > from_mm { radius_mm } else { 0.0 }
        };
        self.pieces_mm().into_iter().map(reaches).fold(0.0, f64::max)
    }

    /// (mm) Radius at a place.
    ///
    /// # Arguments
    /// * `at` - (-) the place as a part of the length
    pub fn radius_at_mm(&self, at: f64) -> f64 {
        let mut until_mm = 0.0;
        let pieces = self.pieces_mm();
        let mut reached = pieces.iter().filter(|[length_mm, _]| {
            until_mm += length_mm;
            at * self.length_mm <= until_mm * (1.0 + 1e-12)
        });
        reached.next().or(pieces.last()).map_or(0.0, |[_, radius_mm]| *radius_mm)
    }
}

/// What a shaft is coupled to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coupled {
    /// To neither motor nor brake.
    #[default]
    Nothing,
    /// To the motor, whose rotation is prescribed.
    Motor,
    /// To the brake, whose torque is prescribed.
    Brake,
}

by_name!(Coupled, ["nothing" => Coupled::Nothing, "motor" => Coupled::Motor, "brake" => Coupled::Brake]);

/// (-) A place along a shaft.
const ALONG: Range = Range::between(Included(0.0), Included(1.0))
    .message("must be from 0 to 1, the part of the shaft's length from its beginning");
const STIFFNESS: Range = Range::positive().implausible_above(1e15);
const MAYBE_STIFF: Range = Range::not_negative().implausible_above(1e15);
const MASS: Range = Range::positive().implausible_above(1e9);
const DAMPING: Range = Range::below_one().help("a bolted structure has 0.01 to 0.05");

keys! {
    "shaft": GearboxShaft = Self {
        name: String::new(),
        length_mm: f64::NAN,
        start_mm: 0.0,
        radius_mm: None,
        segments: Vec::new(),
        bore_radius_mm: 0.0,
        position_mm: None,
        elements: 12,
        couples_to: Coupled::Nothing,
        coupling_stiffness_nm_per_rad: None,
        damping_ratio: 0.05,
        unbalance: Unbalance::default(),
        bow: Bow::default(),
    };
    name "" "the shaft's name" .required().rule("no other shaft's");
    length_mm "mm" "the shaft's length" .required().range(Range::positive().implausible_above(1e5));
    start_mm "mm" "z of its beginning: shafts of one axis stand behind one another"
        .range(Range::between(Excluded(-1e5), Excluded(1e5)));
    radius_mm "mm" "its radius, also of the bores of the wheels on it"
        .otherwise("required, unless segments is given").range(Range::positive())
        .rule("less than the wheels' root radii");
    segments "mm" "the length and the radius of each piece, from its beginning on, in place of one radius"
        .otherwise("one piece of radius_mm").range(Range::positive())
        .rule("lengths add up to length_mm").alternative("[[100.0, 8.0], [140.0, 10.0]]");
    bore_radius_mm "mm" "the radius of the shaft's own bore"
        .range(Range::not_negative()).rule("less than its radius");
    position_mm "mm" "x and y of its axis"
        .otherwise("beside the shaft that it meshes with, at the mesh's centre distance towards positive x")
        .rule("at the mesh's centre distance from the axis of each mating shaft, within 0.01 mm")
        .alternative("[101.6, 0.0]");
    elements "" "the number of its beam elements" .range(Range::from_to(2.0, 60.0));
    couples_to "" "what it is coupled to: the motor at its beginning, or the brake at the other end"
        .rule("one shaft to the motor, one to the brake");
    coupling_stiffness_nm_per_rad "N m/rad" "the torsional stiffness of that coupling"
        .otherwise("2e3 of a motor's, 4e3 of a brake's").range(STIFFNESS).alternative("2000.0");
    damping_ratio "-" "the damping ratio of the shaft and its coupling" .range(DAMPING);
    unbalance "" "the unbalance of the shaft, midway along it"
        .otherwise("none").alternative("{ g_mm = 50.0 }");
    bow "" "the bow of a shaft that is not straight: half a sine over its length"
        .otherwise("none").alternative("{ middle_um = 20.0 }");
}

/// A bearing between a shaft and the seat that it sits in.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Bearing {
    /// Name of the shaft.
    pub shaft: String,
    /// (-) Where along the shaft, as a part of its length.
    pub at: f64,
    /// The kind of bearing.
    pub kind: BearingKind,
    /// Name of a rolling bearing whose geometry is published, in place of the geometry.
    pub name: Option<String>,
    /// Number of its balls or rollers.
    pub elements: Option<u32>,
    /// (mm) Their diameter.
    pub element_mm: Option<f64>,
    /// (mm) Pitch diameter: of the circle through their centres.
    pub pitch_mm: Option<f64>,
    /// (°) Contact angle. Default 0.
    pub contact_angle_deg: f64,
    /// (mm) Length of a roller; none for its diameter.
    pub roller_length_mm: Option<f64>,
    /// (µm) Diametral clearance of a rolling bearing; negative of an interference. Default 10.
    pub clearance_um: f64,
    /// (N) Axial preload of a ball bearing with a contact angle. Default 0.
    pub preload_n: f64,
    /// (%) Standard deviation of the cage's slip at each pass of an element, as a part of the spacing of the elements. Default 1.
    pub slip_percent: f64,
    /// Spalls of a rolling bearing.
    pub defect: Vec<BearingDefect>,
    /// (N/m) Stiffness of a linear bearing across the shaft, in every direction. Default 1.5e8.
    pub stiffness_n_per_m: f64,
    /// (N/m) That along y, where it differs.
    pub vertical_stiffness_n_per_m: Option<f64>,
    /// (N/m) Stiffness along the shaft. Default 3e7, and 0 of cylindrical rollers, on which the shaft slides.
    pub axial_stiffness_n_per_m: Option<f64>,
    /// (N m/rad) Stiffness against tilting. Default 100.
    pub tilt_stiffness_nm_per_rad: f64,
    /// What it sits in.
    pub seat: Seat,
    /// (-) Damping ratio of the bearing and its seat. Default 0.05.
    pub damping_ratio: f64,
}

/// Kind of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum BearingKind {
    /// A spring of constant stiffness.
    #[default]
    Linear,
    /// Balls between grooves.
    Ball,
    /// Cylindrical rollers between races.
    Roller,
}

by_name!(BearingKind, ["linear" => BearingKind::Linear, "ball" => BearingKind::Ball, "roller" => BearingKind::Roller]);

impl Bearing {
    /// A bearing with the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(shaft: &str, at: f64) -> Self {
        Self { shaft: shaft.to_owned(), at, ..Self::start() }
    }

    /// Name of its seat: that of its shaft with its place on it, such as `input:0`.
    pub fn seat_name(&self) -> String {
        format!("{}:{}", self.shaft, self.at)
    }

    /// (N/m) Stiffness along the shaft, given or by the kind of bearing: cylindrical rollers let their ring slide.
    pub fn axial_n_per_m(&self) -> f64 {
        self.axial_stiffness_n_per_m.unwrap_or(if self.kind == BearingKind::Roller { 0.0 } else { 3e7 })
    }

    /// Kind of its elements; none of a linear bearing.
    pub fn element(&self) -> Option<RollingElement> {
        match self.kind {
            BearingKind::Linear => None,
            BearingKind::Ball => Some(RollingElement::Ball),
            BearingKind::Roller => Some(RollingElement::Roller),
        }
    }

    /// What a rolling bearing is made of; none of a linear one.
    ///
    /// # Errors
    /// A geometry that is incomplete, given twice, or that no bearing has; keys of rolling bearings at a linear one. The key is that within the bearing.
    pub fn rolling(&self) -> Result<Option<RollingParts>, ScenarioError> {
        let Some(element) = self.element() else { return self.check_linear().map(|()| None) };
        if self.stiffness_n_per_m != Self::start().stiffness_n_per_m {
            let problem = "given for a rolling bearing, whose stiffness follows from its elements";
            return Err(ScenarioError::new("stiffness_n_per_m", self.stiffness_n_per_m, problem)
                .with_help("remove it"));
        }
        if let Some(stiffness) = self.vertical_stiffness_n_per_m {
            let problem = "given for a rolling bearing, whose stiffness follows from its elements";
            return Err(
                ScenarioError::new("vertical_stiffness_n_per_m", stiffness, problem).with_help("remove it")
            );
        }
        let geometry = match &self.name {
            Some(name) => self.named_geometry(name, element)?,
            None => self.own_geometry()?,
        };
        let contact = match element {
            RollingElement::Ball => ElementContact::ball(&geometry),
            RollingElement::Roller => {
                ElementContact::roller(&geometry, self.roller_length_mm.unwrap_or(geometry.element_mm))
            }
        };
        if element == RollingElement::Ball && self.roller_length_mm.is_some() {
            let problem = "given for a ball bearing";
            return Err(refused("roller_length_mm", problem).with_help("remove it, or set kind = \"roller\""));
        }
        if element == RollingElement::Roller && geometry.contact_angle_deg != 0.0 {
            let problem = "must be 0 of a roller bearing: its rollers are cylindrical";
            return Err(ScenarioError::new("contact_angle_deg", geometry.contact_angle_deg, problem));
        }
        if self.preload_n > 0.0 && geometry.contact_angle_deg == 0.0 {
            let problem = "needs a contact angle, by which an axial force presses the balls";
            return Err(ScenarioError::new("preload_n", self.preload_n, problem)
                .with_help("give contact_angle_deg, or a negative clearance_um, which is an interference"));
        }
        let spall = |(index, defect)| {
            Spall::new(defect, &geometry).map_err(|error| {
                let key = format!("defect[{index}].{}", error.key);
                error.with_key(key)
            })
        };
        Ok(Some(RollingParts {
            geometry,
            contact,
            radial_clearance_m: self.clearance_um * 0.5e-6,
            preload_n: self.preload_n,
            spalls: self.defect.iter().enumerate().map(spall).collect::<Result<_, _>>()?,
            slip: self.slip_percent * 1e-2,
        }))
    }

    /// Refuses what only a rolling bearing has.
    fn check_linear(&self) -> Result<(), ScenarioError> {
        let given = [
            ("name", self.name.is_some()),
            ("elements", self.elements.is_some()),
            ("element_mm", self.element_mm.is_some()),
            ("pitch_mm", self.pitch_mm.is_some()),
            ("roller_length_mm", self.roller_length_mm.is_some()),
            ("contact_angle_deg", self.contact_angle_deg != 0.0),
            ("clearance_um", self.clearance_um != Self::start().clearance_um),
            ("preload_n", self.preload_n != 0.0),
            ("slip_percent", self.slip_percent != Self::start().slip_percent),
            ("defect", !self.defect.is_empty()),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((key, _)) => {
                let error = refused(key, "given for a linear bearing, which has no balls or rollers");
                Err(error.with_help("set kind = \"ball\" or kind = \"roller\", or remove it"))
            }
            None => Ok(()),
        }
    }

    fn named_geometry(&self, name: &str, element: RollingElement) -> Result<BearingGeometry, ScenarioError> {
        let Some(named) = NamedBearing::find(name) else {
            let of_kind =
                NAMED_BEARINGS.iter().filter(|named| is_simulated(named) && named.element == element);
            let names = of_kind.map(|named| named.name).collect::<Vec<_>>().join(", ");
            let problem = if names.is_empty() {
                format!("no {} bearing is known by a name", element.name())
            } else {
                format!("must be one of {names}")
            };
            return Err(ScenarioError::new("name", format!("{name:?}"), problem)
                .with_help("give elements, element_mm and pitch_mm for any other bearing"));
        };
        if !is_simulated(named) {
            let problem = "has rollers at a contact angle; only cylindrical rollers are simulated";
            return Err(ScenarioError::new("name", format!("{name:?}"), problem));
        }
        if named.element != element {
            let kind = named.element.name();
            return Err(ScenarioError::new(
                "name",
                format!("{name:?}"),
                format!("is a {kind} bearing; must agree with kind"),
            )
            .with_help(format!("set kind = {kind:?}")));
        }
        let given = [
            ("elements", self.elements.is_some()),
            ("element_mm", self.element_mm.is_some()),
            ("pitch_mm", self.pitch_mm.is_some()),
            ("contact_angle_deg", self.contact_angle_deg != 0.0),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((key, _)) => Err(refused(key, "given beside name, which states the geometry")
                .with_help("remove one of the two")),
            None => Ok(named.geometry),
        }
    }

    fn own_geometry(&self) -> Result<BearingGeometry, ScenarioError> {
        let missing = |key: &str| {
            refused(key, "missing; a rolling bearing needs elements, element_mm and pitch_mm").with_help(
                "give these, or the name of a bearing whose geometry is published, as in name = \"6205\"",
            )
        };
        let elements = self.elements.ok_or_else(|| missing("elements"))?;
        let element_mm = self.element_mm.ok_or_else(|| missing("element_mm"))?;
        let pitch_mm = self.pitch_mm.ok_or_else(|| missing("pitch_mm"))?;
        BearingGeometry::new(elements, element_mm, pitch_mm, self.contact_angle_deg).map_err(|error| {
            ScenarioError::new(error.name, error.value, format!("must be {}", error.allowed))
        })
    }
}

/// Returns whether the elements of a bearing with a published geometry can be simulated: balls, and rollers without a contact angle.
fn is_simulated(named: &NamedBearing) -> bool {
    named.element == RollingElement::Ball || named.geometry.contact_angle_deg == 0.0
}

/// An error of a key whose value does not matter.
fn refused(key: &str, problem: &str) -> ScenarioError {
    ScenarioError::new(key, "", problem)
}

keys! {
    "bearing": Bearing = Self {
        shaft: String::new(),
        at: f64::NAN,
        kind: BearingKind::Linear,
        name: None,
        elements: None,
        element_mm: None,
        pitch_mm: None,
        contact_angle_deg: 0.0,
        roller_length_mm: None,
        clearance_um: 10.0,
        preload_n: 0.0,
        slip_percent: 1.0,
        defect: Vec::new(),
        stiffness_n_per_m: 1.5e8,
        vertical_stiffness_n_per_m: None,
        axial_stiffness_n_per_m: None,
        tilt_stiffness_nm_per_rad: 100.0,
        seat: Seat::default(),
        damping_ratio: 0.05,
    };
    shaft "" "the name of its shaft" .required();
    at "-" "the position along the shaft, as a fraction of its length from its beginning"
        .required().range(ALONG);
    kind "" "the kind of bearing: a linear spring, or balls or cylindrical rollers in Hertzian contact";
    name "" "the name of a rolling bearing whose geometry is published: 6203, 6205, ER-10K, ER-16K, UER204"
        .otherwise("none: the keys below state the geometry").alternative("\"6205\"");
    elements "" "the number of balls or rollers"
        .otherwise("required of a rolling bearing without name").range(Range::from_to(3.0, 200.0))
        .alternative("9");
    element_mm "mm" "the diameter of a ball or roller"
        .otherwise("required of a rolling bearing without name").range(Range::positive())
        .rule("room for all elements on the pitch circle").alternative("7.94");
    pitch_mm "mm" "the pitch diameter, of the circle through the centres of the elements"
        .otherwise("required of a rolling bearing without name").range(Range::positive())
        .alternative("39.04");
    contact_angle_deg "°" "the contact angle of a ball bearing"
        .range(Range::between(Included(0.0), Excluded(90.0)));
    roller_length_mm "mm" "the length of a roller"
        .otherwise("its diameter").range(Range::positive()).alternative("9.0");
    clearance_um "µm" "the diametral clearance of a rolling bearing; negative for an interference"
        .range(Range::from_to(-200.0, 1000.0));
    preload_n "N" "the axial preload of a ball bearing with a contact angle; it takes up the clearance"
        .range(Range::not_negative().implausible_above(1e6));
    slip_percent "%"
        "the random slip of the cage at each pass of an element: its standard deviation, in the spacing of the elements"
        .range(Range::from_to(0.0, 2.0));
    defect "" "the spalls of a rolling bearing, one by one"
        .otherwise("none").alternative("[{ race = \"outer\", width_mm = 1.0 }]");
    stiffness_n_per_m "N/m" "the radial stiffness of a linear bearing" .range(STIFFNESS);
    vertical_stiffness_n_per_m "N/m"
        "the radial stiffness of a linear bearing along y, where it differs from that along x"
        .otherwise("stiffness_n_per_m").range(STIFFNESS).alternative("1e8");
    axial_stiffness_n_per_m "N/m" "the axial stiffness; 0 where the shaft may slide"
        .otherwise("3e7; 0 of a roller bearing").range(MAYBE_STIFF).alternative("3e7");
    tilt_stiffness_nm_per_rad "N m/rad" "the tilting stiffness of the shaft in the bearing"
        .range(MAYBE_STIFF);
    seat "" "the bearing's seat, on the housing or on the ground";
    damping_ratio "-" "the damping ratio of the bearing and its seat" .range(DAMPING);
}

/// What a bearing sits in: a mass on springs to the housing or to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// (kg) Mass. Default 1.
    pub mass_kg: f64,
    /// (kg m²) Moment of inertia about every axis. Default 1e-3.
    pub inertia_kgm2: f64,
    /// (N/m) Stiffness in every direction. Default 4e8.
    pub stiffness_n_per_m: f64,
    /// (N/m) That along y, where it differs.
    pub vertical_stiffness_n_per_m: Option<f64>,
    /// (N m/rad) Stiffness against every rotation. Default 1e6.
    pub tilt_stiffness_nm_per_rad: f64,
}

keys! {
    Seat = default Self {
        mass_kg: 1.0,
        inertia_kgm2: 1e-3,
        stiffness_n_per_m: 4e8,
        vertical_stiffness_n_per_m: None,
        tilt_stiffness_nm_per_rad: 1e6,
    };
    mass_kg "kg" "the seat's mass" .range(MASS);
    inertia_kgm2 "kg m²" "its moment of inertia about every axis" .range(MASS);
    stiffness_n_per_m "N/m" "its stiffness to the housing or to the ground, in every direction"
        .range(STIFFNESS);
    vertical_stiffness_n_per_m "N/m" "its stiffness along y, where it differs"
        .otherwise("stiffness_n_per_m").range(STIFFNESS).alternative("2e8");
    tilt_stiffness_nm_per_rad "N m/rad" "its rotational stiffness about every axis" .range(STIFFNESS);
}

/// The housing: a body on feet, to which all seats are fixed. It is rigid but for its [modes](HousingModes).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Housing {
    /// (kg) Mass. Default 30.
    pub mass_kg: f64,
    /// (kg m²) Moment of inertia about every axis; none for that of a box 0.3 m by 0.2 m, `m (0.3² + 0.2²)/12`.
    pub inertia_kgm2: Option<f64>,
    /// What it stands on; none for four feet of 6e7 N/m at its corners.
    pub feet: Vec<Foot>,
    /// (-) Damping ratio of the feet. Default 0.05.
    pub damping_ratio: f64,
    /// Its modes. Default 4 per kHz from 350 Hz.
    pub modes: HousingModes,
}

keys! {
    "housing": Housing = default Self {
        mass_kg: 30.0,
        inertia_kgm2: None,
        feet: Vec::new(),
        damping_ratio: 0.05,
        modes: HousingModes::default(),
    };
    mass_kg "kg" "the housing's mass, without the seats" .range(MASS);
    inertia_kgm2 "kg m²" "its moment of inertia about every axis"
        .otherwise("mass_kg (0.3² + 0.2²)/12").range(MASS).alternative("0.325");
    feet "" "the feet on which it stands, one by one"
        .otherwise("four feet of 6e7 N/m: in x 100 mm outside of the outermost shafts, in y 100 mm below the lowest one, at both ends of the longest shaft")
        .alternative("[{ at_mm = [-100.0, -100.0, 0.0], stiffness_n_per_m = 6e7 }]");
    damping_ratio "-" "the damping ratio of the feet" .range(DAMPING);
    modes "" "the modes in which it vibrates between its feet and the seats";
}

impl Housing {
    /// (kg m²) Moment of inertia about every axis, given or by default.
    pub fn moment_of_inertia_kgm2(&self) -> f64 {
        self.inertia_kgm2.unwrap_or(self.mass_kg * (0.3f64.powi(2) + 0.2f64.powi(2)) / 12.0)
    }
}

/// A foot of the housing: a spring to the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foot {
    /// (mm) Where it is: x, y, z.
    pub at_mm: [f64; 3],
    /// (N/m) Its stiffness in every direction. Default 6e7.
    pub stiffness_n_per_m: f64,
    /// (N/m) That along y, where it differs.
    pub vertical_stiffness_n_per_m: Option<f64>,
}

keys! {
    Foot = Self { at_mm: [f64::NAN; 3], stiffness_n_per_m: 6e7, vertical_stiffness_n_per_m: None };
    at_mm "mm" "where it is: x, y, z" .required().range(Range::between(Excluded(-1e5), Excluded(1e5)));
    stiffness_n_per_m "N/m" "its stiffness in every direction" .range(STIFFNESS);
    vertical_stiffness_n_per_m "N/m" "its stiffness along y, where it differs"
        .otherwise("stiffness_n_per_m").range(STIFFNESS).alternative("3e7");
}
