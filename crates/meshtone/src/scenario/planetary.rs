//! Planetary sets: a sun and a ring with planets on a carrier between them.
//!
//! A set is written as one section. Its wheels and meshes follow from it: they come after those of the scenario's own sections, so that
//! teeth, deviations, faults and signals are the same for all meshes.

use std::f64::consts::TAU;

use serde::Serialize;

use super::{Scenario, ScenarioMesh, ScenarioWheel, Shafts};
use crate::keys::{Keys, Range, field, keys};
use crate::machine::{Bearing, Coupled, WheelInertia};
use crate::wheel::rows::*;
use crate::wheel::{FlankRelief, FoundationCoefficients};

/// A sun, planets on a carrier, and a ring with internal teeth.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PlanetarySet {
    /// Its name, of which those of its wheels are made: `p.sun`, `p.planet1`, `p.ring`.
    pub name: String,
    /// Name of the sun's shaft, or `fixed`.
    pub sun: String,
    /// Name of the carrier's shaft, or `fixed`.
    pub carrier: String,
    /// Name of the ring's shaft, or `fixed`. Default fixed.
    pub ring: String,
    /// Tooth counts.
    pub teeth: MemberTeeth,
    /// Number of planets, equally spaced, the first along x. Default 3.
    pub planets: u32,
    /// (°) Where the planets stand on the carrier, from x towards y, instead; empty for equal spacing.
    pub planet_angles_deg: Vec<f64>,
    /// (mm) Module.
    pub module_mm: f64,
    /// (°) Pressure angle at the pitch circle. Default 20.
    pub pressure_angle_deg: f64,
    /// (mm) Face width of all wheels.
    pub face_width_mm: f64,
    /// (-) Profile shift coefficients. Default 0.
    pub profile_shift: MemberShifts,
    /// (mm) Height of all tips' chamfer; none for 0.23 modules.
    pub tip_chamfer_mm: Option<f64>,
    /// (base pitches) By how much every path of contact is shorter than the tips between their chamfers make it. Default 0.1.
    pub active_profile_shortening: f64,
    /// Relief of the flanks near all tips, as a gap. Default none.
    pub flank_relief: FlankRelief,
    /// (mm) Normal backlash of every mesh; none for that of a [`ScenarioMesh`].
    pub backlash_mm: Option<f64>,
    /// Coefficients of the fillet foundation's compliance of external teeth.
    pub foundation: FoundationCoefficients,
    /// Grade of DIN 3961 of the deviations of all wheels, 1 (best) to 12; 0 for ideal teeth. Default 0.
    pub din_grade: u8,
    /// Class of ISO 1328-1:2013 instead, 1 (best) to 11; 0 for none. Default 0.
    pub iso_class: u8,
    /// (-) Damping of the contact over the critical one of the wheels' rotation on the mean mesh. Default 0.08.
    pub damping_ratio: f64,
    /// (-) Coefficient of friction of the flanks. Default 0.05.
    pub friction: f64,
    /// (-) Size of the random force across the line of action of every mesh. Default 0.01, with which half of the power on the ring of a laboratory
    /// set is in lines.
    pub random_force: f64,
    /// The pins that hold the planets.
    pub pin: Pin,
    /// The rim of the ring and its support.
    pub rim: Rim,
    /// (N/m) Stiffness that holds the sun across its axis. Default 1e8.
    pub sun_support_n_per_m: f64,
    /// (N/m) Stiffness that holds the carrier across its axis. Default 1e8.
    pub carrier_support_n_per_m: f64,
    /// (µm) How far the circle of the pins lies off the axis about which the carrier turns, towards the first planet. Default 0.
    pub carrier_eccentricity_um: f64,
    /// (N m/rad) Torsional stiffness between a member and its shaft, or the ground where it is fixed. Default 1e5.
    pub coupling_stiffness_nm_per_rad: f64,
    /// (-) Damping ratio of pins, supports, rim and couplings. Default 0.02.
    pub support_damping_ratio: f64,
    /// Mass and inertia of the sun, instead of those of a solid disc.
    pub sun_inertia: WheelInertia,
    /// Mass and inertia of each planet, instead of those of a solid disc.
    pub planet_inertia: WheelInertia,
    /// Mass and inertia of the ring, instead of those from its tip circle to the outside of its rim.
    pub ring_inertia: WheelInertia,
    /// Mass and inertia of the carrier without the planets, instead of those of a solid disc as wide as the faces that reaches to the far side of the
    /// planets' pitch circles.
    pub carrier_inertia: WheelInertia,
}

