//! The chain on recordings whose average is known.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::signal::{largest_difference, noise, relative_rms, wave};
use meshtone::scenario::{DampingRatio, GearPair, Model, Profile, Scenario};
use meshtone::signal::*;
use meshtone::simulate;

const RATE_HZ: f64 = 20_000.0;

/// One revolution of a gear with 19 teeth, at `angle` revolutions.
fn known(angle: f64) -> f64 {
    let angle = angle.fract();
    let fault = 0.4 * (-((angle - 0.3) / 0.01).powi(2)).exp() * wave(60.0 * angle);
    wave(19.0 * angle) + 0.5 * wave(38.0 * angle + 0.1) + 0.1 * wave(18.0 * angle) + 0.2 * wave(angle) + fault
}

fn known_average(points: usize) -> Vec<f64> {
    (0..points).map(|i| known(i as f64 / points as f64)).collect()
}

// Noise in the average falls with the square root of the revolutions, and so do the tones of other shafts on the whole.
#[test]
fn noise_falls_with_the_square_root_of_the_revolutions() {
    let samples = 1_300_000;
    let phase = ShaftPhase::constant(25.0, RATE_HZ, samples).unwrap();
    let noise = noise(2, samples);
    let signal: Vec<f64> = (0..samples)
        .map(|i| {
            let t = i as f64 / RATE_HZ;
            known(25.0 * t) + noise[i] + 0.7 * wave(1_013.7 * t) + 0.5 * wave(333.3 * t)
        })
        .collect();
    let angular = angular_resample(&signal, &phase, &AngularSettings::default()).unwrap();
    assert_eq!((angular.points_per_revolution, angular.revolutions()), (1024, 1624));
    let truth = known_average(1024);
    for revolutions in [25, 100, 400, 1600] {
        let averages = segmented_averages(&angular, revolutions).unwrap();
        let square = |average: &SynchronousAverage| {
            let off: Vec<f64> = average.values.iter().zip(&truth).map(|(a, b)| a - b).collect();
            rms(&off).powi(2)
        };
        let off = (averages.iter().map(square).sum::<f64>() / averages.len() as f64).sqrt();
        // The interpolation takes a little off the noise near half the sampling rate.
        let expected = 1.0 / (revolutions as f64).sqrt();
        println!("{revolutions} revolutions: rms error {off:.5}, noise alone {expected:.5}");
        assert!(off > 0.85 * expected && off < 1.15 * expected, "{revolutions}: {off} {expected}");
    }
    let record = process_channel(&signal, &phase, 19, &ChainSettings::default()).unwrap();
    assert_eq!(record.average.revolutions, 1624);
    assert!((record.order_spectrum[19] - 1.0).abs() < 5e-3);
    assert!((record.order_spectrum[38] - 0.5).abs() < 5e-3);
}

// Without noise the average is exact, at constant speed, in a run-up, and whatever the phase comes from.
#[test]
fn the_average_is_the_known_one_however_the_phase_is_found() {
    let samples = 100_000;
    let (time_s, speed_hz) = ([0.0, 2.0, 3.0, 5.0], [20.0, 30.0, 28.0, 22.0]);
    let truth = ShaftPhase::from_speed_profile(&time_s, &speed_hz, RATE_HZ, samples).unwrap();
    let signal: Vec<f64> = truth.revolutions.iter().map(|&angle| known(angle)).collect();
    // Every tenth of a revolution a pulse, first at angle 0.
    let pulses: Vec<f64> = (0..(10.0 * truth.span_rev()) as usize)
        .map(|pulse| {
            let angle = pulse as f64 / 10.0;
            let after = truth.revolutions.partition_point(|&r| r < angle).max(1);
            let (from, to) = (truth.revolutions[after - 1], truth.revolutions[after]);
            (after as f64 - 1.0 + (angle - from) / (to - from)) / RATE_HZ
        })
        .collect();
    // A tachometer's waveform: high for a quarter of the distance between pulses, 1 pulse per revolution.
    let waveform: Vec<f64> = truth
        .revolutions
        .iter()
        .map(|r| 2.5 + 2.5 * ((r.fract() - 0.5).abs() / 0.05 - 7.5).clamp(-1.0, 1.0))
        .collect();
    let edges = tachometer_pulses(&waveform, RATE_HZ, &Tachometer::default()).unwrap();
    // It rises through the middle at 0.875 of a revolution.
    let by_waveform = ShaftPhase::from_pulses(&edges, 1, None, RATE_HZ, samples).unwrap();
    let shifted: Vec<f64> = by_waveform.revolutions.iter().map(|r| r + 0.875).collect();
    let by_waveform = ShaftPhase::new(by_waveform.first_sample, shifted).unwrap();
    let by_pulses = ShaftPhase::from_pulses(&pulses, 10, Some(25.7), RATE_HZ, samples).unwrap();
    for (name, phase, tolerance) in
        [("speed profile", &truth, 2e-5), ("pulses", &by_pulses, 3e-4), ("waveform", &by_waveform, 2e-2)]
    {
        let settings = AngularSettings { points_per_revolution: Some(1024), ..Default::default() };
        let angular = angular_resample(&signal, phase, &settings).unwrap();
        let average = synchronous_average(&angular).unwrap();
        let off = relative_rms(&average.values, &known_average(1024));
        println!("{name}: {} revolutions, off by {off:.1e}", average.revolutions);
        assert!(off < tolerance, "{name}: {off}");
    }
}

