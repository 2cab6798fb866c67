//! Fields of the stages before the time loop.

use std::num::NonZeroUsize;

use super::Trace;
use crate::damage::published::{Displacement, FaultGeometry};
use crate::damage::{DamageDescription, FlankPit};
use crate::machine::Structure;
use crate::mesh::{ContactMesh, Mesh, PairKind, PairMesh};
use crate::operation::CycleGrid;
use crate::simulate::Stages;
use crate::wheel::{Mounting, ToothProfile, Wheel};

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
    let mounting = Mounting::new(&stages.scenario.gears);
    trace.scalar("working_pressure_angle_rad", mounting.working_pressure_angle_rad);
    trace.scalar("centre_distance_mm", mounting.centre_distance_mm);
    trace.scalar("normal_backlash_mm", stages.scenario.gears.normal_backlash_mm());
    trace.vector("shaft_stiffness_nm_per_rad", stages.system.shaft_stiffness_nm_per_rad);
    stiffness(trace, stages);
    matrices(trace, stages);
    damages(trace, stages);
    if let Some(fault) = stages.mesh.published().and_then(|mesh| mesh.fault.as_ref()) {
        published_fault(trace, stages, fault);
    }
}

fn wheels(trace: &mut Trace, stages: &Stages) {
    let teeth = &stages.teeth;
    let wheel = |trace: &mut Trace,
                 name: &str,
                 wheel: &Wheel,
                 profile: &ToothProfile,
                 (contact_index, contact_radius): (usize, f64)| {
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
        trace.scalar(&format!("{name}_initial_contact_index"), (contact_index + FIRST_INDEX) as f64);
    };
    let contact = &teeth.contact;
    wheel(
        trace,
        "pinion",
        &teeth.pinion,
        &teeth.pinion_profile,
        (contact.pinion_initial_contact_index, contact.pinion_initial_radius_mm),
    );
    wheel(
        trace,
        "gear",
        &teeth.gear,
        &teeth.gear_profile,
        (contact.initial_contact_index, contact.gear_initial_radius_mm),
    );
    for (name, inertia) in [("pinion", &stages.system.pinion), ("gear", &stages.system.gear)] {
        trace.scalar(&format!("{name}_mass_kg"), inertia.mass_kg);
        trace.scalar(&format!("{name}_transverse_inertia_kgm2"), inertia.transverse_kgm2);
        trace.scalar(&format!("{name}_polar_inertia_kgm2"), inertia.polar_kgm2);
    }
    if let Some(errors) = &stages.profile_errors {
        for (name, table) in
            [("pinion", &errors.pinion_profile_errors_mm), ("gear", &errors.gear_profile_errors_mm)]
        {
            trace.matrix(&format!("{name}_profile_errors_mm"), table.points(), table.teeth(), |r, c| {
                table[(r, c)]
            });
        }
    }
}

/// Pair and mesh stiffness on the grids of the published code, under every model.
fn stiffness(trace: &mut Trace, stages: &Stages) {
    let grid = &stages.cycle;
    let points = grid.fine_points_in(stages.teeth.contact.span_rev);
    let pair = |trace: &mut Trace, name: &str, at: &dyn Fn(f64) -> f64| {
        let positions = (0..points).step_by(PAIR_STRIDE).map(|point| point as f64 * grid.fine_step_rev);
        trace.vector(&format!("pair_stiffness_{name}_n_per_mm"), positions.map(at).collect::<Vec<_>>());
    };
    let mesh = match &stages.mesh {
        Mesh::Published(mesh) => {
            pair(trace, "healthy", &|position| mesh.pair.healthy_curve().at(position));
            if mesh.fault.is_some() {
                pair(trace, "faulty", &|position| mesh.pair.faulty_curve().at(position));
            }
            mesh.stiffness.mesh_n_per_mm.clone()
        }
        Mesh::Pairs(_) | Mesh::Contact(_) => {
            let pairs = stages.pairs();
            let pitches = f64::from(stages.teeth.pinion.teeth);
            let Some(mesh) = mesh_on(stages, grid) else { return };
            let contact = contact_on(stages, grid);
            let is_first =
                |kind: &&PairKind| matches!((kind.pinion, kind.gear), (Some(0), None) | (None, Some(0)));
            let classes = mesh.sequence.classes();
            for (kind, name) in [(classes.first(), "healthy"), (classes.iter().find(is_first), "faulty")] {
                let Some(kind) = kind else { continue };
                pair(trace, name, &|position| pairs.at(kind, position * pitches).stiffness_n_per_mm);
            }
            let revolution = 0..mesh.sequence.gear_teeth();
            match contact {
                Some(contact) => contact.stiffness_n_per_mm(revolution),
                None => mesh.stiffness_n_per_mm(revolution),
            }
        }
    };
    trace.scalar("pair_stiffness_len", points as f64);
    trace.vector("mesh_stiffness_n_per_mm", mesh.iter().copied().step_by(MESH_STRIDE));
    trace.scalar("mesh_stiffness_len", mesh.len() as f64);
}

/// The pairs at the points of a grid; none for stages that somebody has changed so that they do not fit together.
fn mesh_on(stages: &Stages, grid: &CycleGrid) -> Option<PairMesh> {
    stages.pair_mesh(NonZeroUsize::new(grid.points_per_pitch)?).ok()
}

/// The same under `contact`.
fn contact_on(stages: &Stages, grid: &CycleGrid) -> Option<ContactMesh> {
    stages.contact_mesh(NonZeroUsize::new(grid.points_per_pitch)?).ok().flatten()
}

