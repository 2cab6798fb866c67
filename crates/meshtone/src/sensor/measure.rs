//! The signal that a sensor makes of the motion of its place.
//!
//! In this order: the path and the mounted resonance, noise, range, resolution.

use std::f64::consts::TAU;

use meshtone_fourier::{Complex64, from_real_spectrum, real_spectrum, shared_length};

use super::parameters::{ResponseInput, Sensor};
use super::{FrequencyResponse, GRAVITY_M_PER_S2};
use crate::random::{Draws, Purpose};

/// The conditions on which the signal of a sensor depends, besides the sensor and the motion of its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measurement {
    /// (S/s) Sampling rate.
    pub sampling_rate_hz: f64,
    /// Whether the signal repeats itself after its last sample. What does not is taken to start at rest, and what a filter
    /// leaves of its end is cut off.
    pub is_periodic: bool,
    /// Seed of the noise, unless the sensor has its own.
    pub seed: u64,
    /// Number of the sensor in the scenario, from 0: each has its own noise.
    pub index: usize,
}

/// The signal that a sensor shows.
///
/// # Arguments
/// * `raw` - (g) acceleration of its place, or (N) force along the line of action where that goes through its frequency response
/// * `sensor` - what it is
/// * `measurement` - what else it depends on
///
/// # Returns
/// (g) As many samples.
///
/// ```
/// use meshtone::scenario::Sensor;
/// use meshtone::sensor::{Measurement, measure};
///
/// let mut coarse = Sensor::default();
/// coarse.path = meshtone::scenario::SensorPath::RIGID;
/// (coarse.range_g, coarse.bits) = (Some(2.0), Some(8));
/// let measurement = Measurement { sampling_rate_hz: 1e4, is_periodic: true, seed: 1, index: 0 };
/// assert_eq!(measure(vec![0.02, -3.0], &coarse, &measurement), [0.015625, -2.0]);
/// ```
pub fn measure(raw: Vec<f64>, sensor: &Sensor, measurement: &Measurement) -> Vec<f64> {
    let mut signal = passed(raw, sensor, measurement);
    add_noise(&mut signal, sensor, measurement);
    if let Some(range_g) = sensor.range_g {
        signal.iter_mut().for_each(|value| *value = value.clamp(-range_g, range_g));
        if let Some(bits) = sensor.bits {
            let step_g = 2.0 * range_g / f64::from(bits).exp2();
            signal.iter_mut().for_each(|value| *value = (*value / step_g).round() * step_g);
        }
    }
    signal
}

/// (g) The signal behind the path and the mounted resonance: one product in the spectrum.
fn passed(raw: Vec<f64>, sensor: &Sensor, measurement: &Measurement) -> Vec<f64> {
    if !sensor.filters() || raw.is_empty() {
        return raw;
    }
    let samples = raw.len();
    let mut padded = raw;
    if !measurement.is_periodic {
        // Twice as long: neither what a filter leaves of the end comes back at the start, nor what a measured phase makes
        // of the start at the end.
        padded.resize(shared_length(2 * samples), 0.0);
    }
    let length = padded.len();
    let mut spectrum = real_spectrum(&padded);
    let step_hz = measurement.sampling_rate_hz / length as f64;
    let gains = sensor.gains(step_hz, spectrum.len());
    spectrum.iter_mut().zip(gains).for_each(|(line, gain)| *line *= gain);
    let mut signal = from_real_spectrum(spectrum, length);
    signal.truncate(samples);
    signal.shrink_to_fit();
    signal
}

/// (-) What a sensor may remember of its past: a filter's answer to what was before has fallen to this.
pub(super) const REMEMBERED: f64 = 1e-6;

impl Sensor {
    /// Whether the path to the sensor or its mounted resonance changes the motion of its place.
    pub(crate) fn filters(&self) -> bool {
        self.frequency_response.is_some() || self.resonance_hz.is_some() || !self.path.is_rigid()
    }

