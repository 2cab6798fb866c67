//! Tests of a planet in a ring with internal teeth, and of external wheels whose tips differ.
#![allow(clippy::unwrap_used)]

use std::f64::consts::TAU;
use std::num::NonZeroUsize;

use super::corner::Corner;
use super::path_table::{PairState, PairTables};
use super::sliding::Friction;
use super::{Contact, FaceForm, Mesh, MeshParameters, PairKind, PairSequence, Pairs, TipShape, Turning};
use crate::damage::{Fault, damage_kinds, damaged_teeth};
use crate::wheel::{FlankRelief, Gears, ReliefShape, Teeth, Wheel, WheelName, teeth};

fn planet_in_ring() -> (Gears, Teeth) {
    let mut gears = Gears::new(3.2, 31, 81, 38.1);
    (gears.internal, gears.points_per_tooth) = (true, 2000);
    let teeth = teeth(&gears, [24.8, 200.0]);
    (gears, teeth)
}

const SHAPE: TipShape = TipShape {
    chamfer_mm: 0.4,
    active_profile_shortening: 0.05,
    relief: FlankRelief { shape: ReliefShape::Linear, length_mm: 1.0, amount_um: 10.0 },
};

const SOUND: PairKind = PairKind { pinion: None, gear: None, pairs_per_cycle: 1 };

/// (mm) A flank's point with a radius of curvature, in polar coordinates about the wheel's centre; both flanks turn anticlockwise and their
/// base circles are touched at the angle `−α`.
fn on_flank(wheel: &Wheel, rho_mm: f64, now_mm: f64, turned_mm: f64) -> [f64; 2] {
    let base_mm = wheel.base_radius_mm;
    let angle = -wheel.working_pressure_angle_rad + (now_mm - rho_mm + turned_mm) / base_mm;
    [rho_mm.hypot(base_mm), angle + (rho_mm / base_mm).atan()]
}

/// (mm, rad) A point in polar coordinates about a centre that lies `right_mm` beside the first one.
fn about([radius_mm, angle]: [f64; 2], right_mm: f64) -> [f64; 2] {
    let (x_mm, y_mm) = (radius_mm * angle.cos() - right_mm, radius_mm * angle.sin());
    [x_mm.hypot(y_mm), y_mm.atan2(x_mm)]
}

// With wheels as they stand beside one another: both turn on, or back, and the corner's angle is compared with that of the mate's flank at
// the corner's radius.
#[test]
fn corners_part_from_the_mate_s_flank_as_the_wheels_turn() {
    let (_, teeth) = planet_in_ring();
    let Teeth { pinion: planet, gear: ring, path, .. } = &teeth;
    let distance_mm = ring.working_pitch_radius_mm - planet.working_pitch_radius_mm;
    let rho_at = |wheel: &Wheel, radius_mm: f64| (radius_mm.powi(2) - wheel.base_radius_mm.powi(2)).sqrt();
    let tips_mm = [planet, ring].map(|wheel| rho_at(wheel, wheel.tip_radius_mm));
    for outside in [0.02, 0.05, 0.1, 0.2, 0.5] {
        let outside_mm = outside * path.base_pitch_mm;
        // The planet's corner beyond the end, about the ring's centre.
        let corner = about(on_flank(planet, tips_mm[0], tips_mm[0], outside_mm), -distance_mm);
        let flank = on_flank(ring, rho_at(ring, corner[0]), tips_mm[0] - path.line_mm, outside_mm);
        let beyond_mm = ring.base_radius_mm * (flank[1] - corner[1]);
        // The ring's corner before the start, about the planet's centre.
        let corner = about(on_flank(ring, tips_mm[1], tips_mm[1], -outside_mm), distance_mm);
        let flank = on_flank(planet, rho_at(planet, corner[0]), tips_mm[1] + path.line_mm, -outside_mm);
        let before_mm = planet.base_radius_mm * (corner[1] - flank[1]);
        for (own, mate, expected_mm) in [(planet, ring, beyond_mm), (ring, planet, before_mm)] {
            let separation_mm =
                Corner::new(own, mate, path.line_mm, own.tip_radius_mm).separation_mm(outside_mm);
            assert!(expected_mm > 0.0);
            assert!((separation_mm - expected_mm).abs() < 1e-10, "{outside}: {separation_mm} {expected_mm}");
        }
    }
}

fn tabulated(gears: &Gears, teeth: &Teeth, faults: &[Fault], shape: TipShape) -> Vec<PairState> {
    let damaged = damaged_teeth(faults, teeth, 1).unwrap();
    let pairs = Pairs::new(teeth, &damaged, gears);
    let of = |wheel| damaged.iter().position(|tooth| tooth.wheel == wheel);
    let kind = PairKind { pinion: of(WheelName::Pinion), gear: of(WheelName::Gear), ..SOUND };
    let positions: Vec<f64> = (0..600).map(|n| -0.4 + 0.005 * f64::from(n)).collect();
    PairTables::new(&pairs, [shape; 2], Contact::Unilateral).tabulate(&kind, &positions, 0.005)
}

