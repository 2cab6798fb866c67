//! Planetary sets against published natural frequencies, statics, known rules and an independent simulator.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::f64::consts::TAU;

use crate::dense::{Dense, coordinates, machine_of, outputs_from};
use crate::physics::{SOUND_PAIR, sound_pairs};
use meshtone::machine::{GearboxMachine, GearboxParts, RimParts, SetParts, WheelBody};
use meshtone::scenario::*;
use meshtone::wheel::Material;
use meshtone::{Equations, Stages, simulate, stages};
use nalgebra::{DMatrix, DVector};

/// Numbers of an independent simulator of planetary sets: see `planetary/README.md`.
pub const RIG_A: &str = include_str!("../planetary/rig_a.toml");

fn scenario(change: impl Fn(&mut PlanetarySet)) -> Scenario {
    let mut scenario = Scenario::from_toml(RIG_A).unwrap();
    let Structure::Shafts(shafts) = &mut scenario.structure else { panic!("a rig has no sets") };
    change(&mut shafts.planetary[0]);
    scenario
}

/// (Hz) Natural frequencies of a set whose meshes have one stiffness.
fn natural_frequencies_hz(set: &SetParts, mesh_n_per_m: f64) -> Vec<f64> {
    let machine = GearboxMachine::new(&GearboxParts {
        shafts: &[],
        speed_ratios: &[],
        discs: &[],
        meshes: &[],
        bearings: &[],
        housing: None,
        material: Material::default(),
        unbalances: &[],
        brake_inertia_kgm2: 1.0,
        sets: std::slice::from_ref(set),
    })
    .machine;
    let stiffness = machine.closed_stiffness(&vec![mesh_n_per_m; machine.lines.len()]);
    let scale = machine.mass.diagonal().map(|mass| mass.sqrt().recip());
    let scaled = DMatrix::from_fn(stiffness.nrows(), stiffness.ncols(), |r, c| {
        stiffness[(r, c)] * scale[r] * scale[c]
    });
    let mut found: Vec<f64> =
        scaled.symmetric_eigen().eigenvalues.iter().map(|square| square.max(0.0).sqrt() / TAU).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// The example of Lin and Parker, J. Vib. Acoust. 121 (1999) 316, with a ring that is rigid.
fn lin_parker(planets: usize) -> SetParts {
    let alpha = 24.6f64.to_radians();
    let (sun_m, planet_m) = (0.04, 0.05);
    let [ring_m, arm_m] = [sun_m + 2.0 * planet_m, (sun_m + planet_m) / alpha.cos()];
    let body = |mass_kg: f64, of_square_kg: f64, radius_m: f64| WheelBody {
        mass_kg,
        polar_kgm2: of_square_kg * radius_m * radius_m,
        transverse_kgm2: 0.0,
    };
    SetParts {
        name: "p".to_owned(),
        angles_rad: (0..planets).map(|n| TAU * n as f64 / planets as f64).collect(),
        centre_distance_m: arm_m,
        ratios: [1.0, 0.2, 0.0],
        planet_ratio: -0.5,
        shafts: [None; 3],
        bodies: [
            body(0.4, 0.39, sun_m),
            body(0.66, 0.61, planet_m),
            body(2.35, 3.0, ring_m),
            body(5.43, 6.29, arm_m),
        ],
        supports_n_per_m: [1e8; 3],
        couplings_nm_per_rad: [0.0, 0.0, 1e9 * ring_m * ring_m],
        pin_n_per_m: 1e8,
        rolling_n_per_m: Vec::new(),
        pin_errors_m: Vec::new(),
        // One shape alone is left, which is as good as rigid.
        rim: RimParts {
            radius_m: 0.2,
            thickness_m: 0.1,
            width_m: 0.1,
            elasticity_pa: 1e25,
            density_kg_per_m3: 1e9,
            support_n_per_m: [1e8, 1e9],
            waves: 1,
        },
        damping_ratio: 0.02,
        sun_drives: true,
        base_radii_m: [sun_m, planet_m, planet_m, ring_m],
        working_pressure_angles_rad: [alpha; 2],
        has_forces_across: false,
    }
}

/// The published table agrees with these within 0.05 Hz for three planets.
#[test]
fn natural_frequencies_are_those_of_lin_and_parker() {
    let three = [
        0.0,
        743.1638965257141,
        743.1638965257159,
        1102.4193305403437,
        1102.4193305403494,
        1475.7472299932795,
        1896.0199424079556,
        1896.0199424079606,
        1930.3465696085127,
        2276.3801157172556,
        2276.380115717261,
        2658.324423547391,
        6986.298221729211,
        6986.298221729214,
        7462.803434345871,
        9647.91321660446,
        9647.91321660447,
        11775.26578547528,
    ];
    let four = [
        0.0,
        727.2673061799304,
        727.267306179937,
        1091.1635039191983,
        1091.1635039192056,
        1536.5354973738633,
        1808.1808820407946,
        1892.8175644961887,
        1892.8175644961918,
        1970.5923974140442,
        2342.5034837832,
        2342.503483783203,
        2625.6501900070225,
        5963.760021608512,
        6981.705167044027,
        7189.945378540203,
        7189.945378540203,
        7773.551320823501,
        10437.561762242358,
        10437.561762242358,
        13071.110238793695,
    ];
    for (planets, expected) in [(3, &three[..]), (4, &four[..])] {
        let found = natural_frequencies_hz(&lin_parker(planets), 5e8);
        // The brake, which nothing holds, and the rim's one shape come on top.
        let found = &found[1..=expected.len()];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() <= 1e-6 * expected + 0.01, "{planets}: {found} for {expected}");
        }
    }
}

