//! A sensor: where it sits, and what it makes of the motion there.

use meshtone_toml::{ReadResult, TomlValue};

use super::ChannelKind;
use super::frequency_response::FrequencyResponse;
use super::path::SensorPath;
use crate::error::ScenarioError;
use crate::keys::{
    Check, KeyKind, KeyRow, KeyValue, NumberFiles, Range, Written, by_name, check_keys, keys, require, rows,
    rows_but,
};
use crate::model::Model;

/// An accelerometer on the rig.
///
/// ```
/// use meshtone::scenario::{GearPair, Scenario, Sensor};
///
/// let mut sensor = Sensor::default();
/// sensor.resonance_hz = Some(12e3);
/// let mut scenario = Scenario::new(GearPair::example())
///     .with_sensors(vec![sensor]);
/// scenario.solver.sampling_rate_hz = 2e4;
/// let channels = meshtone::simulate(&scenario)?.channels;
/// assert_eq!(channels.signals[0].name, "pinion_support_vertical_g");
/// # Ok::<(), meshtone::Error>(())
/// ```
///
/// Later versions may know more of it: start from [`Sensor::default`] and set fields.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Sensor {
    /// Its name, of which its channel's is made: `NAME_g`. Default: place and direction.
    pub name: Option<String>,
    /// Place at which it sits. Default the support of the pinion's shaft.
    pub at: SensorPlace,
    /// In which direction it measures. Default vertical.
    pub direction: SensorDirection,
    /// (Hz) Mounted resonance. Default: none.
    pub resonance_hz: Option<f64>,
    /// (-) Damping of the mounted resonance over the critical one. Default 0.02.
    pub resonance_damping_ratio: f64,
    /// (g/√Hz) Density of its noise, white and normal. Default 0.
    pub noise_density_g_per_rthz: f64,
    /// Seed of the noise. Default: the scenario's seed.
    pub noise_seed: Option<u64>,
    /// (g) Largest acceleration, of either sign, that it shows. Default: none.
    pub range_g: Option<f64>,
    /// (bits) Resolution over the whole range, from minus to plus. Default: none.
    pub bits: Option<u32>,
    /// The wall and the housing between its place and it; rigid under `linear` and `published`. Default a wall.
    pub path: SensorPath,
    /// Measured frequency response of the path to it. Default: none.
    pub frequency_response: Option<FrequencyResponse>,
    /// Input of [`Self::frequency_response`]. Default the acceleration of its place.
    pub response_input: ResponseInput,
}

/// Place at which a sensor sits.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SensorPlace {
    /// On both supports: their mean.
    Support,
    /// On the support of the pinion's shaft.
    #[default]
    PinionSupport,
    /// On the support of the gear's shaft.
    GearSupport,
    /// On the wheels themselves: the sum of both, as published.
    Wheels,
    /// Among shafts of beams: `SHAFT:AT` for the seat of the bearing there, `shaft:SHAFT:AT` for the shaft itself, `housing:[x, y, z]` in mm
    /// for a point of the housing, `ring:SET:DEGREES` for a place on the ring of a planetary set, `ring:SET:DEGREES:far` for one away from its rim.
    Of(String),
}

impl SensorPlace {
    /// The places of a rig.
    const OF_RIG: [Self; 4] = [Self::Support, Self::PinionSupport, Self::GearSupport, Self::Wheels];

    /// The name in the scenario file.
    pub fn name(&self) -> &str {
        match self {
            Self::Support => "support",
            Self::PinionSupport => "pinion-support",
            Self::GearSupport => "gear-support",
            Self::Wheels => "wheels",
            Self::Of(name) => name,
        }
    }
}

/// Any text is the name of a place: which of them there are, the structure says.
impl KeyValue for SensorPlace {
    fn read(&mut self, value: &TomlValue<'_>, _files: &dyn NumberFiles) -> ReadResult<()> {
        let name = value.string()?;
        let of_rig = Self::OF_RIG.into_iter().find(|place| place.name() == name);
        *self = of_rig.unwrap_or_else(|| Self::Of(name.to_owned()));
        Ok(())
    }

