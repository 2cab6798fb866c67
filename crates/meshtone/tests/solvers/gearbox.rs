//! Gearboxes from their keys to their signals.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::sensor::{NamedSignal, SignalSource};
use std::f64::consts::TAU;

use crate::dense::Dense;
use crate::plain::plain;
use meshtone::batch::{Control, KeepOf, simulate_many};
use meshtone::scenario::*;
use meshtone::wheel::ErrorTable;
use meshtone::{MeshedPair, Simulation, Stages, StepJudgement, stages, stages_within};

fn gearbox(rig: Option<GearboxRig>) -> Scenario {
    plain(Scenario::from_toml(&gearbox_template(rig)).unwrap())
}

/// Two stages with teeth that have pitch deviations and run-out and no chamfer, of the references' steel.
fn two_stages() -> Scenario {
    let mut gearbox = gearbox(None);
    gearbox.material = Material::Given(MaterialConstants {
        youngs_modulus_gpa: 206.0,
        poisson_ratio: 0.3,
        density_kg_per_m3: 7850.0,
    });
    gearbox.sensors.clear();
    for (number, wheel) in gearbox.wheels.iter_mut().enumerate() {
        (wheel.iso_class, wheel.tip_chamfer_mm) = (0, Some(0.0));
        wheel.active_profile_shortening = 0.0;
        let wave =
            |tooth: u32| 1.5 * (TAU * f64::from(3 * tooth) / f64::from(wheel.teeth) + number as f64).sin();
        wheel.deviations.cumulative_pitch_um = Some((0..wheel.teeth).map(wave).collect());
        wheel.deviations.run_out_um = Some(6.0);
    }
    gearbox
}

fn simulate(gearbox: &Scenario) -> Simulation {
    meshtone::simulate(gearbox).unwrap()
}

/// The accelerations of the six seats.
fn accelerations(simulation: &Simulation) -> impl Iterator<Item = &NamedSignal> {
    let signals = simulation.channels.signals.iter().filter(|signal| signal.unit == "g");
    assert_eq!(signals.clone().count(), 6);
    signals
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn files_are_read_back() {
    let mut broken = gearbox(None);
    broken.faults = vec![Fault::new("z3", 7, MissingTooth)];
    broken.operation.torque_ripple =
        vec![Ripple { shaft: None, order: 2.0, amplitude: 0.1, phase_deg: 30.0 }];
    let feet =
        vec![Foot { at_mm: [0.0, -100.0, 0.0], stiffness_n_per_m: 5e7, vertical_stiffness_n_per_m: None }];
    let parts = broken.structure.shafts_mut().unwrap();
    parts.housing.as_mut().unwrap().feet = feet;
    parts.shafts[1].radius_mm = None;
    parts.shafts[1].segments = vec![[100.0, 8.0], [140.0, 10.0]];
    for gearbox in [broken, two_stages(), gearbox(Some(GearboxRig::Tecnalia))] {
        assert_eq!(Scenario::from_toml(&gearbox.to_toml()).unwrap(), gearbox);
    }
}

// T/r_b through the ratios; the mean of the motion is the same.
#[test]
fn published_rigs_carry_their_torque() {
    for rig in GearboxRig::ALL {
        let mut gearbox = gearbox(Some(rig));
        // Sets share their torque, and the shafts of a wind turbine are too slow for this.
        if !gearbox.planetary().is_empty() {
            continue;
        }
        gearbox.solver.duration_s = Some(0.5);
        let simulation = simulate(&gearbox);
        let stages = &simulation.stages;
        let base_m =
            |mesh: usize, wheel: WheelName| stages.pairs[mesh].teeth.wheel(wheel).base_radius_mm * 1e-3;
        let second_n = 20.0 / base_m(1, WheelName::Gear);
        let first_n = second_n * base_m(1, WheelName::Pinion) / base_m(0, WheelName::Gear);
        for (mesh, expected_n) in [first_n, second_n].into_iter().enumerate() {
            let found_n = stages.pairs[mesh].static_force_n;
            assert!((found_n / expected_n - 1.0).abs() < 1e-9, "{}: {found_n} N", rig.name());
            let name = format!("force_n.{}", gearbox.meshes[mesh].name());
            let mean_n = mean(simulation.channels.signal(&name).unwrap());
            assert!((mean_n / expected_n - 1.0).abs() < 1e-3, "{}: {mean_n} N", rig.name());
        }
    }
}

// The rms of the reference are of another draw of deviations, so that they tell a size only.
#[test]
fn stiffness_and_vibration_have_the_size_of_the_reference() {
    let simulation = simulate(&two_stages());
    let stages = &simulation.stages;
    for (mesh, [least, mean_k, most]) in
        stages.meshes.iter().zip([[121.4, 203.1, 231.8], [128.9, 215.5, 242.1]])
    {
        let sound = mesh.healthy_stiffness_n_per_mm();
        let extreme = |of: fn(f64, f64) -> f64, from: f64| sound.iter().copied().fold(from, of) * 1e-3;
        for (found, expected) in [
            (extreme(f64::min, f64::INFINITY), least),
            (mesh.mean_stiffness_n_per_m * 1e-6, mean_k),
            (extreme(f64::max, 0.0), most),
        ] {
            // The reference has the former compliance of the wheels' bodies.
            println!("{found:.1}, reference {expected} kN/mm");
            assert!((found / expected - 1.0).abs() < 0.08, "{found}, not {expected} kN/mm");
        }
    }
    for (signal, expected) in simulation.channels.signals.iter().zip([13.56, 14.23, 3.84, 8.62, 5.17, 7.00]) {
        let found = 9.81 * rms(&signal.values);
        println!("{}: {found:.2} m/s², reference {expected}", signal.name);
        assert!(found > 0.2 * expected && found < 5.0 * expected);
    }
    let [steps, iterations, most, searched] = simulation.step_counts;
    assert!(
        steps >= 100_000 && iterations < 3 * steps && most <= 6 && searched == 0,
        "{iterations} {most} {searched}"
    );
}

// All modes, the same integrator and inputs, with dense matrices. Few elements keep these small.
#[test]
fn gearbox_moves_as_with_dense_matrices() {
    let mut gearbox = two_stages();
    gearbox.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.elements = 4);
    // 105 samples for a pitch of the first mesh, 210 for one of the second.
    gearbox.solver.sampling_rate_hz = 105.0 * 32.0 * 30.0;
    gearbox.structure.shafts_mut().unwrap().housing = None;
    gearbox.solver.highest_mode_hz = Some(1e9);
    gearbox.solver.settle_fraction = 0.0;
    gearbox.solver.duration_s = Some(0.003);
    let simulation = simulate(&gearbox);
    let stages = &simulation.stages;
    let (machine, _) = stages.machine_and_modes().unwrap();
    let time = &stages.time;
    let dense = Dense::of(stages, time.samples);
    let accelerations = dense.accelerations();
    for (sensor, signal) in stages.sensors.iter().zip(&simulation.channels.signals) {
        let weights = machine.weights(&sensor.name(), meshtone::machine::Axis::Y);
        let theirs: Vec<f64> = accelerations.iter().map(|sample| sample.dot(&weights) / 9.81).collect();
        let error: Vec<f64> = theirs.iter().zip(&signal.values).map(|(a, b)| a - b).collect();
        println!("{}: {:.1e} of {:.3} g", signal.name, rms(&error) / rms(&theirs), rms(&theirs));
        assert!(rms(&error) < 1e-6 * rms(&theirs));
    }
}

