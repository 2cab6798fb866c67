//! The root crack: its losses of stiffness against a table, its limits, and what is refused.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::damage::{DamagedTooth, Section, damaged_teeth};
use meshtone::mesh::{PairKind, Pairs};
use meshtone::scenario::*;
use meshtone::wheel::Teeth;
use meshtone::{simulate, stages};

const WIDTH_MM: f64 = 15.0;
const DAMAGED_GEAR: PairKind = PairKind { pinion: None, gear: Some(0), pairs_per_cycle: 1 };

fn crack(depth_mm: f64, length_mm: Option<f64>) -> RootCrack {
    RootCrack { depth_mm, angle_deg: 45.0, length_mm }
}

/// The example's wheels, with bores of 10 mm radius.
fn wheels() -> (Gears, Teeth) {
    let gears = example_gears();
    let teeth = linear_teeth(&gears, 20.0);
    (gears, teeth)
}

fn cracked(teeth: &Teeth, crack: RootCrack) -> DamagedTooth {
    damaged_teeth(&[Fault::on_first_gear_tooth(crack)], teeth, 1).unwrap().remove(0)
}

/// (-) Loss of stiffness of the pair of a gear tooth with given damages at positions of its path.
fn losses<const N: usize>(gears: &Gears, teeth: &Teeth, faults: &[Fault], positions: [f64; N]) -> [f64; N] {
    let damaged = damaged_teeth(faults, teeth, 1).unwrap();
    let pairs = Pairs::new(teeth, &damaged, gears);
    positions.map(|at| {
        1.0 - pairs.at(&DAMAGED_GEAR, at).stiffness_n_per_mm / pairs.at(&SOUND_PAIR, at).stiffness_n_per_mm
    })
}

/// (base pitches) Where the gear's tip starts the path, the pair is first alone, the pitch point is met, and the path ends.
fn notable_positions(teeth: &Teeth) -> [f64; 4] {
    let path = &teeth.path;
    let gear = teeth.wheel(WheelName::Gear);
    let pitch_point = path.position(WheelName::Gear, gear.curvature_mm(gear.pitch_radius_mm));
    [0.0, path.contact_ratio - 1.0, pitch_point, path.contact_ratio]
}

// By another program after Chen and Shao (2011). Ours are larger by 1.2 % of the loss in the mean and by 2.0 % at most, much
// alike for all depths: by 0.9 % and 0.5 % where the tip of the gear and of the pinion bears, by 1.6 % and 1.9 % between.
#[test]
fn losses_of_stiffness_are_those_of_the_table() {
    let (mut gears, teeth) = wheels();
    gears.foundation = with_rotation_in_teeth();
    let start = cracked(&teeth, crack(1.0, None)).crack.unwrap();
    assert!(
        (start.start_x_mm - 53.478).abs() < 1e-3 && (start.start_y_mm - 3.0109).abs() < 1e-3,
        "{start:?}"
    );
    let table = [
        (0.5, [1.69, 0.86, 0.61, 0.23]),
        (1.0, [4.32, 2.04, 1.49, 0.47]),
        (2.0, [12.33, 5.56, 3.87, 1.01]),
        (3.0, [24.51, 10.79, 7.32, 1.77]),
    ];
    let positions = notable_positions(&teeth);
    for (depth_mm, percent) in table {
        let faults = [Fault::on_first_gear_tooth(crack(depth_mm, None))];
        let losses = losses(&gears, &teeth, &faults, positions).map(|loss| loss * 100.0);
        println!("{depth_mm} mm: {losses:.4?} for {percent:?}");
        for (loss, expected) in losses.into_iter().zip(percent) {
            assert!((loss / expected - 1.0).abs() <= 0.02, "{depth_mm} mm: {loss} for {expected}");
        }
    }
}

#[test]
fn a_crack_without_depth_is_none() {
    for teeth in [(17, 38), (9, 12), (45, 80)] {
        let gears = Gears::new(3.0, teeth.0, teeth.1, WIDTH_MM);
        let teeth = linear_teeth(&gears, 20.0);
        for length_mm in [None, Some(9.0), Some(WIDTH_MM)] {
            for depth_mm in [0.0, 1e-13] {
                let faults = [Fault::on_first_gear_tooth(crack(depth_mm, length_mm))];
                let losses = losses(&gears, &teeth, &faults, notable_positions(&teeth));
                assert!(largest(losses) < 1e-12, "{depth_mm} mm over {length_mm:?}: {losses:?}");
            }
        }
    }
}

