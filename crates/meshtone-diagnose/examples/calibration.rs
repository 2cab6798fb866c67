//! How far a diagnosis can be believed, on simulated recordings that it was not learnt from.
//!
//! ```text
//! cargo run --release -p meshtone-diagnose --example calibration -- examples/healthy.toml recording healthy calibration.csv
//! ```
//!
//! Writes a row for each recording: what it is, what is said about it. Of every pair of wheels the first record is the healthy one
//! that the others are compared with; with `alone` in place of `healthy` they are compared with none. A last argument leaves a kind
//! of damage out of the reference set; goes on with refined rounds, `refined`; or asks about recordings that are not what they are stated to be: `bearing`,
//! `teeth`, `ratio`; or about whole signals of healthy and damaged pairs: `signals`. `matrix` asks about inputs that are no gear of the
//! rig, with and without a healthy recording whatever the third argument says, and counts how many pass; after it the kinds of input may
//! be named, `half,rate`.
#![allow(clippy::print_stderr)]

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;

use meshtone::batch::Control;
use meshtone::random::{Draws, Purpose};
use meshtone::scenario::Scenario;
use meshtone::signal::{
    AngleZero, BearingDefects, GearTrain, ShaftPhase, StatedTurning, TrainRecording, TrainTurning,
};
use meshtone_diagnose::{
    Answer, HEALTHY, Learned, Observation, Prior, Question, ReferenceRecord, ReferenceSet, ReferenceStore,
    SEVERAL, SignalKind, WheelLines, diagnose, refine,
};
use meshtone_fourier::{from_real_spectrum, real_spectrum};

/// Simulations that are learnt from, and those that are asked about; of a gearbox, which takes longer, fewer.
const LEARNT: u64 = 6144;
const ASKED: u64 = 4096;
const OF_GEARBOX: [u64; 2] = [6144, 512];
/// Seed of those that are asked about: no threshold was chosen looking at them.
const ASKED_SEED: u64 = 2647;
/// Recordings that are not what they are stated to be.
const OTHERS: u64 = 60;
/// (-) Noise of whole signals, as a part of their rms.
const NOISE_PART: f64 = 0.05;
/// (g) Noise in each line of an average, of every recording that is asked about.
const NOISE_G: f64 = 2e-4;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, rig, signal, healthy, output, other @ ..] = &arguments[..] else {
        return Err("needs RIG.toml, recording | average | difference, healthy | alone, OUTPUT.csv".into());
    };
    let signal = SignalKind::NAMES.into_iter().find(|(name, _)| name == signal).ok_or("no such signal")?.1;
    let has_healthy = healthy == "healthy";
    let prior = Prior::new(&Scenario::from_toml(&fs::read_to_string(rig)?)?)?;
    let store = ReferenceStore::new(std::env::temp_dir().join("meshtone-calibration"));
    let control = Control::default();
    let [learnt, asked] = if prior.base.rig().is_some() { [LEARNT, ASKED] } else { OF_GEARBOX };
    let mut reference = store.get(&prior, learnt, &control)?;
    let asked = store.get(&Prior { seed: ASKED_SEED, ..prior.clone() }, asked, &control)?;
    let name = |record: &ReferenceRecord| {
        record.fault.as_ref().map_or(HEALTHY, |fault| reference_kind(&prior, fault.kind))
    };
    let kinds = other.get(1..).unwrap_or_default();
    let other = other.first().map_or("", String::as_str);
    if other == "matrix" {
        fs::write(output, matrix(&asked.prior, &reference, kinds.first().map_or("", String::as_str))?)?;
        return Ok(());
    }
    // A kind is left out alone and beside another.
    let has_other = |record: &ReferenceRecord| {
        let drawn = prior.draw(record.number);
        let has =
            |form: &Scenario| form.placed_faults().iter().any(|(_, fault)| fault.damage.kind() == other);
        drawn.is_ok_and(|drawn| has(&drawn.scenario))
    };
    reference
        .records
        .retain(|record| name(record) != other && (name(record) != SEVERAL || !has_other(record)));
    let mut learned: Option<Learned> = None;
    let mut table = String::from(
        "unit,kind,wheel,severity,tooth,said,damaged,probability,outside,healthy_outside,common,q05,q25,q50,q75,q95,said_wheel,said_tooth,tooth_probability,any_wheel,speed_ln,load_ln\n",
    );
    let is_refined = other == "refined";
    let is_strange = ["signals", "bearing", "teeth", "ratio"].contains(&other);
    for record in &asked.records {
        let of_gear = record.fault.as_ref().is_none_or(|fault| fault.wheel + 1 == record.wheels.len());
        let kind = name(record);
        let is_asked = if is_strange {
            record.number < 8 * OTHERS
                && record.number % 8 == (if other == "signals" { 1 + record.number / 8 % 7 } else { 1 })
        } else {
            record.number % 8 > 0
        };
        if !is_asked
            || (signal != SignalKind::Recording && !of_gear)
            || (!other.is_empty() && !is_strange && !is_refined && kind != other)
        {
            continue;
        }
        let Some(before) = asked.records.iter().find(|before| before.number == record.number / 8 * 8) else {
            continue;
        };
        let operation = |number| asked.prior.draw(number).map(|drawn| drawn.scenario.operation.clone());
        let (then, at) = (operation(before.number)?, operation(record.number)?);
        let apart = [
            (at.pinion_speed_hz / then.pinion_speed_hz).ln(),
            (at.brake_torque_nm / then.brake_torque_nm).ln(),
        ];
        let now = if is_strange {
            strange(&asked.prior, record.number, other, 0.0)?
        } else {
            observed(record, signal)
        };
        let before = if is_strange {
            strange(&asked.prior, before.number, "signals", 0.0)?
        } else {
            observed(before, signal)
        };
        let (now, before) = ([now], [before]);
        let question = Question { now: &now, healthy: if has_healthy { &before } else { &[] } };
        if learned.is_none() {
            learned = Some(Learned::new(&reference, &question)?);
        }
        let Some(learned) = &learned else { continue };
        let refined = match is_refined {
            true => refine(learned, &question, &control)?,
            false => None,
        };
        let answer = diagnose(learned, &question, refined.as_ref())?;
        row(&mut table, record, kind, &answer, apart)?;
    }
    fs::write(output, table)?;
    Ok(())
}

