//! The model of contact as a whole: teeth that push and never pull, on shafts that bend, in supports.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::dense::*;
use crate::physics::*;
use meshtone::machine::Drive;
use meshtone::mesh::{Contact, PairState};
use meshtone::scenario::*;
use meshtone::solver::Output;
use meshtone::{Simulation, simulate, stages};
use nalgebra::DVector;

fn pair(brake_torque_nm: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair { brake_torque_nm, ..GearPair::example() });
    scenario.model = Model::Contact;
    scenario
}

fn of_rig(din_grade: u8) -> Scenario {
    let mut scenario = pair(10.0);
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = din_grade);
    with_own_structure(&mut scenario);
    scenario
}

/// Of a signal about its mean.
fn fluctuation(signal: &[f64]) -> f64 {
    let mean = mean(signal);
    rms(&signal.iter().map(|value| value - mean).collect::<Vec<_>>())
}

/// log10 of rms and kurtosis about the mean.
fn indicators(signal: &[f64]) -> [f64; 2] {
    let centre = mean(signal);
    let moment = |order: i32| mean(&signal.iter().map(|v| (v - centre).powi(order)).collect::<Vec<_>>());
    [moment(2).sqrt().log10(), (moment(4) / moment(2).powi(2)).log10()]
}

/// A rig whose supports stand still, whose shafts do not bend and where nothing is damped: the linear model's, without its damping.
fn rigid(scenario: &mut Scenario) {
    scenario.rig_mut().unwrap().support.springs =
        SupportSprings::Stiffnesses { stiffness_n_per_m: 1e15, coupling_n_per_m: 1e15 };
    scenario.rig_mut().unwrap().support.damping_ratio = 0.0;
    scenario.meshes[0].damping_ratio = 0.0;
    scenario.rig_mut().unwrap().damping_ratio = DampingRatio::Uniform(0.0);
    let rig = scenario.rig_mut().unwrap();
    for shaft in [&mut rig.pinion_shaft, &mut rig.gear_shaft] {
        shaft.damping_ratio = 0.0;
        // So short that only the bearings give way.
        shaft.bearing_span_mm = 0.1;
    }
}

// With all pairs closed, tip corners and coast flanks out of reach, what remains is the linear model: same stiffness, same start.
// The two are solved in different modes, with and without the mesh.
#[test]
fn closed_pairs_are_the_linear_model() {
    // The supports of the one are not quite rigid, and without damping that small difference grows; with deviations a pair of the
    // two in contact is lifted in time.
    compare_closed_pairs("ideal teeth", false, &[(1_000, 1e-6), (10_000, 5e-5)]);
    compare_closed_pairs("deviations and eccentricity", true, &[(1_000, 1e-6)]);
}

fn compare_closed_pairs(name: &str, deviates: bool, expected: &[(usize, f64)]) {
    let mut linear = pair(200.0);
    with_own_structure(&mut linear);
    linear.model = Model::Linear;
    // Undamped, the mesh's own variation makes it ring ever more; so slow that it takes a while.
    linear.operation.pinion_speed_hz = 5.0;
    linear.solver.sampling_rate_hz = 2e5;
    rigid(&mut linear);
    if deviates {
        let errors = stages(of_rig(6)).unwrap().pairs[0].profile_errors.clone().unwrap();
        linear.set_quality(Quality::of_errors(errors));
        linear.wheels.iter_mut().for_each(|wheel| wheel.eccentricity_mm = 0.004);
    }
    let mut contact = linear.clone();
    contact.model = Model::Contact;
    let of_linear = stages(&linear).unwrap();
    let mut of_contact = stages(&contact).unwrap();
    of_contact.meshes = of_linear.meshes.clone();
    of_contact.meshes[0].contact = Contact::Unilateral;
    // The motion until then; what comes after may be without bound.
    let force = |stages: &meshtone::Stages| {
        outputs_from(stages.time.first_simulated_sample, stages, &[Output::MeshForce { mesh: 0 }])
            .swap_remove(0)
    };
    let (a, b) = (force(&of_linear), force(&of_contact));
    // Until the undamped motion parts the linear flanks too.
    let together = a.iter().take_while(|force| **force > 0.0).count();
    let difference: Vec<f64> = a[..together].iter().zip(&b).map(|(a, b)| (a - b).abs()).collect();
    let fluctuating = fluctuation(&a[..together]);
    assert!(together > 10_000, "the linear mesh pulls after {together} steps");
    for &(steps, tolerance) in expected {
        let largest = largest(difference[..steps].iter().copied()) / mean(&a[..together]);
        println!(
            "closed pairs, {name}, {steps} steps: {largest:.2e} of a force of {:.0} ± {fluctuating:.0} N",
            mean(&a[..together]),
        );
        assert!(largest < tolerance, "{largest} after {steps} steps");
    }
}

