//! Whether what is said about a recording fits: simulated recordings with every mistake, and with none.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;

use meshtone::scenario::Scenario;
use meshtone::signal::{
    Alternative, AngularSettings, AngularSignal, Edge, Mismatch, ShaftPhase, StatedFacts, StatedTurning,
    angular_resample, find_mismatch, interpolate_band_limited, resample,
};
use meshtone::simulate;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::signal::noise;

/// Draws of one recording.
pub struct Draws(ChaCha8Rng);

impl Draws {
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    pub fn part(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * 2f64.powi(-53)
    }

    pub fn between(&mut self, least: f64, largest: f64) -> f64 {
        least + (largest - least) * self.part()
    }

    /// As many in every octave.
    pub fn in_octaves(&mut self, least: f64, largest: f64) -> f64 {
        least * (largest.max(least) / least).powf(self.part())
    }

    pub fn count(&mut self, least: u32, largest: u32) -> u32 {
        least + (self.part() * f64::from(largest + 1 - least)) as u32
    }

    pub fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.part() * of.len() as f64) as usize]
    }

    pub fn chance(&mut self, part: f64) -> bool {
        self.part() < part
    }
}

/// A pair that was simulated.
pub struct Machine {
    pub signal: Vec<f64>,
    pub rate_hz: f64,
    pub samples_per_pinion_revolution: f64,
    pub teeth: [u32; 2],
}

/// Any pair, sound or damaged, at any speed and load, in both models.
fn machine(seed: u64) -> Machine {
    let draws = &mut Draws::new(seed);
    loop {
        let mut teeth = [draws.count(12, 90), draws.count(12, 90)];
        if draws.chance(0.2) {
            let factor = draws.count(2, 8);
            teeth = teeth.map(|teeth| (teeth / factor).max(3) * factor).map(|teeth| teeth.max(12));
        }
        if let Some(machine) = machine_of(seed, teeth, 3.0, draws) {
            return machine;
        }
    }
}

/// A pair of these teeth, at this brake torque or more; none where what is drawn cannot be simulated.
pub fn machine_of(seed: u64, teeth: [u32; 2], least_torque_nm: f64, draws: &mut Draws) -> Option<Machine> {
    let module_mm = draws.one(&[2.0, 3.0, 4.0]);
    let kind =
        draws.one(&["", "", "tooth-breakage", "root-crack", "wear", "missing-tooth", "partial-face", "pits"]);
    let severity = match kind {
        "missing-tooth" => String::new(),
        _ => format!("severity = {}\n", draws.between(0.1, 0.9)),
    };
    let wheel = draws.one(&["pinion", "gear"]);
    let fault = match kind {
        "" => String::new(),
        "wear" => format!("[fault]\nkind = \"wear\"\nwheel = \"{wheel}\"\ntooth = \"all\"\n{severity}"),
        _ => format!("[fault]\nkind = \"{kind}\"\nwheel = \"{wheel}\"\n{severity}"),
    };
    let model = draws.one(&["contact", "contact", "linear"]);
    let text = format!(
        "model = \"{model}\"\nseed = {seed}\n[gears]\nmodule_mm = {module_mm}\npinion_teeth = {}\ngear_teeth = {}\n\
         face_width_mm = {}\n[operation]\npinion_speed_hz = {}\nbrake_torque_nm = {}\n[quality]\ndin_grade = {}\n{fault}",
        teeth[0],
        teeth[1],
        8.0 * module_mm,
        draws.in_octaves(5.0, 50.0),
        draws.in_octaves(least_torque_nm, 200.0),
        draws.one(&[0, 5, 6, 7, 7, 8, 9]),
    );
    let mut scenario = Scenario::from_toml(&text).ok()?;
    crate::physics::with_own_structure(&mut scenario);
    let simulation = simulate(&scenario).ok()?;
    let channels = simulation.channels;
    let rate_hz = channels.sampling_rate_hz;
    Some(Machine {
        signal: channels["vertical_g"].to_vec(),
        rate_hz,
        samples_per_pinion_revolution: (rate_hz / scenario.operation.pinion_speed_hz).round(),
        teeth,
    })
}

