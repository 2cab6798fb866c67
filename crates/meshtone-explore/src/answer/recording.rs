//! A recording that was dropped on the page, through the same chain as the simulation.

use std::borrow::Cow;
use std::io::Write;
use std::path::Path;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channel as SimulatedChannel;
use meshtone::signal::{
    GearTrain, ShaftPhase, StatedTurning, Tachometer, TrainRecording, TrainSettings, TrainTurning,
    tachometer_pulses,
};
use meshtone_io::recording::{
    Channel, ColumnChoice, Recording, RecordingOptions, TextOptions, TimeColumn, read_recording,
};
use serde_json::{Value, json};

use super::bearing::LookedAtBearing;
use super::desk::in_words_of_the_page;
use super::lines::{Spectrum, Tones};
use super::wanted;
use super::wheel_signals::WheelSignals;
use crate::packet::Packet;
use crate::refusal::Refusal;

/// Numbers that processing holds for each sample beside the recording, at most.
const NUMBERS_BESIDE_EACH_SAMPLE: u64 = 8;
/// A tachometer has at most so many pulses in a revolution.
const MOST_PULSES: u64 = 1_000_000;

/// What the file does not say itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingQuestion {
    /// Name of the file: its ending distinguishes text from other formats.
    pub name: String,
    /// The channel that is processed; the only one, or the first, where none is named.
    pub channel: Option<String>,
    /// (S/s) Sampling rate, where the file does not say it.
    pub sampling_rate_hz: Option<f64>,
    /// Channel with a tachometer's pulses on the shaft that the motor turns; the scenario's speed, constant, where none is named.
    pub tachometer: Option<String>,
    /// Pulses in a revolution.
    pub pulses_per_revolution: u32,
    /// The time column, by its name or number; the one that is named as time, where none is stated.
    pub time: Option<String>,
    /// The variable or recording of a file that holds several.
    pub variable: Option<String>,
    /// Lines of text that are skipped.
    pub skip_lines: usize,
    /// Unit of the channel, where the file does not say it; another one is converted.
    pub unit: Option<String>,
    /// The rolling bearing that is looked at, by the name of its seat.
    pub bearing: Option<String>,
}

impl RecordingQuestion {
    /// As the page says it.
    ///
    /// # Arguments
    /// * `fields` - the fields by their names
    pub fn of(fields: &Value) -> Self {
        let text = |name: &str| fields.get(name).and_then(Value::as_str).map(str::to_owned);
        let count = |name: &str| fields.get(name).and_then(Value::as_u64);
        Self {
            name: text("name").unwrap_or_else(|| "the recording".to_owned()),
            channel: text("channel"),
            sampling_rate_hz: fields.get("sampling_rate_hz").and_then(Value::as_f64),
            tachometer: text("tachometer"),
            pulses_per_revolution: count("pulses_per_revolution")
                .map_or(1, |pulses| pulses.clamp(1, MOST_PULSES) as u32),
            time: text("time"),
            variable: text("variable"),
            skip_lines: count("skip_lines").and_then(|lines| lines.try_into().ok()).unwrap_or(0),
            unit: text("unit"),
            bearing: text("bearing"),
        }
    }
}

