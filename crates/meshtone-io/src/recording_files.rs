//! The files of `meshtone init recordings`: recordings of simulated machines, to try the commands on.

use std::io::Cursor;

use meshtone::operation::Profile;
use meshtone::scenario::{Scenario, gearbox_template, template};
use meshtone::sensor::{Channels, NamedSignal, SignalSource};
use meshtone::signal::{Edge, resample_to};

use crate::signals::{SignalFormat, SignalTable};

/// Why there are none: what is simulated is fixed, so that only a fault of this program is one.
type Problem = Box<dyn std::error::Error + Send + Sync>;
/// The files: their names, and what is in them.
type Files = Vec<(String, Vec<u8>)>;

/// The file that says what is in the others.
pub const LIST: &str = "README.md";
/// (S/s) Sampling rate of the recordings.
const SAMPLING_RATE_HZ: f64 = 20e3;
/// The last bearing of the gearbox, and what it is in place of the template's spring: balls as of a 6308, whose bore fits the shaft.
const LAST_BEARING: &str = "shaft = \"output\"\nat = 1.0\n";
const BALLS: &str = "kind = \"ball\"\nelements = 8\nelement_mm = 15.1\npitch_mm = 65.0\n";
const SPALL: &str = "defect = [{ race = \"outer\", width_mm = 2.0 }]\n";
/// The sensor of the pair, whose template has none.
const SENSOR: &str = "\n[[sensor]]\nat = \"support\"\n";
/// (1/g, 1/V, 1/(rev/s)) Steps of the recordings' resolution.
const STEPS_PER_UNIT: f64 = 1e4;
/// (S/s) Rate at which they are simulated.
const SIMULATED_RATE_HZ: f64 = 50e3;
/// (g/√Hz) Noise of every sensor.
const NOISE_G_PER_RTHZ: f64 = 5e-4;
/// Twelve days of the pair, by the severity of its broken tooth.
const DAYS: [f64; 12] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.55, 0.58, 0.61, 0.65, 0.7, 0.8];

/// Simulates the recordings: the files to write beside one another, by name.
///
/// # Errors
/// A template is not what it was, or a simulation fails.
pub fn recording_files() -> Result<Files, Problem> {
    let rig = template("healthy").ok_or("there is no scenario of the pair")?;
    let gearbox = with_behind(&gearbox_template(None), LAST_BEARING, BALLS)?;
    let mut folder = RecordingFolder::default();
    folder.add("rig.toml", "what is known of the pair: no sensor, no noise, no damage", rig.clone());
    let known = "what is known of the gearbox; a ball bearing at the end of its output";
    folder.add("gearbox.toml", known, gearbox.clone());

    let pair = |severity: f64| [&rig, fault("gear", severity).as_str(), SENSOR].concat();
    folder.record("first.csv", "the healthy pair, its pinion at 40 rev/s", &pair(0.0), Run::steady(4.0))?;
    let broken =
        folder.record("run.csv", "the pair with a broken tooth on the gear", &pair(0.7), Run::steady(4.0))?;
    for (name, format) in [("run.mat", SignalFormat::Mat), ("run.wav", SignalFormat::Wav)] {
        folder.add(name, "the same", file_of(&broken, format)?);
    }
    let every_revolution = "instants of one pulse a revolution of the gear in run.csv, in s";
    folder.add("pulses.txt", every_revolution, pulses(&broken));
    folder.add("speed.csv", "time and speed of the gear in run.csv, ten times a second", speeds(&broken));
    let run_up = Run { run_up_hz: Some([15.0, 45.0]), ..Run::steady(6.0) };
    folder.record("run_up.csv", "the healthy pair, its pinion from 15 to 45 rev/s", &pair(0.0), run_up)?;
    for (day, severity) in DAYS.iter().enumerate() {
        // No two days are alike: load and noise differ.
        let torque_nm = 10.0 + 0.2 * ((7 * day) % 5) as f64;
        let run = Run { torque_nm: Some(torque_nm), noise_seed: day as u64, ..Run::steady(1.0) };
        folder.record(&format!("day{:02}.csv", day + 1), "", &pair(*severity), run)?;
    }
    folder.describe(
        "`day01.csv` to `day12.csv`",
        "twelve days of the pair; from the seventh on a tooth of the gear breaks further",
    );

    let spalled = with_behind(&gearbox, BALLS, SPALL)?;
    let broken = [&gearbox, fault("z2", 0.8).as_str()].concat();
    folder.record("gearbox_first.csv", "the healthy gearbox", &gearbox, Run::steady(4.0))?;
    let on_z2 = "the gearbox with a broken tooth on the wheel z2";
    folder.record("gearbox.csv", on_z2, &broken, Run::steady(4.0))?;
    let on_ring = "the gearbox with a spall on the outer race of its ball bearing, 8,15.1,65";
    folder.record("bearing.csv", on_ring, &spalled, Run::steady(8.0))?;
    Ok(folder.finish())
}

