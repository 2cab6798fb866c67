//! Every stage alone, for a healthy pair and for the faults that change the teeth's stiffness.
#![allow(clippy::expect_used, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;

use std::hint::black_box;
use std::num::NonZeroUsize;

use criterion::{Criterion, criterion_group, criterion_main};
use meshtone::damage::damaged_teeth;
use meshtone::machine::{Modes, RigMachine, RigParts, Supports};
use meshtone::scenario::{Model, Scenario};
use meshtone::solver::{Block, Output, Recorder};
use meshtone::wheel::quality::profile_errors;
use meshtone::wheel::teeth;
use meshtone::{sensor::ChannelKind, stages};

/// Takes the samples as they come and keeps none.
struct Nothing;

impl Recorder for Nothing {
    fn record(&mut self, block: &Block) {
        black_box(block.output(0));
    }
}

fn before_the_time_loop(criterion: &mut Criterion, name: &str, scenario: &Scenario) {
    let mut group = criterion.benchmark_group(format!("stages/{name}"));
    let whole = stages(scenario).expect("an example is valid");
    let (gears, rig) = (&scenario.gears(), scenario.rig().expect("a pair"));
    let sound = &whole.pairs[0].teeth;
    group.bench_function("scenario", |bencher| bencher.iter(|| black_box(scenario).validate()));
    group.bench_function("tooth profiles", |bencher| {
        bencher.iter(|| teeth(black_box(gears), [rig.pinion_shaft.radius_mm, rig.gear_shaft.radius_mm]));
    });
    group.bench_function("profile errors", |bencher| {
        bencher.iter(|| profile_errors(&scenario.quality(), black_box(sound), scenario.seed));
    });
    if !scenario.faults.is_empty() {
        group.bench_function("fault", |bencher| {
            bencher.iter(|| damaged_teeth(&scenario.faults, black_box(sound), scenario.seed));
        });
    }
    let points = NonZeroUsize::new(whole.meshes[0].points_per_pitch).expect("a pitch has points");
    group.bench_function("mesh stiffness", |bencher| {
        bencher.iter(|| black_box(&whole).meshes_at(points));
    });
    group.bench_function("equations of motion, modes", |bencher| {
        bencher.iter(|| {
            let parts = RigParts {
                gears,
                rig,
                inertias: [&scenario.wheels[0].inertia, &scenario.wheels[1].inertia],
                unbalances: [&scenario.wheels[0].unbalance, &scenario.wheels[1].unbalance],
                brake_inertia_kgm2: scenario.operation.brake_inertia_kgm2,
                overruns: false,
            };
            let train = RigMachine::new(parts, black_box(sound), Supports::Held);
            Modes::damped_alike(&train.machine, 0.07)
        });
    });
    group.bench_function("all", |bencher| bencher.iter(|| stages(black_box(scenario))));
    group.finish();
}

fn time_loop(criterion: &mut Criterion, name: &str, scenario: &Scenario) {
    let stages = stages(scenario).expect("an example is valid");
    let outputs = ChannelKind::ALL.map(ChannelKind::output);
    let mut group = criterion.benchmark_group(format!("time loop/{name}"));
    group.sample_size(20);
    let mut with = |id: &str, outputs: &[Output], from: usize| {
        group.bench_function(id, |bencher| {
            bencher.iter(|| stages.integrate(outputs, from, &mut Nothing).expect("a solution"));
        });
    };
    with("no output but one", &outputs[..1], stages.time.samples - 1);
    with("six channels", &outputs, stages.time.first_kept_sample);
    group.finish();
}

fn all(criterion: &mut Criterion) {
    for (name, scenario) in cases::with_full_settling(Model::Linear) {
        before_the_time_loop(criterion, name, &scenario);
        time_loop(criterion, name, &scenario);
    }
    let published = cases::healthy(Model::Published);
    time_loop(criterion, "healthy, published", &published);
}

criterion_group!(benches, all);
criterion_main!(benches);
