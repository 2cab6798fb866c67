//! Speed and load.

use meshtone_toml::{ReadResult, TomlValue};

use crate::error::{ScenarioError, ScenarioWarning, WarningKind};
use crate::interpolation::straight_between;
use crate::keys::{
    Check, Columns, KeyKind, KeyRow, KeyValue, NumberFiles, Range, Written, keys, rows, rows_but,
};

/// Drive and load.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Operation {
    /// (rev/s) Nominal speed of the motor and of the shaft that is coupled to it, which a pair's pinion is on. A file with a speed profile may
    /// leave it out: the highest speed of that.
    pub pinion_speed_hz: f64,
    /// (N m) Nominal torque of the brake on the shaft that is coupled to it, which a pair's gear is on. Negative where that shaft drives: the other
    /// flanks of all wheels carry then.
    pub brake_torque_nm: f64,
    /// (Hz) Half width of a uniform error of the motor's speed, drawn for every sample. Default 0.
    pub speed_fluctuation_hz: f64,
    /// (%) Standard deviation of a slow random wander of the motor's speed, of the speed. Default 0.
    ///
    /// A Gaussian process of first order with a corner at 1 Hz and next to nothing above 8 Hz, from the start of the kept signal on. A recorded
    /// two-stage gearbox has 0.03 to 0.045 %: in a spectrum over time its lines of the orders above some 60 smear.
    pub speed_wander_percent: f64,
    /// (N m) Half width of a uniform error of the brake's torque, drawn for every sample. Default 0.
    pub torque_fluctuation_nm: f64,
    /// Speed of the motor against time, instead of the constant `pinion_speed_hz`, which stays
    /// the speed that the sampling rate is chosen for.
    pub speed_profile_hz: Option<Profile>,
    /// Torque of the brake against time, instead of the constant `brake_torque_nm`.
    pub torque_profile_nm: Option<Profile>,
    /// (kg m²) Inertia of the brake. Default 0.02.
    pub brake_inertia_kgm2: f64,
    /// Harmonics of the brake's torque over the rotation of any shaft. Default none.
    pub torque_ripple: Vec<Ripple>,
}

impl Operation {
    /// Constant speed and load.
    ///
    /// # Arguments
    /// They are the fields of the same names.
    pub fn new(pinion_speed_hz: f64, brake_torque_nm: f64) -> Self {
        Self {
            pinion_speed_hz,
            brake_torque_nm,
            speed_fluctuation_hz: 0.0,
            speed_wander_percent: 0.0,
            torque_fluctuation_nm: 0.0,
            speed_profile_hz: None,
            torque_profile_nm: None,
            brake_inertia_kgm2: 0.02,
            torque_ripple: Vec::new(),
        }
    }

    /// Whether speed and torque are constant, or the torque varies with whole harmonics of shafts alone, so that the motion repeats itself with the
    /// wheels': neither follows a profile or fluctuates.
    ///
    /// ```
    /// assert!(meshtone::operation::Operation::new(40.0, 10.0).is_steady());
    /// ```
    pub fn is_steady(&self) -> bool {
        self.is_steady_but_for_wander() && self.speed_wander_percent == 0.0
    }

    /// Whether the motion repeats itself with the wheels' but for a slow wander of the speed.
    pub(crate) fn is_steady_but_for_wander(&self) -> bool {
        self.speed_profile_hz.is_none()
            && self.torque_profile_nm.is_none()
            && !self.is_drawn_for_every_sample()
            && self.torque_ripple.iter().all(|ripple| ripple.order.fract() == 0.0)
    }

    /// Whether speed or torque has an error that is drawn for every sample: with another step the motion is another one.
    pub(crate) fn is_drawn_for_every_sample(&self) -> bool {
        self.speed_fluctuation_hz > 0.0 || self.torque_fluctuation_nm > 0.0
    }

    /// Whether speed and torque are constant.
    pub(crate) fn is_constant(&self) -> bool {
        self.is_steady() && self.torque_ripple.is_empty()
    }

    /// Whether the speed is constant.
    pub(crate) fn turns_evenly(&self) -> bool {
        self.keeps_speed() && self.speed_fluctuation_hz == 0.0
    }

    /// Whether the speed neither follows a profile nor wanders; errors of single samples may be.
    pub(crate) fn keeps_speed(&self) -> bool {
        self.speed_profile_hz.is_none() && self.speed_wander_percent == 0.0
    }

    /// Whether the brake drives at its nominal torque, so that the other flanks carry.
    pub(crate) fn overruns(&self) -> bool {
        self.brake_torque_nm < 0.0
    }

