//! Many simulations: the same bits as alone, in order, each with its own error.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use meshtone::InstructionSet;
use meshtone::batch::{Control, KeepChannels, KeepObserved, KeepSimulation, SteppedAlone, simulate_many};
use meshtone::scenario::*;
use meshtone::sensor::{ChannelKind, Channels, NamedSignal};
use meshtone::{simulate, stages};

fn small(pinion: u32, gear: u32, damage: Option<Damage>) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: pinion,
        gear_teeth: gear,
        pinion_speed_hz: 30.0,
        brake_torque_nm: 60.0,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    scenario.meshes[0].points_per_tooth = 1000;
    scenario.solver.sampling_rate_hz = 1e4;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 6);
    scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
    scenario
}

fn damages() -> Vec<Option<Damage>> {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.4 };
    vec![
        None,
        Some(MissingTooth.into()),
        Some(Damage::ToothBreakage(ToothBreakage {
            chip_height_mm: 3.0,
            chip_width_mm: 9.0,
            tip_loss_mm: 0.0,
        })),
        Some(Damage::PartialFace(PartialFace { width_mm: 5.0, pit })),
        Some(Damage::ThroughFace(ThroughFace { pit })),
        Some(Damage::ToothDestruction(ToothDestruction {
            start: 0.2,
            line: DestructionLine::SlopeDeg(22.0),
            offset_mm: 0.0,
            noise_mm: 0.02,
        })),
    ]
}

/// (m/s, rad/s) A velocity at the start that is not that of the rigid rotation in any coordinate.
fn pushed(scenario: &Scenario) -> [f64; 13] {
    let turns = std::f64::consts::TAU * scenario.operation.pinion_speed_hz;
    let slower = -turns * f64::from(scenario.wheels[0].teeth) / f64::from(scenario.wheels[1].teeth);
    let rigid = [0.0, 0.0, 0.0, 0.0, slower, turns, slower, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    std::array::from_fn(|c| rigid[c] + 1e-3 * (c + 1) as f64)
}

/// Everything that may be mixed: faults, teeth, lengths, models, drives, initial states, and one that is refused.
fn mixed() -> Vec<Scenario> {
    let mut scenarios = Vec::new();
    for (n, damage) in damages().into_iter().enumerate() {
        for (k, (pinion, gear)) in [(17, 38), (20, 20), (18, 27)].into_iter().enumerate() {
            let mut scenario = small(pinion, gear, damage.clone());
            scenario.seed = (10 * n + k) as u64;
            scenario.operation.pinion_speed_hz = 20.0 + 7.0 * n as f64 + k as f64;
            scenario.solver.settle_tolerance = if k == 1 { 0.0 } else { 1e-6 };
            if k == 2 && n % 2 == 0 {
                scenario.model = Model::Published;
            }
            if k == 1 && n == 3 {
                scenario.operation.speed_fluctuation_hz = 0.2;
            }
            if k == 0 && n == 4 {
                scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.01);
            }
            if k == 1 && n == 5 {
                scenario.solver.initial_velocity = Some(pushed(&scenario));
            }
            scenarios.push(scenario);
        }
    }
    let mut refused = small(17, 38, None);
    refused.meshes[0].module_mm = -1.0;
    scenarios.insert(5, refused);
    scenarios
}

/// Under `contact`: faults that tilt the wheels and such that do not, light loads under which teeth let go and coast flanks touch,
/// drives that are not steady, initial states, and one that is refused.
fn mixed_in_contact() -> Vec<Scenario> {
    let mut scenarios: Vec<Scenario> = mixed()
        .into_iter()
        .enumerate()
        .map(|(n, mut scenario)| {
            scenario.model = Model::Contact;
            match n % 4 {
                1 => scenario.operation.brake_torque_nm = 2.0,
                3 => scenario.operation.brake_torque_nm = 600.0,
                _ => {}
            }
            scenario
        })
        .collect();
    // More than one group of drives that are not steady.
    for (n, damage) in damages().into_iter().chain(damages()).enumerate() {
        let mut scenario = small(17, 38, damage);
        scenario.model = Model::Contact;
        scenario.seed = 100 + n as u64;
        match n % 3 {
            0 => scenario.operation.speed_fluctuation_hz = 0.3,
            1 => scenario.operation.torque_fluctuation_nm = 5.0,
            _ => {
                scenario.solver.initial_velocity = Some(pushed(&scenario));
            }
        }
        scenarios.push(scenario);
    }
    scenarios
}

