//! A brake that drives: the other flanks carry, and the machine is the mirror image of the one that its motor drives.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use crate::plain::plain;
use meshtone::scenario::*;
use meshtone::sensor::SignalSource;
use meshtone::wheel::{ErrorTable, ProfileErrors};
use meshtone::{Simulation, StepJudgement, simulate, stages};

const TEETH: u32 = 30;

/// Two equal wheels with a crack in the fifth tooth of one of them, whose flanks deviate alike where they touch.
fn equal_wheels(torque_nm: f64, cracked: &str) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth: TEETH,
        gear_teeth: TEETH,
        face_width_mm: 15.0,
        pinion_speed_hz: 30.0,
        brake_torque_nm: torque_nm,
    });
    (scenario.solver.sampling_rate_hz, scenario.solver.duration_s) = (4e4, Some(0.2));
    let error_mm = |point: usize, tooth: usize| 1e-3 * (0.05 * point as f64 + 0.7 * tooth as f64).sin();
    let table = |of: &dyn Fn(usize, usize) -> f64| ErrorTable::from_fn(100, TEETH as usize, of);
    let mut quality = Quality::default();
    quality.profile_errors = Some(ProfileErrors {
        pinion_profile_errors_mm: table(&error_mm),
        gear_profile_errors_mm: table(&|point, tooth| error_mm(99 - point, tooth)),
    });
    scenario.set_quality(quality);
    scenario.faults =
        vec![Fault::new(cracked, 5, RootCrack { depth_mm: 2.0, angle_deg: 45.0, length_mm: None })];
    scenario
}

fn sign_of_difference(one: &[f64], other: &[f64], sign: f64) -> f64 {
    let rms = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>().sqrt();
    rms(&mut one.iter().zip(other).map(|(one, other)| one - sign * other)) / rms(&mut one.iter().copied())
}

// Two equal wheels in supports that are as stiff in every direction: upside down, the machine is the same one.
#[test]
fn equal_wheels_are_their_mirror_image() {
    let [driven, overrun] = [(10.0, "gear"), (-10.0, "pinion")]
        .map(|(torque_nm, cracked)| simulate(equal_wheels(torque_nm, cracked)).unwrap());
    for (channel, sign) in [("mesh_force_n", 1.0), ("vertical_g", -1.0), ("horizontal_g", 1.0)] {
        let off = sign_of_difference(&driven.channels[channel], &overrun.channels[channel], sign);
        println!("{channel}: {off:.1e}");
        assert!(off < 1e-8, "{channel}: {off}");
    }
    assert_eq!(driven.stages.pairs[0].static_force_n, overrun.stages.pairs[0].static_force_n);
    // The crack is where it was stated.
    assert_eq!(overrun.stages.pairs[0].damaged[0].wheel, meshtone::wheel::WheelName::Pinion);
}

// The gear's tip enters where the pinion drives, the pinion's where the gear does: as of a pair whose wheels are named the other way round.
#[test]
fn the_driving_wheel_comes_first() {
    let with = |teeth: [u32; 2], torque_nm: f64| {
        let mut scenario = Scenario::new(GearPair { brake_torque_nm: torque_nm, ..GearPair::example() });
        let mut gears = scenario.gears();
        (gears.pinion_teeth, gears.gear_teeth) = (teeth[0], teeth[1]);
        (gears.pinion_profile_shift, gears.gear_profile_shift) =
            if teeth[0] < teeth[1] { (0.3, 0.0) } else { (0.0, 0.3) };
        gears.tip_chamfer_mm = [Some(0.3), Some(0.8)];
        gears.flank_relief[0].amount_um = 15.0;
        gears.active_profile_shortening = [0.1; 2];
        if teeth[0] > teeth[1] {
            gears.tip_chamfer_mm.reverse();
            gears.flank_relief.reverse();
        }
        scenario.set_gears(&gears);
        let meshes = stages(&scenario).unwrap().meshes_at(200.try_into().unwrap()).unwrap();
        [meshes[0].stiffness_n_per_mm(0..1), meshes[0].at_rest(500.0, 0..1).deflection_m]
    };
    let [overrun, named, driven] = [with([17, 38], -10.0), with([38, 17], 10.0), with([17, 38], 10.0)];
    for (named, (overrun, driven)) in named.iter().zip(overrun.iter().zip(&driven)) {
        assert!(sign_of_difference(named, overrun, 1.0) < 1e-12);
        assert!(sign_of_difference(named, driven, 1.0) > 1e-3);
    }
}