#[test]
fn stiffness_falls_with_depth_and_length() {
    for (z_pinion, z_gear) in [(17, 38), (25, 60)] {
        let gears = Gears::new(3.0, z_pinion, z_gear, WIDTH_MM);
        let teeth = linear_teeth(&gears, 20.0);
        let ratio = teeth.path.contact_ratio;
        let positions: [f64; 21] = std::array::from_fn(|k| ratio * k as f64 / 20.0);
        let of = |crack: RootCrack| losses(&gears, &teeth, &[Fault::on_first_gear_tooth(crack)], positions);
        let rises = |what: &str, all: Vec<[f64; 21]>| {
            for pair in all.windows(2) {
                let steps = pair[1].iter().zip(&pair[0]).map(|(more, less)| more - less);
                let least = steps.fold(f64::INFINITY, f64::min);
                assert!(least > 0.0, "{z_pinion}/{z_gear}, {what}: {least:e}");
            }
        };
        let depths = [0.0, 0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];
        for length_mm in [None, Some(4.0), Some(WIDTH_MM)] {
            rises("depth", depths.map(|depth_mm| of(crack(depth_mm, length_mm))).to_vec());
        }
        let lengths = [Some(0.5), Some(2.0), Some(5.0), Some(8.0), Some(12.0), Some(WIDTH_MM), None];
        rises("length", lengths.map(|length_mm| of(crack(2.0, length_mm))).to_vec());
        let angles = [20.0, 40.0, 60.0, 75.0, 90.0];
        let at = |angle_deg| of(RootCrack { depth_mm: 1.0, angle_deg, length_mm: None });
        println!("1 mm deep, loss at the start of the path: {:.4?}", angles.map(|angle| at(angle)[0]));
    }
}

/// Area, first moments and second moments about the section's middle, by strips of equal width along the face.
fn moments(half_mm: f64, top_at: impl Fn(f64) -> f64) -> [f64; 6] {
    let strips = 20_000;
    let dz = WIDTH_MM / f64::from(strips);
    let mut sums = [0.0; 6];
    for k in 0..strips {
        let along = dz * (f64::from(k) + 0.5);
        let (z, top) = (along - WIDTH_MM / 2.0, top_at(along));
        let (area, first) = (dz * (top + half_mm), dz * (top * top - half_mm * half_mm) / 2.0);
        let second = dz * (top.powi(3) + half_mm.powi(3)) / 3.0;
        let of_strip = [area, first, area * z, second, area * (z * z + dz * dz / 12.0), first * z];
        sums.iter_mut().zip(of_strip).for_each(|(sum, part)| *sum += part);
    }
    sums
}

/// The same of a section.
fn moments_of(section: &Section) -> [f64; 6] {
    let Section { area_mm2: a, yc_mm: y, zc_mm: z, iy_mm4: iy, iz_mm4: iz, iyz_mm4: iyz, .. } = *section;
    [a, a * y, a * z, iz + a * y * y, iy + a * z * z, iyz + a * y * z]
}

// The depth at the distance s from the side where it is deepest is q √(1 − s/length). Below the crack's start the section's
// rectangles are exact, and what is off is the quadrature's step; further out they stand for a parabola.
#[test]
fn section_of_a_parabolic_crack_by_quadrature() {
    let (_, teeth) = wheels();
    let profile = teeth.profile(WheelName::Gear);
    for (depth_mm, length_mm) in [(3.0, WIDTH_MM), (2.0, 6.0)] {
        let tooth = cracked(&teeth, crack(depth_mm, Some(length_mm)));
        let at = tooth.crack.unwrap();
        let (sin, cos) = at.angle_rad.sin_cos();
        let depth_at = |s: f64| depth_mm * (1.0 - s / length_mm).max(0.0).sqrt();
        let mut largest_off = [[0.0_f64; 6]; 2];
        for i in (0..profile.len()).step_by(500) {
            let (x, y) = (profile.x_mm[i], profile.y_mm[i]);
            let is_outside = x >= at.start_x_mm;
            let top_at = |s: f64| {
                let q = depth_at(s);
                if is_outside {
                    y - (y.min(at.start_y_mm) - (at.start_y_mm - q * sin)).max(0.0)
                } else if x >= at.start_x_mm - q * cos {
                    at.start_y_mm - (at.start_x_mm - x) * at.angle_rad.tan()
                } else {
                    y
                }
            };
            let sound = moments_of(&Section::sound(WIDTH_MM, y));
            let exact = moments(y, top_at);
            let section = moments_of(&Section::damaged(&tooth, profile, WIDTH_MM, i));
            // Where next to nothing is missing, rounding is much of it.
            if exact[0] < 0.99 * sound[0] {
                for (n, largest) in largest_off[usize::from(is_outside)].iter_mut().enumerate() {
                    *largest = largest.max(((section[n] - exact[n]) / (exact[n] - sound[n])).abs());
                }
            }
        }
        println!("{depth_mm} mm over {length_mm} mm: off by {largest_off:.5?} of what is missing");
        let largest_off = largest_off.map(largest);
        assert!(largest_off[0] < 5e-3 && largest_off[1] < 2e-2, "{largest_off:?}");
    }
}