/// What has more modes than spur wheels alone, or is stepped alone: unbalanced wheels, helical ones, both, and such with sliced faces; with
/// steady and other drives, and one that is refused.
fn mixed_in_space() -> Vec<Scenario> {
    let mut scenarios = Vec::new();
    for (n, helix_angle_deg) in [0.0, 8.0, 20.0, 30.0].into_iter().enumerate() {
        let three = [None, Some(MissingTooth.into()), damages().swap_remove(2)];
        for (k, damage) in three.into_iter().enumerate() {
            for unbalances in 0..3 {
                let mut scenario = small(20, 30 + n as u32, damage.clone());
                scenario.seed = (100 * n + 10 * k + unbalances) as u64;
                scenario.model = if k == 1 && n == 2 { Model::Linear } else { Model::Contact };
                scenario.meshes[0].helix_angle_deg = helix_angle_deg;
                scenario.wheels.iter_mut().for_each(|wheel| wheel.face_width_mm = [15.0, 30.0, 60.0][k]);
                if k == 2 {
                    // Slices take long.
                    scenario.solver.pinion_revolutions = Some(8.0);
                }
                if unbalances > 0 {
                    scenario.wheels[1].unbalance = Unbalance { g_mm: 80.0, angle_deg: 20.0 };
                }
                if unbalances > 1 {
                    scenario.wheels[0].unbalance = Unbalance { g_mm: 30.0, angle_deg: -70.0 };
                    scenario.rig_mut().unwrap().pinion_shaft.wheel_at = 0.3;
                    scenario.operation.speed_fluctuation_hz = if k == 1 { 0.3 } else { 0.0 };
                }
                scenarios.push(scenario);
            }
        }
    }
    // So narrow that its thrust hardly tilts the wheels, with many teeth.
    let mut wide = small(40, 60, None);
    wide.model = Model::Contact;
    (wide.meshes[0].helix_angle_deg, wide.meshes[0].module_mm) = (30.0, wide.meshes[0].module_mm / 2.0);
    wide.wheels.iter_mut().for_each(|wheel| wheel.face_width_mm = 30.0);
    scenarios.push(wide);
    let mut refused = small(17, 38, None);
    refused.meshes[0].module_mm = -1.0;
    scenarios.push(refused);
    scenarios
}

/// An order that depends on `seed` alone.
fn shuffled<T>(mut items: Vec<T>, seed: u64) -> Vec<T> {
    let mut state = seed;
    for i in (1..items.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        items.swap(i, (state >> 33) as usize % (i + 1));
    }
    items
}

fn bits(channels: &Channels) -> Vec<Vec<u64>> {
    let of = |signal: &NamedSignal| signal.values.iter().map(|value| value.to_bits()).collect();
    channels.signals.iter().map(of).collect()
}

fn in_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

fn all(scenarios: &[Scenario], control: &Control) -> Vec<Result<Channels, meshtone::Error>> {
    let mut results = Vec::new();
    let handed_out = simulate_many(scenarios.to_vec(), &KeepSimulation, control, |index, result| {
        assert_eq!(index, results.len());
        results.push(result.map(|simulation| simulation.channels));
    });
    assert_eq!(handed_out, scenarios.len());
    results
}

