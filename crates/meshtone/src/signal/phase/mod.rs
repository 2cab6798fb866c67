//! The angle of a shaft at each sample.

mod mesh_tone;
mod mesh_tone_checks;
mod pulse_train;
mod pulses;
mod speed;
mod tachometer;
mod zero;

pub use mesh_tone::MeshTone;
pub use pulse_train::{PulseTrain, repair_pulses};
pub use tachometer::{PulseEdge, Tachometer, tachometer_pulses};
pub use zero::AngleZero;

use super::check::{check_count, check_finite};
use super::{SignalError, SignalWarning};
use crate::scenario::Ratio;

/// Parts of a recording whose speeds are compared, and the ratio of the highest to the lowest one of a run-up.
const PARTS: usize = 16;
const RUN_UP: f64 = 1.1;

/// The angle of a shaft over the samples of a recording, in revolutions, always rising.
///
/// A phase may cover a part of the recording only: pulses say nothing before the first and after the last one.
#[derive(Debug, Clone, PartialEq)]
pub struct ShaftPhase {
    /// Sample of the recording that the first value belongs to.
    pub first_sample: usize,
    /// (rev) Angle at that sample and those after it.
    pub revolutions: Vec<f64>,
    /// Meaning of angle 0.
    pub zero: AngleZero,
    /// Warnings from finding it.
    pub warnings: Vec<SignalWarning>,
}

impl ShaftPhase {
    /// A phase from the angle at each sample.
    ///
    /// # Arguments
    /// * `first_sample` - sample of the recording that the first value belongs to
    /// * `revolutions` - (rev) angle at each sample from that one on
    ///
    /// # Errors
    /// Fewer than two values; a value that is no number, or not more than the one before.
    ///
    /// ```
    /// use meshtone::signal::ShaftPhase;
    ///
    /// let error = ShaftPhase::new(0, vec![0.0, 0.2, 0.1]).unwrap_err();
    /// assert!(error.to_string().contains("turns backwards at sample 2"));
    /// ```
    pub fn new(first_sample: usize, revolutions: Vec<f64>) -> Result<Self, SignalError> {
        let phase = Self { first_sample, revolutions, zero: AngleZero::Given, warnings: Vec::new() };
        phase.check()?;
        Ok(phase)
    }