#[test]
fn high_modes_are_flexibility_enough() {
    let mut gearbox = two_stages();
    gearbox.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.elements = 6);
    gearbox.solver.duration_s = Some(0.3);
    let truncated = simulate(&gearbox);
    gearbox.solver.highest_mode_hz = Some(1e9);
    let whole = simulate(&gearbox);
    for (few, all) in accelerations(&truncated).zip(accelerations(&whole)) {
        let difference = rms(&few.values) / rms(&all.values) - 1.0;
        println!("{}: {:.2} %", few.name, 100.0 * difference);
        assert!(difference.abs() < 0.01);
    }
}

// What is left out of accelerations and speeds is missing there, but teeth are where they are with all modes.
#[test]
fn few_modes_leave_transmission_errors_as_they_are() {
    let mut steady = two_stages();
    steady.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.elements = 6);
    steady.solver.duration_s = Some(0.2);
    let mut run_up = steady.clone();
    run_up.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 0.4], value: vec![20.0, 40.0] });
    (run_up.solver.duration_s, run_up.solver.settle_fraction) = (None, 0.5);
    for (gearbox, highest_hz, vibration_um) in
        [(&steady, 5e3, 0.03), (&steady, 500.0, 0.8), (&run_up, 5e3, 0.03)]
    {
        let [few, all] = [highest_hz, 1e9].map(|highest_hz| {
            let mut gearbox = gearbox.clone();
            gearbox.solver.highest_mode_hz = Some(highest_hz);
            simulate(&gearbox).channels
        });
        for (few, all) in few.signals.iter().zip(&all.signals) {
            let differences: Vec<f64> =
                few.values.iter().zip(&all.values).map(|(few, all)| few - all).collect();
            let (mean, rms) = (mean(&differences), rms(&differences));
            println!("{} up to {highest_hz} Hz: {mean:.1e} {}, vibrating {rms:.1e}", few.name, few.unit);
            match few.unit {
                // The load along the faces follows from the wheels' tilts, of which little is left below 500 Hz.
                "µm" => assert!(mean.abs() < 0.04 && rms < vibration_um),
                "Hz" => assert!(mean.abs() < 1e-5),
                _ => {}
            }
        }
    }
}

#[test]
fn half_the_step_changes_little() {
    let mut gearbox = two_stages();
    gearbox.solver.duration_s = Some(0.3);
    let [coarse, fine] = [1e5, 2e5].map(|rate_hz| {
        gearbox.solver.sampling_rate_hz = rate_hz;
        simulate(&gearbox)
    });
    for (coarse, fine) in accelerations(&coarse).zip(accelerations(&fine)) {
        let difference = rms(&coarse.values) / rms(&fine.values) - 1.0;
        println!("{}: {:.2} %", coarse.name, 100.0 * difference);
        assert!(difference.abs() < 0.02);
    }
}

// The train repeats after 15 revolutions of the input: lines lie at multiples of 1/15 of its order only.
#[test]
fn motion_repeats_after_a_cycle() {
    let mut gearbox = two_stages();
    gearbox.solver.discard_and_keep(2.0, 1.0);
    gearbox.solver.settle_tolerance = 0.0;
    let simulation = simulate(&gearbox);
    assert_eq!(simulation.stages.layout.cycle_revolutions(), 15);
    let cycle = 15 * simulation.stages.time.samples_per_pinion_revolution;
    for signal in accelerations(&simulation) {
        let difference: Vec<f64> =
            signal.values[..cycle].iter().zip(&signal.values[cycle..2 * cycle]).map(|(a, b)| a - b).collect();
        // Half of the difference is what lies between the lines.
        let part = (rms(&difference) / 2.0 / rms(&signal.values)).powi(2);
        println!("{}: {part:.1e} of the energy", signal.name);
        assert!(part < 1e-4);
    }
}

/// An idler with its mates in given directions.
fn idler(teeth: [u32; 3], [first_deg, second_deg]: [f64; 2]) -> Scenario {
    let radius_mm = |wheel: usize| f64::from(teeth[wheel]);
    let at = |direction_deg: f64, distance_mm: f64| {
        let (sin, cos) = direction_deg.to_radians().sin_cos();
        [distance_mm * cos, distance_mm * sin]
    };
    let positions =
        [at(first_deg, radius_mm(0) + radius_mm(1)), [0.0; 2], at(second_deg, radius_mm(1) + radius_mm(2))];
    let names = ["a", "b", "c"];
    let coupled = [Coupled::Motor, Coupled::Nothing, Coupled::Brake];
    let shafts = (0..3).map(|n| {
        let mut shaft = GearboxShaft::new(names[n], 100.0, 5.0);
        (shaft.position_mm, shaft.couples_to) = (Some(positions[n]), coupled[n]);
        shaft
    });
    let wheels = (0..3).map(|n| ScenarioWheel::new(["z1", "z2", "z3"][n], names[n], 0.5, teeth[n], 20.0));
    let bearings = names.iter().flat_map(|name| [Bearing::new(name, 0.0), Bearing::new(name, 1.0)]);
    Scenario::of_shafts(
        shafts.collect(),
        wheels.collect(),
        vec![ScenarioMesh::new(["z1", "z2"], 2.0), ScenarioMesh::new(["z2", "z3"], 2.0)],
        bearings.collect(),
        Operation::new(30.0, 10.0),
    )
}