/// Expects the bits of each alone in other orders and numbers of threads.
fn expect_the_same_bits(scenarios: Vec<Scenario>) {
    let alone: Vec<_> = scenarios.iter().map(simulate).collect();
    assert_eq!(alone.iter().filter(|result| result.is_err()).count(), 1);
    let places: Vec<usize> = (0..scenarios.len()).collect();
    for round in 0..3 {
        let places = shuffled(places.clone(), round);
        let in_order: Vec<Scenario> = places.iter().map(|&place| scenarios[place].clone()).collect();
        let batch = in_threads(1 + round as usize, || all(&in_order, &Control::default()));
        for (&place, batch) in places.iter().zip(&batch) {
            match (&alone[place], batch) {
                (Ok(alone), Ok(batch)) => {
                    assert!(alone.channels.len() > 1000);
                    assert!(bits(&alone.channels) == bits(batch), "{}", scenarios[place].to_toml());
                }
                (alone, batch) => assert_eq!(alone.as_ref().err(), batch.as_ref().err()),
            }
        }
    }
}

#[test]
fn the_same_bits_alone_in_any_lane_and_any_thread() {
    expect_the_same_bits(mixed());
}

#[test]
fn the_same_bits_alone_in_any_lane_and_any_thread_in_contact() {
    expect_the_same_bits(mixed_in_contact());
}

#[test]
fn the_same_bits_alone_in_any_lane_and_any_thread_with_unbalance_and_helical_teeth() {
    let scenarios = mixed_in_space();
    let is_side_by_side =
        |scenario: &&Scenario| stages(*scenario).is_ok_and(|stages| stages.stepped_alone().is_none());
    // All but nine chipped helical pairs, whose faces are cut into slices, and five whose load is so uneven that their wheels tilt.
    assert_eq!(scenarios.iter().filter(is_side_by_side).count(), 23);
    expect_the_same_bits(scenarios);
}

/// What cannot be stepped side by side says why, by itself and in a batch.
#[test]
fn what_is_stepped_alone_has_a_reason() {
    let reason = |scenario: &Scenario| stages(scenario).unwrap().stepped_alone();
    let mut unbalanced = small(20, 40, None);
    unbalanced.model = Model::Contact;
    unbalanced.wheels[0].unbalance.g_mm = 1e-9;
    let mut helical = unbalanced.clone();
    helical.meshes[0].helix_angle_deg = 20.0;
    let mut published = small(20, 40, None);
    published.model = Model::Published;
    let mut crowned = helical.clone();
    crowned.meshes[0].lead_crowning_um = 3.0;
    let mut wide = helical.clone();
    wide.meshes[0].helix_angle_deg = 30.0;
    wide.wheels.iter_mut().for_each(|wheel| wheel.face_width_mm = 120.0);
    let scenarios = [unbalanced, helical, published, crowned, wide];
    let expected = [
        None,
        None,
        Some(SteppedAlone::PublishedModel),
        Some(SteppedAlone::SlicedFace),
        Some(SteppedAlone::ManyPairs),
    ];
    assert_eq!(scenarios.each_ref().map(reason), expected);
    let mut told = Vec::new();
    let keep = KeepObserved::new([ChannelKind::Vertical]);
    simulate_many(scenarios, &keep, &Control::default(), |_, observed| {
        told.push(observed.unwrap().observation.stepped_alone);
    });
    assert_eq!(told, expected);
}

/// Without fused multiply-add the products round apart, and teeth that let go make a motion of which that is seen.
#[test]
fn every_instruction_set_with_fused_multiply_add_gives_the_same_bits_in_contact() {
    let scenarios = mixed_in_contact();
    let mut fused = InstructionSet::available();
    fused.retain(|&instructions| instructions != InstructionSet::Plain);
    let mut results = fused.iter().map(|&instructions| {
        let results = all(&scenarios, &Control { instructions, ..Control::default() });
        results.iter().map(|result| result.as_ref().ok().map(bits)).collect::<Vec<_>>()
    });
    let first = results.next();
    assert!(results.all(|next| first.as_ref() == Some(&next)));
}

