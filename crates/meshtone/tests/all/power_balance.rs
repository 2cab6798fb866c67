//! What goes in comes out: torques and mesh force of ideal wheels over whole revolutions.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::TAU;

use crate::dense::outputs_from;
use crate::physics::*;
use meshtone::Equations;
use meshtone::published::machine::coordinates::{THETA_BRAKE, THETA_GEAR, THETA_PINION};
use meshtone::scenario::{Fault, GearPair, Model, Scenario, ToothBreakage};
use meshtone::solver::Output;

/// (N m, N m, N) Mean motor torque, mean torque of the brake's shaft and mean mesh force.
fn means(scenario: &Scenario) -> [f64; 3] {
    let stages = meshtone::stages(scenario).unwrap();
    // The rig's coordinates have the numbers that the published ones have.
    let angle = |number| Output::Coordinate { number, derivative: 0 };
    let outputs = [angle(THETA_PINION), angle(THETA_BRAKE), angle(THETA_GEAR), Output::MeshForce { mesh: 0 }];
    let first = stages.time.first_kept_sample;
    let [pinion_rad, brake_rad, gear_rad, force_n] =
        outputs_from(first, &stages, &outputs).try_into().unwrap();
    assert_eq!(pinion_rad.len(), stages.time.kept_samples());
    let (motor_rad, [motor, brake]): (Vec<f64>, _) = match &stages.equations {
        Equations::Machine(machine, _) => (
            scenario
                .motion(&stages.time)
                .map(|motion| TAU * motion.revolutions)
                .take(stages.time.samples)
                .collect(),
            [0, 1].map(|shaft| machine.shaft_stiffness_nm_per_rad[shaft]),
        ),
        Equations::Published(published) => (
            published.forcing().map(|forcing| forcing.motor_angle_rad).take(stages.time.samples).collect(),
            published.machine.shaft_stiffness_nm_per_rad,
        ),
    };
    let mean_twist_rad = |end: &[f64], start: &[f64]| {
        mean(&end.iter().zip(start).map(|(end, start)| end - start).collect::<Vec<f64>>())
    };
    [
        motor * mean_twist_rad(&motor_rad[first..], &pinion_rad),
        brake * mean_twist_rad(&brake_rad, &gear_rad),
        mean(&force_n),
    ]
}

/// (N m, N m, N) What the load asks for.
fn expected(scenario: &Scenario) -> [f64; 3] {
    let gears = &scenario.gears();
    let torque = scenario.operation.brake_torque_nm;
    let base_radius_m = gears.module_mm * 1e-3 * f64::from(gears.gear_teeth) / 2.0
        * gears.pressure_angle_deg.to_radians().cos();
    let ratio = f64::from(gears.pinion_teeth) / f64::from(gears.gear_teeth);
    [torque * ratio, torque, torque / base_radius_m]
}

fn pair(module: f64, z1: u32, z2: u32, width: f64, speed: f64, torque: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm: module,
        pinion_teeth: z1,
        gear_teeth: z2,
        face_width_mm: width,
        pinion_speed_hz: speed,
        brake_torque_nm: torque,
    });
    scenario.model = Model::Linear;
    scenario.meshes[0].points_per_tooth = 2_000;
    scenario.solver.sampling_rate_hz = 1e5;
    scenario
}

fn check(name: &str, scenario: &Scenario) {
    let (means, expected) = (means(scenario), expected(scenario));
    for ((quantity, mean), expected) in ["motor", "brake", "mesh"].iter().zip(means).zip(expected) {
        let off = deviation(mean, expected);
        println!("{name}, {quantity}: {mean:.4} instead of {expected:.4}, {:+.4} %", 100.0 * off);
        assert!(off.abs() < 1e-3, "{name}, {quantity}: {mean} instead of {expected}");
    }
}

// Over whole cycles of a periodic motion all accelerations and all velocities relative to the rigid rotation have mean
// zero, so the mean torques are in equilibrium exactly; 0.1 % is what the decay of the start leaves.
#[test]
fn torques_balance_under_linear() {
    check("17/38 at 40 Hz", &pair(3.0, 17, 38, 15.0, 40.0, 10.0));
    check("20/40 at 25 Hz", &pair(2.0, 20, 40, 20.0, 25.0, 30.0));
    check("40/20 at 25 Hz", &pair(2.0, 40, 20, 20.0, 25.0, 30.0));
    check("30/30 at 10 Hz", &pair(4.0, 30, 30, 25.0, 10.0, 200.0));
    let mut high_contact = pair(2.0, 60, 80, 20.0, 20.0, 50.0);
    high_contact.meshes[0].pressure_angle_deg = 14.5;
    check("60/80, 14.5°", &high_contact);
}

// A chipped tooth changes the stiffness and not the load.
#[test]
fn torques_balance_with_a_broken_tooth() {
    let mut scenario = pair(3.0, 17, 38, 15.0, 40.0, 10.0);
    let chip = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 10.0, tip_loss_mm: 0.0 };
    scenario.faults = vec![Fault::on_first_gear_tooth(chip)];
    check("17/38, broken", &scenario);
}

// The published damping acts on the whole velocity, so it takes a torque (C v) ω from the rigid rotation v; with it the
// gear's and the pinion's mean torques balance. What the load asks for is 187 N and 4.5 N m.
#[test]
fn published_damping_takes_power_from_the_rigid_rotation() {
    let mut scenario = Scenario::new(GearPair::example());
    scenario.model = Model::Published;
    let [motor, brake, force] = means(&scenario);
    println!("published: motor {motor:.3} N m, brake {brake:.3} N m, mesh {force:.2} N");
    let stages = meshtone::stages(&scenario).unwrap();
    let Equations::Published(published) = &stages.equations else { panic!("not published") };
    let machine = &published.machine;
    let damping = machine.damping_matrix() * machine.rigid_rotation() * (TAU * 40.0);
    let cos = 20f64.to_radians().cos();
    let (base_pinion, base_gear) = (0.0255 * cos, 0.057 * cos);
    assert_close(
        "published balance",
        1e-6,
        [
            (force * base_gear, brake - damping[THETA_GEAR]),
            (motor, force * base_pinion + damping[THETA_PINION]),
            (brake, 10.0 - damping[THETA_BRAKE]),
        ],
    );
    assert_close("mean mesh force, published", 1e-3, [(force, 1964.7)]);
    assert_close("mean motor torque, published", 1e-3, [(motor, 57.75)]);
    let [asked_motor, _, asked_force] = expected(&scenario);
    assert!((asked_force - 186.7).abs() < 0.1 && (asked_motor - 4.474).abs() < 1e-3);
}