#[test]
fn every_damage_of_planet_and_ring_is_seen_in_their_mesh() {
    let (gears, teeth) = planet_in_ring();
    let shape = TipShape { relief: FlankRelief { amount_um: 0.0, ..SHAPE.relief }, ..SHAPE };
    let sound = tabulated(&gears, &teeth, &[], shape);
    for wheel in WheelName::BOTH {
        for kind in damage_kinds() {
            let severity = if kind.sizes.is_empty() { 1.0 } else { 0.3 };
            let fault = Fault::new(wheel, 1, kind.example).with_severity(severity);
            let own_sizes = Fault { severity: None, ..fault.with_sizes(&teeth) };
            assert!((own_sizes.severity_on(&teeth) - severity).abs() < 2e-3, "{}", kind.name);
            let damaged = tabulated(&gears, &teeth, &[fault], shape);
            let (mut softest, mut stiffest, mut nearest_m, mut farthest_m) =
                (f64::INFINITY, 0.0_f64, 0.0_f64, 0.0_f64);
            for (sound, damaged) in sound.iter().zip(&damaged) {
                let stiffness = damaged.stiffness_n_per_m / sound.stiffness_n_per_m;
                (softest, stiffest) = (softest.min(stiffness), stiffest.max(stiffness));
                if stiffness > 0.0 {
                    let apart_m = damaged.separation_m - sound.separation_m;
                    (nearest_m, farthest_m) = (nearest_m.min(apart_m), farthest_m.max(apart_m));
                }
            }
            let what = format!("{} of {}", kind.name, wheel.name());
            println!(
                "{what}: {softest:.3} to {stiffest:.3} of the stiffness, {:.1} µm apart",
                farthest_m * 1e6
            );
            assert!(softest < 0.98 || farthest_m > 5e-6, "{what}");
            // Nothing brings flanks closer, or makes a pair stiffer than the load's moving to the edge of a hollow does.
            assert!(nearest_m > -1e-9 && stiffest < 1.3, "{what}: {nearest_m:e}, {stiffest}");
        }
    }
}

#[test]
fn chamfer_and_relief_are_at_the_tips() {
    let (gears, teeth) = planet_in_ring();
    let pairs = Pairs::new(&teeth, &[], &gears);
    let path = &teeth.path;
    let whole = TipShape { active_profile_shortening: 0.0, ..SHAPE };
    let ends = PairTables::new(&pairs, [whole; 2], Contact::Unilateral).path_of_sound_teeth();
    for (wheel, end) in [WheelName::Gear, WheelName::Pinion].into_iter().zip(ends) {
        let own = teeth.wheel(wheel);
        let radius_mm = path.curvature_mm(wheel, end).hypot(own.base_radius_mm);
        assert!((radius_mm - (own.tip_radius_mm - own.sign() * 0.4)).abs() < 1e-9, "{radius_mm}");
        let of_length = |length_mm: f64| own.curvature_mm(own.tip_radius_mm - own.sign() * length_mm);
        for (below_mm, gap_um) in [(0.0, 10.0), (0.5, 5.0), (1.0, 0.0), (2.0, 0.0)] {
            assert!((whole.relief.gap_mm(own, of_length(below_mm)) * 1e3 - gap_um).abs() < 1e-9);
        }
    }
    assert!(0.0 < ends[0] && ends[1] < path.contact_ratio, "{ends:?}");
    let active = PairTables::new(&pairs, [SHAPE; 2], Contact::Unilateral).path_of_sound_teeth();
    assert!((ends[1] - ends[0] - (active[1] - active[0]) - 0.05).abs() < 1e-12);
}

const SHARP: TipShape = TipShape {
    chamfer_mm: 0.0,
    active_profile_shortening: 0.0,
    relief: FlankRelief { amount_um: 0.0, ..SHAPE.relief },
};

/// A driving wheel of 17 teeth and a driven one of 38.
fn external() -> (Gears, Teeth) {
    let gears = Gears { points_per_tooth: 2000, ..Gears::new(3.0, 17, 38, 15.0) };
    let teeth = teeth(&gears, [10.0, 10.0]);
    (gears, teeth)
}