    /// Takes the highest speed of the profile as the nominal one, where none was given.
    pub(crate) fn complete(&mut self) {
        if let (true, Some(profile)) = (self.pinion_speed_hz.is_nan(), &self.speed_profile_hz) {
            self.pinion_speed_hz = profile.value.iter().copied().fold(f64::NAN, f64::max);
        }
    }

    /// The warning of harmonics that make the brake drive at times.
    pub(crate) fn reversed_torque(&self) -> Option<ScenarioWarning> {
        let sum: f64 = self.torque_ripple.iter().map(|ripple| ripple.amplitude).sum();
        let message = format!(
            "amplitudes add up to {sum}: where they come together the brake's torque reverses, and the teeth lose contact"
        );
        let warning = ScenarioWarning::new(WarningKind::TorqueReverses, "operation.torque_ripple", message);
        Some(warning).filter(|_| sum > 1.0)
    }

    /// (s) Where the last of the profiles ends; none without a profile.
    pub(crate) fn profiles_end_s(&self) -> Option<f64> {
        let profiles = [&self.speed_profile_hz, &self.torque_profile_nm].into_iter().flatten();
        profiles.filter_map(|profile| profile.time_s.last().copied()).reduce(f64::max)
    }

    /// Lets all profiles end at a time: longer ones are cut there, and shorter ones go on with their last value.
    ///
    /// # Arguments
    /// * `end_s` - (s) after 0
    ///
    /// ```
    /// use meshtone::operation::{Operation, Profile};
    ///
    /// let mut operation = Operation::new(40.0, 10.0);
    /// operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 2.0], value: vec![20.0, 40.0] });
    /// operation.end_profiles_at(1.0);
    /// assert_eq!(operation.speed_profile_hz.unwrap().value, [20.0, 30.0]);
    /// ```
    pub fn end_profiles_at(&mut self, end_s: f64) {
        for profile in [&mut self.speed_profile_hz, &mut self.torque_profile_nm].into_iter().flatten() {
            let end = profile.at(end_s);
            let kept = profile.time_s.iter().take_while(|time_s| **time_s < end_s).count();
            profile.time_s.truncate(kept);
            profile.value.truncate(kept);
            if kept == 0 {
                // It began later: until then its first value holds.
                (profile.time_s, profile.value) = (vec![0.0], vec![end]);
            }
            profile.time_s.push(end_s);
            profile.value.push(end);
        }
    }

    /// Refuses a length of the kept signal that is not that of the profiles: these are kept whole.
    ///
    /// # Arguments
    /// * `key`, `value` - of the length
    /// * `kept_s` - (s) the length
    pub(crate) fn check_length(&self, key: &str, value: f64, kept_s: f64) -> Check {
        let Some(end_s) = self.profiles_end_s().filter(|end_s| (kept_s / end_s - 1.0).abs() > SAME_LENGTH)
        else {
            return Ok(());
        };
        let problem = format!(
            "given beside a profile that ends at {end_s} s; the kept signal is as long as the profile"
        );
        Err(ScenarioError::new(key, value, problem)
            .with_help(format!("remove it, or let the profile end at {kept_s} s")))
    }
}

/// The key that states the speed in place of the nominal one.
const SPEED_PROFILE: &[&str] = &["speed_profile_hz"];

/// (%) Largest standard deviation of the speed's wander: five of them are half the speed.
const MOST_WANDER: f64 = 10.0;

/// (-) Part of a length by which a profile may differ from it.
const SAME_LENGTH: f64 = 1e-6;

keys! {
    "operation": Operation = Self::new(f64::NAN, f64::NAN);
    pinion_speed_hz "rev/s"
        "the nominal speed of the motor and the pinion; the sampling rate is chosen for it"
        .required_unless(SPEED_PROFILE).range(SPEED);
    brake_torque_nm "N m" "the nominal torque of the brake on the gear's shaft, negative where it drives"
        .required().range(TORQUE);
    speed_fluctuation_hz "Hz" "the amplitude of the uniform random error of every sample's speed"
        .range(Range::not_negative()).rule("less than the lowest speed");
    speed_wander_percent "%"
        "the standard deviation of a slow random wander of the speed, below about 8 Hz; a recorded machine has 0.03 %"
        .range(Range::from_to(0.0, MOST_WANDER));
    torque_fluctuation_nm "N m" "the amplitude of the uniform random error of every sample's torque"
        .range(Range::not_negative()).rule("less than the lowest torque");
    speed_profile_hz "s, Hz"
        "the speed against time from the start of the kept signal, which ends with it, { time_s = […], value = […] }, straight between the points, constant outside them; or { file = \"….csv\" } with the columns time_s and value"
        .otherwise("none").rule("at least 2 points, times increasing, values > 0")
        .example("{ time_s = [0.0, 1.0], value = [40.0, 40.0] }");
    torque_profile_nm "s, N m" "the torque against time, likewise"
        .otherwise("none").rule("likewise, values of one sign")
        .example("{ time_s = [0.0, 1.0], value = [10.0, 10.0] }");
    torque_ripple ""
        "harmonics of the brake's torque over the rotation θ of a shaft, T (1 + Σ a cos(hθ + ψ))"
        .otherwise("none").rule("amplitudes add up to 1.2 at most")
        .alternative("[{ order = 2.0, amplitude = 0.05 }]");
}

