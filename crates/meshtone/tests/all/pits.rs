//! Pits: what they take of face, section and flank, how they are drawn, and what is refused.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::damage::{DamageDescription, DamagedTooth, FlankPit, Section, damaged_teeth, damages_of_fault};
use meshtone::mesh::{LoadedPair, PairKind, Pairs};
use meshtone::scenario::*;
use meshtone::wheel::Teeth;
use meshtone::{simulate, stages};

const WIDTH_MM: f64 = 15.0;
const DAMAGED_GEAR: PairKind = PairKind { pinion: None, gear: Some(0), pairs_per_cycle: 1 };

/// The example's wheels, with bores of 10 mm radius.
fn wheels() -> (Gears, Teeth) {
    let gears = example_gears();
    let teeth = linear_teeth(&gears, 20.0);
    (gears, teeth)
}

/// Pits by place along the flank, along the face, radii along both, and depth.
fn listed(pits: &[[f64; 5]]) -> Pits {
    let column = |n: usize| pits.iter().map(|pit| pit[n]).collect();
    Pits::Listed {
        at: column(0),
        z_mm: column(1),
        radius_mm: column(2),
        face_radius_mm: Some(column(3)),
        depth_mm: column(4),
    }
}

fn damaged(teeth: &Teeth, faults: &[Damage]) -> Vec<DamagedTooth> {
    let faults: Vec<Fault> = faults.iter().cloned().map(Fault::on_first_gear_tooth).collect();
    damaged_teeth(&faults, teeth, 1).unwrap()
}

/// The pair of the gear's damaged tooth where its flank is touched at a fraction of its contact part.
fn at(gears: &Gears, teeth: &Teeth, damaged: &[DamagedTooth], fraction: f64) -> LoadedPair {
    let pairs = Pairs::new(teeth, damaged, gears);
    let flank = teeth.flank(WheelName::Gear);
    let first = teeth.initial_contact_index(WheelName::Gear);
    let index = first + (fraction * (flank.profile.len() - 1 - first) as f64).round() as usize;
    pairs.at(&DAMAGED_GEAR, teeth.path.position(WheelName::Gear, flank.curvature_mm(index)))
}

// An ellipse whose middle is at the face's end reaches in by its radius: there the pair bears as beside a pit over part of the
// face, and where the section's loss begins it is the same.
#[test]
fn a_pit_at_the_face_s_end_bears_as_a_partial_one() {
    let (gears, teeth) = wheels();
    let width_mm = 4.0;
    let ellipse = damaged(&teeth, &[listed(&[[0.5, WIDTH_MM / 2.0, 1.0, width_mm, 0.2]]).into()]);
    let pit = PitCircle::Fractions { start: 0.4, end: 0.6, depth: 0.2 };
    let partial = damaged(&teeth, &[PartialFace { width_mm, pit }.into()]);
    let [ellipse, partial] =
        [&ellipse, &partial].map(|damaged| at(&gears, &teeth, damaged, 0.5).face_centre_m);
    println!("{ellipse}, {partial}");
    assert!((ellipse / partial - 1.0).abs() < 1e-6, "{ellipse} and {partial}");
    // The mean of what is left of the face from −7.5 mm on.
    assert!((ellipse * 1e3 + width_mm / 2.0).abs() < 1e-5);
}

