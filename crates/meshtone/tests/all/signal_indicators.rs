//! Indicators of signals whose indicators are known.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::TAU;

use crate::signal::{noise, wave};
use meshtone::signal::*;

#[track_caller]
fn assert_near(value: Option<f64>, exact: f64, tolerance: f64) {
    let value = value.unwrap();
    assert!((value / exact - 1.0).abs() < tolerance, "{value} instead of {exact}");
}

/// Removes the lines of a signal that are within 1.5 Hz of a frequency.
fn without(signal: &[f64], rate_hz: f64, frequencies_hz: &[f64]) -> Vec<f64> {
    let mut spectrum = analytic_signal(signal).unwrap();
    // Real part of the analytic signal is the signal: a line is removed by subtracting it.
    let n = signal.len() as f64;
    let mut left: Vec<f64> = spectrum.drain(..).map(|z| z.re).collect();
    for k in 0..=signal.len() / 2 {
        let frequency = k as f64 * rate_hz / n;
        if frequencies_hz.iter().all(|f| (f - frequency).abs() > 1.5) {
            continue;
        }
        let turn = |i: usize| (TAU * ((k * i) % signal.len()) as f64 / n).sin_cos();
        let (mut re, mut im) = (0.0, 0.0);
        for (i, x) in signal.iter().enumerate() {
            let (sin, cos) = turn(i);
            re += x * cos;
            im -= x * sin;
        }
        let images = if k == 0 || 2 * k == signal.len() { 1.0 } else { 2.0 };
        for (i, x) in left.iter_mut().enumerate() {
            let (sin, cos) = turn(i);
            *x -= images / n * (re * cos - im * sin);
        }
    }
    left
}

// Ten records of a shaft at 3 Hz, teeth at 51 and 153 Hz, and a growing tone at 30 Hz; the values come from another
// implementation.
#[test]
fn na4_of_a_growing_fault() {
    const EXPECTED: [f64; 10] = [
        1.536982703280907,
        3.857738227803903,
        5.590250485891509,
        6.835250547872656,
        7.755227746173137,
        8.457654233606695,
        9.009683995782796,
        9.454160950683573,
        9.819352835339927,
        10.12454304712786,
    ];
    let rate_hz = 5e4;
    let residuals: Vec<Vec<f64>> = (1..=10)
        .map(|record| {
            let signal: Vec<f64> = (0..16_666)
                .map(|i| {
                    let t = f64::from(i) / rate_hz;
                    let sines = |f: f64| (TAU * f * t).sin() + (TAU * 2.0 * f * t).sin();
                    let fault = f64::from(record) / 3.0 * (TAU * 30.0 * t).sin();
                    sines(3.0) + 3.0 * sines(51.0) + 4.0 * sines(153.0) + fault
                })
                .collect();
            without(&signal, rate_hz, &[3.0, 6.0, 51.0, 102.0, 153.0, 306.0])
        })
        .collect();
    let values = na4(&residuals).unwrap();
    for (value, expected) in values.iter().zip(EXPECTED) {
        assert_near(*value, expected, 1e-12);
    }
}

// A sine: µ_2k/µ₂^k = 2^k (2k − 1)!!/(2k)!! = 1.5, 2.5, 4.375.
#[test]
fn moments_of_a_sine() {
    let sine: Vec<f64> = (0..1024).map(|i| 7.0 + 3.0 * wave(5.0 * f64::from(i) / 1024.0)).collect();
    assert_near(fm4(&sine), 1.5, 1e-13);
    assert_near(m6a(&sine), 2.5, 1e-13);
    assert_near(m8a(&sine), 4.375, 1e-13);
    assert!(skewness(&sine).unwrap().abs() < 1e-13);
    let own = ShapeIndicators::new(&sine);
    assert_near(Some(own.rms), 53.5f64.sqrt(), 1e-14);
    assert_near(Some(own.peak_to_peak), 6.0, 1e-4);
    assert_near(own.crest_factor, 10.0 / 53.5f64.sqrt(), 1e-14);
}

// A pulse in n samples, p = 1/n, q = 1 − p: µ_k = p q (q^(k−1) ± p^(k−1)), minus for odd k.
#[test]
fn moments_of_a_pulse() {
    let mut pulse = vec![2.0; 64];
    pulse[9] = 5.0;
    let (p, q) = (1.0 / 64.0, 63.0 / 64.0);
    let even = |k: i32| p * q * (f64::powi(q, k - 1) + f64::powi(p, k - 1)) / f64::powi(p * q, k / 2);
    assert_near(fm4(&pulse), even(4), 1e-13);
    assert_near(m6a(&pulse), even(6), 1e-13);
    assert_near(m8a(&pulse), even(8), 1e-13);
    assert_near(skewness(&pulse), p * q * (q * q - p * p) / (p * q).powf(1.5), 1e-13);
}

// Equal chances of ±1: every even standardised moment is 1. Gaussian noise: 3, 15, 105.
#[test]
fn moments_of_a_square_wave_and_of_noise() {
    let square: Vec<f64> = (0..100).map(|i| if i % 2 == 0 { 4.0 } else { -2.0 }).collect();
    let noise = noise(1, 2_000_000);
    for (indicator, gaussian) in [(fm4 as fn(&[f64]) -> _, 3.0), (m6a, 15.0), (m8a, 105.0)] {
        assert_near(indicator(&square), 1.0, 1e-14);
        assert_near(indicator(&noise), gaussian, 0.03);
    }
}

