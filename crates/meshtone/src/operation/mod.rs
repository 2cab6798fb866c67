//! How time and the mesh cycle are divided.

mod motion;
mod parameters;
mod rules;
mod settings;

pub use motion::{Motion, MotionSample, TorqueHarmonic};
pub(crate) use parameters::MOST_RIPPLE;
pub use parameters::{Operation, Profile, Ripple};
pub use settings::{LengthKey, Solver};

use std::ops::Rem;

use crate::wheel::Gears;

/// Pinion revolutions that are simulated, settling included, where no length is given: `2 z_g`.
pub(crate) fn nominal_revolutions(gear_teeth: u32) -> u32 {
    2 * gear_teeth
}

/// Division of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeGrid {
    /// (S/s) Actual sampling rate, a whole number of samples per revolution of either wheel.
    pub sampling_rate_hz: f64,
    /// Number of samples, the whole settling included.
    pub samples: usize,
    /// First sample that is simulated: 0, or later where a short settling suffices.
    pub first_simulated_sample: usize,
    /// First sample that is kept.
    pub first_kept_sample: usize,
    /// Number of samples per (nominal) pinion revolution.
    pub samples_per_pinion_revolution: usize,
}

impl TimeGrid {
    /// The division of time for a pair in operation; all values are valid.
    ///
    /// Where the length of the kept signal is not given, `2 z_g` pinion revolutions are simulated, settling included; a profile is kept
    /// from its start to its last value, and settling comes before it.
    ///
    /// # Arguments
    /// * `teeth` - tooth counts of the pinion and of the gear
    /// * `operation` - nominal speed, and the profile that may replace it
    /// * `solver` - length and settling
    /// * `samples_per_pitch` - number of samples from one pair of teeth to the next at the nominal speed
    pub(crate) fn new(
        [pinion_teeth, gear_teeth]: [u32; 2],
        operation: &Operation,
        solver: &Solver,
        samples_per_pitch: usize,
    ) -> Self {
        let speed = operation.pinion_speed_hz;
        let samples_per_pinion_revolution = samples_per_pitch.saturating_mul(pinion_teeth as usize);
        let sampling_rate_hz = samples_per_pinion_revolution as f64 * speed;
        let asked = kept_s(operation, solver, speed).map(|kept_s| kept_s * sampling_rate_hz);
        // As floats, and saturating: a scenario may ask for more than any machine holds, and is then refused.
        let (settling, kept) = match asked {
            Some(kept) => {
                (kept.round() * solver.settle_fraction / (1.0 - solver.settle_fraction), kept.round())
            }
            None => {
                let revolutions = f64::from(nominal_revolutions(gear_teeth));
                let samples = revolutions * samples_per_pinion_revolution as f64;
                let settling = (solver.settle_fraction * samples).round();
                (settling, samples.round() - settling)
            }
        };
        Self::of_samples(sampling_rate_hz, samples_per_pinion_revolution, [settling, kept])
    }

    fn of_samples(
        sampling_rate_hz: f64,
        samples_per_pinion_revolution: usize,
        [settling, kept]: [f64; 2],
    ) -> Self {
        let first_kept_sample = settling.round() as usize;
        Self {
            sampling_rate_hz,
            samples: first_kept_sample.saturating_add(kept.round() as usize),
            first_simulated_sample: 0,
            first_kept_sample,
            samples_per_pinion_revolution,
        }
    }

    /// The division of time of a gearbox: a whole number of samples per revolution of the input, a whole number of revolutions kept.
    ///
    /// # Arguments
    /// * `operation` - nominal speed of the input, and the profile that may replace it
    /// * `solver` - rate, length and settling
    pub(crate) fn of_input(operation: &Operation, solver: &Solver) -> Self {
        const USUAL_S: f64 = 1.0;
        let speed_hz = operation.pinion_speed_hz;
        let samples_per_pinion_revolution = samples_per_pitch(solver.sampling_rate_hz, 1, speed_hz);
        let sampling_rate_hz = samples_per_pinion_revolution as f64 * speed_hz;
        let usual = (USUAL_S * speed_hz).ceil() * samples_per_pinion_revolution as f64;
        let kept = kept_s(operation, solver, speed_hz).map_or(usual, |kept_s| kept_s * sampling_rate_hz);
        let settling = kept * solver.settle_fraction / (1.0 - solver.settle_fraction);
        Self::of_samples(sampling_rate_hz, samples_per_pinion_revolution, [settling, kept])
    }

    /// (s) How long the motion settles before the kept signal, whose time starts at 0.
    pub fn kept_from_s(&self) -> f64 {
        self.first_kept_sample as f64 * self.step_s()
    }

    /// Number of samples that are kept.
    pub fn kept_samples(&self) -> usize {
        self.samples - self.first_kept_sample
    }

    /// Number of samples from one pair of teeth to the next at the nominal speed.
    ///
    /// # Arguments
    /// * `gears` - that the time was divided for
    pub fn samples_per_pitch(&self, gears: &Gears) -> usize {
        self.samples_per_pinion_revolution / gears.pinion_teeth as usize
    }

    /// Number of samples in a hunting-tooth period, after which the same teeth meet again, at the nominal speed.
    ///
    /// # Arguments
    /// * `gears` - that the time was divided for
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair { pinion_teeth: 20, gear_teeth: 40, ..GearPair::example() });
    /// let time = scenario.time_grid();
    /// assert_eq!(time.hunting_period_samples(&scenario.gears()), 2 * time.samples_per_pinion_revolution);
    /// ```
    pub fn hunting_period_samples(&self, gears: &Gears) -> usize {
        let pitches = least_common_multiple(gears.pinion_teeth, gears.gear_teeth) as usize;
        self.samples_per_pitch(gears).saturating_mul(pitches)
    }

    /// (s) Time between two samples.
    pub fn step_s(&self) -> f64 {
        1.0 / self.sampling_rate_hz
    }
}

