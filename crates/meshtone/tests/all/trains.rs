//! Machines of several meshes, built by hand: gear pairs side by side, two stages in a row, and an idler between two wheels.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::{PI, TAU};

use crate::dense::{Dense, DenseMesh, Recorded, coordinates, deviations_of, machine_of, outputs_from};
use meshtone::machine::{Drive, LineOfAction, Machine, Modes, Spring};
use meshtone::mesh::{Forcing, Mesh, Turning};
use meshtone::operation::TimeGrid;
use meshtone::scenario::*;
use meshtone::solver::{InitialMotion, ModalMachine, Output, Problem, integrate};
use meshtone::{InstructionSet, Stages, stages};
use nalgebra::{DMatrix, DVector};

/// The acceleration of every coordinate, and the force of every mesh.
fn outputs(machine: &Machine) -> Vec<Output> {
    coordinates(machine, 2).chain((0..machine.lines.len()).map(|mesh| Output::MeshForce { mesh })).collect()
}

/// The same of the solver, of a machine with several meshes.
fn solve(
    machine: &Machine,
    meshes: &[Mesh],
    forcing: Forcing,
    is_steady: bool,
    time: &TimeGrid,
    start: InitialMotion,
) -> Vec<Vec<f64>> {
    let outputs = outputs(machine);
    let mut signals = Recorded(vec![Vec::new(); outputs.len()]);
    let half_face_m = |mesh: &Mesh| mesh.two_unknowns().map_or(0.0, |[width_m, _]| width_m / 2.0);
    let half_faces_m: Vec<f64> = meshes.iter().map(half_face_m).collect();
    let problem = Problem {
        time,
        machine: ModalMachine::new(machine, &Modes::damped_by_springs(machine), &half_faces_m, start),
        laws: meshes.iter().map(Mesh::law).collect(),
        bearings: Vec::new(),
        forcing,
        is_steady,
        hunting_period_samples: None,
        outputs: &outputs,
        first_sample: 0,
    };
    integrate(problem, InstructionSet::in_use(), &mut signals).unwrap();
    signals.0
}

/// Rms of the difference over rms, the largest of all signals. What only rounding moves is compared with what moves.
fn difference(ours: &[Vec<f64>], theirs: &[Vec<f64>]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let rms = |of: &mut dyn Iterator<Item = f64>| of.map(|value| value * value).sum::<f64>().sqrt();
    let scales: Vec<f64> = theirs.iter().map(|signal| rms(&mut signal.iter().copied())).collect();
    let largest = scales.iter().copied().fold(0.0, f64::max);
    let each = ours.iter().zip(theirs).zip(&scales).map(|((ours, theirs), &scale)| {
        assert_eq!(ours.len(), theirs.len());
        rms(&mut ours.iter().zip(theirs).map(|(a, b)| a - b))
            / if scale > 1e-9 * largest { scale } else { largest }
    });
    each.fold(0.0, f64::max)
}

/// `samples` samples from the start of the simulation on.
fn time_grid(samples: usize, samples_per_revolution: usize, speed_hz: f64) -> TimeGrid {
    TimeGrid {
        sampling_rate_hz: samples_per_revolution as f64 * speed_hz,
        samples,
        first_simulated_sample: 0,
        first_kept_sample: 0,
        samples_per_pinion_revolution: samples_per_revolution,
    }
}

/// Stages of a pair on a given division of time.
fn stages_on(scenario: &Scenario, time: TimeGrid, points_per_pitch: usize) -> Stages {
    let mut stages = stages(scenario).unwrap();
    stages.time = time;
    stages.meshes = stages.meshes_at(points_per_pitch.try_into().unwrap()).unwrap();
    stages
}

/// Speed and brake torque of the second pair over those of the first.
const SPEED_RATIO: f64 = 34.0 / 40.0;
const TORQUE_RATIO: f64 = 0.8;
/// 51 kS/s: 75 samples for a pitch of the first pair, 60 for one of the second.
const SAMPLES_PER_REVOLUTION: [usize; 2] = [1275, 1500];
const POINTS_PER_PITCH: [usize; 2] = [75, 60];
const SAMPLES: usize = 3_000;

