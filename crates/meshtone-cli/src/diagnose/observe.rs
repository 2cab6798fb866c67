//! Observation of the scenario's wheels in a recording.

use std::path::Path;

use meshtone::scenario::Scenario;
use meshtone::signal::{SignalWarning, SimulatedShafts, StatedFacts};
use meshtone::tuning::{HealthyRecording, RecordingProblem};
use meshtone::wheel::WheelName;
use meshtone_diagnose::{Observation, SignalKind, other_tone};
use meshtone_io::indicators::WarningEntry;
use meshtone_io::recording::Channel;

use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions};
use crate::indicators::phase::simulated;
use crate::indicators::reading::{Input, own_rate_hz, read_revolution};
use crate::indicators::refuse::{RefusedInput, refuse};
use crate::warnings::about;

/// (rev) Most revolutions in the times of a file that is one revolution of a gear at about the scenario's speed.
const MOST_OF_OWN: f64 = 1.5;
/// (rev) The same by the stated rate of what was recorded: an average may have more values than a revolution had samples.
const MOST_OF_STATED: f64 = 10.0;

/// Features of one file, and warnings about it.
type Observed = (Observation, Vec<WarningEntry>);

/// Reads what recordings of a rig show.
pub struct Observer<'a> {
    scenario: &'a Scenario,
    signal: SignalKind,
    reading: &'a ReadingOptions,
    stated: &'a PhaseOptions,
    /// Facts that the options state, completed by the scenario.
    phase: PhaseOptions,
}

impl<'a> Observer<'a> {
    /// # Arguments
    /// * `scenario` - of the rig
    /// * `signal` - what the recordings are
    /// * `reading`, `stated` - the options
    pub fn new(
        scenario: &'a Scenario,
        signal: SignalKind,
        reading: &'a ReadingOptions,
        stated: &'a PhaseOptions,
    ) -> Result<Self, Failure> {
        if signal != SignalKind::Recording && !stated.is_empty() {
            let problem =
                format!("--signal {}: is one revolution of the gear, which needs no phase", signal.name());
            return Failure::refuse(problem, "leave out --teeth and what says how the shaft turns");
        }
        Ok(Self { scenario, signal, reading, stated, phase: with_scenario(stated, scenario)? })
    }

    /// Observes a file.
    pub fn observe(&self, path: &Path) -> Result<Observed, Failure> {
        if self.signal == SignalKind::Recording { self.recording(path) } else { self.revolution(path) }
    }

    fn revolution(&self, path: &Path) -> Result<Observed, Failure> {
        let (mut channel, warnings) = read_revolution(path, self.reading)?;
        to_g(&mut channel, path, self.reading.sensitivity_mv_per_unit.is_some())?;
        self.check_is_one(path, channel.samples.len())?;
        let last_order = self.reading.sampling_rate_hz.map(|rate_hz| rate_hz / gear_hz(self.scenario) / 2.0);
        let gear_teeth = self.scenario.gears.gear_teeth;
        let observation = Observation::of_revolution(&channel.samples, gear_teeth, self.signal, last_order);
        let what = format!("channel {}", channel.name);
        let observation = observation.map_err(|error| refuse(path, &what, RefusedInput::Phase, &error))?;
        Ok((observation, warnings))
    }

    /// Refuses a whole recording where one revolution is stated, by its own times or the stated rate.
    fn check_is_one(&self, path: &Path, values: usize) -> Result<(), Failure> {
        let stated = self.reading.sampling_rate_hz.map(|rate_hz| (rate_hz, MOST_OF_STATED));
        let own = || own_rate_hz(path, self.reading).map(|rate_hz| (rate_hz, MOST_OF_OWN));
        let Some((rate_hz, most)) = stated.or_else(own) else { return Ok(()) };
        let revolutions = values as f64 / rate_hz * gear_hz(self.scenario);
        if revolutions <= most {
            return Ok(());
        }
        let problem = format!(
            "{}: its {values} values are {revolutions:.1} revolutions of the gear at the scenario's speed; --signal {} is one revolution",
            path.display(),
            self.signal.name()
        );
        Failure::refuse(problem, "leave out --signal: a whole recording is averaged here")
    }

    fn recording(&self, path: &Path) -> Result<Observed, Failure> {
        let input = self.input(path)?;
        match &input.scenario_toml {
            Some(toml) if !self.stated.states_shaft_angle() => self.simulated(&input, toml),
            _ => self.measured(&input),
        }
    }

    /// Reads a recording whole, with the angle of the pinion's shaft.
    pub fn healthy(&self, path: &Path) -> Result<(HealthyRecording, Vec<WarningEntry>), Failure> {
        let input = self.input(path)?;
        let what = format!("channel {}", input.channel.name);
        let (pinion, warnings) = match &input.scenario_toml {
            Some(toml) if !self.stated.states_shaft_angle() => {
                let phase = self.shafts(&input, toml)?.phase(WheelName::Pinion);
                (phase, input.warnings.clone())
            }
            _ => {
                let (shaft, of_phase) = self.phase.measured(&input)?;
                let (samples, stated) = (&input.channel.samples, self.stated_facts());
                let other = other_tone(samples, input.sampling_rate_hz, &shaft, &stated);
                if let Some(mismatch) =
                    other.map_err(|error| refuse(path, &what, RefusedInput::Phase, &error))?
                {
                    let problem = RecordingProblem::DoesNotFit(Box::new(SignalWarning::DoesNotFit(mismatch)));
                    let problem = format!("{}: {problem}", path.display());
                    return Failure::refuse(problem, "state the speed, or a tachometer with --tach");
                }
                let doubtful = shaft.warnings.iter().map(|warning| about(&input.source, warning));
                let warnings = input.warnings.iter().cloned().chain(of_phase).chain(doubtful).collect();
                let [pinion, gear] = teeth_of(self.scenario);
                let is_pinion = self.phase.teeth.is_none_or(|teeth| teeth == pinion);
                (if is_pinion { Ok(shaft) } else { shaft.of_mate(gear, pinion) }, warnings)
            }
        };
        let pinion = pinion.map_err(|error| refuse(&input.source, &what, RefusedInput::Phase, &error))?;
        let Input { channel, sampling_rate_hz, .. } = input;
        Ok((HealthyRecording { values_g: channel.samples, sampling_rate_hz, pinion }, warnings))
    }