/// The share of each planet in the sun's torque at rest.
fn shares(planets: u32, sun_support_n_per_m: f64, rim_mm: f64, error_um: f64) -> Vec<f64> {
    shares_of(planets, |set| {
        set.sun_support_n_per_m = sun_support_n_per_m;
        set.rim.thickness_mm = Some(rim_mm);
        set.pin.error_um = vec![0.0; planets as usize];
        set.pin.error_um[0] = error_um;
    })
}

fn shares_of(planets: u32, change: impl Fn(&mut PlanetarySet)) -> Vec<f64> {
    let scenario = scenario(|set| {
        set.teeth = MemberTeeth { sun: 30, planet: 30, ring: 90 };
        (set.planets, set.module_mm, set.face_width_mm) = (planets, 2.5, 25.0);
        change(set);
    });
    let stages = stages(&scenario).unwrap();
    let Equations::Machine(machine, _) = &stages.equations else { panic!("the published model has no sets") };
    let machine = &machine.machine;
    let n = planets as usize;
    let stiffness = [vec![567571985.6202812; n], vec![747386259.9550613; n]].concat();
    let sun = machine.names.iter().position(|name| name == "phi_z_p.sun").unwrap();
    let mut load = DVector::zeros(machine.coordinates());
    load[sun] = 300.0;
    machine.turning_forces.iter().for_each(|force| load += &force.at[0]);
    let mut closed = machine.closed_stiffness(&stiffness);
    // The brake stands still.
    let brake = machine.names.iter().position(|name| name == "phi_z_brake").unwrap();
    closed[(brake, brake)] += 1e9;
    let displaced = closed.lu().solve(&load).unwrap();
    let forces: Vec<f64> = (machine.lines.iter().zip(&stiffness))
        .map(|(line, stiffness)| stiffness * line.at_middle.dot(&displaced))
        .collect();
    let all: f64 = forces[..n].iter().sum();
    forces[..n].iter().map(|force| force / all).collect()
}

/// Planets share the load as an independent simulator says; three on a sun that floats share it equally, and opposite ones of four are alike.
#[test]
fn planets_share_the_load() {
    // A pin that is stiffer than a machine can show shares as a stiff one does: its error presses with the stiffness that it has there.
    let stiff = [1e13, 1e15].map(|stiffness_n_per_m| {
        shares_of(4, |set| set.pin = Pin { stiffness_n_per_m, error_um: vec![2.0, 0.0, 0.0, 0.0] })
    });
    println!("{stiff:?}");
    stiff[0]
        .iter()
        .zip(&stiff[1])
        .for_each(|(one, other)| assert!((one - other).abs() < 1e-3, "{one} {other}"));
    let table: [(u32, f64, f64, f64, [f64; 3]); 8] = [
        (3, 1e3, 12.0, 40.0, [0.33332940903685787, 0.33333529548157104, 0.33333529548157104]),
        (3, 1e8, 12.0, 5.0, [0.32660148052350463, 0.3366992597382482, 0.33669925973824727]),
        (3, 1e8, 12.0, 40.0, [0.2794785108547022, 0.3602607445726494, 0.36026074457264845]),
        (3, 1e8, 200.0, 20.0, [0.30606765655345497, 0.34696617172327365, 0.3469661717232713]),
        (4, 1e3, 12.0, 20.0, [0.22297886068965928, 0.27702003559442523, 0.22298106812149024]),
        (4, 1e3, 200.0, 20.0, [0.221368243873034, 0.27863065241048335, 0.22137045130599797]),
        (4, 1e8, 12.0, 10.0, [0.22813412702550726, 0.26351001779721156, 0.2448458373800683]),
        (4, 1e8, 12.0, 40.0, [0.16253650810202713, 0.30404007118885096, 0.22938334952027095]),
    ];
    for (planets, support, rim_mm, error_um, expected) in table {
        let found = shares(planets, support, rim_mm, error_um);
        println!("{planets} {support:e} {rim_mm} {error_um}: {found:.5?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-3, "{found} for {expected}");
        }
    }
    let floating = shares(3, 1e3, 12.0, 40.0);
    assert!(floating.iter().all(|share| (share - 1.0 / 3.0).abs() < 1e-5));
    let four = shares(4, 1e3, 12.0, 40.0);
    assert!((four[0] - four[2]).abs() < 1e-4 && (four[1] - four[3]).abs() < 1e-9);

    // A carrier that may move takes its pins back to where they belong; one that is held loads a planet that is behind its place more.
    let off = |support: f64| {
        shares_of(4, |set| (set.carrier_eccentricity_um, set.carrier_support_n_per_m) = (20.0, support))
    };
    let (free, held) = (off(1e-3), off(1e8));
    println!("carrier off its axis: {free:.6?} {held:.4?}");
    assert!(free.iter().all(|share| (share - 0.25).abs() < 1e-6));
    assert!(held[1] - held[3] > 0.05 && (held[1] + held[3] - held[0] - held[2]).abs() < 1e-3);
}

