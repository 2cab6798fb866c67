//! What is said about recordings as rigs make them: hunting-tooth orders, a second mesh, noise, hum; stated rightly and wrongly.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;

use meshtone::signal::{
    AngularSignal, ChainSettings, Edge, GearTrain, MeshTone, ShaftPhase, SignalWarning, StatedFacts,
    StatedTurning, TrainRecording, TrainSettings, TrainTurning, angular_resample, check_recording,
    interpolate_band_limited, process_angular, resample,
};
use rayon::prelude::*;

use crate::signal::{noise, wave};
use crate::signal_mismatch::{Draws, Machine, machine_of, pulses};

/// Pinion and gear; of the first twelve z/z' = p/q in lowest terms has an even p for one of the wheels, as it is stated below.
const PAIRS: [[u32; 2]; 30] = [
    [32, 80],
    [36, 90],
    [24, 60],
    [20, 50],
    [16, 40],
    [32, 48],
    [46, 23],
    [64, 48],
    [40, 50],
    [48, 56],
    [28, 42],
    [60, 45],
    [23, 46],
    [48, 64],
    [17, 38],
    [25, 30],
    [19, 57],
    [20, 60],
    [30, 70],
    [21, 43],
    [29, 67],
    [31, 62],
    [35, 49],
    [18, 81],
    [15, 35],
    [27, 63],
    [33, 55],
    [37, 41],
    [22, 77],
    [45, 60],
];
/// (N m) Brake torque at which most teeth stay in contact: where they rattle, hardly anything repeats.
const LEAST_TORQUE_NM: f64 = 30.0;
/// Recordings of each pair.
const EACH: u64 = 10;

/// How something is stated wrongly, or what the recording has beside the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Wrong {
    Nothing,
    RateAndSpeed,
    NoGear,
    SpeedHardlyOff,
    RunUpAtConstantSpeed,
    RunUpFromMeshTone,
    ForeignTones,
}

/// What a recorder on a rig has kept.
struct Recording {
    signal: Vec<f64>,
    rate_hz: f64,
    /// (rev) How far the shaft of the wheel has turned at each sample.
    turned: Vec<f64>,
    teeth: u32,
    mate_teeth: u32,
}

