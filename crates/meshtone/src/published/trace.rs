//! The traced fields of the stages that the published model has of its own.

use super::Published;
use super::damage::{Displacement, FaultGeometry};
use super::machine::coordinates::{COORDINATES, CoordinateMatrix, CoordinateVector};
use crate::trace_fields::{FAULT_STRIDE, Trace};

/// Coarse points of a through fault's pressure angle.
const ANGLE_POINTS: usize = 6000;
/// Coarse points at which the stiffness matrix is given.
const MATRIX_POINTS: [usize; 2] = [0, 499];
/// How many samples of the forces a trace holds: from the start, of the kept time, and of the deviations' force in it.
const FIRST_FORCES: usize = 200;
const KEPT_FORCES: usize = 500;
const ERROR_FORCES: usize = 2000;

impl Published {
    /// Fields of the matrices, the fault and the forces.
    pub(crate) fn trace(&self, trace: &mut Trace) {
        let (machine, mesh) = (&self.machine, &self.mesh);
        let square = |trace: &mut Trace, name: &str, matrix: &CoordinateMatrix| {
            trace.matrix(name, COORDINATES, COORDINATES, |r, c| matrix[(r, c)]);
        };
        trace.vector("mass_diagonal", machine.mass.iter().copied());
        square(trace, "damping_matrix", &machine.damping_matrix());
        for point in MATRIX_POINTS {
            let matrix = machine.stiffness_matrix_at(&mesh.load, point);
            square(trace, &format!("stiffness_matrix_at_{point}"), &matrix);
        }
        square(trace, "stiffness_matrix_mean", &machine.mean_stiffness_matrix());
        if let Some(fault) = &mesh.fault {
            self.trace_fault(trace, fault);
        }
        self.trace_forces(trace);
    }

    fn trace_forces(&self, trace: &mut Trace) {
        let kept = self.time.first_kept_sample;
        let samples = self.time.samples.min(kept + ERROR_FORCES);
        let forces: Vec<(CoordinateVector, f64)> = self.forces().take(samples).collect();
        let first = &forces[..samples.min(FIRST_FORCES)];
        let of_kept = &forces[kept.min(samples)..samples.min(kept + KEPT_FORCES)];
        for (name, forces) in [("force_first_200", first), ("force_kept_first_500", of_kept)] {
            trace.matrix(name, COORDINATES, forces.len(), |coordinate, sample| forces[sample].0[coordinate]);
        }
        trace.vector("mesh_error_force_n", forces[kept.min(samples)..].iter().map(|(_, force_n)| *force_n));
    }

    fn trace_fault(&self, trace: &mut Trace, fault: &FaultGeometry) {
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
            let points = ANGLE_POINTS.min(self.mesh.grid.points_per_gear_revolution);
            let angles = (0..points).map(|point| self.mesh.load.state(point).pressure_angle_rad);
            trace.vector("mesh_pressure_angle_rad", angles);
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
}