/// A pair of 17/38 teeth, and one of 25/30 teeth of another module, each with deviations of its own.
fn two_scenarios() -> [Scenario; 2] {
    let first = GearPair::example();
    let second = GearPair {
        module_mm: 2.0,
        pinion_teeth: 25,
        gear_teeth: 30,
        face_width_mm: 22.0,
        pinion_speed_hz: SPEED_RATIO * first.pinion_speed_hz,
        brake_torque_nm: TORQUE_RATIO * first.brake_torque_nm,
    };
    [(first, 1), (second, 2)].map(|(pair, seed)| {
        let mut scenario = Scenario::new(pair);
        scenario.seed = seed;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
        crate::physics::with_own_structure(&mut scenario);
        scenario.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.005);
        scenario
    })
}

/// Machines in one, of which no coordinate is coupled to one of another: each with its speed and its torque over those of the first.
fn side_by_side(machines: [&Machine; 2]) -> Machine {
    let n: usize = machines.iter().map(|machine| machine.coordinates()).sum();
    let mut whole = Machine {
        names: Vec::new(),
        mass: DMatrix::zeros(n, n),
        turn: DMatrix::zeros(n, n),
        springs: Vec::new(),
        lines: Vec::new(),
        bearings: Vec::new(),
        turning_forces: Vec::new(),
        spinning: Vec::new(),
        drives: Vec::new(),
        places: Vec::new(),
        rigid_rotation: DVector::zeros(n),
    };
    let mut end = 0;
    for (machine, [speed, torque]) in machines.into_iter().zip([[1.0; 2], [SPEED_RATIO, TORQUE_RATIO]]) {
        let (from, own) = (end, machine.coordinates());
        let vector = |of: &DVector<f64>| {
            let mut vector = DVector::zeros(n);
            vector.rows_mut(from, own).copy_from(of);
            vector
        };
        let matrix = |of: &DMatrix<f64>| {
            let mut matrix = DMatrix::zeros(n, n);
            matrix.view_mut((from, from), (own, own)).copy_from(of);
            matrix
        };
        whole.names.extend(machine.names.iter().cloned());
        whole.mass += matrix(&machine.mass);
        end += own;
        whole.turn += matrix(&machine.turn);
        whole.rigid_rotation += vector(&machine.rigid_rotation) * speed;
        whole.springs.extend(
            machine.springs.iter().map(|spring| Spring { stiffness: matrix(&spring.stiffness), ..*spring }),
        );
        whole.lines.extend(machine.lines.iter().map(|line| LineOfAction {
            at_middle: vector(&line.at_middle),
            per_m: vector(&line.per_m),
            across: None,
        }));
        whole.drives.extend(machine.drives.iter().map(|drive| match *drive {
            Drive::Motor { coordinate, stiffness_nm_per_rad, speed_ratio } => Drive::Motor {
                coordinate: coordinate + from,
                stiffness_nm_per_rad,
                speed_ratio: speed_ratio * speed,
            },
            Drive::Brake { coordinate, torque_share } => {
                Drive::Brake { coordinate: coordinate + from, torque_share: torque_share * torque }
            }
        }));
    }
    whole
}

