//! Observation of the scenario's wheels in a recording.

use std::path::Path;

use meshtone::scenario::Scenario;
use meshtone::signal::{TrainRecording, TrainTurning};
use meshtone_diagnose::{Observation, SignalKind};
use meshtone_io::indicators::WarningEntry;
use meshtone_io::recording::Channel;

use crate::failure::Failure;
use crate::indicators::options::{PhaseOptions, ReadingOptions, ShaftOptions};
use crate::indicators::reading::{Input, own_rate_hz, read_revolution};
use crate::indicators::refuse::{RefusedInput, refuse};
use crate::indicators::train::Turned;
use crate::warnings::about;

/// (rev) Most revolutions in the times of a file that is one revolution of a gear at about the scenario's speed.
const MOST_OF_OWN: f64 = 1.5;
/// (rev) The same by the stated rate of what was recorded: an average may have more values than a revolution had samples.
const MOST_OF_STATED: f64 = 10.0;

/// Features of one file, and warnings about it.
pub type Observed = (Observation, Vec<WarningEntry>);

/// Reads what recordings of a rig show.
pub struct Observer<'a> {
    scenario: &'a Scenario,
    signal: SignalKind,
    reading: &'a ReadingOptions,
    phase: &'a PhaseOptions,
    shafts: &'a ShaftOptions,
}

impl<'a> Observer<'a> {
    /// # Arguments
    /// * `scenario` - of the rig
    /// * `signal` - what the recordings are
    /// * `reading`, `phase`, `shafts` - the options
    pub fn new(
        scenario: &'a Scenario,
        signal: SignalKind,
        reading: &'a ReadingOptions,
        phase: &'a PhaseOptions,
        shafts: &'a ShaftOptions,
    ) -> Result<Self, Failure> {
        let is_revolution = signal != SignalKind::Recording;
        if is_revolution && !(phase.is_empty() && shafts.is_empty()) {
            let problem =
                format!("--signal {}: is one revolution of the gear, which needs no phase", signal.name());
            return Failure::refuse(problem, "leave out --teeth and what says how the shaft turns");
        }
        if is_revolution && scenario.rig().is_none() {
            let problem = format!("--signal {}: is of a pair, and the scenario of a gearbox", signal.name());
            return Failure::refuse(problem, "give whole recordings, and leave out --signal");
        }
        Ok(Self { scenario, signal, reading, phase, shafts })
    }

    /// Observes a file.
    ///
    /// # Arguments
    /// * `path` - the file
    pub fn observe(&self, path: &Path) -> Result<Observed, Failure> {
        if self.signal == SignalKind::Recording {
            return self.recording(Input::read(path, self.reading, self.phase.channel())?);
        }
        let gears = self.scenario.gears();
        let ratio = f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth);
        self.revolution(path, gears.gear_teeth, self.scenario.operation.pinion_speed_hz * ratio)
    }

    fn revolution(&self, path: &Path, gear_teeth: u32, gear_hz: f64) -> Result<Observed, Failure> {
        let (mut channel, warnings) = read_revolution(path, self.reading)?;
        to_g(&mut channel, path, self.reading.sensitivity_mv_per_unit.is_some())?;
        self.check_is_one(path, channel.samples.len(), gear_hz)?;
        let last_order = self.reading.sampling_rate_hz.map(|rate_hz| rate_hz / gear_hz / 2.0);
        let observation = Observation::of_revolution(&channel.samples, gear_teeth, self.signal, last_order);
        let what = format!("channel {}", channel.name);
        let observation = observation.map_err(|error| refuse(path, &what, RefusedInput::Phase, &error))?;
        Ok((observation, warnings))
    }

    /// Refuses a whole recording where one revolution is stated, by its own times or the stated rate.
    fn check_is_one(&self, path: &Path, values: usize, gear_hz: f64) -> Result<(), Failure> {
        let stated = self.reading.sampling_rate_hz.map(|rate_hz| (rate_hz, MOST_OF_STATED));
        let own = || own_rate_hz(path, self.reading).map(|rate_hz| (rate_hz, MOST_OF_OWN));
        let Some((rate_hz, most)) = stated.or_else(own) else { return Ok(()) };
        let revolutions = values as f64 / rate_hz * gear_hz;
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

    /// Observes a recording that was read.
    ///
    /// # Arguments
    /// * `input` - the recording
    pub fn recording(&self, mut input: Input) -> Result<Observed, Failure> {
        to_g(&mut input.channel, &input.source, self.reading.sensitivity_mv_per_unit.is_some())?;
        let turned = Turned::new(&input, self.phase, self.shafts, Some(self.scenario))?;
        let Turned { train, turning, warnings, .. } = turned;
        let rate_hz = input.sampling_rate_hz;
        let (subject, doubtful) = if let TrainTurning::Shaft { phase, .. } = &turning {
            let (speed_hz, by) = (phase.mean_speed_hz(rate_hz), self.phase.source());
            (RefusedInput::Measured { speed_hz, by }, &phase.warnings[..])
        } else {
            (RefusedInput::Simulated { in_segments: false }, &[][..])
        };
        let recording = TrainRecording {
            signal: &input.channel.samples,
            sampling_rate_hz: rate_hz,
            train: &train,
            turning: &turning,
        };
        let what = format!("channel {}", input.channel.name);
        let observation = Observation::of_recording(&recording);
        let observation = observation.map_err(|error| refuse(&input.source, &what, subject, &error))?;
        let doubtful = doubtful.iter().map(|warning| about(&input.source, warning));
        Ok((observation, warnings.into_iter().chain(doubtful).collect()))
    }
}

/// Brings a channel to g.
pub fn to_g(channel: &mut Channel, path: &Path, is_calibrated: bool) -> Result<(), Failure> {
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
