//! Measured difference signals from recordings with their shaft phase.

use meshtone::scenario::WheelName;
use meshtone::signal::{
    AngularSettings, AngularSignal, ChainSettings, MeshTone, ShaftPhase, SignalError, StatedFacts,
    StatedTurning, Tachometer, TrainRecording, TrainTurning, TrainWheel, angular_resample, find_mismatch,
    process_angular, process_angular_segments, tachometer_pulses,
};
use meshtone::tuning::DifferenceChain;
use meshtone_toml::{ReadResult, TomlError, TomlTable, TomlValue};

use super::measured::Wanted;
use super::read::Reading;
use crate::recording::{ColumnChoice, Recording, RecordingOptions, read_recording};

/// Of a sampling rate, relative: what a file's rounded times are off.
pub(super) const RATE_TOLERANCE: f64 = 1e-4;

/// Deviation of a recording's speed from the simulations' that is no other speed, relative.
const SPEED_TOLERANCE: f64 = 0.05;

/// How the phase of a recording's shafts is known.
struct Phase<'a> {
    /// Number of the shaft whose phase it is: the gear's of a pair, the input of a gearbox, or where the tachometer is.
    shaft: usize,
    source: PhaseSource<'a>,
}

/// The source of the phase.
enum PhaseSource<'a> {
    /// The shaft turns at a constant speed.
    Constant { shaft_hz: f64 },
    /// Pulses of a tachometer's channel.
    Tachometer { channel: &'a str, pulses_per_revolution: u32 },
    /// The mesh tone itself, of the wheel with the fewest teeth on the shaft.
    MeshTone { shaft_hz: f64 },
}

/// Difference signals by case and record.
///
/// Each recording is resampled over the turns of the wheel that the simulations are averaged over, with as many points a revolution
/// as they have, so that both are compared in the same way. What does not fit the scenario becomes a warning of the reading.
pub(super) fn differences(
    table: &TomlTable<'_>,
    wanted: &Wanted,
    reading: &mut Reading,
) -> ReadResult<Vec<Vec<Vec<f64>>>> {
    let channel = table.required("channel", "name or number of the recordings' channel")?.string()?;
    let rate = table.number("sampling_rate_hz")?;
    let segment =
        table.read_optional("revolutions_per_record", |value| value.integer(2..=u64::from(u32::MAX)))?;
    let known = phase(table, wanted)?;
    let tachometer = match known.source {
        PhaseSource::Tachometer { channel, .. } => Some(channel),
        _ => None,
    };
    let channels = [Some(channel), tachometer].into_iter().flatten().map(ColumnChoice::parse).collect();
    let options = RecordingOptions { channels, sampling_rate_hz: rate, ..RecordingOptions::default() };
    let TrainWheel { teeth, shaft, .. } = wanted.train.wheels[wanted.wheel];
    let settings = settings(wanted)?;
    let mut warnings = Warnings::default();
    let mut all = Vec::new();
    for (case, files) in wanted.cases.iter().zip(wanted.files) {
        if files.recordings.is_empty() {
            return Err(files.missing(case, "recordings"));
        }
        let mut records = Vec::new();
        for (name, value) in &files.recordings {
            let recording = read_recording(&reading.source(name), &options);
            let recording = recording.map_err(|error| value.error(error.to_string()))?;
            let refuse = |error: SignalError| value.error(format!("{name}: {error}"));
            let (given, stated) = (recording.sampling_rate_hz, wanted.chain.sampling_rate_hz);
            if (given / stated - 1.0).abs() > RATE_TOLERANCE {
                return Err(value.error(format!(
                    "{name} has {given} S/s, but signal.sampling_rate_hz, to which the simulated signals are brought, is {stated}"
                )));
            }
            let of_known = known_phase(&recording, &known, wanted).map_err(refuse)?;
            let phase = wanted.train.carried(&of_known, known.shaft, shaft).map_err(refuse)?;
            let signal = &recording.channels[0].samples;
            let angular = angular_resample(signal, &phase, &settings.angular).map_err(refuse)?;
            let heard = Heard {
                file: name,
                rate_hz: given,
                signal,
                of_known: &of_known,
                phase: &phase,
                angular: &angular,
            };
            warnings.check(&heard, wanted, &known);
            let found = match segment {
                None => process_angular(&angular, teeth, &settings).map(|record| vec![record]),
                Some(count) => process_angular_segments(&angular, teeth, &settings, count as usize),
            };
            records.extend(found.map_err(refuse)?.into_iter().map(|record| record.parts.difference));
        }
        all.push(records);
    }
    reading.warnings.extend(warnings.in_words());
    Ok(all)
}

/// Warnings about recordings. Of several recordings with a warning of one kind, the first one is named.
#[derive(Default)]
struct Warnings {
    /// The words about the first recording of each kind, and how many others the like could be said of.
    first_of_kind: Vec<(WarningKind, String, usize)>,
}