// Sections of a pit that is as wide everywhere as the one over part of the face and as deep, at its own place.
#[test]
fn sections_are_those_of_their_blocks() {
    let (_, teeth) = wheels();
    let profile = teeth.profile(WheelName::Gear);
    let pits = [[0.5, 5.5, 1.5, 3.0, 0.3], [0.45, 4.0, 1.0, 2.0, 0.5], [0.5, -4.0, 1.0, 1.5, 0.2]];
    let tooth = damaged(&teeth, &[listed(&pits).into()]).remove(0);
    let flank = tooth.pits.as_ref().unwrap();
    let mut compared = 0;
    for i in (0..profile.len()).step_by(100) {
        let (y, half) = (profile.y_mm[i], WIDTH_MM / 2.0);
        let section = Section::damaged(&tooth, profile, WIDTH_MM, i);
        // By columns along the face; the sections' z runs the other way.
        let (columns, mut sums) = (30_000, [0.0; 6]);
        let dz = WIDTH_MM / f64::from(columns);
        for k in 0..columns {
            let z = dz * (f64::from(k) + 0.5) - half;
            let depth = flank.pits.iter().filter(|pit| {
                let (u, v) =
                    ((flank.along_mm[i] - pit.along_mm) / pit.radius_mm, (z - pit.z_mm) / pit.face_radius_mm);
                u * u + v * v < 1.0
            });
            let top = y - depth.map(|pit| pit.depth_mm).fold(0.0, f64::max) / flank.normal_cos[i];
            let (area, first) = (dz * (top + y), dz * (top * top - y * y) / 2.0);
            let of_column =
                [area, first, -area * z, dz * (top.powi(3) + y.powi(3)) / 3.0, area * z * z, -first * z];
            sums.iter_mut().zip(of_column).for_each(|(sum, part)| *sum += part);
        }
        let [a, ay, az, yy, zz, yz] = sums;
        let (yc, zc) = (ay / a, az / a);
        let exact = [a, yc, zc, yy - a * yc * yc, zz - a * zc * zc, yz - a * yc * zc];
        let Section { area_mm2, yc_mm, zc_mm, iz_mm4, iy_mm4, iyz_mm4, .. } = section;
        let of_section = [area_mm2, yc_mm, zc_mm, iz_mm4, iy_mm4, iyz_mm4];
        for (value, (exact, scale)) in
            of_section.iter().zip(exact.iter().zip([a, y, half, yy, zz, (yy * zz).sqrt()]))
        {
            assert!((value - exact).abs() < 3e-5 * scale, "point {i}: {of_section:?} and {exact:?}");
        }
        let sound = Section::sound(WIDTH_MM, y);
        assert!(section.shear_per_mm2 >= sound.shear_per_mm2 * (1.0 - 1e-12));
        compared += usize::from(area_mm2 < 0.999 * sound.area_mm2);
    }
    assert!(compared > 10, "{compared}");
}

#[test]
fn pits_that_lie_over_one_another_count_once() {
    let (gears, teeth) = wheels();
    let one = [0.5, 1.0, 1.0, 1.0, 0.2];
    let [single, twice] = [&[one][..], &[one, one]].map(|pits| damaged(&teeth, &[listed(pits).into()]));
    for fraction in [0.3, 0.45, 0.5, 0.6] {
        let [single, twice] = [&single, &twice].map(|damaged| at(&gears, &teeth, damaged, fraction));
        assert!((single.stiffness_n_per_mm / twice.stiffness_n_per_mm - 1.0).abs() < 1e-12);
        assert_eq!(single.face_centre_m, twice.face_centre_m);
    }
    // Two faults or one.
    let apart = [0.4, -4.0, 0.8, 0.8, 0.1];
    let together = damaged(&teeth, &[listed(&[one, apart]).into()]);
    let in_two = damaged(&teeth, &[listed(&[one]).into(), listed(&[apart]).into()]);
    let [together, in_two] = [&together, &in_two].map(|damaged| at(&gears, &teeth, damaged, 0.45));
    assert_eq!(together, in_two);
    // Two pits in the middle of the face, one on either side: the load stays in the middle.
    let even = damaged(&teeth, &[listed(&[[0.5, -4.0, 1.0, 1.0, 0.1], [0.5, 4.0, 1.0, 1.0, 0.1]]).into()]);
    assert!(at(&gears, &teeth, &even, 0.5).face_centre_m.abs() < 1e-15);
}