fn reference_kind(prior: &Prior, kind: usize) -> &'static str {
    prior.kinds().get(kind).map_or(SEVERAL, |kind| kind.name)
}

/// What a simulated record shows, with noise.
fn observed(record: &ReferenceRecord, signal: SignalKind) -> Observation {
    let mut draws = Draws::new(4711, Purpose::DiagnosisNoise, record.number);
    let mut noisy = |lines: &WheelLines| {
        let mut lines = lines.clone();
        for line in &mut lines.lines {
            let [re, im] = draws.normals();
            line.re += re * NOISE_G / 2f64.sqrt();
            line.im += im * NOISE_G / 2f64.sqrt();
        }
        lines
    };
    let is_recording = signal == SignalKind::Recording;
    let noise = if is_recording { vec![NOISE_G] } else { Vec::new() };
    let last = record.wheels.len() - 1;
    let seen = |(place, wheel)| (is_recording || place == last).then(|| noisy(wheel));
    let wheels: Vec<Option<WheelLines>> = record.wheels.iter().enumerate().map(seen).collect();
    Observation {
        signal,
        input_speed_hz: is_recording.then_some(record.input_speed_hz),
        zero: vec![AngleZero::Simulated; wheels.len()],
        noise: vec![noise; wheels.len()],
        wheels,
        mismatch: None,
        foreign: None,
        doubts: Vec::new(),
        bearings: BearingDefects::default(),
    }
}

/// (g) Levels of inputs that are no gear.
const LEVELS_G: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];
/// Inputs of each kind and level.
const ASKED_OF_KIND: u64 = 20;

/// Inputs that are no gear, at each of the levels, and recordings that are not what they are stated to be, or are.
const NO_GEARS: [&str; 6] = ["white", "pink", "sine", "bursts", "uniform", "shuffled"];
const OTHER_GEARS: [&str; 10] =
    ["half", "rate", "teeth", "ratio", "times", "divided", "load", "signals", "healthy", "same"];
/// (-) Probability that is sure, and severity that should not be missed then.
const SURE: f64 = 0.9;
const SEVERE: f64 = 0.6;