/// A planet that hardly bears is warned of, and a step too long for impacts is an error in place of a result.
#[test]
fn what_is_doubtful_is_said() {
    let of =
        |error_um: f64| stages(scenario(|set| set.pin.error_um = vec![error_um, 0.0, 0.0, 0.0])).unwrap();
    let idle =
        |error_um| of(error_um).warnings().iter().filter(|of| of.kind == WarningKind::IdlePlanet).count();
    assert_eq!((idle(5.0), idle(60.0)), (0, 1));
    for (wheel, rate_hz) in [("p.sun", 1e4), ("p.sun", 2e4), ("p.planet1", 1e4), ("p.planet1", 1.5e4)] {
        let mut scenario = scenario(|_| {});
        (scenario.solver.sampling_rate_hz, scenario.solver.duration_s) = (rate_hz, Some(3.0));
        scenario.faults = vec![Fault::new(wheel, 1, Damage::from(MissingTooth))];
        let error = simulate(scenario).unwrap_err().to_string();
        println!("{error}");
        assert!(error.contains("fly through their backlash"), "{wheel} {rate_hz}");
    }
}

/// Positions of all first pairs, in base pitches, the whole part left out.
fn phases(text: &str) -> Vec<f64> {
    let scenario = Scenario::from_toml(text).unwrap();
    scenario.layout().unwrap().phases.iter().map(|phase| phase.rem_euclid(1.0)).collect()
}

/// Pitch points and phases are those that an independent simulator found from tooth thicknesses.
#[test]
fn meshes_are_in_their_phases() {
    let of = |teeth: [u32; 3], planets: u32| {
        phases(
            &RIG_A
                .replace(
                    "sun = 19, planet = 31, ring = 81",
                    &format!("sun = {}, planet = {}, ring = {}", teeth[0], teeth[1], teeth[2]),
                )
                .replace("planets = 4", &format!("planets = {planets}")),
        )
    };
    let near = |found: &[f64], expected: &[f64]| {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            let apart = (found - expected + 0.5).rem_euclid(1.0) - 0.5;
            assert!(apart.abs() < 1e-6, "{found} for {expected}");
        }
    };
    let r = 0.2789384066622347;
    // The sun's teeth come to the planets one after the other in the sense in which it turns.
    near(&of([19, 31, 81], 4), &[0.0, 0.25, 0.5, 0.75, r, r + 0.25, r + 0.5, r + 0.75]);
    let r = 0.7352246723795588;
    near(&of([28, 36, 100], 4), &[0.0, 0.0, 0.0, 0.0, r, r, r, r]);
    let r = 0.7438070790048243;
    near(&of([21, 36, 93], 3), &[0.0, 0.0, 0.0, r, r, r]);
    let r = 0.3005423521735793;
    near(&of([24, 27, 78], 3), &[0.0, 0.0, 0.0, r, r, r]);
}

/// A set with a missing tooth on its ring and deviations moves as the equations of motion say, solved with full matrices. It has one planet: then its
/// forces at rest are determined, and both solutions start alike.
#[test]
fn a_set_moves_as_with_dense_matrices() {
    let mut scenario = scenario(|set| (set.iso_class, set.planets) = (5, 1));
    scenario.faults = vec![Fault::new("p.ring", 3, MissingTooth)];
    scenario.operation.brake_inertia_kgm2 = 0.05;
    // The other solver reads tables as those of a motion that changes.
    scenario.operation.speed_profile_hz = Some(Profile { time_s: vec![0.0, 0.02], value: vec![20.0, 20.2] });
    scenario.operation.pinion_speed_hz = 20.2;
    let shafts = scenario.structure.shafts_mut().unwrap();
    shafts.shafts.iter_mut().for_each(|shaft| shaft.coupling_stiffness_nm_per_rad = Some(1e4));
    (scenario.solver.sampling_rate_hz, scenario.solver.highest_mode_hz) = (40280.0, Some(1e9));
    (scenario.solver.duration_s, scenario.solver.settle_fraction) = (None, 0.0);
    let stages = stages(&scenario).unwrap();
    let (machine, _) = machine_of(&stages);
    let samples = 150;
    let ours = outputs_from(0, &stages, &coordinates(machine, 2).collect::<Vec<_>>());
    let theirs = Dense::of(&stages, samples).accelerations();
    let (mut apart, mut whole) = (0.0, 0.0);
    for (sample, expected) in theirs.iter().enumerate() {
        for (coordinate, expected) in expected.iter().enumerate() {
            apart += (ours[coordinate][sample] - expected).powi(2);
            whole += expected * expected;
        }
    }
    println!("off by {:e}", f64::sqrt(apart / whole));
    assert!(f64::sqrt(apart / whole) < 1e-8);
}

