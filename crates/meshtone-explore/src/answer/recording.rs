//! A recording that was dropped on the page, through the same chain as the simulation.

use std::io::Write;
use std::path::Path;

use meshtone::scenario::Scenario;
use meshtone::sensor::Channel as SimulatedChannel;
use meshtone::signal::{
    AngularSettings, AngularSignal, ChainSettings, ShaftPhase, SignalError, SignalWarning, SimulatedShafts,
    StatedFacts, StatedTurning, Tachometer, angular_resample, check_recording, process_angular,
    tachometer_pulses,
};
use meshtone::wheel::WheelName;
use meshtone_io::recording::{Channel, Recording, RecordingOptions, read_recording};
use serde_json::{Value, json};

use super::wanted;
use super::wheel_signals::WheelSignals;
use crate::packet::Packet;
use crate::refusal::Refusal;

/// Numbers that processing holds for each sample beside the recording, at most.
const NUMBERS_BESIDE_EACH_SAMPLE: u64 = 8;

/// What the file does not say itself.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingQuestion {
    /// Name of the file: its ending distinguishes text from other formats.
    pub name: String,
    /// The channel that is processed; the only one, or the first, where none is named.
    pub channel: Option<String>,
    /// (S/s) Sampling rate, where the file does not say it.
    pub sampling_rate_hz: Option<f64>,
    /// Channel with a tachometer's pulses, one a revolution of the pinion's shaft; the scenario's speed, constant, where none is named.
    pub tachometer: Option<String>,
}

impl RecordingQuestion {
    /// As the page says it.
    ///
    /// # Arguments
    /// * `fields` - the fields by their names
    pub fn of(fields: &Value) -> Self {
        let text = |name: &str| fields.get(name).and_then(Value::as_str).map(str::to_owned);
        Self {
            name: text("name").unwrap_or_else(|| "the recording".to_owned()),
            channel: text("channel"),
            sampling_rate_hz: fields.get("sampling_rate_hz").and_then(Value::as_f64),
            tachometer: text("tachometer"),
        }
    }
}

/// The answer's bytes: what a recording shows of both wheels, through the chain with the wheels and the speed of a scenario.
///
/// # Arguments
/// * `bytes` - the file
/// * `question` - what it does not say itself
/// * `scenario` - whose teeth and speed are taken, unless the file is of a simulation
/// * `is_wanted` - whether the answer still is
///
/// # Errors
/// What [`read_recording`] refuses; a channel that is not there; no longer wanted. Where only one wheel's average cannot be made, its
/// part says why.
pub fn recording(
    bytes: &[u8],
    question: &RecordingQuestion,
    scenario: &Scenario,
    is_wanted: &dyn Fn() -> bool,
) -> Result<Vec<u8>, Refusal> {
    let recording = read(bytes, question)?;
    wanted(is_wanted)?;
    let (simulated, channel) = chosen(&recording, question)?;
    let (turning, wheels, doubts) = match (&simulated, &question.tachometer) {
        (Some(simulated), None) => ("scenario", of_simulation(&recording, channel, simulated), Vec::new()),
        _ => of_measurement(&recording, channel, question, scenario)?,
    };
    let of_records = wheels.iter().filter_map(|wheel| wheel.record.as_ref().ok());
    let of_signal =
        doubts.iter().chain(of_records.flat_map(|record| &record.warnings)).map(ToString::to_string);
    let warnings: Vec<String> = recording.warnings.iter().map(ToString::to_string).chain(of_signal).collect();
    let mut packet = Packet::default();
    let unit = channel.unit.as_deref().unwrap_or("");
    let said = json!({
        "name": question.name,
        "channels": recording.channels.iter().map(|channel| &channel.name).collect::<Vec<_>>(),
        "turning": turning,
        "warnings": warnings,
        "signal": {
            "channel": { "name": channel.name, "unit": unit },
            "sampling_rate_hz": recording.sampling_rate_hz,
            "start_s": recording.start_s,
            "values": packet.array(channel.samples.iter().copied()),
        },
        "wheels": wheels.each_ref().map(|wheel| wheel.json(unit, &mut packet)),
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
        numbers_beside_each_sample: NUMBERS_BESIDE_EACH_SAMPLE,
        ..RecordingOptions::default()
    };
    let kept_at = file.path().display().to_string();
    read_recording(file.path(), &options)
        .map_err(|error| Refusal::unfit(error.to_string().replace(&kept_at, &question.name)))
}

/// The scenario of a file that `meshtone simulate` wrote, and the channel that is processed: the one that is asked for, or the leading one.
pub(super) fn chosen<'r>(
    recording: &'r Recording,
    question: &RecordingQuestion,
) -> Result<(Option<Scenario>, &'r Channel), Refusal> {
    let simulated = recording.scenario_toml.as_deref().and_then(|toml| Scenario::from_toml(toml).ok());
    let leading =
        simulated.as_ref().map(|scenario| SimulatedChannel::leading(&scenario.sensors).name().into_owned());
    let channel = named(recording, question.channel.as_deref().or(leading.as_deref()))?;
    Ok((simulated, channel))
}