// Numbers of involute flanks intersected with the lines of action. The idler turns against the input, and so in the negative sense: the
// mirror image of a train that turns in the positive one.
#[test]
fn idler_phases_are_those_of_its_flanks() {
    for (teeth, [first_deg, second_deg], expected) in [
        ([24, 36, 30], [180.0, 0.0], 0.480534),
        ([24, 35, 30], [180.0, 0.0], 0.983442),
        ([20, 40, 25], [180.0, 70.0], 0.671281),
        ([20, 40, 25], [180.0, -70.0], 0.226837),
        ([23, 41, 57], [200.0, -33.0], 0.065243),
    ] {
        let layout = idler(teeth, [-first_deg, -second_deg]).layout().unwrap();
        let found = (layout.phases[1] - layout.phases[0]).rem_euclid(1.0);
        println!("{teeth:?}: {found:.6}, not {expected}");
        assert!((found - expected).abs() < 1e-6, "{teeth:?}: {found:.6}, not {expected}");
    }
}

fn profile_errors(teeth: u32, of: f64) -> ErrorTable {
    let mut errors = ErrorTable::filled(ERROR_POINTS, teeth as usize, of);
    errors[(7, 3)] = 2.0 * of;
    errors
}

/// The profile errors of the driving and of the driven wheel of each mesh; none of ideal wheels.
fn errors_of_meshes(gearbox: &Scenario) -> Vec<Option<[ErrorTable; 2]>> {
    let of_pair = |pair: MeshedPair| {
        pair.profile_errors.map(|of| [of.pinion_profile_errors_mm, of.gear_profile_errors_mm])
    };
    stages(gearbox).unwrap().pairs.into_iter().map(of_pair).collect()
}

// The given errors are those of the flanks that work in the wheel's first mesh.
#[test]
fn given_profile_errors_are_of_the_flanks_that_work_in_the_first_mesh() {
    let mut gearbox = idler([24, 36, 30], [180.0, 0.0]);
    let of_idler = profile_errors(36, 1e-3);
    gearbox.wheels[1].profile_errors_mm = Some(of_idler.clone());
    let ideal = |teeth: usize| ErrorTable::filled(ERROR_POINTS, teeth, 0.0);
    assert_eq!(errors_of_meshes(&gearbox), [Some([ideal(24), of_idler]), None]);
}

// The power goes both ways round a rhombus: its first wheel drives in two meshes, and its last is driven in two.
#[test]
fn a_wheel_on_the_same_side_of_two_meshes_has_its_profile_errors_in_both() {
    let half_mm = (48.0_f64.powi(2) - 40.0_f64.powi(2)).sqrt();
    let shafts = [
        ("a", [0.0, 0.0], Coupled::Motor),
        ("b", [40.0, half_mm], Coupled::Nothing),
        ("c", [40.0, -half_mm], Coupled::Nothing),
        ("d", [80.0, 0.0], Coupled::Brake),
    ];
    let shaft = |(name, position_mm, couples_to): (&str, [f64; 2], Coupled)| {
        let mut shaft = GearboxShaft::new(name, 100.0, 5.0);
        (shaft.position_mm, shaft.couples_to) = (Some(position_mm), couples_to);
        shaft
    };
    let mut gearbox = Scenario::of_shafts(
        shafts.map(shaft).to_vec(),
        shafts.map(|(name, ..)| ScenarioWheel::new(&format!("z{name}"), name, 0.5, 24, 20.0)).to_vec(),
        [["za", "zb"], ["za", "zc"], ["zb", "zd"], ["zc", "zd"]]
            .map(|of| ScenarioMesh::new(of, 2.0))
            .to_vec(),
        shafts.iter().flat_map(|(name, ..)| [Bearing::new(name, 0.0), Bearing::new(name, 1.0)]).collect(),
        Operation::new(30.0, 10.0),
    );
    let (first, last) = (profile_errors(24, 1e-3), profile_errors(24, 2e-3));
    gearbox.wheels[0].profile_errors_mm = Some(first.clone());
    gearbox.wheels[3].profile_errors_mm = Some(last.clone());
    let ideal = || ErrorTable::filled(ERROR_POINTS, 24, 0.0);
    let (drives, driven) = (Some([first, ideal()]), Some([ideal(), last]));
    assert_eq!(errors_of_meshes(&gearbox), [drives.clone(), drives, driven.clone(), driven]);
}

/// A gearbox of the one pair of the short form's example.
fn one_pair() -> Scenario {
    let names = ["input", "output"];
    let coupled = [Coupled::Motor, Coupled::Brake];
    let shafts = (0..2).map(|n| {
        let mut shaft = GearboxShaft::new(names[n], 200.0, 10.0);
        shaft.couples_to = coupled[n];
        shaft
    });
    let bearings = names.iter().flat_map(|name| [Bearing::new(name, 0.0), Bearing::new(name, 1.0)]);
    Scenario::of_shafts(
        shafts.collect(),
        vec![
            ScenarioWheel::new("z1", "input", 0.5, 17, 15.0),
            ScenarioWheel::new("z2", "output", 0.5, 38, 15.0),
        ],
        vec![ScenarioMesh::new(["z1", "z2"], 3.0)],
        bearings.collect(),
        Operation::new(40.0, 10.0),
    )
}

