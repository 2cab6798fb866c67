//! The modal, low-rank solver against a dense one, written straight from the equations of motion.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::TAU;

use meshtone::scenario::*;
use meshtone::solver::Output;
use meshtone::stages;
use nalgebra::DVector;

use crate::dense::*;
use crate::physics::{rms, with_own_structure};

/// Samples that are compared.
const SAMPLES: usize = 1_000;

/// Rms of the difference over rms, the largest over all coordinates that move.
fn difference(modal: &[Vec<f64>], dense: &[DVector<f64>]) -> f64 {
    let dense: Vec<Vec<f64>> =
        (0..modal.len()).map(|n| dense.iter().map(|acceleration| acceleration[n]).collect()).collect();
    let largest = dense.iter().map(|values| rms(values)).fold(0.0, f64::max);
    let of_coordinate = modal.iter().zip(&dense).map(|(modal, dense)| {
        let difference: Vec<f64> = modal.iter().zip(dense).map(|(a, b)| a - b).collect();
        let scale = rms(dense);
        // What only rounding moves is compared with what moves.
        rms(&difference) / if scale > 1e-9 * largest { scale } else { largest }
    });
    of_coordinate.fold(0.0, f64::max)
}

fn driven_unsteadily(scenario: &mut Scenario, random: &mut impl FnMut(f64, f64) -> f64) {
    scenario.solver.settle_fraction = 0.0;
    let operation = &mut scenario.operation;
    let (speed, torque) = (operation.pinion_speed_hz, operation.brake_torque_nm);
    let seconds = 2.0 * f64::from(scenario.wheels[1].teeth) / speed;
    let profile = |nominal: f64, factors: [f64; 3]| {
        Some(Profile {
            time_s: vec![0.0, 0.6 * seconds, 1.1 * seconds],
            value: factors.map(|factor| factor * nominal).to_vec(),
        })
    };
    // The farther the shafts turn from the rigid rotation at the nominal speed, the more of the mesh's deflection is lost to
    // rounding, in both solutions: 5e-9 of the acceleration at ±10 %, 1.5e-9 at ±1 % and a light load.
    operation.speed_profile_hz = profile(speed, [0.997, 1.003, 1.0]);
    operation.torque_profile_nm = profile(torque, [1.0, 1.3, 0.8]);
    operation.speed_fluctuation_hz = random(0.0, 0.003) * speed;
    operation.torque_fluctuation_nm = random(0.0, 0.1) * torque;
    let eccentricity_mm = random(0.0, 0.02);
    scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = eccentricity_mm);
}

fn damage(kind: usize, module: f64, width: f64, random: &mut impl FnMut(f64, f64) -> f64) -> Option<Damage> {
    let start = random(0.05, 0.35);
    let pit = PitCircle::Fractions { start, end: random(0.55, 0.95), depth: random(0.1, 0.6) };
    Some(match kind {
        0 => return None,
        1 => MissingTooth.into(),
        2 => Damage::ToothBreakage(ToothBreakage {
            chip_height_mm: random(0.5, 1.6) * module,
            chip_width_mm: random(0.2, 0.9) * width,
            tip_loss_mm: random(0.0, 0.9) * module,
        }),
        3 => Damage::PartialFace(PartialFace { width_mm: random(0.1, 0.7) * width, pit }),
        4 => Damage::ThroughFace(ThroughFace { pit }),
        _ => Damage::ToothDestruction(ToothDestruction {
            start,
            line: DestructionLine::End(random(0.7, 1.0)),
            offset_mm: random(0.0, 0.1) * module,
            noise_mm: 0.001,
        }),
    })
}