    fn input(&self, path: &Path) -> Result<Input, Failure> {
        let mut input = Input::read(path, self.reading, self.stated.channel())?;
        to_g(&mut input.channel, path, self.reading.sensitivity_mv_per_unit.is_some())?;
        Ok(input)
    }

    /// The shafts of what was simulated of these wheels.
    fn shafts(&self, input: &Input, scenario_toml: &str) -> Result<SimulatedShafts, Failure> {
        let (_, shafts) = simulated(input, scenario_toml)?;
        let teeth = WheelName::BOTH.map(|shaft| shafts.teeth(shaft));
        let [pinion, gear] = teeth_of(self.scenario);
        if teeth != [pinion, gear] {
            let [here, mate] = teeth;
            let problem = format!(
                "{}: is of wheels with {here} and {mate} teeth, but the scenario has {pinion} and {gear}",
                input.source.display()
            );
            return Failure::refuse(problem, "name the scenario of its own rig with --scenario");
        }
        Ok(shafts)
    }

    fn simulated(&self, input: &Input, scenario_toml: &str) -> Result<Observed, Failure> {
        let shafts = self.shafts(input, scenario_toml)?;
        let what = format!("channel {}", input.channel.name);
        let observation = Observation::of_simulated(&input.channel.samples, &shafts).map_err(|error| {
            refuse(&input.source, &what, RefusedInput::Simulated { in_segments: false }, &error)
        })?;
        Ok((observation, input.warnings.clone()))
    }

    fn measured(&self, input: &Input) -> Result<Observed, Failure> {
        let (shaft, of_phase) = self.phase.measured(input)?;
        let (rate_hz, teeth) = (input.sampling_rate_hz, teeth_of(self.scenario));
        let speed_hz = shaft.mean_speed_hz(rate_hz);
        let subject = RefusedInput::Measured { speed_hz, by: self.phase.source() };
        let stated = self.stated_facts();
        let observation = Observation::of_measured(&input.channel.samples, rate_hz, &shaft, &stated, teeth);
        let what = format!("channel {}", input.channel.name);
        let observation = observation.map_err(|error| refuse(&input.source, &what, subject, &error))?;
        let doubtful = shaft.warnings.iter().map(|warning| about(&input.source, warning));
        let warnings = input.warnings.iter().cloned().chain(of_phase).chain(doubtful).collect();
        Ok((observation, warnings))
    }

    fn stated_facts(&self) -> StatedFacts {
        let [pinion, _] = teeth_of(self.scenario);
        self.phase.stated_facts(self.phase.teeth.unwrap_or(pinion))
    }
}

fn teeth_of(scenario: &Scenario) -> [u32; 2] {
    [scenario.gears.pinion_teeth, scenario.gears.gear_teeth]
}

fn gear_hz(scenario: &Scenario) -> f64 {
    let [pinion, gear] = teeth_of(scenario).map(f64::from);
    scenario.operation.pinion_speed_hz * pinion / gear
}

/// Completes the facts that the options state by the scenario: its teeth, and where nothing says how the shaft turns, its speed, which the mesh tone
/// makes exact.
fn with_scenario(stated: &PhaseOptions, scenario: &Scenario) -> Result<PhaseOptions, Failure> {
    let [pinion, gear] = teeth_of(scenario);
    let refuse = |option: &str, given: u32, allowed: String| {
        let problem = format!("{option} {given}: is no wheel of the scenario; must be {allowed}");
        Failure::refuse(problem, "--teeth chooses the wheel that speed or pulses are of")
    };
    let mut phase = stated.clone();
    let teeth = stated.teeth.unwrap_or(pinion);
    let mate = match teeth {
        _ if teeth == pinion => gear,
        _ if teeth == gear => pinion,
        _ => return refuse("--teeth", teeth, format!("{pinion}, the pinion's, or {gear}, the gear's")),
    };
    if let Some(given) = stated.mate_teeth.filter(|given| *given != mate) {
        return refuse("--mate-teeth", given, mate.to_string());
    }
    (phase.teeth, phase.mate_teeth) = (Some(teeth), Some(mate));
    if !stated.states_shaft_angle() {
        let speed_hz = scenario.operation.pinion_speed_hz * f64::from(pinion) / f64::from(teeth);
        (phase.shaft_hz, phase.from_mesh_tone) = (Some(speed_hz), true);
    }
    Ok(phase)
}

/// Brings a channel to g.
fn to_g(channel: &mut Channel, path: &Path, is_calibrated: bool) -> Result<(), Failure> {
    if channel.convert_to_g() {
        return Ok(());
    }
    let unit = channel.unit.as_deref().unwrap_or("").trim();
    let is = match (unit.is_empty(), is_calibrated) {
        (true, true) => "is divided by --sensitivity-mv-per-unit, but per which unit is not said".to_owned(),
        (true, false) => "has no stated unit".to_owned(),
        (false, _) => format!("is in {unit}"),
    };
    let problem = format!("{}: channel {} {is}; must be g or m/s²", path.display(), channel.name);
    let help = "state what it is with --unit g or --unit m/s², of volts with --sensitivity-mv-per-unit too";
    Failure::refuse(problem, help)
}
