//! The part of a motion that is simulated for a record.

use std::error::Error;

use meshtone::operation::TimeGrid;
use meshtone::scenario::Scenario;
use meshtone::sensor::Channel;
use meshtone::signal::{AntiAliasing, SignalError};

use super::{Turning, path, start};
use crate::draw::DrawnRecord;
use crate::plan::Keep;

/// (samples) How far a whole number of samples may come out beside it.
const ROUNDING: f64 = 1e-6;

/// The window of its simulation that a record takes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Window {
    /// How the wheels turn.
    pub turning: Turning,
    /// (pitches) What has passed each wheel where its teeth begin to be counted.
    pub counted_from: Vec<i64>,
    /// Samples of the simulation before the record's first and after its last, which filters read.
    pub margin: usize,
}

/// The scenario that is simulated for a record, and the record's window of it: no more than the record keeps, with a margin for the
/// filters, after as much settling at least as the scenario of the plan has.
///
/// A steady motion is simulated from where the record begins; any other from the start of the scenario's own kept signal, without a margin.
///
/// # Arguments
/// * `keep` - what is kept of the record
/// * `drawn` - the record
/// * `scenario` - of the plan, with the record's values and faults
///
/// # Errors
/// A sampling rate of the record below 1e-5 of the simulation's; a gearbox that cannot turn.
pub(crate) fn simulated_scenario(
    keep: &Keep,
    drawn: &DrawnRecord,
    mut scenario: Scenario,
) -> Result<(Scenario, Window), Box<dyn Error>> {
    let (time, is_steady) = (scenario.time_grid(), scenario.operation.is_steady());
    let turning = Turning::of(&scenario)?;
    let per_revolution = time.samples_per_pinion_revolution as f64;
    let start = start::start(keep, drawn, &scenario.placed_faults(), &turning, is_steady);
    let margin = if is_steady { margin(keep, drawn, &scenario, &turning, &time)? } else { 0 };
    let mut first = time.first_kept_sample;
    let counted_from = if is_steady {
        // Not after the tooth has come: the averages would lose a revolution.
        let begins = start.input_rev * per_revolution + ROUNDING;
        let (settled, period) = ((first + margin) as f64, start.period_rev * per_revolution);
        // So many periods later that the settling comes before it. The period of a gearbox need not be a whole number of samples.
        let periods = ((settled - begins.floor()) / period).ceil().max(0.0);
        first = (begins + periods * period).floor().max(settled) as usize - margin;
        start::counted_from(&turning, (first + margin) as f64 / per_revolution, ROUNDING / per_revolution)
    } else {
        start::counted_from(&turning, start.input_rev, 0.0)
    };
    let kept = kept_samples(keep, &turning, is_steady, &time);
    let seconds = |samples: usize| samples as f64 * time.step_s();
    scenario.solver.discard_and_keep(seconds(first), seconds(kept + 2 * margin));
    // A record keeps the beginning of a profile.
    scenario.operation.end_profiles_at(seconds(kept + 2 * margin));
    Ok((scenario, Window { turning, counted_from, margin }))
}

/// Samples of a steady simulation before a record's first and after its last, which filters read.
fn margin(
    keep: &Keep,
    drawn: &DrawnRecord,
    scenario: &Scenario,
    turning: &Turning,
    time: &TimeGrid,
) -> Result<usize, SignalError> {
    let reach = AntiAliasing::steep_reach(time.sampling_rate_hz, keep.sampling_rate_hz)?;
    let simulated = keep.simulated();
    let is_read = |name: &str| simulated.contains(&Channel::Sensor(name.to_owned()));
    let sensors = scenario.sensors.iter().filter(|sensor| is_read(&sensor.name()));
    let of_paths = (simulated.iter().filter(|channel| channel.is_acceleration()))
        .map(|channel| path::structure(drawn, &channel.name()).memory_s());
    let memory_s = sensors.map(|sensor| sensor.memory_s()).chain(of_paths).fold(0.0, f64::max);
    let remembered = (memory_s * time.sampling_rate_hz).ceil() as usize;
    let period = (turning.cycle_rev() * time.samples_per_pinion_revolution as f64).round() as usize;
    // One sample of the record more on either side, as the last one may lie behind the end of its last revolution.
    let step = (time.sampling_rate_hz / keep.sampling_rate_hz).ceil() as usize;
    Ok(reach + step + remembered.min(period))
}

/// Samples of the simulation that a record is made of.
fn kept_samples(keep: &Keep, turning: &Turning, is_steady: bool, time: &TimeGrid) -> usize {
    match (keep.over_angle, keep.duration_s) {
        (Some(angle), _) => {
            let wheel = &turning.wheels[turning.number(&keep.wheel.all()[0])];
            // Its first tooth may come a pitch after the record's start.
            let before = if turning.enter_together { 0.0 } else { 1.0 };
            let pitches = angle.revolutions as f64 * f64::from(wheel.teeth) + before;
            let samples = pitches * time.samples_per_pinion_revolution as f64 / wheel.pitches_per_revolution;
            (samples - ROUNDING).ceil() as usize
        }
        (None, Some(duration_s)) => {
            let kept = (duration_s * time.sampling_rate_hz).round() as usize;
            // Of an unsteady motion there is no margin, from which the last sample could be read.
            let last = (time.sampling_rate_hz / keep.sampling_rate_hz).ceil() as usize;
            if is_steady { kept } else { kept + last }
        }
        (None, None) => time.kept_samples(),
    }
}
