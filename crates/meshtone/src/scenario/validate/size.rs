//! How large a simulation is.

use super::super::{Scenario, Sensor};
use super::largest_cause;
use super::memory_limit::{MemoryLimit, in_words};
use crate::keys::Check;
use crate::operation::CycleGrid;

/// Signals that are kept of every sample after settling.
const KEPT_CHANNELS: f64 = 8.0;
/// Numbers that are held for every kept sample of a sensor, beside its signal while it is filtered: what it is padded to, twice
/// as long, its spectrum, the response, the transform's plan and workspace.
const FILTERED_CHANNELS: f64 = 14.0;
/// Numbers that are held for every simulated sample: motor angle and brake torque.
const EXCITATION_CHANNELS: f64 = 2.0;
/// Numbers that are tabulated for every point of the coarse grid over a gear revolution.
const GRID_CHANNELS: f64 = 16.0;
/// Numbers that are held for every profile point of either wheel.
const PROFILE_CHANNELS: f64 = 64.0;
const BYTES_PER_NUMBER: f64 = 8.0;

impl Scenario {
    /// (S/s) The actual sampling rate `⌈f_nom/(L f_p) + 6⌉ L f_p`, with `L` the least common
    /// multiple of the tooth counts: a whole number of samples for each revolution of either shaft
    /// and each tooth.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair { module_mm: 3.0, pinion_teeth: 17, gear_teeth: 38, face_width_mm: 15.0, pinion_speed_hz: 40.0, brake_torque_nm: 10.0 });
    /// assert_eq!(scenario.actual_sampling_rate_hz(), 258_400.0);
    /// ```
    pub fn actual_sampling_rate_hz(&self) -> f64 {
        self.time_grid().sampling_rate_hz
    }

    /// (bytes) Estimate of the memory that the simulation needs: 8 signals of every kept sample,
    /// those of listed sensors and what filtering them takes, the excitation of every sample, the tables over a gear revolution and the tooth profiles,
    /// in double precision.
    ///
    /// `u64::MAX` stands for anything above it.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair { module_mm: 3.0, pinion_teeth: 17, gear_teeth: 38, face_width_mm: 15.0, pinion_speed_hz: 40.0, brake_torque_nm: 10.0 });
    /// assert_eq!(scenario.memory_estimate_bytes() / 1_000_000, 39);
    /// ```
    pub fn memory_estimate_bytes(&self) -> u64 {
        let time = self.time_grid();
        let cycle = CycleGrid::new(self.gears.pinion_teeth, self.gears.gear_teeth, time.sampling_rate_hz);
        let filters = |sensor: &Sensor| sensor.resonance_hz.is_some() || sensor.frequency_response.is_some();
        let filtered = if self.sensors.iter().any(filters) { FILTERED_CHANNELS } else { 0.0 };
        let numbers = time.kept_samples() as f64 * (KEPT_CHANNELS + self.sensors.len() as f64 + filtered)
            + time.samples as f64 * EXCITATION_CHANNELS
            + cycle.points_per_gear_revolution as f64 * GRID_CHANNELS
            + 2.0 * self.gears.points_per_tooth as f64 * PROFILE_CHANNELS;
        (numbers * BYTES_PER_NUMBER) as u64
    }
}

pub(super) fn check(scenario: &Scenario, limit: MemoryLimit) -> Check {
    let needed = scenario.memory_estimate_bytes();
    if needed <= limit.bytes() {
        return Ok(());
    }
    let (needed, allowed) = (in_words(needed), limit.allows());
    let actual = scenario.actual_sampling_rate_hz();
    let problem = format!(
        "the simulation would need {needed} of memory at its actual sampling rate of {actual:.4e} S/s; {allowed}"
    );
    Err(largest_cause::refuse(scenario, &problem))
}
