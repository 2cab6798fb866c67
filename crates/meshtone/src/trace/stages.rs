//! Fields of the stages before the time loop.

use super::Trace;
use crate::fault::{Displacement, FaultDescription, FaultGeometry};
use crate::sampling::FINE_PER_COARSE;
use crate::simulate::Stages;
use crate::tooth::{ToothProfile, Wheel};

/// Every how many points a profile, a flank and a section are given.
const PROFILE_STRIDE: usize = 50;
const FAULT_STRIDE: usize = 25;
/// Every how many fine points a pair's stiffness is given, and coarse points the mesh's.
const PAIR_STRIDE: usize = 40;
const MESH_STRIDE: usize = 4;
/// Coarse points of a through fault's pressure angle.
const ANGLE_POINTS: usize = 6000;
/// Published indices count from 1.
const FIRST_INDEX: usize = 1;

/// Fields of stages 2 to 6.
pub(crate) fn static_stages(trace: &mut Trace, stages: &Stages) {
    wheels(trace, stages);
    let grid = &stages.cycle;
    trace.scalar("sampling_rate_hz", stages.time.sampling_rate_hz);
    trace.scalar("fine_step_rev", grid.fine_step_rev);
    trace.scalar("coarse_step_rev", grid.coarse_step_rev);
    trace.scalar("first_kept_sample", stages.time.first_kept_sample as f64);
    trace.scalar("kept_samples", stages.time.kept_samples() as f64);
    trace.scalar("pinion_revolutions", stages.pinion_revolutions());
    trace.scalar("contact_ratio", stages.teeth.contact.contact_ratio);
    trace.vector("shaft_stiffness_nm_per_rad", stages.system.shaft_stiffness_nm_per_rad);
    stiffness(trace, stages);
    matrices(trace, stages);
    if let Some(fault) = &stages.fault {
        fault_geometry(trace, stages, fault);
    }
}

fn wheels(trace: &mut Trace, stages: &Stages) {
    let teeth = &stages.teeth;
    let wheel =
        |trace: &mut Trace, name: &str, wheel: &Wheel, profile: &ToothProfile, contact_radius: f64| {
            let every = |values: &[f64]| values.iter().copied().step_by(PROFILE_STRIDE).collect::<Vec<_>>();
            let last = profile.len() - 1;
            trace.vector(&format!("{name}_profile_x_mm"), every(&profile.x_mm));
            trace.vector(&format!("{name}_profile_y_mm"), every(&profile.y_mm));
            trace.vector(&format!("{name}_tip_xy_mm"), [profile.x_mm[last], profile.y_mm[last]]);
            trace.vector(
                &format!("{name}_radii_mm"),
                [
                    wheel.pitch_radius_mm,
                    wheel.tip_radius_mm,
                    wheel.root_radius_mm,
                    wheel.base_radius_mm,
                    contact_radius,
                ],
            );
            if let Some(index) = profile.tip_relief_index {
                trace.scalar(&format!("{name}_tip_relief_index"), (index + FIRST_INDEX) as f64);
            }
            trace.scalar(
                &format!("{name}_initial_contact_index"),
                (teeth.contact.initial_contact_index + FIRST_INDEX) as f64,
            );
        };
    let contact = &teeth.contact;
    wheel(trace, "pinion", &teeth.pinion, &teeth.pinion_profile, contact.pinion_initial_radius_mm);
    wheel(trace, "gear", &teeth.gear, &teeth.gear_profile, contact.gear_initial_radius_mm);
    for (name, inertia) in [("pinion", &stages.system.pinion), ("gear", &stages.system.gear)] {
        trace.scalar(&format!("{name}_mass_kg"), inertia.mass_kg);
        trace.scalar(&format!("{name}_transverse_inertia_kgm2"), inertia.transverse_kgm2);
        trace.scalar(&format!("{name}_polar_inertia_kgm2"), inertia.polar_kgm2);
    }
    if let Some(errors) = &stages.profile_errors {
        for (name, matrix) in
            [("pinion", &errors.pinion_profile_errors_mm), ("gear", &errors.gear_profile_errors_mm)]
        {
            trace.matrix(&format!("{name}_profile_errors_mm"), matrix.nrows(), matrix.ncols(), |r, c| {
                matrix[(r, c)]
            });
        }
    }
}

