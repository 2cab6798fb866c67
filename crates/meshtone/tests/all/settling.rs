//! A simulation that starts in equilibrium and settles shortly keeps the signal of one that settles for long.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::scenario::*;
use meshtone::simulate;

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    values.map(|x| x * x).sum::<f64>().sqrt()
}

/// Rms of the difference over rms, of the vertical acceleration and of the mesh force.
fn differences(scenario: &Scenario, tolerance: f64) -> (usize, usize, [f64; 2]) {
    let with = |settle_tolerance| {
        let mut scenario = scenario.clone();
        scenario.solver.settle_tolerance = settle_tolerance;
        simulate(&scenario).unwrap()
    };
    let (long, short) = (with(0.0), with(tolerance));
    let (a, b) = (&long.channels, &short.channels);
    assert_eq!((a.len(), a.start_s, a.sampling_rate_hz), (b.len(), b.start_s, b.sampling_rate_hz));
    let of = |a: &[f64], b: &[f64]| rms(a.iter().zip(b).map(|(a, b)| a - b)) / rms(a.iter().copied());
    let time = &short.stages.time;
    (
        time.first_kept_sample,
        time.first_simulated_sample,
        [of(&a.vertical_g, &b.vertical_g), of(&a.mesh_force_n, &b.mesh_force_n)],
    )
}

#[test]
fn the_kept_signal_is_that_of_the_long_settling() {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.4 };
    for damage in [
        None,
        Some(Damage::MissingTooth(MissingTooth)),
        Some(Damage::ToothBreakage(ToothBreakage {
            chip_height_mm: 5.0,
            chip_width_mm: 12.0,
            tip_loss_mm: 0.0,
        })),
        Some(Damage::PartialFace(PartialFace { width_mm: 5.0, pit })),
        Some(Damage::ThroughFace(ThroughFace { pit })),
        Some(Damage::ToothDestruction(ToothDestruction {
            start: 0.2,
            line: DestructionLine::SlopeDeg(22.0),
            offset_mm: 0.0,
            noise_mm: 0.0,
        })),
    ] {
        let mut scenario = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
        scenario.model = Model::Linear;
        scenario.quality.din_grade = 7;
        scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
        for tolerance in [1e-3, 1e-6] {
            let (kept, start, differences) = differences(&scenario, tolerance);
            println!(
                "{} at {tolerance:e}: {} of {kept} samples of settling left out; vertical {:.1e}, force {:.1e}",
                scenario.faults.first().map_or("healthy", |fault| fault.damage.kind()),
                start,
                differences[0],
                differences[1]
            );
            assert!(start > 0);
            // The transient is never larger than the signal itself.
            assert!(differences.iter().all(|difference| *difference < tolerance));
        }
    }
}

#[test]
fn what_does_not_repeat_settles_for_long() {
    let mut steady = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
    steady.model = Model::Linear;
    let start = |change: &dyn Fn(&mut Scenario)| {
        let mut scenario = steady.clone();
        change(&mut scenario);
        meshtone::stages(&scenario).unwrap().time.first_simulated_sample
    };
    assert!(start(&|_| {}) > 0);
    assert_eq!(start(&|scenario| scenario.model = Model::Published), 0);
    assert_eq!(start(&|scenario| scenario.operation.torque_fluctuation_nm = 1.0), 0);
    assert_eq!(start(&|scenario| scenario.operation.speed_fluctuation_hz = 1.0), 0);
    assert_eq!(start(&|scenario| scenario.solver.initial_velocity = Some([0.0; 13])), 0);
    assert_eq!(start(&|scenario| scenario.rig.damping_ratio = DampingRatio::Uniform(0.0)), 0);
}