    /// Whether what the sensor shows is a linear function of the motion of its place: it has neither noise nor a range.
    ///
    /// ```
    /// assert!(meshtone::scenario::Sensor::default().is_linear());
    /// ```
    pub fn is_linear(&self) -> bool {
        self.noise_density_g_per_rthz == 0.0 && self.range_g.is_none()
    }

    /// Complex gains of the path to the sensor, measured and modelled, and of its mounted resonance, at equally spaced frequencies from 0 on.
    ///
    /// # Arguments
    /// * `step_hz` - (Hz) from one frequency to the next
    /// * `count` - how many
    ///
    /// # Returns
    /// (-, or g/N where the response is to the mesh force) As many gains.
    ///
    /// ```
    /// let mut sensor = meshtone::scenario::Sensor::default();
    /// sensor.path = meshtone::scenario::SensorPath::RIGID;
    /// sensor.resonance_hz = Some(100.0);
    /// sensor.resonance_damping_ratio = 0.05;
    /// let gains = sensor.gains(50.0, 3);
    /// assert!((gains[0].norm() - 1.0).abs() < 1e-12 && (gains[2].norm() - 10.0).abs() < 1e-12);
    /// ```
    pub fn gains(&self, step_hz: f64, count: usize) -> Vec<Complex64> {
        let frequencies_hz = || (0..count).map(|line| line as f64 * step_hz);
        let mut gains = match &self.frequency_response {
            Some(response) => response.at(frequencies_hz()),
            None => vec![Complex64::ONE; count],
        };
        if self.frequency_response.is_some() && self.response_input == ResponseInput::Force {
            gains.iter_mut().for_each(|gain| *gain /= GRAVITY_M_PER_S2);
        }
        if !self.path.is_rigid() {
            let path = self.path.at(frequencies_hz());
            gains.iter_mut().zip(path).for_each(|(gain, path)| *gain *= path);
        }
        if let Some(resonance_hz) = self.resonance_hz {
            let damping_ratio = self.resonance_damping_ratio;
            let lines = gains.iter_mut().zip(frequencies_hz());
            lines.for_each(|(gain, hz)| *gain *= mounted_resonance(hz / resonance_hz, damping_ratio));
        }
        gains
    }

    /// (s) How long what the sensor shows depends on what was before: until 1e-6 is left of an oscillation at its resonance or of the
    /// path's, and as long as the finest step of its frequency response resolves.
    pub fn memory_s(&self) -> f64 {
        let decay_s = |resonance_hz: f64| {
            // An overdamped resonance has a slower part.
            let damping_ratio = self.resonance_damping_ratio;
            let slow = damping_ratio - (damping_ratio * damping_ratio - 1.0).max(0.0).sqrt();
            -REMEMBERED.ln() / (TAU * resonance_hz * slow)
        };
        let resolved_s = |response: &FrequencyResponse| {
            let steps = response.frequency_hz.windows(2).map(|pair| pair[1] - pair[0]);
            1.0 / steps.fold(f64::INFINITY, f64::min)
        };
        let measured_s = self.frequency_response.as_ref().map_or(0.0, resolved_s);
        self.resonance_hz.map_or(0.0, decay_s).max(measured_s).max(self.path.memory_s())
    }
}

/// Complex gain of a sensor on its mount for a sine: `H = ω₀²/(ω₀² − ω² + 2iζω₀ω)`.
///
/// # Arguments
/// * `ratio` - (-) the sine's frequency over the natural one
/// * `damping_ratio` - (-) damping over the critical one
fn mounted_resonance(ratio: f64, damping_ratio: f64) -> Complex64 {
    Complex64::new(1.0 - ratio * ratio, 2.0 * damping_ratio * ratio).inv()
}

