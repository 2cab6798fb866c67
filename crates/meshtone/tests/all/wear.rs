//! Wear: its shape against known numbers, what it does to pairs and signals, and what is refused.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::damage::{damaged_teeth, load_share, slide_factor};
use meshtone::mesh::{PairKind, Pairs};
use meshtone::scenario::*;
use meshtone::signal::{ChainSettings, SimulatedShafts, kurtosis, rms as rms_of};
use meshtone::wheel::WheelName;
use meshtone::wheel::{Mounting, Teeth};
use meshtone::{simulate, stages};

/// The example's wheels, with bores of 10 mm radius.
fn example_wheels() -> (Gears, Teeth) {
    let GearPair { pinion_teeth, gear_teeth, .. } = GearPair::example();
    wheels(pinion_teeth, gear_teeth)
}

/// The example's wheels with other tooth counts, with bores of 10 mm radius.
fn wheels(pinion_teeth: u32, gear_teeth: u32) -> (Gears, Teeth) {
    let mut gears = example_gears();
    (gears.pinion_teeth, gears.gear_teeth) = (pinion_teeth, gear_teeth);
    let teeth = linear_teeth(&gears, 20.0);
    (gears, teeth)
}

fn worn(wheel: WheelName, teeth: impl Into<FaultyTeeth>, depth_um: f64) -> Fault {
    Fault::new(wheel, teeth, Wear { depth_um })
}

/// All teeth of both wheels.
fn all_worn(pinion_um: f64, gear_um: f64) -> Vec<Fault> {
    vec![
        worn(WheelName::Pinion, FaultyTeeth::All, pinion_um),
        worn(WheelName::Gear, FaultyTeeth::All, gear_um),
    ]
}

fn pitch_point(teeth: &Teeth) -> f64 {
    let gear = teeth.wheel(WheelName::Gear);
    teeth.path.position(WheelName::Gear, gear.curvature_mm(gear.working_pitch_radius_mm))
}

// The numbers of another program.
#[test]
fn slide_factors_are_those_that_are_known() {
    let (_, teeth) = example_wheels();
    let at = |position| WheelName::BOTH.map(|wheel| slide_factor(&teeth, wheel, position));
    let (start, end) = (at(0.0), at(teeth.path.contact_ratio));
    println!("start {start:.4?}, end {end:.4?}");
    for (value, known) in start.into_iter().chain(end).zip([9.264, 0.903, 0.629, 1.697]) {
        assert!((value - known).abs() < 5e-4, "{value} and {known}");
    }
    assert!(largest(at(pitch_point(&teeth))) < 1e-12);
}

// Flanks roll on the working pitch circles, which profile shift and centre distance move.
#[test]
fn shifted_wheels_roll_on_their_working_pitch_circles() {
    for (shifts, apart_mm) in [([0.3, 0.2], 0.0), ([0.4, -0.4], 0.0), ([0.3, 0.2], 0.5)] {
        let mut gears = example_gears();
        [gears.pinion_profile_shift, gears.gear_profile_shift] = shifts;
        gears.centre_distance_mm = Some(Mounting::new(&gears).centre_distance_mm + apart_mm);
        let teeth = linear_teeth(&gears, 20.0);
        let pitch_point = pitch_point(&teeth);
        assert!(largest(WheelName::BOTH.map(|wheel| slide_factor(&teeth, wheel, pitch_point))) < 1e-12);
        for tooth in damaged_teeth(&all_worn(80.0, 80.0), &teeth, 1).unwrap() {
            let depth_mm = tooth.descriptions[0].numbers("depth_mm");
            let wheel = teeth.wheel(tooth.wheel);
            let rolls = teeth.profile(tooth.wheel).nearest_to_radius(wheel.working_pitch_radius_mm);
            assert!(depth_mm[rolls] < 1e-4 && (largest(depth_mm.iter().copied()) - 0.08).abs() < 1e-12);
        }
    }
}