#[test]
fn one_pair_has_the_forces_and_stiffness_of_the_short_form() {
    let long: Stages = stages(one_pair()).unwrap();
    let scenario = Scenario::new(GearPair::example());
    let short = meshtone::stages(&scenario).unwrap();
    assert!((long.pairs[0].static_force_n / short.static_force_n() - 1.0).abs() < 1e-9);
    // The tables of both have other points.
    let points = long.meshes[0].points_per_pitch.try_into().unwrap();
    let mesh = &short.meshes_at(points).unwrap()[0];
    assert!((long.meshes[0].mean_stiffness_n_per_m / mesh.mean_stiffness_n_per_m - 1.0).abs() < 1e-9);
    let error = |mesh: &meshtone::mesh::Mesh| mesh.at_rest(short.static_force_n(), 0..38).peak_to_peak_m();
    assert!((error(&long.meshes[0]) / error(mesh) - 1.0).abs() < 1e-9);
}

#[test]
fn a_ripple_of_the_torque_comes_with_the_brakes_shaft() {
    let mut gearbox = one_pair();
    gearbox.operation.torque_ripple =
        vec![Ripple { shaft: None, order: 1.0, amplitude: 0.2, phase_deg: 0.0 }];
    gearbox.solver.discard_and_keep(1.0, 0.95);
    let simulation = simulate(&gearbox);
    let force = simulation.channels.signal("force_n.z1-z2").unwrap();
    // 38 revolutions of the input are 17 of the brake.
    let samples = force.len() as f64;
    let line = |turns: f64| {
        let angle = |n: usize| TAU * turns * n as f64 / samples;
        let [cos, sin] = [f64::cos, f64::sin].map(|of| {
            force.iter().enumerate().map(|(n, value)| value * of(angle(n))).sum::<f64>() * 2.0 / samples
        });
        cos.hypot(sin)
    };
    let static_force_n = simulation.stages.pairs[0].static_force_n;
    println!("{} {}", line(17.0) / static_force_n, line(19.0) / static_force_n);
    // The first torsional mode, at 48 Hz, makes 1.16 times as much of the ripple's 18 Hz.
    assert!((line(17.0) / static_force_n / 0.2 - 1.16).abs() < 0.05);
    assert!(line(19.0) < 0.02 * static_force_n);
}

#[test]
fn a_missing_tooth_of_any_wheel_is_felt_once_a_revolution() {
    let mut gearbox = two_stages();
    // On slender shafts the flanks of sound teeth part too.
    let shafts = &mut gearbox.structure.shafts_mut().unwrap().shafts;
    shafts.iter_mut().for_each(|shaft| shaft.radius_mm = Some(20.0));
    // Without chamfers the tip corners of the neighbours hold the wheels.
    gearbox.wheels.iter_mut().for_each(|wheel| wheel.tip_chamfer_mm = None);
    gearbox.solver.duration_s = Some(0.5);
    gearbox.faults = vec![Fault::new("z3", 5, MissingTooth)];
    let simulation = simulate(&gearbox);
    assert_eq!(simulation.stages.fault_severities, [1.0]);
    let mesh = &simulation.stages.meshes[1];
    let stiffness = mesh.stiffness_n_per_mm(0..2 * 48);
    let sound = mesh.healthy_stiffness_n_per_mm();
    let differs =
        |point: &usize| (stiffness[*point] / sound[point % mesh.points_per_pitch] - 1.0).abs() > 1e-9;
    let mut pitches: Vec<usize> =
        (0..stiffness.len()).filter(differs).map(|point| point / mesh.points_per_pitch).collect();
    pitches.dedup();
    // The fifth tooth enters contact after four pitches, and would leave it less than two later.
    println!("{pitches:?}");
    assert_eq!(pitches, [4, 5, 52, 53]);
    gearbox.faults.clear();
    let sound = simulate(&gearbox);
    let force = |of: &Simulation| of.channels.signal("force_n.z3-z4").unwrap().to_vec();
    let (broken_n, sound_n) = (force(&simulation), force(&sound));
    // The pairs beside the gap catch the wheels: flanks part, and meet again.
    assert!(broken_n.contains(&0.0) && !sound_n.contains(&0.0));
    let differs: Vec<f64> = broken_n.iter().zip(&sound_n).map(|(a, b)| (a - b).abs()).collect();
    let hits = differs.chunks(simulation.stages.time.samples_per_pinion_revolution * 3);
    assert!(
        hits.map(|revolution| revolution.iter().copied().fold(0.0, f64::max)).all(|largest| largest > 100.0)
    );
}

