//! The shaft's phase.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use crate::signal::{noise, wave};
use meshtone::signal::*;

const RATE_HZ: f64 = 25_000.0;

/// (°) Rms of the difference of two phases over the samples of the first, their mean difference left out.
fn rms_degrees(phase: &ShaftPhase, truth: &[f64]) -> f64 {
    let own = &truth[phase.first_sample..phase.first_sample + phase.revolutions.len()];
    let off: Vec<f64> = phase.revolutions.iter().zip(own).map(|(a, b)| 360.0 * (a - b)).collect();
    standard_deviation(&off)
}

/// Phase of a shaft that wanders by half a per cent around 20 Hz, and speeds up by `drift` in all.
fn wandering(samples: usize, drift: f64) -> Vec<f64> {
    let duration = samples as f64 / RATE_HZ;
    (0..samples)
        .map(|i| {
            let t = i as f64 / RATE_HZ;
            20.0 * t
                + 10.0 * drift * t * t / duration
                + 0.1 / (std::f64::consts::TAU * 0.3) * (1.0 - wave(0.3 * t))
        })
        .collect()
}

// Mesh harmonics with sidebands in noise whose power is a tenth of the mesh harmonic's.
#[test]
fn phase_from_the_mesh_tone_in_noise() {
    let samples = 500_000;
    // The last tone wanders into the ends of the band, where it is weakened, and so the noise gains.
    for (teeth, drift, nominal_hz, middle) in
        [(17_u32, 0.01, 20.1, true), (38, 0.0, 20.0, true), (38, 0.01, 20.1, false)]
    {
        let truth = wandering(samples, drift);
        // Half the amplitude squared over ten.
        let noise = noise(u64::from(teeth), samples);
        let signal: Vec<f64> = (0..samples)
            .map(|i| {
                let r = truth[i];
                let z = f64::from(teeth);
                let mesh = (1.0 + 0.3 * wave(r + 0.2)) * wave(z * r) + 0.6 * wave(2.0 * z * r + 0.3);
                mesh + 0.05f64.sqrt() * noise[i] + 0.2 * wave(0.31 * f64::from(teeth) * r)
            })
            .collect();
        let tone = MeshTone::new(teeth, nominal_hz);
        let phase = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &tone).unwrap();
        let off = rms_degrees(&phase, &truth);
        let predicted = 360.0 * (2.0 * 0.69 * 0.5 * nominal_hz / (RATE_HZ * 10.0)).sqrt()
            / (std::f64::consts::TAU * f64::from(teeth));
        println!("{teeth} teeth: {off:.4}° rms, {predicted:.4}° by the formula; {:?}", phase.warnings);
        assert!(off < 0.2, "{teeth}: {off}");
        assert!(!middle || (off / predicted - 1.0).abs() < 0.35, "{teeth}: {off} {predicted}");
        assert!(phase.warnings.is_empty());

        // Good enough to average with: the mesh harmonics come out whole.
        let record = process_channel(&signal, &phase, teeth, &ChainSettings::default()).unwrap();
        assert!((record.order_spectrum[teeth as usize] - 1.0).abs() < 0.01);
        assert!((record.order_spectrum[2 * teeth as usize] - 0.6).abs() < 0.01);
    }
}

// In the band alone, the same ratio of powers: 10 dB of mesh to noise within ± half an order.
#[test]
fn phase_from_the_mesh_tone_in_noise_of_its_own_band() {
    let samples = 500_000;
    let truth = wandering(samples, 0.0);
    let noise = noise(7, samples);
    // White noise with a tenth of the tone's power within ±10 Hz.
    let deviation = (0.05 * (RATE_HZ / 2.0) / 20.0_f64).sqrt();
    let signal: Vec<f64> = (0..samples).map(|i| wave(38.0 * truth[i]) + deviation * noise[i]).collect();
    let phase = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &MeshTone::new(38, 20.0)).unwrap();
    let wide = rms_degrees(&phase, &truth);
    let narrow = MeshTone { half_band_hz: Some(6.0), ..MeshTone::new(38, 20.0) };
    let narrow = rms_degrees(&ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &narrow).unwrap(), &truth);
    println!(
        "noise of {deviation:.1} rms, 22 dB above the tone in all: {wide:.3}° and, in ±6 Hz, {narrow:.3}°"
    );
    assert!(wide < 2.0 && narrow < wide);
}

