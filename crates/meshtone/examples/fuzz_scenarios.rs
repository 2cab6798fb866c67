//! Odd but legal gearboxes, drawn with a seed, each simulated and each result checked: whatever the gearbox, its signals are finite, its torques
//! balance or it says so, and no motion that has settled is called unsettled.
//!
//! ```sh
//! cargo xtask fuzz scenarios                          # 317 gearboxes
//! cargo xtask fuzz scenarios --count 1000 --seed 7    # others
//! cargo xtask fuzz scenarios --number 12              # that one alone, with its file
//! ```
#![allow(clippy::expect_used, clippy::panic, clippy::print_stdout, clippy::print_stderr, missing_docs)]

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

use meshtone::random::{Draws, Purpose};
use meshtone::scenario::{Scenario, WarningKind};
use meshtone::sensor::{Channels, SignalSource};
use meshtone::{Simulation, StepJudgement};

/// (g) A peak that no seat has.
const IMPOSSIBLE_G: f64 = 1e6;
/// (-) Part of an rms by which a result may differ from a better one without a word: of twice the settling, and of four times the rate.
const UNSETTLED: f64 = 0.01;
const COARSE: f64 = 0.05;
const FINE: f64 = 0.01;
/// (Hz) Frequency below which a mode is the rotation of the whole.
const LEAST_HZ: f64 = 0.1;
/// Periods of the slowest mode over which a mean force is judged.
const FEWEST_PERIODS: f64 = 4.0;
/// Samples of the finest repetition that is still made.
const MOST_SAMPLES: f64 = 2e6;

/// Numbers drawn one after the other.
struct Drawn(Draws);

impl Drawn {
    fn between(&mut self, least: f64, most: f64) -> f64 {
        self.0.uniform((least + most) / 2.0, (most - least) / 2.0)
    }

    /// Evenly over the orders of magnitude.
    fn over_orders(&mut self, least: f64, most: f64) -> f64 {
        self.between(least.ln(), most.ln()).exp()
    }

    fn is(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        let place = self.between(0.0, choices.len() as f64) as usize;
        choices[place.min(choices.len() - 1)]
    }
}

/// A gearbox as a file, and what is odd about it.
struct Odd {
    text: String,
    traits: Vec<&'static str>,
}

