//! What drives and disturbs the pair under `linear`: profiles of speed and torque, fluctuations, eccentricity.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::scenario::{GearPair, Model, Profile, Ripple, Scenario};
use meshtone::sensor::Channels;
use meshtone::simulate;

fn pair() -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: 20,
        gear_teeth: 40,
        pinion_speed_hz: 30.0,
        brake_torque_nm: 20.0,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.meshes[0].points_per_tooth = 2_000;
    scenario.solver.sampling_rate_hz = 1e5;
    scenario
}

fn channels(scenario: &Scenario) -> Channels {
    simulate(scenario).unwrap().channels
}

/// Amplitude of the component of `signal` at `hz`, over the whole signal (whole periods of it).
fn amplitude(signal: &[f64], rate_hz: f64, hz: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (i, value) in signal.iter().enumerate() {
        let (sin, cos) = (std::f64::consts::TAU * hz * i as f64 / rate_hz).sin_cos();
        re += value * cos;
        im += value * sin;
    }
    2.0 * re.hypot(im) / signal.len() as f64
}

// k e = k E (sin(α + θ_m/i) − sin(α + θ_m)): a component at either shaft's frequency, absent without eccentricity and
// proportional to it.
#[test]
fn eccentricity_turns_with_both_shafts() {
    let plain = channels(&pair());
    let with = |eccentricity_mm: f64| {
        let mut scenario = pair();
        scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = eccentricity_mm);
        channels(&scenario)
    };
    let (small, large) = (with(0.005), with(0.010));
    let rate = plain.sampling_rate_hz;
    for (shaft, hz) in [("pinion", 30.0), ("gear", 15.0)] {
        let [without, small, large] = [&plain, &small, &large].map(|c| amplitude(&c["vertical_g"], rate, hz));
        println!("{shaft}: {without:.2e} g without, {small:.3e} g, {large:.3e} g");
        assert!(without < 1e-3 * small, "{shaft}");
        // The stiffness varies with the angle and so with the motion, but that is of second order.
        assert_close("twice the eccentricity", 1e-3, [(large, 2.0 * small)]);
    }
    // Quasi-static: the wheels give way by e with the mesh in series to the shafts, so what the mesh carries at the
    // shafts' frequencies is far below k E.
    let force = amplitude(&large["mesh_force_n"], rate, 30.0);
    assert!(force > 0.0 && force < 1e8 * 0.01e-3, "{force} N");
}

// At 16 revolutions of ramp the shaft lags by the ramp's torsion only, which is constant: speeds follow exactly but
// for the mesh's own ripple, which the mean over a revolution takes out.
#[test]
fn shafts_follow_a_speed_profile() {
    let mut scenario = pair();
    scenario.solver.settle_fraction = 0.1;
    scenario.operation.speed_profile_hz =
        Some(Profile { time_s: vec![0.0, 0.5, 2.5], value: vec![20.0, 20.0, 40.0] });
    let channels = channels(&scenario);
    assert!((channels.time_s(channels.len() - 1) - 2.5).abs() < 1e-3, "the profile sets the duration");
    let speed_at = |time: f64| 20.0 + (time - 0.5).clamp(0.0, 2.0) * 10.0;
    let window = (channels.sampling_rate_hz / 30.0) as usize;
    let mut worst: f64 = 0.0;
    for start in (0..channels.len() - window).step_by(window) {
        // Away from the corner, where the train swings.
        let middle = channels.time_s(start) + 0.5 * window as f64 / channels.sampling_rate_hz;
        if (0.45..1.0).contains(&middle) {
            continue;
        }
        let range = start..start + window;
        let pinion = mean(&channels["pinion_shaft_speed_hz"][range.clone()]);
        let gear = mean(&channels["gear_shaft_speed_hz"][range]);
        worst = worst.max(deviation(pinion, speed_at(middle)).abs()).max(deviation(2.0 * gear, pinion).abs());
    }
    println!("speed profile: followed within {worst:.1e}");
    assert!(worst < 2e-3, "{worst}");
}

// Slow against the train's own swinging, the mesh carries the momentary torque: F = T/Rb_g.
#[test]
fn mesh_force_follows_a_torque_profile() {
    let mut scenario = pair();
    let duration = 80.0 / 30.0;
    let profile = Profile { time_s: vec![0.0, duration / 2.0, duration], value: vec![20.0, 20.0, 80.0] };
    scenario.operation.torque_profile_nm = Some(profile);
    let channels = channels(&scenario);
    let base_radius_m = 0.060 * 20f64.to_radians().cos();
    let window = (channels.sampling_rate_hz / 15.0).round() as usize;
    let mut worst: f64 = 0.0;
    for start in (0..channels.len() - window).step_by(window) {
        let middle = channels.time_s(start) + 0.5 * window as f64 / channels.sampling_rate_hz;
        // Behind the corner, where the train swings.
        if middle < duration / 2.0 + 0.27 {
            continue;
        }
        let torque = 20.0 + 60.0 * (middle - duration / 2.0) / (duration / 2.0);
        worst = worst.max(
            deviation(mean(&channels["mesh_force_n"][start..start + window]), torque / base_radius_m).abs(),
        );
    }
    println!("torque profile: followed within {worst:.1e}");
    assert!(worst < 1e-2, "{worst}");
}