/// What a rig's recorder has kept.
struct Recording {
    signal: Vec<f64>,
    rate_hz: f64,
    /// (rev) How far the shaft of the averaged wheel has turned at each sample.
    revolutions: Vec<f64>,
    teeth: u32,
    mate_teeth: u32,
}

/// A stretch of at least five revolutions of the slower wheel, at any rate, with noise down to 0 dB, hum and bearing tones; with a
/// speed that varies by up to ±1 % where that is asked for.
fn recording(machine: &Machine, varies: bool, draws: &mut Draws) -> Recording {
    let [pinion, gear] = machine.teeth.map(f64::from);
    let per_revolution = machine.samples_per_pinion_revolution;
    let slower = per_revolution * (gear / pinion).max(1.0);
    let whole = machine.signal.len() as f64;
    let samples = (slower * draws.in_octaves(5.0, whole / slower)).min(whole) as usize;
    let first = (draws.part() * (machine.signal.len() - samples) as f64) as usize;
    let mut signal = machine.signal[first..first + samples].to_vec();
    let mut turned: Vec<f64> = (first..first + samples).map(|i| i as f64 / per_revolution).collect();
    if varies {
        let (depth, cycles, start) = (draws.between(0.002, 0.01), draws.between(0.3, 2.0), draws.part());
        let end = (samples - 1) as f64;
        let phase_deviation = |x: f64| depth / (TAU * cycles) * (TAU * (cycles * x + start)).sin();
        let warped = |x: f64| {
            (x + phase_deviation(x) - phase_deviation(0.0))
                / (1.0 + phase_deviation(1.0) - phase_deviation(0.0))
        };
        let places: Vec<f64> = (0..samples).map(|i| end * warped(i as f64 / end)).collect();
        signal = interpolate_band_limited(&signal, &places, Edge::Reflect).unwrap();
        turned = places.iter().map(|place| (first as f64 + place) / per_revolution).collect();
    }
    let mesh_hz = pinion * machine.rate_hz / per_revolution;
    let rate_hz = draws.in_octaves((2.6 * mesh_hz).max(4e3), 51_200.0);
    let every = ((machine.rate_hz / rate_hz) as usize).max(1);
    let mut signal = resample(&signal, 1, every, Edge::Reflect).unwrap();
    let turned: Vec<f64> = turned.into_iter().step_by(every).collect();
    let rate_hz = machine.rate_hz / every as f64;
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let rms = (signal.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / signal.len() as f64).sqrt();
    let noise_db = draws.one(&[f64::NEG_INFINITY, -20.0, -10.0, -5.0, 0.0]);
    let noise = noise(draws.0.next_u64(), signal.len());
    let amplitude = rms * 10f64.powf(noise_db / 20.0);
    signal.iter_mut().zip(noise).for_each(|(x, noise)| *x += amplitude * noise);
    let hum = draws.chance(0.3).then_some(50.0);
    let bearing = draws.chance(0.3).then(|| draws.between(2.3, 9.7) * mesh_hz / pinion);
    for tone_hz in hum.into_iter().chain(bearing) {
        for harmonic in 1..=4 {
            let (amplitude, start) = (rms * draws.between(0.0, 0.3), draws.part());
            let cycles = f64::from(harmonic) * tone_hz / rate_hz;
            let add = |(i, x): (usize, &mut f64)| *x += amplitude * (TAU * (cycles * i as f64 + start)).cos();
            signal.iter_mut().enumerate().for_each(add);
        }
    }
    let (wheel, mate) = if draws.chance(0.5) { (0, 1) } else { (1, 0) };
    let ratio = pinion / f64::from(machine.teeth[wheel]);
    Recording {
        signal,
        rate_hz,
        revolutions: turned.iter().map(|angle| ratio * angle).collect(),
        teeth: machine.teeth[wheel],
        mate_teeth: machine.teeth[mate],
    }
}