/// Two to four shafts: a chain of stages, a chain of idlers, or three mates around a wheel.
fn drawn_gearbox(seed: u64, number: u64, attempt: u64) -> Odd {
    let mut draw = Drawn(Draws::new(seed, Purpose::Candidate, number * 1000 + attempt));
    let mut traits = Vec::new();
    let shape = draw.one_of(&["stages", "stages", "idlers", "star"]);
    traits.push(shape);
    let shafts = match shape {
        "star" => 4,
        "idlers" => draw.one_of(&[3, 4]),
        _ => draw.one_of(&[2, 2, 3, 4]),
    };
    let teeth = |draw: &mut Drawn| {
        let [least, most] = draw.one_of(&[[8.0, 20.0], [17.0, 60.0], [17.0, 60.0], [60.0, 400.0]]);
        draw.over_orders(least, most).round() as u32
    };
    let is_helical = draw.is(0.45);
    let face_mm = draw.over_orders(1.0, 200.0);
    let is_equal = draw.is(0.15);
    if is_equal {
        traits.push("ratio 1:1");
    }
    // Of each mesh: both wheels, each with its shaft, and the module.
    let mut wheels: Vec<(usize, u32)> = Vec::new();
    let mut meshes: Vec<([usize; 2], f64, f64)> = Vec::new();
    for stage in 0..shafts - 1 {
        let shares = (shape == "idlers" || shape == "star") && stage > 0;
        let driving = match shape {
            "star" if stage > 0 => 0,
            "idlers" if stage > 0 => wheels.len() - 1,
            _ => {
                let own = teeth(&mut draw);
                wheels.push((stage, own));
                wheels.len() - 1
            }
        };
        let own = wheels[driving].1;
        wheels.push((stage + 1, if is_equal { own } else { teeth(&mut draw) }));
        let (module_mm, helix_deg) = match meshes.last() {
            Some(&(_, module_mm, helix_deg)) if shares => (module_mm, helix_deg),
            _ => {
                let helix_deg =
                    if is_helical { draw.one_of(&[0.01, 0.1, 5.0, 15.0, 25.0, 35.0, 45.0]) } else { 0.0 };
                (draw.over_orders(0.5, 6.0), helix_deg)
            }
        };
        meshes.push(([driving, wheels.len() - 1], module_mm, helix_deg));
    }
    if is_helical {
        traits.push("helical");
    }
    let length_mm = (6.0 * face_mm).max(draw.between(150.0, 500.0));
    let pitch_radius_mm = |wheel: usize| {
        let of = meshes.iter().find(|(wheels, ..)| wheels.contains(&wheel));
        of.map_or(0.0, |(_, module_mm, helix_deg)| {
            module_mm * f64::from(wheels[wheel].1) / 2.0 / helix_deg.to_radians().cos()
        })
    };
    let smallest_mm = |shaft: usize| {
        let own = (0..wheels.len()).filter(|&wheel| wheels[wheel].0 == shaft);
        own.map(|wheel| pitch_radius_mm(wheel) - 1.3 * meshes.iter().map(|mesh| mesh.1).fold(0.0, f64::max))
            .fold(f64::INFINITY, f64::min)
    };
    let mut text = format!("seed = {}\n", number + 1);
    for shaft in 0..shafts {
        let radius_mm = (smallest_mm(shaft) * draw.between(0.4, 0.9)).clamp(0.5, 40.0);
        let coupled = if shaft == 0 {
            "couples_to = \"motor\"\n"
        } else if shaft == shafts - 1 {
            "couples_to = \"brake\"\n"
        } else {
            ""
        };
        text += &format!(
            "[[shaft]]\nname = \"s{shaft}\"\nlength_mm = {length_mm:?}\nradius_mm = {radius_mm:?}\n{coupled}"
        );
        if shape == "star" {
            let distance_mm = if shaft == 0 { 0.0 } else { pitch_radius_mm(0) + pitch_radius_mm(shaft) };
            let (sin, cos) = (TAU * shaft as f64 / 3.0).sin_cos();
            text += &format!("position_mm = [{:.9}, {:.9}]\n", distance_mm * cos, distance_mm * sin);
        }
        if draw.is(0.08) {
            traits.push("stiff coupling");
            if !coupled.is_empty() {
                text += &format!("coupling_stiffness_nm_per_rad = {:e}\n", draw.over_orders(1e6, 9e14));
            }
        }
    }
    let class = draw.one_of(&[0, 4, 6, 8, 10]);
    for (wheel, (shaft, teeth)) in wheels.iter().enumerate() {
        // Of two wheels on a shaft one sits at each end.
        let at = if shape == "stages" { if wheel % 4 < 2 { 0.3 } else { 0.7 } } else { 0.5 };
        text += &format!(
            "[[wheel]]\nname = \"z{wheel}\"\nshaft = \"s{shaft}\"\nat = {at}\nteeth = {teeth}\nface_width_mm = {face_mm:?}\n"
        );
        if class > 0 {
            text += &format!("iso_class = {class}\n");
        }
    }
    for (n, ([a, b], module_mm, helix_deg)) in meshes.iter().enumerate() {
        text += &format!(
            "[[mesh]]\nwheels = [\"z{a}\", \"z{b}\"]\nmodule_mm = {module_mm:?}\npressure_angle_deg = 20.0\n"
        );
        if *helix_deg > 0.0 {
            let hand = if n % 2 == 0 || shape != "stages" { "right" } else { "left" };
            // A wheel between two has one hand, and its mates the other.
            let hand = if shape == "idlers" && n % 2 == 1 { "left" } else { hand };
            text += &format!("helix_angle_deg = {helix_deg:?}\nhand = \"{hand}\"\n");
        }
    }
    let rolling = draw.one_of(&["linear", "linear", "ball", "many balls"]);
    if rolling != "linear" {
        traits.push("rolling bearings");
    }
    for shaft in 0..shafts {
        for at in ["0.0", "1.0"] {
            text += &format!("[[bearing]]\nshaft = \"s{shaft}\"\nat = {at}\n");
            match rolling {
                "ball" => text += "kind = \"ball\"\nname = \"6205\"\n",
                "many balls" => text += "kind = \"ball\"\nelements = 33\nelement_mm = 4.0\npitch_mm = 60.0\n",
                _ => {
                    if draw.is(0.05) {
                        traits.push("stiff bearing");
                        text += &format!("tilt_stiffness_nm_per_rad = {:e}\n", draw.over_orders(1e4, 9e14));
                    }
                }
            }
            if rolling != "linear" && shaft == 1 && at == "0.0" && draw.is(0.5) {
                traits.push("defects on both races");
                text +=
                    "defect = [{ race = \"outer\", width_mm = 0.7 }, { race = \"inner\", width_mm = 0.5 }]\n";
            }
        }
    }
    if draw.is(0.8) {
        text += "[housing]\nmass_kg = 30.0\n";
    }
    let speed_hz = draw.over_orders(3.0, 80.0);
    // Loads that such teeth are made for, or none.
    let force_n = meshes[meshes.len() - 1].1 * face_mm * draw.over_orders(0.3, 15.0);
    let last = wheels.len() - 1;
    let torque_nm = if draw.is(0.1) { 0.0 } else { force_n * pitch_radius_mm(last) * 1e-3 };
    if torque_nm == 0.0 {
        traits.push("no torque");
    }
    text += &format!("[operation]\ninput_speed_hz = {speed_hz:?}\nbrake_torque_nm = {torque_nm:?}\n");
    let duration_s = draw.between(0.15, 0.35);
    match draw.one_of(&["steady", "steady", "steady", "profile", "ripple"]) {
        "profile" => {
            traits.push("profile");
            text += &format!(
                "speed_profile_hz = {{ time_s = [0.0, {duration_s:?}], value = [{speed_hz:?}, {:?}] }}\n",
                speed_hz * draw.between(0.6, 1.6)
            );
        }
        "ripple" => {
            traits.push("ripple");
            text += "torque_ripple = [{ order = 2.0, amplitude = 0.3 }]\n";
        }
        _ => {}
    }
    let rate_hz = draw.one_of(&[20e3, 25e3, 50e3, 100e3]);
    text += &format!("[solver]\nsampling_rate_hz = {rate_hz:?}\nduration_s = {duration_s:?}\n");
    Odd { text, traits }
}

