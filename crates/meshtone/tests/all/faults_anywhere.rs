//! Damage on any tooth of either wheel, and several damages at once, under `linear`.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::f64::consts::PI;
use std::num::NonZeroUsize;

use crate::physics::*;
use meshtone::damage::damaged_teeth;
use meshtone::scenario::*;
use meshtone::stiffness::{FlankLoad, LoadedFlank, hertz_compliance_mm_per_n};
use meshtone::wheel::FlankPoint;
use meshtone::{Simulation, simulate, stages};

/// Ideal wheels of 17 and 38 teeth.
fn pair(faults: Vec<Fault>) -> Scenario {
    let mut scenario =
        Scenario::new(GearPair { pinion_speed_hz: 25.0, brake_torque_nm: 60.0, ..GearPair::example() });
    scenario.model = Model::Linear;
    scenario.meshes[0].points_per_tooth = 2_000;
    scenario.solver.sampling_rate_hz = 1e5;
    // Nothing of the start is left.
    scenario.solver.settle_tolerance = 0.0;
    scenario.faults = faults;
    scenario
}

fn pit(start: f64, end: f64) -> PitCircle {
    PitCircle::Fractions { start, end, depth: 0.4 }
}

fn chip() -> ToothBreakage {
    ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 9.0, tip_loss_mm: 0.5 }
}

fn ground() -> ToothDestruction {
    ToothDestruction { start: 0.2, line: DestructionLine::End(0.9), offset_mm: 0.0, noise_mm: 0.0 }
}

/// Every kind of damage.
fn damages() -> [Damage; 8] {
    [
        MissingTooth.into(),
        chip().into(),
        PartialFace { width_mm: 5.0, pit: pit(0.2, 0.8) }.into(),
        ThroughFace { pit: pit(0.2, 0.8) }.into(),
        ground().into(),
        RootCrack { depth_mm: 3.0, angle_deg: 45.0, length_mm: None }.into(),
        Wear { depth_um: 60.0 }.into(),
        Pits::Listed {
            at: vec![0.3, 0.5],
            z_mm: vec![-4.0, 3.0],
            radius_mm: vec![1.0, 1.5],
            face_radius_mm: None,
            depth_mm: vec![0.2, 0.3],
        }
        .into(),
    ]
}

/// Largest difference of two signals over the largest value of the second, the first one turned back by `samples`.
fn off(turned: &[f64], signal: &[f64], samples: usize) -> f64 {
    let mut turned = turned.to_vec();
    turned.rotate_left(samples);
    largest(turned.iter().zip(signal).map(|(a, b)| a - b)) / largest(signal.iter().copied())
}

fn samples_per_pitch(simulation: &Simulation) -> usize {
    simulation.stages.time.samples_per_pinion_revolution / 17
}

// The kept signal is a whole cycle, after which the same two teeth meet again. A tooth of index j is in contact j pitches after
// the first, and on ideal wheels the rest is the same then.
#[test]
fn the_signal_turns_with_the_damaged_tooth() {
    for (wheel, teeth) in [(WheelName::Pinion, [1, 2, 9, 17]), (WheelName::Gear, [1, 3, 20, 38])] {
        for damage in damages() {
            let signals = teeth.map(|tooth| {
                let simulation = simulate(pair(vec![Fault::new(wheel, tooth, damage.clone())])).unwrap();
                let pitch = samples_per_pitch(&simulation);
                assert_eq!(simulation.channels.len(), 17 * 38 * pitch);
                (simulation.channels["vertical_g"].to_vec(), (tooth as usize - 1) * pitch)
            });
            let (first, _) = &signals[0];
            for (signal, turn) in &signals[1..] {
                let left = off(signal, first, *turn);
                println!("{} of the {}: turned, but for {left:.1e}", damage.kind(), wheel.name());
                assert!(left < 1e-8, "{} of the {}: {left:e}", damage.kind(), wheel.name());
                assert!(off(signal, first, 0) > 1e-3, "another tooth is another signal");
            }
        }
    }
}