/// What is said wrongly.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mistake {
    None,
    NoneAtConstantSpeed,
    Teeth,
    MateTeeth,
    OtherShaft,
    Pulses,
    Speed,
    ConstantSpeed,
}

/// A recording of which something is said.
struct Case {
    recording: Recording,
    phase: ShaftPhase,
    stated: StatedFacts,
    right: Option<Alternative>,
    /// Revolutions of the slower wheel.
    revolutions: f64,
}

/// Times at which a shaft that has turned so far gives pulses.
pub fn pulses(turned: &[f64], per_revolution: u32, rate_hz: f64) -> Vec<f64> {
    let pulses = f64::from(per_revolution);
    let mut next = (turned[0] * pulses).ceil();
    let mut times = Vec::new();
    for (i, pair) in turned.windows(2).enumerate() {
        while next <= pair[1] * pulses {
            times.push((i as f64 + (next / pulses - pair[0]) / (pair[1] - pair[0])) / rate_hz);
            next += 1.0;
        }
    }
    times
}

impl Case {
    /// None where the chain itself refuses the recording.
    fn new(machine: &Machine, mistake: Mistake, draws: &mut Draws) -> Option<Self> {
        let constant =
            matches!(mistake, Mistake::NoneAtConstantSpeed | Mistake::Speed | Mistake::ConstantSpeed);
        let varies = mistake == Mistake::ConstantSpeed || !constant && draws.chance(0.5);
        let recording = recording(machine, varies, draws);
        let Recording { teeth, mate_teeth, rate_hz, .. } = recording;
        let (samples, turned) = (recording.signal.len(), &recording.revolutions);
        let needs_mate = matches!(mistake, Mistake::MateTeeth | Mistake::OtherShaft);
        let stated_mate = (needs_mate || draws.chance(0.7)).then_some(mate_teeth);
        let (right_pulses, stated_pulses) = match mistake {
            Mistake::Pulses => draws.one(&[
                (2, 1),
                (1, 2),
                (3, 1),
                (3, 4),
                (4, 3),
                (4, 2),
                (2, 4),
                (59, 60),
                (61, 60),
                (60, 1),
                (24, 25),
                (20, 19),
            ]),
            _ => draws.one(&[(1, 1), (1, 1), (2, 2), (60, 60)]),
        };
        let mut stated = StatedFacts {
            teeth,
            mate_teeth: stated_mate,
            turning: StatedTurning::Pulses { per_revolution: stated_pulses },
        };
        let on_shaft: Vec<f64> = match mistake {
            Mistake::OtherShaft => {
                let ratio = f64::from(teeth) / f64::from(mate_teeth);
                turned.iter().map(|angle| ratio * angle).collect()
            }
            _ => turned.clone(),
        };
        let mut speed_hz = (turned[samples - 1] - turned[0]) * rate_hz / (samples - 1) as f64;
        let by = draws.one(&[-3, -2, -1, 1, 2, 3]);
        let right = match mistake {
            Mistake::None | Mistake::NoneAtConstantSpeed => None,
            Mistake::Teeth => {
                stated.teeth = teeth.checked_add_signed(by)?;
                Some(Alternative::Teeth { teeth })
            }
            Mistake::MateTeeth => {
                let stated_teeth = mate_teeth.checked_add_signed(by)?;
                stated.mate_teeth = Some(stated_teeth);
                Some(Alternative::MateTeeth { teeth: mate_teeth, stated: stated_teeth })
            }
            Mistake::OtherShaft if teeth == mate_teeth => return None,
            Mistake::OtherShaft => Some(Alternative::OtherShaft { mate_teeth }),
            Mistake::Pulses => {
                Some(Alternative::PulsesPerRevolution { pulses: right_pulses, stated: stated_pulses })
            }
            Mistake::Speed => {
                let off = draws.in_octaves(1e-4, 0.03) * draws.one(&[-1.0, 1.0]);
                let right_hz = speed_hz;
                speed_hz *= 1.0 + off;
                Some(Alternative::ShaftSpeed { speed_hz: right_hz, stated_hz: speed_hz })
            }
            Mistake::ConstantSpeed => Some(Alternative::VaryingSpeed { variation: 0.0, stated_hz: speed_hz }),
        };
        let phase = if constant {
            stated.turning = StatedTurning::ConstantSpeed { speed_hz };
            ShaftPhase::constant(speed_hz, rate_hz, samples).ok()?
        } else {
            let times = pulses(&on_shaft, right_pulses, rate_hz);
            ShaftPhase::from_pulses(&times, stated_pulses, None, rate_hz, samples).ok()?
        };
        let slower = f64::from(teeth) / f64::from(teeth.max(mate_teeth));
        let revolutions = slower * (turned[samples - 1] - turned[0]);
        Some(Self { phase, stated, right, revolutions, recording })
    }