/// Tooth counts of a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemberTeeth {
    /// Of the sun.
    pub sun: u32,
    /// Of a planet.
    pub planet: u32,
    /// Of the ring.
    pub ring: u32,
}

/// Orders at which the events of a planetary set repeat, per revolution of its carrier against its ring: the carrier's own revolution where the ring is fixed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SetOrders {
    /// Teeth of every mesh meet.
    pub mesh: f64,
    /// A planet passes a place on the ring.
    pub planet_passage: f64,
    /// One tooth of the sun meets any planet.
    pub sun_tooth: f64,
    /// One tooth of a planet meets the sun, and so the ring.
    pub planet_tooth: f64,
    /// One tooth of the ring meets any planet.
    pub ring_tooth: f64,
}

impl MemberTeeth {
    /// The orders of the events of a set: McFadden and Smith, Proc. IMechE C 199 (1985) 65.
    ///
    /// ```
    /// let teeth = meshtone::scenario::MemberTeeth { sun: 19, planet: 31, ring: 81 };
    /// assert_eq!(teeth.orders(4).sun_tooth, 4.0 * 81.0 / 19.0);
    /// ```
    ///
    /// # Arguments
    /// * `planets` - how many there are
    pub fn orders(self, planets: usize) -> SetOrders {
        let [sun, planet, ring] = [self.sun, self.planet, self.ring].map(f64::from);
        let planets = planets as f64;
        SetOrders {
            mesh: ring,
            planet_passage: planets,
            sun_tooth: planets * ring / sun,
            planet_tooth: ring / planet,
            ring_tooth: planets,
        }
    }
}

/// Profile shift coefficients of a set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MemberShifts {
    /// (-) Of the sun.
    pub sun: f64,
    /// (-) Of the planets.
    pub planet: f64,
    /// (-) Of the ring: positive where its teeth lie farther outside.
    pub ring: f64,
}

/// The pins of a set's planets.
#[derive(Debug, Clone, PartialEq)]
pub struct Pin {
    /// (N/m) Stiffness of each pin with the planet's bearing, along every direction. Default 1e8.
    pub stiffness_n_per_m: f64,
    /// (µm) How far each pin stands ahead of its place, in the sense in which the carrier turns about positive z; empty for none.
    pub error_um: Vec<f64>,
}

/// The rim of a set's ring.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rim {
    /// (mm) Thickness below the root circle; none for 3 modules.
    pub thickness_mm: Option<f64>,
    /// (N/m) Stiffness that holds the ring as a rigid body across its axis. Default 1e9.
    pub support_n_per_m: f64,
    /// (N/m) Stiffness against its rotation, along its base circle. Default 1e9.
    pub rotation_support_n_per_m: f64,
    /// The largest number of waves around the rim with which it bends. Default 12.
    pub waves: u32,
}

const STIFFNESS: Range = Range::positive().implausible_above(1e15);

keys! {
    MemberTeeth = default Self { sun: 0, planet: 0, ring: 0 };
    = { teeth_row("sun", field!(sun)) };
    = { teeth_row("planet", field!(planet)) };
    = { teeth_row("ring", field!(ring)) };
}

keys! {
    MemberShifts = default Self { sun: 0.0, planet: 0.0, ring: 0.0 };
    = { profile_shift_row("sun", field!(sun)) };
    = { profile_shift_row("planet", field!(planet)) };
    = { profile_shift_row("ring", field!(ring)) };
}

keys! {
    Pin = default Self { stiffness_n_per_m: 1e8, error_um: Vec::new() };
    stiffness_n_per_m "N/m" "the stiffness of each pin with the planet's bearing" .range(STIFFNESS);
    error_um "µm" "how far each pin stands ahead of its place, positive as the carrier turns about positive z"
        .otherwise("0 each").range(Range::from_to(-1e3, 1e3)).rule("one a planet")
        .alternative("[10.0, 0.0, 0.0]");
}

keys! {
    Rim = default Self { thickness_mm: None, support_n_per_m: 1e9, rotation_support_n_per_m: 1e9, waves: 12 };
    thickness_mm "mm" "the rim's thickness below the root circle"
        .otherwise("3 modules").range(Range::positive().implausible_above(1e4)).alternative("12.0");
    support_n_per_m "N/m" "the stiffness that holds the ring across its axis" .range(STIFFNESS);
    rotation_support_n_per_m "N/m" "the stiffness against its rotation, along its base circle" .range(STIFFNESS);
    waves "" "the largest number of waves around the rim with which it bends" .range(Range::from_to(2.0, 20.0));
}

