//! What the user asks for.
//!
//! A [`Scenario`] says everything that a simulation depends on: the two wheels, how they are
//! driven, how well they are made, what is broken, the rig they run in and how the equations are
//! solved. It is a plain value: build it in code, or read it from TOML with [`Scenario::from_toml`].
//! The names are the same everywhere (Rust fields, TOML keys, Python arguments).

mod edit;
mod form;
mod from_toml;
mod gearbox;
mod ignored_keys;
mod sections;
mod serialise;
mod template;
mod to_toml;
mod uncertainty;
mod validate;

pub use crate::bearing::{BearingDefect, DefectPlace};
pub use crate::damage::kinds::*;
pub use crate::damage::{Damage, DamageKind, DestructionLine, Fault, FaultyTeeth, PitCircle, damage_kinds};
pub use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
pub use crate::keys::{FileProblem, KeyDescription, KeyKind};
pub use crate::machine::{
    Bearing, BearingKind, Bow, Coupled, DampingRatio, Foot, GearboxShaft, Housing, Rig, Seat, Shaft, Support,
    SupportSprings, Unbalance, WheelInertia,
};
pub use crate::model::Model;
pub use crate::operation::{Operation, Profile, Ripple, Solver};
pub use crate::sensor::{FrequencyResponse, ResponseInput, Sensor, SensorDirection, SensorPath, SensorPlace};
pub use crate::wheel::{
    ERROR_POINTS, EndRelief, FlankRelief, FoundationCoefficients, Gears, Hand, Material, MaterialConstants,
    ProfileErrors, Quality, ReliefShape, WheelDeviations, WheelName,
};
pub use edit::{ScenarioNumber, names_or_numbers, split_key};
pub use form::ScenarioForm;
pub use from_toml::{ScenarioFiles, line_of_key};
pub use gearbox::{
    Gearbox, GearboxLayout, GearboxMesh, GearboxRig, GearboxWheel, Ratio, gearbox_sections, gearbox_template,
};
pub use meshtone_toml::ErrorKind;
pub use sections::{SectionDescription, sections};
pub use template::{template, template_kinds, template_of_all_keys};
pub use uncertainty::log_deviation;
pub(crate) use validate::unknown_kind;
pub use validate::{MEMORY_LIMIT_BYTES, MemoryLimit};

use crate::keys::Keys;
use crate::operation::{Motion, TimeGrid, samples_per_pitch, samples_per_pitch_of_published};

/// Everything that one simulation depends on.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.quality.din_grade = 7;
/// assert_eq!(scenario.gears.pressure_angle_deg, 20.0);
/// ```
///
/// Later versions may know more of it: start from [`Scenario::new`] and set fields, or use [`Scenario::with_faults`],
/// [`Scenario::with_seed`] and [`Scenario::with_numbers`].
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Scenario {
    /// Model of the mesh.
    pub model: Model,
    /// Seed of every random draw (profile errors, fluctuations, destruction noise, sensors' noise).
    pub seed: u64,
    /// The two wheels.
    pub gears: Gears,
    /// Speed and load.
    pub operation: Operation,
    /// Manufacturing quality.
    pub quality: Quality,
    /// Faults; none in a healthy pair.
    pub faults: Vec<Fault>,
    /// The rig around the wheels.
    pub rig: Rig,
    /// Listed sensors. Every simulation has further channels without them.
    pub sensors: Vec<Sensor>,
    /// Sampling, settling and initial state.
    pub solver: Solver,
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
        Self {
            gears: Gears::new(module_mm, pinion_teeth, gear_teeth, face_width_mm),
            operation: Operation::new(pinion_speed_hz, brake_torque_nm),
            ..Self::start()
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

    /// Division of time: sampling, length, what is discarded.
    pub fn time_grid(&self) -> TimeGrid {
        let Self { gears, operation, solver, .. } = self;
        let (rate_hz, speed_hz) = (solver.sampling_rate_hz, operation.pinion_speed_hz);
        let samples_per_pitch = if self.model.has_meshes() {
            samples_per_pitch(rate_hz, gears.pinion_teeth, speed_hz)
        } else {
            samples_per_pitch_of_published(rate_hz, [gears.pinion_teeth, gears.gear_teeth], speed_hz)
        };
        TimeGrid::new(gears, operation, solver, samples_per_pitch)
    }

    /// Motion of motor and brake, sample by sample from the start of the simulation.
    ///
    /// # Arguments
    /// * `time` - division of time
    pub fn motion(&self, time: &TimeGrid) -> Motion<'_> {
        Motion::new(&self.operation, self.seed, time)
    }
}
