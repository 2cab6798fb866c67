//! The angle of the shaft at each sample.

use std::path::{Path, PathBuf};

use meshtone::scenario::Scenario;
use meshtone::signal::{MeshTone, ShaftPhase, StatedFacts, StatedTurning, Tachometer, tachometer_pulses};
use meshtone_io::indicators::WarningEntry;
use meshtone_plot::DamagedTooth;

use super::options::PhaseOptions;
use super::phase_files::{columns, hertz, pulse_times, times_s};
use super::reading::Input;
use super::refuse::{RefusedInput, refuse};
use crate::failure::Failure;

/// Relative deviation of two sampling rates that is rounding.
const RATE_ROUNDING: f64 = 1e-9;
const SIMULATE_AGAIN: &str = "simulate again with this version: `meshtone simulate SCENARIO.toml -o DIR`";

impl PhaseOptions {
    /// Returns whether none is given, so that only a simulation can be processed.
    pub fn is_empty(&self) -> bool {
        self.teeth.is_none() && !self.states_shaft_angle()
    }

    /// The files that are read for the phase.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let all = self.pulse_times.iter().chain(&self.speed_profile).map(PathBuf::as_path);
        // A name of pulses that is no file's is that of an array.
        all.filter(|path| self.speed_profile.as_deref() == Some(path) || path.exists())
    }

    /// The channel that is read for the phase, behind the option that names it.
    pub fn channel(&self) -> Option<(&'static str, &str)> {
        let tach = self.tach.as_deref().map(|name| ("--tach", name));
        tach.or(self.speed_channel.as_deref().map(|name| ("--speed-channel", name)))
    }

    /// Returns whether it is said how far the shaft has turned.
    pub fn states_shaft_angle(&self) -> bool {
        self.channel().is_some()
            || self.pulse_times.is_some()
            || self.speed_profile.is_some()
            || self.shaft_hz.is_some()
    }

    /// Refuses a measured recording whose wheel is not known.
    pub fn check_teeth(&self, input: &Input) -> Result<(), Failure> {
        if self.teeth.is_some() {
            return Ok(());
        }
        let problem = format!("{}: the teeth of the wheel are not stated", input.source.display());
        let help = "state them with --teeth; only what `meshtone simulate` wrote states them itself";
        Failure::refuse(problem, help)
    }

    /// Refuses a measured recording for which nothing says how its shaft turned.
    pub fn check_angle(&self, input: &Input) -> Result<(), Failure> {
        if self.states_shaft_angle() {
            return Ok(());
        }
        let help = if input.scenario_toml.is_some() {
            "leave out --teeth: what `meshtone simulate` wrote needs no options; or state the speed too, with --shaft-hz"
        } else {
            "state its speed with --shaft-hz, or --tach, --pulse-times, --speed-channel, --speed-profile or \
             --from-mesh-tone"
        };
        let problem = format!("{}: nothing says how far the shaft has turned", input.source.display());
        Failure::refuse(problem, help)
    }

    /// Source of the phase of a simulation, in words.
    pub const SIMULATED: &str = "scenario";

    /// Source of the phase, in words.
    pub fn source(&self) -> &'static str {
        match self {
            Self { tach: Some(_), .. } => "tachometer",
            Self { pulse_times: Some(_), .. } => "pulse times",
            Self { speed_channel: Some(_), .. } => "speed channel",
            Self { speed_profile: Some(_), .. } => "speed profile",
            Self { from_mesh_tone: true, .. } => "mesh tone",
            Self { shaft_hz: Some(_), .. } => "constant speed",
            _ => Self::SIMULATED,
        }
    }

    /// Facts that the options state about a measured recording.
    pub fn stated_facts(&self, teeth: u32) -> StatedFacts {
        let turning = match (self.source(), self.shaft_hz) {
            ("tachometer" | "pulse times", _) => {
                StatedTurning::Pulses { per_revolution: self.pulses_per_rev }
            }
            ("constant speed", Some(speed_hz)) => StatedTurning::ConstantSpeed { speed_hz },
            ("mesh tone", Some(nominal_hz)) => StatedTurning::MeshTone { nominal_hz },
            _ => StatedTurning::Other,
        };
        StatedFacts { teeth, mate_teeth: self.mate_teeth, turning }
    }

    /// Meaning of tooth 1 of a wheel.
    ///
    /// # Arguments
    /// * `is_on_shaft` - whether it is on the shaft that speed or pulses are of
    /// * `damaged_teeth` - of the wheel, where they are known
    pub fn first_tooth(&self, is_on_shaft: bool, damaged_teeth: &[DamagedTooth]) -> String {
        let words = match self.source() {
            Self::SIMULATED => {
                let of = |missing: bool| -> Vec<u32> {
                    let teeth = damaged_teeth.iter().filter(|tooth| tooth.is_missing == missing);
                    teeth.map(|tooth| tooth.tooth).collect()
                };
                let (missing, damaged) =
                    (teeth_that_are("missing", &of(true)), teeth_that_are("damaged", &of(false)));
                return format!("each enters contact at the left of its pitch{missing}{damaged}");
            }
            "mesh tone" => "1: chosen arbitrarily",
            "tachometer" | "pulse times" if is_on_shaft && self.pulses_per_rev == 1 => {
                "1: in mesh at the pulse"
            }
            "tachometer" | "pulse times" => "1: in mesh at the first pulse",
            _ => "1: in mesh at the first sample",
        };
        words.to_owned()
    }

    /// The phase of the shaft, as measured, and what is doubtful about the file that it is from.
    ///
    /// Files that the user names for the phase come before channels of the recording, and these before a constant speed or the mesh tone,
    /// which need nothing but the vibration. Every error names the option or the channel that the phase is from.
    pub fn measured(&self, input: &Input) -> Result<(ShaftPhase, Vec<WarningEntry>), Failure> {
        let (rate_hz, samples) = (input.sampling_rate_hz, input.channel.samples.len());
        let of = |what: String, subject| move |error| refuse(&input.source, &what, subject, &error);
        let pulses = |times: &[f64]| {
            ShaftPhase::from_pulses(times, self.pulses_per_rev, self.shaft_hz, rate_hz, samples)
        };
        if let Some(path) = &self.pulse_times {
            let (times, warnings) = pulse_times(&input.source, path)?;
            let what = format!("--pulse-times {}", path.display());
            let phase = pulses(&times_s(times, input.start_s)).map_err(of(what, RefusedInput::PulseTimes))?;
            return Ok((phase, warnings));
        }
        if let Some(path) = &self.speed_profile {
            let ([times, speeds], warnings) =
                columns(path, "--speed-profile", "two, time in s and speed in Hz or rpm")?;
            let times = times_s(times, input.start_s);
            let phase = ShaftPhase::from_speed_profile(&times, &hertz(path, speeds)?, rate_hz, samples);
            let what = format!("--speed-profile {}", path.display());
            return Ok((phase.map_err(of(what, RefusedInput::Phase))?, warnings));
        }
        let phase = match &input.turning {
            Some(channel) if self.tach.is_some() => {
                let what = || format!("--tach {}", channel.name);
                let tachometer =
                    Tachometer { threshold: self.threshold, hysteresis: self.hysteresis, edge: self.edge };
                let times = tachometer_pulses(&channel.samples, rate_hz, &tachometer);
                times.and_then(|times| pulses(&times)).map_err(of(what(), RefusedInput::Tachometer))
            }
            Some(channel) => {
                let speeds = hertz(&input.source, channel.clone())?;
                let what = format!("--speed-channel {}", channel.name);
                ShaftPhase::from_speed_samples(&speeds, rate_hz).map_err(of(what, RefusedInput::Phase))
            }
            None => {
                let (teeth, shaft_hz) = (self.teeth.unwrap_or(0), self.shaft_hz.unwrap_or(0.0));
                let phase = if self.from_mesh_tone {
                    let tone = MeshTone::new(teeth, shaft_hz);
                    ShaftPhase::from_mesh_tone(&input.channel.samples, rate_hz, &tone)
                } else {
                    ShaftPhase::constant(shaft_hz, rate_hz, samples)
                };
                phase.map_err(of(format!("channel {}", input.channel.name), RefusedInput::Phase))
            }
        };
        Ok((phase?, Vec::new()))
    }
}

