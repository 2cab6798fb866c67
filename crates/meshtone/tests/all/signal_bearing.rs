//! Bearings: what their defects leave in a signal is found there, and noise is not taken for it.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;

use crate::signal::{noise, relative_rms, wave};
use meshtone::bearing::NamedBearing;
use meshtone::signal::*;

const RATE_HZ: f64 = 20_000.0;
const SHAFT_HZ: f64 = 30.0;

/// A resonance that rings at each of the angles, each as strongly as `size` says.
fn ringing(phase: &ShaftPhase, angles: &[f64], hz: f64, size: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut signal = vec![0.0; phase.revolutions.len()];
    for angle in angles {
        let start = phase.sample_at(*angle);
        let from = start.ceil() as usize;
        for (sample, value) in signal.iter_mut().enumerate().skip(from).take(200) {
            let since_s = (sample as f64 - start) / RATE_HZ;
            *value += size(*angle) * (-900.0 * since_s).exp() * (TAU * hz * since_s).sin();
        }
    }
    signal
}

/// Angles at which elements pass a place, each late or early by a random part of the distance.
fn passes(order: f64, revolutions: f64, slip: f64) -> Vec<f64> {
    let random = noise(7, (order * revolutions) as usize);
    // A walk: the elements do not come back into step.
    let mut walk = 0.0;
    let angle = |(pass, random): (usize, &f64)| {
        walk += slip * random;
        (pass as f64 + walk) / order
    };
    random.iter().enumerate().map(angle).filter(|angle| *angle > 0.0).collect()
}

fn over_median(lines: &[DefectLine], name: &str) -> f64 {
    lines.iter().find(|line| line.name() == name).unwrap().over_median
}

// The whole way: gears 20 dB above an inner race's bursts, which come and go with the load zone, at a speed that varies.
#[test]
fn an_inner_race_behind_gears_of_a_varying_speed() {
    let bearing = NamedBearing::find("6205").unwrap().geometry.defect_orders();
    let phase =
        ShaftPhase::from_speed_profile(&[0.0, 5.0, 10.0], &[28.0, 32.0, 29.0], RATE_HZ, 200_000).unwrap();
    let bursts = passes(bearing.inner_race, phase.span_rev(), 0.01);
    let defect = ringing(&phase, &bursts, 4300.0, |angle| (1.0 + wave(angle)) * 0.5);
    let gears =
        |angle: f64| 3.0 * wave(17.0 * angle) + wave(34.0 * angle) + wave(angle) + 2.0 * wave(119.0 * angle);
    let noise = noise(3, phase.revolutions.len());
    let parts = phase.revolutions.iter().zip(defect.iter().zip(&noise));
    let signal: Vec<f64> =
        parts.map(|(angle, (defect, noise))| gears(*angle) + defect + 0.1 * noise).collect();

    let residual = synchronous_residual(&signal, std::slice::from_ref(&phase)).unwrap();
    assert!(rms(&residual.values) < 0.1 * rms(&signal), "{}", rms(&residual.values));
    let best =
        kurtogram(&residual.values, RATE_HZ, 7).unwrap().best(3.0 * 30.0 * bearing.inner_race).unwrap();
    assert!((best.band.from_hz..best.band.to_hz).contains(&4300.0), "{best:?}");
    let spectrum =
        squared_envelope_order_spectrum(&residual.values, RATE_HZ, Some(best.band), &phase).unwrap();
    let lines = defect_lines(&spectrum, &bearing, 1.0);
    lines.iter().for_each(|line| println!("{} {:.4} {:.1}", line.name(), line.found_order, line.over_median));
    assert!(over_median(&lines, "BPFI") > 30.0);
    assert!(over_median(&lines, "BPFO") < 6.0 && over_median(&lines, "2 BSF") < 6.0);
    // The load zone makes sidebands of the shaft.
    let at = |order: f64| {
        let line = (order / spectrum.step).round() as usize;
        spectrum.amplitudes[line - 4..=line + 4].iter().copied().fold(0.0, f64::max)
    };
    let [inner, below] = [bearing.inner_race, bearing.inner_race - 1.0].map(at);
    assert!((0.2..0.8).contains(&(below / inner)), "{}", below / inner);
}

#[test]
fn noise_is_no_defect() {
    let bearing = NamedBearing::find("ER-10K").unwrap().geometry.defect_orders();
    for seed in 0..20 {
        let signal = noise(seed, 100_000);
        let spectrum = squared_envelope_spectrum(&signal, RATE_HZ, None).unwrap();
        let lines = defect_lines(&spectrum, &bearing, SHAFT_HZ);
        assert_eq!(lines.len(), 10);
        assert!(lines.iter().all(|line| (0.3..6.0).contains(&line.over_median)), "{lines:?}");
    }
}