/// (N/m) Stiffness of the pairs of a mesh that touch on their path alone, at equal parts of a base pitch from its first position on.
fn sharp_stiffness(stages: &Stages, mesh: usize, parts: usize) -> Vec<f64> {
    let teeth = &stages.pairs[mesh].teeth;
    let pairs = sound_pairs(&stages.layout.gears[mesh], teeth);
    let at = |part: usize| {
        let first = (stages.layout.phases[mesh] + part as f64 / parts as f64).rem_euclid(1.0);
        let on_path = (0..3).map(|pair| first + f64::from(pair)).filter(|at| *at < teeth.path.contact_ratio);
        on_path.map(|at| pairs.at(&SOUND_PAIR, at).stiffness_n_per_mm * 1e3).sum()
    };
    (0..parts).map(at).collect()
}

/// Rig A as the independent simulator has it: meshes without corners of tips, whose stiffness ends with the path. Solved by Newmark's method in the
/// modes, with the program's masses, springs, lines of action, phases and tooth stiffness, but with none of its time loop.
#[test]
fn rig_a_with_sharp_ends_of_the_path() {
    const PARTS: usize = 256;
    let stages = stages(scenario(|_| {})).unwrap();
    let (machine, modes) = machine_of(&stages);
    let stiffness: Vec<Vec<f64>> = (0..8).map(|mesh| sharp_stiffness(&stages, mesh, PARTS)).collect();
    let name = |name: &str| machine.names.iter().position(|of| of == name).unwrap();
    // At rest on the mean meshes, with the brake held.
    let mean: Vec<f64> = stiffness.iter().map(|of| of.iter().sum::<f64>() / PARTS as f64).collect();
    let mut load = DVector::zeros(machine.coordinates());
    load[name("phi_z_p.sun")] = 50.0;
    let mut closed = machine.closed_stiffness(&mean);
    closed[(name("phi_z_brake"), name("phi_z_brake"))] += 1e9;
    let at_rest = closed.lu().solve(&load).unwrap();
    let to_modes = modes.shapes.transpose();
    let lines: Vec<DVector<f64>> = machine.lines.iter().map(|line| &to_modes * &line.at_middle).collect();
    let load = &to_modes * load;
    let n = lines[0].len();
    let dt = 1.0 / (307.8 * PARTS as f64);
    let [springs, damping] = [
        DVector::from_fn(n, |k, _| modes.angular_frequencies[k].powi(2)),
        DVector::from_fn(n, |k, _| modes.damping_per_s(k)),
    ];
    let inverse = DVector::from_fn(n, |k, _| 1.0 / (4.0 / (dt * dt) + 2.0 * damping[k] / dt + springs[k]));
    let yields = DMatrix::from_fn(8, 8, |a, b| lines[a].component_mul(&inverse).dot(&lines[b]));
    let mut q = &to_modes * (&machine.mass * at_rest);
    let (mut v, mut a) = (DVector::zeros(n), DVector::zeros(n));
    let (mut forces, mut kept) = (vec![Vec::new(); 8], Vec::new());
    // From the thirtieth on the lines are those of the periods after it within 0.3 %.
    let periods = 40;
    for step in 1..=periods * PARTS {
        let known = &load
            + (&q * (4.0 / (dt * dt)) + &v * (4.0 / dt) + &a)
            + damping.component_mul(&(&q * (2.0 / dt) + &v));
        let free = known.component_mul(&inverse);
        let carried: Vec<(f64, f64)> = (0..8)
            .map(|mesh| {
                let stiffness = stiffness[mesh][step % PARTS];
                // The damping of a contact as a stiffness, and what it remembers.
                let lag = stages.meshes[mesh].damping_time_s;
                let before = lines[mesh].dot(&(&q * (2.0 / dt) + &v));
                (stiffness * (1.0 + 2.0 * lag / dt), stiffness * lag * before)
            })
            .collect();
        let matrix = DMatrix::from_fn(8, 8, |a, b| f64::from(a == b) + carried[a].0 * yields[(a, b)]);
        let right = DVector::from_fn(8, |mesh, _| carried[mesh].0 * lines[mesh].dot(&free) - carried[mesh].1);
        let force = matrix.lu().solve(&right).unwrap();
        let pushed = lines.iter().zip(force.iter()).fold(known, |sum, (line, force)| sum - line * *force);
        let next = pushed.component_mul(&inverse);
        let next_a = (&next - &q) * (4.0 / (dt * dt)) - &v * (4.0 / dt) - &a;
        v += (&a + &next_a) * (dt / 2.0);
        (q, a) = (next, next_a);
        if step > (periods - 1) * PARTS {
            force.iter().zip(&mut forces).for_each(|(force, of)| of.push(*force));
            kept.push(&modes.shapes * &q);
        }
    }
    // Least and largest force of the sun's meshes and of the ring's.
    for (mesh, expected) in [(0, [293.24, 668.29]), (4, [279.29, 684.45])] {
        let [least, most] = [f64::min as fn(f64, f64) -> f64, f64::max]
            .map(|pick| forces[mesh].iter().copied().reduce(pick).unwrap());
        println!("mesh {mesh}: {least:.1} to {most:.1} N for {expected:?}");
    }
    // The sensor on top of the ring over a revolution of the carrier, of which the set's motion fills every mesh period.
    let Equations::Machine(assembled, _) = &stages.equations else {
        panic!("the published model has no sets")
    };
    let set = &assembled.sets[0];
    let samples = 81 * PARTS;
    let shown: Vec<f64> = (0..samples)
        .map(|sample| {
            let angle = TAU * (0.25 - sample as f64 / samples as f64);
            let u = &kept[sample % PARTS];
            let rim: f64 = set.rim.iter().map(|(shape, number)| shape.at(angle)[0] * u[*number]).sum();
            rim + u[set.members[2]] * angle.cos() + u[set.members[2] + 1] * angle.sin()
        })
        .collect();
    let mut worst: f64 = 0.0;
    let lines = lines_m_s2(&shown, 1.0);
    for (order, expected) in LINES_OF_RIG_A {
        let squared = (TAU * 3.8 * order as f64).powi(2);
        let found = squared * lines(order as f64) / 9.81;
        println!("order {order}: {found:.4} for {expected}");
        worst = worst.max((found / expected - 1.0).abs());
    }
    assert!(worst < 0.2, "{worst}");
}