    fn find_mismatch(&self) -> Option<Option<Mismatch>> {
        let angular =
            angular_resample(&self.recording.signal, &self.phase, &AngularSettings::default()).ok()?;
        let shown = f64::from(self.stated.teeth) < 0.8 * angular.nyquist_order && angular.revolutions() > 1;
        shown.then(|| find_mismatch(&angular, &self.stated))
    }

    /// Turns of the mesh tone, over the whole recording, between a speed and the right one.
    fn mesh_turns(&self, speed_hz: f64) -> f64 {
        let seconds = self.recording.signal.len() as f64 / self.recording.rate_hz;
        match self.right {
            Some(Alternative::ShaftSpeed { speed_hz: right, .. }) => {
                (speed_hz - right).abs() * f64::from(self.recording.teeth) * seconds
            }
            _ => 0.0,
        }
    }

    /// Whether cause and value are right.
    fn is_right(&self, alternative: Alternative) -> (bool, bool) {
        match (alternative, self.right) {
            (Alternative::ShaftSpeed { speed_hz, .. }, Some(Alternative::ShaftSpeed { .. })) => {
                (true, self.mesh_turns(speed_hz) < 0.25)
            }
            // How much it varies is not known better.
            (Alternative::VaryingSpeed { .. }, Some(Alternative::VaryingSpeed { .. })) => (true, true),
            (alternative, Some(right)) => {
                (std::mem::discriminant(&alternative) == std::mem::discriminant(&right), alternative == right)
            }
            (_, None) => (false, false),
        }
    }
}

/// How often a warning came.
#[derive(Debug, Default, Clone, Copy)]
struct Tally {
    recordings: usize,
    warned: usize,
    right_cause: usize,
    right_value: usize,
}

impl std::iter::Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |a, b| Self {
            recordings: a.recordings + b.recordings,
            warned: a.warned + b.warned,
            right_cause: a.right_cause + b.right_cause,
            right_value: a.right_value + b.right_value,
        })
    }
}

fn tally(case: &Case) -> Option<Tally> {
    let found = case.find_mismatch()?;
    let (right_cause, right_value) =
        found.as_ref().map_or((false, false), |mismatch| case.is_right(mismatch.alternative));
    if std::env::var_os("MISMATCH_SHOW").is_some() && found.is_some() && !right_value {
        println!("{:?} right {:?} revs {:.1} {:?}", case.stated, case.right, case.revolutions, found);
    }
    Some(Tally {
        recordings: 1,
        warned: found.is_some().into(),
        right_cause: right_cause.into(),
        right_value: right_value.into(),
    })
}

fn row(name: &str, tally: Tally) {
    let Tally { recordings, warned, right_cause, right_value } = tally;
    println!("| {name} | {recordings} | {warned} | {right_cause} | {right_value} |");
}