// Of Gaussian noise within five standard deviations, √(20/n) of n independent values; of a tone −1, as its envelope is constant.
#[test]
fn kurtogram_of_noise_and_of_a_tone() {
    let of = kurtogram(&noise(1, 60_000), 2.0, 4).unwrap();
    let bands: Vec<usize> = of.levels.iter().map(Vec::len).collect();
    assert_eq!(bands, [1, 2, 3, 4, 6, 8, 12, 16]);
    for level in &of.levels {
        let allowed = 5.0 * (20.0 * level.len() as f64 / 30_000.0).sqrt();
        assert!(level.iter().all(|value| value.abs() < allowed), "{:?}", level);
    }
    assert!(of.best(0.3).unwrap().bands <= 3);
    assert_eq!(of.best(5.0).unwrap().bands, 1);
    // No band has fewer than 256 lines.
    assert_eq!(kurtogram(&noise(1, 3000), 2.0, 20).unwrap().levels.len(), 4);
    assert!(kurtogram(&noise(1, 500), 2.0, 4).is_err());

    let tone: Vec<f64> = (0..8192).map(|i| wave(0.11 * f64::from(i))).collect();
    for level in kurtogram(&tone, 1.0, 3).unwrap().levels {
        let band = (0.22 * level.len() as f64) as usize;
        assert!((level[band] + 1.0).abs() < 0.02, "{:?}", level);
    }
}

// A burst of a period of its own in each of n periods: ⟨|c|⁴⟩/⟨|c|²⟩² of an exponential is half the distance over its decay of amplitude.
#[test]
fn kurtosis_of_bursts_is_the_closed_form() {
    let (decay, distance) = (900.0, 0.02);
    let phase = ShaftPhase::constant(1.0 / distance, RATE_HZ, 200_000).unwrap();
    let angles: Vec<f64> = (0..499).map(f64::from).collect();
    let signal = ringing(&phase, &angles, 5000.0, |_| 1.0);
    let found = kurtogram(&signal, RATE_HZ, 0).unwrap().levels[0][0];
    // ∫e^(−4at)/T over (∫e^(−2at)/T)², less 2.
    let expected = decay * distance - 2.0;
    assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
}

/// A signal that only its size or its emptiness makes odd gives numbers or an error, whatever it is.
#[test]
fn spectral_kurtosis_of_odd_signals_is_a_number_or_refused() {
    let impulse = |at: usize, size: f64| (0..512).map(|i| if i == at { size } else { 0.0 }).collect();
    let tone = |size: f64| (0..512).map(|i| size * f64::from(i).sin()).collect();
    let good: [Vec<f64>; 5] =
        [impulse(0, 1.0), impulse(300, -1e30), impulse(511, 1e-30), tone(1e35), tone(1e-34)];
    for signal in good {
        assert!(spectral_kurtosis(&signal, 64).unwrap().iter().all(|value| value.is_finite()));
    }
    let odd: [Vec<f64>; 6] =
        [vec![0.0; 512], vec![3.0; 512], impulse(9, 1e200), impulse(9, 5e-324), tone(f64::NAN), tone(1e-200)];
    for signal in odd {
        assert!(spectral_kurtosis(&signal, 64).is_err());
    }
}

#[test]
fn spectral_kurtosis_is_zero_in_noise_and_finds_the_resonance_of_bursts() {
    let noise = noise(5, 200_000);
    let of_noise = spectral_kurtosis(&noise, 128).unwrap();
    assert!(of_noise.iter().all(|value| value.abs() < 0.25), "{of_noise:?}");
    let phase = ShaftPhase::constant(SHAFT_HZ, RATE_HZ, noise.len()).unwrap();
    let bursts = ringing(&phase, &passes(3.05, phase.span_rev(), 0.01), 3000.0, |_| 2.0);
    let signal: Vec<f64> = bursts.iter().zip(&noise).map(|(burst, noise)| burst + 0.1 * noise).collect();
    let of_bursts = spectral_kurtosis(&signal, 128).unwrap();
    let best = (0..65).max_by(|a, b| of_bursts[*a].total_cmp(&of_bursts[*b])).unwrap();
    assert!((2000.0..4000.0).contains(&(best as f64 * RATE_HZ / 128.0)), "{best} {of_bursts:?}");
    assert!(spectral_kurtosis(&signal, 3).is_err() && spectral_kurtosis(&signal[..100], 64).is_err());
}