/// The strongest lines of the independent simulator's sensor up to four times the ring's teeth: order of the carrier, and m/s².
const LINES_OF_RIG_A: [(usize, f64); 12] = [
    (320, 0.179),
    (244, 0.0863),
    (240, 0.0533),
    (324, 0.0436),
    (164, 0.0417),
    (160, 0.0399),
    (248, 0.0226),
    (316, 0.0204),
    (168, 0.0085),
    (4, 0.0080),
    (156, 0.0080),
    (236, 0.0068),
];

/// (m/s²) Amplitudes of the orders of the carrier over the whole signal, in which they turn whole times.
fn lines_m_s2(signal_g: &[f64], revolutions: f64) -> impl Fn(f64) -> f64 + use<> {
    let spectrum = meshtone_fourier::real_spectrum(signal_g);
    let scale = 9.81 * 2.0 / signal_g.len() as f64;
    move |order| {
        let turns = order * revolutions;
        assert!((turns - turns.round()).abs() < 1e-6, "order {order} turns {turns} times");
        scale * spectrum[turns.round() as usize].norm()
    }
}

/// Rig A of the independent simulator: mean forces, and the lines of the sensor on the ring.
#[test]
fn rig_a_sounds_as_it_does_elsewhere() {
    let (planets, revolutions) = (4, 4.0);
    let mut scenario = scenario(|_| {});
    let revolution_s = scenario.solver.duration_s.unwrap() / 19.0;
    scenario.solver.discard_and_keep(1.0, revolutions * revolution_s);
    let simulation = simulate(scenario).unwrap();
    for signal in simulation.channels.signals.iter().filter(|signal| signal.name.starts_with("force_n")) {
        let mean = signal.values.iter().sum::<f64>() / signal.values.len() as f64;
        let (least, most) =
            signal.values.iter().fold((f64::MAX, f64::MIN), |(l, m), v| (l.min(*v), m.max(*v)));
        println!("{} {mean:.4} {least:.1} {most:.1}", signal.name);
        assert!((mean / 437.5731 - 1.0).abs() < 1e-4, "{}: {mean}", signal.name);
    }
    let ring = &simulation.channels.signals[0];
    assert_eq!(ring.name, "ring_p_90_radial_g");
    let lines: Vec<f64> = (1..=324).map(f64::from).map(lines_m_s2(&ring.values, revolutions)).collect();
    let energy = |of: &dyn Fn(usize) -> bool| -> f64 {
        lines.iter().enumerate().filter(|(n, _)| of(n + 1)).map(|(_, line)| line * line).sum()
    };
    let off = energy(&|order| order % planets != 0) / energy(&|_| true);
    println!("off multiples of N: {off:e}");
    assert!(off < 1e-6);
    // Corners of tips that touch beyond the path soften its ends, which the higher harmonics of the mesh are made of.
    for (order, expected) in LINES_OF_RIG_A {
        let found = lines[order - 1];
        println!("order {order}: {found:.4} for {expected}");
        assert!(order > 200 || (found / expected - 1.0).abs() < 0.1, "order {order}: {found} for {expected}");
    }
}