// A crack weakens what another damage has left of the tooth.
#[test]
fn a_broken_tooth_may_be_cracked() {
    let (gears, teeth) = wheels();
    let chip = ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 9.0, tip_loss_mm: 0.0 };
    let pit = PitCircle::Fractions { start: 0.2, end: 0.8, depth: 0.4 };
    let pit = PartialFace { width_mm: 5.0, pit };
    let positions = notable_positions(&teeth);
    for length_mm in [None, Some(8.0)] {
        let cracked = Fault::on_first_gear_tooth(crack(3.0, length_mm));
        let alone = losses(&gears, &teeth, std::slice::from_ref(&cracked), positions);
        for other in [Fault::on_first_gear_tooth(chip), Fault::on_first_gear_tooth(pit)] {
            let of_other = losses(&gears, &teeth, std::slice::from_ref(&other), positions);
            let both = losses(&gears, &teeth, &[other, cracked.clone()], positions);
            // Under a load beside it, the other damage may lie where the crack has left no stress.
            let larger: [f64; 4] = std::array::from_fn(|n| alone[n].max(of_other[n]));
            let is_softer = both.iter().zip(&larger).all(|(both, larger)| *both >= larger - 1e-12);
            assert!(is_softer && both[1] > 1.001 * larger[1], "{both:?}, {alone:?} and {of_other:?}");
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

// It opens under the driving load alone.
#[test]
fn back_flanks_are_as_stiff_as_those_of_sound_teeth() {
    let stiffness = |faults| {
        let stages = stages(scenario(Model::Contact, faults)).unwrap();
        mesh(&stages).law().back_stiffness_n_per_m
    };
    assert_eq!(stiffness(vec![Fault::on_first_gear_tooth(crack(3.0, None))]), stiffness(Vec::new()));
}

// Under a load that keeps the teeth together the same motion follows a while after the start, whichever tooth is cracked; what
// differs is left of the start.
#[test]
fn the_signal_of_teeth_that_part_turns_with_the_cracked_tooth() {
    let signal = |tooth: u32| {
        let fault = Fault::new(WheelName::Gear, tooth, crack(3.0, None));
        let simulation = simulate(scenario(Model::Contact, vec![fault])).unwrap();
        let samples_per_pitch = simulation.stages.time.samples_per_pinion_revolution / 17;
        (simulation.channels["vertical_g"].to_vec(), samples_per_pitch)
    };
    let (first, samples_per_pitch) = signal(1);
    assert_eq!(first.len(), 17 * 38 * samples_per_pitch);
    for tooth in [2, 20] {
        let (turned, _) = signal(tooth);
        let peak = largest(first.iter().copied());
        let off = |turn: usize| {
            let turned = turned.iter().cycle().skip(turn);
            largest(turned.zip(&first).map(|(turned, first)| turned - first)) / peak
        };
        let left = off((tooth as usize - 1) * samples_per_pitch);
        println!("tooth {tooth} under contact: turned, but for {left:.1e}");
        assert!(left < 1e-5 && off(0) > 1e-2, "{left:e}, {:e}", off(0));
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let of = |model, faults: &[RootCrack]| {
        let faults = faults.iter().map(|&crack| Fault::on_first_gear_tooth(crack)).collect();
        let scenario = scenario(model, faults);
        let error = scenario.validate().err().or_else(|| stages(&scenario).err()).unwrap();
        (error.key.clone(), error.to_string())
    };
    let refused = |crack: RootCrack| of(Model::Linear, &[crack]);
    let (key, text) = refused(crack(-1.0, None));
    assert!(key == "fault.depth_mm" && text.contains("0 mm or more"), "{text}");
    let (key, text) = refused(crack(7.0, None));
    assert!(
        key == "fault.depth_mm" && text.contains("must be less than 6.7500 mm, the tooth's height"),
        "{text}"
    );
    let (key, text) = refused(crack(4.3, None));
    assert!(
        key == "fault.depth_mm" && text.contains("must be at most 4.258 mm, where a crack at 45°"),
        "{text}"
    );
    for angle_deg in [0.0, 91.0] {
        let (key, text) = refused(RootCrack { angle_deg, ..crack(1.0, None) });
        assert!(key == "fault.angle_deg" && text.contains("90°"), "{text}");
    }
    let (key, text) = refused(crack(1.0, Some(0.0)));
    assert!(key == "fault.length_mm" && text.contains("more than 0 mm"), "{text}");
    let (key, text) = refused(crack(1.0, Some(15.1)));
    assert!(key == "fault.length_mm" && text.contains("at most 15 mm, the face width"), "{text}");
    let (key, text) = of(Model::Published, &[crack(1.0, None)]);
    assert!(key == "fault.kind" && text.contains("is not supported by the published model"), "{text}");
    let (key, text) = of(Model::Linear, &[crack(1.0, None), crack(2.0, None)]);
    assert!(key == "fault[1].kind" && text.contains("a tooth can have one root crack only"), "{text}");
}
