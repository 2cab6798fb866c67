//! What a step makes of steady sines.
//!
//! A sine of the angular frequency ω turns by ωΔt in a step, and from that the answer of a mode's steps follows as the mode's own does
//! from ω. So the error of a steady vibration is known without a finer step.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method* (2000), section 9.1, on the steps' amplification of a sine.

use meshtone_fourier::Complex64;

use super::ModalMachine;
use super::mode_step::{SampledSine, StepOfMode};
use crate::machine::{Axis, PINION_SUPPORT};
use crate::mesh::MeshLaw;

/// A machine with its mean mesh, as a deviation of the flanks drives it.
pub(crate) struct MeanMachine<'a> {
    model: &'a ModalMachine,
    law: MeshLaw,
    /// (s) Δt.
    step_s: f64,
    steps: Vec<StepOfMode>,
    /// Modal entries of the vertical sensor.
    sensor: Vec<f64>,
}

impl<'a> MeanMachine<'a> {
    /// The machine of a simulation of one mesh.
    ///
    /// # Arguments
    /// * `model` - its modes
    /// * `law` - that of its mesh
    /// * `step_s` - (s) time between two samples
    pub(crate) fn new(model: &'a ModalMachine, law: MeshLaw, step_s: f64) -> Self {
        let (sensor, _) = model.of_coordinates(&model.machine.weights(PINION_SUPPORT, Axis::Y));
        let steps = model.steps(&[law], step_s);
        Self { model, law, step_s, steps, sensor }
    }

    /// The square of how much a steady sine of a simulation would have to grow to be the machine's own: of the sensor's vertical
    /// acceleration, and of the force along the line of action.
    ///
    /// # Arguments
    /// * `angular_frequency` - (rad/s) of the sine, more than 0
    pub(crate) fn squared_growth(&self, angular_frequency: f64) -> [f64; 2] {
        let own = self.squared_gains(&|n| {
            let inertia = angular_frequency * angular_frequency;
            let (stiffness, damping) = (self.model.stiffness[n], self.model.damping[n]);
            let displacement = 1.0 / Complex64::new(stiffness - inertia, damping * angular_frequency);
            let velocity = displacement * Complex64::I * angular_frequency;
            [displacement, velocity, velocity * Complex64::I * angular_frequency]
        });
        let sampled = SampledSine::new(angular_frequency * self.step_s);
        let of_steps = self.squared_gains(&|n| {
            let [displacement, velocity, acceleration] = self.steps[n].answer(&sampled);
            [displacement * (self.step_s * self.step_s), velocity * self.step_s, acceleration]
        });
        [own[0] / of_steps[0], own[1] / of_steps[1]]
    }

    /// Squares of both amplitudes, to a deviation of unit amplitude.
    ///
    /// # Arguments
    /// * `answer` - displacement, velocity and acceleration of a mode to a force of unit amplitude
    fn squared_gains(&self, answer: &dyn Fn(usize) -> [Complex64; 3]) -> [f64; 2] {
        let line = &self.model.lines[0].columns[0];
        let (mut of_line, mut of_sensor) = (Complex64::ZERO, Complex64::ZERO);
        for (n, (line, sensor)) in line.iter().zip(&self.sensor).enumerate() {
            let [displacement, velocity, acceleration] = answer(n);
            of_line += (displacement + velocity * self.law.damping_time_s) * (line * line);
            of_sensor += acceleration * (line * sensor);
        }
        // The flanks' own rate of change is given; the damping's share of it is the same in both.
        let force = self.law.back_stiffness_n_per_m / (1.0 + of_line * self.law.back_stiffness_n_per_m);
        [(of_sensor * force).norm_sqr(), force.norm_sqr()]
    }
}
