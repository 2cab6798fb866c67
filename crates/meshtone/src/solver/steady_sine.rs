//! What a step makes of steady sines.
//!
//! Newmark's method with γ = ½ and β = ¼ answers a sine of the angular frequency ω as the machine itself answers one of
//! `ω' = 2/Δt tan(ω Δt/2)`: it is the trapezoidal rule. So the error of a steady vibration is known without a finer step.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method* (2000), section 9.1, on the method's period elongation.

use meshtone_fourier::Complex64;
use nalgebra::DVector;

use super::ReducedModel;
use crate::machine::ClosedMesh;

/// The machine with its mean mesh, as a deviation of the flanks drives it.
pub(crate) struct MeanMachine<'a> {
    model: &'a ReducedModel,
    /// The mesh, where it is not in the modes.
    mesh: Option<ClosedMesh>,
    /// Modal entries of the line of action.
    line: Vec<f64>,
    /// Modal entries of the vertical sensor.
    sensor: Vec<f64>,
    /// (N/m) Mean stiffness along it.
    stiffness_n_per_m: f64,
}

/// Numbers of the mesh's directions that lie in the nominal line of action: along it, and its rotation.
const IN_LINE: [usize; 2] = [0, 2];

/// Index of the vertical direction in [`ReducedModel::sensor`].
const VERTICAL: usize = 1;

impl<'a> MeanMachine<'a> {
    /// The machine of a simulation.
    ///
    /// # Arguments
    /// * `model` - its modes
    /// * `mesh` - the mean mesh, where the modes are those without it
    pub(crate) fn new(model: &'a ReducedModel, mesh: Option<ClosedMesh>) -> Self {
        let mut line = vec![0.0; model.modes()];
        let columns = model.mesh.iter().zip(&model.directions);
        for (column, _) in columns.filter(|(_, direction)| IN_LINE.contains(direction)) {
            line.iter_mut().zip(column.iter()).for_each(|(sum, entry)| *sum += entry);
        }
        let in_modes = || model.mean_mesh_stiffness.get((0, 0)).copied().unwrap_or(0.0);
        let stiffness_n_per_m = mesh.map_or_else(in_modes, |mesh| mesh.stiffness_n_per_m);
        let weights = &model.sensor[VERTICAL];
        let of_mode = |shape: &DVector<f64>| shape.iter().zip(weights).map(|(s, w)| s * w).sum();
        let sensor = model.shapes.iter().map(of_mode).collect();
        Self { model, mesh, line, sensor, stiffness_n_per_m }
    }

    /// The square of how much a steady sine of a simulation would have to grow to be the machine's own: of the sensor's vertical
    /// acceleration, and of the force along the line of action.
    ///
    /// # Arguments
    /// * `angular_frequency` - (rad/s) of the sine, more than 0
    /// * `step_s` - (s) time between two samples
    pub(crate) fn squared_growth(&self, angular_frequency: f64, step_s: f64) -> [f64; 2] {
        let warped = (angular_frequency * step_s / 2.0).tan() * 2.0 / step_s;
        let (own, of_step) = (self.squared_gains(angular_frequency), self.squared_gains(warped));
        [own[0] / of_step[0], own[1] / of_step[1]]
    }

    /// Squares of both amplitudes, to a deviation of unit amplitude.
    fn squared_gains(&self, angular_frequency: f64) -> [f64; 2] {
        let (receptance, sensor) = self.receptances(angular_frequency);
        let force = match self.mesh {
            Some(mesh) => {
                let loss = Complex64::new(1.0, angular_frequency * mesh.damping_time_s);
                let stiffness = loss * self.stiffness_n_per_m;
                stiffness / (1.0 + stiffness * receptance)
            }
            // The modes give way to the mesh already.
            None => self.stiffness_n_per_m * (1.0 - self.stiffness_n_per_m * receptance),
        };
        let force = force.norm_sqr();
        let driving = if self.mesh.is_some() { force } else { self.stiffness_n_per_m.powi(2) };
        [angular_frequency.powi(4) * sensor.norm_sqr() * driving, force]
    }

    /// (m/N) Displacement along the line of action, and that of the sensor, to a force of unit amplitude along the line.
    fn receptances(&self, angular_frequency: f64) -> (Complex64, Complex64) {
        let modes = self.model.stiffness.iter().zip(&self.model.damping);
        let square = angular_frequency * angular_frequency;
        let (mut of_line, mut of_sensor) = (Complex64::ZERO, Complex64::ZERO);
        for ((stiffness, damping), (line, sensor)) in modes.zip(self.line.iter().zip(&self.sensor)) {
            let impedance = Complex64::new(stiffness - square, damping * angular_frequency);
            let answer = impedance.conj() * (line / impedance.norm_sqr());
            of_line += answer * line;
            of_sensor += answer * sensor;
        }
        (of_line, of_sensor)
    }
}
