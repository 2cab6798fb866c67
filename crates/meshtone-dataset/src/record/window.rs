//! The part of a motion that is simulated for a record.

use meshtone::operation::{TimeGrid, greatest_common_divisor};
use meshtone::scenario::{Fault, Scenario};
use meshtone::sensor::Channel;
use meshtone::signal::{AntiAliasing, SignalError};

use super::{Start, path};
use crate::draw::DrawnRecord;
use crate::plan::Keep;

/// The window of its simulation that a record takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Window {
    /// Where it begins within the hunting-tooth period.
    pub start: Start,
    /// Samples of the simulation before the record's first and after its last, which filters read.
    pub margin: usize,
}

impl Window {
    /// The window of a record. A steady motion is simulated from where the record begins; any other from the start of the scenario's
    /// own kept signal, without a margin.
    ///
    /// # Arguments
    /// * `keep` - what is kept of the record
    /// * `drawn` - the record
    /// * `faults` - of the record
    /// * `scenario` - what is simulated for it
    /// * `time` - its division of time
    pub fn new(
        keep: &Keep,
        drawn: &DrawnRecord,
        faults: &[Fault],
        scenario: &Scenario,
        time: &TimeGrid,
    ) -> Result<Self, SignalError> {
        let gears = &scenario.gears;
        let revolutions = gears.pinion_teeth / greatest_common_divisor(gears.pinion_teeth, gears.gear_teeth);
        let start = if keep.aligned {
            Start::aligned(drawn, gears, revolutions, faults)
        } else {
            Start::new(drawn, gears, revolutions)
        };
        if !scenario.operation.is_steady() {
            // It is counted from the first time that the mark passes.
            return Ok(Self { start: Start { revolution: 0, ..start }, margin: 0 });
        }
        let reach = AntiAliasing::steep(time.sampling_rate_hz, keep.sampling_rate_hz)?.reach();
        let simulated = keep.simulated();
        let is_read =
            |name: String| simulated.iter().any(|channel| *channel == Channel::Sensor(name.clone()));
        let sensors = scenario.sensors.iter().filter(|sensor| is_read(sensor.name()));
        let of_paths = (simulated.iter().filter(|channel| channel.is_acceleration()))
            .map(|channel| path::structure(drawn, &channel.name()).memory_s());
        let memory_s = sensors.map(|sensor| sensor.memory_s()).chain(of_paths).fold(0.0, f64::max);
        let remembered = (memory_s * time.sampling_rate_hz).ceil() as usize;
        // One sample of the record more on either side, as the last one may lie behind the end of its last revolution.
        let step = (time.sampling_rate_hz / keep.sampling_rate_hz).ceil() as usize;
        let margin = reach + step + remembered.min(time.hunting_period_samples(gears));
        Ok(Self { start, margin })
    }

    /// Sample at which the record begins, of those from where the first teeth meet.
    fn first_sample(&self, scenario: &Scenario, time: &TimeGrid) -> usize {
        let passed = self.start.mark_teeth + self.start.revolution * scenario.gears.gear_teeth;
        passed as usize * time.samples_per_pitch(&scenario.gears)
    }
}

/// The scenario that is simulated for a record: no more than the record keeps, with a margin for the filters, after as much settling at
/// least as the scenario of the plan has.
///
/// # Arguments
/// * `keep` - what is kept of the record
/// * `drawn` - the record
/// * `scenario` - of the plan, with the record's values and faults
///
/// # Errors
/// A sampling rate of the record below 1e-5 of the simulation's.
pub(crate) fn simulated_scenario(
    keep: &Keep,
    drawn: &DrawnRecord,
    mut scenario: Scenario,
) -> Result<Scenario, SignalError> {
    let time = scenario.time_grid();
    let window = Window::new(keep, drawn, &scenario.faults, &scenario, &time)?;
    let kept = kept_samples(keep, &scenario, &time);
    let mut first = time.first_kept_sample;
    if scenario.operation.is_steady() {
        let begins = window.first_sample(&scenario, &time);
        let period = time.hunting_period_samples(&scenario.gears).max(1);
        // So many periods later that the settling comes before it.
        first =
            begins + (first + window.margin).saturating_sub(begins).div_ceil(period) * period - window.margin;
    }
    let seconds = |samples: usize| samples as f64 * time.step_s();
    scenario.solver.discard_and_keep(seconds(first), seconds(kept + 2 * window.margin));
    Ok(scenario)
}

/// Samples of the simulation that a record is made of.
fn kept_samples(keep: &Keep, scenario: &Scenario, time: &TimeGrid) -> usize {
    match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => {
            let teeth = scenario.gears.teeth(keep.wheel) as usize;
            angle.revolutions * teeth * time.samples_per_pitch(&scenario.gears)
        }
        (None, Some(duration_s)) => {
            let kept = (duration_s * time.sampling_rate_hz).round() as usize;
            // Of an unsteady motion there is no margin, from which the last sample could be read.
            let last = (time.sampling_rate_hz / keep.sampling_rate_hz).ceil() as usize;
            if scenario.operation.is_steady() { kept } else { kept + last }
        }
        (None, None) => time.kept_samples(),
    }
}
