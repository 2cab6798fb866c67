//! Alone and in a batch against a dense 13 × 13 solver, as fast as careful work makes one, in one run, per simulation: prints the ratios.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::panic, clippy::print_stdout, missing_docs)]

#[path = "cases/mod.rs"]
mod cases;
#[path = "solvers/newmark.rs"]
mod newmark;

use std::hint::black_box;
use std::time::{Duration, Instant};

use meshtone::batch::{Control, KeepChannels, simulate_many};
use meshtone::scenario::{Model, Scenario};
use meshtone::sensor::ChannelKind;
use meshtone::{simulate, stages};
use newmark::Newmark;

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

/// Rms of the dense solver's difference to the library, over the signal's rms; the largest of the three directions.
fn difference(scenario: &Scenario) -> f64 {
    let stages = stages(scenario).expect("an example is valid");
    let dense = Newmark::new(&stages).signals();
    let simulation = simulate(scenario).expect("an example is valid");
    let differences = ChannelKind::ACCELERATIONS.iter().zip(&dense).map(|(kind, dense)| {
        let signal = simulation.channels.of(kind.source());
        assert_eq!(signal.len(), dense.len());
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>();
        let power = square(&mut signal.iter().copied());
        // What does not move has no scale.
        let error = square(&mut signal.iter().zip(dense).map(|(one, other)| one - other));
        if power > 0.0 { (error / power).sqrt() } else { error.sqrt() }
    });
    differences.fold(0.0, f64::max)
}

fn main() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    println!(
        "per simulation, one thread\n{:<18} {:>9} {:>10}   {:>9} {:>7}   {:>14} {:>7}",
        "", "dense", "difference", "alone", "dense", "batch of 64", "dense"
    );
    for (name, scenario) in cases::with_full_settling(Model::Linear) {
        let dense = shortest(|| {
            let stages = stages(&scenario).expect("an example is valid");
            black_box(Newmark::new(&stages).signals());
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
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        let ratio = |time: Duration| dense.as_secs_f64() / time.as_secs_f64();
        println!(
            "{name:<18} {:>6.1} ms {:>10.1e}   {:>6.1} ms {:>5.1} ×   {:>11.2} ms {:>5.1} ×",
            ms(dense),
            difference(&scenario),
            ms(alone),
            ratio(alone),
            ms(batch),
            ratio(batch)
        );
    }
}
