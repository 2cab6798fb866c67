//! Faults of vanishing size are no faults, and how fast they vanish.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::panic)]

use std::num::NonZeroUsize;
use std::sync::LazyLock;

use crate::physics::*;
use meshtone::scenario::*;
use meshtone::simulate;

// So many samples that the smallest damage spans several.
const SAMPLING_RATE_HZ: f64 = 8e5;

fn scenario(damage: Option<Damage>) -> Scenario {
    sampled_scenario(damage, SAMPLING_RATE_HZ)
}

fn sampled_scenario(damage: Option<Damage>, sampling_rate_hz: f64) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        pinion_teeth: 20,
        gear_teeth: 40,
        pinion_speed_hz: 30.0,
        brake_torque_nm: 100.0,
        ..GearPair::example()
    });
    scenario.model = Model::Linear;
    // A chip within the chamfer would be none.
    scenario.wheels.iter_mut().for_each(|wheel| wheel.tip_chamfer_mm = Some(0.0));
    (scenario.solver.sampling_rate_hz, scenario.solver.settle_fraction) = (sampling_rate_hz, 0.2);
    scenario.faults = damage.map(Fault::on_first_gear_tooth).into_iter().collect();
    scenario
}

/// (g) The vertical acceleration of the pair without a fault.
fn healthy() -> &'static [f64] {
    static HEALTHY: LazyLock<Vec<f64>> =
        LazyLock::new(|| simulate(scenario(None)).unwrap().channels["vertical_g"].to_vec());
    &HEALTHY
}

/// (mean relative change of the pair's stiffness, mean of the flanks' separation in m, rms of the change of the vertical acceleration
/// over its rms)
fn effect(healthy: &[f64], damage: Damage) -> [f64; 3] {
    let simulation = simulate(scenario(Some(damage))).unwrap();
    // On a grid of its own, finer than the time loop's.
    let mesh = &simulation.stages.meshes_at(NonZeroUsize::new(5_000).unwrap()).unwrap()[0];
    let [sound, damaged] = sound_and_damaged(mesh);
    let on_path =
        || damaged.states.iter().zip(&sound.states).filter(|(_, sound)| sound.stiffness_n_per_m > 0.0);
    let change: Vec<f64> = on_path()
        .map(|(damaged, sound)| deviation(damaged.stiffness_n_per_m, sound.stiffness_n_per_m).abs())
        .collect();
    let separation_m: Vec<f64> = on_path().map(|(damaged, _)| damaged.separation_m).collect();
    let signal = &simulation.channels["vertical_g"];
    let difference: Vec<f64> = signal.iter().zip(healthy).map(|(f, h)| f - h).collect();
    [mean(&change), mean(&separation_m), rms(&difference) / rms(healthy)]
}

/// What is left at 1, 1/2, …, 1/32 of a fault's size.
struct Vanishing {
    stiffness: Vec<f64>,
    separation: Vec<f64>,
    acceleration: Vec<f64>,
}

const SIZES: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];

impl Vanishing {
    fn of(name: &str, damage: impl Fn(f64) -> Damage) -> Self {
        let effects: Vec<[f64; 3]> = SIZES.iter().map(|&size| effect(healthy(), damage(size))).collect();
        let column = |k: usize| effects.iter().map(|effect| effect[k]).collect::<Vec<f64>>();
        let vanishing = Self { stiffness: column(0), separation: column(1), acceleration: column(2) };
        println!(
            "{name}: stiffness {:.1e} to {:.1e}, order {:.2}; acceleration {:.1e} to {:.1e}, order {:.2}",
            vanishing.stiffness[0],
            vanishing.stiffness[5],
            order(&vanishing.stiffness),
            vanishing.acceleration[0],
            vanishing.acceleration[5],
            order(&vanishing.acceleration)
        );
        vanishing
    }
}

/// Mean order over the last three halvings.
fn order(effects: &[f64]) -> f64 {
    (effects[2] / effects[5]).log2() / 3.0
}

fn chip(height_mm: f64, width_mm: f64) -> Damage {
    Damage::ToothBreakage(ToothBreakage {
        chip_height_mm: height_mm,
        chip_width_mm: width_mm,
        tip_loss_mm: 0.0,
    })
}

fn pit(length: f64, depth: f64) -> PitCircle {
    PitCircle::Fractions { start: 0.3, end: 0.3 + length, depth }
}

fn partial(width_mm: f64, pit: PitCircle) -> Damage {
    Damage::PartialFace(PartialFace { width_mm, pit })
}

// A crack's sections lose in proportion to its depth, along a piece of the tooth that grows with the depth's root: the involute's
// foot is parallel to the tooth's centre line.
#[test]
fn a_vanishing_crack_is_no_crack() {
    let crack = |depth_mm: f64, length_mm| Damage::from(RootCrack { depth_mm, angle_deg: 45.0, length_mm });
    let depth = Vanishing::of("crack, depth", |s| crack(s, None));
    assert!((order(&depth.stiffness) - 1.5).abs() < 0.1 && (order(&depth.acceleration) - 1.5).abs() < 0.1);
    let length = Vanishing::of("crack, length", |s| crack(2.0, Some(15.0 * s)));
    assert!((order(&length.stiffness) - 1.0).abs() < 0.1 && (order(&length.acceleration) - 1.0).abs() < 0.1);
}