/// A text with a part more.
///
/// # Errors
/// The place behind which it belongs is not there.
fn with_behind(text: &str, place: &str, part: &str) -> Result<String, Problem> {
    let (before, after) =
        text.split_once(place).ok_or_else(|| format!("the template of a gearbox has no {place:?}"))?;
    Ok([before, place, part, after].concat())
}

/// A broken tooth, as a scenario has it; nothing without severity.
fn fault(wheel: &str, severity: f64) -> String {
    if severity == 0.0 {
        return String::new();
    }
    format!("\n[[fault]]\nwheel = \"{wheel}\"\nkind = \"tooth-breakage\"\nseverity = {severity:?}\n")
}

/// How a machine is run while it is recorded.
struct Run {
    duration_s: f64,
    /// (rev/s) Speeds of the motor between which it runs up; none at the scenario's speed.
    run_up_hz: Option<[f64; 2]>,
    /// In place of the scenario's.
    torque_nm: Option<f64>,
    noise_seed: u64,
}

impl Run {
    fn steady(duration_s: f64) -> Self {
        Self { duration_s, run_up_hz: None, torque_nm: None, noise_seed: 0 }
    }
}

/// The files so far.
#[derive(Default)]
struct RecordingFolder {
    files: Files,
    /// A line a file.
    contents: String,
}

impl RecordingFolder {
    /// Adds a file, and a line to the list unless it is described elsewhere.
    fn add(&mut self, name: &str, contents: &str, bytes: impl Into<Vec<u8>>) {
        if !contents.is_empty() {
            self.describe(&format!("`{name}`"), contents);
        }
        self.files.push((name.to_owned(), bytes.into()));
    }

    /// Adds a line to the list.
    fn describe(&mut self, names: &str, contents: &str) {
        self.contents.push_str(&format!("* {names}: {contents}\n"));
    }

    /// Simulates a recording and adds it as text.
    fn record(&mut self, name: &str, contents: &str, scenario: &str, run: Run) -> Result<Channels, Problem> {
        let recording = recording(scenario, run).map_err(|error| format!("{name}: {error}"))?;
        self.add(name, contents, file_of(&recording, SignalFormat::Csv)?);
        Ok(recording)
    }

    fn finish(mut self) -> Files {
        let text = format!(
            "Recordings of simulated machines, made by Meshtone: of a pair of 17 and 38 teeth whose pinion turns at 40 rev/s, and of a gearbox of\n\
             two stages, 32/96 and 48/80 teeth, whose input turns at 30 rev/s. The channels are `bearing`, an acceleration in g; `tacho`, the\n\
             voltage of a sensor that sees one mark a revolution of the pinion, or of the gearbox's input; and `speed`, the revolutions per\n\
             second of the gear, or of the gearbox's output. All have {SAMPLING_RATE_HZ} samples a second. To begin with:\n\n    \
             meshtone indicators run.csv -c bearing --tach tacho --teeth 17 --mate-teeth 38\n\n{}",
            self.contents
        );
        self.add(LIST, "", text);
        self.files
    }
}

