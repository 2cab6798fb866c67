//! Gyroscopic moments: natural frequencies against a dense eigenproblem, steps against a matrix exponential.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::TAU;

use crate::dense::{Recorded, machine_of};
use meshtone::machine::{Machine, Modes, Spinning};
use meshtone::mesh::Forcing;
use meshtone::operation::{Motion, TimeGrid};
use meshtone::scenario::*;
use meshtone::solver::{InitialMotion, ModalMachine, Output, Problem, integrate};
use meshtone::{Equations, InstructionSet, Stages, StepJudgement, simulate, stages};
use nalgebra::{DMatrix, DVector};

/// An overhung wheel of 96 teeth of module 3, as few elements as show it.
fn overhung(speed_hz: f64, change: impl Fn(&mut Scenario)) -> Scenario {
    let names = ["input", "output"];
    let shafts = names.iter().zip([Coupled::Motor, Coupled::Brake]).map(|(name, coupled)| {
        let mut shaft = GearboxShaft::new(name, 240.0, 12.0);
        (shaft.couples_to, shaft.elements) = (coupled, 4);
        shaft
    });
    let bearings = names.iter().flat_map(|name| [Bearing::new(name, 0.0), Bearing::new(name, 0.75)]);
    let mut scenario = Scenario::of_shafts(
        shafts.collect(),
        vec![
            ScenarioWheel::new("z1", "input", 0.95, 24, 20.0),
            ScenarioWheel::new("z2", "output", 0.95, 96, 20.0),
        ],
        vec![ScenarioMesh::new(["z1", "z2"], 3.0)],
        bearings.collect(),
        Operation::new(speed_hz, 20.0),
    );
    change(&mut scenario);
    scenario
}

fn spinning(stages: &Stages) -> &[Spinning] {
    match &stages.equations {
        Equations::Machine(assembled, _) => &assembled.spinning,
        Equations::Published(_) => &[],
    }
}

/// G in the machine's coordinates at a speed of the motor.
fn moments(machine: &Machine, spinning: &[Spinning], motor_rad_per_s: f64) -> DMatrix<f64> {
    let mut moments = DMatrix::zeros(machine.coordinates(), machine.coordinates());
    for &Spinning { about_x, polar_kgm2 } in spinning {
        moments[(about_x, about_x + 1)] += polar_kgm2 * motor_rad_per_s;
        moments[(about_x + 1, about_x)] -= polar_kgm2 * motor_rad_per_s;
    }
    moments
}

/// The motion of all coordinates and their rates: `(u, u̇)′ = A (u, u̇)`, with u̇ in units of `scale` times those of u.
fn motion(machine: &Machine, damping: &DMatrix<f64>, scale: f64) -> DMatrix<f64> {
    let n = machine.coordinates();
    let inverse = machine.mass.clone().cholesky().unwrap().inverse();
    let mut motion = DMatrix::zeros(2 * n, 2 * n);
    motion.view_mut((0, n), (n, n)).copy_from(&(DMatrix::identity(n, n) * scale));
    motion.view_mut((n, 0), (n, n)).copy_from(&(-&inverse * machine.stiffness() / scale));
    motion.view_mut((n, n), (n, n)).copy_from(&(-&inverse * damping));
    motion
}

#[test]
fn natural_frequencies_are_those_of_the_dense_eigenproblem() {
    let scenario = overhung(99.0, |scenario| scenario.solver.highest_mode_hz = Some(1e9));
    let stages = stages(&scenario).unwrap();
    let (machine, modes) = machine_of(&stages);
    let motor_rad_per_s = TAU * 99.0;
    let shifts = stages.gyroscopic_shifts(99.0);
    let highest = modes.angular_frequencies.iter().copied().fold(0.0, f64::max);
    let dense = motion(machine, &moments(machine, spinning(&stages), motor_rad_per_s), highest);
    let mut dense_hz: Vec<f64> =
        (dense.complex_eigenvalues().iter()).map(|value| value.im / TAU).filter(|hz| *hz > 1.0).collect();
    dense_hz.sort_by(f64::total_cmp);
    assert_eq!(dense_hz.len(), shifts.len());
    let off = shifts.iter().zip(&dense_hz).map(|(shift, dense)| (shift.shifted_hz / dense - 1.0).abs());
    let (largest, most_shifted) = (
        off.fold(0.0, f64::max),
        shifts.iter().map(|of| of.shifted_hz / of.frequency_hz - 1.0).fold(0.0, f64::max),
    );
    println!("{} modes, off by {largest:.1e}, shifted by up to {:.1} %", shifts.len(), 100.0 * most_shifted);
    assert!(largest < 1e-9 && most_shifted > 0.15, "{largest} {most_shifted}");
}