// The share by a formula is near that by the stiffness of the pairs.
#[test]
fn the_load_share_is_near_that_of_the_stiffness() {
    for (z_pinion, z_gear, most) in [(17, 38, 0.081), (25, 30, 0.079), (45, 80, 0.120), (100, 100, 0.135)] {
        let (gears, teeth) = wheels(z_pinion, z_gear);
        let (pairs, ratio) = (sound_pairs(&gears, &teeth), teeth.path.contact_ratio);
        let stiffness = |at: f64| match (0.0..=ratio).contains(&at) {
            true => pairs.at(&SOUND_PAIR, at).stiffness_n_per_mm,
            false => 0.0,
        };
        let off = (0..=100).map(|k| ratio * f64::from(k) / 100.0).map(|at| {
            let of_stiffness = stiffness(at) / (-2..=2).map(|n| stiffness(at + f64::from(n))).sum::<f64>();
            load_share(at, ratio) - of_stiffness
        });
        let off = largest(off);
        println!("{z_pinion}/{z_gear}: {off:.4}");
        assert!(off < most, "{z_pinion}/{z_gear}: {off}");
    }
    // Of three pairs, too.
    let sum: f64 = (0..3).map(|n| load_share(0.1 + f64::from(n), 2.4)).sum();
    assert!((sum - 1.0).abs() < 1e-12);
}

#[test]
fn the_depth_is_archards_scaled_to_its_largest() {
    let (_, teeth) = example_wheels();
    let ratio = teeth.path.contact_ratio;
    for wheel in WheelName::BOTH {
        let damaged = damaged_teeth(&[worn(wheel, FaultyTeeth::All, 80.0)], &teeth, 1).unwrap();
        let flank = teeth.flank(wheel);
        let left_mm = &damaged[0].flank_y_mm;
        let lost_mm: Vec<f64> = flank.profile.y_mm.iter().zip(left_mm).map(|(y, left)| y - left).collect();
        // (µm) Along the flank's normal.
        let depth = |at: f64| {
            let point = flank.at_curvature(teeth.path.curvature_mm(wheel, at));
            point.of(&lost_mm) * point.load_cos * 1e3
        };
        let rate = |at: f64| load_share(at, ratio) * slide_factor(&teeth, wheel, at);
        // The pinion's where the path starts, the gear's where it ends.
        let deepest = if wheel == WheelName::Pinion { 0.0 } else { ratio };
        assert!((depth(deepest) / 80.0 - 1.0).abs() < 0.01, "{}", depth(deepest));
        assert!(depth(pitch_point(&teeth)) < 0.1);
        for k in 1..40 {
            let at = ratio * (f64::from(k) + 0.3) / 40.0;
            let off = depth(at) - 80.0 * rate(at) / rate(deepest);
            assert!(off.abs() < 0.8, "{} at {at}: {off}", wheel.name());
        }
    }
}

// The deepest point of either wheel is where its flank is touched first from its root, not at its tip.
#[test]
fn both_wheels_wear_most_near_their_roots() {
    let (_, teeth) = example_wheels();
    for (tooth, tip_over_root) in
        damaged_teeth(&all_worn(50.0, 50.0), &teeth, 1).unwrap().iter().zip([0.629 / 9.264, 0.903 / 1.697])
    {
        let depth_mm = tooth.descriptions[0].numbers("depth_mm");
        let root = depth_mm[teeth.initial_contact_index(tooth.wheel)];
        let tip = depth_mm[depth_mm.len() - 1];
        assert!((root - 0.05).abs() < 5e-4 && (largest(depth_mm.iter().copied()) - 0.05).abs() < 1e-12);
        assert!((tip / root / tip_over_root - 1.0).abs() < 0.01, "{}", tip / root);
    }
}

// Of few teeth the wear is a narrow strip near the root. It narrows down to 15 teeth; those of fewer are undercut so far up that
// what is left of the involute slides less.
#[test]
fn the_strip_narrows_with_the_number_of_teeth() {
    for (z_pinion, slide, median) in [
        (13, 8.73, 0.068),
        (14, 12.5, 0.049),
        (15, 19.8, 0.033),
        (16, 16.1, 0.042),
        (17, 9.26, 0.072),
        (18, 6.57, 0.100),
        (20, 4.24, 0.152),
        (25, 2.37, 0.257),
    ] {
        let (_, teeth) = wheels(z_pinion, 38);
        let ratio = teeth.path.contact_ratio;
        let positions = || (0..=4000).map(|k| ratio * f64::from(k) / 4000.0);
        let of_slide = largest(positions().map(|at| slide_factor(&teeth, WheelName::Pinion, at)));
        let rate = |at| load_share(at, ratio) * slide_factor(&teeth, WheelName::Pinion, at);
        let mut depths: Vec<f64> = positions().map(rate).collect();
        depths.sort_by(f64::total_cmp);
        let of_median = depths[2000] / depths[4000];
        println!("{z_pinion}: slide {of_slide:.2}, median {of_median:.3}");
        assert!((of_slide / slide - 1.0).abs() < 0.01, "{z_pinion}: {of_slide}");
        assert!((of_median / median - 1.0).abs() < 0.02, "{z_pinion}: {of_median}");
    }
}

