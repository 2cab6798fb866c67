//! The motion of motor and brake, sample by sample.

use std::f64::consts::TAU;

use super::{Operation, Profile, TimeGrid};
use crate::random::{Draws, Purpose};

/// The motor's angle and speed and the brake's torque at successive samples: an iterator without end.
pub struct Motion<'a> {
    operation: &'a Operation,
    step_s: f64,
    samples_per_revolution: f64,
    /// At which the profiles start.
    first_kept_sample: f64,
    sample: usize,
    revolutions: f64,
    speed_hz: f64,
    speed_draws: Option<Draws>,
    torque_draws: Option<Draws>,
    /// (-) What the speed's wander adds to it, as a part of it; none where it does not wander.
    wander: Option<Profile>,
    ripple: Vec<TorqueHarmonic>,
}

/// A harmonic of the brake's torque.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueHarmonic {
    /// (-) How often it comes in a revolution of the motor.
    pub order: f64,
    /// (-) Its amplitude as a part of the torque.
    pub amplitude: f64,
    /// (rad) Its phase at the start.
    pub phase_rad: f64,
}

/// Motor and brake at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotionSample {
    /// (rev) Revolutions of the motor since the start.
    pub revolutions: f64,
    /// (Hz) Speed of the motor.
    pub speed_hz: f64,
    /// (N m) Torque of the brake.
    pub torque_nm: f64,
}

impl<'a> Motion<'a> {
    /// Motion from the start of the simulation.
    ///
    /// # Arguments
    /// * `operation` - speed, load, their profiles and fluctuations
    /// * `seed` - of the fluctuations
    /// * `time` - division of time
    pub fn new(operation: &'a Operation, seed: u64, time: &TimeGrid) -> Self {
        let draws = |half_width: f64, purpose| (half_width > 0.0).then(|| Draws::new(seed, purpose, 0));
        let mut motion = Self {
            operation,
            step_s: time.step_s(),
            samples_per_revolution: time.samples_per_pinion_revolution as f64,
            first_kept_sample: time.first_kept_sample as f64,
            sample: 0,
            revolutions: 0.0,
            speed_hz: 0.0,
            speed_draws: draws(operation.speed_fluctuation_hz, Purpose::SpeedFluctuation),
            torque_draws: draws(operation.torque_fluctuation_nm, Purpose::TorqueFluctuation),
            wander: wander(1e-2 * operation.speed_wander_percent, seed, time),
            ripple: Vec::new(),
        };
        motion.speed_hz = motion.draw_speed();
        motion
    }

    /// The motion from a later sample on; nothing fluctuates from sample to sample.
    ///
    /// # Arguments
    /// * `sample` - its number
    /// * `revolutions` - (rev) revolutions of the motor up to it
    pub(crate) fn resumed_at(mut self, sample: usize, revolutions: f64) -> Self {
        (self.sample, self.revolutions) = (sample, revolutions);
        self.speed_hz = self.draw_speed();
        self
    }

    /// The motion with harmonics of the torque.
    ///
    /// # Arguments
    /// * `ripple` - the harmonics
    pub fn with_ripple(self, ripple: Vec<TorqueHarmonic>) -> Self {
        Self { ripple, ..self }
    }

    /// The motion from a later sample on, which is known only where the speed is constant.
    ///
    /// # Arguments
    /// * `sample` - number of the sample
    pub(crate) fn starting_at(mut self, sample: usize) -> Self {
        if self.is_steady() {
            (self.sample, self.revolutions) = (sample, sample as f64 / self.samples_per_revolution);
        }
        self
    }

    fn draw_speed(&mut self) -> f64 {
        let operation = self.operation;
        let nominal = self.at_sample(operation.speed_profile_hz.as_ref(), operation.pinion_speed_hz);
        // A factor of exactly 1 without wander.
        let wandering = nominal * (1.0 + self.at_sample(self.wander.as_ref(), 0.0));
        wandering + fluctuation(&mut self.speed_draws, operation.speed_fluctuation_hz)
    }

    fn draw_torque(&mut self) -> f64 {
        let operation = self.operation;
        let nominal = self.at_sample(operation.torque_profile_nm.as_ref(), operation.brake_torque_nm);
        let torque_nm = nominal + fluctuation(&mut self.torque_draws, operation.torque_fluctuation_nm);
        let wave =
            |of: &TorqueHarmonic| of.amplitude * (TAU * of.order * self.revolutions + of.phase_rad).cos();
        // A factor of exactly 1 without harmonics.
        torque_nm * (1.0 + self.ripple.iter().map(wave).sum::<f64>())
    }

