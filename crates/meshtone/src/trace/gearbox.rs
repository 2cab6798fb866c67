//! Every stage's output of a gearbox.

use super::stages::{along_face, helix};
use crate::simulate::{Simulation, Stages};
use crate::trace_fields::Trace;
use crate::wheel::WheelName;

/// Fields of a gearbox: those of its stages, of the steps, and all signals.
///
/// # Arguments
/// * `simulation` - of it
pub(super) fn gearbox_trace(simulation: &Simulation) -> Trace {
    let mut trace = Trace::default();
    gearbox_stages(&mut trace, &simulation.stages);
    for (name, count) in ["steps", "newton_iterations", "most_newton_iterations", "line_searches"]
        .into_iter()
        .zip(simulation.step_counts)
    {
        trace.scalar(name, count as f64);
    }
    for signal in &simulation.channels.signals {
        trace.vector(&signal.name, signal.values.iter().copied());
    }
    trace
}

/// Fields of the stages of a gearbox: those of the train, of each mesh under its name, and of the machine.
pub(super) fn gearbox_stages(trace: &mut Trace, stages: &Stages) {
    let (gearbox, layout) = (&stages.scenario, &stages.layout);
    trace.scalar("sampling_rate_hz", stages.time.sampling_rate_hz);
    trace.scalar("samples_per_input_revolution", stages.time.samples_per_pinion_revolution as f64);
    trace.scalar("first_simulated_sample", stages.time.first_simulated_sample as f64);
    trace.scalar("first_kept_sample", stages.time.first_kept_sample as f64);
    trace.scalar("cycle_input_revolutions", layout.cycle_revolutions() as f64);
    trace.vector("speed_ratio", layout.ratios.iter().map(|ratio| ratio.value()));
    let positions = &layout.positions_m;
    trace.matrix("shaft_position_mm", positions.len(), 2, |shaft, axis| positions[shaft][axis] * 1e3);
    trace.vector("phase", layout.phases.iter().copied());
    trace.vector("static_force_n", stages.pairs.iter().map(|pair| pair.static_force_n));
    let of_file = gearbox.meshes.iter().zip(&layout.gears);
    for ((mesh, pair), (of_file, gears)) in stages.meshes.iter().zip(&stages.pairs).zip(of_file) {
        let named = |quantity: &str| format!("{quantity}.{}", of_file.name());
        helix(trace, &named(""), gears, pair.static_force_n);
        trace.vector(
            &named("radii_mm"),
            WheelName::BOTH.into_iter().flat_map(|side| {
                let wheel = pair.teeth.wheel(side);
                [wheel.base_radius_mm, wheel.tip_radius_mm]
            }),
        );
        trace.scalar(&named("contact_ratio"), pair.teeth.contact.contact_ratio);
        trace.scalar(&named("mean_stiffness_n_per_m"), mesh.mean_stiffness_n_per_m);
        trace.scalar(&named("damping_time_s"), mesh.damping_time_s);
        along_face(trace, &named, mesh);
        trace.vector(
            &named("mesh_stiffness_n_per_mm"),
            mesh.stiffness_n_per_mm(0..mesh.sequence.gear_teeth()),
        );
        for (wheel, errors) in of_file.wheels.iter().zip(
            pair.profile_errors
                .iter()
                .flat_map(|errors| [&errors.pinion_profile_errors_mm, &errors.gear_profile_errors_mm]),
        ) {
            let name = format!("profile_errors_mm.{wheel}.{}", of_file.name());
            trace.matrix(&name, errors.points(), errors.teeth(), |point, tooth| errors[(point, tooth)]);
        }
    }
    for (number, bearing) in &stages.bearings {
        let named = |quantity: &str| format!("{quantity}.{}", gearbox.bearings()[*number].seat_name());
        trace.vector(&named("bearing_load_n"), bearing.static_load_n);
        trace.vector(&named("bearing_spring_n_per_m"), bearing.spring_n_per_m.into_iter().flatten());
    }
    stages.trace_modes(trace);
    trace.vector("natural_frequencies_hz", stages.natural_frequencies_hz());
}