fn rms(signal: &[f64]) -> f64 {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    (signal.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / signal.len() as f64).sqrt()
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

/// Thirty revolutions of the slower wheel and more of a simulated pair, with the orders of both shafts, noise down to -3 dB, hum and
/// bearing tones in some, and in a third hunting-tooth orders and a second mesh on either shaft.
///
/// # Arguments
/// * `run_up` - last speed over the first; 1 for a speed that is constant
/// * `foreign` - (-) energy of tones of neither shaft over the rest
fn recording(machine: &Machine, index: u64, run_up: f64, foreign: f64, draws: &mut Draws) -> Recording {
    let [pinion, gear] = machine.teeth.map(f64::from);
    let per_revolution = machine.samples_per_pinion_revolution;
    let slower = per_revolution * (gear / pinion).max(1.0);
    let whole = machine.signal.len() as f64;
    let samples = (slower * draws.in_octaves(30.0, (whole / slower).max(30.0))).min(whole) as usize;
    let first = (draws.part() * (machine.signal.len() - samples) as f64) as usize;
    let mut signal = machine.signal[first..first + samples].to_vec();
    let mut turned: Vec<f64> = (first..first + samples).map(|i| i as f64 / per_revolution).collect();
    if run_up != 1.0 {
        let end = (samples - 1) as f64;
        let angle = |x: f64| (x + 0.5 * (run_up - 1.0) * x * x) / (1.0 + 0.5 * (run_up - 1.0));
        let places: Vec<f64> = (0..samples).map(|i| end * angle(i as f64 / end)).collect();
        signal = interpolate_band_limited(&signal, &places, Edge::Reflect).unwrap();
        turned = places.iter().map(|place| (first as f64 + place) / per_revolution).collect();
    }
    let mesh_hz = pinion * machine.rate_hz / per_revolution;
    let every = ((machine.rate_hz / draws.in_octaves((6.0 * mesh_hz).max(5e3), 51_200.0)) as usize).max(1);
    let mut signal = resample(&signal, 1, every, Edge::Reflect).unwrap();
    let turned: Vec<f64> = turned.into_iter().step_by(every).collect();
    let rate_hz = machine.rate_hz / every as f64;
    let (own, mate) = if index.is_multiple_of(2) { (0, 1) } else { (1, 0) };
    let [teeth, mate_teeth] = [machine.teeth[own], machine.teeth[mate]];
    let turned: Vec<f64> = turned.iter().map(|angle| pinion / f64::from(teeth) * angle).collect();
    let ratio = f64::from(teeth) / f64::from(mate_teeth);
    let level = rms(&signal);
    let mut add = |order: f64, amplitude: f64, start: f64| {
        signal.iter_mut().zip(&turned).for_each(|(x, angle)| *x += amplitude * wave(order * angle + start));
    };
    for shaft in [1.0, ratio] {
        for order in 1..=3 {
            add(f64::from(order) * shaft, level * draws.between(0.0, 0.15), draws.part());
        }
    }
    if index.is_multiple_of(3) {
        let second = f64::from(draws.count(13, 90));
        let (shaft, third) = (draws.one(&[1.0, ratio]), draws.between(0.2, 0.8));
        for harmonic in 1..=4 {
            let amplitude = level * draws.between(0.1, 0.8) / f64::from(harmonic);
            let order = f64::from(harmonic) * second * shaft;
            add(order, amplitude, draws.part());
            for sideband in [-1.0, 1.0] {
                add(order + sideband * shaft, 0.3 * amplitude, draws.part());
                add(order + sideband * third * shaft, 0.1 * amplitude, draws.part());
            }
        }
        add_hunting(
            &mut signal,
            &turned,
            mate_teeth / greatest_common_divisor(teeth, mate_teeth),
            level,
            draws,
        );
    }
    let speed_hz = (turned[turned.len() - 1] - turned[0]) * rate_hz / (turned.len() - 1) as f64;
    let hum = draws.chance(0.3).then(|| draws.one(&[50.0, 60.0]) / speed_hz);
    let bearing = draws.chance(0.3).then(|| draws.between(2.3, 9.7));
    for order in hum.into_iter().chain(bearing) {
        for harmonic in 1..=4 {
            let cycles = f64::from(harmonic) * order * speed_hz / rate_hz;
            let (amplitude, start) = (level * draws.between(0.0, 0.15), draws.part());
            signal
                .iter_mut()
                .enumerate()
                .for_each(|(i, x)| *x += amplitude * wave(cycles * i as f64 + start));
        }
    }
    if foreign > 0.0 {
        let amplitude = rms(&signal) * (2.0 * foreign / 3.0).sqrt();
        for _ in 0..3 {
            let cycles = draws.between(3.1, 60.0) * speed_hz / rate_hz;
            let start = draws.part();
            signal
                .iter_mut()
                .enumerate()
                .for_each(|(i, x)| *x += amplitude * wave(cycles * i as f64 + start));
        }
    }
    let amplitude = rms(&signal) * 10f64.powf(draws.one(&[-20.0, -10.0, -6.0, -3.0]) / 20.0);
    let noise = noise((draws.part() * 1e15) as u64, signal.len());
    signal.iter_mut().zip(noise).for_each(|(x, noise)| *x += amplitude * noise);
    Recording { signal, rate_hz, turned, teeth, mate_teeth }
}

/// Adds what repeats when the same teeth meet again, after `period` revolutions: every multiple of 1/period, the higher the weaker.
fn add_hunting(signal: &mut [f64], turned: &[f64], period: u32, level: f64, draws: &mut Draws) {
    const POINTS: usize = 128;
    let count = period as usize * POINTS;
    let mut table = noise((draws.part() * 1e15) as u64, count);
    for _ in 0..2 {
        let mut value = 0.0;
        for _ in 0..2 {
            for point in &mut table {
                value += 0.15 * (*point - value);
                *point = value;
            }
        }
    }
    let scale = level * draws.between(0.1, 0.6) / rms(&table);
    for (x, angle) in signal.iter_mut().zip(turned) {
        let place = angle.rem_euclid(f64::from(period)) * POINTS as f64;
        let (at, part) = (place as usize % count, place.fract());
        *x += scale * ((1.0 - part) * table[at] + part * table[(at + 1) % count]);
    }
}

/// What is said about a recording of which something is stated; none where the chain refuses it.
fn said(machine: &Machine, wrong: Wrong, index: u64, draws: &mut Draws) -> Option<Vec<SignalWarning>> {
    let run_up = match wrong {
        Wrong::RunUpAtConstantSpeed | Wrong::RunUpFromMeshTone => draws.in_octaves(1.3, 8.0),
        _ => 1.0,
    };
    let foreign = if wrong == Wrong::ForeignTones { draws.in_octaves(0.6, 3.0) } else { 0.0 };
    let mut of = recording(machine, index, run_up, foreign, draws);
    let samples = of.signal.len();
    let right_hz = (of.turned[samples - 1] - of.turned[0]) * of.rate_hz / (samples - 1) as f64;
    let seconds = samples as f64 / of.rate_hz;
    let speed_hz = match wrong {
        Wrong::RateAndSpeed => {
            let factor = draws.in_octaves(0.5, 2.0);
            right_hz * if (factor - 1.0).abs() < 0.08 { 1.5495 } else { factor }
        }
        Wrong::SpeedHardlyOff => {
            let cycles = draws.between(0.6, 2.0) * draws.one(&[-1.0, 1.0]);
            right_hz + cycles / (f64::from(of.teeth) * seconds)
        }
        _ => right_hz,
    };
    if wrong == Wrong::NoGear {
        of.signal = noise(index, samples);
    }
    let mut stated = StatedFacts {
        teeth: of.teeth,
        // Tones are only looked for where the mate's orders are known.
        mate_teeth: (draws.chance(0.7) || wrong == Wrong::ForeignTones).then_some(of.mate_teeth),
        turning: StatedTurning::ConstantSpeed { speed_hz },
    };
    let phase = if wrong == Wrong::RunUpFromMeshTone {
        stated.turning = StatedTurning::MeshTone { nominal_hz: speed_hz };
        ShaftPhase::from_mesh_tone(&of.signal, of.rate_hz, &MeshTone::new(of.teeth, speed_hz)).ok()?
    } else if index % 4 < 2 && matches!(wrong, Wrong::Nothing | Wrong::ForeignTones) {
        stated.turning = StatedTurning::Pulses { per_revolution: 1 };
        ShaftPhase::from_pulses(&pulses(&of.turned, 1, of.rate_hz), 1, None, of.rate_hz, samples).ok()?
    } else {
        ShaftPhase::constant(speed_hz, of.rate_hz, samples).ok()?
    };
    warnings(&of, &phase, &stated)
}

fn warnings(of: &Recording, phase: &ShaftPhase, stated: &StatedFacts) -> Option<Vec<SignalWarning>> {
    let angular = angular_resample(&of.signal, phase, &Default::default()).ok()?;
    if f64::from(stated.teeth) >= 0.8 * angular.nyquist_order {
        return None;
    }
    let mut found = phase.warnings.clone();
    found.extend(check_recording(&angular, stated, phase, of.rate_hz));
    let record = process_angular(&angular, stated.teeth, &ChainSettings::default()).ok()?;
    found.extend(record.warnings.into_iter().filter(|warning| warning.code() != "mesh-order-near-nyquist"));
    Some(found)
}

fn machines(pairs: &[[u32; 2]]) -> Vec<Machine> {
    let of = |(index, teeth): (usize, &[u32; 2])| {
        (0..20u64).find_map(|attempt| {
            let seed = 500 + 100 * attempt + index as u64;
            machine_of(seed, *teeth, LEAST_TORQUE_NM, &mut Draws::new(seed))
        })
    };
    pairs.par_iter().enumerate().filter_map(of).collect()
}

/// What is said about so many recordings of each pair.
///
/// Returns the recordings, those that the chain refuses, and those of which a warning says something.
fn count(machines: &[Machine], wrong: Wrong, each: u64) -> [usize; 3] {
    let all: Vec<Option<Vec<SignalWarning>>> = (0..machines.len() as u64 * each)
        .into_par_iter()
        .map(|number| {
            let (machine, index) = (&machines[(number / each) as usize], number % each);
            let said = said(machine, wrong, index, &mut Draws::new(10_000 * (wrong as u64 + 1) + number));
            if std::env::var_os("RECORDINGS_SHOW").is_some() {
                let codes =
                    said.as_ref().map(|said| said.iter().map(SignalWarning::code).collect::<Vec<_>>());
                println!("{wrong:?} {number} {:?}: {codes:?}", machine.teeth);
            }
            said
        })
        .collect();
    let refused = all.iter().filter(|said| said.is_none()).count();
    let warned = all.iter().filter(|said| said.as_ref().is_some_and(|said| !said.is_empty())).count();
    [all.len(), refused, warned]
}

/// Prints the table of the book: `cargo test --release -p meshtone-tests --test core -- --ignored recordings_of_rigs --nocapture`.
#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn recordings_of_rigs() {
    let machines = machines(&PAIRS);
    assert_eq!(machines.len(), PAIRS.len());
    println!("| recording | recordings | refused | with a warning |");
    for (wrong, name, each) in [
        (Wrong::Nothing, "right", EACH),
        (Wrong::RateAndSpeed, "sampling rate or speed off by 8 to 100 %", 2),
        (Wrong::NoGear, "noise alone", 2),
        (Wrong::SpeedHardlyOff, "speed off by 0.6 to 2 mesh cycles in all", 2),
        (Wrong::RunUpAtConstantSpeed, "run-up by a factor of 1.3 to 8, constant speed stated", 2),
        (Wrong::RunUpFromMeshTone, "run-up by a factor of 1.3 to 8, from the mesh tone", 2),
        (Wrong::ForeignTones, "three foreign tones, 38 to 75 % of the energy", 2),
    ] {
        let [all, refused, warned] = count(&machines, wrong, each);
        println!("| {name} | {all} | {refused} | {warned} |");
    }
}