/// Scenarios over every fault, both ways of contact, any start and drive.
#[test]
fn modal_and_dense_solutions_agree() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut random = |low: f64, high: f64| {
        use proptest::strategy::{Strategy, ValueTree};
        (low..high).new_tree(&mut runner).unwrap().current()
    };
    let mut worst: f64 = 0.0;
    for round in 0..3 {
        for kind in 0..6 {
            for model in [Model::Contact, Model::Linear] {
                let (module, width) = (random(2.0, 6.0), random(10.0, 60.0));
                let teeth = [(14, 21), (18, 24), (15, 20), (16, 24), (20, 30), (40, 60), (28, 21)];
                let (pinion, gear) = teeth[random(0.0, teeth.len() as f64) as usize];
                let mut scenario = Scenario::new(GearPair {
                    module_mm: module,
                    pinion_teeth: pinion,
                    gear_teeth: gear,
                    face_width_mm: width,
                    pinion_speed_hz: random(15.0, 60.0),
                    brake_torque_nm: random(2.0, 80.0),
                });
                with_own_structure(&mut scenario);
                scenario.model = model;
                scenario.seed = round;
                scenario.meshes[0].points_per_tooth = 2000;
                let din_grade = random(0.0, 10.0) as u8;
                scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = din_grade);
                scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(random(0.01, 0.1));
                // Coarser steps let teeth that part bounce so wildly that rounding grows to be seen.
                scenario.solver.sampling_rate_hz = 4e4;
                // From the start on, where nothing has settled.
                scenario.solver.settle_tolerance = 0.0;
                scenario.meshes[0].pressure_angle_deg = [20.0, 22.5, 18.0][round as usize];
                if round == 1 {
                    // Every mode and every direction of the mesh moves.
                    let speed = TAU * scenario.operation.pinion_speed_hz;
                    let ratio = f64::from(pinion) / f64::from(gear);
                    let rigid = [0.0, 0.0, 0.0, 0.0, -ratio, 1.0, -ratio, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                    scenario.solver.initial_velocity =
                        Some(rigid.map(|rigid| rigid * speed + random(-1e-2, 1e-2)));
                }
                if round == 2 {
                    driven_unsteadily(&mut scenario, &mut random);
                }
                if model == Model::Contact && kind % 2 == 1 {
                    // With two unknowns.
                    scenario.meshes[0].misalignment_um = random(-20.0, 20.0);
                }
                let damage = damage(kind, module, width, &mut random);
                scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
                if kind > 0 {
                    // Another tooth, of the pinion in one round of three, beside it.
                    let wheel = if round == 0 { WheelName::Pinion } else { WheelName::Gear };
                    let beside = ToothBreakage {
                        chip_height_mm: 0.7 * module,
                        chip_width_mm: 0.4 * width,
                        tip_loss_mm: 0.0,
                    };
                    scenario.faults.push(Fault::new(wheel, 5, beside));
                }
                let stages = stages(&scenario).unwrap();
                let outputs: Vec<Output> = coordinates(machine_of(&stages).0, 2).collect();
                let mut modal = outputs_from(0, &stages, &outputs);
                modal.iter_mut().for_each(|values| values.truncate(SAMPLES));
                let dense = Dense::of(&stages, SAMPLES).accelerations();
                let difference = difference(&modal, &dense);
                println!("{round} {kind} {model:?} {pinion}/{gear}: {difference:.2e}");
                worst = worst.max(difference);
                let most = if stages.meshes[0].two_unknowns().is_some() { 1e-8 } else { 1e-9 };
                assert!(difference < most, "{difference:.2e} for\n{}", scenario.to_toml());
            }
        }
    }
    println!("largest: {worst:.2e}");
}

/// Helical and crowned teeth: with even faces and in slices, with damage of every kind, at constant and at varying speed.
#[test]
fn helical_teeth_agree_with_the_dense_solution() {
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut random = |low: f64, high: f64| {
        use proptest::strategy::{Strategy, ValueTree};
        (low..high).new_tree(&mut runner).unwrap().current()
    };
    let mut worst: f64 = 0.0;
    for case in 0..8_usize {
        let (module, width) = (random(2.0, 4.0), random(10.0, 40.0));
        let mut scenario = Scenario::new(GearPair {
            module_mm: module,
            pinion_teeth: 18,
            gear_teeth: 24,
            face_width_mm: width,
            pinion_speed_hz: random(15.0, 40.0),
            brake_torque_nm: random(10.0, 80.0),
        });
        with_own_structure(&mut scenario);
        let mut gears = scenario.gears();
        // Spur teeth that are crowned in two cases.
        gears.helix_angle_deg = if case >= 6 { 0.0 } else { random(5.0, 30.0) };
        gears.hand = if case % 2 == 0 { Hand::Right } else { Hand::Left };
        gears.points_per_tooth = 2000;
        if case != 0 {
            gears.lead_crowning_um = random(1.0, 8.0);
            gears.end_relief = EndRelief { length_mm: 0.2 * width, amount_um: random(0.0, 10.0) };
            scenario.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 6);
        }
        scenario.set_gears(&gears);
        scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.01);
        scenario.solver.sampling_rate_hz = 4e4;
        scenario.solver.settle_tolerance = 0.0;
        if case % 3 == 2 {
            driven_unsteadily(&mut scenario, &mut random);
        }
        let damage = damage(case.saturating_sub(1) % 6, module, width, &mut random);
        scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
        let stages = stages(&scenario).unwrap();
        assert_eq!(stages.meshes[0].slices(), if case == 0 { 1 } else { 21 });
        let outputs: Vec<Output> = coordinates(machine_of(&stages).0, 2).collect();
        let mut modal = outputs_from(0, &stages, &outputs);
        modal.iter_mut().for_each(|values| values.truncate(300));
        let dense = Dense::of(&stages, 300).accelerations();
        let difference = difference(&modal, &dense);
        println!("{case}: {difference:.2e}");
        worst = worst.max(difference);
        assert!(difference < 1e-9, "{difference:.2e} for\n{}", scenario.to_toml());
    }
    println!("largest: {worst:.2e}");
}