/// Counts the inputs that are no gear of the rig and pass as one, a row for each kind and level, the right ones that are refused, and the
/// answers that are surely wrong.
fn matrix(prior: &Prior, reference: &ReferenceSet, only: &str) -> Result<String, Box<dyn Error>> {
    let is_asked = |kind: &&str| only.is_empty() || only.split(',').any(|one| one == *kind);
    let mut cases: Vec<(&str, f64)> = Vec::new();
    for kind in NO_GEARS.into_iter().filter(is_asked) {
        cases.extend(LEVELS_G.map(|level_g| (kind, level_g)));
    }
    cases.extend(OTHER_GEARS.into_iter().filter(is_asked).map(|kind| (kind, 0.0)));
    let healthy_of = |unit| strange(prior, 8 * unit, "signals", 0.0);
    let all_healthy = (0..ASKED_OF_KIND).map(healthy_of).collect::<Result<Vec<_>, _>>()?;
    let mut table = String::from("kind,level_g,with_healthy,asked,seen_before,outside,wrong\n");
    for (kind, level_g) in cases {
        let mut counts = [[0; 4]; 2];
        for (unit, healthy) in (0..).zip(&all_healthy) {
            // Healthy and damaged pairs in turn.
            let is_damaged = ["signals", "load"].contains(&kind) && unit % 2 > 0;
            let number = 8 * unit + if is_damaged { 2 + unit / 2 % 6 } else { 1 };
            let severity = prior.draw(number)?.fault.map_or(0.0, |fault| fault.severity);
            let now = [match kind {
                "healthy" => healthy.clone(),
                kind => strange(prior, number, kind, level_g)?,
            }];
            for (with_healthy, counts) in [false, true].into_iter().zip(&mut counts) {
                counts[0] += 1;
                let healthy = if with_healthy { std::slice::from_ref(healthy) } else { &[] };
                let question = Question { now: &now, healthy };
                let refused = question.check(prior).err().map(|error| error.to_string());
                if let Some(reason) = now[0].mismatch.clone().or(refused) {
                    counts[1] += 1;
                    eprintln!("{kind} {number}: {reason}");
                    continue;
                }
                let learned = Learned::new(reference, &question)?;
                let answer = diagnose(&learned, &question, None)?;
                counts[2] += u64::from(answer.is_outside());
                let is_wrong = if is_damaged {
                    severity > SEVERE && answer.damaged() < 1.0 - SURE
                } else {
                    answer.damaged() > SURE
                };
                counts[3] += u64::from(!answer.is_outside() && is_wrong);
                eprintln!(
                    "{kind} {number}: p {:.3}, of the healthy one {:.3}; damaged {:.3}, in truth {severity:.2}",
                    answer.outside_model,
                    answer.healthy_outside_model.unwrap_or(f64::NAN),
                    answer.damaged()
                );
            }
        }
        for (with_healthy, [asked, before, outside, wrong]) in [false, true].into_iter().zip(counts) {
            writeln!(table, "{kind},{level_g},{with_healthy},{asked},{before},{outside},{wrong}")?;
        }
    }
    Ok(table)
}

/// Puts an input that is no gear in the place of a recording.
fn no_gear(signal: &mut Vec<f64>, kind: &str, level_g: f64, rate_hz: f64, draws: &mut Draws) {
    match kind {
        "white" => signal.fill_with(|| draws.normal()),
        "uniform" => signal.fill_with(|| draws.uniform(0.0, 1.0)),
        "pink" => {
            signal.fill_with(|| draws.normal());
            let mut spectrum = real_spectrum(signal);
            spectrum[0] *= 0.0;
            spectrum.iter_mut().enumerate().skip(1).for_each(|(line, value)| *value /= (line as f64).sqrt());
            *signal = from_real_spectrum(spectrum, signal.len());
        }
        "sine" => {
            let hz = draws.uniform(0.5, 0.4) * 0.2 * rate_hz;
            signal
                .iter_mut()
                .enumerate()
                .for_each(|(at, value)| *value = (TAU * hz * at as f64 / rate_hz).sin());
        }
        "bursts" => {
            let every = draws.uniform(0.02, 0.015) * rate_hz;
            let decay = 0.1 * every;
            let value = |at: usize, normal: f64| normal * (-(at as f64 % every) / decay).exp();
            signal.iter_mut().enumerate().for_each(|(at, old)| *old = value(at, draws.normal()));
        }
        _ => {
            for at in (1..signal.len()).rev() {
                signal.swap(at, (draws.bits() % (at as u64 + 1)) as usize);
            }
        }
    }
    let scale = level_g / meshtone::signal::rms(signal);
    signal.iter_mut().for_each(|value| *value *= scale);
}