// The published interpolation loses amplitude between samples, the band-limited one does not.
#[test]
fn interpolations_of_a_tone() {
    for samples_per_period in [2.5, 3.0, 5.0, 10.0, 30.0] {
        let n = 3000;
        let tone = |t: f64| wave(t / samples_per_period);
        let signal: Vec<f64> = (0..n).map(|i| tone(f64::from(i))).collect();
        let places: Vec<f64> = (0..10_000).map(|i| 100.0 + 0.2718 * f64::from(i)).collect();
        let exact: Vec<f64> = places.iter().map(|&t| tone(t)).collect();
        let band_limited = interpolate_band_limited(&signal, &places, Edge::Reflect).unwrap();
        let pchip = interpolate_pchip(&signal, &places, Edge::Reflect).unwrap();
        let gain = |values: &[f64]| {
            let product: f64 = values.iter().zip(&exact).map(|(a, b)| a * b).sum();
            product / exact.iter().map(|b| b * b).sum::<f64>()
        };
        let off = largest_difference(&band_limited, &exact);
        let loss = 1.0 - gain(&pchip);
        println!(
            "{samples_per_period} samples a period: band-limited off by {off:.1e}; PCHIP off by {:.1e}, loses {loss:.1e}",
            largest_difference(&pchip, &exact)
        );
        assert!(off < 1.2e-5, "{samples_per_period}: {off}");
        // As the documentation has it.
        let model = 34.0 / samples_per_period.powi(4);
        assert!(
            ![5.0, 10.0].contains(&samples_per_period) || (loss / model - 1.0).abs() < 0.1,
            "{samples_per_period}: {loss} {model}"
        );
    }
}

// Periodic recordings lose nothing at their ends and count every revolution.
#[test]
fn a_periodic_recording_is_used_whole() {
    let samples = 8_000; // 10 revolutions of 800 samples
    let phase = ShaftPhase::constant(25.0, RATE_HZ, samples).unwrap();
    let signal: Vec<f64> = (0..samples).map(|i| known(25.0 * i as f64 / RATE_HZ)).collect();
    for (edge, revolutions) in [(Edge::Periodic, 10), (Edge::Reflect, 9)] {
        let settings = AngularSettings { edge, ..Default::default() };
        let angular = angular_resample(&signal, &phase, &settings).unwrap();
        let average = synchronous_average(&angular).unwrap();
        assert_eq!(average.revolutions, revolutions);
        let off = largest_difference(&average.values, &known_average(1024));
        println!("{edge:?}: {off:.1e}");
        assert!(off < if edge == Edge::Periodic { 2e-5 } else { 2e-2 }, "{edge:?}: {off}");
    }
    let odd = AngularSettings { edge: Edge::Periodic, ..Default::default() };
    let error =
        angular_resample(&signal[..7_900], &ShaftPhase::constant(25.0, RATE_HZ, 7_900).unwrap(), &odd);
    assert_eq!(
        error.unwrap_err().to_string(),
        "a recording can be continued periodically only if it spans whole revolutions, but this one spans 9.875000"
    );
}

