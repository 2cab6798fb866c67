//! The random part of a gearbox's vibration, which no line of its spectrum has.
//!
//! What recorded gearboxes have between their lines has the lines' spectrum, so it comes from the same place and goes the same way: in
//! each mesh, by a force across the line of action, which the free rotation of the wheels does not relieve. Its density, in N/√Hz, is
//!
//! `N(t) = c (F̄/1 N)^0.4 (v/0.5 m/s)^1.25 (f̃(t)/F̄)^0.75 w(t)`
//!
//! with w white noise of density 1, F̄ the mean force of the mesh, f̃ its force averaged over a mesh period, v the mean speed at which the flanks
//! slide, and one pole at 10 kHz. c is the key `random_force` of a mesh. The form and c = 0.055 were fitted to two channels of one two-stage gearbox at two
//! loads; the force is an effective one, larger than what friction of the flanks can vary by: it stands for lubricant, bearings and flow too.
//!
//! It is not integrated, but superposed on the motion of the sensors' places by the transfer functions of the machine with its mean meshes closed.
//! So the simulated motion is the same with it and without it, and what checks a result looks at that motion alone.

use std::f64::consts::TAU;

use meshtone_fourier::{Complex64, convenient_length, from_real_spectrum, real_spectrum};
use nalgebra::DVector;

use super::Stages;
use crate::random::{Draws, Purpose};
use crate::sensor::{Channel, Channels, SignalSource};
use crate::solver::{Block, LateralResponse, ModalMachine, Output, Recorder, StepCounts};

/// (-) How the density grows with the mean force, with the speed of sliding, and with the force while it varies.
const BY_MEAN_FORCE: f64 = 0.4;
const BY_SLIDING_SPEED: f64 = 1.25;
const BY_FORCE: f64 = 0.75;
/// (m/s) The speed of sliding of which c is the density at 1 N.
const SLIDING_M_PER_S: f64 = 0.5;
/// (Hz) Above it the density falls with the frequency.
const POLE_HZ: f64 = 1e4;

/// The random forces of a run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RandomForces {
    /// (N) The spectrum of each mesh's.
    spectra: Vec<Vec<Complex64>>,
    /// Number of values of the spectra's signals, as many as are kept or a few more: they repeat themselves after that.
    length: usize,
    /// Number of the first place of each sensor.
    first_places: Vec<usize>,
    /// The transfer functions to all sensors' places.
    response: LateralResponse,
}

impl Stages {
    /// Whether any mesh has a random force.
    fn has_random_forces(&self) -> bool {
        self.scenario.meshes.iter().any(|mesh| mesh.random_force > 0.0)
    }

    /// What the random forces need of a run beside the outputs that are asked for: the force of each mesh, where any is random.
    pub(crate) fn outputs_of_random_forces(&self) -> Vec<Output> {
        let meshes = 0..if self.has_random_forces() { self.meshes.len() } else { 0 };
        meshes.map(|mesh| Output::MeshForce { mesh }).collect()
    }

    /// The stages with the random forces of a run; as they are where no force is random.
    ///
    /// # Arguments
    /// * `mesh_force_n` - (N) force of each mesh, of the kept samples
    pub(crate) fn with_random_forces(mut self, mesh_force_n: &[&[f64]]) -> Self {
        let modal = self.machine().map(|(_, modal)| modal).filter(|_| self.has_random_forces());
        self.random_forces = modal.map(|modal| self.random_forces_of(modal, mesh_force_n));
        self
    }

    /// The same of all channels.
    pub(crate) fn with_random_forces_of(self, channels: &Channels) -> Self {
        let forces: Vec<&[f64]> =
            (0..self.meshes.len()).map(|mesh| channels.of(SignalSource::MeshForce(mesh))).collect();
        self.with_random_forces(&forces)
    }