/// Prints the table of the book: `cargo test --release -p meshtone-tests --test core -- --ignored recordings_with_every_mistake --nocapture`.
#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn recordings_with_every_mistake() {
    let machines: Vec<Machine> = (0..300u64).into_par_iter().map(machine).collect();
    println!("| what is stated | recordings | warned | right cause | right value |");
    let draw = |mistake: Mistake, count: u64| -> Vec<(Case, Tally)> {
        (0..count)
            .into_par_iter()
            .filter_map(|index| {
                let mut draws = Draws::new(1_000_000 * (mistake as u64 + 1) + index);
                let case = Case::new(&machines[(index % 300) as usize], mistake, &mut draws)?;
                let tally = tally(&case)?;
                Some((case, tally))
            })
            .collect()
    };
    for (mistake, name, count) in [
        (Mistake::None, "right, pulses", 900),
        (Mistake::NoneAtConstantSpeed, "right, constant speed", 300),
        (Mistake::Teeth, "teeth of the wheel off by 1 to 3", 300),
        (Mistake::MateTeeth, "teeth of the mate off by 1 to 3", 300),
        (Mistake::OtherShaft, "pulses of the other shaft", 300),
        (Mistake::Pulses, "another number of pulses", 300),
        (Mistake::Speed, "speed off by 0.01 to 3 %", 400),
        (Mistake::ConstantSpeed, "constant, but it varies by 0.2 to 1 %", 300),
    ] {
        let cases = draw(mistake, count);
        let of =
            |keep: &dyn Fn(&Case) -> bool| cases.iter().filter(|(case, _)| keep(case)).map(|(_, t)| *t).sum();
        row(name, of(&|_| true));
        match mistake {
            Mistake::None | Mistake::NoneAtConstantSpeed | Mistake::ConstantSpeed => {}
            Mistake::Speed => {
                let turns = |case: &Case| match case.stated.turning {
                    StatedTurning::ConstantSpeed { speed_hz } => case.mesh_turns(speed_hz),
                    _ => 0.0,
                };
                row("… by less than 0.3 mesh cycles in all", of(&|case| turns(case) < 0.3));
                row("… by more", of(&|case| turns(case) >= 0.3));
            }
            _ => {
                row("… 5 to 10 revolutions", of(&|case| case.revolutions < 10.0));
                row("… 10 to 30", of(&|case| (10.0..30.0).contains(&case.revolutions)));
                row("… more", of(&|case| case.revolutions >= 30.0));
            }
        }
    }
}

/// Five mesh harmonics with the sidebands and orders of both shafts, at half as much noise as signal.
fn meshing(teeth: [u32; 2], revolutions: &[f64]) -> Vec<f64> {
    meshing_with(5, teeth, revolutions)
}

/// As [`meshing`], of so many harmonics.
fn meshing_with(harmonics: u32, teeth: [u32; 2], revolutions: &[f64]) -> Vec<f64> {
    let [own, mate] = teeth.map(f64::from);
    let tone = |order: f64, turned: f64| (TAU * (order * turned).fract()).cos();
    let all = revolutions.iter().zip(noise(3, revolutions.len()));
    all.map(|(&turned, noise)| {
        let other = turned * own / mate;
        let modulation = 1.0
            + 0.2 * tone(1.0, turned)
            + 0.1 * tone(2.0, turned)
            + 0.2 * tone(1.0, other)
            + 0.1 * tone(3.0, other);
        let mesh: f64 = (1..=harmonics).map(|h| tone(f64::from(h) * own, turned) / f64::from(h)).sum();
        let orders: f64 =
            (1..=60).map(|k| 0.1 * (tone(f64::from(k), turned) + tone(f64::from(k), other))).sum();
        modulation * mesh + orders + 0.7 * noise
    })
    .collect()
}

const RATE_HZ: f64 = 10_240.0;
const TEETH: [u32; 2] = [23, 38];

