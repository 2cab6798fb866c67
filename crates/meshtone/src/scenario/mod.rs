//! What the user asks for.
//!
//! A [`Scenario`] says everything that a simulation depends on: the wheels, how they are
//! driven, how well they are made, what is broken, the machine they run in and how the equations are
//! solved. It is a plain value: build it in code, or read it from TOML with [`Scenario::from_toml`].
//! The names are the same everywhere (Rust fields, TOML keys, Python arguments).

mod edit;
mod from_toml;
mod gearbox_template;
mod ignored_keys;
mod layout;
mod long;
mod mesh;
mod places;
mod planetary;
mod planetary_layout;
mod planetary_template;
mod room;
mod serialise;
mod short;
mod structure;
mod template;
mod to_toml;
mod turning;
mod uncertainty;
mod validate;
mod wheel;

pub use crate::bearing::{BearingDefect, DefectPlace};
pub use crate::damage::kinds::*;
pub use crate::damage::{
    Damage, DamageKind, DestructionLine, Fault, FaultFlank, FaultyTeeth, PitCircle, damage_kinds,
};
pub use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
pub use crate::keys::{FileProblem, KeyDescription, KeyKind};
pub use crate::machine::{
    Bearing, BearingKind, Bow, Coupled, DampingRatio, Foot, GearboxShaft, Housing, HousingModes, Rig, Seat,
    Shaft, Support, SupportSprings, Unbalance, WheelInertia,
};
pub use crate::model::Model;
pub use crate::operation::{Operation, Profile, Ripple, Solver};
pub use crate::sensor::{FrequencyResponse, ResponseInput, Sensor, SensorDirection, SensorPath, SensorPlace};
pub use crate::wheel::{
    BodyRotation, ERROR_POINTS, EndRelief, FlankRelief, FoundationCoefficients, Gears, Hand, Material,
    MaterialConstants, ProfileErrors, Quality, ReliefShape, WheelDeviations, WheelName,
};
pub use edit::{NumberedScenario, ScenarioNumber, key_of_both_wheels, names_or_numbers, split_key};
pub use from_toml::{ScenarioFiles, line_of_key};
pub use gearbox_template::{GearboxRig, gearbox_template, gearbox_template_of_all_keys};
pub(crate) use layout::entry_key;
pub use layout::{Layout, Ratio};
pub use long::gearbox_sections;
pub use mesh::ScenarioMesh;
pub use meshtone_toml::ErrorKind;
pub use planetary::{Member, MemberShifts, MemberTeeth, OfSet, Pin, PlanetarySet, Rim, SetOrders};
pub use planetary_layout::SetLayout;
pub use short::{SectionDescription, sections};
pub use structure::{Shafts, Structure, Words};
pub use template::{template, template_kinds, template_of_all_keys};
pub use uncertainty::log_deviation;
pub(crate) use validate::unknown_kind;
pub use validate::{MEMORY_LIMIT_BYTES, MemoryLimit};
pub(crate) use wheel::MOST_WOBBLE;
pub use wheel::ScenarioWheel;

use crate::operation::{Motion, TimeGrid};

/// Everything that one simulation depends on.
///
/// A file states it in one of two forms, that of its structure: one pair in a rig by `[gears]`, `[quality]` and `[rig]`, or any number of
/// `[[shaft]]`, `[[wheel]]` and `[[mesh]]`.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
/// assert_eq!(scenario.meshes[0].pressure_angle_deg, 20.0);
/// ```
///
/// Later versions may know more of it: start from [`Scenario::new`] and set fields, or use [`Scenario::with_faults`],
/// [`Scenario::with_seed`] and [`Scenario::with_numbers`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scenario {
    /// Model of the meshes.
    pub model: Model,
    /// Seed of every random draw (profile errors, fluctuations, destruction noise, sensors' noise).
    pub seed: u64,
    /// Seed of the wheels' deviations; none for that of everything else.
    pub wheels_seed: Option<u64>,
    /// Material of shafts and wheels. Default steel.
    pub material: Material,
    /// The wheels; of a rig the pinion and the gear.
    pub wheels: Vec<ScenarioWheel>,
    /// Which wheels mesh.
    pub meshes: Vec<ScenarioMesh>,
    /// The machine around the wheels.
    pub structure: Structure,
    /// Speed and load.
    pub operation: Operation,
    /// Faults; none of healthy wheels.
    pub faults: Vec<Fault>,
    /// Listed sensors. A rig has further channels without them; among shafts of beams without one, a vertical one sits on every bearing's
    /// seat.
    pub sensors: Vec<Sensor>,
    /// Sampling, settling and initial state.
    pub solver: Solver,
}

/// A simulation takes what it is given.
impl From<&Scenario> for Scenario {
    fn from(scenario: &Scenario) -> Self {
        scenario.clone()
    }
}

/// The numbers that a scenario requires: everything else has a default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearPair {
    /// (mm) Module of both wheels.
    pub module_mm: f64,
    /// Tooth count of the driving wheel.
    pub pinion_teeth: u32,
    /// Tooth count of the driven wheel.
    pub gear_teeth: u32,
    /// (mm) Face width of both wheels.
    pub face_width_mm: f64,
    /// (rev/s) Speed of the driving wheel.
    pub pinion_speed_hz: f64,
    /// (N m) Load on the driven shaft.
    pub brake_torque_nm: f64,
}