// The path ends where the radius of curvature of the driving wheel's flank is that of its tip, and begins at that of the driven wheel's.
#[test]
fn a_chamfer_shortens_the_path_at_its_wheel_s_end() {
    let (gears, teeth) = external();
    let pairs = Pairs::new(&teeth, &[], &gears);
    let ends = |shapes| PairTables::new(&pairs, shapes, Contact::Unilateral).path_of_sound_teeth();
    let [begins, ends_at] = ends([SHARP; 2]);
    assert!(begins.abs() < 1e-12 && (ends_at - teeth.path.contact_ratio).abs() < 1e-12);
    let lost = |module_mm: f64, teeth: f64| {
        let (tip_mm, base_mm) =
            (module_mm * (teeth / 2.0 + 1.0), module_mm * teeth / 2.0 * 20.0_f64.to_radians().cos());
        let curvature_mm = |radius_mm: f64| (radius_mm.powi(2) - base_mm.powi(2)).sqrt();
        (curvature_mm(tip_mm) - curvature_mm(tip_mm - 0.4)) / (TAU * base_mm / teeth)
    };
    let chamfered = TipShape { chamfer_mm: 0.4, ..SHARP };
    let shortened = TipShape { active_profile_shortening: 0.1, ..SHARP };
    let [of_pinion, of_gear] = [17.0, 38.0].map(|teeth| lost(3.0, teeth));
    assert!(of_pinion > 0.05 && (of_gear / of_pinion - 1.0).abs() > 0.1, "{of_pinion} {of_gear}");
    for (shapes, [start, end]) in [
        ([chamfered, SHARP], [0.0, of_pinion]),
        ([SHARP, chamfered], [of_gear, 0.0]),
        ([chamfered; 2], [of_gear, of_pinion]),
        ([shortened, SHARP], [0.0, 0.05]),
        ([SHARP, shortened], [0.05, 0.0]),
    ] {
        let [from, until] = ends(shapes);
        assert!((from - begins - start).abs() < 1e-12, "{from} {start}");
        assert!((ends_at - until - end).abs() < 1e-12, "{until} {end}");
    }
}

#[test]
fn a_mirrored_pair_goes_through_its_path_the_other_way() {
    let (gears, teeth) = external();
    let relieved = TipShape { relief: SHAPE.relief, ..SHARP };
    let chamfered = TipShape { chamfer_mm: 0.4, ..SHARP };
    let shapes = [relieved, chamfered];
    let mirrored = gears.clone().exchanged();
    let mirrored_teeth = crate::wheel::teeth(&mirrored, [10.0, 10.0]);
    let positions: Vec<f64> = (0..500).map(|n| -0.4 + 0.005 * f64::from(n)).collect();
    let from_end = positions.iter().rev().map(|position| teeth.path.from_end(*position)).collect::<Vec<_>>();
    let states = |gears: &Gears, teeth: &Teeth, shapes, positions: &[f64]| {
        let pairs = Pairs::new(teeth, &[], gears);
        PairTables::new(&pairs, shapes, Contact::Unilateral).tabulate(&SOUND, positions, 0.005)
    };
    let there = states(&gears, &teeth, shapes, &positions);
    let back = states(&mirrored, &mirrored_teeth, [chamfered, relieved], &from_end);
    for (own, other) in there.iter().zip(back.iter().rev()) {
        assert!((own.stiffness_n_per_m / other.stiffness_n_per_m - 1.0).abs() < 1e-9);
        assert!((own.separation_m - other.separation_m).abs() < 1e-13);
    }
}

#[test]
fn a_planet_s_mesh_carries_its_load_at_rest() {
    let (mut gears, teeth) = planet_in_ring();
    // As in the independent simulator.
    gears.foundation.rotation = crate::wheel::BodyRotation::Tooth;
    let mesh = |contact: Contact, shape: TipShape, points: usize| {
        let pairs = Pairs::new(&teeth, &[], &gears);
        let parameters = MeshParameters {
            contact,
            turning: Turning { pitches_per_revolution: 31.0, first_pitch: 0.0 },
            damping_ratio: 0.1,
            mesh_mass_kg: 1.0,
            backlash_m: 1e-4,
            static_force_n: 2000.0,
            closer_m: 0.0,
            wobble: None,
            face: FaceForm::Spur,
            tilts: false,
            face_width_m: 0.0381,
            friction: Some(Friction {
                coefficient: 0.05,
                pitch_point: teeth.pitch_point(),
                base_pitch_m: teeth.path.base_pitch_mm * 1e-3,
            }),
        };
        let sequence = PairSequence::new(31, 81, &[]).unwrap();
        Mesh::new(&[pairs], [shape; 2], sequence, NonZeroUsize::new(points).unwrap(), parameters)
    };
    let ideal = mesh(Contact::Bilateral, SHARP, 400);
    // The mean of the independent simulator's, of steel with 206 GPa.
    assert!((ideal.mean_stiffness_n_per_m / (1152.7e6 * 210.0 / 206.0) - 1.0).abs() < 2e-3);
    assert!((ideal.contact_ratio - 1.939677).abs() < 5e-7);

    // Corners let a pair take up its load without a jump: the finer the points, the smaller the steps of the deflection.
    let largest_step = |points: usize| {
        let real = mesh(Contact::Unilateral, TipShape { relief: SHARP.relief, ..SHAPE }, points);
        let at_rest = real.at_rest(2000.0, 31..33);
        for (point, deflection_m) in at_rest.deflection_m.iter().enumerate() {
            let carried: f64 = at_rest.pair_force_n.iter().map(|pair| pair[point]).sum();
            assert!((carried / 2000.0 - 1.0).abs() < 1e-9, "{carried}");
            assert!((1e-6..4e-6).contains(deflection_m), "{deflection_m}");
        }
        let steps = at_rest.deflection_m.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        steps.fold(0.0, f64::max)
    };
    let [coarse, fine] = [400, 1600].map(largest_step);
    println!("steps of {coarse:.2e} and {fine:.2e} m");
    assert!(fine < 0.3 * coarse, "{coarse} {fine}");
}