/// Sidebands follow the places of the planets. In a set whose meshes are not in phase each planet sounds as the first does, turned by its angle, so that
/// order n is that of one planet times `Σ exp(i n ψ)` (McFadden and Smith, Proc. IMechE C 199 (1985) 65), and orders at which this sum is 0 are missing. Of
/// planets in phase the sidebands lie alike on both sides of the mesh, at every order where they are spaced unequally (Inalpolat and Kahraman, JSV 323
/// (2009) 677).
#[test]
fn sidebands_follow_the_places_of_the_planets() {
    let lines = |teeth: [u32; 3], angles_deg: &[f64], revolutions: f64| -> Vec<f64> {
        let [sun, planet, ring] = teeth;
        let mut scenario = scenario(|set| {
            set.teeth = MemberTeeth { sun, planet, ring };
            (set.planets, set.planet_angles_deg) = (angles_deg.len() as u32, angles_deg.to_vec());
            (set.sun_support_n_per_m, set.carrier_support_n_per_m) = (1e9, 1e9);
        });
        scenario.solver.duration_s = Some(revolutions * f64::from(sun + ring) / (20.0 * f64::from(sun)));
        scenario.solver.sampling_rate_hz = 80_000.0;
        let ring = &simulate(scenario).map_err(|error| error.to_string()).unwrap().channels.signals[0];
        (0..=2 * teeth[2]).map(f64::from).map(lines_m_s2(&ring.values, revolutions)).collect()
    };
    let of_places = |angles_deg: &[f64], order: usize| {
        let (cos, sin) = angles_deg.iter().fold((0.0, 0.0), |(c, s), angle| {
            let (sin, cos) = (order as f64 * angle.to_radians()).sin_cos();
            (c + cos, s + sin)
        });
        f64::hypot(cos, sin)
    };
    let places = [vec![0.0, 86.4, 180.0, 266.4], vec![0.0, 97.2, 180.0, 277.2]];
    let [one, other] = places.each_ref().map(|places| lines([19, 31, 81], places, 8.0));
    for order in 74..=88 {
        let [a, b] = places.each_ref().map(|places| of_places(places, order));
        println!("{order}: {:.5} {:.5}, {a:.3} {b:.3}", one[order], other[order]);
        if order % 2 == 1 {
            assert!(one[order].max(other[order]) < 0.01 * one[80], "{order}");
        } else {
            let as_told = one[order] * b / (other[order] * a);
            assert!((as_told - 1.0).abs() < 0.1 || a.min(b) < 0.3, "{order}: {as_told}");
        }
    }
    let in_phase = lines([20, 40, 100], &[0.0, 126.0, 234.0], 4.0);
    for away in 1..=8 {
        let [below, above] = [in_phase[100 - away], in_phase[100 + away]];
        println!("100 ± {away}: {below:.5} {above:.5}");
        assert!(
            (below / above).ln().abs() < 1.4_f64.ln() && below > 0.05 * in_phase[99],
            "{away}: {below} {above}"
        );
    }
}

/// Orders of a damaged sun or planet tooth are where the tooth counts say, and a ring tooth adds no order to those of the sound set.
#[test]
fn damaged_teeth_sound_at_their_orders() {
    let crack = || Damage::from(RootCrack { depth_mm: 3.0, angle_deg: 45.0, length_mm: None });
    let shown = |wheel: &str, damage: Damage, flank: Option<FaultFlank>, revolutions: f64| {
        let mut scenario = scenario(|_| {});
        // As many samples in a revolution of the carrier as planets divide: what folds down stays on the lines.
        scenario.solver.sampling_rate_hz = 80560.0;
        scenario.solver.discard_and_keep(1.5, revolutions * 21200.0 / 80560.0);
        scenario.faults = vec![Fault { flank, ..Fault::new(wheel, 1, damage) }];
        lines_m_s2(&simulate(scenario).unwrap().channels.signals[0].values, revolutions)
    };
    let sun = shown("p.sun", MissingTooth.into(), None, 19.0);
    for order in [148.0 + 4.0 / 19.0, 152.0 + 4.0 / 19.0] {
        let line = sun(order);
        println!("sun {order:.4}: {line:.5}");
        assert!(line > 1.0);
    }
    let between = |n: u32| sun(140.0 + (1.0 + 4.0 * f64::from(n)) / 19.0);
    let off = (0..40).map(between).fold(0.0, f64::max);
    println!("between: {off:.1e}");
    assert!(off < 1e-5);

    let planet = shown("p.planet1", MissingTooth.into(), Some(FaultFlank::Sun), 31.0);
    for order in [150.0 + 17.0 / 31.0, 152.0 + 17.0 / 31.0] {
        let line = planet(order);
        println!("planet {order:.4}: {line:.5}");
        assert!(line > 0.1);
    }

    // It has whole orders alone.
    let ring = shown("p.ring", crack(), None, 4.0);
    let [on, off] = [true, false].map(|is_on| {
        let orders = (1..324_u32).filter(|order| order.is_multiple_of(4) == is_on);
        orders.map(|order| ring(f64::from(order))).fold(0.0, f64::max)
    });
    println!("ring: {on:.1e} on multiples of four, {off:.1e} elsewhere");
    assert!(off < 1e-3 * on);
}