/// Checks that two pairs on one machine, which share no coordinate, move as each does alone.
///
/// # Returns
/// Of each, whether its load tilts the wheels, and its mesh force.
fn check_pairs_side_by_side(scenarios: &[Scenario; 2], first_pitch: [f64; 2]) -> [(bool, Vec<f64>); 2] {
    let of_pair = |pair: usize| {
        let scenario = &scenarios[pair];
        let time = time_grid(SAMPLES, SAMPLES_PER_REVOLUTION[pair], scenario.operation.pinion_speed_hz);
        let mut stages = stages_on(scenario, time, POINTS_PER_PITCH[pair]);
        stages.meshes[0].turning.first_pitch = first_pitch[pair];
        stages
    };
    let pairs = [of_pair(0), of_pair(1)];
    let machines = pairs.each_ref().map(|stages| machine_of(stages).0);
    let alone = [0, 1].map(|pair| outputs_from(0, &pairs[pair], &outputs(machines[pair])));
    let machine = side_by_side(machines);
    let mut meshes = pairs.each_ref().map(|stages| stages.meshes[0].clone());
    meshes[1].turning.pitches_per_revolution *= SPEED_RATIO;
    let Stages { scenario, time, .. } = &pairs[0];
    let operation = &scenario.operation;
    let nominal = [operation.pinion_speed_hz, operation.brake_torque_nm];
    let forcing = Forcing::new(
        pairs[0].motion(),
        time,
        nominal,
        0,
        meshes.iter().zip(pairs.each_ref().map(|stages| deviations_of(stages, 0))),
    );
    let first_speed_hz = operation.speed_profile_hz.as_ref().map_or(nominal[0], |profile| profile.value[0]);
    let start = InitialMotion {
        nominal_rad_per_s: TAU * nominal[0],
        brake_torque_nm: nominal[1],
        motor_rad_per_s: TAU * first_speed_hz,
        velocity: None,
    };
    let together = solve(&machine, &meshes, forcing, pairs[0].is_steady(), time, start);

    for (pair, alone) in alone.iter().enumerate() {
        let mut own = together[17 * pair..17 * (pair + 1)].to_vec();
        own.push(together[34 + pair].clone());
        let difference = difference(&own, alone);
        println!("pair {pair}: {difference:.1e}");
        assert!(difference < 1e-9, "pair {pair}: {difference:.2e}");
    }
    let mut tilts = meshes.iter().map(|mesh| mesh.two_unknowns().is_some());
    alone.map(|mut signals| (tilts.next().unwrap(), signals.pop().unwrap()))
}

/// Whether a pair of wheels comes apart for some time and meets again.
fn loses_contact(force_n: &[f64]) -> bool {
    let apart = force_n.iter().position(|force| *force == 0.0);
    apart.is_some_and(|from| force_n[from..].iter().any(|force| *force > 0.0))
}

#[test]
fn sound_pairs_side_by_side_move_as_alone() {
    for (tilts, force_n) in check_pairs_side_by_side(&two_scenarios(), [0.0; 2]) {
        assert!(!tilts && force_n.iter().all(|force| *force >= 0.0));
    }
}

// The tables of a mesh that does not begin at a point of them are read between their points.
#[test]
fn pairs_of_any_phase_move_as_alone() {
    check_pairs_side_by_side(&two_scenarios(), [0.0, 0.297]);
}

#[test]
fn a_missing_tooth_disturbs_its_own_pair_only() {
    for damaged in 0..2 {
        let mut scenarios = two_scenarios();
        scenarios[damaged].faults = vec![Fault::new(WheelName::Gear, 6, MissingTooth)];
        let pairs = check_pairs_side_by_side(&scenarios, [0.0; 2]);
        assert!(loses_contact(&pairs[damaged].1));
    }
}

// One pair has two unknowns, in slices where a tooth is chipped, the other one. The load is so light that flanks part.
#[test]
fn a_load_that_tilts_the_wheels_of_one_pair_leaves_the_other_alone() {
    let chip = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 12.0, tip_loss_mm: 1.0 };
    for damaged in 0..2 {
        let mut scenarios = two_scenarios();
        scenarios.iter_mut().for_each(|scenario| scenario.operation.brake_torque_nm *= 0.1);
        scenarios[damaged].meshes[0].misalignment_um = 8.0;
        if damaged == 0 {
            scenarios[damaged].faults = vec![Fault::new(WheelName::Pinion, 5, chip)];
        }
        let pairs = check_pairs_side_by_side(&scenarios, [0.0; 2]);
        assert!(loses_contact(&pairs[damaged].1));
        assert_eq!(pairs.map(|(tilts, _)| tilts), [damaged == 0, damaged == 1]);
    }
}