impl GearPair {
    /// The pair of the paper's rig with a broken tooth: 17 and 38 teeth of module 3 mm and 15 mm wide, 40 rev/s and 10 N m. Examples and
    /// tests use it.
    ///
    /// ```
    /// use meshtone::scenario::GearPair;
    ///
    /// let stronger = GearPair { face_width_mm: 30.0, ..GearPair::example() };
    /// assert_eq!((stronger.pinion_teeth, stronger.gear_teeth), (17, 38));
    /// ```
    pub fn example() -> Self {
        Self {
            module_mm: 3.0,
            pinion_teeth: 17,
            gear_teeth: 38,
            face_width_mm: 15.0,
            pinion_speed_hz: 40.0,
            brake_torque_nm: 10.0,
        }
    }
}

impl Scenario {
    /// A healthy pair with every other key at its default.
    ///
    /// # Arguments
    /// * `pair` - what has no default
    pub fn new(pair: GearPair) -> Self {
        let GearPair { module_mm, pinion_teeth, gear_teeth, face_width_mm, pinion_speed_hz, brake_torque_nm } =
            pair;
        let mut scenario = Self::start_of_rig();
        scenario.set_gears(&Gears::new(module_mm, pinion_teeth, gear_teeth, face_width_mm));
        (scenario.operation.pinion_speed_hz, scenario.operation.brake_torque_nm) =
            (pinion_speed_hz, brake_torque_nm);
        scenario
    }

    /// Wheels on shafts of beams, with every other key at its default.
    ///
    /// # Arguments
    /// * `shafts`, `wheels`, `meshes`, `bearings` - its parts
    /// * `operation` - speed and load
    pub fn of_shafts(
        shafts: Vec<GearboxShaft>,
        wheels: Vec<ScenarioWheel>,
        meshes: Vec<ScenarioMesh>,
        bearings: Vec<Bearing>,
        operation: Operation,
    ) -> Self {
        let structure = Structure::Shafts(Shafts { shafts, bearings, ..Shafts::default() });
        Self { structure, wheels, meshes, operation, ..Self::start_of_shafts() }
    }

    /// States the geometry of the wheels of a rig.
    ///
    /// # Arguments
    /// * `gears` - the pinion and the gear
    pub fn set_gears(&mut self, gears: &Gears) {
        self.material = gears.material;
        if let ([mesh, ..], [pinion, gear, ..]) = (&mut self.meshes[..], &mut self.wheels[..]) {
            mesh.set_gears(gears, pinion, gear);
        }
    }

    /// How well the pinion and the gear of a rig are made.
    pub fn quality(&self) -> Quality {
        let [pinion, gear, ..] = &self.wheels[..] else { return Quality::default() };
        let errors = pinion.profile_errors_mm.clone().zip(gear.profile_errors_mm.clone());
        Quality {
            din_grade: pinion.din_grade,
            seed: self.wheels_seed,
            iso_class: pinion.iso_class,
            tooth_share: pinion.tooth_share,
            pitch_share: pinion.pitch_share,
            run_out_share: pinion.run_out_share,
            slope_wobble: pinion.slope_wobble,
            helix_share: pinion.helix_share,
            profile_errors: errors.map(|(pinion_profile_errors_mm, gear_profile_errors_mm)| ProfileErrors {
                pinion_profile_errors_mm,
                gear_profile_errors_mm,
            }),
            pinion_deviations: pinion.deviations.clone(),
            gear_deviations: gear.deviations.clone(),
        }
    }

    /// States how well the wheels of a rig are made.
    ///
    /// # Arguments
    /// * `quality` - of the pinion and the gear
    pub fn set_quality(&mut self, quality: Quality) {
        let Quality { profile_errors, pinion_deviations, gear_deviations, .. } = quality;
        self.wheels_seed = quality.seed;
        let [pinion, gear] = match profile_errors {
            Some(errors) => {
                [errors.pinion_profile_errors_mm, errors.gear_profile_errors_mm].map(Option::Some)
            }
            None => [None, None],
        };
        let given = [(pinion, pinion_deviations), (gear, gear_deviations)];
        for (wheel, (errors, deviations)) in self.wheels.iter_mut().zip(given) {
            (wheel.din_grade, wheel.iso_class) = (quality.din_grade, quality.iso_class);
            (wheel.tooth_share, wheel.pitch_share) = (quality.tooth_share, quality.pitch_share);
            (wheel.run_out_share, wheel.helix_share) = (quality.run_out_share, quality.helix_share);
            wheel.slope_wobble = quality.slope_wobble;
            (wheel.profile_errors_mm, wheel.deviations) = (errors, deviations);
        }
    }

    /// Returns the scenario with other damage.
    ///
    /// # Arguments
    /// * `faults` - what is broken; nothing in a healthy pair
    ///
    /// ```
    /// use meshtone::scenario::{Fault, GearPair, MissingTooth, Scenario};
    ///
    /// let healthy = Scenario::new(GearPair::example());
    /// let missing = healthy.clone().with_faults(vec![Fault::on_first_gear_tooth(MissingTooth)]);
    /// assert_eq!(missing.with_faults(Vec::new()), healthy);
    /// ```
    #[must_use]
    pub fn with_faults(self, faults: Vec<Fault>) -> Self {
        Self { faults, ..self }
    }

    /// Returns the scenario with another seed.
    ///
    /// # Arguments
    /// * `seed` - of every random draw
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Returns the scenario with other sensors.
    ///
    /// # Arguments
    /// * `sensors` - in the order of their channels
    pub fn with_sensors(self, sensors: Vec<Sensor>) -> Self {
        Self { sensors, ..self }
    }

    /// Motion of motor and brake, sample by sample from the start of the simulation.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn motion(&self, time: &TimeGrid) -> Motion<'_> {
        Motion::new(&self.operation, self.seed, time)
    }
}
