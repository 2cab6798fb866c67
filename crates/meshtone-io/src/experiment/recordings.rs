//! Measured difference signals from recordings with their shaft phase.

use meshtone::scenario::WheelName;
use meshtone::signal::{
    AngularSettings, AngularSignal, ChainSettings, MeshTone, ShaftPhase, SignalError, StatedFacts,
    StatedTurning, Tachometer, angular_resample, find_mismatch, points_per_revolution, process_angular,
    process_angular_segments, tachometer_pulses,
};
use meshtone::tuning::DifferenceChain;
use meshtone_toml::{ReadResult, TomlError, TomlTable, TomlValue};

use super::measured::Wanted;
use super::read::Reading;
use crate::recording::{ColumnChoice, Recording, RecordingOptions, read_recording};
use crate::wheel_name::read_wheel;

/// Of a sampling rate, relative: what a file's rounded times are off.
pub(super) const RATE_TOLERANCE: f64 = 1e-4;

/// Deviation of a recording's speed from the simulations' that is no other speed, relative.
const SPEED_TOLERANCE: f64 = 0.05;

/// How the phase of a recording's shafts is known.
enum Phase<'a> {
    /// The gear's shaft turns at a constant speed.
    Constant { gear_shaft_hz: f64 },
    /// Pulses of a tachometer's channel.
    Tachometer { channel: &'a str, pulses_per_revolution: u32, shaft: WheelName },
    /// The mesh tone itself.
    MeshTone { gear_shaft_hz: f64 },
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
    let tachometer = if let Phase::Tachometer { channel, .. } = known { Some(channel) } else { None };
    let channels = [Some(channel), tachometer].into_iter().flatten().map(ColumnChoice::parse).collect();
    let options = RecordingOptions { channels, sampling_rate_hz: rate, ..RecordingOptions::default() };
    let teeth = wanted.base.gears().teeth(wanted.chain.wheel);
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
            let phase = shaft_phase(&recording, &known, wanted).map_err(refuse)?;
            let signal = &recording.channels[0].samples;
            let angular = angular_resample(signal, &phase, &settings.angular).map_err(refuse)?;
            warnings.check(name, wanted, &known, (&phase, &angular), given);
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
    ///
    /// # Arguments
    /// * `file` - the recording's name
    /// * `known` - how its phase is known
    /// * `phase`, `angular` - of the wheel over whose revolutions is averaged
    /// * `rate` - (S/s) of the recording
    fn check(
        &mut self,
        file: &str,
        wanted: &Wanted,
        known: &Phase<'_>,
        (phase, angular): (&ShaftPhase, &AngularSignal),
        rate: f64,
    ) {
        if let Some(warning) = phase.warnings.first() {
            self.add(WarningKind::Phase, file, warning.to_string());
        }
        let wheel = wanted.chain.wheel;
        let (turned, simulated) = (phase.mean_speed_hz(rate), nominal_speed_hz(wanted, wheel));
        if (turned / simulated - 1.0).abs() > SPEED_TOLERANCE {
            self.add(WarningKind::Speed, file, other_speed(wanted, turned / simulated));
            return;
        }
        let gears = &wanted.base.gears();
        let stated = StatedFacts {
            teeth: gears.teeth(wheel),
            mate_teeth: Some(gears.teeth(wheel.mate())),
            turning: match *known {
                Phase::Constant { gear_shaft_hz } if wheel == WheelName::Gear => {
                    StatedTurning::ConstantSpeed { speed_hz: gear_shaft_hz }
                }
                Phase::Constant { .. } => StatedTurning::ConstantSpeed { speed_hz: turned },
                Phase::Tachometer { pulses_per_revolution, shaft, .. } if shaft == wheel => {
                    StatedTurning::Pulses { per_revolution: pulses_per_revolution }
                }
                Phase::MeshTone { .. } => StatedTurning::MeshTone { nominal_hz: turned },
                Phase::Tachometer { .. } => StatedTurning::Other,
            },
        };
        if let Some(find_mismatch) = find_mismatch(angular, &stated) {
            let words = format!(
                "over the revolutions of the {}, {} teeth: {find_mismatch}",
                wheel.name(),
                stated.teeth
            );
            self.add(WarningKind::Misfit, file, words);
        }
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

/// (Hz) Speed of the shaft of a wheel in the simulations.
fn nominal_speed_hz(wanted: &Wanted, wheel: WheelName) -> f64 {
    let gears = &wanted.base.gears();
    wanted.base.operation.pinion_speed_hz * f64::from(gears.pinion_teeth) / f64::from(gears.teeth(wheel))
}

/// # Arguments
/// * `ratio` - of the recording's speed to the scenario's
fn other_speed(wanted: &Wanted, ratio: f64) -> String {
    let simulated_hz = nominal_speed_hz(wanted, WheelName::Gear);
    format!(
        "the gear's shaft turns at {:.4} Hz, but in the scenario at {simulated_hz:.4} Hz ({:+.1} %), and what is tuned are simulations \
         at that speed: correct what [measured] says of it, or write operation.pinion_speed_hz = {:.4} in the scenario",
        simulated_hz * ratio,
        100.0 * (ratio - 1.0),
        wanted.base.operation.pinion_speed_hz * ratio,
    )
}

/// As simulated signals are processed: so many points a revolution, read in the same way.
fn settings(wanted: &Wanted) -> ReadResult<ChainSettings> {
    let shaft_hz = nominal_speed_hz(wanted, wanted.chain.wheel);
    let rate = wanted.chain.sampling_rate_hz;
    let revolution = ShaftPhase::constant(shaft_hz, rate, (3.0 * rate / shaft_hz).ceil() as usize)
        .map_err(|error| TomlError::new("signal.sampling_rate_hz", rate, error.to_string()))?;
    let angular = AngularSettings {
        points_per_revolution: Some(points_per_revolution(&revolution)),
        ..DifferenceChain::angular_settings(wanted.base.model)
    };
    Ok(ChainSettings { angular, separation: wanted.chain.separation.clone() })
}

fn phase<'a>(table: &TomlTable<'a>, wanted: &Wanted) -> ReadResult<Phase<'a>> {
    let nominal = nominal_speed_hz(wanted, WheelName::Gear);
    let stated = table.number("gear_shaft_hz")?;
    let gear_shaft_hz = stated.unwrap_or(nominal);
    let tachometer = table.optional("tachometer_channel");
    let pulses = table.read_optional("pulses_per_revolution", |value| value.integer(1..=100_000))?;
    let on = table.read_optional("tachometer_shaft", read_wheel)?;
    let is_mesh_tone = table.read_optional("phase_from_mesh_tone", TomlValue::boolean)?.unwrap_or(false);
    let refuse_if = |given: bool, key: &str, problem: &str| match given {
        true => Err(table.error(key, problem)),
        false => Ok(()),
    };
    let Some(channel) = tachometer else {
        let problem = "given without tachometer_channel, so it has no effect";
        refuse_if(pulses.is_some(), "pulses_per_revolution", problem)?;
        refuse_if(on.is_some(), "tachometer_shaft", problem)?;
        return Ok(match is_mesh_tone {
            true => Phase::MeshTone { gear_shaft_hz },
            false => Phase::Constant { gear_shaft_hz },
        });
    };
    let problem = "given beside tachometer_channel; the phase has one source";
    refuse_if(stated.is_some(), "gear_shaft_hz", problem)?;
    refuse_if(is_mesh_tone, "phase_from_mesh_tone", problem)?;
    Ok(Phase::Tachometer {
        channel: channel.string()?,
        pulses_per_revolution: pulses.unwrap_or(1) as u32,
        shaft: on.unwrap_or_default(),
    })
}