// Motors and brakes of both follow the input. The farther a shaft turns from the rigid rotation at the nominal speed, the more of the
// deflection is lost to rounding.
#[test]
fn pairs_that_are_driven_unsteadily_move_as_alone() {
    let mut scenarios = two_scenarios();
    for scenario in &mut scenarios {
        scenario.solver.settle_fraction = 0.0;
        let operation = &mut scenario.operation;
        let profile = |nominal: f64, factors: [f64; 3]| {
            let value = factors.map(|factor| factor * nominal).to_vec();
            Some(Profile { time_s: vec![0.0, 0.03, 0.06], value })
        };
        operation.speed_profile_hz = profile(operation.pinion_speed_hz, [0.998, 1.002, 1.0]);
        operation.torque_profile_nm = profile(operation.brake_torque_nm, [1.0, 1.3, 0.8]);
    }
    check_pairs_side_by_side(&scenarios, [0.0; 2]);
}

/// A train of shafts and wheels that only turn. Each rotation is counted positive in the sense in which its wheel turns.
///
/// # Arguments
/// * `inertia_kgm2` - (kg m²) of each wheel, motor and brake
/// * `shafts` - what each connects, or the one that it holds, and (N m/rad) its stiffness
/// * `meshes` - the driving and the driven wheel of each, with (m) their base radii
fn torsional_train(
    inertia_kgm2: &[f64],
    shafts: &[(&[usize], f64)],
    meshes: &[[(usize, f64); 2]],
) -> Machine {
    let n = inertia_kgm2.len();
    let spring = |&(ends, stiffness): &(&[usize], f64)| {
        let stretch: Vec<_> = ends.iter().copied().zip([1.0, -1.0]).collect();
        let mut spring = Spring::new(n, 0.02);
        spring.resist(&stretch, stiffness);
        spring
    };
    let line = |&[(driving, driving_m), (driven, driven_m)]: &[(usize, f64); 2]| {
        let mut at_middle = DVector::zeros(n);
        (at_middle[driving], at_middle[driven]) = (driving_m, -driven_m);
        LineOfAction { at_middle, per_m: DVector::zeros(n), across: None }
    };
    Machine {
        names: vec!["rotation".into(); n],
        mass: DMatrix::from_diagonal(&DVector::from_column_slice(inertia_kgm2)),
        turn: DMatrix::identity(n, n),
        springs: shafts.iter().map(spring).collect(),
        lines: meshes.iter().map(line).collect(),
        bearings: Vec::new(),
        turning_forces: Vec::new(),
        spinning: Vec::new(),
        drives: Vec::new(),
        places: Vec::new(),
        rigid_rotation: DVector::zeros(n),
    }
}

/// (m) Base radius of a wheel of module 2 mm.
fn base_radius_m(teeth: u32) -> f64 {
    1e-3 * f64::from(teeth) * 20f64.to_radians().cos()
}

/// (kg m²) Inertia of a steel disc of its pitch radius, 20 mm wide.
fn disc_kgm2(teeth: u32) -> f64 {
    PI / 2.0 * 7850.0 * 0.02 * (1e-3 * f64::from(teeth)).powi(4)
}

const MOTOR_KGM2: f64 = 5e-3;
const BRAKE_KGM2: f64 = 2e-2;

#[track_caller]
fn assert_frequencies(machine: &Machine, mesh_stiffness: &[f64], expected_hz: &[f64], last_digit_hz: f64) {
    let (found_hz, _) = machine.closed_modes(mesh_stiffness);
    for (found, expected) in found_hz.iter().zip(expected_hz) {
        assert!((found - expected).abs() <= 0.501 * last_digit_hz, "{found} Hz, not {expected} Hz");
    }
    assert_eq!(found_hz[0], 0.0);
}

