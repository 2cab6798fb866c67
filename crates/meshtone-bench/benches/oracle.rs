//! A batch against the dense 13 × 13 solver, in one run, per simulation: prints the ratio.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::print_stdout, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;
#[path = "../../meshtone/tests/all/dense.rs"]
mod dense;

use std::hint::black_box;
use std::time::{Duration, Instant};

use dense::Dense;
use meshtone::batch::{Control, KeepChannels, simulate_many};
use meshtone::scenario::Model;
use meshtone::{simulate, stages};

const BATCH: u32 = 64;
const REPEATS: usize = 3;

/// The shortest of some runs: what the machine does otherwise only adds.
fn shortest(mut run: impl FnMut()) -> Duration {
    (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed()
        })
        .min()
        .unwrap_or_default()
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    println!("per simulation, one thread    dense        alone  ratio   in a batch of {BATCH}  ratio");
    for (name, scenario) in cases::with_full_settling(Model::Linear) {
        let dense = shortest(|| {
            let stages = stages(&scenario).expect("an example is valid");
            black_box(Dense::new(&stages).accelerations());
        });
        let alone = shortest(|| {
            black_box(simulate(&scenario)).expect("an example is valid");
        });
        let batch = shortest(|| {
            pool.install(|| {
                let scenarios = vec![scenario.clone(); BATCH as usize];
                simulate_many(scenarios, &KeepChannels::default(), &Control::default(), |_, signals| {
                    black_box(signals.expect("an example is valid"));
                });
            });
        }) / BATCH;
        let ratio = |time: Duration| dense.as_secs_f64() / time.as_secs_f64();
        println!(
            "{name:<24} {:>8.1} ms  {:>8.2} ms {:>5.0} ×  {:>16.2} ms {:>5.0} ×",
            dense.as_secs_f64() * 1e3,
            alone.as_secs_f64() * 1e3,
            ratio(alone),
            batch.as_secs_f64() * 1e3,
            ratio(batch)
        );
    }
}