#[test]
fn pairs_get_softer_with_every_size() {
    let (gears, teeth) = wheels();
    let stiffness = |pit: [f64; 5]| {
        let damaged = damaged(&teeth, &[listed(&[pit]).into()]);
        [0.2, 0.35, 0.45, 0.5, 0.55, 0.8]
            .map(|fraction| at(&gears, &teeth, &damaged, fraction).stiffness_n_per_mm)
    };
    let sound = stiffness([0.5, 2.0, 1e-9, 1e-9, 0.2]);
    let pairs = sound_pairs(&gears, &teeth);
    let none = at(&gears, &teeth, &damaged(&teeth, &[listed(&[[0.5, 2.0, 1e-9, 1e-9, 0.0]]).into()]), 0.2);
    let position = |fraction: f64| {
        let flank = teeth.flank(WheelName::Gear);
        let first = teeth.initial_contact_index(WheelName::Gear);
        let index = first + (fraction * (flank.profile.len() - 1 - first) as f64).round() as usize;
        teeth.path.position(WheelName::Gear, flank.curvature_mm(index))
    };
    let healthy = pairs.at(&SOUND_PAIR, position(0.2)).stiffness_n_per_mm;
    assert!((none.stiffness_n_per_mm / healthy - 1.0).abs() < 1e-12);
    for grow in [
        (|size| [0.5, 2.0, size, size, 0.2]) as fn(f64) -> [f64; 5],
        |size| [0.5, 2.0, 1.0, size, 0.2],
        |size| [0.5, 2.0, 1.0, 2.0, 0.4 * size],
    ] {
        let mut before = sound;
        for size in [0.25, 0.5, 1.0, 1.5] {
            let here = stiffness(grow(size));
            assert!(
                here.iter().zip(before).all(|(here, before)| *here <= before * (1.0 + 1e-12)),
                "{here:?}, {before:?}"
            );
            assert!(here[3] < before[3]);
            before = here;
        }
    }
}

/// A scenario of the pair under a model.
fn scenario(model: Model, faults: Vec<Fault>) -> Scenario {
    let mut scenario =
        Scenario::new(GearPair { face_width_mm: WIDTH_MM, brake_torque_nm: 60.0, ..GearPair::example() });
    scenario.model = model;
    scenario.faults = faults;
    scenario
}

fn drawn(density_per_cm2: f64) -> Pits {
    Pits::Drawn { density_per_cm2, spread: 0.1, radius_mm: 0.4, radius_spread: 0.4, depth_mm: 0.1 }
}

// Pitting begins where the flanks roll, also on shifted wheels.
#[test]
fn drawn_pits_lie_about_the_working_pitch_circle() {
    for shifts in [[0.0, 0.0], [0.3, 0.2], [0.4, -0.4]] {
        let (mut gears, _) = wheels();
        [gears.pinion_profile_shift, gears.gear_profile_shift] = shifts;
        let teeth = linear_teeth(&gears, 20.0);
        let pits = Pits::Drawn {
            density_per_cm2: 8.0,
            spread: 0.0,
            radius_mm: 0.4,
            radius_spread: 0.0,
            depth_mm: 0.1,
        };
        for wheel in WheelName::BOTH {
            let tooth = damaged_teeth(&[Fault::new(wheel, 1, pits.clone())], &teeth, 1).unwrap().remove(0);
            let (profile, first) = (teeth.profile(wheel), teeth.initial_contact_index(wheel));
            let spacing = 1.0 / (profile.len() - 1 - first) as f64;
            let rolls = profile.nearest_to_radius(teeth.wheel(wheel).working_pitch_radius_mm) - first;
            let drawn = &tooth.pits.as_ref().unwrap().pits;
            assert!(!drawn.is_empty());
            assert!(drawn.iter().all(|pit| (pit.at - rolls as f64 * spacing).abs() < 1e-12), "{shifts:?}");
        }
    }
}