// A run-up of 20 % in a band wide enough for it.
#[test]
fn phase_from_the_mesh_tone_in_a_run_up() {
    let samples = 500_000;
    let truth = wandering(samples, 0.2);
    let signal: Vec<f64> = truth.iter().map(|r| wave(17.0 * r) + 0.2 * wave(18.0 * r)).collect();
    let tone = MeshTone { half_band_hz: Some(80.0), ..MeshTone::new(17, 22.0) };
    let phase = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &tone).unwrap();
    let off = rms_degrees(&phase, &truth);
    println!("run-up: {off:.3}°");
    // The sideband, in the band here, modulates the phase by 0.2 rad: 0.2·57°/17/√2 = 0.48°.
    assert!(off < 0.6, "{off}");
}

#[test]
fn a_mesh_tone_that_is_not_there() {
    let samples = 250_000;
    let noise = noise(11, samples);
    let error = ShaftPhase::from_mesh_tone(&noise, RATE_HZ, &MeshTone::new(17, 20.0)).unwrap_err();
    println!("{error}");
    assert!(matches!(error, SignalError::NoMeshTone { .. }), "{error}");

    // The speed is stated too low by more than the band: a sideband is followed, and the warning says what the speed is.
    let sidebands = |i: usize| {
        let r = 20.0 * i as f64 / RATE_HZ;
        wave(17.0 * r) + 0.2 * wave(16.0 * r) + 0.2 * wave(18.0 * r) + 0.1 * noise[i]
    };
    let signal: Vec<f64> = (0..samples).map(sidebands).collect();
    let phase = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &MeshTone::new(17, 18.9)).unwrap();
    println!("{}", phase.warnings[0]);
    let SignalWarning::StrongerNeighbour { speed_hz, .. } = phase.warnings[0] else { panic!() };
    assert!((speed_hz - 20.0).abs() < 0.02);

    let beyond = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &MeshTone::new(700, 20.0)).unwrap_err();
    assert!(matches!(beyond, SignalError::MeshOrderBeyondNyquist { .. }), "{beyond}");
    let short = ShaftPhase::from_mesh_tone(&signal[..5_000], RATE_HZ, &MeshTone::new(17, 20.0)).unwrap_err();
    assert!(matches!(short, SignalError::TooFew { .. }), "{short}");

    // It fades in the middle.
    let fading: Vec<f64> = (0..samples)
        .map(|i| {
            let t = i as f64 / RATE_HZ;
            (1e-3 + ((t - 5.0) / 5.0).powi(2)) * wave(340.0 * t)
        })
        .collect();
    let phase = ShaftPhase::from_mesh_tone(&fading, RATE_HZ, &MeshTone::new(17, 20.0)).unwrap();
    println!("{}", phase.warnings[0]);
    let SignalWarning::MeshToneFades { sample, .. } = phase.warnings[0] else { panic!() };
    assert!(sample.abs_diff(125_000) < 5_000);
}

// Each way to know a steady speed gives the same phase.
#[test]
fn steady_speed() {
    let exact = ShaftPhase::constant(20.0, RATE_HZ, 25_000).unwrap();
    let profile = ShaftPhase::from_speed_profile(&[0.0, 2.0], &[20.0, 20.0], RATE_HZ, 25_000).unwrap();
    let sampled = ShaftPhase::from_speed_samples(&vec![20.0; 25_000], RATE_HZ).unwrap();
    let times: Vec<f64> = (0..21).map(|n| f64::from(n) / 20.0).collect();
    let pulses = ShaftPhase::from_pulses(&times, 1, Some(20.0), RATE_HZ, 25_000).unwrap();
    let teeth: Vec<f64> = (0..38 * 21).map(|n| f64::from(n) / (38.0 * 20.0)).collect();
    let teeth = ShaftPhase::from_pulses(&teeth, 38, None, RATE_HZ, 25_000).unwrap();
    for phase in [profile, sampled, pulses, teeth] {
        assert!(crate::signal::largest_difference(&phase.revolutions, &exact.revolutions) < 1e-11);
        assert!(phase.warnings.is_empty());
    }
    assert!((exact.mean_speed_hz(RATE_HZ) - 20.0).abs() < 1e-12);
    let there_and_back = exact.of_mate(17, 38).unwrap().of_mate(38, 17).unwrap();
    assert!(crate::signal::largest_difference(&there_and_back.revolutions, &exact.revolutions) < 1e-13);
}

