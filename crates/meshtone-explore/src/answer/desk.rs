//! The desk, on which a recording is looked at and completed before it is processed.

use meshtone::scenario::Scenario;
use meshtone::signal::{Tachometer, tachometer_pulses};
use meshtone_io::recording::{Channel, Recording};
use serde_json::json;

use super::lines::Spectrum;
use super::recording::{RecordingQuestion, chosen, read};
use crate::packet::Packet;
use crate::refusal::Refusal;

/// (s) The part of a recording that is drawn.
const DRAWN_S: f64 = 1.0;
/// Words in names of tachometers' channels.
const TACHOMETERS: [&str; 6] = ["tach", "pulse", "puls", "trigger", "keyphasor", "encoder"];
/// Part of a tachometer's samples that are within a tenth of its range of its extremes, at least.
const ON_LEVELS: f64 = 0.8;
/// Part by which a number of pulses may differ from a whole multiple of the shaft's.
const SPEED_ERROR: f64 = 0.1;

/// The answer's bytes: the channels of a recording, its first second and spectrum, and what is guessed that the file does not say. Where fields
/// of the page would help, the problem is said in place of these.
///
/// # Arguments
/// * `bytes` - the file
/// * `question` - what is stated already
/// * `scenario` - the page's
///
/// # Errors
/// It returns a problem against which no field of the page helps.
pub fn desk(bytes: &[u8], question: &RecordingQuestion, scenario: &Scenario) -> Result<Vec<u8>, Refusal> {
    let mut packet = Packet::default();
    let recording = match read(bytes, question) {
        Ok(recording) => recording,
        Err(refusal) if helps(&refusal) => {
            let said = json!({ "name": question.name, "problem": refusal.json()["text"] });
            return Ok(packet.bytes(&said));
        }
        Err(refusal) => return Err(refusal),
    };
    let guessed = tachometer(&recording);
    let named = question.tachometer.as_deref().or(guessed);
    let first =
        recording.channels.iter().find(|channel| Some(channel.name.as_str()) != named && is_live(channel));
    let leading = RecordingQuestion {
        channel: question.channel.clone().or_else(|| first.map(|channel| channel.name.clone())),
        ..question.clone()
    };
    let (simulated, channel) = chosen(&recording, &leading)?;
    let rate_hz = recording.sampling_rate_hz;
    let drawn = ((DRAWN_S * rate_hz) as usize).clamp(1, channel.samples.len());
    let spectrum = Spectrum::of(&channel.samples, rate_hz);
    let speed_hz = scenario.operation.pinion_speed_hz;
    let of_pulses = named.and_then(|name| recording.channel(name));
    let pulses_hz = of_pulses.and_then(|tachometer| pulses_hz(tachometer, rate_hz));
    let teeth =
        |wheel: &meshtone::scenario::ScenarioWheel| json!({ "wheel": wheel.name, "teeth": wheel.teeth });
    let said = json!({
        "name": question.name,
        "channels": recording.channels.iter().map(|of| json!({ "name": of.name, "unit": of.unit })).collect::<Vec<_>>(),
        "sampling_rate_hz": rate_hz,
        "rate_by": recording.rate_by,
        "pulses_hz": pulses_hz,
        "speed_hz": speed_hz,
        "duration_s": recording.len() as f64 / rate_hz,
        "is_simulated": simulated.is_some(),
        "guess": {
            "channel": channel.name,
            "tachometer": named,
            "pulses_per_revolution": pulses_hz.and_then(|hz| whole(hz / speed_hz)).unwrap_or(1),
        },
        "teeth": scenario.wheels.iter().map(teeth).collect::<Vec<_>>(),
        "warnings": recording.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "signal": { "unit": channel.unit, "start_s": recording.start_s, "values": packet.array(channel.samples[..drawn].iter().copied()) },
        "spectrum": { "step_hz": spectrum.step_hz, "values": packet.array(spectrum.amplitudes.iter().copied()) },
    });
    Ok(packet.bytes(&said))
}