#[test]
fn a_damaged_tooth_repeats_at_its_own_shaft_s_order() {
    for (wheel, own, other) in [(WheelName::Pinion, 17, 38), (WheelName::Gear, 38, 17)] {
        let simulation = simulate(pair(vec![Fault::new(wheel, 4, MissingTooth)])).unwrap();
        let (pitch, signal) = (samples_per_pitch(&simulation), &simulation.channels["vertical_g"]);
        assert!(off(signal, signal, own * pitch) < 1e-8, "{} once a revolution", wheel.name());
        for turn in [1, other, own - 1] {
            assert!(off(signal, signal, turn * pitch) > 0.1, "{}, {turn} pitches", wheel.name());
        }
        // Where it is in contact the mesh is softer; a revolution of its wheel is a whole number of pitches.
        let mesh = mesh(&simulation.stages);
        let (per_pitch, healthy) = (mesh.points_per_pitch, mesh.healthy_stiffness_n_per_mm());
        let cycle = mesh.stiffness_n_per_mm(0..17 * 38);
        for (pitch, points) in cycle.chunks(per_pitch).enumerate() {
            let softer = points.iter().zip(&healthy).any(|(k, healthy)| *k < 0.99 * healthy);
            // Tooth 4 is in contact for 1.6 pitches.
            assert_eq!(softer, (3..=4).contains(&(pitch % own)), "{}, pitch {pitch}", wheel.name());
        }
    }
}

#[test]
fn faults_on_different_teeth_are_each_its_own() {
    let one = Fault::new(WheelName::Gear, 3, chip());
    let two = Fault::new(WheelName::Pinion, 11, PartialFace { width_mm: 5.0, pit: pit(0.2, 0.8) });
    let meshes =
        [vec![], vec![one.clone()], vec![two.clone()], vec![one.clone(), two.clone()]].map(|faults| {
            let stages = stages(pair(faults)).unwrap();
            (stages.pairs[0].damaged.len(), mesh(&stages).stiffness_n_per_mm(0..17 * 38))
        });
    assert_eq!(meshes.each_ref().map(|(damaged, _)| *damaged), [0, 1, 1, 2]);
    let [(_, sound), (_, of_one), (_, of_two), (_, of_both)] = &meshes;
    let (mut alone, mut together) = (0, 0);
    for i in 0..sound.len() {
        let changed = |of: &[f64]| (of[i] / sound[i] - 1.0).abs() > 1e-12;
        match (changed(of_one), changed(of_two)) {
            // In neighbouring pairs, or in the same one.
            (true, true) => {
                together += 1;
                assert!(of_both[i] <= of_one[i].min(of_two[i]) * (1.0 + 1e-12), "point {i}");
            }
            (one, two) => {
                alone += usize::from(one || two);
                let expected = if one { of_one[i] } else { of_two[i] };
                assert!((of_both[i] / expected - 1.0).abs() < 1e-12, "point {i}");
            }
        }
    }
    assert!(alone > 1000 && together > 0, "{alone} {together}");

    // The order in which they are named says nothing.
    let signal = |faults: Vec<Fault>| simulate(pair(faults)).unwrap().channels["vertical_g"].to_vec();
    let both = signal(vec![one.clone(), two.clone()]);
    assert!(off(&signal(vec![two.clone(), one.clone()]), &both, 0) < 1e-10);
    assert!(off(&signal(vec![one]), &both, 0) > 1e-3 && off(&signal(vec![two]), &both, 0) > 1e-3);
}

#[test]
fn teeth_that_are_alike_make_one_class() {
    let of = |faults: Vec<Fault>| {
        let stages = stages(pair(faults)).unwrap();
        let teeth: Vec<Vec<usize>> =
            stages.pairs[0].damaged.iter().map(|tooth| tooth.teeth.clone()).collect();
        let mesh = mesh(&stages);
        (teeth, mesh.classes.len(), mesh.stiffness_n_per_mm(0..17 * 38))
    };
    // Two pairs of neighbouring teeth are in contact at once.
    let together = of(vec![Fault::new(WheelName::Gear, vec![7, 6, 20], chip())]);
    assert_eq!((&together.0[..], together.1), (&[vec![5, 6, 19]][..], 2));
    let one_by_one = of([7, 6, 20].map(|tooth| Fault::new(WheelName::Gear, tooth, chip())).to_vec());
    assert_eq!((one_by_one.0.len(), one_by_one.1), (3, 4));
    assert!(together.2 == one_by_one.2);
    // All of both wheels: sound pairs have a class, though there are none.
    let all = |damage: &dyn Fn() -> Damage| {
        WheelName::BOTH.map(|wheel| Fault::new(wheel, FaultyTeeth::All, damage()))
    };
    let whole = of(all(&|| chip().into()).to_vec());
    assert_eq!(whole.0.iter().map(Vec::len).collect::<Vec<_>>(), [17, 38]);
    assert_eq!(whole.1, 2);
    let per_pitch = whole.2.len() / (17 * 38);
    assert!(largest(whole.2.iter().zip(&whole.2[per_pitch..]).map(|(a, b)| a - b)) < 1e-9);
    // A tooth with another fault beside the common one, and teeth that are each drawn for themselves.
    let both = of(vec![
        Fault::new(WheelName::Pinion, FaultyTeeth::All, chip()),
        Fault::new(WheelName::Pinion, 3, RootCrack { depth_mm: 3.0, angle_deg: 45.0, length_mm: None }),
    ]);
    assert_eq!(both.0.iter().map(Vec::len).collect::<Vec<_>>(), [16, 1]);
    let rough = ToothDestruction { noise_mm: 0.01, ..ground() };
    let drawn = of(vec![Fault::new(WheelName::Pinion, vec![2, 3], rough)]);
    assert_eq!(drawn.0, [[1], [2]]);
}

