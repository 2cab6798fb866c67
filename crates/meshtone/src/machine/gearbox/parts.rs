//! The keys of a gearbox's shafts, bearings and housing.

use std::ops::Bound::{Excluded, Included};

use crate::keys::{KeyRow, Keys, Range, by_name, field, row};

/// A round shaft between two ends, with wheels and bearings on it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GearboxShaft {
    /// Its name.
    pub name: String,
    /// (mm) Length.
    pub length_mm: f64,
    /// (mm) Radius, also of the bores of the wheels on it; of a shaft of several radii see [`Self::segments`].
    pub radius_mm: Option<f64>,
    /// (mm) Length and radius of each piece, from z = 0 on, instead of one radius. Empty: one radius.
    pub segments: Vec<[f64; 2]>,
    /// (mm) Radius of the shaft's own bore. Default 0: solid.
    pub bore_radius_mm: f64,
    /// (mm) x and y of its axis; none for the place that the meshes give it, with the centres side by side.
    pub position_mm: Option<[f64; 2]>,
    /// Number of beam elements, shared among its pieces by their length. Default 12.
    pub elements: u32,
    /// What it is coupled to at an end: the motor at z = 0, the brake at the other. Default nothing.
    pub couples_to: Coupled,
    /// (N m/rad) Torsional stiffness of that coupling. Default 2e3 of a motor's, 4e3 of a brake's.
    pub coupling_stiffness_nm_per_rad: Option<f64>,
    /// (-) Damping ratio of the shaft and its coupling. Default 0.02.
    pub damping_ratio: f64,
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

    /// (mm) Length and radius of each piece.
    pub fn pieces_mm(&self) -> Vec<[f64; 2]> {
        match self.radius_mm {
            Some(radius_mm) if self.segments.is_empty() => vec![[self.length_mm, radius_mm]],
            _ => self.segments.clone(),
        }
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
    .message("must be from 0 to 1, the part of the shaft's length from the end at z = 0");
const STIFFNESS: Range = Range::positive().implausible_above(1e15);
const MAYBE_STIFF: Range = Range::not_negative().implausible_above(1e15);
const MASS: Range = Range::positive().implausible_above(1e9);
const DAMPING: Range = Range::below_one().help("a bolted structure has 0.01 to 0.05");

impl Keys for GearboxShaft {
    const SECTION: &str = "shaft";

    fn start() -> Self {
        Self {
            name: String::new(),
            length_mm: f64::NAN,
            radius_mm: None,
            segments: Vec::new(),
            bore_radius_mm: 0.0,
            position_mm: None,
            elements: 12,
            couples_to: Coupled::Nothing,
            coupling_stiffness_nm_per_rad: None,
            damping_ratio: 0.02,
        }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("name", "", "the shaft's name", field!(name)).required().rule("no other shaft's"),
            row("length_mm", "mm", "the shaft's length, from z = 0 on", field!(length_mm))
                .required()
                .range(Range::positive().implausible_above(1e5)),
            row("radius_mm", "mm", "its radius, also of the bores of the wheels on it", field!(radius_mm))
                .otherwise("required, unless segments is given")
                .range(Range::positive())
                .rule("less than the wheels' root radii"),
            row(
                "segments",
                "mm",
                "the length and the radius of each piece, from z = 0 on, in place of one radius",
                field!(segments),
            )
            .otherwise("one piece of radius_mm")
            .range(Range::positive())
            .rule("lengths add up to length_mm")
            .alternative("[[100.0, 8.0], [140.0, 10.0]]"),
            row("bore_radius_mm", "mm", "the radius of the shaft's own bore", field!(bore_radius_mm))
                .range(Range::not_negative())
                .rule("less than its radius"),
            row("position_mm", "mm", "x and y of its axis", field!(position_mm))
                .otherwise("beside the shaft that it meshes with, at the mesh's centre distance towards positive x")
                .rule("at the mesh's centre distance from the axis of each mating shaft, within 0.01 mm")
                .alternative("[101.6, 0.0]"),
            row("elements", "", "the number of its beam elements", field!(elements))
                .range(Range::from_to(2.0, 60.0)),
            row(
                "couples_to",
                "",
                "what it is coupled to: the motor at z = 0, or the brake at the other end",
                field!(couples_to),
            )
            .rule("one shaft to the motor, one to the brake"),
            row(
                "coupling_stiffness_nm_per_rad",
                "N m/rad",
                "the torsional stiffness of that coupling",
                field!(coupling_stiffness_nm_per_rad),
            )
            .otherwise("2e3 of a motor's, 4e3 of a brake's")
            .range(STIFFNESS)
            .alternative("2000.0"),
            row("damping_ratio", "-", "the damping ratio of the shaft and its coupling", field!(damping_ratio))
                .range(DAMPING),
        ]
    }
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
    /// (N/m) Stiffness across the shaft, in every direction. Default 1.5e8.
    pub stiffness_n_per_m: f64,
    /// (N/m) Stiffness along the shaft. Default 3e7; 0 of a bearing that lets the shaft slide.
    pub axial_stiffness_n_per_m: f64,
    /// (N m/rad) Stiffness against tilting. Default 100.
    pub tilt_stiffness_nm_per_rad: f64,
    /// What it sits in.
    pub seat: Seat,
    /// (-) Damping ratio of the bearing and its seat. Default 0.02.
    pub damping_ratio: f64,
}