// A mesh of constant stiffness does no work of its own: what the brake puts in, less what is stored, is what the structure's
// and the contact's damping take. The method's own sums, force times way over each step, make this an identity.
#[test]
fn motor_and_brake_put_in_what_damping_takes() {
    let mut scenario = of_rig(0);
    scenario.operation.torque_profile_nm =
        Some(Profile { time_s: vec![0.0, 0.2, 0.3, 1.0, 3.0], value: vec![10.0, 10.0, 25.0, 8.0, 12.0] });
    scenario.solver.settle_fraction = 0.0;
    let mut stages = stages(&scenario).unwrap();
    let torque: Vec<f64> = stages.motion().take(stages.time.samples).map(|now| now.torque_nm).collect();
    let mesh = &mut stages.meshes[0];
    let stiffness = mesh.mean_stiffness_n_per_m;
    mesh.points_before = 0;
    let closed = PairState { stiffness_n_per_m: stiffness, separation_m: 0.0, face_centre_m: 0.0 };
    mesh.classes[0].states = vec![closed; mesh.points_per_pitch];
    let (machine, modes) = machine_of(&stages);
    let n = machine.coordinates();
    let force = [Output::MeshForce { mesh: 0 }];
    let outputs: Vec<Output> = coordinates(machine, 0).chain(coordinates(machine, 1)).chain(force).collect();
    let kept = outputs_from(0, &stages, &outputs);
    let step_s = stages.time.step_s();
    let rigid = &machine.rigid_rotation * (std::f64::consts::TAU * 40.0);
    // Relative to the rigid rotation, at which the motor turns.
    let state = |first: usize, k: usize| DVector::from_fn(n, |row, _| kept[first + row][k]);
    let way = |k: usize| state(0, k) - &rigid * (k as f64 * step_s);
    let line = &machine.turn * &machine.lines[0].at_middle;
    let mass = machine.mass.diagonal();
    let (damping, springs) = (modes.damping_matrix(machine), machine.turn_back(&machine.stiffness()));
    let energy = |k: usize| {
        let (u, v) = (way(k), state(n, k) - &rigid);
        let deflection = line.dot(&u).max(0.0);
        (v.component_mul(&mass).dot(&v) + (&springs * &u).dot(&u) + stiffness * deflection * deflection) / 2.0
    };
    let Drive::Brake { coordinate: theta_brake, .. } = machine.drives[1] else { panic!("no brake") };
    let from = kept[0].len() / 20;
    let until = from + 30_000;
    let (mut put_in, mut structural, mut of_contact) = (0.0, 0.0, 0.0);
    for k in from..until {
        let (before, after) = (way(k), way(k + 1));
        let moved = &after - &before;
        put_in += (torque[k] + torque[k + 1]) / 2.0 * moved[theta_brake];
        structural += (&damping * &moved).dot(&moved) / step_s;
        let lost = |k: usize, u: &DVector<f64>| kept[2 * n][k] - stiffness * line.dot(u).max(0.0);
        of_contact += (lost(k, &before) + lost(k + 1, &after)) / 2.0 * line.dot(&moved);
    }
    let stored = energy(until) - energy(from);
    println!(
        "put in {put_in:.9} J, stored {stored:.9} J, structure {structural:.3e} J, contact {of_contact:.3e} J"
    );
    assert!(structural > 0.0 && of_contact > 0.0);
    assert!((put_in - stored - structural - of_contact).abs() < 1e-6 * put_in.abs());
}