#[test]
fn wrong_recordings_of_a_rig_are_seen_and_right_ones_pass() {
    let machines = machines(&PAIRS[..2]);
    assert_eq!(count(&machines, Wrong::Nothing, 6), [12, 0, 0]);
    for wrong in [Wrong::RateAndSpeed, Wrong::NoGear, Wrong::SpeedHardlyOff, Wrong::RunUpAtConstantSpeed] {
        assert_eq!(count(&machines, wrong, 2), [4, 0, 4], "{wrong:?}");
    }
}

/// The sum of the [`wave`]s of 1, 2, … to `count` times so many cycles, in closed form.
fn waves(count: u32, cycles: f64) -> f64 {
    let (half, count) = (PI * cycles.fract(), f64::from(count));
    let sine = half.sin();
    if sine.abs() < 1e-9 { count } else { (count * half).sin() * ((count + 1.0) * half).cos() / sine }
}

#[test]
fn the_closed_form_is_the_sum_of_waves() {
    for cycles in [0.0, 1.0, 0.13, 7.25, 0.999, 41.0 / 3.0] {
        let sum: f64 = (1..=120).map(|k| wave(f64::from(k) * cycles)).sum();
        assert!((waves(120, cycles) - sum).abs() < 1e-9, "{cycles}: {} {sum}", waves(120, cycles));
    }
}