// A gear of 20 teeth: harmonics of 3 and 1, sidebands ±1 of 0.5 each and ±2 of 0.1, a shaft order of 0.3, a fault line at
// order 29 of 0.2 and a mean of 0.7. Everything follows by hand.
#[test]
fn a_spectrum_made_by_hand() {
    let lines: [(f64, f64); 9] = [
        (3.0, 0.3),
        (18.0, 0.1),
        (19.0, 0.5),
        (20.0, 3.0),
        (21.0, 0.5),
        (22.0, 0.1),
        (29.0, 0.2),
        (40.0, 1.0),
        (0.0, 0.7),
    ];
    let sum = |chosen: &dyn Fn(f64) -> bool| -> Vec<f64> {
        (0..512)
            .map(|i| {
                let at = |(order, a): &(f64, f64)| a * wave(order * f64::from(i) / 512.0);
                lines.iter().filter(|(order, _)| chosen(*order)).map(at).sum()
            })
            .collect()
    };
    let average = SynchronousAverage { revolutions: 2, nyquist_order: 256.0, values: sum(&|_| true) };
    let record = process_average(average, 20, &ChainSettings::default()).unwrap();
    let near = |a: &[f64], b: &[f64]| assert!(crate::signal::largest_difference(a, b) < 1e-13);
    near(&record.parts.difference, &sum(&|order| order == 0.0 || order == 29.0));
    near(&record.parts.regular, &sum(&|order| order != 0.0 && order != 29.0));
    near(&record.parts.residual, &sum(&|order| ![3.0, 20.0, 40.0].contains(&order)));
    for (order, amplitude) in lines {
        assert!((record.order_spectrum[order as usize] - amplitude).abs() < 1e-14);
    }
    let own = record.indicators;
    let square = |lines: &[f64]| (lines.iter().map(|a| a * a).sum::<f64>() / 2.0).sqrt();
    let regular = square(&[0.3, 0.1, 0.5, 3.0, 0.5, 0.1, 1.0]);
    let peak_to_peak = own.average.peak_to_peak;
    assert_near(own.fm0, peak_to_peak / 4.0, 1e-12);
    assert_near(own.energy_ratio, square(&[0.2]) / regular, 1e-12);
    assert_near(own.sideband_level_factor, 1.0 / regular.hypot(square(&[0.2])), 1e-12);
    assert_near(own.fm4, 1.5, 1e-10);
    assert_near(Some(own.difference.rms), 0.7f64.hypot(square(&[0.2])), 1e-12);
    assert_near(Some(own.residual.rms), 0.7f64.hypot(square(&[0.1, 0.5, 0.5, 0.1, 0.2])), 1e-12);
    assert_near(Some(own.regular.rms), regular, 1e-12);
    assert_eq!(own.na4, own.residual.kurtosis);
    // Of 20 teeth the first harmonic is 3 high, between sidebands of 0.5.
    let [first, ..] = own.mesh_harmonics;
    assert_near(first.amplitude, 3.0, 1e-12);
    for sidebands in [first.lower_sidebands, first.upper_sidebands] {
        assert_near(sidebands[0], 0.5, 1e-12);
        assert_near(sidebands[1], 0.1, 1e-12);
    }
    assert_eq!(own.table("g").len(), 86);

    let mut settings = SeparationSettings::new(20);
    settings.mean = MeanPart::Removed;
    settings.sidebands = 0;
    settings.shaft_orders.clear();
    let parts = separate(&sum(&|_| true), &settings).unwrap();
    near(&parts.regular, &sum(&|order| [0.0, 20.0, 40.0].contains(&order)));
    near(&parts.difference, &parts.residual);
}

// The envelope of a difference signal that is modulated once a revolution.
#[test]
fn envelope_of_a_modulated_difference() {
    let values = (0..1024)
        .map(|i| {
            let t = f64::from(i) / 1024.0;
            5.0 * wave(20.0 * t) + (1.0 + 0.4 * wave(t)) * wave(150.0 * t)
        })
        .collect();
    let average = SynchronousAverage { revolutions: 2, nyquist_order: 512.0, values };
    let record = process_average(average, 20, &ChainSettings::default()).unwrap();
    for (order, amplitude) in [(0, 1.0), (1, 0.4), (2, 0.0)] {
        assert!((record.envelope_spectrum[order] - amplitude).abs() < 1e-13);
    }
    // Of 1 + 0.4 cos: rms √1.08, kurtosis of the cosine.
    assert_near(Some(record.indicators.envelope.rms), 1.08f64.sqrt(), 1e-13);
    assert_near(record.indicators.envelope.kurtosis, 1.5, 1e-12);
}

// Where nothing is left, nothing is reported but zeros: rounding has no kurtosis.
#[test]
fn nothing_left_has_no_shape() {
    let values = (0..512).map(|i| 40.0 * wave(20.0 * f64::from(i) / 512.0)).collect();
    let average = SynchronousAverage { revolutions: 2, nyquist_order: 256.0, values };
    let own = process_average(average, 20, &ChainSettings::default()).unwrap().indicators;
    assert_eq!((own.difference.rms, own.residual.rms, own.envelope.rms), (0.0, 0.0, 0.0));
    assert_eq!((own.fm4, own.m6a, own.m8a, own.na4), (None, None, None, None));
    assert_eq!(
        (own.difference.kurtosis, own.envelope.kurtosis, own.envelope.crest_factor),
        (None, None, None)
    );
    assert_eq!(own.energy_ratio, Some(0.0));
    assert_near(own.average.kurtosis, 1.5, 1e-12);
}