/// A planet turns with the outer ring of its bearing, and its load stands at the inner one on the pin: a spall of the outer race passes the load once a
/// turn, which gives its lines sidebands, and one of the inner race stays under the load.
#[test]
fn planet_bearings_exchange_the_roles_of_their_rings() {
    const BEARING: &str = "[[bearing]]\nshaft = \"p.planet1\"\nat = 0.5\nkind = \"roller\"\nelements = 14\nelement_mm = 10.0\npitch_mm = 60.0\nslip_percent = 0.0\n";
    let revolutions = 12.0;
    let shown = |defect: &str| {
        let text = RIG_A.replace("[operation]", &format!("{BEARING}{defect}\n[operation]"));
        let mut scenario = Scenario::from_toml(&text).unwrap();
        scenario.solver.sampling_rate_hz = 40280.0;
        scenario.solver.discard_and_keep(0.5, revolutions * 31.0 / (20.0 * 0.81 * 19.0));
        let stages = stages(scenario).unwrap();
        let load_n = stages.bearings[0].1.static_load_n;
        // Twice the tangential force of a mesh, by the linear springs that only find where to linearise.
        assert!(load_n[0].abs() < 1.0 && (load_n[1] / -822.4 - 1.0).abs() < 0.02, "{load_n:?}");
        lines_m_s2(
            stages.simulate().unwrap().channels.signal("force_n.p.sun-p.planet1").unwrap(),
            revolutions,
        )
    };
    // A pin ahead of its place relieves its planet, one behind loads it as much more.
    let load_n = |error_um: f64| {
        let mut scenario =
            Scenario::from_toml(&RIG_A.replace("[operation]", &format!("{BEARING}\n[operation]"))).unwrap();
        scenario.structure.shafts_mut().unwrap().planetary[0].pin.error_um = vec![error_um, 0.0, 0.0, 0.0];
        stages(scenario).unwrap().bearings[0].1.static_load_n[1]
    };
    let [ahead, exact, behind] = [20.0, 0.0, -20.0].map(load_n);
    println!("bearing of a planet ahead, in its place, behind: {ahead:.1}, {exact:.1}, {behind:.1} N");
    assert!(ahead / exact < 0.6 && ((ahead + behind) / (2.0 * exact) - 1.0).abs() < 0.01);
    let [sound, outer, inner] = ["", "outer", "inner"].map(|race| match race {
        "" => shown(""),
        race => shown(&format!("defect = [{{ race = \"{race}\", width_mm = 2.0 }}]")),
    });
    // Orders of the planet against the carrier.
    let (of_outer, of_inner) = (14.0 * (1.0 - 1.0 / 6.0) / 2.0, 14.0 * (1.0 + 1.0 / 6.0) / 2.0);
    let lines =
        |of: &dyn Fn(f64) -> f64, order: f64| [order, order - 1.0, order + 1.0].map(|order| of(order) / 9.81);
    for (name, signal) in [("sound", &sound), ("outer", &outer), ("inner", &inner)] {
        println!("{name}: BPFO {:.2?} N, BPFI {:.2?} N", lines(signal, of_outer), lines(signal, of_inner));
    }
    let [[outer_line, below, above], [sound_line, ..]] =
        [&outer, &sound].map(|signal| lines(signal, of_outer));
    assert!(
        outer_line.min(below).min(above) > 20.0 * sound_line,
        "{outer_line} {below} {above} {sound_line}"
    );
    let [inner_line, below, above] = lines(&inner, of_inner);
    let [sound_line, ..] = lines(&sound, of_inner);
    assert!(
        inner_line > 2.0 * sound_line && below.max(above) < 0.02 * inner_line,
        "{inner_line} {below} {above}"
    );
}

/// The ratios of all shafts of a train of sets.
fn ratios(shafts: &[&str], sets: &[[&str; 3]], brake: &str) -> Result<Vec<String>, ScenarioError> {
    let mut text = String::new();
    for (n, name) in shafts.iter().enumerate() {
        let coupled = if n == 0 {
            "motor"
        } else if *name == brake {
            "brake"
        } else {
            "nothing"
        };
        text += &format!(
            "[[shaft]]\nname = \"{name}\"\nlength_mm = 50.0\nstart_mm = {}.0\nradius_mm = 5.0\ncouples_to = \"{coupled}\"\n",
            100 * n
        );
        text += &[0, 1].map(|at| format!("[[bearing]]\nshaft = \"{name}\"\nat = {at}.0\n")).concat();
    }
    for (n, [sun, carrier, ring]) in sets.iter().enumerate() {
        text += &format!(
            "[[planetary]]\nname = \"p{n}\"\nsun = \"{sun}\"\ncarrier = \"{carrier}\"\nring = \"{ring}\"\n"
        );
        text += "teeth = { sun = 30, planet = 20, ring = 70 }\nplanets = 4\nmodule_mm = 3.0\nface_width_mm = 20.0\n";
    }
    text += "[operation]\ninput_speed_hz = 5.0\nbrake_torque_nm = 20.0\n";
    let layout = Scenario::from_toml(&text)?.layout()?;
    Ok(layout.ratios[..layout.own_shafts()].iter().map(ToString::to_string).collect())
}