/// Orders of both shafts and mesh harmonics with sidebands, the hunting-tooth orders of a pair, and noise, over so many revolutions.
fn pair_with_hunting_tooth(teeth: u32, mate_teeth: u32, revolutions: usize) -> AngularSignal {
    let points_per_revolution = 1024;
    let period = f64::from(mate_teeth / greatest_common_divisor(teeth, mate_teeth));
    let ratio = f64::from(teeth) / f64::from(mate_teeth);
    let noise = noise(u64::from(teeth), points_per_revolution * revolutions);
    let value = |(at, noise): (usize, f64)| {
        let turned = at as f64 / points_per_revolution as f64;
        let of = |spacing: f64, amplitude: f64| amplitude * waves(120, spacing * turned + 0.13);
        let mesh: f64 = (1..=4).map(|h| wave(f64::from(h * teeth) * turned) / f64::from(h)).sum();
        (1.0 + 0.2 * wave(turned) + 0.2 * wave(ratio * turned)) * mesh
            + of(1.0, 0.1)
            + of(ratio, 0.1)
            + of(1.0 / period, 0.1)
            + noise
    };
    let values = noise.into_iter().enumerate().map(value).collect();
    AngularSignal { points_per_revolution, start_rev: 0.0, nyquist_order: 512.0, values }
}

