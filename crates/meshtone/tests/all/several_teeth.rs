//! Where and how often damage is met: pinion and gear, neighbours, and two damaged teeth that meet.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use crate::physics::*;
use meshtone::scenario::*;
use meshtone::{Simulation, simulate, stages};

/// Pitches until the same two teeth meet again.
const CYCLE: usize = 17 * 38;

/// Ideal wheels of 17 and 38 teeth.
fn pair(model: Model, faults: Vec<Fault>) -> Scenario {
    let mut scenario = Scenario::new(GearPair { brake_torque_nm: 60.0, ..GearPair::example() });
    scenario.model = model;
    scenario.meshes[0].points_per_tooth = 2_000;
    scenario.solver.sampling_rate_hz = 1e5;
    scenario.solver.settle_tolerance = 1e-9;
    scenario.faults = faults;
    scenario
}

fn signal(model: Model, faults: Vec<Fault>) -> (Vec<f64>, usize) {
    let Simulation { stages, channels, .. } = simulate(pair(model, faults)).unwrap();
    let per_pitch = stages.time.samples_per_pinion_revolution / 17;
    assert_eq!(channels["vertical_g"].len(), CYCLE * per_pitch);
    // From the first pair's start of contact on.
    let mut signal = channels["vertical_g"].to_vec();
    let kept = signal.len();
    signal.rotate_right(stages.time.first_kept_sample % kept);
    (signal, per_pitch)
}

fn crack(depth_mm: f64) -> RootCrack {
    RootCrack { depth_mm, angle_deg: 45.0, length_mm: None }
}

/// Largest difference of a signal from itself, turned, over its largest value.
fn off(signal: &[f64], turn: usize) -> f64 {
    let turned = signal.iter().cycle().skip(turn);
    largest(turned.zip(signal).map(|(turned, value)| turned - value)) / largest(signal.iter().copied())
}

// Under both models: the pinion's damage comes every 17 pitches and not every 38, the gear's the other way round.
#[test]
fn damage_repeats_at_the_order_of_its_own_shaft() {
    for model in [Model::Linear, Model::Contact] {
        for (wheel, own, other) in [(WheelName::Pinion, 17, 38), (WheelName::Gear, 38, 17)] {
            let (signal, per_pitch) = signal(model, vec![Fault::new(wheel, 4, crack(3.5))]);
            let [same, different] = [own, other].map(|turn| off(&signal, turn * per_pitch));
            println!(
                "{}, {}: {same:.1e} after {own} pitches, {different:.2} after {other}",
                model.name(),
                wheel.name()
            );
            assert!(same < 1e-4 && different > 0.02, "{}, {}", model.name(), wheel.name());
        }
    }
}

/// The pitch of the cycle from which on two teeth, by their indices, are in contact together: in one pair, or each in one of two
/// pairs beside one another.
fn meetings(pinion: usize, gear: usize) -> [usize; 3] {
    let at = |pinion: usize, gear: usize| {
        (0..CYCLE).find(|pitch| (pitch % 17, pitch % 38) == (pinion, gear)).unwrap()
    };
    // The pair of the damaged pinion tooth, the damaged gear tooth in the same one, in the one before, in the one after.
    [at(pinion, gear), at(pinion, gear + 1) - 1, at(pinion, gear - 1)]
}

