//! Every stage alone, for a healthy pair and for the faults that change the teeth's stiffness.
#![allow(clippy::expect_used, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use meshtone::dynamics::{MeshLoad, System};
use meshtone::fault::fault_geometry;
use meshtone::quality::profile_errors;
use meshtone::scenario::{Convention, Scenario};
use meshtone::solver::{Block, Output, Recorder};
use meshtone::stiffness::{MeshStiffness, PairStiffness};
use meshtone::tooth::teeth;
use meshtone::{signal::channel_outputs, stages};

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
    let (gears, convention, cycle) = (&scenario.gears, scenario.convention, &whole.cycle);
    let fault = whole.fault.as_ref();
    group.bench_function("scenario", |bencher| bencher.iter(|| black_box(scenario).validate()));
    group.bench_function("tooth profiles", |bencher| {
        bencher.iter(|| teeth(black_box(gears), &scenario.rig, convention));
    });
    group.bench_function("profile errors", |bencher| {
        bencher.iter(|| profile_errors(&scenario.quality, black_box(&whole.teeth), scenario.seed));
    });
    if let Some(fault) = &scenario.fault {
        group.bench_function("fault", |bencher| {
            bencher.iter(|| fault_geometry(fault, black_box(&whole.teeth), convention, scenario.seed));
        });
    }
    group.bench_function("pair stiffness", |bencher| {
        bencher.iter(|| PairStiffness::new(gears, black_box(&whole.teeth), fault));
    });
    group.bench_function("mesh stiffness", |bencher| {
        bencher.iter(|| MeshStiffness::new(black_box(&whole.pair), cycle, convention));
    });
    let angle = whole.teeth.gear.pressure_angle_rad;
    group.bench_function("equations of motion", |bencher| {
        bencher.iter(|| {
            let load =
                MeshLoad::new(black_box(&whole.mesh), fault, cycle, gears.face_width_mm, angle, convention);
            System::new(scenario, &whole.teeth, load)
        });
    });
    group.bench_function("modes", |bencher| bencher.iter(|| black_box(&whole).reduced_model()));
    group.bench_function("all", |bencher| bencher.iter(|| stages(black_box(scenario))));
    group.finish();
}

fn time_loop(criterion: &mut Criterion, name: &str, scenario: &Scenario) {
    let stages = stages(scenario).expect("an example is valid");
    let (model, outputs) = (stages.reduced_model(), channel_outputs());
    let mut group = criterion.benchmark_group(format!("time loop/{name}"));
    group.sample_size(20);
    let mut with = |id: &str, outputs: &[Output], from: usize| {
        group.bench_function(id, |bencher| {
            bencher.iter(|| stages.integrate(&model, outputs, from, &mut Nothing).expect("a solution"));
        });
    };
    with("no output but one", &outputs[..1], stages.time.samples - 1);
    with("six channels", &outputs, stages.time.first_kept_sample);
    group.finish();
}

fn all(criterion: &mut Criterion) {
    for (name, scenario) in cases::with_full_settling(Convention::Corrected) {
        before_the_time_loop(criterion, name, &scenario);
        time_loop(criterion, name, &scenario);
    }
    let published = cases::healthy(Convention::Published);
    time_loop(criterion, "healthy, published", &published);
}

criterion_group!(benches, all);
criterion_main!(benches);
