//! Recordings of gearboxes: the phase of one shaft gives the averages, indicators and foreign lines of all.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;

use meshtone::scenario::*;
use meshtone::signal::{
    AngularSettings, Edge, GearTrain, ShaftPhase, SignalError, SignalWarning, StatedTurning, Tachometer,
    TrainRecording, TrainRecords, TrainSettings, TrainTurning, resample_to, synchronous_average,
    tachometer_pulses,
};

fn healthy(rig: Option<GearboxRig>) -> Scenario {
    let mut gearbox = crate::plain::plain(Scenario::from_toml(&gearbox_template(rig)).unwrap());
    gearbox.faults.clear();
    for wheel in &mut gearbox.wheels {
        if wheel.din_grade == 0 {
            wheel.iso_class = 6;
        }
    }
    gearbox
}

/// What one sensor records, from a moment on at which all shafts have turned whole revolutions.
struct Recorded {
    train: GearTrain,
    rate_hz: f64,
    signal: Vec<f64>,
    /// (rev) Angle of the input.
    input_rev: Vec<f64>,
}

fn record(gearbox: &Scenario, sensor: &str, cycles: usize, profile_hz: Option<[f64; 2]>) -> Recorded {
    let [recorded] = record_at(gearbox, [sensor], cycles, profile_hz);
    recorded
}

/// What several sensors record of one simulation.
fn record_at<const SENSORS: usize>(
    gearbox: &Scenario,
    sensors: [&str; SENSORS],
    cycles: usize,
    profile_hz: Option<[f64; 2]>,
) -> [Recorded; SENSORS] {
    let mut gearbox = gearbox.clone();
    gearbox.sensors = sensors.map(Sensor::at_place).to_vec();
    let cycle_rev = gearbox.layout().unwrap().cycle_revolutions() as f64;
    let speed_hz = gearbox.operation.pinion_speed_hz;
    let duration_s = (cycles + 1) as f64 * cycle_rev / speed_hz + 0.01;
    gearbox.solver.discard_and_keep(0.3, duration_s);
    if let Some([from_hz, to_hz]) = profile_hz {
        let value = vec![(from_hz + to_hz) / 2.0, to_hz];
        gearbox.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, duration_s], value });
    }
    let channels = meshtone::simulate(&gearbox).unwrap().channels;
    let phase = ShaftPhase::of_simulated_input(&gearbox, channels.start_s, channels.len()).unwrap();
    let angle = phase.revolutions;
    let from_rev = (angle[0] / cycle_rev).ceil() * cycle_rev;
    let from = angle.partition_point(|rev| *rev < from_rev - 1e-3);
    let to = angle.partition_point(|rev| *rev < from_rev + cycles as f64 * cycle_rev + 1e-3).min(angle.len());
    let of_sensors: Vec<&str> = channels.signals[..SENSORS].iter().map(|signal| signal.unit).collect();
    assert_eq!(of_sensors, ["g"; SENSORS]);
    std::array::from_fn(|sensor| Recorded {
        train: GearTrain::of_scenario(&gearbox).unwrap(),
        rate_hz: channels.sampling_rate_hz,
        signal: channels.signals[sensor].values[from..to].to_vec(),
        input_rev: angle[from..to].to_vec(),
    })
}

impl Recorded {
    /// The phase of a shaft by a tachometer on it, whose waveform is a sine.
    fn tachometer(&self, shaft: usize) -> TrainTurning {
        let ratio = self.train.shafts[shaft].speed_ratio.value();
        let waveform: Vec<f64> = self.input_rev.iter().map(|rev| (TAU * rev * ratio).sin()).collect();
        let settings = Tachometer { threshold: Some(0.0), ..Tachometer::default() };
        let pulses = tachometer_pulses(&waveform, self.rate_hz, &settings).unwrap();
        let phase = ShaftPhase::from_pulses(&pulses, 1, None, self.rate_hz, self.signal.len()).unwrap();
        TrainTurning::Shaft { shaft, phase, stated: StatedTurning::Pulses { per_revolution: 1 } }
    }

    fn recording<'a>(&'a self, turning: &'a TrainTurning) -> TrainRecording<'a> {
        TrainRecording { signal: &self.signal, sampling_rate_hz: self.rate_hz, train: &self.train, turning }
    }

