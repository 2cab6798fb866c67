//! The size of a simulation.

use std::collections::BTreeSet;

use super::super::{Fault, Scenario, Sensor, WheelName};
use super::largest_cause;
use super::memory_limit::{MemoryLimit, in_words};
use crate::keys::Check;
use crate::operation::{CycleGrid, TimeGrid, least_common_multiple};

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
/// Numbers that are held for every profile point of a damaged tooth, or of several alike: what is left of it, and its integrals.
const DAMAGED_CHANNELS: f64 = 16.0;
/// Numbers that are tabulated for every point of a class of pairs under `contact`; `linear` has more for fewer points.
const PAIR_CHANNELS: f64 = 3.0;
/// (base pitches) How far a pair is tabulated.
const PAIR_PITCHES: f64 = 3.0;
const BYTES_PER_NUMBER: f64 = 8.0;

impl Scenario {
    /// (S/s) The actual sampling rate: the nominal one, or just above it, so that a whole number of samples passes from one pair of
    /// teeth to the next, and so in a revolution of either shaft. Under the published model `⌈f_nom/(L f_p) + 6⌉ L f_p`, with `L` the
    /// least common multiple of the tooth counts.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// assert_eq!(scenario.actual_sampling_rate_hz(), 100_640.0);
    /// ```
    pub fn actual_sampling_rate_hz(&self) -> f64 {
        self.time_grid().sampling_rate_hz
    }

    /// (bytes) Estimate of the memory that the simulation needs: 8 signals of every kept sample,
    /// those of listed sensors and what filtering them takes, the excitation of every sample, the tables over a gear revolution, the tooth profiles,
    /// damaged teeth and the tables of the pairs that they make, in double precision.
    ///
    /// `u64::MAX` stands for anything above it.
    ///
    /// ```
    /// use meshtone::scenario::{GearPair, Scenario};
    ///
    /// let scenario = Scenario::new(GearPair::example());
    /// assert_eq!(scenario.memory_estimate_bytes() / 1_000_000, 25);
    /// ```
    pub fn memory_estimate_bytes(&self) -> u64 {
        let (time, gears) = (self.time_grid(), self.gears());
        let cycle = CycleGrid::new(gears.pinion_teeth, gears.gear_teeth, time.sampling_rate_hz);
        let filters = |sensor: &Sensor| sensor.resonance_hz.is_some() || sensor.frequency_response.is_some();
        let filtered = if self.sensors.iter().any(filters) { FILTERED_CHANNELS } else { 0.0 };
        let numbers = time.kept_samples() as f64 * (KEPT_CHANNELS + self.sensors.len() as f64 + filtered)
            + time.samples as f64 * EXCITATION_CHANNELS
            + cycle.points_per_gear_revolution as f64 * GRID_CHANNELS
            + 2.0 * gears.points_per_tooth as f64 * PROFILE_CHANNELS
            + self.damaged_kinds().iter().sum::<usize>() as f64
                * gears.points_per_tooth as f64
                * DAMAGED_CHANNELS
            + (self.pair_classes() - 1) as f64 * self.points_per_class(&time) * PAIR_CHANNELS;
        (numbers * BYTES_PER_NUMBER) as u64
    }
}

impl Scenario {
    /// Number of kinds of damaged teeth of the pinion and of the gear: teeth with the same faults are of one, and each tooth that
    /// something is drawn for is of its own.
    fn damaged_kinds(&self) -> [usize; 2] {
        let gears = self.gears();
        WheelName::BOTH.map(|wheel| {
            let mut kinds = BTreeSet::new();
            for tooth in 1..=gears.teeth(wheel) {
                let on_tooth =
                    |(_, fault): &(usize, &Fault)| fault.side() == wheel && fault.tooth.contains(tooth);
                let on_tooth: Vec<(usize, &Fault)> =
                    self.faults.iter().enumerate().filter(on_tooth).collect();
                let is_drawn = on_tooth.iter().any(|(_, fault)| fault.damage.is_drawn());
                if !on_tooth.is_empty() {
                    let numbers: Vec<usize> = on_tooth.into_iter().map(|(number, _)| number).collect();
                    kinds.insert((numbers, is_drawn.then_some(tooth)));
                }
            }
            kinds.len()
        })
    }

    /// Largest number of classes of pairs that they make, that of sound teeth included.
    pub(super) fn pair_classes(&self) -> usize {
        let [pinion, gear] = self.damaged_kinds();
        let gears = self.gears();
        let met = least_common_multiple(gears.pinion_teeth, gears.gear_teeth);
        ((pinion + 1) * (gear + 1)).min(met as usize + 1)
    }

    /// Points of a class's table.
    fn points_per_class(&self, time: &TimeGrid) -> f64 {
        PAIR_PITCHES * time.samples_per_pinion_revolution as f64 / f64::from(self.gears().pinion_teeth)
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
    let mut refused = largest_cause::refuse(scenario, &problem);
    let raise = "raise the memory limit";
    refused.help = Some(refused.help.map_or(raise.to_string(), |help| format!("{help}; or {raise}")));
    Err(refused)
}
