//! Laws that a result obeys before it leaves: bounds of machines, the balance of torques, a step that makes no difference.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use meshtone::scenario::*;
use meshtone::sensor::SignalSource;
use meshtone::{Error, Simulation, StepJudgement, simulate};

fn stock(change: impl Fn(&mut Scenario)) -> Scenario {
    let mut gearbox = crate::plain::plain(Scenario::from_toml(&gearbox_template(None)).unwrap());
    gearbox.solver.duration_s = Some(0.4);
    gearbox.solver.sampling_rate_hz = 5e4;
    change(&mut gearbox);
    gearbox
}

fn codes(simulation: &Simulation) -> Vec<&'static str> {
    let warnings =
        [simulation.stages.warnings(), simulation.warnings_of_signals(StepJudgement::Repeated)].concat();
    warnings.iter().map(|warning| warning.kind.code()).collect()
}

// Springs up to the stiffest that are legal: the forces of both meshes are those of the statics. The ripple of 41 Hz that is left in 0.4 s
// makes the tolerance.
#[test]
fn a_spring_that_is_a_constraint_keeps_the_balance() {
    type Change<'a> = &'a dyn Fn(&mut Scenario);
    let cases: [(&str, Change); 4] = [
        ("brake's coupling", &|gearbox| {
            gearbox.structure.shafts_mut().unwrap().shafts[2].coupling_stiffness_nm_per_rad = Some(1e13)
        }),
        ("motor's coupling", &|gearbox| {
            gearbox.structure.shafts_mut().unwrap().shafts[0].coupling_stiffness_nm_per_rad = Some(1e15)
        }),
        ("tilt", &|gearbox| gearbox.bearings_mut()[0].tilt_stiffness_nm_per_rad = 1e13),
        ("all", &|gearbox| {
            gearbox.structure.shafts_mut().unwrap().shafts[0].coupling_stiffness_nm_per_rad = Some(9e14);
            gearbox.structure.shafts_mut().unwrap().shafts[2].coupling_stiffness_nm_per_rad = Some(9e14);
            gearbox.bearings_mut().iter_mut().for_each(|bearing| {
                (bearing.stiffness_n_per_m, bearing.tilt_stiffness_nm_per_rad) = (9e14, 9e14);
                (bearing.seat.stiffness_n_per_m, bearing.seat.tilt_stiffness_nm_per_rad) = (9e14, 9e14);
            });
        }),
    ];
    for (what, change) in cases {
        let simulation = simulate(stock(change)).unwrap();
        for mesh in 0..2 {
            let force_n = simulation.channels.of(SignalSource::MeshForce(mesh));
            let mean_n = force_n.iter().sum::<f64>() / force_n.len() as f64;
            let off = mean_n / simulation.stages.pairs[mesh].static_force_n - 1.0;
            println!("{what}: {off:.1e}");
            assert!(off.abs() < 1e-3, "{what}: {off}");
        }
        assert!(!codes(&simulation).contains(&"torque-imbalance"), "{what}");
    }
}

// 25 kS/s are too few for a run-up through this machine's resonances, and 200 kS/s are enough.
#[test]
fn a_step_that_falsifies_a_run_up_is_told() {
    let run_up = |rate_hz: f64| {
        let gearbox = stock(|gearbox| {
            gearbox.solver.duration_s = None;
            gearbox.solver.sampling_rate_hz = rate_hz;
            gearbox.operation.speed_profile_hz =
                Some(Profile { time_s: vec![0.0, 0.5], value: vec![30.0, 40.0] });
        });
        codes(&simulate(gearbox).unwrap())
    };
    assert!(run_up(8e3).contains(&"step-error"));
    assert!(!run_up(2e5).contains(&"step-error"));
}

#[test]
fn what_no_machine_does_is_an_error() {
    // The teeth would pass through each other. Under three times as much the faces, of which an end bears on these shafts, move beyond all bounds.
    let overloaded = stock(|gearbox| gearbox.operation.brake_torque_nm = 3e4);
    match simulate(overloaded) {
        Err(Error::Impossible { problem, help }) => {
            assert!(problem.contains("its flanks would overlap by"), "{problem}");
            assert!(help.contains("lower operation.brake_torque_nm: "), "{help}");
            assert!(!help.contains("damping") && !help.contains("sampling_rate_hz"), "{help}");
        }
        other => panic!("{other:?}"),
    }
}

// A profile far from the nominal torque begins as the constant torque does, with nothing to settle.
#[test]
fn a_torque_profile_begins_under_its_first_torque() {
    let force_n = |torque_nm: f64, profile: Option<f64>| {
        let gearbox = stock(|gearbox| {
            gearbox.solver.settle_fraction = 0.0;
            gearbox.solver.duration_s = profile.is_none().then_some(0.05);
            gearbox.operation.brake_torque_nm = torque_nm;
            gearbox.operation.torque_profile_nm =
                profile.map(|first| Profile { time_s: vec![0.0, 0.05], value: vec![first, first] });
        });
        simulate(gearbox).unwrap().channels.of(SignalSource::MeshForce(1)).to_vec()
    };
    let (constant, profile) = (force_n(20.0, None), force_n(200.0, Some(20.0)));
    let mean_n = constant.iter().sum::<f64>() / constant.len() as f64;
    let off = constant.iter().zip(&profile).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / mean_n;
    println!("{off:.1e} of {mean_n:.0} N");
    assert!(off < 0.02, "{off}");
}

#[test]
fn sensors_that_show_nothing_and_a_band_that_lacks_the_teeth_are_told() {
    let narrow = stock(|gearbox| gearbox.solver.highest_mode_hz = Some(100.0));
    let codes = codes(&simulate(narrow).unwrap());
    assert!(codes.contains(&"beyond-band"), "{codes:?}");
    let axial = stock(|gearbox| gearbox.sensors[0].direction = SensorDirection::Axial);
    let simulation = simulate(axial).unwrap();
    let is_silent = simulation.channels.of(SignalSource::Sensor(0)).iter().all(|value| *value == 0.0);
    assert_eq!(self::codes(&simulation).contains(&"silent-sensor"), is_silent);
}

#[test]
fn a_run_out_beyond_all_tolerances_is_told() {
    let eccentric = stock(|gearbox| gearbox.wheels[0].deviations.run_out_um = Some(200.0));
    let warnings = meshtone::stages(&eccentric).unwrap().warnings();
    assert!(warnings.iter().any(|warning| warning.key == "wheel[0].run_out_um"), "{warnings:?}");
}