/// Phase of the shaft over whose revolutions is averaged.
fn shaft_phase(recording: &Recording, phase: &Phase, wanted: &Wanted) -> Result<ShaftPhase, SignalError> {
    let rate = recording.sampling_rate_hz;
    let gears = &wanted.base.gears();
    let (of, phase) = match *phase {
        Phase::Constant { gear_shaft_hz } => {
            (WheelName::Gear, ShaftPhase::constant(gear_shaft_hz, rate, recording.len())?)
        }
        Phase::MeshTone { gear_shaft_hz } => {
            let tone = MeshTone::new(gears.gear_teeth, gear_shaft_hz);
            (WheelName::Gear, ShaftPhase::from_mesh_tone(&recording.channels[0].samples, rate, &tone)?)
        }
        Phase::Tachometer { pulses_per_revolution, shaft, .. } => {
            let waveform = &recording.channels[1].samples;
            let times_s = tachometer_pulses(waveform, rate, &Tachometer::default())?;
            let phase =
                ShaftPhase::from_pulses(&times_s, pulses_per_revolution, None, rate, recording.len())?;
            (shaft, phase)
        }
    };
    let wheel = wanted.chain.wheel;
    if of == wheel { Ok(phase) } else { phase.of_mate(gears.teeth(of), gears.teeth(wheel)) }
}