    fn write(&self) -> Written {
        self.name().to_owned().write()
    }

    fn kind() -> KeyKind {
        KeyKind::Text
    }
}

/// In which direction a sensor measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SensorDirection {
    /// Across the shafts, square to the line between them.
    #[default]
    Vertical,
    /// From shaft to shaft.
    Horizontal,
    /// Along the shafts.
    Axial,
    /// On a ring, outwards from its axis.
    Radial,
    /// On a ring, around its axis in the sense of positive rotation.
    Tangential,
}

by_name!(SensorDirection, [
    "radial" => SensorDirection::Radial,
    "tangential" => SensorDirection::Tangential,
    "vertical" => SensorDirection::Vertical,
    "horizontal" => SensorDirection::Horizontal,
    "axial" => SensorDirection::Axial,
]);

/// Input of a measured frequency response.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ResponseInput {
    /// The acceleration of the sensor's place; magnitudes have no unit.
    #[default]
    Acceleration,
    /// The force along the line of action; magnitudes are in (m/s²)/N.
    Force,
}

by_name!(ResponseInput, ["acceleration" => ResponseInput::Acceleration, "force" => ResponseInput::Force]);

keys! {
    "sensor": Sensor = default Self {
        name: None,
        at: SensorPlace::default(),
        direction: SensorDirection::default(),
        resonance_hz: None,
        resonance_damping_ratio: 0.02,
        noise_density_g_per_rthz: 0.0,
        noise_seed: None,
        range_g: None,
        bits: None,
        path: SensorPath::default(),
        frequency_response: None,
        response_input: ResponseInput::default(),
    };
    name "" "the sensor's name; its signal is the channel `NAME_g`"
        .otherwise("place and direction, such as `gear_support_vertical`")
        .rule("a letter, then letters, digits and `_`; no other channel's")
        .example("\"accelerometer_1\"");
    at ""
        "where it sits: on both supports (their mean), on one, or on the wheels (their sum); always the wheels under linear and published"
        .kind(KeyKind::Name(vec!["support", "pinion-support", "gear-support", "wheels"]));
    direction "" "the direction it measures in; under contact axial only at the wheels";
    resonance_hz "Hz" "the natural frequency of the sensor on its mount"
        .otherwise("none").range(Range::positive().implausible_above(1e7)).example("12000.0");
    resonance_damping_ratio "-" "the damping ratio of that resonance"
        .range(Range::positive().implausible_above(10.0));
    noise_density_g_per_rthz "g/√Hz"
        "the density of its white normal noise: the standard deviation over the root of half the sampling rate"
        .range(Range::not_negative().implausible_above(1e3));
    noise_seed "" "the seed of the noise alone" .otherwise("the scenario's `seed`").example("1");
    range_g "g" "the largest acceleration, of either sign, that it measures"
        .otherwise("none").range(Range::positive().implausible_above(1e9)).example("50.0");
    bits "" "the resolution: the range from minus to plus has 2^bits steps"
        .otherwise("none").range(Range::from_to(8.0, 32.0)).rule("with range_g").example("16");
    path "" "the wall and the modes of a housing between its place and the sensor; rigid under linear and published";
    frequency_response "Hz, -, °"
        "the measured path to the sensor: magnitude and phase over frequency, straight between the points, the phase unwrapped; zero outside them. Or { file = \"….csv\" } with the columns frequency_hz, magnitude, phase_deg"
        .otherwise("none").rule("at least 2 points, frequencies increasing from 0 on, magnitudes ≥ 0")
        .example("{ frequency_hz = [0.0, 20000.0], magnitude = [1.0, 1.0], phase_deg = [0.0, 0.0] }");
    response_input ""
        "the input of the frequency response: the place's acceleration, magnitudes without unit; or, regardless of `at` and `direction`, the force along the line of action, magnitudes in (m/s²)/N"
        .rule("\"force\" with frequency_response");
}