fn stiffness(trace: &mut Trace, stages: &Stages) {
    let fine = stages.cycle.fine_step_rev;
    let points = stages.cycle.fine_points_in(stages.pair.span_rev);
    let sample = |curve: crate::stiffness::PairCurve| -> Vec<f64> {
        (0..points).step_by(PAIR_STRIDE).map(|i| curve.at(i as f64 * fine)).collect()
    };
    trace.vector("pair_stiffness_healthy_n_per_mm", sample(stages.pair.healthy_curve()));
    if stages.fault.is_some() {
        trace.vector("pair_stiffness_faulty_n_per_mm", sample(stages.pair.faulty_curve()));
    }
    trace.scalar("pair_stiffness_len", points as f64);
    let mesh = &stages.mesh.mesh_n_per_mm;
    trace.vector("mesh_stiffness_n_per_mm", mesh.iter().copied().step_by(MESH_STRIDE));
    trace.scalar("mesh_stiffness_len", mesh.len() as f64);
    debug_assert_eq!(points.div_ceil(FINE_PER_COARSE), stages.cycle.coarse_points_in(stages.pair.span_rev));
}

fn matrices(trace: &mut Trace, stages: &Stages) {
    let system = &stages.system;
    let square = |trace: &mut Trace, name: &str, matrix: &nalgebra::SMatrix<f64, 13, 13>| {
        trace.matrix(name, 13, 13, |r, c| matrix[(r, c)]);
    };
    trace.vector("natural_frequencies_hz", system.natural_frequencies_hz());
    trace.vector("mass_diagonal", system.mass_diagonal);
    square(trace, "damping_matrix", &system.damping_matrix());
    for point in [0, 499] {
        square(trace, &format!("stiffness_matrix_at_{point}"), &system.stiffness_matrix_at(point));
    }
    square(trace, "stiffness_matrix_mean", &system.mean_stiffness_matrix());
}

fn fault_geometry(trace: &mut Trace, stages: &Stages, fault: &FaultGeometry) {
    let every = |values: &[f64]| values.iter().copied().step_by(FAULT_STRIDE).collect::<Vec<_>>();
    let index = |i: usize| (i + FIRST_INDEX) as f64;
    match &fault.description {
        FaultDescription::MissingTooth => {}
        FaultDescription::ToothBreakage { exit_rev, .. } => trace.scalar("fault_exit_rev", *exit_rev),
        FaultDescription::FaceFault { pit, .. } => {
            let indices = [pit.start_index, pit.mid_index, pit.end_index];
            trace.vector("fault_indices", indices.map(index));
            trace.scalar("fault_length_mm", pit.length_mm);
            trace.scalar("fault_length_fraction", pit.length_fraction);
            trace.vector("fault_positions_rev", [pit.start_rev, pit.end_rev]);
            trace.vector("fault_flank_y_mm", every(&fault.flank_y_mm));
        }
        FaultDescription::ToothDestruction { start_index, end_index, slope_rad } => {
            trace.vector("fault_indices", [*start_index, *end_index].map(index));
            trace.scalar("fault_slope_rad", *slope_rad);
            trace.vector("fault_flank_y_mm", every(&fault.flank_y_mm));
        }
    }
    match &fault.displacement {
        Displacement::None => {}
        Displacement::Pair { displacement_mm } => {
            trace.vector("fault_displacement_mm", every(displacement_mm))
        }
        Displacement::Rolling(rolling) => {
            trace.vector("fault_mate_radii_mm", rolling.mate_radii_mm);
            trace.scalar("fault_deviation_mm", rolling.deviation_mm);
        }
    }
    if let Some(angles) = &fault.gear.pressure_angle_rad {
        trace.vector("fault_pressure_angle_rad", every(angles));
        let points = ANGLE_POINTS.min(stages.cycle.points_per_gear_revolution);
        let mesh = &stages.system.mesh;
        trace.vector("mesh_pressure_angle_rad", (0..points).map(|i| mesh.pressure_angle_rad(i)));
    }
    if let (Some(lateral), Some(yc)) = (&fault.gear.lateral, &fault.gear.yc_mm) {
        trace.vector("fault_section_area_mm2", every(&fault.gear.area_mm2));
        trace.vector("fault_section_yc_mm", every(yc));
        trace.vector("fault_section_zc_mm", every(&lateral.zc_mm));
        trace.vector("fault_section_iy_mm4", every(&lateral.iy_mm4));
        trace.vector("fault_section_iz_mm4", every(&fault.gear.iz_mm4));
        trace.vector("fault_section_iyz_mm4", every(&lateral.iyz_mm4));
    }
}
