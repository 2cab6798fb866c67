//! Simulates one pair of wheels with many draws of profile errors, with progress, and prints the kurtosis of the first few.
//!
//! ```text
//! cargo run --release -p meshtone --example many_simulations -- 512
//! ```
#![allow(clippy::print_stdout, clippy::print_stderr)]

use std::error::Error;
use std::time::Instant;

use meshtone::batch::{Control, KeepChannels, simulate_many};
use meshtone::scenario::Scenario;

/// Fourth moment over the second one squared: 3 for Gaussian noise.
fn kurtosis(signal: &[f32]) -> f64 {
    let mean = signal.iter().map(|&x| f64::from(x)).sum::<f64>() / signal.len() as f64;
    let moment =
        |k: i32| signal.iter().map(|&x| (f64::from(x) - mean).powi(k)).sum::<f64>() / signal.len() as f64;
    moment(4) / moment(2).powi(2)
}

fn main() -> Result<(), Box<dyn Error>> {
    let count: u64 = std::env::args().nth(1).map_or(Ok(64), |count| count.parse())?;
    let text = include_str!("../../../examples/healthy.toml");
    let base = Scenario::from_toml(text)?;
    let scenarios = (0..count).map(|seed| base.clone().with_seed(seed));

    let start = Instant::now();
    let progress = |finished: usize| eprint!("\r{finished} of {count}");
    let control = Control { progress: &progress, ..Control::default() };
    let mut first = Vec::new();
    // Vertical and horizontal acceleration, 32 bits a sample; called with the results in order, as they finish.
    simulate_many(scenarios, &KeepChannels::default(), &control, |index, signals| match signals {
        Ok(signals) if index < 5 => first.push(kurtosis(&signals.channels[1])),
        Ok(_) => {}
        Err(error) => eprintln!("\nscenario {index}: {error}"),
    });
    let seconds = start.elapsed().as_secs_f64();
    eprintln!();
    println!("{count} simulations in {seconds:.2} s: {:.0} a second", count as f64 / seconds);
    println!("kurtosis of the vertical acceleration: {first:.3?}");
    Ok(())
}