#[test]
fn every_instruction_set_gives_the_same() {
    let scenarios: Vec<Scenario> = mixed();
    let with = |instructions| all(&scenarios, &Control { instructions, ..Control::default() });
    let reference = with(InstructionSet::Plain);
    let mut fused = None;
    for instructions in InstructionSet::available() {
        println!("{instructions:?}");
        let results = with(instructions);
        for (result, reference) in results.iter().zip(&reference) {
            let (Ok(result), Ok(reference)) = (result, reference) else {
                assert_eq!(result.as_ref().err(), reference.as_ref().err(), "{instructions:?}");
                continue;
            };
            for (a, b) in [
                (&result["horizontal_g"], &reference["horizontal_g"]),
                (&result["vertical_g"], &reference["vertical_g"]),
                (&result["mesh_force_n"], &reference["mesh_force_n"]),
            ] {
                let square = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>();
                let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b)).sqrt();
                // Equal wheels move in opposition: of their sum only rounding is left.
                let most = 1e-9 * square(&mut b.iter().copied()).sqrt() + 1e-10;
                assert!(difference <= most, "{instructions:?}");
            }
        }
        if instructions != InstructionSet::Plain {
            let results: Vec<_> = results.iter().map(|result| result.as_ref().ok().map(bits)).collect();
            assert!(*fused.get_or_insert_with(|| results.clone()) == results, "{instructions:?}");
        }
    }
}

#[test]
fn progress_counts_every_simulation() {
    let counts = Mutex::new(Vec::new());
    let progress = |count| counts.lock().unwrap().push(count);
    let scenarios = vec![small(17, 34, None); 40];
    let control = Control { progress: &progress, ..Control::default() };
    assert_eq!(in_threads(4, || all(&scenarios, &control)).len(), 40);
    let counts = counts.into_inner().unwrap();
    assert!(counts.is_sorted() && counts.last() == Some(&40) && counts.len() >= 5, "{counts:?}");
}

#[test]
fn cancelled_work_ends_early_and_what_is_handed_out_is_whole() {
    let cancelled = AtomicBool::new(false);
    let asked_for = AtomicUsize::new(0);
    let scenarios = (0..100_000).map(|_| {
        asked_for.fetch_add(1, Ordering::Relaxed);
        small(17, 34, None)
    });
    let expected = simulate(small(17, 34, None)).unwrap().channels.len();
    let control = Control { cancelled: &cancelled, ..Control::default() };
    let handed_out = in_threads(2, || {
        simulate_many(scenarios, &KeepChannels::default(), &control, |index, signals| {
            assert_eq!(signals.unwrap().channels[0].len(), expected);
            if index == 20 {
                cancelled.store(true, Ordering::Relaxed);
            }
        })
    });
    assert!((21..1000).contains(&handed_out), "{handed_out}");
    assert!(asked_for.into_inner() < 1000);
}

#[test]
fn nothing_to_do() {
    assert_eq!(all(&[], &Control::default()).len(), 0);
}

#[test]
fn single_precision_channels_are_the_signals_rounded() {
    let scenario = small(17, 34, None);
    let whole = simulate(&scenario).unwrap().channels;
    let mut taken = 0;
    simulate_many([scenario], &KeepChannels::default(), &Control::default(), |_, signals| {
        taken += 1;
        let signals = signals.unwrap();
        assert_eq!(signals.sampling_rate_hz, whole.sampling_rate_hz);
        assert_eq!(signals.start_s, whole.start_s);
        assert_eq!(signals.channels.len(), 2);
        for (channel, whole) in signals.channels.iter().zip([&whole["horizontal_g"], &whole["vertical_g"]]) {
            assert_eq!(channel.len(), whole.len());
            assert!(channel.iter().zip(whole).all(|(a, b)| *a == *b as f32));
        }
    });
    assert_eq!(taken, 1);
}

/// A panic of what the caller gave ends the batch, instead of leaving the other threads waiting.
#[test]
fn a_panic_of_the_caller_s_own_code_ends_the_batch() {
    let asked_for = AtomicUsize::new(0);
    let scenarios = (0..100_000).map(|_| {
        asked_for.fetch_add(1, Ordering::Relaxed);
        small(17, 34, None)
    });
    let caught = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        in_threads(2, || {
            simulate_many(scenarios, &KeepChannels::default(), &Control::default(), |index, _| {
                assert!(index < 5, "what the caller does not want");
            })
        })
    }));
    assert!(caught.is_err());
    assert!(asked_for.into_inner() < 2000);
}