#[test]
fn tones_are_separated_from_noise() {
    let noise = noise(11, 400_000);
    let tones = |i: usize| 2.0 * wave(0.0371 * i as f64) + wave(0.2503 * i as f64);
    let signal: Vec<f64> = noise.iter().enumerate().map(|(i, noise)| tones(i) + noise).collect();
    let parts = discrete_random_separation(&signal, 2048, 2048).unwrap();
    let inside = 2048..398_000;
    let own: Vec<f64> = inside.clone().map(tones).collect();
    // Of 390 blocks 0.9/√390 of the noise's amplitude passes, and all of it in the widths of the tones, twice four lines of 1024.
    let passed = 0.9 / 390f64.sqrt() + (8.0f64 / 1024.0).sqrt();
    assert!(relative_rms(&parts.discrete[inside.clone()], &own) < passed / rms(&own));
    assert!(relative_rms(&parts.random[inside.clone()], &noise[inside]) < passed);
    let refused = |block, delay| discrete_random_separation(&signal, block, delay).unwrap_err().to_string();
    assert!(refused(8, 10).starts_with("block_samples is 8"));
    assert!(refused(64, 0).starts_with("delay_samples is 0"));
    assert!(refused(50_000, 1).contains("at least 400001 are needed"));
}

#[test]
fn the_residual_of_two_shafts_covers_what_the_phase_does() {
    let input = ShaftPhase::constant(20.0, 10_000.0, 30_000).unwrap();
    let part = ShaftPhase::new(1_000, input.revolutions[1_000..29_000].to_vec()).unwrap();
    let mate = part.of_mate(17, 38).unwrap();
    let own: Vec<f64> =
        input.revolutions.iter().map(|angle| wave(17.0 * angle) + wave(angle * 17.0 / 38.0)).collect();
    let noise = noise(2, own.len());
    let signal: Vec<f64> = own.iter().zip(&noise).map(|(own, noise)| own + 0.1 * noise).collect();
    let residual = synchronous_residual(&signal, &[part.clone(), mate]).unwrap();
    assert_eq!((residual.first_sample, residual.values.len()), (1_000, 28_000));
    // Of 55 and 24 revolutions 1/55 and 1/24 of the noise's power are taken.
    let left = rms(&residual.values) / (0.1 * rms(&noise));
    assert!((0.93..1.0).contains(&left), "{left}");
    assert!(synchronous_residual(&signal, &[]).is_err());
    assert!(synchronous_residual(&signal, &[part, input]).is_err());
}

#[test]
fn prewhitening_hears_a_bearing_under_tones() {
    let bearing = NamedBearing::find("6205").unwrap().geometry.defect_orders();
    let phase = ShaftPhase::constant(SHAFT_HZ, RATE_HZ, 200_000).unwrap();
    let defect = ringing(&phase, &passes(bearing.outer_race, phase.span_rev(), 0.01), 4300.0, |_| 1.0);
    let tones =
        |angle: f64| 20.0 * wave(17.0 * angle) * (1.0 + 0.5 * wave(angle)) + 20.0 * wave(150.5 * angle);
    let noise = noise(3, defect.len());
    let all = phase.revolutions.iter().zip(defect.iter().zip(&noise));
    let signal: Vec<f64> =
        all.map(|(angle, (defect, noise))| tones(*angle) + defect + 0.05 * noise).collect();
    let outer = |signal: &[f64]| {
        let spectrum = squared_envelope_order_spectrum(signal, RATE_HZ, None, &phase).unwrap();
        over_median(&defect_lines(&spectrum, &bearing, 1.0), "BPFO")
    };
    let white = cepstral_prewhitening(&signal).unwrap();
    assert!((rms(&white) - 1.0).abs() < 1e-12);
    println!("{} {}", outer(&signal), outer(&white));
    assert!(outer(&white) > 20.0 && outer(&white) > 2.0 * outer(&signal));
}

#[test]
fn velocity_of_tones_is_the_closed_form() {
    let rate_hz = 8000.0;
    let of = |tones: &[(f64, f64)]| {
        let value =
            |i: usize| tones.iter().map(|(size, hz)| size * wave(hz * i as f64 / rate_hz)).sum::<f64>();
        velocity_rms(&(0..80_000).map(value).collect::<Vec<_>>(), rate_hz).unwrap()
    };
    let one = |size: f64, hz: f64| 1e3 * size / (TAU * hz) / 2f64.sqrt();
    let expected = one(2.0, 25.3).hypot(one(30.0, 800.1));
    assert!((of(&[(2.0, 25.3), (30.0, 800.1), (50.0, 1500.0), (0.2, 3.0)]) / expected - 1.0).abs() < 1e-3);
    assert!(
        velocity_rms(&noise(1, 10_000), 2000.0).is_err() && velocity_rms(&noise(1, 7_000), 8000.0).is_err()
    );
}
