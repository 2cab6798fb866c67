//! Times as files have them, and the rates that follow from them.

use super::super::error::Problem;
use super::{Timing, timing};

fn of(times: &[f64]) -> Result<Timing, String> {
    timing("time", times, 1.0).map_err(|problem| match problem {
        Problem::Refused(problem) => problem,
        other => format!("{other:?}"),
    })
}

fn rounded(count: usize, rate_hz: f64, start_s: f64, decimals: i32) -> Vec<f64> {
    let scale = 10_f64.powi(decimals);
    (0..count).map(|i| ((start_s + i as f64 / rate_hz) * scale).round() / scale).collect()
}

#[test]
fn rounded_times_tell_the_rate() {
    for rate_hz in [50_000.0, 25_600.0, 51_200.0, 48_000.0, 44_100.0, 12_345.6, 258_400.0] {
        for decimals in [4, 5, 6, 7, 9, 12] {
            for start_s in [0.0, -3.0, 17.123_456] {
                let timing = of(&rounded(200_000, rate_hz, start_s, decimals)).unwrap();
                let error = (timing.rate_hz / rate_hz - 1.0).abs();
                assert!(error <= timing.uncertainty.max(1e-12), "{rate_hz} {decimals} {start_s}: {timing:?}");
            }
        }
    }
    assert_eq!(of(&rounded(100_000, 50_000.0, 0.0, 4)).unwrap().rate_hz, 50_000.0);
    assert_eq!(of(&rounded(200_000, 25_600.0, 0.0, 6)).unwrap().rate_hz, 25_600.0);
}

#[test]
fn exact_and_single_precision_times_tell_the_rate() {
    let exact: Vec<f64> = (0..100_000).map(|i| 0.95 + f64::from(i) / 258_400.0).collect();
    assert_eq!(of(&exact).unwrap().rate_hz, 258_400.0);
    let single: Vec<f64> = (0..100_000).map(|i| f64::from((f64::from(i) / 10_000.0) as f32)).collect();
    assert_eq!(of(&single).unwrap().rate_hz, 10_000.0);
    let since_1970: Vec<f64> = (0..100_000).map(|i| 1.7e9 + f64::from(i) / 1000.0).collect();
    assert_eq!(of(&since_1970).unwrap().rate_hz, 1000.0);
    assert_eq!(of(&[0.0, 1.0]).unwrap().rate_hz, 1.0);
}

#[test]
fn a_drifting_clock_is_uniform() {
    for count in [60_000, 130_000, 300_000] {
        let times = rounded(count, 1.0 / 20.0002e-6, 0.0, 6);
        assert!((of(&times).unwrap().rate_hz * 20.0002e-6 - 1.0).abs() < 2e-6);
    }
}

#[test]
fn one_missing_sample_is_found() {
    for (rate_hz, decimals) in
        [(50_000.0, 5), (50_000.0, 6), (1.0, 0), (100.0, 2), (25_600.0, 6), (10_000.0, 9)]
    {
        for missing in [1, 500, 9_998] {
            let mut times = rounded(10_000, rate_hz, 0.0, decimals);
            times.remove(missing);
            let error = of(&times).unwrap_err();
            let words = format!("is not uniform: from sample {missing} to the next");
            assert!(error.contains(&words), "{rate_hz} {decimals} {missing}: {error}");
        }
    }
}

#[test]
fn a_gap_among_coarsely_rounded_times_is_found() {
    let mut times = rounded(100_000, 50_000.0, 0.0, 4);
    times.drain(50_000..50_010);
    assert!(of(&times).unwrap_err().contains("is not uniform"));
}

#[test]
fn times_that_tell_no_rate_are_refused() {
    let message = |times: &[f64]| of(times).unwrap_err();
    assert!(message(&[1.0]).contains("one sample only"));
    assert!(message(&[1.0, 1.0]).contains("stays at 1 s"));
    assert!(message(&[0.0, 1.0, 0.5]).contains("goes back from 1 s to 0.5 s at sample 3"));
    assert!(
        message(&[0.0, 0.0, 0.1, 0.1, 0.1]).contains("is rounded to 0.1 s"),
        "{}",
        message(&[0.0, 0.0, 0.1, 0.1, 0.1])
    );
}