/// Kind of a bearing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum BearingKind {
    /// A spring of constant stiffness.
    #[default]
    Linear,
}

by_name!(BearingKind, ["linear" => BearingKind::Linear]);

impl Bearing {
    /// A bearing with the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(shaft: &str, at: f64) -> Self {
        Self { shaft: shaft.to_owned(), at, ..Self::start() }
    }
}

impl Keys for Bearing {
    const SECTION: &str = "bearing";

    fn start() -> Self {
        Self {
            shaft: String::new(),
            at: f64::NAN,
            kind: BearingKind::Linear,
            stiffness_n_per_m: 1.5e8,
            axial_stiffness_n_per_m: 3e7,
            tilt_stiffness_nm_per_rad: 100.0,
            seat: Seat::default(),
            damping_ratio: 0.02,
        }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("shaft", "", "the name of its shaft", field!(shaft)).required(),
            row("at", "-", "the position along the shaft, as a fraction of its length from z = 0", field!(at))
                .required()
                .range(ALONG),
            row("kind", "", "the kind of bearing", field!(kind)),
            row("stiffness_n_per_m", "N/m", "the radial stiffness", field!(stiffness_n_per_m))
                .range(STIFFNESS),
            row(
                "axial_stiffness_n_per_m",
                "N/m",
                "the axial stiffness; 0 where the shaft may slide",
                field!(axial_stiffness_n_per_m),
            )
            .range(MAYBE_STIFF),
            row(
                "tilt_stiffness_nm_per_rad",
                "N m/rad",
                "the tilting stiffness of the shaft in the bearing",
                field!(tilt_stiffness_nm_per_rad),
            )
            .range(MAYBE_STIFF),
            row("seat", "", "the bearing's seat, on the housing or on the ground", field!(seat)),
            row("damping_ratio", "-", "the damping ratio of the bearing and its seat", field!(damping_ratio))
                .range(DAMPING),
        ]
    }
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
    /// (N m/rad) Stiffness against every rotation. Default 1e6.
    pub tilt_stiffness_nm_per_rad: f64,
}

impl Default for Seat {
    fn default() -> Self {
        Self { mass_kg: 1.0, inertia_kgm2: 1e-3, stiffness_n_per_m: 4e8, tilt_stiffness_nm_per_rad: 1e6 }
    }
}

impl Keys for Seat {
    fn start() -> Self {
        Self::default()
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("mass_kg", "kg", "the seat's mass", field!(mass_kg)).range(MASS),
            row("inertia_kgm2", "kg m²", "its moment of inertia about every axis", field!(inertia_kgm2)).range(MASS),
            row(
                "stiffness_n_per_m",
                "N/m",
                "its stiffness to the housing or to the ground, in every direction",
                field!(stiffness_n_per_m),
            )
            .range(STIFFNESS),
            row(
                "tilt_stiffness_nm_per_rad",
                "N m/rad",
                "its rotational stiffness about every axis",
                field!(tilt_stiffness_nm_per_rad),
            )
            .range(STIFFNESS),
        ]
    }
}

/// The housing: one rigid body on feet, to which all seats are fixed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Housing {
    /// (kg) Mass. Default 30.
    pub mass_kg: f64,
    /// (kg m²) Moment of inertia about every axis; none for that of a box 0.3 m by 0.2 m, `m (0.3² + 0.2²)/12`.
    pub inertia_kgm2: Option<f64>,
    /// What it stands on; none for four feet of 6e7 N/m at its corners.
    pub feet: Vec<Foot>,
    /// (-) Damping ratio of the feet. Default 0.02.
    pub damping_ratio: f64,
}

impl Keys for Housing {
    const SECTION: &str = "housing";

    fn start() -> Self {
        Self { mass_kg: 30.0, inertia_kgm2: None, feet: Vec::new(), damping_ratio: 0.02 }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("mass_kg", "kg", "the housing's mass, without the seats", field!(mass_kg)).range(MASS),
            row("inertia_kgm2", "kg m²", "its moment of inertia about every axis", field!(inertia_kgm2))
                .otherwise("mass_kg (0.3² + 0.2²)/12")
                .range(MASS)
                .alternative("0.325"),
            row("feet", "", "the feet on which it stands, one by one", field!(feet))
                .otherwise(
                    "four feet of 6e7 N/m: in x 100 mm outside of the outermost shafts, in y 100 mm below the lowest one, \
                     at both ends of the longest shaft",
                )
                .alternative("[{ at_mm = [-100.0, -100.0, 0.0], stiffness_n_per_m = 6e7 }]"),
            row("damping_ratio", "-", "the damping ratio of the feet", field!(damping_ratio)).range(DAMPING),
        ]
    }
}

impl Default for Housing {
    fn default() -> Self {
        Self::start()
    }
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
}

impl Keys for Foot {
    fn start() -> Self {
        Self { at_mm: [f64::NAN; 3], stiffness_n_per_m: 6e7 }
    }

    fn rows() -> Vec<KeyRow<Self>> {
        vec![
            row("at_mm", "mm", "where it is: x, y, z", field!(at_mm))
                .required()
                .range(Range::between(Excluded(-1e5), Excluded(1e5))),
            row("stiffness_n_per_m", "N/m", "its stiffness in every direction", field!(stiffness_n_per_m))
                .range(STIFFNESS),
        ]
    }
}
