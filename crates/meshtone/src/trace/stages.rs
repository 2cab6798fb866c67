//! Fields of the stages before the time loop.

use super::Trace;
use crate::damage::QuantityValue;
use crate::mesh::{LoadAlongFace, Mesh, MeshCurve};
use crate::simulate::{MeshedPair, Stages};
use crate::trace_fields::FAULT_STRIDE;
use crate::wheel::{Gears, Mounting, WheelName};

/// Every how many points a profile, a flank and a section are given.
const PROFILE_STRIDE: usize = 50;
/// Every how many fine points a pair's stiffness is given, and coarse points the mesh's.
const PAIR_STRIDE: usize = 40;
const MESH_STRIDE: usize = 4;
/// Published indices count from 1.
const FIRST_INDEX: usize = 1;

/// Fields of stages 2 to 6.
pub(crate) fn static_stages(trace: &mut Trace, stages: &Stages) {
    wheels(trace, stages);
    let MeshedPair { cycle: grid, teeth, static_force_n, .. } = &stages.pairs[0];
    let gears = &stages.layout.gears[0];
    trace.scalar("sampling_rate_hz", stages.time.sampling_rate_hz);
    trace.scalar("fine_step_rev", grid.fine_step_rev);
    trace.scalar("coarse_step_rev", grid.coarse_step_rev);
    trace.scalar("first_kept_sample", stages.time.first_kept_sample as f64);
    trace.scalar("kept_samples", stages.time.kept_samples() as f64);
    trace.scalar("pinion_revolutions", stages.pinion_revolutions());
    trace.scalar("contact_ratio", teeth.contact.contact_ratio);
    let mounting = Mounting::new(gears);
    trace.scalar("working_pressure_angle_rad", mounting.working_pressure_angle_rad);
    trace.scalar("centre_distance_mm", mounting.centre_distance_mm);
    trace.scalar("normal_backlash_mm", gears.normal_backlash_mm());
    helix(trace, "", gears, *static_force_n);
    if let Some(mesh) = stages.meshes.first() {
        along_face(trace, &str::to_owned, mesh);
    }
    bodies(trace, stages);
    stiffness(trace, stages);
    trace.vector("natural_frequencies_hz", stages.natural_frequencies_hz());
    stages.trace_matrices(trace);
    damages(trace, stages);
    stages.trace_of_published(trace);
}

/// What only helical wheels have: angles, overlap and the force along the shafts.
///
/// # Arguments
/// * `suffix` - of the names
/// * `gears` - two wheels in mesh
/// * `static_force_n` - (N) under the nominal torque, in the transverse section
pub(super) fn helix(trace: &mut Trace, suffix: &str, gears: &Gears, static_force_n: f64) {
    if gears.is_helical() {
        let named = |quantity: &str| format!("{quantity}{suffix}");
        trace.scalar(&named("transverse_pressure_angle_rad"), gears.transverse_pressure_angle_rad());
        trace.scalar(&named("base_helix_angle_rad"), gears.base_helix_angle_rad());
        trace.scalar(&named("overlap_ratio"), gears.overlap_ratio());
        trace.scalar(&named("axial_force_n"), static_force_n * gears.thrust());
    }
}

/// How a mesh bears along its face.
///
/// # Arguments
/// * `named` - what a quantity of this mesh is called
/// * `mesh` - with its tables
pub(super) fn along_face(trace: &mut Trace, named: &dyn Fn(&str) -> String, mesh: &Mesh) {
    let LoadAlongFace { lean_m, tilt_product, face_load_factor, .. } = mesh.along_face;
    trace.scalar(&named("face_load_factor"), face_load_factor);
    trace.scalar(&named("lean_um"), lean_m * 1e6);
    trace.scalar(&named("tilt_product"), tilt_product);
    trace.scalar(&named("tilt_unknowns"), f64::from(u8::from(mesh.closer_at_end_m.is_some())));
}