#[test]
fn a_tooth_may_be_broken_and_ground() {
    let on_tooth = |damages: &[Damage]| {
        let faults = damages.iter().map(|damage| Fault::new(WheelName::Gear, 5, damage.clone())).collect();
        stages(pair(faults)).unwrap()
    };
    let [broken, flat, both] = [
        on_tooth(&[chip().into()]),
        on_tooth(&[ground().into()]),
        on_tooth(&[chip().into(), ground().into()]),
    ];
    let [tooth] = &both.pairs[0].damaged[..] else { panic!("one tooth") };
    assert_eq!((tooth.wheel, &tooth.teeth[..]), (WheelName::Gear, &[4][..]));
    let kinds = tooth.descriptions.iter().map(|damage| damage.kind);
    assert_eq!(kinds.collect::<Vec<_>>(), ["tooth-breakage", "tooth-destruction"]);
    assert_eq!(tooth.missing_width_mm, broken.pairs[0].damaged[0].missing_width_mm);
    assert_eq!(tooth.flank_y_mm, flat.pairs[0].damaged[0].flank_y_mm);
    let [set_back, of_both] = [&flat, &both].map(|stages| &sound_and_damaged(mesh(stages))[1].states);
    for (both, flat) in of_both.iter().zip(set_back).filter(|(both, _)| both.stiffness_n_per_m > 0.0) {
        assert_eq!(both.separation_m, flat.separation_m);
    }
    let kind = sound_and_damaged(mesh(&both))[1].kind;
    let [broken, flat, both] = [&broken, &flat, &both].map(|stages| {
        let (pairs, ratio) = (stages.tooth_pairs(), stages.pairs[0].teeth.path.contact_ratio);
        (0..=500).map(|k| pairs.at(&kind, ratio * f64::from(k) / 500.0)).collect::<Vec<_>>()
    });
    let mut softer = 0;
    for (both, (broken, flat)) in both.iter().zip(broken.iter().zip(&flat)) {
        let least = broken.stiffness_n_per_mm.min(flat.stiffness_n_per_mm);
        assert!(both.stiffness_n_per_mm <= least * (1.0 + 1e-12), "{both:?}, {broken:?} and {flat:?}");
        assert_eq!(both.face_centre_m, broken.face_centre_m);
        softer += usize::from(both.stiffness_n_per_mm < 0.999 * least);
    }
    assert!(softer > 10, "{softer}");
}

#[test]
fn cuts_that_overlap_are_refused() {
    let refused = |one: Damage, other: Damage, tooth: u32| {
        let named = format!("where fault[0] ({}) has cut it", one.kind());
        let faults = vec![Fault::new(WheelName::Gear, 3, one), Fault::new(WheelName::Gear, tooth, other)];
        stages(pair(faults)).err().map(|error| {
            assert!(error.problem.contains("tooth 3"), "{error}");
            assert!(error.problem.contains(&named), "{error}");
            error.key
        })
    };
    let through = |start, end| ThroughFace { pit: pit(start, end) };
    let partial = |start, end| PartialFace { width_mm: 4.0, pit: pit(start, end) };
    let key = Some("fault[1]".to_owned());
    assert_eq!(refused(through(0.2, 0.5).into(), through(0.4, 0.7).into(), 3), key);
    assert_eq!(refused(through(0.2, 0.5).into(), partial(0.3, 0.4).into(), 3), key);
    assert_eq!(refused(partial(0.6, 0.9).into(), ground().into(), 3), key);
    // Apart, or on another tooth.
    assert_eq!(refused(through(0.2, 0.4).into(), through(0.5, 0.7).into(), 3), None);
    assert_eq!(refused(through(0.2, 0.5).into(), through(0.4, 0.7).into(), 4), None);
}