// Uniform in ± a: variance a²/3. Of n draws the variance scatters by a relative √(0.8/n), the mean by √(1/3n) a; five
// of those are allowed. Speed and torque draw independently.
#[test]
fn fluctuations_have_their_distribution_and_their_seed() {
    let mut scenario = pair();
    scenario.operation.speed_fluctuation_hz = 0.3;
    scenario.operation.torque_fluctuation_nm = 2.0;
    let time = scenario.time_grid();
    let draw = |seed: u64| -> [Vec<f64>; 2] {
        let mut scenario = scenario.clone();
        scenario.seed = seed;
        let motion: Vec<_> = scenario.motion(&time).take(time.samples).collect();
        [
            motion.iter().map(|sample| (sample.speed_hz - 30.0) / 0.3).collect(),
            motion.iter().map(|sample| (sample.torque_nm - 20.0) / 2.0).collect(),
        ]
    };
    let [speed, torque] = draw(1);
    let n = speed.len() as f64;
    for (name, errors) in [("speed", &speed), ("torque", &torque)] {
        let variance = deviation_about_mean(errors).powi(2);
        println!("{name}: mean {:.1e}, variance {variance:.5} of 1/3, {n} draws", mean(errors));
        assert!(largest(errors.iter().copied()) <= 1.0);
        assert!(deviation(variance, 1.0 / 3.0).abs() < 5.0 * (0.8 / n).sqrt(), "{name}: {variance}");
        assert!(mean(errors).abs() < 5.0 / (3.0 * n).sqrt(), "{name}");
        let neighbours: f64 = errors.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n * 3.0;
        assert!(neighbours.abs() < 5.0 / n.sqrt(), "{name}: neighbours correlate by {neighbours}");
    }
    let correlation = speed.iter().zip(&torque).map(|(a, b)| a * b).sum::<f64>() / n * 3.0;
    assert!(correlation.abs() < 5.0 / n.sqrt(), "speed and torque correlate by {correlation}");
    assert_eq!(draw(1), [speed.clone(), torque.clone()], "the same seed, the same draws");
    let other = draw(2);
    let same = speed.iter().zip(&other[0]).filter(|(a, b)| a == b).count();
    assert!(same < 5, "another seed, other draws: {same} are equal");
}

// A fluctuating torque shakes the brake; the mean mesh force stays the load's.
#[test]
fn fluctuations_reach_the_signals() {
    let mut scenario = pair();
    let calm = channels(&scenario);
    scenario.operation.torque_fluctuation_nm = 5.0;
    let shaken = channels(&scenario);
    assert_ne!(calm["mesh_force_n"], shaken["mesh_force_n"]);
    assert_close("mean mesh force", 2e-3, [(mean(&shaken["mesh_force_n"]), mean(&calm["mesh_force_n"]))]);
}

// Far below the first torsional mode (100 Hz) the mesh carries what the brake holds: T (1 + Σ a cos(hθ + ψ)) / r_b.
#[test]
fn a_ripple_of_the_torque_comes_with_its_shaft() {
    for model in [Model::Linear, Model::Contact] {
        let mut scenario = pair();
        scenario.model = model;
        scenario.operation.pinion_speed_hz = 4.0;
        let ripple = |shaft: Option<&str>, order, amplitude| Ripple {
            shaft: shaft.map(str::to_owned),
            order,
            amplitude,
            phase_deg: 0.0,
        };
        scenario.operation.torque_ripple = vec![ripple(None, 1.0, 0.2), ripple(Some("pinion"), 3.0, 0.3)];
        // Two revolutions of the pinion, one of the gear.
        scenario.solver.discard_and_keep(0.5, 0.5);
        let channels = channels(&scenario);
        let force = &channels["mesh_force_n"];
        let mean = force.iter().sum::<f64>() / force.len() as f64;
        let part = |hz: f64| amplitude(force, channels.sampling_rate_hz, hz) / mean;
        println!("{model:?}: {} {} {}", part(2.0), part(12.0), part(4.0));
        // The mode makes 1/(1 − (12/100)²) of the faster one.
        assert!((part(2.0) / 0.2 - 1.0).abs() < 0.005);
        assert!((part(12.0) / 0.3 - 1.0).abs() < 0.03);
        assert!(part(4.0) < 0.002);
    }
}

#[test]
fn a_ripple_of_an_unknown_shaft_is_refused() {
    let mut scenario = pair();
    let ripple = Ripple { shaft: Some("middle".into()), order: 1.0, amplitude: 0.2, phase_deg: 0.0 };
    scenario.operation.torque_ripple = vec![ripple];
    let error = simulate(&scenario).unwrap_err().to_string();
    assert!(error.contains("operation.torque_ripple.shaft") && error.contains("pinion"), "{error}");
}