fn wheels(trace: &mut Trace, stages: &Stages) {
    let MeshedPair { teeth, profile_errors, .. } = &stages.pairs[0];
    for which in WheelName::BOTH {
        let (name, wheel, profile) = (which.name(), teeth.wheel(which), teeth.profile(which));
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
                teeth.initial_contact_radius_mm(which),
            ],
        );
        if let Some(index) = profile.tip_relief_index {
            trace.scalar(&format!("{name}_tip_relief_index"), (index + FIRST_INDEX) as f64);
        }
        let contact_index = teeth.initial_contact_index(which) + FIRST_INDEX;
        trace.scalar(&format!("{name}_initial_contact_index"), contact_index as f64);
    }
    if let Some(errors) = profile_errors {
        for (name, table) in
            [("pinion", &errors.pinion_profile_errors_mm), ("gear", &errors.gear_profile_errors_mm)]
        {
            trace.matrix(&format!("{name}_profile_errors_mm"), table.points(), table.teeth(), |r, c| {
                table[(r, c)]
            });
        }
    }
}

/// The wheels' bodies and the shafts.
fn bodies(trace: &mut Trace, stages: &Stages) {
    for (name, body) in WheelName::BOTH.map(WheelName::name).into_iter().zip(stages.wheel_bodies()) {
        trace.scalar(&format!("{name}_mass_kg"), body.mass_kg);
        trace.scalar(&format!("{name}_transverse_inertia_kgm2"), body.transverse_kgm2);
        trace.scalar(&format!("{name}_polar_inertia_kgm2"), body.polar_kgm2);
    }
    trace.vector("shaft_stiffness_nm_per_rad", stages.shaft_stiffness_nm_per_rad());
}

/// Pair and mesh stiffness on the grids of the published code, under every model.
fn stiffness(trace: &mut Trace, stages: &Stages) {
    let MeshedPair { cycle: grid, teeth, .. } = &stages.pairs[0];
    let points = grid.fine_points_in(teeth.contact.span_rev);
    // None for stages that somebody has changed so that they do not fit together.
    let Ok(meshes) = stages.mesh_curves_on_coarse_grid(None) else { return };
    let positions: Vec<f64> =
        (0..points).step_by(PAIR_STRIDE).map(|point| point as f64 * grid.fine_step_rev).collect();
    for (name, stiffness) in ["healthy", "faulty"].into_iter().zip(stages.pair_stiffness_n_per_mm(&positions))
    {
        if let Some(stiffness) = stiffness {
            trace.vector(&format!("pair_stiffness_{name}_n_per_mm"), stiffness);
        }
    }
    trace.scalar("pair_stiffness_len", points as f64);
    for (number, MeshCurve { stiffness_n_per_mm, .. }) in meshes.into_iter().enumerate() {
        let prefix = numbered("mesh", number);
        trace.scalar(&format!("{prefix}_stiffness_len"), stiffness_n_per_mm.len() as f64);
        let shown = stiffness_n_per_mm.into_iter().step_by(MESH_STRIDE);
        trace.vector(&format!("{prefix}_stiffness_n_per_mm"), shown);
    }
}

/// A name of several fields: `mesh` of the first, `mesh_2` of the next.
fn numbered(name: &str, number: usize) -> String {
    if number == 0 { name.to_owned() } else { format!("{name}_{}", number + 1) }
}

/// What the damages are: fields `fault_…` of the first, `fault_2_…` of the next.
fn damages(trace: &mut Trace, stages: &Stages) {
    let damaged = stages.pairs.iter().flat_map(|pair| &pair.damaged);
    let all = damaged.flat_map(|tooth| tooth.descriptions.iter().map(move |damage| (tooth, damage)));
    for (number, (tooth, damage)) in all.enumerate() {
        let prefix = numbered("fault", number);
        for (name, value) in &damage.quantities {
            let name = format!("{prefix}_{name}");
            match value {
                QuantityValue::Number(value) => trace.scalar(&name, *value),
                QuantityValue::Numbers(values) => trace.vector(&name, values.iter().copied()),
                QuantityValue::OverProfile(values) => {
                    trace.vector(&name, values.iter().copied().step_by(FAULT_STRIDE));
                }
                QuantityValue::Indices(indices) => {
                    trace.vector(&name, indices.iter().map(|index| (index + FIRST_INDEX) as f64));
                }
                QuantityValue::Word(_) => {}
            }
        }
        if damage.part.is_of_flank() {
            let flank_y_mm = tooth.outline_y_mm();
            trace.vector(&format!("{prefix}_flank_y_mm"), flank_y_mm.into_iter().step_by(FAULT_STRIDE));
        }
    }
}
