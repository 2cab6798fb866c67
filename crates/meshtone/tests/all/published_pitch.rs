//! Points of a pitch as the published code counts them.
#![allow(clippy::unwrap_used)]

use meshtone::scenario::{GearPair, Model, Scenario};
use meshtone::{stage_trace, stages};

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
        let cycle = &stages.cycle;
        assert_eq!(cycle.fine_points_per_pitch, 50 * cycle.points_per_pitch + usize::from(longer));
        let points = stage_trace(&stages).get("mesh_stiffness_len").unwrap().values[0] as usize;
        assert_eq!(points, length.unwrap_or(cycle.points_per_pitch * gear_teeth as usize));
        assert_eq!(points, stages.mesh.stiffness_n_per_mm().len());
        // The other models' cycle is whole.
        scenario.model = Model::Linear;
        let cycle = meshtone::stages(&scenario).unwrap().cycle;
        assert_eq!(cycle.fine_points_per_pitch, 50 * cycle.points_per_pitch);
    }
}
