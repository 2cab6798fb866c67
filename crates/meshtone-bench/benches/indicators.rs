//! One channel of a 60 s recording at 50 kS/s, from samples to the indicators of both wheels, and its kurtogram.
#![allow(missing_docs, clippy::unwrap_used)]

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use meshtone::signal::*;

const RATE_HZ: f64 = 5e4;
const SAMPLES: usize = 3_000_000;
const PINION_HZ: f64 = 40.0;
const PINION_TEETH: u32 = 17;
const GEAR_TEETH: u32 = 38;

/// Mesh tones with something in between, without a random generator.
fn recording() -> Vec<f64> {
    let mesh_hz = PINION_HZ * f64::from(PINION_TEETH);
    (0..SAMPLES)
        .map(|i| {
            let t = i as f64 / RATE_HZ;
            let scatter = (i.wrapping_mul(2_654_435_761) % 65_536) as f64 / 65_536.0 - 0.5;
            (TAU * mesh_hz * t).cos() + 0.5 * (TAU * 2.0 * mesh_hz * t).cos() + scatter
        })
        .collect()
}

/// Pulses once a revolution of the pinion.
fn pulses() -> Vec<f64> {
    (0..(SAMPLES as f64 / RATE_HZ * PINION_HZ) as u32).map(|n| f64::from(n) / PINION_HZ).collect()
}

/// Both wheels, from the pulses of one of them.
fn both_wheels(signal: &[f64], pulses: &[f64], settings: &ChainSettings) -> [Record; 2] {
    let pinion = ShaftPhase::from_pulses(pulses, 1, Some(PINION_HZ), RATE_HZ, signal.len()).unwrap();
    let gear = pinion.of_mate(PINION_TEETH, GEAR_TEETH).unwrap();
    [(&pinion, PINION_TEETH), (&gear, GEAR_TEETH)]
        .map(|(phase, teeth)| process_channel(signal, phase, teeth, settings).unwrap())
}

fn indicators(criterion: &mut Criterion) {
    let (signal, pulses) = (recording(), pulses());
    let mut group = criterion.benchmark_group("a channel of 60 s at 50 kS/s, both wheels");
    group.sample_size(10);
    for interpolation in [Interpolation::BandLimited, Interpolation::Pchip] {
        let angular = AngularSettings { interpolation, ..Default::default() };
        let settings = ChainSettings { angular, ..Default::default() };
        group.bench_function(format!("{interpolation:?}"), |bencher| {
            bencher.iter(|| both_wheels(black_box(&signal), black_box(&pulses), &settings));
        });
    }
    group.bench_function("phase from the mesh tone", |bencher| {
        let tone = MeshTone::new(PINION_TEETH, PINION_HZ);
        bencher.iter(|| ShaftPhase::from_mesh_tone(black_box(&signal), RATE_HZ, &tone).unwrap());
    });
    group.bench_function("kurtogram", |bencher| {
        bencher.iter(|| kurtogram(black_box(&signal), RATE_HZ, 7).unwrap());
    });
    group.finish();
}

criterion_group!(benches, indicators);
criterion_main!(benches);