/// What does not fit a shaft of 20 Hz whose speed varies by 1 %, where `stated_per_right` is how quickly it is stated to turn.
fn mismatch_of(stated_per_right: f64, stated: StatedFacts) -> Option<Mismatch> {
    let seconds = |i: usize| i as f64 / RATE_HZ;
    let turned: Vec<f64> =
        (0..81_920).map(|i| 20.0 * seconds(i) + 0.1 * (TAU * 0.3 * seconds(i)).sin()).collect();
    let phase = ShaftPhase::new(0, turned.iter().map(|angle| stated_per_right * angle).collect()).unwrap();
    let angular = angular_resample(&meshing(TEETH, &turned), &phase, &AngularSettings::default()).unwrap();
    find_mismatch(&angular, &stated)
}

#[test]
fn each_mistake_is_named_with_the_better_value() {
    let pulses = |per_revolution| StatedTurning::Pulses { per_revolution };
    let stated = |teeth, mate_teeth, turning| StatedFacts { teeth, mate_teeth: Some(mate_teeth), turning };
    let [own, mate] = TEETH;
    for (stated_per_right, stated, alternative) in [
        (1.0, stated(own, mate, pulses(1)), None),
        (1.0, stated(own, mate, StatedTurning::Other), None),
        (1.0, stated(own + 1, mate, pulses(1)), Some(Alternative::Teeth { teeth: own })),
        (
            1.0,
            stated(own, mate - 1, pulses(1)),
            Some(Alternative::MateTeeth { teeth: mate, stated: mate - 1 }),
        ),
        (23.0 / 38.0, stated(own, mate, pulses(1)), Some(Alternative::OtherShaft { mate_teeth: mate })),
        (2.0, stated(own, mate, pulses(1)), Some(Alternative::PulsesPerRevolution { pulses: 2, stated: 1 })),
        (0.75, stated(own, mate, pulses(4)), Some(Alternative::PulsesPerRevolution { pulses: 3, stated: 4 })),
        (
            59.0 / 60.0,
            stated(own, mate, pulses(60)),
            Some(Alternative::PulsesPerRevolution { pulses: 59, stated: 60 }),
        ),
    ] {
        let found = mismatch_of(stated_per_right, stated);
        assert_eq!(found.as_ref().map(|mismatch| mismatch.alternative), alternative, "{stated:?}: {found:?}");
    }
}

// With twice as many pulses the mesh is at half the stated order and its multiples: 16, 48, 80 are orders of the hunting tooth of 32 and 80
// teeth, 11.5, 34.5, 57.5 none of 23 and 39.
#[test]
fn the_orders_of_the_pair_do_not_speak_for_other_pulses() {
    let found = |teeth: u32, mate_teeth: u32| {
        let turned = (0..81_920).map(|i| 20.0 * f64::from(i) / RATE_HZ);
        let tone = |order: f64, turned: f64| (TAU * (order * turned).fract()).cos();
        let tones = |at: f64| -> f64 { (1..=10).map(|k| tone(f64::from(k * teeth) / 2.0, at)).sum() };
        let signal: Vec<f64> = turned.zip(noise(3, 81_920)).map(|(at, noise)| tones(at) + noise).collect();
        let phase = ShaftPhase::constant(20.0, RATE_HZ, signal.len()).unwrap();
        let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
        let turning = StatedTurning::Pulses { per_revolution: 1 };
        let stated = StatedFacts { teeth, mate_teeth: Some(mate_teeth), turning };
        find_mismatch(&angular, &stated).map(|mismatch| mismatch.alternative)
    };
    assert_eq!(found(32, 80), None);
    assert_eq!(found(23, 39), Some(Alternative::PulsesPerRevolution { pulses: 2, stated: 1 }));
}