/// The parts of a recording that are checked.
struct Heard<'a> {
    /// Its name.
    file: &'a str,
    rate_hz: f64,
    signal: &'a [f64],
    /// The phase of the shaft that is known, and that of the wheel over whose revolutions is averaged.
    of_known: &'a ShaftPhase,
    phase: &'a ShaftPhase,
    /// The signal over the latter.
    angular: &'a AngularSignal,
}

#[derive(Clone, Copy, PartialEq)]
enum WarningKind {
    /// The shaft turns at another speed than the scenario's.
    Speed,
    /// The recording hardly fits what is stated about it.
    Misfit,
    /// How the phase was found.
    Phase,
}

impl Warnings {
    /// Adds what speaks against a recording: doubts about its phase, another speed than the simulations', or teeth that do not fit.
    ///
    /// Where the speed differs, the teeth are not looked at: the mesh orders are then elsewhere for that reason alone. The shaft that is
    /// stated depends on how the phase is known; only what the reader has stated can be reported as mistaken.
    fn check(&mut self, heard: &Heard, wanted: &Wanted, known: &Phase<'_>) {
        let &Heard { file, rate_hz, signal, of_known, phase, angular } = heard;
        if let Some(warning) = phase.warnings.first() {
            self.add(WarningKind::Phase, file, warning.to_string());
        }
        let wheel = &wanted.train.wheels[wanted.wheel];
        let (turned_hz, simulated_hz) = (phase.mean_speed_hz(rate_hz), nominal_speed_hz(wanted, wheel.shaft));
        if (turned_hz / simulated_hz - 1.0).abs() > SPEED_TOLERANCE {
            self.add(WarningKind::Speed, file, other_speed(wanted, known.shaft, turned_hz / simulated_hz));
            return;
        }
        if let (Some(_), [pinion, gear]) = (wanted.base.rig(), &wanted.train.wheels[..]) {
            let mate = if wanted.wheel == 0 { gear } else { pinion };
            let turning = known.stated(wheel.shaft, turned_hz);
            let stated = StatedFacts { teeth: wheel.teeth, mate_teeth: Some(mate.teeth), turning };
            if let Some(mismatch) = find_mismatch(angular, &stated) {
                let words =
                    format!("over the revolutions of the {}, {} teeth: {mismatch}", wheel.name, wheel.teeth);
                self.add(WarningKind::Misfit, file, words);
            }
            return;
        }
        // Several meshes are judged together, over the angle that is known.
        let stated = known.stated(known.shaft, of_known.mean_speed_hz(rate_hz));
        let turning = TrainTurning::Shaft { shaft: known.shaft, phase: of_known.clone(), stated };
        let recording =
            TrainRecording { signal, sampling_rate_hz: rate_hz, train: &wanted.train, turning: &turning };
        // Too few turns of the known shaft for a check are no error of the recording.
        let misfits = recording.check().unwrap_or_default();
        misfits.iter().for_each(|misfit| self.add(WarningKind::Misfit, file, misfit.to_string()));
    }

    fn add(&mut self, kind: WarningKind, file: &str, words: String) {
        match self.first_of_kind.iter_mut().find(|(of_kind, ..)| *of_kind == kind) {
            Some((.., more)) => *more += 1,
            None => self.first_of_kind.push((kind, format!("{file}: {words}"), 0)),
        }
    }

    fn in_words(self) -> impl Iterator<Item = String> {
        self.first_of_kind.into_iter().map(|(_, words, more)| match more {
            0 => words,
            1 => format!("{words} (likewise of another recording)"),
            more => format!("{words} (likewise of {more} other recordings)"),
        })
    }
}

/// (Hz) Speed of a shaft in the simulations.
fn nominal_speed_hz(wanted: &Wanted, shaft: usize) -> f64 {
    let train = &wanted.train;
    wanted.base.operation.pinion_speed_hz * train.speed_ratio(shaft, train.input()).value()
}

/// # Arguments
/// * `shaft` - whose phase is known
/// * `ratio` - of the recording's speed to the scenario's
fn other_speed(wanted: &Wanted, shaft: usize, ratio: f64) -> String {
    let simulated_hz = nominal_speed_hz(wanted, shaft);
    format!(
        "{} turns at {:.4} Hz, but in the scenario at {simulated_hz:.4} Hz ({:+.1} %), and what is tuned are simulations \
         at that speed: correct what [measured] says of it, or write {} = {:.4} in the scenario",
        wanted.base.shaft_in_words(&wanted.train.shafts[shaft].name),
        simulated_hz * ratio,
        100.0 * (ratio - 1.0),
        wanted.base.words().speed_key,
        wanted.base.operation.pinion_speed_hz * ratio,
    )
}