/// How the pinion's shaft turns by a tachometer's channel, one pulse a revolution.
pub(super) fn by_tachometer(
    recording: &Recording,
    name: &str,
) -> Result<(StatedTurning, ShaftPhase), Refusal> {
    let rate_hz = recording.sampling_rate_hz;
    let times = tachometer_pulses(&named(recording, Some(name))?.samples, rate_hz, &Tachometer::default())?;
    let phase = ShaftPhase::from_pulses(&times, 1, None, rate_hz, recording.len())?;
    Ok((StatedTurning::Pulses { per_revolution: 1 }, phase))
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

/// The scenario that a file of ours has says how far the shafts have turned.
fn of_simulation(recording: &Recording, channel: &Channel, scenario: &Scenario) -> [WheelSignals; 2] {
    let shafts = SimulatedShafts::new(scenario, recording.start_s, recording.len());
    let of_wheel = |shaft| {
        let record = shafts.process(&channel.samples, shaft, &ChainSettings::default());
        WheelSignals { record, teeth: shafts.teeth(shaft), damaged: Vec::new() }
    };
    WheelName::BOTH.map(of_wheel)
}

fn of_measurement(
    recording: &Recording,
    channel: &Channel,
    question: &RecordingQuestion,
    scenario: &Scenario,
) -> Result<(&'static str, [WheelSignals; 2], Vec<SignalWarning>), Refusal> {
    let (rate_hz, samples) = (recording.sampling_rate_hz, recording.len());
    let [pinion_teeth, gear_teeth] = [scenario.gears().pinion_teeth, scenario.gears().gear_teeth];
    let speed_hz = scenario.operation.pinion_speed_hz;
    let (name, (turning, phase)) = match &question.tachometer {
        Some(name) => ("tachometer", by_tachometer(recording, name)?),
        None => {
            let turning = StatedTurning::ConstantSpeed { speed_hz };
            ("constant speed", (turning, ShaftPhase::constant(speed_hz, rate_hz, samples)?))
        }
    };
    let stated = StatedFacts { teeth: pinion_teeth, mate_teeth: Some(gear_teeth), turning };
    let settings = ChainSettings::default();
    let over = |phase: &ShaftPhase| angular_resample(&channel.samples, phase, &AngularSettings::default());
    let process = |angular: &Result<AngularSignal, SignalError>, teeth: u32| WheelSignals {
        record: angular
            .as_ref()
            .map_err(Clone::clone)
            .and_then(|angular| process_angular(angular, teeth, &settings)),
        teeth,
        damaged: Vec::new(),
    };
    let pinion = over(&phase);
    let mut doubts = phase.warnings.clone();
    if let Ok(angular) = &pinion {
        doubts.extend(check_recording(angular, &stated, &phase, rate_hz));
    }
    let gear = over(&phase.of_mate(pinion_teeth, gear_teeth)?);
    Ok((name, [process(&pinion, pinion_teeth), process(&gear, gear_teeth)], doubts))
}