/// Scenario of ideal wheels, or of wheels of a grade.
fn scenario(model: Model, pinion_speed_hz: f64, din_grade: u8, faults: Vec<Fault>) -> Scenario {
    let mut scenario =
        Scenario::new(GearPair { pinion_speed_hz, brake_torque_nm: 60.0, ..GearPair::example() });
    scenario.model = model;
    scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = din_grade);
    scenario.faults = faults;
    with_own_structure(&mut scenario);
    scenario.sensors = vec![mean_of_supports()];
    scenario
}

#[test]
fn wear_without_depth_is_none() {
    for model in [Model::Linear, Model::Contact] {
        let of = |faults| stages(scenario(model, 40.0, 0, faults)).unwrap();
        let (healthy, none) = (of(Vec::new()), of(all_worn(0.0, 0.0)));
        let stiffness =
            mesh(&none).stiffness_n_per_mm(0..38).into_iter().zip(mesh(&healthy).stiffness_n_per_mm(0..38));
        let off = largest(stiffness.map(|(none, healthy)| deviation(none, healthy)));
        println!("{}: {off:.1e}", model.name());
        assert!(off < 1e-12, "{}: {off:e}", model.name());
        let [sound, worn] =
            sound_and_damaged(mesh(&none)).map(|table| table.states.iter().map(|state| state.separation_m));
        assert!(sound.eq(worn));
    }
}

// What has worn is missing in the tooth's sections.
#[test]
fn stiffness_falls_a_little_with_the_depth() {
    let (gears, teeth) = example_wheels();
    let ratio = teeth.path.contact_ratio;
    let stiffness = |depth_um: f64| -> Vec<f64> {
        let damaged = damaged_teeth(&all_worn(depth_um, depth_um), &teeth, 1).unwrap();
        let pairs = Pairs::new(&teeth, &damaged, &gears);
        let kind = PairKind { pinion: Some(0), gear: Some(1), pairs_per_cycle: 1 };
        (0..=20).map(|k| pairs.at(&kind, ratio * f64::from(k) / 20.0).stiffness_n_per_mm).collect()
    };
    let all = [0.0, 10.0, 30.0, 60.0, 100.0].map(stiffness);
    for pair in all.windows(2) {
        assert!(pair[1].iter().zip(&pair[0]).all(|(deeper, less)| deeper < less));
    }
    let loss = largest(all[4].iter().zip(&all[0]).map(|(worn, sound)| deviation(*worn, *sound)));
    println!("100 µm on both wheels: {:.2} % of a pair's stiffness at most", 100.0 * loss);
    assert!(loss < 0.0055, "{loss}");
}

/// Rms of the mesh harmonics in the gear's average, kurtosis of its difference signal, and FM4.
fn indicators(scenario: &Scenario) -> [f64; 3] {
    let simulation = simulate(scenario).unwrap();
    let shafts = SimulatedShafts::of_channels(scenario, &simulation.channels);
    let signal = &simulation.channels.signals[0].values;
    let record = shafts.process(signal, WheelName::Gear, &ChainSettings::default()).unwrap();
    let mesh: f64 =
        record.order_spectrum.iter().skip(38).step_by(38).take(10).map(|order| order * order / 2.0).sum();
    let difference = &record.parts.difference;
    assert!(rms_of(difference) > 0.0);
    [mesh.sqrt(), kurtosis(difference).unwrap(), record.indicators.fm4.unwrap()]
}