/// A place on the ring of a planetary set.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RingPlace {
    /// Name of the set.
    pub(crate) set: String,
    /// (rad) Where on the ring, from x towards y.
    pub(crate) angle_rad: f64,
    /// Whether it is away from the rim.
    pub(crate) is_far: bool,
}

impl RingPlace {
    /// The place that a text names: `ring:p:90`, `ring:p:90:far`.
    pub(crate) fn of(at: &str) -> Option<Self> {
        let parts: Vec<&str> = at.strip_prefix("ring:")?.split(':').collect();
        let (set, angle, is_far) = match parts[..] {
            [set, angle] => (set, angle, false),
            [set, angle, "far"] => (set, angle, true),
            _ => return None,
        };
        let angle_deg: f64 = angle.trim().parse().ok().filter(|angle: &f64| angle.is_finite())?;
        Some(Self { set: set.to_owned(), angle_rad: angle_deg.to_radians(), is_far })
    }
}

impl Sensor {
    /// A vertical sensor at a place among shafts of beams. Seats and housing move by themselves: no wall bends between them and the sensor.
    ///
    /// # Arguments
    /// * `at` - where it sits, as [`SensorPlace::Of`] has it
    pub fn at_place(at: &str) -> Self {
        Self { at: SensorPlace::Of(at.to_owned()), path: SensorPath::RIGID, ..Self::default() }
    }

    /// The rows among shafts of beams.
    pub(crate) fn rows_of_shafts() -> Vec<KeyRow<Self>> {
        rows! {
            at "" "where it sits: \"SHAFT:AT\" on the seat of the bearing there, \"shaft:SHAFT:AT\" on the shaft itself, \"housing:[x, y, z]\" in mm on the housing, \"ring:SET:DEGREES\" on the ring of a planetary set, with \":far\" behind it away from the rim"
                .required();
            name "" "the sensor's name; its signal is the channel `NAME_g`"
                .otherwise("place and direction, such as `input_0_vertical`")
                .rule("a letter, then letters, digits and `_`; no other channel's")
                .alternative("\"output_bearing\"");
            direction "" "the direction it measures in";
            .. { rows_but(&["at", "name", "direction", "response_input"]) };
        }
    }

    /// Its name, given or by place and direction.
    pub fn name(&self) -> String {
        let by_place = || {
            let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
            let place: String = self.at.name().chars().map(letter).collect();
            let place = place.trim_matches('_').replace("__", "_");
            format!("{place}_{}", self.direction.name())
        };
        self.name.clone().unwrap_or_else(by_place)
    }

    /// The name of its signal's channel, with the unit at the end.
    ///
    /// ```
    /// use meshtone::scenario::{Sensor, SensorPlace};
    ///
    /// let mut sensor = Sensor::default();
    /// sensor.at = SensorPlace::GearSupport;
    /// assert_eq!(sensor.channel(), "gear_support_vertical_g");
    /// ```
    pub fn channel(&self) -> String {
        channel_of(&self.name())
    }

    /// Returns whether what it shows depends on the motion of its place.
    fn reads_its_place(&self) -> bool {
        self.response_input == ResponseInput::Acceleration
    }

    /// What a sensor makes of the motion of its place, wherever that is: name, path, converter.
    pub(crate) fn check_signal(&self) -> Check {
        self.path.check()?;
        if let Some(name) = &self.name {
            check_name(name)?;
        }
        if let (Some(bits), None) = (self.bits, self.range_g) {
            let problem = "needs sensor.range_g: the steps divide the range";
            return Err(
                ScenarioError::new("sensor.bits", bits, problem).with_help("write sensor.range_g too")
            );
        }
        self.check_direction()
    }