// 10 µm more on all of a wheel's teeth turn the driven side a little further, and no signal knows.
#[test]
fn a_deviation_of_all_teeth_is_a_rotation() {
    let mut scenario = of_rig(7);
    scenario.operation.brake_torque_nm = 200.0;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.run_out_share = 0.0);
    let drawn = simulate(&scenario).unwrap();
    let mut errors = drawn.stages.pairs[0].profile_errors.clone().unwrap();
    errors.pinion_profile_errors_mm = errors.pinion_profile_errors_mm.map(|error| error + 0.01);
    let mut quality = scenario.quality();
    (quality.profile_errors, quality.din_grade) = (Some(errors), 0);
    scenario.set_quality(quality);
    let thicker = simulate(&scenario).unwrap();
    let (a, b) = (&drawn.channels["vertical_g"], &thicker.channels["vertical_g"]);
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    println!("10 µm on all pinion teeth: {:.2e} of {:.3} g", rms(&difference) / rms(a), rms(a));
    assert!(rms(&difference) < 1e-6 * rms(a));
}

// A healthy pair, at twice the sampling rate.
#[test]
fn halving_the_step_changes_no_indicator_of_a_healthy_pair() {
    let mut scenario = of_rig(7);
    let at = |scenario: &Scenario| {
        let channels = simulate(scenario).unwrap().channels;
        [indicators(&channels["vertical_g"]), indicators(&channels["mesh_force_n"])]
    };
    let coarse = at(&scenario);
    scenario.solver.sampling_rate_hz *= 2.0;
    let fine = at(&scenario);
    for (channel, (coarse, fine)) in ["acceleration", "force"].iter().zip(coarse.iter().zip(&fine)) {
        for (indicator, (coarse, fine)) in ["rms", "kurtosis"].iter().zip(coarse.iter().zip(fine)) {
            let change = 10f64.powf(fine - coarse) - 1.0;
            println!("{channel}, {indicator}: {:+.3} %", 100.0 * change);
            assert!(change.abs() < 0.01, "{channel} {indicator}: {change}");
        }
    }
}

// Teeth never pull: the force is never negative unless coast flanks touch, which a light load and coarse teeth make them do.
#[test]
fn teeth_let_go_and_never_pull() {
    let mut scenario = of_rig(9);
    scenario.meshes[0].backlash_mm = Some(1.0);
    let force = simulate(&scenario).unwrap().channels["mesh_force_n"].to_vec();
    assert!(force.iter().all(|force| *force >= 0.0));
    let apart = force.iter().filter(|force| **force == 0.0).count() as f64 / force.len() as f64;
    println!("apart for {:.1} % of the time", 100.0 * apart);
    assert!(apart > 0.001 && apart < 0.5, "{apart}");
    scenario.meshes[0].backlash_mm = Some(0.001);
    let tight = simulate(&scenario).unwrap().channels["mesh_force_n"].to_vec();
    assert!(tight.iter().any(|force| *force < 0.0));
}

// Damage of size zero is no damage; more of it is felt more.
#[test]
fn small_damages_are_small() {
    let healthy = of_rig(7);
    let mut none = healthy.clone();
    let chip = |tip_loss_mm| ToothBreakage { chip_height_mm: 1e-6, chip_width_mm: 1e-6, tip_loss_mm };
    none.faults = vec![Fault::on_first_gear_tooth(chip(0.0))];
    let [a, b] =
        [&healthy, &none].map(|scenario| simulate(scenario).unwrap().channels["vertical_g"].to_vec());
    let [a, b] = [fluctuation(&a), fluctuation(&b)];
    assert!((a / b - 1.0).abs() < 1e-2, "{a} {b}");
    let peaks: Vec<f64> = [2.0, 3.0, 4.0]
        .map(|tip_loss_mm| {
            let faults = vec![Fault::on_first_gear_tooth(chip(tip_loss_mm))];
            let broken = healthy.clone().with_faults(faults);
            largest(simulate(&broken).unwrap().channels["vertical_g"].iter().map(|v| v.abs()))
        })
        .to_vec();
    println!("peaks of tips lost by 2, 3 and 4 mm: {peaks:.1?} g");
    assert!(peaks[1] > 2.0 * peaks[0] && peaks[2] > 2.0 * peaks[0], "{peaks:?}");
}