#[test]
fn mistakes_are_named_with_their_key_and_line() {
    let text = gearbox_template(None);
    let change = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        Scenario::from_toml(&text.replacen(from, to, 1)).unwrap_err()
    };
    for (from, to, key, problem) in [
        ("shaft = \"input\"", "shaft = \"inptu\"", "wheel[0].shaft", "is no shaft's name"),
        (
            "wheels = [\"z1\", \"z2\"]",
            "wheels = [\"z2\", \"z1\"]",
            "mesh[0].wheels",
            "names the driven wheel first",
        ),
        ("wheels = [\"z3\", \"z4\"]", "wheels = [\"z3\", \"z5\"]", "mesh[1].wheels[1]", "is no wheel's name"),
        ("couples_to = \"brake\"\n", "", "shaft.couples_to", "no shaft couples to the brake"),
        ("at = 0.25", "at = 0.5", "mesh[0].wheels", "middle planes"),
        ("name = \"z2\"", "name = \"z1\"", "wheel[1].name", "is the name of wheel[0] already"),
        ("seed = 1", "seed = 1\n[gears]\nmodule_mm = 3.0\n[other]", "gears", "given beside shaft"),
        ("seed = 1", "model = \"published\"", "model", "must be \"contact\""),
        ("at = \"input:0\"", "at = \"input:0.5\"", "sensor[0].at", "names no bearing's place"),
        ("teeth = 96", "teeth = 96\nprofile_shift = 3.0", "wheel[1].profile_shift", "must be from"),
        ("input_speed_hz = 30.0", "input_speed_hz = 1800.0", "operation.input_speed_hz", "287 m/s"),
        (
            "[operation]",
            "[[fault]]\nwheel = \"z3\"\ntooth = 49\nkind = \"missing-tooth\"\n[operation]",
            "fault.tooth",
            "z3's teeth",
        ),
        (
            "face_width_mm = 19.05",
            "face_width_mm = 19.05\nprofile_shift = -0.9",
            "wheel[0].profile_shift",
            "must be at least -0.8716",
        ),
    ] {
        let error = change(from, to);
        assert_eq!(error.key, key, "{error}");
        assert!(error.problem.contains(problem), "{error}");
        let missing = from.starts_with("couples_to");
        assert!(error.line.is_some() || missing, "{error}");
    }
    let overlapping = Scenario::from_toml(&text.replace("at = 0.75", "at = 0.3")).unwrap_err();
    let outside = Scenario::from_toml(&text.replace("at = 0.25", "at = 0.03")).unwrap_err();
    assert_eq!((outside.key.as_str(), outside.line), ("wheel[0].at", Some(33)));
    assert!(outside.problem.contains("would reach from z = -2.325 to 16.725 mm"), "{outside}");
    assert_eq!(overlapping.key, "wheel[2].at");
    assert!(overlapping.problem.contains("\"z3\" reaches from z = 62.475 to 81.525 mm"), "{overlapping}");
    let placed =
        text.replacen("couples_to = \"motor\"", "couples_to = \"motor\"\nposition_mm = [0.0, 0.0]", 1);
    let placed = placed.replacen("name = \"middle\"", "name = \"middle\"\nposition_mm = [90.0, 0.0]", 1);
    let error = Scenario::from_toml(&placed).unwrap_err();
    assert_eq!(error.key, "shaft[1].position_mm");
    assert!(
        error
            .problem
            .contains("is 90.0000 mm from the axis of its mating shaft, but the wheels of mesh z1-z2 mesh at 101.6000 mm"),
        "{error}"
    );
    // The number of a fault is that in the file, whichever mesh its wheel is in.
    let fault =
        |wheel: &str| format!("[[fault]]\nwheel = \"{wheel}\"\ntooth = 5\nkind = \"missing-tooth\"\n");
    let faults = [fault("z1"), fault("z4"), fault("z4")].concat();
    let error = change("[operation]", &format!("{faults}[operation]"));
    assert_eq!(error.key, "fault[2].kind");
    assert!(error.problem.starts_with("tooth 5 of z4 has fault[1] already"), "{error}");
    let error = change("pressure_angle_deg = 20.0", "pressure_angle_deg = 35.0\nbacklash_mm = 2.0");
    assert_eq!((error.key.as_str(), error.line), ("mesh[0].backlash_mm", Some(67)), "{error}");
    let gearbox = Scenario::from_toml(&text).unwrap();
    let pair = gearbox.expect_pair().unwrap_err();
    assert!(pair.problem.contains("is of a gearbox"), "{pair}");
}

// The last wheel stands beside the first, whose tips it would run into: their axes are twice the pitch radii of 40 teeth apart.
#[test]
fn wheels_of_other_shafts_do_not_run_into_one_another() {
    let shaft = |name: &str, direction_deg: f64, coupled: Coupled| {
        let mut shaft = GearboxShaft::new(name, 100.0, 5.0);
        let (sin, cos) = f64::to_radians(direction_deg).sin_cos();
        let distance_mm = if name == "middle" { 0.0 } else { 60.0 };
        shaft.position_mm = Some([distance_mm * cos, distance_mm * sin]);
        shaft.couples_to = coupled;
        shaft
    };
    let with_last_at = |direction_deg: f64| {
        let shafts = vec![
            shaft("input", 0.0, Coupled::Motor),
            shaft("middle", 0.0, Coupled::Nothing),
            shaft("output", direction_deg, Coupled::Brake),
        ];
        let names = ["input", "middle", "output"];
        let wheels =
            (0..3).map(|n| ScenarioWheel::new(["z1", "z2", "z3"][n], names[n], 0.5, [40, 20, 40][n], 20.0));
        let bearings = names.iter().flat_map(|name| [Bearing::new(name, 0.0), Bearing::new(name, 1.0)]);
        let meshes = vec![ScenarioMesh::new(["z1", "z2"], 2.0), ScenarioMesh::new(["z2", "z3"], 2.0)];
        Scenario::of_shafts(shafts, wheels.collect(), meshes, bearings.collect(), Operation::new(30.0, 10.0))
    };
    assert!(with_last_at(180.0).validate().is_ok());
    let error = with_last_at(80.0).validate().unwrap_err();
    assert_eq!(error.key, "wheel[2].at");
    assert!(
        error
            .problem
            .contains("their axes are 77.135 mm apart, less than the tip radii, 42.000 and 42.000 mm"),
        "{error}"
    );
}

fn codes(warnings: &[ScenarioWarning]) -> Vec<&'static str> {
    warnings.iter().map(|warning| warning.kind.code()).collect()
}