keys! {
    "planetary": PlanetarySet = Self {
        name: String::new(),
        sun: String::new(),
        carrier: String::new(),
        ring: FIXED.to_owned(),
        teeth: MemberTeeth::default(),
        planets: 3,
        planet_angles_deg: Vec::new(),
        module_mm: f64::NAN,
        pressure_angle_deg: 20.0,
        face_width_mm: f64::NAN,
        profile_shift: MemberShifts::default(),
        tip_chamfer_mm: None,
        active_profile_shortening: 0.1,
        flank_relief: FlankRelief::default(),
        backlash_mm: None,
        foundation: ScenarioMesh::start().foundation,
        din_grade: 0,
        iso_class: 0,
        damping_ratio: ScenarioMesh::start().damping_ratio,
        friction: ScenarioMesh::start().friction,
        random_force: 0.01,
        pin: Pin::default(),
        rim: Rim::default(),
        sun_support_n_per_m: 1e8,
        carrier_support_n_per_m: 1e8,
        carrier_eccentricity_um: 0.0,
        coupling_stiffness_nm_per_rad: 1e5,
        support_damping_ratio: 0.02,
        sun_inertia: WheelInertia::default(),
        planet_inertia: WheelInertia::default(),
        ring_inertia: WheelInertia::default(),
        carrier_inertia: WheelInertia::default(),
    };
    name "" "the set's name; its wheels are called NAME.sun, NAME.planet1, NAME.ring"
        .required().rule("no other set's");
    sun "" "the name of the sun's shaft, or \"fixed\"" .required();
    carrier "" "the name of the carrier's shaft, or \"fixed\"" .required();
    ring "" "the name of the ring's shaft, or \"fixed\"" .rule("one member at most is fixed");
    teeth "" "the tooth counts of sun, planets and ring" .rule("teeth that fit one another at one centre distance");
    planets "" "the number of planets, equally spaced, the first along x"
        .range(Range::from_to(1.0, 8.0)).rule("teeth that fit; room beside one another");
    planet_angles_deg "°" "where the planets stand instead, from x towards y"
        .otherwise("equally spaced").range(Range::from_to(-360.0, 360.0)).rule("one a planet; teeth that fit")
        .alternative("[0.0, 120.0, 240.0]");
    = { module_row(field!(module_mm)) };
    = { pressure_angle_row(field!(pressure_angle_deg)) };
    = { face_width_row("the face width of all wheels", field!(face_width_mm)) };
    profile_shift "-" "the profile shift coefficients of sun, planets and ring";
    = { chamfer_row(field!(tip_chamfer_mm)) };
    = { shortening_row(field!(active_profile_shortening)) };
    flank_relief "" "the relief of the flanks near all tips, as a gap in µm";
    = { backlash_row(field!(backlash_mm)) };
    = { foundation_row(field!(foundation)) };
    = { din_grade_row("the grade of DIN 3961 of the deviations of all wheels, 1 (best) to 12; 0: ideal teeth", field!(din_grade)) };
    = { iso_class_row(field!(iso_class)) };
    = { mesh_damping_row(field!(damping_ratio)) };
    = { friction_row(field!(friction)) };
    = { random_force_row(
        "the size of the random force across the line of action of every mesh; 0 for none",
        field!(random_force),
    ) };
    pin "" "the pins that hold the planets";
    rim "" "the rim of the ring and its support";
    sun_support_n_per_m "N/m" "the stiffness that holds the sun across its axis; a floating sun has 1e3" .range(STIFFNESS);
    carrier_support_n_per_m "N/m" "the stiffness that holds the carrier across its axis" .range(STIFFNESS);
    carrier_eccentricity_um "µm" "the eccentricity of the circle of the pins, towards the first planet"
        .range(Range::from_to(0.0, 1e3));
    coupling_stiffness_nm_per_rad "N m/rad"
        "the torsional stiffness between a member and its shaft, or the ground where sun or carrier is fixed"
        .range(STIFFNESS);
    support_damping_ratio "-" "the damping ratio of pins, supports, rim and couplings"
        .range(Range::below_one().help("a bolted structure has 0.01 to 0.05"));
    sun_inertia "" "the sun's mass and inertia" .otherwise("those of a solid disc of pitch radius");
    planet_inertia "" "the mass and inertia of each planet" .otherwise("those of a solid disc of pitch radius");
    ring_inertia "" "the ring's mass and inertia" .otherwise("those of what lies outside of its tip circle");
    carrier_inertia "" "the carrier's mass and inertia without planets"
        .otherwise("those of a solid disc that reaches to the far side of the planets' pitch circles");
}