/// Fields of the page, by which the program knows what to say of a recording.
pub(super) const FIELDS: [&str; 4] = ["Sampling rate", "Time column", "Variable", "Lines to skip"];

/// Says whether a field of the page helps against a refusal.
fn helps(refusal: &Refusal) -> bool {
    let text = refusal.json()["text"].as_str().unwrap_or_default().to_owned();
    FIELDS.iter().any(|field| text.contains(field))
}

fn is_live(channel: &Channel) -> bool {
    channel.samples.iter().any(|sample| *sample != channel.samples[0])
}

/// The channel that is rather a tachometer's: one that is named so, or that rests on two levels and has even pulses.
fn tachometer(recording: &Recording) -> Option<&str> {
    let is_named = |channel: &&Channel| {
        let name = channel.name.to_lowercase();
        TACHOMETERS.iter().any(|word| name.contains(word))
    };
    let found = recording.channels.iter().find(|channel| is_named(channel) && is_live(channel));
    let rests = || {
        recording
            .channels
            .iter()
            .find(|channel| is_live(channel) && rests_on_levels(channel, recording.sampling_rate_hz))
    };
    found.or_else(rests).filter(|_| recording.channels.len() > 1).map(|channel| channel.name.as_str())
}

fn rests_on_levels(channel: &Channel, rate_hz: f64) -> bool {
    let least = channel.samples.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = channel.samples.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let near = 0.1 * (largest - least);
    let on_levels = channel.samples.iter().filter(|x| **x < least + near || **x > largest - near).count();
    on_levels as f64 >= ON_LEVELS * channel.samples.len() as f64
        && tachometer_pulses(&channel.samples, rate_hz, &Tachometer::default())
            .is_ok_and(|times| times.len() > 2)
}

/// (1/s) The mean rate of a tachometer's pulses.
fn pulses_hz(channel: &Channel, rate_hz: f64) -> Option<f64> {
    let times = tachometer_pulses(&channel.samples, rate_hz, &Tachometer::default()).ok()?;
    let [first, .., last] = times[..] else { return None };
    Some((times.len() - 1) as f64 / (last - first))
}

/// The whole number of pulses in a revolution that a quotient of speeds nearly is.
fn whole(pulses: f64) -> Option<u32> {
    let whole = pulses.round();
    (whole >= 1.0 && (pulses / whole - 1.0).abs() < SPEED_ERROR).then_some(whole as u32)
}

/// A message of a reader in the words of the page: its fields in place of options, and nothing of what it has not.
pub(super) fn in_words_of_the_page(message: &str) -> String {
    const WORDS: [(&str, &str); 18] = [
        (
            "choose those that belong together (option channels, or variable)",
            "name those that belong together in the field Variable",
        ),
        (
            "; choose fewer channels (option channels), cut the recording, or raise the memory limit",
            "; cut the recording",
        ),
        (
            "choose channels that were recorded together",
            "save those that were recorded together in a file of their own",
        ),
        (", or choose other columns (option channels)", ""),
        ("; if the column holds no numbers, choose others (option channels)", ""),
        (
            "state which (option text.separator or text.decimal_sign)",
            "save it with semicolons between its cells",
        ),
        ("if it is the comma, say so (option text.decimal_sign)", "save it with one decimal sign throughout"),
        ("if it is the point, say so (option text.decimal_sign)", "save it with one decimal sign throughout"),
        (
            "; if separator or decimal sign are unusual, state them (options text.separator and text.decimal_sign)",
            "",
        ),
        ("(option text.skip_lines)", "in the field Lines to skip"),
        ("(option sampling_rate_hz)", "in the field Sampling rate"),
        ("(option time)", "in the field Time column"),
        ("(option variable)", "in the field Variable"),
        ("choose others (option channels)", "save the others in a file of their own"),
        ("(option channels)", "in the file"),
        (", or take another separation: discrete-random or prewhitening", ""),
        ("choose a variable", "name one in the field Variable"),
        ("choose one by its recording_id", "name one by its recording_id"),
    ];
    WORDS.iter().fold(message.to_owned(), |message, (option, field)| message.replace(option, field))
}