    /// Goes on to the next sample.
    fn advance(&mut self) {
        let speed_hz = self.speed_hz;
        self.sample += 1;
        self.speed_hz = self.draw_speed();
        self.revolutions = if self.is_steady() {
            self.sample as f64 / self.samples_per_revolution
        } else {
            self.revolutions + 0.5 * (speed_hz + self.speed_hz) * self.step_s
        };
    }

    /// The profile at the present sample, or the constant where there is none. Its time 0 is where the kept signal starts.
    fn at_sample(&self, profile: Option<&Profile>, constant: f64) -> f64 {
        profile.map_or(constant, |profile| {
            profile.at((self.sample as f64 - self.first_kept_sample) * self.step_s)
        })
    }

    /// Returns whether the motor's speed is constant.
    pub(crate) fn is_steady(&self) -> bool {
        self.operation.turns_evenly()
    }

    /// Returns whether the brake's torque is constant.
    pub(crate) fn has_constant_torque(&self) -> bool {
        self.torque_draws.is_none() && self.operation.torque_profile_nm.is_none() && self.ripple.is_empty()
    }
}

impl Iterator for Motion<'_> {
    type Item = MotionSample;

    fn next(&mut self) -> Option<MotionSample> {
        let here = MotionSample {
            revolutions: self.revolutions,
            speed_hz: self.speed_hz,
            torque_nm: self.draw_torque(),
        };
        self.advance();
        Some(here)
    }

    /// What is skipped needs no harmonics of the torque.
    fn nth(&mut self, skipped: usize) -> Option<MotionSample> {
        for _ in 0..skipped {
            fluctuation(&mut self.torque_draws, self.operation.torque_fluctuation_nm);
            self.advance();
        }
        self.next()
    }
}

/// (1/s) Points of the wander, between which it is straight: it has next to nothing above half as many hertz.
const WANDER_POINTS_PER_S: f64 = 16.0;
/// (Hz) Corner of the wander's spectrum.
const WANDER_CORNER_HZ: f64 = 1.0;

/// (-) The wander of the speed over the kept time: a Gaussian process of first order, which a longer simulation goes on with.
///
/// # Arguments
/// * `deviation` - (-) its standard deviation
/// * `seed` - of its draws
/// * `time` - division of time
fn wander(deviation: f64, seed: u64, time: &TimeGrid) -> Option<Profile> {
    let mut draws = (deviation > 0.0).then(|| Draws::new(seed, Purpose::SpeedWander, 0))?;
    let kept = (time.kept_samples() as f64 * time.step_s() * WANDER_POINTS_PER_S).ceil() as usize + 2;
    let kept_part = (-TAU * WANDER_CORNER_HZ / WANDER_POINTS_PER_S).exp();
    let new_part = (1.0 - kept_part * kept_part).sqrt();
    // Between points the straight line varies less than they do: by (2 + a)/3 on average over a cell, where neighbours have the correlation a.
    let scale = deviation / ((2.0 + kept_part) / 3.0).sqrt();
    let first = draws.normal();
    let value = std::iter::successors(Some(first), |last| Some(kept_part * last + new_part * draws.normal()));
    let value: Vec<f64> = value.take(kept).map(|value| scale * value).collect();
    Some(Profile { time_s: (0..kept).map(|n| n as f64 / WANDER_POINTS_PER_S).collect(), value })
}

/// The next draw, evenly from within ± `half_width`; 0 where nothing fluctuates.
fn fluctuation(draws: &mut Option<Draws>, half_width: f64) -> f64 {
    draws.as_mut().map_or(0.0, |draws| draws.uniform(0.0, half_width))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{GearPair, Scenario};

    /// With draws for each sample, a wander and harmonics: all that later samples depend on.
    #[test]
    fn what_is_skipped_is_passed() {
        let mut scenario = Scenario::new(GearPair::example());
        let operation = &mut scenario.operation;
        (operation.speed_fluctuation_hz, operation.torque_fluctuation_nm) = (0.5, 2.0);
        operation.speed_wander_percent = 1.0;
        let time = scenario.time_grid();
        let ripple = vec![TorqueHarmonic { order: 3.0, amplitude: 0.2, phase_rad: 1.0 }];
        let motion = || Motion::new(&scenario.operation, 7, &time).with_ripple(ripple.clone());
        let all: Vec<MotionSample> = motion().take(120).collect();
        assert_eq!(motion().skip(100).take(20).collect::<Vec<_>>(), all[100..]);
        assert_eq!(motion().step_by(7).take(10).last(), Some(all[63]));
    }
}