// The mesh's stiffness without chamfer, while only pairs on their path count, is that of the linear model.
#[test]
fn mesh_stiffness_is_the_linear_one() {
    let mut scenario = pair(10.0);
    for wheel in &mut scenario.wheels {
        (wheel.tip_chamfer_mm, wheel.active_profile_shortening) = (Some(0.0), 0.0);
    }
    let mean = |scenario: &Scenario| stages(scenario).unwrap().mesh_curves()[0].mean_stiffness_n_per_mm;
    let contact = mean(&scenario);
    scenario.model = Model::Linear;
    let linear = mean(&scenario);
    println!("mean stiffness {contact:.0} and {linear:.0} N/mm");
    assert!((contact / linear - 1.0).abs() < 2e-3);
}

#[test]
fn varying_speed_is_the_steady_one_where_it_does_not_vary() {
    let mut scenario = of_rig(6);
    let steady = simulate(&scenario).unwrap().channels["vertical_g"].to_vec();
    scenario.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 10.0], value: vec![40.0, 40.0] });
    let varying = simulate(&scenario).unwrap().channels["vertical_g"].to_vec();
    let (a, b) = (fluctuation(&steady), fluctuation(&varying));
    println!("steady {a:.4} g, by a profile {b:.4} g");
    assert!((a / b - 1.0).abs() < 0.02);
}

// A list of pitches is what the flanks of those teeth have more.
#[test]
fn given_pitches_are_deviations_of_whole_flanks() {
    let mut scenario = of_rig(6);
    let errors = stages(&scenario).unwrap().pairs[0].profile_errors.clone().unwrap();
    scenario.set_quality(Quality::of_errors(errors));
    let mut by_flanks = scenario.clone();
    let pitches_um: Vec<f64> = (0..38).map(|tooth| f64::from(tooth % 5) - 2.0).collect();
    let cos = 20f64.to_radians().cos();
    let errors = by_flanks.wheels[1].profile_errors_mm.as_mut().unwrap();
    for (tooth, pitch_um) in pitches_um.iter().enumerate() {
        (0..100).for_each(|point| errors[(point, tooth)] += pitch_um * 1e-3 * cos);
    }
    scenario.wheels[1].deviations.cumulative_pitch_um = Some(pitches_um);
    for model in [Model::Linear, Model::Contact] {
        let signal = |scenario: &Scenario| {
            let mut scenario = scenario.clone();
            scenario.model = model;
            simulate(&scenario).unwrap().channels
        };
        assert_eq!(signal(&scenario), signal(&by_flanks));
    }
}

// Measured pitches have the run-out in them: none is drawn beside them, and the other wheel keeps its own.
#[test]
fn given_pitches_have_the_run_out_in_them() {
    let mut scenario = of_rig(6);
    let drawn = stages(&scenario).unwrap().pairs[0].run_out;
    scenario.wheels[1].deviations.cumulative_pitch_um = Some(vec![0.0; 38]);
    let given = stages(&scenario).unwrap().pairs[0].run_out;
    assert_eq!((given[0], given[1].run_out_um), (drawn[0], 0.0));
    assert!(drawn[1].run_out_um > 0.0);
    scenario.wheels[1].deviations.run_out_um = Some(7.0);
    assert_eq!(stages(&scenario).unwrap().pairs[0].run_out[1].run_out_um, 7.0);
}

// Misalignment and helix slopes are one: what the shafts take the flanks' metal can make up for.
#[test]
fn helix_slopes_and_misalignment_add_up() {
    let mut scenario = of_rig(6);
    let aligned = simulate(&scenario).unwrap();
    assert_eq!(mesh(&aligned.stages).along_face.face_load_factor, 1.0);
    scenario.meshes[0].misalignment_um = 8.0;
    let misaligned = simulate(&scenario).unwrap();
    let [before, after] = [&aligned, &misaligned].map(|simulation| mesh(&simulation.stages));
    assert!(after.along_face.face_load_factor > 2.0);
    assert!(after.mean_stiffness_n_per_m < 0.9 * before.mean_stiffness_n_per_m);
    scenario.wheels[0].deviations.helix_slope_um = Some(-3.0);
    scenario.wheels[1].deviations.helix_slope_um = Some(-5.0);
    assert_eq!(simulate(&scenario).unwrap().channels, aligned.channels);
    // Without a load nothing says how much of the face bears.
    scenario.wheels[1].deviations.helix_slope_um = None;
    scenario.operation.brake_torque_nm = 0.0;
    let refused = stages(&scenario).unwrap_err();
    assert_eq!(refused.key, "operation.brake_torque_nm");
}