#[test]
fn a_speed_that_is_off_is_found_to_parts_per_million() {
    let turned: Vec<f64> = (0..204_800).map(|i| 20.0 * i as f64 / RATE_HZ).collect();
    let signal = meshing(TEETH, &turned);
    for off in [0.0, 8e-5, -1.2e-4, 8e-4, -7e-3, 0.024] {
        let speed_hz = 20.0 * (1.0 + off);
        let phase = ShaftPhase::constant(speed_hz, RATE_HZ, signal.len()).unwrap();
        let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
        let turning = StatedTurning::ConstantSpeed { speed_hz };
        let found =
            find_mismatch(&angular, &StatedFacts { teeth: TEETH[0], mate_teeth: Some(TEETH[1]), turning });
        match found.as_ref().map(|mismatch| mismatch.alternative) {
            None => assert_eq!(off, 0.0),
            Some(Alternative::ShaftSpeed { speed_hz, .. }) => {
                println!("{off:+.1e}: {:+.1e}, {}", speed_hz / 20.0 - 1.0, found.unwrap());
                assert!(off != 0.0 && (speed_hz / 20.0 - 1.0).abs() < 3e-6, "{off}: {speed_hz}");
            }
            other => assert_eq!(other, None, "{off}"),
        }
    }
}

/// Two mesh harmonics with a little modulation in noise, as on many rigs.
fn two_harmonics(teeth: u32, revolutions: &[f64]) -> Vec<f64> {
    let tone = |order: f64, turned: f64| (TAU * (order * turned).fract()).cos();
    let mesh = |turned: f64| tone(f64::from(teeth), turned) + 0.6 * tone(2.0 * f64::from(teeth), turned);
    let all = revolutions.iter().zip(noise(11, revolutions.len()));
    all.map(|(&turned, noise)| (1.0 + 0.1 * tone(1.0, turned)) * mesh(turned) + 0.5 * noise).collect()
}

fn mismatch_at(speed_hz: f64, signal: &[f64], teeth: u32, turning: StatedTurning) -> Option<Mismatch> {
    let phase = ShaftPhase::constant(speed_hz, RATE_HZ, signal.len()).unwrap();
    let angular = angular_resample(signal, &phase, &AngularSettings::default()).unwrap();
    find_mismatch(&angular, &StatedFacts { teeth, mate_teeth: None, turning })
}

#[test]
fn two_harmonics_are_enough() {
    let turned: Vec<f64> = (0..81_920).map(|i| 20.0 * i as f64 / RATE_HZ).collect();
    let signal = two_harmonics(23, &turned);
    let constant = |speed_hz: f64| StatedTurning::ConstantSpeed { speed_hz };
    let pulses = StatedTurning::Pulses { per_revolution: 1 };
    for turning in [constant(20.0), pulses] {
        assert_eq!(mismatch_at(20.0, &signal, 23, turning), None);
    }
    for teeth in [22, 24, 26] {
        let found = mismatch_at(20.0, &signal, teeth, pulses).map(|mismatch| mismatch.alternative);
        assert_eq!(found, Some(Alternative::Teeth { teeth: 23 }), "{teeth}");
    }
    for off in [-0.02, 0.004, 0.03] {
        let speed_hz = 20.0 * (1.0 + off);
        let found = mismatch_at(speed_hz, &signal, 23, constant(speed_hz));
        let Some(Alternative::ShaftSpeed { speed_hz, .. }) =
            found.as_ref().map(|mismatch| mismatch.alternative)
        else {
            panic!("{off}: {found:?}")
        };
        assert!((speed_hz / 20.0 - 1.0).abs() < 1e-5, "{off}: {speed_hz}");
    }
}

#[test]
fn a_shaft_that_wobbles_does_not_turn_at_a_constant_speed() {
    for (depth, cycles_hz) in [(0.003, 0.5), (0.01, 1.1), (0.012, 0.5)] {
        let turned: Vec<f64> = (0..40_960)
            .map(|i| i as f64 / RATE_HZ)
            .map(|time| 20.0 * (time + depth / (TAU * cycles_hz) * (TAU * cycles_hz * time).sin()))
            .collect();
        for signal in [two_harmonics(23, &turned), meshing(TEETH, &turned)] {
            let found = mismatch_at(20.0, &signal, 23, StatedTurning::ConstantSpeed { speed_hz: 20.0 });
            let Some(Alternative::VaryingSpeed { variation, .. }) =
                found.as_ref().map(|mismatch| mismatch.alternative)
            else {
                panic!("{depth} {cycles_hz}: {found:?}")
            };
            let rms = depth / 2f64.sqrt();
            assert!((variation / rms - 1.0).abs() < 0.15, "{depth} {cycles_hz}: {}", found.unwrap());
        }
    }
}