// A pulse that is missing, one that is doubled, and noise on the tachometer.
#[test]
fn a_bad_tachometer() {
    let samples = 50_000;
    let noise = noise(5, samples);
    let waveform: Vec<f64> = (0..samples)
        .map(|i| {
            let turned = 20.0 * i as f64 / RATE_HZ;
            let high = turned.fract() < 0.25 && turned.floor() != 13.0;
            let bounce = (7.11..7.115).contains(&turned);
            (if high && !bounce { 5.0 } else { 0.0 }) + 0.2 * noise[i]
        })
        .collect();
    let settings = Tachometer::default();
    let times = tachometer_pulses(&waveform, RATE_HZ, &settings).unwrap();
    let phase = ShaftPhase::from_pulses(&times, 1, Some(20.0), RATE_HZ, samples).unwrap();
    let messages: Vec<String> = phase.warnings.iter().map(ToString::to_string).collect();
    println!("{messages:#?}");
    let [SignalWarning::DoubledPulse { time_s, .. }, SignalWarning::MissingPulses { after_s, count: 1, .. }] =
        phase.warnings[..]
    else {
        panic!("{messages:#?}")
    };
    assert!((time_s - 7.115 / 20.0).abs() < 1e-4 && (after_s - 12.0 / 20.0).abs() < 1e-4);
    let truth: Vec<f64> = (0..samples).map(|i| 20.0 * i as f64 / RATE_HZ).collect();
    assert!(rms_degrees(&phase, &truth) < 0.2);

    let falling = Tachometer { edge: PulseEdge::Falling, threshold: Some(2.5), hysteresis: Some(1.0) };
    let clean: Vec<f64> =
        (0..samples).map(|i| if (20.0 * i as f64 / RATE_HZ).fract() < 0.25 { 5.0 } else { 0.0 }).collect();
    let times = tachometer_pulses(&clean, RATE_HZ, &falling).unwrap();
    assert!((times[0] - 0.0125).abs() < 1.0 / RATE_HZ && times.len() == 40);
}

#[test]
fn pulses_between_samples_lose_no_revolution() {
    for offset_s in [0.0, 0.0003, 0.0007] {
        for pulses in 3..6 {
            let times: Vec<f64> = (0..pulses).map(|k| 0.05 + offset_s + 0.1 * f64::from(k)).collect();
            let phase = ShaftPhase::from_pulses(&times, 1, None, 1000.0, 700).unwrap();
            let signal: Vec<f64> = (0..700).map(|i| f64::from(i % 37)).collect();
            let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
            assert_eq!(angular.revolutions() as i32, pulses - 1, "{offset_s} {pulses}");
            assert_eq!(angular.start_rev, 0.0);
        }
    }
}

// A missing tooth rings a resonance beside the mesh: many lines of the mate's shaft, none of which is a mesh.
#[test]
fn ringing_beside_the_mesh_is_no_other_mesh() {
    let noise = noise(12, 100_000);
    let ringing = |gear_rev: f64| -> f64 {
        let line = |k: i32| (-f64::from(k - 47).powi(2) / 9.0).exp() * wave(f64::from(k) * gear_rev);
        (41..=53).map(line).sum()
    };
    let signal = |i: usize| {
        let r = 20.0 * i as f64 / RATE_HZ;
        0.3 * wave(17.0 * r) + ringing(r * 17.0 / 38.0) + 0.05 * noise[i]
    };
    let signal: Vec<f64> = (0..noise.len()).map(signal).collect();
    let phase = ShaftPhase::from_mesh_tone(&signal, RATE_HZ, &MeshTone::new(17, 20.0)).unwrap();
    assert_eq!(phase.warnings, []);
    assert_eq!(phase.zero, AngleZero::Chance);
}

#[test]
fn a_phase_knows_from_where_teeth_are_counted() {
    let pulses = |per_revolution| {
        let times: Vec<f64> = (1..=20).map(|i| 0.05 * f64::from(i)).collect();
        ShaftPhase::from_pulses(&times, per_revolution, None, RATE_HZ, 20_000).unwrap()
    };
    let speeds = vec![20.0; 100];
    for (phase, zero, of_mate) in [
        (pulses(1), AngleZero::Pulse, AngleZero::FirstPulse),
        (pulses(2), AngleZero::FirstPulse, AngleZero::FirstPulse),
        (ShaftPhase::constant(20.0, RATE_HZ, 100).unwrap(), AngleZero::FirstSample, AngleZero::FirstSample),
        (
            ShaftPhase::from_speed_samples(&speeds, RATE_HZ).unwrap(),
            AngleZero::FirstSample,
            AngleZero::FirstSample,
        ),
        (ShaftPhase::new(0, vec![0.0, 0.1]).unwrap(), AngleZero::Given, AngleZero::Given),
    ] {
        assert_eq!((phase.zero, phase.of_mate(17, 38).unwrap().zero), (zero, of_mate));
    }
    for (place, (name, zero)) in AngleZero::NAMES.into_iter().enumerate() {
        assert_eq!((zero.name(), zero as usize), (name, place));
    }
}