// Wear of all teeth alike is the same in every pitch: it raises the mesh's harmonics, and gives no tooth away. Wheels of grade 7
// have a difference signal of their own, whose shape stays. That of linear depends on the rate: its force jumps where a pair leaves.
#[test]
fn mesh_harmonics_rise_and_local_indicators_do_not() {
    for (model, speed_hz, mesh_g, shape) in [
        (Model::Linear, 15.0, [2.08, 3.62, 6.22, 14.5], [89.6, 92.5, 93.8, 85.9]),
        (Model::Linear, 25.0, [6.44, 11.2, 19.2, 39.1], [42.0, 43.4, 44.1, 40.7]),
        (Model::Linear, 40.0, [14.3, 19.1, 35.5, 92.6], [26.5, 27.5, 27.9, 25.6]),
        (Model::Contact, 15.0, [0.33, 0.60, 0.85, 1.77], [4.56, 3.75, 3.93, 3.53]),
        (Model::Contact, 40.0, [0.74, 1.83, 3.22, 8.23], [2.81, 3.28, 3.58, 3.24]),
        (Model::Contact, 47.0, [1.61, 2.62, 4.77, 16.9], [2.77, 2.62, 2.66, 2.73]),
    ] {
        let all =
            [[0.0, 0.0], [30.0, 15.0], [60.0, 25.0], [100.0, 100.0]].map(|um| graded(model, speed_hz, um));
        let what = format!("{} at {speed_hz} Hz", model.name());
        println!("{what}: mesh, kurtosis, FM4 {all:.3?}");
        for pair in all.windows(2) {
            assert!(pair[1][0] > pair[0][0], "{what}: mesh harmonics {} after {}", pair[1][0], pair[0][0]);
        }
        assert!(all[3][0] > 2.0 * all[0][0]);
        for worn in &all[1..] {
            assert!((1..3).all(|n| worn[n] < 1.4 * all[0][n]), "{what}: {worn:?} after {:?}", all[0]);
        }
        for (here, (mesh_g, shape)) in all.iter().zip(mesh_g.into_iter().zip(shape)) {
            assert!((here[0] / mesh_g - 1.0).abs() < 0.03, "{what}: {here:?} and {mesh_g} g");
            assert!((1..3).all(|n| (here[n] / shape - 1.0).abs() < 0.03), "{what}: {here:?} and {shape}");
        }
    }
}

/// Indicators of a pair of grade 7 whose wheels have worn by some depths.
fn graded(model: Model, speed_hz: f64, [pinion_um, gear_um]: [f64; 2]) -> [f64; 3] {
    let faults = if pinion_um > 0.0 { all_worn(pinion_um, gear_um) } else { Vec::new() };
    indicators(&scenario(model, speed_hz, 7, faults))
}

// Where little is worn near the path's ends, it is a relief; and near a resonance less can be more.
#[test]
fn a_little_wear_may_lower_the_mesh_harmonics() {
    let (little, some) = ([10.0, 5.0], [60.0, 25.0]);
    for (model, speed_hz, worn_um, sound_g, worn_g) in [
        (Model::Linear, 25.0, little, 6.45, 6.14),
        (Model::Linear, 55.0, little, 29.7, 27.6),
        (Model::Contact, 15.0, little, 0.33, 0.30),
        (Model::Contact, 25.0, little, 1.10, 1.07),
        (Model::Contact, 55.0, some, 5.29, 5.07),
    ] {
        let [sound, worn] = [[0.0; 2], worn_um].map(|um| graded(model, speed_hz, um)[0]);
        println!("{} at {speed_hz} Hz, {worn_um:?}: {sound:.3} g, {worn:.3} g", model.name());
        assert!((sound / sound_g - 1.0).abs() < 0.03 && (worn / worn_g - 1.0).abs() < 0.03);
        assert!(worn < sound);
    }
}

// A single worn tooth does.
#[test]
fn one_worn_tooth_is_a_local_fault() {
    let of = |faults| indicators(&scenario(Model::Contact, 40.0, 7, faults));
    let (sound, one) = (of(Vec::new()), of(vec![worn(WheelName::Gear, 5, 60.0)]));
    println!("mesh, kurtosis, FM4: {sound:.2?}, with one worn tooth {one:.2?}");
    for (value, stated) in
        [(sound[0], 0.74), (one[0], 0.89), (sound[1], 2.81), (one[1], 16.0), (one[2], 16.0)]
    {
        assert!((value / stated - 1.0).abs() < 0.03, "{one:?} after {sound:?}");
    }
}