// What two damaged teeth do together beyond what each does alone: it is there once in 646 pitches for each way of being in
// contact together, and nowhere else. In the mesh's stiffness it is the one pair that has both; in the signal also the two
// pairs beside one another, where neither can take the load from the other.
#[test]
fn two_damaged_teeth_that_meet_show_at_the_hunting_tooth_rate() {
    let one = || Fault::new(WheelName::Pinion, 3, crack(3.0));
    let two = || Fault::new(WheelName::Gear, 12, crack(3.5));
    let meetings = meetings(2, 11);
    assert_eq!(meetings, [87, 239, 580]);
    let all = || [vec![], vec![one()], vec![two()], vec![one(), two()]];
    let excess = |signals: &[Vec<f64>]| -> Vec<f64> {
        let of = |i: usize| signals[3][i] - signals[1][i] - signals[2][i] + signals[0][i];
        (0..signals[0].len()).map(of).collect()
    };

    let stiffness =
        all().map(|faults| mesh(&stages(pair(Model::Linear, faults)).unwrap()).stiffness_n_per_mm(0..CYCLE));
    let stiffness_excess = excess(&stiffness);
    let per_pitch = stiffness_excess.len() / CYCLE;
    let (mut here, mut elsewhere) = (0.0_f64, 0.0_f64);
    for (point, value) in stiffness_excess.iter().enumerate() {
        let is_here = (meetings[0]..=meetings[0] + 1).contains(&(point / per_pitch));
        let largest = if is_here { &mut here } else { &mut elsewhere };
        *largest = largest.max(value.abs());
    }
    println!("stiffness: {here:.3} N/mm where they meet, {elsewhere:.1e} elsewhere");
    assert!(here > 100.0 && elsewhere < 1e-8, "{here} and {elsewhere:e}");

    for (model, least) in [(Model::Linear, 0.99), (Model::Contact, 0.9)] {
        let signals = all().map(|faults| signal(model, faults));
        let per_pitch = signals[0].1;
        let excess = excess(&signals.map(|(signal, _)| signal));
        let energy = |pitch: usize| -> f64 {
            (pitch * per_pitch..(pitch + 1) * per_pitch).map(|sample| excess[sample].powi(2)).sum()
        };
        let whole: f64 = (0..CYCLE).map(energy).sum();
        let shares = meetings.map(|meeting| (meeting..meeting + 8).map(energy).sum::<f64>() / whole);
        let together: f64 = shares.iter().sum();
        println!("{}: {shares:.3?} of the excess within 8 of 646 pitches from each meeting", model.name());
        assert!(together > least, "{}: {together}", model.name());
        // It repeats at neither shaft's order.
        assert!(off(&excess, 17 * per_pitch) > 0.5 && off(&excess, 38 * per_pitch) > 0.5);
    }
}

// Wheels whose tooth counts have a common divisor: two given teeth may never meet.
#[test]
fn teeth_that_never_meet_have_no_class_together() {
    let classes = |gear_tooth: u32| {
        let mut scenario = pair(
            Model::Linear,
            vec![
                Fault::new(WheelName::Pinion, 1, crack(2.0)),
                Fault::new(WheelName::Gear, gear_tooth, crack(2.0)),
            ],
        );
        (scenario.wheels[0].teeth, scenario.wheels[1].teeth) = (18, 36);
        let stages = stages(&scenario).unwrap();
        let kinds = mesh(&stages).sequence.classes().to_vec();
        kinds.iter().filter(|kind| kind.pinion.is_some() && kind.gear.is_some()).count()
    };
    assert_eq!([classes(1), classes(19), classes(2)], [1, 1, 0]);
}

// Two neighbours are in contact at once for a part of a pitch: there the mesh lacks what either lacks.
#[test]
fn neighbours_that_are_damaged_bear_together() {
    let of = |teeth: &[u32]| {
        let faults = if teeth.is_empty() {
            Vec::new()
        } else {
            vec![Fault::new(WheelName::Gear, teeth.to_vec(), crack(3.0))]
        };
        mesh(&stages(pair(Model::Linear, faults)).unwrap()).stiffness_n_per_mm(0..38)
    };
    let (sound, first, second, both) = (of(&[]), of(&[6]), of(&[7]), of(&[6, 7]));
    let mut together = 0;
    for i in 0..sound.len() {
        let [of_first, of_second, of_both] = [&first, &second, &both].map(|mesh| sound[i] - mesh[i]);
        assert!((of_both - of_first - of_second).abs() < 1e-9 * sound[i], "point {i}");
        together += usize::from(of_first > 1.0 && of_second > 1.0);
    }
    let share = together as f64 * 38.0 / sound.len() as f64;
    // As long as two pairs are on their path between the chamfers.
    let expected = mesh(&stages(pair(Model::Linear, Vec::new())).unwrap()).contact_ratio - 1.0;
    println!("together for {share:.3} pitches of {expected:.3}");
    assert!((share - expected).abs() < 0.03, "{share}");
    // Under `contact` too a tooth whose neighbour is damaged is softer where both bear.
    let contact =
        |teeth: Vec<u32>| signal(Model::Contact, vec![Fault::new(WheelName::Gear, teeth, crack(3.5))]);
    let ((one, per_pitch), (two, _)) = (contact(vec![6]), contact(vec![6, 7]));
    assert!(off(&two, 38 * per_pitch) < 1e-4 && largest(one.iter().zip(&two).map(|(a, b)| a - b)) > 1e-2);
}