/// (s) Length of the kept signal: as it is given, or as long as the longer of the profiles; none where neither says.
fn kept_s(operation: &Operation, solver: &Solver, speed_hz: f64) -> Option<f64> {
    let given_s = solver.duration_s.or(solver.pinion_revolutions.map(|revolutions| revolutions / speed_hz));
    given_s.or(operation.profiles_end_s())
}

/// Number of samples from one pair of teeth to the next with which a nominal rate is met or just exceeded.
///
/// # Arguments
/// * `sampling_rate_hz` - (S/s) the nominal rate
/// * `pinion_teeth`, `pinion_speed_hz` - tooth count and (rev/s) nominal speed of the pinion
pub(crate) fn samples_per_pitch(sampling_rate_hz: f64, pinion_teeth: u32, pinion_speed_hz: f64) -> usize {
    // Without the part by which rounding exceeds a whole number.
    (sampling_rate_hz / (f64::from(pinion_teeth) * pinion_speed_hz) * (1.0 - 1e-12)).ceil() as usize
}

/// The same by the rule of the published model, with a multiple of the least common multiple `L` of the tooth counts in a revolution of
/// the pinion: the rate is `⌈f/(L f_p) + 6⌉ L f_p`.
///
/// # Arguments
/// * `sampling_rate_hz` - (S/s) the nominal rate
/// * `teeth` - of the pinion and of the gear
/// * `pinion_speed_hz` - (rev/s) nominal speed
pub(crate) fn samples_per_pitch_of_published(
    sampling_rate_hz: f64,
    teeth: [u32; 2],
    pinion_speed_hz: f64,
) -> usize {
    let multiple = least_common_multiple(teeth[0], teeth[1]);
    let per_multiple = (sampling_rate_hz / (f64::from(multiple) * pinion_speed_hz) + 6.0).ceil();
    (per_multiple as usize).saturating_mul((multiple / teeth[0]) as usize)
}

/// Division of the mesh cycle (one gear revolution), in fractions of a pinion revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleGrid {
    /// (rev) Step of the fine grid, on which the error forces are given.
    pub fine_step_rev: f64,
    /// (rev) Step of the coarse grid, on which the mesh stiffness is given.
    pub coarse_step_rev: f64,
    /// Number of fine points from one tooth to the next.
    pub fine_points_per_pitch: usize,
    /// Number of coarse points from one tooth to the next.
    pub points_per_pitch: usize,
    /// Number of coarse points in a pinion revolution.
    pub points_per_pinion_revolution: usize,
    /// Number of coarse points in a gear revolution.
    pub points_per_gear_revolution: usize,
}

/// Number of fine steps in a coarse one.
pub(crate) const FINE_PER_COARSE: usize = 50;
/// Least number of fine points in a pinion revolution.
const LEAST_FINE_POINTS: f64 = 1e6;

impl CycleGrid {
    /// The division of the cycle: `d_f = 1/(50 L ⌈max(f_s, 1e6)/(50 L)⌉)`, `d_c = 50 d_f`.
    ///
    /// # Arguments
    /// * `pinion_teeth`, `gear_teeth` - tooth counts
    /// * `sampling_rate_hz` - (S/s) the actual sampling rate
    pub fn new(pinion_teeth: u32, gear_teeth: u32, sampling_rate_hz: f64) -> Self {
        let multiple = least_common_multiple(pinion_teeth, gear_teeth) as usize;
        let unit = (FINE_PER_COARSE * multiple) as f64;
        let refinement = (sampling_rate_hz.max(LEAST_FINE_POINTS) / unit).ceil() as usize;
        let per_pinion_revolution = multiple.saturating_mul(refinement);
        let points_per_pitch = per_pinion_revolution / pinion_teeth as usize;
        Self {
            fine_step_rev: 1.0 / (FINE_PER_COARSE as f64 * per_pinion_revolution as f64),
            coarse_step_rev: FINE_PER_COARSE as f64 / (FINE_PER_COARSE as f64 * per_pinion_revolution as f64),
            fine_points_per_pitch: FINE_PER_COARSE * points_per_pitch,
            points_per_pitch,
            points_per_pinion_revolution: per_pinion_revolution,
            points_per_gear_revolution: points_per_pitch.saturating_mul(gear_teeth as usize),
        }
    }

    /// Number of fine points at which a pair that spans `span_rev` is in contact.
    pub fn fine_points_in(&self, span_rev: f64) -> usize {
        (span_rev / self.fine_step_rev * (1.0 + 1e-14)) as usize + 1
    }
}

/// Greatest common divisor of two tooth counts.
///
/// # Arguments
/// * `a`, `b` - the counts, not both 0
///
/// ```
/// assert_eq!(meshtone::operation::greatest_common_divisor(18, 42), 6);
/// ```
pub fn greatest_common_divisor<T: Copy + Default + PartialEq + Rem<Output = T>>(a: T, b: T) -> T {
    if b == T::default() { a } else { greatest_common_divisor(b, a % b) }
}

/// Least common multiple of two tooth counts.
pub(crate) fn least_common_multiple(a: u32, b: u32) -> u32 {
    a / greatest_common_divisor(a, b) * b
}