fn gearbox(change: impl Fn(&mut Scenario)) -> Scenario {
    let mut gearbox = plain(Scenario::from_toml(&gearbox_template(None)).unwrap());
    gearbox.operation.brake_torque_nm *= -1.0;
    (gearbox.solver.sampling_rate_hz, gearbox.solver.duration_s) = (5e4, Some(0.4));
    change(&mut gearbox);
    gearbox
}

fn kinds(simulation: &Simulation) -> Vec<WarningKind> {
    simulation.warnings_of_signals(StepJudgement::Estimated).iter().map(|warning| warning.kind).collect()
}

#[test]
fn torques_of_a_gearbox_balance() {
    type Change<'a> = &'a dyn Fn(&mut Scenario);
    let cases: [(&str, Change, f64); 3] = [
        ("spur", &|_| (), 1e-3),
        ("helical", &|gearbox| gearbox.meshes.iter_mut().for_each(|mesh| mesh.helix_angle_deg = 20.0), 1e-3),
        ("rubbing", &|gearbox| gearbox.meshes.iter_mut().for_each(|mesh| mesh.friction = 0.05), 0.02),
    ];
    for (what, change, tolerance) in cases {
        let mut scenario = gearbox(change);
        if what == "helical" {
            // Teeth of the same module in the transverse section stand as far apart.
            let cos = 20f64.to_radians().cos();
            scenario.meshes.iter_mut().for_each(|mesh| mesh.module_mm *= cos);
        }
        let simulation = simulate(scenario).unwrap();
        for mesh in 0..2 {
            let force_n = simulation.channels.of(SignalSource::MeshForce(mesh));
            let mean_n = force_n.iter().sum::<f64>() / force_n.len() as f64;
            let off = mean_n / simulation.stages.pairs[mesh].static_force_n - 1.0;
            println!(
                "{what}, mesh {mesh}: {mean_n:.3} N, {off:.1e}, efficiency {:?}",
                simulation.efficiency(mesh)
            );
            assert!(mean_n > 0.0 && off.abs() < tolerance, "{what}: {off}");
            if what == "rubbing" {
                let efficiency = simulation.efficiency(mesh).unwrap();
                assert!(efficiency > 0.97 && efficiency < 0.999, "{efficiency}");
            }
        }
        assert!(!kinds(&simulation).contains(&WarningKind::TorqueImbalance), "{what}");
    }
}

// On shafts side by side the other flanks push with the same part along the line of centres, and with the opposite one across it and along the shafts.
#[test]
fn the_lines_of_action_are_mirrored() {
    let helical = |torque_nm: f64| {
        let scenario = gearbox(|gearbox| {
            gearbox.operation.brake_torque_nm = torque_nm;
            for mesh in &mut gearbox.meshes {
                mesh.module_mm *= 20f64.to_radians().cos();
                mesh.helix_angle_deg = 20.0;
            }
        });
        let stages = stages(&scenario).unwrap();
        let (machine, _) = stages.machine_and_modes().unwrap();
        let lines: Vec<_> = machine.lines.iter().map(|line| line.at_middle.clone()).collect();
        (machine.names.clone(), lines)
    };
    let ((names, driven), (_, overrun)) = (helical(20.0), helical(-20.0));
    for (driven, overrun) in driven.iter().zip(&overrun) {
        for (name, (driven, overrun)) in names.iter().zip(driven.iter().zip(overrun.iter())) {
            let sign = if name.starts_with('x') { 1.0 } else { -1.0 };
            assert!((driven - sign * overrun).abs() < 1e-12, "{name}: {driven} and {overrun}");
        }
    }
}

