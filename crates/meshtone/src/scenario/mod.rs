//! Stage 1: what the user asks for.
//!
//! A [`Scenario`] says everything that a simulation depends on: the two wheels, how they are
//! driven, how well they are made, what is broken, the rig they run in and how the equations are
//! solved. It is a plain value: build it in code, or read it from TOML with [`Scenario::from_toml`].
//! The names are the same everywhere (Rust fields, TOML keys, Python arguments).

mod edit;
mod error;
mod fault;
mod from_toml;
mod gears;
mod honoured;
mod material;
mod operation;
mod quality;
mod rig;
mod solver;
mod template;
mod to_toml;
mod validate;

pub use edit::ScenarioNumber;
pub use error::{ScenarioError, ScenarioWarning};
pub use fault::{
    DestructionLine, Fault, PartialFace, PitCircle, ThroughFace, ToothBreakage, ToothDestruction,
};
pub use from_toml::{FileProblem, ScenarioFiles, line_of_key};
pub use gears::{FoundationCoefficients, Gears, ReliefShape, TipRelief};
pub use material::Material;
pub use operation::{Operation, Profile};
pub use quality::{ERROR_POINTS, ProfileErrors, Quality};
pub use rig::{DampingRatio, Rig, Shaft, WheelInertia};
pub use solver::Solver;
pub use template::{TEMPLATE_KINDS, template};
pub use validate::{MEMORY_LIMIT_BYTES, MemoryLimit};

/// Which of two readings of the model is simulated.
///
/// The published code differs from the theory of its own paper in several places (listed in the
/// chapter "Published and corrected" of the documentation).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Convention {
    /// What the paper's own theory says. The default.
    #[default]
    Corrected,
    /// The published code, its slips included, so that results can be compared number by number.
    Published,
}

/// Everything that one simulation depends on.
///
/// ```
/// use meshtone::scenario::Scenario;
///
/// let mut scenario = Scenario::new(3.0, 17, 38, 15.0, 40.0, 10.0);
/// scenario.quality.din_grade = 7;
/// assert_eq!(scenario.gears.pressure_angle_deg, 20.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Published or corrected model.
    pub convention: Convention,
    /// Seed of every random draw (profile errors, fluctuations, destruction noise).
    pub seed: u64,
    /// The two wheels.
    pub gears: Gears,
    /// Speed and load.
    pub operation: Operation,
    /// Manufacturing quality.
    pub quality: Quality,
    /// The damage on the gear's first tooth; none for a healthy pair.
    pub fault: Option<Fault>,
    /// The rig around the wheels.
    pub rig: Rig,
    /// Sampling, settling and initial state.
    pub solver: Solver,
}

impl Scenario {
    /// A healthy pair with every other key at its default.
    ///
    /// # Arguments
    /// * `module_mm` - (mm) module of both wheels
    /// * `pinion_teeth`, `gear_teeth` - tooth counts of the driving and the driven wheel
    /// * `face_width_mm` - (mm) face width of both wheels
    /// * `pinion_speed_hz` - (rev/s) speed of the driving wheel
    /// * `brake_torque_nm` - (N m) load on the driven shaft
    pub fn new(
        module_mm: f64,
        pinion_teeth: u32,
        gear_teeth: u32,
        face_width_mm: f64,
        pinion_speed_hz: f64,
        brake_torque_nm: f64,
    ) -> Self {
        Self {
            convention: Convention::default(),
            seed: 1,
            gears: Gears::new(module_mm, pinion_teeth, gear_teeth, face_width_mm),
            operation: Operation::new(pinion_speed_hz, brake_torque_nm),
            quality: Quality::default(),
            fault: None,
            rig: Rig::default(),
            solver: Solver::default(),
        }
    }
}