#[test]
fn drawn_pits_may_be_listed() {
    let fault = Fault::new(WheelName::Pinion, vec![2, 9], drawn(8.0));
    let of = |seed: u64| stages(scenario(Model::Contact, vec![fault.clone()]).with_seed(seed)).unwrap();
    let stages_of_one = of(1);
    let teeth = damages_of_fault(&stages_of_one.pairs[0].damaged, 0);
    assert_eq!(teeth.iter().map(|(tooth, _)| *tooth).collect::<Vec<_>>(), [2, 9]);
    assert!(teeth[0].1 != teeth[1].1 && !teeth[0].1.numbers("at").is_empty());
    let again = of(1);
    assert_eq!(damages_of_fault(&again.pairs[0].damaged, 0), teeth);
    let other = of(2);
    assert!(damages_of_fault(&other.pairs[0].damaged, 0) != teeth);
    // What was drawn is written down as a list, and gives the same signal.
    let list = |pits: &DamageDescription| Pits::Listed {
        at: pits.numbers("at"),
        z_mm: pits.numbers("z_mm"),
        radius_mm: pits.numbers("radius_mm"),
        face_radius_mm: Some(pits.numbers("face_radius_mm")),
        depth_mm: pits.numbers("depth_mm"),
    };
    let as_lists =
        teeth.iter().map(|(tooth, pits)| Fault::new(WheelName::Pinion, *tooth, list(pits))).collect();
    let [of_draw, of_lists] =
        [vec![fault.clone()], as_lists].map(|faults| simulate(scenario(Model::Contact, faults)).unwrap());
    assert!(of_draw.channels["vertical_g"] == of_lists.channels["vertical_g"]);
}

#[test]
fn draws_are_about_the_pitch_circle_and_as_many_as_asked() {
    let (_, teeth) = wheels();
    let all: Vec<FlankPit> = (0..400)
        .flat_map(|seed| {
            let tooth =
                damaged_teeth(&[Fault::on_first_gear_tooth(drawn(6.0))], &teeth, seed).unwrap().remove(0);
            tooth.pits.unwrap().pits
        })
        .collect();
    let flank = damaged(&teeth, &[drawn(0.0).into()]).remove(0).pits.unwrap();
    let area_cm2 = flank.along_mm.last().unwrap() * WIDTH_MM * 1e-2;
    let count = all.len() as f64 / 400.0;
    assert!((count / (6.0 * area_cm2) - 1.0).abs() < 0.05, "{count} for {}", 6.0 * area_cm2);
    let of = |value: fn(&FlankPit) -> f64| all.iter().map(value).collect::<Vec<_>>();
    let places = of(|pit| pit.at);
    println!("{count:.2} pits a tooth, about {:.3} ± {:.3}", mean(&places), deviation_about_mean(&places));
    assert!((deviation_about_mean(&places) - 0.1).abs() < 0.01);
    let logarithms = of(|pit| (pit.radius_mm / 0.4).ln());
    assert!(mean(&logarithms).abs() < 0.03 && (deviation_about_mean(&logarithms) - 0.4).abs() < 0.03);
    assert!(mean(&of(|pit| pit.z_mm)).abs() < 0.5);
    assert!(all.iter().all(|pit| pit.z_mm.abs() <= WIDTH_MM / 2.0 && (0.0..=1.0).contains(&pit.at)));
}

#[test]
fn the_area_is_that_of_the_ellipses() {
    let (_, teeth) = wheels();
    let area = |pits: &[[f64; 5]]| {
        damaged(&teeth, &[listed(pits).into()])[0].descriptions[0].numbers("area_percent")[0]
    };
    let one = area(&[[0.5, 0.0, 1.0, 1.0, 0.1]]);
    let flank = damaged(&teeth, &[drawn(0.0).into()]).remove(0).pits.unwrap();
    let exact = 100.0 * std::f64::consts::PI / (flank.along_mm.last().unwrap() * WIDTH_MM);
    println!("a circle of 1 mm: {one:.3} %");
    assert!((one / exact - 1.0).abs() < 1e-4, "{one} and {exact}");
    assert!(
        (area(&[[0.5, 4.0, 1.0, 1.0, 0.1], [0.5, -4.0, 1.0, 2.0, 0.1]]) / (3.0 * one) - 1.0).abs() < 1e-4
    );
}