/// Three wheels, the middle one an idler.
fn idler_train(teeth: [u32; 3], torque_nm: f64) -> Scenario {
    let names = ["a", "b", "c"];
    let coupled = [Coupled::Motor, Coupled::Nothing, Coupled::Brake];
    let shafts = (0..3).map(|n| {
        let mut shaft = GearboxShaft::new(names[n], 100.0, 5.0);
        shaft.couples_to = coupled[n];
        shaft
    });
    let wheels = (0..3).map(|n| ScenarioWheel::new(["z1", "z2", "z3"][n], names[n], 0.5, teeth[n], 20.0));
    let bearings = names.iter().flat_map(|name| [Bearing::new(name, 0.0), Bearing::new(name, 1.0)]);
    Scenario::of_shafts(
        shafts.collect(),
        wheels.collect(),
        vec![ScenarioMesh::new(["z1", "z2"], 2.0), ScenarioMesh::new(["z2", "z3"], 2.0)],
        bearings.collect(),
        Operation::new(30.0, torque_nm),
    )
}

// An idler is driven in its first mesh and drives in its second one.
#[test]
fn an_idler_has_its_own_tips_in_both_meshes() {
    let mut train = idler_train([24, 35, 30], 10.0);
    let idler = &mut train.wheels[1];
    idler.flank_relief.amount_um = 12.0;
    (idler.tip_chamfer_mm, idler.uniform_flank_reduction_mm) = (Some(0.1), 0.01);
    idler.active_profile_shortening = 0.2;
    assert_eq!(Scenario::from_toml(&train.to_toml()).unwrap(), train);
    let stages = stages(&train).unwrap();
    for (gears, idler) in stages.layout.gears.iter().zip([1, 0]) {
        let other = 1 - idler;
        assert_eq!([idler, other].map(|wheel| gears.flank_relief[wheel].amount_um), [12.0, 0.0]);
        assert_eq!([idler, other].map(|wheel| gears.tip_chamfer_mm[wheel]), [Some(0.1), None]);
        assert_eq!([idler, other].map(|wheel| gears.uniform_flank_reduction_mm[wheel]), [0.01, 0.0]);
        assert_eq!([idler, other].map(|wheel| gears.active_profile_shortening[wheel]), [0.2, 0.1]);
    }
    // The same teeth with less metal: thinner by the reduction.
    let thickness_mm = |mesh: usize| {
        let teeth = &stages.pairs[mesh].teeth;
        [&teeth.pinion_profile, &teeth.gear_profile].map(|profile| profile.y_mm[profile.len() / 2])
    };
    assert_eq!(thickness_mm(0)[1], thickness_mm(1)[0]);
}

// The teeth of an idler between two wheels that exchange their roles.
#[test]
fn an_idler_is_met_from_its_other_side() {
    let phase = |teeth: [u32; 3], torque_nm: f64| {
        stages(idler_train(teeth, torque_nm)).unwrap().meshes[1].turning.first_pitch
    };
    let (overrun, backwards) = (phase([24, 35, 30], -10.0), phase([30, 35, 24], 10.0));
    let whole = overrun + backwards;
    assert!((whole - whole.round()).abs() < 1e-9, "{overrun} and {backwards}");
    assert!((phase([24, 35, 30], 10.0) - overrun).abs() > 0.01);
}

#[test]
fn what_cannot_overrun_says_so() {
    let mut published = Scenario::new(GearPair { brake_torque_nm: -10.0, ..GearPair::example() });
    assert!(published.validate().is_ok());
    let profile = |value: [f64; 2]| Some(Profile { time_s: vec![0.0, 1.0], value: value.to_vec() });
    published.operation.torque_profile_nm = profile([-10.0, 5.0]);
    assert_eq!(published.validate().unwrap_err().key, "operation.torque_profile_nm.value[1]");
    published.operation.torque_profile_nm = profile([-10.0, -5.0]);
    assert!(published.validate().is_ok());
    published.operation.torque_profile_nm = None;
    published.model = Model::Published;
    let error = published.validate().unwrap_err();
    assert!(error.key == "operation.brake_torque_nm" && error.problem.contains("one flank"), "{error}");
}