/// A recording that is not of the pair that it is stated to be of.
fn strange(prior: &Prior, number: u64, what: &str, level_g: f64) -> Result<Observation, Box<dyn Error>> {
    let mut draws = Draws::new(99, Purpose::DiagnosisNoise, number);
    let drawn = prior.draw(number)?;
    let mut scenario = drawn.scenario.clone();
    let stated = [scenario.wheels[0].teeth, scenario.wheels[1].teeth];
    match what {
        "teeth" => scenario.wheels[0].teeth += 2,
        // Another torque on the same wheels, from 1 to 100 N m.
        "load" => scenario.operation.brake_torque_nm = 10.0 * draws.uniform(0.0, 2.3).exp(),
        "ratio" => scenario.wheels[1].teeth = (f64::from(stated[1]) * draws.uniform(0.8, 0.1)) as u32,
        _ => {}
    }
    let simulation = meshtone::simulate(&scenario)?;
    let rate_hz = simulation.stages.time.sampling_rate_hz;
    // Behind the path to the sensor. The same teeth meet again where the simulation ends: it goes on as it began.
    let once = simulation.channels.leading().map_or(&[][..], |signal| &signal.values);
    let mut spectrum = real_spectrum(once);
    let gains = drawn.path_gains((0..spectrum.len()).map(|line| line as f64 * rate_hz / once.len() as f64));
    spectrum.iter_mut().zip(gains).for_each(|(value, gain)| *value *= gain);
    let mut signal = from_real_spectrum(spectrum, once.len()).repeat(4);
    let rms = meshtone::signal::rms(&signal);
    if what == "bearing" {
        // A defect of an outer race: impulses that ring at a resonance, a little off every order, jittered by 1 %.
        let (every_s, ring_hz) = (
            1.0 / (scenario.operation.pinion_speed_hz * draws.uniform(3.6, 0.2)),
            draws.uniform(5000.0, 2500.0),
        );
        let (size, decay_s) = (rms * draws.uniform(4.0, 2.0), 8e-4);
        let mut at_s = 0.0;
        while at_s < signal.len() as f64 / rate_hz {
            let first = (at_s * rate_hz) as usize;
            for (later, value) in
                signal.iter_mut().skip(first).take((6.0 * decay_s * rate_hz) as usize).enumerate()
            {
                let t = later as f64 / rate_hz;
                *value += size * (-t / decay_s).exp() * (TAU * ring_hz * t).sin();
            }
            at_s += every_s * (1.0 + 0.01 * draws.normal());
        }
    }
    // Noise of the sensor and of the machine.
    signal.iter_mut().for_each(|value| *value += NOISE_PART * rms * draws.normal());
    let samples = signal.len();
    let mut stated_hz = rate_hz;
    match what {
        "half" => signal[samples / 2..].fill(0.0),
        "rate" => stated_hz *= 1.13,
        "times" => signal.iter_mut().for_each(|value| *value *= 9.81),
        "divided" => signal.iter_mut().for_each(|value| *value /= 9.81),
        "white" | "pink" | "sine" | "bursts" | "uniform" | "shuffled" => {
            no_gear(&mut signal, what, level_g, rate_hz, &mut draws);
        }
        _ => {}
    }
    let speed_hz = scenario.operation.pinion_speed_hz;
    let phase = ShaftPhase::constant(speed_hz, stated_hz, samples)?;
    let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::ConstantSpeed { speed_hz } };
    let train = GearTrain::of_wheels([("pinion", stated[0]), ("gear", stated[1])]);
    let recording =
        TrainRecording { signal: &signal, sampling_rate_hz: stated_hz, train: &train, turning: &turning };
    Ok(Observation::of_recording(&recording)?)
}

fn row(
    table: &mut String,
    record: &ReferenceRecord,
    kind: &str,
    answer: &Answer,
    apart: [f64; 2],
) -> Result<(), Box<dyn Error>> {
    let of_kind = answer.kinds.iter().find(|of| of.label == kind);
    let names = &answer.wheels;
    let (wheel, severity, tooth) = record.fault.as_ref().map_or(("", 0.0, 0), |fault| {
        (names[fault.wheel].as_str(), fault.severity, if fault.is_on_one_tooth { fault.tooth } else { 0 })
    });
    write!(
        table,
        "{},{kind},{wheel},{severity},{tooth},{},{}",
        record.number / 8,
        answer.kinds[0].label,
        answer.damaged()
    )?;
    let probability = of_kind.map_or(0.0, |of| of.probability);
    write!(
        table,
        ",{probability},{},{},{}",
        answer.outside_model,
        answer.healthy_outside_model.unwrap_or(f64::NAN),
        answer.common_change.map_or(f64::NAN, |change| change.p)
    )?;
    match of_kind.and_then(|of| of.severity) {
        Some(said) => {
            let [lowest, highest] = said.within_90;
            let [low, high] = said.within_50;
            write!(table, ",{lowest},{low},{},{high},{highest}", said.median)?;
        }
        None => write!(table, ",,,,,")?,
    }
    let place = of_kind.and_then(|of| of.place);
    let said_wheel = place.map_or("", |place| names[place.wheel].as_str());
    let tooth = place.and_then(|place| place.tooth);
    let said_tooth = tooth.map_or(0, |tooth| tooth.number);
    let sure = tooth.map_or(f64::NAN, |tooth| tooth.probability);
    let any_wheel = answer.any_damage.as_ref().map_or("", |any| &names[any.wheel]);
    let [speed_ln, load_ln] = apart;
    writeln!(table, ",{said_wheel},{said_tooth},{sure},{any_wheel},{speed_ln},{load_ln}")?;
    Ok(())
}