/// Each kind with one of its sizes, of which 0 is none, and the sizes that are compared.
struct Sized {
    damage: fn(f64) -> Damage,
    /// As good as none.
    nothing: f64,
    sizes: [f64; 4],
}

fn pit(start: f64, end: f64, depth: f64) -> PitCircle {
    PitCircle::Fractions { start, end, depth }
}

/// Kinds whose pair gets softer as they grow. A pit over the whole face, a destroyed flank and wear are none: the pair touches at the
/// edge of what they take, where it may be stiffer.
fn growing() -> Vec<Sized> {
    vec![
        Sized {
            damage: |size| {
                ToothBreakage { chip_height_mm: 5.0, chip_width_mm: size, tip_loss_mm: 0.0 }.into()
            },
            nothing: 1e-9,
            sizes: [1.0, 4.0, 8.0, 14.0],
        },
        Sized { damage: |size| crack(size).into(), nothing: 1e-9, sizes: [0.3, 0.8, 1.6, 2.4] },
        Sized {
            damage: |size| PartialFace { width_mm: size, pit: pit(0.2, 0.8, 0.4) }.into(),
            nothing: 1e-9,
            sizes: [0.5, 2.0, 6.0, 12.0],
        },
    ]
}

// On any wheel of several pairs, on both of their wheels.
#[test]
fn pairs_get_softer_as_damage_grows_from_nothing() {
    for (z_pinion, z_gear, module_mm) in [(17, 38, 3.0), (25, 30, 2.5), (45, 80, 3.0)] {
        for wheel in WheelName::BOTH {
            for Sized { damage, nothing, sizes } in growing() {
                let stiffness = |damage: Option<Damage>| -> Vec<f64> {
                    let mut scenario = pair(
                        Model::Linear,
                        damage.map(|damage| Fault::new(wheel, 1, damage)).into_iter().collect(),
                    );
                    scenario.meshes[0].module_mm = module_mm;
                    (scenario.wheels[0].teeth, scenario.wheels[1].teeth) = (z_pinion, z_gear);
                    let stages = stages(&scenario).unwrap();
                    // A class of damaged pairs, or the sound one.
                    mesh(&stages).classes.last().map(stiffness_n_per_m).unwrap()
                };
                let name = format!("{} of the {} of {z_pinion}/{z_gear}", damage(0.5).kind(), wheel.name());
                let sound = stiffness(None);
                let mut before = stiffness(Some(damage(nothing)));
                let none = largest(before.iter().zip(&sound).map(|(none, sound)| deviation(*none, *sound)));
                assert!(none < 1e-7, "{name}: {none:e} without a size");
                for size in sizes {
                    let here = stiffness(Some(damage(size)));
                    let stiffer = here.iter().zip(&before).map(|(here, before)| deviation(*here, *before));
                    // Where nothing touches the ratio is no number.
                    let most =
                        stiffer.filter(|stiffer| stiffer.is_finite()).fold(f64::NEG_INFINITY, f64::max);
                    assert!(most < 1e-9, "{name}, size {size}: {most:e} stiffer");
                    assert!(
                        here.iter().zip(&sound).any(|(here, sound)| here < &(sound * (1.0 - 1e-6))),
                        "{name}, {size}"
                    );
                    before = here;
                }
            }
        }
    }
}