// Resampling a periodic signal rings nowhere; with zeros beyond its ends it does.
#[test]
fn resampling_rings_only_with_zeros_beyond_the_ends() {
    let n = 4_800;
    let slow = |t: f64| 2.0 + wave(5.0 * t) + 0.5 * wave(80.0 * t + 0.2);
    let signal: Vec<f64> = (0..n).map(|i| slow(i as f64 / n as f64)).collect();
    let exact: Vec<f64> = (0..1_125).map(|i| slow(f64::from(i) / 1_125.0)).collect();
    let off = |edge| largest_difference(&resample(&signal, 15, 64, edge).unwrap(), &exact);
    let (zero, reflect, periodic) = (off(Edge::Zero), off(Edge::Reflect), off(Edge::Periodic));
    println!("zeros {zero:.1e}, reflected {reflect:.1e}, periodic {periodic:.1e}");
    assert!(zero > 0.5 && reflect < 0.1 && periodic < 2e-3);
}

// Rigs sample at any rate and turn at any speed: ratios of the rates need not be those of whole numbers.
#[test]
fn any_rates_are_resampled() {
    let mut state = 7_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let (mut off, mut whole) = (0.0_f64, 0);
    for _ in 0..500 {
        let from_hz = 5e3 * 60_f64.powf(draw());
        let to_hz = from_hz * 0.05_f64.powf(draw());
        whole += usize::from(resampling_ratio(from_hz, to_hz).is_ok());
        // Up to 0.8 of half the lower rate.
        let tones = [0.4 * to_hz, 0.4 * to_hz * draw(), 0.4 * to_hz * draw()];
        let signal_at = |time_s: f64| tones.iter().map(|hz| wave(hz * time_s)).sum::<f64>();
        let reach = (25.0 * from_hz / to_hz).ceil() as usize;
        let signal: Vec<f64> = (0..4 * reach).map(|i| signal_at(i as f64 / from_hz)).collect();
        let resampled = resample_to(&signal, from_hz, to_hz, Edge::Reflect).unwrap();
        assert_eq!(resampled.len(), (signal.len() as f64 * to_hz / from_hz).ceil() as usize);
        // The filter reaches ten samples of the new rate.
        let inside = 11..resampled.len() - 11;
        off = inside.map(|m| (resampled[m] - signal_at(m as f64 / to_hz)).abs()).fold(off, f64::max);
    }
    println!("500 pairs of rates, {whole} of a whole ratio: off by {off:.1e} of three tones of 1");
    // Of each tone 0.2 %, and as much of its image beyond half the rate.
    assert!(off < 3.0 * 4e-3 && whole < 50);
}

// What the documentation says of the default filter.
#[test]
fn response_of_the_resampling_filter() {
    let taps = resampling_taps(1, 40).unwrap();
    let half = (taps.len() / 2) as f64;
    // Frequency in units of half the lower rate.
    let gain = |f: f64| -> f64 {
        taps.iter().enumerate().map(|(i, tap)| tap * wave((i as f64 - half) * f / 80.0)).sum()
    };
    let deviation =
        |to: f64| (0..1000).map(|i| (gain(to * f64::from(i) / 1000.0) - 1.0).abs()).fold(0.0, f64::max);
    println!(
        "off 1 by {:.1e} up to 0.8 and {:.1e} up to 0.85 of half the rate",
        deviation(0.8),
        deviation(0.85)
    );
    let stop = (0..4000).map(|i| gain(1.2 + f64::from(i) / 110.0).abs()).fold(0.0, f64::max);
    println!("at half the rate {:.4}, beyond 1.2 of it {stop:.1e}", gain(1.0));
    assert!(deviation(0.8) < 2e-3 && (gain(1.0) - 0.5).abs() < 1e-3 && stop < 2e-3);
}