/// The answer's bytes: what a recording shows of all wheels, and of a rolling bearing, with the wheels and the speed of a scenario.
///
/// # Arguments
/// * `bytes` - the file
/// * `question` - what it does not say itself
/// * `scenario` - whose wheels and speed are taken, unless the file is of a simulation
/// * `is_wanted` - whether the answer still is
///
/// # Errors
/// What [`read_recording`] refuses; a channel that is not there; a simulation of another machine; no longer wanted. Where one wheel's
/// average cannot be made, its part says why.
pub fn recording(
    bytes: &[u8],
    question: &RecordingQuestion,
    scenario: &Scenario,
    is_wanted: &dyn Fn() -> bool,
) -> Result<Vec<u8>, Refusal> {
    let recording = read(bytes, question)?;
    wanted(is_wanted)?;
    let (simulated, channel) = chosen(&recording, question)?;
    let speed_hz = scenario.operation.pinion_speed_hz;
    let constant = |_: &GearTrain| {
        let phase = ShaftPhase::constant(speed_hz, recording.sampling_rate_hz, recording.len())?;
        Ok(("constant speed", StatedTurning::ConstantSpeed { speed_hz }, phase))
    };
    let machine = simulated.as_ref().unwrap_or(scenario);
    let tachometer = question.tachometer.as_deref().map(|name| (name, question.pulses_per_revolution));
    let Turned { source, train, turning } =
        turned(&recording, tachometer, simulated.as_ref(), scenario, constant)?;
    let train = train.at_sensor(machine, &channel.name);
    let looked_at = TrainRecording {
        signal: &channel.samples,
        sampling_rate_hz: recording.sampling_rate_hz,
        train: &train,
        turning: &turning,
    };
    let mut packet = Packet::default();
    let unit = channel.unit.as_deref().unwrap_or("");
    let mut warnings: Vec<String> = recording.warnings.iter().map(ToString::to_string).collect();
    // What cannot be resampled is a problem of its wheels.
    let doubts = [looked_at.doubts(), looked_at.check().unwrap_or_default()].concat();
    warnings.extend(doubts.iter().map(ToString::to_string));
    let mut wheels = Vec::new();
    for (number, wheel) in train.wheels.iter().enumerate() {
        wanted(is_wanted)?;
        let records = looked_at.process_one(number, &TrainSettings::default());
        let Some(record) = records.map(|of| of.records.into_iter().next()).transpose() else { continue };
        for warning in record.iter().flat_map(|record| &record.warnings).map(ToString::to_string) {
            // Wheels on one shaft have one average.
            if !warnings.contains(&warning) {
                warnings.push(warning);
            }
        }
        let signals = WheelSignals { record, teeth: wheel.teeth, damaged: Vec::new() };
        let mut said = signals.json(unit, &mut packet);
        said["name"] = wheel.name.as_str().into();
        wheels.push(said);
    }
    // A pair's page draws the spectrum of the average instead, and a rig has no rolling bearings.
    let (mut spectrum, mut bearing) = (Value::Null, Value::Null);
    if machine.rig().is_none() {
        let all = Spectrum::of(&channel.samples, recording.sampling_rate_hz);
        spectrum = all.json(&Tones::of(&train, machine.operation.pinion_speed_hz), &mut packet);
        let of = LookedAtBearing::of(machine, &train, question.bearing.as_deref());
        bearing = of.map_or(Value::Null, |of| of.json(Ok(looked_at), &mut packet));
    }
    let said = json!({
        "name": question.name,
        "channels": recording.channels.iter().map(|channel| &channel.name).collect::<Vec<_>>(),
        "turning": source,
        "warnings": warnings.iter().map(|warning| in_words_of_the_page(warning)).collect::<Vec<_>>(),
        "signal": {
            "channel": { "name": channel.name, "unit": unit },
            "sampling_rate_hz": recording.sampling_rate_hz,
            "start_s": recording.start_s,
            "values": packet.array(channel.samples.iter().copied()),
        },
        "wheels": wheels,
        "spectrum": spectrum,
        "bearing": bearing,
    });
    Ok(packet.bytes(&said))
}

/// The file as it would be read from a folder, without the name of where it lay meanwhile in what is wrong with it.
pub(super) fn read(bytes: &[u8], question: &RecordingQuestion) -> Result<Recording, Refusal> {
    let failed =
        |error: std::io::Error| Refusal::unfit(format!("the recording cannot be kept for reading: {error}"));
    let ending = Path::new(&question.name).extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let ending: String = ending.chars().filter(char::is_ascii_alphanumeric).take(8).collect();
    let mut file = tempfile::Builder::new().suffix(&format!(".{ending}")).tempfile().map_err(failed)?;
    file.write_all(bytes).and_then(|()| file.flush()).map_err(failed)?;
    let options = RecordingOptions {
        sampling_rate_hz: question.sampling_rate_hz,
        time: question
            .time
            .as_deref()
            .map_or(TimeColumn::ByName, |time| TimeColumn::Chosen(ColumnChoice::parse(time))),
        variable: question.variable.clone(),
        text: TextOptions { skip_lines: question.skip_lines, ..TextOptions::default() },
        numbers_beside_each_sample: NUMBERS_BESIDE_EACH_SAMPLE,
        ..RecordingOptions::default()
    };
    let kept_at = file.path().display().to_string();
    let read = read_recording(file.path(), &options)
        .map_err(|error| error.to_string().replace(&kept_at, &question.name));
    read.map_err(|problem| Refusal::unfit(in_words_of_the_page(&problem)))
}