    fn random_forces_of(&self, modal: &ModalMachine, mesh_force_n: &[&[f64]]) -> RandomForces {
        let samples = self.time.kept_samples();
        let length = convenient_length(samples);
        let rate_hz = self.time.sampling_rate_hz;
        // A density of 1 over all frequencies up to half the rate.
        let deviation = (rate_hz / 2.0).sqrt();
        let speed = self.sliding_over_nominal();
        let spectrum = |(mesh, force_n): (usize, &&[f64])| {
            let envelope = self.density_n_per_rthz(mesh, force_n, speed.as_deref());
            let mut draws = Draws::new(self.scenario.seed, Purpose::RandomForce, mesh as u64);
            let mut signal = vec![0.0; length];
            for (n, pair) in signal.chunks_mut(2).enumerate() {
                for (k, (value, normal)) in pair.iter_mut().zip(draws.normals()).enumerate() {
                    *value = deviation * normal * envelope.get((2 * n + k) % samples.max(1)).unwrap_or(&0.0);
                }
            }
            let mut spectrum = real_spectrum(&signal);
            for (line, value) in spectrum.iter_mut().enumerate() {
                let hz = line as f64 * rate_hz / length as f64;
                *value /= Complex64::new(1.0, hz / POLE_HZ);
            }
            spectrum
        };
        let (mut places, mut first_places): (Vec<DVector<f64>>, Vec<usize>) = Default::default();
        for sensor in 0..self.sensors.len() {
            first_places.push(places.len());
            places.extend(self.weights_of(modal, sensor));
        }
        let response = LateralResponse::new(modal, &self.closed_meshes(), &places, rate_hz / 2.0);
        let spectra = mesh_force_n.iter().enumerate().map(spectrum).collect();
        RandomForces { spectra, length, first_places, response }
    }

    /// (N/√Hz) The density of a mesh's random force at each kept sample.
    ///
    /// # Arguments
    /// * `mesh` - its number
    /// * `force_n` - (N) its force
    /// * `speed` - (-) the motor's speed over the nominal one at each sample; none where it is constant
    fn density_n_per_rthz(&self, mesh: usize, force_n: &[f64], speed: Option<&[f64]>) -> Vec<f64> {
        let size = self.scenario.meshes[mesh].random_force;
        let period =
            self.time.samples_per_pinion_revolution as f64 / self.layout.pitches_per_revolution(mesh);
        let averaged_n = averaged(force_n, period.round() as usize);
        let mean_n = averaged_n.iter().sum::<f64>() / averaged_n.len().max(1) as f64;
        if size == 0.0 || mean_n <= 0.0 {
            return vec![0.0; force_n.len()];
        }
        let sliding = self.mean_sliding_m_per_s(mesh) / SLIDING_M_PER_S;
        let whole = size * mean_n.powf(BY_MEAN_FORCE) * sliding.powf(BY_SLIDING_SPEED);
        let at = |(k, force_n): (usize, f64)| {
            let faster = speed.map_or(1.0, |speed| speed[k].powf(BY_SLIDING_SPEED));
            whole * faster * (force_n / mean_n).powf(BY_FORCE)
        };
        averaged_n.into_iter().enumerate().map(at).collect()
    }

    /// (-) The motor's speed over the nominal one at each kept sample; none where it is constant.
    fn sliding_over_nominal(&self) -> Option<Vec<f64>> {
        let operation = &self.scenario.operation;
        let relative =
            || self.kept_motion().iter().map(|motion| motion.speed_hz / operation.pinion_speed_hz).collect();
        (!operation.keeps_speed()).then(relative)
    }

    /// (m/s) Mean over the path of the speed at which the flanks of a mesh slide, at the nominal speed.
    fn mean_sliding_m_per_s(&self, mesh: usize) -> f64 {
        let teeth = &self.pairs[mesh].teeth;
        let (path, pitch_point) = (&teeth.path, teeth.pitch_point());
        let [before, after] = [pitch_point, path.contact_ratio - pitch_point].map(f64::abs);
        let mean = (before * before + after * after) / (2.0 * (before + after));
        let driving_rad_per_s =
            TAU * self.scenario.operation.pinion_speed_hz * self.layout.driving_ratio(mesh).abs();
        let ratio = teeth.gear.sign() * f64::from(teeth.pinion.teeth) / f64::from(teeth.gear.teeth);
        mean * path.base_pitch_mm * 1e-3 * driving_rad_per_s * (1.0 + ratio)
    }

