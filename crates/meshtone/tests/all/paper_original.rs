//! The paper's own simulation, before tuning: the indicators of its Figure 6, series `original`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::paper_rigs;
use meshtone::scenario::*;
use meshtone::tuning::{DifferenceChain, SimulatedCases, TuningIndicator, difference_signals};

/// The cases whose fault dominates, with their severity.
fn dominating(name: &str) -> Vec<(usize, Fault)> {
    let first = match name {
        "breakage" => 4,
        "pitting" => 1,
        _ => 3,
    };
    let faults = paper_rigs::cases(name).into_iter().enumerate().skip(first);
    faults.filter_map(|(severity, faults)| Some((severity, faults.into_iter().next()?))).collect()
}

fn original(name: &str, indicator: TuningIndicator, severity: usize) -> f64 {
    paper_rigs::values(name, indicator, "original", severity)[0]
}

/// Compares the mean of so many draws of the wheels' profile errors with the paper, which shows a single one. One draw scatters by up to 0.08.
fn assert_near_the_paper(draws: u64) {
    let indicators = [TuningIndicator::Rms, TuningIndicator::Kurtosis];
    for name in ["breakage", "pitting", "destruction"] {
        let (base, rate_hz) = paper_rigs::rig(name, Model::Published);
        let cases = dominating(name);
        // All draws in one call, so that simulations of one kind run side by side.
        let scenarios = (1..=draws).flat_map(|seed| {
            let base = base.clone().with_seed(seed);
            let faulty = cases.iter().map(|(_, fault)| vec![fault.clone()]);
            let faults = std::iter::once(Vec::new()).chain(faulty).collect::<Vec<_>>();
            faults.into_iter().map(move |faults| base.clone().with_faults(faults))
        });
        let signals = difference_signals(scenarios.collect(), &DifferenceChain::new(rate_hz)).unwrap();
        let mut sums = vec![[0.0; 2]; cases.len()];
        for of_draw in signals.chunks_exact(1 + cases.len()) {
            let simulated = SimulatedCases::new(of_draw.to_vec()).unwrap();
            let values = simulated.predict(&indicators, &meshtone::tuning::Enhancement::default()).unwrap();
            for (sum, value) in sums.iter_mut().zip(&values[1..]) {
                (0..2).for_each(|j| sum[j] += value[j] / draws as f64);
            }
        }
        for ((severity, _), means) in cases.iter().zip(&sums) {
            for (j, &indicator) in indicators.iter().enumerate() {
                let paper = original(name, indicator, *severity);
                println!(
                    "{name} F{severity} log10 {}: {:.3}, the paper {paper:.3}",
                    indicator.name(),
                    means[j]
                );
                assert!((means[j] - paper).abs() < 0.15, "{name} F{severity} {}", indicator.name());
            }
        }
    }
}

/// One draw, which is off by up to 0.08 itself; the mean of the measurement below is off by 0.01.
#[test]
fn the_paper_s_original_indicators_where_the_fault_dominates() {
    assert_near_the_paper(1);
}

/// Prints the book's table.
#[test]
#[ignore = "a measurement: cargo xtask measure"]
fn the_paper_s_original_indicators_of_many_draws() {
    assert_near_the_paper(64);
}