// A simulated run-up: over time the mesh lines are smeared, over the angle of the shaft each is one order wide.
#[test]
fn a_run_up_has_mesh_lines_one_bin_wide() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.model = Model::Linear;
    scenario.solver.sampling_rate_hz = 2e5;
    scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(0.2);
    let profile = Profile { time_s: vec![0.0, 1.0, 3.0], value: vec![20.0, 20.0, 60.0] };
    scenario.operation.speed_profile_hz = Some(profile);
    let simulation = simulate(&scenario).unwrap();
    let channels = &simulation.channels;
    let rate_hz = channels.sampling_rate_hz;
    // The mesh force carries the teeth's variation whatever the speed; resonances make its amplitude vary.
    let signal = &channels["mesh_force_n"];
    let phase = ShaftPhase::from_speed_samples(&channels["pinion_shaft_speed_hz"], rate_hz).unwrap();
    let angular = angular_resample(signal, &phase, &AngularSettings::default()).unwrap();
    let points = angular.points_per_revolution;
    println!(
        "{} revolutions from {:.1} to {:.1} Hz",
        angular.revolutions(),
        channels["pinion_shaft_speed_hz"][0],
        channels["pinion_shaft_speed_hz"][signal.len() - 1]
    );
    assert!(angular.revolutions() > 40);

    // In the average's spectrum a bin is an order: nothing is left beside the mesh lines.
    let average = synchronous_average(&angular).unwrap();
    let spectrum = order_spectrum(&average.values).unwrap();
    for harmonic in 1..=5 {
        let line = 17 * harmonic;
        let beside =
            (line - 8..line).chain(line + 1..line + 9).map(|order| spectrum[order]).fold(0.0, f64::max);
        println!(
            "mesh harmonic {harmonic}: {:.3} N, within 8 orders beside it {beside:.1e} N",
            spectrum[line]
        );
        assert!(beside < 0.02 * spectrum[line], "harmonic {harmonic}");
    }

    // All revolutions in one spectrum resolve 1/count of an order. What is left there is the resonances that the run-up
    // passes: they modulate the lines, which keep their energy within a tenth of an order.
    let count = angular.revolutions();
    let fine = order_spectrum(&angular.values[..points * count]).unwrap();
    let energy = |bins: std::ops::RangeInclusive<usize>| fine[bins].iter().map(|a| a * a).sum::<f64>();
    let line = 17 * count;
    let near = energy(line - count / 10..=line + count / 10) / energy(line - 8 * count..=line + 8 * count);
    // Over time the line is spread over the whole run-up.
    let over_time = order_spectrum(signal).unwrap();
    let hz = signal.len() as f64 / rate_hz;
    let spread = (17.0 * 20.0 * hz) as usize..(17.0 * 60.0 * hz) as usize;
    let strongest = over_time[spread].iter().copied().fold(0.0, f64::max);
    println!(
        "{near:.4} of the energy within 0.1 order; {:.2} N, over time at most {strongest:.2} N",
        fine[line]
    );
    assert!(near > 0.9 && strongest < 0.5 * fine[line]);
}

// A series in one call: NA4 depends on the order of the records, the rest does not.
#[test]
fn a_series_of_recordings() {
    let samples = 40_000;
    let phase = ShaftPhase::constant(25.0, RATE_HZ, samples).unwrap();
    let recording = |seed: u64, fault: f64| -> Vec<f64> {
        let noise = noise(seed, samples);
        (0..samples)
            .map(|i| {
                let t = 25.0 * i as f64 / RATE_HZ;
                known(t) + fault * (-((t.fract() - 0.6) / 0.004).powi(2)).exp() * wave(90.0 * t) + noise[i]
            })
            .collect()
    };
    let signals: Vec<Vec<f64>> = (0..6).map(|k| recording(k, 2.0 * k as f64)).collect();
    let recordings: Vec<Recording> =
        signals.iter().map(|signal| Recording { signal, phase: &phase }).collect();
    let records = process_series(&recordings, 19, &ChainSettings::default()).unwrap();
    let trend: Vec<f64> = records.iter().map(|record| record.indicators.na4.unwrap()).collect();
    println!("NA4 {trend:.2?}");
    assert_eq!(records[0].indicators.na4, records[0].indicators.residual.kurtosis);
    assert!(trend.windows(2).all(|pair| pair[1] > pair[0]));
    let alone = process_channel(&signals[5], &phase, 19, &ChainSettings::default()).unwrap();
    assert_eq!(alone.indicators.fm4, records[5].indicators.fm4);
    assert!(alone.indicators.na4.unwrap() < trend[5]);

    let segments = process_segments(&signals[3], &phase, 19, &ChainSettings::default(), 12).unwrap();
    assert_eq!(segments.len(), 4);
    assert!(segments.iter().all(|segment| segment.average.revolutions == 12));
}