/// The name of a member's shaft where the member stands still.
pub(super) const FIXED: &str = "fixed";

/// A wheel of a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Member {
    /// The sun.
    Sun,
    /// A planet, by its number from 0.
    Planet(usize),
    /// The ring.
    Ring,
}

/// Which wheel of which set a wheel of a scenario is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OfSet {
    /// Number of the set.
    pub set: usize,
    /// The wheel.
    pub member: Member,
}

impl PlanetarySet {
    /// A set with a fixed ring, and the rest at its default.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(
        name: &str,
        sun: &str,
        carrier: &str,
        teeth: MemberTeeth,
        module_mm: f64,
        face_width_mm: f64,
    ) -> Self {
        let [name, sun, carrier] = [name, sun, carrier].map(str::to_owned);
        Self { name, sun, carrier, teeth, module_mm, face_width_mm, ..Self::start() }
    }

    /// Names of the shafts of sun, carrier and ring; none of a fixed member.
    pub fn shafts(&self) -> [Option<&str>; 3] {
        [&self.sun, &self.carrier, &self.ring].map(|name| Some(name.as_str()).filter(|name| *name != FIXED))
    }

    /// (rad) Where each planet stands on the carrier, from x towards y.
    pub fn planet_angles_rad(&self) -> Vec<f64> {
        if !self.planet_angles_deg.is_empty() {
            return self.planet_angles_deg.iter().map(|angle_deg| angle_deg.to_radians()).collect();
        }
        (0..self.planets).map(|planet| TAU * f64::from(planet) / f64::from(self.planets)).collect()
    }

    /// (m) How far each pin stands off its place, outwards and in the sense of positive rotation.
    pub fn pin_errors_m(&self) -> Vec<[f64; 2]> {
        let angles_rad = self.planet_angles_rad();
        let of_pin = |(planet, angle_rad): (usize, &f64)| {
            let (sin, cos) = (angles_rad[0] - angle_rad).sin_cos();
            let own_um = self.pin.error_um.get(planet).copied().unwrap_or(0.0);
            [self.carrier_eccentricity_um * cos, self.carrier_eccentricity_um * sin + own_um]
                .map(|um| um * 1e-6)
        };
        angles_rad.iter().enumerate().map(of_pin).collect()
    }

    /// Name of a wheel.
    pub fn wheel_name(&self, member: Member) -> String {
        match member {
            Member::Sun => format!("{}.sun", self.name),
            Member::Planet(planet) => format!("{}.planet{}", self.name, planet + 1),
            Member::Ring => format!("{}.ring", self.name),
        }
    }

    /// (mm) Thickness of the rim, given or by default.
    pub fn rim_thickness_mm(&self) -> f64 {
        self.rim.thickness_mm.unwrap_or(3.0 * self.module_mm)
    }

    /// The wheels: the sun, the planets, the ring.
    fn members(&self) -> Vec<Member> {
        let planets = (0..self.planet_angles_rad().len()).map(Member::Planet);
        [Member::Sun].into_iter().chain(planets).chain([Member::Ring]).collect()
    }

    /// A wheel as one of a scenario. It turns about an axis of its own, which has its name.
    fn wheel(&self, set: usize, member: Member) -> ScenarioWheel {
        let name = self.wheel_name(member);
        let (teeth, shift, inertia) = match member {
            Member::Sun => (self.teeth.sun, self.profile_shift.sun, self.sun_inertia),
            Member::Planet(_) => (self.teeth.planet, self.profile_shift.planet, self.planet_inertia),
            Member::Ring => (self.teeth.ring, self.profile_shift.ring, self.ring_inertia),
        };
        ScenarioWheel {
            profile_shift: shift,
            inertia,
            tip_chamfer_mm: self.tip_chamfer_mm,
            active_profile_shortening: self.active_profile_shortening,
            flank_relief: self.flank_relief,
            din_grade: self.din_grade,
            iso_class: self.iso_class,
            of_set: Some(OfSet { set, member }),
            ..ScenarioWheel::new(&name, &name, 0.5, teeth, self.face_width_mm)
        }
    }

    /// The meshes: those of the sun with all planets, then those of all planets with the ring.
    fn meshes(&self) -> Vec<ScenarioMesh> {
        let mesh = |wheels: [Member; 2]| ScenarioMesh {
            wheels: wheels.map(|member| self.wheel_name(member)),
            pressure_angle_deg: self.pressure_angle_deg,
            backlash_mm: self.backlash_mm,
            foundation: self.foundation,
            damping_ratio: self.damping_ratio,
            friction: self.friction,
            random_force: self.random_force,
            is_internal: wheels[1] == Member::Ring,
            is_of_set: true,
            ..ScenarioMesh::new(["", ""], self.module_mm)
        };
        let planets = || (0..self.planet_angles_rad().len()).map(Member::Planet);
        let of_sun = planets().map(|planet| mesh([Member::Sun, planet]));
        of_sun.chain(planets().map(|planet| mesh([planet, Member::Ring]))).collect()
    }
}