/// Tilts of the overhung wheel after a blow, by the solver and by the matrix exponential: the largest difference over the largest tilt.
fn error_of_steps(rate_hz: f64) -> f64 {
    let (speed_hz, length_s) = (60.0, 0.05);
    let stages = stages(overhung(speed_hz, |_| ())).unwrap();
    let (machine, modes) = machine_of(&stages);
    let stepped = machine.spinning.clone();
    assert!(!stepped.is_empty());
    let wheel = stepped[0].about_x;
    let lonely = Machine { lines: Vec::new(), ..machine.clone() };
    let nominal_rad_per_s = TAU * speed_hz;
    let mut velocity = &machine.rigid_rotation * nominal_rad_per_s;
    velocity[wheel] += 1.0;
    let start = InitialMotion {
        nominal_rad_per_s,
        brake_torque_nm: 0.0,
        motor_rad_per_s: nominal_rad_per_s,
        velocity: Some(velocity.as_slice()),
    };
    // The blow moves low modes alone.
    let highest = TAU * 8e3;
    let modal = ModalMachine::new(&lonely, modes, &[], start).up_to(highest);
    let samples_per_revolution = (rate_hz / speed_hz).round() as usize;
    let time = TimeGrid {
        sampling_rate_hz: samples_per_revolution as f64 * speed_hz,
        samples: (length_s * rate_hz) as usize,
        first_simulated_sample: 0,
        first_kept_sample: 0,
        samples_per_pinion_revolution: samples_per_revolution,
    };
    let outputs = [wheel, wheel + 1].map(|number| Output::Coordinate { number, derivative: 0 });
    let mut signals = Recorded(vec![Vec::new(); 2]);
    let operation = Operation::new(speed_hz, 0.0);
    let problem = Problem {
        time: &time,
        machine: modal,
        laws: Vec::new(),
        bearings: Vec::new(),
        forcing: Forcing::new(Motion::new(&operation, 1, &time), &time, [speed_hz, 0.0], 0, []),
        is_steady: true,
        hunting_period_samples: None,
        outputs: &outputs,
        first_sample: 0,
    };
    integrate(problem, InstructionSet::in_use(), &mut signals).unwrap();
    let exact = exact_tilts(&lonely, modes, (&stepped, nominal_rad_per_s), (wheel, highest), &time);
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, value| most.max(value.abs()));
    let off = signals.0.iter().zip(&exact).map(|(ours, exact)| {
        largest(&mut ours.iter().zip(exact).map(|(ours, exact)| ours - exact))
            / largest(&mut exact.iter().copied())
    });
    off.fold(0.0, f64::max)
}

/// The same of the exponential of the motion in the modes up to a frequency.
fn exact_tilts(
    machine: &Machine,
    modes: &Modes,
    (stepped, motor_rad_per_s): (&[Spinning], f64),
    (wheel, highest): (usize, f64),
    time: &TimeGrid,
) -> [Vec<f64>; 2] {
    let low: Vec<usize> =
        (0..modes.angular_frequencies.len()).filter(|&n| modes.angular_frequencies[n] <= highest).collect();
    let shapes =
        DMatrix::from_columns(&low.iter().map(|&n| modes.shapes.column(n).into_owned()).collect::<Vec<_>>());
    let gyroscopic = shapes.transpose() * moments(machine, stepped, motor_rad_per_s) * &shapes;
    let n = low.len();
    let motion = DMatrix::from_fn(2 * n, 2 * n, |row, column| match (row < n, column < n) {
        (true, true) => 0.0,
        (true, false) => f64::from(row + n == column),
        (false, true) if row == column + n => -modes.angular_frequencies[low[column]].powi(2),
        (false, true) => 0.0,
        (false, false) => {
            let damping = if row == column { modes.damping_per_s(low[row - n]) } else { 0.0 };
            -gyroscopic[(row - n, column - n)] - damping
        }
    });
    let step = (motion * time.step_s()).exp();
    let mut state = DVector::zeros(2 * n);
    let blow = shapes.transpose() * machine.mass.column(wheel);
    state.rows_mut(n, n).copy_from(&blow);
    let mut tilts = [Vec::new(), Vec::new()];
    for _ in 0..time.samples {
        for (about, tilts) in tilts.iter_mut().enumerate() {
            tilts.push(shapes.row(wheel + about).transpose().dot(&state.rows(0, n)));
        }
        state = &step * state;
    }
    tilts
}

#[test]
fn steps_ring_as_the_moments_make_them() {
    let [coarse, fine] = [5e4, 1e5].map(error_of_steps);
    println!("off by {coarse:.1e} at 50 kS/s and {fine:.1e} at 100 kS/s");
    assert!(fine < 1e-3 && coarse / fine > 3.0, "{coarse} {fine}");
}

// Nothing is added where little is shifted, and a run-up has the moments of each of its speeds.
#[test]
fn moments_are_stepped_where_they_matter() {
    let short = |scenario: &mut Scenario| {
        (scenario.solver.sampling_rate_hz, scenario.solver.duration_s) = (4e4, Some(0.1));
    };
    let is_spinning = |stages: &Stages| !stages.machine_and_modes().unwrap().0.spinning.is_empty();
    assert!(!is_spinning(&stages(overhung(0.5, short)).unwrap()));
    let fast = stages(overhung(60.0, short)).unwrap();
    assert!(is_spinning(&fast));
    assert!(
        fast.warnings().iter().all(|warning| warning.kind != WarningKind::Gyroscopic),
        "{:?}",
        fast.warnings()
    );
    let run_up = overhung(60.0, |scenario| {
        short(scenario);
        scenario.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, 0.1], value: vec![30.0, 60.0] });
        scenario.solver.duration_s = None;
    });
    let simulation = simulate(run_up).unwrap();
    let codes: Vec<_> = simulation.warnings_of_signals(StepJudgement::Estimated);
    assert!(codes.iter().all(|warning| warning.kind != WarningKind::TorqueImbalance), "{codes:?}");
}