#[test]
fn worn_teeth_may_have_other_damage() {
    let pit = PitCircle::Fractions { start: 0.2, end: 0.6, depth: 0.3 };
    let line = DestructionLine::End(0.9);
    let ground = ToothDestruction { start: 0.3, line, offset_mm: 0.0, noise_mm: 0.0 };
    let others: [Damage; 6] = [
        MissingTooth.into(),
        ToothBreakage { chip_height_mm: 3.0, chip_width_mm: 6.0, tip_loss_mm: 0.5 }.into(),
        RootCrack { depth_mm: 2.0, angle_deg: 45.0, length_mm: None }.into(),
        PartialFace { width_mm: 4.0, pit }.into(),
        ThroughFace { pit }.into(),
        ground.into(),
    ];
    let worn = worn(WheelName::Gear, FaultyTeeth::All, 100.0);
    for other in others {
        let other = Fault::new(WheelName::Gear, 3, other);
        let of = |faults: Vec<Fault>| {
            let stages = stages(scenario(Model::Linear, 40.0, 0, faults)).unwrap();
            let of_third =
                stages.pairs[0].damaged.iter().find(|tooth| tooth.teeth.contains(&2)).unwrap().clone();
            (of_third, stages.pairs[0].damaged.len(), mesh(&stages).stiffness_n_per_mm(0..38))
        };
        // In whichever order they are named, and as much is left as either leaves.
        let (both, reversed) = (of(vec![worn.clone(), other.clone()]), of(vec![other.clone(), worn.clone()]));
        assert_eq!((both.1, reversed.1), (2, 2));
        assert!(both.0.flank_y_mm == reversed.0.flank_y_mm);
        assert!(both.2 == reversed.2, "{}", other.damage.kind());
        let (of_wear, of_other) = (of(vec![worn.clone()]).0, of(vec![other]).0);
        let outlines = [&of_wear, &of_other, &both.0].map(|tooth| tooth.outline_y_mm());
        for (i, left) in outlines[2].iter().enumerate() {
            assert!((left - outlines[0][i].min(outlines[1][i])).abs() < 1e-12, "point {i}");
        }
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |model, faults: Vec<Fault>| {
        let scenario = scenario(model, 40.0, 0, faults);
        let error = scenario.validate().err().or_else(|| stages(&scenario).err()).unwrap();
        (error.key.clone(), format!("{error}; {}", error.help.as_deref().unwrap_or_default()))
    };
    for depth_um in [-1.0, 100.1] {
        let (key, text) = refused(Model::Linear, vec![worn(WheelName::Gear, 1, depth_um)]);
        assert!(key == "fault.depth_um" && text.contains("must be from 0 µm to 100 µm"), "{text}");
        assert!(text.contains("tooth-destruction"), "{text}");
    }
    let (key, text) = refused(
        Model::Linear,
        vec![worn(WheelName::Gear, FaultyTeeth::All, 5.0), worn(WheelName::Gear, 3, 5.0)],
    );
    assert!(
        key == "fault[1].kind" && text.contains("tooth 3 of the gear has fault[0] already (wear)"),
        "{text}"
    );
    let (key, text) = refused(Model::Published, vec![worn(WheelName::Gear, 1, 5.0)]);
    assert!(key == "fault.kind" && text.contains("is not supported by the published model"), "{text}");
    let mut small = scenario(Model::Linear, 40.0, 0, vec![worn(WheelName::Gear, 1, 99.0)]);
    small.meshes[0].module_mm = 0.05;
    small.wheels.iter_mut().for_each(|wheel| (wheel.face_width_mm, wheel.tip_chamfer_mm) = (0.25, None));
    small.rig_mut().unwrap().pinion_shaft.radius_mm = 0.1;
    small.rig_mut().unwrap().gear_shaft.radius_mm = 0.1;
    let error = stages(&small).unwrap_err();
    assert!(
        error.key == "fault.depth_um" && error.problem.contains("less than the tooth's thickness"),
        "{error}"
    );
}