/// `; 1 is missing`, `; 3, 7 are damaged`, and of many teeth how many they are.
fn teeth_that_are(state: &str, teeth: &[u32]) -> String {
    const MOST_NAMED: usize = 3;
    let named: Vec<_> = teeth.iter().map(u32::to_string).collect();
    match named.len() {
        0 => String::new(),
        1 => format!("; {} is {state}", named[0]),
        count if count > MOST_NAMED => format!("; {count} teeth are {state}"),
        _ => format!("; {} are {state}", named.join(", ")),
    }
}

/// What was simulated.
pub fn simulated_form(input: &Input, scenario_toml: &str) -> Result<Scenario, Failure> {
    let path = input.source.display();
    if !input.has_own_time {
        let problem =
            format!("{path}: --sampling-rate-hz or --time-column is given, but the file says both itself");
        let help = "leave them out, or state --teeth and the phase too, as of a measured recording";
        return Failure::refuse(problem, help);
    }
    Scenario::from_toml(scenario_toml).map_err(|error| {
        Failure::bad_input(format!("{path}: the scenario in the file is not valid: {error}"))
            .with_help(SIMULATE_AGAIN)
    })
}

/// Refuses a recording whose rate is not its scenario's.
pub fn check_rate(input: &Input, expected_hz: f64) -> Result<(), Failure> {
    let rate_hz = input.sampling_rate_hz;
    if (rate_hz / expected_hz - 1.0).abs() > RATE_ROUNDING {
        let path = input.source.display();
        let problem = format!("{path}: is sampled at {rate_hz} S/s, but its scenario at {expected_hz} S/s");
        return Failure::refuse(problem, SIMULATE_AGAIN);
    }
    Ok(())
}
