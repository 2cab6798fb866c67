//! Many simulations, horizontal and vertical channel kept in single precision, with full settling: time of a simulation
//! is the reciprocal of the rate that is printed.
#![allow(clippy::expect_used, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use meshtone::batch::{Control, KeepChannels, simulate_many};
use meshtone::scenario::{Model, Scenario};

/// Scenarios that differ by their profile errors.
fn batch(of: &Scenario, count: u64) -> impl Iterator<Item = Scenario> + Send {
    let of = of.clone();
    (0..count).map(move |seed| {
        let mut scenario = of.clone();
        scenario.seed = seed;
        scenario
    })
}

fn run(criterion: &mut Criterion, name: &str, scenario: &Scenario, count: u64, threads: usize) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut group = criterion.benchmark_group(format!("batch/{name}"));
    group.sample_size(10).throughput(Throughput::Elements(count));
    group.bench_function(format!("{count} simulations, {threads} threads"), |bencher| {
        bencher.iter(|| {
            pool.install(|| {
                simulate_many(
                    batch(scenario, count),
                    &KeepChannels::default(),
                    &Control::default(),
                    |_, signals| {
                        black_box(signals.expect("an example is valid"));
                    },
                )
            })
        });
    });
    group.finish();
}

fn batches(criterion: &mut Criterion) {
    let healthy = cases::healthy(Model::Linear);
    for count in [1, 8, 64, 512] {
        run(criterion, "healthy", &healthy, count, 1);
    }
    for count in [64, 512] {
        run(criterion, "healthy", &healthy, count, 2);
    }
    for (name, scenario) in cases::with_full_settling(Model::Linear).into_iter().skip(1) {
        run(criterion, name, &scenario, 64, 1);
    }
    for (model, word) in [(Model::Published, "published"), (Model::Contact, "contact")] {
        for (name, scenario) in cases::with_full_settling(model) {
            run(criterion, &format!("{name}, {word}"), &scenario, 64, 1);
        }
    }
}

criterion_group!(benches, batches);
criterion_main!(benches);