/// Adds white, normal noise of the sensor's density, up to half of the sampling rate.
fn add_noise(signal: &mut [f64], sensor: &Sensor, measurement: &Measurement) {
    let density = sensor.noise_density_g_per_rthz;
    if density == 0.0 {
        return;
    }
    let deviation_g = density * (measurement.sampling_rate_hz / 2.0).sqrt();
    let seed = sensor.noise_seed.unwrap_or(measurement.seed);
    let mut draws = Draws::new(seed, Purpose::SensorNoise, measurement.index as u64);
    for pair in signal.chunks_mut(2) {
        pair.iter_mut().zip(draws.normals()).for_each(|(value, normal)| *value += deviation_g * normal);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorPath;

    /// A sensor on the support's mass itself.
    fn rigid() -> Sensor {
        Sensor { path: SensorPath::RIGID, ..Sensor::default() }
    }

    const MEASUREMENT: Measurement =
        Measurement { sampling_rate_hz: 1000.0, is_periodic: true, seed: 3, index: 0 };

    fn sine(turns: usize, samples: usize, lead_rad: f64) -> Vec<f64> {
        let step = TAU * turns as f64 / samples as f64;
        (0..samples).map(|n| (step * n as f64 + lead_rad).sin()).collect()
    }

    fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    fn response(points: &[[f64; 3]]) -> Sensor {
        let column = |n: usize| points.iter().map(|point| point[n]).collect();
        let frequency_response =
            Some(FrequencyResponse { frequency_hz: column(0), magnitude: column(1), phase_deg: column(2) });
        Sensor { frequency_response, ..rigid() }
    }

    /// At its natural frequency a resonance is `1/(2ζ)` times as large, a quarter of a turn late; well below it is the sine.
    #[test]
    fn resonance_is_the_closed_form_on_a_sine() {
        let (samples, damping_ratio) = (1000, 0.05);
        let sensor = Sensor { resonance_hz: Some(200.0), resonance_damping_ratio: damping_ratio, ..rigid() };
        for turns in [20, 100, 200, 300] {
            let ratio = turns as f64 / 200.0;
            let gain = 1.0 / ((1.0 - ratio * ratio).powi(2) + (2.0 * damping_ratio * ratio).powi(2)).sqrt();
            let lag_rad = (2.0 * damping_ratio * ratio).atan2(1.0 - ratio * ratio);
            let expected: Vec<f64> =
                sine(turns, samples, -lag_rad).into_iter().map(|value| gain * value).collect();
            let measured = measure(sine(turns, samples, 0.0), &sensor, &MEASUREMENT);
            assert!(largest_difference(&measured, &expected) < 1e-11 * gain.max(1.0), "{turns}");
        }
    }

    /// A resonance that starts at rest answers a hit by its impulse response.
    #[test]
    fn resonance_starts_at_rest_where_nothing_is_periodic() {
        let (rate, hz, damping_ratio) = (1e6, 2000.0, 0.05);
        let sensor = Sensor { resonance_hz: Some(hz), resonance_damping_ratio: damping_ratio, ..rigid() };
        let mut hit = vec![0.0; 20_000];
        hit[100] = rate;
        let measurement = Measurement { sampling_rate_hz: rate, is_periodic: false, seed: 1, index: 0 };
        let measured = measure(hit, &sensor, &measurement);
        let w0 = TAU * hz;
        let wd = w0 * (1.0 - damping_ratio * damping_ratio).sqrt();
        let expected: Vec<f64> =
            (0..20_000)
                .map(|n| (f64::from(n) - 100.0) / rate)
                .map(|t| {
                    if t < 0.0 {
                        0.0
                    } else {
                        w0 * w0 / wd * (-damping_ratio * w0 * t).exp() * (wd * t).sin()
                    }
                })
                .collect();
        // The spectrum ends at half the rate, where the response is 1.6e-5 of a hit's: a ripple of that share of w0.
        assert!(largest_difference(&measured, &expected) < 2e-2 * w0);
    }

    #[test]
    fn response_of_one_changes_nothing() {
        let all = response(&[[0.0, 1.0, 0.0], [500.0, 1.0, 0.0]]);
        for samples in [1000, 997] {
            let signal: Vec<f64> = (0..samples).map(|n| f64::from(n * n % 101) - 50.0).collect();
            for is_periodic in [true, false] {
                let measured = measure(signal.clone(), &all, &Measurement { is_periodic, ..MEASUREMENT });
                assert!(largest_difference(&measured, &signal) < 1e-12 * 50.0);
            }
        }
    }

    /// A phase of `−360° f τ` is a delay, however it is wrapped; outside the measured frequencies nothing passes.
    #[test]
    fn linear_phase_delays() {
        let (samples, delay) = (1000, 7);
        let wrapped = |hz: f64| (-360.0 * hz * delay as f64 / 1000.0 + 180.0).rem_euclid(360.0) - 180.0;
        let points: Vec<[f64; 3]> =
            (0..=20).map(|n| f64::from(n) * 20.0).map(|hz| [hz, 0.5, wrapped(hz)]).collect();
        let sensor = response(&points);
        let signal: Vec<f64> =
            sine(30, samples, 0.2).iter().zip(sine(390, samples, 0.0)).map(|(a, b)| a + b).collect();
        let beyond = sine(401, samples, 0.0);
        let sum = signal.iter().zip(&beyond).map(|(a, b)| a + b).collect();
        let measured = measure(sum, &sensor, &MEASUREMENT);
        let expected: Vec<f64> =
            (0..samples).map(|n| 0.5 * signal[(n + samples - delay) % samples]).collect();
        assert!(largest_difference(&measured, &expected) < 1e-11);
    }

    #[test]
    fn flat_response_to_force_is_the_force_over_g() {
        let mut sensor = response(&[[0.0, 1.0, 0.0], [500.0, 1.0, 0.0]]);
        sensor.response_input = ResponseInput::Force;
        let force = sine(10, 500, 0.0);
        let expected: Vec<f64> = force.iter().map(|force| force / 9.81).collect();
        assert!(largest_difference(&measure(force, &sensor, &MEASUREMENT), &expected) < 1e-12);
    }

    #[test]
    fn noise_has_its_density_and_its_own_draws() {
        let samples = 200_001;
        let sensor = Sensor { noise_density_g_per_rthz: 1e-3, ..rigid() };
        let noise = |sensor: &Sensor, index| {
            measure(vec![0.0; samples], sensor, &Measurement { index, ..MEASUREMENT })
        };
        let first = noise(&sensor, 0);
        let mean_square = first.iter().map(|value| value * value).sum::<f64>() / samples as f64;
        let expected = 1e-6 * 500.0;
        // The mean square of n normal numbers scatters by √(2/n) = 0.3 %.
        assert!((mean_square / expected - 1.0).abs() < 0.015, "{mean_square}");
        let second = noise(&sensor, 1);
        let product = first.iter().zip(&second).map(|(a, b)| a * b).sum::<f64>() / samples as f64;
        assert!(product.abs() < 5.0 * expected / (samples as f64).sqrt());
        assert_eq!(noise(&Sensor { noise_seed: Some(3), ..sensor.clone() }, 0), first);
        assert_ne!(noise(&Sensor { noise_seed: Some(4), ..sensor }, 0), first);
    }

    #[test]
    fn range_and_resolution_are_exact() {
        let sensor = Sensor { range_g: Some(4.0), ..rigid() };
        let signal = || vec![4.5, 4.0, 0.1, -3.99, -1e9, 0.015_624, 0.015_626];
        assert_eq!(
            measure(signal(), &sensor, &MEASUREMENT),
            [4.0, 4.0, 0.1, -3.99, -4.0, 0.015_624, 0.015_626]
        );
        // A step is 8/256 = 1/32.
        let sensor = Sensor { bits: Some(8), ..sensor };
        assert_eq!(
            measure(signal(), &sensor, &MEASUREMENT),
            [4.0, 4.0, 3.0 / 32.0, -4.0, -4.0, 0.0, 1.0 / 32.0]
        );
    }

    #[test]
    fn sensor_without_anything_shows_the_motion_bit_by_bit() {
        let signal = sine(3, 100, 0.1);
        assert_eq!(measure(signal.clone(), &rigid(), &MEASUREMENT), signal);
    }
}
