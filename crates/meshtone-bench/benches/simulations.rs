//! One simulation of each fault: scenario in, signals out, in one thread, with full settling (490 960 steps).
#![allow(missing_docs)]

#[path = "cases/mod.rs"]
mod cases;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use meshtone::scenario::Model;
use meshtone::simulate;

fn simulations(criterion: &mut Criterion) {
    for model in [Model::Linear, Model::Published, Model::Contact] {
        let mut group = criterion.benchmark_group(format!("simulation/{model:?}").to_lowercase());
        group.sample_size(20);
        for (name, mut scenario) in cases::with_full_settling(model) {
            group.bench_function(name, |bencher| bencher.iter(|| simulate(black_box(&scenario))));
            if model == Model::Linear {
                scenario.solver.settle_tolerance = 1e-6;
                group.bench_function(format!("{name}, settled to 1e-6"), |bencher| {
                    bencher.iter(|| simulate(black_box(&scenario)));
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, simulations);
criterion_main!(benches);