// Numbers of an independent program.
#[test]
fn torsional_frequencies_of_two_stages_and_of_an_idler() {
    let [z1, z2, z3, z4] = [32, 80, 48, 64];
    let two_stages = torsional_train(
        &[MOTOR_KGM2, disc_kgm2(z1), disc_kgm2(z2), disc_kgm2(z3), disc_kgm2(z4), BRAKE_KGM2],
        &[(&[0, 1], 5e3), (&[2, 3], 2e4), (&[4, 5], 1e4)],
        &[[(1, base_radius_m(z1)), (2, base_radius_m(z2))], [(3, base_radius_m(z3)), (4, base_radius_m(z4))]],
    );
    let expected = [0.0, 106.66, 285.43, 481.04, 4327.10, 5590.45];
    assert_frequencies(&two_stages, &[3e8, 3e8], &expected, 0.01);
    let expected = [0.0, 106.73, 285.84, 481.36, 4668.94, 6444.15];
    assert_frequencies(&two_stages, &[4e8, 3.5e8], &expected, 0.01);

    let [z1, z2, z3] = [17, 23, 38];
    let idler = torsional_train(
        &[MOTOR_KGM2, disc_kgm2(z1), disc_kgm2(z2), disc_kgm2(z3), BRAKE_KGM2],
        &[(&[0, 1], 5e3), (&[3, 4], 1e4)],
        &[[(1, base_radius_m(z1)), (2, base_radius_m(z2))], [(2, base_radius_m(z2)), (3, base_radius_m(z3))]],
    );
    assert_frequencies(&idler, &[3e8; 2], &[0.0, 125.21, 1037.32, 6856.59, 13207.45], 0.01);
}

// What turns behind the second mesh counts by the square of its ratio, as if it were on the second shaft.
#[test]
fn a_rigid_second_mesh_leaves_one_pair_with_the_transformed_inertia() {
    let [z1, z2, z3, z4] = TWO_STAGES;
    let first = [(1, base_radius_m(z1)), (2, base_radius_m(z2))];
    let two_stages = torsional_train(
        &[MOTOR_KGM2, disc_kgm2(z1), disc_kgm2(z2), disc_kgm2(z3), disc_kgm2(z4), BRAKE_KGM2],
        &[(&[0, 1], 5e3), (&[2, 3], 2e4), (&[4, 5], 1e4)],
        &[first, [(3, base_radius_m(z3)), (4, base_radius_m(z4))]],
    );
    let squared = (f64::from(z3) / f64::from(z4)).powi(2);
    let one_pair = torsional_train(
        &[
            MOTOR_KGM2,
            disc_kgm2(z1),
            disc_kgm2(z2),
            disc_kgm2(z3) + squared * disc_kgm2(z4),
            squared * BRAKE_KGM2,
        ],
        &[(&[0, 1], 5e3), (&[2, 3], 2e4), (&[3, 4], squared * 1e4)],
        &[first],
    );
    let (expected_hz, _) = one_pair.closed_modes(&[3e8]);
    let largest = |second_n_per_m: f64| {
        let (found_hz, _) = two_stages.closed_modes(&[3e8, second_n_per_m]);
        let differences =
            expected_hz.iter().zip(&found_hz).skip(1).map(|(expected, found)| (found / expected - 1.0).abs());
        differences.fold(0.0, f64::max)
    };
    let differences = [1e10, 1e12, 1e14].map(largest);
    println!("{differences:?}");
    assert!(differences[1] < differences[0] / 50.0 && differences[2] < 1e-6);
}

