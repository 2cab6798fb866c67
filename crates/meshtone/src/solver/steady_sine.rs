//! What a step makes of steady sines.
//!
//! A sine of the angular frequency ω turns by ωΔt in a step, and from that the answer of a mode's steps follows as the mode's own does
//! from ω. So the error of a steady vibration is known without a finer step.
//!
//! Source: T. J. R. Hughes, *The Finite Element Method* (2000), section 9.1, on the steps' amplification of a sine.

use std::borrow::Cow;

use meshtone_fourier::Complex64;
use nalgebra::DMatrix;

use super::ModalMachine;
use super::mode_step::{SampledSine, StepOfMode};
use crate::machine::Axis;
use crate::mesh::MeshLaw;

/// A machine with its mean meshes, as deviations of the flanks drive it.
pub(crate) struct MeanMachine<'a> {
    model: &'a ModalMachine,
    laws: Vec<MeshLaw>,
    /// (s) Δt.
    step_s: f64,
    steps: Vec<StepOfMode>,
    /// Modal entries of each sensor.
    sensors: Vec<Vec<f64>>,
    /// (m/N) Deflection of each mesh per force of each, of the modes that are not stepped.
    residual: DMatrix<f64>,
}

impl<'a> MeanMachine<'a> {
    /// The machine of a simulation.
    ///
    /// # Arguments
    /// * `model` - its modes
    /// * `laws` - those of its meshes
    /// * `step_s` - (s) time between two samples
    /// * `sensors` - place and axis of the accelerations that are asked for
    pub(crate) fn new(
        model: &'a ModalMachine,
        laws: Vec<MeshLaw>,
        step_s: f64,
        sensors: &[(Cow<'static, str>, Axis)],
    ) -> Self {
        let of_sensor =
            |(place, axis): &(Cow<'static, str>, Axis)| model.of_coordinates(&model.weights(place, *axis)).0;
        let compliance = model.residual.compliance();
        Self {
            steps: model.steps(&laws, step_s),
            sensors: sensors.iter().map(of_sensor).collect(),
            residual: DMatrix::from_fn(laws.len(), laws.len(), |a, b| {
                compliance.get(a).map_or(0.0, |row| row[b])
            }),
            model,
            laws,
            step_s,
        }
    }

    /// The square of how much a steady sine of a simulation would have to grow to be the machine's own: of each sensor's acceleration, and
    /// then of the force along each line of action.
    ///
    /// # Arguments
    /// * `angular_frequency` - (rad/s) of the sine, more than 0
    pub(crate) fn squared_growth(&self, angular_frequency: f64) -> Vec<f64> {
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
        own.into_iter().zip(of_steps).map(|(own, of_steps)| own / of_steps).collect()
    }

    /// Squares of the amplitudes of all sensors and forces, to deviations of unit amplitude that the meshes have by turns, added up.
    ///
    /// # Arguments
    /// * `answer` - displacement, velocity and acceleration of a mode to a force of unit amplitude
    fn squared_gains(&self, answer: &dyn Fn(usize) -> [Complex64; 3]) -> Vec<f64> {
        // Of one mesh, whose sines are many, all of this is a few numbers.
        if let ([law], [sensor]) = (&self.laws[..], &self.sensors[..]) {
            let line = &self.model.lines[0].at_middle;
            let (mut of_line, mut of_sensor) = (Complex64::from(self.residual[(0, 0)]), Complex64::ZERO);
            for (n, (line, sensor)) in line.iter().zip(sensor).enumerate() {
                let [displacement, velocity, acceleration] = answer(n);
                of_line += (displacement + velocity * law.damping_time_s) * (line * line);
                of_sensor += acceleration * (line * sensor);
            }
            let force = law.back_stiffness_n_per_m / (1.0 + of_line * law.back_stiffness_n_per_m);
            return vec![(of_sensor * force).norm_sqr(), force.norm_sqr()];
        }
        let (meshes, sensors) = (self.laws.len(), self.sensors.len());
        let line = |mesh: usize, n: usize| self.model.lines[mesh].at_middle[n];
        let mut of_line = self.residual.map(Complex64::from);
        let mut of_sensor = DMatrix::from_element(sensors, meshes, Complex64::ZERO);
        for n in 0..self.model.modes() {
            let [displacement, velocity, acceleration] = answer(n);
            for b in 0..meshes {
                for a in 0..meshes {
                    let led = displacement + velocity * self.laws[a].damping_time_s;
                    of_line[(a, b)] += led * (line(a, n) * line(b, n));
                }
                for (sensor, entries) in self.sensors.iter().enumerate() {
                    of_sensor[(sensor, b)] += acceleration * (line(b, n) * entries[n]);
                }
            }
        }
        // The flanks' own rate of change is given; the damping's share of it is the same in both.
        let stiffness = |mesh: usize| self.laws[mesh].back_stiffness_n_per_m;
        let closed = DMatrix::from_fn(meshes, meshes, |a, b| {
            of_line[(a, b)] * stiffness(a) + if a == b { Complex64::ONE } else { Complex64::ZERO }
        });
        let deviations = DMatrix::from_fn(meshes, meshes, |a, b| {
            if a == b { Complex64::from(stiffness(a)) } else { Complex64::ZERO }
        });
        // Singular for no ω: every mode is damped, or a sine beside its frequency.
        let forces = closed.lu().solve(&deviations).unwrap_or(deviations);
        let sum = |row: nalgebra::DVector<Complex64>| row.iter().map(Complex64::norm_sqr).sum::<f64>();
        let accelerations = of_sensor * &forces;
        let rows = (0..sensors).map(|n| accelerations.row(n).transpose());
        rows.chain((0..meshes).map(|n| forces.row(n).transpose())).map(sum).collect()
    }
}