/// Speeds are the solution of all relations together; what is locked or free is refused.
#[test]
fn shafts_turn_as_willis_says() {
    let of = |shafts: &[&str], sets: &[[&str; 3]], brake: &str| {
        ratios(shafts, sets, brake).map_err(|error| error.to_string())
    };
    assert_eq!(of(&["in", "out"], &[["in", "out", "fixed"]], "out").unwrap(), ["1/1", "3/10"]);
    assert_eq!(of(&["in", "out"], &[["out", "in", "fixed"]], "out").unwrap(), ["1/1", "10/3"]);
    assert_eq!(of(&["in", "out"], &[["fixed", "in", "out"]], "out").unwrap(), ["1/1", "10/7"]);
    assert_eq!(of(&["in", "out"], &[["in", "fixed", "out"]], "out").unwrap(), ["1/1", "-3/7"]);
    // Two sets with a common sun, neither of which determines it alone.
    let common_sun = [["sun", "out", "in"], ["sun", "fixed", "out"]];
    assert_eq!(of(&["in", "sun", "out"], &common_sun, "out").unwrap(), ["1/1", "-49/51", "7/17"]);

    let free = of(&["in", "out", "ring"], &[["in", "out", "ring"]], "out").unwrap_err();
    assert!(free.contains("is free to turn at any speed"), "{free}");
    let locked = of(&["in", "out"], &[["in", "out", "fixed"], ["out", "in", "fixed"]], "out").unwrap_err();
    assert!(locked.contains("locks the train"), "{locked}");
    let fixed = of(&["in", "out"], &[["in", "fixed", "fixed"]], "out").unwrap_err();
    assert!(fixed.contains("one at most stands still"), "{fixed}");
    let unknown = of(&["in", "out"], &[["in", "away", "fixed"]], "out").unwrap_err();
    assert!(unknown.contains("planetary.carrier") && unknown.contains("\"away\""), "{unknown}");
}

/// What cannot be built is refused with its key, and with what would fit.
#[test]
fn sets_that_do_not_fit_are_refused() {
    let refused = |changes: &[(&str, &str)]| {
        let text = changes.iter().fold(RIG_A.to_owned(), |text, (from, to)| {
            assert!(text.contains(from), "{from}");
            text.replace(from, to)
        });
        let error = Scenario::from_toml(&text).unwrap_err();
        let text = format!("{error}; {}", error.help.as_deref().unwrap_or_default());
        println!("{text}");
        text
    };
    let three = refused(&[("planets = 4", "planets = 3")]);
    assert!(three.contains("planetary.planets") && three.contains("118.8") && three.contains("planet 2"));
    let tight = refused(&[("ring = 81", "ring = 82")]);
    assert!(tight.contains("planetary.teeth") && tight.contains("80.0000") && tight.contains("81.6000"));
    let crowded = refused(&[("planets = 4", "planet_angles_deg = [0.0, 36.0]\nplanets = 2")]);
    assert!(crowded.contains("run into one another"));
    let errors = refused(&[("planets = 4", "planets = 4\npin = { error_um = [1.0] }")]);
    assert!(errors.contains("planetary.pin.error_um"));
    let bearing = |key: &str| {
        format!("[[bearing]]\nshaft = \"p.planet1\"\nat = 0.5\nkind = \"roller\"\n{key}\n\n[operation]")
    };
    for (key, value) in
        [("damping_ratio", "0.2"), ("seat", "{ mass_kg = 2.0 }"), ("tilt_stiffness_nm_per_rad", "1.0")]
    {
        let text = refused(&[("[operation]", &bearing(&format!("{key} = {value}")))]);
        assert!(text.contains(key) && text.contains("has no effect on the bearing of a planet"), "{text}");
    }
    let sensor = refused(&[("ring:p:90", "ring:q:90")]);
    assert!(sensor.contains("sensor.at") && sensor.contains("ring:p:90"));
    let direction = refused(&[("ring:p:90\"", "output:0\"\ndirection = \"radial\"")]);
    assert!(direction.contains("sensor.direction") && direction.contains("\"radial\""));
    let along = refused(&[("ring:p:90\"", "ring:p:90\"\ndirection = \"axial\"")]);
    assert!(along.contains("sensor.direction") && along.contains("\"axial\""));
    let mut sensor = Sensor::default();
    sensor.direction = SensorDirection::Tangential;
    let of_pair = Scenario::new(GearPair::example()).with_sensors(vec![sensor]).validate().unwrap_err();
    assert_eq!(of_pair.key, "sensor.direction");
    let elsewhere = refused(&[(
        "[solver]",
        "[[fault]]\nwheel = \"p.sun\"\nflank = \"ring\"\nkind = \"missing-tooth\"\n[solver]",
    )]);
    assert!(elsewhere.contains("fault.flank"));
    let linear = refused(&[("[operation]", "[[bearing]]\nshaft = \"p.planet1\"\nat = 0.5\n[operation]")]);
    assert!(linear.contains("bearing[4].kind") && linear.contains("planetary.pin.stiffness_n_per_m"));
    let overrun = refused(&[("brake_torque_nm = 263.157894736842", "brake_torque_nm = -263.0")]);
    assert!(overrun.contains("operation.brake_torque_nm"));
}

/// A file with sets is read back as it was written.
#[test]
fn sets_are_written_as_they_are_read() {
    for rig in [GearboxRig::NrelGrc, GearboxRig::PlanetaryLab] {
        let scenario = Scenario::from_toml(&gearbox_template(Some(rig))).unwrap();
        assert_eq!(Scenario::from_toml(&scenario.to_toml()).unwrap(), scenario);
        assert_eq!(scenario.validate().unwrap(), []);
    }
    let nrel = Scenario::from_toml(&gearbox_template(Some(GearboxRig::NrelGrc))).unwrap();
    let layout = nrel.layout().unwrap();
    assert!((layout.ratios[3].value().abs() - 81.49).abs() < 0.005 && !layout.sets[0].sun_drives);
}