    /// All records by a tachometer on the input.
    fn process(&self) -> TrainRecords {
        let turning = self.tachometer(self.train.input());
        self.recording(&turning).process(&TrainSettings::default()).unwrap()
    }
}

/// The averages of the intermediate and of the output shaft by the tachometer of the input are those by tachometers of their own, also where
/// the speed drifts by 4 %.
#[test]
fn one_tachometer_gives_the_averages_of_all_shafts() {
    for profile_hz in [None, Some([29.4, 30.6])] {
        let recorded = record(&healthy(None), "middle:1", 5, profile_hz);
        let of_input = recorded.tachometer(0);
        for (wheel, shaft) in [(0, 0), (1, 1), (2, 1), (3, 2)] {
            let own = recorded.tachometer(shaft);
            let settings =
                AngularSettings { points_per_revolution: Some(16_384), ..AngularSettings::default() };
            let [carried, own] = [&of_input, &own].map(|turning| {
                synchronous_average(&recorded.recording(turning).angular(wheel, &settings).unwrap()).unwrap()
            });
            assert_eq!(carried.revolutions, own.revolutions);
            let square =
                |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>();
            let apart = square(&mut carried.values.iter().zip(&own.values).map(|(a, b)| a - b));
            let part = (apart / square(&mut own.values.iter().copied())).sqrt();
            println!("{profile_hz:?}, wheel {wheel}: {} revolutions, apart by {part:.2e}", own.revolutions);
            assert!(part < 0.01, "{profile_hz:?}, wheel {wheel}: {part}");
        }
    }
}

/// A missing tooth shows on its own shaft: the kurtosis of the difference signal is at least twice that of the other shafts, at sensors that
/// hear all of them, and no line is foreign. At the input's bearings the output's difference is a twentieth of the input's, and traces of the
/// input's tooth make it impulsive.
#[test]
fn a_missing_tooth_shows_on_its_own_shaft() {
    let mut gearbox = crate::plain::even(healthy(None));
    gearbox.solver.sampling_rate_hz = 5e4;
    for (number, wheel) in gearbox.wheels.iter().enumerate() {
        let mut damaged = gearbox.clone();
        let fault = Fault::new(WheelName::Gear, 5, MissingTooth);
        damaged.faults = vec![Fault { wheel: wheel.name.clone(), ..fault }];
        let sensors = ["middle:1", "output:0", "output:1"];
        for (sensor, recorded) in sensors.into_iter().zip(record_at(&damaged, sensors, 5, None)) {
            let records = recorded.process();
            let differences = records.wheels.iter().map(|of| of.records[0].indicators.difference);
            let kurtosis: Vec<f64> = differences.map(|of| of.kurtosis.unwrap()).collect();
            println!("{} gone, {sensor}: kurtosis {kurtosis:.1?}", wheel.name);
            let shaft = recorded.train.wheels[number].shaft;
            let others = (0..4).filter(|other| recorded.train.wheels[*other].shaft != shaft);
            let most = others.map(|other| kurtosis[other]).fold(0.0, f64::max);
            assert!(kurtosis[number] >= 2.0 * most, "{} at {sensor}: {kurtosis:?}", wheel.name);
            let foreign = records.foreign.unwrap().tones;
            assert!(foreign.is_empty(), "{} at {sensor}: {foreign:?}", wheel.name);
        }
    }
}