impl Operation {
    /// The rows where motor and brake are coupled to any two shafts.
    pub(crate) fn rows_of_shafts() -> Vec<KeyRow<Self>> {
        rows! {
            <pinion_speed_hz> input_speed_hz "rev/s"
                "the nominal speed of the motor and of the shaft that is coupled to it; the sampling rate is chosen for it"
                .required_unless(SPEED_PROFILE).range(SPEED);
            brake_torque_nm "N m"
                "the nominal torque of the brake on the shaft that is coupled to it, negative where it drives"
                .required().range(TORQUE);
            .. { rows_but(&["pinion_speed_hz", "brake_torque_nm"]) };
            brake_inertia_kgm2 "kg m²" "the inertia of the brake" .range(Range::positive().implausible_above(1e9));
        }
    }
}

/// (rev/s) Speeds that are plausible.
const SPEED: Range = Range::positive().implausible_above(1e5);
/// (N m) Beyond it there is no wheel: a tooth of module 100 and a metre wide breaks at less.
const TORQUE: Range = Range::from_to(-1e9, 1e9);

/// (-) Largest sum of the amplitudes of the torque's harmonics. Beyond it the motion flips between two states.
pub(crate) const MOST_RIPPLE: f64 = 1.2;

/// A harmonic of the brake's torque.
#[derive(Debug, Clone, PartialEq)]
pub struct Ripple {
    /// Name of the shaft with whose rotation it comes; none for the brake's.
    pub shaft: Option<String>,
    /// (-) h: the number of its periods per revolution of that shaft.
    pub order: f64,
    /// (-) a: its amplitude as a part of the torque.
    pub amplitude: f64,
    /// (°) ψ: its phase at the start. Default 0.
    pub phase_deg: f64,
}

keys! {
    Ripple = Self { shaft: None, order: f64::NAN, amplitude: f64::NAN, phase_deg: 0.0 };
    shaft "" "the name of the shaft with whose rotation it comes"
        .otherwise("that of the brake").alternative("\"input\"");
    order "-" "the number of its periods per revolution of that shaft"
        .required().range(Range::positive().implausible_above(1e4));
    amplitude "-" "its amplitude as a part of the torque" .required().range(Range::from_to(0.0, MOST_RIPPLE));
    phase_deg "°" "its phase at the start";
}

/// A quantity against time: straight lines between the points, constant outside them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Profile {
    /// (s) Strictly increasing times from 0 on, where the kept signal starts; before it, the first value holds.
    pub time_s: Vec<f64>,
    /// (Hz or N m) The quantity at those times.
    pub value: Vec<f64>,
}

impl Profile {
    /// (Hz or N m) The quantity at a time: straight lines between its points, constant outside.
    pub(crate) fn at(&self, time_s: f64) -> f64 {
        straight_between(&self.time_s, &self.value, time_s)
    }
}

/// Its columns, in a table and in a file.
const COLUMNS: Columns<2> =
    Columns { noun: "a profile", names: ["time_s", "value"], inline: ["time_s or value", "inline values"] };

impl KeyValue for Profile {
    fn read(&mut self, value: &TomlValue<'_>, files: &dyn NumberFiles) -> ReadResult<()> {
        let [time_s, value] = COLUMNS.read(value, |name| files.times_and_values(name))?;
        *self = Self { time_s, value };
        Ok(())
    }

    fn write(&self) -> Written {
        COLUMNS.write([&self.time_s, &self.value])
    }

    fn check(&self, key: &str, _range: &Range, _unit: &str) -> Check {
        self.check_points(key)
    }

    fn kind() -> KeyKind {
        KeyKind::Profile
    }
}