    /// The phase of the shaft that meshes with this one, forwards too.
    ///
    /// # Arguments
    /// * `teeth` - of the wheel on this shaft
    /// * `mate_teeth` - of the wheel on the other
    ///
    /// # Errors
    /// A wheel without teeth.
    ///
    /// ```
    /// use meshtone::signal::ShaftPhase;
    ///
    /// let pinion = ShaftPhase::constant(40.0, 1000.0, 101)?;
    /// let gear = pinion.of_mate(17, 34)?;
    /// assert!((gear.revolutions[100] - 2.0).abs() < 1e-12);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn of_mate(&self, teeth: u32, mate_teeth: u32) -> Result<Self, SignalError> {
        for (name, count) in [("teeth", teeth), ("mate_teeth", mate_teeth)] {
            if count == 0 {
                return Err(SignalError::parameter(name, 0.0, "at least 1"));
            }
        }
        self.geared(Ratio::ONE.times(i64::from(teeth), i64::from(mate_teeth)))
    }

    /// The phase of a shaft that turns at a ratio of this one's speed.
    pub(super) fn geared(&self, speed_ratio: Ratio) -> Result<Self, SignalError> {
        let ratio = speed_ratio.value();
        let revolutions = self.revolutions.iter().map(|angle| angle * ratio).collect();
        let mut other = Self::new(self.first_sample, revolutions)?;
        other.warnings.clone_from(&self.warnings);
        other.zero = self.zero.of_mate();
        Ok(other)
    }

    /// The phase of a part of the recording, as of `signal[100..900]`.
    ///
    /// # Arguments
    /// * `samples` - of the recording: from the first one of the part to before its end
    ///
    /// # Errors
    /// Fewer than two samples of the part have a phase.
    ///
    /// ```
    /// let phase = meshtone::signal::ShaftPhase::new(10, vec![0.0, 0.25, 0.75, 1.0])?;
    /// let part = phase.part(11..13)?;
    /// assert_eq!((part.first_sample, part.revolutions), (0, vec![0.25, 0.75]));
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn part(&self, samples: std::ops::Range<usize>) -> Result<Self, SignalError> {
        let known = |sample: usize| sample.saturating_sub(self.first_sample).min(self.revolutions.len());
        let (from, to) = (known(samples.start), known(samples.end));
        let revolutions = self.revolutions.get(from..to).unwrap_or_default().to_vec();
        let part = Self::new(self.first_sample.saturating_sub(samples.start), revolutions)?;
        Ok(part.with_zero(self.zero).with_warnings(self.warnings.clone()))
    }

    /// (rev) What the shaft turns between the first and the last value.
    pub fn span_rev(&self) -> f64 {
        self.revolutions.first().map_or(0.0, |first| self.last() - first)
    }

    /// (Hz) Mean speed.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) of the recording
    pub fn mean_speed_hz(&self, sampling_rate_hz: f64) -> f64 {
        self.span_rev() * sampling_rate_hz / self.revolutions.len().saturating_sub(1).max(1) as f64
    }

    /// (Hz) The lowest and the highest mean speed of equal parts of the angle.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) of the recording
    /// * `parts` - how many
    ///
    /// ```
    /// let phase = meshtone::signal::ShaftPhase::from_speed_profile(&[0.0, 1.0], &[10.0, 20.0], 1e4, 10_001)?;
    /// let [lowest, highest] = phase.speed_range_hz(1e4, 10);
    /// assert!((10.0..11.5).contains(&lowest) && (19.0..20.0).contains(&highest));
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn speed_range_hz(&self, sampling_rate_hz: f64, parts: usize) -> [f64; 2] {
        let each = self.span_rev() / parts.max(1) as f64;
        let first = self.revolutions.first().copied().unwrap_or(0.0);
        let at = |part: usize| self.sample_at(first + each * part as f64);
        let speeds = (0..parts.max(1)).map(|part| each * sampling_rate_hz / (at(part + 1) - at(part)));
        speeds.fold([f64::INFINITY, 0.0], |[low, high], speed| [low.min(speed), high.max(speed)])
    }

    /// Returns whether the highest speed is at least a tenth above the lowest one, so that resonances pass over orders: a run-up, a
    /// coast-down, or a speed that fluctuates as much.
    ///
    /// # Arguments
    /// * `sampling_rate_hz` - (S/s) of the recording
    pub fn is_run_up(&self, sampling_rate_hz: f64) -> bool {
        let [lowest_hz, highest_hz] = self.speed_range_hz(sampling_rate_hz, PARTS);
        highest_hz >= RUN_UP * lowest_hz
    }

    /// Place of an angle between the samples of the recording; at the first or last one where the shaft did not turn so far.
    ///
    /// # Arguments
    /// * `angle_rev` - (rev) the angle
    ///
    /// ```
    /// let phase = meshtone::signal::ShaftPhase::new(10, vec![0.0, 0.25, 0.75])?;
    /// assert_eq!(phase.sample_at(0.5), 11.5);
    /// # Ok::<(), meshtone::signal::SignalError>(())
    /// ```
    pub fn sample_at(&self, angle_rev: f64) -> f64 {
        let reached = self.revolutions.partition_point(|angle| *angle <= angle_rev);
        let between = match (
            reached.checked_sub(1).map(|before| self.revolutions[before]),
            self.revolutions.get(reached),
        ) {
            (Some(from), Some(to)) => reached as f64 - 1.0 + (angle_rev - from) / (to - from),
            (None, _) => 0.0,
            (Some(_), None) => reached as f64 - 1.0,
        };
        self.first_sample as f64 + between
    }

    pub(super) fn last(&self) -> f64 {
        self.revolutions.last().copied().unwrap_or(0.0)
    }

    /// Checks that the shaft turns forwards: the fields are open to everyone.
    pub(super) fn check(&self) -> Result<(), SignalError> {
        let revolutions = &self.revolutions;
        check_count("samples with a phase", revolutions.len(), 2)?;
        check_finite(revolutions)?;
        // All of them first, many at a time: hardly any phase has to be searched.
        if revolutions.windows(2).fold(true, |rising, pair| rising & (pair[1] > pair[0])) {
            return Ok(());
        }
        match revolutions.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(()),
            Some(i) => Err(SignalError::NotForwards {
                sample: self.first_sample.saturating_add(i + 1),
                from_rev: revolutions[i],
                to_rev: revolutions[i + 1],
            }),
        }
    }

    /// The phase with a known angle 0.
    ///
    /// # Arguments
    /// * `zero` - what it is
    #[must_use]
    pub fn with_zero(mut self, zero: AngleZero) -> Self {
        self.zero = zero;
        self
    }

    pub(super) fn with_warnings(mut self, warnings: Vec<SignalWarning>) -> Self {
        self.warnings = warnings;
        self
    }
}