#[test]
fn warnings_are_those_of_a_pair_mesh_by_mesh() {
    let mut settled = gearbox(None);
    settled.solver.discard_and_keep(5.0, 0.1);
    let warnings = |change: &dyn Fn(&mut Scenario)| {
        let mut gearbox = settled.clone();
        change(&mut gearbox);
        // The template's shafts lean.
        let warnings = stages(&gearbox).unwrap().warnings();
        warnings.into_iter().filter(|warning| warning.kind != WarningKind::UnevenFace).collect::<Vec<_>>()
    };
    assert!(warnings(&|_| ()).is_empty());
    let overload = warnings(&|gearbox| gearbox.operation.brake_torque_nm = 4000.0);
    assert_eq!(codes(&overload), ["overload", "overload"]);
    assert!(overload.iter().any(|warning| warning.message.contains("at most 3020 N m")), "{overload:?}");
    // Each mesh that would break is named; without a nominal torque the profile's counts all the same.
    let both = warnings(&|gearbox| {
        gearbox.operation.brake_torque_nm = 0.0;
        gearbox.solver.duration_s = None;
        gearbox.operation.torque_profile_nm =
            Some(Profile { time_s: vec![0.0, 5.1], value: vec![10.0, 20_000.0] });
    });
    let named = |of: &str, kind| {
        let about = |warning: &&ScenarioWarning| warning.kind == kind && warning.message.contains(of);
        both.iter().filter(about).count()
    };
    for mesh in ["the teeth of mesh z1-z2", "the teeth of mesh z3-z4"] {
        assert_eq!(named(mesh, WarningKind::Overload), 1, "{both:?}");
    }
    assert!(both.iter().any(|warning| warning.key == "operation.torque_profile_nm.value[1]"), "{both:?}");
    // What is stepped is not warned of.
    let fast = warnings(&|gearbox| gearbox.operation.pinion_speed_hz = 200.0);
    assert!(!codes(&fast).contains(&"gyroscopic"), "{fast:?}");
    let run_up = warnings(&|gearbox| {
        gearbox.solver.duration_s = None;
        gearbox.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, 5.1], value: vec![10.0, 205.0] });
    });
    assert!(!codes(&run_up).contains(&"gyroscopic"), "{run_up:?}");
    // What is given is not drawn, and a share of it has no effect.
    let ignored = warnings(&|gearbox| {
        let [first, second, ..] = &mut gearbox.wheels[..] else { unreachable!() };
        first.iso_class = 0;
        first.profile_errors_mm = Some(ErrorTable::filled(ERROR_POINTS, 32, 1e-3));
        (first.tooth_share, first.run_out_share) = (0.1, 0.1);
        // At their defaults.
        (first.pitch_share, first.slope_wobble) = (0.5, 1.0);
        second.deviations.run_out_um = Some(5.0);
        (second.tooth_share, second.run_out_share) = (0.1, 0.1);
    });
    let keys: Vec<&str> = ignored.iter().map(|warning| warning.key.as_str()).collect();
    assert_eq!(keys, ["wheel[0].tooth_share", "wheel[0].run_out_share", "wheel[1].run_out_share"]);
    assert!(codes(&ignored).iter().all(|code| *code == "ignored-key"), "{ignored:?}");
    assert!(ignored[0].message.contains("beside given profile errors"), "{}", ignored[0]);
    assert!(ignored[2].message.contains("remove run_out_share, or the run-outs"), "{}", ignored[2]);
    let undamped = warnings(&|gearbox| {
        gearbox.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.damping_ratio = 0.0);
        gearbox.bearings_mut().iter_mut().for_each(|bearing| bearing.damping_ratio = 0.0);
        gearbox.meshes.iter_mut().for_each(|mesh| mesh.damping_ratio = 0.0);
        gearbox.structure.shafts_mut().unwrap().housing = None;
    });
    assert_eq!(codes(&undamped), ["unsettled"]);
    assert!(undamped[0].message.ends_with("it never decays: a mode has no damping"), "{}", undamped[0]);
    let long = warnings(&|gearbox| {
        (gearbox.wheels[1].teeth, gearbox.wheels[3].teeth) = (97, 79);
    });
    // 32/97 · 48/79 in lowest terms.
    assert_eq!(codes(&long), ["long-cycle"]);
    assert!(long[0].message.contains("hunting-tooth period is 7663 revolutions"), "{}", long[0]);
    let undercut = warnings(&|gearbox| {
        (gearbox.wheels[2].teeth, gearbox.wheels[3].teeth) = (16, 96);
        gearbox.meshes[1].module_mm = 2.0;
    });
    assert!(undercut.iter().any(|warning| warning.key == "wheel[2].teeth"), "{undercut:?}");
    let slow = warnings(&|gearbox| {
        gearbox.operation.speed_profile_hz =
            Some(Profile { time_s: vec![0.0, 5.1], value: vec![10.0, 20.0] });
        (gearbox.solver.duration_s, gearbox.solver.settle_fraction) = (None, 0.9);
    });
    assert_eq!(codes(&slow), ["speed-profile-off"]);
    assert!(slow[0].message.contains("operation.input_speed_hz"), "{}", slow[0]);
}

// Deviations of micrometres make forces of tens of newtons, whatever the load.
#[test]
fn forces_far_beyond_the_load_are_reported_of_each_mesh() {
    let mut gearbox = gearbox(None);
    gearbox.solver.duration_s = Some(0.2);
    gearbox.operation.brake_torque_nm = 1e-3;
    let warnings = simulate(&gearbox).warnings_of_signals(StepJudgement::Estimated);
    let resonances: Vec<_> =
        warnings.iter().filter(|warning| warning.kind == WarningKind::Resonance).collect();
    let [first, second] = resonances[..] else { panic!("{warnings:?}") };
    assert!(first.message.starts_with("the force of mesh z1-z2 reaches"), "{first}");
    assert!(second.message.starts_with("the force of mesh z3-z4 reaches"), "{second}");
    assert_eq!(first.key, "operation.input_speed_hz");
}

#[test]
fn a_shaft_that_turns_at_another_speed_is_told() {
    let mut gearbox = gearbox(None);
    gearbox.solver.duration_s = Some(0.2);
    let mut simulation = simulate(&gearbox);
    let slipping = |simulation: &Simulation| {
        let warnings = simulation.warnings_of_signals(StepJudgement::Estimated);
        warnings.into_iter().filter(|warning| warning.kind == WarningKind::OtherSpeed).collect::<Vec<_>>()
    };
    assert!(slipping(&simulation).is_empty());
    let speed =
        simulation.channels.signals.iter_mut().find(|signal| signal.name == "speed_hz.output").unwrap();
    speed.values.iter_mut().for_each(|speed_hz| *speed_hz *= 0.75);
    let told = slipping(&simulation);
    assert_eq!(told.len(), 1, "{told:?}");
    let words = "shaft \"output\" turns at 4.5000 Hz on average, while the motor drives it at 6.0000 Hz";
    assert!(told[0].message.starts_with(words), "{}", told[0]);
}