// M. I. Friswell et al., Dynamics of Rotating Machines (2010): two trains that branch, the meshes of which are rigid in the book.
#[test]
fn torsional_frequencies_of_branched_trains() {
    let motor_and_two_rotors = torsional_train(
        &[400e-6, 25e-6, 25e-6, 700e-6, 700e-6],
        &[(&[0, 1], 1e4), (&[2, 3], 5e3), (&[1, 4], 5e3)],
        &[[(1, 0.05), (2, 0.05)]],
    );
    assert_frequencies(&motor_and_two_rotors, &[1e13], &[0.0, 425.4, 634.1, 3247.2], 0.1);

    // Example 9.6.3.
    let three_meshes = torsional_train(
        &[3200.0, 200.0, 200.0, 800.0, 800.0, 450.0, 450.0],
        &[(&[0, 1], 4_272_566.0), (&[3, 5], 7_450_764.0), (&[4, 6], 7_450_764.0)],
        &[[(1, 0.5), (2, 0.5)], [(1, 0.5), (3, 0.8)], [(2, 0.5), (4, 0.8)]],
    );
    assert_frequencies(&three_meshes, &[1e14; 3], &[0.0, 10.304, 20.479, 24.423], 0.001);
    for (stiffness, expected) in [
        (1e8, [0.0, 9.8878, 18.4374, 24.2948, 39.5965, 73.8331, 102.7444]),
        (1e9, [0.0, 10.2617, 20.2972, 24.4110, 112.8429, 228.4388, 320.9899]),
        (1e10, [0.0, 10.2999, 20.4613, 24.4217, 353.7101, 720.783, 1013.8664]),
    ] {
        assert_frequencies(&three_meshes, &[stiffness; 3], &expected, 1e-4);
    }
}

/// Teeth of the two stages, and (Hz) speed of the input.
const TWO_STAGES: [u32; 4] = [32, 80, 48, 64];
const INPUT_HZ: f64 = 30.0;
/// (N m) At the output.
const BRAKE_NM: f64 = 20.0;

/// The two stages, turned by a motor behind the first shaft.
fn driven_two_stages() -> Machine {
    let [z1, z2, z3, z4] = TWO_STAGES;
    let input_nm_per_rad = 5e3;
    let [second, third] = [f64::from(z1) / f64::from(z2), f64::from(z1 * z3) / f64::from(z2 * z4)];
    Machine {
        drives: vec![
            Drive::Motor { coordinate: 0, stiffness_nm_per_rad: input_nm_per_rad, speed_ratio: 1.0 },
            // It acts against the rotation.
            Drive::Brake { coordinate: 4, torque_share: -1.0 },
        ],
        rigid_rotation: DVector::from_vec(vec![1.0, second, second, third, third]),
        ..torsional_train(
            &[disc_kgm2(z1), disc_kgm2(z2), disc_kgm2(z3), disc_kgm2(z4), BRAKE_KGM2],
            &[(&[0], input_nm_per_rad), (&[1, 2], 2e4), (&[3, 4], 1e4)],
            &[
                [(0, base_radius_m(z1)), (1, base_radius_m(z2))],
                [(2, base_radius_m(z3)), (3, base_radius_m(z4))],
            ],
        )
    }
}

fn start(velocity: Option<&[f64]>) -> InitialMotion<'_> {
    InitialMotion {
        nominal_rad_per_s: TAU * INPUT_HZ,
        brake_torque_nm: BRAKE_NM,
        motor_rad_per_s: TAU * INPUT_HZ,
        velocity,
    }
}

#[test]
fn static_mesh_forces_balance_the_torque_through_the_ratios() {
    let machine = driven_two_stages();
    let modes = Modes::damped_by_springs(&machine);
    // One for each shaft but the motor's.
    assert_eq!(modes.angular_frequencies.iter().filter(|omega| **omega == 0.0).count(), 2);
    let [_, r2, r3, r4] = TWO_STAGES.map(base_radius_m);
    let second_n = BRAKE_NM / r4;
    let first_n = second_n * r3 / r2;
    let modal = ModalMachine::new(&machine, &modes, &[0.0; 2], start(None));
    for (line, expected_n) in modal.lines.iter().zip([first_n, second_n]) {
        assert!((line.static_force_n / expected_n - 1.0).abs() < 1e-9, "{} N", line.static_force_n);
    }
}

/// Division of time of the two stages: 60 samples for a pitch of the first mesh, 100 for one of the second.
fn time_of_two_stages() -> TimeGrid {
    time_grid(300, 1920, INPUT_HZ)
}