/// The scenario of a file that `meshtone simulate` wrote, and the channel that is processed, in the stated unit: the one that is asked for, or the
/// leading one.
pub(super) fn chosen<'r>(
    recording: &'r Recording,
    question: &RecordingQuestion,
) -> Result<(Option<Scenario>, Cow<'r, Channel>), Refusal> {
    let simulated = recording.scenario_toml.as_deref().and_then(|toml| Scenario::from_toml(toml).ok());
    let leading =
        simulated.as_ref().map(|scenario| SimulatedChannel::leading(&scenario.sensors).name().into_owned());
    let mut channel = Cow::Borrowed(named(recording, question.channel.as_deref().or(leading.as_deref()))?);
    if question.unit.is_some() {
        channel.to_mut().calibrate(None, question.unit.as_deref()).map_err(Refusal::unfit)?;
    }
    Ok((simulated, channel))
}

/// A machine, and how its shafts turned over a recording.
pub(super) struct Turned {
    /// What says how they turned.
    pub(super) source: &'static str,
    /// The machine.
    pub(super) train: GearTrain,
    /// How its shafts turned.
    pub(super) turning: TrainTurning,
}

/// How the shafts turned: by a tachometer; else as the scenario says that a file of ours has; else as the page's scenario lets one believe.
///
/// # Arguments
/// * `recording` - the recording
/// * `tachometer` - the channel of the tachometer, and its pulses in a revolution of the input
/// * `simulated` - what was simulated, where the recording is a simulation
/// * `scenario` - the page's
/// * `otherwise` - the phase of the input where nothing else says it: its source, what is stated, itself
///
/// # Errors
/// A simulation of a machine with other wheels; a channel that is not there, or that has no pulses.
pub(super) fn turned(
    recording: &Recording,
    tachometer: Option<(&str, u32)>,
    simulated: Option<&Scenario>,
    scenario: &Scenario,
    otherwise: impl FnOnce(&GearTrain) -> Result<(&'static str, StatedTurning, ShaftPhase), Refusal>,
) -> Result<Turned, Refusal> {
    // A pair has the names of any pair: its wheels are those of the file.
    let names = |of: &Scenario| -> Vec<String> {
        let teeth =
            |teeth: u32| if of.rig().is_some() { String::new() } else { format!(" of {teeth} teeth") };
        of.wheels.iter().map(|wheel| wheel.name.clone() + &teeth(wheel.teeth)).collect()
    };
    if let Some(simulated) = simulated.filter(|simulated| names(simulated) != names(scenario)) {
        let [own, pages] = [simulated, scenario].map(|of| names(of).join(", "));
        let problem = format!("the recording is a simulation of the wheels {own}, and the page has {pages}");
        return Err(Refusal::unfit(problem).with_help("open the page with the scenario of that machine"));
    }
    let rate_hz = recording.sampling_rate_hz;
    let train = GearTrain::of_scenario(scenario)?;
    let (source, stated, phase) = match (tachometer, simulated) {
        (Some((name, per_revolution)), _) => {
            let pulses = &named(recording, Some(name))?.samples;
            let times = tachometer_pulses(pulses, rate_hz, &Tachometer::default())?;
            let phase = ShaftPhase::from_pulses(&times, per_revolution, None, rate_hz, recording.len())?;
            ("tachometer", StatedTurning::Pulses { per_revolution }, phase)
        }
        (None, Some(simulated)) => {
            let turning = TrainTurning::of_simulated(simulated, recording.start_s, recording.len())?;
            return Ok(Turned { source: "scenario", train: GearTrain::of_scenario(simulated)?, turning });
        }
        (None, None) => otherwise(&train)?,
    };
    let turning = TrainTurning::Shaft { shaft: train.input(), phase, stated };
    Ok(Turned { source, train, turning })
}

/// The channel of a name, or the first.
fn named<'r>(recording: &'r Recording, name: Option<&str>) -> Result<&'r Channel, Refusal> {
    let found = match name {
        None => recording.channels.first(),
        Some(name) => recording.channel(name),
    };
    found.ok_or_else(|| {
        let known: Vec<_> = recording.channels.iter().map(|channel| channel.name.as_str()).collect();
        let asked = name.unwrap_or_default();
        Refusal::unfit(format!("there is no channel {asked}; there are {}", known.join(", ")))
    })
}