/// Draws what is asked for, with a mesh frequency on a natural one where the gearbox is to resound.
fn legal(seed: u64, number: u64) -> (Scenario, Odd) {
    for attempt in 0.. {
        let mut odd = drawn_gearbox(seed, number, attempt);
        let Ok(mut gearbox) = Scenario::from_toml(&odd.text) else { continue };
        if number % 9 == 4 && gearbox.operation.is_steady() {
            let Ok(stages) = meshtone::stages(&gearbox) else { continue };
            let per_turn = f64::from(gearbox.wheels[0].teeth);
            let own =
                stages.natural_frequencies_hz().into_iter().find(|hz| *hz > 100.0 && *hz / per_turn > 3.0);
            if let Some(hz) = own.filter(|hz| hz / per_turn < 80.0) {
                gearbox.operation.pinion_speed_hz = hz / per_turn;
                odd.traits.push("resonance");
            }
        }
        odd.text = gearbox.to_toml();
        return (gearbox, odd);
    }
    unreachable!("attempts end only with a legal gearbox")
}

/// (-) The largest change of the rms about the mean of any sensor or mesh force from one result to a better one. What a force varies by counts from a
/// twentieth of the force on.
fn change(of: &Channels, better: &Channels) -> f64 {
    let rms = |values: &[f64]| {
        let count = values.len().max(1) as f64;
        let mean = values.iter().sum::<f64>() / count;
        let varying = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt();
        varying.max(0.05 * mean.abs())
    };
    let is_judged = |source| matches!(source, SignalSource::Sensor(_) | SignalSource::MeshForce(_));
    let both = of.signals.iter().zip(&better.signals).filter(|(signal, _)| is_judged(signal.source));
    let changes = both.map(|(a, b)| {
        let (a, b) = (rms(&a.values), rms(&b.values));
        if b < 1e-9 { 0.0 } else { (a / b - 1.0).abs() }
    });
    changes.fold(0.0, f64::max)
}

