//! Two stages of spur gears, 100 kS/s, 1 s kept and all of it simulated: alone, and of many, in one thread, both with all warnings, as a
//! user gets them. The time is that of the processor, which a busy machine does not disturb; Linux tells it.
#![allow(clippy::expect_used, missing_docs)]

use std::hint::black_box;
use std::time::Duration;

use criterion::measurement::{Measurement, ValueFormatter, WallTime};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use meshtone::batch::{Control, KeepOf, simulate_many};
use meshtone::scenario::{BearingKind, Scenario, gearbox_template};
use meshtone::{Simulation, StepJudgement, stages};

/// Time that this thread had the processor.
struct ProcessorTime(WallTime);

impl Measurement for ProcessorTime {
    type Intermediate = Duration;
    type Value = Duration;

    fn start(&self) -> Duration {
        let times = std::fs::read_to_string("/proc/thread-self/schedstat").expect("Linux");
        let first = times.split_whitespace().next().and_then(|nanoseconds| nanoseconds.parse().ok());
        Duration::from_nanos(first.expect("the first is the time on the processor"))
    }

    fn end(&self, start: Duration) -> Duration {
        self.start() - start
    }

    fn add(&self, a: &Duration, b: &Duration) -> Duration {
        *a + *b
    }

    fn zero(&self) -> Duration {
        Duration::ZERO
    }

    fn to_f64(&self, value: &Duration) -> f64 {
        self.0.to_f64(value)
    }

    fn formatter(&self) -> &dyn ValueFormatter {
        self.0.formatter()
    }
}

/// The example of `meshtone init gearbox` with a sensor on every seat.
fn two_stages(seed: u64) -> Scenario {
    let mut gearbox = Scenario::from_toml(&gearbox_template(None)).expect("the template is valid");
    gearbox.seed = seed;
    gearbox.sensors.clear();
    gearbox.solver.settle_fraction = 0.0;
    gearbox
}

/// Number of the warnings that a user gets.
fn warnings(simulation: &Simulation, judgement: StepJudgement) -> usize {
    simulation.stages.warnings().len() + simulation.warnings_of_signals(judgement).len()
}

fn gearboxes(criterion: &mut Criterion<ProcessorTime>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().expect("a thread");
    let mut group = criterion.benchmark_group("gearbox/two stages");
    group.sample_size(10);
    let gearbox = two_stages(1);
    group.bench_function("stages", |bencher| bencher.iter(|| stages(black_box(&gearbox))));
    let made = stages(&gearbox).expect("the template is valid");
    group.bench_function("time loop", |bencher| bencher.iter(|| black_box(&made).clone().simulate()));
    let mut with_ball_bearing = gearbox.clone();
    with_ball_bearing.bearings_mut()[0].kind = BearingKind::Ball;
    with_ball_bearing.bearings_mut()[0].name = Some("ER-10K".to_owned());
    let with_ball_bearing = stages(&with_ball_bearing).expect("the bearing is valid");
    group.bench_function("time loop, one ball bearing", |bencher| {
        bencher.iter(|| black_box(&with_ball_bearing).clone().simulate());
    });
    group.bench_function("alone", |bencher| {
        bencher.iter(|| {
            let simulation = meshtone::simulate(black_box(&gearbox)).expect("the template is valid");
            warnings(&simulation, StepJudgement::Repeated)
        });
    });
    let many: Vec<Scenario> = (1..=16).map(two_stages).collect();
    group.throughput(Throughput::Elements(many.len() as u64));
    group.bench_function("16 simulations, 1 thread", |bencher| {
        bencher.iter(|| {
            pool.install(|| {
                let keep = KeepOf(|_: usize, simulation: Simulation| {
                    warnings(&simulation, StepJudgement::Estimated)
                });
                let mut kept = Vec::with_capacity(many.len());
                simulate_many(many.clone(), &keep, &Control::default(), |_, of| kept.push(of));
                kept
            })
        });
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(ProcessorTime(WallTime));
    targets = gearboxes
}
criterion_main!(benches);