impl Shafts {
    /// The wheels and meshes of all sets.
    fn of_sets(&self) -> (Vec<ScenarioWheel>, Vec<ScenarioMesh>) {
        let sets = || self.planetary.iter().enumerate();
        let wheels = sets()
            .flat_map(|(number, set)| set.members().into_iter().map(move |member| set.wheel(number, member)))
            .collect();
        (wheels, sets().flat_map(|(_, set)| set.meshes()).collect())
    }
}

impl Scenario {
    /// The planetary sets; none of a rig.
    pub fn planetary(&self) -> &[PlanetarySet] {
        self.structure.shafts().map_or(&[], |of| &of.planetary)
    }

    /// Names of the planetary sets.
    pub(crate) fn set_names(&self) -> Vec<&str> {
        self.planetary().iter().map(|set| set.name.as_str()).collect()
    }

    /// Number of a shaft.
    pub(crate) fn shaft_number(&self, name: &str) -> Option<usize> {
        self.shafts().iter().position(|shaft| shaft.name == name)
    }

    /// The bearings that sit between a shaft and a seat: all but those of planets.
    pub fn bearings_of_shafts(&self) -> impl Iterator<Item = &Bearing> {
        self.bearings().iter().filter(|bearing| self.axis_of_planet(&bearing.shaft).is_none())
    }

    /// Number of the axis of a planet, on which a bearing can be: those of sets come after the shafts.
    pub(super) fn axis_of_planet(&self, name: &str) -> Option<usize> {
        let of_sets = &self.wheels[self.own_wheels()..];
        let is_named = |wheel: &ScenarioWheel| {
            wheel.name == name && matches!(wheel.of_set, Some(OfSet { member: Member::Planet(_), .. }))
        };
        Some(self.shafts().len() + of_sets.iter().position(is_named)?)
    }

    /// Whether a member of a set sits at the end of its shaft rather than at its beginning: away from the motor, which is at the beginning of its
    /// shaft, or from a set that comes before in the file and has the beginning.
    pub(crate) fn is_at_end(&self, set: &PlanetarySet, shaft: &str) -> bool {
        let is_motor = self.coupled(shaft) == Coupled::Motor;
        let before = self.planetary().iter().take_while(|other| other.name != set.name);
        is_motor || before.into_iter().any(|other| other.shafts().contains(&Some(shaft)))
    }

    /// (mm) z of a set: midway between the ends of its shafts.
    pub(super) fn z_of_set_mm(&self, set: &PlanetarySet) -> f64 {
        let end_mm = |name: &str| {
            let shaft = &self.shafts()[self.shaft_number(name)?];
            Some(shaft.z_mm(if self.is_at_end(set, name) { 1.0 } else { 0.0 }))
        };
        let ends_mm: Vec<f64> = set.shafts().into_iter().flatten().filter_map(end_mm).collect();
        ends_mm.iter().sum::<f64>() / ends_mm.len().max(1) as f64
    }

    /// Number of the wheels that have sections of their own; those of planetary sets come after them.
    pub fn own_wheels(&self) -> usize {
        self.wheels.iter().take_while(|wheel| wheel.of_set.is_none()).count()
    }

    /// Number of the meshes that have sections of their own; those of planetary sets come after them.
    pub fn own_meshes(&self) -> usize {
        self.meshes.iter().take_while(|mesh| !mesh.is_of_set).count()
    }

    /// The scenario with the wheels and meshes that its planetary sets have as they are stated now.
    #[must_use]
    pub fn with_members(mut self) -> Self {
        let (wheels, meshes) = self.structure.shafts().map(Shafts::of_sets).unwrap_or_default();
        self.wheels.retain(|wheel| wheel.of_set.is_none());
        self.meshes.retain(|mesh| !mesh.is_of_set);
        self.wheels.extend(wheels);
        self.meshes.extend(meshes);
        self
    }
}