/// Under four periods of the hunting tooth its orders are no lines of their own: none of them is foreign, and the needed length is said.
#[test]
fn hunting_tooth_orders_of_a_short_recording_are_not_foreign() {
    let (speed_hz, rate_hz) = (30.0, 30.0 * 1024.0);
    let train = GearTrain::of_wheels([("pinion", 23), ("gear", 38)]);
    let searched = |revolutions: usize| {
        let signal = pair_with_hunting_tooth(23, 38, revolutions).values;
        let phase = ShaftPhase::constant(speed_hz, rate_hz, signal.len()).unwrap();
        let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz: rate_hz, train: &train, turning: &turning };
        let found = recording.process(&TrainSettings::default()).unwrap();
        println!("{revolutions}: {:?} {:?}", found.foreign, found.warnings);
        found.foreign.unwrap()
    };
    for revolutions in [100, 148] {
        let found = searched(revolutions);
        assert!(found.tones.is_empty(), "{revolutions}: {found:?}");
        let needed_s = found.needed_s.unwrap();
        assert!((needed_s - 153.0 / speed_hz).abs() < 0.01, "{needed_s}");
    }
    assert_eq!(searched(160).needed_s, None);
}

#[test]
fn hunting_tooth_orders_are_no_other_mate() {
    let mut found = 0;
    for (teeth, mate_teeth) in [
        (32, 80),
        (36, 90),
        (24, 60),
        (20, 50),
        (16, 40),
        (32, 48),
        (23, 46),
        (80, 32),
        (46, 23),
        (64, 48),
        (23, 38),
    ] {
        let angular = pair_with_hunting_tooth(teeth, mate_teeth, 128);
        let phase = ShaftPhase::constant(30.0, 3e4, 10_000).unwrap();
        let pulses = StatedTurning::Pulses { per_revolution: 1 };
        for turning in [pulses, StatedTurning::ConstantSpeed { speed_hz: 30.0 }] {
            let stated = StatedFacts { teeth, mate_teeth: Some(mate_teeth), turning };
            assert_eq!(check_recording(&angular, &stated, &phase, 3e4), [], "{teeth}/{mate_teeth}");
        }
        let wrong = StatedFacts { teeth, mate_teeth: Some(mate_teeth + 1), turning: pulses };
        let said = check_recording(&angular, &wrong, &phase, 3e4);
        found += usize::from(
            said.iter().any(|said| (said.code(), said.values()[0].1) == ("mate_teeth", mate_teeth.into())),
        );
    }
    assert!(found >= 6, "{found}");
}