/// Stages of both pairs of the two-stage train: their meshes turn with the train's input.
fn pairs_of_two_stages(model: Model) -> [Stages; 2] {
    let [z1, z2, z3, z4] = TWO_STAGES;
    let second_shaft = f64::from(z1) / f64::from(z2);
    [(z1, z2, 1.0, 60), (z3, z4, second_shaft, 100)].map(|(pinion_teeth, gear_teeth, ratio, points)| {
        let mut scenario = Scenario::new(GearPair {
            module_mm: 2.0,
            pinion_teeth,
            gear_teeth,
            face_width_mm: 20.0,
            pinion_speed_hz: ratio * INPUT_HZ,
            brake_torque_nm: BRAKE_NM,
        });
        scenario.model = model;
        scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 0);
        if model == Model::Contact {
            scenario.faults = vec![Fault::new(WheelName::Pinion, 2, MissingTooth)];
        }
        let mut stages = stages_on(&scenario, time_of_two_stages(), points);
        stages.meshes[0].turning =
            Turning { pitches_per_revolution: ratio * f64::from(pinion_teeth), first_pitch: 0.0 };
        stages
    })
}

/// Makes a mesh's stiffness its mean at every point: each pair carries it for one pitch, and then nothing.
fn level(mesh: &mut Mesh) {
    let (mean, per_pitch) = (mesh.mean_stiffness_n_per_m, mesh.points_per_pitch);
    for (point, state) in mesh.classes[0].states.iter_mut().enumerate() {
        state.stiffness_n_per_m = if point < per_pitch { mean } else { 0.0 };
        state.separation_m = 0.0;
    }
}

/// Rms of the difference between the accelerations of the coupled solver and of the dense one, over rms; and the forces of the meshes.
fn against_dense(pairs: &[Stages; 2]) -> (f64, Vec<Vec<f64>>) {
    let (machine, time) = (driven_two_stages(), time_of_two_stages());
    let modes = Modes::damped_by_springs(&machine);
    let meshes = pairs.each_ref().map(|stages| stages.meshes[0].clone());
    let motion = || pairs[0].scenario.motion(&time);
    let deviations = || pairs.each_ref().map(|stages| deviations_of(stages, 0));
    let forcing = Forcing::new(motion(), &time, [INPUT_HZ, BRAKE_NM], 0, meshes.iter().zip(deviations()));
    let velocity = &machine.rigid_rotation * (TAU * INPUT_HZ) + DVector::from_column_slice(&PUSH);
    let start = start(Some(velocity.as_slice()));
    let mut modal = solve(&machine, &meshes, forcing, true, &time, start);
    let dense = Dense {
        machine: &machine,
        modes: &modes,
        meshes: meshes
            .iter()
            .zip(deviations())
            .map(|(mesh, of_mesh)| DenseMesh::new(mesh, of_mesh))
            .collect(),
        time: &time,
        motion: motion().take(time.samples).collect(),
        is_steady: true,
        start,
    };
    let samples = dense.accelerations();
    let by_coordinate: Vec<Vec<f64>> =
        (0..machine.coordinates()).map(|n| samples.iter().map(|sample| sample[n]).collect()).collect();
    let forces = modal.split_off(machine.coordinates());
    let difference = difference(&modal, &by_coordinate);
    println!("{difference:.1e}");
    (difference, forces)
}

/// (rad/s) A velocity at the start by which everything vibrates.
const PUSH: [f64; 5] = [0.05, -0.02, 0.03, 0.01, -0.04];

#[test]
fn two_stages_of_constant_stiffness_move_as_with_dense_matrices() {
    let mut pairs = pairs_of_two_stages(Model::Linear);
    pairs.iter_mut().for_each(|stages| level(&mut stages.meshes[0]));
    let (difference, _) = against_dense(&pairs);
    assert!(difference < 1e-9, "{difference:.2e}");
}

// A tooth is missing in either mesh, so that both lose contact, and what happens in one is felt in the other.
#[test]
fn two_stages_that_lose_contact_move_as_with_dense_matrices() {
    let (difference, forces) = against_dense(&pairs_of_two_stages(Model::Contact));
    assert!(difference < 1e-9, "{difference:.2e}");
    assert!(forces.iter().all(|force| loses_contact(force)));
}