/// Returns what is wrong with a result, which is nothing most of the time.
fn faults_of(gearbox: &Scenario, simulation: &Simulation, kinds: &[WarningKind]) -> Vec<(&'static str, f64)> {
    let mut found = Vec::new();
    let channels = &simulation.channels;
    let values = || channels.signals.iter().flat_map(|signal| &signal.values);
    if values().any(|value| !value.is_finite()) {
        found.push(("a number that is not finite", 0.0));
    }
    let peak_g = (channels.signals.iter().filter(|signal| signal.unit == "g"))
        .flat_map(|signal| &signal.values)
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    if peak_g > IMPOSSIBLE_G {
        found.push(("a peak beyond 1e6 g", peak_g));
    }
    let is_said = |kind| kinds.contains(&kind);
    // What a mesh that idles carries counts against the loaded ones.
    let loaded_n = simulation.stages.pairs.iter().map(|pair| pair.static_force_n.abs()).fold(0.0, f64::max);
    // Over less than a few periods of what rings longest a mean says nothing.
    let kept_s = channels.len() as f64 / channels.sampling_rate_hz;
    let slowest_hz = simulation.stages.natural_frequencies_hz().into_iter().find(|hz| *hz > LEAST_HZ);
    let is_constant = gearbox.operation.is_steady() && gearbox.operation.torque_ripple.is_empty();
    if is_constant && slowest_hz.is_none_or(|hz| kept_s * hz >= FEWEST_PERIODS) {
        for (mesh, pair) in simulation.stages.pairs.iter().enumerate() {
            let force_n = channels.of(SignalSource::MeshForce(mesh));
            let weight = |n: usize| (n + 1).min(force_n.len() - n) as f64;
            let weights: f64 = (0..force_n.len()).map(weight).sum();
            let mean_n =
                force_n.iter().enumerate().map(|(n, force)| weight(n) * force).sum::<f64>() / weights;
            let rms_n =
                (force_n.iter().map(|force| force * force).sum::<f64>() / force_n.len() as f64).sqrt();
            let part = (mean_n - pair.static_force_n).abs()
                / rms_n.max(pair.static_force_n.abs()).max(0.01 * loaded_n).max(1e-9);
            if part > 0.05 && !is_said(WarningKind::TorqueImbalance) && !is_said(WarningKind::Unsettled) {
                found.push(("a broken balance without a word", part));
            }
        }
    }
    if gearbox.operation.is_steady() && is_said(WarningKind::Unsettled) {
        let mut longer = gearbox.clone();
        longer.solver.discard_and_keep(4.0 * kept_s, kept_s);
        longer.solver.settle_tolerance = 0.0;
        // Only where the teeth stand as before where the kept signal starts can the two be compared: in the mean over turns.
        if let Ok(settled) = meshtone::simulate(&longer) {
            let change = change(channels, &settled.channels);
            if change < UNSETTLED / 3.0 {
                found.push(("a false unsettled", change));
            }
        }
    }
    let finer_hz = 4.0 * gearbox.solver.sampling_rate_hz;
    // Random forces are drawn anew at another rate: of short signals in narrow resonances that changes more than a step.
    let mut still = gearbox.clone();
    still.meshes.iter_mut().for_each(|mesh| mesh.random_force = 0.0);
    if finer_hz * channels.len() as f64 / channels.sampling_rate_hz < MOST_SAMPLES
        && let Ok(coarse) = meshtone::simulate(&still)
    {
        let mut finer = still.clone();
        finer.solver.highest_mode_hz = Some(gearbox.solver.highest_mode_hz(channels.sampling_rate_hz));
        finer.solver.sampling_rate_hz = finer_hz;
        if let Ok(finer) = meshtone::simulate(&finer) {
            let change = change(&coarse.channels, &finer.channels);
            if change > COARSE && !is_said(WarningKind::StepError) && !is_said(WarningKind::Rattle) {
                // Teeth or elements that bounce are elsewhere at every step: what no step takes away is none of its errors.
                still.solver.highest_mode_hz =
                    Some(gearbox.solver.highest_mode_hz(coarse.channels.sampling_rate_hz));
                still.solver.sampling_rate_hz = 2.0 * finer_hz;
                let rest = meshtone::simulate(&still)
                    .map_or(0.0, |finest| self::change(&finer.channels, &finest.channels));
                let what = if rest > change / 2.0 {
                    "a motion that no step settles"
                } else {
                    "a step error above 5 % without a word"
                };
                found.push((what, change));
            }
            if change < FINE && is_said(WarningKind::StepError) {
                found.push(("a step error that is none", change));
            }
        }
    }
    found
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let of = |name: &str| -> Option<u64> {
        let place = arguments.iter().position(|argument| argument == name)?;
        arguments.get(place + 1)?.parse().ok()
    };
    let (count, seed, only) = (of("--count").unwrap_or(317), of("--seed").unwrap_or(58), of("--number"));
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut findings = 0;
    for number in only.map_or(0..count, |number| number..number + 1) {
        let (gearbox, odd) = legal(seed, number);
        if only.is_some() {
            println!("{}", odd.text);
        }
        let mut add = |what: String| *counts.entry(what).or_default() += 1;
        odd.traits
            .iter()
            .collect::<std::collections::BTreeSet<_>>()
            .iter()
            .for_each(|of| add(format!("gearboxes: {of}")));
        let result = catch_unwind(AssertUnwindSafe(|| {
            let simulation = meshtone::simulate(&gearbox)?;
            let warnings =
                [simulation.stages.warnings(), simulation.warnings_of_signals(StepJudgement::Repeated)]
                    .concat();
            let kinds: Vec<WarningKind> = warnings.iter().map(|warning| warning.kind).collect();
            if only.is_some() {
                warnings.iter().for_each(|warning| println!("{warning}"));
            }
            let found = faults_of(&gearbox, &simulation, &kinds);
            Ok::<_, meshtone::Error>((kinds, found))
        }));
        let found = match result {
            Err(_) => vec![("a panic", 0.0)],
            Ok(Err(error)) => {
                println!("{number}: refused: {error}");
                add("results: refused with an error".to_owned());
                Vec::new()
            }
            Ok(Ok((mut kinds, found))) => {
                kinds.sort();
                kinds.dedup();
                add("results: simulated".to_owned());
                kinds.iter().for_each(|kind| add(format!("warnings: {}", kind.code())));
                found
            }
        };
        for (what, size) in found {
            println!("{number}: {what}, {size:.3e} ({})", odd.traits.join(", "));
            add(format!("findings: {what}"));
            findings += 1;
        }
    }
    counts.iter().for_each(|(what, count)| println!("{count:6}  {what}"));
    println!("{findings} findings in {} gearboxes, seed {seed}", only.map_or(count, |_| 1));
    if findings == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
