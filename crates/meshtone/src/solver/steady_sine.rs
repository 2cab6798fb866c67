//! What a step makes of steady sines.
//!
//! Newmark's method with γ = ½ and β = ¼ answers a sine of the angular frequency ω as the machine itself answers one of
//! `ω' = 2/Δt tan(ω Δt/2)`: it is the trapezoidal rule. So the error of a steady vibration is known without a finer step.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method* (2000), section 9.1, on the method's period elongation.

use meshtone_fourier::Complex64;

use super::ModalMachine;
use crate::machine::{Axis, ClosedMesh, SENSOR};

/// A machine with its mean mesh, as a deviation of the flanks drives it.
pub(crate) struct MeanMachine<'a> {
    model: &'a ModalMachine,
    mesh: ClosedMesh,
    /// Modal entries of the vertical sensor.
    sensor: Vec<f64>,
}

impl<'a> MeanMachine<'a> {
    /// The machine of a simulation of one mesh.
    ///
    /// # Arguments
    /// * `model` - its modes
    /// * `mesh` - the mean mesh
    pub(crate) fn new(model: &'a ModalMachine, mesh: ClosedMesh) -> Self {
        let (sensor, _) = model.of_coordinates(&model.machine.weights(SENSOR, Axis::Y));
        Self { model, mesh, sensor }
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
        let loss = Complex64::new(1.0, angular_frequency * self.mesh.damping_time_s);
        let stiffness = loss * self.mesh.stiffness_n_per_m;
        let force = (stiffness / (1.0 + stiffness * receptance)).norm_sqr();
        [angular_frequency.powi(4) * sensor.norm_sqr() * force, force]
    }

    /// (m/N) Displacement along the line of action, and that of the sensor, to a force of unit amplitude along the line.
    fn receptances(&self, angular_frequency: f64) -> (Complex64, Complex64) {
        let modes = self.model.stiffness.iter().zip(&self.model.damping);
        let square = angular_frequency * angular_frequency;
        let (mut of_line, mut of_sensor) = (Complex64::ZERO, Complex64::ZERO);
        for ((stiffness, damping), (line, sensor)) in modes.zip(self.model.lines[0].columns[0].iter().zip(&self.sensor)) {
            let impedance = Complex64::new(stiffness - square, damping * angular_frequency);
            let answer = impedance.conj() * (line / impedance.norm_sqr());
            of_line += answer * line;
            of_sensor += answer * sensor;
        }
        (of_line, of_sensor)
    }
}