/// A pair of 50 teeth each on stubby shafts between a motor and a brake that are coupled softly, whose speed rises or falls.
fn sweep(torque_nm: f64, from_hz: f64, to_hz: f64) -> Simulation {
    let shaft = |name: &str, to: &str| {
        format!(
            "[[shaft]]\nname = \"{name}\"\nlength_mm = 60.0\nradius_mm = 20.0\ncouples_to = \"{to}\"\ncoupling_stiffness_nm_per_rad = 2e3\n\
             [[bearing]]\nshaft = \"{name}\"\nat = 0.0\nstiffness_n_per_m = 2e10\n\
             [[bearing]]\nshaft = \"{name}\"\nat = 1.0\nstiffness_n_per_m = 2e10\n\
             [[wheel]]\nname = \"{name}\"\nshaft = \"{name}\"\nat = 0.5\nteeth = 50\nface_width_mm = 20.0\n"
        )
    };
    let toml = format!(
        "{}{}[[mesh]]\nwheels = [\"a\", \"b\"]\nmodule_mm = 3.0\ndamping_ratio = 0.05\nfriction = 0.0\nrandom_force = 0.0\n\
         [operation]\nbrake_torque_nm = {torque_nm:?}\nbrake_inertia_kgm2 = 1.0\n\
         speed_profile_hz = {{ time_s = [0.0, 4.0], value = [{from_hz:?}, {to_hz:?}] }}\n\
         [solver]\nsampling_rate_hz = 1e5\n",
        shaft("a", "motor"),
        shaft("b", "brake"),
    );
    simulate(Scenario::from_toml(&toml).unwrap()).unwrap()
}

// With clearance the resonance of the mesh leans to lower speeds, as Kahraman and Blankenship measured it (Journal of Applied Mechanics
// 64, 1997): on the way up the teeth part at a jump, on the way down they meet again at a lower one, and both speeds hardly depend on the
// load.
#[test]
fn a_mesh_resonance_jumps_up_and_down() {
    const SLOW_HZ: f64 = 55.0;
    const FAST_HZ: f64 = 80.0;
    let jump = |torque_nm: f64, is_up: bool| {
        let [from_hz, to_hz] = if is_up { [SLOW_HZ, FAST_HZ] } else { [FAST_HZ, SLOW_HZ] };
        let simulation = sweep(torque_nm, from_hz, to_hz);
        let force = &simulation.channels["force_n.a-b"];
        let window = 1_000;
        let windows: Vec<bool> = force
            .chunks_exact(window)
            .map(|values| values.iter().filter(|value| **value <= 0.0).count() > window / 5)
            .collect();
        let at_window = |n: usize| from_hz + (to_hz - from_hz) * (n as f64 + 0.5) / windows.len() as f64;
        let changed = if is_up {
            windows.iter().position(|parts| *parts)
        } else {
            windows.iter().rposition(|parts| *parts)
        };
        let mesh_hz = simulation.stages.natural_frequencies_hz();
        (50.0 * at_window(changed.unwrap()), mesh_hz)
    };
    let [light, heavy] = [150.0, 340.0].map(|torque_nm| [true, false].map(|is_up| jump(torque_nm, is_up)));
    // The mode in which both wheels turn against each other on the mean mesh.
    let mode_hz = light[0].1.iter().copied().find(|hz| *hz > 3.5e3).unwrap();
    assert!((mode_hz - 4060.0).abs() < 20.0, "{mode_hz}");
    let [light, heavy] = [light, heavy].map(|jumps| jumps.map(|(hz, _)| hz));
    for [up_hz, down_hz] in [light, heavy] {
        assert!((0.86..0.94).contains(&(up_hz / mode_hz)), "{up_hz} of {mode_hz}");
        assert!((0.79..0.89).contains(&(down_hz / up_hz)), "{down_hz} of {up_hz}");
    }
    println!("up and down: {light:?} at 150 N m, {heavy:?} at 340 N m");
    for (light_hz, heavy_hz) in light.into_iter().zip(heavy) {
        assert!((heavy_hz / light_hz - 1.0).abs() < 0.02, "{light_hz} {heavy_hz}");
    }
}
