//! Errors and warnings about a scenario.

use std::fmt;

use meshtone_toml::TomlError;
use serde::{Deserialize, Serialize};

/// A scenario that cannot be simulated: which key, what it says, what is allowed.
///
/// ```
/// use meshtone::scenario::{ErrorKind, Scenario};
///
/// let text = "[gears]\nmodule_mm = -3.0\npinion_teeth = 17\ngear_teeth = 38\nface_width_mm = 15.0\n\
///             [operation]\npinion_speed_hz = 40.0\nbrake_torque_nm = 10.0\n";
/// let error = Scenario::from_toml(text).unwrap_err();
/// assert_eq!(error.key, "gears.module_mm");
/// assert_eq!((error.kind, error.line), (ErrorKind::NotAllowed, Some(2)));
/// assert_eq!(error.to_string(), "line 2: gears.module_mm = -3.0: must be more than 0 mm");
/// ```
pub type ScenarioError = TomlError;

/// Foundation coefficients with which a healthy pair of teeth would not be stiff.
///
/// # Arguments
/// * `key`, `help` - of [`NamedGears::foundation`](crate::wheel::NamedGears::foundation)
pub(crate) fn not_stiff((key, help): (String, &str)) -> ScenarioError {
    let problem =
        "the compliance of the healthy tooth pair would not be positive at every point of contact; must be";
    ScenarioError::new(key, "", problem).with_help(help)
}

/// Damage that leaves no tooth that could carry a load.
pub(crate) fn nothing_left() -> ScenarioError {
    let problem = "the faults leave no pair of teeth that could touch; at least one must be left";
    ScenarioError::new("fault", "", problem).with_help("remove some of the faults")
}

/// Why there is no simulation.
///
/// ```
/// use meshtone::Error;
/// use meshtone::scenario::{GearPair, Scenario};
///
/// let mut scenario = Scenario::new(GearPair::example());
/// scenario.wheels[0].eccentricity_mm = -0.1;
/// match meshtone::simulate(&scenario).map(drop) {
///     Err(Error::Scenario(error)) => assert_eq!(error.key, "rig.eccentricity_mm"),
///     Err(Error::Diverged { time_s, .. }) => println!("no motion is left after {time_s} s"),
///     other => println!("{other:?}"),
/// }
/// ```
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scenario is not valid, or a fault does not fit its tooth.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    /// The motion grows without bound.
    #[error(
        "the motion grows without bound within {time_s:.4} s, with {key} = {}; damping must remove the \
         energy that the varying mesh stiffness adds to a mode, and a missing tooth must leave another in \
         contact",
        in_short(.damping_ratios)
    )]
    Diverged {
        /// (s) When that was noticed, from the start of the simulation.
        time_s: f64,
        /// The key that damps the modes.
        key: &'static str,
        /// What the user can do.
        help: &'static str,
        /// (-) The damping ratio of each mode, in the order of rising natural frequency.
        damping_ratios: Vec<f64>,
    },
    /// A result that no machine can have, or that breaks a law that every machine obeys.
    #[error("{problem}")]
    Impossible {
        /// Which law, and by how much.
        problem: String,
        /// What the user can do.
        help: String,
    },
}

impl Error {
    /// Advice, where the message does not make it plain.
    pub fn help(&self) -> Option<&str> {
        match self {
            Self::Scenario(error) => error.help.as_deref(),
            Self::Diverged { help, .. } => Some(help),
            Self::Impossible { help, .. } => Some(help),
        }
    }
}

/// One number where all are the same, else the least and the largest: a gearbox has hundreds.
fn in_short(ratios: &[f64]) -> String {
    match ratios {
        [first, rest @ ..] if rest.iter().all(|ratio| ratio == first) => format!("{first:?}"),
        _ => [f64::min, f64::max]
            .map(|of| format!("{:?}", ratios.iter().copied().fold(f64::NAN, of)))
            .join(" to "),
    }
}

