//! The published averages, differences and order spectra of the gear's vertical signal.
//!
//! The published fields were made under GNU Octave, and their numbers are those of a resampling filter with the single tap
//! 10: ten times every q-th sample, p − 1 zeros between, no low-pass. That is what Octave's `resample(x, p, q, 10)` does,
//! which takes the fourth argument for the filter itself, where MATLAB takes it for half the filter's length. So as averages of
//! the signal they say little, but with the same single tap the chain must give the same numbers, which checks angular
//! resampling by PCHIP, averaging, separation and spectrum. With the filter that was meant, it must give the orders that
//! the simulated signal really holds.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::published_model::{for_each_scenario, reference, scenario};
use crate::signal::{largest_difference, relative_rms};
use meshtone::signal::*;
use meshtone::{simulate, trace_at};

/// Relative rms; the signals themselves agree to 5e-7 (partial face 1e-5).
const TOLERANCE: f64 = 1e-5;

fn check(name: &str) {
    let reference = reference(name);
    let field = |name: &str| reference[name].iter().copied().collect::<Vec<f64>>();
    let rate_hz = field("sa_rate_in_hz")[0];
    let scenario = scenario(name, &reference);
    let (simulation, trace) = trace_at(&scenario, rate_hz).unwrap();
    let channels = &simulation.channels;
    let gears = &scenario.gears();
    let gear_hz =
        scenario.operation.pinion_speed_hz * f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth);

    // The published chain, with Octave's filter.
    let (up, down) = resampling_ratio(channels.sampling_rate_hz, rate_hz).unwrap();
    let resampled = resample_with(&channels["vertical_g"], up, down, &[10.0], Edge::Zero).unwrap();
    let phase = ShaftPhase::constant(gear_hz, rate_hz, resampled.len()).unwrap();
    let angular =
        AngularSettings { interpolation: Interpolation::Pchip, edge: Edge::Zero, ..Default::default() };
    let settings = ChainSettings { angular, ..Default::default() };
    let record = process_channel(&resampled, &phase, gears.gear_teeth, &settings).unwrap();
    let mut amplitude = record.order_spectrum.clone();
    amplitude[0] *= 2.0;
    let theirs = field("order_amplitude_g");
    amplitude.truncate(theirs.len());
    let deviations = [
        relative_rms(&record.average.values, &field("synchronous_average_g")),
        relative_rms(&record.parts.difference, &field("difference_g")),
        relative_rms(&amplitude, &theirs),
    ];
    println!("{name}: average, difference, orders off by {deviations:?}");
    assert!(deviations.iter().all(|&deviation| deviation < TOLERANCE), "{name}: {deviations:?}");

    // What was meant: the trace's fields are the low orders of the kept signal itself, whose samples are whole revolutions.
    let per_revolution = (channels.sampling_rate_hz / gear_hz).round() as usize;
    let exact = order_spectrum(&revolution_average(&channels["vertical_g"], per_revolution)).unwrap();
    let ours = &trace.get("order_amplitude_g").unwrap().values;
    let largest = exact.iter().copied().fold(0.0, f64::max);
    let nyquist = ours.len() as f64;
    let within = |part: f64| {
        let orders = (part * nyquist) as usize;
        largest_difference(&exact[1..orders], &ours[1..orders]) / largest
    };
    println!(
        "{name}: orders of the trace off by {:.1e} up to a tenth of the rate, {:.1e} up to a quarter",
        within(0.2),
        within(0.5)
    );
    assert!(within(0.2) < 0.02, "{name}: {}", within(0.2));
    assert_eq!(trace.get("sa_rate_in_hz").unwrap().values, [rate_hz]);
}

for_each_scenario!(check);

// With band-limited interpolation the average keeps what the resampling filter lets through.
#[test]
fn band_limited_interpolation_keeps_the_orders() {
    let reference = reference("healthy_din7");
    let scenario = scenario("healthy_din7", &reference);
    let channels = simulate(&scenario).unwrap().channels;
    let exact = order_spectrum(&revolution_average(&channels["vertical_g"], 14_440)).unwrap();
    let resampled = resample(&channels["vertical_g"], 125, 1292, Edge::Periodic).unwrap();
    assert_eq!(resampled.len(), 23_750);
    let phase = ShaftPhase::constant(40.0 * 17.0 / 38.0, 25e3, resampled.len()).unwrap();
    let largest = exact[..698].iter().copied().fold(0.0, f64::max);
    for (interpolation, orders, tolerance) in
        [(Interpolation::BandLimited, 558, 2e-3), (Interpolation::Pchip, 139, 2e-2)]
    {
        let angular = AngularSettings { interpolation, edge: Edge::Periodic, ..Default::default() };
        let angular = angular_resample(&resampled, &phase, &angular).unwrap();
        assert_eq!((angular.revolutions(), angular.points_per_revolution), (17, 2048));
        let average = synchronous_average(&angular).unwrap();
        let ours = order_spectrum(&average.values).unwrap();
        let off = largest_difference(&ours[..orders], &exact[..orders]) / largest;
        println!("{interpolation:?}: {off:.1e} up to order {orders} of 698");
        assert!(off < tolerance, "{interpolation:?}: {off}");
    }
}