/// Of the wheels, brake and supports under `contact`: without the mesh, and with the mean one closed.
fn structure_matrices(trace: &mut Trace, stages: &Stages, structure: &Structure) {
    let size = structure.mass_diagonal.len();
    let mean_n_per_m = stages.mesh.mean_stiffness_n_per_mm() * 1e3;
    trace.vector("mass_diagonal", structure.mass_diagonal.iter().copied());
    for (name, matrix) in [
        ("damping_matrix", structure.damping_matrix()),
        ("stiffness_matrix_open", structure.stiffness_matrix()),
        ("stiffness_matrix_mean", structure.closed_stiffness_matrix(mean_n_per_m)),
    ] {
        trace.matrix(name, size, size, |r, c| matrix[(r, c)]);
    }
}

fn matrices(trace: &mut Trace, stages: &Stages) {
    trace.vector("natural_frequencies_hz", stages.natural_frequencies_hz());
    if let Some(structure) = &stages.structure {
        structure_matrices(trace, stages, structure);
        return;
    }
    let system = &stages.system;
    let square = |trace: &mut Trace, name: &str, matrix: &nalgebra::SMatrix<f64, 13, 13>| {
        trace.matrix(name, 13, 13, |r, c| matrix[(r, c)]);
    };
    trace.vector("mass_diagonal", system.mass_diagonal);
    square(trace, "damping_matrix", &system.damping_matrix());
    // On the coarse grid of the published code, under every model.
    let coarse = match &stages.mesh {
        Mesh::Published(_) => None,
        Mesh::Pairs(_) | Mesh::Contact(_) => mesh_on(stages, &stages.cycle),
    };
    for point in [0, 499] {
        let matrix = match &coarse {
            None => system.stiffness_matrix_at(&stages.mesh, point),
            Some(mesh) => system.stiffness_matrix(&mesh.stiffness_at(mesh.entry(point))),
        };
        square(trace, &format!("stiffness_matrix_at_{point}"), &matrix);
    }
    square(trace, "stiffness_matrix_mean", &system.mean_stiffness_matrix());
}

/// What the damages are: fields `fault_…` of the first, `fault_2_…` of the next.
fn damages(trace: &mut Trace, stages: &Stages) {
    let index = |i: usize| (i + FIRST_INDEX) as f64;
    let all = stages.damaged.iter().flat_map(|tooth| {
        tooth.descriptions.iter().map(move |description| (tooth.outline_y_mm(), description))
    });
    for (number, (flank_y_mm, description)) in all.enumerate() {
        let prefix = if number == 0 { "fault".to_string() } else { format!("fault_{}", number + 1) };
        let name = |field: &str| format!("{prefix}_{field}");
        match description {
            DamageDescription::MissingTooth => continue,
            DamageDescription::ToothBreakage { exit_rev, .. } => {
                trace.scalar(&name("exit_rev"), *exit_rev);
                continue;
            }
            DamageDescription::FaceFault { pit, .. } => {
                let indices = [pit.start_index, pit.mid_index, pit.end_index];
                trace.vector(&name("indices"), indices.map(index));
                trace.scalar(&name("length_mm"), pit.length_mm);
                trace.scalar(&name("length_fraction"), pit.length_fraction);
                trace.vector(&name("positions_rev"), [pit.start_rev, pit.end_rev]);
            }
            DamageDescription::ToothDestruction { start_index, end_index, slope_rad } => {
                trace.vector(&name("indices"), [*start_index, *end_index].map(index));
                trace.scalar(&name("slope_rad"), *slope_rad);
            }
            DamageDescription::Pits { pits, area_percent } => {
                let every = |of: fn(&FlankPit) -> f64| pits.iter().map(of).collect::<Vec<_>>();
                trace.vector(&name("at"), every(|pit| pit.at));
                trace.vector(&name("z_mm"), every(|pit| pit.z_mm));
                trace.vector(&name("radius_mm"), every(|pit| pit.radius_mm));
                trace.vector(&name("face_radius_mm"), every(|pit| pit.face_radius_mm));
                trace.vector(&name("depth_mm"), every(|pit| pit.depth_mm));
                trace.scalar(&name("area_percent"), *area_percent);
            }
            DamageDescription::Wear { start_index, end_index, depth_mm } => {
                trace.vector(&name("indices"), [*start_index, *end_index].map(index));
                trace.vector(&name("depth_mm"), depth_mm.iter().copied().step_by(FAULT_STRIDE));
            }
            DamageDescription::RootCrack { crack } => {
                let (tip_x_mm, tip_y_mm) = crack.tip_mm();
                trace.vector(&name("crack_x_mm"), [crack.start_x_mm, tip_x_mm]);
                trace.vector(&name("crack_y_mm"), [crack.start_y_mm, tip_y_mm]);
                continue;
            }
        }
        trace.vector(&name("flank_y_mm"), flank_y_mm.iter().copied().step_by(FAULT_STRIDE));
    }
}

/// What the published code makes of its fault.
fn published_fault(trace: &mut Trace, stages: &Stages, fault: &FaultGeometry) {
    let every = |values: &[f64]| values.iter().copied().step_by(FAULT_STRIDE).collect::<Vec<_>>();
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
        if let Some(mesh) = stages.mesh.published() {
            let angles = (0..points).map(|point| mesh.load.pressure_angle_rad(point));
            trace.vector("mesh_pressure_angle_rad", angles);
        }
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