// Machines are told apart by their masses and springs.
#[test]
fn a_batch_gives_each_what_it_gives_alone() {
    let mut short = two_stages();
    short.solver.duration_s = Some(0.05);
    let mut stiffer = short.clone();
    stiffer.bearings_mut()[0].stiffness_n_per_m *= 2.0;
    let mut wrong = short.clone();
    wrong.wheels[0].at = 0.5;
    let boxes = [short.clone(), stiffer, wrong, short];
    let mut together = Vec::new();
    let keep = KeepOf(|_: usize, simulation: Simulation| simulation.channels);
    simulate_many(boxes.clone(), &keep, &Control::default(), |_, kept| together.push(kept));
    for (gearbox, together) in boxes.iter().zip(&together) {
        match (meshtone::simulate(gearbox).map(|simulation| simulation.channels), together) {
            (Ok(alone), Ok(together)) => assert_eq!(alone, *together),
            (Err(alone), Err(together)) => assert_eq!(alone, *together),
            other => panic!("{other:?}"),
        }
    }
    assert!(together[2].is_err() && together[0] == together[3] && together[0] != together[1]);
}

// Of all modes near three times the first mesh frequency, the one at 4.4 kHz moves the teeth by more than their load at rest does.
#[test]
fn a_mesh_frequency_at_a_natural_frequency_is_reported() {
    let mut gearbox = gearbox(None);
    gearbox.solver.discard_and_keep(5.0, 0.1);
    let mut reported = |speed_hz: f64| {
        gearbox.operation.pinion_speed_hz = speed_hz;
        let warnings = stages(&gearbox).unwrap().warnings();
        warnings.into_iter().find(|warning| warning.kind == WarningKind::MeshResonance)
    };
    assert_eq!(reported(30.0), None);
    let warning = reported(4422.4 / 96.0 * 1.009).unwrap();
    assert!(warning.message.contains("4422.4 Hz by 4462.2 Hz, 3 times that of mesh z1-z2"), "{warning}");
    assert_eq!(reported(4422.4 / 96.0 * 1.02), None);
}

// At 20 kS/s modes of several kilohertz are met that the step shifts.
#[test]
fn a_step_that_is_too_long_is_reported() {
    let mut gearbox = gearbox(Some(GearboxRig::Uconn));
    gearbox.solver.sampling_rate_hz = 2e4;
    gearbox.solver.duration_s = Some(0.5);
    let simulation = simulate(&gearbox);
    let warnings = simulation.warnings_of_signals(StepJudgement::Repeated);
    assert_eq!(codes(&warnings), ["step-error"], "{warnings:?}");
    assert!(warnings[0].message.contains("at 40020 S/s the rms is"), "{}", warnings[0]);
    gearbox.solver.sampling_rate_hz = 4e5;
    gearbox.solver.duration_s = Some(0.2);
    let warnings = simulate(&gearbox).warnings_of_signals(StepJudgement::Repeated);
    assert!(warnings.is_empty(), "{warnings:?}");
    // What the repetition may need is limited as the first simulation is: without it there is the estimate alone. Of better wheels, whose
    // teeth do not part, all is repeated.
    gearbox.solver.sampling_rate_hz = 2e4;
    gearbox.wheels.iter_mut().for_each(|wheel| wheel.iso_class = 3);
    let limited = |bytes: u64| {
        let stages = stages_within(&gearbox, MemoryLimit::Given { bytes }).unwrap();
        stages.simulate().unwrap().warnings_of_signals(StepJudgement::Repeated)
    };
    let [once, twice] = [2_000_000, 4_000_000].map(limited);
    assert!(once[0].message.contains("the rms may be wrong by"), "{}", once[0]);
    assert!(twice[0].message.contains("at 40020 S/s the rms is"), "{}", twice[0]);
}

// Only one tooth is left of a wheel, and whenever it meets its mate the train is thrown farther.
#[test]
fn a_motion_without_bound_names_the_missing_teeth() {
    let mut gearbox = gearbox(None);
    gearbox.faults = vec![Fault::new("z3", (1..48).collect::<Vec<u32>>(), MissingTooth)];
    gearbox.solver.duration_s = Some(8.0);
    let error = meshtone::simulate(&gearbox).map(drop).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("47 neighbouring teeth of z3 are missing (fault[0])"), "{text}");
    assert!(text.contains("the motion grows without bound within"), "{text}");
}

#[test]
fn a_mesh_that_carries_nothing_is_named_with_the_keys_of_its_wheels() {
    let mut gearbox = idler([24, 36, 30], [180.0, 0.0]);
    gearbox.structure.shafts_mut().unwrap().shafts[1].couples_to = Coupled::Brake;
    gearbox.structure.shafts_mut().unwrap().shafts[2].couples_to = Coupled::Nothing;
    assert!(stages(&gearbox).is_ok());
    gearbox.wheels[2].deviations.helix_slope_um = Some(5.0);
    let error = stages(&gearbox).map(drop).unwrap_err();
    assert_eq!(error.key, "mesh[1].wheels");
    assert!(error.problem.starts_with("the mesh is unloaded"), "{error}");
    assert!(error.help.unwrap().contains("set mesh[1].misalignment_um, wheel[1].helix_slope_um, wheel[2].helix_slope_um and helix_share of both wheels to 0"));
}

// A second mesh between two shafts that are geared already locks them unless its ratio is the same.
#[test]
fn a_locked_train_names_both_ratios() {
    let mut gearbox = one_pair();
    gearbox.wheels.push(ScenarioWheel::new("z3", "input", 0.2, 18, 15.0));
    gearbox.wheels.push(ScenarioWheel::new("z4", "output", 0.2, 37, 15.0));
    gearbox.meshes.push(ScenarioMesh::new(["z3", "z4"], 3.0));
    let error = gearbox.validate().unwrap_err();
    assert_eq!(error.key, "mesh[1].wheels");
    assert!(error.problem.contains("-18/37") && error.problem.contains("-17/38"), "{error}");
}