// Without an offset the line meets the flank at the end's own point. There it does not lie below the flank, so that the ground
// part ends one point before, whichever way the last bit is rounded.
#[test]
fn a_ground_flank_ends_before_the_point_where_the_line_meets_it() {
    for model in [Model::Linear, Model::Published] {
        let mut scenario = Scenario::new(GearPair {
            module_mm: 3.0,
            pinion_teeth: 18,
            gear_teeth: 35,
            face_width_mm: 30.0,
            pinion_speed_hz: 45.0,
            brake_torque_nm: 15.0,
        });
        scenario.model = model;
        let line = DestructionLine::End(13.2 / 14.0);
        let ground = ToothDestruction { start: -0.6 / 14.0, line, offset_mm: 0.0, noise_mm: 0.0 };
        scenario.faults = vec![Fault::on_first_gear_tooth(ground)];
        let tooth = &stages(&scenario).unwrap().pairs[0].damaged[0];
        assert_eq!(tooth.descriptions[0].numbers("indices"), [2815.0, 9587.0], "{model:?}");
    }
}

// The path of equal wheels read from its other end is the path with the wheels exchanged, and what damage on the gear does on the way
// out, the same damage on the pinion does on the way in. The centre distance makes the path so many base pitches long that its points
// are the same from either end: it is the sum of what both tips reach beyond their base circles' tangents, `√(Ra² − Rb²)` each,
// less the tangents' length, `√(a² − 4Rb²)`.
#[test]
fn damage_on_either_of_two_equal_wheels_is_mirrored() {
    for (teeth, ratio) in [(17, 1.5), (31, 1.625)] {
        let (pitch_mm, tip_mm) = (1.5 * f64::from(teeth), 1.5 * f64::from(teeth) + 3.0);
        let base_mm = pitch_mm * 20f64.to_radians().cos();
        let reach_mm = (tip_mm * tip_mm - base_mm * base_mm).sqrt();
        let line_mm = 2.0 * reach_mm - ratio * 2.0 * PI * base_mm / f64::from(teeth);
        for damage in damages() {
            let faults = [(WheelName::Pinion, 2), (WheelName::Gear, 3)];
            let mut scenario =
                pair(faults.map(|(wheel, tooth)| Fault::new(wheel, tooth, damage.clone())).to_vec());
            (scenario.wheels[0].teeth, scenario.wheels[1].teeth) = (teeth, teeth);
            scenario.meshes[0].centre_distance_mm = Some(line_mm.hypot(2.0 * base_mm));
            let stages = stages(&scenario).unwrap();
            let mesh = &stages.meshes_at(NonZeroUsize::new(400).unwrap()).unwrap()[0];
            let [sound, of_gear, of_pinion] = &mesh.classes[..] else { panic!("three classes") };
            assert_eq!([of_pinion.kind.pinion, of_gear.kind.gear], [Some(0), Some(1)]);
            let on_path = mesh.points_before..=mesh.points_before + (ratio * 400.0) as usize;
            let mirrored: Vec<_> = on_path
                .clone()
                .zip(on_path.rev())
                .map(|(at, from_the_end)| (of_pinion.states[at], of_gear.states[from_the_end]))
                .collect();
            let carrying = mirrored.iter().filter(|(_, gear)| gear.stiffness_n_per_m > 0.0);
            let stiffness = carrying.map(|(pinion, gear)| (pinion.stiffness_n_per_m, gear.stiffness_n_per_m));
            if damage != MissingTooth.into() {
                assert_close(&format!("{} on either wheel", damage.kind()), 1e-9, stiffness);
            }
            for (pinion, gear) in &mirrored {
                assert!((pinion.separation_m - gear.separation_m).abs() < 1e-12, "{pinion:?} {gear:?}");
                assert!((pinion.face_centre_m - gear.face_centre_m).abs() < 1e-15, "{pinion:?} {gear:?}");
            }
            // Each is felt: in the stiffness, or, where little material is missing, as a separation.
            let is_softer = of_gear
                .states
                .iter()
                .zip(&sound.states)
                .any(|(gear, sound)| gear.stiffness_n_per_m < 0.99 * sound.stiffness_n_per_m);
            let farthest = largest(of_gear.states.iter().map(|state| state.separation_m));
            assert!(is_softer || farthest > 1e-5, "{}", damage.kind());
        }
    }
}