/// One row a kind of doubt: its name, the code that programs read, what it means.
macro_rules! warning_kinds {
    ($($kind:ident $code:literal $meaning:literal;)+) => {
        /// Subject of a [`ScenarioWarning`], by which programs distinguish warnings.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[non_exhaustive]
        pub enum WarningKind {
            $(#[doc = concat!($meaning, ".")] #[serde(rename = $code)] $kind,)+
        }

        impl WarningKind {
            /// All of its values.
            pub const ALL: [Self; [$($code),+].len()] = [$(Self::$kind),+];

            /// The code, which stays the same whatever the words are.
            pub fn code(self) -> &'static str {
                match self { $(Self::$kind => $code,)+ }
            }

            /// The kind of a code.
            ///
            /// # Arguments
            /// * `code` - as [`Self::code`] gives it
            pub fn of_code(code: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|kind| kind.code() == code)
            }

            /// Its meaning, in a few words.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$kind => $meaning,)+ }
            }
        }
    };
}

warning_kinds! {
    Undercut "undercut" "teeth are undercut, but their simulated profile is not";
    ThinTips "thin-tips" "tips are so thin that they could break off";
    IgnoredKey "ignored-key" "a key has no effect";
    FormerDefaults "former-defaults" "keys that are left out have the defaults of former files";
    FastTeeth "fast-teeth" "the pitch line is faster than gears usually run";
    Gyroscopic "gyroscopic" "gyroscopic moments, which are neglected, shift a natural frequency by more than 2 %";
    IdlePlanet "idle-planet" "a planet carries less than a tenth of its share of the load";
    TurningFrame "turning-frame" "the forces of a carrier's turning frame, which are neglected, shift natural frequencies by more than 1 %";
    AddedThrust "added-thrust" "the axial forces of two helical wheels add up on their shaft";
    LongCycle "long-cycle" "the machine repeats itself only after a very long time";
    SpeedProfileOff "speed-profile-off" "a speed profile never comes near the nominal speed";
    EqualWheels "equal-wheels" "both wheels move in opposition, and the supports' accelerations cancel";
    Unsettled "unsettled" "a start-up transient changes the rms of the kept signal by more than 1 %";
    TorqueImbalance "torque-imbalance" "the mean forces of the meshes differ from those that the load asks for by more than 1 %";
    Rattle "rattle" "the teeth of a mesh lose contact for more than half of the time and bounce";
    SilentSensor "silent-sensor" "a sensor shows exactly 0 throughout";
    BeyondBand "beyond-band" "a sensor or a mesh lies above the highest mode that is simulated";
    LargeRunOut "large-run-out" "a wheel runs out by more than a tenth of the module";
    Overload "overload" "the load would break the teeth";
    UnevenFace "uneven-face" "the shafts lean so much that the load is at one end of the face";
    NoContact "no-contact" "at times no pair of teeth is on the path of contact: a linear mesh has no stiffness there, else corners of tips touch";
    MeshPulls "mesh-pulls" "the linear mesh pulls where real teeth would separate";
    Resonance "resonance" "the mesh force is far beyond what a machine survives";
    MeshResonance "mesh-resonance" "a mesh frequency, or twice or three times it, is within 1 % of a natural frequency";
    BrakedRotation "braked-rotation" "the published model's damping brakes the whole machine, and the mean mesh force differs from the load's";
    TorqueReverses "torque-reverses" "the brake's torque reverses at times, so that the teeth lose contact";
    OtherSpeed "other-speed" "a shaft does not turn at the speed that it is driven at";
    StepError "step-error" "the step changes the rms by more than 2 %";
}

/// Something about a scenario that can be simulated but deserves the user's attention.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ScenarioWarning {
    /// Subject of the warning.
    #[serde(rename = "code")]
    pub kind: WarningKind,
    /// Dotted key in the scenario file.
    pub key: String,
    /// The doubt, and what could be done.
    pub message: String,
}

impl ScenarioWarning {
    /// A warning about `key`.
    ///
    /// # Arguments
    /// * `kind` - what it is about
    /// * `key` - dotted key in the scenario file
    /// * `message` - what is doubtful, and what could be done
    pub fn new(kind: WarningKind, key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { kind, key: key.into(), message: message.into() }
    }
}

impl fmt::Display for ScenarioWarning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}: {}", self.key, self.message)
    }
}