    /// (g) What the random forces add to the motion of a sensor's place; nothing where there are none, or what goes to the sensor is a force.
    ///
    /// # Arguments
    /// * `sensor` - its number
    /// * `motion` - is added to
    pub(crate) fn add_random_part(&self, sensor: usize, motion: &mut [f64]) {
        let Some(random) = &self.random_forces else { return };
        let first = random.first_places[sensor];
        match self.sensors[sensor].output(&self.scenario.set_names()) {
            Output::Acceleration { factor, .. } => {
                let added = self.moved_by_chance(random, first);
                motion.iter_mut().zip(added).for_each(|(motion, added)| *motion += factor * added);
            }
            Output::OnRing(on) => {
                let (terms, angles_rad) = (self.terms_of(&on), self.kept_angles_rad(&on));
                for (number, term) in terms.iter().enumerate() {
                    let added = self.moved_by_chance(random, first + number);
                    for ((motion, added), angle_rad) in motion.iter_mut().zip(added).zip(&angles_rad) {
                        *motion += term.weight(&on, *angle_rad) * added;
                    }
                }
            }
            _ => {}
        }
    }

    /// The coordinates' weights in each place whose acceleration a sensor's depends on: its own, or those of the ring on which it sits.
    fn weights_of(&self, modal: &ModalMachine, sensor: usize) -> Vec<DVector<f64>> {
        match self.sensors[sensor].output(&self.scenario.set_names()) {
            Output::Acceleration { place, axis, .. } => vec![modal.weights(&place, axis)],
            Output::OnRing(on) => {
                let unit = |number| {
                    let mut weights = DVector::zeros(modal.rigid_rotation.len());
                    weights[number] = 1.0;
                    weights
                };
                self.terms_of(&on).iter().map(|term| unit(term.coordinate)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// (m/s²) The acceleration of a place by the random forces of all meshes.
    fn moved_by_chance(&self, random: &RandomForces, place: usize) -> Vec<f64> {
        let RandomForces { spectra, length, response, .. } = random;
        let lines = length / 2 + 1;
        let mut sum = vec![Complex64::ZERO; lines];
        for (mesh, spectrum) in spectra.iter().enumerate() {
            let gains = response.at(place, mesh, self.time.sampling_rate_hz / *length as f64, lines);
            for ((sum, gain), line) in sum.iter_mut().zip(gains).zip(spectrum) {
                *sum += gain * line;
            }
        }
        from_real_spectrum(sum, *length)
    }

    /// Number of the sensor of a channel.
    pub(super) fn sensor_number(&self, channel: &Channel) -> Option<usize> {
        self.sensors
            .iter()
            .position(|sensor| matches!(channel, Channel::Sensor(name) if sensor.name() == *name))
    }
}

/// The mean over some samples around each, of what is positive; fewer at the ends.
///
/// # Arguments
/// * `values` - of which
/// * `width` - number of samples
fn averaged(values: &[f64], width: usize) -> Vec<f64> {
    let mut sum = 0.0;
    let until: Vec<f64> = std::iter::once(0.0)
        .chain(values.iter().map(|value| {
            sum += value.max(0.0);
            sum
        }))
        .collect();
    let half = width / 2;
    let mean = |n: usize| {
        let (from, to) = (n.saturating_sub(half), (n + half + 1).min(values.len()));
        (until[to] - until[from]).max(0.0) / (to - from) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// Hands a run's outputs on, and keeps those behind them: the forces of the meshes.
pub(crate) struct WithMeshForces<R> {
    /// Takes the outputs.
    pub(crate) inner: R,
    /// Number of the first force among the outputs.
    first: usize,
    /// (N) Of each mesh.
    pub(crate) mesh_force_n: Vec<Vec<f64>>,
}

impl<R> WithMeshForces<R> {
    /// A recorder for some outputs and forces behind them.
    ///
    /// # Arguments
    /// * `inner` - takes the outputs
    /// * `first` - number of the first force
    /// * `forces` - how many
    pub(crate) fn new(inner: R, first: usize, forces: usize) -> Self {
        Self { inner, first, mesh_force_n: vec![Vec::new(); forces] }
    }
}

impl<R: Recorder> Recorder for WithMeshForces<R> {
    fn record(&mut self, block: &Block) {
        for (n, force_n) in self.mesh_force_n.iter_mut().enumerate() {
            force_n.extend_from_slice(block.output(self.first + n));
        }
        self.inner.record(block);
    }

    fn count(&mut self, counts: StepCounts) {
        self.inner.count(counts);
    }

    fn goes_on(&self) -> bool {
        self.inner.goes_on()
    }
}