/// What a sensor, a tachometer on the motor's shaft and a speed sensor on the brake's record of a machine.
fn recording(scenario: &str, run: Run) -> Result<Channels, Problem> {
    let mut scenario = Scenario::from_toml(scenario)?;
    scenario.solver.duration_s = Some(run.duration_s);
    scenario.solver.sampling_rate_hz = SIMULATED_RATE_HZ;
    if let Some(value) = run.run_up_hz {
        let time_s = vec![0.0, run.duration_s];
        scenario.operation.speed_profile_hz = Some(Profile { time_s, value: value.to_vec() });
    }
    for sensor in &mut scenario.sensors {
        sensor.noise_density_g_per_rthz = NOISE_G_PER_RTHZ;
        sensor.noise_seed = Some(run.noise_seed);
    }
    scenario.operation.brake_torque_nm = run.torque_nm.unwrap_or(scenario.operation.brake_torque_nm);
    // The last sensor of the gearbox sits on the seat of its ball bearing.
    let sensor = SignalSource::Sensor(scenario.sensors.len().saturating_sub(1));
    let channels = meshtone::simulate(&scenario)?.channels;
    let speeds: Vec<&NamedSignal> = channels
        .signals
        .iter()
        .filter(|signal| matches!(signal.source, SignalSource::ShaftSpeed(_)))
        .collect();
    let (Some(motor), Some(brake)) = (speeds.first(), speeds.last()) else {
        return Err("it has no shafts".into());
    };

    let values =
        resample_to(channels.of(sensor), channels.sampling_rate_hz, SAMPLING_RATE_HZ, Edge::Reflect)?;
    let step = channels.sampling_rate_hz / SAMPLING_RATE_HZ;
    let kept = |signal: &[f64]| -> Vec<f64> {
        (0..values.len()).filter_map(|k| signal.get((k as f64 * step).round() as usize)).copied().collect()
    };
    let turned: Vec<f64> = revolutions(&motor.values, channels.sampling_rate_hz).map(tachometer_v).collect();
    let (tacho, speed) = (kept(&turned), kept(&brake.values));
    let samples = values.len().min(tacho.len());
    let named = |name: &'static str, source: SignalSource, mut values: Vec<f64>| {
        values.truncate(samples);
        // As a converter does, and so that text is short.
        values.iter_mut().for_each(|value| *value = (*value * STEPS_PER_UNIT).round() / STEPS_PER_UNIT);
        let mut signal = NamedSignal::new(name, source);
        signal.values = values;
        signal
    };
    let signals = vec![
        named("bearing", sensor, values),
        named("tacho", SignalSource::ShaftSpeed(0), tacho),
        named("speed", SignalSource::ShaftSpeed(1), speed),
    ];
    Ok(Channels::new(SAMPLING_RATE_HZ, 0.0, signals))
}

/// (rev) The angle of a shaft at the end of each sample, from 0 before the first.
fn revolutions(speed_hz: &[f64], sampling_rate_hz: f64) -> impl Iterator<Item = f64> {
    speed_hz.iter().scan(0.0, move |revolutions, speed_hz| {
        *revolutions += speed_hz / sampling_rate_hz;
        Some(*revolutions)
    })
}

/// (V) What the tachometer shows at an angle of its shaft in revolutions: a mark with flanks, so that instants between samples can be read.
fn tachometer_v(revolutions: f64) -> f64 {
    const WIDTH: f64 = 0.1;
    const FLANK: f64 = 0.02;
    let place = revolutions.rem_euclid(1.0);
    5.0 * (place / FLANK).min((WIDTH - place) / FLANK).clamp(0.0, 1.0)
}

/// The bytes of a file of the recording; text has the units in the names of its columns, as recorders write them.
fn file_of(recording: &Channels, format: SignalFormat) -> Result<Vec<u8>, Problem> {
    let mut recording = recording.clone();
    if format == SignalFormat::Csv {
        let units = ["bearing [g]", "tacho [V]", "speed [Hz]"];
        recording.signals.iter_mut().zip(units).for_each(|(signal, name)| signal.name = name.into());
    }
    let mut file = Cursor::new(Vec::new());
    SignalTable::without_scenario(&recording).write(&mut file, format)?;
    Ok(file.into_inner())
}

/// Instants at which the last shaft has made one revolution more.
fn pulses(recording: &Channels) -> String {
    let mut before = 0.0_f64;
    let mut text = String::new();
    for (sample, turned) in revolutions(&recording["speed"], SAMPLING_RATE_HZ).enumerate() {
        if turned.floor() > before.floor() {
            let part = (turned.floor() - before) / (turned - before);
            text.push_str(&format!("{:.7}\n", (sample as f64 + part) / SAMPLING_RATE_HZ));
        }
        before = turned;
    }
    text
}

/// The speed of the last shaft, as a table of means about the instants that it states.
fn speeds(recording: &Channels) -> String {
    const PER_SECOND: f64 = 10.0;
    let (speed, every) = (&recording["speed"], (SAMPLING_RATE_HZ / PER_SECOND) as usize);
    let row = |sample: usize| {
        let about = &speed[sample.saturating_sub(every / 2)..(sample + every / 2).min(speed.len())];
        let mean_hz = about.iter().sum::<f64>() / about.len() as f64;
        format!("{:.1},{mean_hz:.4}\n", sample as f64 / SAMPLING_RATE_HZ)
    };
    ["time_s,speed_hz\n".to_owned()].into_iter().chain((0..=speed.len()).step_by(every).map(row)).collect()
}