    /// A ring moves outwards and around, every other place along the axes; the set of a ring is spur, and does not move along its shafts.
    fn check_direction(&self) -> Check {
        use SensorDirection::{Axial, Radial, Tangential};
        let refused = |problem: &str, help: &str| {
            let value = format!("{:?}", self.direction.name());
            Err(ScenarioError::new("sensor.direction", value, problem).with_help(help))
        };
        match (self.direction, RingPlace::of(self.at.name())) {
            (Radial | Tangential, None) if self.reads_its_place() => refused(
                "can be measured only on the ring of a planetary set",
                "write sensor.at = \"ring:SET:DEGREES\", or take another direction",
            ),
            (Axial, Some(_)) => refused(
                "cannot be measured on a ring, which moves only across its axis",
                "take \"radial\", \"tangential\", \"vertical\" or \"horizontal\"",
            ),
            _ => Ok(()),
        }
    }

    fn check(&self, model: Model) -> Check {
        check_keys(self, "sensor")?;
        self.check_signal()?;
        // Where the place is ignored, every sensor sits on the wheels.
        let on_support = self.at != SensorPlace::Wheels && !model.ignores("sensor.at");
        if on_support && self.reads_its_place() && self.direction == SensorDirection::Axial {
            let problem = "cannot be measured at a support, which moves only across the shafts";
            return Err(ScenarioError::new("sensor.direction", "\"axial\"", problem)
                .with_help("write sensor.at = \"wheels\", or take another direction"));
        }
        if self.response_input == ResponseInput::Force && self.frequency_response.is_none() {
            let problem = "needs sensor.frequency_response: a force is no acceleration";
            return Err(ScenarioError::new("sensor.response_input", "\"force\"", problem)
                .with_help("write sensor.frequency_response too, with magnitudes in (m/s²)/N"));
        }
        Ok(())
    }
}

/// The name of a sensor's channel.
pub(super) fn channel_of(name: &str) -> String {
    format!("{name}_g")
}

/// Most letters of a name.
const LONGEST_NAME: usize = 64;

/// Returns whether a text can be a sensor's name, whatever others there are.
pub(super) fn is_name(name: &str) -> bool {
    name.len() <= LONGEST_NAME
        && name.starts_with(|first: char| first.is_ascii_alphabetic())
        && name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_')
}

/// Names whose channels would be taken for others: those of columns beside the channels.
const TAKEN: [&str; 3] = ["average", "difference", "enhanced_difference"];

fn check_name(name: &str) -> Check {
    let refused = |problem: String| Err(ScenarioError::new("sensor.name", format!("{name:?}"), problem));
    if !is_name(name) {
        return refused(format!(
            "must be a letter, then letters without accents, digits and `_`, at most {LONGEST_NAME} in all"
        ));
    }
    let channel = channel_of(name);
    if TAKEN.contains(&name) || ChannelKind::ALL.iter().any(|kind| kind.name() == channel) {
        return refused(format!("its channel {channel} has the name of another channel; take another name"));
    }
    Ok(())
}

/// Checks every sensor, alone and beside the others.
///
/// # Arguments
/// * `sensors` - all of a scenario
/// * `model` - of the mesh, which says where sensors can be
pub(crate) fn check_sensors(sensors: &[Sensor], model: Model) -> Check {
    for (index, sensor) in sensors.iter().enumerate() {
        sensor.check(model).map_err(|error| error.in_entry("sensor", index, sensors.len()))?;
        check_own_name(sensors, index)?;
    }
    Ok(())
}

/// Refuses a sensor with the name of one before it.
pub(crate) fn check_own_name(sensors: &[Sensor], index: usize) -> Check {
    let name = sensors[index].name();
    let Some(other) = sensors[..index].iter().position(|other| other.name() == name) else { return Ok(()) };
    let problem = format!("is the name of sensor[{other}] already; no two have the same channel");
    Err(ScenarioError::new(format!("sensor[{index}].name"), format!("{name:?}"), problem)
        .with_help("give it a name of its own"))
}

/// (-) A number of a frequency response must be finite, and must not be less than 0.
pub(super) fn finite_and_not_negative(key: &str, value: f64) -> Check {
    require(key, value, value.is_finite() && value >= 0.0, "must be a finite number, 0 or more")
}
