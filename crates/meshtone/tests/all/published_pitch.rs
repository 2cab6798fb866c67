//! Pitches and cycles as the published code counts them.
#![allow(clippy::unwrap_used, clippy::panic)]

use meshtone::published::Published;
use meshtone::scenario::*;
use meshtone::{Equations, Stages, stage_trace, stages};

// A pitch has ⌈(1/z_p)/d_f⌉ fine points in floating point: one more than a whole number where the quotient comes out above it.
// The cycle is then longer by z_g fine points.
#[test]
fn some_pitches_have_a_point_more() {
    for (module_mm, pinion_teeth, gear_teeth, longer, length) in
        [(2.0, 20, 45, true, Some(45_361)), (2.0, 25, 30, true, Some(24_121)), (3.0, 17, 38, false, None)]
    {
        let mut scenario =
            Scenario::new(GearPair { module_mm, pinion_teeth, gear_teeth, ..GearPair::example() });
        scenario.model = Model::Published;
        let stages = stages(&scenario).unwrap();
        let cycle = &stages.pairs[0].cycle;
        assert_eq!(cycle.fine_points_per_pitch, 50 * cycle.points_per_pitch + usize::from(longer));
        let points = stage_trace(&stages).get("mesh_stiffness_len").unwrap().values[0] as usize;
        assert_eq!(points, length.unwrap_or(cycle.points_per_pitch * gear_teeth as usize));
        assert_eq!(points, stages.mesh_curves()[0].stiffness_n_per_mm.len());
        // The other models' cycle is whole.
        scenario.model = Model::Linear;
        let cycle = meshtone::stages(&scenario).unwrap().pairs[0].cycle;
        assert_eq!(cycle.fine_points_per_pitch, 50 * cycle.points_per_pitch);
    }
}

/// A pair whose gear has one damaged tooth, by the published model.
fn published(
    [pinion_teeth, gear_teeth]: [u32; 2],
    pinion_speed_hz: f64,
    damage: impl Into<Damage>,
) -> Scenario {
    let mut scenario = Scenario::new(GearPair {
        module_mm: 3.0,
        pinion_teeth,
        gear_teeth,
        face_width_mm: 15.0,
        pinion_speed_hz,
        brake_torque_nm: 10.0,
    });
    scenario.model = Model::Published;
    scenario.with_faults(vec![Fault::on_first_gear_tooth(damage)])
}

fn own_stages(stages: &Stages) -> &Published {
    let Equations::Published(published) = &stages.equations else { panic!("another model") };
    published
}

fn through(start: f64, end: f64) -> ThroughFace {
    ThroughFace { pit: PitCircle::Fractions { start, end, depth: 0.5 } }
}

// The remainder of a cycle that is longer than a revolution of the gear is 0 at its last point, which so is the last before the
// fault's end. Numbers of the published code.
#[test]
fn a_longer_cycle_is_turned_as_a_whole() {
    for (teeth, start, end, first, last) in [
        ([25, 30], 0.35, 0.65, 460, 24_120),
        ([20, 31], 0.3, 0.7, 495, 31_713),
        ([17, 38], 0.2, 0.8, 380, 1516),
    ] {
        let stages = stages(published(teeth, 40.0, through(start, end))).unwrap();
        let own = own_stages(&stages);
        let nominal = own.mesh.load.nominal.pressure_angle_rad;
        let turned: Vec<usize> = (0..stages.pairs[0].cycle.points_per_gear_revolution)
            .filter(|&point| own.mesh.load.state(point).pressure_angle_rad != nominal)
            .collect();
        // The first and the last angle are the nominal one: the mate has not turned yet, and no more.
        assert_eq!((turned[0] - 1, turned[turned.len() - 1] + 1), (first, last), "{teeth:?}");
    }
}

// The displacement of a through fault has the gear's exact revolution for modulus, not the longer cycle. The fault begins at 0.0228666
// revolutions: the first sample behind it, of 7 650 a revolution, is 175 in every revolution of the gear.
#[test]
fn a_displacement_does_not_know_of_the_longer_cycle() {
    let mut scenario = published([25, 30], 40.0, through(0.35, 0.65));
    scenario.solver.sampling_rate_hz = 40.0 * 7_650.0 - 6.5 * 40.0 * 150.0;
    let stages = stages(&scenario).unwrap();
    assert_eq!(stages.time.samples_per_pinion_revolution, 7_650);
    let forcing = own_stages(&stages).forcing().take(20 * 9_180);
    let forces: Vec<f64> = forcing.map(|forcing| forcing.error_force_n).collect();
    for revolution in forces.chunks(9_180) {
        assert_eq!(revolution.iter().position(|force| *force != 0.0), Some(175));
    }
}

// The grid of the cycle follows the nominal sampling rate, not the higher actual one.
#[test]
fn the_fine_grid_follows_the_nominal_rate() {
    let stages = stages(published([40, 41], 100.0, MissingTooth)).unwrap();
    assert!((1.0 / stages.pairs[0].cycle.fine_step_rev - 1_066_000.0).abs() < 1e-6);
    assert!(stages.time.sampling_rate_hz > 1_100_000.0);
}

// A line that starts below the contact part grinds it from its start.
#[test]
fn a_destruction_begins_in_contact() {
    let line = DestructionLine::End(0.9);
    let destruction = ToothDestruction { start: -0.1, line, offset_mm: 0.01, noise_mm: 0.0 };
    let stages = stages(published([18, 35], 45.0, destruction)).unwrap();
    let first = stage_trace(&stages).get("fault_indices").unwrap().values[0];
    // Indices count from 1.
    assert_eq!(first as usize, stages.pairs[0].teeth.contact.initial_contact_index + 1);
}

// Every kind of damage that the published code knows, with teeth whose cycle is longer, shorter or whole, runs.
#[test]
fn any_teeth_can_be_simulated() {
    for teeth in [[20, 31], [25, 30], [40, 41], [19, 19], [20, 20]] {
        let pit = PitCircle::Fractions { start: 0.3, end: 0.7, depth: 0.4 };
        let line = DestructionLine::End(0.9);
        let damages: [Damage; 5] = [
            MissingTooth.into(),
            ToothBreakage { chip_height_mm: 4.0, chip_width_mm: 9.0, tip_loss_mm: 1.0 }.into(),
            PartialFace { width_mm: 4.0, pit }.into(),
            ThroughFace { pit }.into(),
            ToothDestruction { start: 0.2, line, offset_mm: 0.0, noise_mm: 0.0 }.into(),
        ];
        for damage in damages {
            let mut scenario = published(teeth, 30.0, damage);
            scenario.wheels.iter_mut().for_each(|wheel| wheel.din_grade = 7);
            scenario.solver.sampling_rate_hz = 1e5;
            // About ten cycles, which are revolutions of the gear.
            scenario.solver.discard_and_keep(0.1, 0.5);
            let simulation = meshtone::simulate(&scenario).unwrap();
            let force_n = &simulation.channels["mesh_force_n"];
            assert!(
                force_n.iter().all(|force| force.is_finite()) && force_n.iter().any(|force| *force > 0.0)
            );
        }
    }
}