#[test]
fn impossible_tooth_counts_are_not_compared() {
    let turned: Vec<f64> = (0..40_960).map(|i| 20.0 * f64::from(i) / RATE_HZ).collect();
    let phase = ShaftPhase::constant(20.0, RATE_HZ, turned.len()).unwrap();
    let signal = meshing(TEETH, &turned);
    let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
    let turning = StatedTurning::ConstantSpeed { speed_hz: 20.0 };
    for (teeth, mate_teeth) in [(TEETH[0], Some(1_000_000_000)), (u32::MAX, None)] {
        assert_eq!(find_mismatch(&angular, &StatedFacts { teeth, mate_teeth, turning }), None);
    }
}

// Eight times as many revolutions as are transformed at once, over which the mesh tone gains four cycles.
#[test]
fn a_speed_that_is_hardly_off_is_found_in_a_long_recording() {
    let (points_per_revolution, revolutions, off) = (128, 16_384, 1e-5);
    let mesh = |i: usize| -> f64 {
        let mesh_turned = 23.0 * (1.0 + off) * i as f64 / points_per_revolution as f64;
        [1.0, 2.0].into_iter().map(|harmonic| (TAU * (harmonic * mesh_turned).fract()).cos()).sum()
    };
    let values = (0..revolutions * points_per_revolution).map(mesh).collect();
    let angular = AngularSignal { points_per_revolution, start_rev: 0.0, nyquist_order: 64.0, values };
    let turning = StatedTurning::ConstantSpeed { speed_hz: 20.0 };
    let found = find_mismatch(&angular, &StatedFacts { teeth: 23, mate_teeth: None, turning }).unwrap();
    let Alternative::ShaftSpeed { speed_hz, stated_hz } = found.alternative else { panic!("{found}") };
    assert_eq!(stated_hz, 20.0);
    assert!((speed_hz / stated_hz - 1.0 - off).abs() < 1e-7, "{found}");
}

// Nothing but noise; too short for the mate's orders.
#[test]
fn nothing_is_said_where_nothing_can_be_concluded() {
    let turned: Vec<f64> = (0..40_960).map(|i| 20.0 * i as f64 / RATE_HZ).collect();
    for (signal, teeth, mate_teeth) in
        [(noise(5, turned.len()), 24, 38), (meshing(TEETH, &turned[..2500]), TEETH[0], 39)]
    {
        let phase = ShaftPhase::constant(20.0, RATE_HZ, signal.len()).unwrap();
        let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
        for turning in
            [StatedTurning::ConstantSpeed { speed_hz: 20.0 }, StatedTurning::Pulses { per_revolution: 1 }]
        {
            assert_eq!(
                find_mismatch(&angular, &StatedFacts { teeth, mate_teeth: Some(mate_teeth), turning }),
                None
            );
        }
    }
}

#[test]
fn mistakes_about_simulated_recordings_are_found() {
    let machines: Vec<Machine> = (0..3).map(machine).collect();
    let mistakes =
        [Mistake::None, Mistake::NoneAtConstantSpeed, Mistake::Teeth, Mistake::Pulses, Mistake::Speed];
    let of = |mistake: Mistake| -> Tally {
        (0..6)
            .filter_map(|index| {
                let mut draws = Draws::new(77_000 + index + 100 * mistake as u64);
                tally(&Case::new(&machines[(index % 3) as usize], mistake, &mut draws)?)
            })
            .sum()
    };
    let tallies = mistakes.map(of);
    println!("{tallies:?}");
    assert_eq!((tallies[0].warned, tallies[1].warned), (0, 0));
    let Tally { warned, right_cause, .. } = tallies.into_iter().sum();
    assert!(right_cause >= 6 && right_cause == warned, "{tallies:?}");
}