/// No line of healthy gearboxes is foreign at any sensor, whatever their tooth counts; the tone of a bearing is.
#[test]
fn a_bearing_is_foreign_and_the_gearbox_is_not() {
    for rig in [None, Some(GearboxRig::Uconn), Some(GearboxRig::Tecnalia)] {
        let gearbox = healthy(rig);
        let mut gearbox = gearbox.clone();
        gearbox.solver.discard_and_keep(0.3, 3.0);
        if rig.is_some() {
            // A tone of UConn's machine lasts for seconds.
            gearbox.solver.discard_and_keep(3.0, 3.0);
            // At the rate of the rig's recordings: far above it, where nothing is noise, lines count of less than a hundred-thousandth of the power.
            gearbox.solver.sampling_rate_hz = 20_480.0;
        }
        gearbox.sensors = ["input:0", "middle:1", "output:1"].map(Sensor::at_place).to_vec();
        let channels = meshtone::simulate(&gearbox).unwrap().channels;
        let train = GearTrain::of_scenario(&gearbox).unwrap();
        let phase = ShaftPhase::of_simulated_input(&gearbox, channels.start_s, channels.len()).unwrap();
        let turning =
            TrainTurning::Shaft { shaft: train.input(), phase: phase.clone(), stated: StatedTurning::Other };
        for signal in channels.signals.iter().filter(|signal| signal.unit == "g") {
            let process = |values: &[f64]| {
                let recording = TrainRecording {
                    signal: values,
                    sampling_rate_hz: channels.sampling_rate_hz,
                    train: &train,
                    turning: &turning,
                };
                recording.process(&TrainSettings::default()).unwrap()
            };
            let records = process(&signal.values);
            println!("{rig:?} {}: {:?} {:?}", signal.name, records.foreign, records.warnings);
            let foreign = records.foreign.unwrap();
            assert!(foreign.tones.is_empty(), "{rig:?} {}: {foreign:?}", signal.name);
            // An output may not be heard at the input.
            let codes = records.warnings.iter().map(|warning| warning.code());
            assert!(codes.clone().all(|code| code == "nothing-synchronous"), "{rig:?} {}", signal.name);
            // A tenth of the signal's level at the outer race's order of a bearing with eight balls.
            let level = meshtone::signal::rms(&signal.values);
            let tone = |rev: &f64| 0.1 * level * 2f64.sqrt() * (TAU * 3.0523 * rev).cos();
            let values: Vec<f64> =
                signal.values.iter().zip(&phase.revolutions).map(|(value, rev)| value + tone(rev)).collect();
            let foreign = process(&values).foreign.unwrap();
            // The same teeth of 29/100 and 36/90 meet again after 250 revolutions of the input: no weak line is judged in a third of that.
            if rig == Some(GearboxRig::Tecnalia) {
                let least_s = 4.0 * 250.0 / gearbox.operation.pinion_speed_hz;
                assert!(foreign.tones.is_empty() && foreign.needed_s.unwrap() >= least_s, "{foreign:?}");
                continue;
            }
            assert_eq!(foreign.needed_s, None, "{rig:?}");
            let foreign = foreign.tones;
            let [bearing] = foreign[..] else { panic!("{rig:?} {}: {foreign:?}", signal.name) };
            let hz = 3.0523 * gearbox.operation.pinion_speed_hz;
            assert!((bearing.order - 3.0523).abs() < 5e-3 && (bearing.frequency_hz / hz - 1.0).abs() < 2e-3);
            let amplitude = 0.1 * level * 2f64.sqrt();
            assert!((bearing.amplitude / amplitude - 1.0).abs() < 0.15, "{bearing:?} {amplitude}");
        }
    }
}

/// The mesh tone of a mesh gives the phase of its shaft, and a wrong constant speed is found.
#[test]
fn a_mesh_tone_and_a_wrong_speed() {
    let recorded = record(&healthy(None), "middle:1", 5, None);
    let tone = meshtone::signal::MeshTone::new(48, 10.01);
    let phase = ShaftPhase::from_mesh_tone(&recorded.signal, recorded.rate_hz, &tone).unwrap();
    let turning =
        TrainTurning::Shaft { shaft: 1, phase, stated: StatedTurning::MeshTone { nominal_hz: 10.01 } };
    let records = recorded.recording(&turning).process(&TrainSettings::default()).unwrap();
    let speeds: Vec<f64> = records.wheels.iter().map(|of| of.mean_speed_hz).collect();
    for (found, right) in speeds.iter().zip([30.0, 10.0, 10.0, 6.0]) {
        assert!((found / right - 1.0).abs() < 1e-4, "{speeds:?}");
    }
    println!("{:?} {:?}", records.foreign, records.warnings);
    assert_eq!(records.warnings, []);
    let by_tachometer = recorded.process();
    for (of_tone, of_tachometer) in records.wheels.iter().zip(&by_tachometer.wheels) {
        let rms = |of: &meshtone::signal::WheelRecords| of.records[0].indicators.average.rms;
        assert!((rms(of_tone) / rms(of_tachometer) - 1.0).abs() < 0.05);
    }
    // At a rate as of a rig, 1 % off.
    let rate_hz = 20_000.0;
    let signal = resample_to(&recorded.signal, recorded.rate_hz, rate_hz, Edge::Zero).unwrap();
    let phase = ShaftPhase::constant(30.3, rate_hz, signal.len()).unwrap();
    let turning =
        TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::ConstantSpeed { speed_hz: 30.3 } };
    let recording = TrainRecording {
        signal: &signal,
        sampling_rate_hz: rate_hz,
        train: &recorded.train,
        turning: &turning,
    };
    let records = recording.process(&TrainSettings::default()).unwrap();
    println!("{:?}", records.warnings);
    assert!(records.warnings.iter().any(|warning| warning.code() == "speed_hz"), "{:?}", records.warnings);
}