// Springs up to the stiffest that are legal: the forces of both meshes are those of the statics. What is left of the start in 0.4 s makes the
// tolerance.
#[test]
fn a_spring_that_is_a_constraint_keeps_the_balance() {
    type Change<'a> = &'a dyn Fn(&mut Scenario);
    let couplings: Change = &|gearbox| {
        let shafts = &mut gearbox.structure.shafts_mut().unwrap().shafts;
        (shafts[0].coupling_stiffness_nm_per_rad, shafts[2].coupling_stiffness_nm_per_rad) =
            (Some(1e15), Some(1e13));
    };
    let tilt: Change = &|gearbox| gearbox.bearings_mut()[0].tilt_stiffness_nm_per_rad = 1e13;
    for change in [couplings, tilt] {
        let mut gearbox = gearbox(None);
        gearbox.faults.clear();
        gearbox.solver.duration_s = Some(0.4);
        change(&mut gearbox);
        let simulation = simulate(&gearbox);
        for (mesh, name) in ["force_n.z1-z2", "force_n.z3-z4"].into_iter().enumerate() {
            let force_n = simulation.channels.signal(name).unwrap();
            let mean_n = force_n.iter().sum::<f64>() / force_n.len() as f64;
            let off = mean_n / simulation.stages.pairs[mesh].static_force_n - 1.0;
            println!("{name}: {off:.1e}");
            assert!(off.abs() < 2e-3, "{name}: {off}");
        }
    }
}

/// Two layshafts between coaxial input and output, whose axes are one and whose ends are `apart_mm` apart.
fn power_split(apart_mm: f64) -> String {
    let shaft = |name: &str, length_mm: f64, more: String| {
        let bearings: String =
            [0.0, 1.0].iter().map(|at| format!("[[bearing]]\nshaft = \"{name}\"\nat = {at:?}\n")).collect();
        format!(
            "[[shaft]]\nname = \"{name}\"\nlength_mm = {length_mm:?}\nradius_mm = 10.0\n{more}\n{bearings}"
        )
    };
    let wheel = |name: &str, shaft: &str, teeth: u32, at: f64| {
        format!(
            "[[wheel]]\nname = \"{name}\"\nshaft = \"{shaft}\"\nat = {at:?}\nteeth = {teeth}\nface_width_mm = 15.0\n"
        )
    };
    let mesh = |a: &str, b: &str| {
        format!(
            "[[mesh]]\nwheels = [\"{a}\", \"{b}\"]\nmodule_mm = 2.0\npressure_angle_deg = 20.0\nfriction = 0.0\n"
        )
    };
    let at = |z_mm: f64| z_mm / (240.0 + apart_mm);
    [
        shaft("in", 120.0, "position_mm = [0.0, 0.0]\ncouples_to = \"motor\"".to_owned()),
        shaft("left", 240.0 + apart_mm, "position_mm = [-60.0, 0.0]".to_owned()),
        shaft("right", 240.0 + apart_mm, "position_mm = [60.0, 0.0]".to_owned()),
        shaft(
            "out",
            120.0,
            format!("start_mm = {:?}\nposition_mm = [0.0, 0.0]\ncouples_to = \"brake\"", 120.0 + apart_mm),
        ),
        wheel("a", "in", 20, 0.5),
        wheel("b", "left", 40, at(60.0)),
        wheel("c", "right", 40, at(60.0)),
        wheel("d", "left", 20, at(180.0 + apart_mm)),
        wheel("e", "right", 20, at(180.0 + apart_mm)),
        wheel("f", "out", 40, 0.5),
        [mesh("a", "b"), mesh("a", "c"), mesh("d", "f"), mesh("e", "f")].concat(),
        "[operation]\ninput_speed_hz = 20.0\nbrake_torque_nm = 100.0\n".to_owned(),
        "[solver]\nsampling_rate_hz = 1e5\nduration_s = 0.5\nsettle_fraction = 0.7\n".to_owned(),
    ]
    .concat()
}

/// Input and output of one axis stand behind one another, and each way carries half of the load.
#[test]
fn a_coaxial_power_split_shares_its_load() {
    let gearbox = Scenario::from_toml(&power_split(20.0)).unwrap();
    let simulation = simulate(&gearbox);
    let base_radius_m = 0.020 * 20f64.to_radians().cos();
    // Of the output, and half a turn as fast half as much.
    for (mesh, radius_m) in [
        (0, 4.0 * base_radius_m),
        (1, 4.0 * base_radius_m),
        (2, 2.0 * base_radius_m),
        (3, 2.0 * base_radius_m),
    ] {
        let (share_n, static_n) = (50.0 / radius_m, simulation.stages.pairs[mesh].static_force_n);
        let force_n = simulation.channels.of(SignalSource::MeshForce(mesh));
        let mean_n = force_n.iter().sum::<f64>() / force_n.len() as f64;
        println!(
            "mesh {mesh}: {share_n:.6} N, statics {:.1e}, mean {:.1e}",
            static_n / share_n - 1.0,
            mean_n / share_n - 1.0
        );
        assert!((static_n / share_n - 1.0).abs() < 1e-6 && (mean_n / share_n - 1.0).abs() < 1e-4);
    }
    // Nearer, the ends of both would overlap.
    let error = Scenario::from_toml(&power_split(-1.0)).unwrap_err();
    assert_eq!(error.key, "shaft[3].start_mm", "{error}");
    assert!(error.problem.contains("runs into shaft \"in\" from z = 119.000 to 120.000 mm"), "{error}");
}

/// Where z = 0 lies does not matter.
#[test]
fn a_gearbox_may_begin_anywhere() {
    let gearbox = two_stages();
    let mut moved = gearbox.clone();
    moved.structure.shafts_mut().unwrap().shafts.iter_mut().for_each(|shaft| shaft.start_mm = 1234.5);
    let frequencies = |gearbox: &Scenario| stages(gearbox).unwrap().natural_frequencies_hz();
    for (here, there) in frequencies(&gearbox).iter().zip(frequencies(&moved)).skip(1) {
        assert!((here / there - 1.0).abs() < 1e-7, "{here} {there}");
    }
    // A shaft alone that is moved takes its wheel out of mesh.
    gearbox.validate().unwrap();
    moved.structure.shafts_mut().unwrap().shafts[0].start_mm = 0.0;
    assert_eq!(moved.validate().unwrap_err().key, "mesh[0].wheels");
}