// The wheels tilt with the load that leaves the middle of the face.
#[test]
fn pits_beside_the_middle_tilt_the_wheels() {
    for model in [Model::Linear, Model::Contact] {
        let axial = |z_mm: f64| {
            let pits = listed(&[[0.5, z_mm, 1.5, 2.0, 0.2], [0.5, -z_mm, 1.5, 2.0, 0.2]]);
            let aside = listed(&[[0.5, z_mm, 1.5, 2.0, 0.2]]);
            [pits, aside].map(|pits| {
                let stages = stages(scenario(model, vec![Fault::on_first_gear_tooth(pits)])).unwrap();
                let [_, damaged] = sound_and_damaged(mesh(&stages));
                largest(damaged.states.iter().map(|state| state.face_centre_m))
            })
        };
        let [even, aside] = axial(4.0);
        // 4 mm beside the middle 4 mm of 15 are gone.
        assert!(
            even < 1e-15 && (aside * 1e3 - 4.0 * 4.0 / 11.0).abs() < 0.05,
            "{}: {even} {aside}",
            model.name()
        );
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let refused = |model, faults: Vec<Damage>| {
        let scenario = scenario(model, faults.into_iter().map(Fault::on_first_gear_tooth).collect());
        let error = scenario.validate().err().or_else(|| stages(&scenario).err()).unwrap();
        (error.key.clone(), error.to_string())
    };
    let one = [0.5, 0.0, 1.0, 1.0, 0.1];
    let with = |place: usize, value: f64| {
        let mut pit = one;
        pit[place] = value;
        vec![listed(&[one, pit]).into()]
    };
    for (place, value, key, words) in [
        (0, 1.1, "fault.at[1]", "must be from 0 to 1"),
        (
            1,
            8.6,
            "fault.z_mm[1]",
            "must be less than 8.5 mm from the face's middle, or the pit misses the face",
        ),
        (2, 0.0, "fault.radius_mm[1]", "more than 0 mm"),
        (3, -1.0, "fault.face_radius_mm[1]", "more than 0 mm"),
        (4, 9.0, "fault.depth_mm[1]", "must be less deep than the tooth"),
    ] {
        let (found, text) = refused(Model::Linear, with(place, value));
        assert!(found == key && text.contains(words), "{text}");
    }
    let (key, text) = refused(Model::Linear, vec![listed(&[]).into()]);
    assert!(key == "fault.at" && text.contains("at least one pit"), "{text}");
    let uneven = Pits::Listed {
        at: vec![0.5, 0.6],
        z_mm: vec![0.0],
        radius_mm: vec![1.0; 2],
        face_radius_mm: None,
        depth_mm: vec![0.1; 2],
    };
    let (key, text) = refused(Model::Linear, vec![uneven.into()]);
    assert!(key == "fault.z_mm" && text.contains("has 1 numbers; must have 2, as fault.at"), "{text}");
    let (key, text) = refused(Model::Linear, vec![listed(&[[0.5, 0.0, 1.0, 20.0, 0.1]]).into()]);
    assert!(key == "fault" && text.contains("no more than 2 % of the face"), "{text}");
    let halves = [listed(&[[0.5, 7.5, 1.0, 8.0, 0.1]]).into(), listed(&[[0.5, -7.5, 1.0, 8.0, 0.1]]).into()];
    let (key, text) = refused(Model::Linear, halves.to_vec());
    assert!(key == "fault[1]" && text.contains("together with other pits"), "{text}");
    let (key, text) = refused(Model::Linear, vec![drawn(1e5).into()]);
    assert!(key == "fault.random.density_per_cm2" && text.contains("must be at most"), "{text}");
    let (key, text) = refused(Model::Published, vec![listed(&[one]).into()]);
    assert!(key == "fault.kind" && text.contains("is not supported by the published model"), "{text}");
}