/// Where the angle is that of a mesh tone, with an error of less than half a cycle of it, harmonics of the other mesh of the shaft, which lie eight times as
/// high and as far beside their orders, are not foreign; of a tachometer they would be.
#[test]
fn an_error_of_the_mesh_tone_makes_no_line_foreign() {
    let train = GearTrain::of_scenario(&healthy(None)).unwrap();
    let (rate_hz, turns, followed) = (20_000.0, 41.0, 48.0);
    let turned: Vec<f64> = (0..82_000).map(|i| turns * f64::from(i) / 82_000.0).collect();
    let noise = crate::signal::noise(7, turned.len());
    let order = |order: f64, rev: f64| (TAU * (order * rev).fract()).cos();
    let meshes = |rev: f64| order(48.0, rev) + (1..=4).map(|h| order(f64::from(96 * h), rev)).sum::<f64>();
    let signal: Vec<f64> = turned.iter().zip(noise).map(|(rev, noise)| meshes(*rev) + 0.1 * noise).collect();
    let off = 1.0 + 0.4 / (followed * turns);
    let phase = ShaftPhase::new(0, turned.iter().map(|rev| off * rev).collect()).unwrap();
    let tones = |stated: StatedTurning| {
        let turning = TrainTurning::Shaft { shaft: 1, phase: phase.clone(), stated };
        let recording =
            TrainRecording { signal: &signal, sampling_rate_hz: rate_hz, train: &train, turning: &turning };
        let records = recording.process(&TrainSettings::default()).unwrap();
        println!("{stated:?} {:?} {:?}", records.foreign, records.warnings);
        records.foreign.map(|found| found.tones.len())
    };
    assert_eq!(tones(StatedTurning::MeshTone { nominal_hz: 10.0 }), Some(0));
    assert!(tones(StatedTurning::Other) > Some(0));
}

/// A recording of 1.6 revolutions of the output shaft has no average of its wheel, but those of the others; of 0.4, there is none at all.
#[test]
fn a_wheel_that_turns_too_little_leaves_the_others() {
    let mut recorded = record(&healthy(None), "middle:1", 1, None);
    let samples = |input_rev: f64| {
        let from = recorded.input_rev[0];
        recorded.input_rev.partition_point(|rev| *rev < from + input_rev)
    };
    let (long, short) = (samples(8.0), samples(1.5));
    recorded.signal.truncate(long);
    recorded.input_rev.truncate(long);
    let records = recorded.process();
    let wheels: Vec<usize> = records.wheels.iter().map(|of| of.wheel).collect();
    assert_eq!(wheels, [0, 1, 2]);
    let [SignalWarning::WheelWithoutAverage(without)] = &records.warnings[..] else {
        panic!("{:?}", records.warnings)
    };
    assert_eq!((without.wheel.as_str(), without.teeth), ("z4", 80));
    recorded.signal.truncate(short);
    recorded.input_rev.truncate(short);
    let phase = ShaftPhase::new(0, recorded.input_rev.clone()).unwrap();
    let turning = TrainTurning::Shaft { shaft: 0, phase, stated: StatedTurning::Other };
    let none = recorded.recording(&turning).process(&TrainSettings::default()).unwrap_err();
    assert!(matches!(none.error, SignalError::TooFewRevolutions { .. }), "{none}");
}

/// A longer recording leaves fewer orders in which a foreign line would not be seen.
#[test]
fn a_longer_recording_distinguishes_more_orders() {
    let part =
        |cycles: usize| record(&healthy(None), "middle:1", cycles, None).process().foreign.unwrap().own_part;
    let [short, long] = [2, 8].map(part);
    println!("{short:.3} {long:.3}");
    assert!(short <= 1.0 && long < 0.5 * short, "{short} {long}");
}