// Over a pit the mate is loaded, and loads the pitted tooth, at the pit's nearer edge, and the flanks' curvature keeps them apart:
// `x²/(2ρ*)` with the distance x of the edge along the flank.
#[test]
fn the_mate_of_a_pit_touches_its_edges() {
    let mut scenario = pair(vec![Fault::on_first_gear_tooth(ThroughFace { pit: pit(0.2, 0.8) })]);
    scenario.meshes[0].points_per_tooth = 20_000;
    let stages = stages(&scenario).unwrap();
    let damaged = &damaged_teeth(&scenario.faults, &stages.pairs[0].teeth, 1).unwrap()[0];
    let (path, width_mm) = (stages.pairs[0].teeth.path, scenario.wheels[0].face_width_mm);
    let (gear, pinion) =
        (stages.pairs[0].teeth.flank(WheelName::Gear), stages.pairs[0].teeth.flank(WheelName::Pinion));
    let sound = LoadedFlank::new(pinion, None, Material::Steel, &scenario.meshes[0].foundation);
    let pitted = LoadedFlank::new(gear, Some(damaged), Material::Steel, &scenario.meshes[0].foundation);
    let compliance = |flank: &LoadedFlank, point: FlankPoint| {
        let (sin, cos) = (point.load_sin, point.load_cos);
        flank.compliance_mm_per_n(&FlankLoad { point, sin, cos, z_mm: 0.0, width_mm })
    };
    let mesh = &stages.meshes_at(NonZeroUsize::new(5_000).unwrap()).unwrap()[0];
    let [_, damaged_pair] = sound_and_damaged(mesh);
    let [low, high] = damaged.descriptions[0].range;
    for (part, edge) in [(0.1, low), (0.3, low), (0.7, high), (0.9, high)] {
        let [low_mm, high_mm, edge_mm] = [low, high, edge].map(|index| gear.curvature_mm(index));
        let rho_mm = low_mm + part * (high_mm - low_mm);
        let own = compliance(&sound, pinion.at_curvature(path.line_mm - edge_mm));
        let expected = own
            + compliance(&pitted, gear.at_curvature(edge_mm))
            + hertz_compliance_mm_per_n([Material::Steel; 2], width_mm);
        let away_mm =
            (rho_mm * rho_mm - edge_mm * edge_mm) / (2.0 * stages.pairs[0].teeth.gear.base_radius_mm);
        let gap_mm = away_mm * away_mm / (2.0 * rho_mm * (path.line_mm - rho_mm) / path.line_mm);
        let position = path.position(WheelName::Gear, rho_mm);
        let state = damaged_pair.states[mesh.points_before + (position * 5_000.0).round() as usize];
        assert_close("stiffness over a pit", 1e-3, [(state.stiffness_n_per_m * 1e-3, 1.0 / expected)]);
        assert!((state.separation_m * 1e3 - gap_mm).abs() < 2e-4, "{state:?} {gap_mm}");
    }
}

#[test]
fn a_pit_whose_edge_has_broken_off_is_refused() {
    let broken = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 2.0, tip_loss_mm: 3.0 };
    let [pitted, broken]: [Damage; 2] = [ThroughFace { pit: pit(0.2, 0.8) }.into(), broken.into()];
    for faults in [[pitted.clone(), broken.clone()], [broken, pitted]] {
        let faults = faults.map(Fault::on_first_gear_tooth).to_vec();
        let error = stages(pair(faults)).map(drop).unwrap_err().to_string();
        assert!(error.contains("without its edge"), "{error}");
    }
}

#[test]
fn two_ground_lines_have_their_own_roughness() {
    let line = |start, end| ToothDestruction {
        start,
        line: DestructionLine::End(end),
        offset_mm: 0.0,
        noise_mm: 0.02,
    };
    let faults = [line(-0.1, 0.3), line(0.55, 0.95)].map(Fault::on_first_gear_tooth).to_vec();
    let scenario = pair(faults);
    let stages = stages(&scenario).unwrap();
    let damaged = &damaged_teeth(&scenario.faults, &stages.pairs[0].teeth, 1).unwrap()[0];
    let cuts = damaged.descriptions.iter().map(|damage| damage.numbers("indices"));
    let [first, second] = cuts
        .map(|indices| {
            let flank = &damaged.flank_y_mm[indices[0] as usize..indices[1] as usize];
            // Roughness is what differs from point to point; the lines are straight.
            flank.windows(3).map(|y| y[0] - 2.0 * y[1] + y[2]).take(100).collect::<Vec<f64>>()
        })
        .collect::<Vec<_>>()
        .try_into()
        .unwrap();
    assert!(first.len() > 50 && second.len() > 50);
    let alike = first.iter().zip(&second).filter(|(a, b)| (*a - *b).abs() < 1e-9).count();
    assert!(alike < 5, "{alike}");
}