// The mean change is the missing part of the face: of first order in a chip's width, and in its height too where that
// shrinks with it, hence 2. Its acceleration follows: that of a force of first order that lasts for a time of first has an rms of
// order 3/2, and less while it lasts longer than the mesh rings.
#[test]
fn a_vanishing_chip_is_no_chip() {
    let width = Vanishing::of("chip, width", |s| chip(5.0, 10.0 * s));
    assert!((order(&width.stiffness) - 1.0).abs() < 0.05 && (order(&width.acceleration) - 1.0).abs() < 0.05);
    let both = Vanishing::of("chip, height and width", |s| chip(5.0 * s, 10.0 * s));
    assert!((order(&both.stiffness) - 2.0).abs() < 0.1);
    assert!((1.0..1.5).contains(&order(&both.acceleration)));
}

#[test]
fn a_vanishing_partial_pit_is_no_pit() {
    let width = Vanishing::of("partial pit, width", |s| partial(2.5 * s, pit(0.5, 0.5)));
    assert!((order(&width.stiffness) - 1.0).abs() < 0.05 && (order(&width.acceleration) - 1.0).abs() < 0.05);
    // The step in width at the pit's ends stays: it rings the mesh until the pit has passed much faster than the ring.
    let length = Vanishing::of("partial pit, length", |s| partial(5.0, pit(0.5 * s, 0.5)));
    assert!((order(&length.stiffness) - 1.0).abs() < 0.05);
    let signal = |damage| simulate(sampled_scenario(damage, 1.6e6)).unwrap().channels["vertical_g"].to_vec();
    let healthy = signal(None);
    let short = [32.0, 64.0, 128.0, 256.0].map(|shorter| {
        let damaged = signal(Some(partial(5.0, pit(0.5 / shorter, 0.5))));
        let difference: Vec<f64> = damaged.iter().zip(&healthy).map(|(f, h)| f - h).collect();
        rms(&difference) / rms(&healthy)
    });
    let order = (short[0] / short[3]).log2() / 3.0;
    println!("partial pit, length from 1/64 to 1/512 of the flank: {short:.4?}, order {order:.2}");
    assert!((order - 1.0).abs() < 0.15);
}

// A pit over part of the face, however shallow, carries no load: its depth only weakens the section. So depth does not lead
// to the healthy tooth; the limit is a face that is narrower by the pit. The circle of a pit over the whole face becomes its chord: a
// flank that is ground along it.
#[test]
fn a_shallow_pit_still_carries_nothing() {
    let depth = Vanishing::of("partial pit, depth", |s| partial(5.0, pit(0.5, 0.5 * s)));
    assert!(depth.stiffness[5] > 0.95 * depth.stiffness[0] && depth.stiffness[5] < depth.stiffness[0]);
    let shallow = effect(healthy(), ThroughFace { pit: pit(0.5, 1e-3) }.into());
    let line = DestructionLine::End(0.8);
    let chord = ToothDestruction { start: 0.3, line, offset_mm: 0.0, noise_mm: 0.0 };
    assert_close("shallow pit and its chord", 0.05, shallow.into_iter().zip(effect(healthy(), chord.into())));
}

// The flanks' sagitta over the pit is of second order, and lasts for a length of first: 3. The pair is loaded at the pit's edges, off
// by as much as it is long: its stiffness changes by first order over a length of first, 2. The force of the sagitta, of second order
// for a time of first, accelerates with an rms of order 2 + 1/2; that of the stiffness with 1 + 1/2, which outlasts it. With these sizes
// the order is on the way from one to the other: 2.2, also at four times the rate.
#[test]
fn a_vanishing_through_pit_is_no_pit() {
    let through = |s: f64| Damage::ThroughFace(ThroughFace { pit: pit(0.125 * s, 0.5) });
    let length = Vanishing::of("through pit, length", through);
    assert!((order(&length.stiffness) - 2.0).abs() < 0.3 && (order(&length.separation) - 3.0).abs() < 0.1);
    assert!((order(&length.acceleration) - 2.2).abs() < 0.1);
}

// The same of a line between two points of the flank.
#[test]
fn a_vanishing_destruction_is_no_destruction() {
    let destruction = |s: f64| {
        let line = DestructionLine::End(0.2 + 0.175 * s);
        Damage::ToothDestruction(ToothDestruction { start: 0.2, line, offset_mm: 0.0, noise_mm: 0.0 })
    };
    let length = Vanishing::of("destruction, length", destruction);
    assert!((order(&length.stiffness) - 2.0).abs() < 0.1 && (order(&length.separation) - 3.0).abs() < 0.1);
    assert!(length.acceleration[5] < 2e-3 * length.acceleration[0]);
}

// A missing tooth is the other end: its pair carries nothing, and so does one whose whole tip is lost.
#[test]
fn a_missing_tooth_carries_nothing() {
    let carries = |damage: Damage| {
        let stages = meshtone::stages(scenario(Some(damage))).unwrap();
        sound_and_damaged(mesh(&stages))[1].states.iter().any(|state| state.stiffness_n_per_m > 0.0)
    };
    assert!(!carries(MissingTooth.into()));
    let lost = ToothBreakage { chip_height_mm: 1.0, chip_width_mm: 1.0, tip_loss_mm: 6.0 };
    assert!(!carries(lost.into()));
    assert!(carries(chip(5.0, 10.0)));
}