/// As simulated signals are processed: so many points a revolution, read in the same way.
fn settings(wanted: &Wanted) -> ReadResult<ChainSettings> {
    let shaft_hz = nominal_speed_hz(wanted, wanted.train.wheels[wanted.wheel].shaft);
    let rate_hz = wanted.chain.sampling_rate_hz;
    let refuse = |error: SignalError| TomlError::new("signal.sampling_rate_hz", rate_hz, error.to_string());
    let points = wanted.chain.points_per_revolution(shaft_hz).map_err(refuse)?;
    let angular = AngularSettings {
        points_per_revolution: Some(points),
        ..DifferenceChain::angular_settings(wanted.base.model)
    };
    let separation = wanted.chain.separation.as_ref();
    let separation = separation.map(|settings| wanted.train.separation(wanted.wheel, settings));
    Ok(ChainSettings { angular, separation })
}

/// Reads what `[measured]` says of the phase: of a shaft's speed by `gear_shaft_hz` of a pair and `input_shaft_hz` of a gearbox.
fn phase<'a>(table: &TomlTable<'a>, wanted: &Wanted) -> ReadResult<Phase<'a>> {
    let (speed_key, usual) = match wanted.base.rig() {
        Some(_) => ("gear_shaft_hz", WheelName::Gear as usize),
        None => ("input_shaft_hz", wanted.train.input()),
    };
    let shafts = wanted.train.shafts.iter().enumerate();
    let names: Vec<(&str, usize)> = shafts.map(|(number, shaft)| (shaft.name.as_str(), number)).collect();
    let stated = table.number(speed_key)?;
    let shaft_hz = stated.unwrap_or_else(|| nominal_speed_hz(wanted, usual));
    let tachometer = table.optional("tachometer_channel");
    let pulses = table.read_optional("pulses_per_revolution", |value| value.integer(1..=100_000))?;
    let on = table.read_optional("tachometer_shaft", |value| value.choice(&names))?;
    let is_mesh_tone = table.read_optional("phase_from_mesh_tone", TomlValue::boolean)?.unwrap_or(false);
    let refuse_if = |given: bool, key: &str, problem: &str| match given {
        true => Err(table.error(key, problem)),
        false => Ok(()),
    };
    let Some(channel) = tachometer else {
        let problem = "given without tachometer_channel, so it has no effect";
        refuse_if(pulses.is_some(), "pulses_per_revolution", problem)?;
        refuse_if(on.is_some(), "tachometer_shaft", problem)?;
        let source = match is_mesh_tone {
            true => PhaseSource::MeshTone { shaft_hz },
            false => PhaseSource::Constant { shaft_hz },
        };
        return Ok(Phase { shaft: usual, source });
    };
    let problem = "given beside tachometer_channel; the phase has one source";
    refuse_if(stated.is_some(), speed_key, problem)?;
    refuse_if(is_mesh_tone, "phase_from_mesh_tone", problem)?;
    let pulses_per_revolution = pulses.unwrap_or(1) as u32;
    let source = PhaseSource::Tachometer { channel: channel.string()?, pulses_per_revolution };
    Ok(Phase { shaft: on.unwrap_or(usual), source })
}

impl Phase<'_> {
    /// The statement about a shaft that can be reported as mistaken.
    ///
    /// # Arguments
    /// * `shaft` - its number
    /// * `turned_hz` - (Hz) its mean speed
    fn stated(&self, shaft: usize, turned_hz: f64) -> StatedTurning {
        let is_known = self.shaft == shaft;
        match self.source {
            PhaseSource::Constant { shaft_hz } => {
                StatedTurning::ConstantSpeed { speed_hz: if is_known { shaft_hz } else { turned_hz } }
            }
            PhaseSource::Tachometer { pulses_per_revolution, .. } if is_known => {
                StatedTurning::Pulses { per_revolution: pulses_per_revolution }
            }
            PhaseSource::MeshTone { .. } => StatedTurning::MeshTone { nominal_hz: turned_hz },
            PhaseSource::Tachometer { .. } => StatedTurning::Other,
        }
    }
}

/// Phase of the shaft that is known.
fn known_phase(recording: &Recording, phase: &Phase, wanted: &Wanted) -> Result<ShaftPhase, SignalError> {
    let rate = recording.sampling_rate_hz;
    match phase.source {
        PhaseSource::Constant { shaft_hz } => ShaftPhase::constant(shaft_hz, rate, recording.len()),
        PhaseSource::MeshTone { shaft_hz } => {
            let teeth = wanted.train.teeth_on(phase.shaft).min().unwrap_or(1);
            let tone = MeshTone::new(teeth, shaft_hz);
            ShaftPhase::from_mesh_tone(&recording.channels[0].samples, rate, &tone)
        }
        PhaseSource::Tachometer { pulses_per_revolution, .. } => {
            let waveform = &recording.channels[1].samples;
            let times_s = tachometer_pulses(waveform, rate, &Tachometer::default())?;
            ShaftPhase::from_pulses(&times_s, pulses_per_revolution, None, rate, recording.len())
        }
    }
}
